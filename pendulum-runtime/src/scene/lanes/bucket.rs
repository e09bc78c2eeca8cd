//! Pendulums of one type that take the same steps: those that are awake first, all in blocks of
//! lanes.

use crate::real::{Float, Lane};
use crate::scene::lanes::block::{Block, Rare};
use crate::scene::lanes::detached::Loose;
use crate::scene::lanes::kernel::{Batch, Run};
use crate::scene::lanes::limits::{Extra, Extras, half_decay};
use crate::scene::lanes::system::{Hung, Known, W, Wide};
use crate::scene::sampling::scheme::Grid;
use crate::scene::sampling::tracks::{Sampled, Tracks};
use crate::simd::widest;
use crate::system::System;
use crate::time::Time;
use core::sync::atomic::AtomicBool;

/// What pendulums have in common that are computed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) grid: Grid,
    /// Their joints rest for ever.
    pub(crate) still: bool,
}

/// Pendulums of one kind.
pub(crate) struct Bucket<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) kind: Kind,
    pub(crate) tracks: Tracks<T>,
    pub(crate) blocks: Vec<Block<S, T, N>>,
    /// The other part of each block.
    pub(crate) rare: Vec<Rare<S, T, N>>,
    /// The parameters: as many lanes for each block as the system has parameters.
    pub(crate) parameters: Vec<Wide<T>>,
    /// All, and those at the front that are awake.
    pub(crate) len: usize,
    pub(crate) awake: usize,
    times: Vec<Time>,
    stale: bool,
}

/// A lane that has failed: the pendulum and the ticks since the beginning of the batch.
pub(crate) type Failed = (u32, u8);

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Bucket<S, T, N> {
    pub(crate) fn new(kind: Kind) -> Self {
        let tracks = Tracks::new(
            <S::Inputs as crate::scene::sampling::assemble::Assemble<T>>::COMPONENTS.len(),
        );
        Self {
            kind,
            tracks,
            blocks: Vec::new(),
            rare: Vec::new(),
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

    /// Adds a pendulum at the end, where it sleeps; gives its slot.
    pub(crate) fn push(&mut self, prototype: &S, loose: &Loose<T, N>) -> usize {
        let slot = self.len;
        if slot == self.blocks.len() * W {
            let (block, rare) = Block::new(prototype);
            self.blocks.push(block);
            self.rare.push(rare);
            prototype.mapped(|parameter| {
                self.parameters.push(Wide::splat(parameter));
                parameter
            });
        }
        self.len += 1;
        self.write(slot, loose);
        slot
    }

    /// Takes out the last pendulum, which must sleep.
    pub(crate) fn pop(&mut self) {
        self.len -= 1;
        if self.len <= (self.blocks.len() - 1) * W {
            self.blocks.pop();
            self.rare.pop();
            self.parameters.truncate(self.blocks.len() * Self::parameter_count());
        }
    }

    /// What acts on the pendulum in a slot and its state, as in [`Loose`].
    pub(crate) fn numbers(&self, slot: usize) -> (Extra<T, N>, [[T; N]; 6]) {
        let (block, lane) = (&self.blocks[slot / W], slot % W);
        let of = |lanes: &[Wide<T>; N]| lanes.map(|lanes| lanes.0[lane]);
        let extra = block.extras.as_deref().map_or_else(Extra::none, |extras| Extra {
            damping: extras.damping.0[lane],
            low: of(&extras.low),
            high: of(&extras.high),
            restitution: extras.restitution.0[lane],
            stiffness: extras.stiffness.0[lane],
            hard: extras.hard.0[lane],
        });
        let [before_q, before_v] = &block.before;
        (
            extra,
            [&block.q.high, &block.q.low, &block.v.high, &block.v.low, before_q, before_v].map(of),
        )
    }

    /// The pendulum in a slot.
    pub(crate) fn read(&self, slot: usize) -> Loose<T, N> {
        let (extra, state) = self.numbers(slot);
        let parameters = self.parameters_of(slot).collect();
        Loose { id: self.id(slot), joints: self.joints(slot).to_vec(), parameters, state, extra }
    }

    /// The joints of the pendulum in a slot.
    pub(crate) fn joints(&self, slot: usize) -> &[u32] {
        self.tracks.joints(self.blocks[slot / W].track[slot % W])
    }

    /// The parameters of the pendulum in a slot.
    pub(crate) fn parameters_of(&self, slot: usize) -> impl Iterator<Item = T> {
        let count = Self::parameter_count();
        self.parameters[slot / W * count..][..count].iter().map(move |lanes| lanes.0[slot % W])
    }

    /// Puts a pendulum into a slot.
    pub(crate) fn write(&mut self, slot: usize, loose: &Loose<T, N>) {
        let track = self.tracks.find(&loose.joints);
        let count = Self::parameter_count();
        let lane = slot % W;
        let parameters = &mut self.parameters[slot / W * count..][..count];
        let (block, rare) = (&mut self.blocks[slot / W], &mut self.rare[slot / W]);
        for (lanes, &parameter) in parameters.iter_mut().zip(&loose.parameters) {
            lanes.0[lane] = parameter;
        }
        rare.stale = true;
        self.stale = true;
        (block.track[lane], rare.id[lane]) = (track, loose.id);
        let Block { q, v, before: [before_q, before_v], .. } = block;
        for (lanes, numbers) in
            [&mut q.high, &mut q.low, &mut v.high, &mut v.low, before_q, before_v]
                .into_iter()
                .zip(&loose.state)
        {
            for i in 0..N {
                lanes[i].0[lane] = numbers[i];
            }
        }
        let extra = &loose.extra;
        if block.extras.is_none() && *extra == Extra::none() {
            return;
        }
        let extras = block.extras.get_or_insert_with(|| Box::new(Extras::none()));
        for i in 0..N {
            (extras.low[i].0[lane], extras.high[i].0[lane]) = (extra.low[i], extra.high[i]);
        }
        extras.damping.0[lane] = extra.damping;
        extras.restitution.0[lane] = extra.restitution;
        extras.stiffness.0[lane] = extra.stiffness;
        extras.hard.0[lane] = extra.hard;
    }

    /// Lets the pendulums in two slots change places.
    pub(crate) fn swap(&mut self, a: usize, b: usize) {
        if a != b {
            let (first, second) = (self.read(a), self.read(b));
            self.write(a, &second);
            self.write(b, &first);
        }
    }

    pub(crate) fn id(&self, slot: usize) -> u32 {
        self.rare[slot / W].id[slot % W]
    }

    /// Computes once what parameters alone decide, where they have changed.
    pub(crate) fn settle(&mut self, prototype: &S, step: f64) {
        if !self.stale {
            return;
        }
        self.stale = false;
        let (count, h) = (Self::parameter_count(), step / f64::from(self.kind.grid.substeps));
        let blocks = self.blocks.iter_mut().zip(&mut self.rare).enumerate();
        for (index, (block, rare)) in blocks.filter(|(_, (_, rare))| rare.stale) {
            let mut parameters = self.parameters[index * count..][..count].iter();
            rare.system = prototype.widen(|parameter| {
                parameters.next().map_or(Wide::splat(parameter), |lanes| *lanes)
            });
            block.prepared = rare.system.prepare();
            rare.stale = false;
            if let Some(extras) = &mut block.extras {
                let infinity = T::from_f64(f64::INFINITY);
                extras.stops = false;
                for lane in 0..W {
                    extras.factor.0[lane] = half_decay(extras.damping.0[lane], h);
                    extras.stops |= (0..N).any(|i| {
                        extras.low[i].0[lane] != -infinity || extras.high[i].0[lane] != infinity
                    });
                }
            }
        }
    }

    /// Goes through a batch of ticks; gives the lanes that failed.
    pub(crate) fn run(&mut self, sampled: &Sampled<'_, T>, fork: bool, failed: &mut Vec<Failed>) {
        if self.awake == 0 {
            return;
        }
        let (layout, momenta) =
            (const { &Known::<S, N>::FORCES }, const { &Known::<S, N>::MOMENTA });
        let Kind { grid, still } = self.kind;
        if still {
            self.tracks.load_still(
                layout,
                S::FACTS.inputs,
                sampled.clock.time(sampled.tick),
                sampled.places,
            );
        } else {
            self.tracks.load(grid, layout, momenta, S::FACTS.inputs, sampled, fork);
        }
        self.times.clear();
        for tick in 0..sampled.ticks {
            self.times.extend(
                grid.fractions()
                    .map(|fraction| sampled.clock.within(sampled.tick + tick as i64, fraction)),
            );
        }
        let h = sampled.clock.step() / f64::from(grid.substeps);
        let batch = Batch {
            grid,
            h,
            ticks: sampled.ticks,
            times: &self.times,
            tracks: &self.tracks,
            still,
            failed: AtomicBool::new(false),
        };
        let blocks = &mut self.blocks[..self.awake.div_ceil(W)];
        let lanes_of_last = (self.awake - 1) % W + 1;
        through(blocks, &self.rare, lanes_of_last, &batch, fork);
        if !batch.failed.into_inner() {
            return;
        }
        for (block, rare) in
            blocks.iter_mut().zip(&self.rare).filter(|(block, _)| block.failed != 0)
        {
            for lane in (0..W).filter(|lane| block.failed & (1 << lane) != 0) {
                failed.push((rare.id[lane], block.failed_at[lane]));
            }
            block.failed = 0;
        }
    }
}

/// Takes all blocks through a batch, on all threads if there are many.
#[cfg(feature = "rayon")]
fn through<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    blocks: &mut [Block<S, T, N>],
    rare: &[Rare<S, T, N>],
    lanes_of_last: usize,
    batch: &Batch<'_, T>,
    fork: bool,
) {
    use crate::scene::threads::{part, share};
    const LEAST: usize = 32;
    if !fork || blocks.len() < 2 * LEAST {
        return widest(Run { blocks, rare, lanes_of_last, batch });
    }
    let part = part(blocks.len(), LEAST);
    let last = blocks.len().div_ceil(part) - 1;
    let parts = blocks.chunks_mut(part).zip(rare.chunks(part)).enumerate();
    share(parts, |(index, (blocks, rare))| {
        widest(Run {
            blocks,
            rare,
            lanes_of_last: if index == last { lanes_of_last } else { W },
            batch,
        });
    });
}

/// Takes all blocks through a batch.
#[cfg(not(feature = "rayon"))]
fn through<S: Hung<T, N>, T: Lane + Float, const N: usize>(
    blocks: &mut [Block<S, T, N>],
    rare: &[Rare<S, T, N>],
    lanes_of_last: usize,
    batch: &Batch<'_, T>,
    _: bool,
) {
    widest(Run { blocks, rare, lanes_of_last, batch });
}
