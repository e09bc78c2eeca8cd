//! The status of a pendulum: awake, asleep, hidden or failed.

/// The status of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SceneStatus {
    /// The pendulum is computed in every tick.
    Awake,
    /// The pendulum rests until the given tick, or until it is woken.
    Asleep(i64),
    /// The pendulum was hidden at the given tick and is not computed.
    Hidden(i64),
    /// The state is no longer finite; the pendulum keeps its last finite state.
    Failed,
}
