//! Warm-up and closed loops.

use crate::advance::Advanced;
use crate::error::SceneError;
use crate::sampling::joint::Drive;
use crate::scene::Scene;
use crate::system::ORDERS;
use pendulum_core::motion::{Derivatives, Side};
use pendulum_core::scalar::Float;
use pendulum_core::time::Time;

/// The result of [`Scene::close_loop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closed {
    /// The number of simulated turns.
    pub turns: u32,
    /// The largest difference of a coordinate between the beginning and the end of the last turn,
    /// plus [`velocity_gap`](Self::velocity_gap) times the period: no less than the difference of a
    /// coordinate after the next turn, for small swings and free turns. If a joint does not return
    /// to its motion at the beginning, it is at least the difference of its position, velocity or
    /// acceleration, whichever the equations contain.
    pub gap: f64,
    /// The largest difference of a velocity between the beginning and the end of the last turn.
    pub velocity_gap: f64,
}

impl<T: Float> Scene<T> {
    /// Simulates the `seconds` before now, starting with the current states of the pendulums, so
    /// that pendulums already swing in the first frame.
    ///
    /// Joints move according to their motions at those times; live joints rest where they were last
    /// told to be.
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
        let clock = self.world.clock.state();
        self.world.clock.jump(self.world.clock.tick() - ticks as i64);
        let advanced = self.whole_ticks(ticks);
        self.world.clock.restore(clock);
        advanced
    }

    /// Finds states for a closed loop of the next `period` ticks, whose end equals its beginning:
    /// simulates turn after turn until the gap is at most `tolerance`, at most `most` times.
    ///
    /// The motions must repeat after `period` ticks, or at least end as they begin. With damping,
    /// the gap shrinks by e^(−γP/2) per turn or faster; without damping it may not shrink.
    /// Afterwards the time of the scene is unchanged, and the states are those after the last turn.
    /// The gap bounds the jump between the end and the beginning of the loop that is played next. An
    /// angle that grows by whole revolutions per turn does not return, and has a gap.
    ///
    /// A kink up to a rounding error of `f32` after the last tick, as at the end of a period from a
    /// file, counts as at the last tick.
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
        self.wake_all();
        let joints = self.joint_gap(period);
        // A coordinate may pass its beginning with another velocity. Within a turn, this moves it by
        // at most velocity times time: by less on a spring, where it is Δv sin(ωP)/ω.
        let seconds = f64::from(period) * self.step();
        let mut closed = Closed { turns: 0, gap: f64::INFINITY, velocity_gap: f64::INFINITY };
        while closed.turns < most {
            let begin = self.snapshot();
            // The turn is the loop itself: a motion that only ends as it begins was another before.
            let clock = self.world.clock.state();
            self.wake_all();
            self.whole_ticks(u64::from(period));
            self.world.clock.restore(clock);
            // Pendulums sleep until times after the loop.
            self.wake_all();
            (closed.turns, closed.gap, closed.velocity_gap) = (closed.turns + 1, 0.0, 0.0);
            for ((_, group), begin) in self.groups.iter().zip(begin.groups()) {
                let [gap, velocity_gap] = group.gap(begin);
                (closed.gap, closed.velocity_gap) =
                    (closed.gap.max(gap), closed.velocity_gap.max(velocity_gap));
            }
            closed.gap += seconds * closed.velocity_gap;
            if closed.gap <= tolerance {
                break;
            }
        }
        closed.gap = closed.gap.max(joints);
        Ok(closed)
    }

    /// Returns the largest difference between the motions of joints now and `period` ticks later,
    /// of the derivatives that awake pendulums feel; differences that are small relative to the
    /// motion during the loop do not count.
    fn joint_gap(&self, period: u32) -> f64 {
        let mut felt = vec![Derivatives::NONE; self.world.joints.len()];
        for tracks in &self.world.tracks {
            tracks.needs(|joint, needed| {
                felt[joint as usize] = felt[joint as usize].union(needed);
            });
        }
        // The states of the pendulums that carry joints have gaps of their own.
        let carried = &self.world.carried;
        let moving = self.world.joints.iter().zip(felt).zip(carried);
        let moving = moving.filter(|((joint, _), carried)| !joint.still && carried.is_none());
        moving
            .map(|((joint, felt), _)| self.gap_of(&*joint.drive, felt, period))
            .fold(0.0, f64::max)
    }

    fn gap_of(&self, drive: &dyn Drive<T>, felt: Derivatives, period: u32) -> f64 {
        // Periods from files are rounded, and steep motions change much within this rounding.
        const SMALL: f64 = 1e-4;
        let mut gap = 0.0f64;
        for own in ORDERS {
            // Velocities act at kinks, if accelerations act between them.
            let acts = felt.contains(own)
                || own == Derivatives::VELOCITY && felt.contains(Derivatives::ACCELERATION);
            if !acts || !drive.has().contains(own) {
                continue;
            }
            let at = |ticks: u32| {
                let mut values = vec![T::from_f64(0.0); drive.components()];
                let t = self.world.clock.time(self.world.clock.tick() + i64::from(ticks));
                drive.sample(Time::new(t), Side::After, own, &mut values);
                values
            };
            let (begin, end) = (at(0), at(period));
            let apart = |a: &[T], b: &[T]| {
                a.iter().zip(b).map(|(&a, &b)| (a - b).to_f64().abs()).fold(0.0, f64::max)
            };
            // The origin of positions is arbitrary.
            let zero = vec![T::from_f64(0.0); begin.len()];
            let from = if own == Derivatives::POSITION { &begin } else { &zero };
            let size = (0..=period).map(|ticks| apart(&at(ticks), from)).fold(0.0, f64::max);
            let jump = apart(&begin, &end);
            if SMALL * size < jump {
                gap = gap.max(jump);
            }
        }
        gap
    }
}
