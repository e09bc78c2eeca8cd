//! Joints: motions of any type. Each joint is sampled once per time for all pendulums on it.

use crate::motion::{Derivatives, Motion, Sample, Side};
use crate::scalar::Real;
use crate::scene::error::SceneError;
use crate::scene::handle::SceneId;
use crate::scene::sampling::clock::{Clock, at_tick};
use crate::sealed::Sealed;
use crate::time::Time;
use core::fmt;
use std::sync::Arc;

/// A handle of a joint that moves in `D` dimensions. Other scenes do not accept the handle.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Joint<const D: usize> {
    scene: SceneId,
    index: u32,
}

impl<const D: usize> Joint<D> {
    pub(crate) const fn new(scene: SceneId, index: u32) -> Self {
        Self { scene, index }
    }

    /// Returns the index of the joint in `scene`.
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene.
    pub(crate) fn of(self, scene: SceneId) -> Result<u32, SceneError> {
        if self.scene == scene { Ok(self.index) } else { Err(SceneError::Joint(self.index)) }
    }
}

impl<const D: usize> Sealed for Joint<D> {}

impl<const D: usize> fmt::Debug for Joint<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Joint").field(&self.index).finish()
    }
}

/// The joints on which a system hangs: `()`, a [`Joint`] or a tuple of joints, one for each driven
/// input in the order of declaration.
pub trait Anchor<Inputs>: Sealed {
    /// Returns the indices of the joints in a scene.
    ///
    /// # Errors
    /// Returns an error if a joint belongs to another scene.
    #[doc(hidden)]
    fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError>;
}

impl Anchor<()> for () {
    fn joints(&self, _: SceneId) -> Result<Vec<u32>, SceneError> {
        Ok(Vec::new())
    }
}

impl<T: Real, const D: usize> Anchor<(Sample<T, D>,)> for Joint<D> {
    fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError> {
        Ok(vec![self.of(scene)?])
    }
}

macro_rules! tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> Anchor<($(Sample<T, $dim>,)+)> for ($(Joint<$dim>,)+) {
            fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError> {
                Ok(vec![$((self.$index).of(scene)?),+])
            }
        }
    )+};
}

for_tuples_of_motions!(tuples);

/// A motion whose type and dimension are erased.
pub(crate) trait Drive<T>: Send + Sync {
    fn has(&self) -> Derivatives;
    fn components(&self) -> usize;
    /// Writes the derivatives in `wanted` (position, velocity, acceleration) in this order.
    fn sample(&self, t: Time, side: Side, wanted: Derivatives, numbers: &mut [T]);
    /// Writes a record of samples for each time. Consecutive equal times are sampled once.
    fn sample_all(&self, times: &[Time], wanted: Derivatives, numbers: &mut [T]);
    /// Returns the first kink after `t`. A kink within rounding after a tick counts as at the tick.
    fn next_kink(&self, t: f64) -> Option<f64>;
    /// Returns the time at which the motion after all kinks that count as up to `t` begins.
    fn felt(&self, t: Time) -> Time;
    fn rest_until(&self, t: f64) -> f64;
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64>;
}

/// The number of times in one call of [`Motion::sample_all`].
const AT_ONCE: usize = 8;

/// Writes the derivatives of a sample that are in `wanted`, in their order.
#[inline]
fn put<T: Real, const D: usize>(sample: &Sample<T, D>, wanted: Derivatives, numbers: &mut [T]) {
    let all = [
        (Derivatives::POSITION, &sample.position),
        (Derivatives::VELOCITY, &sample.velocity),
        (Derivatives::ACCELERATION, &sample.acceleration),
    ];
    let mut rest = numbers;
    for (order, values) in all {
        if wanted.contains(order) {
            let (here, after) = rest.split_at_mut(D);
            here.copy_from_slice(values);
            rest = after;
        }
    }
}

struct ErasedMotion<M, const D: usize> {
    motion: M,
    /// The number of ticks per second.
    rate: f64,
    /// `true` if the motion rests for ever, without kinks.
    still: bool,
}

impl<T: Real, M: Motion<T, D> + Send + Sync, const D: usize> Drive<T> for ErasedMotion<M, D> {
    fn has(&self) -> Derivatives {
        M::HAS
    }

    fn components(&self) -> usize {
        D
    }

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives, numbers: &mut [T]) {
        let t = if side == Side::After { self.felt(t) } else { t };
        put(&self.motion.sample(t, side, wanted), wanted, numbers);
    }

    fn sample_all(&self, times: &[Time], wanted: Derivatives, numbers: &mut [T]) {
        let width = D * wanted.count();
        if width == 0 {
            return;
        }
        let again = |index: usize| 0 < index && times[index - 1] == times[index];
        let (mut distinct, mut samples) = ([Time::new(0.0); AT_ONCE], [Sample::zero(); AT_ONCE]);
        let mut begin = 0;
        while begin < times.len() {
            let (mut end, mut count) = (begin, 0);
            while end < times.len() && (count < AT_ONCE || again(end)) {
                if !again(end) {
                    distinct[count] = times[end];
                    count += 1;
                }
                end += 1;
            }
            // Without kinks both sides are equal up to rounding. The same side is always used, so
            // that the bits do not depend on the division into batches.
            self.motion.sample_all(&distinct[..count], wanted, &mut samples[..count]);
            let mut next = 0;
            for index in begin..end {
                let (before, here) = numbers.split_at_mut(index * width);
                if again(index) {
                    here[..width].copy_from_slice(&before[(index - 1) * width..]);
                } else {
                    put(&samples[next], wanted, &mut here[..width]);
                    next += 1;
                }
            }
            begin = end;
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let mut from = t;
        loop {
            let kink = self.motion.next_kink(from)?;
            let counted = at_tick(kink, self.rate);
            if t < counted || kink <= from {
                return Some(counted);
            }
            from = kink;
        }
    }

    fn felt(&self, t: Time) -> Time {
        let mut felt = t;
        while !self.still
            && let Some(kink) = self.motion.next_kink(felt.to_f64())
            && felt.to_f64() < kink
            && at_tick(kink, self.rate) <= t.to_f64()
        {
            felt = Time::new(kink);
        }
        felt
    }

    fn rest_until(&self, t: f64) -> f64 {
        let until = at_tick(self.motion.rest_until(t), self.rate);
        if until < t { t } else { until }
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        self.motion.longest_step(t, widths)
    }
}

/// Erases the type and dimension of a motion in a scene of `rate` ticks per second.
pub(crate) fn erase<T: Real, M: Motion<T, D> + Send + Sync + 'static, const D: usize>(
    motion: M,
    rate: f64,
) -> Arc<dyn Drive<T>> {
    // Checked from −∞ on, because a scene may go back in time.
    let still = motion.rest_until(f64::NEG_INFINITY) == f64::INFINITY;
    Arc::new(ErasedMotion { motion, rate, still })
}

/// A joint of a scene: its motion, and the requirements of the pendulums on it.
#[derive(Clone)]
pub(crate) struct JointSlot<T> {
    pub(crate) drive: Arc<dyn Drive<T>>,
    /// `true` if the joint rests for ever and is not sampled in batches.
    pub(crate) still: bool,
    /// The derivatives that awake pendulums on the joint need.
    pub(crate) wanted: Derivatives,
    /// The grids of awake pendulums on the joint, by bit.
    pub(crate) grids: u64,
    /// The index of the joint among the sampled joints.
    pub(crate) active: u32,
}

/// A sampled joint: awake pendulums depend on it.
#[derive(Debug)]
pub(crate) struct Active {
    pub(crate) joint: u32,
    /// The class of the timetable for the grids of the joint.
    pub(crate) class: u32,
    /// The derivatives that awake pendulums on the joint need.
    pub(crate) wanted: Derivatives,
    pub(crate) components: usize,
    /// The next kink at the last search; NaN before the first search.
    kink: f64,
    /// The time of that search if a kink shortly afterwards counted as at this time, otherwise NaN.
    late: f64,
    /// The index at which the samples of the joint begin.
    pub(crate) offset: usize,
    /// The ticks of the batch with a kink in them or at their ends, by bit.
    pub(crate) kinked: u32,
}

impl<T> fmt::Debug for JointSlot<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("JointSlot")
            .field("still", &self.still)
            .field("wanted", &self.wanted)
            .finish_non_exhaustive()
    }
}

impl<T: Real> JointSlot<T> {
    pub(crate) fn new(drive: Arc<dyn Drive<T>>) -> Self {
        let still = drive.rest_until(f64::NEG_INFINITY) == f64::INFINITY;
        Self { drive, still, wanted: Derivatives::NONE, grids: 0, active: 0 }
    }
}

impl Active {
    pub(crate) fn new<T: Real>(joint: u32, joint_slot: &JointSlot<T>, class: u32) -> Self {
        let components = joint_slot.drive.components();
        Self {
            joint,
            class,
            wanted: joint_slot.wanted,
            components,
            kink: f64::NAN,
            late: f64::NAN,
            offset: 0,
            kinked: 0,
        }
    }

    /// Returns the number of values in a sample.
    pub(crate) fn width(&self) -> usize {
        self.components * self.wanted.count()
    }

    /// Samples the ticks from `tick` on at `times`. Ticks with a kink in them or at their ends are
    /// omitted.
    pub(crate) fn sample<T: Real>(
        &mut self,
        drive: &dyn Drive<T>,
        clock: &Clock,
        tick: i64,
        ticks: usize,
        times: &[Time],
        numbers: &mut [T],
    ) {
        self.kinked = 0;
        if !self.kink_within(drive, clock.time(tick), clock.time(tick + ticks as i64)) {
            return drive.sample_all(times, self.wanted, numbers);
        }
        let (per_tick, width) = (times.len() / ticks, self.width());
        for index in 0..ticks {
            let now = tick + index as i64;
            if self.kink_within(drive, clock.time(now), clock.time(now + 1)) {
                self.kinked |= 1 << index;
            } else {
                let numbers = &mut numbers[index * per_tick * width..][..per_tick * width];
                drive.sample_all(&times[index * per_tick..][..per_tick], self.wanted, numbers);
            }
        }
    }

    /// Returns `true` if there is a kink in (`start`, `end`], or shortly after `start` one that
    /// counts as at `start`.
    fn kink_within<T>(&mut self, drive: &dyn Drive<T>, start: f64, end: f64) -> bool {
        // `false` for the initial NaN.
        let ahead = start < self.kink;
        if !ahead {
            self.kink = match drive.next_kink(start) {
                // If the next kink is not after `start`, there are no further kinks.
                Some(kink) if start < kink => kink,
                _ => f64::INFINITY,
            };
            let felt = drive.felt(Time::new(start)).to_f64();
            self.late = if start < felt { start } else { f64::NAN };
        }
        self.kink <= end || self.late == start
    }
}

/// Returns `true` if all joints rest for ever.
pub(crate) fn still<T>(joint_slots: &[JointSlot<T>], joints: &[u32]) -> bool {
    joints.iter().all(|&joint| joint_slots[joint as usize].still)
}
