//! Threads of ensembles.

/// Runs `work` on all threads, at most `most`.
#[cfg(feature = "rayon")]
pub(super) fn on_all(most: usize, work: impl Fn() + Sync) {
    rayon::in_place_scope(|scope| {
        for _ in 1..rayon::current_num_threads().min(most) {
            scope.spawn(|_| work());
        }
        // The current thread starts without waiting for the other threads.
        work();
    });
}

/// Runs `work` on the current thread.
#[cfg(not(feature = "rayon"))]
pub(super) fn on_all(_: usize, work: impl Fn() + Sync) {
    work();
}
