//! The motions of all driven inputs of a system.

// Code for lanes must be compiled with the vector instructions of its caller.
#![allow(clippy::inline_always)]

use crate::motion::analytic::Analytic;
use crate::motion::input::{Input, Purpose};
use crate::motion::prescribed::{Motion, earlier};
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::InputSeries;
use crate::scalar::{Float, Octet, Real};
use crate::time::Time;

/// The motions of all driven inputs of a system: `()` or a tuple, in the order of declaration.
pub trait Motions<Inputs> {
    /// The derivatives that each motion has.
    const HAS: &'static [Derivatives];

    /// Samples each motion.
    fn sample(&self, t: Time, side: Side, inputs: &[Input], purpose: Purpose) -> Inputs;

    /// Returns the first kink of the motions after `t`.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// Returns the last kink of the motions before `t`, as [`Motion::kink_before`]; `None` if it is
    /// unknown for any motion.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the minimum of [`Motion::longest_step`] over all motions, with `unknown` in place of
    /// `None`.
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        unknown
    }
}

/// Returns `true` if motions that have the derivatives `has` can drive `inputs`.
pub(crate) const fn sufficient(has: &[Derivatives], inputs: &[Input]) -> bool {
    let mut index = 0;
    while index < inputs.len() {
        let input = &inputs[index];
        let Input { accelerations, momenta, energy, power, outputs, .. } = *input;
        let needed = accelerations.union(momenta).union(energy).union(power).union(outputs);
        if !has[index].contains(needed) {
            return false;
        }
        index += 1;
    }
    true
}

impl Motions<()> for () {
    const HAS: &'static [Derivatives] = &[];

    fn sample(&self, _: Time, _: Side, _: &[Input], _: Purpose) {}

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }

    #[inline]
    fn longest_step(&self, _: f64, _: f64, _: f64) -> f64 {
        f64::INFINITY
    }
}

/// Returns the shorter of two steps. NaN propagates, so that it is reported.
#[inline]
pub(crate) fn shorter(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// Returns the derivatives of an input that `purpose` needs; all derivatives if `inputs` does not
/// contain the input.
const fn derivatives_of(inputs: &[Input], index: usize, purpose: Purpose) -> Derivatives {
    if index < inputs.len() { inputs[index].derivatives(purpose) } else { Derivatives::ALL }
}

macro_rules! tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $($motion: Motion<T, $dim>, const $dim: usize),+> Motions<($(Sample<T, $dim>,)+)> for ($($motion,)+) {
            const HAS: &'static [Derivatives] = &[$($motion::HAS),+];

            #[inline(always)]
            fn sample(&self, t: Time, side: Side, inputs: &[Input], purpose: Purpose) -> ($(Sample<T, $dim>,)+) {
                ($(self.$index.sample(t, side, derivatives_of(inputs, $index, purpose)),)+)
            }

            fn next_kink(&self, t: f64) -> Option<f64> {
                let mut next = None;
                $(next = earlier(next, self.$index.next_kink(t));)+
                next
            }

            fn kink_before(&self, t: f64) -> Option<f64> {
                let mut last = f64::NEG_INFINITY;
                $(last = f64::max(last, self.$index.kink_before(t)?);)+
                Some(last)
            }

            #[inline]
            fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
                let mut longest = f64::INFINITY;
                $(longest = shorter(longest, self.$index.longest_step(t, widths).unwrap_or(unknown));)+
                longest
            }
        }
    )+};
}

for_tuples_of_motions!(tuples);

/// The Taylor series of the motions of all driven inputs of a system, and their samples in lanes.
///
/// If they are `KNOWN`, every motion is [`Analytic`]. Otherwise [`Motion::analytic`] says it at run
/// time, and all methods except [`is_analytic`](Self::is_analytic) ignore motions that are not.
/// The defaults are those without motions.
pub(crate) trait AnalyticMotions<Inputs, T: Real, const KNOWN: bool = true>:
    Motions<Inputs>
{
    /// One sample for each motion, with a time in each lane.
    type Wide;

    /// Returns the samples at `times`, with the derivatives that are required of each motion. The
    /// last lane contains the samples at `last` instead, seen from its side, if it is given.
    fn sample_lanes(
        &self,
        times: &[Time; 8],
        last: Option<(Time, Side)>,
        inputs: &[Input],
    ) -> Self::Wide
    where
        T: Float;

    /// Returns `true` if every motion is analytic.
    fn is_analytic(&self) -> bool {
        true
    }

    /// Writes the Taylor series of all components of the positions, as [`Analytic::series`].
    fn series(&self, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]) {
        let _ = (t, side, count, components);
    }

    /// Returns the first time after `t` at which an analytic motion is not analytic.
    fn next_break(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the last time before `t` at which an analytic motion is not analytic.
    fn last_break(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }
}

impl<T: Real, const KNOWN: bool> AnalyticMotions<(), T, KNOWN> for () {
    type Wide = ();

    #[inline(always)]
    fn sample_lanes(&self, _: &[Time; 8], _: Option<(Time, Side)>, _: &[Input]) {}
}

/// Returns the samples of one motion as [`AnalyticMotions::sample_lanes`].
#[inline(always)]
fn lanes<T: Float, M: Motion<T, D>, const D: usize>(
    motion: &M,
    times: &[Time; 8],
    last: Option<(Time, Side)>,
    wanted: Derivatives,
) -> Sample<Octet<T>, D> {
    let mut lanes = motion.sample_lanes(times, wanted);
    if let Some((last, side)) = last {
        let sample = motion.sample(last, side, wanted);
        for d in 0..D {
            lanes.position[d].0[7] = sample.position[d];
            lanes.velocity[d].0[7] = sample.velocity[d];
            lanes.acceleration[d].0[7] = sample.acceleration[d];
        }
    }
    lanes
}

/// Returns the later of two times.
fn later(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    earlier(a.map(|a| -a), b.map(|b| -b)).map(|time| -time)
}

/// Defines the methods for motions, of dimensions `dim`; each `known` is an `Option` of an analytic
/// motion.
macro_rules! answers {
    ($this:ident, [$($known:expr, $dim:ident, $index:tt);*]) => {
        type Wide = ($(Sample<Octet<T>, $dim>,)*);

        #[inline(always)]
        fn sample_lanes(&$this, times: &[Time; 8], last: Option<(Time, Side)>, inputs: &[Input]) -> Self::Wide
        where
            T: Float,
        {
            ($(lanes(&$this.$index, times, last, derivatives_of(inputs, $index, Purpose::Accelerations)),)*)
        }

        fn series(&$this, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]) {
            let mut components = components.iter_mut();
            $(for (component, series) in components.by_ref().take($dim).enumerate() {
                if let Some(motion) = $known {
                    motion.series(t, side, component, count, &mut series.position);
                }
            })*
        }

        fn next_break(&$this, t: f64) -> Option<f64> {
            let mut next = None;
            $(next = earlier(next, $known.and_then(|motion| motion.next_break(t)));)*
            next
        }

        fn last_break(&$this, t: f64) -> Option<f64> {
            let mut last = None;
            $(last = later(last, $known.and_then(|motion| motion.last_break(t)));)*
            last
        }

        fn last_kink(&$this, t: f64) -> Option<f64> {
            let mut last = None;
            $(last = later(last, $known.and_then(|motion| motion.last_kink(t)));)*
            last
        }
    };
}

macro_rules! analytic_tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $($motion: Motion<T, $dim> + Analytic<T, $dim>, const $dim: usize),+>
            AnalyticMotions<($(Sample<T, $dim>,)+), T, true> for ($($motion,)+)
        {
            answers!(self, [$(Some(&self.$index), $dim, $index);+]);
        }

        impl<T: Real, $($motion: Motion<T, $dim>, const $dim: usize),+>
            AnalyticMotions<($(Sample<T, $dim>,)+), T, false> for ($($motion,)+)
        {
            fn is_analytic(&self) -> bool {
                $(self.$index.analytic().is_some())&&+
            }

            answers!(self, [$(self.$index.analytic(), $dim, $index);+]);
        }
    )+};
}

for_tuples_of_motions!(analytic_tuples);
