//! Ensembles: members have the bits of single motions on any number of threads and processes.

#![allow(mixed_script_confusables, missing_docs)]

pub mod checkpoints;
pub mod driven;
pub mod edges;
pub mod lanes;
pub mod reductions;
pub mod teams;
pub mod walls;
pub mod ways;
