//! Motions that diverge: each part of the interval takes twice the steps of the one before.
//!
//! A pendulum whose damper has the wrong sign, or that is followed back in time, turns faster and
//! faster. Its steps shorten in proportion, so that the time of twice the steps stays the same, and
//! ten million steps take minutes to say that they do not suffice. It is said as soon as two things
//! hold: the pace has halved three times, each time with the number of steps, and even the present
//! pace does not suffice. A motion that begins fast and slows down later keeps its pace or gains;
//! an encounter of two bodies is over within hundreds of steps. Impacts that accumulate slow down
//! alike, but end in rest: the count begins anew at each impact that is weaker than one before.

/// The number of steps at the first time that counts. A start takes fewer.
const FIRST: u64 = 2048;

/// The times at which the number of steps had doubled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// The number of steps at the start.
    from: u64,
    /// The number of steps at the next time, or the number allowed, and the last time.
    next: u64,
    allowed: u64,
    time: f64,
    /// The time of the last doublings.
    spans: [f64; 3],
    /// The largest impulse of an impact.
    strongest: f64,
}

impl Pace {
    pub(super) fn new(start: f64, allowed: u64) -> Self {
        let next = FIRST.min(allowed);
        Self { from: 0, next, allowed, time: start, spans: [0.0; 3], strongest: 0.0 }
    }

    /// Regards an impact after a number of steps.
    pub(super) fn strike(&mut self, steps: u64, t: f64, impulse: f64) {
        if impulse < self.strongest {
            let next = (steps + FIRST).min(self.allowed);
            let (strongest, new) = (self.strongest, Self::new(t, self.allowed));
            *self = Self { from: steps, next, strongest, ..new };
        } else {
            self.strongest = impulse;
        }
    }

    /// Returns `true` if the steps allowed have been taken, or do not suffice for the time `left`.
    #[inline]
    pub(super) fn fails(&mut self, steps: u64, t: f64, left: f64) -> bool {
        self.next <= steps && self.has_failed(steps, t, left)
    }

    // A call in the loop over the steps would keep its values in memory.
    #[cold]
    #[inline(never)]
    fn has_failed(&mut self, steps: u64, t: f64, left: f64) -> bool {
        if self.allowed <= steps {
            return true;
        }
        let own = steps - self.from;
        let span = (t - self.time).abs();
        let [first, second, third] = self.spans;
        self.next = (self.from + 2 * own).min(self.allowed);
        (self.time, self.spans) = (t, [second, third, span]);
        // The spans of a steady pace double; those of one that halves vary by the steps.
        let slows = |[before, after]: [f64; 2]| 0.0 < before && after < 1.1 * before;
        let slower = [[first, second], [second, third], [third, span]].into_iter().all(slows);
        let needed = left.abs() / span * (own / 2) as f64;
        slower && ((self.allowed - steps) as f64) < needed
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    /// Returns the number of steps after which a run of this length ends, if it is ended.
    fn ended(time: impl Fn(u64) -> f64, end: f64) -> Option<u64> {
        let mut pace = Pace::new(0.0, 10_000_000);
        (1..1_000_000).find(|&k| pace.fails(k, time(k), end - time(k)))
    }

    #[test]
    fn a_pace_that_halves_for_ever_is_seen() {
        assert_eq!(ended(|k| (1.0 + k as f64).ln() / 3000.0, 10.0), Some(16384));
        assert!(ended(|k| (1.0 + k as f64).ln(), 200.0).is_some_and(|k| k < 300_000));
    }

    #[test]
    fn a_pace_that_suffices_or_stays_is_not() {
        assert_eq!(ended(|k| (1.0 + k as f64).ln(), 12.0), None);
        // Too slow, but steadily so: it may become faster.
        assert_eq!(ended(|k| 1e-9 * k as f64, 1.0), None);
        // A rotor that is driven by a constant torque.
        assert_eq!(ended(|k| 1e-6 * (k as f64).sqrt(), 1.0), None);
        // An approach of nine thousand steps.
        let approach = |k: u64| 1.0 - 0.5_f64.powf(k as f64 / 300.0);
        let beyond = |k: u64| 1e-5 * k.saturating_sub(9000) as f64;
        assert_eq!(ended(|k| approach(k) + beyond(k), 2.0), None);
    }

    #[test]
    fn impacts_that_accumulate_do_not_diverge() {
        let time = |k: u64| (1.0 + k as f64).ln() / 3000.0;
        for (weaker, expected) in [(0.99, None), (1.01, Some(16384))] {
            let mut pace = Pace::new(0.0, 10_000_000);
            let mut impulse = 1.0;
            let fails = |&k: &u64| {
                if k % 100 == 0 {
                    impulse *= weaker;
                    pace.strike(k, time(k), impulse);
                }
                pace.fails(k, time(k), 10.0)
            };
            assert_eq!((1..20_000).find(fails), expected);
        }
    }
}
