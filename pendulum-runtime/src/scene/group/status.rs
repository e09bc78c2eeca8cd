//! Statuses of pendulums.

/// Status of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SceneStatus {
    /// The pendulum swings.
    Awake,
    /// The pendulum rests until the tick given, or until somebody wakes it.
    Asleep(i64),
    /// The pendulum was hidden at the tick given and is not computed.
    Hidden(i64),
    /// Its state has ceased to be finite; it hangs where it was last good.
    Failed,
}
