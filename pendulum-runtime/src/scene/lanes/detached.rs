//! Pendulums outside of their buckets.

use crate::scalar::Real;
use crate::scene::lanes::limits::Limits;

/// A copy of a pendulum outside of its bucket.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Detached<T, const N: usize> {
    pub(crate) id: u32,
    pub(crate) joints: Vec<u32>,
    pub(crate) parameters: Vec<T>,
    /// The coordinates with their low words, the velocities with their low words, and the
    /// coordinates and velocities one tick earlier.
    pub(crate) state: [[T; N]; 6],
    pub(crate) limits: Limits<T, N>,
}

impl<T: Real, const N: usize> Detached<T, N> {
    /// Clamps the state to hard limits.
    pub(crate) fn hold(&mut self) {
        let [q, q_low, v, v_low, ..] = &mut self.state;
        let before = (*q, *v);
        self.limits.hold(q, v);
        if before != (*q, *v) {
            (*q_low, *v_low) = ([T::from_f64(0.0); N], [T::from_f64(0.0); N]);
        }
    }
}
