//! Symmetric matrices, such as inertias, as parameters of systems.

use crate::body::error::BodyError;
use crate::scalar::Float;
use nalgebra::SMatrix;

/// Returns the entries xx, yy, zz, xy, xz and yz of a symmetric matrix, which are the value of a
/// parameter `J: [kg*m^2; 3, 3]`.
///
/// Opposite entries may differ by rounding, as those of a turned matrix `R * J * R.transpose()`; the
/// result is their mean.
///
/// # Errors
///
/// [`BodyError::Argument`] if opposite entries differ by more than sixteen units in the last place
/// of the largest entry, or if an entry is infinite or NaN.
///
/// # Examples
///
/// ```
/// use pendulum_runtime::body::symmetric;
/// use pendulum_runtime::nalgebra::Matrix3;
///
/// let inertia = Matrix3::new(3.0, -0.1, 0.0, -0.1, 4.0, 0.2, 0.0, 0.2, 5.0);
/// assert_eq!(symmetric(&inertia)?, [3.0, 4.0, 5.0, -0.1, 0.0, 0.2]);
/// assert!(symmetric(&Matrix3::new(3.0, 0.1, 0.0, -0.1, 4.0, 0.2, 0.0, 0.2, 5.0)).is_err());
/// # Ok::<(), pendulum_runtime::body::BodyError>(())
/// ```
pub fn symmetric<T: Float>(matrix: &SMatrix<T, 3, 3>) -> Result<[T; 6], BodyError> {
    let zero = T::from_f64(0.0);
    let mut largest = zero;
    for &entry in matrix {
        if !entry.is_finite() {
            return Err(argument("matrix entry", entry, "finite"));
        }
        largest = largest.max(entry.abs());
    }
    let mut entries = [zero; 6];
    let places = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    for (entry, (row, column)) in entries.iter_mut().zip(places) {
        let (above, below) = (matrix[(row, column)], matrix[(column, row)]);
        let difference = above - below;
        if T::from_f64(16.0) * T::EPSILON * largest < difference.abs() {
            let required = "zero in a symmetric matrix";
            return Err(argument("difference of opposite entries", difference, required));
        }
        *entry = below + difference * T::from_f64(0.5);
    }
    Ok(entries)
}

fn argument<T: Float>(name: &'static str, value: T, required: &'static str) -> BodyError {
    BodyError::Argument { name, value: value.to_f64(), required }
}

#[cfg(test)]
mod tests {
    use super::symmetric;
    use nalgebra::{Matrix3, Rotation3, Vector3};

    #[test]
    fn a_turned_matrix_is_symmetric() {
        let turn = Rotation3::new(Vector3::new(0.3, -1.2, 0.7)).into_inner();
        let turned =
            turn * Matrix3::from_diagonal(&Vector3::new(1.0, 20.0, 300.0)) * turn.transpose();
        let [xx, yy, zz, xy, xz, yz] = symmetric(&turned).unwrap();
        let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        assert!((own - turned).amax() < 1e-13);
        assert!(symmetric(&turned.map(|entry| entry as f32)).is_ok());
    }

    #[test]
    fn what_is_not_symmetric_is_told() {
        let message = |matrix: Matrix3<f64>| symmetric(&matrix).unwrap_err().to_string();
        let mut matrix = Matrix3::identity();
        matrix[(0, 2)] = 0.5;
        assert_eq!(
            message(matrix),
            "the difference of opposite entries is 0.5; it must be zero in a symmetric matrix"
        );
        matrix[(0, 2)] = f64::NAN;
        assert_eq!(message(matrix), "the matrix entry is NaN; it must be finite");
    }

    #[test]
    fn the_largest_numbers_have_a_mean() {
        let matrix = Matrix3::repeat(f64::MAX);
        assert_eq!(symmetric(&matrix).unwrap(), [f64::MAX; 6]);
    }
}
