//! Results of ensembles: what was gathered, what failed, how far it is.

use crate::error::Error;
use crate::integrate::{Outcome, Stats};
use core::fmt;

/// The number of failed members whose errors are kept.
pub(super) const KEPT: usize = 16;

/// The result of an ensemble.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Gathered<R> {
    /// The reduction of all members that were solved.
    pub value: R,
    /// The counters.
    pub tally: Tally,
    /// True if the function given to [`on_progress`](super::Mapped::on_progress) has ended it
    /// early: shards that were not finished are missing from the value.
    pub cancelled: bool,
    /// The number of shards that were read from a checkpoint.
    pub resumed: usize,
    /// The number of shards of other [parts](super::Mapped::part) that were not there.
    pub missing: usize,
}

/// The counters of an ensemble, or of a part of it.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Tally {
    /// The members that were solved or have failed.
    pub members: u64,
    /// The members that have failed.
    pub failed: u64,
    /// The first of them by index, sixteen at most.
    pub failures: Vec<FailedMember>,
    /// Evaluations of all members, as [`Stats`] count them.
    pub evaluations: u64,
    /// Steps of all members.
    pub accepted: u64,
    /// Rejected steps of all members.
    pub rejected: u64,
}

/// A member that has failed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FailedMember {
    /// Its index.
    pub index: usize,
    /// The time that it has reached.
    pub t: f64,
    /// Why it failed; empty if the member was read from a checkpoint, which keeps `message` alone.
    pub error: Option<Error>,
    /// The error as text.
    pub message: String,
}

impl fmt::Display for FailedMember {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "member {}: {}", self.index, self.message)
    }
}

impl Tally {
    /// Counts a member.
    pub(super) fn add<T, const N: usize>(&mut self, index: usize, outcome: &Outcome<T, N>) {
        let Stats { evaluations, accepted, rejected, .. } = match outcome {
            Ok(solution) => solution.stats,
            Err(failure) => failure.partial.stats,
        };
        self.members += 1;
        self.evaluations += evaluations;
        self.accepted += accepted;
        self.rejected += rejected;
        let Err(failure) = outcome else { return };
        self.failed += 1;
        // Members end in any order: the first ones by index stay.
        let place = self.failures.partition_point(|failed| failed.index < index);
        if place < KEPT {
            let (t, error) = (failure.partial.end.t, Some(failure.error.clone()));
            let message = failure.error.to_string();
            self.failures.insert(place, FailedMember { index, t, error, message });
            self.failures.truncate(KEPT);
        }
    }

    /// Adds the members of a part with greater indices.
    pub(super) fn join(&mut self, later: Self) {
        self.members += later.members;
        self.failed += later.failed;
        self.evaluations += later.evaluations;
        self.accepted += later.accepted;
        self.rejected += later.rejected;
        self.failures.extend(later.failures);
        self.failures.truncate(KEPT);
    }
}

/// The progress of an ensemble, for a function given by
/// [`on_progress`](super::Mapped::on_progress).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Progress {
    /// The members that are done, failed ones included.
    pub members: u64,
    /// The members that have failed.
    pub failed: u64,
    /// All members.
    pub total: u64,
    /// The shards that are done.
    pub shards: usize,
    /// All shards.
    pub total_shards: usize,
}

impl Progress {
    /// The part of the members that is done: from 0 to 1.
    pub fn progress(&self) -> f64 {
        if self.total == 0 { 1.0 } else { self.members as f64 / self.total as f64 }
    }
}
