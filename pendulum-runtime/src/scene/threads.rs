//! Whether a batch of ticks is worth more than one thread.
//!
//! A fork wakes threads that sleep, which takes as long as a thousand pendulums or, where others
//! want the same cores, a million. How long nobody knows beforehand, so it is measured: the same
//! bits come out either way.

#[cfg(feature = "rayon")]
use std::time::Instant;

/// Nanoseconds that a batch has to take alone to be worth a fork.
const LEAST: f64 = 200_000.0;

/// Batches are tried the other way in pairs: the first wakes the threads, the second shows what
/// they can do.
const TRIAL: u32 = 2;

/// The batches from one trial to the next, at first and at most: each trial that shows nothing new
/// doubles them.
const SOON: u32 = 32;
const LATE: u32 = 1024;

/// How a batch goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Alone,
    Together,
}

/// The choice between one thread and all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Threads {
    /// Nanoseconds for a pendulum and tick alone and together; 0 as long as nobody knows.
    pace: [f64; 2],
    /// The better way when it was last looked at.
    better: Way,
    /// The batches until the next trial; those of the trial are the last.
    left: u32,
    /// The batches from one trial to the next.
    period: u32,
    /// Whether every batch forks, whatever that costs.
    #[cfg_attr(not(feature = "rayon"), allow(dead_code))]
    always: bool,
}

impl Threads {
    pub(super) const fn new() -> Self {
        Self { pace: [0.0; 2], better: Way::Alone, left: SOON, period: SOON, always: false }
    }

    /// Forks for every batch and measures nothing, or chooses again.
    pub(super) fn set_always(&mut self, always: bool) {
        self.always = always;
    }

    /// How to go through so many pendulums times ticks.
    #[cfg_attr(not(feature = "rayon"), allow(dead_code))]
    fn way(&mut self, pendulum_ticks: f64) -> Way {
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
            (self.better, self.period) = (better, SOON);
            self.left = self.left.min(SOON);
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
    #[cfg_attr(not(feature = "rayon"), allow(dead_code))]
    fn took(&mut self, way: Way, pendulum_ticks: f64, nanoseconds: f64) {
        let (pace, now) = (&mut self.pace[way as usize], nanoseconds / pendulum_ticks);
        // An interruption may take a thousand times as long and says nothing; what lasts is
        // believed after a few batches.
        *pace = if *pace == 0.0 || now < *pace { now } else { *pace + 0.25 * (now - *pace).min(*pace) };
    }

    /// Does `batch`, which takes so many pendulums through so many ticks; it is told whether to
    /// fork.
    #[cfg(feature = "rayon")]
    pub(super) fn measured<R>(&mut self, pendulum_ticks: usize, batch: impl FnOnce(bool) -> R) -> R {
        if self.always {
            return batch(0 < pendulum_ticks);
        }
        // Less than this is not worth a fork whatever the equations are.
        if pendulum_ticks < 1000 || rayon::current_num_threads() < 2 {
            return batch(false);
        }
        let pendulum_ticks = pendulum_ticks as f64;
        let way = self.way(pendulum_ticks);
        let start = Instant::now();
        let result = batch(way == Way::Together);
        self.took(way, pendulum_ticks, start.elapsed().as_nanos() as f64);
        result
    }

    /// Does `batch`, alone.
    #[cfg(not(feature = "rayon"))]
    #[allow(clippy::unused_self)]
    pub(super) fn measured<R>(&mut self, _: usize, batch: impl FnOnce(bool) -> R) -> R {
        batch(false)
    }
}

/// The number of parts for each thread: who is late leaves some to the others.
#[cfg(feature = "rayon")]
const PARTS: usize = 4;

/// The length of the parts that `count` things are divided into for all threads, at least `least`.
#[cfg(feature = "rayon")]
pub(super) fn part(count: usize, least: usize) -> usize {
    count.div_ceil(PARTS * rayon::current_num_threads()).max(least)
}

/// Does `work` for all `parts`, on this thread and on all others that have time.
#[cfg(feature = "rayon")]
pub(super) fn share<P: Send>(parts: impl Iterator<Item = P> + Send, work: impl Fn(P) + Sync) {
    use std::sync::{Mutex, PoisonError};
    let parts = Mutex::new(parts);
    let take = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
    let all = || {
        while let Some(part) = take() {
            work(part);
        }
    };
    // This thread does not wait for the others to wake up.
    rayon::in_place_scope(|scope| {
        for _ in 1..rayon::current_num_threads() {
            scope.spawn(|_| all());
        }
        all();
    });
}

#[cfg(test)]
mod tests {
    use super::{LATE, LEAST, Threads, Way};

    /// The parts of `batches` that went together where the two ways take so many nanoseconds a
    /// pendulum and tick.
    fn share_together(threads: &mut Threads, batches: u32, pendulum_ticks: f64, alone: f64, together: f64) -> f64 {
        let mut count = 0;
        for _ in 0..batches {
            let way = threads.way(pendulum_ticks);
            count += u32::from(way == Way::Together);
            threads.took(way, pendulum_ticks, pendulum_ticks * if way == Way::Together { together } else { alone });
        }
        f64::from(count) / f64::from(batches)
    }

    #[test]
    #[cfg(feature = "rayon")]
    fn who_asks_for_it_forks_always() {
        let mut threads = Threads::new();
        threads.set_always(true);
        let forks = |threads: &mut Threads, work| (0..100).filter(|_| threads.measured(work, |fork| fork)).count();
        assert_eq!((forks(&mut threads, 1), forks(&mut threads, 1_000_000)), (100, 100));
        // Where threads are forbidden there is no work for them.
        assert_eq!(forks(&mut threads, 0), 0);
        threads.set_always(false);
        assert_eq!(forks(&mut threads, 1), 0);
    }

    #[test]
    fn small_batches_go_alone() {
        let mut threads = Threads::new();
        assert_eq!(share_together(&mut threads, 1000, 0.9 * LEAST / 10.0, 10.0, 5.0), 0.0);
    }

    #[test]
    fn the_quicker_way_is_taken_and_the_other_tried_seldom() {
        let mut threads = Threads::new();
        assert!(0.95 < share_together(&mut threads, 10_000, 1e5, 10.0, 6.0));
        // Others come and want the cores.
        assert!(share_together(&mut threads, 10_000, 1e5, 10.0, 15.0) < 0.02);
        // And go again: that is noticed at the next trial.
        share_together(&mut threads, 2 * LATE, 1e5, 10.0, 6.0);
        assert!(0.95 < share_together(&mut threads, 10_000, 1e5, 10.0, 6.0));
    }

    #[test]
    fn interruptions_change_nothing() {
        let mut threads = Threads::new();
        share_together(&mut threads, 1000, 1e5, 10.0, 6.0);
        threads.took(Way::Together, 1e5, 1e9);
        assert!(0.95 < share_together(&mut threads, 1000, 1e5, 10.0, 6.0));
    }
}
