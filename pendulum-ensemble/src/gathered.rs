//! Results of ensembles: values, counters, failed members, progress.

use core::fmt;
use pendulum_core::error::Error;
use pendulum_core::integrate::{Outcome, Stats};

/// The maximum number of failed members whose errors are stored.
pub(super) const KEPT: usize = 16;

/// The result of an ensemble.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Gathered<R> {
    /// The reduction of all members that were solved.
    pub value: R,
    /// The counters.
    pub tally: Tally,
    /// `true` if the function given to [`on_progress`](super::Mapped::on_progress) has cancelled
    /// the run: the value does not include unfinished shards.
    pub cancelled: bool,
    /// The number of shards that were read from a checkpoint.
    pub resumed: usize,
    /// The number of shards that the value does not include: those of other
    /// [parts](super::Mapped::part) that are not in the checkpoint, and unfinished ones of a
    /// cancelled run.
    pub missing: usize,
}

impl<R> Gathered<R> {
    /// Converts the value.
    pub(super) fn map<S>(self, convert: impl FnOnce(R) -> S) -> Gathered<S> {
        let Self { value, tally, cancelled, resumed, missing } = self;
        Gathered { value: convert(value), tally, cancelled, resumed, missing }
    }
}

/// The counters of an ensemble, or of a part of it.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Tally {
    /// The number of members that were solved or have failed.
    pub members: u64,
    /// The number of members that have failed.
    pub failed: u64,
    /// The failed members with the smallest indices, at most sixteen.
    pub failures: Vec<FailedMember>,
    /// The evaluations of all members, as counted by [`Stats`].
    pub evaluations: u64,
    /// The accepted steps of all members.
    pub accepted: u64,
    /// The rejected steps of all members.
    pub rejected: u64,
}

/// A member that has failed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FailedMember {
    /// The index of the member.
    pub index: usize,
    /// The time at which the integration ended.
    pub t: f64,
    /// The error; `None` if the member was read from a checkpoint, which contains only `message`.
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
        // Members end in any order; those with the smallest indices are kept.
        let place = self.failures.partition_point(|failed| failed.index < index);
        if place < KEPT {
            let (t, error) = (failure.partial.end.t, Some(failure.error.clone()));
            let message = failure.error.to_string();
            self.failures.insert(place, FailedMember { index, t, error, message });
            self.failures.truncate(KEPT);
        }
    }

    /// Adds the counters of a part whose members have greater indices.
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

/// The progress of an ensemble, passed to the function given to
/// [`on_progress`](super::Mapped::on_progress).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Progress {
    /// The number of finished members, including failed members.
    pub members: u64,
    /// The number of members that have failed.
    pub failed: u64,
    /// The number of all members.
    pub total: u64,
    /// The number of finished shards.
    pub shards: usize,
    /// The number of all shards.
    pub total_shards: usize,
}

impl Progress {
    /// Returns the fraction of finished members, from 0 to 1.
    pub fn progress(&self) -> f64 {
        if self.total == 0 { 1.0 } else { self.members as f64 / self.total as f64 }
    }
}
