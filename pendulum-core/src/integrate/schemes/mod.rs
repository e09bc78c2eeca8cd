//! Parts of steps that several methods share.

pub(crate) mod runge_kutta;
pub(crate) mod splitting;
