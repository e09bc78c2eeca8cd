//! Changes of motions, parameters and states, planned for all pendulums before the first of them
//! changes, so that an error leaves the scene as it was.

use crate::error::SceneError;
use crate::group::hung::Hung;
use crate::group::members::{Group, SceneStatus};
use crate::lanes::bucket::Detached;
use crate::sampling::joint::JointSlot;
use crate::sampling::live::Course;
use crate::sampling::scheme::Kind;
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem};
use pendulum_core::motion::Side;
use pendulum_core::scalar::Float;
use pendulum_core::system::{At, Dynamics, Purpose, scalar_time};
use pendulum_core::time::Time;

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

/// A change of a pendulum.
pub(crate) enum Change<'a, T> {
    /// The steps are chosen again, with the method of the group.
    Steps,
    /// The pendulum hangs at rest.
    Rest,
    /// The parameter with this name gets a value.
    Parameter(&'a str, T),
    /// The joint with this index has another motion than before; the earlier one is only needed to
    /// preserve momenta.
    Motion(u32, Option<&'a JointSlot<T>>, Preserve),
}

impl<T> Change<'_, T> {
    /// Returns `true` if pendulums come to rest.
    fn rests(&self) -> bool {
        matches!(self, Self::Rest | Self::Motion(_, _, Preserve::Nothing))
    }
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    /// Plans a change of the pendulums `ids`, and returns the number of those that it concerns.
    ///
    /// # Errors
    /// Returns an error if a motion lacks a derivative, a pendulum cannot be brought onto its
    /// constraints, has no state of rest or is too fast, or a mass is negative.
    pub(crate) fn plan_for(
        &mut self,
        world: &World<T>,
        change: &Change<'_, T>,
        ids: impl Iterator<Item = u32>,
    ) -> Result<usize, SceneError> {
        self.planned.clear();
        for id in ids.filter(|&id| self.generation(id).is_some()).collect::<Vec<_>>() {
            let concerned = match *change {
                Change::Steps | Change::Rest => true,
                Change::Parameter(name, _) => S::FACTS.parameters.contains(&name),
                Change::Motion(joint, ..) => self.joints(id).contains(&joint),
            };
            if concerned {
                let changed = self.changed(world, change, id)?;
                self.planned.push(changed);
            }
        }
        Ok(self.planned.len())
    }

    /// Returns a pendulum after a change that concerns it.
    fn changed(
        &self,
        world: &World<T>,
        change: &Change<'_, T>,
        id: u32,
    ) -> Result<(Kind, Detached<T, N>), SceneError> {
        let mut detached = self.read(id);
        match *change {
            Change::Steps | Change::Rest => {}
            Change::Parameter(name, value) => {
                for (parameter, own) in S::FACTS.parameters.iter().zip(&mut detached.parameters) {
                    if *parameter == name {
                        *own = value;
                    }
                }
                self.constrain(world, &mut detached)?;
            }
            Change::Motion(joint, before, preserve) => {
                self.hung(world, &detached).check_motions()?;
                if preserve == Preserve::Momentum
                    && let Some(before) = before
                {
                    // A world of the joints of this pendulum.
                    let slot = |own: &u32| {
                        if *own == joint { before } else { &world.joints[*own as usize] }
                    };
                    let joints: Vec<_> =
                        detached.joints.iter().map(|own| slot(own).clone()).collect();
                    let earlier =
                        Detached { joints: (0..joints.len() as u32).collect(), ..detached.clone() };
                    let before = World::new(world.clock, joints);
                    let before = self.hung(&before, &earlier);
                    let after = self.hung(world, &detached);
                    if let Some(v) = kicked(&before, &after) {
                        (detached.state[2], detached.state[3]) = (v, [T::from_f64(0.0); N]);
                    }
                }
                if preserve != Preserve::Nothing {
                    self.constrain(world, &mut detached)?;
                }
            }
        }
        let kind =
            if let Change::Rest = change { self.kind_of(id) } else { self.kind(world, &detached)? };
        if change.rests() {
            let (q, zero) = (self.hung(world, &detached).rest(world.now())?, [T::from_f64(0.0); N]);
            detached.state = [q, zero, zero, zero, q, zero];
            self.settle(world, &mut detached)
                .map_err(|_| SceneError::Restless { kind: S::FACTS.name, index: id })?;
        }
        Ok((kind, detached))
    }

    /// Makes the planned changes. Pendulums whose parameters or joints change wake if they sleep;
    /// pendulums that are set to rest are computed again if they have failed.
    pub(crate) fn commit(&mut self, world: &mut World<T>, change: &Change<'_, T>) {
        for (kind, detached) in core::mem::take(&mut self.planned) {
            let id = detached.id;
            self.place(world, kind, &detached);
            if change.rests() && self.status[id as usize] == SceneStatus::Failed {
                self.status[id as usize] = SceneStatus::Awake;
                self.set_awake(world, id, true);
            }
            if let Change::Parameter(..) | Change::Motion(..) = change {
                self.wake(world, id);
                self.forget_criterion(id);
            }
        }
    }

    /// Wakes a pendulum on a joint that begins to move or has jumped, and brings it onto its
    /// constraints and limits after a jump.
    pub(crate) fn follow(&mut self, world: &mut World<T>, id: u32, course: Course) {
        self.wake(world, id);
        if const { Layouts::<S, N>::HELD || Layouts::<S, N>::LIMITED } && course == Course::Jumps {
            let mut detached = self.read(id);
            // If there is no such state, the next tick fails with the cause, or pushes the pendulum
            // out of its limits.
            if self.constrain(world, &mut detached).is_ok() {
                self.write(world, &detached);
            }
        }
    }

    /// Brings a pendulum onto its constraints after a change of its parameters or joints.
    ///
    /// # Errors
    /// Returns an error if the constraints cannot be fulfilled.
    fn constrain(&self, world: &World<T>, detached: &mut Detached<T, N>) -> Result<(), SceneError> {
        let [q, v] = self.hung(world, detached).nearest()?;
        if (q, v) != (detached.state[0], detached.state[2]) {
            let zero = [T::from_f64(0.0); N];
            (detached.state[0], detached.state[1]) = (q, zero);
            (detached.state[2], detached.state[3]) = (v, zero);
        }
        self.settle(world, detached)
    }

    /// Brings a pendulum onto its limits, with the impacts now, and finds their states.
    ///
    /// # Errors
    /// Returns an error if a gap is below zero.
    pub(crate) fn settle(
        &self,
        world: &World<T>,
        detached: &mut Detached<T, N>,
    ) -> Result<(), SceneError> {
        if const { !Layouts::<S, N>::LIMITED } {
            return Ok(());
        }
        let [q, _, v, ..] = detached.state;
        let ([q_now, q_low, v_now, v_low, ..], standing) =
            self.hung(world, detached).begin(q, v)?;
        if (q_now, v_now) != (q, v) {
            detached.state[..4].copy_from_slice(&[q_now, q_low, v_now, v_low]);
        }
        detached.standing = standing;
        Ok(())
    }
}

/// Returns the velocities with the same momenta after a joint has got another motion; `None` if
/// they do not change.
fn kicked<S: SceneSystem<T, N>, T: Float, const N: usize>(
    before: &Hung<'_, S, T, N>,
    after: &Hung<'_, S, T, N>,
) -> Option<[T; N]> {
    // A kink at the current tick belongs to the tick before it, so the state lies after the kinks
    // of both motions.
    let now = Time::new(after.world.now());
    let [old, new] = [before, after].map(|hung| hung.inputs(now, Side::After, Purpose::Momenta));
    let (system, t, [q, _, v, ..]) = (&after.system, scalar_time(now), &after.pendulum.state);
    if old == new {
        return None;
    }
    let kicked = system.velocities(t, q, &system.momenta(At { t, q, v, inputs: &old }), &new);
    // If the equations have no solution, the velocity is kept, and the next tick fails with the
    // cause.
    kicked.iter().all(|v| v.is_finite()).then_some(kicked)
}
