//! Random systems, derived by the macro and computed without it.
//!
//! The generator makes systems in a language of its own. The macro gets them as text; the reference evaluates the generator's trees with
//! infinitesimals and knows no rule of the macro. What both say at random states is compared in `f64` and in double-double.

mod check;
pub(crate) mod derive;
mod evaluate;
pub(crate) mod generate;
mod interpret;
mod nilpotent;
mod reference;
mod source;
pub(crate) mod split_mix;
mod state;
#[cfg(test)]
mod tests;
pub(crate) mod tokens;
#[cfg(test)]
mod transform;
pub(crate) mod tree;
#[cfg(test)]
mod written;

pub(crate) use split_mix::Random;

/// What became of a random system.
pub(crate) enum Outcome {
    /// Refused, with these errors.
    Refused(String),
    /// The source has no value at the state that plain arithmetic can find.
    Unsound,
    Compared(check::Findings),
}

/// Derives the system of a seed and compares it at the state of the same seed.
pub(crate) fn outcome(system: &tree::System) -> Outcome {
    let mut errors = crate::error::Errors::default();
    let found = derive::derived(&system.source("Random"), &mut errors, |model, graph, motion, _| {
        check::compare(system, &check::Derived { model, graph, motion }, system.seed)
    });
    match found {
        None => Outcome::Refused(errors.into_tokens().to_string()),
        Some(findings) if findings.sound() => Outcome::Compared(findings),
        Some(_) => Outcome::Unsound,
    }
}
