//! Steps of fixed length of a system with limits or dry frictions whose state another program
//! keeps.

use super::Integration;
use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::method::Method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::stats::Stats;
use crate::integrate::step::arguments::Arguments;
use crate::integrate::step::fixed::FixedStep;
use crate::integrate::step::held::Held;
use crate::integrate::step::limits::Limits;
use crate::integrate::step::standing::Standings;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, System};
use crate::time::Time;

/// The maximum number of steps in one call of [`advance`]. A ball that comes to rest takes about a
/// hundred for its last impacts.
const MOST_STEPS: u64 = 10_000;

/// Returns the state at `t` from the coordinates `q` and velocities `v` given there, after the
/// impacts at this time, with the states of limits and frictions.
///
/// # Errors
/// Returns an error if the state is not finite or not on the constraints, if a mass is negative, if
/// a gap is below zero, or if no accelerations fulfil the laws of contacts and frictions.
pub fn start<D, M, const N: usize>(
    dynamics: &D,
    method: M,
    t: f64,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
) -> Result<(Endpoint<D::Scalar, N>, Standings), Error>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    let control = FixedStep::new(1.0);
    let integration = Integration::new(Held::borrowed(dynamics), method, control, t, q, v)?;
    Ok((integration.end, integration.limits.standings()))
}

/// Advances the state `end` to the time `t`, in steps of at most `step` seconds, with the bits of an
/// [`Integrator`](crate::integrate::Integrator) that has the same [`FixedStep`] and is advanced to
/// the same times. Does not allocate.
///
/// # Errors
/// Returns the error of a step; the state is then that at its start. A motion with more than ten
/// thousand steps is an error too.
pub fn advance<D, M, const N: usize>(
    dynamics: &D,
    method: M,
    step: f64,
    t: f64,
    (end, standing): (&mut Endpoint<D::Scalar, N>, &mut Standings),
) -> Result<(), Error>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    let mut integration = Integration::assembled(
        Held::borrowed(dynamics),
        method,
        FixedStep::new(step),
        (*end, Stats::new(M::NAME)),
        false,
        (Limits::silent(*standing), Arguments::none()),
    )?;
    let mut left = MOST_STEPS;
    let mut advanced = Ok(());
    while integration.t() != t && advanced.is_ok() {
        advanced = if left == 0 {
            Err(Error::MaxSteps { t: integration.t(), max_steps: MOST_STEPS })
        } else {
            integration.step(t)
        };
        left -= 1;
    }
    (*end, *standing) = (integration.end, integration.limits.standings());
    advanced
}

/// Returns the accelerations of a state with the forces of the limits in contact and of frictions.
pub fn accelerations<D, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    (q, v): (&[D::Scalar; N], &[D::Scalar; N]),
    standing: &Standings,
) -> [D::Scalar; N]
where
    D: Dynamics<N, Scalar: Float>,
{
    let prepared = dynamics.system().prepare();
    let mut field = Field::<D, N>::new(dynamics, &prepared);
    field.contacts = standing.contacts();
    field.at(t, side, q, v)
}
