//! Turns about an axis.

use crate::attitude::{Attitude, product};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A turn about a fixed axis by an angle that is a motion itself, as the four numbers of a unit
/// quaternion: a turntable, a door, a steered wheel.
///
/// ```
/// use pendulum_runtime::motion::{Sinusoid, Turning};
///
/// // To and fro about the vertical.
/// let platform = Turning::new([0.0, 0.0, 1.0], Sinusoid::new([0.2], 3.0, [0.0]));
/// # let _ = platform;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Turning<M> {
    axis: [f64; 3],
    angle: M,
    /// The attitude at the angle zero.
    start: [f64; 4],
}

impl<M> Turning<M> {
    /// Creates a turn about `axis` in space, which may have any length but zero, from the attitude
    /// whose axes are those of space.
    ///
    /// The axis zero gives NaN, which integrations refuse.
    pub fn new(axis: [f64; 3], angle: M) -> Self {
        let [_, x, y, z] =
            Attitude::from_quaternion([0.0, axis[0], axis[1], axis[2]]).to_quaternion();
        Self { axis: [x, y, z], angle, start: [1.0, 0.0, 0.0, 0.0] }
    }

    /// Sets the attitude at the angle zero.
    #[must_use]
    pub fn starting_at(self, attitude: Attitude) -> Self {
        Self { start: attitude.to_quaternion(), ..self }
    }
}

impl<T: Real, M: Motion<T, 1>> Motion<T, 4> for Turning<M> {
    const HAS: Derivatives = M::HAS;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 4> {
        let angle = self.angle.sample(t, side, wanted.with_lower());
        let half = T::from_f64(0.5);
        let [phase, rate, change] =
            [angle.position[0], angle.velocity[0], angle.acceleration[0]].map(|part| part * half);
        let (sin, cos) = phase.sin_cos();
        let [x, y, z] = self.axis.map(T::from_f64);
        let start = self.start.map(T::from_f64);
        let turned = |w: T, s: T| product([w, x * s, y * s, z * s], start);
        let mut sample = Sample::zero();
        if wanted.contains(Derivatives::POSITION) {
            sample.position = turned(cos, sin);
        }
        if wanted.contains(Derivatives::VELOCITY) {
            sample.velocity = turned(-(rate * sin), rate * cos);
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            let square = rate * rate;
            let across = -(change * sin + square * cos);
            sample.acceleration = turned(across, change * cos - square * sin);
        }
        sample
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.angle.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        self.angle.kink_before(t)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        self.angle.longest_step(t, widths)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.angle.rest_until(t)
    }
}

#[cfg(test)]
mod tests {
    use super::Turning;
    use crate::attitude::{Attitude, Rates};
    use crate::motion::{Derivatives, Motion, Sample, Side, Sinusoid};
    use crate::time::Time;

    #[test]
    fn a_turn_has_the_rates_of_its_angle() {
        let angle = Sinusoid::new([0.7], 3.0, [0.4]).about([0.2]);
        let start = Attitude::from_euler("zxz", [0.3, 1.0, 2.0]).unwrap();
        let axis = [1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0];
        let turning = Turning::new(axis.map(|part| 5.0 * part), angle).starting_at(start);
        for t in [0.0, 0.3, 1.7, 4.0] {
            let own: Sample<f64, 1> = angle.sample(Time::new(t), Side::After, Derivatives::ALL);
            let found: Sample<f64, 4> = turning.sample(Time::new(t), Side::After, Derivatives::ALL);
            let exact = Attitude::from_axis_angle(axis, own.position[0]) * start;
            let attitude = Attitude::from_quaternion(found.position);
            let rates = Rates::from_derivative(attitude, found.velocity).in_space(attitude);
            for d in 0..4 {
                assert!((found.position[d] - exact.to_quaternion()[d]).abs() < 1e-15);
            }
            // Of q̈ = ½ α∘q − |q̇|² q, the part along the derivative of ω.
            let speed: f64 = found.velocity.iter().map(|part| part * part).sum();
            let rest: [f64; 4] =
                core::array::from_fn(|d| found.acceleration[d] + speed * found.position[d]);
            let change = Rates::from_derivative(attitude, rest).in_space(attitude);
            for d in 0..3 {
                assert!((rates[d] - axis[d] * own.velocity[0]).abs() < 1e-14);
                assert!((change[d] - axis[d] * own.acceleration[0]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn only_what_is_wanted_is_computed() {
        let turning = Turning::new([0.0, 0.0, 2.0], Sinusoid::new([0.7], 3.0, [0.4]));
        let all: Sample<f64, 4> = turning.sample(Time::new(0.3), Side::After, Derivatives::ALL);
        for wanted in [Derivatives::VELOCITY, Derivatives::ACCELERATION] {
            let some: Sample<f64, 4> = turning.sample(Time::new(0.3), Side::After, wanted);
            assert_eq!(some.position, [0.0; 4]);
            let velocity = wanted == Derivatives::VELOCITY;
            assert_eq!(some.velocity, if velocity { all.velocity } else { [0.0; 4] });
            assert_eq!(some.acceleration, if velocity { [0.0; 4] } else { all.acceleration });
        }
    }
}
