//! The results of a step of Picard iteration, and their error.

// The functions of a step are inlined into code that is compiled for several instruction sets.
#![allow(clippy::inline_always)]

use super::lanes::WideOf;
use super::tableau::{BETWEEN, Columns, EIGHT, S, SIXTEEN};
use crate::integrate::methods::dop853;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::short::shortest;
use crate::scalar::{Float, Octet};
use crate::system::{Dynamics, System};
use crate::time::Time;
use core::hint::black_box;

/// The target for the error of a step over the one allowed.
pub(super) const AIM: f64 = 1.0 / 16.0;
/// The accelerations that a rounding error of each coordinate and velocity may cause at a node,
/// over what an error of one machine epsilon does.
const INHERITED: f64 = 4.0;
/// The number of steps that `Dop853` takes where sweeps do not converge.
pub(super) const DETOUR: usize = 24;

/// One number for each node of a vector.
pub(super) type Wide<T> = Octet<T>;

/// The accelerations at the nodes of a step, by vector and coordinate.
pub(super) type Stages<T, const N: usize, const G: usize> = [[Wide<T>; N]; G];

/// The columns of h A and h² A² from the values in `G` vectors to the points of one vector, for
/// steps of one length. They are multiplied once for a length, not in every sweep.
#[derive(Clone, Debug)]
pub(super) struct Scaled<T, const G: usize> {
    h: T,
    pub(super) once: [[[Wide<T>; 1]; S]; G],
    pub(super) twice: [[[Wide<T>; 1]; S]; G],
}

impl<T: Float, const G: usize> Scaled<T, G> {
    pub(super) fn new() -> Self {
        let zero = [[[Wide::splat(T::from_f64(0.0)); 1]; S]; G];
        Self { h: T::from_f64(0.0), once: zero, twice: zero }
    }

    /// Computes the columns for the vector `to` from those of A and A², if the length differs by
    /// more than rounding.
    #[inline(always)]
    pub(super) fn scale<const H: usize>(
        &mut self,
        h: T,
        [once, twice]: [&'static Columns<G, H>; 2],
        to: usize,
    ) {
        if f64::abs(self.h.to_f64() - h.to_f64()) <= 1e-15 * f64::abs(self.h.to_f64()) {
            return;
        }
        self.h = h;
        let (h, square) = (Wide::splat(h), Wide::splat(h * h));
        for g in 0..G {
            for j in 0..S {
                // One column at a time: otherwise the compiler would combine lanes of several
                // columns.
                let (once, twice) = black_box((&once[g][j][to], &twice[g][j][to]));
                self.once[g][j][0] = Wide::<T>::known(once) * h;
                self.twice[g][j][0] = Wide::<T>::known(twice) * square;
            }
        }
    }

    /// Visits the length for which the columns were computed, and recomputes the columns when the
    /// length is restored: a length that differs by rounding would give other digits.
    fn remember<const H: usize>(
        &mut self,
        memory: &mut Memory,
        columns: [&'static Columns<G, H>; 2],
        to: usize,
    ) {
        let mut h = self.h;
        memory.scalar(&mut h);
        if memory.reads() {
            *self = Self::new();
            if h != self.h {
                self.scale(h, columns, to);
            }
        }
    }
}

/// The outcome of an iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress<T> {
    /// The number of sweeps.
    pub(super) sweeps: u32,
    /// The number of vectors evaluated in all sweeps.
    pub(super) vectors: u32,
    /// The square of the last change, over the error allowed.
    pub(super) change: T,
    /// `true` if the remaining error is negligible.
    pub(super) done: bool,
    /// `true` if one sweep less would have been sufficient.
    pub(super) spare: bool,
    /// `true` if the last sweep has evaluated all required vectors.
    pub(super) complete: bool,
}

/// The number of coefficients in the error estimate.
pub(super) const TAIL: usize = 5;

/// The result of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends<T, const N: usize> {
    /// The Legendre coefficients α₁₅, α₁₄, α₁₃, α₁₂ and α₁₆ of the accelerations.
    pub(super) tail: [[T; TAIL]; N],
    /// The accelerations just before the end of the step.
    pub(super) last: [T; N],
    /// The root mean square of the accelerations, in `f64`: the squares of a scalar of fewer bits
    /// may overflow.
    pub(super) size: [f64; N],
    pub(super) progress: Progress<T>,
    /// `true` if the equations are solved.
    pub(super) solved: bool,
    /// The error of the step over the one allowed.
    pub(super) error: f64,
}

impl<T: Float, const N: usize> Ends<T, N> {
    pub(super) fn new() -> Self {
        let zero = [T::from_f64(0.0); N];
        let progress = Progress {
            sweeps: 0,
            vectors: 0,
            change: zero[0],
            done: false,
            spare: false,
            complete: false,
        };
        Self {
            tail: [[zero[0]; TAIL]; N],
            last: zero,
            size: [0.0; N],
            progress,
            solved: false,
            error: 0.0,
        }
    }
}

/// The results of a step, for the next one and for the dense output.
#[derive(Clone, Debug)]
pub struct Workspace<T: Float, P, const N: usize> {
    /// The values that depend only on parameters, over lanes.
    pub(super) prepared: P,
    /// The accelerations at the nodes of the last step and of the current one.
    pub(super) a: [Stages<T, N, 1>; 2],
    /// The accelerations at the points between the nodes and at the start of these steps.
    pub(super) between: [([Wide<T>; N], [T; N]); 2],
    /// `true` if `between` is known: not for steps of fixed length.
    pub(super) between_known: bool,
    /// The index of the last step among the two.
    pub(super) last: usize,
    /// The time, coordinates and velocities at the end of the last step; `None` before the first
    /// step and after steps by `Dop853`.
    pub(super) end: Option<(Time, [T; N], [T; N])>,
    /// The length of the last step.
    pub(super) h: f64,
    pub(super) ends: Ends<T, N>,
    /// The root mean square of the accelerations of the last accepted step.
    pub(super) size: [f64; N],
    /// The accelerations at the end of the last accepted step.
    pub(super) start: [T; N],
    /// `true` if `start` has been computed: fixed steps do not compute it.
    pub(super) start_known: bool,
    /// The columns for steps of the last length: of a sweep, of the first sweep after an equal
    /// step, and of the points between the nodes.
    pub(super) scaled: [Scaled<T, 1>; 3],
    /// The columns of a sweep at sixteen nodes, by vector.
    pub(super) within: [Scaled<T, 2>; 2],
    /// The number of sweeps that the next step is expected to take.
    pub(super) sweeps: u32,
    /// The error in the step that a unit of each acceleration causes, over the error allowed.
    pub(super) weights: [T; N],
    /// The end of the step whose equations were not solved, and the coordinate with the largest
    /// acceleration over the one allowed.
    pub(super) unsolved: Option<(Time, usize)>,
    /// The stages of a step that `Dop853` has taken.
    pub(super) detour: dop853::Stages<T, N>,
    /// `true` if `Dop853` has taken the last step.
    pub(super) on_detour: bool,
    /// The number of further steps for `Dop853`.
    pub(super) detour_left: usize,
}

/// The workspace for the dynamics `D`.
pub(super) type WorkspaceOf<D, const N: usize> =
    Workspace<<D as Dynamics<N>>::Scalar, <WideOf<D, N> as System<N>>::Prepared, N>;

/// The tolerances of a step: relative, and absolute for coordinates and velocities.
pub(super) type Tolerances<const N: usize> = (f64, ([f64; N], [f64; N]));

/// Returns the machine epsilon of the scalar, but at least that of `f64`, because the coefficients
/// have its accuracy.
#[inline(always)]
fn epsilon<T: Float>() -> f64 {
    let epsilon = T::EPSILON.to_f64();
    if epsilon < f64::EPSILON { f64::EPSILON } else { epsilon }
}

impl<T: Float, P, const N: usize> Workspace<T, P, N> {
    /// Computes `weights` for a step of length `h`: the error that a unit of each acceleration
    /// causes, over the error allowed, in the velocity or in the coordinate, whichever is larger.
    ///
    /// The error allowed is the tolerance plus the rounding error of the step. If the tolerance is
    /// larger than a twentieth of the change that the accelerations cause in the step, that
    /// twentieth replaces it, but at least a thousandth of the tolerance: otherwise loose
    /// tolerances would hide the accelerations.
    #[inline(always)]
    pub(super) fn weigh(&mut self, h: f64, from: &Endpoint<T, N>, (rtol, atol): &Tolerances<N>) {
        let rounding = 0.125 * epsilon::<T>();
        let most = if shortest::<T>() == 0.0 { f64::MAX } else { f64::from(f32::MAX) };
        let size = self
            .size
            .iter()
            .fold(0.0, |largest, size| if largest < *size { *size } else { largest });
        let gain = h * size;
        let allowed = |atol: f64, relative: f64, change: f64, value: f64| {
            let tolerance = atol + relative;
            let least =
                if 0.05 * change < 0.001 * tolerance { 0.001 * tolerance } else { 0.05 * change };
            // Values near zero may be rounding errors of ordinary ones, unless an absolute
            // tolerance below those errors states that they are not.
            let unit = epsilon::<T>();
            let unit = if 0.0 < atol && atol < rounding * unit { atol } else { unit };
            (if least < tolerance { least } else { tolerance }) + rounding * (value + unit)
        };
        for i in 0..N {
            let (q, v) = (f64::abs(from.q.high[i].to_f64()), f64::abs(from.v.high[i].to_f64()));
            let by_velocity = h / allowed(atol.1[i], rtol * v, gain, v + gain);
            let by_coordinate = h * h / allowed(atol.0[i], rtol * q, h * gain, q + h * (v + gain));
            let weight = if by_velocity < by_coordinate { by_coordinate } else { by_velocity };
            // The product of zero and infinity would be NaN.
            self.weights[i] = T::from_f64(if most < weight { most } else { weight });
        }
    }

    /// Returns `true` if the equations are solved: the iteration has converged, or its last change
    /// is rounding, that of the accelerations or `inherited` from coordinates and velocities.
    #[inline(always)]
    pub(super) fn is_solved(&self, inherited: &[f64; N]) -> bool {
        let Ends { size, progress, .. } = &self.ends;
        // Accelerations that are not finite define no scale.
        if !(progress.complete && size.iter().all(|size| size.is_finite())) {
            return false;
        }
        if progress.done {
            return true;
        }
        let mut rounding = 0.01;
        for i in 0..N {
            let weight = self.weights[i].to_f64();
            let noise = weight * 8.0 * epsilon::<T>() * size[i] + weight * INHERITED * inherited[i];
            rounding += S as f64 * noise * noise;
        }
        // Not solved if the iteration has diverged.
        rounding.is_finite() && progress.change.to_f64() <= rounding
    }

    /// Returns the error of the step over the one allowed: in each coordinate w max(|α₁₆|, ε₇
    /// min(1, ε₇/ε₆), ε₇/16), where w is the weight of the coordinate and ε_k is the larger of
    /// |α_2k| and |α_2k+1|.
    ///
    /// The Gauss rule is exact for the coefficients up to α₁₅ and omits all further ones. If the
    /// coefficients decay, both of the first terms have the size of the omitted ones. At a corner,
    /// a jump or a narrow kick ε₇ is as large as ε₆, and a jump between the start and the first
    /// node appears only in α₁₆. Coefficients at the level of rounding are ignored: below 32 ε of
    /// the accelerations, or below 512 ε if the coefficients do not decay (ε₆ < 4 ε₇), or below
    /// what the accelerations have `inherited` from coordinates and velocities.
    #[inline(always)]
    pub(super) fn error(&self, inherited: &[f64; N]) -> f64 {
        let (mut error, epsilon) = (0.0, epsilon::<T>());
        let larger = |a: f64, b: f64| if a < b { b } else { a };
        for i in 0..N {
            let [a15, a14, a13, a12, a16] = self.ends.tail[i].map(|x| f64::abs(x.to_f64()));
            let (last, before) = (larger(a15, a14), larger(a13, a12));
            let size = self.ends.size[i];
            let own = if before < 4.0 * last { 512.0 } else { 32.0 } * epsilon * size;
            let noise = larger(own, INHERITED * inherited[i]);
            let tail = larger(last, a16);
            // NaN counts as an error.
            if noise < tail || tail.is_nan() || a16.is_nan() {
                let by_decay = last * (last / larger(before, last));
                let part = self.weights[i].to_f64() * larger(a16, larger(by_decay, last / 16.0));
                if error < part || part.is_nan() {
                    error = part;
                }
            }
        }
        error
    }

    /// Returns `true` if what is left of the error may be rounding: coefficients that hardly decay,
    /// or changes by sweeps, far below the accelerations. A jump is as large as those.
    pub(super) fn may_be_rounding(&self) -> bool {
        let (far, larger) =
            (epsilon::<T>().sqrt().sqrt(), |a: f64, b: f64| if a < b { b } else { a });
        let (mut decays, mut bound) = (true, 0.0);
        for i in 0..N {
            let [a15, a14, a13, a12, _] = self.ends.tail[i].map(|x| f64::abs(x.to_f64()));
            let (last, before, size) = (larger(a15, a14), larger(a13, a12), self.ends.size[i]);
            decays &= !(0.0 < last && before < 32.0 * last && last < far * size);
            let change = self.weights[i].to_f64() * far * size;
            bound += S as f64 * change * change;
        }
        let change = self.ends.progress.change.to_f64();
        if self.ends.solved { !decays } else { change <= bound }
    }

    /// Returns the coordinate with the largest accelerations, over those allowed.
    pub(super) fn worst(&self) -> usize {
        let part = |i: usize| self.weights[i].to_f64() * self.ends.size[i];
        (1..N).fold(0, |worst, i| if part(worst) < part(i) { i } else { worst })
    }

    /// Visits everything that the next step depends on.
    pub(super) fn remember(&mut self, memory: &mut Memory) {
        memory.count(&mut self.last, 1);
        self.a[self.last].iter_mut().flatten().for_each(|lanes| memory.scalars(&mut lanes.0));
        let zero = [T::from_f64(0.0); N];
        let empty = || (Time::new(0.0), zero, zero);
        memory.maybe(&mut self.end, empty, |memory, (t, q, v)| {
            memory.time(t);
            memory.scalars(q);
            memory.scalars(v);
        });
        memory.number(&mut self.h);
        self.size.iter_mut().for_each(|size| memory.number(size));
        memory.scalars(&mut self.start);
        memory.flag(&mut self.start_known);
        let mut sweeps = self.sweeps as usize;
        memory.count(&mut sweeps, 8);
        self.sweeps = sweeps as u32;
        memory.count(&mut self.detour_left, DETOUR);
        self.remember_sums(memory);
    }

    /// Visits the lengths of the scaled columns.
    fn remember_sums(&mut self, memory: &mut Memory) {
        let [scaled, ahead, between] = &mut self.scaled;
        scaled.remember(memory, [&EIGHT.once, &EIGHT.twice], 0);
        ahead.remember(memory, [&EIGHT.once_ahead, &EIGHT.twice_ahead], 0);
        between.remember(memory, [&BETWEEN.once, &BETWEEN.twice], 0);
        for (to, within) in self.within.iter_mut().enumerate() {
            within.remember(memory, [&SIXTEEN.once, &SIXTEEN.twice], to);
        }
    }

    /// Makes the current step the last one.
    #[inline]
    pub(super) fn accept(&mut self, to: &Endpoint<T, N>, h: f64) {
        let Progress { sweeps, spare, .. } = self.ends.progress;
        self.sweeps = (sweeps - u32::from(spare)).clamp(2, 8);
        self.last ^= 1;
        (self.end, self.h) = (Some((to.t, to.q.high, to.v.high)), h);
        (self.size, self.start) = (self.ends.size, self.ends.last);
    }
}
