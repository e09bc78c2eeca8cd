//! Times between acts, which tell acts that go on from those that never end.

use crate::integrate::state::saved::Memory;
use crate::time::Time;

/// Times between acts that have grown shorter so often, and by this factor, accumulate.
const SHORTER: u32 = 5;
const ACCUMULATED: f64 = 1e-6;
/// The number of acts in a row, each within this part of the time reached, that stay where they
/// are.
const ACTS: u32 = 1000;
const STILL: f64 = 1e-12;

/// The times between the acts of an event.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Acts {
    /// The last act.
    last: Option<Time>,
    /// The time between the last two, and how many in a row have been shorter than the one before.
    gap: f64,
    shorter: u32,
    /// The last such time over the one before it.
    ratio: f64,
    /// The time between two acts from which they have grown shorter.
    longest: f64,
    /// The number of acts in a row at the same time.
    still: u32,
}

/// The verdict on the times between the acts of an event.
pub(super) enum Next {
    Usual,
    /// They come at the same time.
    Still,
    /// They accumulate at this time.
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

    /// Takes note of an act at `time`.
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

    /// The time at which acts accumulate, the last of them at `time`, if they have grown shorter
    /// often enough: the sum of a geometric series.
    pub(super) fn limit(&self, time: Time) -> Option<f64> {
        let rest = self.gap * self.ratio / (1.0 - self.ratio);
        (SHORTER <= self.shorter).then(|| time.to_f64() + rest)
    }
}
