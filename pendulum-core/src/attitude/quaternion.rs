//! Attitudes as unit quaternions.

use crate::attitude::euler::AttitudeError;
use crate::scalar::{Float, Real};
use core::ops::Mul;
use nalgebra::SMatrix;

/// An attitude in space, which turns the axes of a solid from those of space.
///
/// It is a unit quaternion. The quaternions q and −q are the same attitude; constructors keep the
/// sign that their arguments suggest, so that an attitude which changes continuously has a
/// quaternion which does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Attitude<T = f64> {
    quaternion: [T; 4],
}

impl<T: Real> Attitude<T> {
    /// Creates the attitude whose axes are those of space.
    pub fn identity() -> Self {
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        Self { quaternion: [one, zero, zero, zero] }
    }

    /// Creates the attitude of a quaternion [w, x, y, z] of any length but zero, with its sign.
    pub fn from_quaternion(quaternion: [T; 4]) -> Self {
        Self { quaternion: unit(quaternion) }
    }

    /// Returns the quaternion [w, x, y, z].
    pub fn to_quaternion(self) -> [T; 4] {
        self.quaternion
    }

    /// Creates a turn by `angle` about `axis`, which may have any length but zero.
    ///
    /// A full turn is the quaternion −1.
    pub fn from_axis_angle(axis: [T; 3], angle: T) -> Self {
        let (sin, cos) = (angle * T::from_f64(0.5)).sin_cos();
        let [x, y, z] = unit(axis).map(|part| part * sin);
        Self::from_quaternion([cos, x, y, z])
    }

    /// Returns a unit vector and the angle of the turn about it, from 0 to π.
    ///
    /// The axis is z if the angle is zero, and either of the two if it is π.
    pub fn to_axis_angle(self) -> ([T; 3], T) {
        let [zero, one, two] = [0.0, 1.0, 2.0].map(T::from_f64);
        let [w, x, y, z] = self.quaternion;
        let sign = w.where_positive(one, (-w).where_positive(-one, one));
        let vector = [x, y, z].map(|part| part * sign);
        let sin = length(vector);
        let along = |part: T, otherwise| sin.where_positive(part / sin, otherwise);
        let axis = [along(vector[0], zero), along(vector[1], zero), along(vector[2], one)];
        (axis, two * sin.atan2(w * sign))
    }

    /// Creates a turn about a vector by its length in radians.
    pub fn from_rotation_vector(vector: [T; 3]) -> Self {
        let half = vector.map(|part| part * T::from_f64(0.5));
        let angle = length(half);
        let [x, y, z] = half.map(|part| part * angle.sinc(0));
        Self::from_quaternion([angle.cos(), x, y, z])
    }

    /// Returns the axis times the angle from 0 to π.
    pub fn to_rotation_vector(self) -> [T; 3] {
        let (axis, angle) = self.to_axis_angle();
        axis.map(|part| part * angle)
    }

    /// Creates the shortest turn that brings the direction `from` to the direction `to`; neither
    /// may be zero.
    ///
    /// If they are opposite, it is the half turn about an axis that is perpendicular to `from` and
    /// to that of x, y and z which is farthest from the line of `from`; to the first, of equal ones.
    pub fn from_directions(from: [T; 3], to: [T; 3]) -> Self {
        let (from, to) = (unit(from), unit(to));
        let half = T::from_f64(0.5);
        let sum: [T; 3] = core::array::from_fn(|k| from[k] + to[k]);
        let apart: [T; 3] = core::array::from_fn(|k| to[k] - from[k]);
        let (middle, reach) = (length(sum), length(apart));
        // The product of `from` and the direction in the middle. If the sum is short, rounding errors
        // of this direction would change the angle; an error of the axis alone turns about `from`,
        // which hardly moves the opposite direction.
        let across = cross(from, sum);
        let width = length(across);
        let near = middle - T::from_f64(1.0);
        let opposite = width - T::from_f64(1e-15);
        let aside = perpendicular(from);
        let vector = core::array::from_fn(|k| {
            let far = opposite.where_positive(reach * half * (across[k] / width), aside[k]);
            near.where_positive(across[k] / middle, far)
        });
        let [x, y, z]: [T; 3] = vector;
        Self::from_quaternion([middle * half, x, y, z])
    }

    /// Returns the matrix whose columns are the axes of the solid in space.
    pub fn to_matrix(self) -> SMatrix<T, 3, 3> {
        let [w, x, y, z] = self.quaternion;
        let one = T::from_f64(1.0);
        let twice = |value: T| value + value;
        SMatrix::from([
            [one - twice(y * y + z * z), twice(x * y + w * z), twice(x * z - w * y)],
            [twice(x * y - w * z), one - twice(x * x + z * z), twice(y * z + w * x)],
            [twice(x * z + w * y), twice(y * z - w * x), one - twice(x * x + y * y)],
        ])
    }

    /// Returns the turn back. Its quaternion is the conjugate.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [w, x, y, z] = self.quaternion;
        Self { quaternion: [w, -x, -y, -z] }
    }

    /// Maps every number of the quaternion, to another scalar.
    pub fn map<U>(self, map: impl FnMut(T) -> U) -> Attitude<U> {
        Attitude { quaternion: self.quaternion.map(map) }
    }
}

impl<T: Float> Attitude<T> {
    /// Creates the attitude of a matrix whose columns are the axes of the solid in space, with a
    /// real part that is not negative.
    ///
    /// # Errors
    /// If a product of two columns is off by more than 10⁻⁶, or if the columns are left-handed.
    pub fn from_matrix(matrix: SMatrix<T, 3, 3>) -> Result<Self, AttitudeError> {
        let columns: [[T; 3]; 3] = matrix.into();
        let mut off = 0.0_f64;
        for (j, &left) in columns.iter().enumerate() {
            for (k, &right) in columns.iter().enumerate() {
                let product = dot(left, right).to_f64() - if j == k { 1.0 } else { 0.0 };
                off = if product.abs() <= off { off } else { product.abs() };
            }
        }
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        // NaN is refused, too.
        if !(off <= 1e-6 && zero < dot(columns[0], cross(columns[1], columns[2]))) {
            return Err(AttitudeError::NoRotation { off });
        }
        // 4q qᵀ has the row of each component; that of the greatest does not cancel (Shepperd 1978).
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = columns;
        let rows = [
            [one + xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, one + xx - yy - zz, xy + yx, xz + zx],
            [zx - xz, xy + yx, one - xx + yy - zz, yz + zy],
            [xy - yx, xz + zx, yz + zy, one - xx - yy + zz],
        ];
        let mut row = 0;
        for k in 1..4 {
            if rows[row][row] < rows[k][k] {
                row = k;
            }
        }
        let quaternion = rows[row];
        let sign = if quaternion[0] < zero { -one } else { one };
        Ok(Self::from_quaternion(quaternion.map(|part| sign * part)))
    }
}

impl<T: Real> Mul for Attitude<T> {
    type Output = Self;

    /// Composes two turns: the right one is the first.
    fn mul(self, first: Self) -> Self {
        Self::from_quaternion(product(self.quaternion, first.quaternion))
    }
}

impl<T: Real> Mul<[T; 3]> for Attitude<T> {
    type Output = [T; 3];

    /// Turns a vector, from components along the axes of the solid to components in space.
    fn mul(self, vector: [T; 3]) -> [T; 3] {
        let [w, axis @ ..] = self.quaternion;
        let across = cross(axis, vector);
        let twice = across.map(|part| part + part);
        let again = cross(axis, twice);
        core::array::from_fn(|k| vector[k] + w * twice[k] + again[k])
    }
}

/// Returns the product of two quaternions.
pub(crate) fn product<T: Real>(a: [T; 4], b: [T; 4]) -> [T; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// Returns `vector` divided by its length.
fn unit<T: Real, const K: usize>(vector: [T; K]) -> [T; K] {
    // Scaled first, because squares of long and short vectors are out of the range of numbers.
    let largest = vector.iter().fold(T::from_f64(0.0), |largest, part| largest.max(part.abs()));
    let vector = vector.map(|part| part / largest);
    let size = length(vector);
    vector.map(|part| part / size)
}

fn length<T: Real, const K: usize>(vector: [T; K]) -> T {
    dot(vector, vector).sqrt()
}

fn dot<T: Real, const K: usize>(a: [T; K], b: [T; K]) -> T {
    (1..K).fold(a[0] * b[0], |sum, k| sum + a[k] * b[k])
}

fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns a unit vector perpendicular to `vector` and to the coordinate axis farthest from it.
fn perpendicular<T: Real>(vector: [T; 3]) -> [T; 3] {
    let [x, y, z] = vector.map(Real::abs);
    let [zero, one] = [0.0, 1.0].map(T::from_f64);
    // 1 for the smallest component and 0 for the others; the first counts if two are equal.
    let z_least = (x.min(y) - z).where_positive(one, zero);
    let y_least = (x - y).where_positive(one - z_least, zero);
    unit(cross(vector, [one - z_least - y_least, y_least, z_least]))
}

#[cfg(test)]
pub(in crate::attitude) mod tests {
    use super::{Attitude, cross, dot, length};
    use crate::attitude::AttitudeError;
    use crate::scalar::{Dual, Octet};
    use core::f64::consts::PI;
    use nalgebra::{Matrix3, Vector3};

    /// Checks that two quaternions are equal up to their sign.
    pub(in crate::attitude) fn same(a: Attitude, b: Attitude, tolerance: f64) {
        let cosine = dot(a.quaternion, b.quaternion);
        let apart: [f64; 4] =
            core::array::from_fn(|k| a.quaternion[k] - cosine.signum() * b.quaternion[k]);
        assert!(length(apart) <= tolerance, "{a:?} is not {b:?}");
    }

    fn some() -> Vec<Attitude> {
        let mut attitudes = vec![Attitude::identity()];
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 2.0], [1.0, 2.0, -3.0]] {
            for angle in [1e-9, 0.3, 1.5, 3.0, PI, 4.0, 6.2] {
                attitudes.push(Attitude::from_axis_angle(axis, angle));
            }
        }
        attitudes
    }

    #[test]
    fn a_turn_is_that_of_rodrigues() {
        let (axis, vector) = ([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], [0.3, -1.2, 0.7]);
        for angle in [0.0_f64, 0.4, 2.0, -3.0, 5.0] {
            let (sin, cos) = crate::scalar::Real::sin_cos(angle);
            let (across, along) = (cross(axis, vector), dot(axis, vector));
            let turned = Attitude::from_axis_angle(axis, angle) * vector;
            for k in 0..3 {
                let exact = cos * vector[k] + sin * across[k] + (1.0 - cos) * along * axis[k];
                assert!((turned[k] - exact).abs() < 1e-15, "{angle}");
            }
        }
    }

    #[test]
    fn every_form_comes_back() {
        for attitude in some() {
            let (axis, angle) = attitude.to_axis_angle();
            assert!((0.0..=PI).contains(&angle) && (length(axis) - 1.0).abs() < 4e-16);
            same(Attitude::from_axis_angle(axis, angle), attitude, 5e-16);
            same(Attitude::from_rotation_vector(attitude.to_rotation_vector()), attitude, 5e-16);
            same(Attitude::from_matrix(attitude.to_matrix()).unwrap(), attitude, 5e-16);
            let [w, x, y, z] = attitude.to_quaternion();
            let double = Attitude::from_quaternion([2.0 * w, 2.0 * x, 2.0 * y, 2.0 * z]);
            same(double, attitude, 5e-16);
        }
    }

    #[test]
    fn quaternions_keep_their_sign_at_any_length() {
        for scale in [1e-300, 1.0, 1e300] {
            let quaternion = [-0.5, 0.5, -0.5, 0.5].map(|part: f64| part * scale);
            let unit = Attitude::from_quaternion(quaternion).to_quaternion();
            assert_eq!(unit, [-0.5, 0.5, -0.5, 0.5]);
        }
        assert_eq!(
            Attitude::from_axis_angle([0.0, 1e-200, 0.0], 2.0 * PI).to_quaternion()[0],
            -1.0
        );
    }

    #[test]
    fn what_is_no_attitude_is_not_a_number() {
        let wrong = [
            Attitude::from_quaternion([0.0; 4]),
            Attitude::from_quaternion([f64::INFINITY, 0.0, 0.0, 0.0]),
            Attitude::from_axis_angle([0.0; 3], 1.0),
            Attitude::from_axis_angle([1.0, 0.0, 0.0], f64::NAN),
            Attitude::from_rotation_vector([0.0, f64::NAN, 0.0]),
            Attitude::from_directions([0.0; 3], [1.0, 0.0, 0.0]),
            Attitude::from_directions([1.0, 0.0, 0.0], [0.0; 3]),
        ];
        for attitude in wrong {
            assert!(attitude.quaternion.iter().all(|part| part.is_nan()), "{attitude:?}");
        }
    }

    #[test]
    fn the_shortest_turn_brings_one_direction_to_the_other() {
        let directions = [[1.0_f64, 0.0, 0.0], [0.0, 0.0, 3.0], [-1.0, 2.0, 0.5], [0.3, 0.3, 0.3]];
        for from in directions {
            for to in directions.into_iter().chain(directions.map(|to| to.map(|part| -part))) {
                let attitude = Attitude::from_directions(from, to);
                let turned = attitude * from;
                for k in 0..3 {
                    let exact = to[k] / length(to) * length(from);
                    assert!((turned[k] - exact).abs() < 2e-15 * length(from), "{from:?} {to:?}");
                }
                let cosine = dot(from, to) / (length(from) * length(to));
                let angle = attitude.to_axis_angle().1;
                assert!((angle.cos() - cosine).abs() < 1e-15, "{from:?} {to:?}");
            }
        }
    }

    #[test]
    fn almost_opposite_directions_lose_no_digits() {
        let from = [0.6, 0.0, 0.8];
        for angle in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-16] {
            let to = Attitude::from_axis_angle([0.0, 1.0, 0.0], PI - angle) * from;
            let turned = Attitude::from_directions(from, to) * from;
            for k in 0..3 {
                assert!((turned[k] - to[k]).abs() < 1e-15, "{angle}");
            }
        }
    }

    #[test]
    fn opposite_directions_turn_about_the_stated_axis() {
        let about = |from: [f64; 3]| {
            Attitude::from_directions(from, from.map(|part| -part)).to_quaternion()
        };
        // Perpendicular to z and x; to x and y; to (1, 1, 0) and z.
        assert_eq!(about([0.0, 0.0, 2.0]), [0.0, 0.0, 1.0, 0.0]);
        assert_eq!(about([5.0, 0.0, 0.0]), [0.0, 0.0, 0.0, 1.0]);
        let [w, x, y, z] = about([1.0, 1.0, 0.0]);
        assert!(w == 0.0 && (x - 0.5_f64.sqrt()).abs() < 1e-15 && x == -y && z == 0.0);
    }

    #[test]
    fn turns_compose_as_matrices_do() {
        for a in some() {
            for b in some() {
                let composed = (a * b).to_matrix();
                assert!((composed - a.to_matrix() * b.to_matrix()).amax() < 2e-15);
            }
            same(a * a.inverse(), Attitude::identity(), 3e-16);
            let vector = Vector3::new(0.3, -0.2, 1.0);
            let turned = Vector3::from(a * [0.3, -0.2, 1.0]);
            assert!((turned - a.to_matrix() * vector).amax() < 1e-15);
        }
    }

    #[test]
    fn matrices_that_are_no_rotations_are_refused() {
        let mirror = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0);
        let error = Attitude::from_matrix(mirror).unwrap_err();
        assert_eq!(error, AttitudeError::NoRotation { off: 0.0 });
        assert!(error.to_string().contains("right-handed"));
        let stretched = Matrix3::identity() * 1.001;
        let error = Attitude::from_matrix(stretched).unwrap_err();
        assert!(
            matches!(error, AttitudeError::NoRotation { off } if (off - 0.002001).abs() < 1e-15)
        );
        for bad in [f64::NAN, f64::INFINITY, 0.0] {
            assert!(Attitude::from_matrix(Matrix3::identity() * bad).is_err(), "{bad}");
        }
        // Rounded as a file writes it.
        let nearly = Attitude::from_euler("zyx", [0.3, 0.2, 0.1]).unwrap();
        let rounded = nearly.to_matrix().map(|part: f64| (part * 1e7).round() / 1e7);
        same(Attitude::from_matrix(rounded).unwrap(), nearly, 1e-7);
    }

    #[test]
    fn every_scalar_has_attitudes() {
        let eight = Attitude::from_axis_angle(
            [Octet([0.0, 1.0].repeat(4).try_into().unwrap()); 3],
            Octet([2.0_f64; 8]),
        );
        assert!(eight.to_quaternion()[0].0[0].is_nan() && !eight.to_quaternion()[0].0[1].is_nan());
        // d(R u)/dθ = n × R u.
        let axis = [0.6_f64, 0.0, 0.8];
        let attitude = Attitude::from_axis_angle(axis.map(Dual::constant), Dual::variable(0.7));
        let turned = attitude * [1.0, 2.0, 3.0].map(Dual::constant);
        let across = cross(axis, turned.map(|part| part.value));
        for k in 0..3 {
            assert!((turned[k].derivative - across[k]).abs() < 1e-15);
        }
    }
}
