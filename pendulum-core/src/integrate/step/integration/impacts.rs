//! Steps of a system with limits: a step ends when it meets a limit, and the next step begins
//! there.

use super::Integration;
use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::field::cone::{group, heads, norm};
use crate::integrate::field::contacts::{self, CLOSED, has_contacts};
use crate::integrate::field::grasp::{Grip, has_frictions, has_vectors};
use crate::integrate::method::Method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::{Controller, ControllerState};
use crate::integrate::step::frictions::{BREAKS, decide};
use crate::integrate::step::limits::{Accuracy, Limits};
use crate::integrate::step::meeting::{Meeting, Met};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System};
use crate::time::Time;
use core::ops::Range;

/// The longest step while a rate against a vector slides, in units of the time in which friction
/// alone would stop it: the direction of a small rate is stiff, and an explicit method turns it back
/// and forth in longer steps, with errors that may cancel in the estimate.
const STABLE: f64 = 6.0;

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
            let (t, facts) = (self.from.t.to_f64(), &<D::System as System<N>>::FACTS);
            return Err(match facts.limits.first() {
                Some(limit) => Error::NoWayBack { t, limit: limit.name },
                None => Error::FrictionBack { t, friction: facts.frictions[0].name },
            });
        }
        let accuracy = self.controller.accuracy();
        self.limits.accuracy = accuracy.map(|(relative, absolute)| Accuracy { relative, absolute });
        self.limits.begin();
        let mut target = target;
        if const { has_vectors::<D, N>() } {
            let (what, left) = self.approach();
            if let Some(what) = what {
                self.end = Endpoint { a: None, ..self.from };
                *met = Some(Meeting { theta: 0.0, what });
                return Ok(StepInterval::by(self.from.t, 0.0));
            }
            // Behind the place where a rate is zero, the equations say nothing.
            let part = if accuracy.is_some() { 0.9 } else { 0.5 };
            if part * left < -self.from.t.since(target) {
                target = (self.from.t + part * left).to_f64();
            }
        }
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
            let meets = if const { 0 < contacts::limits::<D, N>() } {
                limits.watch(dynamics, &interpolant, end, Side::Before, free)
            } else {
                None
            };
            let rubs = if const { has_frictions::<D, N>() } {
                // Beyond the meeting with a limit, forces have no meaning.
                let until = meets.map_or(1.0, |meets| meets.theta);
                let (held, step) = (limits.contacts(), (&interpolant, &*end, until));
                let accuracy = limits.accuracy;
                let allowed = |j: usize, v: D::Scalar| {
                    accuracy.map_or(f64::INFINITY, |own| own.allows(j, v.to_f64()))
                };
                let ways = (free, allowed);
                limits.frictions.watch(&held, dynamics, step, Side::Before, ways)?
            } else {
                None
            };
            let earlier = |rub: &Meeting| meets.is_none_or(|meets| rub.theta < meets.theta);
            let Some(meeting) = rubs.filter(earlier).or(meets) else {
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
                let late = self.late(meeting.what);
                let next = self.end.t + -late;
                if repeated == REPEATED
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

    /// Returns the change of a friction against a vector whose rate becomes zero before another
    /// number of time, or would no longer leave zero, and how long the rates of the others would
    /// take to become zero if they went on as now.
    ///
    /// The direction of such a rate changes as fast as the rate is small, up to the place where it
    /// is zero, with powers of the time that remains: steps approach this place geometrically.
    fn approach(&mut self) -> (Option<Met>, f64) {
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.contacts = self.limits.contacts();
        let a = self.from.start_acceleration(&mut field);
        self.stats.evaluations += field.evaluations;
        let Endpoint { t, q, v, .. } = &self.from;
        let side = Side::After;
        let free = self.dynamics.accelerations_with(&self.prepared, *t, side, &q.high, &v.high);
        let phase = self.from.phase(&*self.dynamics, side);
        let grasp = phase.grasp_with(&free, &field.contacts);
        let ([rates, _], least) = (grasp.rates, grasp.rounding(phase.v, &phase.sizes()[1]));
        let (before, after) = (grasp.after(&free), grasp.after(&a));
        let facts = <D::System as System<N>>::FACTS.frictions;
        let number = D::Scalar::from_f64;
        let mut soonest = f64::INFINITY;
        let contacts = &field.contacts;
        let slides =
            |own: &Range<usize>| 1 < own.len() && grasp.direction(contacts, own.start).is_some();
        for own in heads(facts).map(|head| group(facts, head)).filter(slides) {
            let [mut pace, mut force, mut noise, mut squares] = [number(0.0); 4];
            for k in own.clone() {
                let s = grasp.direction(contacts, k).unwrap_or(number(0.0));
                (pace, squares) = (pace - s * after[k], squares + s * s);
                force += s * (before[k] - after[k]);
                noise += number(BREAKS) * grasp.noise(k, &free, &a);
            }
            let small = |k: usize| rates[k].abs() <= number(CLOSED) * least[k];
            if own.clone().all(small) {
                // What has just broken away needs all of its force, up to rounding errors.
                if squares < number(1.0 - 1e-6) {
                    return (Some(Met::Stops(own.start)), 0.0);
                }
                continue;
            }
            let size = norm(&rates[own.clone()]);
            let turns = contacts.grip(own.start) == Grip::Forwards && number(0.0) < force;
            if turns && self.limits.accuracy.is_some() {
                soonest = f64::min(soonest, STABLE * (size / force).to_f64());
            }
            if noise < pace {
                let left = (size / pace).to_f64();
                if contacts.grip(own.start) == Grip::Backwards {
                    return (Some(Met::Turns), left);
                }
                // Below the tolerances, errors would turn the rate as they like. If the friction is
                // hardly greater than what drives the rate, its direction is stiff long before: an
                // explicit method lets the rate hover at a few tolerances, and may miss the stop.
                let part = if pace < number(0.1) * force { 4.0 } else { 0.1 };
                let allowed = |k: usize| {
                    grasp.allowed(k, phase.v, |j, v| {
                        self.limits.accuracy.map_or(0.0, |own| part * own.allows(j, v.to_f64()))
                    })
                };
                let mut resting = *contacts;
                own.clone().for_each(|k| resting.grips[k] = Grip::Sticks);
                let stops = || {
                    let decided = decide(&phase, &free, &resting);
                    decided.is_ok_and(|decided| decided.grip(own.start) == Grip::Sticks)
                };
                if left <= 4.0 * f64::EPSILON * t.to_f64().abs()
                    || size.to_f64() <= own.clone().map(allowed).sum() && stops()
                {
                    return (Some(Met::Stops(own.start)), left);
                }
                soonest = f64::min(soonest, left);
            }
        }
        (None, soonest)
    }

    /// Returns how long ago the end of a step has met `what`; NaN for what no number shows as well.
    fn late(&mut self, what: Met) -> f64 {
        let side = Side::Before;
        match what {
            Met::Closes(limit) => {
                let [gaps, rates, _] = self.end.phase(&*self.dynamics, side).gaps();
                (gaps[limit] / rates[limit]).to_f64()
            }
            Met::Stops(friction) => {
                let mut field = Field::new(&*self.dynamics, &self.prepared);
                field.contacts = self.limits.began();
                let a = self.end.end_acceleration(&mut field);
                let grasp = self.end.phase(&*self.dynamics, side).grasp();
                (grasp.rates[0][friction] / grasp.after(&a)[friction]).to_f64()
            }
            Met::Opens(_) | Met::Breaks { .. } | Met::Turns => f64::NAN,
        }
    }

    /// Makes the state reached fulfil the limits, after a step that has met a limit or crossed a
    /// kink.
    #[cold]
    #[inline(never)]
    pub(super) fn resolve_limits(&mut self, met: Option<Meeting>) -> Result<(), Error> {
        let (before, crossed) = (self.end, self.crossed);
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
        let changed = limits.resolve(dynamics, end, Side::After, (met, crossed), free)?;
        end.settle(dynamics, Side::After);
        let contacts = self.limits.contacts();
        if contacts.any() && !self.method.keeps_contacts() {
            let (t, method) = (before.t.to_f64(), M::NAME);
            let facts = &<D::System as System<N>>::FACTS;
            let touching = (0..facts.limits.len()).find(|i| contacts.has(*i));
            return Err(match touching {
                Some(limit) => Error::Contact { t, limit: facts.limits[limit].name, method },
                None => Error::Friction { t, friction: facts.frictions[0].name, method },
            });
        }
        if let Some(Met::Stops(friction) | Met::Breaks { friction, .. }) = met.map(|met| met.what) {
            self.limits.frictions.count::<D, N>(before.t, friction)?;
        }
        if changed {
            self.before_kink.get_or_insert(before);
            let ControllerState { h, error, unknown, .. } = self.state;
            // The motion goes on as smoothly as before, in contrast to an impact.
            let smooth =
                matches!(met.map(|met| met.what), Some(Met::Stops(_) | Met::Breaks { .. }));
            let (h, error) = if smooth { (h, error) } else { (0.0, 0.0) };
            self.state = ControllerState { h, error, unknown, ..ControllerState::default() };
        }
        Ok(())
    }

    /// Checks the limits at a state that has been set, and makes the state fulfil them.
    pub(super) fn check_limits(&mut self) -> Result<(), Error> {
        if const { has_contacts::<D, N>() } {
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
