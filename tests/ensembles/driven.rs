//! Driven members in lanes have the bits of single motions by `Taylor`: smooth motions, breaks and
//! kinks.

use crate::lanes::{number, same};
use crate::ways::OnJoint;
use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Batch, Event, Problem};
use pendulum_runtime::motion::{Curve, Function, Sinusoid};
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A pendulum on a joint in the plane and with a wind, both known beforehand.
    #[derive(Clone, Debug)]
    pub struct Blown { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    driven w: N;
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y) - w*y.x;
}

/// Returns the keys of a joint, half a second apart.
fn keys() -> (Vec<f64>, Vec<[f64; 1]>) {
    let keys = (0..12).map(|k| (0.5 * f64::from(k), [0.4 * number(k as usize, 9)]));
    keys.unzip()
}

/// Returns a pendulum of random length and start on `joint`; some pendulums go back in time.
fn on<M: Clone>(joint: M, k: usize) -> Problem<Driven<OnJoint, (M,)>, 1>
where
    Driven<OnJoint, (M,)>: pendulum_runtime::system::Dynamics<1, Scalar = f64>,
{
    let (start, length) = (0.1 + number(k, 1), 1.0 + 4.0 * number(k, 2));
    let time = if k % 5 == 3 { (start + length, start) } else { (start, start + length) };
    Problem {
        system: Driven { system: OnJoint::new(0.3 + number(k, 3)), motions: (joint,) },
        time,
        q: [4.0 * number(k, 4) - 2.0],
        v: [number(k, 5)],
    }
}

/// Compares all kinds of outputs, with and without events, with single motions.
macro_rules! all_settings {
    ($problem:expr) => {{
        let zero = Event::new(|_, q: &[f64; 1], _| q[0]);
        let still = Event::new(|_, _: &[f64; 1], v: &[f64; 1]| v[0]);
        let third = zero.clone().terminal_after(3);
        assert!(300 < same!(60, $problem, rtol(1e-9), every(0.1)).1);
        assert!(300 < same!(60, $problem, rtol(1e-6), every_step()).1);
        same!(30, $problem, rtol(1e-12), dense(), every(0.2));
        assert!(100 < same!(60, $problem, rtol(1e-10), events([zero.clone(), still.clone()])).0);
        assert!(60 < same!(60, $problem, rtol(1e-7), events([third.clone(), still.clone()])).0);
        same!(30, $problem, rtol(1e-9), max_steps(12));
        same!(30, $problem, rtol(1e-9), first_step(1e-3), max_step(0.07));
    }};
}

#[test]
fn smooth_motions() {
    all_settings!(|k| on(Sinusoid::new([0.1], 6.0, [0.3]), k));
}

#[test]
fn motions_with_breaks() {
    let (times, places) = keys();
    all_settings!(|k| on(Curve::spline(&times, &places).unwrap(), k));
}

#[test]
fn motions_whose_accelerations_jump() {
    let (times, places) = keys();
    all_settings!(|k| on(Curve::catmull_rom(&times, &places).unwrap(), k));
}

#[test]
fn motions_whose_velocities_jump() {
    let (times, places) = keys();
    all_settings!(|k| on(Curve::linear(&times, &places).unwrap(), k));
}

/// `Picard` does not use series.
#[test]
fn another_method_comes_to_the_same_ends() {
    let (times, places) = keys();
    let lines = Curve::linear(&times, &places).unwrap();
    let problem = |k: usize| {
        let Problem { system, time, q, v } = on(lines.clone(), k);
        Problem { system, time: (f64::min(time.0, time.1), f64::max(time.0, time.1)), q, v }
    };
    let end = |_: usize, solution: &Solution<f64, 1>| (solution.end, solution.stats.kinks);
    let lanes = Ensemble::new(0..60, problem).rtol(1e-12).map(end).collect().unwrap().value;
    let alone = Ensemble::new(0..60, problem).rtol(1e-12).method(Picard).map(end);
    let mut most = 0;
    for (k, (one, other)) in lanes.into_iter().zip(alone.collect().unwrap().value).enumerate() {
        let ((one, kinks), (other, expected)) = (one.unwrap(), other.unwrap());
        assert_eq!(kinks, expected, "member {k}");
        most = kinks.max(most);
        let error = (one.q[0] - other.q[0]).abs().max((one.v[0] - other.v[0]).abs());
        assert!(error < 1e-9, "member {k}: {error:e}");
    }
    assert!(5 < most);
}

/// Tests two inputs of several components, with motions that differ between members.
#[test]
fn each_member_has_its_own_motions() {
    let (times, places) = keys();
    let problem = |k: usize| {
        let joint = Sinusoid::new([0.1 * number(k, 1), 0.05], 2.0 + 5.0 * number(k, 2), [0.0, 0.4]);
        let wind: Vec<_> = places.iter().map(|[x]| [x * number(k, 3)]).collect();
        let wind = Curve::linear(&times, &wind).unwrap();
        let system = Blown::new(0.5, 0.3 + number(k, 4)).driven_by(joint, wind);
        Problem { system, time: (0.0, 5.0), q: [number(k, 5)], v: [0.0] }
    };
    assert!(300 < same!(40, problem, rtol(1e-10), every(0.5)).1);
    assert!(300 < same!(40, problem, rtol(1e-6), every_step()).1);
}

#[test]
fn neighbours_and_lengths_of_shards_change_nothing() {
    let (times, places) = keys();
    let lines = Curve::catmull_rom(&times, &places).unwrap();
    let problems: Vec<_> = (0..40).map(|k| on(lines.clone(), k)).collect();
    let together = Batch::new().rtol(1e-11).run(&problems).unwrap();
    let backwards: Vec<_> = problems.iter().rev().cloned().collect();
    let reversed = Batch::new().rtol(1e-11).run(&backwards).unwrap();
    for (k, outcome) in together.iter().enumerate() {
        let alone = Batch::new().rtol(1e-11).run(&problems[k..=k]).unwrap().remove(0);
        let outcome = outcome.as_ref().unwrap();
        assert_eq!(outcome, &alone.unwrap(), "member {k}");
        assert_eq!(outcome, reversed[39 - k].as_ref().unwrap(), "member {k}");
    }
    let all = Ensemble::new(0..40, |k| on(lines.clone(), k)).rtol(1e-11).shard(3);
    let all = all.map(|_, solution| solution.clone()).collect().unwrap().value;
    for (member, outcome) in all.into_iter().zip(together) {
        assert_eq!(member, outcome.ok());
    }
}

#[test]
fn motions_without_series_go_one_by_one() {
    let problem = |k: usize| {
        let swing = Function::new(|t: f64| [0.1 * t.sin()])
            .velocity(|t: f64| [0.1 * t.cos()])
            .acceleration(|t: f64| [-0.1 * t.sin()]);
        let system = OnJoint::new(0.5).driven_by(swing);
        Problem { system, time: (0.0, 3.0), q: [0.1 * k as f64], v: [0.0] }
    };
    let all = Ensemble::new(0..20, problem).rtol(1e-9).every(0.5);
    let all = all.map(|_, solution| solution.clone()).collect().unwrap();
    for (k, member) in all.value.into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(k);
        let alone = solve(&system, time, q, v).rtol(1e-9).every(0.5).run().unwrap();
        assert_eq!(alone.stats.method, "Picard");
        assert_eq!(member, Some(alone));
    }
}

#[test]
fn motions_that_are_no_numbers_end_one_member() {
    let problem = |k: usize| {
        let size = if k == 7 { f64::NAN } else { 0.1 };
        on(Sinusoid::new([size], 3.0, [0.0]), k)
    };
    let all = Ensemble::new(0..20, problem).map(|_, solution| solution.end).collect().unwrap();
    assert_eq!(all.tally.failed, 1);
    let failed = &all.tally.failures[0];
    assert!(failed.index == 7 && matches!(failed.error, Some(Error::NotFinite { .. })), "{failed}");
    same!(20, problem, rtol(1e-9));
}
