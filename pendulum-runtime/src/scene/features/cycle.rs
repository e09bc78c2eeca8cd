//! Simulation of times before now: warm-up and closed loops.

use crate::scalar::{Float, Lane};
use crate::scene::advance::Advanced;
use crate::scene::error::SceneError;
use crate::scene::scene::Scene;

/// The result of [`Scene::close_loop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closed {
    /// The number of simulated turns.
    pub turns: u32,
    /// The largest difference of a coordinate between the beginning and the end of the last turn.
    pub gap: f64,
    /// The largest difference of a velocity between the beginning and the end of the last turn.
    pub velocity_gap: f64,
}

impl<T: Lane + Float> Scene<T> {
    /// Simulates the `seconds` before now, starting with the current states of the pendulums, so
    /// that pendulums already swing in the first frame.
    ///
    /// Joints move according to their motions at those times.
    ///
    /// # Errors
    /// Returns an error if `seconds` is negative, NaN or longer than a year.
    pub fn warm_up(&mut self, seconds: f64) -> Result<Advanced, SceneError> {
        if !(0.0..=3.2e7).contains(&seconds) {
            return Err(SceneError::Setting {
                name: "warm-up",
                value: seconds,
                required: "between zero and a year",
            });
        }
        // As for frames, a difference of less than a millionth of a tick is ignored.
        Ok(self.before((seconds / self.step() - 1e-6).ceil().max(0.0) as u64))
    }

    /// Computes the `ticks` ticks before now and restores the clock.
    fn before(&mut self, ticks: u64) -> Advanced {
        // Pendulums that sleep now may have been awake at earlier times.
        self.wake_all();
        let clock = self.clock.state();
        self.clock.jump(self.clock.tick() - ticks as i64);
        self.dirty = true;
        let advanced = self.whole_ticks(ticks);
        self.clock.restore(clock);
        // The next kinks must be searched again.
        self.dirty = true;
        advanced
    }

    /// Finds states for a closed loop of `period` ticks, whose end equals its beginning: simulates
    /// turn after turn until the gap is at most `tolerance`, at most `most` times.
    ///
    /// The motions must have a period of `period` ticks. With damping, the gap shrinks by e^(−γP/2)
    /// per turn or faster; without damping it may not shrink. Afterwards the time of the scene is
    /// unchanged, and the states are those after the last turn. The gap is the jump between the end
    /// and the beginning of the loop.
    ///
    /// # Errors
    /// Returns an error if `period` or `most` is zero.
    pub fn close_loop(
        &mut self,
        period: u32,
        most: u32,
        tolerance: f64,
    ) -> Result<Closed, SceneError> {
        if period == 0 || most == 0 {
            return Err(SceneError::Setting {
                name: "period",
                value: f64::from(period.min(most)),
                required: "at least one",
            });
        }
        let mut closed = Closed { turns: 0, gap: f64::INFINITY, velocity_gap: f64::INFINITY };
        while closed.turns < most {
            let begin = self.snapshot();
            self.before(u64::from(period));
            (closed.turns, closed.gap, closed.velocity_gap) = (closed.turns + 1, 0.0, 0.0);
            for ((_, group), begin) in self.groups.iter().zip(begin.groups()) {
                let [gap, velocity_gap] = group.gap(begin);
                (closed.gap, closed.velocity_gap) =
                    (closed.gap.max(gap), closed.velocity_gap.max(velocity_gap));
            }
            if closed.gap <= tolerance {
                break;
            }
        }
        Ok(closed)
    }
}
