//! The steps of pendulums with limits, one pendulum after the other: those of single runs, by the
//! same code.

use crate::group::hung::Hung;
use crate::lanes::block::{Block, Limited};
use crate::lanes::bucket::{Bucket, Failed};
use crate::lanes::limits::Standings;
use crate::sampling::world::World;
use crate::system::{SceneSystem, W};
use crate::threads::{part, share};
use pendulum_core::error::Error;
use pendulum_core::integrate::method::{Compensated, Endpoint};
use pendulum_core::integrate::{Rk4, limits};
use pendulum_core::scalar::{Float, Lane};
use pendulum_core::time::Time;

/// Advances the awake pendulums of a bucket by a batch of ticks, and appends those that fail to
/// `failed`.
pub(super) fn run<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>(
    bucket: &mut Bucket<S, T, N>,
    prototype: &S,
    world: &World<T>,
    ticks: usize,
    fork: bool,
    failed: &mut Vec<Failed>,
) {
    if bucket.awake == 0 {
        return;
    }
    let mut blocks = core::mem::take(&mut bucket.blocks);
    let (count, all) = (bucket.awake.div_ceil(W), &*bucket);
    let part = part(count, 1, fork);
    share(blocks[..count].chunks_mut(part).enumerate(), |(index, blocks)| {
        for (block, k) in blocks.iter_mut().zip(index * part..) {
            for slot in k * W..all.awake.min((k + 1) * W) {
                run_one(all, prototype, world, ticks, (block, slot));
            }
        }
    });
    bucket.blocks = blocks;
    bucket.collect_failed(failed);
}

/// Advances the pendulum in a slot. A pendulum that fails keeps its state at the beginning of the
/// tick.
fn run_one<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>(
    bucket: &Bucket<S, T, N>,
    prototype: &S,
    world: &World<T>,
    ticks: usize,
    (block, slot): (&mut Block<S, T, N>, usize),
) {
    let Some(mut limited) = block.limited.take() else { return };
    let Limited { standing, alone } = &mut *limited;
    let lane = slot % W;
    let standing = &mut standing[lane];
    bucket.copy(block, slot, alone);
    let mut state = alone.state;
    let mut parameters = alone.parameters.iter();
    let system = prototype.map(|parameter| parameters.next().copied().unwrap_or(parameter));
    let hung = Hung { system, world, pendulum: &*alone };
    for tick in 0..ticks {
        let ([q, _, v, ..], before) = (state, *standing);
        let (now, substeps) = (world.clock.tick() + tick as i64, bucket.kind.grid.substeps);
        if hung.advance(now, substeps, &mut state, standing).is_err() {
            let zero = [T::from_f64(0.0); N];
            (state, *standing) = ([q, zero, v, zero, q, v], before);
            block.failed |= 1 << lane;
            block.failed_at[lane] = tick as u8;
            break;
        }
    }
    for (lanes, numbers) in block.numbers_mut().into_iter().zip(&state) {
        for i in 0..N {
            lanes[i].0[lane] = numbers[i];
        }
    }
    block.limited = Some(limited);
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Hung<'_, S, T, N> {
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

    /// Returns the error of a tick of a pendulum with limits that begins with its state.
    pub(super) fn failure(&self, tick: i64, substeps: u32) -> Option<Error> {
        let (mut state, mut standing) = (self.pendulum.state, self.pendulum.standing);
        self.advance(tick, substeps, &mut state, &mut standing).err()
    }
}
