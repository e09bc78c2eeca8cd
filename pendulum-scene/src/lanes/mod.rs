//! Lanes: pendulums of one type that are computed together in blocks.

pub(super) mod block;
pub(super) mod bucket;
pub(super) mod equations;
pub(super) mod kernel;
pub(super) mod limits;
mod octets;
pub(super) mod open;
mod steps;
