//! Systems shared by tests, benchmarks and tools, with a few helpers, and the final states of every
//! method as hashes.

#![allow(mixed_script_confusables, confusable_idents)]

pub mod constrained;
pub mod distance;
pub mod fingerprints;
pub mod keys;
pub mod pendulums;
pub mod planet;
pub mod problems;
pub mod work_precision;

/// Random numbers and the selection of cases.
pub mod random {
    pub use split_mix::Random;

    /// Returns every seventh case, beginning with the first, or all cases with `ALL_CASES=1`.
    ///
    /// `.ci/run` runs all cases of tests that take seconds without optimization.
    pub fn some<T>(cases: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        let share = if std::env::var_os("ALL_CASES").is_some() { 1 } else { 7 };
        cases.into_iter().step_by(share)
    }
}
