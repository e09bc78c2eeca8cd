//! Runs before the beginning: warm-up, and loops that close.

use crate::scalar::{Float, Lane};
use crate::scene::advance::Advanced;
use crate::scene::error::SceneError;
use crate::scene::scene::Scene;

/// Result of [`Scene::close_loop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closed {
    /// The turns simulated.
    pub turns: u32,
    /// The largest difference of a coordinate between the end of the last turn and its beginning.
    pub gap: f64,
    /// The largest difference of a velocity.
    pub velocity_gap: f64,
}

impl<T: Lane + Float> Scene<T> {
    /// Simulates the `seconds` before now, from the states that the pendulums have, up to now: what
    /// has swung before the first frame is swinging in it.
    ///
    /// Joints move as their motions say for those times.
    ///
    /// # Errors
    /// A time that is negative or longer than a year.
    pub fn warm_up(&mut self, seconds: f64) -> Result<Advanced, SceneError> {
        if !(0.0..=3.2e7).contains(&seconds) {
            return Err(SceneError::Setting {
                name: "warm-up",
                value: seconds,
                required: "between zero and a year",
            });
        }
        // As with frames, what lacks less than a millionth of a tick is whole.
        Ok(self.before((seconds / self.step() - 1e-6).ceil().max(0.0) as u64))
    }

    /// Does the `ticks` before now; the clock is as before.
    fn before(&mut self, ticks: u64) -> Advanced {
        // A pendulum that sleeps now need not have slept then.
        self.wake_all();
        let clock = self.clock.state();
        self.clock.jump(self.clock.tick() - ticks as i64);
        self.dirty = true;
        let advanced = self.whole_ticks(ticks);
        self.clock.restore(clock);
        // Kinks are looked for anew.
        self.dirty = true;
        advanced
    }

    /// Finds the states with which a loop of `period` ticks begins as it ends: simulates turn after
    /// turn until the gap is at most `tolerance`, at most `most` times.
    ///
    /// The motions have to repeat after that many ticks. With damping the gap shrinks by e^(−γP/2)
    /// a turn or faster; without, it need not. The scene is at the time at which it was, with the
    /// state after the last turn; the gap is what a loop would show.
    ///
    /// # Errors
    /// No ticks, or no turns.
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
