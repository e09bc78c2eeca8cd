//! The motions of all driven inputs of a system.

use crate::motion::analytic::Analytic;
use crate::motion::input::{Input, Purpose};
use crate::motion::prescribed::{Motion, earlier};
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::InputSeries;
use crate::scalar::Real;
use crate::time::Time;

/// The motions of all driven inputs of a system: `()` or a tuple, in the order of declaration.
pub trait Motions<Inputs> {
    /// The derivatives that each motion has.
    const HAS: &'static [Derivatives];

    /// One sample for each motion.
    fn sample(&self, t: Time, side: Side, inputs: &[Input], purpose: Purpose) -> Inputs;

    /// The first kink of any of them after `t`.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The last kink of any of them before `t`, as [`Motion::kink_before`]; `None` if one of them
    /// does not know.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// The least of the answers of [`Motion::longest_step`], with `unknown` for those that do not
    /// know.
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        unknown
    }
}

/// Returns true if motions that have the derivatives `has` can drive `inputs`.
pub(crate) const fn sufficient(has: &[Derivatives], inputs: &[Input]) -> bool {
    let mut index = 0;
    while index < inputs.len() {
        let input = &inputs[index];
        let needed =
            input.accelerations.union(input.momenta).union(input.energy).union(input.power);
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

/// The shorter of two steps; what is no number stays, so that somebody says so.
#[inline]
pub(crate) fn shorter(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The derivatives that a purpose needs of an input; all of them if the system does not say.
pub(crate) const fn derivatives_of(
    inputs: &[Input],
    index: usize,
    purpose: Purpose,
) -> Derivatives {
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

/// The motions of all driven inputs of a system, if every one is analytic.
pub trait AnalyticMotions<Inputs, T: Real>: Motions<Inputs> {
    /// The positions of all components, as [`Analytic::series`] gives them.
    fn series(&self, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]);

    /// The first time after `t` at which one of them is not analytic.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// The motions of all driven inputs of a system, of which it shows at run time whether every one is
/// analytic.
///
/// The part of one that is not is missing in all other answers.
pub trait MaybeAnalytic<Inputs, T: Real>: Motions<Inputs> {
    /// Returns true if every motion is analytic.
    fn is_analytic(&self) -> bool;

    /// The positions of all components, as [`Analytic::series`] gives them.
    fn series(&self, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]);

    /// The first time after `t` at which one of them is not analytic.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// The later of two times.
fn later(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    earlier(a.map(|a| -a), b.map(|b| -b)).map(|time| -time)
}

/// The methods that both traits have, for motions of which `known` gives those that are analytic.
macro_rules! answers {
    ($this:ident, [$($known:expr, $dim:expr);*]) => {
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

macro_rules! nothing {
    ($($method:ident)+) => {
        fn series(&self, _: Time, _: Side, _: usize, _: &mut [InputSeries<T>]) {}

        $(fn $method(&self, _: f64) -> Option<f64> {
            None
        })+
    };
}

impl<T: Real> AnalyticMotions<(), T> for () {
    nothing!(next_break last_break last_kink);
}

impl<T: Real> MaybeAnalytic<(), T> for () {
    fn is_analytic(&self) -> bool {
        true
    }

    nothing!(next_break last_break last_kink);
}

macro_rules! analytic_tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $($motion: Motion<T, $dim> + Analytic<T, $dim>, const $dim: usize),+>
            AnalyticMotions<($(Sample<T, $dim>,)+), T> for ($($motion,)+)
        {
            answers!(self, [$(Some(&self.$index), $dim);+]);
        }

        impl<T: Real, $($motion: Motion<T, $dim>, const $dim: usize),+> MaybeAnalytic<($(Sample<T, $dim>,)+), T> for ($($motion,)+) {
            fn is_analytic(&self) -> bool {
                $(self.$index.analytic().is_some())&&+
            }

            answers!(self, [$(self.$index.analytic(), $dim);+]);
        }
    )+};
}

for_tuples_of_motions!(analytic_tuples);
