//! States of rest.

use crate::group::frequency::cube_root_of_rounding;
use crate::lanes::limits::Limits;
use pendulum_core::nalgebra::{DMatrix, DVector};
use pendulum_core::scalar::Float;
use pendulum_core::system::{At, System};

/// Returns the state without acceleration that an overdamped pendulum approaches from `q`, with the
/// inputs at rest, soft stops, and hard stops as bounds; `None` if the search fails.
///
/// Takes steps of Newton's method if the pendulum is stable and the step halves the acceleration,
/// otherwise steps q̈/(2ω²) with the fastest frequency ω.
pub(crate) fn rest<S: System<N, Scalar = T>, T: Float, const N: usize>(
    system: &S,
    t: T,
    q: &[T; N],
    inputs: &S::Inputs,
    omega: f64,
    limits: &Limits<T, N>,
) -> Option<[T; N]> {
    let prepared = system.prepare();
    let zero = [T::from_f64(0.0); N];
    let a = |q: &[T; N]| -> [f64; N] {
        let (a, push) = (
            system.accelerations_prepared(&prepared, At { t, q, v: &zero, inputs }),
            limits.push(q),
        );
        core::array::from_fn(|i| (a[i] + push[i]).to_f64())
    };
    let size = |a: &[f64; N]| a.iter().fold(0.0f64, |size, a| size.max(a.abs()));
    let held = |q: [T; N]| if limits.is_hard() { limits.inside(&q) } else { q };
    let constrained = 0 < S::FACTS.held_constraints();
    let held = |q: [T; N]| held(if constrained { project(system, t, q, inputs) } else { q });
    let moved = |q: &[T; N], by: &[f64]| -> [T; N] {
        held(core::array::from_fn(|i| q[i] + T::from_f64(by[i])))
    };
    let (mut q, step) = (held(*q), cube_root_of_rounding::<T>());
    // The corrections leave rounding errors.
    let digits = if constrained { 64.0 } else { 4.0 };
    let enough = digits * T::EPSILON.to_f64() * (omega * omega).max(1e-12);
    // With constraints the frequency is inaccurate, so the step shrinks after each overshoot.
    let mut pace = 0.5 / (omega * omega).max(1e-12);
    let mut before = [0.0; N];
    for _ in 0..10_000 {
        let mut here = a(&q);
        if !here.iter().all(|a| a.is_finite()) {
            return None;
        }
        // A hard stop cancels accelerations towards it.
        let mut presses = false;
        for i in (0..N).filter(|_| limits.is_hard()) {
            if here[i] < 0.0 && q[i] == limits.low[i] || 0.0 < here[i] && q[i] == limits.high[i] {
                (here[i], presses) = (0.0, true);
            }
        }
        if size(&here) <= enough {
            return Some(q);
        }
        let jacobian = jacobian(step, &q, a);
        // Near a saddle, Newton's method would converge to the saddle. With constraints, its step
        // would ignore them.
        let stable = !(presses || constrained)
            && jacobian.complex_eigenvalues().iter().all(|value| value.re < 0.0);
        let newton =
            if stable { jacobian.lu().solve(&DVector::from_fn(N, |i, _| -here[i])) } else { None };
        let newton = newton.filter(|by| by.amax() < 0.5);
        if let Some(by) = newton {
            let next = moved(&q, by.as_slice());
            if next == q {
                return Some(q);
            }
            if size(&a(&next)) < 0.5 * size(&here) {
                q = next;
                continue;
            }
            // The step is of the order of the rounding error.
            if by.amax() <= 16.0 * T::EPSILON.to_f64() {
                return Some(q);
            }
        }
        if constrained && here.iter().zip(&before).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
            pace *= 0.5;
        }
        before = here;
        // `omega` is a lower estimate of the frequency, hence the factor 0.5.
        let down = if constrained {
            here.map(|a| pace * a)
        } else {
            here.map(|a| 0.5 * a / (omega * omega).max(1e-12))
        };
        q = moved(&q, &down.map(|by| by.clamp(-0.5, 0.5)));
    }
    None
}

/// Projects a state near the constraints onto them.
pub(super) fn project<S: System<N, Scalar = T>, T: Float, const N: usize>(
    system: &S,
    t: T,
    mut q: [T; N],
    inputs: &S::Inputs,
) -> [T; N] {
    let zero = [T::from_f64(0.0); N];
    for _ in 0..3 {
        let at = At { t, q: &q, v: &zero, inputs };
        let change = system.correction(at, &system.misfits(at)[0]);
        q = core::array::from_fn(|i| q[i] - change[i]);
    }
    q
}

/// Returns ∂q̈/∂q by central differences.
fn jacobian<T: Float, const N: usize>(
    step: f64,
    q: &[T; N],
    a: impl Fn(&[T; N]) -> [f64; N],
) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(N, N);
    for column in 0..N {
        let (mut ahead, mut behind) = (*q, *q);
        ahead[column] += T::from_f64(step);
        behind[column] -= T::from_f64(step);
        let (ahead, behind) = (a(&ahead), a(&behind));
        for row in 0..N {
            matrix[(row, column)] = (ahead[row] - behind[row]) / (2.0 * step);
        }
    }
    matrix
}
