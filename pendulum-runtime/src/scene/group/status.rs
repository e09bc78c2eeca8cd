//! Whether pendulums are computed.

/// What a pendulum is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SceneStatus {
    /// It swings.
    Awake,
    /// It rests until the tick given, or until somebody wakes it.
    Asleep(i64),
    /// It has been taken off the screen at the tick given.
    Hidden(i64),
    /// Its state has ceased to be finite; it hangs where it was last good.
    Failed,
}
