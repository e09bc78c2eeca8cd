//! Dense output of the Gauss methods.

use super::tableau::Tableau;
use crate::integrate::interpolant::fit::{Condition, fit};
use crate::integrate::interpolant::{Interpolant, TERMS};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;

/// Returns the polynomial of degree S + 1 through the velocities at both ends and at the stages,
/// and its integral. If S = 1, the cubic through coordinates and velocities at both ends replaces
/// the integral.
pub(super) fn interpolant<T: Float, const N: usize, const S: usize>(
    interval: &StepInterval,
    from: &Endpoint<T, N>,
    to: &Endpoint<T, N>,
    stages: &[[T; N]; S],
) -> Interpolant<T, N> {
    let nodes = const { &Tableau::<S>::GAUSS.nodes };
    let mut interpolant = Interpolant::linear(interval, from, to);
    let h = interval.length::<T>();
    let zero = (Condition::Slope(0.0), [T::from_f64(0.0); N]);
    let (mut q, mut v) = ([zero; TERMS], [zero; TERMS]);
    for (j, (&node, stage)) in nodes.iter().zip(stages).enumerate() {
        q[j] = (Condition::Slope(node), stage.map(|v| h * v));
        v[j] = (Condition::Value(node), core::array::from_fn(|i| stage[i] - from.v.high[i]));
    }
    // The increment of the coordinates is a quadrature of the slopes at the stages, so that one of
    // these slopes is redundant.
    q[S - 1] = (Condition::Slope(0.0), from.v.high.map(|v| h * v));
    q[S] = (Condition::Slope(1.0), to.v.high.map(|v| h * v));
    fit(&mut interpolant.q, &q[..=S]);
    fit(&mut interpolant.v, &v[..S]);
    interpolant.terms = S + 2;
    interpolant
}
