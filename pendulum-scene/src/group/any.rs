//! The interface between a scene and its groups.

use crate::error::{SceneError, SceneFault};
use crate::group::alone;
use crate::group::change::Change;
use crate::group::members::{Group, SceneStatus};
use crate::group::saved::GroupState;
use crate::lanes::bucket::{Bucket, Failed};
use crate::sampling::carried::Place;
use crate::sampling::live::Course;
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem};
use core::any::Any;
use pendulum_core::scalar::Float;

/// A group of pendulums whose type is erased.
pub(crate) trait AnyGroup<T>: Any + Send + Sync {
    /// Advances the awake pendulums of a level by a batch, and appends the lanes that fail to
    /// `failed`.
    fn run(
        &mut self,
        world: &World<T>,
        level: u32,
        ticks: usize,
        fork: bool,
        failed: &mut Vec<Failed>,
    );
    /// Returns the place of a pendulum among those that carry joints.
    fn place_of(&self, id: u32) -> Place;
    /// Removes a pendulum that has failed in a tick from the computed pendulums, and returns the
    /// fault.
    fn fail(&mut self, world: &mut World<T>, id: u32, tick: i64) -> SceneFault;
    /// Returns the generation of a pendulum; `None` if it has been removed.
    fn generation(&self, id: u32) -> Option<u32>;
    /// Returns the joints of a pendulum.
    fn joints(&self, id: u32) -> &[u32];
    /// Removes a pendulum.
    fn take_down(&mut self, world: &mut World<T>, id: u32);
    /// Returns the number of computed pendulums and the number of all pendulums.
    fn awake(&self) -> (usize, usize);
    /// Returns the name of the type.
    fn name(&self) -> &'static str;
    /// Returns the names of the parameters of the type.
    fn parameters(&self) -> &'static [&'static str];
    /// Plans a change of all pendulums, or of the given ones, and returns the number of those that
    /// it concerns.
    fn plan(
        &mut self,
        world: &World<T>,
        change: &Change<'_, T>,
        ids: Option<&[u32]>,
    ) -> Result<usize, SceneError>;
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
    /// Wakes a pendulum on a joint that begins to move or has jumped.
    fn follow(&mut self, world: &mut World<T>, id: u32, course: Course);
    /// Wakes all sleeping pendulums.
    fn wake_all(&mut self, world: &mut World<T>);
    /// Discards the sleep criteria.
    fn forget_criteria(&mut self);
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> AnyGroup<T> for Group<S, T, N> {
    fn run(
        &mut self,
        world: &World<T>,
        level: u32,
        ticks: usize,
        fork: bool,
        failed: &mut Vec<Failed>,
    ) {
        for bucket in self.buckets.iter_mut().filter(|bucket| bucket.kind.level == level) {
            if const { Layouts::<S, N>::LIMITED } {
                alone::run(bucket, &self.prototype, world, ticks, fork, failed);
                continue;
            }
            bucket.run(&self.prototype, world, ticks, fork, failed);
        }
        failed.retain_mut(|failed| !self.repeat(world, ticks, failed));
    }

    fn place_of(&self, id: u32) -> Place {
        Group::place_of(self, id)
    }

    fn fail(&mut self, world: &mut World<T>, id: u32, tick: i64) -> SceneFault {
        self.set_awake(world, id, false);
        self.status[id as usize] = SceneStatus::Failed;
        let t = world.clock.time(tick);
        let (detached, substeps) = (self.read(id), self.kind_of(id).grid.substeps);
        let hung = self.hung(world, &detached);
        let limited = if const { Layouts::<S, N>::LIMITED } { Some(&hung) } else { None };
        let error = limited.and_then(|hung| hung.failure(tick, substeps));
        let error = error.unwrap_or_else(|| hung.fault(t));
        SceneFault { kind: S::FACTS.name, index: id, t, error }
    }

    fn generation(&self, id: u32) -> Option<u32> {
        Group::generation(self, id)
    }

    fn joints(&self, id: u32) -> &[u32] {
        Group::joints(self, id)
    }

    fn take_down(&mut self, world: &mut World<T>, id: u32) {
        Group::take_down(self, world, id);
    }

    fn awake(&self) -> (usize, usize) {
        let count = |number: fn(&Bucket<S, T, N>) -> usize| self.buckets.iter().map(number).sum();
        (count(|bucket| bucket.awake), count(|bucket| bucket.len))
    }

    fn name(&self) -> &'static str {
        S::FACTS.name
    }

    fn parameters(&self) -> &'static [&'static str] {
        S::FACTS.parameters
    }

    fn plan(
        &mut self,
        world: &World<T>,
        change: &Change<'_, T>,
        ids: Option<&[u32]>,
    ) -> Result<usize, SceneError> {
        match ids {
            Some(ids) => self.plan_for(world, change, ids.iter().copied()),
            None => self.plan_for(world, change, 0..self.table.len() as u32),
        }
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

    fn follow(&mut self, world: &mut World<T>, id: u32, course: Course) {
        Group::follow(self, world, id, course);
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
