//! Frames, ticks and batches of ticks: each batch samples the joints, then advances all blocks.

use crate::error::SceneError;
use crate::group::sleep::LOOK;
use crate::lanes::bucket::Failed;
use crate::sampling::tracks::BATCH;
use crate::scene::Scene;
use pendulum_core::scalar::{Float, Lane};

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
        let (ticks, dropped) = self.world.clock.ask(dt, self.longest_frame)?;
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
        self.world.clock.shift(ticks as i64);
        self.ticks(ticks);
        Advanced { ticks, dropped: 0.0, failed: self.faults.len() - failed }
    }

    pub(crate) fn ticks(&mut self, mut ticks: u64) {
        while 0 < ticks {
            let batch = ticks.min(self.update_sleep()).min(BATCH as u64);
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
        let Self { world, groups, threads, faults, .. } = self;
        let mut all: Vec<(u8, usize, u32)> = Vec::new();
        let mut failed: Vec<Failed> = Vec::new();
        threads.measured(work, |fork| {
            world.sample(ticks, fork);
            for (index, (_, group)) in groups.iter_mut().enumerate() {
                group.run(world, ticks, fork, &mut failed);
                all.extend(failed.drain(..).map(|(id, at)| (at, index, id)));
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
