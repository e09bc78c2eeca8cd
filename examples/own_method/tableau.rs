//! The tableau, and the slopes at the stages of a step.

use pendulum_runtime::scalar::Real;

/// The slopes at the four stages: velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stages<T, const N: usize> {
    pub(crate) v: [[T; N]; 4],
    pub(crate) a: [[T; N]; 4],
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// Returns Σ weight · slope of velocities and accelerations.
    pub(crate) fn weighted(&self, weights: &[f64; 4]) -> ([T; N], [T; N]) {
        let sum = |slopes: &[[T; N]; 4]| {
            core::array::from_fn(|i| {
                let terms = weights.iter().zip(slopes);
                terms.fold(T::from_f64(0.0), |sum, (&w, slope)| sum + T::from_f64(w) * slope[i])
            })
        };
        (sum(&self.v), sum(&self.a))
    }
}

pub(crate) const C: [f64; 3] = [0.0, 0.5, 0.75];
pub(crate) const B: [f64; 4] = [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0];
/// The differences between the weights of both orders.
pub(crate) const E: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];
