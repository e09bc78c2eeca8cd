//! Blocks that only a lint refuses.

#![allow(mixed_script_confusables)]

mod unused_parameter;

fn main() {}
