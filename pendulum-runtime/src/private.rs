//! What generated code names; no one else may rely on it.

use crate::real::Real;
use crate::system::{Facts, Input, System};
pub use nalgebra::SMatrix;
pub use pendulum_macros::lagrangian;

/// All fields of [`Facts`], which others cannot name.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Known {
    pub name: &'static str,
    pub coordinates: &'static [&'static str],
    pub parameters: &'static [&'static str],
    pub units: &'static [&'static str],
    pub inputs: &'static [Input],
    pub autonomous: bool,
    pub explicit_time: bool,
    pub separable: bool,
    pub velocity_free: bool,
    pub constant_mass_matrix: bool,
    pub nonconservative: bool,
    pub smooth: bool,
    pub cyclic: &'static [usize],
    pub conserved: &'static [&'static str],
    pub unused: &'static [&'static str],
    pub equations: &'static str,
    pub latex: &'static str,
}

/// The facts of a generated system.
pub const fn facts(known: Known) -> Facts {
    Facts {
        name: known.name,
        coordinates: known.coordinates,
        parameters: known.parameters,
        units: known.units,
        inputs: known.inputs,
        autonomous: known.autonomous,
        explicit_time: known.explicit_time,
        separable: known.separable,
        velocity_free: known.velocity_free,
        constant_mass_matrix: known.constant_mass_matrix,
        nonconservative: known.nonconservative,
        smooth: known.smooth,
        cyclic: known.cyclic,
        conserved: known.conserved,
        unused: known.unused,
        equations: known.equations,
        latex: known.latex,
        derived: true,
    }
}

/// The columns of a matrix of `N` rows, stored one after the other.
pub fn columns<T, const N: usize>(entries: &[T]) -> &[[T; N]] {
    entries.as_chunks().0
}

/// q̇ from p by Newton's method, for Lagrangians that are not quadratic in the velocities.
///
/// Starts from rest and takes a fixed number of steps, because lanes have no common moment of convergence.
pub fn newton<const N: usize, S: System<N>>(
    system: &S,
    t: S::Scalar,
    q: &[S::Scalar; N],
    p: &[S::Scalar; N],
    inputs: &S::Inputs,
) -> [S::Scalar; N] {
    let zero = S::Scalar::from_f64(0.0);
    let mut v = [zero; N];
    for _ in 0..64 {
        let momenta = system.momenta(t, q, &v, inputs);
        let mut matrix = system.mass_matrix(t, q, &v, inputs);
        let mut step = [zero; N];
        for i in 0..N {
            step[i] = p[i] - momenta[i];
        }
        // LDLᵀ in place: the mass matrix is symmetric and positive definite.
        for j in 0..N {
            for i in j + 1..N {
                let factor = matrix[(i, j)] / matrix[(j, j)];
                for k in j + 1..N {
                    let part = factor * matrix[(j, k)];
                    matrix[(i, k)] -= part;
                }
                step[i] -= factor * step[j];
            }
        }
        for j in (0..N).rev() {
            for k in j + 1..N {
                step[j] -= matrix[(j, k)] * step[k];
            }
            step[j] /= matrix[(j, j)];
            v[j] += step[j];
        }
    }
    v
}
