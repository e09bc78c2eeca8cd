//! A watchdog that ends the program if a case hangs.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The running case.
type Running = Arc<Mutex<Option<(&'static str, u64, Instant)>>>;

/// A thread that checks the running case once a second.
pub(crate) struct Watch {
    running: Running,
}

impl Watch {
    /// Starts the thread. A case that takes longer than `limit` is reported and ends the program.
    pub(crate) fn start(limit: Duration) -> Self {
        let running = Running::default();
        let seen = Arc::clone(&running);
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                let case = *seen.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some((target, seed, start)) = case
                    && limit < start.elapsed()
                {
                    println!(
                        "--only {target} --seed {seed} --count 1: hangs for {:.0} s",
                        start.elapsed().as_secs_f64()
                    );
                    std::process::exit(1);
                }
            }
        });
        Self { running }
    }

    pub(crate) fn begin(&self, target: &'static str, seed: u64) {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) =
            Some((target, seed, Instant::now()));
    }

    pub(crate) fn end(&self) {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}
