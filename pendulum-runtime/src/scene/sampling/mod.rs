//! Time in ticks, and the samples of joints at the times that the grids of the pendulums ask for.

pub(super) mod clock;
pub(super) mod from_numbers;
pub(super) mod joint;
pub(super) mod layout;
pub(super) mod scheme;
pub(super) mod timetable;
pub(super) mod tracks;
