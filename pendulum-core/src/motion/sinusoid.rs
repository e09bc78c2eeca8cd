//! A harmonic motion.

// Code for lanes must be compiled with the vector instructions of its caller.
#![allow(clippy::inline_always)]

use crate::motion::analytic::Analytic;
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::Series;
use crate::scalar::exact::{two_product, two_sum};
use crate::scalar::{Float, Octet, Real};
use crate::simd::{Work, widest};
use crate::time::Time;

/// A harmonic motion: x_d(t) = offset_d + amplitude_d · sin(frequency · t + phase_d).
///
/// With equal amplitudes and phases that differ by π/2 it is a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid<const D: usize> {
    /// The amplitude in metres.
    pub amplitude: [f64; D],
    /// The angular frequency in rad/s.
    pub frequency: f64,
    /// The phase in radians.
    pub phase: [f64; D],
    /// The centre in metres.
    pub offset: [f64; D],
}

impl<const D: usize> Sinusoid<D> {
    /// Creates a harmonic motion about the origin.
    pub const fn new(amplitude: [f64; D], frequency: f64, phase: [f64; D]) -> Self {
        Self { amplitude, frequency, phase, offset: [0.0; D] }
    }

    /// Returns the angle ω t in two words, for a time in two words. In one word the angle, and with
    /// it the acceleration, would have errors of 1e-12 after a second at 1 kHz.
    #[inline(always)]
    fn angle<L: Real>(&self, high: (L, [L; 2]), low: L) -> (L, L) {
        let (frequency, parts) = halves(self.frequency);
        let frequency = L::from_f64(frequency);
        let (angle, rounded) = two_product((frequency, parts.map(L::from_f64)), high);
        (angle, rounded + frequency * low)
    }

    /// Returns sine and cosine of the angle of component `d`.
    #[inline]
    pub(super) fn sin_cos(&self, d: usize, t: Time) -> (f64, f64) {
        self.sin_cos_at(d, self.angle(halves(t.to_f64()), t.low()), |low| far(&[low]))
    }

    /// Returns sine and cosine of the angle of component `d` for a given ω t.
    #[inline(always)]
    fn sin_cos_at<L: Real>(
        &self,
        d: usize,
        (angle, low): (L, L),
        far: impl Fn(L) -> bool,
    ) -> (L, L) {
        let (angle, left) = two_sum(angle, L::from_f64(self.phase[d]));
        let (sin, cos) = angle.sin_cos();
        turned(sin, cos, left + low, far)
    }

    /// Returns position, velocity and acceleration of component `d` from the sine and cosine of its
    /// angle; derivatives outside of `wanted` are zero.
    #[inline(always)]
    fn of_component<L: Real>(&self, wanted: Derivatives, d: usize, (sin, cos): (L, L)) -> [L; 3] {
        let (a, w, number) = (self.amplitude[d], self.frequency, L::from_f64);
        let mut component = [number(0.0); 3];
        if wanted.contains(Derivatives::POSITION) {
            component[0] = number(self.offset[d]) + number(a) * sin;
        }
        if wanted.contains(Derivatives::VELOCITY) {
            component[1] = number(a * w) * cos;
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            component[2] = -(number(a * w * w) * sin);
        }
        component
    }

    /// Returns the sample from the sines and cosines of the components.
    #[inline(always)]
    fn at<T: Real>(
        &self,
        wanted: Derivatives,
        sin_cos: impl Fn(usize) -> (f64, f64),
    ) -> Sample<T, D> {
        let mut sample = Sample::zero();
        for d in 0..D {
            let component = self.of_component(wanted, d, sin_cos(d)).map(T::from_f64);
            [sample.position[d], sample.velocity[d], sample.acceleration[d]] = component;
        }
        sample
    }

    /// Sets the centre of the motion.
    pub const fn about(self, offset: [f64; D]) -> Self {
        Self { offset, ..self }
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Sinusoid<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline(always)]
    fn sample(&self, t: Time, _: Side, wanted: Derivatives) -> Sample<T, D> {
        self.at(wanted, |d| self.sin_cos(d, t))
    }

    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, D>]) {
        for (times, samples) in times.chunks(AT_ONCE).zip(samples.chunks_mut(AT_ONCE)) {
            widest(Several { sinusoid: self, times, wanted, samples });
        }
    }

    #[inline(always)]
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, D>
    where
        T: Float,
    {
        let mut lanes = Sample::<Octet<T>, D>::zero();
        let (mut high, mut upper, mut lower) = ([0.0; 8], [0.0; 8], [0.0; 8]);
        for k in 0..8 {
            (high[k], [upper[k], lower[k]]) = halves(times[k].to_f64());
        }
        let high = (Octet(high), [Octet(upper), Octet(lower)]);
        let angle = self.angle(high, Octet(times.map(Time::low)));
        let mut sin_cos = (angle.0, angle.1);
        for d in 0..D {
            if d == 0 || self.phase[d].to_bits() != self.phase[d - 1].to_bits() {
                sin_cos = self.sin_cos_at(d, angle, |low: Octet<f64>| far(&low.0));
            }
            let component =
                self.of_component(wanted, d, sin_cos).map(|octet| Octet(octet.0.map(T::from_f64)));
            [lanes.position[d], lanes.velocity[d], lanes.acceleration[d]] = component;
        }
        lanes
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    // The width of a bell with the curvature of a crest, 1 − ω²t²/2, as for a sine in equations.
    fn longest_step(&self, _: f64, widths: f64) -> Option<f64> {
        let longest = widths * core::f64::consts::SQRT_2 / self.frequency.abs();
        // A frequency that is not finite is reported where it is sampled.
        Some(if 0.0 < longest { longest } else { f64::INFINITY })
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }
}

/// Returns a number and its two halves. Bits are masked, so that large numbers do not overflow.
#[inline(always)]
fn halves(x: f64) -> (f64, [f64; 2]) {
    let upper = f64::from_bits(x.to_bits() & !0x07ff_ffff);
    (x, [upper, x - upper])
}

/// Returns `true` if the magnitude of any of the angles exceeds [`SMALL`].
#[inline(always)]
fn far(low: &[f64]) -> bool {
    let mut far = false;
    for low in low {
        far |= SMALL < low.abs();
    }
    far
}

/// Returns sine and cosine of the sum of an angle and a small angle `low`.
#[inline(always)]
fn turned<L: Real>(sin: L, cos: L, low: L, far: impl Fn(L) -> bool) -> (L, L) {
    if far(low) {
        return turned_far(sin, cos, low);
    }
    turned_little(sin, cos, low)
}

/// Returns the same for a `low` whose third power is below the rounding error.
#[inline(always)]
fn turned_little<L: Real>(sin: L, cos: L, low: L) -> (L, L) {
    let half = L::from_f64(0.5) * low;
    (sin + low * (cos - half * sin), cos - low * (sin + half * cos))
}

/// Returns the same if `low` is not small in some lanes: for angles of 1e11 and more.
#[cold]
#[inline(never)]
fn turned_far<L: Real>(sin: L, cos: L, low: L) -> (L, L) {
    let little = turned_little(sin, cos, low);
    let (low_sin, low_cos) = low.sin_cos();
    let large = low.abs() - L::from_f64(SMALL);
    (
        large.where_positive(sin * low_cos + cos * low_sin, little.0),
        large.where_positive(cos * low_cos - sin * low_sin, little.1),
    )
}

/// The greatest magnitude of `low` for the expansion of second order.
const SMALL: f64 = 1e-5;

/// The number of times that are evaluated at once.
const AT_ONCE: usize = 8;

/// A sinusoid at several times.
struct Several<'a, T, const D: usize> {
    sinusoid: &'a Sinusoid<D>,
    times: &'a [Time],
    wanted: Derivatives,
    samples: &'a mut [Sample<T, D>],
}

impl<T: Real, const D: usize> Work for Several<'_, T, D> {
    #[inline(always)]
    fn run(self) {
        let (mut sin, mut cos) = ([[0.0; AT_ONCE]; D], [[0.0; AT_ONCE]; D]);
        // Evaluates as many components together as fit into the lanes.
        let count = self.times.len().max(1);
        let together = (AT_ONCE / count).max(1);
        let mut first = 0;
        while first < D {
            let (mut angles, mut lows) = ([0.0; AT_ONCE], [0.0; AT_ONCE]);
            let components = first..D.min(first + together);
            for (d, (angles, lows)) in
                components.clone().zip(angles.chunks_mut(count).zip(lows.chunks_mut(count)))
            {
                for ((angle, low), &t) in angles.iter_mut().zip(lows).zip(self.times) {
                    let (turns, rest) = self.sinusoid.angle(halves(t.to_f64()), t.low());
                    let (whole, left) = two_sum(turns, self.sinusoid.phase[d]);
                    (*angle, *low) = (whole, left + rest);
                }
            }
            let (sines, cosines) = f64::sin_cos_lanes(&angles);
            let (sines, cosines) = (Octet(sines), Octet(cosines));
            let (Octet(sines), Octet(cosines)) =
                turned(sines, cosines, Octet(lows), |low| far(&low.0));
            for (d, (sines, cosines)) in
                components.zip(sines.chunks(count).zip(cosines.chunks(count)))
            {
                sin[d][..sines.len()].copy_from_slice(sines);
                cos[d][..cosines.len()].copy_from_slice(cosines);
            }
            first += together;
        }
        for (index, sample) in self.samples.iter_mut().enumerate() {
            *sample = self.sinusoid.at(self.wanted, |d| (sin[d][index], cos[d][index]));
        }
    }
}

impl<T: Real, const D: usize> Analytic<T, D> for Sinusoid<D> {
    /// Uses the recurrence k(k−1) x\[k\] = −ω² x\[k−2\].
    fn series(&self, t: Time, _: Side, component: usize, count: usize, position: &mut Series<T>) {
        let (a, w) = (self.amplitude[component], self.frequency);
        let (sin, cos) = self.sin_cos(component, t);
        let (mut even, mut odd) = (a * sin, a * w * cos);
        for (k, coefficient) in position.iter_mut().take(count).enumerate() {
            *coefficient = T::from_f64(even);
            let next = -(w * w * even) / ((k + 1) * (k + 2)) as f64;
            (even, odd) = (odd, next);
        }
        position[0] = T::from_f64(self.offset[component] + a * sin);
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}
