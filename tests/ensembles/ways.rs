//! Every way of solving members gives the same solutions as `solve`.

use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Batch, Event, Problem, Status};
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;
use systems::pendulums::Simple;
use systems::problems::Double;

lagrangian! {
    /// A pendulum on a joint that moves.
    #[derive(Clone, Debug)]
    pub struct OnJoint { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: m;
    let y = [x + L*sin(θ), -L*cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
}

lagrangian! {
    /// A pendulum with a motor.
    #[derive(Clone, Debug)]
    pub struct WithMotor { L }
    coordinate θ;
    input u;
    kinetic = (L*θ̇)^2/2;
    potential = -9.81*L*cos(θ);
    force θ = u;
}

/// Returns the problem of a double pendulum.
pub fn double(k: usize) -> Problem<Double, 2> {
    let (a, b) = (k % 10, k / 10 % 10);
    Problem {
        system: Double::new([1.0, 0.5 + 0.05 * a as f64], [1.0, 0.7], 9.8),
        time: (0.0, 1.0 + 0.1 * (k % 7) as f64),
        q: [0.3 * a as f64, -0.2 * b as f64],
        v: [0.1, 0.0],
    }
}

#[test]
fn lanes_have_the_bits_of_a_batch() {
    let all = Ensemble::new(3..80, double).rtol(1e-11).map(|_, solution| solution.clone());
    let all = all.collect().unwrap();
    let problems: Vec<_> = (3..80).map(double).collect();
    let batch = Batch::new().rtol(1e-11).run(&problems).unwrap();
    assert_eq!((all.tally.members, all.tally.failed, all.value.len()), (77, 0, 77));
    let steps = batch.iter().map(|outcome| outcome.as_ref().unwrap().stats.accepted).sum::<u64>();
    assert_eq!(all.tally.accepted, steps);
    for (member, outcome) in all.value.into_iter().zip(batch) {
        assert_eq!(member, outcome.ok());
    }
}

#[test]
fn controlled_systems_and_named_methods_go_one_by_one() {
    let problem = |k: usize| {
        let law = |_: f64, q: &[f64; 1], v: &[f64; 1]| -3.0 * q[0] - v[0];
        let system = WithMotor::new(0.5).controlled_by(law);
        Problem { system, time: (0.0, 2.0), q: [0.1 * k as f64], v: [0.0] }
    };
    let end = |_: usize, solution: &Solution<f64, 1>| solution.end;
    let all = Ensemble::new(0..10, problem).map(end).collect().unwrap();
    let named = Ensemble::new(0..10, problem).method(Dop853).map(end).collect().unwrap();
    let steps = Ensemble::new(0..10, problem).step(0.01).map(end).collect().unwrap();
    for k in 0..10 {
        let Problem { system, time, q, v } = problem(k);
        let run = || solve(&system, time, q, v);
        assert_eq!(all.value[k], Some(run().run().unwrap().end));
        assert_eq!(named.value[k], Some(run().method(Dop853).run().unwrap().end));
        assert_eq!(steps.value[k], Some(run().step(0.01).run().unwrap().end));
    }
}

#[test]
fn events_that_act_go_one_by_one() {
    let floor = Event::new(|_, q: &[f64; 1], _: &[f64; 1]| q[0] + 0.3)
        .falling()
        .then(|state| state.v[0] *= -0.5);
    let problem = |k: usize| Problem {
        system: Simple::new(1.0, 1.0),
        time: (0.0, 2.0),
        q: [0.4 + 0.1 * k as f64],
        v: [0.0],
    };
    let all = Ensemble::new(0..5, problem).events([floor.clone()]);
    let all = all.map(|_, solution| solution.clone()).collect().unwrap();
    for (k, member) in all.value.into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(k);
        let alone = solve(&system, time, q, v).events([floor.clone()]).run().unwrap();
        assert!(!alone.events.is_empty());
        assert_eq!(member, Some(alone));
    }
}

#[test]
fn failed_members_are_values() {
    let bad = |k: usize| k % 5 == 2;
    let problem = |k: usize| {
        let mut problem = double(k);
        if bad(k) {
            problem.q[1] = f64::NAN;
        }
        problem
    };
    for named in [false, true] {
        let all = Ensemble::new(0..200, problem);
        let all = if named {
            all.method(Dop853).map(|k, _| k).collect().unwrap()
        } else {
            all.map(|k, _| k).collect().unwrap()
        };
        assert_eq!((all.tally.members, all.tally.failed), (200, 40));
        let first: Vec<_> = all.tally.failures.iter().map(|failed| failed.index).collect();
        assert_eq!(first, (0..16).map(|k| 5 * k + 2).collect::<Vec<_>>());
        let failed = &all.tally.failures[0];
        assert!(matches!(failed.error, Some(Error::InitialState { .. })));
        assert!(failed.to_string().starts_with("member 2: the initial position of"), "{failed}");
        for (k, member) in all.value.into_iter().enumerate() {
            assert_eq!(member, (!bad(k)).then_some(k));
        }
    }
}

#[test]
fn settings_are_checked_once() {
    let error = Ensemble::new(0..5, double).rtol(-1.0).map(|k, _| k).collect().unwrap_err();
    assert!(error.to_string().starts_with("`rtol` is -1.0"), "{error}");
}

#[test]
fn statuses_are_those_of_solve() {
    let all = Ensemble::new(0..3, double).map(|_, solution| solution.status).collect().unwrap();
    assert_eq!(all.value, [Some(Status::Completed); 3]);
    let joint = |_| Problem {
        system: OnJoint::new(0.5).driven_by(Sinusoid::new([0.1], 2.0, [0.3])),
        time: (0.0, f64::INFINITY),
        q: [0.0],
        v: [0.0],
    };
    let all = Ensemble::new(0..3, joint).map(|k, _| k).collect().unwrap();
    assert!(matches!(all.tally.failures[0].error, Some(Error::Interval { .. })));
}
