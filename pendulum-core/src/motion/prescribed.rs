//! The trait of motions.

use crate::motion::analytic::Analytic;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::{Float, Octet, Real};
use crate::time::Time;

/// A prescribed motion in `D` dimensions over the scalar `T`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no motion with the number of components {D}",
    label = "no motion with the number of components {D}",
    note = "a closure becomes a motion by `Function::new(|t| [x, y])`, with `.velocity(…)` and `.acceleration(…)` as far as the equations need them; a number by `Still::new([x, y])`",
    note = "the motion of a scalar has one component, as in `Function::new(|t| [x])`, `Sinusoid::new([0.1], 2.0, [0.0])` and `Curve::spline(&times, &[[0.0], [1.0]])`"
)]
pub trait Motion<T: Real, const D: usize> {
    /// The derivatives that this motion has between its kinks.
    const HAS: Derivatives;

    /// Returns position, velocity and acceleration at `t`; derivatives outside of `wanted` are
    /// zero.
    ///
    /// At a kink the values are the limits from `side`; elsewhere `side` has no effect.
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D>;

    /// Samples the motion at several times, with the values after a kink. The results are bitwise
    /// equal to those of [`sample`](Self::sample). Override this method if several samples at once
    /// are faster.
    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, D>]) {
        for (sample, &t) in samples.iter_mut().zip(times) {
            *sample = self.sample(t, Side::After, wanted);
        }
    }

    /// Samples the motion at eight times, one per lane, for [`Picard`](crate::integrate::Picard).
    /// The results are bitwise equal to those of [`sample`](Self::sample).
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, D>
    where
        T: Float,
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

    /// Returns the first time after `t` (never `t` itself) at which the position, the velocity or
    /// the acceleration jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// Returns the last time before `t` (never `t` itself) at which the position, the velocity or
    /// the acceleration jumps: −∞ if there is none, `None` if it is unknown. If it is unknown,
    /// integrations cannot go backwards in time.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the longest step from `t`, in seconds, that cannot miss a feature of the motion. A
    /// step may be `widths` times as long as the narrowest feature. The result is infinite if there
    /// are no features too narrow for a step, and `None` if they are unknown.
    ///
    /// Steps end at kinks, so features extend at most from kink to kink. If the result is `None`,
    /// steps are at most a fiftieth of the interval of [`solve`](crate::integrate::solve), or one
    /// second in an [`Integrator`](crate::integrate::Integrator). Distant features allow longer
    /// steps: for a feature of width w the bound is the longer of `widths`·w and half the distance
    /// to its middle. The bound is always positive; a result of 0 is an error.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let _ = (t, widths);
        None
    }

    /// Returns `Some(self)` if the motion is [`Analytic`].
    ///
    /// [`Auto`](crate::integrate::Auto) and ensembles call this method, and do not use Taylor
    /// series if it returns `None`.
    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        None
    }

    /// Returns a time until which the point rests from `t` on: `t` itself if it is unknown,
    /// infinity if the point rests forever.
    ///
    /// Pendulums of a scene sleep until then. A time that is too late causes wrong results; a time
    /// that is too early only costs computing time.
    fn rest_until(&self, t: f64) -> f64 {
        t
    }
}

/// Returns the earlier of two times.
pub(crate) fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        (a, None) => a,
        (None, b) => b,
    }
}
