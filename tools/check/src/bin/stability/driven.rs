//! Driven motions: fast shaking, kinks, square waves, values that are not finite, late times.

use crate::numbers::{dop853, error, error_from, fixed, larger, largest, stepping, taylor, truth};
use crate::reference;
use crate::systems::{Effective, Hung, Kapitza, Simple};
use ::systems::keys::keys;
use check::report::{Figure, Report, Scale, Test};
use pendulum_runtime::error::{Error, Quantity};
use pendulum_runtime::integrate::Failure;
use pendulum_runtime::motion::{Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Lanes, Real};
use pendulum_runtime::time::Time;
use std::sync::Mutex;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S7", title: "fast shaking", run: shaking },
    Test { id: "S12", title: "numbers that are none", run: not_finite },
    Test { id: "S13", title: "keyed motions", run: keyed },
    Test { id: "S15", title: "intervals and late times", run: intervals },
    Test { id: "S27", title: "square waves", run: square },
];

/// Returns the motion y = (4/Ω) cos Ωt.
fn shaken(frequency: f64) -> Sinusoid<1> {
    Sinusoid::new([4.0 / frequency], frequency, [core::f64::consts::FRAC_PI_2])
}

fn shaking(scale: Scale, report: &mut Report) {
    let system = Kapitza::new();
    for (t, exact) in &reference::rows("P11") {
        let driven = system.map(|x| x).driven_by(shaken(32.0));
        let end = taylor(&driven, (0.0, *t), [3.0], [0.0], 1e-16);
        report.row(format!("P11, Ω = 32, Taylor at t = {t}")).at_most(error(&end, exact), 1e-12);
    }
    let driven = |frequency| Kapitza::new().driven_by(shaken(frequency));
    let fast = driven(1e3);
    let exact =
        truth(&Kapitza::<DoubleDouble>::new().driven_by(shaken(1e3)), (0.0, 1.0), [3.0], [0.0]).end;
    let end = dop853(&fast, (0.0, 1.0), [3.0], [0.0], 1e-12).end;
    report
        .row("Ω = 1e3, Dop853, rtol 1e-12, against two words at t = 1")
        .at_most(error_from(&end, &exact), 1e-8);

    let frequencies = [1e3, 1e4, scale.pick(2e4, 1e5, 1e5)];
    let runs = frequencies.map(|frequency| {
        let dynamics = driven(frequency);
        let solution = dop853(&dynamics, (0.0, 5.0), [3.0], [0.0], 1e-9);
        (solution.stats.evaluations as f64, solution.end.q[0])
    });
    let growth = (runs[2].0 / runs[0].0) / (frequencies[2] / frequencies[0]);
    report
        .row("evaluations against Ω, Dop853, up to 1e5: ratio of their growths")
        .between(growth, 0.5, 1.5);

    // Q̈ = −sin Q − (AΩ)²/2 sin Q cos Q, from Q(0) = q(0) + A sin q(0). The difference at equal
    // times is of order A = 4/Ω.
    let effective = Effective::new(4.0);
    let mean = runs.map(|run| run.1);
    let off: Vec<f64> = (0..3)
        .map(|k| {
            let a = 4.0 / frequencies[k];
            let start = 3.0 + a * 3.0f64.sin();
            let slow = dop853(&effective, (0.0, 5.0), [start], [0.0], 1e-12).end.q[0];
            (mean[k] - slow).abs() * frequencies[k]
        })
        .collect();
    report
        .row("distance from the motion in the effective potential, times Ω")
        .at_most(largest(off.iter().copied()), 4.0);

    let coarse =
        solve(&fast, (0.0, 1.0), [3.0], [0.0]).method(Rk4).step(core::f64::consts::PI / 1e3).run();
    report.row("half a period as a fixed step is refused").failures([coarse.is_err()]).because(
        "fixed steps are taken as they are asked for: what is too long for Rk4 is short for Gauss<8>; adaptive methods find out",
    );
}

/// A place or velocity that stays zero.
type Zero = fn(f64) -> [f64; 2];

/// Returns a motion that stays at the origin while its acceleration along x is `push`.
fn pushed(push: impl Fn(f64) -> f64) -> Function<Zero, Zero, impl Fn(f64) -> [f64; 2]> {
    let zero: Zero = |_| [0.0; 2];
    Function::new(zero).velocity(zero).acceleration(move |t| [push(t), 0.0])
}

fn hung() -> Hung<f64> {
    Hung::new(0.5, 9.81)
}

/// Returns `true` if the failure names the input and a time in this range, and provides a finite
/// state before it.
fn blames(failure: Result<(), Failure<f64, 1>>, (from, to): (f64, f64)) -> bool {
    let Err(Failure {
        error: Error::NotFinite { t, what: Quantity::Input { name, .. }, .. },
        partial,
    }) = failure
    else {
        return false;
    };
    let end = &partial.end;
    name == "x"
        && from <= t
        && t <= to
        && end.t <= t
        && end.q[0].is_finite()
        && end.v[0].is_finite()
}

fn not_finite(_: Scale, report: &mut Report) {
    let mut cases = Vec::new();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (from, to) in [(0.0, 0.001), (0.5, 0.504), (0.999, 2.0)] {
            let push = move |t: f64| if from <= t && t < to { bad } else { (5.0 * t).sin() };
            let driven = hung().driven_by(pushed(push));
            let problem = || solve(&driven, (0.0, 2.0), [0.3], [0.0]);
            cases.extend(
                [
                    problem().method(Rk4).step(0.002).run(),
                    problem().method(Srkn6b).step(0.002).run(),
                    problem().method(Dop853).max_step(0.002).run(),
                ]
                .map(|run| blames(run.map(drop), (from, to))),
            );
        }
    }
    report
        .row(format!(
            "NaN and ±∞ in the drive, at t = 0 and later, {} runs: the error names input and time",
            cases.len()
        ))
        .failures(cases);

    // With a first step that is far too long, the invalid samples occur in a step that would be
    // rejected in any case.
    let push = |t: f64| if 0.9 < t && t < 0.91 { f64::NAN } else { (40.0 * t).sin() * 50.0 };
    let driven = hung().driven_by(pushed(push));
    let mut run = Integrator::new(&driven, Dop853, 0.0, [0.3], [0.0]).unwrap();
    let mut kept = false;
    for _ in 0..100_000 {
        let before = run.state();
        if run.step().is_err() {
            kept = run.state() == before && before.q[0].is_finite();
            break;
        }
    }
    report.row("after the error the state is the one before the step").failures([kept]);

    let lanes = Simple::new(Lanes([1.0, f64::NAN, f64::INFINITY, 1.0])).accelerations(At::of(
        Lanes::splat(0.0),
        &[Lanes([0.5, 0.5, 0.0, 0.25])],
        &[Lanes::splat(0.0)],
    ))[0];
    let alone = |q: f64| Simple::new(1.0).accelerations(At::of(0.0, &[q], &[0.0]))[0];
    report.row("a lane that fails leaves its neighbours alone").failures([
        lanes.0[0] == alone(0.5),
        lanes.0[3] == alone(0.25),
        lanes.0[1].is_nan(),
        !lanes.0[2].is_finite(),
    ]);
}

fn keyed(_: Scale, report: &mut Report) {
    let (times, values) = keys();
    let linear = hung().driven_by(Curve::linear(&times, &values).unwrap());
    let smooth = hung().driven_by(Curve::catmull_rom(&times, &values).unwrap());
    // The same curve without declared keys.
    let hidden = {
        let motion = Curve::catmull_rom(&times, &values).unwrap();
        let at = move |t: f64| -> Sample<f64, 2> {
            motion.sample(Time::new(t), Side::After, Derivatives::ALL)
        };
        let (a, b) = (at.clone(), at.clone());
        hung().driven_by(
            Function::new(move |t| at(t).position)
                .velocity(move |t| a(t).velocity)
                .acceleration(move |t| b(t).acceleration),
        )
    };
    let steps = [1u32, 2, 4, 8, 16, 32];
    macro_rules! errors {
        ($dynamics:expr, $method:expr, $exact:expr, $offset:expr) => {
            steps.map(|count| {
                let h = 1.0 / (24.0 * f64::from(count)) * $offset;
                let end = fixed($dynamics, (0.0, 5.0), [0.3], [0.0], $method, h);
                (h, (end.q[0] - $exact).abs())
            })
        };
    }
    let [line, curve] = reference::KEYED;
    // The bars are the errors of a program written by hand, to two digits.
    let found = [
        ("Leapfrog, lines", errors!(&linear, Leapfrog, line, 1.0), 3.25e-3, 1.95e-4),
        ("Srkn6b, lines", errors!(&linear, Srkn6b, line, 1.0), 2.65e-8, 1.05e-10),
        ("Leapfrog, curves", errors!(&smooth, Leapfrog, curve, 1.0), 7.45e-3, 5.15e-4),
        ("Srkn6b, curves", errors!(&smooth, Srkn6b, curve, 1.0), 3.35e-7, 1.35e-9),
    ];
    for (name, errors, one, four) in found {
        report.row(format!("{name}, a step a key")).at_most(errors[0].1, one);
        report.row(format!("{name}, four steps a key")).at_most(errors[2].1, four);
        // The reference has twelve digits.
        let shown = errors.into_iter().filter(|point| 2e-12 < point.1);
        report.curve(Figure::Kinks, name, shown.collect());
    }
    report.curve(Figure::Kinks, "Rk4, lines", errors!(&linear, Rk4, line, 1.0).to_vec());
    report.curve(Figure::Kinks, "Rk4, curves", errors!(&smooth, Rk4, curve, 1.0).to_vec());
    let points = errors!(&hidden, Rk4, curve, 0.93).to_vec();
    report.curve(Figure::Kinks, "Rk4, curves whose keys are hidden", points);
    report
        .row("Dop853, lines, rtol 1e-12")
        .at_most((dop853(&linear, (0.0, 5.0), [0.3], [0.0], 1e-12).end.q[0] - line).abs(), 1e-11);

    // A teleport: the pivot jumps to another place with the same velocity, and the pendulum moves
    // with it.
    let jump = |t: f64| if t < 0.5 { 0.0 } else { 10.0 };
    let motion = |kinks: &[f64]| {
        Function::new(move |t| [jump(t), 0.0])
            .velocity(|_| [0.0; 2])
            .acceleration(|_| [0.0; 2])
            .kinks(kinks)
    };
    let still = hung().driven_by(pushed(|_| 0.0));
    let away = hung().driven_by(motion(&[0.5]));
    let [here, there] = [
        fixed(&still, (0.0, 1.0), [0.3], [0.0], Srkn6b, 1.0 / 64.0),
        fixed(&away, (0.0, 1.0), [0.3], [0.0], Srkn6b, 1.0 / 64.0),
    ];
    report
        .row("a teleport moves the pendulum along and changes nothing else, bit for bit")
        .failures([there == here]);

    // Keys that are a nanosecond apart, a pause, and keys that coincide.
    let times = [0.0, 0.25, 0.25 + 1e-9, 0.5, 0.75, 1.0];
    let values = [[0.0, 0.0], [0.1, 0.0], [0.1 + 1e-9, 0.0], [0.1, 0.05], [0.1, 0.05], [0.0, 0.0]];
    let dense = hung().driven_by(Curve::linear(&times, &values).unwrap());
    let sparse = hung().driven_by(
        Curve::linear(
            &[0.0, 0.25, 0.5, 0.75, 1.0],
            &[values[0], values[1], values[3], values[4], values[5]],
        )
        .unwrap(),
    );
    let run = |dynamics: &_| dop853(dynamics, (0.0, 1.0), [0.3], [0.0], 1e-12).end.q[0];
    report
        .row("two keys 1e-9 s apart with 1e-9 m between them, and a pause: difference")
        .at_most((run(&dense) - run(&sparse)).abs(), 1e-8);
    let twice = Curve::linear(&[0.0, 0.5, 0.5], &[[0.0; 2]; 3]);
    report.row("keys at one time are refused").failures([twice.is_err()]);
}

/// A motion that records the difference between its sample times, relative to a late origin, and
/// multiples of half a step.
struct Clock<'a> {
    origin: f64,
    step: f64,
    worst: &'a Mutex<f64>,
}

impl<T: Real> Motion<T, 2> for Clock<'_> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, _: Side, _: Derivatives) -> Sample<T, 2> {
        let halves = 2.0 * t.since(self.origin) / self.step;
        let mut worst = self.worst.lock().unwrap();
        *worst = larger(*worst, (halves - halves.round()).abs() * 0.5 / halves.abs().max(1.0));
        Sample::zero()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

fn intervals(_: Scale, report: &mut Report) {
    let system = Simple::new(1.0);
    let run = |start: f64, end: f64| {
        solve(&system, (start, end), [1.3], [0.0]).method(Rk4).step(0.01).run()
    };
    let here = run(3.0, 3.0).map(|solution| (solution.end.t, solution.end.q[0], solution.end.v[0]));
    report
        .row("an interval of length zero gives the start")
        .failures([matches!(here, Ok((t, q, v)) if t == 3.0 && q == 1.3 && v == 0.0)]);
    let bad = [
        (0.0, f64::INFINITY),
        (f64::NEG_INFINITY, 0.0),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (-1e308, 1e308),
    ];
    report.row("infinite and undefined intervals are refused").failures(bad.map(|(start, end)| {
        matches!(run(start, end), Err(Failure { error: Error::Interval { .. }, .. }))
    }));
    let ends = [(0.0, 0.1), (0.1, 0.7), (1e9, 1e9 + 1.0 / 3.0), (-7.3, 1e-300), (0.0, 1e-9)];
    let exact = ends.map(|(start, end)| run(start, end).is_ok_and(|run| run.end.t == end));
    report.row("the last state is at the end, exactly").failures(exact);

    let worst = Mutex::new(0.0);
    let clock = Clock { origin: 1e9, step: 1.0 / 60.0, worst: &worst };
    let driven = hung().driven_by(clock);
    let mut run = stepping(&driven, Rk4, 1e9, [0.3], [0.0], 1.0 / 60.0);
    for _ in 0..60_000 {
        run.step().unwrap();
    }
    // The times at which the drive is sampled after 10⁹ s, relative to the elapsed times.
    let row = report.row(
        "times of the drive after 1e9 s, steps of 1/60 s: error relative to a step or the time \
         passed",
    );
    row.at_most(*worst.lock().unwrap(), f64::EPSILON);

    // The same keys 10⁹ s later result in the same swing.
    let (times, values) = keys();
    let late: Vec<f64> = times.iter().map(|t| (t * 24.0).round() / 32.0 + 1e9).collect();
    let soon: Vec<f64> = late.iter().map(|t| t - 1e9).collect();
    let swing = |start: f64, times: &[f64]| {
        let driven = hung().driven_by(Curve::catmull_rom(times, &values).unwrap());
        fixed(&driven, (start, start + 5.0), [0.3], [0.0], Srkn6b, 1.0 / 64.0).q[0]
    };
    report
        .row("a keyed swing 1e9 s later: difference")
        .at_most((swing(1e9, &late) - swing(0.0, &soon)).abs(), 1e-14);
}

fn square(_: Scale, report: &mut Report) {
    // A velocity of ±1 m/s whose sign changes 2000 times a second.
    let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 5e-4).collect();
    let values: Vec<[f64; 2]> =
        (0..=2000).map(|k| [if k % 2 == 0 { 0.0 } else { 5e-4 }, 0.0]).collect();
    let known = hung().driven_by(Curve::linear(&times, &values).unwrap());
    let mut rejected = 0.0;
    let mut cost = 0.0;
    macro_rules! run {
        ($dynamics:expr, $method:expr) => {{
            let stats = solve($dynamics, (0.0, 1.0), [0.3], [0.0])
                .method($method)
                .rtol(1e-8)
                .atol(1e-8)
                .run()
                .unwrap()
                .stats;
            (stats.rejected as f64 / stats.accepted as f64, stats.accepted as f64 / 2000.0)
        }};
    }
    for (storm, steps) in [run!(&known, Dop853), run!(&known, Rodas4)] {
        (rejected, cost) = (larger(rejected, storm), larger(cost, steps));
    }
    report
        .row("1 kHz, keys known: rejected over accepted steps, two methods")
        .at_most(rejected, 0.5);
    report.row("steps between two keys").at_most(cost, 2.0);
    // A force that jumps 2000 times a second.
    let kinks: Vec<f64> = (1..2000).map(|k| f64::from(k) * 5e-4).collect();
    let push = |t: f64| if ((t / 5e-4).floor() as i64) % 2 == 0 { 100.0 } else { -100.0 };
    let known = hung().driven_by(pushed(push).kinks(&kinks));
    let hidden = hung().driven_by(pushed(push));
    let (storm, _) = run!(&known, Dop853);
    report.row("±100 m/s² at 1 kHz, kinks declared").at_most(storm, 0.5);
    let (storm, _) = run!(&hidden, Dop853);
    report.row("the same, kinks hidden (for comparison)").between(storm, 0.0, f64::INFINITY);
}
