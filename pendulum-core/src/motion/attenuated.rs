//! Motions with a gain and a limit of the speed.

use crate::motion::error::MotionError;
use crate::motion::prescribed::{Motion, earlier};
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A motion with a modified velocity: limited, and multiplied by a gain. The acceleration is
/// modified accordingly.
///
/// ẋ becomes γ ẋ min(1, s/|ẋ|) with the gain γ and the limit s in m/s, and ẍ becomes its
/// derivative. The position is unchanged, both for drawing the joint and in equations that contain
/// it. For example, a limit makes running have the effect of walking, and a gain of 0.1 makes a
/// tenth of a root motion take effect. When the speed reaches the limit, the acceleration jumps: a
/// kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attenuated<M> {
    motion: M,
    gain: f64,
    limit: f64,
}

/// The time in seconds between comparisons of the speed with the limit. A shorter excess is
/// limited, but may be without kinks.
const CELL: f64 = 1.0 / 128.0;

/// The number of cells in one search. The end of each block of cells is a kink, which bounds the
/// search.
const CELLS: i64 = 512;

impl<M> Attenuated<M> {
    /// Creates a motion with a gain and a limit of the speed; infinity means no limit.
    ///
    /// # Errors
    /// If the gain is not finite or the limit is not positive.
    pub fn new(motion: M, gain: f64, limit: f64) -> Result<Self, MotionError> {
        if !gain.is_finite() {
            let required = "finite, 1 for the motion as it is";
            return Err(MotionError::Argument { name: "gain", value: gain, required });
        }
        if limit <= 0.0 || limit.is_nan() {
            let required = "a positive number of metres per second, infinity for none";
            return Err(MotionError::Argument { name: "speed limit", value: limit, required });
        }
        Ok(Self { motion, gain, limit })
    }

    /// Returns `true` if the speed at `t` exceeds the limit.
    fn is_fast<const D: usize>(&self, t: f64) -> bool
    where
        M: Motion<f64, D>,
    {
        let sample = self.motion.sample(Time::new(t), Side::After, Derivatives::VELOCITY);
        self.limit * self.limit < square(&sample.velocity)
    }

    /// Returns the first time after `t` and before `end` at which the speed crosses the limit, or
    /// the end of the block of cells.
    fn crossing<const D: usize>(&self, t: f64, end: f64) -> Option<f64>
    where
        M: Motion<f64, D>,
    {
        // The cells are multiples of absolute time, so the kinks do not depend on `t`.
        let first = (t / CELL).floor() as i64;
        let last = (first.div_euclid(CELLS) + 1) * CELLS;
        for cell in first..last {
            let (mut low, mut high) = (cell as f64 * CELL, (cell + 1) as f64 * CELL);
            if let Some(kink) = self.motion.next_kink(low)
                && kink < high
            {
                // The speed may jump at a kink of the motion: the parts before and after it are
                // separate cells.
                if t < kink {
                    high = kink;
                } else {
                    low = kink;
                }
            }
            if end < high {
                high = end;
            }
            if high <= low {
                return None;
            }
            let fast = self.is_fast(low);
            if fast == self.is_fast(high.next_down()) {
                if end <= high {
                    return None;
                }
                continue;
            }
            for _ in 0..60 {
                let middle = low.midpoint(high);
                if self.is_fast(middle) == fast {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            if t < high {
                return Some(high);
            }
        }
        Some(last as f64 * CELL)
    }
}

fn square<T: Real, const D: usize>(v: &[T; D]) -> T {
    v.iter().fold(T::from_f64(0.0), |sum, &v| sum + v * v)
}

impl<T: Real, const D: usize, M: Motion<T, D> + Motion<f64, D>> Motion<T, D> for Attenuated<M> {
    const HAS: Derivatives = <M as Motion<T, D>>::HAS;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let limited = self.limit < f64::INFINITY;
        let asked = if limited && wanted.contains(Derivatives::ACCELERATION) {
            wanted.union(Derivatives::VELOCITY)
        } else {
            wanted
        };
        let mut sample: Sample<T, D> = self.motion.sample(t, side, asked);
        let gain = T::from_f64(self.gain);
        let fast = limited
            && self.is_fast(if side == Side::Before { t.to_f64().next_down() } else { t.to_f64() });
        if fast {
            let v = sample.velocity;
            let (speed, along) = (
                square(&v).sqrt(),
                (0..D).fold(T::from_f64(0.0), |sum, d| sum + v[d] * sample.acceleration[d]),
            );
            let part = T::from_f64(self.limit) / speed;
            for d in 0..D {
                sample.acceleration[d] =
                    part * (sample.acceleration[d] - along / (speed * speed) * v[d]);
                sample.velocity[d] = part * v[d];
            }
        }
        for d in 0..D {
            sample.velocity[d] *= gain;
            sample.acceleration[d] *= gain;
        }
        if asked != wanted && !wanted.contains(Derivatives::VELOCITY) {
            sample.velocity = [T::from_f64(0.0); D];
        }
        sample
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let own = Motion::<f64, D>::next_kink(&self.motion, t);
        if self.limit == f64::INFINITY || !t.is_finite() {
            return own;
        }
        // Without motion there are no crossings.
        let rest = Motion::<f64, D>::rest_until(&self.motion, t);
        if t < rest && own.is_none_or(|own| rest <= own) {
            return if rest < f64::INFINITY { Some(rest) } else { own };
        }
        earlier(own, self.crossing(t, own.unwrap_or(f64::INFINITY)))
    }

    /// Returns `None` if there is a limit: the crossings before `t` are unknown.
    fn kink_before(&self, t: f64) -> Option<f64> {
        if self.limit == f64::INFINITY {
            Motion::<f64, D>::kink_before(&self.motion, t)
        } else {
            None
        }
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        Motion::<f64, D>::longest_step(&self.motion, t, widths)
    }

    fn rest_until(&self, t: f64) -> f64 {
        Motion::<f64, D>::rest_until(&self.motion, t)
    }
}
