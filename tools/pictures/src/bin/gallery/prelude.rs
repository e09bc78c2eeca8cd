//! The names that the programs of the gallery use.

pub(crate) use pendulum_runtime::prelude::*;

pub(crate) type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;
