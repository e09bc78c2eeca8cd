//! Straight lines between keys.

use crate::motion::analytic::Analytic;
use crate::motion::error::MotionError;
use crate::motion::piecewise::{Piecewise, analytic_pieces, checked};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// Straight lines between keys: the velocity jumps at every key, and the acceleration is zero
/// between keys.
///
/// Accelerations alone would miss such a motion. The integrators end steps at the keys and preserve
/// the momenta across each jump. The point rests before the first key and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear<const D: usize>(Piecewise<D>);

impl<const D: usize> Linear<D> {
    /// Creates lines through `values` at `times`, in metres and seconds.
    ///
    /// # Errors
    /// If there are no keys, if the lengths differ, if the times do not increase, or if a number is
    /// not finite.
    pub fn new(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        Ok(Self(Piecewise::lines(times, values)))
    }

    /// Repeats the motion periodically. The last key closes the loop.
    ///
    /// # Errors
    /// If there are fewer than two keys.
    pub fn looped(self) -> Result<Self, MotionError> {
        Ok(Self(self.0.looped()?))
    }

    /// Returns the pieces of the line.
    pub(super) fn pieces(&self) -> &Piecewise<D> {
        &self.0
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Linear<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        if wanted == Derivatives::ACCELERATION {
            // Zero on every line, so the piece need not be found.
            return Sample::zero();
        }
        self.0.sample(t, side, wanted)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.0.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        Some(self.0.last_kink(t).unwrap_or(f64::NEG_INFINITY))
    }

    // No bound: steps end at all keys.
    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.0.rest_until(t)
    }
}

analytic_pieces!(Linear);
