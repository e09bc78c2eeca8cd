//! Calls that a constant refuses where they are compiled.

#![allow(mixed_script_confusables)]

mod derivative_missing;

fn main() {
    derivative_missing::main();
}
