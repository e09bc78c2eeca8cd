//! Mistakes that a system shows: parameters that explain numbers that are not finite, and a mass
//! matrix that is not positive definite.

use crate::error::{Error, Suspect};
use crate::scalar::Float;
use crate::system::at::At;
use crate::system::dynamics::scalar_time;
use crate::system::equations::System;
use crate::time::Time;
use nalgebra::SMatrix;

/// Returns the parameters that are zero, infinite or NaN, with their values: the likely causes of
/// accelerations that are not finite.
pub fn suspects<S: System<N, Scalar: Float>, const N: usize>(system: &S) -> Vec<Suspect> {
    parameters(system, |value| value == 0.0 || !value.is_finite())
}

/// Returns the parameters with values that are `suspicious`.
fn parameters<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    suspicious: impl Fn(f64) -> bool,
) -> Vec<Suspect> {
    let (mut index, mut suspects) = (0, Vec::new());
    system.map(|parameter| {
        let value = parameter.to_f64();
        if suspicious(value) {
            let parameter = S::FACTS.parameters.get(index).copied().unwrap_or("");
            suspects.push(Suspect { parameter, value });
        }
        index += 1;
        parameter
    });
    suspects
}

/// Checks that the mass matrix at `t`, `q` and `v` has no negative pivot, as the kinetic energy of
/// bodies with mass requires. `inputs` are sampled for
/// [`Purpose::Momenta`](crate::system::Purpose::Momenta).
///
/// Systems written by hand need no mass matrix, and are not checked.
///
/// # Errors
/// Returns [`Error::NegativeInertia`] with the coordinate of the pivot and the negative parameters.
pub fn check_inertia<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    t: Time,
    q: &[S::Scalar; N],
    v: &[S::Scalar; N],
    inputs: &S::Inputs,
) -> Result<(), Error> {
    if !S::FACTS.derived {
        return Ok(());
    }
    let matrix = system.mass_matrix(At { t: scalar_time(t), q, v, inputs });
    let Some((index, pivot)) = negative_pivot(matrix) else { return Ok(()) };
    Err(Error::NegativeInertia {
        t: t.to_f64(),
        coordinate: S::FACTS.coordinate(index),
        pivot,
        suspects: parameters(system, |value| value < 0.0),
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
