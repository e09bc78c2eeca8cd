//! Nearly singular mass matrices, parameters of all magnitudes, collapsing steps.

use crate::numbers::{dop853, error, error_from, larger, largest, truth};
use crate::reference;
use crate::systems::{Arenstorf, Double, Elastic, Kepler};
use check::report::{Report, Scale, Test};
use pendulum_runtime::error::{Error, Quantity};
use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::System;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S4", title: "near-singular mass matrix", run: near_singular },
    Test { id: "S5", title: "singular mass matrix", run: singular },
    Test { id: "S6", title: "parameter ratios", run: ratios },
    Test { id: "S14", title: "step collapse", run: collapse },
];

fn near_singular(_: Scale, report: &mut Report) {
    let light = |exponent: i32| Double::new([0.5f64.powi(exponent), 1.0], [1.0; 2], 1.0);
    for (t, exact) in &reference::rows("P26") {
        let end = dop853(&light(10), (0.0, *t), [0.5, 0.625], [0.0; 2], 1e-14).end;
        // The condition number of the mass matrix for aligned links is 2/m.
        report
            .row(format!("P26, upper mass 2^-10, Dop853 at t = {t}, against the condition"))
            .at_most(error(&end, exact), 2048.0 * f64::EPSILON);
    }
    let (mut worst, mut steps) = (0.0, 0.0);
    for exponent in [20, 40, 52] {
        // Twenty periods of the fast link, whose frequency is 1/√m times that of the slow link.
        let (system, t) = (light(exponent), 126.0 * 0.5f64.powi(exponent / 2));
        let exact = truth(&system.map(DoubleDouble::from), (0.0, t), [0.5, 0.625], [0.0; 2]).end;
        let scales = |v: f64| 1e-12 * v;
        let speed = 2.0f64.powi(exponent / 2);
        let problem = solve(&system, (0.0, t), [0.5, 0.625], [0.0; 2])
            .method(Dop853)
            .rtol(1e-12)
            .atol_each([scales(t); 2], [scales(1.0 / speed); 2]);
        let end = problem.run().unwrap();
        let condition = 2.0 / (system.m[0] + 0.125f64.sin().powi(2));
        worst = larger(worst, error_from(&end.end, &exact) / (1e-12 * condition));
        steps = larger(steps, end.stats.accepted as f64);
    }
    report
        .row("upper masses 2^-20, 2^-40, 2^-52: error in condition × rtol 1e-12")
        .at_most(worst, 1.0);
    report.row("steps for twenty periods of the fast link").at_most(steps, 2000.0);

    // Nearly aligned links: Δ has an error of ε, so that no formula is more accurate than ε/Δ. The
    // generated determinant m₁ + m₂ sin² Δ has this accuracy; m₁ + m₂ − m₂ cos² Δ would have only
    // ε/Δ².
    let (mut sine, mut cosine) = (0.0f64, 0.0f64);
    for exponent in 1..=24 {
        let (system, gap) = (light(52), 0.7 * 0.5f64.powi(exponent));
        let (q, v) = ([0.5, 0.5 + gap], [0.25, 0.25]);
        let found = system.accelerations(At::of(0.0, &q, &v));
        let wide = system.map(DoubleDouble::from).accelerations(At::of(
            0.0.into(),
            &q.map(DoubleDouble::from),
            &v.map(DoubleDouble::from),
        ));
        let size = largest(wide.map(|a| a.to_f64().abs()));
        let apart =
            largest((0..2).map(|i| (DoubleDouble::from(found[i]) - wide[i]).to_f64().abs() / size));
        sine = larger(sine, apart * gap / f64::EPSILON);
        let (m, difference) = (system.m, q[0] - q[1]);
        let exact = m[0] + m[1] * difference.sin().powi(2);
        cosine = cosine.max(
            ((m[0] + m[1]) - m[1] * difference.cos().powi(2) - exact).abs() / exact * gap
                / f64::EPSILON,
        );
    }
    report
        .row("accelerations of aligned links, Δ down to 4e-8, upper mass 2^-52: error in ε/Δ")
        .at_most(sine, 4.0);
    let row = report.row("the determinant with cos² for comparison, in ε/Δ");
    row.between(cosine, 1e3, f64::INFINITY);
}

fn finite(state: &State<f64, 2>) -> bool {
    state.q.iter().chain(&state.v).all(|x| x.is_finite())
}

/// Returns `true` if an integration ended with an error about an acceleration that names the
/// coordinate, and with a finite state.
fn refused(result: Result<Solution<f64, 2>, Failure<f64, 2>>) -> bool {
    let Err(failure) = result else { return false };
    finite(&failure.partial.end)
        && matches!(failure.error, Error::NotFinite { what: Quantity::Acceleration(coordinate) | Quantity::Series(coordinate), .. } if !coordinate.name.is_empty())
}

fn singular(_: Scale, report: &mut Report) {
    let massless = Double::new([0.0, 1.0], [1.0; 2], 1.0);
    let problem = || solve(&massless, (0.0, 1.0), [0.5, 0.5], [0.0; 2]).method(Dop853);
    report
        .row("m₁ = 0 and Δ = 0: an error that names the coordinate, with the state before")
        .failures([
            refused(problem().run()),
            refused(problem().method(Rk4).step(0.01).run()),
            refused(problem().method(Taylor::new()).rtol(1e-12).run()),
            refused(problem().method(Picard).rtol(1e-12).run()),
        ]);
    let still = Double::new([1.0, 0.0], [1.0; 2], 1.0);
    report
        .row("m₂ = 0: the same")
        .failures([refused(solve(&still, (0.0, 1.0), [0.5, 0.25], [0.0; 2]).method(Dop853).run())]);
    // The links become aligned during the motion. Either the step control stops before, or the run
    // continues with finite numbers.
    let crossing = solve(&massless, (0.0, 1.0), [0.5, 0.625], [0.0, -1.0]).method(Dop853);
    let end = crossing
        .max_steps(1_000_000)
        .run()
        .map_or_else(|failure| failure.partial.end, |run| run.end);
    report
        .row("m₁ = 0 and links that line up on the way: no NaN in any state")
        .failures([finite(&end)]);
    let negative = |m| {
        let system = Double::new(m, [1.0; 2], 1.0);
        let problem = || solve(&system, (0.0, 1.0), [0.5, 0.625], [0.0; 2]);
        [
            unbounded(problem().method(Dop853).run()),
            unbounded(problem().method(Rk4).step(0.01).run()),
            unbounded(problem().method(Taylor::new()).rtol(1e-12).run()),
            unbounded(problem().method(Picard).rtol(1e-12).run()),
            unbounded(problem().method(Gauss::<2>::new()).step(0.01).run()),
        ]
    };
    let row = report.row(
        "m₁ = −2, m₂ = −½, both −1, a negative pivot: an error before the first step that names \
         the coordinate, five methods",
    );
    row.failures([[-2.0, 1.0], [1.0, -0.5], [-1.0, -1.0]].map(negative).concat());
}

/// Returns `true` if an integration ended immediately with an error about negative inertia that
/// names the coordinate, and with the initial state.
fn unbounded(result: Result<Solution<f64, 2>, Failure<f64, 2>>) -> bool {
    let Err(failure) = result else { return false };
    let kept = (failure.partial.end.t, failure.partial.end.q) == (0.0, [0.5, 0.625]);
    kept && matches!(failure.error, Error::NegativeInertia { t: 0.0, coordinate, .. } if !coordinate.name.is_empty())
}

fn ratios(_: Scale, report: &mut Report) {
    // The same motion in other units of mass, length and time: m, k and l from 1e-12 to 1e12.
    let reference = elastic(1.0, 1.0, 1.0);
    let mut worst = 0.0;
    for exponents in [
        [-12, 0, 0],
        [12, 0, 0],
        [0, -12, 0],
        [0, 12, 0],
        [0, 0, -6],
        [0, 0, 6],
        [-12, 12, 6],
        [12, -12, -6],
        [12, 12, 6],
    ] {
        let [mass, length, time] = exponents.map(|exponent: i32| 10f64.powi(exponent));
        let found = elastic(mass, length, time);
        worst = larger(worst, largest((0..4).map(|i| (found[i] - reference[i]).abs())));
    }
    report.row("P32 in units of 1e-12 to 1e12: dimensionless difference").at_most(worst, 1e-13);
    let reference = double(1.0, 1.0);
    let mut worst = 0.0;
    for (mass, length) in [
        (1e-12, 1.0),
        (1e12, 1.0),
        (1.0, 1e-12),
        (1.0, 1e12),
        (1e12, 1e-12),
        (1e-300, 1.0),
        (1e300, 1.0),
        (1.0, 1e-300),
        (1.0, 1e300),
    ] {
        let found = double(mass, length);
        worst = larger(worst, largest((0..4).map(|i| (found[i] - reference[i]).abs())));
    }
    report
        .row("P22 with masses and lengths (and gravity) of 1e±12 and 1e±300: difference")
        .at_most(worst, 1e-13);
    // Powers of two do not change any digit.
    let binary = double(0.5f64.powi(40), 2.0f64.powi(70));
    report.row("P22 in units of powers of two: the same bits").failures([binary == reference]);

    let hung = |g: f64, t: f64, v: f64| {
        let system = Double::new([1.0; 2], [1.0; 2], g);
        let problem = solve(&system, (0.0, t), [0.5, -0.25], [v; 2])
            .method(Dop853)
            .rtol(1e-13)
            .atol_each([1e-13; 2], [1e-13 * g.sqrt().max(1.0); 2]);
        problem.run().map(|solution| solution.end)
    };
    let (free, faint, heavy) =
        (hung(0.0, 10.0, 0.5), hung(1e-300, 10.0, 0.5), hung(1e300, 1e-149, 0.0));
    let weight = hung(1.0, 10.0, 0.0).unwrap();
    report
        .row("g = 0 and g = 1e-300: the same motion")
        .failures([matches!((free, faint), (Ok(a), Ok(b)) if a.q == b.q && a.v == b.v)]);
    let apart =
        heavy.map_or(f64::NAN, |end| largest((0..2).map(|i| (end.q[i] - weight.q[i]).abs())));
    report.row("g = 1e300 against g = 1").at_most(apart, 1e-11);
}

/// Integrates P32 in other units of mass, length and time. Returns the final state in the units of
/// the problem.
fn elastic(mass: f64, length: f64, time: f64) -> [f64; 4] {
    let system = Elastic::new(mass, 8.0 * mass / (time * time), length, length / (time * time));
    let (q, v) = ([1.25 * length, 1.0], [0.0; 2]);
    let speed = [1e-15 * length / time, 1e-15 / time];
    let problem = solve(&system, (0.0, 2.0 * time), q, v)
        .method(Dop853)
        .rtol(1e-14)
        .atol_each([1e-15 * length, 1e-15], speed);
    problem.run().map_or([f64::NAN; 4], |solution| {
        let end = solution.end;
        [end.q[0] / length, end.q[1], end.v[0] * time / length, end.v[1] * time]
    })
}

/// Integrates P22 with scaled masses and lengths, and with gravity scaled like the lengths.
fn double(mass: f64, length: f64) -> [f64; 4] {
    let system = Double::new([mass; 2], [length; 2], length);
    let problem =
        solve(&system, (0.0, 2.0), [0.5, -0.25], [0.0; 2]).method(Dop853).rtol(1e-14).atol(1e-15);
    problem.run().map_or([f64::NAN; 4], |solution| {
        [solution.end.q[0], solution.end.q[1], solution.end.v[0], solution.end.v[1]]
    })
}

fn collapse(_: Scale, report: &mut Report) {
    let kepler = Kepler::new(1.0);
    // Straight into the sun, which is reached after π/(2√2) s from rest at distance 1.
    let fall = |solution: Result<Solution<f64, 2>, Failure<f64, 2>>| match solution {
        Ok(solution) => (false, solution.stats.accepted + solution.stats.rejected),
        Err(failure) => {
            let stats = &failure.partial.stats;
            let typed =
                matches!(failure.error, Error::StepSizeUnderflow { .. } | Error::NotFinite { .. });
            let near = (failure.partial.end.t - core::f64::consts::PI / 8.0f64.sqrt()).abs() < 1e-3;
            (typed && near, stats.accepted + stats.rejected)
        }
    };
    let problem = || solve(&kepler, (0.0, 2.0), [1.0, 0.0], [0.0; 2]).method(Dop853);
    let found = [
        fall(problem().run()),
        fall(problem().method(Taylor::new()).rtol(1e-12).run()),
        fall(problem().method(Picard).rtol(1e-12).run()),
        fall(problem().method(Rodas4).run()),
    ];
    report
        .row("a fall into the centre ends with an error where it happens, four methods")
        .failures(found.map(|found| found.0));
    report
        .row("the steps it takes until then")
        .at_most(largest(found.map(|found| found.1 as f64)), 10_000.0);

    let gap = 1e-12;
    let fastest = [0.0, ((2.0 - gap) / gap).sqrt()];
    let around = solve(&kepler, (0.0, core::f64::consts::TAU), [gap, 0.0], fastest);
    let around = around.method(Dop853).rtol(1e-10);
    let steps = match around.run() {
        Ok(solution) => solution.stats.accepted + solution.stats.rejected,
        Err(failure) => failure.partial.stats.accepted + failure.partial.stats.rejected,
    };
    report
        .row("Kepler with e = 1 − 1e-12, one orbit: steps or an error, in steps")
        .at_most(steps as f64, 10_000.0);

    let orbit = Arenstorf::new();
    let (q, v, period) =
        ([0.994, 0.0], [0.0, -2.00158510637908252240537862224], 17.0652165601579625588917206249);
    let close = |solution: Solution<f64, 2>| {
        (
            largest([(solution.end.q[0] - 0.994).abs(), solution.end.q[1].abs()]),
            solution.stats.accepted + solution.stats.rejected,
        )
    };
    let taylor =
        close(solve(&orbit, (0.0, period), q, v).method(Taylor::new()).rtol(1e-18).run().unwrap());
    let dop853 = close(dop853(&orbit, (0.0, period), q, v, 1e-13));
    // The start is rounded to 1e-16; a period amplifies the rounding error.
    let near = truth(&orbit.map(DoubleDouble::from), (0.0, period), q, v).end;
    let rounded = largest([(near.q[0].to_f64() - 0.994).abs(), near.q[1].to_f64().abs()]);
    let row = report.row(
        "P41 closes after a period by Taylor, against ten times what the rounded start does to it",
    );
    row.at_most(taylor.0, 10.0 * rounded);
    report.row("P41 by Dop853, rtol 1e-13").at_most(dop853.0, 1e-5);
    report.row("its steps by either").at_most(largest([taylor.1 as f64, dop853.1 as f64]), 1000.0);
}
