//! Limits of lanes: they return the same errors as single motions.

use crate::lanes::same;
use crate::ways::OnJoint;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Batch, Problem};
use pendulum_runtime::jet::Series;
use pendulum_runtime::motion::{Analytic, Derivatives, Motion, Sample, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use systems::pendulums::Simple;

lagrangian! {
    /// A mass that is used up after a second.
    #[derive(Clone, Debug)]
    pub struct Burning { r }
    coordinate x;
    kinetic = (1 - r*t)*ẋ^2/2;
}

/// A body at rest does not move when its mass becomes negative.
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

/// Single motions and lanes check the mass after every 64th step, and both refuse a mass that is
/// negative for a while.
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

/// Single precision cannot represent a step of 1e-40 s.
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

/// A sway whose next break or kink is always the same time, even after that time.
#[derive(Clone, Debug)]
struct Halting {
    sway: Sinusoid<1>,
    breaks: Option<f64>,
    kinks: Option<f64>,
    /// `true` if `analytic` returns the motion.
    told: bool,
}

impl Motion<f64, 1> for Halting {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<f64, 1> {
        self.sway.sample(t, side, wanted)
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        self.kinks
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        Motion::<f64, 1>::longest_step(&self.sway, t, widths)
    }

    fn analytic(&self) -> Option<&dyn Analytic<f64, 1>> {
        self.told.then_some(self)
    }
}

impl Analytic<f64, 1> for Halting {
    fn series(
        &self,
        t: Time,
        side: Side,
        component: usize,
        count: usize,
        position: &mut Series<f64>,
    ) {
        Analytic::<f64, 1>::series(&self.sway, t, side, component, count, position);
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        self.breaks
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        self.breaks
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        self.kinks
    }
}

/// Lanes refuse such motions as single motions do, and no member takes all allowed steps. The lanes
/// use the series of a motion even if `analytic` returns `None`.
#[test]
fn motions_that_halt_are_refused() {
    let problem = |k: usize| Problem {
        system: OnJoint::new(1.0).driven_by(Halting {
            sway: Sinusoid::new([0.1], 3.0, [0.0]),
            breaks: [None, Some(0.7), Some(0.7), None, Some(-1.0)][k % 5],
            kinks: [None, Some(0.7), None, Some(0.7), None][k % 5],
            told: k < 7,
        }),
        time: (0.0, 2.0),
        q: [0.5],
        v: [0.0],
    };
    let problems: Vec<_> = (0..10).map(problem).collect();
    let outcomes = Batch::new().run(&problems).unwrap();
    for (k, outcome) in outcomes.into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(k);
        let alone = solve(&system, time, q, v).method(Taylor::new()).run();
        let Err(alone) = alone else {
            assert_eq!(format!("{outcome:?}"), format!("{alone:?}"), "member {k}");
            assert_eq!(k % 5, 0);
            continue;
        };
        // Lanes cross the repeated kink, and single motions do not; the errors name the same kink.
        let kink = |error: &Error| match error {
            Error::Kink { kink, .. } => *kink,
            error => panic!("member {k}: {error}"),
        };
        assert_eq!(kink(&outcome.unwrap_err().error), kink(&alone.error), "member {k}");
    }
}
