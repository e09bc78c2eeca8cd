//! One step: its length, its error, its end, and the loop that takes one after the other.

pub(crate) mod adaptive;
pub(crate) mod compensated;
pub(crate) mod contacts;
pub(crate) mod controller;
pub(crate) mod diagnose;
pub(crate) mod endpoint;
pub(crate) mod fast_exp2;
pub(crate) mod field;
pub(crate) mod fixed;
pub(crate) mod gap;
pub(crate) mod held;
pub(crate) mod inertia;
pub(crate) mod integration;
pub(crate) mod interval;
pub(crate) mod limits;
pub(crate) mod observed;
pub(crate) mod projection;
pub(crate) mod short;
