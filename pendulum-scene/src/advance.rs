//! Frames, ticks and batches of ticks: each batch samples the joints, then advances all blocks.

use crate::error::SceneError;
use crate::group::sleep::LOOK;
use crate::lanes::bucket::Failed;
use crate::sampling::carried::{Carrier, Place};
use crate::sampling::live::Course;
use crate::sampling::tracks::BATCH;
use crate::sampling::world::World;
use crate::scene::{Groups, Scene};
use core::any::Any;
use pendulum_core::scalar::Float;
use std::collections::BTreeSet;

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
    /// The number of live joints that have jumped instead of moving; see
    /// [`Scene::move_to`](crate::Scene::move_to).
    pub jumped: usize,
}

impl<T: Float> Scene<T> {
    /// Advances the scene by a frame of `dt` seconds: computes all ticks that are due and keeps the
    /// remaining time for the next frame.
    ///
    /// States at equal times have the same bits for every division of time into frames, unless
    /// there are [live](Self::live) joints, whose motion is known once a frame. A frame of zero
    /// length has no effect. A frame longer than the [longest frame](Self::set_longest_frame) is
    /// shortened.
    ///
    /// # Errors
    /// Returns an error if `dt` is negative, infinite or NaN.
    pub fn advance(&mut self, dt: f64) -> Result<Advanced, SceneError> {
        if self.paused && (0.0..f64::INFINITY).contains(&dt) {
            self.world.each_live(|_, live| live.interrupt());
            return Ok(Advanced::default());
        }
        let (ticks, dropped) = self.world.clock.ask(dt, self.longest_frame)?;
        if 0.0 < dropped {
            self.world.each_live(|_, live| live.interrupt());
        }
        let failed = self.faults.len();
        let jumped = self.begin_frame(ticks);
        self.ticks(ticks);
        Ok(Advanced { ticks, dropped, failed: self.faults.len() - failed, jumped })
    }

    /// Computes `ticks` ticks, independently of frames.
    pub fn advance_ticks(&mut self, ticks: u32) -> Advanced {
        self.world.clock.shift(i64::from(ticks));
        let (jumped, failed) = (self.begin_frame(u64::from(ticks)), self.faults.len());
        self.ticks(u64::from(ticks));
        let failed = self.faults.len() - failed;
        Advanced { ticks: u64::from(ticks), failed, jumped, ..Advanced::default() }
    }

    /// Begins a frame of `ticks` ticks for the live joints, and returns the number of those that
    /// jump. A frame without a tick is a part of the next one.
    fn begin_frame(&mut self, ticks: u64) -> usize {
        let mut others = core::mem::take(&mut self.others);
        if 0 < ticks {
            self.world.begin_frame(ticks, &mut others);
        }
        for &(joint, course) in &others {
            for index in 0..self.world.carries[joint as usize].len() {
                let (group, id) = self.world.carries[joint as usize][index];
                self.groups[group as usize].1.follow(&mut self.world, id, course);
            }
        }
        let jumped = others.iter().filter(|(_, course)| *course == Course::Jumps).count();
        others.clear();
        self.others = others;
        jumped
    }

    /// Computes `ticks` ticks, in which live joints rest where they were last told to be.
    pub(crate) fn whole_ticks(&mut self, ticks: u64) -> Advanced {
        let (now, failed) = (self.world.clock.asked(0), self.faults.len());
        self.world.each_live(|_, live| live.settle(now));
        self.world.clock.shift(ticks as i64);
        self.ticks(ticks);
        Advanced { ticks, failed: self.faults.len() - failed, ..Advanced::default() }
    }

    pub(crate) fn ticks(&mut self, mut ticks: u64) {
        while 0 < ticks {
            // What hangs on a carried joint needs the tick of the pendulum that carries it, and bones
            // with limits act on each tick.
            let free = self.world.carriers.is_empty() && self.limits.bones.is_empty();
            let most = if free { BATCH as u64 } else { 1 };
            let batch = ticks.min(self.update_sleep()).min(most);
            self.batch(batch as usize);
            self.world.clock.passed(batch);
            ticks -= batch;
        }
    }

    /// Wakes the pendulums whose joints are about to move, and lets others fall asleep. Returns the
    /// number of ticks until the next call is due.
    fn update_sleep(&mut self) -> u64 {
        let tick = self.world.clock.tick();
        let look = self.sleep.map_or(i64::MAX, |_| LOOK - tick.rem_euclid(LOOK));
        let groups = self.groups.iter_mut();
        let next = groups
            .map(|(_, group)| group.sleep(&mut self.world, self.sleep).saturating_sub(tick))
            .fold(look, i64::min);
        next.max(1) as u64
    }

    /// Computes a batch of `ticks` ticks, at most [`BATCH`].
    fn batch(&mut self, ticks: usize) {
        let work = if self.parallel { self.awake().0 * ticks } else { 0 };
        let Self { id, world, groups, threads, faults, limits, .. } = self;
        let mut all: Vec<(u8, usize, u32)> = Vec::new();
        let mut failed: Vec<Failed> = Vec::new();
        threads.measured(work, |fork| {
            for level in 0..=world.top() {
                world.sample(level, ticks, fork);
                for (index, (_, group)) in groups.iter_mut().enumerate() {
                    group.run(world, level, ticks, fork, &mut failed);
                    all.extend(failed.drain(..).map(|(id, at)| (at, index, id)));
                }
                limits.keep(world, groups, *id, level);
                carry(world, groups, level);
            }
        });
        // Sorts by time, so that the order does not depend on the batches.
        all.sort_unstable();
        for (at, index, id) in all {
            let tick = world.clock.tick() + i64::from(at);
            faults.push(groups[index].1.fail(world, id, tick));
        }
    }
}

/// Moves the joints that the pendulums of a level carry through the tick that these have taken, and
/// wakes pendulums on joints that begin to move or have jumped.
fn carry<T: Float>(world: &mut World<T>, groups: &mut Groups<T>, level: u32) {
    let mut carriers = core::mem::take(&mut world.carriers);
    for (&place, carrier) in carriers.range_mut((level, 0, 0)..(level + 1, 0, 0)) {
        let tick = world.clock.tick();
        carry_one(world, groups, place, carrier, tick, true);
    }
    world.carriers = carriers;
}

/// Moves the joints that a pendulum carries through a tick.
fn carry_one<T: Float>(
    world: &mut World<T>,
    groups: &mut Groups<T>,
    (_, group, id): Place,
    carrier: &mut Carrier<T>,
    tick: i64,
    follow: bool,
) {
    let group: &dyn Any = &*groups[group as usize].1;
    (carrier.frames)(group, world, id, tick, carrier);
    for ride in &carrier.rides {
        let course = world.move_carried(ride, tick);
        if follow && course != Course::Continues {
            for index in 0..world.carries[ride.joint as usize].len() {
                let (group, id) = world.carries[ride.joint as usize][index];
                groups[group as usize].1.follow(world, id, course);
            }
        }
    }
}

impl<T: Float> Scene<T> {
    /// Moves the joints that a pendulum carries, those that pendulums on these joints carry and so
    /// on, after its state has been changed between ticks. What hangs there does not feel the jump.
    pub(crate) fn carry_from(&mut self, place: Place) {
        let Self { world, groups, .. } = self;
        let mut places = BTreeSet::from([place]);
        while let Some(place) = places.pop_first() {
            let Some(mut carrier) = world.carriers.remove(&place) else { continue };
            let tick = world.clock.tick() - 1;
            carry_one(world, groups, place, &mut carrier, tick, true);
            for ride in &carrier.rides {
                for &(group, id) in &world.carries[ride.joint as usize] {
                    places.insert(groups[group as usize].1.place_of(id));
                }
            }
            world.carriers.insert(place, carrier);
        }
    }

    /// Moves all joints that pendulums carry, after a change of the whole scene; what
    /// hangs there is woken and brought onto its constraints if `follow` is `true`.
    pub(crate) fn carry_all(&mut self, follow: bool) {
        let Self { world, groups, .. } = self;
        let mut carriers = core::mem::take(&mut world.carriers);
        for (&place, carrier) in &mut carriers {
            let tick = world.clock.tick() - 1;
            carry_one(world, groups, place, carrier, tick, follow);
        }
        world.carriers = carriers;
    }
}
