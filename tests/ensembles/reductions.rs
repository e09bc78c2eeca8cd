//! Reductions have the same bits in any order of work.

use crate::ways::double;
use pendulum_runtime::ensemble::{Ensemble, Gathered};
use pendulum_runtime::integrate::Problem;
use std::ops::ControlFlow;

/// Computes a sum whose bits depend on the order of the additions, and the list of the members in
/// their order.
fn sums(n: usize) -> Gathered<(f64, Vec<usize>)> {
    let ensemble = Ensemble::new(0..n, double).rtol(1e-9);
    ensemble
        .map(|k, solution| (solution.end.q[0].sin() * solution.end.v[1], k))
        .fold(
            || (0.0, Vec::new()),
            |(sum, mut members), (value, k)| {
                members.push(k);
                (sum + value, members)
            },
            |(sum, mut members), (later, more)| {
                members.extend(more);
                (sum + later, members)
            },
        )
        .unwrap()
}

#[test]
fn members_are_folded_in_order() {
    for n in [0, 1, 8, 100, 300] {
        let gathered = sums(n);
        assert_eq!(gathered.value.1, (0..n).collect::<Vec<_>>());
        assert_eq!((gathered.tally.members, gathered.cancelled), (n as u64, false));
    }
}

#[test]
fn the_tree_is_that_of_shards_of_a_known_size() {
    let values: Vec<f64> = Ensemble::new(0..50, double)
        .map(|_, solution| solution.end.v[0])
        .collect()
        .unwrap()
        .value
        .into_iter()
        .flatten()
        .collect();
    let tree = Ensemble::new(0..50, double).shard(10).map(|_, solution| solution.end.v[0]);
    let tree = tree.reduce(|| 0.0, |a, b| a + b).unwrap().value;
    let part: Vec<f64> =
        values.chunks(10).map(|shard| shard.iter().fold(0.0, |a, b| a + b)).collect();
    assert_eq!(tree, ((part[0] + part[1]) + (part[2] + part[3])) + part[4]);
}

#[test]
fn each_member_is_given_once() {
    let mut seen = vec![0; 123];
    let each = Ensemble::new(0..123, double).map(|k, solution| (k, solution.end.t));
    each.for_each(|k, (same, t)| {
        assert_eq!((k, t), (same, double(k).time.1));
        seen[k] += 1;
    })
    .unwrap();
    assert!(seen.iter().all(|&count| count == 1));
}

#[test]
fn progress_is_told_and_cancels() {
    let mut seen = Vec::new();
    let all = Ensemble::new(0..100, double).shard(10).map(|k, _| k);
    let all = all.on_progress(|progress| {
        seen.push((progress.members, progress.shards, progress.progress()));
        ControlFlow::Continue(())
    });
    assert!(!all.collect().unwrap().cancelled);
    assert_eq!(seen.len(), 10);
    assert_eq!(seen[9], (100, 10, 1.0));

    let some = Ensemble::new(0..1000, double).shard(10).map(|k, _| k);
    let some = some.on_progress(|progress| {
        if progress.shards < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let some = some.collect().unwrap();
    assert!(some.cancelled && some.tally.members < 1000);
    assert_eq!(some.value.iter().flatten().count() as u64, some.tally.members);
}

#[test]
fn problems_are_made_one_by_one() {
    // A list of all problems would exceed the memory.
    let all = Ensemble::new(0..usize::MAX, |k| Problem { time: (0.0, 0.0), ..double(k) });
    let mut count = 0;
    let all = all.map(|_, _| ()).on_progress(|_| {
        count += 1;
        if count < 10 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert!(all.reduce(|| (), |(), ()| ()).unwrap().cancelled);
}
