//! The error and the time of `Taylor` for the simple pendulum over 1000 s, the double pendulum and
//! a chain of five links at several tolerances; and of `Batch` for 512 pendulums of different
//! amplitudes at order 20.
//!
//! The error is the error of the final coordinates, relative to elliptic functions, to results of
//! arbitrary precision or, for `Batch`, to scalars of two words. The time is the median of eleven
//! runs. `benches/peers/heyoka_batch.py` measures heyoka on the same batches. `cargo bench -p
//! pendulum-runtime --bench taylor [-- batch]`

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::integrate::{Batch, Batched, Problem};
use pendulum_runtime::jet::JetDynamics;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use std::hint::black_box;
use std::time::Instant;

use systems::pendulums::Simple;
use systems::problems::{Double, Five};

/// Returns a pendulum with g/L = 9.8.
fn pendulum() -> Simple {
    Simple { m: 1.0, L: 1.0, g: 9.8 }
}

fn report<const N: usize>(
    name: &str,
    dynamics: &impl JetDynamics<N, Scalar = f64>,
    end: f64,
    q: [f64; N],
    exact: &[f64],
) {
    for exponent in [3, 6, 9, 12, 15, 16, 18] {
        let tolerance = 10f64.powi(-exponent);
        let (mut times, mut found) = (Vec::new(), None);
        for _ in 0..11 {
            let start = Instant::now();
            found = solve(black_box(dynamics), (0.0, end), q, [0.0; N])
                .method(Taylor::new())
                .rtol(tolerance)
                .run()
                .ok();
            times.push(start.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        let Some(solution) = found else { continue };
        let error =
            solution.end.q.iter().zip(exact).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()));
        let steps = solution.stats.accepted;
        println!(
            "{name:<9} 1e-{exponent:<3} error {error:8.1e}   {:8.3} ms   {steps:>6} steps   {:6.3} µs a step",
            1e3 * times[5],
            1e6 * times[5] / steps as f64
        );
    }
}

/// The number of motions of a batch.
const MOTIONS: usize = 512;

/// The tolerances of the batches: the machine epsilon and multiples.
const TOLERANCES: [f64; 4] =
    [f64::EPSILON, 4.0 * f64::EPSILON, 16.0 * f64::EPSILON, 64.0 * f64::EPSILON];

/// Prints the nanoseconds per lane and step at order 20, those of `Taylor` applied to one motion
/// after the other, and the largest error of every 37th motion.
fn batch<S, const N: usize>(
    name: &str,
    rtol: f64,
    problems: &[Problem<S, N>],
    exact: impl Fn(&Problem<S, N>) -> [DoubleDouble; N],
) where
    S: Batched<N, Scalar = f64> + JetDynamics<N, Scalar = f64>,
{
    let method = Batch::new().order(20).rtol(rtol);
    let Ok(outcomes) = method.run(problems) else { return };
    let (mut steps, mut error) = (0, 0.0f64);
    for (index, (outcome, problem)) in outcomes.iter().zip(problems).enumerate() {
        let Ok(solution) = outcome else { return println!("{name}: {outcome:?}") };
        let Problem { system, time, q, v } = problem;
        let alone =
            solve(system, *time, *q, *v).method(Taylor::new().order(20)).rtol(rtol).run().ok();
        assert_eq!(Some(solution), alone.as_ref(), "{name}: motion {index} has other bits alone");
        steps += solution.stats.accepted;
        if index % 37 == 0 {
            for (q, exact) in solution.end.q.iter().zip(exact(problem)) {
                error = error.max((DoubleDouble::from_f64(*q) - exact).to_f64().abs());
            }
        }
    }
    let (mut together, mut alone) = (Vec::new(), Vec::new());
    for _ in 0..11 {
        let start = Instant::now();
        black_box(method.run(black_box(problems))).ok();
        together.push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        for Problem { system, time, q, v } in black_box(problems) {
            black_box(
                solve(system, *time, *q, *v).method(Taylor::new().order(20)).rtol(rtol).run(),
            )
            .ok();
        }
        alone.push(start.elapsed().as_secs_f64());
    }
    together.sort_by(f64::total_cmp);
    alone.sort_by(f64::total_cmp);
    let each = |times: &[f64], index: usize| 1e9 * times[index] / steps as f64;
    println!(
        "{name:<15} {rtol:.1e}   error {error:8.1e}   {:6.1} ns a lane and step (least {:.1}), alone {:.1} ns (least {:.1})   {steps} steps, {:.2} ms",
        each(&together, 5),
        each(&together, 0),
        each(&alone, 5),
        each(&alone, 0),
        1e3 * together[5]
    );
}

fn batches() {
    let amplitude = |index: usize| 0.1 + 2.9 * index as f64 / MOTIONS as f64;
    let problems: Vec<_> = (0..MOTIONS)
        .map(|k| Problem { system: pendulum(), time: (0.0, 100.0), q: [amplitude(k)], v: [0.0] })
        .collect();
    let two = DoubleDouble::from_f64;
    for rtol in TOLERANCES {
        batch("batch pendulum", rtol, &problems, |problem| {
            let start = [two(problem.q[0])];
            let exact = solve(&problem.system.map(two), problem.time, start, [two(0.0)])
                .method(Taylor::new())
                .rtol(1e-28)
                .run();
            exact.map_or([two(f64::NAN)], |exact| exact.end.q)
        });
    }
    let problems: Vec<_> = (0..MOTIONS)
        .map(|k| Problem {
            system: Double::new([1.0; 2], [1.0; 2], 1.0),
            time: (0.0, 20.0),
            q: [0.5 * amplitude(k), -0.25 * amplitude(k)],
            v: [0.0; 2],
        })
        .collect();
    for rtol in TOLERANCES {
        batch("batch double", rtol, &problems, |problem| {
            let exact =
                solve(&problem.system.map(two), problem.time, problem.q.map(two), [two(0.0); 2])
                    .method(Taylor::new())
                    .rtol(1e-28)
                    .run();
            exact.map_or([two(f64::NAN); 2], |exact| exact.end.q)
        });
    }
}

fn main() {
    batches();
    if std::env::args().any(|word| word == "batch") {
        return;
    }
    // θ(1000 s) = 2 asin(k sn(K − ωt | k²)) with k = sin 0.65 and ω² = 9.8.
    report("pendulum", &pendulum(), 1000.0, [1.3], &[1.2960573950636069]);
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    report("double", &double, 100.0, [0.5, -0.25], &[0.26851790980526665, -0.4249557728764732]);
    let five = Five::new([1.0; 5], [1.0; 5], 1.0);
    let exact = [
        0.05220813867706581,
        0.10782852392603176,
        0.13529170011065064,
        0.37745677737390876,
        0.5996624870071492,
    ];
    report("chain5", &five, 10.0, [0.25, 0.5, 0.75, 1.0, 1.25], &exact);
}
