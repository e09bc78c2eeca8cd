//! Random systems, derived by the compiler and evaluated without it.
//!
//! The compiler is compared with the reference of `random_systems`, at random states, in `f64` and
//! in double-double.

mod bodies;
mod check;
mod constrained;
pub(crate) mod interpret;
mod tests;
mod written;

use crate::compile::derived;
use crate::messages::Errors;
use random_systems::tree;

/// The outcome of a random system.
enum Outcome {
    /// The block was refused with these errors.
    Refused(String),
    /// The source has no value at the state that `f64` can compute.
    Unsound,
    Compared(check::Findings),
}

/// Derives a system and compares it with the reference at the state of its seed.
fn outcome(system: &tree::System) -> Outcome {
    let mut errors = Errors::default();
    let found = derived(&system.source("Random"), &mut errors, |model, graph, motion, _| {
        check::compare(system, &check::Derived { model, graph, motion }, system.seed)
    });
    match found {
        None => Outcome::Refused(errors.into_tokens().to_string()),
        Some(findings) if findings.sound() => Outcome::Compared(findings),
        Some(_) => Outcome::Unsound,
    }
}
