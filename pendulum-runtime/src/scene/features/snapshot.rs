//! Everything that changes while a scene runs, as plain numbers.

use crate::real::{Float, Lane, Real};
use crate::scene::error::{Failure, SceneError};
use crate::scene::features::hash;
use crate::scene::group::members::{Group, Status};
use crate::scene::lanes::bucket::{Extra, Kind, Loose, still};
use crate::scene::lanes::system::{Hung, Known};
use crate::scene::sampling::joint::Place;
use crate::scene::sampling::scheme::{Grid, MOST_SUBSTEPS, Scheme};
use crate::scene::scene::Scene;

/// The state of a scene: time, states, parameters, damping, stops, who sleeps and who has failed.
///
/// Motions and the list of joints and pendulums are not in it: it is restored to the scene that it
/// was taken of, or to one that was built in the same way. Written to a file, it keeps who has
/// failed and not why: [`Scene::failures`] is empty after it was read. With `serde_json` the bits
/// stay what they are if its feature `float_roundtrip` is on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot<T> {
    /// Tick, tick at which the sum of frame times began, that sum in two words.
    clock: (i64, i64, [f64; 2]),
    groups: Vec<GroupState<T>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    failures: Vec<Failure>,
}

/// The state of all pendulums of a type, in the order of hanging.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GroupState<T> {
    kind: String,
    pendulums: Vec<(Scheme, u32, Status)>,
    /// Parameters, states and extras of one pendulum after the other.
    numbers: Vec<T>,
}

/// The time of a tick beyond these is no longer exact.
const MOST_TICKS: u64 = 1 << 53;

/// Stands for infinity in snapshots, as some formats know no infinite numbers.
fn most<T: Float>() -> T {
    T::from_f64(f64::from(f32::MAX))
}

/// The numbers of a pendulum beside its parameters.
const fn numbers(coordinates: usize) -> usize {
    6 * coordinates + 2 * coordinates + 4
}

pub(crate) fn save<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    group: &Group<S, T, N>,
) -> GroupState<T> {
    let count = group.table.len();
    let mut state = GroupState {
        kind: S::FACTS.name.to_owned(),
        pendulums: Vec::with_capacity(count),
        numbers: Vec::with_capacity(count * (S::FACTS.parameters.len() + numbers(N))),
    };
    for (index, location) in group.table.iter().enumerate() {
        let bucket = &group.buckets[location.bucket as usize];
        let Grid { scheme, substeps } = bucket.kind.grid;
        state.pendulums.push((scheme, substeps, group.status[index]));
        let (extra, values) = bucket.numbers(location.slot as usize);
        state.numbers.extend(bucket.parameters_of(location.slot as usize));
        state.numbers.extend(values.iter().flatten());
        state.numbers.extend(
            extra
                .low
                .iter()
                .chain(&extra.high)
                .map(|&limit| Real::max(Real::min(limit, most()), -most::<T>())),
        );
        state.numbers.extend([extra.damping, extra.restitution, extra.stiffness, extra.hard]);
    }
    state
}

pub(crate) fn accepts<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    group: &Group<S, T, N>,
    state: &GroupState<T>,
) -> Result<(), SceneError> {
    if state.kind != S::FACTS.name {
        return Err(SceneError::Snapshot("the types of its pendulums differ"));
    }
    let count = group.table.len();
    let (parameters, width) = (S::FACTS.parameters.len(), S::FACTS.parameters.len() + numbers(N));
    if state.pendulums.len() != count || state.numbers.len() != count * width {
        return Err(SceneError::Snapshot("the numbers of its pendulums differ"));
    }
    let suits = |scheme, substeps: u32| {
        (scheme == Scheme::Rk4 || Known::<S, N>::SPLITS)
            && substeps <= MOST_SUBSTEPS
            && substeps.is_power_of_two()
    };
    if !state.pendulums.iter().all(|&(scheme, substeps, _)| suits(scheme, substeps)) {
        return Err(SceneError::Snapshot("it holds steps that its pendulums cannot take"));
    }
    // Parameters may be what they like: a pendulum that fails for them can be saved, too.
    if state
        .numbers
        .chunks_exact(width)
        .any(|numbers| numbers[parameters..].iter().any(|number| !number.is_finite()))
    {
        return Err(SceneError::Snapshot("it holds a state that is not finite"));
    }
    Ok(())
}

pub(crate) fn restore<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    group: &mut Group<S, T, N>,
    places: &[Place<T>],
    state: &GroupState<T>,
) {
    let zero = T::from_f64(0.0);
    let mut rest = &state.numbers[..];
    let mut take = |count: usize| {
        let (here, after) = rest.split_at(count);
        rest = after;
        here
    };
    for (id, &(scheme, substeps, status)) in (0..).zip(&state.pendulums) {
        let parameters = take(S::FACTS.parameters.len()).to_vec();
        let mut array = || -> [T; N] {
            let mut values = [zero; N];
            values.copy_from_slice(take(N));
            values
        };
        let numbers = core::array::from_fn(|_| array());
        let mut limits = || {
            array().map(|limit| {
                if limit.abs() < most() { limit } else { limit * T::from_f64(f64::INFINITY) }
            })
        };
        let (low, high) = (limits(), limits());
        let last = take(4);
        let extra = Extra {
            damping: last[0],
            low,
            high,
            restitution: last[1],
            stiffness: last[2],
            hard: last[3],
        };
        let joints = group.joints(id).to_vec();
        let kind = Kind { grid: Grid { scheme, substeps }, still: still(places, &joints) };
        let loose = Loose { id, joints, parameters, state: numbers, extra };
        let location = group.table[id as usize];
        if group.buckets[location.bucket as usize].kind == kind {
            group.write(&loose);
        } else {
            group.remove(id);
            group.insert(kind, &loose);
        }
        group.status[id as usize] = status;
        group.set_awake(id, status == Status::Awake);
    }
    group.reset_alarms();
    group.beds.clear();
}

/// The largest differences of coordinates and of velocities.
pub(crate) fn gap<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    group: &Group<S, T, N>,
    state: &GroupState<T>,
) -> [f64; 2] {
    let count = S::FACTS.parameters.len();
    let mut gap = [0.0f64; 2];
    for (id, numbers) in
        (0..group.table.len() as u32).zip(state.numbers.chunks_exact(count + numbers(N)))
    {
        let [_, (q, v)] = group.states(id);
        // Coordinates and velocities stand before their low words.
        for i in 0..N {
            gap[0] = gap[0].max((q[i] - numbers[count + i]).to_f64().abs());
            gap[1] = gap[1].max((v[i] - numbers[count + 2 * N + i]).to_f64().abs());
        }
    }
    gap
}

impl<T> Snapshot<T> {
    pub(crate) fn groups(&self) -> &[GroupState<T>] {
        &self.groups
    }
}

impl<T: Lane + Float> Scene<T> {
    /// Everything that changes while the scene runs.
    pub fn snapshot(&self) -> Snapshot<T> {
        let groups = self.groups.iter().map(|(_, group)| group.save()).collect();
        Snapshot { clock: self.clock.state(), groups, failures: self.failures.clone() }
    }

    /// Puts the scene back to where a snapshot was taken; what follows has the same bits as it had
    /// then.
    ///
    /// # Errors
    /// A snapshot of another scene, or one that was damaged.
    pub fn restore(&mut self, snapshot: &Snapshot<T>) -> Result<(), SceneError> {
        if snapshot.groups.len() != self.groups.len() {
            return Err(SceneError::Snapshot("the numbers of types differ"));
        }
        for ((_, group), state) in self.groups.iter().zip(&snapshot.groups) {
            group.accepts(state)?;
        }
        let (tick, origin, asked) = snapshot.clock;
        if MOST_TICKS < tick.unsigned_abs().max(origin.unsigned_abs())
            || asked.iter().any(|asked| !asked.is_finite())
        {
            return Err(SceneError::Snapshot("it holds a time that is out of range"));
        }
        self.clock.restore(snapshot.clock);
        for ((_, group), state) in self.groups.iter_mut().zip(&snapshot.groups) {
            group.restore(&self.places, state);
        }
        self.failures.clone_from(&snapshot.failures);
        self.dirty = true;
        Ok(())
    }

    /// A number that two scenes share that are in the same state at the same tick, to the last bit,
    /// whatever the frames were.
    pub fn checksum(&self) -> u64 {
        self.snapshot().checksum()
    }
}

impl<T: Real + Float> Snapshot<T> {
    /// A number that two snapshots share whose tick and states are the same to the last bit; the
    /// part of a tick that frames have asked for beyond does not count.
    pub fn checksum(&self) -> u64 {
        let mut hash = hash::Hash::new();
        hash.add(self.clock.0 as u64);
        for group in &self.groups {
            hash.add(group.pendulums.len() as u64);
            for &(scheme, substeps, status) in &group.pendulums {
                let (status, tick) = match status {
                    Status::Awake => (0, 0),
                    Status::Asleep(tick) => (1, tick),
                    Status::Hidden(tick) => (2, tick),
                    Status::Failed => (3, 0),
                };
                hash.add(scheme as u64 | u64::from(substeps) << 8 | status << 40);
                hash.add(tick as u64);
            }
            for number in &group.numbers {
                hash.add(number.to_f64().to_bits());
            }
        }
        hash.value()
    }
}
