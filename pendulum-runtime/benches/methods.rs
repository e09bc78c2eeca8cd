//! The error and the time of every method for the simple pendulum, θ(0) = 1.3, g/L = 9.8, 1000 s,
//! with five settings each.
//!
//! The error is the error of the final angle relative to the elliptic functions; the time is the
//! median of eleven runs. `cargo bench -p pendulum-runtime --bench methods`

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::integrate::Stats;
use pendulum_runtime::prelude::*;
use std::hint::black_box;
use std::time::Instant;

use systems::pendulums::Simple;

/// Returns a pendulum with g/L = 9.8.
fn pendulum() -> Simple {
    Simple { m: 1.0, L: 1.0, g: 9.8 }
}

/// θ(1000 s) = 2 asin(k sn(K − ωt | k²)) with k = sin 0.65 and ω² = 9.8.
const EXACT: f64 = 1.2960573950636069;

fn report(setting: &str, mut run: impl FnMut() -> (f64, Stats)) {
    let mut times = Vec::new();
    let mut result = None;
    for _ in 0..11 {
        let start = Instant::now();
        result = Some(run());
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    if let Some((angle, stats)) = result {
        println!(
            "{:<16} {setting:<14} error {:8.1e}   {:9.3} ms   {:>9} evaluations",
            stats.method,
            (angle - EXACT).abs(),
            1e3 * times[5],
            stats.evaluations
        );
    }
}

macro_rules! fixed {
    ($method:expr, $steps:expr) => {
        for steps in $steps {
            let pendulum = pendulum();
            report(&format!("{steps} steps"), || {
                let solution = solve(black_box(&pendulum), (0.0, 1000.0), [1.3], [0.0])
                    .method($method)
                    .steps(steps)
                    .run();
                solution
                    .map_or((f64::NAN, failed()), |solution| (solution.end.q[0], solution.stats))
            });
        }
    };
}

macro_rules! adaptive {
    ($method:expr) => {
        for exponent in [4, 6, 8, 10, 12] {
            let tolerance = 10f64.powi(-exponent);
            let pendulum = pendulum();
            report(&format!("rtol 1e-{exponent}"), || {
                let problem =
                    solve(black_box(&pendulum), (0.0, 1000.0), [1.3], [0.0]).method($method);
                let solution = problem.rtol(tolerance).atol(tolerance).run();
                solution
                    .map_or((f64::NAN, failed()), |solution| (solution.end.q[0], solution.stats))
            });
        }
    };
}

fn failed() -> Stats {
    let pendulum = pendulum();
    match solve(&pendulum, (0.0, 0.0), [0.0], [0.0]).run() {
        Ok(solution) => solution.stats,
        Err(failure) => failure.partial.stats,
    }
}

fn main() {
    println!("simple pendulum, 1000 s");
    fixed!(SymplecticEuler, [10_000, 30_000, 100_000, 300_000, 1_000_000]);
    fixed!(Leapfrog, [10_000, 30_000, 100_000, 300_000, 1_000_000]);
    fixed!(Srkn6b, [5_000, 10_000, 20_000, 50_000, 100_000]);
    fixed!(Srkn14a, [3_000, 5_000, 10_000, 20_000, 50_000]);
    fixed!(Rk4, [10_000, 30_000, 100_000, 300_000, 1_000_000]);
    fixed!(Gauss::<4>::new(), [1_000, 2_000, 4_000, 8_000, 16_000]);
    fixed!(Gauss::<8>::new(), [500, 1_000, 2_000, 3_000, 4_000]);
    adaptive!(Dop853);
}
