//! The cause of a step that failed.

use crate::error::{Error, Quantity, Suspect};
use crate::integrate::method::Method;
use crate::integrate::schemes::linear::Factors;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::{Field, coordinate, first_in_state};
use crate::integrate::step::interval::StepInterval;
use crate::motion::Side;
use crate::real::{Float, Real};
use crate::system::{Dynamics, Purpose, System, scalar_time};
use crate::time::Time;

/// The error for a step, with what it has left in `workspace`, that led to a number that is not
/// finite.
pub(crate) fn cause<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    method: &M,
    field: &Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    workspace: &M::Workspace,
) -> Error {
    let coordinate = coordinate(&<D::System as System<N>>::FACTS, 0);
    method.diagnose(field, interval, from, workspace).unwrap_or_else(|| Error::NotFinite {
        t: interval.end.to_f64(),
        what: Quantity::Velocity(coordinate),
        suspects: Vec::new(),
    })
}

/// The first number in the evaluations of a step that is not finite, or where its equations were
/// not solved, if there is one.
pub(crate) fn fault<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    method: &M,
    field: &Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    workspace: &M::Workspace,
) -> Option<Error> {
    let facts = &<D::System as System<N>>::FACTS;
    let dynamics = field.dynamics;
    let unsolved = method.unsolved(workspace);
    let mut watched = field.watched();
    let mut start = Endpoint { a: None, ..*from };
    let to = method.attempt(&mut watched, interval, &mut start, &mut method.workspace(dynamics));
    let findings = watched.findings;
    if let Some((t, coordinate)) = findings.lost
        && regular(dynamics, from)
    {
        return Some(Error::NoVelocity { t: t.to_f64(), coordinate });
    }
    // Where an iteration went astray, numbers that are not finite are not the cause but the effect.
    if let Some((t, index)) = unsolved {
        let coordinate = coordinate(facts, index);
        return Some(Error::NoConvergence { t: t.to_f64(), step: interval.h, coordinate });
    }
    let at_end = || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what));
    let (t, what) = findings.first.or_else(at_end)?;
    if findings.singular {
        return Some(Error::NotFinite {
            t: t.to_f64(),
            what,
            suspects: suspects(dynamics.system()),
        });
    }
    Some(not_finite(dynamics.system(), t, what))
}

/// Whether the mass matrix at the start of a step leads from velocities to momenta and back.
fn regular<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    from: &Endpoint<D::Scalar, N>,
) -> bool {
    let (t, q, v) = (scalar_time(from.t), &from.q.high, &from.v.high);
    let inputs = dynamics.inputs(from.t, Side::After, Purpose::Momenta);
    let mass = dynamics.system().mass_matrix(t, q, v, &inputs);
    let momenta = Factors::<_, N, 1>::new(|_, _| {
        core::array::from_fn(|i| core::array::from_fn(|j| mass[(i, j)]))
    });
    let mut unit = [[D::Scalar::from_f64(1.0); N]];
    momenta.solve(&mut unit);
    unit[0].iter().all(|x| x.is_finite())
}

/// The error for a number that is not finite, with the parameters that may be the cause.
pub(crate) fn not_finite<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    t: Time,
    what: Quantity,
) -> Error {
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
fn parameters<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    suspicious: impl Fn(f64) -> bool,
) -> Vec<Suspect> {
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
