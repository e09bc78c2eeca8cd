//! A harmonic motion.

use super::{Analytic, Motion, Orders, Sample, Side};
use crate::real::{Lane, Octet, Real};
use crate::simd::{Work, widest};
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

    /// The angle of component `d`.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn angle(&self, d: usize, t: Time) -> f64 {
        self.frequency * t.to_f64() + (self.phase[d] + self.frequency * t.low())
    }

    /// The sample where the components have these sines and cosines.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn at<T: Real>(&self, orders: Orders, sin_cos: impl Fn(usize) -> (f64, f64)) -> Sample<T, D> {
        let mut sample = Sample::zero();
        for d in 0..D {
            let ((sin, cos), a, w) = (sin_cos(d), self.amplitude[d], self.frequency);
            let component = of_component(orders, self.offset[d], a, w, sin, cos);
            [sample.position[d], sample.velocity[d], sample.acceleration[d]] = component;
        }
        sample
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
        self.at(orders, |d| Real::sin_cos(self.angle(d, t)))
    }

    fn sample_all(&self, times: &[Time], orders: Orders, samples: &mut [Sample<T, D>]) {
        for (times, samples) in times.chunks(AT_ONCE).zip(samples.chunks_mut(AT_ONCE)) {
            widest(Several { sinusoid: self, times, orders, samples });
        }
    }

    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn sample_lanes(&self, times: &[Time; 8], orders: Orders) -> Sample<Octet<T>, D>
    where
        T: Lane,
    {
        let mut lanes = Sample::<Octet<T>, D>::zero();
        for d in 0..D {
            let mut angles = [0.0; 8];
            for k in 0..8 {
                angles[k] = self.angle(d, times[k]);
            }
            let (sin, cos) = f64::sin_cos_lanes(&angles);
            let (a, w) = (self.amplitude[d], self.frequency);
            for k in 0..8 {
                let sample = of_component::<T>(orders, self.offset[d], a, w, sin[k], cos[k]);
                [lanes.position[d].0[k], lanes.velocity[d].0[k], lanes.acceleration[d].0[k]] = sample;
            }
        }
        lanes
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }
}

/// Position, velocity and acceleration of a component; those that `orders` leaves out are zero.
#[inline(always)]
#[allow(clippy::inline_always)]
fn of_component<T: Real>(orders: Orders, offset: f64, a: f64, w: f64, sin: f64, cos: f64) -> [T; 3] {
    let mut component = [T::from_f64(0.0); 3];
    if orders.contains(Orders::POSITION) {
        component[0] = T::from_f64(offset + a * sin);
    }
    if orders.contains(Orders::VELOCITY) {
        component[1] = T::from_f64(a * w * cos);
    }
    if orders.contains(Orders::ACCELERATION) {
        component[2] = T::from_f64(-(a * w * w * sin));
    }
    component
}

/// The times that are done at once.
const AT_ONCE: usize = 8;

/// A sinusoid at several times.
struct Several<'a, T, const D: usize> {
    sinusoid: &'a Sinusoid<D>,
    times: &'a [Time],
    orders: Orders,
    samples: &'a mut [Sample<T, D>],
}

impl<T: Real, const D: usize> Work for Several<'_, T, D> {
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn run(self) {
        let (mut sin, mut cos) = ([[0.0; AT_ONCE]; D], [[0.0; AT_ONCE]; D]);
        // As many components as there is room for go together.
        let count = self.times.len().max(1);
        let together = (AT_ONCE / count).max(1);
        let mut first = 0;
        while first < D {
            let mut angles = [0.0; AT_ONCE];
            let components = first..D.min(first + together);
            for (d, angles) in components.clone().zip(angles.chunks_mut(count)) {
                for (angle, &t) in angles.iter_mut().zip(self.times) {
                    *angle = self.sinusoid.angle(d, t);
                }
            }
            let (sines, cosines) = f64::sin_cos_lanes(&angles);
            for (d, (sines, cosines)) in components.zip(sines.chunks(count).zip(cosines.chunks(count))) {
                sin[d][..sines.len()].copy_from_slice(sines);
                cos[d][..cosines.len()].copy_from_slice(cosines);
            }
            first += together;
        }
        for (index, sample) in self.samples.iter_mut().enumerate() {
            *sample = self.sinusoid.at(self.orders, |d| (sin[d][index], cos[d][index]));
        }
    }
}
