//! Doubts about series that did not hold at the end of a step.

use crate::integrate::state::interval::StepInterval;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::controller::Trial;
use crate::time::Time;

/// A jump is found within some forty steps, and behind it they are long again. If series go on not
/// to hold, the accelerations are not exact.
pub(super) const MOST_DOUBTS: u32 = 256;

/// A step is long again if it is so many times as long as the shortest before it.
const FOUND: f64 = 1e3;

/// The greatest number of times that a step is halved.
const MOST_HALVED: u32 = 40;

/// Doubts about series, from step to step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubts {
    /// The last time at which a series did not hold.
    pub(super) refuted: Option<Time>,
    /// The number of steps in a row that went over a jump, or over something like one.
    crossed: u32,
    /// One more for each step that was halved, two less for each whole step whose series holds, and
    /// none where steps are long again.
    pub(super) count: u32,
    /// The shortest step of these.
    shortest: f64,
    /// Of the step under way: its series holds, as far as it was looked at.
    pub(super) holds: bool,
    /// It differs from the accelerations by no more than rounding.
    pub(super) rounding: bool,
    /// It goes over a jump.
    crosses: bool,
    /// It is taken without another look.
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
    /// Begins a step from `t`; its length is `wanted`, or less if a series did not hold before.
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

    /// Returns true if the next step is taken as if there had been none.
    pub(super) fn are_gone(&self) -> bool {
        self.refuted.is_none() && self.count == 0 && self.crossed == 0
    }

    /// Visits all that the next step needs.
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

    /// The length of the next attempt after one whose series does not hold at its end.
    pub(super) fn shorten(&mut self, trial: &Trial, interval: &StepInterval, whole: f64) -> f64 {
        let halved = trial.rejected + 1;
        self.refuted = Some(interval.end);
        // A jump may be as wide as the rounding of the place: each further step over it is twice as
        // long.
        if halved < MOST_HALVED.saturating_sub(self.crossed) {
            return 0.5 * interval.h.abs();
        }
        // Something jumps within so short a step, which goes over that; or its series is right, and
        // the difference is rounding.
        (self.refuted, self.crosses, self.trusts) = (None, !self.rounding, true);
        if self.crosses { trial.wanted } else { whole }
    }

    /// The step is taken, after shorter attempts if it was `halved`.
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
