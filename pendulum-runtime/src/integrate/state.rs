//! The state at one time.

use crate::integrate::step::endpoint::Endpoint;
use crate::scalar::Float;

/// The state at one time.
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
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::data::serial::array"))]
    pub q: [T; N],
    /// The velocities.
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::data::serial::array"))]
    pub v: [T; N],
}

impl<T: Float, const N: usize> From<&Endpoint<T, N>> for State<T, N> {
    fn from(end: &Endpoint<T, N>) -> Self {
        Self { t: end.t.to_f64(), q: end.q.high, v: end.v.high }
    }
}
