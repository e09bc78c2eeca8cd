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

    /// The angle of component `d` in two words: one alone is rounded by 1e-12 after a second at 1
    /// kHz, and the acceleration with it.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn angle(&self, d: usize, t: Time) -> (f64, f64) {
        let (product, rounded) = product(self.frequency, t.to_f64());
        let (angle, left) = sum(product, self.phase[d]);
        (angle, left + (rounded + self.frequency * t.low()))
    }

    /// Sine and cosine of the angle of component `d`.
    #[inline]
    pub(super) fn sin_cos(&self, d: usize, t: Time) -> (f64, f64) {
        let (angle, low) = self.angle(d, t);
        let (sin, cos) = Real::sin_cos(angle);
        turned(sin, cos, low)
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
        self.at(orders, |d| self.sin_cos(d, t))
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
            let (mut angles, mut lows) = ([0.0; 8], [0.0; 8]);
            for k in 0..8 {
                (angles[k], lows[k]) = self.angle(d, times[k]);
            }
            let (sin, cos) = f64::sin_cos_lanes(&angles);
            let (a, w) = (self.amplitude[d], self.frequency);
            for k in 0..8 {
                let (sin, cos) = turned(sin[k], cos[k], lows[k]);
                let sample = of_component::<T>(orders, self.offset[d], a, w, sin, cos);
                [lanes.position[d].0[k], lanes.velocity[d].0[k], lanes.acceleration[d].0[k]] = sample;
            }
        }
        lanes
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    // No bound: it never pauses, so that every step sees it.
    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
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

/// A product and its rounding error (Dekker 1971); the halves are cut by bits, so that nothing
/// overflows before the product does.
#[inline(always)]
#[allow(clippy::inline_always)]
fn product(a: f64, b: f64) -> (f64, f64) {
    let half = |x: f64| f64::from_bits(x.to_bits() & !0x07ff_ffff);
    let (product, a_high, b_high) = (a * b, half(a), half(b));
    let (a_low, b_low) = (a - a_high, b - b_high);
    (product, ((a_high * b_high - product) + (a_high * b_low + a_low * b_high)) + a_low * b_low)
}

/// A sum and its rounding error (Knuth 1969).
#[inline(always)]
#[allow(clippy::inline_always)]
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// Sine and cosine of an angle that is larger by a rounding error.
#[inline(always)]
#[allow(clippy::inline_always)]
fn turned(sin: f64, cos: f64, low: f64) -> (f64, f64) {
    let half = 0.5 * low;
    (sin + low * (cos - half * sin), cos - low * (sin + half * cos))
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
            let (mut angles, mut lows) = ([0.0; AT_ONCE], [0.0; AT_ONCE]);
            let components = first..D.min(first + together);
            for (d, (angles, lows)) in components.clone().zip(angles.chunks_mut(count).zip(lows.chunks_mut(count))) {
                for ((angle, low), &t) in angles.iter_mut().zip(lows).zip(self.times) {
                    (*angle, *low) = self.sinusoid.angle(d, t);
                }
            }
            let (mut sines, mut cosines) = f64::sin_cos_lanes(&angles);
            for k in 0..AT_ONCE {
                (sines[k], cosines[k]) = turned(sines[k], cosines[k], lows[k]);
            }
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
