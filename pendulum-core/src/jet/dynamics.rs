//! Dynamics with known jets: a system with recurrences, and motions with series for its driven
//! inputs.

use crate::jet::recurrences::Jets;
use crate::motion::series::InputSeries;
use crate::motion::{AnalyticMotions, MaybeAnalytic, Side};
use crate::system::{
    Controlled, Driven, Dynamics, MOST_CONTROLS, NoInputs, Purpose, Sampled, System,
};
use crate::time::Time;

/// Dynamics whose jets can be computed, as required by [`Taylor`](crate::integrate::Taylor).
pub trait JetDynamics<const N: usize>: Dynamics<N, System: Jets<N>> {
    /// Computes the series of all driven inputs at `t` on `side`, with `count` coefficients of
    /// their accelerations.
    fn drive(
        &self,
        t: Time,
        side: Side,
        count: usize,
        drive: &mut <Self::System as Jets<N>>::Drive,
    );

    /// Returns the first time after `t` at which a motion is not analytic. Kinks are such times.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// Returns the last time before `t` at which a motion is not analytic.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// Returns the last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// Dynamics of a generated system, whose jets may or may not be known, as determined at run time.
///
/// All methods except [`is_analytic`](Self::is_analytic) ignore motions that are not analytic.
#[diagnostic::on_unimplemented(
    message = "no method can be chosen for `{Self}`",
    label = "what `lagrangian!` knows about a system decides about the method",
    note = "name one: `solve(…).method(Dop853)`"
)]
pub trait MaybeJets<const N: usize>: Dynamics<N, System: Jets<N>> {
    /// Returns `true` if the jets are known, because every motion is analytic.
    fn is_analytic(&self) -> bool;

    /// Computes the series of all driven inputs, as [`JetDynamics::drive`].
    fn drive(
        &self,
        t: Time,
        side: Side,
        count: usize,
        drive: &mut <Self::System as Jets<N>>::Drive,
    );

    /// Returns a time as [`JetDynamics::next_break`].
    fn next_break(&self, t: f64) -> Option<f64>;

    /// Returns a time as [`JetDynamics::last_break`].
    fn last_break(&self, t: f64) -> Option<f64>;

    /// Returns a time as [`JetDynamics::last_kink`].
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// Defines the common methods of both traits for systems without inputs.
macro_rules! none {
    ($($method:ident)+) => {
        #[inline]
        fn drive(&self, _: Time, _: Side, _: usize, _: &mut S::Drive) {}

        $(#[inline]
        fn $method(&self, _: f64) -> Option<f64> {
            None
        })+
    };
}

macro_rules! of_motions {
    ($($method:ident)+) => {
        fn drive(&self, t: Time, side: Side, count: usize, drive: &mut S::Drive) {
            let drive: &mut [InputSeries<S::Scalar>] = drive.as_mut();
            self.motions.series(t, side, count + 2, drive);
            for input in drive {
                input.differentiate(count);
            }
        }

        $(fn $method(&self, t: f64) -> Option<f64> {
            self.motions.$method(t)
        })+
    };
}

macro_rules! of_inner {
    ($this:ident, $inner:expr; $($method:ident)+) => {
        #[inline]
        fn drive(&$this, t: Time, side: Side, count: usize, drive: &mut <Self::System as Jets<N>>::Drive) {
            $inner.drive(t, side, count, drive);
        }

        $(#[inline]
        fn $method(&$this, t: f64) -> Option<f64> {
            $inner.$method(t)
        })+
    };
}

impl<const N: usize, S: Jets<N, Inputs: NoInputs<S>>> JetDynamics<N> for S {
    none!(next_break last_break last_kink);
}

impl<const N: usize, S: Jets<N, Inputs: NoInputs<S>>> MaybeJets<N> for S {
    fn is_analytic(&self) -> bool {
        true
    }

    none!(next_break last_break last_kink);
}

impl<const N: usize, S: Jets<N>, M: AnalyticMotions<S::Inputs, S::Scalar>> JetDynamics<N>
    for Driven<S, M>
{
    of_motions!(next_break last_break last_kink);
}

impl<const N: usize, S: Jets<N>, M: MaybeAnalytic<S::Inputs, S::Scalar>> MaybeJets<N>
    for Driven<S, M>
{
    fn is_analytic(&self) -> bool {
        self.motions.is_analytic()
    }

    of_motions!(next_break last_break last_kink);
}

/// Defines the methods of dynamics without jets.
macro_rules! without_jets {
    () => {
        fn is_analytic(&self) -> bool {
            false
        }

        fn drive(&self, _: Time, _: Side, _: usize, _: &mut S::Drive) {}

        fn next_break(&self, t: f64) -> Option<f64> {
            self.next_kink(t)
        }

        fn last_break(&self, _: f64) -> Option<f64> {
            None
        }

        fn last_kink(&self, _: f64) -> Option<f64> {
            None
        }
    };
}

impl<const N: usize, S, M, F, U> MaybeJets<N> for Controlled<S, M, F, U>
where
    S: Jets<N>,
    Self: Dynamics<N, System = S, Scalar = S::Scalar>,
{
    without_jets!();
}

impl<const N: usize, S, M, C, U> MaybeJets<N> for Sampled<S, M, C, U>
where
    S: Jets<N>,
    Self: Dynamics<N, System = S, Scalar = S::Scalar>,
{
    without_jets!();
}

/// Dynamics whose motions have been found to be analytic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<'a, D>(pub(crate) &'a D);

impl<const N: usize, D: MaybeJets<N>> JetDynamics<N> for Known<'_, D> {
    of_inner!(self, self.0; next_break last_break last_kink);
}

impl<const N: usize, D: Dynamics<N>> Dynamics<N> for Known<'_, D> {
    type System = D::System;
    type Scalar = D::Scalar;

    fn system(&self) -> &D::System {
        self.0.system()
    }

    #[inline]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> <D::System as System<N>>::Inputs {
        self.0.inputs(t, side, purpose)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.0.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        self.0.kink_before(t)
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        self.0.longest_step(t, widths, unknown)
    }

    const FEEDBACK: bool = D::FEEDBACK;

    fn control(
        &self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &mut <D::System as System<N>>::Inputs,
    ) {
        self.0.control(t, q, v, inputs);
    }

    fn controls(
        &self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; MOST_CONTROLS] {
        self.0.controls(t, q, v)
    }

    #[inline]
    fn accelerations_with(
        &self,
        prepared: &<D::System as System<N>>::Prepared,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.0.accelerations_with(prepared, t, side, q, v)
    }
}
