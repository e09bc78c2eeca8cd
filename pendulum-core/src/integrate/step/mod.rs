//! A single step: its length, its error, its end, and the loop over all steps.

pub(crate) mod adaptive;
pub(crate) mod arguments;
pub(crate) mod contact;
pub(crate) mod controller;
mod course;
pub(crate) mod fast_exp2;
pub(crate) mod fixed;
pub(crate) mod frictions;
pub(crate) mod gap;
pub(crate) mod held;
pub(crate) mod integration;
pub(crate) mod limits;
pub(crate) mod meeting;
pub(crate) mod passing;
pub(crate) mod projection;
pub(crate) mod short;
pub(crate) mod standing;
