//! The state of a system at one time, and its forms during an integration.

#[cfg(feature = "serde")]
pub(crate) mod arrays;
pub(crate) mod compensated;
pub(crate) mod endpoint;
pub(crate) mod impact;
pub(crate) mod interval;
pub(crate) mod saved;
pub(crate) mod slip;

use crate::integrate::field::response::impact;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The state of a system at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct State<T, const N: usize> {
    /// The time in seconds.
    pub t: f64,
    /// The coordinates.
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::state::arrays::array"))]
    pub q: [T; N],
    /// The velocities.
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::state::arrays::array"))]
    pub v: [T; N],
}

impl<T: Float, const N: usize> State<T, N> {
    /// Reflects the velocities from a wall with the normal ∂g/∂q: adds the change computed by
    /// [`impact`](crate::integrate::impact).
    ///
    /// ```
    /// # use pendulum_runtime::{integrate::*, system::*};
    /// fn stop<S: System<2, Scalar = f64, Inputs = ()> + Sync>(arm: &S) -> Event<'_, f64, 2> {
    ///     Event::new(|_t, q, _v| q[1] - q[0]).falling().then(|state| state.bounce(arm, &[-1.0, 1.0], 0.5))
    /// }
    /// ```
    pub fn bounce<D: Dynamics<N, Scalar = T>>(
        &mut self,
        dynamics: &D,
        normal: &[T; N],
        restitution: f64,
    ) {
        let change = impact(dynamics, self.t, &self.q, &self.v, normal, restitution);
        for i in 0..N {
            self.v[i] += change[i];
        }
    }
}
