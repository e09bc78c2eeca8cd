//! Blocks that are sound, and calls that their types refuse.

#![allow(mixed_script_confusables)]

mod control_missing;
mod controlled_by_series;
mod motions_missing;

fn main() {}
