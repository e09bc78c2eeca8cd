//! Steps of a system with switches or layers: a step ends where a switch changes its sign, and is
//! short enough for layers.

use super::{Integration, onwards};
use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::field::contacts::has_contacts;
use crate::integrate::method::Method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::arguments::{Cut, Passage, has_arguments};
use crate::integrate::step::controller::{Controller, ControllerState};
use crate::integrate::step::passing::Passing;
use crate::integrate::step::short::straight;
use crate::scalar::{Float, Real};
use crate::system::{At, Dynamics, Purpose, System, scalar_time};
use crate::time::Time;

impl<const N: usize, D, M, C> Integration<'_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Takes one step towards `target`, or the part of it that switches and layers allow.
    ///
    /// A step that passes a change of sign is repeated and ends before it, so that all its samples
    /// lie on one side. The next step crosses in a straight line, as short as time resolves.
    #[inline]
    pub(super) fn take(&mut self, target: f64) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        if const { has_arguments::<D, N>() }
            && let Some((relative, absolute)) = self.controller.accuracy()
        {
            return self.take_in_parts(target, (relative, &absolute));
        }
        self.take_whole(target)
    }

    #[inline(never)]
    fn take_in_parts(
        &mut self,
        target: f64,
        accuracy: (f64, &[[f64; N]; 2]),
    ) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        /// The number of attempts to land at a switch; further ones become shorter by half.
        const ATTEMPTS: usize = 16;
        self.straight = false;
        if 0.0 < self.state.ahead {
            return self.take_over_switch(target);
        }
        let side = onwards(self.backwards);
        self.check_beside_switches(target, accuracy.1)?;
        let (plan, accepted) = (self.state, self.stats.accepted);
        let left = -self.from.t.since(target);
        let bounded = plan.reach < left.abs();
        let towards =
            if bounded { (self.from.t + plan.reach.copysign(left)).to_f64() } else { target };
        let mut interval = self.take_whole(towards)?;
        let whole = interval.h.abs();
        // The end of a step beside a switch is this precise.
        let epsilon = D::Scalar::EPSILON.to_f64();
        let precise = 4.0 * (f64::EPSILON * self.from.t.to_f64().abs() + epsilon * whole);
        // A straight step of this length has an error below rounding.
        let straight = f64::max(1e-8 * whole, 2.0 * precise);
        let (mut layer, mut landing) = (false, None);
        for attempt in 1.. {
            let mut end = self.end;
            let interpolant = self.motion(&interval, &mut end);
            self.end.a = end.a;
            let dynamics = &*self.dynamics;
            let cut = self.arguments.look(dynamics, &interpolant, &end, side, accuracy);
            let cut = cut.or_else(|| {
                let stage =
                    |index| self.method.stage(index, &interval, &self.from, &self.workspace);
                self.arguments.strayed(dynamics, &end, side, accuracy.1, stage)
            });
            let most = if attempt < ATTEMPTS { 1.0 } else { 0.5 };
            let length = match (cut, landing.filter(|_| attempt < ATTEMPTS)) {
                (None, None) => break,
                (None, Some(index)) => {
                    // The switch is as far ahead as the first dense output was off.
                    let ahead = self.arguments.ahead(index) * interval.h.abs();
                    if ahead <= straight {
                        self.state.ahead = f64::max(ahead, 0.0) + precise;
                        break;
                    }
                    if ahead.is_nan() || 0.1 * interval.h.abs() <= ahead {
                        break;
                    }
                    interval.h.abs() + ahead - precise
                }
                (Some(Cut::Layer(theta)), _) => {
                    (layer, landing) = (true, None);
                    f64::min(theta, most) * interval.h.abs()
                }
                (Some(Cut::Switch { index, theta }), _) => {
                    landing = Some(index);
                    f64::min(theta, most) * interval.h.abs() - precise
                }
            };
            (self.end, self.state, self.stats.accepted) = (self.from, plan, accepted);
            self.stats.rejected += 1;
            if length <= straight {
                (self.state.h, self.state.ahead) = (whole, f64::max(length, 0.0) + 2.0 * precise);
                return self.take_over_switch(target);
            }
            let end = (self.from.t + length.copysign(interval.h)).to_f64();
            interval = self.take_whole(end)?;
            if interval.end != Time::new(end) {
                landing = None;
            }
        }
        self.state.reach = if layer {
            2.0 * interval.h.abs()
        } else if bounded {
            2.0 * plan.reach
        } else {
            f64::INFINITY
        };
        Ok(interval)
    }

    /// Takes a straight step over the switch ahead.
    fn take_over_switch(&mut self, target: f64) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        let left = -self.from.t.since(target);
        let ahead = self.state.ahead;
        let interval = if ahead < left.abs() {
            StepInterval::by(self.from.t, ahead.copysign(left))
        } else {
            StepInterval::to(self.from.t, target)
        };
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.backwards = self.backwards;
        if const { has_contacts::<D, N>() } {
            field.contacts = self.limits.contacts();
        }
        self.end = straight(&mut field, &interval, &mut self.from);
        self.stats.evaluations += field.evaluations;
        self.stats.accepted += 1;
        self.straight = true;
        self.project_end(interval.h)?;
        match self.passage(&mut { self.from }, &mut { self.end }, left) {
            // Rounding hides the change, or there is none.
            Passage::Nothing => {
                self.state.ahead = if ahead < 1e-6 * self.state.h { 2.0 * ahead } else { 0.0 }
            }
            Passage::Through(index) => {
                self.jump_at(index, &interval);
                self.state =
                    ControllerState { unknown: self.state.unknown, ..ControllerState::default() };
            }
            Passage::Back(index) => return Err(self.sliding(index)),
        }
        Ok(interval)
    }

    /// Changes the velocities that jump at the switch that the straight step has passed.
    fn jump_at(&mut self, index: usize, interval: &StepInterval) {
        let (from, to) = (self.from, self.end);
        let motion = |theta: f64| {
            let part: D::Scalar = Real::from_f64(theta);
            let mut at = Endpoint { t: interval.at(theta).0, a: None, ..from };
            for i in 0..N {
                at.q.high[i] += part * (to.q.high[i] - from.q.high[i]);
                at.v.high[i] += part * (to.v.high[i] - from.v.high[i]);
            }
            if theta == 1.0 { to } else { at }
        };
        let (dynamics, side) = (&*self.dynamics, onwards(self.backwards));
        let Passing { near: Endpoint { t, q, v, .. }, jump, rate, .. } =
            self.arguments.passing(dynamics, index, motion, side);
        let (q, v) = (&q.high, &v.high);
        let inputs = dynamics.inputs_with(t, side, Purpose::Accelerations, q, v);
        let near = At { t: scalar_time(t), q, v, inputs: &inputs };
        if let Some(change) = dynamics.system().jump(index, rate, near, &jump) {
            self.end.v.add(Real::from_f64(1.0), &change);
            self.end.a = None;
        }
    }

    /// Returns an error if the motion has come near to a switch, and the accelerations on both sides
    /// lead to it.
    fn check_beside_switches(
        &mut self,
        target: f64,
        absolute: &[[f64; N]; 2],
    ) -> Result<(), Error> {
        let side = onwards(self.backwards);
        let dynamics = &*self.dynamics;
        let Some([mut before, mut after]) =
            self.arguments.beside(dynamics, &self.from, side, absolute)
        else {
            return Ok(());
        };
        match self.passage(&mut before, &mut after, -self.from.t.since(target)) {
            Passage::Back(index) => Err(self.sliding(index)),
            Passage::Through(_) | Passage::Nothing => Ok(()),
        }
    }

    /// Returns what the switches do between two states near each other, before steps towards
    /// `left`.
    fn passage(
        &mut self,
        before: &mut Endpoint<D::Scalar, N>,
        after: &mut Endpoint<D::Scalar, N>,
        left: f64,
    ) -> Passage {
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.backwards = self.backwards;
        if const { has_contacts::<D, N>() } {
            field.contacts = self.limits.contacts();
        }
        let a = [before.start_acceleration(&mut field), after.start_acceleration(&mut field)];
        self.stats.evaluations += field.evaluations;
        let side = onwards(self.backwards);
        // In a fraction of a short step, the velocity of what sticks to a belt would not change.
        let largest = |values: &[D::Scalar]| {
            values.iter().fold(0.0, |most, value| f64::max(most, value.to_f64().abs()))
        };
        let changed = largest(&after.v.high) / largest(a.as_flattened());
        let time = if changed.is_finite() { changed.max(self.state.h.abs()) } else { self.state.h };
        let dt = (16.0 * D::Scalar::EPSILON.to_f64().sqrt() * time).copysign(left);
        self.arguments.crossed(&*self.dynamics, [before, after], [&a[0], &a[1]], side, dt)
    }

    /// Returns the error for a motion that would have to stay at the switch with this index.
    fn sliding(&self, index: usize) -> Error {
        let argument = <D::System as System<N>>::FACTS.switches[index];
        Error::Sliding { t: self.from.t.to_f64(), argument }
    }
}
