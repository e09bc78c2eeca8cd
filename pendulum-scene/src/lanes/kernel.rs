//! The steps of a block of lanes in a batch of ticks.
//!
//! All functions are inlined into the code that [`simd`](pendulum_core::simd) compiles for several
//! instruction sets. Each lane has the same bits as the scalar methods in
//! [`integrate`](pendulum_core::integrate).

#![allow(clippy::inline_always)]

use crate::lanes::block::{Block, ColdData};
use crate::lanes::equations::{Equations, Slopes, Whole};
use crate::lanes::limits::{LaneLimits, half_decay};
use crate::lanes::octets::tick_of_octets;
use crate::lanes::steps::{decay, drift, project, runge_kutta, stop};
use crate::sampling::followed::{Followed, Inputs, nothing};
use crate::sampling::scheme::{Grid, MOST_STAGES, Scheme};
use crate::sampling::tracks::{Piece, Tracks};
use crate::system::{Layouts, SceneSystem, W, Wide, WideOf};
use core::sync::atomic::{AtomicBool, Ordering};
use pendulum_core::integrate::method::Compensated;
use pendulum_core::integrate::{Leapfrog, Srkn6b};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::simd::Work;
use pendulum_core::system::{At, Samples, System, scalar_time};
use pendulum_core::time::Time;

/// The data of a batch of ticks that all blocks of a bucket share.
pub(crate) struct Batch<'a, T> {
    pub(crate) grid: Grid,
    /// The length of a step.
    pub(crate) h: f64,
    /// The number of ticks, and the first one to be computed.
    pub(crate) ticks: usize,
    pub(crate) first: usize,
    /// The times of all evaluations.
    pub(crate) times: &'a [Time],
    pub(crate) tracks: &'a Tracks<T>,
    /// `true` if all joints rest for ever, so that each track has one record.
    pub(crate) still: bool,
    /// `true` if a lane has failed.
    pub(crate) failed: AtomicBool,
}

/// The computation of a batch for several blocks. The last block has `lanes_of_last` awake lanes.
pub(crate) struct Run<'a, S: SceneSystem<T, N>, T: Float, const N: usize> {
    pub(crate) blocks: &'a mut [Block<S, T, N>],
    /// The rarely read data of the blocks.
    pub(crate) cold: &'a [ColdData<S, T, N>],
    pub(crate) lanes_of_last: usize,
    pub(crate) batch: &'a Batch<'a, T>,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Work for Run<'_, S, T, N> {
    #[inline(always)]
    fn run(self) {
        let last = self.blocks.len().wrapping_sub(1);
        for (index, (block, cold)) in self.blocks.iter_mut().zip(self.cold).enumerate() {
            let lanes = if index == last { self.lanes_of_last } else { W };
            let kept = (lanes < W).then_some(block.numbers().map(|numbers| *numbers));
            match self.batch.grid.scheme {
                Scheme::Leapfrog if Layouts::<S, N>::SPLITS => {
                    batch::<S, T, N, LEAPFROG, 1>(block, cold, self.batch);
                }
                Scheme::Srkn6b if Layouts::<S, N>::SPLITS => {
                    batch::<S, T, N, SRKN6B, 7>(block, cold, self.batch);
                }
                _ => batch::<S, T, N, RK4, 3>(block, cold, self.batch),
            }
            if let Some(kept) = kept {
                // Restores the lanes that are not awake.
                for (numbers, kept) in block.numbers_mut().into_iter().zip(&kept) {
                    (lanes..W).for_each(|lane| copy_lane(numbers, kept, lane));
                }
                block.failed &= (1 << lanes) - 1;
            }
            if block.failed != 0 {
                self.batch.failed.store(true, Ordering::Relaxed);
            }
        }
    }
}

const LEAPFROG: u8 = 0;
const SRKN6B: u8 = 1;
pub(super) const RK4: u8 = 2;

#[inline(always)]
pub(crate) fn copy_lane<T: Copy, const N: usize>(
    to: &mut [Wide<T>; N],
    from: &[Wide<T>; N],
    lane: usize,
) {
    for i in 0..N {
        to[i].0[lane] = from[i].0[lane];
    }
}

/// The weights of a step, multiplied by its length.
pub(super) struct Weights<T> {
    outer: [Wide<T>; MOST_STAGES],
    inner: [Wide<T>; MOST_STAGES],
    h: Wide<T>,
}

impl<T: Float> Weights<T> {
    #[inline(always)]
    pub(super) fn new<const SCHEME: u8>(lanes: impl Fn(f64) -> Wide<T>) -> Self {
        let zero = Wide::from_f64(0.0);
        let mut weights = Self { outer: [zero; MOST_STAGES], inner: [zero; MOST_STAGES], h: zero };
        let (outer, inner): (&[f64], &[f64]) = match SCHEME {
            LEAPFROG => (&Leapfrog::SPLITTING.outer, &Leapfrog::SPLITTING.inner),
            SRKN6B => (&Srkn6b::SPLITTING.outer, &Srkn6b::SPLITTING.inner),
            _ => (&[], &[]),
        };
        for (to, &weight) in weights.outer.iter_mut().zip(outer) {
            *to = lanes(weight);
        }
        for (to, &weight) in weights.inner.iter_mut().zip(inner) {
            *to = lanes(weight);
        }
        weights.h = lanes(1.0);
        weights
    }
}

#[inline(always)]
fn batch<S: SceneSystem<T, N>, T: Float, const N: usize, const SCHEME: u8, const K: usize>(
    block: &mut Block<S, T, N>,
    cold: &ColdData<S, T, N>,
    batch: &Batch<'_, T>,
) {
    let ColdData { system, octets, controls, .. } = cold;
    let stages = K;
    let weights = Weights::<T>::new::<SCHEME>(|weight| Wide::from_f64(weight * batch.h));
    let layout = const { &Layouts::<S, N>::FORCES };
    let zero = T::from_f64(0.0);
    let track = block.track;
    let followed = Followed::new(batch.tracks, layout, &track);
    let mut inputs = [nothing::<S, T, N>(); K];
    if batch.still && 0 < layout.width {
        inputs = [followed.inputs::<S, N>(0); K];
    }
    for inputs in &mut inputs {
        control::<S, T, N>(inputs, controls);
    }
    let mut times = [Wide::from_f64(0.0); K];
    for tick in batch.first..batch.ticks {
        block.before = [block.q.high, block.v.high];
        if batch.tracks.any_cut()
            && block.track.iter().any(|&track| !batch.tracks.pieces(tick, track).is_empty())
        {
            cut_tick::<S, T, N, SCHEME, K>(block, cold, batch, tick);
        } else if const { Layouts::<S, N>::LONG && SCHEME == RK4 } {
            tick_of_octets(block, cold, batch, &followed, tick);
        } else {
            for step in 0..batch.grid.substeps as usize {
                let evaluation = (tick * batch.grid.substeps as usize + step) * stages;
                for stage in 0..stages {
                    times[stage] = Wide::splat(scalar_time(batch.times[evaluation + stage]));
                }
                if !batch.still && 0 < layout.width {
                    for stage in 0..stages {
                        inputs[stage] = followed.inputs::<S, N>(evaluation + stage);
                        control::<S, T, N>(&mut inputs[stage], controls);
                    }
                }
                let Block { prepared, q, v, limits, .. } = &mut *block;
                let equations = Equations { system, prepared, octets };
                let limits = limits.as_deref();
                step_of::<S, T, N, SCHEME, K>(&equations, &weights, &times, &inputs, q, v, limits);
            }
        }
        // 0·x is zero for finite x, and NaN for infinities and NaN.
        let mut finite = Wide::from_f64(0.0);
        for i in 0..N {
            finite += block.q.high[i] * Wide::from_f64(0.0);
            finite += block.v.high[i] * Wide::from_f64(0.0);
        }
        let mut all = block.failed == 0;
        for lane in 0..W {
            all &= finite.0[lane] == zero;
        }
        if !all {
            freeze(block, &finite, tick);
        }
    }
}

/// Restores the state at the beginning of the tick in lanes that are not finite, in this tick and
/// all further ticks of the batch.
#[cold]
#[inline(never)]
fn freeze<S: SceneSystem<T, N>, T: Float, const N: usize>(
    block: &mut Block<S, T, N>,
    finite: &Wide<T>,
    tick: usize,
) {
    for lane in 0..W {
        let bit = 1 << lane;
        if block.failed & bit == 0 {
            if finite.0[lane] == T::from_f64(0.0) {
                continue;
            }
            block.failed |= bit;
            block.failed_at[lane] = tick as u8;
        }
        for i in 0..N {
            (block.q.high[i].0[lane], block.q.low[i].0[lane]) =
                (block.before[0][i].0[lane], T::from_f64(0.0));
            (block.v.high[i].0[lane], block.v.low[i].0[lane]) =
                (block.before[1][i].0[lane], T::from_f64(0.0));
        }
    }
}

/// Sets the control inputs of all lanes.
#[inline(always)]
pub(super) fn control<S: SceneSystem<T, N>, T: Float, const N: usize>(
    inputs: &mut Inputs<S, N>,
    controls: &[Wide<T>],
) {
    if const { 0 < Layouts::<S, N>::CONTROLS } {
        inputs.set_controls(Layouts::<S, N>::DRIVEN, controls);
    }
}

#[inline(always)]
pub(super) fn step_of<
    S: SceneSystem<T, N>,
    T: Float,
    const N: usize,
    const SCHEME: u8,
    const K: usize,
>(
    equations: &Equations<'_, S, N>,
    weights: &Weights<T>,
    times: &[Wide<T>; K],
    inputs: &[Inputs<S, N>; K],
    q: &mut Compensated<Wide<T>, N>,
    v: &mut Compensated<Wide<T>, N>,
    limits: Option<&LaneLimits<Wide<T>, N>>,
) {
    decay(v, limits);
    let slopes = Whole { equations, times, inputs, limits };
    match SCHEME {
        LEAPFROG => {
            drift(weights.outer[0], q, v, limits);
            let a = slopes.at(0, &q.high, &v.high);
            v.add(weights.inner[0], &a);
            drift(weights.outer[1], q, v, limits);
        }
        SRKN6B => {
            for i in 0..7 {
                let a = slopes.at(i, &q.high, &v.high);
                v.add(weights.outer[i], &a);
                if i < 6 {
                    drift(weights.inner[i], q, v, limits);
                }
            }
        }
        _ => {
            runge_kutta(weights.h, &slopes, q, v, &Layouts::<S, N>::MAY_BE_LENGTH, limits);
            stop(q, v, limits);
        }
    }
    decay(v, limits);
    if const { Layouts::<S, N>::HELD } {
        project(equations.system, T::EPSILON, times[K - 1], &inputs[K - 1], q, v);
    }
}

/// Computes a tick that is cut at kinks, with different pieces in each lane.
#[cold]
#[inline(never)]
fn cut_tick<S: SceneSystem<T, N>, T: Float, const N: usize, const SCHEME: u8, const K: usize>(
    block: &mut Block<S, T, N>,
    cold: &ColdData<S, T, N>,
    batch: &Batch<'_, T>,
    tick: usize,
) {
    let ColdData { system, octets, controls, .. } = cold;
    let stages = K;
    let substeps = batch.grid.substeps as usize;
    let layout = const { &Layouts::<S, N>::FORCES };
    let pieces = block.track.map(|track| batch.tracks.pieces(tick, track));
    let steps = pieces
        .iter()
        .map(|pieces| if pieces.is_empty() { substeps } else { pieces.len() })
        .max()
        .unwrap_or(0);
    for step in 0..steps {
        let mut active = [true; W];
        let mut lengths = [batch.h; W];
        let mut times = [Wide::from_f64(0.0); K];
        for lane in 0..W {
            let whole = pieces[lane].is_empty();
            active[lane] = step < if whole { substeps } else { pieces[lane].len() };
            if !active[lane] {
                continue;
            }
            if !whole {
                lengths[lane] = pieces[lane][step].h;
            }
            for stage in 0..stages {
                let evaluation = (tick * substeps + step) * stages + stage;
                let t =
                    if whole { batch.times[evaluation] } else { pieces[lane][step].times[stage] };
                times[stage].0[lane] = scalar_time(t);
            }
        }
        let mut inputs = [nothing::<S, T, N>(); K];
        for (stage, inputs) in inputs.iter_mut().enumerate().take(stages) {
            *inputs = Samples::from_numbers(&mut |input, derivative, component| {
                let mut lanes = Wide::from_f64(0.0);
                let Some(place) = layout.place(input, derivative, component) else { return lanes };
                for lane in (0..W).filter(|&lane| active[lane]) {
                    lanes.0[lane] = if let Some(piece) = pieces[lane].get(step) {
                        batch.tracks.piece_records()[piece.begin + stage * layout.width + place]
                    } else {
                        let evaluation = (tick * substeps + step) * stages + stage;
                        batch.tracks.record(block.track[lane], evaluation, layout.width)[place]
                    };
                }
                lanes
            });
            control::<S, T, N>(inputs, controls);
        }
        let weights = Weights::<T>::new::<SCHEME>(|weight| {
            let mut lanes = Wide::from_f64(0.0);
            for lane in 0..W {
                lanes.0[lane] = T::from_f64(weight * lengths[lane]);
            }
            lanes
        });
        let limits = block.limits.as_deref().map(|limits| {
            let mut limits = limits.clone();
            for lane in 0..W {
                limits.factor.0[lane] = half_decay(limits.own.damping.0[lane], lengths[lane]);
            }
            limits
        });
        let (mut q, mut v) = (block.q, block.v);
        let equations = Equations { system, prepared: &block.prepared, octets };
        let limits = limits.as_ref();
        step_of::<S, T, N, SCHEME, K>(
            &equations, &weights, &times, &inputs, &mut q, &mut v, limits,
        );
        for lane in (0..W).filter(|&lane| active[lane]) {
            copy_lane(&mut block.q.high, &q.high, lane);
            copy_lane(&mut block.q.low, &q.low, lane);
            copy_lane(&mut block.v.high, &v.high, lane);
            copy_lane(&mut block.v.low, &v.low, lane);
        }
        cross::<S, T, N>(block, system, batch, &pieces.map(|pieces| pieces.get(step)));
    }
}

/// Updates the velocities at the kinks at the ends of the last pieces, so that the momenta are
/// continuous.
fn cross<S: SceneSystem<T, N>, T: Float, const N: usize>(
    block: &mut Block<S, T, N>,
    system: &WideOf<S, N>,
    batch: &Batch<'_, T>,
    pieces: &[Option<&Piece>; W],
) {
    let layout = const { &Layouts::<S, N>::MOMENTA };
    let records = batch.tracks.piece_records();
    let mut jumps = [None; W];
    for lane in 0..W {
        if let Some((time, begin)) = pieces[lane].and_then(|piece| piece.jump)
            && records[begin..][..layout.width] != records[begin + layout.width..][..layout.width]
        {
            jumps[lane] = Some((time, begin));
        }
    }
    if jumps.iter().all(Option::is_none) {
        return;
    }
    let side = |after: usize| -> Inputs<S, N> {
        Samples::from_numbers(&mut |input, derivative, component| {
            let mut lanes = Wide::from_f64(0.0);
            if let Some(place) = layout.place(input, derivative, component) {
                for lane in 0..W {
                    if let Some((_, begin)) = jumps[lane] {
                        lanes.0[lane] = records[begin + after * layout.width + place];
                    }
                }
            }
            lanes
        })
    };
    let mut t = Wide::from_f64(0.0);
    for lane in 0..W {
        t.0[lane] = T::from_f64(jumps[lane].map_or(0.0, |(time, _)| time));
    }
    let (q, v) = (block.q.high, block.v.high);
    let momenta = system.momenta(At { t, q: &q, v: &v, inputs: &side(0) });
    let mut velocities = system.velocities(t, &q, &momenta, &side(1));
    if const { Layouts::<S, N>::HELD } {
        // A constraint whose velocity jumps exerts an impulse.
        let after = side(1);
        let at = At { t, q: &q, v: &velocities, inputs: &after };
        let change = system.correction(at, &system.misfits(at)[1]);
        for i in 0..N {
            velocities[i] -= change[i];
        }
    }
    for lane in (0..W).filter(|&lane| jumps[lane].is_some()) {
        for i in 0..N {
            if velocities[i].0[lane] != v[i].0[lane] {
                (block.v.high[i].0[lane], block.v.low[i].0[lane]) =
                    (velocities[i].0[lane], T::from_f64(0.0));
            }
        }
    }
}
