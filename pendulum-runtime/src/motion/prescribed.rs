//! The trait of motions.

use crate::motion::analytic::Analytic;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::{Lane, Octet, Real};
use crate::time::Time;

/// A prescribed motion in `D` dimensions over the scalar `T`.
pub trait Motion<T: Real, const D: usize> {
    /// The derivatives that this motion has between its kinks.
    const HAS: Derivatives;

    /// Position, velocity and acceleration at `t`; those that `wanted` leaves out are zero.
    ///
    /// At a kink the value is the limit from `side`; elsewhere `side` does not matter.
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D>;

    /// Samples after a kink at as many times as there are samples, with the bits of single samples:
    /// for motions that can do several at once.
    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, D>]) {
        for (sample, &t) in samples.iter_mut().zip(times) {
            *sample = self.sample(t, Side::After, wanted);
        }
    }

    /// Samples at eight times, a lane each, with the bits of single samples, for
    /// [`Picard`](crate::integrate::Picard).
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, D>
    where
        T: Lane,
    {
        let mut samples = [Sample::zero(); 8];
        self.sample_all(times, wanted, &mut samples);
        let mut lanes = Sample::<Octet<T>, D>::zero();
        for (k, sample) in samples.iter().enumerate() {
            for d in 0..D {
                lanes.position[d].0[k] = sample.position[d];
                lanes.velocity[d].0[k] = sample.velocity[d];
                lanes.acceleration[d].0[k] = sample.acceleration[d];
            }
        }
        lanes
    }

    /// The first time after `t` (never `t` itself) at which the position, the velocity or the
    /// acceleration jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The last time before `t` (never `t` itself) at which the position, the velocity or the
    /// acceleration jumps; −∞ if there is none, and `None` if that is not known: integrations do
    /// not go back in time then.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// The longest step from `t` that cannot go unseen over anything that the motion does, in
    /// seconds, where a step may be `widths` times as long as the narrowest of it; infinite if
    /// nothing is too narrow for any step, and `None` if that is not known.
    ///
    /// Steps end at kinks, so that only what lies between two of them counts. Where nothing is
    /// known, a step is at most a fiftieth of the interval of [`solve`](crate::integrate::solve),
    /// or one second in an [`Integrator`](crate::integrate::Integrator). What lies farther off may
    /// be approached: for something as wide as w the answer is the longer of `widths`·w and half
    /// the distance to its middle, which is always positive; an answer of 0 is an error.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let _ = (t, widths);
        None
    }

    /// The motion as one that knows all its derivatives: `Some(self)` where it is [`Analytic`].
    ///
    /// [`Auto`](crate::integrate::Auto) and [`Ensemble`](crate::ensemble::Ensemble) ask for it:
    /// they do without series where there is none.
    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        None
    }

    /// A time up to which the point rests from `t` on: `t` itself if that is not known, infinity if
    /// it rests for ever.
    ///
    /// Scenes let pendulums sleep until then, so a time that is too late is wrong and one that is
    /// too early only costs time.
    fn rest_until(&self, t: f64) -> f64 {
        t
    }
}

/// The earlier of two kinks.
pub(crate) fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        (a, None) => a,
        (None, b) => b,
    }
}
