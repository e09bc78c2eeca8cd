//! Edges of what lanes can do: they fail where single motions do.

use crate::lanes::same;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Batch, Problem};
use pendulum_runtime::prelude::*;
use systems::pendulums::Simple;

lagrangian! {
    /// A mass that is used up after a second.
    #[derive(Clone, Debug)]
    pub struct Burning { r }
    coordinate x;
    kinetic = (1 - r*t)*ẋ^2/2;
}

/// A mass at rest feels nothing when its mass becomes negative.
#[test]
fn negative_masses_at_the_end_are_refused() {
    let problem = |k: usize| Problem {
        system: Burning::new(0.1 * k as f64),
        time: (0.0, 2.0),
        q: [0.5],
        v: [0.0],
    };
    let problems: Vec<_> = (0..10).map(problem).collect();
    for (k, outcome) in Batch::new().run(&problems).unwrap().into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(k);
        let alone = solve(&system, time, q, v).method(Taylor::new()).run();
        assert_eq!(format!("{outcome:?}"), format!("{alone:?}"), "member {k}");
        let refused = matches!(outcome, Err(failure) if matches!(failure.error, Error::NegativeInertia { .. }));
        assert_eq!(refused, 5 < k, "member {k}");
    }
    same!(10, problem, every(0.3));
}

lagrangian! {
    /// A mass that is below zero for a while.
    #[derive(Clone, Debug)]
    pub struct Waning { s }
    coordinate x;
    kinetic = (1 - s*t + t^2)*ẋ^2/2;
}

/// Single motions check every 64th step, and so do lanes: a mass that recovers is refused by both.
#[test]
fn negative_masses_on_the_way_are_refused() {
    let problem = |k: usize| Problem {
        system: Waning::new(0.3 * k as f64),
        time: (0.0, 3.0),
        q: [0.5],
        v: [0.0],
    };
    let problems: Vec<_> = (0..12).map(problem).collect();
    let mut refused = 0;
    let batch = Batch::new().max_step(0.004);
    for (k, outcome) in batch.run(&problems).unwrap().into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(k);
        let alone = solve(&system, time, q, v).method(Taylor::new()).max_step(0.004).run();
        assert_eq!(format!("{outcome:?}"), format!("{alone:?}"), "member {k}");
        refused += usize::from(
            matches!(outcome, Err(failure) if matches!(failure.error, Error::NegativeInertia { .. })),
        );
    }
    // The mass is negative between the roots of t² − s t + 1, which are real from s = 2.
    assert_eq!(refused, 5);
}

/// Single precision holds no step of 1e-40 s.
#[test]
fn short_steps_of_single_precision_are_those_of_single_motions() {
    let problem = |end: f64| Problem {
        system: Simple::<f32>::new(1.0, 1.0),
        time: (0.0, end),
        q: [1.0],
        v: [1.0],
    };
    let problems = [1e-40, -1e-39, 1e-37, 1.0, 3e-310].map(problem);
    for batch in [Batch::new(), Batch::new().first_step(1e-41)] {
        let first = batch != Batch::new();
        for (k, outcome) in batch.run(&problems).unwrap().into_iter().enumerate() {
            let Problem { system, time, q, v } = &problems[k];
            let alone = solve(system, *time, *q, *v).method(Taylor::new());
            let alone = if first { alone.first_step(1e-41).run() } else { alone.run() };
            assert_eq!(format!("{outcome:?}"), format!("{alone:?}"), "member {k}");
        }
    }
}
