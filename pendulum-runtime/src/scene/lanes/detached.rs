//! Pendulums outside of their lanes.

use crate::scalar::Real;
use crate::scene::lanes::limits::Limits;

/// A pendulum outside of all buckets.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Detached<T, const N: usize> {
    pub(crate) id: u32,
    pub(crate) joints: Vec<u32>,
    pub(crate) parameters: Vec<T>,
    /// Coordinates and velocities, each with its low words, and both one tick before.
    pub(crate) state: [[T; N]; 6],
    pub(crate) limits: Limits<T, N>,
}

impl<T: Real, const N: usize> Detached<T, N> {
    /// Holds the state within hard limits.
    pub(crate) fn hold(&mut self) {
        let [q, q_low, v, v_low, ..] = &mut self.state;
        let before = (*q, *v);
        self.limits.hold(q, v);
        if before != (*q, *v) {
            (*q_low, *v_low) = ([T::from_f64(0.0); N], [T::from_f64(0.0); N]);
        }
    }
}
