//! Dynamics that can be evaluated at several times at once.

#![allow(clippy::inline_always)]

use crate::motion::{AnalyticMotions, Side, earlier};
use crate::scalar::{Float, Octet, Real};
use crate::system::{
    ControlValues, Controlled, Driven, Dynamics, InOctets, LaneSystem, MOST_CONTROLS, NoInputs,
    Sampled, Samples, Staged, System,
};
use crate::time::Time;

use super::tableau::S;

/// The system of the dynamics `D` over lanes.
pub(super) type WideOf<D, const N: usize> =
    <<D as Dynamics<N>>::System as LaneSystem<InOctets, N>>::Wide;

/// The inputs of the system over lanes.
pub(super) type LaneInputs<D, const N: usize> = <WideOf<D, N> as System<N>>::Inputs;

/// Dynamics of a system that `lagrangian!` has made: the accelerations at eight times can be
/// computed side by side.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be evaluated at several times at once",
    note = "`Picard` takes systems that `lagrangian!` has made; for others use `Dop853`"
)]
pub trait LaneDynamics<const N: usize>:
    Dynamics<N, Scalar: Float, System: LaneSystem<InOctets, N>>
{
    /// Returns the samples of all driven inputs at eight times, between which there is no kink. The
    /// last lane contains the samples at `last` instead, seen from its side, if it is given.
    #[doc(hidden)]
    fn inputs_at(&self, times: &[Time; 8], last: Option<(Time, Side)>) -> LaneInputs<Self, N>;

    /// Writes the control inputs that depend on the state in each lane into `inputs`.
    #[doc(hidden)]
    #[inline(always)]
    fn control_lanes(
        &self,
        times: &[Time; 8],
        q: &[Octet<Self::Scalar>; N],
        v: &[Octet<Self::Scalar>; N],
        inputs: &mut LaneInputs<Self, N>,
    ) {
        let _ = (times, q, v, inputs);
    }

    /// Returns the first time after `t` at which a motion is known not to have all derivatives.
    #[doc(hidden)]
    fn next_break(&self, t: f64) -> Option<f64>;

    /// Returns the last such time before `t`.
    #[doc(hidden)]
    fn break_before(&self, t: f64) -> Option<f64>;
}

impl<S0, const N: usize> LaneDynamics<N> for S0
where
    S0: System<N, Scalar: Float, Inputs: NoInputs<S0>>,
    S0::With<Octet<S0::Scalar>>: Staged<N, Inputs: NoInputs<S0>>,
{
    #[inline(always)]
    fn inputs_at(&self, _: &[Time; S], _: Option<(Time, Side)>) -> LaneInputs<Self, N> {
        NoInputs::none()
    }

    #[inline]
    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    #[inline]
    fn break_before(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<S0, M, const N: usize> LaneDynamics<N> for Driven<S0, M>
where
    S0: System<N, Scalar: Float>,
    M: AnalyticMotions<S0::Inputs, S0::Scalar, false>,
    S0::With<Octet<S0::Scalar>>: Staged<N, Inputs = M::Wide>,
{
    #[inline(always)]
    fn inputs_at(&self, times: &[Time; S], last: Option<(Time, Side)>) -> LaneInputs<Self, N> {
        self.motions.sample_lanes(times, last, S0::FACTS.inputs)
    }

    #[inline]
    fn next_break(&self, t: f64) -> Option<f64> {
        self.motions.next_break(t)
    }

    fn break_before(&self, t: f64) -> Option<f64> {
        self.motions.last_break(t)
    }
}

impl<S0, M, F, U, const N: usize> LaneDynamics<N> for Controlled<S0, M, F, U>
where
    S0: System<N, Scalar: Float>,
    M: AnalyticMotions<S0::Inputs, S0::Scalar, false, Wide: Samples<Octet<S0::Scalar>>>,
    S0::With<Octet<S0::Scalar>>: Staged<N, Inputs = M::Wide>,
    F: Fn(f64, &[S0::Scalar; N], &[S0::Scalar; N]) -> U,
    U: ControlValues<S0::Scalar>,
{
    #[inline(always)]
    fn inputs_at(&self, times: &[Time; S], last: Option<(Time, Side)>) -> LaneInputs<Self, N> {
        self.driven.motions.sample_lanes(times, last, S0::FACTS.inputs)
    }

    #[inline(always)]
    fn control_lanes(
        &self,
        times: &[Time; S],
        q: &[Octet<S0::Scalar>; N],
        v: &[Octet<S0::Scalar>; N],
        inputs: &mut LaneInputs<Self, N>,
    ) {
        let mut values = [Octet::splat(S0::Scalar::from_f64(0.0)); MOST_CONTROLS];
        for k in 0..S {
            let (q, v) = (q.map(|q| q.0[k]), v.map(|v| v.0[k]));
            let own = self.controls(times[k], &q, &v);
            for (value, own) in values.iter_mut().zip(own).take(U::COUNT) {
                value.0[k] = own;
            }
        }
        inputs.set_controls(const { S0::FACTS.driven() }, &values[..U::COUNT]);
    }

    #[inline]
    fn next_break(&self, t: f64) -> Option<f64> {
        self.driven.motions.next_break(t)
    }

    fn break_before(&self, t: f64) -> Option<f64> {
        self.driven.motions.last_break(t)
    }
}

impl<S0, M, C, U, const N: usize> LaneDynamics<N> for Sampled<S0, M, C, U>
where
    S0: System<N, Scalar: Float>,
    M: AnalyticMotions<S0::Inputs, S0::Scalar, false, Wide: Samples<Octet<S0::Scalar>>>,
    S0::With<Octet<S0::Scalar>>: Staged<N, Inputs = M::Wide>,
    C: FnMut(f64, &[S0::Scalar; N], &[S0::Scalar; N]) -> U + Clone,
    U: ControlValues<S0::Scalar>,
{
    #[inline(always)]
    fn inputs_at(&self, times: &[Time; S], last: Option<(Time, Side)>) -> LaneInputs<Self, N> {
        let mut inputs = self.driven.motions.sample_lanes(times, last, S0::FACTS.inputs);
        let mut values = [Octet::splat(S0::Scalar::from_f64(0.0)); MOST_CONTROLS];
        for k in 0..S {
            let (t, side) = match last {
                Some(last) if k + 1 == S => last,
                _ => (times[k], Side::After),
            };
            let own = self.held(t, side);
            for (value, own) in values.iter_mut().zip(own).take(U::COUNT) {
                value.0[k] = own;
            }
        }
        inputs.set_controls(const { S0::FACTS.driven() }, &values[..U::COUNT]);
        inputs
    }

    #[inline]
    fn next_break(&self, t: f64) -> Option<f64> {
        earlier(self.driven.motions.next_break(t), self.next_kink(t))
    }

    fn break_before(&self, t: f64) -> Option<f64> {
        self.driven.motions.last_break(t)
    }
}
