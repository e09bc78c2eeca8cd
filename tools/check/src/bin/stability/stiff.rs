//! Stiff springs, heavy dampers, and the steps chosen by adaptive methods.

use crate::elliptic::Swing;
use crate::numbers::{dop853, error, fixed, larger, largest, stepping, taylor, truth};
use crate::reference;
use crate::systems::{Cart, Damped, Double, Elastic, Kepler, Simple};
use ::systems::random::Random;
use check::report::{Report, Scale, Test};
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::controller::Controller;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{AdaptiveStep, State};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::Jacobians;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S18", title: "stiff spring", run: spring },
    Test { id: "S19", title: "heavy damping", run: damping },
    Test { id: "S26", title: "tolerances at random", run: tolerances },
];

fn spring(_: Scale, report: &mut Report) {
    let (mut energy, mut rejected, mut refused) = (0.0, Vec::new(), Vec::new());
    let mut slow = 0.0;
    for exponent in [2, 4, 6, 8, 10] {
        let stiffness = 10f64.powi(exponent);
        let system = Elastic::new(1.0, stiffness, 1.0, 1.0);
        // The spring is in equilibrium for this angle, so that the fast vibration is small.
        let (q, v) = ([1.0 + 1.0f64.cos() / stiffness, 1.0], [0.0; 2]);
        let start = system.energy(At::of(0.0, &q, &v));
        let end = fixed(&system, (0.0, 20.0), q, v, Gauss::<2>::new().newton(), 0.02);
        energy = larger(energy, (system.energy(At::of(0.0, &end.q, &end.v)) - start).abs());
        // If k is large, the solution approaches that of a rigid rod.
        if 8 <= exponent {
            let rigid = dop853(&Simple::new(1.0), (0.0, 20.0), [1.0], [0.0], 1e-12).end.q[0];
            let damped = solve(&system, (0.0, 20.0), q, v).method(Rodas4).rtol(1e-8).atol(1e-8);
            slow = larger(slow, (damped.run().unwrap().end.q[1] - rigid).abs());
        }
        // 0.1 s exceeds 2.8/√k for k ≥ 10³.
        if 4 <= exponent {
            refused.push(solve(&system, (0.0, 20.0), q, v).method(Rk4).step(0.1).run().is_err());
            let sweeps =
                solve(&system, (0.0, 20.0), q, v).method(Gauss::<2>::new()).step(0.1).run();
            rejected.push(matches!(sweeps, Err(failure) if matches!(failure.error, Error::NoConvergence { .. })));
        }
    }
    report
        .row("energy by Gauss<2> with Newton's method, k = 1e2 to 1e10, steps of 0.02 s")
        .at_most(energy, 1e-4);
    report.row("Rodas4 against a rigid rod, k = 1e8 and 1e10, rtol 1e-8").at_most(slow, 1e-6);
    report
        .row("Rk4 beyond its stability limit ends with an error, k = 1e4 to 1e10")
        .failures(refused);
    report
        .row("Gauss<2> by sweeps beyond their limit ends with an error that says so")
        .failures(rejected);
}

fn damping(scale: Scale, report: &mut Report) {
    let (mut ringing, mut creep) = (0usize, 0.0);
    for exponent in 1..=6 {
        let c = 10f64.powi(exponent);
        let system = Damped::new(c);
        let run = solve(&system, (0.0, 5.0 * c), [1.0], [0.0]).method(Rodas4);
        let solution = run.rtol(1e-8).atol(1e-12).every_step().run().unwrap();
        ringing += solution.q.windows(2).filter(|pair| pair[0][0] < pair[1][0]).count();
        // tan(q/2) = tan(½) e^(−t/c) up to 1/c².
        if 4 <= exponent {
            let exact = 2.0 * (0.5f64.tan() * (-5.0f64).exp()).atan();
            creep = larger(creep, (solution.end.q[0] - exact).abs() - 2.0 / (c * c));
        }
    }
    report
        .row("c = 10 to 1e6, Rodas4: steps in which the pendulum rises again")
        .at_most(ringing as f64, 0.0);
    report
        .row("c = 1e4 to 1e6: distance from the creeping motion after 5c, beyond 2/c²")
        .at_most(creep, 1e-7);

    let explicit = [1e2, 1e4, 1e6].map(|c| {
        solve(&Damped::new(c), (0.0, 1e3), [1.0], [0.0]).method(Rk4).step(10.0 / c).run().is_err()
    });
    report.row("Rk4 with h c = 10 ends with an error").failures(explicit);

    let faint = Damped::new(1e-12);
    let end = taylor(&faint, (0.0, 100.0), [1.3], [0.0], 1e-18);
    let exact = truth(&faint.map(DoubleDouble::from), (0.0, 100.0), [1.3], [0.0]).end;
    let change = Swing::from(1.3).at(100.0)[0] - exact.q[0];
    report.row("c = 1e-12, Taylor at t = 100, error over what the damping has changed").at_most(
        (DoubleDouble::from(end.q[0]) - exact.q[0]).to_f64().abs() / change.to_f64().abs(),
        0.01,
    );

    // The motion decays to rest and continues: no number may become NaN, and small numbers must not
    // be slow.
    let steps = scale.pick(100_000, 1_000_000, 1_000_000);
    let rest = Damped::new(0.5);
    let mut run = stepping(&rest, Rk4, 0.0, [1.0], [0.0], 0.05);
    let mut finite = true;
    for _ in 0..steps {
        run.step().unwrap();
        finite &= run.q()[0].is_finite() && run.v()[0].is_finite();
    }
    report.row("damped to rest and beyond").failures([finite, run.q()[0].abs() < 1e-300]);
}

/// The results for random tolerances and first steps on a system.
struct Spread {
    /// The largest error divided by the tolerance, for tolerances below and above 1e-3.
    worst: [f64; 2],
    failed: usize,
    /// The number of times that a hundredth of the tolerance results in a larger error.
    turned: usize,
}

fn spread<S, M, const N: usize>(
    system: &S,
    method: M,
    (end, q, v): (f64, [f64; N], [f64; N]),
    exact: &State<DoubleDouble, N>,
    random: &mut Random,
    count: usize,
) -> Spread
where
    S: Jacobians<N, Scalar = f64, Inputs = ()>,
    M: Method<S, N>,
    AdaptiveStep<N>: Controller<M, S, N>,
{
    let run = |tolerance: f64, first: Option<f64>| {
        let problem =
            solve(system, (0.0, end), q, v).method(method).rtol(tolerance).atol(tolerance);
        let problem = match first {
            Some(first) => problem.first_step(first),
            None => problem,
        };
        problem.run().ok().map(|solution| {
            let end = &solution.end;
            let off = |found: &f64, exact: &DoubleDouble| {
                (DoubleDouble::from(*found) - *exact).to_f64().abs() / (1.0 + exact.to_f64().abs())
            };
            let pairs = end.q.iter().zip(&exact.q).chain(end.v.iter().zip(&exact.v));
            largest(pairs.map(|(a, b)| off(a, b)))
        })
    };
    let mut spread = Spread { worst: [0.0; 2], failed: 0, turned: 0 };
    for _ in 0..count {
        let tolerance = 10f64.powf(random.uniform(-14.6, -1.0));
        let first = 10f64.powf(random.uniform(-12.0, 3.0));
        match run(tolerance, Some(first)) {
            Some(error) => {
                let worst = &mut spread.worst[usize::from(1e-3 < tolerance)];
                *worst = larger(*worst, error / tolerance);
            }
            None => spread.failed += 1,
        }
    }
    let errors: Vec<f64> =
        (1..=7).map(|k| run(10f64.powi(-2 * k), None).unwrap_or(f64::NAN)).collect();
    spread.turned = errors.windows(2).filter(|pair| pair[1].is_nan() || pair[0] < pair[1]).count();
    spread
}

fn tolerances(scale: Scale, report: &mut Report) {
    let mut random = Random::new(26);
    let count = scale.pick(30, 200, 1000);
    let (simple, double) = (Simple::new(1.0), Double::new([1.0; 2], [1.0; 2], 1.0));
    let (cart, kepler) = (Cart::new(2.0, 1.0, 1.0, 1.0), Kepler::new(1.0));
    let problems = (
        (10.0, [1.3], [0.0]),
        (10.0, [0.5, -0.25], [0.0; 2]),
        (10.0, [0.0, 2.0], [0.0; 2]),
        (20.0, [0.5, 0.0], [0.0, 3.0f64.sqrt()]),
    );
    macro_rules! exact {
        ($system:expr, $problem:expr) => {
            truth(&$system.map(DoubleDouble::from), (0.0, $problem.0), $problem.1, $problem.2).end
        };
    }
    let exact = (
        exact!(simple, problems.0),
        exact!(double, problems.1),
        exact!(cart, problems.2),
        exact!(kepler, problems.3),
    );
    let near = |found: f64| found <= 1e-14;
    report.row("the references in two words against 24 digits").failures([
        near(error(&exact.0, &reference::at("P01", 10.0))),
        near(error(&exact.1, &reference::at("P22", 10.0))),
        near(error(&exact.2, &reference::at("P31", 10.0))),
        near(error(&exact.3, &reference::at("P38", 20.0))),
    ]);
    macro_rules! method {
        ($name:literal, $method:expr) => {
            let spreads = [
                spread(&simple, $method, problems.0, &exact.0, &mut random, count),
                spread(&double, $method, problems.1, &exact.1, &mut random, count),
                spread(&cart, $method, problems.2, &exact.2, &mut random, count),
                spread(&kepler, $method, problems.3, &exact.3, &mut random, count),
            ];
            tell(report, $name, count, &spreads);
        };
    }
    method!("Dop853", Dop853);
    method!("Taylor", Taylor::new());
    method!("Picard", Picard);
}

/// Adds the rows of a method: three problems, and an orbit.
fn tell(report: &mut Report, name: &str, count: usize, spreads: &[Spread; 4]) {
    let [found @ .., orbit] = spreads;
    let worst = |index: usize| largest(found.iter().map(|spread| spread.worst[index]));
    let runs = format!("{name}: {count} runs each of P01, P22, P31");
    let row = report.row(format!("{runs}: error over tolerance, 3e-15 to 1e-3"));
    row.at_most(worst(0), 100.0).because(
        "thirty steps cover the run: in one of a thousand the estimate for one of them is small by \
         accident, on P31",
    );
    report.row(format!("{runs}: the same, 1e-3 to 0.1")).at_most(worst(1), 100.0);
    let row = report.row(format!("{name}: P38, e = 0.5, three orbits, 3e-15 to 1e-3"));
    row.at_most(orbit.worst[0], 100.0).because(
        "the error of a step changes the period of an orbit, and what that costs grows with time",
    );
    report.row(format!("{name}: the same, 1e-3 to 0.1")).at_most(orbit.worst[1], 100.0);
    let failed: usize = spreads.iter().map(|spread| spread.failed).sum();
    report.row(format!("{name}: runs that fail")).at_most(failed as f64, 0.0);
    let turned: usize = spreads.iter().map(|spread| spread.turned).sum();
    let row = report.row(format!("{name}: errors that grow as the tolerance falls"));
    row.at_most(turned as f64, 0.0);
    // The two known cases are accepted.
    if name == "Picard" && turned <= 2 {
        row.because(
            "at 1e-8 on P01 and 1e-10 on P31 the error is 3e-5 and 8e-3 of the tolerance, by accident",
        );
    }
}
