//! A check that the mass matrix is positive definite, as the kinetic energy of bodies with mass
//! requires.

use crate::error::Error;
use crate::integrate::field::coordinate;
use crate::integrate::field::diagnose::negative;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, Facts, Purpose, System, scalar_time};
use crate::time::Time;
use nalgebra::SMatrix;

/// Returns `true` if [`inertia`] has to check the step with the number `accepted`.
///
/// It checks every step that ends on a kink and every 64th step. Above sixteen coordinates it
/// checks every N²/4-th step, rounded up to a power of two, so that the cost is negligible.
///
/// Pivots change their sign only at points with a singular mass matrix, which methods with step
/// control do not pass.
#[inline]
pub(crate) fn is_due<S: System<N>, const N: usize>(accepted: u64, on_kink: bool) -> bool {
    let every = if N <= 16 { 64 } else { (N * N / 4).next_power_of_two() as u64 };
    varies(&S::FACTS) && (on_kink || accepted.is_multiple_of(every))
}

/// Returns `true` if pivots may change their sign during an integration.
pub(crate) fn varies(facts: &Facts) -> bool {
    facts.derived && !facts.constant_mass_matrix
}

/// Returns an error if the mass matrix at `t`, `q` and `v` has a negative pivot.
///
/// Systems written by hand need no mass matrix, and are not checked.
#[inline(never)]
pub(crate) fn inertia<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    q: &[D::Scalar; N],
    v: &[D::Scalar; N],
) -> Result<(), Error> {
    if !<D::System as System<N>>::FACTS.derived {
        return Ok(());
    }
    inertia_of(dynamics.system(), t, q, v, &dynamics.inputs(t, side, Purpose::Momenta))
}

/// Returns an error if the mass matrix of a derived system has a negative pivot.
pub(crate) fn inertia_of<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    t: Time,
    q: &[S::Scalar; N],
    v: &[S::Scalar; N],
    inputs: &S::Inputs,
) -> Result<(), Error> {
    let matrix = system.mass_matrix(scalar_time(t), q, v, inputs);
    let Some((index, pivot)) = negative_pivot(matrix) else { return Ok(()) };
    Err(Error::NegativeInertia {
        t: t.to_f64(),
        coordinate: coordinate(&S::FACTS, index),
        pivot,
        suspects: negative(system),
    })
}

/// Returns the first pivot of M = L D Lᵀ that is negative by more than its rounding error.
///
/// Each pivot is compared with its diagonal entry of M, which makes the check independent of the
/// units of the coordinates. The search ends at a pivot that is NaN or zero up to rounding; the
/// accelerations show the problem in that case.
fn negative_pivot<T: Float, const N: usize>(mut matrix: SMatrix<T, N, N>) -> Option<(usize, f64)> {
    let rounding = T::from_f64(8.0 * N as f64) * T::EPSILON;
    let diagonal: [T; N] = core::array::from_fn(|i| matrix[(i, i)].abs());
    for j in 0..N {
        let pivot = matrix[(j, j)];
        let noise = rounding * diagonal[j];
        if pivot < -noise {
            return Some((j, pivot.to_f64()));
        }
        // False for NaN, too.
        let regular = noise < pivot;
        if !regular {
            return None;
        }
        for i in j + 1..N {
            let factor = matrix[(i, j)] / pivot;
            for k in j + 1..=i {
                let part = factor * matrix[(k, j)];
                matrix[(i, k)] -= part;
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::negative_pivot;
    use nalgebra::{Matrix2, Matrix3};

    #[test]
    fn the_first_negative_pivot_is_found_in_any_units() {
        for unit in [1e-150, 1.0, 1e150] {
            let matrix =
                |entries: [f64; 4]| Matrix2::new(entries[0], entries[1], entries[1], entries[3]);
            let scaled = |[a, b, _, d]: [f64; 4]| matrix([a, b * unit, b * unit, d * unit * unit]);
            assert_eq!(negative_pivot(scaled([2.0, 1.0, 1.0, 1.0])), None);
            assert_eq!(negative_pivot(scaled([-1.0, 1.0, 1.0, 1.0])), Some((0, -1.0)));
            let (index, pivot) = negative_pivot(scaled([2.0, 2.0, 2.0, 1.0])).unwrap();
            assert!(index == 1 && (pivot / (unit * unit) + 1.0).abs() < 1e-12, "{pivot}");
        }
    }

    /// A matrix of rank one is singular for any rounding; NaN is no evidence of a negative pivot.
    #[test]
    fn rounding_and_numbers_that_are_none_are_no_negative_pivots() {
        for k in 1..2000 {
            let x = [f64::from(k) / 7.0, 1.0 / f64::from(k), 0.3];
            assert_eq!(negative_pivot(Matrix3::from_fn(|i, j| x[i] * x[j])), None);
            let x = x.map(|x| x as f32);
            assert_eq!(negative_pivot(Matrix3::from_fn(|i, j| x[i] * x[j])), None);
        }
        assert_eq!(negative_pivot(Matrix2::new(f64::NAN, 0.0, 0.0, -1.0)), None);
        assert_eq!(negative_pivot(Matrix2::new(0.0, 1.0, 1.0, 0.0)), None);
    }
}
