//! Systems shared by tests, benchmarks and tools, with a few helpers, and the final states of every
//! method as hashes.

#![allow(mixed_script_confusables, confusable_idents)]

pub mod constrained;
pub mod distance;
pub mod fingerprints;
pub mod keys;
pub mod pendulums;
pub mod problems;
pub mod random;
pub mod work_precision;
