//! Dynamics with jets: a system with recurrences, and motions with series for its driven inputs.

use crate::jet::recurrences::Jets;
use crate::motion::series::InputSeries;
use crate::motion::{AnalyticMotions, Side};
use crate::system::{Controlled, Driven, Dynamics, NoInputs, Sampled};
use crate::time::Time;

/// Dynamics of a generated system with the jets of its motion.
///
/// [`Taylor`](crate::integrate::Taylor) requires that the jets are `KNOWN`, because every motion is
/// [`Analytic`](crate::motion::Analytic). Methods that choose at run time ask
/// [`is_analytic`](Self::is_analytic) instead; if it returns `false`, all other methods ignore the
/// motions that are not analytic. The defaults are those of a system without inputs.
#[diagnostic::on_unimplemented(
    message = "no method can be chosen for `{Self}`",
    label = "what `lagrangian!` knows about a system decides about the method",
    note = "name one: `solve(…).method(Dop853)`"
)]
pub trait JetDynamics<const N: usize, const KNOWN: bool = true>:
    Dynamics<N, System: Jets<N>>
{
    /// Returns `true` if every motion is analytic.
    fn is_analytic(&self) -> bool {
        true
    }

    /// Computes the series of all driven inputs at `t` on `side`, with `count` coefficients of
    /// their accelerations.
    #[inline]
    fn drive(
        &self,
        t: Time,
        side: Side,
        count: usize,
        drive: &mut <Self::System as Jets<N>>::Drive,
    ) {
        let _ = (t, side, count, drive);
    }

    /// Returns the first time after `t` at which a motion is not analytic. Kinks are such times.
    #[inline]
    fn next_break(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the last time before `t` at which a motion is not analytic.
    #[inline]
    fn last_break(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the last kink before `t`.
    #[inline]
    fn last_kink(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }
}

impl<const N: usize, const KNOWN: bool, S> JetDynamics<N, KNOWN> for S where
    S: Jets<N, Inputs: NoInputs<S>>
{
}

impl<const N: usize, const KNOWN: bool, S, M> JetDynamics<N, KNOWN> for Driven<S, M>
where
    S: Jets<N>,
    M: AnalyticMotions<S::Inputs, S::Scalar, KNOWN>,
{
    fn is_analytic(&self) -> bool {
        self.motions.is_analytic()
    }

    fn drive(&self, t: Time, side: Side, count: usize, drive: &mut S::Drive) {
        let drive: &mut [InputSeries<S::Scalar>] = drive.as_mut();
        self.motions.series(t, side, count + 2, drive);
        for input in drive {
            input.differentiate(count);
        }
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.motions.next_break(t)
    }

    fn last_break(&self, t: f64) -> Option<f64> {
        self.motions.last_break(t)
    }

    fn last_kink(&self, t: f64) -> Option<f64> {
        self.motions.last_kink(t)
    }
}

impl<const N: usize, S, M, F, U> JetDynamics<N, false> for Controlled<S, M, F, U>
where
    S: Jets<N>,
    Self: Dynamics<N, System = S, Scalar = S::Scalar>,
{
    fn is_analytic(&self) -> bool {
        false
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.next_kink(t)
    }
}

impl<const N: usize, S, M, C, U> JetDynamics<N, false> for Sampled<S, M, C, U>
where
    S: Jets<N>,
    Self: Dynamics<N, System = S, Scalar = S::Scalar>,
{
    fn is_analytic(&self) -> bool {
        false
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.next_kink(t)
    }
}
