//! Sensitive motions: the separatrix, chaos, and motions there and back.

use crate::numbers::{
    apart, error, error_from, fixed, larger, largest, line, stepping, taylor, truth,
};
use crate::reference;
use crate::systems::{Double, Simple, Upright};
use check::report::{Figure, Report, Scale, Test};
use pendulum_runtime::integrate::{Event, State};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Real};

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S8", title: "separatrix", run: separatrix },
    Test { id: "S9", title: "chaos", run: chaos },
    Test { id: "S10", title: "there and back", run: back },
];

const UNIT: f64 = 0.5 * f64::EPSILON;

fn separatrix(_: Scale, report: &mut Report) {
    // From the bottom with exactly the energy at the top: q = 4 atan eᵗ − π, q̇ = 2 sech t.
    let system = Simple::new(1.0);
    let mut worst = 0.0;
    for t in [1.0, 5.0, 10.0, 20.0, 30.0] {
        let end = taylor(&system, (0.0, t), [0.0], [2.0], 1e-18);
        let e = DoubleDouble::from(t).exp();
        let (one, two, four) =
            (DoubleDouble::from(1.0), DoubleDouble::from(2.0), DoubleDouble::from(4.0));
        let exact =
            State { t, q: [four * e.atan() - DoubleDouble::PI], v: [two / ((e + one / e) / two)] };
        worst = larger(worst, error_from(&end, &exact) / (t.exp() * UNIT));
    }
    report.row("error of P05 up to t = 30, in eᵗ u").at_most(worst, 4.0);

    let end = taylor(&system, (0.0, 100.0), [3.125], [0.0], 1e-18);
    let row = report.row(
        "P03, a swing from 3.125 rad, t = 100, against a rounding amplified eight times a period",
    );
    row.at_most(error(&end, &reference::at("P03", 100.0)), 1e-11);

    let fall = |q: f64| {
        let over = Event::new(|_, q, _| q[0].abs() - 1.0).terminal();
        let run = solve(&system, (0.0, 100.0), [q], [0.0]).method(Taylor::new()).rtol(1e-18);
        let solution = run.events([over]).run().unwrap();
        (solution.events[0].state.t, solution.end)
    };
    // The distance from the top, 1.2e-16, grows as cosh t: it reaches order one after
    // ln(2/1.2e-16) = 37.3 s, with an uncertainty due to the last digit of π.
    let (when, end) = fall(core::f64::consts::PI);
    report.row("fall from the double next to π to 1 rad, s").between(when, 35.0, 41.0);
    let (mirrored_when, mirrored) = fall(-core::f64::consts::PI);
    report.row("its mirror image, bit for bit").failures([
        when == mirrored_when,
        end.q[0] == -mirrored.q[0],
        end.v[0] == -mirrored.v[0],
    ]);
    let top = Upright::new();
    let rest = [
        taylor(&top, (0.0, 1e3), [0.0], [0.0], 1e-15),
        fixed(&top, (0.0, 1e3), [0.0], [0.0], Srkn14a, 0.1),
        solve(&top, (0.0, 1e3), [0.0], [0.0]).run().unwrap().end,
        fixed(&top, (0.0, 1e3), [0.0], [0.0], Gauss::<4>::new(), 0.1),
    ];
    report
        .row("exactly upright it stays, four methods for 1000 s")
        .failures(rest.map(|end| end.q[0] == 0.0 && end.v[0] == 0.0));
}

fn double() -> Double<f64> {
    Double::new([1.0; 2], [1.0; 2], 1.0)
}

fn chaos(scale: Scale, report: &mut Report) {
    let system = double();
    let start = ([2.0, 2.5], [0.0; 2]);
    let at = |t: f64| taylor(&system, (0.0, t), start.0, start.1, 1e-18);
    for ((t, exact), bar) in reference::rows("P23").iter().zip([1e-12, 1e-9]) {
        report.row(format!("P23 by Taylor at t = {t}")).at_most(error(&at(*t), exact), bar);
    }

    // Pairs of states that differ in the last digit, from many points of a long motion. Their
    // distance grows with the Lyapunov exponent, 0.46 ± 0.01.
    let pairs = scale.pick(16, 64, 64);
    let times: Vec<f64> = (1..=pairs).map(|k| 100.0 * f64::from(k)).collect();
    let path = solve(&system, (0.0, 100.0 * f64::from(pairs)), start.0, start.1).method(Dop853);
    let path = path.rtol(1e-12).atol(1e-12).t_eval(&times).run().unwrap();
    let mut slopes = Vec::new();
    for k in 0..path.t.len() {
        let (q, v) = (path.q[k], path.v[k]);
        let near = [f64::from_bits(q[0].to_bits() + 1), q[1]];
        let points = separation(&system, (q, v), (near, v), 100.0);
        if k < 3 {
            report.curve(Figure::Separation, format!("from t = {}", 100 * (k + 1)), points.clone());
        }
        let growing: Vec<(f64, f64)> = points
            .iter()
            .take_while(|point| point.1 < 1e-2)
            .filter(|point| 5.0 <= point.0)
            .map(|point| (point.0, point.1.ln()))
            .collect();
        slopes.push(line(&growing).0);
    }
    let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
    report
        .row(format!("rate at which {pairs} pairs a last digit apart separate, 1/s"))
        .between(mean, 0.41, 0.51);
    let near = [f64::from_bits(2.0f64.to_bits() + 1), 2.5];
    let points = separation(&system, start, (near, start.1), 100.0);
    report.curve(Figure::Separation, "from θ = (2, 2.5)", points);

    // The motions are uncorrelated after 70 s; energy is conserved.
    let seconds = scale.pick(500.0, 10_000.0, 10_000.0);
    let energy = |state: &State<f64, 2>| system.energy(At::of(0.0, &state.q, &state.v));
    let first = energy(&State { t: 0.0, q: start.0, v: start.1 });
    let h = 1.0 / 64.0;
    let mut run = stepping(&system, Gauss::<4>::new(), 0.0, start.0, start.1, h);
    let (mut drift, mut halves) = (0.0, [0.0; 2]);
    let (mut square, mut flips, mut side) = (0.0, 0.0, 0.0);
    let count = (seconds / h) as u64;
    for step in 0..count {
        run.step().unwrap();
        drift = larger(drift, ((energy(&run.state()) - first) / first).abs());
        halves[usize::from(count / 2 < step)] = drift;
        square += run.v()[1] * run.v()[1] / count as f64;
        let turn = (run.q()[1] / core::f64::consts::TAU).round();
        flips += (turn - side).abs();
        side = turn;
    }
    report.row(format!("energy by Gauss<4>, 1/64 s, over {seconds} s")).at_most(drift, 1e-10);
    report.row("its largest error, second half over first").at_most(halves[1] / halves[0], 2.0);

    let every: Vec<f64> = (1..=(seconds / h) as u64).map(|k| k as f64 * h).collect();
    let other = solve(&system, (0.0, seconds), start.0, start.1).method(Dop853);
    let other = other.rtol(1e-9).atol(1e-9).t_eval(&every).run().unwrap();
    let turns: Vec<f64> = other.q.iter().map(|q| (q[1] / core::f64::consts::TAU).round()).collect();
    let others = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>();
    let mean = other.v.iter().map(|v| v[1] * v[1]).sum::<f64>() / other.v.len() as f64;
    let bar = 0.05 * (10_000.0f64 / seconds).sqrt();
    report
        .row("mean of θ̇₂² by Gauss<4> and by Dop853, relative difference")
        .at_most((square / mean - 1.0).abs(), bar);
    // Turns of the lower link occur in bursts.
    report
        .row(format!("its turns, {flips:.0} and {others:.0}, relative difference"))
        .at_most((flips / others - 1.0).abs(), 2.0 * bar);
}

/// Returns the distance of two motions as a function of time.
fn separation(
    system: &Double<f64>,
    a: ([f64; 2], [f64; 2]),
    b: ([f64; 2], [f64; 2]),
    end: f64,
) -> Vec<(f64, f64)> {
    let [a, b] = [a, b].map(|(q, v)| {
        let problem = solve(system, (0.0, end), q, v).method(Taylor::new()).rtol(1e-18);
        problem.every(0.5).run().unwrap()
    });
    let distance = |k: usize| {
        largest((0..2).flat_map(|i| [(a.q[k][i] - b.q[k][i]).abs(), (a.v[k][i] - b.v[k][i]).abs()]))
    };
    (1..a.t.len()).map(|k| (a.t[k], distance(k).max(1e-17))).collect()
}

fn back(scale: Scale, report: &mut Report) {
    let system = Simple::new(9.8);
    let far = scale.pick(200.0, 1000.0, 1000.0);
    let start = State { t: 0.0, q: [0.05], v: [0.025] };
    let run = |from: &State<f64, 1>, to: f64| taylor(&system, (from.t, to), from.q, from.v, 1e-18);
    report
        .row(format!("P06 to t = {far} and back by Taylor"))
        .at_most(apart(&run(&run(&start, far), 0.0), &start), 1e-14);

    let system = double();
    let run = |from: &State<f64, 2>, to: f64| taylor(&system, (from.t, to), from.q, from.v, 1e-18);
    let start = State { t: 0.0, q: [2.0, 2.5], v: [0.0; 2] };
    // A rounding error at t = 10 is amplified as much on the way back as an error at the start on
    // the way there, 1.3e3 times.
    let limit = 10.0 * 1.3e3 * f64::EPSILON;
    report
        .row("P23 to t = 10 and back by Taylor, ten roundings amplified 1300 times")
        .at_most(apart(&run(&run(&start, 10.0), 0.0), &start), limit);
    let wide = system.map(DoubleDouble::from);
    let there = truth(&wide, (0.0, 10.0), start.q, start.v).end;
    let here = taylor(&wide, (10.0, 0.0), there.q, there.v, 1e-28);
    report
        .row("the same in two words, which the references here are made of")
        .at_most(error_from(&start, &here), 1e-24);
}
