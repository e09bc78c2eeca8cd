//! All pendulums of one type.

use crate::motion::Side;
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::constraints::OnJoints;
use crate::scene::group::criterion::{Alarms, SleepCriterion};
use crate::scene::group::joints::inputs_at;
use crate::scene::group::status::SceneStatus;
use crate::scene::group::{frequency, rest};
use crate::scene::lanes::bucket::{Bucket, Kind};
use crate::scene::lanes::detached::Detached;
use crate::scene::lanes::limits::Limits;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::{JointSlot, still};
use crate::scene::sampling::scheme::{Grid, MOST_SUBSTEPS, Scheme};
use crate::scene::system::SceneSystem;
use crate::system::Purpose;
use crate::time::Time;

/// The place of a pendulum in its group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Location {
    pub(crate) bucket: u32,
    pub(crate) slot: u32,
}

/// All pendulums of one type.
pub(crate) struct Group<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) prototype: S,
    /// The method set by the user, if any.
    pub(crate) scheme: Option<Scheme>,
    pub(crate) buckets: Vec<Bucket<S, T, N>>,
    pub(crate) table: Vec<Location>,
    pub(crate) status: Vec<SceneStatus>,
    /// The relative phase error for which the steps of each pendulum are chosen.
    tolerances: Vec<f64>,
    pub(crate) alarms: Alarms,
    /// The sleep criterion of each pendulum, computed on first use.
    pub(crate) criteria: Vec<Option<SleepCriterion<T, N>>>,
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Group<S, T, N> {
    pub(crate) fn new(prototype: S) -> Self {
        Self {
            prototype,
            scheme: None,
            buckets: Vec::new(),
            table: Vec::new(),
            status: Vec::new(),
            tolerances: Vec::new(),
            alarms: Alarms::new(),
            criteria: Vec::new(),
        }
    }

    /// Hangs a pendulum, which is awake, on joints and returns its index.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast.
    pub(crate) fn hang(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        joints: Vec<u32>,
        system: &S,
        tolerance: f64,
        [q, v]: [[T; N]; 2],
    ) -> Result<u32, SceneError> {
        let id = self.table.len() as u32;
        let zero = [T::from_f64(0.0); N];
        let mut parameters = Vec::with_capacity(S::FACTS.parameters.len());
        system.map(|parameter| {
            parameters.push(parameter);
            parameter
        });
        let detached = Detached {
            id,
            joints,
            parameters,
            state: [q, zero, v, zero, q, v],
            limits: Limits::none(),
        };
        let kind = self.kind(clock, joint_slots, system, &detached, tolerance)?;
        self.table.push(Location { bucket: 0, slot: 0 });
        self.status.push(SceneStatus::Awake);
        self.tolerances.push(tolerance);
        self.insert(kind, &detached);
        self.set_awake(id, true);
        Ok(id)
    }

    /// Returns the kind of a pendulum: its steps, and `true` if its joints rest for ever.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast in its current state. If only its neighbourhood
    /// is too fast, it takes `MOST_SUBSTEPS` steps.
    fn kind(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        system: &S,
        detached: &Detached<T, N>,
        tolerance: f64,
    ) -> Result<Kind, SceneError> {
        let t = clock.time(clock.tick());
        let inputs = inputs_at::<S, T, N>(
            joint_slots,
            &detached.joints,
            Time::new(t),
            Side::After,
            Purpose::Accelerations,
            true,
        );
        // A soft stop adds a frequency.
        let stop = detached.limits.stiffness.to_f64().sqrt();
        let [here, nearby] =
            frequency::fastest(system, T::from_f64(t), &detached.state[0], &inputs)
                .map(|omega| omega.max(stop));
        let grid = |omega: f64| Grid::of(&S::FACTS, self.scheme, omega * clock.step(), tolerance);
        let grid = match (grid(here), grid(nearby)) {
            (Some(_), Some(grid)) => grid,
            (Some(grid), None) => Grid { substeps: MOST_SUBSTEPS, ..grid },
            (None, _) => {
                return Err(SceneError::Frequency {
                    kind: S::FACTS.name,
                    index: detached.id,
                    frequency: here,
                    step: clock.step(),
                    tolerance,
                });
            }
        };
        Ok(Kind { grid, still: still(joint_slots, &detached.joints) })
    }

    /// Returns the kind of a pendulum of this group.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast or a mass is negative.
    pub(in crate::scene) fn checked_kind(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        detached: &Detached<T, N>,
    ) -> Result<Kind, SceneError> {
        let (system, joints) = (self.system_of(&detached.parameters), &detached.joints[..]);
        let [q, _, v, ..] = &detached.state;
        let on_joints = OnJoints { system: &system, joint_slots, joints };
        on_joints.check_inertia(clock.time(clock.tick()), q, v)?;
        let tolerance = self.tolerances[detached.id as usize];
        self.kind(clock, joint_slots, &system, detached, tolerance)
    }

    /// Returns an error if a pendulum on `joint` is too fast for its motion.
    pub(super) fn accepts_steps(
        &self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        joint: u32,
    ) -> Result<(), SceneError> {
        let mut ids = (0..self.table.len() as u32).filter(|&id| self.joints(id).contains(&joint));
        ids.try_for_each(|id| self.checked_kind(clock, joint_slots, &self.read(id)).map(drop))
    }

    /// Adds a pendulum to its bucket, among the pendulums that are not computed.
    pub(crate) fn insert(&mut self, kind: Kind, detached: &Detached<T, N>) {
        let bucket =
            self.buckets.iter().position(|bucket| bucket.kind == kind).unwrap_or_else(|| {
                self.buckets.push(Bucket::new(kind));
                self.buckets.len() - 1
            });
        let slot = self.buckets[bucket].push(&self.prototype, detached);
        self.table[detached.id as usize] = Location { bucket: bucket as u32, slot: slot as u32 };
    }

    /// Removes a pendulum from its bucket; `insert` adds it again.
    pub(crate) fn remove(&mut self, id: u32) -> Detached<T, N> {
        self.set_awake(id, false);
        let Location { bucket, slot } = self.table[id as usize];
        let last = self.buckets[bucket as usize].len - 1;
        self.swap(bucket as usize, slot as usize, last);
        let detached = self.buckets[bucket as usize].read(last);
        self.buckets[bucket as usize].pop();
        detached
    }

    /// Moves a pendulum to the computed pendulums of its bucket, or to the others.
    pub(crate) fn set_awake(&mut self, id: u32, awake: bool) {
        let Location { bucket, slot } = self.table[id as usize];
        let (index, slot) = (bucket as usize, slot as usize);
        let bucket = &mut self.buckets[index];
        if (slot < bucket.awake) == awake {
            return;
        }
        let track =
            bucket.blocks[slot / crate::scene::system::W].track[slot % crate::scene::system::W];
        bucket.tracks.count_awake(track, awake);
        if awake {
            bucket.awake += 1;
        } else {
            bucket.awake -= 1;
        }
        let other = if awake { bucket.awake - 1 } else { bucket.awake };
        self.swap(index, slot, other);
    }

    fn swap(&mut self, bucket: usize, a: usize, b: usize) {
        self.buckets[bucket].swap(a, b);
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
    pub(crate) fn write(&mut self, detached: &Detached<T, N>) {
        let Location { bucket, slot } = self.table[detached.id as usize];
        self.buckets[bucket as usize].write(slot as usize, detached);
    }

    /// Writes a pendulum, and moves it to another bucket if its steps have changed.
    ///
    /// # Errors
    /// Returns an error if the pendulum is too fast or a mass is negative; the pendulum stays
    /// unchanged.
    pub(crate) fn rewrite(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        detached: &Detached<T, N>,
    ) -> Result<(), SceneError> {
        let kind = self.checked_kind(clock, joint_slots, detached)?;
        if self.buckets[self.table[detached.id as usize].bucket as usize].kind == kind {
            self.write(detached);
            return Ok(());
        }
        let awake = self.is_awake(detached.id);
        self.remove(detached.id);
        self.insert(kind, detached);
        self.set_awake(detached.id, awake);
        Ok(())
    }

    /// Wakes a pendulum if it sleeps.
    pub(crate) fn wake(&mut self, id: u32) {
        if let SceneStatus::Asleep(_) = self.status[id as usize] {
            self.status[id as usize] = SceneStatus::Awake;
            self.set_awake(id, true);
        }
    }

    /// Returns the coordinates at which a pendulum comes to rest, with its joints fixed at their
    /// positions at `t`.
    pub(crate) fn rest_of(
        &self,
        joint_slots: &[JointSlot<T>],
        detached: &Detached<T, N>,
        t: f64,
    ) -> Option<[T; N]> {
        let system = self.system_of(&detached.parameters);
        let inputs = inputs_at::<S, T, N>(
            joint_slots,
            &detached.joints,
            Time::new(t),
            Side::After,
            Purpose::Accelerations,
            true,
        );
        let t = T::from_f64(t);
        let [_, nearby] = frequency::fastest(&system, t, &detached.state[0], &inputs);
        let omega = nearby.max(detached.limits.stiffness.to_f64().sqrt());
        rest::rest(&system, t, &detached.state[0], &inputs, omega, &detached.limits)
    }

    /// Sets a pendulum to its state of rest, and wakes it if it has failed.
    pub(crate) fn rest(
        &mut self,
        clock: &Clock,
        joint_slots: &[JointSlot<T>],
        id: u32,
    ) -> Result<(), SceneError> {
        let mut detached = self.read(id);
        let missing = SceneError::Restless { kind: S::FACTS.name, index: id };
        let q = self.rest_of(joint_slots, &detached, clock.time(clock.tick())).ok_or(missing)?;
        let zero = [T::from_f64(0.0); N];
        detached.state = [q, zero, zero, zero, q, zero];
        self.write(&detached);
        if self.status[id as usize] == SceneStatus::Failed {
            self.status[id as usize] = SceneStatus::Awake;
            self.set_awake(id, true);
        }
        Ok(())
    }

    /// Returns the system with the given parameters.
    pub(crate) fn system_of(&self, parameters: &[T]) -> S {
        let mut parameters = parameters.iter();
        self.prototype.map(|parameter| parameters.next().copied().unwrap_or(parameter))
    }

    /// Returns the states of a pendulum one tick ago and now.
    pub(crate) fn states(&self, id: u32) -> [([T; N], [T; N]); 2] {
        let Location { bucket, slot } = self.table[id as usize];
        let (block, lane) = (
            &self.buckets[bucket as usize].blocks[slot as usize / crate::scene::system::W],
            slot as usize % crate::scene::system::W,
        );
        let before =
            [&block.before[0], &block.before[1]].map(|lanes| lanes.map(|lanes| lanes.0[lane]));
        [(before[0], before[1]), block.state(lane)]
    }
}
