//! Driven motions with kinks: a pivot keyed at 24 frames a second.
//!
//! The keys are computed by a linear congruential generator, which makes them easy to reproduce;
//! the angles after five seconds were computed with aligned steps in the momentum form to twelve
//! digits.

use pendulum_runtime::motion::{Curve, Function};
use pendulum_runtime::prelude::*;

use systems::keys::keys;
use systems::pendulums::Hanging;

fn pendulum() -> Hanging {
    Hanging::new(0.3, 0.5)
}

fn after_five_seconds(dynamics: &impl Dynamics<1, Scalar = f64>) -> f64 {
    solve(dynamics, (0.0, 5.0), [0.3], [0.0])
        .method(Dop853)
        .rtol(1e-12)
        .atol(1e-12)
        .run()
        .unwrap()
        .end
        .q[0]
}

/// With straight lines between the keys, the acceleration is zero almost everywhere: only the jumps
/// move the pendulum.
#[test]
fn linear_keys_swing_a_pendulum() {
    let (times, values) = keys();
    let found = after_five_seconds(&pendulum().driven_by(Curve::linear(&times, &values).unwrap()));
    assert!((found + 0.129608683467).abs() < 1e-10, "{found}");
}

#[test]
fn jumps_of_the_acceleration_cost_no_order() {
    let (times, values) = keys();
    let found =
        after_five_seconds(&pendulum().driven_by(Curve::catmull_rom(&times, &values).unwrap()));
    assert!((found + 0.128838666144).abs() < 1e-10, "{found}");
}

#[test]
fn the_nystrom_pair_lands_on_the_keys() {
    let (times, values) = keys();
    let driven = pendulum().driven_by(Curve::linear(&times, &values).unwrap());
    let problem = solve(&driven, (0.0, 5.0), [0.3], [0.0]).rtol(1e-12).atol(1e-12);
    let found = problem.method(Dprkn12).run().unwrap().end.q[0];
    assert!((found + 0.129608683467).abs() < 1e-11, "{found}");
}

/// The keys do not lie at multiples of the step, a sixtieth of a second: the methods end steps at
/// the keys.
#[test]
fn fixed_steps_land_on_the_keys() {
    let (times, values) = keys();
    let driven = pendulum().driven_by(Curve::linear(&times, &values).unwrap());
    let run = |solution: Result<pendulum_runtime::integrate::Solution<f64, 1>, _>| match solution {
        Ok(solution) => (solution.end.q[0] + 0.129608683467, solution.stats),
        Err::<_, pendulum_runtime::integrate::Failure<f64, 1>>(failure) => panic!("{failure}"),
    };
    let (error, stats) =
        run(solve(&driven, (0.0, 5.0), [0.3], [0.0]).method(Srkn6b).step(1.0 / 60.0).run());
    assert!(error.abs() < 1e-7, "{error:e}");
    // The kinks between the start and the end, and the kink at the end.
    assert_eq!(stats.kinks, 120);
    let (error, _) =
        run(solve(&driven, (0.0, 5.0), [0.3], [0.0]).method(Rk4).step(1.0 / 60.0).run());
    assert!(error.abs() < 1e-4, "{error:e}");
    let (error, _) =
        run(solve(&driven, (0.0, 5.0), [0.3], [0.0]).method(Leapfrog).step(1.0 / 240.0).run());
    assert!(error.abs() < 1e-3, "{error:e}");
}

/// On a pivot in free fall, the pendulum is weightless: it turns at constant speed, to rounding.
#[test]
fn a_falling_pivot_leaves_a_free_rotation() {
    let fall = Function::new(|t: f64| [0.0, -4.905 * t * t])
        .velocity(|t: f64| [0.0, -9.81 * t])
        .acceleration(|_| [0.0, -9.81]);
    let end = solve(&pendulum().driven_by(fall), (0.0, 10.0), [0.4], [1.7]).run().unwrap().end;
    assert!((end.q[0] - 17.4).abs() < 1e-14 * 17.4 && end.v[0] == 1.7, "{end:?}");
}

/// The difference between a smooth curve and straight lines through keys on the curve decreases
/// with the number of keys.
#[test]
fn fine_linear_keys_approach_the_curve() {
    let curve = |t: f64| [0.1 * (3.0 * t).sin(), 0.05 * (5.0 * t).cos()];
    let run = |count: u32| {
        let times: Vec<f64> = (0..=count).map(|k| 5.0 * f64::from(k) / f64::from(count)).collect();
        let values: Vec<[f64; 2]> = times.iter().map(|&t| curve(t)).collect();
        let start = |t: f64| [0.3 * (3.0 * t).cos(), -0.25 * (5.0 * t).sin()];
        let spline = Curve::clamped(&times, &values, start(0.0), start(5.0)).unwrap();
        let linear = Curve::linear(&times, &values).unwrap();
        (after_five_seconds(&pendulum().driven_by(spline))
            - after_five_seconds(&pendulum().driven_by(linear)))
        .abs()
    };
    let (coarse, fine) = (run(50), run(500));
    assert!(fine < 2e-3 && fine < coarse / 5.0, "{coarse:e} and {fine:e}");
}

/// Tests the same block in single precision.
#[test]
fn single_precision_follows() {
    let (times, values) = keys();
    let motion = || Curve::catmull_rom(&times, &values).unwrap();
    let double = after_five_seconds(&pendulum().driven_by(motion()));
    let single = pendulum().map(|parameter| parameter as f32).driven_by(motion());
    let found = solve(&single, (0.0, 5.0), [0.3f32], [0.0])
        .method(Rk4)
        .step(1.0 / 240.0)
        .run()
        .unwrap()
        .end
        .q[0];
    assert!((f64::from(found) - double).abs() < 2e-6, "{found} and {double}");
}
