//! Errors relative to references, and references in double-double.

use pendulum_runtime::integrate::controller::Controller;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{Dop853, FixedStep, Integrator, Solution, State, Taylor, solve};
use pendulum_runtime::jet::JetDynamics;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::Dynamics;

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

/// Returns the end of a run by `Taylor`.
pub(crate) fn taylor<D: JetDynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    interval: (f64, f64),
    q: [D::Scalar; N],
    v: [D::Scalar; N],
    rtol: f64,
) -> State<D::Scalar, N> {
    solve(dynamics, interval, q, v).method(Taylor::new()).rtol(rtol).run().expect("it runs").end
}

/// Returns a run by `Dop853` with equal tolerances.
pub(crate) fn dop853<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    interval: (f64, f64),
    q: [D::Scalar; N],
    v: [D::Scalar; N],
    tolerance: f64,
) -> Solution<D::Scalar, N> {
    let problem = solve(dynamics, interval, q, v).method(Dop853).rtol(tolerance).atol(tolerance);
    problem.run().expect("it runs")
}

/// Returns the end of a run in steps of the length `h`.
pub(crate) fn fixed<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    dynamics: &D,
    interval: (f64, f64),
    q: [D::Scalar; N],
    v: [D::Scalar; N],
    method: M,
    h: f64,
) -> State<D::Scalar, N>
where
    FixedStep: Controller<M, D, N>,
{
    solve(dynamics, interval, q, v).method(method).step(h).run().expect("it runs").end
}

/// Returns an integrator in steps of the length `h`.
pub(crate) fn stepping<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    dynamics: &D,
    method: M,
    t: f64,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
    h: f64,
) -> Integrator<'_, N, D, M, FixedStep>
where
    FixedStep: Controller<M, D, N>,
{
    let run = Integrator::new(dynamics, method, t, q, v).expect("it begins");
    run.control(FixedStep::new(h)).expect("a length")
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
