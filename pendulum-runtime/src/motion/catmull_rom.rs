//! Catmull–Rom curves.

use crate::motion::analytic::Analytic;
use crate::motion::error::MotionError;
use crate::motion::piecewise::{Piecewise, analytic_pieces, checked};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A Catmull–Rom curve through keys: the velocity is continuous, the acceleration jumps at every
/// key.
///
/// The velocity at a key is that of the parabola through the key and its neighbours; at the ends,
/// that of the nearest parabola (Catmull and Rom 1974, for keys at unequal times). The point rests
/// before the first key and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct CatmullRom<const D: usize>(Piecewise<D>);

impl<const D: usize> CatmullRom<D> {
    /// Creates a curve through `values` at `times`, in metres and seconds.
    ///
    /// # Errors
    /// If there are no keys, if the lengths differ, if the times do not increase, or if a number is
    /// not finite.
    pub fn new(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        let count = times.len();
        let chord = |key: usize, d: usize| {
            (values[key + 1][d] - values[key][d]) / (times[key + 1] - times[key])
        };
        let mut velocities = vec![[0.0; D]; count];
        for (key, velocity) in velocities.iter_mut().enumerate() {
            for d in 0..D {
                velocity[d] = match count {
                    1 => 0.0,
                    2 => chord(0, d),
                    _ => {
                        let middle = key.clamp(1, count - 2);
                        let (before, after) =
                            (times[middle] - times[middle - 1], times[middle + 1] - times[middle]);
                        let (left, right) = (chord(middle - 1, d), chord(middle, d));
                        let curvature = (right - left) / (before + after);
                        left + curvature
                            * (times[key] - times[middle - 1] + (times[key] - times[middle]))
                    }
                };
            }
        }
        let slopes: Vec<_> = velocities.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        Ok(Self(Piecewise::hermite(times, values, &slopes).with_kinks(true)))
    }

    /// Repeats the motion periodically. The last key closes the loop; the velocity may jump there.
    ///
    /// # Errors
    /// If there are fewer than two keys.
    pub fn looped(self) -> Result<Self, MotionError> {
        Ok(Self(self.0.looped()?))
    }

    /// Returns the cubic pieces of the curve.
    pub(super) fn pieces(&self) -> &Piecewise<D> {
        &self.0
    }
}

impl<T: Real, const D: usize> Motion<T, D> for CatmullRom<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        self.0.sample(t, side, wanted)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.0.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        Some(self.0.last_kink(t).unwrap_or(f64::NEG_INFINITY))
    }

    // No bound: steps end at every key at which the acceleration jumps.
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

analytic_pieces!(CatmullRom);
