//! Systems that tests, benchmarks and tools share, with a few helpers, and the final states of
//! every method as hashes.

#![allow(mixed_script_confusables, confusable_idents)]

pub mod constrained;
pub mod distance;
pub mod fingerprints;
pub mod keys;
pub mod pendulums;
pub mod planet;
pub mod problems;
pub mod work_precision;

/// The random numbers.
pub mod random {
    pub use split_mix::Random;

    /// Every seventh case, from the first on; all of them with `ALL_CASES=1`.
    ///
    /// `.ci/run` looks at all cases of tests that take seconds without optimization.
    pub fn some<T>(cases: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        let share = if std::env::var_os("ALL_CASES").is_some() { 1 } else { 7 };
        cases.into_iter().step_by(share)
    }
}
