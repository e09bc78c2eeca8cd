//! The interface of an integration for event detectors and recorders.

use super::{Integration, onwards};
use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::field::contacts::has_contacts;
use crate::integrate::field::phase::{Phase, has_states};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::Method;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::contact;
use crate::integrate::step::projection;
use crate::scalar::Float;
use crate::system::{Dynamics, Facts, System, is_constrained};
use crate::time::Time;

impl<const N: usize, D, M, C> Observed<D::Scalar, N> for Integration<'_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
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
        Integration::interpolant(self);
    }

    fn interpolated(&self) -> Option<&Interpolant<D::Scalar, N>> {
        self.interpolant.as_ref()
    }

    fn accelerations(&mut self) -> [D::Scalar; N] {
        Integration::accelerations(self)
    }

    fn deliver(&self, t: Time, state: &mut State<D::Scalar, N>) {
        let side = onwards(self.backwards);
        if const { is_constrained::<D, N>() } {
            projection::deliver(&*self.dynamics, t, side, state);
        }
        if const { has_contacts::<D, N>() } {
            let contacts = self.limits.began();
            if contacts.hold() {
                contact::deliver(&*self.dynamics, t, side, &contacts, state);
            }
        }
        if const { has_states::<D, N>() } {
            let phase = Phase { dynamics: &*self.dynamics, t, side, q: &state.q, v: &state.v };
            [state.v, _] = phase.with_rates(&state.v);
        }
    }

    fn contacts(&self) -> [u64; 2] {
        if const { has_contacts::<D, N>() } {
            return [self.limits.began(), self.limits.contacts()].map(|contacts| contacts.bits());
        }
        [0; 2]
    }

    fn goes_back(&self) -> bool {
        self.backwards
    }

    fn last_length(&self) -> f64 {
        self.last.map_or(0.0, |interval| interval.h)
    }

    fn cut(&mut self, t: Time, state: &State<D::Scalar, N>) {
        Integration::cut(self, t, state);
    }

    fn jump(&mut self, state: &State<D::Scalar, N>) -> Result<(), Error> {
        Integration::jump(self, state)
    }

    fn retreat(&mut self) {
        Integration::retreat(self);
    }
}
