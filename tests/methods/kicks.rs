//! Kicks that fit between two samples of a long step: bounds on steps ensure that no kick is
//! missed.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Batch, Problem, Solution};
use pendulum_runtime::motion::{Curve, Derivatives, Function, MotionError, Sample, Side};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use systems::random::{Random, some};

lagrangian! {
    /// A pendulum that is pushed once.
    #[derive(Clone, Copy, Debug)]
    pub struct Kicked { A, t0, w, L, g }
    coordinate θ;
    kinetic = L^2*θ̇^2/2;
    potential = -g*L*cos(θ);
    force θ = A*exp(-((t - t0)/w)^2);
}

lagrangian! {
    /// A pendulum in the wind.
    #[derive(Clone, Copy, Debug)]
    pub struct Blown { L, g }
    coordinate θ;
    driven f;
    kinetic = L^2*θ̇^2/2;
    potential = -g*L*cos(θ);
    force θ = f;
}

const LENGTH: f64 = 0.5;
const G: f64 = 9.81;
const STRENGTH: f64 = 4.0;
const WIDTH: f64 = 0.01;
const END: f64 = 100.0;
const TOLERANCE: f64 = 1e-7;

fn kicked(t0: f64, w: f64) -> Kicked {
    Kicked::new(STRENGTH, t0, w, LENGTH, G)
}

fn push(t: f64, t0: f64, w: f64) -> f64 {
    STRENGTH * (-((t - t0) / w).powi(2)).exp()
}

/// Returns the angle and the velocity a second after the middle of the kick, from a motion that
/// starts with the kick, in short steps.
fn reference(w: f64) -> [f64; 2] {
    let begin = solve(&kicked(1.0, w), (1.0 - 10.0 * w, 1.0 + 10.0 * w), [0.0], [0.0])
        .method(Dop853)
        .max_step(0.1 * w)
        .rtol(1e-14)
        .run()
        .unwrap()
        .end;
    let end = solve(&kicked(-1e6, 1.0), (begin.t, 2.0), begin.q, begin.v)
        .method(Dop853)
        .rtol(1e-14)
        .run()
        .unwrap()
        .end;
    [end.q[0], end.v[0]]
}

/// Returns the largest error a second after the kick, in units of the tolerance.
fn off(solution: &Solution<f64, 1>, [q, v]: [f64; 2]) -> f64 {
    (solution.q[0][0] - q).abs().max((solution.v[0][0] - v).abs()) / TOLERANCE
}

/// Tests each method with a kick in the equations and with a kick by a driving function.
macro_rules! never_missed {
    ($($test:ident $method:tt)+) => {$(
        #[test]
        fn $test() {
            let (mut random, expected) = (Random::new(7), reference(WIDTH));
            for _ in some(0..200) {
                let t0 = random.uniform(1.0, 98.0);
                let times = [t0 + 1.0];
                let within = kicked(t0, WIDTH);
                never_missed!(@run &within, times, expected, t0, $method);
                let wind = Function::new(move |t| [push(t, t0, WIDTH)]).resolution(WIDTH).unwrap();
                let without = Blown::new(LENGTH, G).driven_by(wind);
                never_missed!(@function &without, times, expected, t0, $method);
            }
        }
    )+};
    // `Taylor` does not support functions.
    (@function $dynamics:expr, $times:ident, $expected:ident, $t0:ident, (Taylor::new())) => { let _ = $dynamics; };
    (@function $dynamics:expr, $times:ident, $expected:ident, $t0:ident, $method:tt) => {
        never_missed!(@run $dynamics, $times, $expected, $t0, $method);
    };
    (@run $dynamics:expr, $times:ident, $expected:ident, $t0:ident, ($method:expr)) => {
        let run = solve($dynamics, (0.0, END), [0.0], [0.0]).t_eval(&$times).method($method).rtol(TOLERANCE).atol(TOLERANCE);
        let solution = run.run().unwrap();
        let error = off(&solution, $expected);
        assert!(error <= 100.0, "{}, kick at {}: {error} tolerances", solution.stats.method, $t0);
    };
}

never_missed! {
    auto (Auto)
    picard (Picard)
    taylor (Taylor::new())
    dop853 (Dop853)
    rodas4 (Rodas4)
    dprkn12 (Dprkn12)
}

/// Far from the kick, steps are as long as without the kick.
#[test]
fn a_narrow_kick_costs_little() {
    let w = 1e-6;
    let expected = reference(w);
    let times = [38.25];
    macro_rules! check {
        ($($method:expr, $most:literal;)+) => {$(
            let solution = solve(&kicked(37.25, w), (0.0, END), [0.0], [0.0])
                .t_eval(&times)
                .method($method)
                .rtol(TOLERANCE)
                .atol(TOLERANCE)
                .run()
                .unwrap();
            let (error, steps) = (off(&solution, expected), solution.stats.accepted + solution.stats.rejected);
            assert!(error <= 100.0 && steps < $most, "{}: {error} tolerances, {steps} steps", solution.stats.method);
        )+};
    }
    check! { Picard, 700; Dop853, 700; Taylor::new(), 1500; Rodas4, 8000; }
}

#[test]
fn back_in_time_and_in_a_batch() {
    let (mut random, expected) = (Random::new(8), reference(WIDTH));
    let problems: Vec<_> = (0..40)
        .map(|_| Problem {
            system: kicked(random.uniform(1.0, 98.0), WIDTH),
            time: (0.0, END),
            q: [0.0],
            v: [0.0],
        })
        .collect();
    let batch = Batch::new().rtol(TOLERANCE).atol(TOLERANCE).run(&problems).unwrap();
    for (problem, together) in problems.iter().zip(batch) {
        let (system, t0) = (&problem.system, problem.system.t0);
        let alone = solve(system, problem.time, [0.0], [0.0])
            .method(Taylor::new())
            .rtol(TOLERANCE)
            .atol(TOLERANCE)
            .run()
            .unwrap();
        let together = together.unwrap();
        assert_eq!((alone.end, alone.stats), (together.end, together.stats), "kick at {t0}");
        // The kick is symmetric in time.
        let times = [t0 - 1.0];
        let back = solve(system, (END, 0.0), [0.0], [0.0])
            .t_eval(&times)
            .method(Taylor::new())
            .rtol(TOLERANCE)
            .atol(TOLERANCE)
            .run();
        let error = off(&back.unwrap(), [expected[0], -expected[1]]);
        assert!(error <= 100.0, "back over a kick at {t0}: {error} tolerances");
    }
}

/// Tests square waves, pulses and repeated kicks.
#[test]
fn other_shapes() {
    lagrangian! {
        pub struct Pulsed { a, b }
        coordinate q;
        kinetic = q̇^2/2;
        force q = sign(t - a) - sign(t - b);
    }
    lagrangian! {
        pub struct Tent { t0, w }
        coordinate q;
        kinetic = q̇^2/2;
        force q = max(0, 1 - abs(t - t0)/w);
    }
    lagrangian! {
        pub struct Ticking { k }
        coordinate q;
        kinetic = q̇^2/2;
        force q = exp(-k*sin(t/2)^2);
    }
    let mut random = Random::new(9);
    for _ in some(0..50) {
        let t0 = random.uniform(1.0, 98.0);
        let pulse = solve(&Pulsed::new(t0, t0 + 0.02), (0.0, END), [0.0], [0.0])
            .rtol(1e-6)
            .run()
            .unwrap()
            .end;
        // The measured errors are at most 5e-7 and 6e-7.
        assert!((pulse.v[0] - 0.04).abs() < 3e-6, "pulse at {t0}: {}", pulse.v[0]);
        let tent =
            solve(&Tent::new(t0, 0.02), (0.0, END), [0.0], [0.0]).rtol(1e-6).run().unwrap().end;
        assert!((tent.v[0] - 0.02).abs() < 3e-6, "tent at {t0}: {}", tent.v[0]);
    }
    // e^(−k/2) I₀(k/2) is the mean, near 1/√(πk) (1 + 1/(4k)); sixteen kicks, starting and ending
    // between two kicks.
    let (k, tau) = (10_000.0, core::f64::consts::TAU);
    let end = solve(&Ticking::new(k), (-0.5 * tau, 15.5 * tau), [0.0], [0.0])
        .rtol(1e-8)
        .run()
        .unwrap()
        .end;
    let expected = 16.0 * tau * (1.0 + 0.25 / k) / (core::f64::consts::PI * k).sqrt();
    assert!((end.v[0] - expected).abs() < 1e-5, "{} for {expected}", end.v[0]);
}

/// Tests keys that are dense for a short time. Only `Picard` and `Taylor` stop at all keys.
#[test]
fn dense_keys_of_a_spline() {
    let (mut random, expected) = (Random::new(10), reference(WIDTH));
    for _ in some(0..50) {
        let t0 = random.uniform(3.0, 97.0).round() + 0.5;
        let mut times: Vec<f64> = (-80..=80).map(|k| t0 + 1e-3 * f64::from(k)).collect();
        times.extend((0..=100).map(f64::from));
        times.sort_by(f64::total_cmp);
        let values: Vec<[f64; 1]> = times.iter().map(|&t| [push(t, t0, WIDTH)]).collect();
        let wind = Curve::spline(&times, &values).unwrap();
        let blown = Blown::new(LENGTH, G).driven_by(wind);
        let at = [t0 + 1.0];
        macro_rules! check {
            ($($method:expr),+) => {$(
                let solution = solve(&blown, (0.0, END), [0.0], [0.0])
                    .t_eval(&at)
                    .method($method)
                    .rtol(TOLERANCE)
                    .atol(TOLERANCE)
                    .run()
                    .unwrap();
                let error = off(&solution, expected);
                // The spline itself has a small error.
                assert!(error <= 200.0, "{}, kick at {t0}: {error} tolerances", solution.stats.method);
                assert!(solution.stats.accepted < 5000, "{}: {:?}", solution.stats.method, solution.stats);
            )+};
        }
        check!(Picard, Dop853, Rodas4, Dprkn12);
    }
}

/// Two keys that nearly coincide do not shorten all steps.
#[test]
fn keys_close_together() {
    let times = [0.0, 20.0, 20.0 + 1e-9, 40.0, 60.0, 80.0, 100.0];
    let wind = Curve::spline(&times, &[[0.0], [0.1], [0.1], [0.0], [0.1], [0.0], [0.0]]).unwrap();
    let solution = solve(&Blown::new(LENGTH, G).driven_by(wind), (0.0, END), [0.1], [0.0])
        .method(Dop853)
        .run()
        .unwrap();
    assert!(solution.stats.accepted < 1000, "{:?}", solution.stats);
}

/// Without a resolution, a step is at most a fiftieth of the interval, or a second if there is no
/// interval.
#[test]
#[ignore = "tens of seconds without optimization: `.ci/run` runs it"]
fn functions_of_unknown_resolution() {
    let mut random = Random::new(11);
    for _ in 0..200 {
        let (t0, w) = (random.uniform(1.0, 8.0), 0.05);
        let wind = Function::new(move |t| [push(t, t0, w)]);
        let blown = Blown::new(LENGTH, G).driven_by(wind);
        let end = solve(&blown, (0.0, 10.0), [0.0], [0.0]).run().unwrap().end;
        assert!(0.1 < end.q[0].hypot(end.v[0]), "kick at {t0} missed");
    }
    let calm = Blown::new(LENGTH, G).driven_by(Function::new(|_| [0.0]));
    let mut run = Integrator::new(&calm, Dop853, 0.0, [0.0], [0.0]).unwrap();
    let mut longest = 0.0f64;
    for _ in 0..50 {
        let t = run.t();
        run.step().unwrap();
        longest = longest.max(run.t() - t);
    }
    assert!((longest - 1.0).abs() < 1e-12, "{longest}");
    run.advance_to(1000.0).unwrap();
    let known = Blown::new(LENGTH, G).driven_by(Function::new(|_| [0.0]).resolution(10.0).unwrap());
    let mut run = Integrator::new(&known, Dop853, 0.0, [0.0], [0.0]).unwrap();
    for _ in 0..50 {
        run.step().unwrap();
    }
    assert!(1000.0 < run.t(), "{}", run.t());
}

#[test]
fn a_resolution_is_a_positive_time() {
    for wrong in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        let refused = Function::new(|t| [t]).resolution(wrong).unwrap_err();
        assert!(
            matches!(refused, MotionError::Argument { name: "resolution", value, .. } if value.to_bits() == wrong.to_bits())
        );
    }
    let text = Function::new(|t| [t]).resolution(-1.0).unwrap_err().to_string();
    assert!(text.contains("is -1") && text.contains("positive number of seconds"), "{text}");
}

/// A motion with an invalid `longest_step`.
struct Confused(f64);

impl Motion<f64, 1> for Confused {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, _: Time, _: Side, _: Derivatives) -> Sample<f64, 1> {
        Sample::zero()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(self.0)
    }
}

#[test]
fn a_bound_that_is_none_is_refused() {
    for wrong in [0.0, -1.0, f64::NAN] {
        let blown = Blown::new(LENGTH, G).driven_by(Confused(wrong));
        let failed = solve(&blown, (0.0, 1.0), [0.1], [0.0]).run().unwrap_err();
        assert!(
            matches!(failed.error, Error::Setting { name: "longest_step", .. }),
            "{wrong}: {:?}",
            failed.error
        );
    }
}

/// A pulse that is switched off has no width; another pulse of the same system is still detected.
#[test]
fn what_is_switched_off_hides_nothing() {
    lagrangian! {
        pub struct Switched { A, k, b }
        coordinate q;
        driven f;
        kinetic = q̇^2/2;
        force q = f + A*exp(-(k*t - b)^2);
    }
    let expected = 0.01 * core::f64::consts::PI.sqrt() * 4.0;
    for b in [0.0, 1.0] {
        let gust = Function::new(|t: f64| [4.0 * (-((t - 40.123) / 0.01).powi(2)).exp()])
            .resolution(0.01)
            .unwrap();
        let switched = Switched::new(0.0, 0.0, b).driven_by(gust);
        macro_rules! check {
            ($($method:expr),+) => {$(
                let end = solve(&switched, (0.0, 45.0), [0.0], [0.0]).method($method).rtol(1e-6).atol(1e-6).run().unwrap().end;
                assert!((end.v[0] - expected).abs() < 1e-4, "b = {b}: {} for {expected}", end.v[0]);
            )+};
        }
        check!(Picard, Dop853);
    }
}
