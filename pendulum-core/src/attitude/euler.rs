//! Attitudes as three turns about coordinate axes.

use crate::attitude::quaternion::Attitude;
use crate::scalar::Real;
use core::fmt;

/// The reason for which numbers are no attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AttitudeError {
    /// The name of an order of axes is none of the twelve.
    Order,
    /// A matrix is no rotation.
    NoRotation {
        /// The largest deviation of a product of two columns from 0 or 1; it is small if the
        /// columns are left-handed.
        off: f64,
    },
}

impl fmt::Display for AttitudeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order => write!(
                f,
                "an order of axes is three letters of `x`, `y` and `z`, neighbours different, such as \"zyx\" or \"zxz\""
            ),
            Self::NoRotation { off } if *off <= 1e-6 => {
                write!(f, "the matrix is a reflection; its columns must be right-handed")
            }
            Self::NoRotation { off } => write!(
                f,
                "the matrix is no rotation: a product of two columns is off by {off:e}; they must be perpendicular unit vectors"
            ),
        }
    }
}

impl core::error::Error for AttitudeError {}

/// Returns the three axes of an order: 0 for x, 1 for y, 2 for z.
fn axes(order: &str) -> Result<[usize; 3], AttitudeError> {
    let &[a, b, c] = order.as_bytes() else { return Err(AttitudeError::Order) };
    let axis = |letter| b"xyz".iter().position(|&known| known == letter);
    match (axis(a), axis(b), axis(c)) {
        (Some(a), Some(b), Some(c)) if a != b && b != c => Ok([a, b, c]),
        _ => Err(AttitudeError::Order),
    }
}

impl<T: Real> Attitude<T> {
    /// Creates an attitude by three turns about the solid's own axes, each turned by those before
    /// it. `order` names the axes in this order: `"zyx"` is heading, climb and bank, and `"zxz"`
    /// Euler's precession, nutation and spin.
    ///
    /// # Errors
    /// If `order` is not three letters of `x`, `y` and `z`, of which neighbours differ.
    pub fn from_euler(order: &str, angles: [T; 3]) -> Result<Self, AttitudeError> {
        let [a, b, c] = axes(order)?;
        Ok(about(a, angles[0]) * about(b, angles[1]) * about(c, angles[2]))
    }

    /// Creates an attitude by three turns about the axes of space, one after the other in the order
    /// named.
    ///
    /// # Errors
    /// As [`from_euler`](Self::from_euler).
    pub fn from_extrinsic_euler(order: &str, angles: [T; 3]) -> Result<Self, AttitudeError> {
        let [a, b, c] = axes(order)?;
        Ok(about(c, angles[2]) * about(b, angles[1]) * about(a, angles[0]))
    }

    /// Returns the angles from which [`from_euler`](Self::from_euler) creates this attitude.
    ///
    /// The first and the third lie in [−π, π]. The second lies in [0, π] if the first and the third
    /// axis are the same, in [−π/2, π/2] otherwise. At the ends of this range (the gimbal lock)
    /// only the sum or the difference of the others is determined; the third is then zero.
    ///
    /// # Errors
    /// As [`from_euler`](Self::from_euler).
    pub fn to_euler(self, order: &str) -> Result<[T; 3], AttitudeError> {
        let [c, b, a] = self.extrinsic(axes(order).map(|[a, b, c]| [c, b, a])?, 2);
        Ok([a, b, c])
    }

    /// Returns the angles from which [`from_extrinsic_euler`](Self::from_extrinsic_euler) creates
    /// this attitude, with the ranges of [`to_euler`](Self::to_euler).
    ///
    /// # Errors
    /// As [`from_euler`](Self::from_euler).
    pub fn to_extrinsic_euler(self, order: &str) -> Result<[T; 3], AttitudeError> {
        Ok(self.extrinsic(axes(order)?, 0))
    }

    /// Returns angles about the axes of space; in a gimbal lock, only that of turn `kept` and the
    /// second are not zero.
    ///
    /// A quaternion whose first and third turn are about one axis is a product of two complex
    /// numbers, whose angles are half the sum and half the difference of theirs. If the axes
    /// differ, a quarter turn about the second makes them the same (Bernardes and Viollet 2022).
    fn extrinsic(self, [i, j, third]: [usize; 3], kept: usize) -> [T; 3] {
        let number = T::from_f64;
        let [w, vector @ ..] = self.to_quaternion();
        let k = 3 - i - j;
        // Right-handed axes i, j, k, or left-handed ones.
        let sign = number(if (i + 1) % 3 == j { 1.0 } else { -1.0 });
        let (x, y, z) = (vector[i], vector[j], sign * vector[k]);
        let proper = i == third;
        let [a, b, c, d] = if proper { [w, x, y, z] } else { [w - y, x + z, y + w, z - x] };
        let length = |a: T, b: T| (a * a + b * b).sqrt();
        let (sin, cos) = (length(c, d), length(a, b));
        let (sum, difference) = (b.atan2(a), d.atan2(c));
        let second = number(2.0) * sin.atan2(cos);
        // Rounding errors of the quaternion are as large.
        let least = number(1e-15);
        let [first_kept, last_kept] =
            [0, 2].map(|turn| number(if turn == kept { 2.0 } else { 0.0 }));
        let choose = |regular, without_sin, without_cos| {
            let regular = (cos - least).where_positive(regular, without_cos);
            wrapped((sin - least).where_positive(regular, without_sin))
        };
        let first = choose(sum - difference, first_kept * sum, -first_kept * difference);
        let last = choose(sum + difference, last_kept * sum, last_kept * difference);
        if proper {
            [first, second, last]
        } else {
            [first, second - T::pi() * number(0.5), sign * last]
        }
    }
}

/// Returns a turn about a coordinate axis.
fn about<T: Real>(axis: usize, angle: T) -> Attitude<T> {
    let mut vector = [T::from_f64(0.0); 3];
    vector[axis] = T::from_f64(1.0);
    Attitude::from_axis_angle(vector, angle)
}

/// Returns an angle between −2π and 2π in [−π, π].
fn wrapped<T: Real>(angle: T) -> T {
    let turn = T::pi() + T::pi();
    let angle = (angle - T::pi()).where_positive(angle - turn, angle);
    (-T::pi() - angle).where_positive(angle + turn, angle)
}

#[cfg(test)]
mod tests {
    use super::AttitudeError;
    use crate::attitude::Attitude;
    use crate::attitude::quaternion::tests::same;
    use crate::scalar::Real;
    use core::f64::consts::{FRAC_PI_2, PI};

    const ORDERS: [&str; 12] =
        ["xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"];

    fn matrix(axis: u8, angle: f64) -> nalgebra::Matrix3<f64> {
        let (s, c) = angle.sin_cos();
        match axis {
            b'x' => nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c),
            b'y' => nalgebra::Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c),
            _ => nalgebra::Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0),
        }
    }

    #[test]
    fn own_axes_multiply_matrices_to_the_right_and_those_of_space_to_the_left() {
        for order in ORDERS {
            let angles = [0.4, -1.1, 2.3];
            let &[a, b, c] = order.as_bytes() else { panic!("{order}") };
            let [first, second, third] =
                [matrix(a, angles[0]), matrix(b, angles[1]), matrix(c, angles[2])];
            let own = Attitude::from_euler(order, angles).unwrap().to_matrix();
            assert!((own - first * second * third).amax() < 1e-15, "{order}");
            let space = Attitude::from_extrinsic_euler(order, angles).unwrap().to_matrix();
            assert!((space - third * second * first).amax() < 1e-15, "{order}");
        }
    }

    #[test]
    fn angles_come_back_in_every_order() {
        for order in ORDERS {
            let shift = if order.as_bytes()[0] == order.as_bytes()[2] { FRAC_PI_2 } else { 0.0 };
            for first in [-3.1, -1.0, 0.0, 0.4, 3.0] {
                for second in [-1.5, -0.3, 0.0, 1.2, 1.55] {
                    for third in [-2.9, 0.0, 0.1, 2.0] {
                        let angles = [first, second + shift, third];
                        let attitude = Attitude::from_euler(order, angles).unwrap();
                        let back = attitude.to_euler(order).unwrap();
                        let lost = 1e-15 / Real::cos(second);
                        for k in 0..3 {
                            let off = (back[k] - angles[k]).abs();
                            assert!(off < 2.0 * lost + 1e-15, "{order} {angles:?} {back:?}");
                        }
                        let attitude = Attitude::from_extrinsic_euler(order, angles).unwrap();
                        let back = attitude.to_extrinsic_euler(order).unwrap();
                        let again = Attitude::from_extrinsic_euler(order, back).unwrap();
                        same(again, attitude, 2e-15);
                    }
                }
            }
        }
    }

    #[test]
    fn a_gimbal_lock_leaves_the_third_angle_zero() {
        for order in ORDERS {
            let proper = order.as_bytes()[0] == order.as_bytes()[2];
            for second in if proper { [0.0, PI] } else { [-FRAC_PI_2, FRAC_PI_2] } {
                for (first, third) in [(0.7, 0.4), (-2.0, -2.5), (3.0, -0.1), (0.0, 0.0)] {
                    let angles = [first, second, third];
                    let own = Attitude::from_euler(order, angles).unwrap();
                    let back = own.to_euler(order).unwrap();
                    assert!(back[2] == 0.0 && (back[1] - second).abs() < 3e-15, "{order} {back:?}");
                    same(Attitude::from_euler(order, back).unwrap(), own, 3e-15);
                    let space = Attitude::from_extrinsic_euler(order, angles).unwrap();
                    let back = space.to_extrinsic_euler(order).unwrap();
                    assert!(back[2] == 0.0 && (back[1] - second).abs() < 3e-15, "{order} {back:?}");
                    same(Attitude::from_extrinsic_euler(order, back).unwrap(), space, 3e-15);
                }
            }
        }
    }

    #[test]
    fn orders_that_are_none_are_refused() {
        for order in ["", "zy", "zyxz", "zzx", "xyy", "ZYX", "123", "zy\u{444}"] {
            let found = Attitude::from_euler(order, [0.0_f64; 3]);
            assert_eq!(found, Err(AttitudeError::Order), "{order}");
            assert_eq!(Attitude::<f64>::identity().to_euler(order), Err(AttitudeError::Order));
        }
    }
}
