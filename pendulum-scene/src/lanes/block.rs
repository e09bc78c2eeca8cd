//! Blocks of lanes: pendulums of one type that are computed together.

use crate::lanes::bucket::Detached;
use crate::lanes::limits::LaneLimits;
use crate::system::{Layouts, OctetOf, SceneSystem, W, Wide, WideOf};
use pendulum_core::integrate::limits::Standings;
use pendulum_core::integrate::method::Compensated;
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{InLanes, LaneSystem, System};

/// Returns the numbers of a lane. `map` would copy those of all lanes.
#[inline]
pub(crate) fn lane_of<T: Copy, const N: usize>(lanes: &[Wide<T>; N], lane: usize) -> [T; N] {
    core::array::from_fn(|i| lanes[i].0[lane])
}

/// A block of [`W`] pendulums of one type.
pub(crate) struct Block<S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) prepared: <WideOf<S, N> as System<N>>::Prepared,
    pub(crate) q: Compensated<Wide<T>, N>,
    pub(crate) v: Compensated<Wide<T>, N>,
    /// The coordinates and velocities one tick earlier.
    pub(crate) before: [[Wide<T>; N]; 2],
    /// The track of each lane.
    pub(crate) track: [u32; W],
    /// The lanes whose states are no longer finite, by bit. For these lanes `failed_at` is the
    /// number of ticks from the beginning of the batch to the failed tick.
    pub(crate) failed: u64,
    pub(crate) failed_at: [u8; W],
    /// Damping and stops, if a lane has any.
    pub(crate) limits: Option<Box<LaneLimits<Wide<T>, N>>>,
    /// What a system with limits or frictions needs beside the lanes.
    pub(crate) limited: Option<Box<Limited<T, N>>>,
}

/// The states of the limits and frictions of [`W`] pendulums.
#[derive(Debug)]
pub(crate) struct Limited<T, const N: usize> {
    pub(crate) standing: [Standings; W],
    /// The pendulum that takes its steps now; its memory is used again.
    pub(crate) alone: Detached<T, N>,
}

/// Data of [`W`] pendulums that most steps do not read. They are stored apart from the states to
/// save cache.
pub(crate) struct ColdData<S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) system: WideOf<S, N>,
    /// The system for each eight lanes with its prepared values, if the equations are long.
    pub(crate) octets: Vec<(OctetOf<S, N>, <OctetOf<S, N> as System<N>>::Prepared)>,
    /// The components of the control inputs, which keep their values until they are set.
    pub(crate) controls: Vec<Wide<T>>,
    /// The index of each lane's pendulum in the group.
    pub(crate) id: [u32; W],
    /// `true` if parameters have changed, so that `system` and its prepared values must be
    /// recomputed.
    pub(crate) stale: bool,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Block<S, T, N> {
    /// Creates a block of pendulums with the parameters of `prototype`, at rest at zero.
    pub(crate) fn new(prototype: &S) -> (Self, ColdData<S, T, N>) {
        let system = LaneSystem::<InLanes<W>, N>::widen(prototype, Wide::splat);
        let zero = [Wide::from_f64(0.0); N];
        let zero_state = [T::from_f64(0.0); N];
        let block = Self {
            prepared: system.prepare(),
            q: Compensated::new(zero),
            v: Compensated::new(zero),
            before: [zero; 2],
            track: [0; W],
            failed: 0,
            failed_at: [0; W],
            limits: None,
            limited: const { Layouts::<S, N>::LIMITED }.then(|| {
                let alone = Detached::new(prototype, Vec::new(), zero_state, zero_state);
                Box::new(Limited { standing: [Standings::OPEN; W], alone })
            }),
        };
        let controls = vec![Wide::from_f64(0.0); Layouts::<S, N>::CONTROLS];
        let octets = Vec::with_capacity(if const { Layouts::<S, N>::LONG } { W / 8 } else { 0 });
        (block, ColdData { system, octets, controls, id: [0; W], stale: false })
    }

    /// Returns the coordinates and velocities of a lane.
    pub(crate) fn state(&self, lane: usize) -> ([T; N], [T; N]) {
        (lane_of(&self.q.high, lane), lane_of(&self.v.high, lane))
    }

    /// Returns the coordinates with their low words, the velocities with their low words, and the
    /// coordinates and velocities one tick earlier.
    pub(crate) fn numbers(&self) -> [&[Wide<T>; N]; 6] {
        let [before_q, before_v] = &self.before;
        [&self.q.high, &self.q.low, &self.v.high, &self.v.low, before_q, before_v]
    }

    /// Sets these numbers of a lane.
    pub(crate) fn set_numbers(&mut self, lane: usize, state: &[[T; N]; 6]) {
        for (lanes, numbers) in self.numbers_mut().into_iter().zip(state) {
            for i in 0..N {
                lanes[i].0[lane] = numbers[i];
            }
        }
    }

    /// Returns the same numbers to be changed.
    #[inline]
    pub(crate) fn numbers_mut(&mut self) -> [&mut [Wide<T>; N]; 6] {
        let Self { q, v, before: [before_q, before_v], .. } = self;
        [&mut q.high, &mut q.low, &mut v.high, &mut v.low, before_q, before_v]
    }
}
