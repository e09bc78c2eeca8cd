//! Integrators on systems with known solutions.

mod accuracy;
mod energy;
mod errors;
mod events;
mod kinks;
mod order;
mod output;
mod stepping;
mod systems;

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{State, solve};
use pendulum_runtime::system::Dynamics;

/// Returns the largest difference between a state and the exact state.
///
/// The result is NaN if a component is NaN: a failed run must not look accurate.
fn distance<const N: usize>(q: &[f64; N], v: &[f64; N], exact: &[f64]) -> f64 {
    assert_eq!(exact.len(), 2 * N);
    let differences = q.iter().chain(v).zip(exact).map(|(value, exact)| (value - exact).abs());
    differences
        .fold(0.0, |largest, difference| if difference <= largest { largest } else { difference })
}

/// Returns the state at `end` after fixed steps from time 0.
fn fixed<D: Dynamics<N, Scalar = f64>, const N: usize>(
    dynamics: &D,
    end: f64,
    q: [f64; N],
    v: [f64; N],
    method: impl Method<D, N>,
    steps: u64,
) -> State<f64, N> {
    let solution = solve(dynamics, (0.0, end), q, v).method(method).steps(steps).run().unwrap();
    assert_eq!(solution.end.t, end);
    solution.end
}
