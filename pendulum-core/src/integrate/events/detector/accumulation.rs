//! Times between acts, which distinguish acts that accumulate from acts that continue.

use crate::integrate::state::saved::Memory;
use crate::time::Time;

/// Acts accumulate after the times between them have become shorter this many times in a row.
const SHORTER: u32 = 5;
/// Acts accumulate after the times between them have become shorter by this factor.
const ACCUMULATED: f64 = 1e-6;
/// The number of acts in a row at almost the same time that count as an event without progress.
const ACTS: u32 = 1000;
/// The greatest time between such acts, relative to the time reached.
const STILL: f64 = 1e-12;

/// The times between the acts of an event.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Acts {
    /// The time of the last act.
    last: Option<Time>,
    /// The time between the last two acts.
    gap: f64,
    /// The number of times in a row that the time between acts has become shorter.
    shorter: u32,
    /// The ratio of the last time between acts to the one before, when it last became shorter.
    ratio: f64,
    /// The time between two acts after which the times have only become shorter.
    longest: f64,
    /// The number of acts in a row at almost the same time.
    still: u32,
}

/// The verdict on the times between the acts of an event.
pub(super) enum Next {
    Usual,
    /// The acts happen at the same time.
    Still,
    /// The acts accumulate at this time.
    Accumulated(f64),
}

impl Acts {
    /// Visits all numbers.
    pub(super) fn remember(&mut self, memory: &mut Memory) {
        memory.maybe(&mut self.last, || Time::new(0.0), Memory::time);
        for number in [&mut self.gap, &mut self.ratio, &mut self.longest] {
            memory.number(number);
        }
        for count in [&mut self.shorter, &mut self.still] {
            let mut number = *count as usize;
            memory.count(&mut number, u32::MAX as usize);
            *count = number as u32;
        }
    }

    /// Adds an act at `time`.
    pub(super) fn next(&mut self, time: Time) -> Next {
        let t = time.to_f64();
        let Some(last) = self.last.replace(time) else { return Next::Usual };
        let (gap, before) = ((time.since(last.to_f64()) - last.low()).abs(), self.gap);
        self.gap = gap;
        self.still = if gap <= STILL * t.abs() { self.still + 1 } else { 0 };
        if gap < before {
            (self.shorter, self.ratio) = (self.shorter + 1, gap / before);
        } else {
            (self.shorter, self.longest) = (0, gap);
        }
        match self.limit(time) {
            Some(limit) if gap < ACCUMULATED * self.longest => Next::Accumulated(limit),
            _ if ACTS <= self.still => Next::Still,
            _ => Next::Usual,
        }
    }

    /// Returns the time at which acts accumulate, if the times between them have become shorter
    /// often enough: the sum of a geometric series. The last act is at `time`.
    pub(super) fn limit(&self, time: Time) -> Option<f64> {
        let rest = self.gap * self.ratio / (1.0 - self.ratio);
        (SHORTER <= self.shorter).then(|| time.to_f64() + rest)
    }
}
