//! Pendulums outside of their buckets.

use crate::scalar::Real;
use crate::scene::lanes::limits::Limits;
use crate::system::System;

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
    /// Creates a pendulum on joints, without limits.
    pub(crate) fn new<S: System<N, Scalar = T>>(
        system: &S,
        joints: Vec<u32>,
        q: [T; N],
        v: [T; N],
    ) -> Self {
        let mut parameters = Vec::new();
        system.map(|parameter| {
            parameters.push(parameter);
            parameter
        });
        let mut detached =
            Self { id: 0, joints, parameters, state: [q; 6], limits: Limits::none() };
        detached.set_state(q, v);
        detached
    }

    /// Sets the state, now and one tick earlier.
    pub(crate) fn set_state(&mut self, q: [T; N], v: [T; N]) {
        let zero = [T::from_f64(0.0); N];
        self.state = [q, zero, v, zero, q, v];
    }

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
