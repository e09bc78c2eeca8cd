//! Dynamics whose jets are known: a system with recurrences, and motions with series for its driven inputs.

use super::{InputSeries, Jets};
use crate::motion::{AnalyticMotions, Side};
use crate::system::{Driven, Dynamics, Prepared, System};
use crate::time::Time;

/// Dynamics of which [`Taylor`](crate::integrate::Taylor) can compute the jets.
pub trait JetDynamics<const N: usize>: Dynamics<N, System: Jets<N>> {
    /// The series of all driven inputs at `t`, seen from `side`: `count` coefficients of their accelerations.
    fn drive(&self, t: Time, side: Side, count: usize, drive: &mut <Self::System as Jets<N>>::Drive);

    /// The first time after `t` at which a motion stops being analytic; every kink is such a time.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

impl<const N: usize, S: Jets<N> + System<N, Inputs = ()>> JetDynamics<N> for S {
    #[inline]
    fn drive(&self, _: Time, _: Side, _: usize, _: &mut S::Drive) {}

    #[inline]
    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    #[inline]
    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<const N: usize, S: Jets<N>, M: AnalyticMotions<S::Inputs, S::Scalar>> JetDynamics<N> for Driven<S, M> {
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

impl<const N: usize, D: JetDynamics<N>> JetDynamics<N> for Prepared<'_, D, <D::System as System<N>>::Prepared> {
    #[inline]
    fn drive(&self, t: Time, side: Side, count: usize, drive: &mut <D::System as Jets<N>>::Drive) {
        self.dynamics().drive(t, side, count, drive);
    }

    #[inline]
    fn next_break(&self, t: f64) -> Option<f64> {
        self.dynamics().next_break(t)
    }

    #[inline]
    fn last_break(&self, t: f64) -> Option<f64> {
        self.dynamics().last_break(t)
    }

    fn last_kink(&self, t: f64) -> Option<f64> {
        self.dynamics().last_kink(t)
    }
}
