//! All pendulums of one type.

use crate::error::SceneError;
use crate::group::criterion::{Alarms, SleepCriterion};
use crate::group::hung::Hung;
use crate::lanes::bucket::{Bucket, Detached};
use crate::sampling::carried::Place;
use crate::sampling::scheme::{Kind, Scheme};
use crate::sampling::world::World;
use crate::system::{SceneSystem, W};
use pendulum_core::scalar::Float;

/// The status of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SceneStatus {
    /// The pendulum is computed in every tick.
    Awake,
    /// The pendulum rests until the given tick, or until it is woken.
    Asleep(i64),
    /// The pendulum was hidden at the given tick and is not computed.
    Hidden(i64),
    /// The state is no longer finite; the pendulum keeps its last finite state.
    Failed,
}

/// The place of a pendulum in its group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Location {
    pub(crate) bucket: u32,
    pub(crate) slot: u32,
}

const NOWHERE: Location = Location { bucket: u32::MAX, slot: u32::MAX };

/// All pendulums of one type.
pub(crate) struct Group<S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) prototype: S,
    /// The index of the group in its scene.
    place: u32,
    /// The method set by the user, if any.
    pub(crate) scheme: Option<Scheme>,
    pub(crate) buckets: Vec<Bucket<S, T, N>>,
    /// The place of each pendulum; [`NOWHERE`] if it has been removed.
    pub(crate) table: Vec<Location>,
    /// For each index, the number of pendulums that have had it before.
    generations: Vec<u32>,
    /// The indices of removed pendulums, to be used again.
    free: Vec<u32>,
    pub(crate) status: Vec<SceneStatus>,
    /// The relative phase error for which the steps of each pendulum are chosen.
    tolerances: Vec<f64>,
    /// The changes of pendulums that `plan` has found possible.
    pub(super) planned: Vec<(Kind, Detached<T, N>)>,
    pub(crate) alarms: Alarms,
    /// The sleep criterion of each pendulum, computed on first use.
    pub(crate) criteria: Vec<Option<SleepCriterion<T, N>>>,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    pub(crate) fn new(prototype: S, place: usize) -> Self {
        Self {
            prototype,
            place: place as u32,
            scheme: None,
            buckets: Vec::new(),
            table: Vec::new(),
            generations: Vec::new(),
            free: Vec::new(),
            status: Vec::new(),
            tolerances: Vec::new(),
            planned: Vec::new(),
            alarms: Alarms::new(),
            criteria: Vec::new(),
        }
    }

    /// Adds a pendulum, which is awake, and returns its index and generation.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast.
    pub(crate) fn hang(
        &mut self,
        world: &mut World<T>,
        mut detached: Detached<T, N>,
        tolerance: f64,
    ) -> Result<(u32, u32), SceneError> {
        detached.id = self.free.last().copied().unwrap_or(self.table.len() as u32);
        let kind = self.hung(world, &detached).kind(self.scheme, tolerance)?;
        let index = detached.id as usize;
        if self.free.pop().is_none() {
            self.table.push(NOWHERE);
            self.generations.push(0);
            self.status.push(SceneStatus::Awake);
            self.tolerances.push(tolerance);
        }
        self.tolerances[index] = tolerance;
        for &joint in &detached.joints {
            world.carries[joint as usize].push((self.place, detached.id));
        }
        self.insert(world, kind, &detached);
        self.set_awake(world, detached.id, true);
        Ok((detached.id, self.generations[index]))
    }

    /// Removes a pendulum from the scene.
    pub(crate) fn take_down(&mut self, world: &mut World<T>, id: u32) {
        for &joint in self.joints(id) {
            let carried = &mut world.carries[joint as usize];
            if let Some(index) = carried.iter().position(|own| *own == (self.place, id)) {
                carried.swap_remove(index);
            }
        }
        self.remove(world, id);
        let index = id as usize;
        (self.table[index], self.status[index]) = (NOWHERE, SceneStatus::Awake);
        self.forget_criterion(id);
        // An index without a further generation is not used again.
        self.generations[index] += 1;
        if self.generations[index] < u32::MAX {
            self.free.push(id);
        }
    }

    /// Returns the generation of a pendulum; `None` if it has been removed.
    pub(crate) fn generation(&self, id: u32) -> Option<u32> {
        let location = self.table.get(id as usize)?;
        (*location != NOWHERE).then(|| self.generations[id as usize])
    }

    /// Returns the indices of all pendulums.
    pub(crate) fn ids(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.table).filter(|(_, location)| **location != NOWHERE).map(|(id, _)| id)
    }

    /// Returns a pendulum with its system on the joints of the scene.
    pub(crate) fn hung<'a>(
        &self,
        world: &'a World<T>,
        pendulum: &'a Detached<T, N>,
    ) -> Hung<'a, S, T, N> {
        Hung { system: self.system_of(&pendulum.parameters), world, pendulum }
    }

    /// Returns the kind of a pendulum of this group.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast or a mass is negative.
    pub(crate) fn kind(
        &self,
        world: &World<T>,
        detached: &Detached<T, N>,
    ) -> Result<Kind, SceneError> {
        self.hung(world, detached).kind(self.scheme, self.tolerances[detached.id as usize])
    }

    /// Adds a pendulum to its bucket, among the pendulums that are not computed.
    fn insert(&mut self, world: &mut World<T>, kind: Kind, detached: &Detached<T, N>) {
        let bucket =
            self.buckets.iter().position(|bucket| bucket.kind == kind).unwrap_or_else(|| {
                self.buckets.push(Bucket::new(kind, world));
                self.buckets.len() - 1
            });
        let slot = self.buckets[bucket].push(world, &self.prototype, detached);
        self.table[detached.id as usize] = Location { bucket: bucket as u32, slot: slot as u32 };
    }

    /// Removes a pendulum from its bucket; `insert` adds it again.
    fn remove(&mut self, world: &mut World<T>, id: u32) {
        self.set_awake(world, id, false);
        let Location { bucket, slot } = self.table[id as usize];
        let last = self.buckets[bucket as usize].len - 1;
        self.swap(world, bucket as usize, slot as usize, last);
        self.buckets[bucket as usize].pop();
    }

    /// Moves a pendulum to the computed pendulums of its bucket, or to the others.
    pub(crate) fn set_awake(&mut self, world: &mut World<T>, id: u32, awake: bool) {
        let Location { bucket, slot } = self.table[id as usize];
        let (index, slot) = (bucket as usize, slot as usize);
        let bucket = &mut self.buckets[index];
        if (slot < bucket.awake) == awake {
            return;
        }
        let track = bucket.blocks[slot / W].track[slot % W];
        world.tracks[bucket.tracks].count_awake(track, awake);
        if awake {
            bucket.awake += 1;
        } else {
            bucket.awake -= 1;
        }
        let other = if awake { bucket.awake - 1 } else { bucket.awake };
        self.swap(world, index, slot, other);
    }

    fn swap(&mut self, world: &mut World<T>, bucket: usize, a: usize, b: usize) {
        self.buckets[bucket].swap(world, a, b);
        for slot in [a, b] {
            let id = self.buckets[bucket].id(slot);
            self.table[id as usize].slot = slot as u32;
        }
    }

    pub(crate) fn is_awake(&self, id: u32) -> bool {
        let Location { bucket, slot } = self.table[id as usize];
        (slot as usize) < self.buckets[bucket as usize].awake
    }

    /// Returns the joints of a pendulum.
    pub(crate) fn joints(&self, id: u32) -> &[u32] {
        let Location { bucket, slot } = self.table[id as usize];
        self.buckets[bucket as usize].joints(slot as usize)
    }

    /// Returns a copy of a pendulum with its joints, parameters, state and limits.
    pub(crate) fn read(&self, id: u32) -> Detached<T, N> {
        let Location { bucket, slot } = self.table[id as usize];
        self.buckets[bucket as usize].read(slot as usize)
    }

    /// Writes a pendulum to its place.
    pub(crate) fn write(&mut self, world: &mut World<T>, detached: &Detached<T, N>) {
        let Location { bucket, slot } = self.table[detached.id as usize];
        self.buckets[bucket as usize].write(world, slot as usize, detached);
    }

    /// Writes a pendulum, and moves it to another bucket if its kind has changed.
    pub(crate) fn place(&mut self, world: &mut World<T>, kind: Kind, detached: &Detached<T, N>) {
        if self.kind_of(detached.id) == kind {
            self.write(world, detached);
            return;
        }
        let awake = self.is_awake(detached.id);
        self.remove(world, detached.id);
        self.insert(world, kind, detached);
        self.set_awake(world, detached.id, awake);
    }

    /// Returns the place of a pendulum among those that carry joints.
    pub(crate) fn place_of(&self, id: u32) -> Place {
        (self.kind_of(id).level, self.place, id)
    }

    /// Returns the kind of the bucket of a pendulum.
    pub(crate) fn kind_of(&self, id: u32) -> Kind {
        self.buckets[self.table[id as usize].bucket as usize].kind
    }

    /// Sets the components of the control inputs of a pendulum, and wakes it if one of them changes.
    pub(crate) fn set_controls(&mut self, world: &mut World<T>, id: u32, values: &[T]) {
        let Location { bucket, slot } = self.table[id as usize];
        if self.buckets[bucket as usize].set_controls(slot as usize, values) {
            self.forget_criterion(id);
            self.wake(world, id);
        }
    }

    /// Wakes a pendulum if it sleeps.
    pub(crate) fn wake(&mut self, world: &mut World<T>, id: u32) {
        if let SceneStatus::Asleep(_) = self.status[id as usize] {
            self.status[id as usize] = SceneStatus::Awake;
            self.set_awake(world, id, true);
        }
    }

    /// Returns the system with the given parameters.
    pub(crate) fn system_of(&self, parameters: &[T]) -> S {
        let mut parameters = parameters.iter();
        self.prototype.map(|parameter| parameters.next().copied().unwrap_or(parameter))
    }

    /// Returns the states of a pendulum one tick ago and now.
    pub(crate) fn states(&self, id: u32) -> [([T; N], [T; N]); 2] {
        let Location { bucket, slot } = self.table[id as usize];
        let blocks = &self.buckets[bucket as usize].blocks;
        let (block, lane) = (&blocks[slot as usize / W], slot as usize % W);
        let before =
            [&block.before[0], &block.before[1]].map(|lanes| lanes.map(|lanes| lanes.0[lane]));
        [(before[0], before[1]), block.state(lane)]
    }
}
