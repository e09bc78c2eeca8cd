//! Taylor series of any order.

mod controller;
mod doubts;
mod method;
mod rule;

pub(crate) use controller::{Ends, MISFIT};
pub use method::Taylor;
pub(crate) use method::{GAP, WorkspaceOf, rest, series_interpolant};
pub(crate) use rule::{LAST_ORDERS, Rule};
