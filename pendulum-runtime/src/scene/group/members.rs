//! All pendulums of one type.

use crate::error::{Coordinate, Error, Quantity};
use crate::integrate::blame::suspects;
use crate::integrate::field::{coordinate, first_in_inputs};
use crate::motion::{Orders, Side};
use crate::real::{Float, Lane};
use crate::scene::error::{Failure, SceneError};
use crate::scene::features::commands::Carry;
use crate::scene::features::sleep::{Alarms, Bed};
use crate::scene::features::snapshot::{self, GroupState};
use crate::scene::group::frequency;
use crate::scene::group::rest;
use crate::scene::lanes::bucket::{self, Bucket, Extra, Failed, Kind, Loose};
use crate::scene::lanes::system::{Hung, Layout};
use crate::scene::sampling::assemble::{Assemble, By};
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::Place;
use crate::scene::sampling::scheme::{Grid, MOST_SUBSTEPS, Scheme};
use crate::scene::sampling::tracks::Sampled;
use crate::system::{Purpose, scalar_time};
use crate::time::Time;
use core::any::Any;
use core::cmp::Reverse;

/// All pendulums of the type `S`, as the scene sees them.
pub(crate) trait AnyGroup<T>: Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    /// Tells `visit` every joint that somebody awake hangs on, with what is needed of it and when.
    fn needs(&self, visit: &mut dyn FnMut(u32, Orders, Grid));
    /// Makes ready for a batch.
    fn settle(&mut self, clock: &Clock);
    /// Goes through a batch.
    fn run(&mut self, sampled: &Sampled<'_, T>, fork: bool, failed: &mut Vec<Failed>);
    /// Takes a pendulum that has failed in a tick away from those that are computed, and says why
    /// it failed.
    fn fail(&mut self, clock: &Clock, places: &[Place<T>], id: u32, tick: i64) -> Failure;
    /// All that changes while running.
    fn save(&self) -> GroupState<T>;
    /// Whether a saved state belongs to this group; what differs if not.
    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError>;
    /// The largest differences of coordinates and of velocities from a saved state.
    fn gap(&self, state: &GroupState<T>) -> [f64; 2];
    /// Lets all pendulums hang at rest.
    fn reset(&mut self, clock: &Clock, places: &[Place<T>]) -> Result<(), SceneError>;
    /// Whether a motion has what those on a joint need.
    fn accepts_motion(&self, joint: u32, has: Orders) -> Result<(), SceneError>;
    /// A joint has another motion than `before`.
    fn moved(
        &mut self,
        clock: &Clock,
        before: &[Place<T>],
        places: &[Place<T>],
        joint: u32,
        carry: Carry,
    ) -> Result<(), SceneError>;
    /// Sets a parameter of all, if they have it.
    fn set_parameter(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        name: &str,
        value: T,
    ) -> Option<usize>;
    /// Wakes those whose time has come; whether there were any.
    fn ring(&mut self, tick: i64) -> bool;
    /// The tick at which somebody is to wake, far away if nobody is.
    fn next_alarm(&self) -> i64;
    /// Lets those fall asleep that may; whether there were any.
    fn lull(&mut self, clock: &Clock, places: &[Place<T>], tolerance: f64) -> bool;
    /// Forgets who may sleep.
    fn unmake_beds(&mut self);
    /// Those that are computed, and all.
    fn awake(&self) -> (usize, usize);
    /// Puts back what was saved.
    fn restore(&mut self, places: &[Place<T>], state: &GroupState<T>);
}

/// Where a pendulum is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Location {
    pub(crate) bucket: u32,
    pub(crate) slot: u32,
}

/// What a pendulum is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// It swings.
    Awake,
    /// It rests until the tick given, or until somebody wakes it.
    Asleep(i64),
    /// It has been taken off the screen at the tick given.
    Hidden(i64),
    /// Its state has ceased to be finite; it hangs where it was last good.
    Failed,
}

/// All pendulums of one type.
pub(crate) struct Group<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) prototype: S,
    /// The method that somebody has chosen.
    pub(crate) scheme: Option<Scheme>,
    pub(crate) buckets: Vec<Bucket<S, T, N>>,
    pub(crate) table: Vec<Location>,
    pub(crate) status: Vec<Status>,
    /// The relative errors of the phase that steps are chosen by.
    tolerances: Vec<f64>,
    pub(crate) alarms: Alarms,
    /// By pendulum, once somebody has looked.
    pub(crate) beds: Vec<Option<Bed<T, N>>>,
}

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Group<S, T, N> {
    pub(crate) fn new(prototype: S) -> Self {
        Self {
            prototype,
            scheme: None,
            buckets: Vec::new(),
            table: Vec::new(),
            status: Vec::new(),
            tolerances: Vec::new(),
            alarms: Alarms::new(),
            beds: Vec::new(),
        }
    }

    /// Hangs a pendulum on joints; it is awake.
    pub(crate) fn hang(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        joints: Vec<u32>,
        system: &S,
        tolerance: f64,
        [q, v]: [[T; N]; 2],
    ) -> u32 {
        let id = self.table.len() as u32;
        let mut parameters = Vec::with_capacity(S::FACTS.parameters.len());
        system.mapped(|parameter| {
            parameters.push(parameter);
            parameter
        });
        let zero = [T::from_f64(0.0); N];
        let loose =
            Loose { id, joints, parameters, state: [q, zero, v, zero, q, v], extra: Extra::none() };
        self.table.push(Location { bucket: 0, slot: 0 });
        self.status.push(Status::Awake);
        self.tolerances.push(tolerance);
        let kind = self.kind(clock, places, system, &loose);
        self.insert(kind, &loose);
        self.set_awake(id, true);
        id
    }

    /// What the pendulum has in common with others.
    pub(crate) fn kind(
        &self,
        clock: &Clock,
        places: &[Place<T>],
        system: &S,
        loose: &Loose<T, N>,
    ) -> Kind {
        let t = clock.time(clock.tick());
        let inputs = inputs_at::<S, T, N>(
            places,
            &loose.joints,
            Time::new(t),
            Side::After,
            Purpose::Accelerations,
            true,
        );
        let omega = frequency::fastest(system, T::from_f64(t), &loose.state[0], &inputs);
        // A soft stop swings too.
        let phase = omega.max(loose.extra.stiffness.to_f64().sqrt()) * clock.step();
        let tolerance = self.tolerances[loose.id as usize];
        let grid = match self.scheme {
            Some(scheme) => Grid { scheme, substeps: scheme.substeps(phase, tolerance) },
            None => Scheme::cheapest(&S::FACTS, phase, tolerance),
        };
        debug_assert!(grid.substeps <= MOST_SUBSTEPS);
        Kind { grid, still: bucket::still(places, &loose.joints) }
    }

    /// Puts a pendulum into its bucket, asleep.
    pub(crate) fn insert(&mut self, kind: Kind, loose: &Loose<T, N>) {
        let bucket =
            self.buckets.iter().position(|bucket| bucket.kind == kind).unwrap_or_else(|| {
                self.buckets.push(Bucket::new(kind));
                self.buckets.len() - 1
            });
        let slot = self.buckets[bucket].push(&self.prototype, loose);
        self.table[loose.id as usize] = Location { bucket: bucket as u32, slot: slot as u32 };
    }

    /// Takes a pendulum out of its bucket; `insert` puts it back.
    pub(crate) fn remove(&mut self, id: u32) -> Loose<T, N> {
        self.set_awake(id, false);
        let Location { bucket, slot } = self.table[id as usize];
        let last = self.buckets[bucket as usize].len - 1;
        self.swap(bucket as usize, slot as usize, last);
        let loose = self.buckets[bucket as usize].read(last);
        self.buckets[bucket as usize].pop();
        loose
    }

    /// Moves a pendulum among those that are computed, or away from them.
    pub(crate) fn set_awake(&mut self, id: u32, awake: bool) {
        let Location { bucket, slot } = self.table[id as usize];
        let (index, slot) = (bucket as usize, slot as usize);
        let bucket = &mut self.buckets[index];
        if (slot < bucket.awake) == awake {
            return;
        }
        let track = bucket.blocks[slot / crate::scene::lanes::system::W].track
            [slot % crate::scene::lanes::system::W];
        bucket.tracks.stir(track, awake);
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

    /// The joints of a pendulum.
    pub(crate) fn joints(&self, id: u32) -> &[u32] {
        let Location { bucket, slot } = self.table[id as usize];
        self.buckets[bucket as usize].joints(slot as usize)
    }

    /// A pendulum with all that belongs to it.
    pub(crate) fn read(&self, id: u32) -> Loose<T, N> {
        let Location { bucket, slot } = self.table[id as usize];
        self.buckets[bucket as usize].read(slot as usize)
    }

    /// Writes a pendulum back to where it is.
    pub(crate) fn write(&mut self, loose: &Loose<T, N>) {
        let Location { bucket, slot } = self.table[loose.id as usize];
        self.buckets[bucket as usize].write(slot as usize, loose);
    }

    /// Writes a pendulum back that may need other steps than before.
    pub(crate) fn rewrite(&mut self, clock: &Clock, places: &[Place<T>], loose: &Loose<T, N>) {
        let system = self.system_of(&loose.parameters);
        let kind = self.kind(clock, places, &system, loose);
        if self.buckets[self.table[loose.id as usize].bucket as usize].kind == kind {
            return self.write(loose);
        }
        let awake = self.is_awake(loose.id);
        self.remove(loose.id);
        self.insert(kind, loose);
        self.set_awake(loose.id, awake);
    }

    /// Wakes a pendulum that sleeps.
    pub(crate) fn rouse(&mut self, id: u32) {
        if let Status::Asleep(_) = self.status[id as usize] {
            self.status[id as usize] = Status::Awake;
            self.set_awake(id, true);
        }
    }

    /// Where a pendulum comes to rest with its joints at rest where they are at `t`.
    pub(crate) fn rest_of(
        &self,
        places: &[Place<T>],
        loose: &Loose<T, N>,
        t: f64,
    ) -> Option<[T; N]> {
        let system = self.system_of(&loose.parameters);
        let inputs = inputs_at::<S, T, N>(
            places,
            &loose.joints,
            Time::new(t),
            Side::After,
            Purpose::Accelerations,
            true,
        );
        let t = T::from_f64(t);
        let omega = frequency::fastest(&system, t, &loose.state[0], &inputs)
            .max(loose.extra.stiffness.to_f64().sqrt());
        rest::rest(&system, t, &loose.state[0], &inputs, omega, &loose.extra)
    }

    /// Lets a pendulum hang at rest; one that has failed swings again.
    pub(crate) fn rest(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        id: u32,
    ) -> Result<(), SceneError> {
        let mut loose = self.read(id);
        let missing = SceneError::Restless { kind: S::FACTS.name, index: id };
        let q = self.rest_of(places, &loose, clock.time(clock.tick())).ok_or(missing)?;
        let zero = [T::from_f64(0.0); N];
        loose.state = [q, zero, zero, zero, q, zero];
        self.write(&loose);
        if self.status[id as usize] == Status::Failed {
            self.status[id as usize] = Status::Awake;
            self.set_awake(id, true);
        }
        Ok(())
    }

    /// The system with these parameters.
    pub(crate) fn system_of(&self, parameters: &[T]) -> S {
        let mut parameters = parameters.iter();
        self.prototype.mapped(|parameter| parameters.next().copied().unwrap_or(parameter))
    }

    /// The state of a pendulum now and one tick before.
    pub(crate) fn states(&self, id: u32) -> [([T; N], [T; N]); 2] {
        let Location { bucket, slot } = self.table[id as usize];
        let (block, lane) = (
            &self.buckets[bucket as usize].blocks[slot as usize / crate::scene::lanes::system::W],
            slot as usize % crate::scene::lanes::system::W,
        );
        let before =
            [&block.before[0], &block.before[1]].map(|lanes| lanes.map(|lanes| lanes.0[lane]));
        [(before[0], before[1]), block.state(lane)]
    }
}

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> AnyGroup<T> for Group<S, T, N> {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn needs(&self, visit: &mut dyn FnMut(u32, Orders, Grid)) {
        for bucket in self.buckets.iter().filter(|bucket| !bucket.kind.still && bucket.awake != 0) {
            bucket
                .tracks
                .needs(S::FACTS.inputs, |joint, orders| visit(joint, orders, bucket.kind.grid));
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

    fn fail(&mut self, clock: &Clock, places: &[Place<T>], id: u32, tick: i64) -> Failure {
        self.set_awake(id, false);
        self.status[id as usize] = Status::Failed;
        let loose = self.read(id);
        let t = clock.time(tick);
        let error = blame(&self.system_of(&loose.parameters), places, &loose, t);
        Failure { kind: S::FACTS.name, index: id, t, error }
    }

    fn save(&self) -> GroupState<T> {
        snapshot::save(self)
    }

    fn ring(&mut self, tick: i64) -> bool {
        self.wake_up_to(tick)
    }

    fn next_alarm(&self) -> i64 {
        self.alarms.peek().map_or(i64::MAX, |Reverse((tick, _))| *tick)
    }

    fn lull(&mut self, clock: &Clock, places: &[Place<T>], tolerance: f64) -> bool {
        self.fall_asleep(clock, places, tolerance)
    }

    fn unmake_beds(&mut self) {
        self.beds.clear();
    }

    fn awake(&self) -> (usize, usize) {
        (self.buckets.iter().map(|bucket| bucket.awake).sum(), self.table.len())
    }

    fn gap(&self, state: &GroupState<T>) -> [f64; 2] {
        snapshot::gap(self, state)
    }

    fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError> {
        snapshot::accepts(self, state)
    }

    fn reset(&mut self, clock: &Clock, places: &[Place<T>]) -> Result<(), SceneError> {
        (0..self.table.len() as u32).try_for_each(|id| self.rest(clock, places, id))
    }

    fn accepts_motion(&self, joint: u32, has: Orders) -> Result<(), SceneError> {
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

    fn moved(
        &mut self,
        clock: &Clock,
        before: &[Place<T>],
        places: &[Place<T>],
        joint: u32,
        carry: Carry,
    ) -> Result<(), SceneError> {
        let time = Time::new(clock.time(clock.tick()));
        for id in 0..self.table.len() as u32 {
            if !self.joints(id).contains(&joint) {
                continue;
            }
            let mut loose = self.read(id);
            if carry == Carry::Momentum {
                let inputs = |places, side| {
                    inputs_at::<S, T, N>(places, &loose.joints, time, side, Purpose::Momenta, false)
                };
                let (old, new) = (inputs(before, Side::Before), inputs(places, Side::After));
                let (system, t) = (self.system_of(&loose.parameters), scalar_time(time));
                let [q, _, v, ..] = loose.state;
                if old != new {
                    let after = system.velocities(t, &q, &system.momenta(t, &q, &v, &old), &new);
                    // One whose equations have no solution keeps its velocity, and fails in the
                    // next tick, which says why.
                    if after.iter().all(|v| v.is_finite()) {
                        (loose.state[2], loose.state[3]) = (after, [T::from_f64(0.0); N]);
                    }
                }
            }
            self.rewrite(clock, places, &loose);
            if carry == Carry::Rest {
                self.rest(clock, places, id)?;
            }
            self.rouse(id);
            self.unmake_bed(id);
        }
        Ok(())
    }

    fn set_parameter(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        name: &str,
        value: T,
    ) -> Option<usize> {
        let index = S::FACTS.parameters.iter().position(|parameter| *parameter == name)?;
        for id in 0..self.table.len() as u32 {
            let mut loose = self.read(id);
            loose.parameters[index] = value;
            self.rewrite(clock, places, &loose);
            self.rouse(id);
        }
        self.beds.clear();
        Some(self.table.len())
    }

    fn restore(&mut self, places: &[Place<T>], state: &GroupState<T>) {
        snapshot::restore(self, places, state);
    }
}

/// What is not finite in the tick that begins at `t` with the state of `loose`.
fn blame<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    system: &S,
    places: &[Place<T>],
    loose: &Loose<T, N>,
    t: f64,
) -> Error {
    let time = Time::new(t);
    let inputs = inputs_at::<S, T, N>(
        places,
        &loose.joints,
        time,
        Side::After,
        Purpose::Accelerations,
        false,
    );
    let [q, _, v, ..] = &loose.state;
    let mut what = first_in_inputs(&S::FACTS, &inputs);
    if what.is_none() {
        let a = system.accelerations(scalar_time(time), q, v, &inputs);
        what = a
            .iter()
            .position(|a| !a.is_finite())
            .map(|index| Quantity::Acceleration(coordinate(&S::FACTS, index)));
    }
    // Where the tick begins well, it is the velocity that grows beyond all bounds.
    let fastest = |i: &usize, j: &usize| v[*i].to_f64().abs().total_cmp(&v[*j].to_f64().abs());
    let what = what.unwrap_or_else(|| {
        Quantity::Velocity(coordinate(&S::FACTS, (0..N).max_by(fastest).unwrap_or(0)))
    });
    let suspects = if let Quantity::Acceleration(_) = what { suspects(system) } else { Vec::new() };
    Error::NotFinite { t, what, suspects }
}

/// The inputs of a system on joints, with what `purpose` needs; at rest if asked so: only the
/// positions then.
pub(crate) fn inputs_at<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    places: &[Place<T>],
    joints: &[u32],
    t: Time,
    side: Side,
    purpose: Purpose,
    at_rest: bool,
) -> S::Inputs {
    let components = <S::Inputs as Assemble<T>>::COMPONENTS;
    let layout = Layout::new(S::FACTS.inputs, components, purpose);
    let mut record = vec![T::from_f64(0.0); layout.width];
    let mut at = 0;
    for (input, &joint) in joints.iter().enumerate() {
        let drive = &places[joint as usize].drive;
        let orders = crate::motion::orders(S::FACTS.inputs, input, purpose);
        let own = components[input] * orders.count();
        if !at_rest {
            drive.sample(t, side, orders, &mut record[at..at + own]);
        } else if orders.contains(Orders::POSITION) {
            drive.sample(t, side, Orders::POSITION, &mut record[at..at + components[input]]);
        }
        at += own;
    }
    Assemble::assemble(&mut By(|input, derivative, component| {
        layout.place(input, derivative, component).map_or(T::from_f64(0.0), |place| record[place])
    }))
}

/// Whether a state is finite.
pub(crate) fn check_state<T: Float, const N: usize>(
    facts: &crate::system::Facts,
    values: &[T; N],
) -> Result<(), SceneError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            let name = facts.coordinates.get(index).copied().unwrap_or("");
            Err(SceneError::State {
                coordinate: Coordinate { index, name },
                value: values[index].to_f64(),
            })
        }
    }
}

/// Whether joints exist, move in as many dimensions as their inputs and have what the equations
/// need.
pub(crate) fn check_joints<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    places: &[Place<T>],
    joints: &[u32],
) -> Result<(), SceneError> {
    for (input, &joint) in joints.iter().enumerate() {
        let components = <S::Inputs as Assemble<T>>::COMPONENTS.get(input);
        let place = places
            .get(joint as usize)
            .filter(|place| components == Some(&place.drive.components()));
        let place = place.ok_or(SceneError::Joint(joint))?;
        check_motion(&S::FACTS, input, place.drive.has())?;
    }
    Ok(())
}

/// Whether a motion has what the equations need of an input.
pub(crate) fn check_motion(
    facts: &crate::system::Facts,
    input: usize,
    has: Orders,
) -> Result<(), SceneError> {
    let needed = [Purpose::Accelerations, Purpose::Momenta]
        .map(|purpose| crate::motion::orders(facts.inputs, input, purpose));
    for derivative in 0..3 {
        let order = Orders::of(derivative);
        if needed.iter().any(|needed| needed.contains(order)) && !has.contains(order) {
            let input = facts.inputs.get(input).map_or("", |input| input.name);
            return Err(SceneError::Derivative { input, derivative });
        }
    }
    Ok(())
}
