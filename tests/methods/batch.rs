//! Batches of motions: every lane has the solution of the single motion.

use pendulum_runtime::error::{Error, Part};
use pendulum_runtime::integrate::{Batch, Batched, Problem};
use pendulum_runtime::jet::JetDynamics;
use pendulum_runtime::prelude::*;
use std::fmt::Debug;

use systems::pendulums::Simple;
use systems::problems::{Double, Kepler};
use systems::random::some;

lagrangian! {
    /// ẍ = k x² + p sin 2t: without a push it leaves for infinity in a finite time.
    #[derive(Clone, Debug)]
    pub struct Pushed { k, p }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = -k*x^3/3 - p*x*sin(2*t);
}

/// Returns a generator of reproducible pseudorandom numbers.
fn noise(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        f64::from(state >> 8) / f64::from(1u32 << 24)
    }
}

/// Asserts that each solution and each failure equals that of the single motion, including all bits
/// and counters.
fn same<S, const N: usize>(method: Taylor, batch: Batch<N>, rtol: f64, problems: &[Problem<S, N>])
where
    S: Batched<N> + JetDynamics<N>,
    S::Scalar: Debug,
{
    let outcomes = batch.rtol(rtol).run(problems).unwrap();
    assert_eq!(outcomes.len(), problems.len());
    for (index, (outcome, Problem { system, time, q, v })) in
        outcomes.iter().zip(problems).enumerate()
    {
        let alone = solve(system, *time, *q, *v).method(method).rtol(rtol).run();
        match (outcome, alone) {
            (Ok(together), Ok(alone)) => assert_eq!(*together, alone, "motion {index}"),
            (Err(together), Err(alone)) => {
                // Failures are compared as text because NaN is not equal to itself.
                let all = |failure: &pendulum_runtime::integrate::Failure<_, N>| {
                    format!("{:?} {failure:?}", failure.error)
                };
                assert_eq!(all(together), all(&alone), "motion {index}");
            }
            (together, alone) => panic!("motion {index}: {together:?}, but alone {alone:?}"),
        }
    }
}

fn pendulums(count: usize) -> Vec<Problem<Simple, 1>> {
    let mut noise = noise(1);
    let mut next = |_| Problem {
        system: Simple::new(0.5 + noise(), 0.2 + noise()),
        time: (10.0 * noise() - 5.0, 30.0 * noise() - 10.0),
        q: [6.0 * noise() - 3.0],
        v: [4.0 * noise() - 2.0],
    };
    (0..count).map(&mut next).collect()
}

#[test]
fn any_number_of_motions_has_the_bits_of_single_ones() {
    for count in [0, 1, 7, 8, 9, 16, 50] {
        same(Taylor::new(), Batch::new(), 1e-12, &pendulums(count));
    }
}

#[test]
fn any_order_and_tolerance_has_the_bits_of_single_motions() {
    let problems: Vec<_> = some(pendulums(11)).collect();
    for order in [2, 3, 4, 5, 20, 30] {
        same(
            Taylor::new().order(order),
            Batch::new().order(order),
            if order < 5 { 1e-4 } else { 1e-16 },
            &problems,
        );
    }
    for rtol in [1e-3, 1e-6, 1e-18] {
        same(Taylor::new(), Batch::new(), rtol, &problems);
    }
}

#[test]
fn other_systems_have_the_bits_of_single_motions() {
    let mut noise = noise(2);
    let double = |_| Problem {
        system: Double::new([1.0, 0.5 + noise()], [0.5 + noise(), 1.0], 9.8),
        time: (0.0, 5.0 * noise()),
        q: [4.0 * noise() - 2.0, 4.0 * noise() - 2.0],
        v: [noise(), 0.0],
    };
    let double: Vec<_> = (0..13).map(double).collect();
    same(Taylor::new(), Batch::new(), 1e-14, &double);
    let kepler = |k: usize| Problem {
        system: Kepler::new(1.0 + 0.01 * k as f64),
        time: (0.0, 20.0),
        q: [1.0 - 0.09 * k as f64, 0.0],
        v: [0.0, 1.0],
    };
    same(Taylor::new(), Batch::new(), 1e-15, &(0..10).map(kepler).collect::<Vec<_>>());
    let pushed = |k: usize| {
        let start = 1e6 * k as f64;
        Problem {
            system: Pushed::new(-0.01 * k as f64, 0.2),
            time: (start, start + 7.0),
            q: [0.5],
            v: [0.0],
        }
    };
    same(Taylor::new(), Batch::new(), 1e-13, &(0..10).map(pushed).collect::<Vec<_>>());
}

#[test]
fn single_precision_has_the_bits_of_single_motions() {
    let mut noise = noise(3);
    let mut number = move || noise() as f32;
    let problem = |_| Problem {
        system: Simple::new(0.5 + number(), 0.2 + number()),
        time: (0.0, 20.0 * f64::from(number())),
        q: [6.0 * number() - 3.0],
        v: [number()],
    };
    same(
        Taylor::new(),
        Batch::new(),
        1e-6,
        &(0..37).map(problem).collect::<Vec<Problem<Simple<f32>, 1>>>(),
    );
}

/// Errors in numbers, intervals or parameters affect only one motion.
#[test]
fn failures_stay_alone() {
    let mut problems = pendulums(40);
    problems[1].q = [f64::NAN];
    problems[2].v = [f64::INFINITY];
    problems[4].system.L = 0.0;
    problems[9].time.1 = f64::NAN;
    problems[10].time.1 = problems[10].time.0;
    problems[17].system.g = f64::NAN;
    problems[18].q = [1e9];
    problems[20].system.g = 1e300;
    same(Taylor::new(), Batch::new(), 1e-12, &problems);
    let outcomes = Batch::new().rtol(1e-12).run(&problems).unwrap();
    let failed: Vec<_> = (0..40).filter(|&index| outcomes[index].is_err()).collect();
    assert!(
        [1, 2, 4, 9, 17].iter().all(|index| failed.contains(index)) && failed.len() <= 6,
        "{failed:?}"
    );
    assert!(
        matches!(&outcomes[1], Err(failure) if matches!(failure.error, Error::InitialState { part: Part::Position, .. }))
    );
    // The pole is at t = 2/√x for v = x^(3/2).
    let escape = |k: usize| {
        let x = 1.0 + k as f64;
        Problem { system: Pushed::new(1.5, 0.0), time: (0.0, 0.9), q: [x], v: [x * x.sqrt()] }
    };
    let problems: Vec<_> = (0..12).map(escape).collect();
    same(Taylor::new(), Batch::new(), 1e-12, &problems);
    let outcomes = Batch::new().rtol(1e-12).run(&problems).unwrap();
    let failed: Vec<_> = outcomes.iter().map(Result::is_err).collect();
    assert_eq!(
        failed,
        (0..12).map(|k| 2.0 / f64::sqrt(1.0 + f64::from(k)) < 0.9).collect::<Vec<_>>()
    );
}

#[test]
fn limits_hold_for_each_motion() {
    let problems = pendulums(20);
    for most in [0, 1, 5] {
        let outcomes = Batch::new().rtol(1e-12).max_steps(most).run(&problems).unwrap();
        for (outcome, Problem { system, time, q, v }) in outcomes.iter().zip(&problems) {
            let alone = solve(system, *time, *q, *v)
                .method(Taylor::new())
                .rtol(1e-12)
                .max_steps(most)
                .run();
            assert_eq!(format!("{outcome:?}"), format!("{alone:?}"));
        }
    }
    let limited = Batch::new()
        .rtol(1e-12)
        .first_step(1e-3)
        .max_step(0.05)
        .atol_each([1e-9], [1e-8])
        .run(&problems)
        .unwrap();
    for (outcome, Problem { system, time, q, v }) in limited.into_iter().zip(&problems) {
        let alone = solve(system, *time, *q, *v).method(Taylor::new()).rtol(1e-12);
        let alone = alone.first_step(1e-3).max_step(0.05).atol_each([1e-9], [1e-8]).run();
        assert_eq!(outcome.unwrap(), alone.unwrap());
    }
    let refused = Batch::new().rtol(1e-12).first_step(1e-250).run(&problems).unwrap();
    for (outcome, Problem { system, time, q, v }) in refused.into_iter().zip(&problems) {
        let alone =
            solve(system, *time, *q, *v).method(Taylor::new()).rtol(1e-12).first_step(1e-250).run();
        assert_eq!(outcome.unwrap_err().error, alone.unwrap_err().error);
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let refused = |batch: Batch<1>| matches!(batch.run(&pendulums(2)), Err(Error::Setting { .. }));
    assert!(refused(Batch::new().rtol(0.0)) && refused(Batch::new().rtol(f64::NAN)));
    assert!(
        refused(Batch::new().atol(-1.0))
            && refused(Batch::new().max_step(0.0))
            && refused(Batch::new().first_step(0.0))
    );
    assert!(Batch::new().max_step(f64::NAN).run(&pendulums(1)).is_err());
}
