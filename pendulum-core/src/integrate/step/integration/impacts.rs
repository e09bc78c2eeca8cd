//! Steps of a system with limits: a step ends when it meets a limit, and the next step begins
//! there.

use super::Integration;
use crate::error::Error;
use crate::integrate::field::contacts::has_limits;
use crate::integrate::method::Method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::{Controller, ControllerState};
use crate::integrate::step::limits::{Accuracy, Limits, Meeting};
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, System};
use crate::time::Time;

impl<const N: usize, D, M, C> Integration<'_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Takes one step, or the part of a step before it meets a limit. The end then lies at the
    /// closing of the gap, which repeated steps find up to rounding, or at the end of the contact.
    #[inline(never)]
    pub(super) fn step_to_limit(
        &mut self,
        target: f64,
        met: &mut Option<Meeting>,
    ) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        const ATTEMPTS: usize = 6;
        const REPEATED: usize = 3;
        if self.backwards {
            let limit = <D::System as System<N>>::FACTS.limits[0].name;
            return Err(Error::NoWayBack { t: self.from.t.to_f64(), limit });
        }
        let accuracy = self.controller.accuracy();
        self.limits.accuracy = accuracy.map(|(relative, absolute)| Accuracy { relative, absolute });
        self.limits.begin();
        let (plan, accepted) = (self.state, self.stats.accepted);
        let mut interval = self.take(target)?;
        self.limits.step = if accuracy.is_none() { interval.h } else { 0.0 };
        for _ in 0..ATTEMPTS {
            let mut end = self.end;
            let interpolant = self.motion(&interval, &mut end);
            self.end.a = end.a;
            let Self { dynamics, prepared, limits, end, .. } = self;
            let (dynamics, prepared) = (&**dynamics, &*prepared);
            let free = |t, q: &[D::Scalar; N], v: &[D::Scalar; N]| {
                dynamics.accelerations_with(prepared, t, Side::Before, q, v)
            };
            let Some(meeting) = limits.watch(dynamics, &interpolant, end, Side::Before, free)
            else {
                return Ok(interval);
            };
            let mut t = interval.start + meeting.theta * interval.h;
            for repeated in 1..=REPEATED {
                let time = t.to_f64();
                if 0.0 <= self.from.t.since(time) {
                    // A number does not resolve the distance to the meeting.
                    self.end = Endpoint { a: None, ..self.from };
                    *met = Some(meeting);
                    return Ok(StepInterval::by(self.from.t, 0.0));
                }
                if self.end.t != Time::new(time) {
                    (self.end, self.state, self.stats.accepted) = (self.from, plan, accepted);
                    interval = self.take(time)?;
                }
                if self.end.t != Time::new(time) {
                    // The tolerances require a shorter step.
                    break;
                }
                let [gaps, rates, _] = self.end.phase(&*self.dynamics, Side::Before).gaps();
                let late = (gaps[meeting.limit] / rates[meeting.limit]).to_f64();
                let next = self.end.t + -late;
                if meeting.release
                    || repeated == REPEATED
                    || late.is_nan()
                    || 0.1 * interval.h <= late.abs()
                    || next.to_f64() == time
                {
                    *met = Some(meeting);
                    return Ok(interval);
                }
                t = next;
            }
        }
        Ok(interval)
    }

    /// Makes the state reached fulfil the limits, after a step that has met a limit or crossed a
    /// kink.
    #[cold]
    #[inline(never)]
    pub(super) fn resolve_limits(&mut self, met: Option<Meeting>) -> Result<(), Error> {
        let before = self.end;
        let Self { dynamics, prepared, limits, end, .. } = self;
        let (dynamics, prepared) = (&**dynamics, &*prepared);
        let free = |endpoint: &Endpoint<D::Scalar, N>| {
            dynamics.accelerations_with(
                prepared,
                endpoint.t,
                Side::After,
                &endpoint.q.high,
                &endpoint.v.high,
            )
        };
        let changed = limits.resolve(dynamics, end, Side::After, met, free)?;
        let contacts = self.limits.contacts();
        if contacts.any() && !self.method.keeps_contacts() {
            let all = <D::System as System<N>>::FACTS.limits;
            let first = (0..all.len()).find(|i| contacts.has(*i)).unwrap_or(0);
            let (t, method) = (before.t.to_f64(), M::NAME);
            return Err(Error::Contact { t, limit: all[first].name, method });
        }
        if changed {
            self.before_kink.get_or_insert(before);
            self.state =
                ControllerState { unknown: self.state.unknown, ..ControllerState::default() };
        }
        Ok(())
    }

    /// Checks the limits at a state that has been set, and makes the state fulfil them.
    pub(super) fn check_limits(&mut self) -> Result<(), Error> {
        if const { has_limits::<D, N>() } {
            Limits::check(&self.end.phase(&*self.dynamics, Side::After))?;
            self.limits.forget();
            let kept = self.before_kink;
            self.resolve_limits(None)?;
            self.before_kink = kept;
        }
        Ok(())
    }

    /// Returns the impacts at the end of the last step, or at the start.
    pub(crate) fn impacts(&self) -> &[Impact<D::Scalar, N>] {
        self.limits.found()
    }
}
