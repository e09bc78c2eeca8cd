//! A harmonic motion.

use super::{Analytic, Motion, Orders, Sample, Side};
use crate::real::Real;
use crate::time::Time;

/// A harmonic motion: x_d(t) = offset_d + amplitude_d · sin(frequency · t + phase_d).
///
/// With equal amplitudes and phases a quarter turn apart it is a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid<const D: usize> {
    /// In metres.
    pub amplitude: [f64; D],
    /// Angular frequency in rad/s.
    pub frequency: f64,
    /// In radians.
    pub phase: [f64; D],
    /// The centre, in metres.
    pub offset: [f64; D],
}

impl<const D: usize> Sinusoid<D> {
    /// A harmonic motion about the origin.
    pub const fn new(amplitude: [f64; D], frequency: f64, phase: [f64; D]) -> Self {
        Self { amplitude, frequency, phase, offset: [0.0; D] }
    }

    /// The same motion about another centre.
    pub const fn about(self, offset: [f64; D]) -> Self {
        Self { offset, ..self }
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Sinusoid<D> {
    const HAS: Orders = Orders::ALL;

    #[inline]
    fn sample(&self, t: Time, _: Side, orders: Orders) -> Sample<T, D> {
        let mut sample = Sample::zero();
        let w = self.frequency;
        for d in 0..D {
            let (sin, cos) = Real::sin_cos(w * t.to_f64() + (self.phase[d] + w * t.low()));
            let a = self.amplitude[d];
            if orders.contains(Orders::POSITION) {
                sample.position[d] = T::from_f64(self.offset[d] + a * sin);
            }
            if orders.contains(Orders::VELOCITY) {
                sample.velocity[d] = T::from_f64(a * w * cos);
            }
            if orders.contains(Orders::ACCELERATION) {
                sample.acceleration[d] = T::from_f64(-(a * w * w * sin));
            }
        }
        sample
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }
}
