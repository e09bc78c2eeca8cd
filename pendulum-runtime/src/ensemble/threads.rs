//! The threads that take part in an ensemble.

/// Does `work` on as many threads as there are, at most `most`.
#[cfg(feature = "rayon")]
pub(super) fn on_all(most: usize, work: impl Fn() + Sync) {
    rayon::in_place_scope(|scope| {
        for _ in 1..rayon::current_num_threads().min(most) {
            scope.spawn(|_| work());
        }
        // This thread does not wait for the others to wake up.
        work();
    });
}

/// Does `work`, alone.
#[cfg(not(feature = "rayon"))]
pub(super) fn on_all(_: usize, work: impl Fn() + Sync) {
    work();
}
