//! One run of each crate's DOP853.

use systems::work_precision::measure::{Outcome, Run};
use systems::work_precision::problem::Problem;
use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use ode_solvers::SVector;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::dop853::Dop853;
use std::hint::black_box;

/// y = (q, q̇) with q̈ from a function.
struct FirstOrder<F>(F);

/// Coordinates and velocities of y.
fn halves<const N: usize>(y: &[f64]) -> ([f64; N], [f64; N]) {
    (core::array::from_fn(|i| y[i]), core::array::from_fn(|i| y[N + i]))
}

/// The derivatives of y = (q, q̇), or of y = (q, q̇, t).
#[inline]
fn derivatives<const N: usize, const M: usize>(
    f: &impl Fn(f64, &[f64; N], &[f64; N]) -> [f64; N],
    t: f64,
    y: &[f64],
    mut set: impl FnMut(usize, f64),
) {
    let (q, v) = halves::<N>(y);
    let a = f(if 2 * N < M { y[2 * N] } else { t }, &q, &v);
    for i in 0..N {
        set(i, v[i]);
        set(N + i, a[i]);
    }
    if 2 * N < M {
        set(2 * N, 1.0);
    }
}

impl<F: Fn(f64, &[f64; N], &[f64; N]) -> [f64; N], const N: usize, const M: usize> ode_solvers::System<f64, SVector<f64, M>>
    for FirstOrder<(F, [(); N])>
{
    #[inline]
    fn system(&self, t: f64, y: &SVector<f64, M>, dy: &mut SVector<f64, M>) {
        derivatives::<N, M>(&self.0.0, t, y.as_slice(), |i, value| dy[i] = value);
    }
}

impl<F: Fn(f64, &[f64; N], &[f64; N]) -> [f64; N], const N: usize, const M: usize> ODE<f64, [f64; M]>
    for FirstOrder<(F, [(); N])>
{
    #[inline]
    fn diff(&self, t: f64, y: &[f64; M], dy: &mut [f64; M]) {
        derivatives::<N, M>(&self.0.0, t, y, |i, value| dy[i] = value);
    }
}

/// The state at the start.
fn start<const N: usize, const M: usize>(problem: &Problem<N>) -> [f64; M] {
    core::array::from_fn(|i| match i {
        i if i < N => problem.q[i],
        i if i < 2 * N => problem.v[i - N],
        _ => 0.0,
    })
}

/// The crate `ode_solvers`.
pub fn ode_solvers<const N: usize, const M: usize>(
    problem: &Problem<N>,
    tolerance: f64,
    accelerations: impl Fn(f64, &[f64; N], &[f64; N]) -> [f64; N] + Copy,
) -> Outcome {
    let mut y = SVector::from(start::<N, M>(problem));
    let (mut t, mut values, mut evaluations) = (0.0, Vec::with_capacity(2 * N * problem.times.len()), 0);
    for &end in &problem.times {
        let system = FirstOrder((black_box(accelerations), [(); N]));
        // The defaults of `Dop853::new`, but for the number of steps and the output.
        let output = OutputType::Sparse;
        let mut stepper = Dop853::from_param(
            system,
            t,
            end,
            0.0,
            y,
            tolerance,
            tolerance,
            0.9,
            0.0,
            0.333,
            6.0,
            end - t,
            0.0,
            10_000_000,
            1000,
            output,
        );
        let stats = stepper.integrate().map_err(|error| error.to_string())?;
        y = *stepper.y_out().last().ok_or("no output")?;
        t = *stepper.x_out().last().ok_or("no output")?;
        if 1e-12 * end < (t - end).abs() {
            return Err(format!("it ended at {t} instead of {end}"));
        }
        evaluations += u64::from(stats.num_eval);
        values.extend(&y.as_slice()[..2 * N]);
    }
    Ok(Run { values, evaluations })
}

/// The crate `differential-equations`.
pub fn differential_equations<const N: usize, const M: usize>(
    problem: &Problem<N>,
    tolerance: f64,
    accelerations: impl Fn(f64, &[f64; N], &[f64; N]) -> [f64; N] + Copy,
) -> Outcome {
    let mut y = start::<N, M>(problem);
    let (mut t, mut values, mut evaluations) = (0.0, Vec::with_capacity(2 * N * problem.times.len()), 0);
    for &end in &problem.times {
        let system = FirstOrder((black_box(accelerations), [(); N]));
        let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance).max_steps(10_000_000);
        let solution = IVP::ode(&system, t, end, y).t_eval([end]).method(method).solve();
        let solution = solution.map_err(|error| format!("{error:?}"))?;
        if solution.t != [end] {
            return Err(format!("it ended at {:?} instead of {end}", solution.t));
        }
        (t, y) = (end, solution.y[0]);
        evaluations += solution.evals.function as u64;
        values.extend(&y[..2 * N]);
    }
    Ok(Run { values, evaluations })
}
