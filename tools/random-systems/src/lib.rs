//! Random systems in the language of `lagrangian!`, and their motion computed without the compiler.
//!
//! The generator makes trees of its own and writes them as source text. The reference evaluates the
//! trees with infinitesimals and knows no rule of the compiler; the tests of the compiler compare
//! both at random states.

// For the tests of this workspace alone.
#![allow(
    missing_docs,
    missing_debug_implementations,
    clippy::missing_panics_doc,
    clippy::should_implement_trait
)]

pub mod evaluate;
pub mod generate;
pub mod nilpotent;
pub mod reference;
mod source;
pub mod split_mix;
pub mod state;
pub mod tokens;
pub mod transform;
pub mod tree;

pub use split_mix::Random;
