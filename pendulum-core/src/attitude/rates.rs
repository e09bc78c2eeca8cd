//! Rates of turning.

use crate::attitude::quaternion::{Attitude, product};
use crate::scalar::Real;

/// An angular velocity in rad/s, along the axes of a solid or of space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rates<T = f64> {
    components: [T; 3],
    of_body: bool,
}

impl<T: Real> Rates<T> {
    /// Creates an angular velocity from its components along the axes of the solid, as a gyroscope
    /// on it measures them.
    pub fn body(components: [T; 3]) -> Self {
        Self { components, of_body: true }
    }

    /// Creates an angular velocity from its components along the axes of space.
    pub fn space(components: [T; 3]) -> Self {
        Self { components, of_body: false }
    }

    /// Returns the angular velocity from the rates of an attitude's quaternion.
    ///
    /// The part of the rates that would change the quaternion's length does not count.
    pub fn from_derivative(attitude: Attitude<T>, derivative: [T; 4]) -> Self {
        let [_, x, y, z] = product(attitude.inverse().to_quaternion(), derivative);
        Self::body([x + x, y + y, z + z])
    }

    /// Returns the rates of the attitude's quaternion: ½ q∘Ω for components Ω along the axes of the
    /// solid, ½ ω∘q for components ω in space.
    pub fn derivative(self, attitude: Attitude<T>) -> [T; 4] {
        let [x, y, z] = self.components.map(|part| part * T::from_f64(0.5));
        let (half, quaternion) = ([T::from_f64(0.0), x, y, z], attitude.to_quaternion());
        if self.of_body { product(quaternion, half) } else { product(half, quaternion) }
    }

    /// Returns the components along the axes of a solid in `attitude`.
    pub fn in_body(self, attitude: Attitude<T>) -> [T; 3] {
        if self.of_body { self.components } else { attitude.inverse() * self.components }
    }

    /// Returns the components along the axes of space for a solid in `attitude`.
    pub fn in_space(self, attitude: Attitude<T>) -> [T; 3] {
        if self.of_body { attitude * self.components } else { self.components }
    }
}

#[cfg(test)]
mod tests {
    use super::Rates;
    use crate::attitude::Attitude;
    use crate::scalar::Dual;

    fn tilted() -> Attitude {
        Attitude::from_euler("zxz", [0.3, 1.2, -2.0]).unwrap()
    }

    #[test]
    fn vectors_on_a_solid_turn_with_its_rates() {
        let (attitude, vector, omega) = (tilted(), [0.2, -1.0, 0.4], [0.7, -0.3, 1.9]);
        for rates in [Rates::body(omega), Rates::space(omega)] {
            let derivative = rates.derivative(attitude);
            let moving = core::array::from_fn(|k| Dual {
                value: attitude.to_quaternion()[k],
                derivative: derivative[k],
            });
            let turned = Attitude::from_quaternion(moving) * vector.map(Dual::constant);
            let [x, y, z] = turned.map(|part| part.value);
            let [a, b, c] = rates.in_space(attitude);
            let across = [b * z - c * y, c * x - a * z, a * y - b * x];
            for k in 0..3 {
                assert!((turned[k].derivative - across[k]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn rates_of_quaternions_do_not_change_their_length() {
        let derivative = Rates::space([0.7, -0.3, 1.9]).derivative(tilted());
        let along: f64 = (0..4).map(|k| derivative[k] * tilted().to_quaternion()[k]).sum();
        assert!(along.abs() < 1e-15);
    }

    #[test]
    fn rates_come_back_from_the_derivative() {
        let omega = [0.7, -0.3, 1.9];
        let attitude = tilted();
        let rates = Rates::from_derivative(attitude, Rates::body(omega).derivative(attitude));
        let space = Rates::from_derivative(attitude, Rates::space(omega).derivative(attitude));
        for k in 0..3 {
            assert!((rates.in_body(attitude)[k] - omega[k]).abs() < 1e-15);
            assert!((space.in_space(attitude)[k] - omega[k]).abs() < 1e-15);
        }
    }

    #[test]
    fn body_and_space_differ_by_the_attitude() {
        let quarter = Attitude::from_axis_angle([0.0, 0.0, 1.0], core::f64::consts::FRAC_PI_2);
        let [x, y, z] = Rates::body([1.0, 0.0, 0.0]).in_space(quarter);
        assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.0);
        let [x, y, z] = Rates::space([1.0, 0.0, 0.0]).in_body(quarter);
        assert!(x.abs() < 1e-15 && (y + 1.0).abs() < 1e-15 && z == 0.0);
    }
}
