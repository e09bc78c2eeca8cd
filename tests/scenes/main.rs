//! Scenes: many pendulums on joints.

#![allow(confusable_idents, mixed_script_confusables, missing_docs)]

pub mod bones;
pub mod centers;
pub mod chains;
pub mod commands;
pub mod constrained;
pub mod contacts;
pub mod expectations;
pub mod frictions;
pub mod inputs;
pub mod interface;
pub mod limits;
pub mod live;
pub mod pinches;
pub mod refusals;
pub mod removal;
pub mod skipping;
pub mod sleep;
pub mod slips;
pub mod space;
pub mod sweeps;
