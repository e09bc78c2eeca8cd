//! Random systems in the language of `lagrangian!`, and their motion computed without the compiler.
//!
//! The generator creates trees and writes them as source text. The reference evaluates the trees
//! with infinitesimals and uses no rule of the compiler. The tests of the compiler compare both at
//! random states.

// Names of variants and fields are those of the language, and the crate is used only in this
// workspace.
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

pub use systems::random::Random;
