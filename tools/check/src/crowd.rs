//! Many runs on several threads.

use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Runs `job` for each index below `count` on `threads` threads. Returns the results in the order of
/// the indices.
///
/// A bar of progress shows the name of the latest job. It is hidden if stderr is not a terminal.
///
/// # Panics
///
/// Panics if a job panics.
pub fn run<T: Send>(
    count: usize,
    threads: usize,
    name: impl Fn(usize) -> &'static str + Sync,
    job: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let bar = ProgressBar::new(count as u64);
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {elapsed} {eta} {msg}");
    bar.set_style(style.expect("a template"));
    bar.enable_steady_tick(Duration::from_millis(500));
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if count <= index {
                return;
            }
            bar.set_message(name(index));
            let result = job(index);
            results.lock().expect("no job panicked").push((index, result));
            bar.inc(1);
        }
    };
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    bar.finish_and_clear();
    let mut results = results.into_inner().expect("no job panicked");
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}
