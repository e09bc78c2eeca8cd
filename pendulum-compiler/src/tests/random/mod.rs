//! Random systems, derived by the compiler and computed without it.
//!
//! The compiler against the reference of `random_systems`, at random states, in `f64` and in
//! double-double.

mod check;
mod constrained;
mod interpret;
mod tests;
mod written;

use crate::compile::derived;
use crate::messages::Errors;
use random_systems::tree;

/// The fate of a random system.
enum Outcome {
    /// Refused, with these errors.
    Refused(String),
    /// The source has no value at the state that plain arithmetic can find.
    Unsound,
    Compared(check::Findings),
}

/// Derives the system of a seed and compares it at the state of the same seed.
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
