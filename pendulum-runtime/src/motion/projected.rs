//! Motions in space, seen in a plane.

use super::{Motion, Orders, Sample, Side};
use crate::real::Real;
use crate::time::Time;

/// A motion in space as it is seen in a plane: P x(t), with velocities and accelerations to match.
#[derive(Clone, Debug, PartialEq)]
pub struct Projected<M> {
    motion: M,
    rows: [[f64; 3]; 2],
}

impl<M> Projected<M> {
    /// `rows` are the directions that become x and y of the plane; a length other than one scales the motion.
    ///
    /// `[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]` looks along the third axis, `[[0.01, 0.0, 0.0], [0.0, 0.01, 0.0]]` does so from
    /// centimetres.
    pub const fn new(motion: M, rows: [[f64; 3]; 2]) -> Self {
        Self { motion, rows }
    }
}

impl<T: Real, M: Motion<T, 3>> Motion<T, 2> for Projected<M> {
    const HAS: Orders = M::HAS;

    #[inline]
    fn sample(&self, t: Time, side: Side, orders: Orders) -> Sample<T, 2> {
        let sample = self.motion.sample(t, side, orders);
        let seen = |vector: [T; 3]| {
            self.rows.map(|row| {
                let [a, b, c] = row.map(T::from_f64);
                a * vector[0] + b * vector[1] + c * vector[2]
            })
        };
        Sample { position: seen(sample.position), velocity: seen(sample.velocity), acceleration: seen(sample.acceleration) }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.motion.next_kink(t)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.motion.rest_until(t)
    }
}
