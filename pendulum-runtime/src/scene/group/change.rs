//! Changes of motions and parameters.

use crate::motion::{Derivatives, Side};
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::constraints::OnJoints;
use crate::scene::group::joints::{check_motion, inputs_at};
use crate::scene::group::members::Group;
use crate::scene::lanes::detached::Detached;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::system::SceneSystem;
use crate::system::{Purpose, scalar_time};
use crate::time::Time;

/// The part of the state that is preserved when a joint gets another motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Preserve {
    /// Coordinates and velocities are preserved. Pendulums with coordinates relative to the joint,
    /// such as angles, are teleported with the joint without an impulse; absolute coordinates keep
    /// their values. A jump of the old velocity at the last tick, such as the end of a motion, has
    /// been felt: to continue a motion by another one, preserve the momenta.
    Swing,
    /// Coordinates and momenta are preserved: a jump in the velocity of the joint acts as an
    /// impulse.
    Momentum,
    /// The state is not preserved: the pendulums hang at rest.
    Nothing,
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Group<S, T, N> {
    /// Sets all pendulums to their states of rest.
    pub(super) fn reset(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
    ) -> Result<(), SceneError> {
        (0..self.table.len() as u32).try_for_each(|id| self.rest(clock, joint_slots, id))
    }

    /// Returns an error if a motion with the derivatives `has` lacks one that the pendulums on
    /// `joint` need.
    pub(super) fn accepts_motion(&self, joint: u32, has: Derivatives) -> Result<(), SceneError> {
        for bucket in &self.buckets {
            for track in 0..bucket.tracks.count() as u32 {
                for (input, &other) in bucket.tracks.joints(track).iter().enumerate() {
                    if other == joint {
                        check_motion(&S::FACTS, input, has)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Adapts the pendulums on `joint` to its new motion in `joint_slots`, which replaces the
    /// motion in `before`.
    ///
    /// # Errors
    /// Returns an error if a pendulum cannot be brought onto its constraints, has no state of rest
    /// or is too fast.
    pub(super) fn moved(
        &mut self,
        clock: &Clock,
        before: &[JointSlot<T>],
        joint_slots: &[JointSlot<T>],
        joint: u32,
        preserve: Preserve,
    ) -> Result<(), SceneError> {
        for bucket in &mut self.buckets {
            bucket.tracks.forget_kinks();
        }
        let time = Time::new(clock.time(clock.tick()));
        for id in 0..self.table.len() as u32 {
            if !self.joints(id).contains(&joint) {
                continue;
            }
            let mut detached = self.read(id);
            if preserve == Preserve::Momentum {
                // A kink at the current tick belongs to the tick before it, so the state lies after
                // the kinks of both motions.
                let inputs = |joint_slots| {
                    inputs_at::<S, T, N>(
                        joint_slots,
                        &detached.joints,
                        time,
                        Side::After,
                        Purpose::Momenta,
                        false,
                    )
                };
                let (old, new) = (inputs(before), inputs(joint_slots));
                let (system, t) = (self.system_of(&detached.parameters), scalar_time(time));
                let [q, _, v, ..] = detached.state;
                if old != new {
                    let after = system.velocities(t, &q, &system.momenta(t, &q, &v, &old), &new);
                    // If the equations have no solution, the velocity is kept, and the next tick
                    // fails with the cause.
                    if after.iter().all(|v| v.is_finite()) {
                        (detached.state[2], detached.state[3]) = (after, [T::from_f64(0.0); N]);
                    }
                }
            }
            if preserve != Preserve::Nothing {
                self.constrain(clock, joint_slots, &mut detached)?;
            }
            self.rewrite(clock, joint_slots, &detached)?;
            if preserve == Preserve::Nothing {
                self.rest(clock, joint_slots, id)?;
            }
            self.wake(id);
            self.forget_criterion(id);
        }
        Ok(())
    }

    /// Brings a pendulum onto its constraints after a change of its parameters or joints.
    ///
    /// # Errors
    /// Returns an error if the constraints cannot be fulfilled.
    pub(in crate::scene) fn constrain(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        detached: &mut Detached<T, N>,
    ) -> Result<(), SceneError> {
        let (system, joints) = (self.system_of(&detached.parameters), detached.joints.clone());
        OnJoints { system: &system, joint_slots, joints: &joints }
            .constrain(clock.time(clock.tick()), detached)
    }

    /// Returns an error if a pendulum with this value of a parameter is too fast, has a negative
    /// mass or cannot fulfil its constraints.
    pub(super) fn accepts_parameter(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Result<(), SceneError> {
        let index = S::FACTS.parameters.iter().position(|parameter| *parameter == name);
        let Some(index) = index else { return Ok(()) };
        (0..self.table.len() as u32).try_for_each(|id| {
            let mut detached = self.read(id);
            detached.parameters[index] = value;
            self.constrain(clock, joint_slots, &mut detached)?;
            self.checked_kind(clock, joint_slots, &detached).map(drop)
        })
    }

    /// Sets a parameter of all pendulums and returns their number; `None` if the type has no such
    /// parameter.
    ///
    /// Callers must check the value with `accepts_parameter` first.
    pub(super) fn set_parameter(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Option<usize> {
        let index = S::FACTS.parameters.iter().position(|parameter| *parameter == name)?;
        for id in 0..self.table.len() as u32 {
            let mut detached = self.read(id);
            detached.parameters[index] = value;
            let _ = self.constrain(clock, joint_slots, &mut detached);
            let _ = self.rewrite(clock, joint_slots, &detached);
            self.wake(id);
        }
        self.criteria.clear();
        Some(self.table.len())
    }
}
