//! Saved states of groups, as plain numbers.

use crate::error::SceneError;
use crate::group::members::{Group, SceneStatus};
use crate::lanes::bucket::Detached;
use crate::lanes::limits::Limits;
use crate::sampling::scheme::{Grid, Kind, MOST_SUBSTEPS, Scheme};
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem};
use pendulum_core::integrate::limits::Standings;
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::System;

/// The state of all pendulums of a type, in the order of hanging.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct GroupState<T> {
    pub(crate) kind: String,
    /// The index and the generation of each pendulum.
    #[cfg_attr(feature = "serde", serde(default))]
    names: Vec<(u32, u32)>,
    pub(crate) pendulums: Vec<(Scheme, u32, SceneStatus)>,
    /// Parameters, control inputs, the states of limits of blocks, states and limits of coordinates,
    /// pendulum by pendulum.
    pub(crate) numbers: Vec<T>,
}

/// Returns the number that represents infinity in snapshots, because some formats do not support
/// infinities.
fn most<T: Float>() -> T {
    T::from_f64(f64::from(f32::MAX))
}

/// Returns the states of limits and frictions for which numbers stand.
fn known<S: System<N>, T: Float, const N: usize>(numbers: &[T]) -> Option<Standings> {
    Standings::from_codes(&S::FACTS, numbers.iter().map(|number| number.to_f64()))
}

/// Returns the length of the saved state and limits of a pendulum.
const fn numbers(coordinates: usize) -> usize {
    6 * coordinates + 2 * coordinates + 4
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    /// The number of saved numbers of a pendulum.
    const WIDTH: usize = Self::STATE + numbers(N);
    /// The number of those before the state.
    const STATE: usize = S::FACTS.parameters.len() + Layouts::<S, N>::CONTROLS + Self::STANDINGS;
    /// The number of those of limits and frictions.
    const STANDINGS: usize = S::FACTS.limits.len() + S::FACTS.frictions.len();

    /// Returns the index and the generation of each pendulum.
    fn names(&self) -> Vec<(u32, u32)> {
        self.ids().filter_map(|id| Some((id, self.generation(id)?))).collect()
    }

    /// Returns the state of all pendulums of the group.
    pub(super) fn save(&self) -> GroupState<T> {
        let names = self.names();
        let count = names.len();
        let mut state = GroupState {
            kind: S::FACTS.name.to_owned(),
            names,
            pendulums: Vec::with_capacity(count),
            numbers: Vec::with_capacity(count * Self::WIDTH),
        };
        for id in self.ids() {
            let (index, location) = (id as usize, self.table[id as usize]);
            let bucket = &self.buckets[location.bucket as usize];
            let Grid { scheme, substeps, .. } = bucket.kind.grid;
            state.pendulums.push((scheme, substeps, self.status[index]));
            let (limits, values) = bucket.numbers(location.slot as usize);
            state.numbers.extend(bucket.parameters_of(location.slot as usize));
            state.numbers.extend(bucket.controls_of(location.slot as usize));
            let standing = bucket.standing(location.slot as usize);
            state.numbers.extend(standing.codes(&S::FACTS).map(T::from_f64));
            state.numbers.extend(values.iter().flatten());
            state.numbers.extend(
                limits
                    .low
                    .iter()
                    .chain(&limits.high)
                    .map(|&limit| Real::max(Real::min(limit, most()), -most::<T>())),
            );
            state.numbers.extend([
                limits.damping,
                limits.restitution,
                limits.stiffness,
                limits.hard,
            ]);
        }
        state
    }

    /// Checks that a saved state belongs to this group; the error describes the difference.
    pub(super) fn accepts(&self, state: &GroupState<T>) -> Result<(), SceneError> {
        if state.kind != S::FACTS.name {
            return Err(SceneError::Snapshot("the types of its pendulums differ"));
        }
        let names = self.names();
        let count = names.len();
        let (parameters, width) = (S::FACTS.parameters.len(), Self::WIDTH);
        if state.pendulums.len() != count || state.numbers.len() != count * width {
            return Err(SceneError::Snapshot("the numbers of its pendulums differ"));
        }
        // A scene from which nothing was removed yet takes them in their order.
        let fresh = (0..).zip(&names).all(|(index, name)| *name == (index, 0));
        if state.names != names && !fresh {
            return Err(SceneError::Snapshot("other pendulums have been removed since"));
        }
        let suits = |scheme, substeps: u32| {
            (scheme == Scheme::Rk4 || Layouts::<S, N>::SPLITS)
                && substeps <= MOST_SUBSTEPS
                && substeps.is_power_of_two()
        };
        if !state.pendulums.iter().all(|&(scheme, substeps, _)| suits(scheme, substeps)) {
            return Err(SceneError::Snapshot("it holds steps that its pendulums cannot take"));
        }
        // Parameters may be infinite or NaN: a pendulum that fails because of its parameters can be
        // saved.
        if state
            .numbers
            .chunks_exact(width)
            .any(|numbers| numbers[parameters..].iter().any(|number| !number.is_finite()))
        {
            return Err(SceneError::Snapshot("it holds a state that is not finite"));
        }
        let mut standing = state
            .numbers
            .chunks_exact(width)
            .map(|numbers| &numbers[Self::STATE - Self::STANDINGS..Self::STATE]);
        if standing.any(|numbers| known::<S, T, N>(numbers).is_none()) {
            return Err(SceneError::Snapshot(
                "it holds a state of a limit or friction that does not exist",
            ));
        }
        Ok(())
    }

    /// Restores a saved state.
    pub(super) fn restore(&mut self, world: &mut World<T>, state: &GroupState<T>) {
        let zero = T::from_f64(0.0);
        let mut rest = &state.numbers[..];
        let mut take = |count: usize| {
            let (here, after) = rest.split_at(count);
            rest = after;
            here
        };
        for (&(id, _), &(scheme, substeps, status)) in self.names().iter().zip(&state.pendulums) {
            let parameters = take(S::FACTS.parameters.len()).to_vec();
            let controls = take(Layouts::<S, N>::CONTROLS).to_vec();
            let standing = known::<S, T, N>(take(Self::STANDINGS)).unwrap_or(Standings::OPEN);
            let mut array = || -> [T; N] {
                let mut values = [zero; N];
                values.copy_from_slice(take(N));
                values
            };
            let numbers = core::array::from_fn(|_| array());
            let mut limit = || {
                array().map(|limit| {
                    if limit.abs() < most() { limit } else { limit * T::from_f64(f64::INFINITY) }
                })
            };
            let (low, high) = (limit(), limit());
            let last = take(4);
            let limits = Limits {
                damping: last[0],
                low,
                high,
                restitution: last[1],
                stiffness: last[2],
                hard: last[3],
            };
            let joints = self.joints(id).to_vec();
            let grid = Grid { scheme, substeps, watched: const { Layouts::<S, N>::LIMITED } };
            let kind = Kind { grid, still: world.still(&joints), level: world.level(&joints) };
            let state = numbers;
            let detached = Detached { id, joints, parameters, controls, state, limits, standing };
            self.place(world, kind, &detached);
            self.status[id as usize] = status;
            self.set_awake(world, id, status == SceneStatus::Awake);
        }
        self.reset_alarms();
        self.criteria.clear();
    }

    /// Returns the largest differences of coordinates and of velocities from a saved state.
    pub(super) fn gap(&self, state: &GroupState<T>) -> [f64; 2] {
        let count = Self::STATE;
        let mut gap = [0.0f64; 2];
        for (id, numbers) in self.ids().zip(state.numbers.chunks_exact(Self::WIDTH)) {
            let [_, (q, v)] = self.states(id);
            // The high words of coordinates and velocities precede their low words.
            for i in 0..N {
                gap[0] = gap[0].max((q[i] - numbers[count + i]).to_f64().abs());
                gap[1] = gap[1].max((v[i] - numbers[count + 2 * N + i]).to_f64().abs());
            }
        }
        gap
    }
}
