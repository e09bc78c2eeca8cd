//! Ticks of blocks of long equations, eight lanes after the other: their intermediate values stay
//! in the first cache.

#![allow(clippy::inline_always)]

use crate::lanes::block::{Block, ColdData};
use crate::lanes::equations::Slopes;
use crate::lanes::kernel::Batch;
use crate::lanes::limits::LaneLimits;
use crate::lanes::steps::{decay, project, runge_kutta, stop};
use crate::sampling::followed::Followed;
use crate::system::{Layouts, OctetOf, SceneSystem, octet};
use core::hint::black_box;
use pendulum_core::integrate::method::Compensated;
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::system::{MOST_CONTROLS, Samples, Staged, scalar_time};

/// The stages of eight lanes.
struct Eight<'a, S: Staged<N>, const N: usize> {
    system: &'a S,
    prepared: &'a S::Prepared,
    times: &'a [S::Scalar; 3],
    inputs: &'a [S::Inputs; 3],
    limits: Option<&'a LaneLimits<S::Scalar, N>>,
}

impl<S: Staged<N>, const N: usize> Slopes<S::Scalar, N> for Eight<'_, S, N> {
    #[inline(always)]
    fn at(&self, stage: usize, q: &[S::Scalar; N], v: &[S::Scalar; N]) -> [S::Scalar; N] {
        let (t, inputs) = (self.times[stage], &self.inputs[stage]);
        let at_time = S::at_time(t, inputs);
        let at = self.system.at_position(self.prepared, &at_time, t, q, inputs);
        let mut a = self.system.accelerations_staged(self.prepared, &at_time, &at, t, q, v, inputs);
        if let Some(limits) = self.limits {
            limits.push(q, &mut a);
        }
        a
    }
}

/// Advances a block by a tick with RK4.
#[inline(always)]
pub(super) fn tick_of_octets<S: SceneSystem<T, N>, T: Float, const N: usize>(
    block: &mut Block<S, T, N>,
    cold: &ColdData<S, T, N>,
    batch: &Batch<'_, T>,
    followed: &Followed<'_, T>,
    tick: usize,
) {
    // A number of octets that the compiler knows would make it write out the equations as often.
    for (part, (system, prepared)) in black_box(&cold.octets[..]).iter().enumerate() {
        let limits = block.limits.as_ref().map(|limits| limits.octet(part));
        let limits = limits.as_ref();
        let mut q = Compensated::new([Octet::from_f64(0.0); N]);
        let mut v = q;
        for i in 0..N {
            (q.high[i], q.low[i]) = (octet(&block.q.high[i], part), octet(&block.q.low[i], part));
            (v.high[i], v.low[i]) = (octet(&block.v.high[i], part), octet(&block.v.low[i], part));
        }
        for step in 0..batch.grid.substeps as usize {
            let first = 3 * (tick * batch.grid.substeps as usize + step);
            let evaluations = [first, first + 1, first + 2];
            let times = evaluations.map(|index| Octet::splat(scalar_time(batch.times[index])));
            let [a, b, c] = if batch.still { [0; 3] } else { evaluations };
            let mut inputs = [
                followed.octet::<S, N>(a, part),
                followed.octet::<S, N>(b, part),
                followed.octet::<S, N>(c, part),
            ];
            if const { 0 < Layouts::<S, N>::CONTROLS } {
                let mut own = [Octet::from_f64(0.0); MOST_CONTROLS];
                for (own, lanes) in own.iter_mut().zip(&cold.controls) {
                    *own = octet(lanes, part);
                }
                for inputs in &mut inputs {
                    inputs.set_controls(Layouts::<S, N>::DRIVEN, &own);
                }
            }
            let (times, inputs) = (&times, &inputs);
            let slopes = Eight::<OctetOf<S, N>, N> { system, prepared, times, inputs, limits };
            decay(&mut v, limits);
            let h = Octet::from_f64(batch.h);
            let may_be_length = &Layouts::<S, N>::MAY_BE_LENGTH;
            runge_kutta(h, &slopes, &mut q, &mut v, may_be_length, limits);
            stop(&mut q, &mut v, limits);
            decay(&mut v, limits);
            if const { Layouts::<S, N>::HELD } {
                project(system, T::EPSILON, times[2], &inputs[2], &mut q, &mut v);
            }
        }
        for i in 0..N {
            block.q.high[i].0.as_chunks_mut().0[part] = q.high[i].0;
            block.q.low[i].0.as_chunks_mut().0[part] = q.low[i].0;
            block.v.high[i].0.as_chunks_mut().0[part] = v.high[i].0;
            block.v.low[i].0.as_chunks_mut().0[part] = v.low[i].0;
        }
    }
}
