//! Doubts about series that were not valid at the end of a step.

use crate::integrate::state::interval::StepInterval;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::controller::Trial;
use crate::time::Time;

/// The count of doubts at which the accelerations are assumed to be inexact: a jump is located
/// within about forty steps, and the steps after it are long again.
pub(super) const MOST_DOUBTS: u32 = 256;

/// A step counts as long again if it exceeds the shortest step before it by this factor.
const FOUND: f64 = 1e3;

/// The largest number of halvings of a step.
const MOST_HALVED: u32 = 40;

/// The doubts about series that pass from step to step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubts {
    /// The last time at which a series was not valid, until steps have passed it.
    pub(super) refuted: Option<Time>,
    /// The number of successive steps that crossed a jump or something similar.
    crossed: u32,
    /// The count of doubts. It increases by one for each step that was halved, decreases by two for
    /// each whole step with a valid series, and returns to zero when steps are long again.
    pub(super) count: u32,
    /// The length of the shortest halved step since the count was zero.
    shortest: f64,
    /// `true` if the series of the current step has passed all checks and no refuted time lies
    /// ahead.
    pub(super) holds: bool,
    /// `true` if the series of the current step differs from the accelerations by rounding only.
    pub(super) rounding: bool,
    /// `true` if the current step crosses a jump.
    crosses: bool,
    /// `true` if the current step is taken without a further check.
    pub(super) trusts: bool,
}

impl Default for Doubts {
    fn default() -> Self {
        Self {
            refuted: None,
            crossed: 0,
            count: 0,
            shortest: f64::INFINITY,
            holds: true,
            rounding: false,
            crosses: false,
            trusts: false,
        }
    }
}

impl Doubts {
    /// Begins a step from `t` and returns its length: `wanted`, or the distance to a refuted time
    /// ahead if that is shorter.
    pub(super) fn begin(&mut self, t: Time, backwards: bool, resolution: f64, wanted: f64) -> f64 {
        let left = |refuted: Time| refuted.since(t.to_f64()) - t.low();
        self.refuted = self.refuted.filter(|&refuted| {
            let left = left(refuted);
            (left < 0.0) == backwards && resolution < left.abs()
        });
        (self.holds, self.crosses, self.trusts) = (self.refuted.is_none(), false, false);
        let left = self.refuted.map_or(f64::INFINITY, |refuted| left(refuted).abs());
        if left < wanted { left } else { wanted }
    }

    /// Returns `true` if no doubt affects the next step.
    pub(super) fn are_gone(&self) -> bool {
        self.refuted.is_none() && self.count == 0 && self.crossed == 0
    }

    /// Visits everything that the next step depends on.
    pub(super) fn remember(&mut self, memory: &mut Memory) {
        let Self { refuted, crossed, count, shortest, .. } = self;
        memory.maybe(refuted, || Time::new(0.0), Memory::time);
        for count in [crossed, count] {
            let mut number = *count as usize;
            memory.count(&mut number, u32::MAX as usize);
            *count = number as u32;
        }
        memory.number(shortest);
    }

    /// Returns the length of the next attempt after one with a series that was not valid at its
    /// end.
    pub(super) fn shorten(&mut self, trial: &Trial, interval: &StepInterval, whole: f64) -> f64 {
        let halved = trial.rejected + 1;
        self.refuted = Some(interval.end);
        // A jump may be as wide as the rounding of its position: each further step across it is
        // twice as long.
        if halved < MOST_HALVED.saturating_sub(self.crossed) {
            return 0.5 * interval.h.abs();
        }
        // Either the accelerations jump within this short interval, and the step crosses it; or the
        // series is valid, and the difference is rounding.
        (self.refuted, self.crosses, self.trusts) = (None, !self.rounding, true);
        if self.crosses { trial.wanted } else { whole }
    }

    /// Records that a step of length `taken` was accepted; `halved` is `true` after rejected
    /// attempts.
    pub(super) fn accept(&mut self, halved: bool, taken: f64) {
        self.crossed = if self.crosses { self.crossed + 1 } else { 0 };
        if self.count < MOST_DOUBTS && FOUND * self.shortest < taken || self.count == 0 {
            (self.count, self.shortest) = (0, f64::INFINITY);
        }
        if halved {
            self.count += 1;
            self.shortest = if taken < self.shortest { taken } else { self.shortest };
        } else if self.holds {
            self.count = self.count.saturating_sub(2);
        }
        if MOST_DOUBTS <= self.count {
            self.refuted = None;
        }
    }
}
