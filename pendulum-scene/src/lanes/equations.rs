//! The accelerations of a block of lanes: for all lanes at once, or for eight at a time if the
//! equations are long.

#![allow(clippy::inline_always)]

use crate::lanes::limits::LaneLimits;
use crate::sampling::followed::Inputs;
use crate::system::{Layouts, OctetOf, SceneSystem, W, Wide, WideOf, octet};
use core::hint::black_box;
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::system::{InLanes, InOctets, LaneSystem, Numbers, Samples, Staged, System};

/// The equations of a block.
pub(super) struct Equations<
    'a,
    S: LaneSystem<InLanes<W>, N> + LaneSystem<InOctets, N>,
    const N: usize,
> {
    pub(super) system: &'a WideOf<S, N>,
    pub(super) prepared: &'a <WideOf<S, N> as System<N>>::Prepared,
    pub(super) octets: &'a [(OctetOf<S, N>, <OctetOf<S, N> as System<N>>::Prepared)],
}

/// The inputs of eight lanes as a source of numbers.
struct Part<'a, I> {
    inputs: &'a I,
    part: usize,
}

impl<T: Float, I: Samples<Wide<T>>> Numbers<Octet<T>> for Part<'_, I> {
    #[inline(always)]
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> Octet<T> {
        match self.inputs.number(input, derivative, component) {
            Some(lanes) => octet(lanes, self.part),
            None => Octet::from_f64(0.0),
        }
    }
}

/// The accelerations at the stages of a step. A trait, because closures may not be inlined, and
/// would then be compiled for another instruction set.
pub(super) trait Slopes<L, const N: usize> {
    fn at(&self, stage: usize, q: &[L; N], v: &[L; N]) -> [L; N];
}

/// The stages of all lanes of a block.
pub(super) struct Whole<'a, S: SceneSystem<T, N>, T: Float, const N: usize, const K: usize> {
    pub(super) equations: &'a Equations<'a, S, N>,
    pub(super) times: &'a [Wide<T>; K],
    pub(super) inputs: &'a [Inputs<S, N>; K],
    pub(super) limits: Option<&'a LaneLimits<Wide<T>, N>>,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize, const K: usize> Slopes<Wide<T>, N>
    for Whole<'_, S, T, N, K>
{
    #[inline(always)]
    fn at(&self, stage: usize, q: &[Wide<T>; N], v: &[Wide<T>; N]) -> [Wide<T>; N] {
        let Self { equations, times, inputs, limits } = self;
        accelerations(equations, times[stage], &inputs[stage], q, v, *limits)
    }
}

/// Computes the accelerations including those of soft stops.
#[inline(always)]
pub(super) fn accelerations<S: SceneSystem<T, N>, T: Float, const N: usize>(
    equations: &Equations<'_, S, N>,
    t: Wide<T>,
    inputs: &Inputs<S, N>,
    q: &[Wide<T>; N],
    v: &[Wide<T>; N],
    limits: Option<&LaneLimits<Wide<T>, N>>,
) -> [Wide<T>; N] {
    let Equations { system, prepared, octets } = equations;
    let mut a;
    if const { Layouts::<S, N>::LONG } {
        a = [Wide::from_f64(0.0); N];
        // A number of octets that the compiler knows would make it write out the equations as
        // often.
        for (part, (system, prepared)) in black_box(*octets).iter().enumerate() {
            let inputs = Samples::from_numbers(&mut Part { inputs, part });
            let (t, mut state) = (octet(&t, part), [[Octet::from_f64(0.0); N]; 2]);
            for i in 0..N {
                (state[0][i], state[1][i]) = (octet(&q[i], part), octet(&v[i], part));
            }
            let at_time = OctetOf::<S, N>::at_time(t, &inputs);
            let at = system.at_position(prepared, &at_time, t, &state[0], &inputs);
            let [q, v] = &state;
            let own = system.accelerations_staged(prepared, &at_time, &at, t, q, v, &inputs);
            for i in 0..N {
                a[i].0.as_chunks_mut().0[part] = own[i].0;
            }
        }
    } else {
        let at_time = WideOf::<S, N>::at_time(t, inputs);
        let at = system.at_position(prepared, &at_time, t, q, inputs);
        a = system.accelerations_staged(prepared, &at_time, &at, t, q, v, inputs);
    }
    if let Some(limits) = limits {
        limits.push(q, &mut a);
    }
    a
}
