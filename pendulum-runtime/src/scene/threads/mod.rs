//! Batches of ticks on one thread or on all.

#[cfg(any(feature = "rayon", test))]
mod pace;

#[cfg(feature = "rayon")]
use pace::{Choice, Way};
#[cfg(feature = "rayon")]
use std::time::Instant;

/// The threads that batches are given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threads {
    #[cfg(feature = "rayon")]
    choice: Choice,
    /// Every batch forks, whatever that costs.
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

    /// Forks for every batch and measures nothing, or chooses again.
    #[cfg(feature = "rayon")]
    pub(crate) fn set_always(&mut self, always: bool) {
        self.always = always;
    }

    /// Does `batch`, which takes so many pendulums through so many ticks; it is told whether to
    /// fork.
    #[cfg(feature = "rayon")]
    pub(crate) fn measured<R>(
        &mut self,
        pendulum_ticks: usize,
        batch: impl FnOnce(bool) -> R,
    ) -> R {
        if self.always {
            return batch(0 < pendulum_ticks);
        }
        // Less than this is not worth a fork whatever the equations are.
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

    /// Without threads nothing forks.
    #[cfg(not(feature = "rayon"))]
    #[allow(clippy::unused_self)]
    pub(crate) fn set_always(&mut self, _: bool) {}

    /// Does `batch`, alone.
    #[cfg(not(feature = "rayon"))]
    #[allow(clippy::unused_self)]
    pub(crate) fn measured<R>(&mut self, _: usize, batch: impl FnOnce(bool) -> R) -> R {
        batch(false)
    }
}

/// The number of parts for each thread: who is late leaves some to the others.
#[cfg(feature = "rayon")]
const PARTS: usize = 4;

/// The length of the parts that `count` things are divided into for all threads, at least `least`.
#[cfg(feature = "rayon")]
pub(crate) fn part(count: usize, least: usize) -> usize {
    count.div_ceil(PARTS * rayon::current_num_threads()).max(least)
}

/// Does `work` for all `parts`, on this thread and on all others that have time.
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
    // This thread does not wait for the others to wake up.
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
        // Forbidden threads have no work.
        assert_eq!(forks(&mut threads, 0), 0);
        threads.set_always(false);
        assert_eq!(forks(&mut threads, 1), 0);
    }
}
