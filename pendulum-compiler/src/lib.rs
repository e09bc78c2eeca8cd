//! The compiler behind `lagrangian!` of the `pendulum` workspace: from the tokens of a Lagrangian
//! to Rust code.
//!
//! [`compile()`] takes source text outside of any macro. The folders are layers, each of which uses
//! only the layers below it:
//!
//! ```text
//! compile     the order of the passes
//! backend     Rust with its jets, Unicode, LaTeX, MathML, and the copy for editors
//! mechanics   energies, Euler–Lagrange, elimination, symmetries, Jacobians
//! schedule    expressions to straight-line programs
//! model       names resolved, shapes and units
//! syntax      tokens to a tree
//! algebra     the graph of expressions: exact numbers, functions, rules, derivatives, order
//! messages    what is wrong, at the tokens at fault
//! ```

mod algebra;
mod backend;
mod compile;
mod mechanics;
mod messages;
mod model;
mod schedule;
mod syntax;
#[cfg(test)]
mod tests;

pub use backend::compiled::{Compiled, Declaration, Message, Output, Position};
pub use compile::{compile, expand, words};
pub use schedule::Operations;
