//! Errors have a cause, a time, and the last valid state.

use super::systems::{
    Kepler, MovingPendulum, Pendulum, Root, double_pendulum, moving, oscillator, pendulum, shaken,
};
use pendulum_runtime::error::{Coordinate, Error, Part, Quantity, Suspect};
use pendulum_runtime::integrate::{Dop853, Failure, Leapfrog, Rk4, Srkn14a, solve};
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
use pendulum_runtime::system::Driven;
use pendulum_runtime::time::Time;

const THETA: Coordinate = Coordinate { index: 0, name: "θ" };

fn text(failure: &Failure<f64, 1>) -> String {
    assert!(std::error::Error::source(failure).is_some());
    failure.to_string()
}

#[test]
fn unusable_intervals() {
    for (start, end) in [
        (0.0, f64::INFINITY),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (f64::NEG_INFINITY, 0.0),
        (-1e308, 1e308),
    ] {
        for failure in [
            solve(&pendulum(), (start, end), [1.3], [0.0]).method(Dop853).run().unwrap_err(),
            solve(&pendulum(), (start, end), [1.3], [0.0]).method(Rk4).step(0.1).run().unwrap_err(),
            solve(&pendulum(), (start, end), [1.3], [0.0]).method(Rk4).steps(10).run().unwrap_err(),
        ] {
            assert!(matches!(failure.error, Error::Interval { .. }), "{failure}");
            assert_eq!((failure.partial.end.q, failure.partial.stats.evaluations), ([1.3], 0));
        }
    }
}

#[test]
fn unusable_initial_states() {
    let failure =
        solve(&pendulum(), (0.0, 1.0), [f64::NAN], [0.0]).method(Dop853).run().unwrap_err();
    assert!(
        matches!(
            failure.error,
            Error::InitialState { part: Part::Position, coordinate: THETA, .. }
        ),
        "{failure}"
    );
    let failure = solve(&double_pendulum(), (0.0, 1.0), [0.0; 2], [0.0, f64::INFINITY])
        .method(Dop853)
        .run()
        .unwrap_err();
    let coordinate = Coordinate { index: 1, name: "θ₂" };
    assert_eq!(
        failure.error,
        Error::InitialState { part: Part::Velocity, coordinate, value: f64::INFINITY }
    );
    assert_eq!(failure.partial.end.v, [0.0, f64::INFINITY]);
}

#[test]
fn unusable_settings() {
    let pendulum = pendulum();
    let run = || solve(&pendulum, (0.0, 1.0), [1.3], [0.0]).method(Dop853);
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let names = [
            run().rtol(value).run().unwrap_err(),
            run().atol(value).run().unwrap_err(),
            run().atol_each([1.0], [value]).run().unwrap_err(),
            run().first_step(value).run().unwrap_err(),
            run().method(Rk4).step(value).run().unwrap_err(),
        ]
        .map(|failure| match failure.error {
            Error::Setting { name, .. } => name,
            error => panic!("{error}"),
        });
        assert_eq!(names, ["rtol", "atol", "atol", "first_step", "step"]);
    }
    assert!(matches!(
        run().max_step(0.0).run().unwrap_err().error,
        Error::Setting { name: "max_step", .. }
    ));
    assert!(matches!(
        run().method(Rk4).steps(0).run().unwrap_err().error,
        Error::Setting { name: "steps", .. }
    ));
    let message = text(&run().rtol(1e-15).run().unwrap_err());
    assert!(
        message.contains("`rtol` is 1e-15") && message.contains("ten machine epsilons"),
        "{message}"
    );
    let failure = solve(&Pendulum { length: 1.0_f32, g: 1.0 }, (0.0, 1.0), [1.3], [0.0])
        .method(Dop853)
        .rtol(1e-7)
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Setting { name: "rtol", .. }));
}

#[test]
fn a_drive_that_is_not_finite() {
    let formula = |t: f64| [[0.0; 2], [0.0; 2], [0.0, if t < 3.0 { 0.1 } else { f64::NAN }]];
    let driven = moving(formula, f64::INFINITY);
    let what = Quantity::Input { name: "x", component: 1, derivative: 2 };
    for failure in [
        solve(&driven, (0.0, 10.0), [0.5], [0.0]).method(Dop853).every_step().run().unwrap_err(),
        solve(&driven, (0.0, 10.0), [0.5], [0.0])
            .method(Rk4)
            .step(0.1)
            .every_step()
            .run()
            .unwrap_err(),
        solve(&driven, (0.0, 10.0), [0.5], [0.0])
            .method(Leapfrog)
            .step(0.1)
            .every_step()
            .run()
            .unwrap_err(),
        solve(&driven, (0.0, 10.0), [0.5], [0.0])
            .method(Srkn14a)
            .step(0.1)
            .every_step()
            .run()
            .unwrap_err(),
    ] {
        let Error::NotFinite { t, what: found, ref suspects } = failure.error else {
            panic!("{failure}")
        };
        assert!((3.0..6.0).contains(&t) && found == what && suspects.is_empty(), "{failure}");
        // The partial solution contains all earlier states.
        let partial = &failure.partial;
        assert!(
            0.5 < partial.end.t && partial.end.t <= 3.0 && partial.end.q[0].is_finite(),
            "{failure}"
        );
        assert_eq!(
            (partial.t.last(), partial.q.last()),
            (Some(&partial.end.t), Some(&partial.end.q))
        );
    }
}

#[test]
fn a_drive_that_is_not_finite_at_the_start() {
    let formula = |_| [[0.0; 2], [0.0; 2], [f64::INFINITY, 0.0]];
    let driven = moving(formula, f64::INFINITY);
    let failure = solve(&driven, (2.0, 10.0), [0.5], [0.25]).method(Dop853).run().unwrap_err();
    assert_eq!(
        text(&failure),
        "at t = 2.0 the acceleration of the driven input `x` (component 0) is not finite; check the motion that drives it at this time"
    );
    assert_eq!(
        (failure.partial.end.t, failure.partial.end.q, failure.partial.end.v),
        (2.0, [0.5], [0.25])
    );
}

#[test]
fn a_zero_length() {
    let pendulum = Pendulum { length: 0.0, g: 9.81 };
    let suspects = vec![Suspect { parameter: "L", value: 0.0 }];
    for failure in [
        solve(&pendulum, (0.5, 1.0), [0.5], [0.0]).method(Dop853).run().unwrap_err(),
        solve(&pendulum, (0.5, 1.0), [0.5], [0.0]).method(Rk4).steps(10).run().unwrap_err(),
    ] {
        let what = Quantity::Acceleration(THETA);
        assert_eq!(failure.error, Error::NotFinite { t: 0.5, what, suspects: suspects.clone() });
        assert_eq!(
            text(&failure),
            "at t = 0.5 the acceleration of `θ` is not finite; check parameter `L`, which is 0.0"
        );
    }
}

#[test]
fn parameters_that_are_not_finite() {
    let failure =
        solve(&oscillator(f64::NAN), (0.0, 1.0), [0.5], [0.0]).method(Dop853).run().unwrap_err();
    assert!(text(&failure).ends_with("check parameter `k`, which is NaN"), "{failure}");
}

#[test]
fn a_function_left_behind_its_domain() {
    // x reaches zero with a nonzero speed, and √x is undefined beyond.
    let failure =
        solve(&Root { k: 1.0 }, (0.0, 10.0), [1.0], [0.0]).method(Dop853).run().unwrap_err();
    let Error::NotFinite { t, what: Quantity::Acceleration(Coordinate { name: "x", .. }), .. } =
        failure.error
    else {
        panic!("{failure}")
    };
    // ∫₀¹ dx/√(4/3 (1 − x^{3/2})) = 1.4936684….
    assert!(
        (t - 1.4936684).abs() < 1e-4
            && (t - failure.partial.end.t).abs() < 1e-4
            && failure.partial.end.q[0] < 1e-2,
        "{failure}"
    );
    assert!(failure.to_string().contains("outside its domain"), "{failure}");
}

#[test]
fn a_collision_collapses_the_step() {
    let failure = solve(&Kepler { mu: 1.0 }, (0.0, 10.0), [1.0, 0.0], [0.0, 0.0])
        .method(Dop853)
        .rtol(1e-10)
        .run()
        .unwrap_err();
    // A free fall into the centre takes π/(2√2).
    let end = failure.partial.end;
    assert!((end.t - core::f64::consts::PI / 8.0_f64.sqrt()).abs() < 1e-6, "{failure}");
    let coordinate = Coordinate { index: 0, name: "x" };
    assert!(
        matches!(failure.error, Error::StepSizeUnderflow { coordinate: c, .. } if c == coordinate),
        "{failure}"
    );
    assert!(
        failure.partial.stats.accepted + failure.partial.stats.rejected < 10_000,
        "{}",
        failure.partial.stats
    );
}

#[test]
fn late_times_are_resolved_in_two_words() {
    // The equations of the pendulum do not depend on time.
    let early =
        solve(&pendulum(), (0.0, 16.0), [1.3], [0.0]).method(Dop853).rtol(1e-10).run().unwrap();
    for start in [1e12, -1e12, 1e14, 1e15] {
        let late = solve(&pendulum(), (start, start + 16.0), [1.3], [0.0])
            .method(Dop853)
            .rtol(1e-10)
            .run()
            .unwrap();
        assert!((late.end.q[0] - early.end.q[0]).abs() < 1e-8, "from {start:e}");
    }
}

#[test]
fn a_first_step_that_is_none() {
    for (start, step) in [(0.0, 1e-300), (1.0, 1e-30)] {
        let failure = solve(&pendulum(), (start, 2.0), [1.3], [0.0])
            .method(Dop853)
            .first_step(step)
            .run()
            .unwrap_err();
        assert!(
            matches!(failure.error, Error::Setting { name: "first_step", value, .. } if value == step),
            "{failure}"
        );
    }
    assert!(
        solve(&pendulum(), (1.0, 2.0), [1.3], [0.0]).method(Dop853).first_step(1e-20).run().is_ok()
    );
}

#[test]
fn a_velocity_at_the_end_of_the_range() {
    let pendulum = Pendulum { length: 1.0_f32, g: 9.81 };
    let failure = solve(&pendulum, (0.0, 10.0), [0.0], [3e38]).method(Dop853).run().unwrap_err();
    assert!(matches!(failure.error, Error::NotFinite { t: 0.0, .. }), "{failure}");
}

#[test]
fn more_states_than_anybody_keeps() {
    let failure =
        solve(&pendulum(), (0.0, 1.0), [1.3], [0.0]).method(Dop853).every(1e-9).run().unwrap_err();
    assert!(
        matches!(failure.error, Error::Setting { name: "every", value: 1e-9, .. }),
        "{failure}"
    );
    assert!(failure.to_string().contains("ten million"), "{failure}");
}

#[test]
fn steps_run_out() {
    let failure = solve(&pendulum(), (0.0, 1e6), [1.3], [0.0])
        .method(Dop853)
        .max_steps(1000)
        .run()
        .unwrap_err();
    let Error::MaxSteps { t, max_steps: 1000 } = failure.error else { panic!("{failure}") };
    assert!(t == failure.partial.end.t && 100.0 < t);
    assert_eq!(failure.partial.stats.accepted + failure.partial.stats.rejected, 1000);
    // Fixed steps are counted before the first step.
    let failure =
        solve(&pendulum(), (0.0, 1e6), [1.3], [0.0]).method(Rk4).step(1e-9).run().unwrap_err();
    assert_eq!(failure.error, Error::MaxSteps { t: 0.0, max_steps: 10_000_000 });
    let failure = solve(&pendulum(), (0.0, 1e6), [1.3], [0.0])
        .method(Dop853)
        .max_step(1e-9)
        .run()
        .unwrap_err();
    assert_eq!(failure.error, Error::MaxSteps { t: 0.0, max_steps: 10_000_000 });
}

#[test]
fn numbers_that_grow_beyond_all_bounds() {
    // ẍ = 10¹⁰ x.
    let failure = solve(&oscillator(-1e10), (0.0, 1.0), [1.0], [0.0])
        .method(Rk4)
        .step(1e-5)
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::NotFinite { .. }), "{failure}");
    assert!(failure.partial.end.q[0].is_finite() && failure.partial.end.v[0].is_finite());
    assert!(1e250 < failure.partial.end.q[0], "{:e}", failure.partial.end.q[0]);
}

/// A motion with a faulty `next_kink`.
struct Stuck(f64);

impl Motion<f64, 2> for Stuck {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, _: Time, _: Side, _: Derivatives) -> Sample<f64, 2> {
        Sample::zero()
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        if t < self.0 { Some(self.0) } else { Some(t) }
    }
}

#[test]
fn a_kink_that_never_passes() {
    let driven = Driven::new(MovingPendulum { length: 1.0, g: 1.0 }, (Stuck(0.5),));
    let failure = solve(&driven, (0.0, 1.0), [0.5], [0.0]).method(Dop853).run().unwrap_err();
    assert_eq!(failure.error, Error::Kink { t: 0.5, kink: 0.5 });
    assert!(failure.partial.end.t < 0.5);
    let driven = Driven::new(MovingPendulum { length: 1.0, g: 1.0 }, (Stuck(-1.0),));
    assert_eq!(
        solve(&driven, (0.0, 1.0), [0.5], [0.0]).method(Dop853).run().unwrap_err().error,
        Error::Kink { t: 0.0, kink: 0.0 }
    );
}

#[test]
fn a_velocity_that_is_not_finite_at_a_kink() {
    let formula = |t: f64| [[0.0; 2], [if t < 1.0 { 0.0 } else { f64::NAN }, 0.0], [0.0; 2]];
    let driven = moving(formula, 0.5);
    let failure = solve(&driven, (0.0, 2.0), [0.5], [0.0]).method(Dop853).run().unwrap_err();
    let what = Quantity::Input { name: "x", component: 0, derivative: 1 };
    assert_eq!(failure.error, Error::NotFinite { t: 1.0, what, suspects: Vec::new() });
    assert!(failure.partial.end.t < 1.0 && failure.partial.end.v[0].is_finite());
}

#[test]
fn failures_print_what_matters() {
    let failure = solve(&pendulum(), (0.0, 1e6), [1.3], [0.0])
        .method(Rk4)
        .step(0.1)
        .max_steps(10)
        .every_step()
        .run()
        .unwrap_err();
    assert_eq!(
        format!("{failure:?}"),
        "10 steps do not suffice from t = 0.0; raise `max_steps`, loosen the tolerances or lengthen the step; if the motion diverges, check the signs of gains and of friction, and the period of a controller; dry friction needs a `friction` in place of `sign(v)`\n  \
         reached: t = 0.0, q = [1.3], v = [0.0]\n  Rk4: 0 steps, 0 rejected, 0 kinks, 0 evaluations"
    );
}

#[test]
fn one_failure_leaves_the_neighbour_alone() {
    let (shaken, broken) = (shaken(), oscillator(f64::NAN));
    let alone = solve(&shaken, (0.0, 10.0), [0.5], [0.0]).method(Dop853).run().unwrap();
    assert!(solve(&broken, (0.0, 10.0), [0.5], [0.0]).method(Dop853).run().is_err());
    assert_eq!(
        solve(&shaken, (0.0, 10.0), [0.5], [0.0]).method(Dop853).run().unwrap().end,
        alone.end
    );
}

#[test]
fn tiny_and_huge_numbers() {
    // Denormal amplitudes, tolerances far below them, and huge stiffness: no panic, no loop.
    let tiny = solve(&oscillator(1.0), (0.0, 1.0), [1e-310], [0.0]).method(Dop853).run().unwrap();
    assert!((tiny.end.q[0] / 1e-310 - 0.5403).abs() < 1e-3);
    let solution = solve(&oscillator(1.0), (0.0, 1.0), [1.0], [0.0])
        .method(Dop853)
        .rtol(1e-12)
        .atol(1e-300)
        .run()
        .unwrap();
    assert!((solution.end.q[0] - 0.5403023058681398).abs() < 1e-10, "{}", solution.stats);
    let failure =
        solve(&oscillator(1e300), (0.0, 1.0), [1.0], [0.0]).method(Dop853).max_steps(1000).run();
    assert!(failure.is_err());
}
