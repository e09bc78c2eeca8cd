//! Joints: motions of any type, each sampled once per time for all that hangs on it.

use super::clock::Clock;
use crate::motion::{Motion, Orders, Side};
use crate::real::Real;
use crate::time::Time;
use core::fmt;
use std::sync::Arc;

/// A joint of a scene that moves in `D` dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Joint<const D: usize>(pub(super) u32);

/// A motion whose type and dimension are forgotten.
pub(super) trait Drive<T>: Send + Sync {
    fn has(&self) -> Orders;
    fn components(&self) -> usize;
    /// Writes those of position, velocity and acceleration that are in `orders`, one after the other.
    fn sample(&self, t: Time, side: Side, orders: Orders, numbers: &mut [T]);
    fn next_kink(&self, t: f64) -> Option<f64>;
    fn rest_until(&self, t: f64) -> f64;
}

struct Forgotten<M, const D: usize>(M);

impl<T: Real, M: Motion<T, D> + Send + Sync, const D: usize> Drive<T> for Forgotten<M, D> {
    fn has(&self) -> Orders {
        M::HAS
    }

    fn components(&self) -> usize {
        D
    }

    #[inline]
    fn sample(&self, t: Time, side: Side, orders: Orders, numbers: &mut [T]) {
        let sample = self.0.sample(t, side, orders);
        let all = [
            (Orders::POSITION, sample.position),
            (Orders::VELOCITY, sample.velocity),
            (Orders::ACCELERATION, sample.acceleration),
        ];
        let mut rest = numbers;
        for (order, values) in all {
            if orders.contains(order) {
                let (here, after) = rest.split_at_mut(D);
                here.copy_from_slice(&values);
                rest = after;
            }
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.0.next_kink(t)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.0.rest_until(t)
    }
}

/// `motion` as a drive.
pub(super) fn forget<T: Real, M: Motion<T, D> + Send + Sync + 'static, const D: usize>(motion: M) -> Arc<dyn Drive<T>> {
    Arc::new(Forgotten(motion))
}

/// A joint, and what was last sampled of it.
#[derive(Clone)]
pub(super) struct Place<T> {
    pub(super) drive: Arc<dyn Drive<T>>,
    /// Whether it rests for ever, so that it is never sampled.
    pub(super) still: bool,
    /// What those that are awake on it need.
    pub(super) orders: Orders,
    /// By bit, the grids on which it is needed.
    pub(super) grids: u64,
    /// The class of the timetable for these grids.
    pub(super) class: u32,
    /// The first kink after the time last looked at; NaN before anybody has looked.
    kink: f64,
    /// Where its samples begin.
    pub(super) offset: usize,
    /// Whether each tick of the batch, from its first, has a kink in it or at its end.
    pub(super) kinked: u32,
}

impl<T> fmt::Debug for Place<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Place").field("still", &self.still).field("orders", &self.orders).finish_non_exhaustive()
    }
}

impl<T: Real> Place<T> {
    pub(super) fn new(drive: Arc<dyn Drive<T>>, now: f64) -> Self {
        let still = drive.rest_until(now) == f64::INFINITY;
        Self { drive, still, orders: Orders::NONE, grids: 0, class: 0, kink: f64::NAN, offset: 0, kinked: 0 }
    }

    /// The numbers in a sample.
    pub(super) fn width(&self) -> usize {
        self.drive.components() * self.orders.count()
    }

    /// Looks again for kinks, after a jump in time.
    pub(super) fn forget_kink(&mut self) {
        self.kink = f64::NAN;
    }

    /// Samples the ticks from `tick` at `fractions`; ticks with a kink are left out.
    pub(super) fn sample(&mut self, clock: &Clock, tick: i64, ticks: usize, fractions: &[f64], numbers: &mut [T]) {
        let width = self.width();
        self.kinked = 0;
        // A motion without kinks in sight is asked at every time but once: the end of a tick is the start of the next.
        let shared = fractions.first() == Some(&0.0) && fractions.last() == Some(&1.0);
        for index in 0..ticks {
            let now = tick + index as i64;
            let (start, end) = (clock.time(now), clock.time(now + 1));
            // Also where nobody has looked yet.
            let ahead = start < self.kink;
            if !ahead {
                self.kink = match self.drive.next_kink(start) {
                    // A motion that has not passed what it says is next has no more to say.
                    Some(kink) if start < kink => kink,
                    _ => f64::INFINITY,
                };
            }
            if self.kink <= end {
                self.kinked |= 1 << index;
                continue;
            }
            let length = fractions.len() * width;
            let (before, here) = numbers.split_at_mut(index * length);
            for (node, (&fraction, sample)) in fractions.iter().zip(here.chunks_exact_mut(width.max(1))).enumerate() {
                if node == 0 && shared && 0 < index && self.kinked & (1 << (index - 1)) == 0 {
                    sample.copy_from_slice(&before[before.len() - width..]);
                    continue;
                }
                // Without a kink the side is all one, but only one side gives the same bits however ticks are cut into batches.
                self.drive.sample(clock.within(now, fraction), Side::After, self.orders, sample);
            }
        }
    }
}
