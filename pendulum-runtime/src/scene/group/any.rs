//! The pendulums of a type as the scene sees them.

use crate::motion::Derivatives;
use crate::scalar::{Float, Lane};
use crate::scene::error::{SceneError, SceneFault};
use crate::scene::group::change::Preserve;
use crate::scene::group::fault::diagnose;
use crate::scene::group::members::Group;
use crate::scene::group::saved::GroupState;
use crate::scene::group::status::SceneStatus;
use crate::scene::lanes::bucket::Failed;
use crate::scene::lanes::system::{Layouts, SceneSystem};
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::sampling::scheme::Grid;
use crate::scene::sampling::tracks::Sampled;
use core::any::Any;
use core::cmp::Reverse;

/// All pendulums of the type `S`, as the scene sees them.
pub(crate) trait AnyGroup<T>: Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    /// Visits every joint of pendulums that are awake, with the derivatives needed of it and the
    /// grid of their times.
    fn needs(&self, visit: &mut dyn FnMut(u32, Derivatives, Grid));
    /// Prepares a batch: computes once what parameters alone decide.
    fn settle(&mut self, clock: &Clock);
    /// Goes through a batch.
    fn run(&mut self, sampled: &Sampled<'_, T>, fork: bool, failed: &mut Vec<Failed>);
    /// Takes a pendulum that has failed in a tick away from those that are computed, and returns
    /// the reason.
    fn fail(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        id: u32,
        tick: i64,
    ) -> SceneFault;
    /// The names of the parameters of its type.
    fn parameters(&self) -> &'static [&'static str];
    /// Everything that changes while the scene runs.
    fn save(&self) -> GroupState<T>;
    /// Refuses a saved state that does not belong to this group, and names the difference.
    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError>;
    /// The largest differences of coordinates and of velocities from a saved state.
    fn gap(&self, state: &GroupState<T>) -> [f64; 2];
    /// Lets all pendulums hang at rest.
    fn reset(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>]) -> Result<(), SceneError>;
    /// Refuses a motion that lacks a derivative which the pendulums on a joint need.
    fn accepts_motion(&self, joint: u32, has: Derivatives) -> Result<(), SceneError>;
    /// Refuses the motion of a joint with which a pendulum on it is too fast.
    fn accepts_steps(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        joint: u32,
    ) -> Result<(), SceneError>;
    /// Adapts pendulums to the motion of a joint that was given in place of the one in `before`.
    fn moved(
        &mut self,
        clock: &Clock,
        before: &[JointSlot<T>],
        joint_slots: &[JointSlot<T>],
        joint: u32,
        preserve: Preserve,
    ) -> Result<(), SceneError>;
    /// Returns true if its pendulums have constraints.
    fn is_constrained(&self) -> bool;
    /// Refuses a value of a parameter with which a pendulum is too fast, has a negative mass or
    /// cannot fulfil its constraints.
    fn accepts_parameter(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Result<(), SceneError>;
    /// Sets a parameter of all pendulums, if they have it; returns their number.
    fn set_parameter(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        name: &str,
        value: T,
    ) -> Option<usize>;
    /// Wakes the sleepers whose time has come; returns true if there were any.
    fn wake_due(&mut self, tick: i64) -> bool;
    /// The next tick at which a pendulum wakes, `i64::MAX` if none does.
    fn next_alarm(&self) -> i64;
    /// Lets the pendulums fall asleep that may; returns true if there were any.
    fn fall_asleep(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>], tolerance: f64) -> bool;
    /// Forgets the criteria of sleep.
    fn forget_criteria(&mut self);
    /// The number of pendulums that are computed, and of all.
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

    fn needs(&self, visit: &mut dyn FnMut(u32, Derivatives, Grid)) {
        for bucket in self.buckets.iter().filter(|bucket| !bucket.kind.still && bucket.awake != 0) {
            bucket
                .tracks
                .needs(S::FACTS.inputs, |joint, wanted| visit(joint, wanted, bucket.kind.grid));
        }
    }

    fn settle(&mut self, clock: &Clock) {
        for bucket in &mut self.buckets {
            bucket.settle(&self.prototype, clock.step());
        }
    }

    fn run(&mut self, sampled: &Sampled<'_, T>, fork: bool, failed: &mut Vec<Failed>) {
        for bucket in &mut self.buckets {
            bucket.run(sampled, fork, failed);
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

    fn wake_due(&mut self, tick: i64) -> bool {
        self.wake_due(tick)
    }

    fn next_alarm(&self) -> i64 {
        self.alarms.peek().map_or(i64::MAX, |Reverse((tick, _))| *tick)
    }

    fn fall_asleep(&mut self, clock: &Clock, joint_slots: &[JointSlot<T>], tolerance: f64) -> bool {
        self.fall_asleep(clock, joint_slots, tolerance)
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
