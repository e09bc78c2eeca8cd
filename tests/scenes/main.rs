//! Scenes: many pendulums on joints.

#![allow(mixed_script_confusables, missing_docs)]

pub mod commands;
pub mod interface;
pub mod skipping;
pub mod sleep;
