//! Test build.
#![allow(mixed_script_confusables, dead_code)]
mod bvh;
mod hand;
fn main() {}
