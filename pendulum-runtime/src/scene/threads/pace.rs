//! Choice between one thread and all for a batch of ticks.
//!
//! A fork wakes threads that sleep, which takes as long as a thousand pendulums or, where others
//! want the same cores, a million. How long nobody knows beforehand, so it is measured: the same
//! bits come out either way.

/// Nanoseconds that a batch has to take alone to be worth a fork.
const LEAST: f64 = 200_000.0;

/// Batches are tried the other way in pairs: the first wakes the threads, the second shows what
/// they can do.
const TRIAL: u32 = 2;

/// The way alone is tried no more where together takes less than this part of its time, as long as
/// that is not so many times what it was at the comparison: a trial would be a frame that is late.
const CLEAR: f64 = 0.5;
const WORSE: f64 = 1.25;

/// The most trials in turn that are left out.
const MOST_SPARED: u32 = 8;

/// The batches from one trial to the next, at first and at most: each trial that shows nothing new
/// doubles them.
const SOON: u32 = 32;
const LATE: u32 = 1024;

/// Ways to run a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Alone,
    Together,
}

/// The choice between one thread and all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// Nanoseconds for a pendulum and tick alone and together; 0 as long as nobody knows.
    pace: [f64; 2],
    /// The better way when it was last looked at.
    better: Way,
    /// The pace together when both ways were last compared.
    compared: f64,
    /// The batches until the next trial; those of the trial are the last.
    left: u32,
    /// The batches from one trial to the next.
    period: u32,
    /// The trials that were left out since the last one.
    spared: u32,
}

impl Choice {
    pub(crate) const fn new() -> Self {
        Self {
            pace: [0.0; 2],
            better: Way::Alone,
            compared: 0.0,
            left: SOON,
            period: SOON,
            spared: 0,
        }
    }

    /// Chooses the way for so many pendulums times ticks.
    pub(crate) fn way(&mut self, pendulum_ticks: f64) -> Way {
        let [alone, together] = self.pace;
        if alone == 0.0 || alone * pendulum_ticks < LEAST {
            return Way::Alone;
        }
        if together == 0.0 {
            return Way::Together;
        }
        // Less is not worth the cores of others, and may be chance.
        let better = if together < 0.8 * alone { Way::Together } else { Way::Alone };
        if better != self.better {
            (self.better, self.period, self.compared) = (better, SOON, together);
            self.left = self.left.min(SOON);
        }
        let clear = better == Way::Together && together < CLEAR * alone;
        // The pace alone may have become another, too.
        let alike = together < WORSE * self.compared && self.compared < WORSE * together;
        if self.left == TRIAL && clear && alike && self.spared < MOST_SPARED {
            (self.left, self.spared) = (0, self.spared + 1);
        } else if self.left == 0 {
            (self.compared, self.spared) = (together, 0);
        }
        if self.left == 0 {
            self.period = (2 * self.period).min(LATE);
            self.left = self.period;
        }
        self.left -= 1;
        match better {
            Way::Alone if self.left < TRIAL => Way::Together,
            Way::Together if self.left < TRIAL => Way::Alone,
            better => better,
        }
    }

    /// Takes in how long a batch has taken.
    pub(crate) fn took(&mut self, way: Way, pendulum_ticks: f64, nanoseconds: f64) {
        let (pace, now) = (&mut self.pace[way as usize], nanoseconds / pendulum_ticks);
        // An interruption may take a thousand times as long and says nothing; what lasts is
        // believed after a few batches.
        *pace =
            if *pace == 0.0 || now < *pace { now } else { *pace + 0.25 * (now - *pace).min(*pace) };
    }
}

#[cfg(test)]
mod tests {
    use super::{Choice, LATE, LEAST, SOON, TRIAL, Way};

    /// The parts of `batches` that went together where the two ways take so many nanoseconds a
    /// pendulum and tick.
    fn share_together(
        choice: &mut Choice,
        batches: u32,
        pendulum_ticks: f64,
        alone: f64,
        together: f64,
    ) -> f64 {
        let mut count = 0;
        for _ in 0..batches {
            let way = choice.way(pendulum_ticks);
            count += u32::from(way == Way::Together);
            choice.took(
                way,
                pendulum_ticks,
                pendulum_ticks * if way == Way::Together { together } else { alone },
            );
        }
        f64::from(count) / f64::from(batches)
    }

    #[test]
    fn small_batches_go_alone() {
        let mut choice = Choice::new();
        assert_eq!(share_together(&mut choice, 1000, 0.9 * LEAST / 10.0, 10.0, 5.0), 0.0);
    }

    #[test]
    fn the_quicker_way_is_taken_and_the_other_tried_seldom() {
        let mut choice = Choice::new();
        assert!(0.95 < share_together(&mut choice, 10_000, 1e5, 10.0, 6.0));
        // Other programs come and want the cores.
        assert!(share_together(&mut choice, 10_000, 1e5, 10.0, 15.0) < 0.02);
        // And go again: that is noticed at the next trial.
        share_together(&mut choice, 2 * LATE, 1e5, 10.0, 6.0);
        assert!(0.95 < share_together(&mut choice, 10_000, 1e5, 10.0, 6.0));
    }

    #[test]
    fn the_clearly_slower_way_is_tried_once_in_nine_periods() {
        let mut choice = Choice::new();
        share_together(&mut choice, 4 * SOON, 1e5, 10.0, 2.0);
        // Two batches a trial, of which nine periods have one.
        let least = 1.0 - f64::from(TRIAL * 12) / f64::from(100 * LATE);
        let share = share_together(&mut choice, 100 * LATE, 1e5, 10.0, 2.0);
        assert!(least < share && share < 1.0, "{share}");
        // A little worse is no reason yet, and an interruption none that lasts.
        choice.took(Way::Together, 1e5, 1e9);
        assert!(least < share_together(&mut choice, 100 * LATE, 1e5, 10.0, 2.4));
        // A quarter worse is one; alone has become quicker too, which only a trial shows.
        share_together(&mut choice, 2 * LATE, 1e5, 1.0, 3.2);
        assert!(share_together(&mut choice, 10_000, 1e5, 1.0, 3.2) < 0.02);
    }

    #[test]
    fn interruptions_change_nothing() {
        let mut choice = Choice::new();
        share_together(&mut choice, 1000, 1e5, 10.0, 6.0);
        choice.took(Way::Together, 1e5, 1e9);
        assert!(0.95 < share_together(&mut choice, 1000, 1e5, 10.0, 6.0));
    }

    #[test]
    fn a_lighter_scene_goes_alone_again() {
        let mut choice = Choice::new();
        assert!(0.95 < share_together(&mut choice, 10_000, 1e6, 10.0, 4.0));
        // Alone is much quicker now, and together as it was.
        share_together(&mut choice, 10 * LATE, 1e6, 1.0, 3.9);
        assert!(share_together(&mut choice, 10_000, 1e6, 1.0, 3.9) < 0.02);
    }
}
