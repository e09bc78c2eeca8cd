//! Random systems in the language of `lagrangian!`, and their motion computed without the compiler.
//!
//! The generator makes trees of its own and writes them as source text. The reference evaluates the
//! trees with infinitesimals and knows no rule of the compiler; the tests of the compiler compare
//! both at random states.

// Names of variants and fields are those of the language; nobody outside of the workspace reads on.
#![allow(missing_docs)]

pub mod evaluate;
pub mod generate;
pub mod nilpotent;
pub mod reference;
mod source;
pub mod state;
pub mod tokens;
pub mod transform;
pub mod tree;

pub use ::split_mix::Random;
