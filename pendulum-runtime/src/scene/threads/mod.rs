//! Threads: the choice between one thread and all threads for a batch, and the distribution of
//! work.

#[cfg(any(feature = "rayon", test))]
mod pace;

#[cfg(feature = "rayon")]
use pace::{Choice, Way};
#[cfg(feature = "rayon")]
use std::time::Instant;

/// The choice of threads for batches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threads {
    #[cfg(feature = "rayon")]
    choice: Choice,
    /// `true` if every batch forks, regardless of the cost.
    #[cfg(feature = "rayon")]
    always: bool,
}

impl Threads {
    pub(crate) const fn new() -> Self {
        Self {
            #[cfg(feature = "rayon")]
            choice: Choice::new(),
            #[cfg(feature = "rayon")]
            always: false,
        }
    }

    /// Enables or disables forks in every batch, without measurements.
    #[cfg(feature = "rayon")]
    pub(crate) fn set_always(&mut self, always: bool) {
        self.always = always;
    }

    /// Runs `batch`, whose argument is `true` if it may fork, and measures its time.
    /// `pendulum_ticks` is the number of pendulums times the number of ticks.
    #[cfg(feature = "rayon")]
    pub(crate) fn measured<R>(
        &mut self,
        pendulum_ticks: usize,
        batch: impl FnOnce(bool) -> R,
    ) -> R {
        if self.always {
            return batch(0 < pendulum_ticks);
        }
        // Smaller batches are not worth a fork for any equations.
        if pendulum_ticks < 1000 || rayon::current_num_threads() < 2 {
            return batch(false);
        }
        let pendulum_ticks = pendulum_ticks as f64;
        let way = self.choice.way(pendulum_ticks);
        let start = Instant::now();
        let result = batch(way == Way::Together);
        self.choice.took(way, pendulum_ticks, start.elapsed().as_nanos() as f64);
        result
    }

    /// Has no effect without threads.
    #[cfg(not(feature = "rayon"))]
    #[allow(clippy::unused_self)]
    pub(crate) fn set_always(&mut self, _: bool) {}

    /// Runs `batch` on the current thread.
    #[cfg(not(feature = "rayon"))]
    #[allow(clippy::unused_self)]
    pub(crate) fn measured<R>(&mut self, _: usize, batch: impl FnOnce(bool) -> R) -> R {
        batch(false)
    }
}

/// The number of parts per thread, so that fast threads can take parts of slow threads.
#[cfg(feature = "rayon")]
const PARTS: usize = 4;

/// Returns the length of the parts into which `count` items are divided for all threads, at least
/// `least`.
#[cfg(feature = "rayon")]
pub(crate) fn part(count: usize, least: usize) -> usize {
    count.div_ceil(PARTS * rayon::current_num_threads()).max(least)
}

/// Runs `work` for all `parts`, on the current thread and on all other available threads.
#[cfg(feature = "rayon")]
pub(crate) fn share<P: Send>(parts: impl Iterator<Item = P> + Send, work: impl Fn(P) + Sync) {
    use std::sync::{Mutex, PoisonError};
    let parts = Mutex::new(parts);
    let take = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
    let all = || {
        while let Some(part) = take() {
            work(part);
        }
    };
    // The current thread starts without waiting for the other threads.
    rayon::in_place_scope(|scope| {
        for _ in 1..rayon::current_num_threads() {
            scope.spawn(|_| all());
        }
        all();
    });
}

#[cfg(all(test, feature = "rayon"))]
mod tests {
    use super::Threads;

    #[test]
    fn who_asks_for_it_forks_always() {
        let mut threads = Threads::new();
        threads.set_always(true);
        let forks = |threads: &mut Threads, work| {
            (0..100).filter(|_| threads.measured(work, |fork| fork)).count()
        };
        assert_eq!((forks(&mut threads, 1), forks(&mut threads, 1_000_000)), (100, 100));
        // If threads are forbidden, `pendulum_ticks` is zero.
        assert_eq!(forks(&mut threads, 0), 0);
        threads.set_always(false);
        assert_eq!(forks(&mut threads, 1), 0);
    }
}
