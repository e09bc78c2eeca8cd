//! Long runs: energy, phase, bias, growing angles, and quantities conserved by symmetry.

use crate::elliptic::{Swing, Turning};
use crate::numbers::{error, largest, line, stepping};
use crate::reference;
use crate::systems::{Cart, Double, Simple, Spherical};
use check::report::{Figure, Report, Scale, Test};
use pendulum_runtime::integrate::controller::Controller;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{FixedStep, State};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::System;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S1", title: "long drift", run: drift },
    Test { id: "S2", title: "phase drift", run: phase },
    Test { id: "S3", title: "bias of rounding", run: bias },
    Test { id: "S17", title: "angle growth", run: growth },
    Test { id: "S25", title: "conserved momenta", run: momenta },
];

/// The step of the splitting methods.
const STEP: f64 = 1.0 / 32.0;

/// The unit roundoff.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// Energy and phase along a run of the pendulum from 1.3 rad.
#[derive(Default)]
struct Trace {
    /// The largest error of the energy up to each time, relative to the energy above rest.
    energy: Vec<(f64, f64)>,
    /// The largest error of the phase in seconds up to each time.
    phase: Vec<(f64, f64)>,
    /// Weighted means of the relative energy error over the first and the second half.
    halves: [f64; 2],
}

impl Trace {
    /// Adds the curves of energy and phase.
    fn draw(self, name: &str, report: &mut Report) {
        report.curve(Figure::Energy, name, self.energy);
        report.curve(Figure::Phase, name, self.phase);
    }
}

/// Takes `steps` steps of length `h`. If `plain` is set, the low words of the state are discarded
/// after each step.
fn trace<M>(method: M, h: f64, steps: u64, plain: bool) -> Trace
where
    M: Method<Simple<f64>, 1>,
    FixedStep: Controller<M, Simple<f64>, 1>,
{
    let (system, swing) = (Simple::new(1.0), Swing::from(1.3));
    let energy = |q: f64, v: f64| system.energy(At::of(0.0, &[q], &[v]));
    let start = energy(1.3, 0.0);
    let mut run = stepping(&system, method, 0.0, [1.3], [0.0], h);
    let mut trace = Trace::default();
    let (mut worst, mut late) = (0.0f64, 0.0f64);
    let mut means = [[0.0; 2]; 2];
    let (mut mark, half) = (64.0, steps as f64 / 2.0);
    for step in 1..=steps {
        run.step().unwrap();
        if plain {
            run.reset(run.t(), *run.q(), *run.v()).unwrap();
        }
        if step % 8 != 0 {
            continue;
        }
        let relative = (energy(run.q()[0], run.v()[0]) - start) / (start + 1.0);
        worst = largest([worst, relative.abs()]);
        // A smooth window: oscillations average out faster than any power of the length.
        let (index, x) = if step as f64 <= half {
            (0, step as f64 / half)
        } else {
            (1, step as f64 / half - 1.0)
        };
        if 0.0 < x && x < 1.0 {
            let weight = (-1.0 / (x * (1.0 - x))).exp();
            means[index][0] += weight * relative;
            means[index][1] += weight;
        }
        let place = step as f64 / mark;
        if 0.8 < place && step % 512 == 0 || 1.0 <= place {
            late = largest([late, swing.phase(run.t(), run.q()[0], run.v()[0]).abs()]);
        }
        if 1.0 <= place {
            trace.energy.push((run.t(), worst.max(UNIT)));
            // Beyond this value, the error is no longer a phase error.
            if late < 0.5 {
                trace.phase.push((run.t(), late.max(UNIT)));
            }
            mark *= 1.4;
        }
    }
    trace.halves = means.map(|[sum, weight]| sum / weight);
    trace
}

fn drift(scale: Scale, report: &mut Report) {
    let steps = scale.pick(400_000, 10_000_000, 1_000_000_000);
    let shown = steps.min(10_000_000);
    let first = |trace: &Trace| {
        trace.energy.iter().filter(|point| point.0 <= 1.0001e5).fold(0.0f64, |_, point| point.1)
    };

    let summed = trace(Srkn14a, STEP, steps, false);
    report
        .row("largest energy error of Srkn14a, 3.2e6 steps of 1/32 s")
        .at_most(first(&summed), 5e-15);
    let last = summed.energy[summed.energy.len() - 1].1;
    let bar = 5e-15 * (steps as f64 / 3.2e6).sqrt().max(1.0);
    report
        .row(format!("the same, {:.0e} steps, bar grown by their root", steps as f64))
        .at_most(last, bar);
    let walk = (steps as f64).sqrt() * UNIT;
    let slope = |trace: &Trace| 2.0 * (trace.halves[1] - trace.halves[0]).abs();
    report.row("drift of its mean energy against √n u").at_most(slope(&summed), walk);
    summed.draw("Srkn14a", report);

    trace(Srkn14a, STEP, shown.min(3_200_000), true).draw("Srkn14a, plain sums", report);

    let leapfrog = trace(Leapfrog, STEP, steps, false);
    report
        .row(format!(
            "drift of the mean energy of Leapfrog, {:.0e} steps, against √n u",
            steps as f64
        ))
        .at_most(slope(&leapfrog), walk);
    leapfrog.draw("Leapfrog", report);

    trace(Gauss::<4>::new(), 0.1, shown / 5, false).draw("Gauss<4>, 0.1 s", report);
    trace(Dop853, 0.25, shown / 8, false).draw("Dop853, 1/4 s", report);
    trace(Taylor::new(), 0.25, shown / 8, false).draw("Taylor, 1/4 s", report);
}

fn phase(scale: Scale, report: &mut Report) {
    let system = Simple::new(1.0);
    let rows = scale.pick(4, 5, 5);
    let mut run = stepping(&system, Srkn14a, 0.0, [1.3], [0.0], STEP);
    let mut errors = Vec::new();
    let rows = &reference::rows("P01")[..rows];
    for (t, exact) in rows {
        run.advance_to(*t).unwrap();
        errors.push(error(&run.state(), exact));
    }
    report
        .row(format!("Srkn14a at t = {:.0e}", rows[rows.len() - 1].0))
        .at_most(errors[rows.len() - 1], 5e-12);
}

/// Copies that start 1e-12 apart have different rounding errors. Their energies must be random
/// walks without a common direction.
fn bias(scale: Scale, report: &mut Report) {
    const COPIES: usize = 64;
    let system = Simple::new(1.0);
    let wide = system.map(DoubleDouble::from);
    let energy = |state: &State<f64, 1>| {
        let [q, v] = [state.q, state.v].map(|parts| parts.map(DoubleDouble::from));
        wide.energy(At::of(0.0.into(), &q, &v))
    };
    let ensemble = |plain: bool, marks: &[u64]| -> Vec<(f64, f64, f64)> {
        let mut found = vec![[0.0; COPIES]; marks.len()];
        for copy in 0..COPIES {
            let start = State { t: 0.0, q: [1.3 + 1e-12 * copy as f64], v: [0.0] };
            let before = energy(&start);
            let mut run = stepping(&system, Srkn14a, 0.0, start.q, start.v, STEP);
            let mut step = 0;
            for (row, &mark) in marks.iter().enumerate() {
                // The mean over a few states removes the roundings in the last words of the states.
                let mut mean = 0.0;
                while step < mark {
                    run.step().unwrap();
                    if plain {
                        run.reset(run.t(), *run.q(), *run.v()).unwrap();
                    }
                    step += 1;
                    if mark <= step + 16 {
                        mean += ((energy(&run.state()) - before) / before).to_f64();
                    }
                }
                found[row][copy] = mean / 17.0_f64.min(mark as f64);
            }
        }
        let statistics = |(mark, errors): (&u64, &[f64; COPIES])| {
            let mean = errors.iter().sum::<f64>() / COPIES as f64;
            (*mark as f64, (errors.iter().map(|e| e * e).sum::<f64>() / COPIES as f64).sqrt(), mean)
        };
        marks.iter().zip(&found).map(statistics).collect()
    };
    let slope = |rows: &[(f64, f64, f64)]| {
        line(&rows.iter().map(|row| (row.0.ln(), row.1.ln())).collect::<Vec<_>>()).0
    };
    let marks = |from: u64, count: u32| (0..count).map(|k| from << k).collect::<Vec<u64>>();

    let plain = ensemble(true, &marks(1000, scale.pick(5, 7, 9)));
    report
        .row("growth of the mean square energy error of 64 copies, plain sums: exponent")
        .between(slope(&plain), 0.4, 0.6);
    let last = plain[plain.len() - 1];
    report
        .row("their mean against their root mean square")
        .at_most(last.2.abs() / last.1, 3.0 / 8.0);
    let summed = ensemble(false, &marks(16_000, scale.pick(2, 6, 8)));
    if scale != Scale::Quick {
        let row = report.row("the same with the sums of the runtime: exponent");
        row.between(slope(&summed), 0.4, 0.6);
    }
    let last = summed[summed.len() - 1];
    report
        .row("their mean against their root mean square, sums of the runtime")
        .at_most(last.2.abs() / last.1, 3.0 / 8.0);
}

fn growth(scale: Scale, report: &mut Report) {
    let (system, exact) = (Simple::new(1.0), Turning::new());
    let end = scale.pick(1e4, 1e6, 1e7);
    // The error in seconds. Turns of 2π are removed in double-double.
    let off = |t: f64, turns: f64, q: f64| {
        let (angle, whole, speed) = exact.at(t);
        let turn = DoubleDouble::PI + DoubleDouble::PI;
        let apart = (DoubleDouble::from(q) - angle) - turn * DoubleDouble::from(whole - turns);
        (apart / speed).to_f64().abs()
    };
    // The bar is n^{3/2} u steps.
    let bar = |t: f64| (t / STEP).powf(1.5) * UNIT * STEP;
    let start = || stepping(&system, Srkn14a, 0.0, [0.0], [2.5], STEP).max_steps(1 << 40);
    let (mut run, mut turns, mut t) = (start(), 0.0, 0.0);
    while t < end {
        t += 1.0;
        run.advance_to(t).unwrap();
        let whole = (run.q()[0] / core::f64::consts::TAU).round();
        if whole != 0.0 {
            turns += whole;
            run.displace([-whole * core::f64::consts::TAU], [-whole * TAU_LOW]).unwrap();
        }
    }
    let phase = format!(
        "phase of Srkn14a at t = {end:.0e}, whole turns taken off, in s, against n^(3/2) u steps"
    );
    report.row(phase).at_most(off(t, turns, run.q()[0]), bar(end));
    let mut run = start();
    run.advance_to(1e4).unwrap();
    let row = report.row("the same at t = 1e4 without taking turns off");
    row.at_most(off(1e4, 0.0, run.q()[0]), bar(1e4)).because(
        "forces see the first word of the angle, which loses a digit with every ten turns; \
         `Integrator::displace` takes them off",
    );
}

/// The error of the double nearest to 2π.
const TAU_LOW: f64 = 2.4492935982947064e-16;

fn momenta(scale: Scale, report: &mut Report) {
    let steps = scale.pick(30_000, 1_000_000, 1_000_000);
    let walk = (steps as f64).sqrt() * UNIT;

    let cart = Cart::new(2.0, 1.0, 1.0, 1.0);
    let along = |state: &State<f64, 2>| cart.momenta(At::of(0.0, &state.q, &state.v))[0].abs();
    report.row(format!("p_x of P31, Gauss<4>, {steps} steps, against rounding")).at_most(
        conserved(&cart, Gauss::<4>::new(), 0.05, steps, [0.0, 2.0], [0.0; 2], along),
        4e-15,
    );
    report
        .row("p_x of P31, Taylor, against √n u")
        .at_most(conserved(&cart, Taylor::new(), 0.1, steps, [0.0, 2.0], [0.0; 2], along), walk);

    let sphere = Spherical::new(1.0, 1.0);
    let around = |q: &[f64; 2], v: &[f64; 2]| sphere.momenta(At::of(0.0, q, v))[1];
    let start = around(&[1.0, 0.0], &[0.0, 1.0]);
    let change = |state: &State<f64, 2>| (around(&state.q, &state.v) - start).abs();
    report.row("p_φ of P33, Gauss<4>, against rounding").at_most(
        conserved(&sphere, Gauss::<4>::new(), 0.05, steps, [1.0, 0.0], [0.0, 1.0], change),
        4e-15,
    );
    report.row("p_φ of P33, Taylor, against √n u").at_most(
        conserved(&sphere, Taylor::new(), 0.1, steps, [1.0, 0.0], [0.0, 1.0], change),
        walk,
    );

    let free = Double::new([1.0; 2], [1.0; 2], 0.0);
    let spin = |q: &[f64; 2], v: &[f64; 2]| free.momenta(At::of(0.0, q, v)).iter().sum::<f64>();
    let start = spin(&[0.0, 1.0], &[0.3, 0.5]);
    let change = |state: &State<f64, 2>| (spin(&state.q, &state.v) - start).abs() / start.abs();
    report.row("angular momentum of two links without weight, Gauss<4>, against √n u").at_most(
        conserved(&free, Gauss::<4>::new(), 0.05, steps, [0.0, 1.0], [0.3, 0.5], change),
        walk,
    );
}

/// Returns the largest value of `change` along a run, sampled every tenth step.
fn conserved<S, M, const N: usize>(
    system: &S,
    method: M,
    h: f64,
    steps: u64,
    q: [f64; N],
    v: [f64; N],
    change: impl Fn(&State<f64, N>) -> f64,
) -> f64
where
    S: System<N, Scalar = f64, Inputs = ()>,
    M: Method<S, N>,
    FixedStep: Controller<M, S, N>,
{
    let mut run = stepping(system, method, 0.0, q, v, h);
    let mut worst = 0.0;
    for step in 0..steps {
        run.step().unwrap();
        if step % 10 == 0 {
            worst = largest([worst, change(&run.state())]);
        }
    }
    worst
}
