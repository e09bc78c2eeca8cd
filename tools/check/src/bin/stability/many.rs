//! Many pendulums at once: the same bits in lanes, threads and scenes as for single pendulums, tiny
//! numbers, a soak test.

use crate::memory::memory;
use crate::numbers::{larger, stepping};
use crate::scenes;
use crate::systems::{Double, Hung, Simple};
use ::systems::fingerprints::{self, LANES, same_in_lanes};
use ::systems::random::Random;
use check::report::{Report, Scale, Test};
use pendulum_runtime::motion::{Curve, Derivatives, Motion, Side};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Lanes;
use pendulum_runtime::system::System;
use pendulum_runtime::time::Time;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S11", title: "denormal numbers", run: denormals },
    Test { id: "S22", title: "same bits", run: bits },
    Test { id: "S28", title: "soak", run: soak },
];

fn denormals(scale: Scale, report: &mut Report) {
    let system = Simple::new(1.0);
    let steps = scale.pick(100_000, 1_000_000, 1_000_000);
    let mut run = stepping(&system, Rk4, 0.0, [1e-310], [0.0], 0.05);
    for _ in 0..steps {
        run.step().unwrap();
    }
    let end = run.q()[0];
    report.row("swing of 1e-310 rad: magnitude after a million steps").at_most(end.abs(), 1.1e-310);
    let faint = Simple::new(1e-200);
    let end = solve(&faint, (0.0, 1e3), [1e-200], [0.0]).method(Dop853).run().unwrap().end;
    report
        .row("g θ = 1e-400, which is zero: it stays")
        .failures([end.q[0] == 1e-200 && end.v[0] == 0.0]);
    // The reciprocal of the smallest tolerances is infinite. An error or a number is acceptable,
    // NaN is not.
    let mut kept = Vec::new();
    for atol in [0.0, 1e-322, 1e-310, 1e-305, 1e-300] {
        for start in [0.0, 1e-310] {
            let problem = || {
                solve(&system, (0.0, 100.0), [start], [0.0])
                    .method(Dop853)
                    .atol(atol)
                    .rtol(1e-10)
                    .max_steps(100_000)
            };
            let ends = [
                problem().run().map(|solution| solution.end),
                problem().method(Rodas4).run().map(|solution| solution.end),
                problem().method(Taylor::new()).run().map(|solution| solution.end),
                problem().method(Picard).run().map(|solution| solution.end),
            ];
            let near = 1.1e-310 + 1e3 * atol;
            kept.extend(ends.map(|end| {
                end.map_or(true, |end| end.q[0].abs() <= near && end.v[0].abs() <= near)
            }));
        }
    }
    report
        .row("tolerances down to nothing: an error or numbers within them, four methods")
        .failures(kept);
}

fn bits(scale: Scale, report: &mut Report) {
    let steps = scale.pick(2_000, 20_000, 200_000);
    let starts: [[f64; 2]; LANES] =
        core::array::from_fn(|k| [2.0 - 0.3 * k as f64, 2.5 + 1e3 * (k / 6) as f64]);
    let system = Double::new([1.0, 0.7], [0.9, 1.1], 9.81);
    report
        .row(format!(
            "eight double pendulums in lanes and alone, {steps} steps of Rk4: lanes that differ"
        ))
        .failures(same_in_lanes(&system, starts, [0.0; 2], steps));
    let (single, rounded) = (system.map(|x| x as f32), starts.map(|start| start.map(|x| x as f32)));
    report
        .row("the same in single precision")
        .failures(same_in_lanes(&single, rounded, [0.0; 2], steps));

    let differ = fingerprints::lanes_that_differ(scale.pick(200, 2000, 20_000));
    report
        .row(format!("{} systems in eight lanes and alone: lanes that differ", differ.len()))
        .at_most(differ.iter().map(|(_, lanes)| *lanes as f64).sum(), 0.0);

    let run = |k: usize| {
        solve(&system, (0.0, 50.0), starts[k], [0.0; 2])
            .method(Dop853)
            .rtol(1e-10)
            .run()
            .unwrap()
            .end
    };
    let here: Vec<_> = (0..LANES).map(run).collect();
    let there: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..LANES).rev().map(|k| scope.spawn(move || run(k))).collect();
        threads.into_iter().rev().map(|thread| thread.join().unwrap()).collect()
    });
    report
        .row("the same runs in eight threads, in another order")
        .failures(here.iter().zip(&there).map(|(a, b)| a == b));
    scenes::bits(scale, report);
    let expected = include_str!("../../../../../tests/data/determinism.txt");
    // What reads files is not in this build.
    let expected: Vec<_> = expected.lines().filter(|line| !line.starts_with("import ")).collect();
    let found = fingerprints::all();
    report
        .row(format!(
            "{} final states and features against the checked-in ones: this build",
            found.len()
        ))
        .failures(
            found
                .iter()
                .zip(&expected)
                .map(|(found, line)| found == line)
                .chain([found.len() == expected.len()]),
        );
}

/// Pendulums on the joints of random characters: groups of sixteen lanes with a joint each, half a
/// step before and after each force.
fn soak(scale: Scale, report: &mut Report) {
    const W: usize = 16;
    let count = scale.pick(1_000, 10_000, 100_000);
    let frames = 10_000;
    let (h, mut random) = (1.0 / 60.0, Random::new(28));
    let mut uniform = |low: f64, high: f64| random.uniform(low, high);
    let (mut finite, mut drifted, mut grown) = (true, 0usize, 0.0);
    let mut before = None;
    for group in 0..count / W {
        let times: Vec<f64> = (0..=60).map(|k| f64::from(k) * 0.25).collect();
        let mut keys: Vec<[f64; 2]> =
            times.iter().map(|_| [uniform(-0.2, 0.2), uniform(-0.05, 0.05)]).collect();
        keys[60] = keys[0];
        let joint = Curve::periodic(&times, &keys).unwrap();
        let lengths: [f64; W] = core::array::from_fn(|_| uniform(0.1, 2.0));
        let starts: [f64; W] = core::array::from_fn(|_| uniform(-3.0, 3.0));
        let system = Hung::new(Lanes(lengths), Lanes::splat(9.81));
        let (mut q, mut v) = ([Lanes(starts)], [Lanes::splat(0.0)]);
        let watched = (group % 64 == 0).then(|| Hung::new(lengths[group % W], 9.81));
        let (mut one, mut speed) = ([starts[group % W]], [0.0]);
        for frame in 0..frames {
            let t = Time::new((f64::from(frame) + 0.5) * h);
            let drift = |q: &mut Lanes<f64, W>, v: &Lanes<f64, W>| *q += Lanes::splat(0.5 * h) * *v;
            drift(&mut q[0], &v[0]);
            let inputs = (joint.sample(t, Side::After, Derivatives::ACCELERATION),);
            let a = system.accelerations(At {
                t: Lanes::splat(t.to_f64()),
                q: &q,
                v: &v,
                inputs: &inputs,
            });
            v[0] += Lanes::splat(h) * a[0];
            drift(&mut q[0], &v[0]);
            if let Some(system) = &watched {
                one[0] += 0.5 * h * speed[0];
                let inputs = (joint.sample(t, Side::After, Derivatives::ACCELERATION),);
                let a =
                    system.accelerations(At { t: t.to_f64(), q: &one, v: &speed, inputs: &inputs });
                speed[0] += h * a[0];
                one[0] += 0.5 * h * speed[0];
            }
        }
        finite &= q[0].0.iter().chain(&v[0].0).all(|x| x.is_finite());
        if watched.is_some() {
            drifted += usize::from(q[0].0[group % W] != one[0] || v[0].0[group % W] != speed[0]);
        }
        if group == 8 {
            before = memory();
        }
    }
    if let (Some(before), Some(after)) = (before, memory()) {
        grown = larger(grown, after - before);
    }
    report.row(format!("{count} pendulums, {frames} frames: finite")).failures([finite]);
    report.row("lanes that differ from the same pendulum alone").at_most(drifted as f64, 0.0);
    // Another test may run concurrently.
    report.row("growth of memory in bytes, other tests included").at_most(grown, 3e7);
    scenes::soak(scale, report);
}
