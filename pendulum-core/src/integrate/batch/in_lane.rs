//! The interface of a motion in a lane for event detectors and recorders.

use super::flight::Wide;
use super::problem::Batched;
use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::methods::taylor::series_interpolant;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::jet::Path;
use crate::system::{Facts, System};
use crate::time::Time;

/// A motion in a lane, after a step.
pub(super) struct InLane<'v, D: Batched<N>, const N: usize> {
    pub(super) dynamics: &'v D,
    pub(super) path: &'v Path<Wide<D::Scalar>, N>,
    pub(super) order: usize,
    pub(super) lane: usize,
    pub(super) from: Endpoint<D::Scalar, N>,
    /// The end of the step before a kink, if the step ended on one.
    pub(super) before_kink: Option<Endpoint<D::Scalar, N>>,
    pub(super) end: Endpoint<D::Scalar, N>,
    pub(super) interval: StepInterval,
    pub(super) interpolant: Option<Interpolant<D::Scalar, N>>,
    pub(super) evaluations: &'v mut u64,
}

impl<D: Batched<N>, const N: usize> Observed<D::Scalar, N> for InLane<'_, D, N> {
    fn facts(&self) -> &'static Facts {
        &<D::System as System<N>>::FACTS
    }

    fn end(&self) -> &Endpoint<D::Scalar, N> {
        &self.end
    }

    fn before_kink(&self) -> Option<&Endpoint<D::Scalar, N>> {
        self.before_kink.as_ref()
    }

    fn interpolate(&mut self) {
        let Self { path, order, lane: l, from, interval, .. } = *self;
        self.interpolant.get_or_insert_with(|| {
            series_interpolant(interval, &from, order, |i, k| {
                [path.q[i][k].0[l], path.v[i][k].0[l]]
            })
        });
    }

    fn interpolated(&self) -> Option<&Interpolant<D::Scalar, N>> {
        self.interpolant.as_ref()
    }

    fn accelerations(&mut self) -> [D::Scalar; N] {
        let prepared = self.dynamics.system().prepare();
        let mut field = Field::new(self.dynamics, &prepared);
        field.backwards = self.goes_back();
        let a = self.end.start_acceleration(&mut field);
        *self.evaluations += field.evaluations;
        a
    }

    fn goes_back(&self) -> bool {
        self.interval.h.is_sign_negative()
    }

    fn last_length(&self) -> f64 {
        self.interval.h
    }

    fn cut(&mut self, t: Time, state: &State<D::Scalar, N>) {
        (self.before_kink, self.end) = (None, Endpoint::new(t, state.q, state.v));
    }

    // Lanes do not process events with actions.
    fn jump(&mut self, state: &State<D::Scalar, N>) -> Result<(), Error> {
        self.end = Endpoint::new(self.end.t, state.q, state.v);
        Ok(())
    }

    fn retreat(&mut self) {
        (self.before_kink, self.end) = (None, self.from);
    }
}
