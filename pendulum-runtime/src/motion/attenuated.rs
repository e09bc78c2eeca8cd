//! A motion of which only a part is felt.

use crate::motion::error::MotionError;
use crate::motion::prescribed::{Motion, earlier};
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A motion as pendulums on it shall feel it: its velocity cut to a limit and multiplied by a gain,
/// its acceleration accordingly.
///
/// ẋ becomes γ ẋ min(1, s/|ẋ|) with the gain γ and the limit s in m/s; ẍ is the derivative of that.
/// The position stays: the joint is drawn where it is, and equations that contain it see it there.
/// Running feels like walking with a limit, and a root motion of which a tenth is felt has a gain
/// of 0.1. Where the speed reaches the limit the acceleration jumps: a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attenuated<M> {
    motion: M,
    gain: f64,
    limit: f64,
}

/// The speed is compared with the limit at multiples of this time, in seconds; an excess that is
/// shorter is met without a kink.
const CELL: f64 = 1.0 / 128.0;

/// The cells that are searched at once; their ends are kinks, so that nobody searches farther.
const CELLS: i64 = 512;

impl<M> Attenuated<M> {
    /// The motion with so much of it felt; a limit of infinity is none.
    ///
    /// # Errors
    /// A gain that is not finite, a limit that is not positive.
    pub fn new(motion: M, gain: f64, limit: f64) -> Result<Self, MotionError> {
        if !gain.is_finite() {
            return Err(MotionError::Gain(gain));
        }
        if limit <= 0.0 || limit.is_nan() {
            return Err(MotionError::SpeedLimit(limit));
        }
        Ok(Self { motion, gain, limit })
    }

    /// Returns true if the speed after `t` is beyond the limit.
    fn is_fast<const D: usize>(&self, t: f64) -> bool
    where
        M: Motion<f64, D>,
    {
        let sample = self.motion.sample(Time::new(t), Side::After, Derivatives::VELOCITY);
        self.limit * self.limit < square(&sample.velocity)
    }

    /// The first time after `t` and before `end` at which the speed passes the limit.
    fn crossing<const D: usize>(&self, t: f64, end: f64) -> Option<f64>
    where
        M: Motion<f64, D>,
    {
        // The cells are those of absolute time, so that it does not matter when somebody asks.
        let first = (t / CELL).floor() as i64;
        let last = (first.div_euclid(CELLS) + 1) * CELLS;
        for cell in first..last {
            let (mut low, mut high) = (cell as f64 * CELL, (cell + 1) as f64 * CELL);
            if let Some(kink) = self.motion.next_kink(low)
                && kink < high
            {
                // Between kinks of the motion itself the speed may jump: the later part is another
                // cell.
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
        // While it rests nothing changes.
        let rest = Motion::<f64, D>::rest_until(&self.motion, t);
        if t < rest && own.is_none_or(|own| rest <= own) {
            return if rest < f64::INFINITY { Some(rest) } else { own };
        }
        earlier(own, self.crossing(t, own.unwrap_or(f64::INFINITY)))
    }

    /// Unknown where the speed passes the limit.
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
