//! Who is to blame for a step that failed.

use super::field::{Watched, first_in_state};
use super::method::Suits;
use super::node::Node;
use super::span::Span;
use super::stepper::Stepper;
use crate::error::{Error, Quantity, Suspect};
use crate::real::Float;
use crate::system::{Dynamics, System};
use crate::time::Time;

/// The error for a step, with what it has left in `stages`, that led to a number that is not finite.
pub(crate) fn blame<D: Dynamics<N, Scalar: Float>, M: Stepper<D, N>, const N: usize>(
    method: &M,
    dynamics: &D,
    span: &Span,
    from: &Node<D::Scalar, N>,
    stages: &M::Stages,
) -> Error {
    let coordinate = super::field::coordinate(&<D::System as System<N>>::FACTS, 0);
    let unknown = Error::NotFinite { t: span.end.to_f64(), what: Quantity::Velocity(coordinate), suspects: Vec::new() };
    method.fault(dynamics, span, from, stages).unwrap_or(unknown)
}

/// The first number in the stages of a step that is not finite, or where its equations were not solved, if there is one.
pub(crate) fn fault<D: Dynamics<N, Scalar: Float>, M: Suits<D::System, N>, const N: usize>(
    method: &M,
    dynamics: &D,
    span: &Span,
    from: &Node<D::Scalar, N>,
    stages: &M::Stages<D::Scalar, N>,
) -> Option<Error> {
    let facts = &<D::System as System<N>>::FACTS;
    // Where an iteration went astray, numbers that are not finite are not the cause but the effect.
    if let Some((t, index)) = M::unsolved(stages) {
        let coordinate = super::field::coordinate(facts, index);
        return Some(Error::NoConvergence { t: t.to_f64(), step: span.h, coordinate });
    }
    let mut watched = Watched::new(dynamics);
    let to = method.step(&mut watched, span, &mut Node { a: None, ..*from }, &mut M::stages());
    let at_end = || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (span.end, what));
    let (t, what) = watched.first.or_else(at_end)?;
    if watched.singular {
        return Some(Error::NotFinite { t: t.to_f64(), what, suspects: suspects(dynamics.system()) });
    }
    Some(not_finite(dynamics.system(), t, what))
}

/// The error for a number that is not finite, with the parameters that may be the cause.
pub(crate) fn not_finite<S: System<N, Scalar: Float>, const N: usize>(system: &S, t: Time, what: Quantity) -> Error {
    let suspects = if let Quantity::Acceleration(_) = what { suspects(system) } else { Vec::new() };
    Error::NotFinite { t: t.to_f64(), what, suspects }
}

/// The parameters that are zero, infinite or not a number.
pub(crate) fn suspects<S: System<N, Scalar: Float>, const N: usize>(system: &S) -> Vec<Suspect> {
    parameters(system, |value| value == 0.0 || !value.is_finite())
}

/// The parameters that are negative.
pub(crate) fn negative<S: System<N, Scalar: Float>, const N: usize>(system: &S) -> Vec<Suspect> {
    parameters(system, |value| value < 0.0)
}

/// The parameters with values that are `suspicious`.
fn parameters<S: System<N, Scalar: Float>, const N: usize>(system: &S, suspicious: impl Fn(f64) -> bool) -> Vec<Suspect> {
    let (mut index, mut suspects) = (0, Vec::new());
    system.map(|parameter| {
        let value = parameter.to_f64();
        if suspicious(value) {
            let parameter = S::FACTS.parameters.get(index).copied().unwrap_or("");
            suspects.push(Suspect { parameter, value });
        }
        index += 1;
        parameter
    });
    suspects
}
