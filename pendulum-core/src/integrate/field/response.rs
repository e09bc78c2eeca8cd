//! Changes of the velocities by impulses and impacts.

use super::phase::Phase;
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System, is_constrained};
use crate::time::Time;
use nalgebra::SMatrix;

/// Returns the change of the velocities in a frictionless impact with the coefficient of
/// restitution e: Δq̇ = −(1 + e) M⁻¹n (n·q̇)/(nᵀM⁻¹n).
///
/// The wall is g(q) = 0, at rest in these coordinates, and `normal` is n = ∂g/∂q, of any length.
/// The impulse, a change of momenta, has the direction of n, and the impact multiplies n·q̇ by −e.
/// M is the mass matrix at `t` and `q`. The kinetic energy falls by (1 − e²)(n·q̇)²/(2 nᵀM⁻¹n).
///
/// The forces of constraints act too: M Δq̇ = nμ + Cᵀν with C Δq̇ = 0. The part of M⁻¹n that
/// satisfies the constraints then replaces M⁻¹n.
///
/// The result is not finite if n is zero or if the mass matrix is singular.
///
/// Source: F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts (1996),
/// chapter 8, for a single contact with Newton's law of restitution.
pub fn impact<const N: usize, D: Dynamics<N, Scalar: Float>>(
    dynamics: &D,
    t: f64,
    q: &[D::Scalar; N],
    v: &[D::Scalar; N],
    normal: &[D::Scalar; N],
    restitution: f64,
) -> [D::Scalar; N] {
    let phase = Phase { dynamics, t: Time::new(t), side: Side::After, q, v };
    let direction = phase.response(normal);
    let speed = product(normal, v);
    let factor = -D::Scalar::from_f64(1.0 + restitution) * speed / product(normal, &direction);
    direction.map(|component| factor * component)
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns the change of the velocities by the impulse `normal` while the constraints hold:
    /// K n, which is M⁻¹n without constraints, otherwise M⁻¹n − M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹C M⁻¹n.
    pub(crate) fn response(&self, normal: &[D::Scalar; N]) -> [D::Scalar; N] {
        let (system, inputs) = (self.dynamics.system(), self.momentum_inputs());
        let at = self.at(&inputs);
        let mut change = solved(system.mass_matrix(at), *normal);
        if const { is_constrained::<D, N>() } {
            let back = system.correction(at, &system.constraint_rates(at, &change));
            for i in 0..N {
                change[i] -= back[i];
            }
        }
        change
    }
}

pub(crate) fn product<T: Float, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    a.iter().zip(b).fold(T::from_f64(0.0), |sum, (a, b)| sum + *a * *b)
}

/// Returns M⁻¹ b for a symmetric positive definite M, by elimination without row exchanges.
pub(crate) fn solved<T: Float, const N: usize>(matrix: SMatrix<T, N, N>, b: [T; N]) -> [T; N] {
    solved_where(matrix, b, |_, _| true)
}

/// Returns the solution of the equations as [`solved`], with zero for the unknowns that `keep`
/// refuses by their index and the pivot that the unknowns before them have left.
pub(crate) fn solved_where<T: Float, const N: usize>(
    mut matrix: SMatrix<T, N, N>,
    mut b: [T; N],
    keep: impl Fn(usize, T) -> bool,
) -> [T; N] {
    let mut kept = [false; N];
    for j in 0..N {
        kept[j] = keep(j, matrix[(j, j)]);
        if !kept[j] {
            continue;
        }
        for i in j + 1..N {
            let factor = matrix[(i, j)] / matrix[(j, j)];
            for k in j..N {
                let part = factor * matrix[(j, k)];
                matrix[(i, k)] -= part;
            }
            let part = factor * b[j];
            b[i] -= part;
        }
    }
    let mut x = [T::from_f64(0.0); N];
    for i in (0..N).rev().filter(|i| kept[*i]) {
        let rest = (i + 1..N).fold(b[i], |rest, k| rest - matrix[(i, k)] * x[k]);
        x[i] = rest / matrix[(i, i)];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::solved;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn elimination_agrees_with_cholesky() {
        let root = Matrix3::new(2.0_f64, 0.0, 0.0, -1.0, 1.5, 0.0, 0.3, 0.7, 0.9);
        let (matrix, b) = (root * root.transpose(), [1.0, -2.0, 0.5]);
        let trusted = matrix.cholesky().unwrap().solve(&Vector3::from(b));
        for (found, expected) in solved(matrix, b).iter().zip(trusted.iter()) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }
}
