//! Output times, dense output and events in lanes equal those of single motions by `Taylor`.

use crate::ways::double;
use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::integrate::{Event, Problem, Status};
use pendulum_runtime::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicU64, Ordering};
use systems::pendulums::Simple;
use systems::problems::Double;

/// Returns a reproducible pseudorandom number from 0 to 1.
pub fn number(k: usize, salt: usize) -> f64 {
    let mixed = (k * 0x9e37_79b9 + salt * 0x85eb_ca6b + 77) as u32;
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2c1b_3c6d);
    f64::from((mixed ^ (mixed >> 12)) >> 8) / f64::from(1u32 << 24)
}

/// Returns a pendulum that swings or turns over. Some problems go back in time, and some have
/// intervals of length zero.
fn simple(k: usize) -> Problem<Simple, 1> {
    let start = 10.0 * number(k, 1) - 5.0;
    let end = if k % 13 == 5 { start } else { start + 40.0 * number(k, 2) - 10.0 };
    Problem {
        system: Simple::new(0.5 + number(k, 3), 0.2 + number(k, 4)),
        time: (start, end),
        q: [6.0 * number(k, 5) - 3.0],
        v: [10.0 * number(k, 6) - 5.0],
    }
}

/// Compares every member, bit by bit, with the same settings of an ensemble and of `solve`.
macro_rules! same {
    ($count:expr, $problem:expr, $($setting:ident ($($value:expr)?)),*) => {{
        let all = Ensemble::new(0..$count, $problem)$(.$setting($($value)?))*;
        let all = all.map(|_, solution| solution.clone()).collect().unwrap();
        let mut failures = all.tally.failures.iter();
        let (mut events, mut states) = (0, 0);
        for (k, member) in all.value.into_iter().enumerate() {
            let Problem { system, time, q, v } = $problem(k);
            let alone = solve(&system, time, q, v).method(Taylor::new())$(.$setting($($value)?))*.run();
            match alone {
                Ok(alone) => {
                    events += alone.events.len();
                    states += alone.len();
                    assert_eq!(member, Some(alone), "member {k}");
                }
                Err(failure) => {
                    assert_eq!(member, None, "member {k}");
                    if let Some(failed) = failures.next() {
                        assert_eq!((failed.index, &failed.error), (k, &Some(failure.error)));
                        assert_eq!(failed.t, failure.partial.end.t);
                    }
                }
            }
        }
        (events, states)
    }};
}
pub(crate) use same;

#[test]
fn outputs() {
    assert!(500 < same!(50, simple, rtol(1e-9), every(0.3)).1);
    assert!(500 < same!(50, simple, rtol(1e-6), every_step()).1);
    assert!(300 < same!(60, double, rtol(1e-12), every(0.21)).1);
    let times = [0.0, 0.2, 0.2, 0.5, 0.99];
    assert_eq!(same!(60, double, t_eval(&times)).1, 300);
    // Outside of the intervals of some members.
    let times = [0.0, 1.05, 1.3];
    assert!(0 < same!(60, double, t_eval(&times)).1);
}

#[test]
fn dense_output() {
    same!(30, simple, rtol(1e-9), dense());
    same!(30, double, dense(), every(0.1));
}

/// Returns the events of a pendulum: both directions, one direction, dips that touch zero and dips
/// that do not.
fn events() -> Vec<Event<'static, f64, 1>> {
    vec![
        Event::new(|_, q, _| q[0]),
        Event::new(|_, _, v| v[0]).falling(),
        Event::new(|_, q, _| q[0] * q[0]),
        Event::new(|t, q, _| q[0] - 0.3 * t.sin()).rising(),
        Event::new(|_, q, v| q[0] * q[0] + v[0] * v[0] - 2.0),
        Event::new(|_, q, _| 5.0 - q[0].cos()),
    ]
}

#[test]
fn events_are_found() {
    for rtol in [1e-3, 1e-6, 1e-9, 1e-13] {
        assert!(200 < same!(60, simple, rtol(rtol), events(events())).0);
    }
    assert!(200 < same!(60, simple, every(0.5), events(events()), max_step(0.4)).0);
    // More events than are evaluated together.
    let many: Vec<_> =
        (0..12).map(|k| Event::new(move |_, q: &[f64; 1], _| q[0] - 0.1 * f64::from(k))).collect();
    assert!(500 < same!(20, simple, events(&many)).0);
}

#[test]
fn terminal_events_end_a_lane() {
    let over = Event::new(|_, q: &[f64; 1], _| q[0] * q[0] - PI * PI).rising().terminal();
    assert!(10 < same!(100, simple, rtol(1e-9), events([over.clone(), events().swap_remove(0)])).0);
    let third = Event::new(|_, q: &[f64; 1], _| q[0]).terminal_after(3);
    assert!(50 < same!(60, simple, dense(), every(0.4), events([third.clone()])).0);
    // An event that starts exactly at zero, and several events together.
    let start = |k: usize| Problem { q: [0.0], ..simple(k) };
    same!(60, start, events([third.clone(), events().swap_remove(2)]));
    let twice = [Event::new(|_, q: &[f64; 1], _| q[0]), Event::new(|_, q, _| 2.0 * q[0])];
    same!(60, simple, events(twice.clone().map(Event::terminal)));
    let [first, second] = twice;
    same!(60, simple, events([first.clone(), second.clone().terminal()]));
}

/// The detector evaluates a function at ten points of a step besides its start, with and without
/// outputs.
#[test]
fn each_step_is_searched_once() {
    let evaluations = |outputs: bool| {
        let count = AtomicU64::new(0);
        let far = Event::new(|t, _: &[f64; 1], _: &[f64; 1]| {
            count.fetch_add(1, Ordering::Relaxed);
            t + 1000.0
        });
        let all = Ensemble::new(0..40, simple).rtol(1e-9).events([far]);
        let all = if outputs { all.every_step() } else { all };
        let steps = all.map(|_, solution| solution.stats.accepted).reduce(|| 0, |a, b| a + b);
        count.into_inner() as f64 / steps.unwrap().value as f64
    };
    for outputs in [false, true] {
        let found = evaluations(outputs);
        assert!((9.5..11.0).contains(&found), "{outputs} {found}");
    }
}

/// Only rounding determines whether the angle reaches the amplitude, once in every period.
#[test]
fn functions_that_graze_zero() {
    let top = |k: usize| Problem { q: [1.2], v: [0.0], ..simple(k) };
    let reaches = Event::new(|_, q: &[f64; 1], _| q[0] - 1.2);
    let both = Event::new(|_, q: &[f64; 1], _| q[0] * q[0] - 1.44);
    let mut found = 0;
    for rtol in [1e-4, 1e-9, 1e-13] {
        let one = [reaches.clone().rising(), reaches.clone().falling(), both.clone().rising()];
        same!(60, top, rtol(rtol), events(&one));
        found += same!(60, top, rtol(rtol), events([reaches.clone(), both.clone()])).0;
    }
    assert!(200 < found, "{found}");
    same!(60, top, events([both.clone().touching(0.0)]));
    let third = [both.terminal_after(3), reaches];
    same!(60, top, events(&third));
}

#[test]
fn functions_that_fail_end_a_lane() {
    let root = Event::new(|_, q: &[f64; 1], _| (2.5 - q[0]).sqrt() - 0.1);
    same!(60, simple, events([root.clone()]));
    let near = Event::new(|_, q: &[f64; 1], _| q[0]).touching(1e-3);
    same!(60, simple, events([near.clone()]), max_steps(9));
}

#[test]
fn flips_of_double_pendulums() {
    let flip = Event::new(|_, q: &[f64; 2], _| (0.5 * q[1]).cos()).terminal();
    let start = |k: usize| Problem {
        system: Double::new([1.0; 2], [1.0; 2], 9.81),
        time: (0.0, 10.0),
        q: [1.5 + 0.2 * (k % 8) as f64, 2.0 + 0.3 * (k / 8) as f64],
        v: [0.0; 2],
    };
    let statuses = Ensemble::new(0..32, start).rtol(1e-9).events([flip.clone()]);
    let statuses = statuses.map(|_, solution| solution.status).collect().unwrap().value;
    let flipped = statuses.iter().filter(|status| **status == Some(Status::Event(0))).count();
    assert!(8 < flipped && flipped <= 32, "{flipped}");
    assert!(8 < same!(32, start, rtol(1e-9), events([flip.clone()])).0);
}
