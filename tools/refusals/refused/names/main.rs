//! Blocks that name something that is there already.

#![allow(mixed_script_confusables)]

mod name_of_a_struct;

fn main() {}
