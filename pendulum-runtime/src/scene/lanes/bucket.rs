//! Buckets: pendulums of one type that take the same steps, in blocks of lanes. Awake pendulums
//! precede all others.

use crate::scalar::{Float, Lane};
use crate::scene::lanes::block::{Block, ColdData};
use crate::scene::lanes::detached::Detached;
use crate::scene::lanes::kernel::{Batch, Run};
use crate::scene::lanes::limits::{LaneLimits, Limits, half_decay};
use crate::scene::sampling::joint::World;
use crate::scene::sampling::scheme::Grid;
use crate::scene::sampling::tracks::{Ticks, Tracks};
use crate::scene::system::{FromNumbers, Layouts, SceneSystem, W, Wide};
use crate::scene::threads::{part, share};
use crate::simd::widest;
use crate::system::System;
use crate::time::Time;
use core::sync::atomic::AtomicBool;

/// The properties shared by all pendulums of a bucket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) grid: Grid,
    /// `true` if their joints rest for ever.
    pub(crate) still: bool,
}

/// All pendulums of one kind.
pub(crate) struct Bucket<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) kind: Kind,
    pub(crate) tracks: Tracks<T>,
    pub(crate) blocks: Vec<Block<S, T, N>>,
    /// The rarely read data of each block.
    pub(crate) cold: Vec<ColdData<S, N>>,
    /// The parameters of all pendulums: for each block and parameter of the system, a number per
    /// lane.
    pub(crate) parameters: Vec<Wide<T>>,
    /// The number of all pendulums; `awake` is the number of awake pendulums, which come first.
    pub(crate) len: usize,
    pub(crate) awake: usize,
    times: Vec<Time>,
    stale: bool,
}

/// A failure in a batch: the index of the pendulum, and the number of ticks since the beginning of
/// the batch.
pub(crate) type Failed = (u32, u8);

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Bucket<S, T, N> {
    pub(crate) fn new(kind: Kind) -> Self {
        let tracks = Tracks::new(<S::Inputs as FromNumbers<T>>::COMPONENTS.len());
        Self {
            kind,
            tracks,
            blocks: Vec::new(),
            cold: Vec::new(),
            parameters: Vec::new(),
            len: 0,
            awake: 0,
            times: Vec::new(),
            stale: false,
        }
    }

    const fn parameter_count() -> usize {
        S::FACTS.parameters.len()
    }

    /// Adds a pendulum at the end, after all awake pendulums, and returns its slot.
    pub(crate) fn push(&mut self, prototype: &S, detached: &Detached<T, N>) -> usize {
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
        self.write(slot, detached);
        slot
    }

    /// Removes the last pendulum, which must not be among the awake pendulums.
    pub(crate) fn pop(&mut self) {
        self.len -= 1;
        if self.len <= (self.blocks.len() - 1) * W {
            self.blocks.pop();
            self.cold.pop();
            self.parameters.truncate(self.blocks.len() * Self::parameter_count());
        }
    }

    /// Returns the limits and the state, as in [`Detached`], of the pendulum in a slot.
    pub(crate) fn numbers(&self, slot: usize) -> (Limits<T, N>, [[T; N]; 6]) {
        let (block, lane) = (&self.blocks[slot / W], slot % W);
        let of = |lanes: &[Wide<T>; N]| lanes.map(|lanes| lanes.0[lane]);
        let limits = block.limits.as_deref().map_or_else(Limits::none, |limits| Limits {
            damping: limits.damping.0[lane],
            low: of(&limits.low),
            high: of(&limits.high),
            restitution: limits.restitution.0[lane],
            stiffness: limits.stiffness.0[lane],
            hard: limits.hard.0[lane],
        });
        let [before_q, before_v] = &block.before;
        (
            limits,
            [&block.q.high, &block.q.low, &block.v.high, &block.v.low, before_q, before_v].map(of),
        )
    }

    /// Returns a copy of the pendulum in a slot.
    pub(crate) fn read(&self, slot: usize) -> Detached<T, N> {
        let (limits, state) = self.numbers(slot);
        let parameters = self.parameters_of(slot).collect();
        Detached {
            id: self.id(slot),
            joints: self.joints(slot).to_vec(),
            parameters,
            state,
            limits,
        }
    }

    /// Returns the joints of the pendulum in a slot.
    pub(crate) fn joints(&self, slot: usize) -> &[u32] {
        self.tracks.joints(self.blocks[slot / W].track[slot % W])
    }

    /// Returns the parameters of the pendulum in a slot.
    pub(crate) fn parameters_of(&self, slot: usize) -> impl Iterator<Item = T> {
        let count = Self::parameter_count();
        self.parameters[slot / W * count..][..count].iter().map(move |lanes| lanes.0[slot % W])
    }

    /// Writes a pendulum to a slot.
    pub(crate) fn write(&mut self, slot: usize, detached: &Detached<T, N>) {
        let track = self.tracks.find(&detached.joints);
        let count = Self::parameter_count();
        let lane = slot % W;
        let parameters = &mut self.parameters[slot / W * count..][..count];
        let (block, cold) = (&mut self.blocks[slot / W], &mut self.cold[slot / W]);
        for (lanes, &parameter) in parameters.iter_mut().zip(&detached.parameters) {
            lanes.0[lane] = parameter;
        }
        cold.stale = true;
        self.stale = true;
        (block.track[lane], cold.id[lane]) = (track, detached.id);
        let Block { q, v, before: [before_q, before_v], .. } = block;
        for (lanes, numbers) in
            [&mut q.high, &mut q.low, &mut v.high, &mut v.low, before_q, before_v]
                .into_iter()
                .zip(&detached.state)
        {
            for i in 0..N {
                lanes[i].0[lane] = numbers[i];
            }
        }
        let own = &detached.limits;
        if block.limits.is_none() && *own == Limits::none() {
            return;
        }
        let limits = block.limits.get_or_insert_with(|| Box::new(LaneLimits::none()));
        for i in 0..N {
            (limits.low[i].0[lane], limits.high[i].0[lane]) = (own.low[i], own.high[i]);
        }
        limits.damping.0[lane] = own.damping;
        limits.restitution.0[lane] = own.restitution;
        limits.stiffness.0[lane] = own.stiffness;
        limits.hard.0[lane] = own.hard;
    }

    /// Exchanges the pendulums in two slots.
    pub(crate) fn swap(&mut self, a: usize, b: usize) {
        if a != b {
            let (first, second) = (self.read(a), self.read(b));
            self.write(a, &second);
            self.write(b, &first);
        }
    }

    pub(crate) fn id(&self, slot: usize) -> u32 {
        self.cold[slot / W].id[slot % W]
    }

    /// Recomputes the values that depend only on parameters, if the parameters have changed.
    fn settle(&mut self, prototype: &S, step: f64) {
        if !self.stale {
            return;
        }
        self.stale = false;
        let (count, h) = (Self::parameter_count(), step / f64::from(self.kind.grid.substeps));
        let blocks = self.blocks.iter_mut().zip(&mut self.cold).enumerate();
        for (index, (block, cold)) in blocks.filter(|(_, (_, cold))| cold.stale) {
            let mut parameters = self.parameters[index * count..][..count].iter();
            cold.system = prototype.widen(|parameter| {
                parameters.next().map_or(Wide::splat(parameter), |lanes| *lanes)
            });
            block.prepared = cold.system.prepare();
            cold.stale = false;
            if let Some(limits) = &mut block.limits {
                let infinity = T::from_f64(f64::INFINITY);
                limits.stops = false;
                for lane in 0..W {
                    limits.factor.0[lane] = half_decay(limits.damping.0[lane], h);
                    limits.stops |= (0..N).any(|i| {
                        limits.low[i].0[lane] != -infinity || limits.high[i].0[lane] != infinity
                    });
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
        let clock = &world.clock;
        self.settle(prototype, clock.step());
        if self.awake == 0 {
            return;
        }
        let Kind { grid, still } = self.kind;
        let tick = clock.tick();
        self.times.clear();
        for tick in tick..tick + ticks as i64 {
            self.times.extend(grid.fractions().map(|fraction| clock.within(tick, fraction)));
        }
        let layouts = const { [&Layouts::<S, N>::FORCES, &Layouts::<S, N>::MOMENTA] };
        // Joints that rest for ever have one record.
        let now = [Time::new(clock.time(tick))];
        let times = if still { &now[..] } else { &self.times[..] };
        let batch = Ticks { world, count: ticks, times };
        self.tracks.sample(grid, layouts, batch, fork);
        let batch = Batch {
            grid,
            h: clock.step() / f64::from(grid.substeps),
            ticks,
            times: &self.times,
            tracks: &self.tracks,
            still,
            failed: AtomicBool::new(false),
        };
        let blocks = &mut self.blocks[..self.awake.div_ceil(W)];
        let lanes_of_last = (self.awake - 1) % W + 1;
        let part = part(blocks.len(), 32, fork);
        let last = blocks.len().div_ceil(part) - 1;
        let parts = blocks.chunks_mut(part).zip(self.cold.chunks(part)).enumerate();
        share(parts, |(index, (blocks, cold))| {
            let lanes_of_last = if index == last { lanes_of_last } else { W };
            widest(Run { blocks, cold, lanes_of_last, batch: &batch });
        });
        if !batch.failed.into_inner() {
            return;
        }
        for (block, cold) in
            blocks.iter_mut().zip(&self.cold).filter(|(block, _)| block.failed != 0)
        {
            for lane in (0..W).filter(|lane| block.failed & (1 << lane) != 0) {
                failed.push((cold.id[lane], block.failed_at[lane]));
            }
            block.failed = 0;
        }
    }
}
