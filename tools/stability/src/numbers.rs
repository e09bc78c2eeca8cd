//! Errors relative to references, and references in double-double.

use pendulum_runtime::integrate::{Solution, State, solve};
use pendulum_runtime::jet::JetDynamics;
use pendulum_runtime::prelude::Taylor;
use pendulum_runtime::scalar::{DoubleDouble, Float};

/// Returns the larger of two numbers, or NaN if one is NaN.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b < a { a } else { b }
}

/// Returns the largest value, or NaN if one is NaN.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, larger)
}

/// Returns the largest difference of coordinates and velocities from reference values.
pub(crate) fn error<T: Float, const N: usize>(state: &State<T, N>, exact: &[f64]) -> f64 {
    assert_eq!(exact.len(), 2 * N, "coordinates and velocities");
    largest(
        state
            .q
            .iter()
            .chain(&state.v)
            .zip(exact)
            .map(|(found, exact)| (found.to_f64() - exact).abs()),
    )
}

/// Returns the largest difference between two states.
pub(crate) fn apart<T: Float, const N: usize>(a: &State<T, N>, b: &State<T, N>) -> f64 {
    largest(
        (0..N).flat_map(|i| [(a.q[i] - b.q[i]).to_f64().abs(), (a.v[i] - b.v[i]).to_f64().abs()]),
    )
}

/// Returns the largest difference from a reference in double-double.
pub(crate) fn error_from<const N: usize>(
    state: &State<f64, N>,
    exact: &State<DoubleDouble, N>,
) -> f64 {
    let wide = State {
        t: state.t,
        q: state.q.map(DoubleDouble::from),
        v: state.v.map(DoubleDouble::from),
    };
    apart(&wide, exact)
}

/// Returns a Taylor solution to 28 digits, with dense output.
pub(crate) fn truth<const N: usize>(
    dynamics: &impl JetDynamics<N, Scalar = DoubleDouble>,
    (start, end): (f64, f64),
    q: [f64; N],
    v: [f64; N],
) -> Solution<DoubleDouble, N> {
    let problem =
        solve(dynamics, (start, end), q.map(DoubleDouble::from), v.map(DoubleDouble::from));
    problem.method(Taylor::new()).rtol(1e-28).dense().run().expect("the reference runs")
}

/// Returns slope and intercept of the straight line through points, by least squares.
pub(crate) fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let (mut top, mut bottom) = (0.0, 0.0);
    for point in points {
        top += (point.0 - x) * (point.1 - y);
        bottom += (point.0 - x) * (point.0 - x);
    }
    (top / bottom, y - top / bottom * x)
}
