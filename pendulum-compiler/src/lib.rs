//! The compiler behind `lagrangian!` of the `pendulum` workspace: a Lagrangian as tokens in, Rust out.

mod articulated;
mod ast;
mod cancel;
mod check;
mod clock;
mod collect;
mod compile;
mod derive;
mod diff;
mod emit;
mod error;
mod expr;
mod jacobian;
mod jet;
mod latex;
mod lower;
mod mirror;
mod modular;
mod motion;
mod name;
mod number;
mod order;
mod parse;
mod print;
mod rule;
mod schedule;
mod sign;
mod solve;
mod symmetry;
#[cfg(test)]
mod tests;
mod unit;
mod value;

pub use compile::{Compiled, Declaration, Message, Operations, Place, compile, expand};
