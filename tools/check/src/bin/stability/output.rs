//! Values between steps: dense output and events. Single precision.

use crate::elliptic::Swing;
use crate::numbers::{apart, error, larger, largest, truth};
use crate::reference;
use crate::systems::{Double, Simple, Triple};
use check::report::{Report, Scale, Test};
use pendulum_runtime::integrate::Event;
use pendulum_runtime::integrate::Solution;
use pendulum_runtime::motion::Side;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S16", title: "single precision", run: single },
    Test { id: "S23", title: "dense output", run: dense },
    Test { id: "S24", title: "events", run: events },
];

fn single(scale: Scale, report: &mut Report) {
    let double = Double::new([1.0f32; 2], [1.0; 2], 1.0);
    let run = |t: f64, q: [f32; 2], steps: u64| {
        solve(&double, (0.0, t), q, [0.0; 2]).method(Rk4).steps(steps).run().unwrap().end
    };
    let off = error(&run(10.0, [2.0, 2.5], 800), &reference::at("P23", 10.0));
    report.row("P23 by Rk4, T = 10, 800 steps").at_most(off, 5e-6).because(
        "with these steps Rk4 is 5.6e-6 off in f64, and rounded forces add 1e-5: the root mean \
         square of neighbouring starts is 1e-5",
    );
    let steps = scale.pick(51_200, 512_000, 512_000);
    let end = run(100.0, [0.5, -0.25], steps);
    report
        .row(format!("P22 by Rk4, T = 100, {steps} steps"))
        .at_most(error(&end, &reference::at("P22", 100.0)), 5e-6);
    let triple = Triple::new([1.0f32; 3], [1.0; 3], 1.0);
    let run = solve(&triple, (0.0, 10.0), [1.0, 1.5, 2.0], [0.0; 3]).method(Rk4).steps(4000);
    let end = run.run().unwrap().end;
    // An error at the start grows 5e2 times until then.
    report
        .row("P28 by Rk4, T = 10, 4000 steps, against a hundred roundings amplified 500 times")
        .at_most(error(&end, &reference::at("P28", 10.0)), 100.0 * 500.0 * 6e-8);
}

fn dense(_: Scale, report: &mut Report) {
    let system = Double::new([1.0; 2], [1.0; 2], 1.0);
    let wide = system.map(DoubleDouble::from);
    let (q, v, tolerance) = ([2.0, 2.5], [0.0; 2], 1e-9);
    let check = |solution: &Solution<f64, 2>| {
        // Each step is compared with the exact motion from its own start, at points that no method
        // uses.
        let (mut within, mut jump, mut points) = (0.0, 0.0, 0);
        let steps = solution.t.len() - 1;
        for k in 0..steps {
            let (from, to) = (solution.t[k], solution.t[k + 1]);
            let exact = truth(&wide, (from, to), solution.q[k], solution.v[k]);
            let count = 1000 / steps + 1;
            for j in 1..=count {
                let t = from + (to - from) * (j as f64 - 0.5) / count as f64;
                let (found, exact) = (solution.at(t).unwrap(), exact.at(t).unwrap());
                // The norm is the one in which steps are accepted.
                let off = |found: &f64, exact: &DoubleDouble| {
                    let apart = (DoubleDouble::from(*found) - *exact).to_f64();
                    (apart / (tolerance * (1.0 + exact.to_f64().abs()))).powi(2)
                };
                let pairs = found.q.iter().zip(&exact.q).chain(found.v.iter().zip(&exact.v));
                let squares = pairs.map(|(a, b)| off(a, b)).sum::<f64>();
                within = larger(within, (squares / 4.0).sqrt());
                points += 1;
            }
            if 0 < k {
                let side = |side| solution.at_side(from, side).unwrap();
                jump = larger(jump, apart(&side(Side::Before), &side(Side::After)));
            }
        }
        (within, jump, points)
    };
    let problem = || {
        let problem = solve(&system, (0.0, 10.0), q, v).method(Dop853).every_step().dense();
        problem.rtol(tolerance).atol(tolerance)
    };
    let found = [
        ("Dop853", check(&problem().run().unwrap())),
        ("Taylor", check(&problem().method(Taylor::new()).run().unwrap())),
        ("Picard", check(&problem().method(Picard).run().unwrap())),
    ];
    for (name, (within, jump, points)) in found {
        let row = report
            .row(format!("{name}: {points} points between steps, local error over tolerance 1e-9"));
        row.at_most(within, 1.0).because(
            "the interpolant has a lower order than the step and bounds its own error nowhere; \
             shorten steps with `max_step`",
        );
        report.row(format!("{name}: jump at the ends of steps")).at_most(jump, 4e-15);
    }
}

fn events(_: Scale, report: &mut Report) {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    let up = [Event::new(|_, q, _| q[0] - core::f64::consts::PI).terminal()];
    let problem = || solve(&double, (0.0, 20.0), [2.0, 2.5], [0.0; 2]).events(&up);
    let off = |found: Solution<f64, 2>| (found.events[0].state.t - reference::FLIP).abs();
    let found = problem().method(Taylor::new()).rtol(1e-18).run().unwrap();
    report.row("flip of P23 by Taylor").at_most(off(found), 1e-13);
    let found = problem().method(Dop853).rtol(1e-13).atol(1e-13).run().unwrap();
    // 5e3 is the growth of an error at the start until then.
    report.row("by Dop853, rtol 1e-13, against 5e3 tolerances").at_most(off(found), 5e-10);

    let simple = Simple::new(1.0);
    let period = Swing::from(1.3).period().to_f64();
    // The angle touches 1.3 rad once per period. The start is not an event.
    let touch = Event::new(|_, q, _| q[0] - 1.3);
    let rest = Event::new(|_, _, v| v[0]).falling();
    // The angle passes 1.299 rad twice around each extreme, 0.1 s apart and within a single step.
    let twice = Event::new(|_, q, _| q[0] - 1.299);
    let run = solve(&simple, (0.0, 10.5 * period), [1.3], [0.0]).method(Taylor::new()).rtol(1e-18);
    let solution = run.events([touch, rest, twice]).run().unwrap();
    let times = |event: usize| -> Vec<f64> {
        let found = solution.events.iter().filter(|found| found.event == event);
        found.map(|found| found.state.t).collect()
    };
    let worst = |times: &[f64]| {
        largest(times.iter().enumerate().map(|(k, t)| (t - (k as f64 + 1.0) * period).abs()))
    };
    let (touching, resting, pairs) = (times(0), times(1), times(2));
    report.row("ten grazings, ten returns, 21 passages in pairs, none at the start").failures([
        touching.len() == 10,
        resting.len() == 10,
        pairs.len() == 21,
    ]);
    report
        .row("grazings: error of the time, known to the root of rounding")
        .at_most(worst(&touching), 1e-7);
    report.row("returns: error of the time").at_most(worst(&resting), 1e-13);
    let steps = solution.stats.accepted as f64 / 10.5;
    report.row("steps in a period, so that a pair falls within one").at_most(steps, 40.0);
    let cross = |t: f64| (Swing::from(1.3).at(t)[0] - DoubleDouble::from(1.299)).to_f64().abs();
    report
        .row("pairs: distance of the angle from where it should be")
        .at_most(largest(pairs.iter().map(|&t| cross(t))), 1e-14);
}
