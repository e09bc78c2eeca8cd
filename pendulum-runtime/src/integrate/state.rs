//! The state at one time.

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
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::data::arrays::array"))]
    pub q: [T; N],
    /// The velocities.
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::data::arrays::array"))]
    pub v: [T; N],
}
