//! The interface between a scene and its groups.

use crate::motion::Derivatives;
use crate::scalar::{Float, Lane};
use crate::scene::error::{SceneError, SceneFault};
use crate::scene::group::change::Preserve;
use crate::scene::group::fault::diagnose;
use crate::scene::group::members::Group;
use crate::scene::group::saved::GroupState;
use crate::scene::group::status::SceneStatus;
use crate::scene::lanes::bucket::Failed;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::system::{Layouts, SceneSystem};
use core::any::Any;
use core::cmp::Reverse;

/// A group of pendulums whose type is erased.
pub(crate) trait AnyGroup<T>: Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    /// Calls `visit` for every joint of awake pendulums, with the derivatives that they need.
    fn needs(&self, visit: &mut dyn FnMut(u32, Derivatives));
    /// Advances the awake pendulums by a batch, and appends the lanes that fail to `failed`.
    fn run(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        ticks: usize,
        fork: bool,
        failed: &mut Vec<Failed>,
    );
    /// Removes a pendulum that has failed in a tick from the computed pendulums, and returns the
    /// fault.
    fn fail(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        id: u32,
        tick: i64,
    ) -> SceneFault;
    /// Returns the names of the parameters of the type.
    fn parameters(&self) -> &'static [&'static str];
    /// Returns the state of all pendulums of the group.
    fn save(&self) -> GroupState<T>;
    /// Checks that a saved state belongs to this group; the error describes the difference.
    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError>;
    /// Returns the largest differences of coordinates and of velocities from a saved state.
    fn gap(&self, state: &GroupState<T>) -> [f64; 2];
    /// Sets all pendulums to their states of rest.
    fn reset(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>]) -> Result<(), SceneError>;
    /// Returns an error if a motion with the derivatives `has` lacks one that the pendulums on
    /// `joint` need.
    fn accepts_motion(&self, joint: u32, has: Derivatives) -> Result<(), SceneError>;
    /// Returns an error if a pendulum on `joint` is too fast for its motion.
    fn accepts_steps(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        joint: u32,
    ) -> Result<(), SceneError>;
    /// Adapts the pendulums on `joint` to its new motion in `joint_slots`, which replaces the
    /// motion in `before`.
    fn moved(
        &mut self,
        clock: &Clock,
        before: &[JointSlot<T>],
        joint_slots: &[JointSlot<T>],
        joint: u32,
        preserve: Preserve,
    ) -> Result<(), SceneError>;
    /// Returns `true` if the pendulums have constraints.
    fn is_constrained(&self) -> bool;
    /// Returns an error if a pendulum with this value of a parameter is too fast, has a negative
    /// mass or cannot fulfil its constraints.
    fn accepts_parameter(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Result<(), SceneError>;
    /// Sets a parameter of all pendulums and returns their number; `None` if the type has no such
    /// parameter.
    fn set_parameter(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Option<usize>;
    /// Wakes the sleeping pendulums whose alarms are due at `tick`, or all at `i64::MAX`.
    fn wake_due(&mut self, tick: i64);
    /// Returns the next tick at which a pendulum wakes, or `i64::MAX` if there is none.
    fn next_alarm(&self) -> i64;
    /// Puts all pendulums to sleep that fulfil their sleep criterion.
    fn fall_asleep(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>], tolerance: f64);
    /// Discards the sleep criteria.
    fn forget_criteria(&mut self);
    /// Returns the number of computed pendulums and the number of all pendulums.
    fn awake(&self) -> (usize, usize);
    /// Restores a saved state.
    fn restore(&mut self, joint_slots: &[JointSlot<T>], state: &GroupState<T>);
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> AnyGroup<T> for Group<S, T, N> {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn needs(&self, visit: &mut dyn FnMut(u32, Derivatives)) {
        for tracks in self.buckets.iter().map(|bucket| &bucket.tracks) {
            for track in (0..tracks.count()).filter(|&track| tracks.is_awake(track)) {
                let joints = tracks.joints(track as u32).iter();
                joints.zip(Layouts::<S, N>::FORCES.wanted).for_each(|(&joint, wanted)| visit(joint, wanted));
            }
        }
    }

    fn run(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        ticks: usize,
        fork: bool,
        failed: &mut Vec<Failed>,
    ) {
        for bucket in &mut self.buckets {
            bucket.settle(&self.prototype, clock.step());
            bucket.run(clock, joint_slots, ticks, fork, failed);
        }
    }

    fn fail(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        id: u32,
        tick: i64,
    ) -> SceneFault {
        self.set_awake(id, false);
        self.status[id as usize] = SceneStatus::Failed;
        let detached = self.read(id);
        let t = clock.time(tick);
        let error = diagnose(
            &self.system_of(&detached.parameters),
            joint_slots,
            &detached,
            t,
            clock.step(),
        );
        SceneFault { kind: S::FACTS.name, index: id, t, error }
    }

    fn parameters(&self) -> &'static [&'static str] {
        S::FACTS.parameters
    }

    fn save(&self) -> GroupState<T> {
        Group::save(self)
    }

    fn wake_due(&mut self, tick: i64) {
        self.wake_due(tick);
    }

    fn next_alarm(&self) -> i64 {
        self.alarms.peek().map_or(i64::MAX, |Reverse((tick, _))| *tick)
    }

    fn fall_asleep(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>], tolerance: f64) {
        self.fall_asleep(clock, joint_slots, tolerance);
    }

    fn forget_criteria(&mut self) {
        self.criteria.clear();
    }

    fn awake(&self) -> (usize, usize) {
        (self.buckets.iter().map(|bucket| bucket.awake).sum(), self.table.len())
    }

    fn gap(&self, state: &GroupState<T>) -> [f64; 2] {
        Group::gap(self, state)
    }

    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError> {
        Group::accepts(self, state)
    }

    fn reset(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>]) -> Result<(), SceneError> {
        Group::reset(self, clock, joint_slots)
    }

    fn accepts_motion(&self, joint: u32, has: Derivatives) -> Result<(), SceneError> {
        Group::accepts_motion(self, joint, has)
    }

    fn accepts_steps(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        joint: u32,
    ) -> Result<(), SceneError> {
        Group::accepts_steps(self, clock, joint_slots, joint)
    }

    fn moved(
        &mut self,
        clock: &Clock,
        before: &[JointSlot<T>],
        joint_slots: &[JointSlot<T>],
        joint: u32,
        preserve: Preserve,
    ) -> Result<(), SceneError> {
        Group::moved(self, clock, before, joint_slots, joint, preserve)
    }

    fn is_constrained(&self) -> bool {
        Layouts::<S, N>::HELD
    }

    fn accepts_parameter(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Result<(), SceneError> {
        Group::accepts_parameter(self, clock, joint_slots, name, value)
    }

    fn set_parameter(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Option<usize> {
        Group::set_parameter(self, clock, joint_slots, name, value)
    }

    fn restore(&mut self, joint_slots: &[JointSlot<T>], state: &GroupState<T>) {
        Group::restore(self, joint_slots, state);
    }
}
