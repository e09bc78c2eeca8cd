//! Intervals, states, parameters and tolerances far from one: finite numbers or a helpful error
//! within a short time.

use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::motion::{Function, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use std::time::{Duration, Instant};
use systems::random::some;

lagrangian! {
    /// A pendulum with a spring at its pivot, which moves: without `k` and with the pivot at rest a
    /// plain one, without `g` an oscillator.
    #[derive(Clone, Debug)]
    pub struct Swing { l, g, k }
    coordinate θ;
    driven x: [1; 2];
    let r = x + l*[sin(θ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r) + k*θ^2/2;
}

/// One run of the table.
#[derive(Clone, Copy, Debug)]
struct Case {
    interval: f64,
    q: f64,
    v: f64,
    /// The parameters l, g and k.
    parameters: [f64; 3],
    /// Of the pivot.
    amplitude: f64,
    rtol: f64,
}

/// An ordinary case, from which all other cases differ.
const PLAIN: Case =
    Case { interval: 1.0, q: 1.0, v: 0.5, parameters: [1.0, 1.0, 0.0], amplitude: 0.0, rtol: 1e-3 };

const INTERVALS: [f64; 6] = [1e-300, 1e-40, 1e-20, 1.0, 1e40, 1e300];
const NUMBERS: [f64; 6] = [1e-300, 1e-40, 1e15, 1e38, 1e150, 1e300];
const TOLERANCES: [f64; 4] = [1e-300, 1e-30, 1e-3, 0.9];

/// Returns cases with each number in each place, over each interval, and each tolerance with the
/// relevant numbers.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for interval in INTERVALS {
        let plain = Case { interval, ..PLAIN };
        let mut states = vec![
            plain,
            Case { parameters: [1.0, 0.0, 1.0], ..plain },
            Case { amplitude: 0.1, ..plain },
        ];
        for number in NUMBERS {
            let [l, g, k] = plain.parameters;
            states.extend([
                Case { q: number, ..plain },
                Case { v: -number, ..plain },
                Case { q: number, v: number, ..plain },
                Case { parameters: [number, g, k], ..plain },
                Case { parameters: [l, number, k], ..plain },
                Case { parameters: [l, g, number], ..plain },
                Case { q: number, parameters: [l, 0.0, 1.0], ..plain },
                Case { amplitude: number, ..plain },
            ]);
        }
        cases.extend(
            states.into_iter().flat_map(|case| TOLERANCES.map(|rtol| Case { rtol, ..case })),
        );
    }
    cases
}

/// The bounds of a scalar.
trait Tried: Float {
    const NAME: &'static str;
}

impl Tried for f32 {
    const NAME: &'static str = "f32";
}

impl Tried for f64 {
    const NAME: &'static str = "f64";
}

impl Tried for DoubleDouble {
    const NAME: &'static str = "DoubleDouble";
}

/// The list of complaints, with their case.
#[derive(Default)]
struct Complaints(Vec<String>);

impl Complaints {
    /// Checks the result of a run.
    fn look<T: Tried>(
        &mut self,
        name: &str,
        case: &Case,
        seconds: Duration,
        run: Result<Solution<T, 1>, Failure<T, 1>>,
    ) {
        let mut say =
            |what: String| self.0.push(format!("{name} over {}, {case:?}: {what}", T::NAME));
        if Duration::from_secs(1) < seconds {
            say(format!("took {seconds:?}"));
        }
        let (solution, error) = match run {
            Ok(solution) => (solution, None),
            Err(Failure { error, partial }) => (*partial, Some(error)),
        };
        match &error {
            None if solution.t.len() != 3 || solution.end.t != case.interval => {
                say(format!("is complete with {:?}", solution.t));
            }
            None => {}
            Some(error) => {
                let message = error.to_string();
                let hint = ["check", "give", "try", "raise", "stop", "has to be"];
                if !hint.iter().any(|word| message.contains(word)) || message.contains("NaN") {
                    say(format!("says {message}"));
                }
            }
        }
        if !(T::from_f64(case.q).is_finite() && T::from_f64(case.v).is_finite()) {
            // The scalar cannot represent such a number: the result has to be an error.
            if error.is_none() {
                say(format!("is complete with {:?}", solution.q));
            }
            return;
        }
        let states = solution.q.iter().chain(&solution.v).chain([&solution.end.q, &solution.end.v]);
        if !states.flatten().all(|x| x.is_finite()) {
            say(format!("gives {:?} {:?}, {error:?}", solution.q, solution.v));
        }
    }
}

/// Tests a method on all cases, with adaptive or with fixed steps.
macro_rules! tried {
    ($complaints:ident, $scalar:ty, $kind:ident, $($method:expr),*) => {$(
        for case in some(cases()) {
            let number = <$scalar as Real>::from_f64;
            let [l, g, k] = case.parameters.map(number);
            let swing = Swing { l, g, k }.driven_by(Sinusoid::new([0.0, case.amplitude], 3.0, [0.0, 0.5]));
            let (q, v) = ([number(case.q)], [number(case.v)]);
            let times = [0.0, case.interval / 2.0, case.interval];
            let start = Instant::now();
            let solve = solve(&swing, (0.0, case.interval), q, v).method($method).t_eval(&times).max_steps(40);
            let run = tried!(@$kind solve, case);
            $complaints.look(stringify!($method), &case, start.elapsed(), run);
        }
    )*};
    (@adaptive $solve:ident, $case:ident) => { $solve.rtol($case.rtol).run() };
    (@fixed $solve:ident, $case:ident) => { $solve.steps(3).run() };
}

macro_rules! over {
    ($(#[$attribute:meta])? $name:ident $scalar:ty) => {
        #[test]
        $(#[$attribute])?
        fn $name() {
            let mut complaints = Complaints::default();
            tried!(
                complaints,
                $scalar,
                adaptive,
                Auto,
                Picard,
                Taylor::new(),
                Dop853,
                Dprkn12,
                Rodas4
            );
            tried!(
                complaints,
                $scalar,
                fixed,
                Auto,
                Rk4,
                SymplecticEuler,
                Leapfrog,
                Srkn6b,
                Srkn14a
            );
            tried!(
                complaints,
                $scalar,
                fixed,
                Gauss::<2>::new(),
                Gauss::<2>::new().newton(),
                Picard,
                Taylor::new(),
                Dop853,
                Rodas4
            );
            let Complaints(all) = complaints;
            assert!(all.is_empty(), "{} complaints: {:#?}", all.len(), &all[..all.len().min(20)]);
        }
    };
}

over!(single f32);
over!(double f64);
over!(#[ignore = "tens of seconds without optimization: `.ci/run` runs it"] double_double DoubleDouble);

/// With coefficients of the precision of `f64`, no step has an error below a tolerance of two
/// words.
#[test]
fn tolerances_beyond_the_coefficients_come_to_an_end() {
    let number = DoubleDouble::from_f64;
    let [zero, one] = [0.0, 1.0].map(number);
    let lift =
        Function::new(|t| [0.0, t * t]).velocity(|t| [0.0, 2.0 * t]).acceleration(|_| [0.0, 2.0]);
    let lifted = Swing { l: one, g: one, k: zero }.driven_by(lift);
    let heavier =
        Swing { l: one, g: number(3.0), k: zero }.driven_by(Sinusoid::new([0.0; 2], 1.0, [0.0; 2]));
    for q in [1.0, 1e15] {
        let exact = solve(&heavier, (0.0, 1.0), [number(q)], [zero]).rtol(1e-30).run().unwrap();
        let run = solve(&lifted, (0.0, 1.0), [number(q)], [zero])
            .rtol(1e-30)
            .max_steps(1000)
            .run()
            .unwrap();
        assert_eq!((exact.stats.method, run.stats.method), ("Taylor", "Dop853"));
        let error = (run.end.q[0] - exact.end.q[0]).abs().to_f64();
        assert!(error < 1e-13 * q, "{q}: {error:e}, {}", run.stats);
    }
}

/// Over such a short time, the motion continues in a straight line.
#[test]
fn short_steps_of_single_precision_go_straight() {
    let swing =
        Swing { l: 1.0_f32, g: 1e38, k: 0.0 }.driven_by(Sinusoid::new([0.0; 2], 1.0, [0.0; 2]));
    for steps in [1, 10] {
        let run = solve(&swing, (0.0, 1e-39), [0.5], [2e38])
            .method(Rk4)
            .steps(steps)
            .every_step()
            .dense()
            .run()
            .unwrap();
        let (q, v) = (run.end.q[0], run.end.v[0]);
        assert!((q - 0.7).abs() < 1e-6 && (v - 2e38).abs() < 1e32, "{q} {v}");
        let half = run.at(0.5e-39).unwrap();
        assert!((half.q[0] - 0.6).abs() < 1e-6, "{half:?}");
    }
    let run = solve(&swing, (0.0, 1e-39), [0.5], [2e38]).run().unwrap();
    assert!((run.end.q[0] - 0.7).abs() < 1e-6);
    let back = solve(&swing, (1e-39, 0.0), [0.7], [2e38]).method(Taylor::new()).run().unwrap();
    assert!((back.end.q[0] - 0.5).abs() < 1e-6);
}
