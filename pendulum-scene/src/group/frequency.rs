//! Frequencies of systems, which determine their steps.

use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{At, System};

/// Estimates angular frequencies in rad/s that small motions do not exceed by much, first about
/// `q`, then about `q` and its neighbourhood, with the inputs at rest.
///
/// The first frequency is the larger of max √|λ| over the eigenvalues λ of ∂q̈/∂q and max |λ| of
/// ∂q̈/∂q̇, by power iteration with central differences. The second frequency is the maximum of the
/// first and of √|λ| at three states in which all coordinates are larger by 0.8, 1.6 and 2.4.
pub(crate) fn fastest<S: System<N, Scalar = T>, T: Float, const N: usize>(
    system: &S,
    t: T,
    q: &[T; N],
    inputs: &S::Inputs,
) -> [f64; 2] {
    let prepared = system.prepare();
    let zero = [T::from_f64(0.0); N];
    let a =
        |q: &[T; N], v: &[T; N]| system.accelerations_prepared(&prepared, At { t, q, v, inputs });
    let step = cube_root_of_rounding::<T>();
    let [mut here, mut fastest] = [0.0f64; 2];
    for place in 0..4 {
        let q = q.map(|q| q + T::from_f64(0.8 * f64::from(place)));
        let stiffness = largest(step, |direction, size| {
            let (ahead, behind) = (moved(&q, direction, size), moved(&q, direction, -size));
            (a(&ahead, &zero), a(&behind, &zero))
        });
        fastest = fastest.max(stiffness.sqrt());
        if !S::FACTS.velocity_free && place == 0 {
            fastest = fastest.max(largest(step, |direction, size| {
                (a(&q, &moved(&zero, direction, size)), a(&q, &moved(&zero, direction, -size)))
            }));
        }
        if place == 0 {
            here = fastest;
        }
    }
    [here, fastest]
}

/// Returns the step for which the rounding error and the truncation error of a central difference
/// have similar size.
pub(crate) fn cube_root_of_rounding<T: Float>() -> f64 {
    Real::powf(T::EPSILON.to_f64(), 1.0 / 3.0)
}

fn moved<T: Real, const N: usize>(q: &[T; N], direction: &[f64; N], size: f64) -> [T; N] {
    core::array::from_fn(|i| q[i] + T::from_f64(size * direction[i]))
}

/// Estimates the largest |λ| of a Jacobian from central differences, usually from below; returns
/// zero if the estimate is not finite.
fn largest<T: Float, const N: usize>(
    step: f64,
    mut pair: impl FnMut(&[f64; N], f64) -> ([T; N], [T; N]),
) -> f64 {
    // The components are unequal, so that the direction has no symmetry of the system.
    let mut direction: [f64; N] = core::array::from_fn(|i| 1.0 + 0.37 * i as f64);
    if N.is_multiple_of(2) {
        direction[N / 2] = -direction[N / 2];
    }
    let norm = |x: &[f64; N]| x.iter().fold(0.0, |sum: f64, x| sum + x * x).sqrt();
    let mut size = 0.0;
    let rounds = if N == 1 { 1 } else { 12 };
    let scale = norm(&direction);
    direction = direction.map(|x| x / scale);
    for _ in 0..rounds {
        let (ahead, behind) = pair(&direction, step);
        let image: [f64; N] =
            core::array::from_fn(|i| (ahead[i].to_f64() - behind[i].to_f64()) / (2.0 * step));
        size = norm(&image);
        if !size.is_finite() || size == 0.0 {
            return 0.0;
        }
        direction = image.map(|x| x / size);
    }
    size
}
