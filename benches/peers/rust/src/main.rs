//! The crates `ode_solvers` and `differential-equations` on the systems of the benchmark
//! `work_precision`, which starts this program.
//!
//! Both integrate with their own DOP853, once with the right-hand side that `lagrangian!` generated
//! and once with one written by hand (`hand.rs`). Tolerances are relative and absolute, limits on
//! the number of steps are lifted, the rest is their defaults.
//!
//! Both are asked for the end of each stretch between two output times, one integration after the
//! other, because of their dense outputs: that of `ode_solvers` would cost three evaluations at
//! every step and extrapolates the last state from the step after the last but one output, that of
//! `differential-equations` is off by 1e-8 where its steps are good to 1e-12.
//!
//! The table of `ode_solvers` 0.6.2 holds 0 instead of 1 for the time of its last stages, which
//! spoils its order and error estimate for driven systems; there it is given the time as a further
//! component of the state, so that it does not use the table.

#![allow(missing_docs)]

mod hand;
mod serve;
mod solvers;

use pendulum_runtime::motion::Side;
use pendulum_runtime::system::{Dynamics, System};
use pendulum_runtime::time::Time;
use systems::work_precision as shared;
use systems::work_precision::measure::Row;
use systems::work_precision::problem::Problem;

fn main() -> std::io::Result<()> {
    let mut rows = Vec::new();
    add::<1, 2, 2>(&mut rows, "simple", shared::simple(), hand::simple);
    add::<1, 2, 3>(&mut rows, "moving", shared::moving(), hand::moving);
    add::<1, 2, 3>(&mut rows, "moving_compound", shared::moving_compound(), hand::moving_compound);
    add::<2, 4, 4>(&mut rows, "elastic", shared::elastic(), hand::elastic);
    add::<2, 4, 4>(&mut rows, "double_regular", shared::double(), hand::double);
    add::<2, 4, 4>(&mut rows, "double_chaotic", shared::double(), hand::double);
    add::<5, 10, 10>(&mut rows, "chain5", shared::chain5(), hand::chain5);
    add::<2, 4, 4>(&mut rows, "kepler", shared::kepler(), hand::kepler);
    add::<2, 4, 4>(&mut rows, "henon_heiles", shared::henon_heiles(), hand::henon_heiles);
    serve::serve(&versions(), &mut rows)
}

/// The rows of one system with N coordinates: M = 2N, and L = M for `ode_solvers` or L = M + 1
/// where it is given the time.
fn add<const N: usize, const M: usize, const L: usize>(
    rows: &mut Vec<Row>,
    name: &'static str,
    dynamics: impl Dynamics<N, Scalar = f64> + 'static,
    hand: impl Fn(f64, &[f64; N], &[f64; N]) -> [f64; N] + Copy + 'static,
) {
    // The parameters' part is computed once, as in our own integrators; the program lives as long
    // as its rows.
    let dynamics: &'static _ = Box::leak(Box::new(dynamics));
    let prepared = dynamics.system().prepare();
    let generated = move |t, q: &[f64; N], v: &[f64; N]| {
        dynamics.accelerations_with(&prepared, Time::new(t), Side::After, q, v)
    };
    let problem = Problem::<N>::new(name);
    for exponent in [3, 5, 7, 9, 10, 11, 12, 13] {
        let tolerance = 10f64.powi(-exponent);
        let mut row = |method: &str, run| {
            rows.push(Row {
                system: problem.name.to_string(),
                method: method.to_string(),
                setting: format!("tol=1e-{exponent}"),
                run,
            });
        };
        let p = problem.clone();
        row("ode_solvers Dop853", Box::new(move || solvers::ode_solvers::<N, L>(&p, tolerance, generated)));
        let p = problem.clone();
        row("ode_solvers Dop853 by hand", Box::new(move || solvers::ode_solvers::<N, L>(&p, tolerance, hand)));
        let p = problem.clone();
        row("differential-equations Dop853", Box::new(move || solvers::differential_equations::<N, M>(&p, tolerance, generated)));
        let p = problem.clone();
        row(
            "differential-equations Dop853 by hand",
            Box::new(move || solvers::differential_equations::<N, M>(&p, tolerance, hand)),
        );
    }
}

/// The versions of both crates, from the lock file.
fn versions() -> String {
    let lock = include_str!("../Cargo.lock");
    let version = |name: &str| {
        let mut lines = lock.lines().skip_while(|line| *line != format!("name = \"{name}\""));
        let line = lines.nth(1).unwrap_or_default();
        format!("{name} {}", line.trim_start_matches("version = ").trim_matches('"'))
    };
    format!("{}, {}", version("ode_solvers"), version("differential-equations"))
}
