//! Buckets: pendulums of one type that take the same steps, in blocks of lanes. Awake pendulums
//! precede all others.

use crate::lanes::block::{Block, ColdData, lane_of};
use crate::lanes::kernel::{Batch, Run};
use crate::lanes::limits::{LaneLimits, Limits, half_decay};
use crate::lanes::steps::MOST_TURN;
use crate::sampling::scheme::Kind;
use crate::sampling::tracks::Shared;
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem, W, Wide, octet};
use crate::threads::{part, share};
use core::sync::atomic::AtomicBool;
use pendulum_core::integrate::limits::Standings;
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::simd::widest;
use pendulum_core::system::{InLanes, InOctets, LaneSystem, System};

/// A copy of a pendulum outside of its bucket.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Detached<T, const N: usize> {
    pub(crate) id: u32,
    pub(crate) joints: Vec<u32>,
    pub(crate) parameters: Vec<T>,
    /// The components of the control inputs.
    pub(crate) controls: Vec<T>,
    /// The coordinates with their low words, the velocities with their low words, and the
    /// coordinates and velocities one tick earlier.
    pub(crate) state: [[T; N]; 6],
    pub(crate) limits: Limits<T, N>,
    pub(crate) standing: Standings,
}

impl<T: Real, const N: usize> Detached<T, N> {
    /// Creates a pendulum on joints, without limits and with control inputs of zero.
    pub(crate) fn new<S: System<N, Scalar = T>>(
        system: &S,
        joints: Vec<u32>,
        q: [T; N],
        v: [T; N],
    ) -> Self {
        let mut parameters = Vec::new();
        system.map(|parameter| {
            parameters.push(parameter);
            parameter
        });
        let controls = vec![T::from_f64(0.0); Layouts::<S, N>::CONTROLS];
        let (limits, standing) = (Limits::none(), Standings::OPEN);
        let mut detached =
            Self { id: 0, joints, parameters, controls, state: [q; 6], limits, standing };
        detached.set_state(q, v);
        detached
    }

    /// Sets the state, now and one tick earlier.
    pub(crate) fn set_state(&mut self, q: [T; N], v: [T; N]) {
        let zero = [T::from_f64(0.0); N];
        self.state = [q, zero, v, zero, q, v];
    }

    /// Clamps the state to hard limits.
    pub(crate) fn hold(&mut self) {
        let [q, q_low, v, v_low, ..] = &mut self.state;
        let before = (*q, *v);
        self.limits.hold(q, v);
        if before != (*q, *v) {
            (*q_low, *v_low) = ([T::from_f64(0.0); N], [T::from_f64(0.0); N]);
        }
    }
}

/// All pendulums of one kind.
pub(crate) struct Bucket<S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) kind: Kind,
    /// The index of the tracks in the world.
    pub(crate) tracks: usize,
    /// The joints of all pendulums.
    joints: Vec<u32>,
    pub(crate) blocks: Vec<Block<S, T, N>>,
    /// The rarely read data of each block.
    pub(crate) cold: Vec<ColdData<S, T, N>>,
    /// The parameters of all pendulums: for each block and parameter of the system, a number per
    /// lane.
    pub(crate) parameters: Vec<Wide<T>>,
    /// The number of all pendulums; `awake` is the number of awake pendulums, which come first.
    pub(crate) len: usize,
    pub(crate) awake: usize,
    stale: bool,
}

/// A failure in a batch: the index of the pendulum, and the number of ticks since the beginning of
/// the batch.
pub(crate) type Failed = (u32, u8);

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Bucket<S, T, N> {
    const INPUTS: usize = Layouts::<S, N>::DRIVEN;

    pub(crate) fn new(kind: Kind, world: &mut World<T>) -> Self {
        let (forces, momenta) = (Layouts::<S, N>::FORCES, Layouts::<S, N>::MOMENTA);
        Self {
            kind,
            tracks: world.tracks_for(&Shared { kind, inputs: Self::INPUTS, forces, momenta }),
            joints: Vec::new(),
            blocks: Vec::new(),
            cold: Vec::new(),
            parameters: Vec::new(),
            len: 0,
            awake: 0,
            stale: false,
        }
    }

    const fn parameter_count() -> usize {
        S::FACTS.parameters.len()
    }

    /// Adds a pendulum at the end, after all awake pendulums, and returns its slot.
    pub(crate) fn push(
        &mut self,
        world: &mut World<T>,
        prototype: &S,
        detached: &Detached<T, N>,
    ) -> usize {
        let slot = self.len;
        if slot == self.blocks.len() * W {
            let (block, cold) = Block::new(prototype);
            self.blocks.push(block);
            self.cold.push(cold);
            prototype.map(|parameter| {
                self.parameters.push(Wide::splat(parameter));
                parameter
            });
        }
        self.len += 1;
        self.joints.extend_from_slice(&detached.joints);
        self.write(world, slot, detached);
        slot
    }

    /// Removes the last pendulum, which must not be among the awake pendulums.
    pub(crate) fn pop(&mut self) {
        self.len -= 1;
        self.joints.truncate(self.len * Self::INPUTS);
        if self.len <= (self.blocks.len() - 1) * W {
            self.blocks.pop();
            self.cold.pop();
            self.parameters.truncate(self.blocks.len() * Self::parameter_count());
        }
    }

    /// Returns the limits and the state, as in [`Detached`], of the pendulum in a slot.
    pub(crate) fn numbers(&self, slot: usize) -> (Limits<T, N>, [[T; N]; 6]) {
        let (block, lane) = (&self.blocks[slot / W], slot % W);
        let limits = block.limits.as_deref().map_or_else(Limits::none, |own| own.own.lane(lane));
        (limits, block.numbers().map(|numbers| lane_of(numbers, lane)))
    }

    /// Writes the coordinates and velocities of the pendulum in a slot.
    pub(crate) fn set_state(&mut self, slot: usize, q: &[T; N], v: &[T; N]) {
        let (block, lane, zero) = (&mut self.blocks[slot / W], slot % W, T::from_f64(0.0));
        for i in 0..N {
            (block.q.high[i].0[lane], block.q.low[i].0[lane]) = (q[i], zero);
            (block.v.high[i].0[lane], block.v.low[i].0[lane]) = (v[i], zero);
        }
    }

    /// Returns a copy of the pendulum in a slot.
    pub(crate) fn read(&self, slot: usize) -> Detached<T, N> {
        let (limits, state) = self.numbers(slot);
        let parameters = self.parameters_of(slot).collect();
        let controls = self.controls_of(slot).collect();
        Detached {
            id: self.id(slot),
            joints: self.joints(slot).to_vec(),
            parameters,
            controls,
            state,
            limits,
            standing: self.standing(slot),
        }
    }

    /// Copies the pendulum in a slot of a block that has been taken out, without the states of its
    /// limits.
    pub(crate) fn copy(&self, block: &Block<S, T, N>, slot: usize, to: &mut Detached<T, N>) {
        let lane = slot % W;
        to.id = self.id(slot);
        to.joints.clear();
        to.joints.extend_from_slice(self.joints(slot));
        to.parameters.clear();
        to.parameters.extend(self.parameters_of(slot));
        to.controls.clear();
        to.controls.extend(self.controls_of(slot));
        to.state = block.numbers().map(|numbers| lane_of(numbers, lane));
        to.limits =
            block.limits.as_deref().map_or_else(Limits::none, |limits| limits.own.lane(lane));
    }

    /// Returns the states of the limits and frictions of the pendulum in a slot.
    pub(crate) fn standing(&self, slot: usize) -> Standings {
        let limited = self.blocks[slot / W].limited.as_ref();
        limited.map_or(Standings::OPEN, |limited| limited.standing[slot % W])
    }

    /// Returns the joints of the pendulum in a slot.
    pub(crate) fn joints(&self, slot: usize) -> &[u32] {
        &self.joints[slot * Self::INPUTS..][..Self::INPUTS]
    }

    /// Returns the parameters of the pendulum in a slot.
    pub(crate) fn parameters_of(&self, slot: usize) -> impl Iterator<Item = T> {
        let count = Self::parameter_count();
        self.parameters[slot / W * count..][..count].iter().map(move |lanes| lanes.0[slot % W])
    }

    /// Returns the components of the control inputs of the pendulum in a slot.
    pub(crate) fn controls_of(&self, slot: usize) -> impl Iterator<Item = T> {
        self.cold[slot / W].controls.iter().map(move |lanes| lanes.0[slot % W])
    }

    /// Sets the components of the control inputs of the pendulum in a slot, and returns `true` if
    /// one of them changes.
    pub(crate) fn set_controls(&mut self, slot: usize, values: &[T]) -> bool {
        let mut changed = false;
        for (lanes, &value) in self.cold[slot / W].controls.iter_mut().zip(values) {
            changed |= lanes.0[slot % W] != value;
            lanes.0[slot % W] = value;
        }
        changed
    }

    /// Writes a pendulum to a slot.
    pub(crate) fn write(&mut self, world: &mut World<T>, slot: usize, detached: &Detached<T, N>) {
        let track = world.tracks[self.tracks].find(&detached.joints);
        self.joints[slot * Self::INPUTS..][..Self::INPUTS].copy_from_slice(&detached.joints);
        let count = Self::parameter_count();
        let lane = slot % W;
        let parameters = &mut self.parameters[slot / W * count..][..count];
        let (block, cold) = (&mut self.blocks[slot / W], &mut self.cold[slot / W]);
        let controls = cold.controls.iter_mut().zip(&detached.controls);
        for (lanes, &number) in parameters.iter_mut().zip(&detached.parameters).chain(controls) {
            lanes.0[lane] = number;
        }
        cold.stale = true;
        self.stale = true;
        (block.track[lane], cold.id[lane]) = (track, detached.id);
        block.set_numbers(lane, &detached.state);
        if let Some(limited) = &mut block.limited {
            limited.standing[lane] = detached.standing;
        }
        if block.limits.is_some() || detached.limits != Limits::none() {
            let limits = block.limits.get_or_insert_with(|| {
                let (own, one) = (Limits::none(), Wide::from_f64(1.0));
                Box::new(LaneLimits { own, factor: one, most_turn: one, stops: false })
            });
            limits.own.set_lane(lane, &detached.limits);
        }
    }

    /// Exchanges the pendulums in two slots.
    pub(crate) fn swap(&mut self, world: &mut World<T>, a: usize, b: usize) {
        if a != b {
            let (first, second) = (self.read(a), self.read(b));
            self.write(world, a, &second);
            self.write(world, b, &first);
        }
    }

    pub(crate) fn id(&self, slot: usize) -> u32 {
        self.cold[slot / W].id[slot % W]
    }

    /// Recomputes the values that depend only on parameters, if the parameters have changed.
    pub(crate) fn settle(&mut self, prototype: &S, step: f64) {
        if !self.stale {
            return;
        }
        self.stale = false;
        let (count, h) = (Self::parameter_count(), step / f64::from(self.kind.grid.substeps));
        let blocks = self.blocks.iter_mut().zip(&mut self.cold).enumerate();
        for (index, (block, cold)) in blocks.filter(|(_, (_, cold))| cold.stale) {
            let parameters = &self.parameters[index * count..][..count];
            let mut next = parameters.iter();
            cold.system = LaneSystem::<InLanes<W>, N>::widen(prototype, |parameter| {
                next.next().map_or(Wide::splat(parameter), |all| *all)
            });
            block.prepared = cold.system.prepare();
            cold.octets.clear();
            for part in 0..if const { Layouts::<S, N>::LONG } { W / 8 } else { 0 } {
                let mut next = parameters.iter();
                let system = LaneSystem::<InOctets, N>::widen(prototype, |parameter| {
                    next.next().map_or(Octet::splat(parameter), |all| octet(all, part))
                });
                let prepared = system.prepare();
                cold.octets.push((system, prepared));
            }
            cold.stale = false;
            if let Some(limits) = &mut block.limits {
                let infinity = T::from_f64(f64::INFINITY);
                limits.stops = false;
                for lane in 0..W {
                    let own = limits.own.lane(lane);
                    let Limits { damping, low, high, .. } = own;
                    limits.factor.0[lane] = half_decay(damping, h);
                    let free = own == Limits::none();
                    limits.most_turn.0[lane] = if free { T::from_f64(MOST_TURN) } else { infinity };
                    limits.stops |= (0..N).any(|i| low[i] != -infinity || high[i] != infinity);
                }
            }
        }
    }

    /// Advances the awake pendulums by a batch of ticks, and appends the lanes that fail to
    /// `failed`.
    pub(crate) fn run(
        &mut self,
        prototype: &S,
        world: &World<T>,
        ticks: usize,
        fork: bool,
        failed: &mut Vec<Failed>,
    ) {
        self.settle(prototype, world.clock.step());
        if self.awake == 0 {
            return;
        }
        let batch = self.batch(world, ticks);
        let blocks = &mut self.blocks[..self.awake.div_ceil(W)];
        let lanes_of_last = (self.awake - 1) % W + 1;
        let part = part(blocks.len(), 32, fork);
        let last = blocks.len().div_ceil(part) - 1;
        let parts = blocks.chunks_mut(part).zip(self.cold.chunks(part)).enumerate();
        share(parts, |(index, (blocks, cold))| {
            let lanes_of_last = if index == last { lanes_of_last } else { W };
            widest(Run { blocks, cold, lanes_of_last, batch: &batch });
        });
        if batch.failed.into_inner() {
            self.collect_failed(failed);
        }
    }

    /// Returns the data of a batch of ticks.
    pub(crate) fn batch<'a>(&self, world: &'a World<T>, ticks: usize) -> Batch<'a, T> {
        let (tracks, Kind { grid, still, .. }) = (&world.tracks[self.tracks], self.kind);
        Batch {
            grid,
            h: world.clock.step() / f64::from(grid.substeps),
            ticks,
            first: 0,
            times: &tracks.times,
            tracks,
            still,
            failed: AtomicBool::new(false),
        }
    }

    /// Appends the lanes that have failed in a batch to `failed`.
    pub(crate) fn collect_failed(&mut self, failed: &mut Vec<Failed>) {
        let all = self.blocks.iter_mut().zip(&self.cold);
        for (block, cold) in all.filter(|(block, _)| block.failed != 0) {
            for lane in (0..W).filter(|lane| block.failed & (1 << lane) != 0) {
                failed.push((cold.id[lane], block.failed_at[lane]));
            }
            block.failed = 0;
        }
    }
}
