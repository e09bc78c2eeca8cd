//! What an integration checks at its start, and how it finds and crosses kinks.

use crate::error::{Error, Part, Quantity};
use crate::integrate::field::inertia::inertia;
use crate::integrate::field::load::loads;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::{first_in_inputs, first_in_state};
use crate::integrate::method::Method;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::projection;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, Purpose, System, is_constrained};
use crate::time::Time;

/// Returns the side of a kink on which a step lies that starts there.
pub(super) fn onwards(backwards: bool) -> Side {
    if backwards { Side::Before } else { Side::After }
}

/// Checks that an integration can begin at this state.
pub(crate) fn check_start<D: Dynamics<N, Scalar = T>, T: Float, const N: usize>(
    dynamics: &D,
    time: Time,
    q: &[T; N],
    v: &[T; N],
) -> Result<(), Error> {
    let t = time.to_f64();
    if !t.is_finite() {
        return Err(Error::Interval { start: t, end: t });
    }
    for (part, values) in [(Part::Position, q), (Part::Velocity, v)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let coordinate = <D::System as System<N>>::FACTS.coordinate(index);
            return Err(Error::InitialState { part, coordinate, value: values[index].to_f64() });
        }
    }
    inertia(&Phase { dynamics, t: time, side: Side::After, q, v })
}

/// Returns the first kink after `t`, or the last kink before `t` if `backwards`; infinite if there
/// is none.
pub(super) fn next_kink<D, M, const N: usize>(
    method: &M,
    dynamics: &D,
    t: f64,
    backwards: bool,
) -> Result<f64, Error>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    match method.kink(dynamics, t, backwards) {
        None => Ok(if backwards { f64::NEG_INFINITY } else { f64::INFINITY }),
        Some(kink) if t < kink && !backwards || kink < t && backwards => Ok(kink),
        Some(kink) => Err(Error::Kink { t, kink }),
    }
}

/// Carries the velocities over the kink at `endpoint.t`.
pub(crate) fn cross<D, T, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<T, N>,
    backwards: bool,
) -> Result<(), Error>
where
    D: Dynamics<N, Scalar = T>,
    T: Float,
{
    let from = if backwards { Side::After } else { Side::Before };
    let v = dynamics.across_kink(endpoint.t, from, &endpoint.q.high, &endpoint.v.high);
    let facts = &<D::System as System<N>>::FACTS;
    if let Some(velocity) = first_in_state(facts, &endpoint.q.high, &v) {
        let input =
            |side| first_in_inputs(facts, &dynamics.inputs(endpoint.t, side, Purpose::Momenta));
        let t = endpoint.t.to_f64();
        return Err(match (input(Side::Before).or_else(|| input(Side::After)), velocity) {
            (Some(what), _) => Error::NotFinite { t, what, suspects: Vec::new() },
            // The state and the inputs are finite.
            (None, Quantity::Velocity(coordinate)) => Error::NoVelocity { t, coordinate },
            (None, what) => Error::NotFinite { t, what, suspects: Vec::new() },
        });
    }
    endpoint.v.jump(&v);
    endpoint.a = None;
    if const { is_constrained::<D, N>() } {
        // A constraint with a jump in its velocity exerts an impulse at the jump.
        let far = from.opposite();
        if const { 0 < loads::<D, N>() } {
            let phase = endpoint.phase(dynamics, far);
            let rest = Phase { v: &[T::from_f64(0.0); N], ..phase };
            let [_, drives] = dynamics.system().misfits(rest.at(&rest.momentum_inputs()));
            if let Some(k) = phase.knocked(phase.v, |k| drives[k]) {
                let (t, friction) = (endpoint.t.to_f64(), facts.frictions[k].name);
                return Err(Error::FrictionImpulse { t, friction });
            }
        }
        let state = projection::landed(dynamics, endpoint.t, far, &State::from(&*endpoint))?;
        endpoint.q.jump(&state.q);
        endpoint.v.jump(&state.v);
    }
    endpoint.settle(dynamics, from.opposite());
    Ok(())
}
