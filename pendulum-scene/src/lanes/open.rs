//! Ticks of pendulums with limits whose gaps stay open.
//!
//! Each lane has the bits of a single run with RK4, which looks at its gaps at the ends and in the
//! middles of the parts of each step. Lanes look at the same places, and leave to the single run what
//! it would have to search.

#![allow(clippy::inline_always)]

use crate::lanes::block::{Block, ColdData};
use crate::lanes::equations::{Equations, accelerations};
use crate::lanes::kernel::{Batch, RK4, Weights, control, step_of};
use crate::sampling::followed::{Followed, Inputs, nothing};
use crate::sampling::scheme::PLACES;
use crate::system::{Layouts, SceneSystem, W, Wide, WideOf};
use pendulum_core::integrate::limits::{PARTS, stays_open};
use pendulum_core::integrate::method::Compensated;
use pendulum_core::scalar::{Float, Real};
use pendulum_core::simd::Work;
use pendulum_core::system::{At, MOST_LIMITS, System, scalar_time};

/// The computation of a tick for a block.
pub(crate) struct Open<'a, S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) block: &'a mut Block<S, T, N>,
    pub(crate) cold: &'a ColdData<S, T, N>,
    pub(crate) batch: &'a Batch<'a, T>,
    pub(crate) tick: usize,
    /// The lanes, by bit, whose gaps may close or whose states are not finite.
    pub(crate) doubtful: &'a mut u32,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Work for Open<'_, S, T, N> {
    #[inline(always)]
    fn run(self) {
        let Self { block, cold, batch, tick, doubtful } = self;
        let ColdData { system, octets, controls, .. } = cold;
        let weights = Weights::<T>::new::<RK4>(|weight| Wide::from_f64(weight * batch.h));
        let layout = const { &Layouts::<S, N>::FORCES };
        let track = block.track;
        let followed = Followed::new(batch.tracks, layout, &track);
        let substeps = batch.grid.substeps as usize;
        block.before = [block.q.high, block.v.high];
        for step in 0..substeps {
            let first = (tick * substeps + step) * PLACES;
            let time = |place: usize| Wide::splat(scalar_time(batch.times[first + place]));
            let inputs = |place: usize| {
                let mut inputs = nothing::<S, T, N>();
                if 0 < layout.width {
                    inputs = followed.inputs::<S, N>(if batch.still { 0 } else { first + place });
                }
                control::<S, T, N>(&mut inputs, controls);
                inputs
            };
            let from = [block.q, block.v];
            let stages = [0, PARTS, 2 * PARTS];
            let (times, sampled) = (stages.map(time), stages.map(inputs));
            let equations = Equations { system, prepared: &block.prepared, octets };
            let a = |stage: usize, [q, v]: &[Compensated<Wide<T>, N>; 2]| {
                let inputs = &sampled[stage];
                let t = times[stage];
                accelerations(&equations, t, inputs, &q.high, &v.high, None)
            };
            let start = a(0, &from);
            let mut to = from;
            let [q, v] = &mut to;
            step_of::<S, T, N, RK4, 3>(&equations, &weights, &times, &sampled, q, v, None);
            let motion = Quintic::new(Wide::from_f64(batch.h), &from, &to, &start, &a(2, &to));
            let look = |place: usize| {
                let (q, v) = match place {
                    0 => (from[0].high, from[1].high),
                    place if place == 2 * PARTS => (to[0].high, to[1].high),
                    place => motion.at(place as f64 / (2 * PARTS) as f64),
                };
                gaps::<S, T, N>(system, time(place), &inputs(place), &q, &v)
            };
            let mut last = look(0);
            for part in 0..PARTS {
                let (middle, end) = (look(2 * part + 1), look(2 * part + 2));
                for limit in 0..S::FACTS.limits.len() {
                    for lane in 0..W {
                        let at = |gaps: &[[Wide<T>; MOST_LIMITS]; 2]| {
                            [gaps[0][limit].0[lane].to_f64(), gaps[1][limit].0[lane].to_f64()]
                        };
                        let places = [at(&last), at(&middle), at(&end)];
                        let open = stays_open(batch.h / PARTS as f64, places);
                        *doubtful |= u32::from(!open) << lane;
                    }
                }
                last = end;
            }
            [block.q, block.v] = to;
        }
        for lane in 0..W {
            let (q, v) = block.state(lane);
            let finite = q.iter().chain(&v).all(|number| number.is_finite());
            *doubtful |= u32::from(!finite) << lane;
        }
    }
}

/// Returns the gaps and their rates.
#[inline(always)]
fn gaps<S: SceneSystem<T, N>, T: Float, const N: usize>(
    system: &WideOf<S, N>,
    t: Wide<T>,
    inputs: &Inputs<S, N>,
    q: &[Wide<T>; N],
    v: &[Wide<T>; N],
) -> [[Wide<T>; MOST_LIMITS]; 2] {
    let [gaps, rates, _] = system.gaps(At { t, q, v, inputs });
    [gaps, rates]
}

/// The motion within a step as single runs with RK4 have it: the terms F of coordinates and of
/// velocities of y(θ) = y₀ + θ(F₀ + (1−θ)(F₁ + θ(F₂ + (1−θ)(F₃ + θ F₄)))).
struct Quintic<T, const N: usize> {
    start: [[Wide<T>; N]; 2],
    terms: [[[Wide<T>; 5]; N]; 2],
}

impl<T: Float, const N: usize> Quintic<T, N> {
    /// Creates the polynomials through coordinates, velocities and accelerations at both ends of a
    /// step of the length `h`.
    #[inline(always)]
    fn new(
        h: Wide<T>,
        from: &[Compensated<Wide<T>, N>; 2],
        to: &[Compensated<Wide<T>, N>; 2],
        a: &[Wide<T>; N],
        end: &[Wide<T>; N],
    ) -> Self {
        let number = |value: f64| Wide::from_f64(value);
        let half = number(0.5);
        let [q, v] = [0, 1].map(|part| to[part].since(&from[part]));
        let mut terms = [[[number(0.0); 5]; N]; 2];
        for i in 0..N {
            let (v0, v1) = (from[1].high[i], to[1].high[i]);
            let q1 = h * v0 - q[i];
            let q2 = (q[i] - h * v1) - q1;
            let q3 = h * h * a[i] * half + q1 - q2;
            let q4 = h * h * end[i] * half + q1 + q2 + q2 - q3;
            terms[0][i] = [q[i], q1, q2, q3, q4];
            let speed1 = h * a[i] - v[i];
            let speed2 = (v[i] - h * end[i]) - speed1;
            let rest = (q[i] / h - v0) - v[i] * half - speed1 / number(6.0) - speed2 / number(12.0);
            terms[1][i] = [v[i], speed1, speed2, rest * number(30.0), number(0.0)];
        }
        Self { start: [from[0].high, from[1].high], terms }
    }

    /// Returns the coordinates and the velocities at θ.
    #[inline(always)]
    fn at(&self, theta: f64) -> ([Wide<T>; N], [Wide<T>; N]) {
        let (theta, other) = (Wide::from_f64(theta), Wide::from_f64(1.0 - theta));
        let [q, v] = [0, 1].map(|part| {
            let mut values = self.start[part];
            for i in 0..N {
                let [f0, f1, f2, f3, f4] = self.terms[part][i];
                let inner = theta * (f2 + other * (f3 + theta * f4));
                values[i] += theta * (f0 + other * (f1 + inner));
            }
            values
        });
        (q, v)
    }
}
