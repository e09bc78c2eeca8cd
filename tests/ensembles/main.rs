//! Ensembles: the bits of single members, and the same bits whoever solves them.

#![allow(mixed_script_confusables, missing_docs)]

pub mod checkpoints;
pub mod driven;
pub mod edges;
pub mod lanes;
pub mod reductions;
pub mod teams;
pub mod walls;
pub mod ways;
