//! Joints: motions of any type.

use crate::error::SceneError;
use crate::handle::SceneId;
use crate::sampling::carried::Carried;
use crate::sampling::clock::at_tick;
use crate::sampling::live::{Course, Path, Steer};
use crate::sampling::turn::Turn;
use crate::system::ORDERS;
use core::any::Any;
use core::fmt;
use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use std::sync::Arc;

/// A handle of a joint that moves in `D` dimensions. Other scenes do not accept the handle, nor
/// does its own after the joint is [removed](crate::Scene::remove_joint).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Joint<const D: usize> {
    scene: SceneId,
    index: u32,
    /// The number of joints that have had this index before.
    generation: u32,
}

/// The joints of a scene, as handles name them.
#[derive(Clone, Copy, Debug)]
pub struct Living<'a> {
    pub(crate) scene: SceneId,
    /// The generation of each joint.
    pub(crate) generations: &'a [u32],
}

impl<const D: usize> Joint<D> {
    pub(crate) const fn new(scene: SceneId, (index, generation): (u32, u32)) -> Self {
        Self { scene, index, generation }
    }

    /// Returns the index of the joint in a scene.
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene or has been removed.
    pub(crate) fn of(self, living: Living<'_>) -> Result<u32, SceneError> {
        let own = self.scene == living.scene;
        if own && living.generations.get(self.index as usize) == Some(&self.generation) {
            Ok(self.index)
        } else {
            Err(SceneError::Joint(self.index))
        }
    }
}

impl<const D: usize> fmt::Debug for Joint<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Joint").field(&self.index).finish()
    }
}

/// The inputs of a system that hangs on an anchor `A`: `()`, a [`Joint`] or a tuple of joints, one
/// for each driven input in the order of declaration.
// A trait of the inputs: one of the anchor would have a single implementation for each, and a wrong
// anchor would be two types that differ, without advice. The types of control inputs, which come
// last and have no joints, are those of driven inputs: `hang` compares the numbers.
#[diagnostic::on_unimplemented(
    message = "a system with the inputs `{Self}` does not hang on `{A}`",
    label = "other joints are needed",
    note = "a system hangs on `()` without driven inputs, on a joint for one, on a tuple of joints for several, each with as many components as its input",
    note = "control inputs have no joints: `Scene::set_inputs` sets them"
)]
pub trait Anchored<A> {
    /// The number of joints.
    #[doc(hidden)]
    const JOINTS: usize;

    /// Returns the indices of the joints in a scene.
    ///
    /// # Errors
    /// Returns an error if a joint belongs to another scene or has been removed.
    #[doc(hidden)]
    fn joints(anchor: A, living: Living<'_>) -> Result<Vec<u32>, SceneError>;
}

impl Anchored<()> for () {
    const JOINTS: usize = 0;

    fn joints((): (), _: Living<'_>) -> Result<Vec<u32>, SceneError> {
        Ok(Vec::new())
    }
}

/// Implements [`Anchored`] for a tuple of samples: joints for the inputs before the semicolon, none
/// for those behind it.
macro_rules! anchored {
    (; $($control:ident)+) => {
        impl<T: Real, $(const $control: usize),+> Anchored<()> for ($(Sample<T, $control>,)+) {
            const JOINTS: usize = 0;

            fn joints((): (), _: Living<'_>) -> Result<Vec<u32>, SceneError> {
                Ok(Vec::new())
            }
        }
    };
    ($dim:ident $index:tt; $($control:ident)*) => {
        impl<T: Real, const $dim: usize, $(const $control: usize),*> Anchored<Joint<$dim>>
            for (Sample<T, $dim>, $(Sample<T, $control>,)*)
        {
            const JOINTS: usize = 1;

            fn joints(anchor: Joint<$dim>, living: Living<'_>) -> Result<Vec<u32>, SceneError> {
                Ok(vec![anchor.of(living)?])
            }
        }

        anchored!(@ $dim $index; $($control)*);
    };
    ($(@)? $($dim:ident $index:tt)+; $($control:ident)*) => {
        impl<T: Real, $(const $dim: usize,)+ $(const $control: usize),*>
            Anchored<($(Joint<$dim>,)+)> for ($(Sample<T, $dim>,)+ $(Sample<T, $control>,)*)
        {
            const JOINTS: usize = [$($index),+].len();

            fn joints(
                anchor: ($(Joint<$dim>,)+),
                living: Living<'_>,
            ) -> Result<Vec<u32>, SceneError> {
                Ok(vec![$((anchor.$index).of(living)?),+])
            }
        }
    };
}

/// Divides the inputs behind the semicolon in all ways into driven inputs and control inputs.
macro_rules! divided {
    ($($dim:ident $index:tt)*;) => {
        anchored!($($dim $index)*;);
    };
    ($($dim:ident $index:tt)*; $next:ident $place:tt $($other:ident $later:tt)*) => {
        anchored!($($dim $index)*; $next $($other)*);
        divided!($($dim $index)* $next $place; $($other $later)*);
    };
}

divided!(; DA 0);
divided!(; DA 0 DB 1);
divided!(; DA 0 DB 1 DC 2);
divided!(; DA 0 DB 1 DC 2 DD 3);
divided!(; DA 0 DB 1 DC 2 DD 3 DE 4);
divided!(; DA 0 DB 1 DC 2 DD 3 DE 4 DF 5);
divided!(; DA 0 DB 1 DC 2 DD 3 DE 4 DF 5 DG 6);
divided!(; DA 0 DB 1 DC 2 DD 3 DE 4 DF 5 DG 6 DH 7);

/// A motion whose type and dimension are erased.
pub(crate) trait Drive<T>: Send + Sync {
    fn has(&self) -> Derivatives;
    fn components(&self) -> usize;
    /// Writes the derivatives in `wanted` (position, velocity, acceleration) in this order.
    fn sample(&self, t: Time, side: Side, wanted: Derivatives, numbers: &mut [T]);
    /// Writes a sample for each time, at intervals of `width` numbers. Consecutive equal times are
    /// sampled once.
    fn sample_all(&self, times: &[Time], wanted: Derivatives, numbers: &mut [T], width: usize);
    /// Returns the first kink after `t`. A kink within rounding after a tick counts as at the tick.
    fn next_kink(&self, t: f64) -> Option<f64>;
    /// Returns the time at which the motion after all kinks that count as up to `t` begins.
    fn felt(&self, t: Time) -> Time;
    fn rest_until(&self, t: f64) -> f64;
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64>;
    /// Returns `Some` if the joint is live.
    fn live(&self) -> Option<&dyn Steer>;
    fn live_mut(&mut self) -> Option<&mut dyn Steer>;
    /// Moves the joint through a tick; `None` unless a pendulum carries it.
    fn follow(&mut self, ends: [f64; 2], states: &[Sample<f64, 4>; 2]) -> Option<Course>;
}

/// The number of times in one call of [`Motion::sample_all`].
const AT_ONCE: usize = 8;

/// Writes the derivatives of a sample that are in `wanted`, in their order.
#[inline]
fn put<T: Real, const D: usize>(sample: &Sample<T, D>, wanted: Derivatives, numbers: &mut [T]) {
    let all = [&sample.position, &sample.velocity, &sample.acceleration];
    let mut rest = numbers;
    for (order, values) in ORDERS.into_iter().zip(all) {
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

impl<T: Real, M: Motion<T, D> + Send + Sync + 'static, const D: usize> Drive<T>
    for ErasedMotion<M, D>
{
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

    fn sample_all(&self, times: &[Time], wanted: Derivatives, numbers: &mut [T], width: usize) {
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
                let here = index * width;
                if again(index) {
                    let before = here - width;
                    numbers.copy_within(before..before + D * wanted.count(), here);
                } else {
                    put(&samples[next], wanted, &mut numbers[here..]);
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

    fn live(&self) -> Option<&dyn Steer> {
        let motion: &dyn Any = &self.motion;
        let path = motion.downcast_ref::<Path<D>>().map(|path| path as &dyn Steer);
        path.or_else(|| motion.downcast_ref::<Turn>().map(|turn| turn as &dyn Steer))
    }

    fn live_mut(&mut self) -> Option<&mut dyn Steer> {
        let motion: &mut dyn Any = &mut self.motion;
        if motion.is::<Turn>() {
            return motion.downcast_mut::<Turn>().map(|turn| turn as &mut dyn Steer);
        }
        motion.downcast_mut::<Path<D>>().map(|path| path as &mut dyn Steer)
    }

    fn follow(&mut self, ends: [f64; 2], states: &[Sample<f64, 4>; 2]) -> Option<Course> {
        let motion: &mut dyn Any = &mut self.motion;
        motion.downcast_mut::<Carried<D>>().map(|carried| carried.follow(ends, states))
    }
}

/// Erases the type and dimension of a motion in a scene of `rate` ticks per second.
pub(crate) fn erase<T: Real, M: Motion<T, D> + Send + Sync + 'static, const D: usize>(
    motion: M,
    rate: f64,
) -> JointSlot<T> {
    // Checked from −∞ on, because a scene may go back in time.
    let still = motion.rest_until(f64::NEG_INFINITY) == f64::INFINITY;
    JointSlot { drive: Arc::new(ErasedMotion { motion, rate, still }), still }
}

/// A joint of a scene.
#[derive(Clone)]
pub(crate) struct JointSlot<T> {
    pub(crate) drive: Arc<dyn Drive<T>>,
    /// `true` if the joint rests for ever, without kinks.
    pub(crate) still: bool,
}

/// Returns the motions of some joints.
pub(crate) fn drives<'a, T>(
    slots: &'a [JointSlot<T>],
    joints: &'a [u32],
) -> impl Iterator<Item = &'a dyn Drive<T>> {
    joints.iter().map(|&joint| &*slots[joint as usize].drive)
}
