//! Time in ticks, and samples of joints at the times of all evaluations.

pub(super) mod carried;
pub(super) mod clock;
pub(super) mod followed;
pub(super) mod joint;
pub(super) mod live;
pub(super) mod scheme;
pub(super) mod tracks;
pub(super) mod turn;
pub(super) mod world;
