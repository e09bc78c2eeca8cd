//! Names of generated code; no one else may rely on them.

use crate::scalar::Real;
use crate::system::System;
pub use crate::system::facts::{Known, facts};
pub use nalgebra::SMatrix;
pub use pendulum_macros::lagrangian;

/// The words of the language, which rust-analyzer alone reads.
#[allow(unexpected_cfgs, nonstandard_style, missing_docs)]
pub mod words {
    #[cfg(rust_analyzer)]
    pendulum_macros::words!();
}

/// The columns of a matrix of `N` rows, stored one after the other.
pub fn columns<T, const N: usize>(entries: &[T]) -> &[[T; N]] {
    entries.as_chunks().0
}

/// The least of max(w·`widths`, |d|/2) over functions of time, given one over their width w and the
/// time d since their middle.
pub fn longest_step<T: Real>(all: &[T], widths: T) -> T {
    let mut longest = T::from_f64(f64::INFINITY);
    for feature in all.as_chunks::<2>().0 {
        // A function that never changes has no middle.
        let bound = (widths / feature[0]).max(T::from_f64(0.5) * feature[1].abs());
        longest = feature[0].where_positive(longest.min(bound), longest);
    }
    longest
}

/// q̇ from p by Newton's method, for Lagrangians that are not quadratic in the velocities; not a
/// number for a coordinate where none is found.
///
/// Starts from rest. A step is halved until it stays where the momenta are numbers and makes what
/// is missing less, in the norm of the inverse mass matrix, which has no units of its own
/// (Deuflhard 1974). Each lane goes on alone until its steps do not move it any more, and then
/// stays: how many rounds the others take does not change its bits.
pub fn newton<const N: usize, S: System<N>>(
    system: &S,
    t: S::Scalar,
    q: &[S::Scalar; N],
    p: &[S::Scalar; N],
    inputs: &S::Inputs,
) -> [S::Scalar; N] {
    let number = S::Scalar::from_f64;
    let (zero, one) = (number(0.0), number(1.0));
    let momenta = |v: &[S::Scalar; N]| system.momenta(t, q, v, inputs);
    let missing =
        |found: &[S::Scalar; N]| -> [S::Scalar; N] { core::array::from_fn(|i| p[i] - found[i]) };
    let factors = |v: &[S::Scalar; N]| Factors::new(system.mass_matrix(t, q, v, inputs));
    let mut v = [zero; N];
    let rest = momenta(&v);
    let mut left = missing(&rest);
    // The share of a step that is taken, and whether the lane still moves.
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
    // Two steps that only have to stay where there are numbers: derivatives come one step after the
    // values, second ones another.
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
    checked(p, &rest, &left, v, &system.mass_matrix(t, q, &v, inputs))
}

/// The greatest number of trials. Towards a limit of the velocities each step halves the way that
/// is left at least, and two words hold a hundred halves.
const ROUNDS: usize = 256;

/// The velocities `v`, not numbers where the momenta that are `left` are neither the rounding of
/// `p` nor what a unit in the last place of `v` does to the momenta by the mass matrix there.
///
/// Towards a limit of the velocities that matrix is huge, and the number nearest to the velocity
/// may miss a large part of the momentum; towards a limit of the momenta it vanishes, and nothing
/// may be missed.
fn checked<T: Real, const N: usize>(
    p: &[T; N],
    rest: &[T; N],
    left: &[T; N],
    v: [T; N],
    mass: &SMatrix<T, N, N>,
) -> [T; N] {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    // Four thirds are rounded, and what is left of them shows by how much.
    let epsilon = (T::from_f64(3.0) * (T::ratio(4.0, 3.0) - one) - one).abs();
    let sizes: [T; N] = core::array::from_fn(|i| p[i].abs() + rest[i].abs());
    // Products with velocities are energies, which coordinates have in common: a momentum may be
    // what greater ones leave of each other.
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

/// L and D of a symmetric matrix L D Lᵀ.
struct Factors<T, const N: usize>(SMatrix<T, N, N>);

impl<T: Real, const N: usize> Factors<T, N> {
    /// The upper triangle becomes D Lᵀ, the lower one L.
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

    /// x = M⁻¹ b, and b·x with the absolute values of all terms.
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
