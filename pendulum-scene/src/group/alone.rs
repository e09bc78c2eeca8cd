//! The steps of pendulums with limits and frictions: in lanes while their gaps stay open, and
//! otherwise one after the other, by the code and with the bits of single runs.

use crate::group::hung::Hung;
use crate::group::members::{Group, Location};
use crate::lanes::block::{Block, Limited};
use crate::lanes::bucket::{Bucket, Failed};
use crate::lanes::kernel::{Batch, Run, copy_lane};
use crate::lanes::limits::Limits;
use crate::lanes::open::Open;
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem, W};
use crate::threads::{part, share};
use pendulum_core::error::Error;
use pendulum_core::integrate::Rk4;
use pendulum_core::integrate::limits::{self, Standings};
use pendulum_core::integrate::method::{Compensated, Endpoint};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::simd::widest;
use pendulum_core::time::Time;

/// The difference of the coordinates at which two computations of a tick agree. The second one
/// takes steps of a quarter of the length, so that its error is less than a hundredth of that.
const AGREE: f64 = 1e-3;

/// Advances the awake pendulums of a bucket by a batch of ticks, and appends those that fail to
/// `failed`.
pub(super) fn run<S: SceneSystem<T, N>, T: Float, const N: usize>(
    bucket: &mut Bucket<S, T, N>,
    prototype: &S,
    world: &World<T>,
    ticks: usize,
    fork: bool,
    failed: &mut Vec<Failed>,
) {
    bucket.settle(prototype, world.clock.step());
    if bucket.awake == 0 {
        return;
    }
    let mut blocks = core::mem::take(&mut bucket.blocks);
    let (count, all) = (bucket.awake.div_ceil(W), &*bucket);
    let (batch, part) = (all.batch(world, ticks), part(count, 1, fork));
    share(blocks[..count].chunks_mut(part).enumerate(), |(index, blocks)| {
        for (block, k) in blocks.iter_mut().zip(index * part..) {
            for tick in 0..ticks {
                one_tick(all, prototype, world, &batch, (block, k), tick);
            }
        }
    });
    bucket.blocks = blocks;
    bucket.collect_failed(failed);
}

/// Computes a tick of the block with the index `k`.
fn one_tick<S: SceneSystem<T, N>, T: Float, const N: usize>(
    bucket: &Bucket<S, T, N>,
    prototype: &S,
    world: &World<T>,
    batch: &Batch<'_, T>,
    (block, k): (&mut Block<S, T, N>, usize),
    tick: usize,
) {
    let awake = (bucket.awake - k * W).min(W);
    let (mut working, mut alone) = (0u32, 0u32);
    for lane in (0..awake).filter(|lane| block.failed & (1 << lane) == 0) {
        working |= 1 << lane;
        // The choice depends on the pendulum itself, so that others change none of its bits.
        let open = block.limited.as_ref().is_some_and(|limited| limited.standing[lane].is_open());
        let whole = batch.tracks.pieces(tick, block.track[lane]).is_empty();
        let damping = block.limits.as_ref().map(|limits| limits.own.damping.0[lane]);
        let damped = damping.is_some_and(|damping| damping != T::from_f64(0.0));
        // Projections onto constraints have other bits in lanes.
        let held = const { Layouts::<S, N>::HELD };
        alone |= u32::from(!open || !whole || damped || held) << lane;
    }
    if alone != working {
        let kept = block.numbers().map(|numbers| *numbers);
        let cold = &bucket.cold[k];
        widest(Open { block: &mut *block, cold, batch, tick, doubtful: &mut alone });
        alone &= working;
        for lane in (0..W).filter(|lane| working & !alone & (1 << lane) == 0) {
            for (numbers, kept) in block.numbers_mut().into_iter().zip(&kept) {
                copy_lane(numbers, kept, lane);
            }
        }
    }
    for lane in (0..W).filter(|lane| alone & (1 << lane) != 0) {
        run_one(bucket, prototype, world, tick, (block, k * W + lane));
    }
}

/// Advances the pendulum in a slot by a tick. A pendulum that fails keeps its state at the beginning
/// of the tick.
fn run_one<S: SceneSystem<T, N>, T: Float, const N: usize>(
    bucket: &Bucket<S, T, N>,
    prototype: &S,
    world: &World<T>,
    tick: usize,
    (block, slot): (&mut Block<S, T, N>, usize),
) {
    let Some(mut limited) = block.limited.take() else { return };
    let Limited { standing, alone } = &mut *limited;
    let lane = slot % W;
    let standing = &mut standing[lane];
    bucket.copy(block, slot, alone);
    let mut parameters = alone.parameters.iter();
    let system = prototype.map(|parameter| parameters.next().copied().unwrap_or(parameter));
    let hung = Hung { system, world, pendulum: &*alone };
    let (mut state, before) = (alone.state, *standing);
    let (now, substeps) = (world.clock.tick() + tick as i64, bucket.kind.grid.substeps);
    if hung.advance(now, substeps, &mut state, standing).is_err() {
        let ([q, _, v, ..], zero) = (alone.state, [T::from_f64(0.0); N]);
        (state, *standing) = ([q, zero, v, zero, q, v], before);
        block.failed |= 1 << lane;
        block.failed_at[lane] = tick as u8;
    }
    block.set_numbers(lane, &state);
    block.limited = Some(limited);
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    /// Repeats the tick of a batch in which a pendulum has failed in shorter steps, until two lengths
    /// agree, continues to the end of the batch, and returns `true` if it succeeds. Steps fit small
    /// motions; on a joint that is shaken, a pendulum may be many times as fast.
    pub(super) fn repeat(&mut self, world: &World<T>, ticks: usize, (id, at): &mut Failed) -> bool {
        let Location { bucket, slot } = self.table[*id as usize];
        let (k, lane) = (slot as usize / W, slot as usize % W);
        loop {
            let detached = self.read(*id);
            let plain = const { !Layouts::<S, N>::LIMITED } && detached.limits == Limits::none();
            let tick = world.clock.tick() + i64::from(*at);
            let (hung, shorter) = (self.hung(world, &detached), if plain { 4 } else { 0 });
            let substeps = self.kind_of(*id).grid.substeps;
            let mut found: Option<[[T; N]; 6]> = None;
            for more in &[8, 32, 128, 512][..shorter] {
                let (mut state, mut standing) = (detached.state, detached.standing);
                if hung.advance(tick, more * substeps, &mut state, &mut standing).is_ok() {
                    let before = found.replace(state);
                    let agrees = |before: [[T; N]; 6]| {
                        (0..N).all(|i| Real::abs(before[0][i] - state[0][i]).to_f64() <= AGREE)
                    };
                    if before.is_some_and(agrees) {
                        break;
                    }
                }
            }
            let Some(state) = found else { return false };
            let bucket = &mut self.buckets[bucket as usize];
            bucket.blocks[k].set_numbers(lane, &state);
            let first = usize::from(*at) + 1;
            if first == ticks {
                return true;
            }
            // The other lanes have taken these ticks.
            let mut blocks = core::mem::take(&mut bucket.blocks);
            let (block, cold) = (&mut blocks[k..=k], &bucket.cold[k..=k]);
            let kept = block[0].numbers().map(|numbers| *numbers);
            let batch = Batch { first, ..bucket.batch(world, ticks) };
            widest(Run { blocks: block, cold, lanes_of_last: W, batch: &batch });
            let block = &mut blocks[k];
            for (numbers, kept) in block.numbers_mut().into_iter().zip(&kept) {
                (0..W)
                    .filter(|&other| other != lane)
                    .for_each(|lane| copy_lane(numbers, kept, lane));
            }
            let failed = core::mem::take(&mut block.failed) & (1 << lane) != 0;
            *at = block.failed_at[lane];
            bucket.blocks = blocks;
            if !failed {
                return true;
            }
        }
    }
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Hung<'_, S, T, N> {
    /// Advances a state of the pendulum, with the states of its limits, by a tick.
    ///
    /// # Errors
    /// Returns the error of a step.
    fn advance(
        &self,
        tick: i64,
        substeps: u32,
        state: &mut [[T; N]; 6],
        standing: &mut Standings,
    ) -> Result<(), Error> {
        let (clock, [q, q_low, v, v_low, ..]) = (&self.world.clock, *state);
        let mut end = Endpoint {
            t: Time::new(clock.time(tick)),
            q: Compensated { high: q, low: q_low },
            v: Compensated { high: v, low: v_low },
            a: None,
        };
        let (step, t) = (clock.step() / f64::from(substeps), clock.time(tick + 1));
        limits::advance(self, Rk4, step, t, (&mut end, standing))?;
        *state = [end.q.high, end.q.low, end.v.high, end.v.low, q, v];
        Ok(())
    }

    /// Returns `true` if a tick moves no coordinate by more than `least` and ends no contact.
    pub(super) fn stays(&self, tick: i64, substeps: u32, least: T) -> bool {
        let (mut state, mut standing) = (self.pendulum.state, self.pendulum.standing);
        let advanced = self.advance(tick, substeps, &mut state, &mut standing);
        let near = |i| Real::abs(state[0][i] - self.pendulum.state[0][i]) <= least;
        advanced.is_ok() && standing == self.pendulum.standing && (0..N).all(near)
    }

    /// Returns the error of a tick of a pendulum with limits that begins with its state.
    pub(super) fn failure(&self, tick: i64, substeps: u32) -> Option<Error> {
        let (mut state, mut standing) = (self.pendulum.state, self.pendulum.standing);
        self.advance(tick, substeps, &mut state, &mut standing).err()
    }
}
