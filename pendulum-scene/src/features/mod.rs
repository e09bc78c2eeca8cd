//! Operations of a scene between ticks.

pub(super) mod bake;
pub(super) mod carried;
pub(super) mod commands;
pub(super) mod cycle;
pub(super) mod limits;
pub(super) mod removal;
pub(super) mod snapshot;
pub(super) mod visibility;
