//! Threads: the choice between one thread and all threads for a batch of ticks, and the
//! distribution of work.
//!
//! A fork wakes sleeping threads, which takes as long as the computation of a thousand pendulums,
//! or of a million pendulums if other programs use the same cores. This time is not known in
//! advance, so it is measured. The result has the same bits either way.

use std::time::Instant;

/// Returns the number of threads, which is 1 without the feature `rayon`.
fn available() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    1
}

/// The choice of threads for batches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threads {
    choice: Choice,
    /// `true` if every batch forks, regardless of the cost.
    pub(crate) always: bool,
}

impl Threads {
    pub(crate) const fn new() -> Self {
        Self { choice: Choice::new(), always: false }
    }

    /// Runs `batch`, whose argument is `true` if it may fork, and measures its time.
    /// `pendulum_ticks` is the number of pendulums times the number of ticks.
    pub(crate) fn measured(&mut self, pendulum_ticks: usize, batch: impl FnOnce(bool)) {
        if self.always {
            return batch(0 < pendulum_ticks);
        }
        // Smaller batches are not worth a fork for any equations.
        if pendulum_ticks < 1000 || available() < 2 {
            return batch(false);
        }
        let pendulum_ticks = pendulum_ticks as f64;
        let way = self.choice.way(pendulum_ticks);
        let start = Instant::now();
        batch(way == Way::Together);
        self.choice.took(way, pendulum_ticks, start.elapsed().as_nanos() as f64);
    }
}

/// Returns the length of the parts into which `count` items are divided: all of them without a
/// fork, or if two parts would have fewer than `least` each. There are four parts for each thread,
/// so that fast threads can take parts of slow threads.
pub(crate) fn part(count: usize, least: usize, fork: bool) -> usize {
    if fork && 2 * least <= count && cfg!(feature = "rayon") {
        count.div_ceil(4 * available()).max(least)
    } else {
        count.max(1)
    }
}

/// Runs `work` for all `parts`, on all threads if there are several parts.
pub(crate) fn share<P: Send>(
    parts: impl ExactSizeIterator<Item = P> + Send,
    work: impl Fn(P) + Sync,
) {
    #[cfg(feature = "rayon")]
    if 1 < parts.len() {
        use std::sync::{Mutex, PoisonError};
        let parts = Mutex::new(parts);
        let take = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
        let all = || {
            while let Some(part) = take() {
                work(part);
            }
        };
        // The current thread starts without waiting for the other threads.
        return rayon::in_place_scope(|scope| {
            for _ in 1..rayon::current_num_threads() {
                scope.spawn(|_| all());
            }
            all();
        });
    }
    parts.for_each(work);
}

/// The least time of a batch on one thread that is worth a fork, in nanoseconds.
const LEAST: f64 = 200_000.0;

/// The number of consecutive batches in a trial of the other way: the first batch wakes the
/// threads, the second batch shows their speed.
const TRIAL: u32 = 2;

/// Trials of one thread are skipped if all threads take less than `CLEAR` times the time of one
/// thread, because a trial would delay a frame. They are not skipped if the time of all threads has
/// changed by a factor of more than `WORSE` since the last comparison.
const CLEAR: f64 = 0.5;
const WORSE: f64 = 1.25;

/// The maximum number of consecutive skipped trials.
const MOST_SPARED: u32 = 8;

/// The initial and the maximum number of batches from one trial to the next. The number doubles
/// after each trial that does not change the choice.
const SOON: u32 = 32;
const LATE: u32 = 1024;

/// A way to run a batch: on one thread or on all threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Alone,
    Together,
}

/// The measurements that determine the choice between one thread and all threads.
#[derive(Clone, Copy, Debug)]
struct Choice {
    /// The nanoseconds per pendulum and tick on one thread and on all threads; 0 if unknown.
    pace: [f64; 2],
    /// The better way in the previous batch.
    better: Way,
    /// The pace on all threads at the last comparison of both ways.
    compared: f64,
    /// The number of batches until the end of the next trial.
    left: u32,
    /// The number of batches from one trial to the next.
    period: u32,
    /// The number of trials skipped since the last trial.
    spared: u32,
}

impl Choice {
    const fn new() -> Self {
        Self {
            pace: [0.0; 2],
            better: Way::Alone,
            compared: 0.0,
            left: SOON,
            period: SOON,
            spared: 0,
        }
    }

    /// Chooses the way for a batch. `pendulum_ticks` is the number of pendulums times the number of
    /// ticks.
    fn way(&mut self, pendulum_ticks: f64) -> Way {
        let [alone, together] = self.pace;
        if alone == 0.0 || alone * pendulum_ticks < LEAST {
            return Way::Alone;
        }
        if together == 0.0 {
            return Way::Together;
        }
        // A smaller gain may be chance, and does not justify the use of more cores.
        let better = if together < 0.8 * alone { Way::Together } else { Way::Alone };
        if better != self.better {
            (self.better, self.period, self.compared) = (better, SOON, together);
            self.left = self.left.min(SOON);
        }
        let clear = better == Way::Together && together < CLEAR * alone;
        // If this pace has changed, the pace on one thread may have changed as well.
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

    /// Updates the pace of `way` with the time of a batch.
    fn took(&mut self, way: Way, pendulum_ticks: f64, nanoseconds: f64) {
        let (pace, now) = (&mut self.pace[way as usize], nanoseconds / pendulum_ticks);
        // An interruption can be a thousand times as long as a batch, so the pace grows by at most
        // a quarter per batch. A lasting change is adopted after a few batches.
        *pace =
            if *pace == 0.0 || now < *pace { now } else { *pace + 0.25 * (now - *pace).min(*pace) };
    }
}

#[cfg(test)]
mod tests {
    use super::{Choice, LATE, LEAST, SOON, TRIAL, Threads, Way};

    /// Returns the fraction of `batches` that use all threads, if a pendulum and tick takes `alone`
    /// and `together` nanoseconds in the two ways.
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
        // Other programs start to use the cores.
        assert!(share_together(&mut choice, 10_000, 1e5, 10.0, 15.0) < 0.02);
        // The other programs end; the next trial detects it.
        share_together(&mut choice, 2 * LATE, 1e5, 10.0, 6.0);
        assert!(0.95 < share_together(&mut choice, 10_000, 1e5, 10.0, 6.0));
    }

    #[test]
    fn the_clearly_slower_way_is_tried_once_in_nine_periods() {
        let mut choice = Choice::new();
        share_together(&mut choice, 4 * SOON, 1e5, 10.0, 2.0);
        // One trial of two batches in nine periods.
        let least = 1.0 - f64::from(TRIAL * 12) / f64::from(100 * LATE);
        let share = share_together(&mut choice, 100 * LATE, 1e5, 10.0, 2.0);
        assert!(least < share && share < 1.0, "{share}");
        // A slightly slower pace does not cause a trial, nor does an interruption.
        choice.took(Way::Together, 1e5, 1e9);
        assert!(least < share_together(&mut choice, 100 * LATE, 1e5, 10.0, 2.4));
        // A pace slower by a quarter causes a trial, which shows that one thread has become faster.
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
        // One thread is much faster now; the pace on all threads is almost unchanged.
        share_together(&mut choice, 10 * LATE, 1e6, 1.0, 3.9);
        assert!(share_together(&mut choice, 10_000, 1e6, 1.0, 3.9) < 0.02);
    }

    #[test]
    fn who_asks_for_it_forks_always() {
        let mut threads = Threads::new();
        threads.always = true;
        let forks = |threads: &mut Threads, work| {
            let mut forks = 0;
            for _ in 0..100 {
                threads.measured(work, |fork| forks += u32::from(fork));
            }
            forks
        };
        assert_eq!((forks(&mut threads, 1), forks(&mut threads, 1_000_000)), (100, 100));
        // If threads are forbidden, `pendulum_ticks` is zero.
        assert_eq!(forks(&mut threads, 0), 0);
        threads.always = false;
        assert_eq!(forks(&mut threads, 1), 0);
    }
}
