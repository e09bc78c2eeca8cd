//! Integration with an `Integrator`, step by step.

use super::systems::{MovingPendulum, moving, pendulum, shaken};
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{
    AdaptiveStep, Dop853, FixedStep, Integrator, Leapfrog, Rk4, Srkn14a, solve,
};
use pendulum_runtime::motion::{Function, Sample, Side};
use pendulum_runtime::system::{Driven, Dynamics, Purpose};
use pendulum_runtime::time::Time;

#[test]
fn steps_have_the_length_asked_for() {
    let pendulum = pendulum();
    let mut integrator = Integrator::new(&pendulum, Leapfrog, 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(0.25))
        .unwrap();
    for step in 1..=8 {
        integrator.step().unwrap();
        assert_eq!(integrator.t(), 0.25 * f64::from(step));
    }
    assert_eq!(integrator.stats().accepted, 8);
    assert_eq!(integrator.stats().evaluations, 8);
}

#[test]
fn advancing_ends_exactly_and_equals_solving() {
    let pendulum = pendulum();
    let mut integrator = Integrator::new(&pendulum, Rk4, 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(0.01))
        .unwrap();
    for frame in 1..=60 {
        integrator.advance_to(f64::from(frame) / 60.0).unwrap();
        assert_eq!(integrator.t(), f64::from(frame) / 60.0);
    }
    let whole =
        solve(&pendulum, (0.0, 1.0), [1.3], [0.0]).method(Rk4).step(1.0 / 120.0).run().unwrap();
    assert!((integrator.q()[0] - whole.end.q[0]).abs() < 1e-14);
    integrator.advance_to(1.0).unwrap();
    assert_eq!(integrator.stats().accepted, 120);
}

#[test]
fn advancing_to_where_it_is_takes_no_step() {
    let driven = moving(|_| [[0.0; 2]; 3], 1.0);
    let mut integrator = Integrator::new(&driven, Dop853, 0.0, [1.3], [0.0]).unwrap();
    for step in 1..=10 {
        integrator.step().unwrap();
        // The time has a low word that an `f64` does not contain.
        let state = integrator.state();
        integrator.advance_to(state.t).unwrap();
        assert_eq!((integrator.state(), integrator.stats().accepted), (state, step));
    }
}

#[test]
fn adaptive_steps_survive_being_cut_into_frames() {
    let shaken = shaken();
    let control = AdaptiveStep::new().rtol(1e-10).atol(1e-10);
    let mut integrator =
        Integrator::new(&shaken, Dop853, 0.0, [0.5], [0.0]).unwrap().control(control).unwrap();
    for frame in 1..=600 {
        integrator.advance_to(f64::from(frame) / 60.0).unwrap();
    }
    assert!((integrator.q()[0] - super::systems::SHAKEN[0]).abs() < 1e-9);
    // The length of a frame is shorter than the error allows, and steps keep this length.
    assert!(
        integrator.stats().accepted < 610 && integrator.stats().rejected < 5,
        "{}",
        integrator.stats()
    );
}

#[test]
fn the_last_step_is_known_within() {
    let pendulum = pendulum();
    let mut integrator = Integrator::new(&pendulum, Dop853, 0.0, [1.3], [0.0]).unwrap();
    assert!(integrator.interpolant().is_none());
    integrator.step().unwrap();
    let interpolant = integrator.interpolant().unwrap();
    let (q, v) = interpolant.at(1.0);
    assert!((q[0] - integrator.q()[0]).abs() < 1e-15 && (v[0] - integrator.v()[0]).abs() < 1e-15);
    assert_eq!(interpolant.at(0.0), ([1.3], [0.0]));
}

#[test]
fn a_reset_state_goes_on_from_there() {
    let pendulum = pendulum();
    let mut integrator = Integrator::new(&pendulum, Rk4, 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(0.1))
        .unwrap();
    integrator.advance_to(5.0).unwrap();
    integrator.reset(0.0, [1.3], [0.0]).unwrap();
    integrator.advance_to(1.0).unwrap();
    let fresh = solve(&pendulum, (0.0, 1.0), [1.3], [0.0]).method(Rk4).step(0.1).run().unwrap();
    assert_eq!(integrator.state(), fresh.end);
    assert!(matches!(integrator.reset(0.0, [f64::NAN], [0.0]), Err(Error::InitialState { .. })));
    assert_eq!(integrator.state(), fresh.end);
}

#[test]
fn a_reset_ends_the_plan_of_equal_steps() {
    let driven = moving(|_| [[0.0; 2]; 3], 1.0);
    let mut integrator = Integrator::new(&driven, Rk4, 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(0.1))
        .unwrap();
    for _ in 0..3 {
        integrator.step().unwrap();
    }
    integrator.reset(0.0, [1.3], [0.0]).unwrap();
    for step in 1..=20 {
        integrator.step().unwrap();
        assert!((integrator.t() - 0.1 * f64::from(step)).abs() < 1e-15, "{}", integrator.t());
    }
    assert_eq!(integrator.stats().kinks, 2);
}

#[test]
fn times_that_are_none_are_refused_and_change_nothing() {
    let pendulum = pendulum();
    let mut integrator = Integrator::new(&pendulum, Dop853, 1.0, [1.3], [0.0]).unwrap();
    for t in [f64::NAN, f64::INFINITY] {
        assert!(matches!(integrator.advance_to(t), Err(Error::Interval { .. })));
    }
    assert_eq!((integrator.t(), integrator.q()), (1.0, &[1.3]));
}

#[test]
fn a_failed_step_leaves_the_state_before_it() {
    let formula = |t: f64| [[0.0; 2], [0.0; 2], [if t < 1.0 { 0.0 } else { f64::NAN }, 0.0]];
    let driven = moving(formula, f64::INFINITY);
    let mut integrator = Integrator::new(&driven, Leapfrog, 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(0.25))
        .unwrap();
    assert!(matches!(integrator.advance_to(2.0), Err(Error::NotFinite { t: 1.125, .. })));
    let state = integrator.state();
    assert!(state.t == 1.0 && state.q[0].is_finite());
    assert!(integrator.step().is_err());
    assert_eq!(integrator.state(), state);
    // The interpolant of a failed step is not available.
    assert!(integrator.interpolant().is_none());
}

#[test]
fn a_long_time_at_a_small_step_keeps_its_digits() {
    // Steps of a sixtieth of a second after thirty years sample the drive at the correct times.
    let pendulum = pendulum();
    let run = |start: f64| {
        let mut integrator = Integrator::new(&pendulum, Rk4, start, [1.3], [0.0])
            .unwrap()
            .control(FixedStep::new(1.0 / 60.0))
            .unwrap();
        for _ in 0..600 {
            integrator.step().unwrap();
        }
        (integrator.t() - start, *integrator.q())
    };
    assert_eq!(run(1e9), (10.0, run(0.0).1));
}

#[test]
fn displaced_coordinates_keep_what_rounding_has_left_off() {
    // A free rotation in steps that `f64` cannot represent: whole turns are subtracted, and the low
    // words are kept.
    let turn = (core::f64::consts::TAU, 2.4492935982947064e-16);
    let system = pendulum();
    let mut here = Integrator::new(&system, Srkn14a, 0.0, [0.0], [2.5])
        .unwrap()
        .control(FixedStep::new(1.0 / 32.0))
        .unwrap();
    let mut there = here.clone();
    for _ in 0..1000 {
        there.displace([turn.0], [turn.1]).unwrap();
        there.displace([-turn.0], [-turn.1]).unwrap();
        here.step().unwrap();
        there.step().unwrap();
    }
    assert!(
        (here.q()[0] - there.q()[0]).abs() < 1e-13 && (here.v()[0] - there.v()[0]).abs() < 1e-13
    );
    let error = there.displace([f64::INFINITY], [0.0]).unwrap_err();
    assert!(
        matches!(error, Error::InitialState { part: pendulum_runtime::error::Part::Position, .. }),
        "{error}"
    );
    assert!(there.q()[0].is_finite());
}

#[test]
fn intervals_without_a_fiftieth_have_steps() {
    let still = Function::new(|_| [0.0, 0.0]).velocity(|_| [0.0, 0.0]).acceleration(|_| [0.0, 0.0]);
    let driven = Driven::new(MovingPendulum { length: 1.0_f64, g: 1.0 }, (still,));
    for end in [5e-324, 1e-323, 1e-310, f64::MIN_POSITIVE, 1e-300] {
        let end = solve(&driven, (0.0, end), [1.3], [0.0]).method(Dop853).run().unwrap().end;
        assert_eq!((end.q, end.v[0].abs() < 1e-299), ([1.3], true));
    }
}

/// Inputs without a known rate of change.
struct Inputs(MovingPendulum<f64>);

impl Dynamics<1> for Inputs {
    type System = MovingPendulum<f64>;
    type Scalar = f64;

    fn system(&self) -> &MovingPendulum<f64> {
        &self.0
    }

    fn inputs(&self, _: Time, _: Side, _: Purpose) -> (Sample<f64, 2>,) {
        (Sample::zero(),)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn inputs_of_unknown_resolution_bound_steps() {
    assert_eq!(Inputs(MovingPendulum { length: 1.0, g: 1.0 }).longest_step(0.0, 5.0, 0.25), 0.25);
    assert_eq!(pendulum().longest_step(0.0, 5.0, 0.25), f64::INFINITY);
}
