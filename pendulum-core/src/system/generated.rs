//! Items that generated code uses; other code must not depend on them.

use crate::scalar::Real;
use crate::system::at::At;
use crate::system::equations::System;
pub use crate::system::facts::{Known, facts};
pub use crate::system::table::{ends, knots, knots_of, rows_of, table};
pub use nalgebra::SMatrix;
pub use pendulum_macros::lagrangian;

/// The keywords of the language, for rust-analyzer only.
#[allow(unexpected_cfgs, nonstandard_style, missing_docs)]
pub mod words {
    #[cfg(rust_analyzer)]
    pendulum_macros::words!();
}

/// Views `entries`, stored column by column, as the columns of a matrix with `N` rows.
pub fn columns<T, const N: usize>(entries: &[T]) -> &[[T; N]] {
    entries.as_chunks().0
}

/// Computes the least of max(w·`widths`, |d|/2) over functions of time. `all` contains the pair
/// 1/w, d for each function, with its width w and the time d since its middle.
pub fn longest_step<T: Real>(all: &[T], widths: T) -> T {
    let mut longest = T::from_f64(f64::INFINITY);
    for feature in all.as_chunks::<2>().0 {
        // 1/w = 0 stands for a constant function, which sets no bound.
        let bound = (widths / feature[0]).max(T::from_f64(0.5) * feature[1].abs());
        longest = feature[0].where_positive(longest.min(bound), longest);
    }
    longest
}

/// Solves for q̇ from p by Newton's method, for Lagrangians that are not quadratic in the
/// velocities. Coordinates without a solution become NaN.
///
/// The iteration starts at q̇ = 0. Each step is halved until the momenta are finite and the
/// residual decreases in the norm of the inverse mass matrix, which is independent of units
/// (Deuflhard 1974). Each lane stops when its steps no longer change it, so that its bits do not
/// depend on the number of iterations of the other lanes.
pub fn newton<const N: usize, S: System<N>>(
    system: &S,
    t: S::Scalar,
    q: &[S::Scalar; N],
    p: &[S::Scalar; N],
    inputs: &S::Inputs,
) -> [S::Scalar; N] {
    let number = S::Scalar::from_f64;
    let (zero, one) = (number(0.0), number(1.0));
    let momenta = |v: &[S::Scalar; N]| system.momenta(At { t, q, v, inputs });
    let missing =
        |found: &[S::Scalar; N]| -> [S::Scalar; N] { core::array::from_fn(|i| p[i] - found[i]) };
    let factors = |v: &[S::Scalar; N]| Factors::new(system.mass_matrix(At { t, q, v, inputs }));
    let mut v = [zero; N];
    let rest = momenta(&v);
    let mut left = missing(&rest);
    // The fraction of a step that is taken, and 1 while the lane still changes.
    let (mut share, mut moving) = (one, one);
    for _ in 0..ROUNDS {
        let factors = factors(&v);
        let (step, size) = factors.solve(left);
        let trial: [S::Scalar; N] = core::array::from_fn(|i| v[i] + share * step[i]);
        let left_then = missing(&momenta(&trial));
        let gain = moving.where_positive(size - factors.solve(left_then).1, zero);
        let moved = (0..N).fold(zero, |sum, i| sum + (trial[i] - v[i]).abs());
        for i in 0..N {
            v[i] = gain.where_positive(trial[i], v[i]);
            left[i] = gain.where_positive(left_then[i], left[i]);
        }
        share = gain.where_positive((share + share).min(one), number(0.5) * share);
        moving = moved.where_positive(moving, zero);
        if moving == zero {
            break;
        }
    }
    // Two further steps, accepted if they are finite: first derivatives converge one step after the
    // values, second derivatives one step later.
    for _ in 0..2 {
        let step = factors(&v).solve(left).0;
        let trial: [S::Scalar; N] = core::array::from_fn(|i| v[i] + step[i]);
        let left_then = missing(&momenta(&trial));
        let finite = (0..N).fold(one, |sum, i| sum + zero * (left_then[i] + trial[i]));
        for i in 0..N {
            v[i] = finite.where_positive(trial[i], v[i]);
            left[i] = finite.where_positive(left_then[i], left[i]);
        }
    }
    checked(p, &rest, &left, v, &system.mass_matrix(At { t, q, v: &v, inputs }))
}

/// The greatest number of iterations. Close to a limit of the velocities each step at least halves
/// the remaining distance, and a number of two words can be halved about a hundred times.
const ROUNDS: usize = 256;

/// Replaces velocities of `v` by NaN if their residuals `left` are too large. Allowed are the
/// rounding error of `p` and the change of the momenta, by the mass matrix `mass`, for a change of
/// `v` by one unit in the last place.
///
/// Close to a limit of the velocities the mass matrix is huge, and the momentum of the nearest
/// representable velocity may be far from `p`. Close to a limit of the momenta the mass matrix
/// vanishes, and hardly any residual is allowed.
fn checked<T: Real, const N: usize>(
    p: &[T; N],
    rest: &[T; N],
    left: &[T; N],
    v: [T; N],
    mass: &SMatrix<T, N, N>,
) -> [T; N] {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    // ε from the rounding error of 4/3.
    let epsilon = (T::from_f64(3.0) * (T::ratio(4.0, 3.0) - one) - one).abs();
    let sizes: [T; N] = core::array::from_fn(|i| p[i].abs() + rest[i].abs());
    // The products p q̇ are energies, so they are comparable between coordinates: a momentum may be
    // the small difference of greater ones.
    let total = (0..N).fold(zero, |sum, i| sum + v[i].abs() * sizes[i]);
    core::array::from_fn(|i| {
        let weight = v[i].abs().where_positive(v[i].abs(), one);
        let moved = (0..N).fold(zero, |sum, j| sum + mass[(i, j)].abs() * v[j].abs());
        let rounding = T::from_f64(64.0) * sizes[i] + T::from_f64(8.0) * moved;
        let allowed = epsilon * (weight * rounding + T::from_f64(8.0) * total);
        let wrong = T::from_f64(f64::NAN);
        let found = (allowed - weight * left[i].abs()).where_positive(v[i], wrong);
        (one - left[i].abs().sign()).where_positive(v[i], found)
    })
}

/// The factors L and D of a symmetric matrix L D Lᵀ.
struct Factors<T, const N: usize>(SMatrix<T, N, N>);

impl<T: Real, const N: usize> Factors<T, N> {
    /// Factors `matrix`: its upper triangle becomes D Lᵀ, its lower triangle L.
    fn new(mut matrix: SMatrix<T, N, N>) -> Self {
        for j in 0..N {
            for i in j + 1..N {
                let factor = matrix[(i, j)] / matrix[(j, j)];
                for k in i..N {
                    let part = factor * matrix[(j, k)];
                    matrix[(i, k)] -= part;
                    matrix[(k, i)] = matrix[(i, k)];
                }
                matrix[(i, j)] = factor;
            }
        }
        Self(matrix)
    }

    /// Returns x = M⁻¹ b, and b·x summed over absolute values.
    fn solve(&self, mut b: [T; N]) -> ([T; N], T) {
        let Self(matrix) = self;
        let mut size = T::from_f64(0.0);
        for j in 0..N {
            for i in j + 1..N {
                let part = matrix[(i, j)] * b[j];
                b[i] -= part;
            }
            let scaled = b[j] / matrix[(j, j)];
            size += (b[j] * scaled).abs();
            b[j] = scaled;
        }
        for j in (0..N).rev() {
            for k in j + 1..N {
                let part = matrix[(k, j)] * b[k];
                b[j] -= part;
            }
        }
        (b, size)
    }
}
