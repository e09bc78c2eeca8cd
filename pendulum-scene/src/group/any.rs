//! The interface between a scene and its groups.

use crate::error::{SceneError, SceneFault};
use crate::group::change::Change;
use crate::group::members::{Group, SceneStatus};
use crate::group::saved::GroupState;
use crate::lanes::bucket::Failed;
use crate::sampling::live::Course;
use crate::sampling::world::World;
use crate::system::SceneSystem;
use core::any::Any;
use pendulum_core::scalar::{Float, Lane};

/// A group of pendulums whose type is erased.
pub(crate) trait AnyGroup<T>: Any + Send + Sync {
    /// Advances the awake pendulums by a batch, and appends the lanes that fail to `failed`.
    fn run(&mut self, world: &World<T>, ticks: usize, fork: bool, failed: &mut Vec<Failed>);
    /// Removes a pendulum that has failed in a tick from the computed pendulums, and returns the
    /// fault.
    fn fail(&mut self, world: &mut World<T>, id: u32, tick: i64) -> SceneFault;
    /// Returns the number of computed pendulums and the number of all pendulums.
    fn awake(&self) -> (usize, usize);
    /// Returns the names of the parameters of the type.
    fn parameters(&self) -> &'static [&'static str];
    /// Plans a change of all pendulums, and returns the number of those that it concerns.
    fn plan(&mut self, world: &World<T>, change: &Change<'_, T>) -> Result<usize, SceneError>;
    /// Makes the planned changes.
    fn commit(&mut self, world: &mut World<T>, change: &Change<'_, T>);
    /// Returns the state of all pendulums of the group.
    fn save(&self) -> GroupState<T>;
    /// Checks that a saved state belongs to this group; the error describes the difference.
    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError>;
    /// Restores a saved state.
    fn restore(&mut self, world: &mut World<T>, state: &GroupState<T>);
    /// Returns the largest differences of coordinates and of velocities from a saved state.
    fn gap(&self, state: &GroupState<T>) -> [f64; 2];
    /// Wakes the pendulums whose joints are about to move, and puts others to sleep with this
    /// tolerance. Returns the next tick at which a pendulum wakes, or `i64::MAX` if there is none.
    fn sleep(&mut self, world: &mut World<T>, tolerance: Option<f64>) -> i64;
    /// Wakes the pendulums on joints that begin to move or have jumped, which are in ascending order.
    fn follow(&mut self, world: &mut World<T>, joints: &[(u32, Course)]);
    /// Wakes all sleeping pendulums.
    fn wake_all(&mut self, world: &mut World<T>);
    /// Discards the sleep criteria.
    fn forget_criteria(&mut self);
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> AnyGroup<T> for Group<S, T, N> {
    fn run(&mut self, world: &World<T>, ticks: usize, fork: bool, failed: &mut Vec<Failed>) {
        for bucket in &mut self.buckets {
            bucket.run(&self.prototype, world, ticks, fork, failed);
        }
    }

    fn fail(&mut self, world: &mut World<T>, id: u32, tick: i64) -> SceneFault {
        self.set_awake(world, id, false);
        self.status[id as usize] = SceneStatus::Failed;
        let t = world.clock.time(tick);
        let error = self.hung(world, &self.read(id)).fault(t);
        SceneFault { kind: S::FACTS.name, index: id, t, error }
    }

    fn awake(&self) -> (usize, usize) {
        (self.buckets.iter().map(|bucket| bucket.awake).sum(), self.table.len())
    }

    fn parameters(&self) -> &'static [&'static str] {
        S::FACTS.parameters
    }

    fn plan(&mut self, world: &World<T>, change: &Change<'_, T>) -> Result<usize, SceneError> {
        self.plan_for(world, change, 0..self.table.len() as u32)
    }

    fn commit(&mut self, world: &mut World<T>, change: &Change<'_, T>) {
        Group::commit(self, world, change);
    }

    fn save(&self) -> GroupState<T> {
        Group::save(self)
    }

    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError> {
        Group::accepts(self, state)
    }

    fn restore(&mut self, world: &mut World<T>, state: &GroupState<T>) {
        Group::restore(self, world, state);
    }

    fn gap(&self, state: &GroupState<T>) -> [f64; 2] {
        Group::gap(self, state)
    }

    fn sleep(&mut self, world: &mut World<T>, tolerance: Option<f64>) -> i64 {
        Group::sleep(self, world, tolerance)
    }

    fn follow(&mut self, world: &mut World<T>, joints: &[(u32, Course)]) {
        Group::follow(self, world, joints);
    }

    fn wake_all(&mut self, world: &mut World<T>) {
        self.alarms.clear();
        for id in 0..self.table.len() as u32 {
            self.wake(world, id);
        }
    }

    fn forget_criteria(&mut self) {
        self.criteria.clear();
    }
}
