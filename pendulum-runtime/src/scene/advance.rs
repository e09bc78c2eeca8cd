//! Ticks: each batch samples the joints, then advances all blocks.

use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::sleep::LOOK;
use crate::scene::lanes::bucket::Failed;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::{Active, JointSlot};
use crate::scene::sampling::timetable::Timetable;
use crate::scene::sampling::tracks::{BATCH, Sampled};
use crate::scene::scene::Scene;
use crate::scene::threads::{part, share};
use core::sync::atomic::{AtomicBool, Ordering};

/// The result of [`Scene::advance`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Advanced {
    /// The number of ticks computed.
    pub ticks: u64,
    /// The part of the frame beyond the longest frame, in seconds. This time is skipped.
    pub dropped: f64,
    /// The number of pendulums that have failed.
    pub failed: usize,
}

impl<T: Lane + Float> Scene<T> {
    /// Advances the scene by a frame of `dt` seconds: computes all ticks that are due and keeps the
    /// remaining time for the next frame.
    ///
    /// States at equal times have the same bits for every division of time into frames. A frame of
    /// zero length has no effect. A frame longer than the [longest frame](Self::set_longest_frame)
    /// is shortened.
    ///
    /// # Errors
    /// Returns an error if `dt` is negative, infinite or NaN.
    pub fn advance(&mut self, dt: f64) -> Result<Advanced, SceneError> {
        if self.paused && (0.0..f64::INFINITY).contains(&dt) {
            return Ok(Advanced::default());
        }
        let (ticks, dropped) = self.clock.ask(dt, self.longest_frame)?;
        let failed = self.faults.len();
        self.ticks(ticks);
        Ok(Advanced { ticks, dropped, failed: self.faults.len() - failed })
    }

    /// Computes `ticks` ticks, independently of frames.
    pub fn advance_ticks(&mut self, ticks: u32) -> Advanced {
        self.whole_ticks(u64::from(ticks))
    }

    pub(crate) fn whole_ticks(&mut self, ticks: u64) -> Advanced {
        let failed = self.faults.len();
        self.clock.shift(ticks as i64);
        self.ticks(ticks);
        Advanced { ticks, dropped: 0.0, failed: self.faults.len() - failed }
    }

    pub(crate) fn ticks(&mut self, mut ticks: u64) {
        while 0 < ticks {
            let batch = ticks.min(self.update_sleep()).min(BATCH as u64);
            self.batch(batch as usize);
            self.clock.passed(batch);
            ticks -= batch;
        }
    }

    /// Wakes the pendulums whose joints are about to move, and lets others fall asleep. Returns the
    /// number of ticks until the next call is due.
    fn update_sleep(&mut self) -> u64 {
        let tick = self.clock.tick();
        let Self { clock, joint_slots, groups, sleep, dirty, .. } = self;
        let mut next = i64::MAX;
        for (_, group) in groups.iter_mut() {
            *dirty |= group.wake_due(tick);
            if let Some(tolerance) = *sleep {
                if tick.rem_euclid(LOOK) == 0 {
                    *dirty |= group.fall_asleep(clock, joint_slots, tolerance);
                }
                next = next.min(LOOK - tick.rem_euclid(LOOK));
            }
            next = next.min(group.next_alarm().saturating_sub(tick));
        }
        next.max(1) as u64
    }
    /// Computes a batch of `ticks` ticks, at most [`BATCH`].
    fn batch(&mut self, ticks: usize) {
        if self.dirty {
            self.assign();
        }
        let mut threads = self.threads;
        let work = if self.parallel { self.awake().0 * ticks } else { 0 };
        threads.measured(work, |fork| self.computed(ticks, fork));
        self.threads = threads;
    }

    /// Computes a batch, on all threads if `fork` is `true` and the batch is large enough.
    fn computed(&mut self, ticks: usize, fork: bool) {
        let tick = self.clock.tick();
        let kinks = self.sample(tick, ticks, fork);
        let Self { clock, joint_slots, actives, numbers, timetable, groups, faults, .. } = self;
        let mut all: Vec<(u8, usize, u32)> = Vec::new();
        let mut failed: Vec<Failed> = Vec::new();
        for (index, (_, group)) in groups.iter_mut().enumerate() {
            group.settle(clock);
            let sampled =
                Sampled { clock, tick, ticks, joint_slots, actives, numbers, timetable, kinks };
            group.run(&sampled, fork, &mut failed);
            all.extend(failed.drain(..).map(|(id, at)| (at, index, id)));
        }
        self.dirty |= !all.is_empty();
        // Sorts by time, so that the order does not depend on the batches.
        all.sort_unstable();
        for (at, index, id) in all {
            faults.push(groups[index].1.fail(clock, joint_slots, id, tick + i64::from(at)));
        }
    }

    /// Assigns to every joint the derivatives and grids that awake pendulums need, and collects the
    /// joints that are sampled.
    pub(crate) fn assign(&mut self) {
        self.dirty = false;
        let Self { joint_slots, actives, groups, timetable, .. } = self;
        for joint_slot in joint_slots.iter_mut() {
            (joint_slot.wanted, joint_slot.grids) = (crate::motion::Derivatives::NONE, 0);
        }
        for (_, group) in groups.iter() {
            // The bit of the grid is looked up once per bucket instead of once per joint.
            let mut known = None;
            group.needs(&mut |joint, wanted, grid| {
                let bit = match known {
                    Some((last, bit)) if last == grid => bit,
                    _ => timetable.bit(grid),
                };
                known = Some((grid, bit));
                let joint_slot = &mut joint_slots[joint as usize];
                joint_slot.wanted = joint_slot.wanted.union(wanted);
                joint_slot.grids |= bit;
            });
        }
        actives.clear();
        let mut last = None;
        for (joint, joint_slot) in (0..)
            .zip(joint_slots.iter_mut())
            .filter(|(_, joint_slot)| joint_slot.grids != 0 && !joint_slot.still)
        {
            let class = match last {
                Some((grids, class)) if grids == joint_slot.grids => class,
                _ => timetable.class(joint_slot.grids),
            };
            last = Some((joint_slot.grids, class));
            joint_slot.active = actives.len() as u32;
            actives.push(Active::new(joint, joint_slot, class));
        }
    }

    /// Samples all joints that awake pendulums need; returns `true` if there are kinks.
    fn sample(&mut self, tick: i64, ticks: usize, fork: bool) -> bool {
        let Self { clock, joint_slots, actives, numbers, timetable, .. } = self;
        timetable.begin(clock, tick, ticks);
        let mut length = 0;
        let kinks = AtomicBool::new(false);
        let shared = Times { clock, timetable, tick, count: ticks, kinks: &kinks };
        for active in actives.iter_mut() {
            active.offset = length;
            length += shared.length(active);
        }
        numbers.resize(length, T::from_f64(0.0));
        shared.sample_all(joint_slots, actives, numbers, fork);
        kinks.into_inner()
    }
}

/// The values shared by all samplers.
#[derive(Clone, Copy)]
struct Times<'a> {
    clock: &'a Clock,
    timetable: &'a Timetable,
    tick: i64,
    count: usize,
    /// `true` if a sampler has found a kink.
    kinks: &'a AtomicBool,
}

impl Times<'_> {
    /// Returns the number of values of a joint in a batch.
    fn length(&self, active: &Active) -> usize {
        self.timetable.times(active.class).len() * active.width()
    }

    /// Samples joints into `numbers`, whose first value belongs to the first joint.
    fn sample<T: Lane + Float>(
        &self,
        joint_slots: &[JointSlot<T>],
        actives: &mut [Active],
        numbers: &mut [T],
    ) {
        let (mut begin, mut kinked) = (0, 0);
        for active in actives {
            let (length, times) = (self.length(active), self.timetable.times(active.class));
            let drive = &*joint_slots[active.joint as usize].drive;
            active.sample(
                drive,
                self.clock,
                self.tick,
                self.count,
                times,
                &mut numbers[begin..begin + length],
            );
            begin += length;
            kinked |= active.kinked;
        }
        if kinked != 0 {
            self.kinks.store(true, Ordering::Relaxed);
        }
    }

    /// Samples joints, on all threads if there are many.
    fn sample_all<T: Lane + Float>(
        &self,
        joint_slots: &[JointSlot<T>],
        actives: &mut [Active],
        numbers: &mut [T],
        fork: bool,
    ) {
        let (part, mut rest) = (part(actives.len(), 256, fork), numbers);
        let parts = actives.chunks_mut(part).map(|actives| {
            let size = actives.iter().map(|active| self.length(active)).sum();
            (actives, rest.split_off_mut(..size).unwrap_or_default())
        });
        share(parts, |(actives, numbers)| self.sample(joint_slots, actives, numbers));
    }
}
