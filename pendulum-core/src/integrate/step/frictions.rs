//! Dry frictions during an integration: rates that become zero, and forces that break away.
//!
//! While a friction slides, the step ends where its rate becomes zero; while it sticks, where its
//! force exceeds the bound. What follows is decided there: sticking, sliding on, or sliding back.

use crate::error::Error;
use crate::integrate::events::root;
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::grasp::{Grip, Rubbed, frictions};
use crate::integrate::field::phase::Phase;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::meeting::{
    CLOSED, FINEST, HALVINGS, Meeting, Met, PARTS, Place, dip, falling, place,
};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, MOST_FRICTIONS as F, System};
use crate::time::Time;

/// The rounding errors of a force above its bound with which a friction breaks away.
const BREAKS: f64 = 64.0;
/// The number of changes at one time after which a run ends in an error. Each of sixteen frictions
/// may break away after another, and be stopped by it.
const STALLS: u32 = 256;

/// The modes of the frictions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modes {
    pub(crate) grips: [Grip; F],
    /// `true` for frictions that slide, but with a rate that has been zero up to rounding since. Its
    /// sign does not count yet.
    fresh: [bool; F],
}

/// The dry frictions of an integration.
#[derive(Clone, Debug)]
pub(crate) struct Frictions {
    pub(crate) now: Modes,
    /// The modes at the start of the last step.
    pub(crate) before: Modes,
    /// The time of the last change, and the number of changes at that time.
    stalled: (f64, u32),
}

impl Frictions {
    pub(crate) fn new(count: usize) -> Self {
        let grip = |k| if k < count { Grip::Forwards } else { Grip::Absent };
        let now = Modes { grips: core::array::from_fn(grip), fresh: [false; F] };
        Self { now, before: now, stalled: (f64::NAN, 0) }
    }

    /// Resets the modes, after the state of the system has been set: rates that are not zero decide.
    pub(crate) fn forget(&mut self) {
        let forget = |grip| if grip == Grip::Absent { grip } else { Grip::Forwards };
        self.now = Modes { grips: self.now.grips.map(forget), fresh: [false; F] };
        self.stalled = (f64::NAN, 0);
    }

    /// Visits the data that one step passes to the next.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        let Modes { grips, fresh } = &mut self.now;
        for (grip, fresh) in grips.iter_mut().zip(fresh).filter(|(grip, _)| **grip != Grip::Absent)
        {
            let mut index = Grip::ALL.iter().position(|other| other == grip).unwrap_or(0);
            memory.count(&mut index, Grip::ALL.len() - 1);
            *grip = Grip::ALL[index];
            memory.flag(fresh);
        }
        if memory.reads() {
            self.before = self.now;
        }
    }

    /// Begins to decide the modes after a step that has met `what`. If rates may have `jumped`, at an
    /// impact or where a belt changes its speed at a kink, they alone tell what is at rest.
    pub(crate) fn rest(&self, what: Option<Met>, jumped: bool) -> Rest {
        let mut at_rest = self.now.grips.map(|grip| grip == Grip::Sticks);
        let mut released = None;
        if jumped {
            return Rest { at_rest: [false; F], released };
        }
        match what {
            Some(Met::Stops(friction)) => at_rest[friction] = true,
            Some(Met::Breaks { friction, forwards }) => released = Some((friction, forwards)),
            _ => {}
        }
        Rest { at_rest, released }
    }

    /// Sets the modes.
    pub(crate) fn set(&mut self, grips: &[Grip; F], rest: &Rest) {
        self.now.grips = *grips;
        for k in 0..F {
            self.now.fresh[k] = rest.at_rest[k] && grips[k] != Grip::Sticks;
        }
    }

    /// Counts a change at `t`.
    ///
    /// # Errors
    /// Returns an error if there are too many of them at one time.
    pub(crate) fn count<D: Dynamics<N>, const N: usize>(
        &mut self,
        t: Time,
        friction: usize,
    ) -> Result<(), Error> {
        let t = t.to_f64();
        self.stalled = if self.stalled.0 == t { (t, self.stalled.1 + 1) } else { (t, 1) };
        if self.stalled.1 <= STALLS {
            return Ok(());
        }
        Err(Error::NoGrip { t, friction: name::<D, N>(friction) })
    }
}

/// The frictions whose modes are to be decided.
pub(crate) struct Rest {
    /// The frictions whose rates are zero.
    at_rest: [bool; F],
    /// The friction that has broken away, and its direction.
    released: Option<(usize, bool)>,
}

impl Rest {
    /// Returns the modes by the rates: those at rate zero stick until it is decided. Once it is zero
    /// up to rounding errors of the velocities `scale`, a rate is kept so.
    pub(crate) fn find<D: Dynamics<N, Scalar: Float>, const N: usize>(
        &mut self,
        phase: &Phase<'_, D, N>,
        scale: &[D::Scalar; N],
    ) -> [Grip; F] {
        let zero = D::Scalar::from_f64(0.0);
        let grasp = phase.grasp();
        let least = grasp.rounding(phase.v, scale);
        let mut grips = [Grip::Absent; F];
        for k in 0..frictions::<D, N>() {
            let rate = grasp.rates[0][k];
            self.at_rest[k] |= rate.abs() <= D::Scalar::from_f64(CLOSED) * least[k];
            grips[k] = if self.at_rest[k] { Grip::Sticks } else { Grip::sliding(zero < rate) };
        }
        grips
    }

    /// Returns the modes of all frictions, from those that [`find`](Self::find) has returned.
    ///
    /// # Errors
    /// Returns [`Error::NoGrip`] if no accelerations fulfil the laws of contacts and frictions.
    pub(crate) fn decide<D: Dynamics<N, Scalar: Float>, const N: usize>(
        &mut self,
        phase: &Phase<'_, D, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Result<[Grip; F], Error> {
        let mut contacts = *contacts;
        let undecided = |k: usize| self.at_rest[k] && contacts.grips[k] != Grip::Absent;
        let at_rest: [bool; F] = core::array::from_fn(undecided);
        for k in (0..F).filter(|k| at_rest[*k]) {
            contacts.grips[k] = Grip::Sticks;
        }
        if let Some((friction, forwards)) = self.released {
            contacts.grips[friction] = Grip::sliding(forwards);
            self.at_rest[friction] = true;
            let decided = decide(phase, free, &contacts)?;
            let a = phase.push(free, &decided, true).accelerations;
            let rate = phase.grasp().after(&a)[friction].to_f64();
            let noise = BREAKS * phase.grasp().noise(friction, free, &a).to_f64();
            if -noise <= if forwards { rate } else { -rate } {
                return Ok(decided.grips);
            }
            self.released = None;
            contacts.grips[friction] = Grip::Sticks;
        }
        Ok(decide(phase, free, &contacts)?.grips)
    }
}

/// Returns the contacts with the modes of the frictions that stick, as [`Phase::decide`] does.
fn decide<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    free: &[D::Scalar; N],
    contacts: &Contacts,
) -> Result<Contacts, Error> {
    let refused = |k| Error::NoGrip { t: phase.t.to_f64(), friction: name::<D, N>(k) };
    phase.decide(free, contacts).map_err(refused)
}

/// Returns `true` if a friction that sticks has a rate.
pub(super) fn slides<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    contacts: &Contacts,
) -> bool {
    let grasp = phase.grasp();
    let least = grasp.rounding(phase.v, &phase.sizes()[1]);
    (0..F).any(|k| contacts.grips[k] == Grip::Sticks && least[k] < grasp.rates[0][k].abs())
}

fn name<D: Dynamics<N>, const N: usize>(friction: usize) -> &'static str {
    <D::System as System<N>>::FACTS.frictions[friction].name
}

/// The frictions at a place within a step.
struct Sight<T> {
    theta: f64,
    /// The rates.
    rates: [T; F],
    rubbed: Rubbed<T>,
}

impl<T: Float> Sight<T> {
    /// Returns how far the force of a friction that sticks is below its bound.
    fn margin(&self, friction: usize) -> T {
        let Rubbed { forces, bounds, .. } = &self.rubbed;
        let noise = T::from_f64(BREAKS) * T::EPSILON * bounds[friction];
        bounds[friction] + noise - forces[friction].abs()
    }

    /// Returns the rate of a friction that slides in the direction `s`, above `least`.
    fn place(&self, friction: usize, s: f64, least: f64) -> Place {
        let (rate, second) = (self.rates[friction].to_f64(), self.rubbed.rates[friction].to_f64());
        Place { theta: self.theta, gap: s * rate - least, rate: s * second }
    }
}

impl Frictions {
    /// Returns the first change of a friction within the step of `interpolant` that ends in `end`,
    /// if any before its fraction `until`, with the limits in contact and the modes `held`.
    ///
    /// # Errors
    /// Returns an error for a negative magnitude, and for a friction whose contact has no force
    /// that keeps it closed.
    pub(crate) fn watch<T: Float, D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        held: &Contacts,
        dynamics: &D,
        (interpolant, end, until): (&Interpolant<T, N>, &Endpoint<T, N>, f64),
        side: Side,
        free: impl Fn(Time, &[T; N], &[T; N]) -> [T; N],
    ) -> Result<Option<Meeting>, Error> {
        let zero = T::from_f64(0.0);
        let look = |theta: f64| {
            let (t, q, v) = place(interpolant, end, theta);
            see(&Phase { dynamics, t, side, q: &q, v: &v }, &free(t, &q, &v), held, theta)
        };
        let sticks = |k: &usize| held.grip(*k) == Grip::Sticks;
        let sticking = || (0..frictions::<D, N>()).filter(sticks);
        // The friction that breaks away most, and its direction.
        let broken = |sight: &Sight<T>| -> Result<Option<(usize, bool)>, Error> {
            if !sticking().any(|k| sight.margin(k) < zero) {
                return Ok(None);
            }
            let (t, q, v) = place(interpolant, end, sight.theta);
            let phase = Phase { dynamics, t, side, q: &q, v: &v };
            let decided = decide(&phase, &free(t, &q, &v), held)?;
            let moving = sticking().filter(|k| decided.grip(*k) != Grip::Sticks);
            let most = |a: usize, b: usize| if sight.margin(b) < sight.margin(a) { b } else { a };
            Ok(moving.reduce(most).map(|k| (k, decided.grip(k) == Grip::Forwards)))
        };
        let broken_at = |sight: &Sight<T>| {
            let meeting = |(friction, forwards)| {
                let what = Met::Breaks { friction, forwards };
                Meeting { theta: sight.theta, what }
            };
            broken(sight).map(|found| found.map(meeting))
        };
        // The first place between two at which a friction breaks away.
        let breaks = |mut whole: f64, beyond: Meeting| -> Result<Meeting, Error> {
            let mut found = beyond;
            for _ in 0..HALVINGS {
                let middle = whole + 0.5 * (found.theta - whole);
                match broken_at(&look(middle)?)? {
                    Some(earlier) => found = earlier,
                    None => whole = middle,
                }
            }
            Ok(found)
        };
        let mut fresh = self.now.fresh;
        let mut last = look(0.0)?;
        if let Some(meeting) = broken_at(&last)? {
            return Ok(Some(meeting));
        }
        let flat: [f64; F] = {
            let (t, q, v) = place(interpolant, end, 0.0);
            let phase = Phase { dynamics, t, side, q: &q, v: &v };
            let least = phase.grasp().rounding(&v, &phase.sizes()[1]);
            least.map(|least| CLOSED * least.to_f64())
        };
        let mut earlier: Option<Sight<T>> = None;
        for part in 1..=PARTS {
            if until <= last.theta {
                break;
            }
            let here = look(f64::min(part as f64 / PARTS as f64, until))?;
            let mut first: Option<Meeting> = None;
            let mut meet = |found: Meeting| {
                if first.is_none_or(|first| found.theta < first.theta) {
                    first = Some(found);
                }
            };
            if let Some(beyond) = broken_at(&here)? {
                meet(breaks(last.theta, beyond)?);
            } else if let Some(earlier) = &earlier {
                for k in sticking() {
                    let points = [earlier, &last, &here]
                        .map(|sight| (T::from_f64(sight.theta), sight.margin(k)));
                    if points[0].1 <= points[1].1
                        || points[2].1 < points[1].1
                        || root::stays_away(&points, zero)
                    {
                        continue;
                    }
                    let mut margin = |theta: T| look(theta.to_f64()).map(|sight| sight.margin(k));
                    if let root::Dip::Crosses(low) = root::dip(&mut margin, points, zero)?
                        && let Some(beyond) = broken_at(&look(low.to_f64())?)?
                    {
                        meet(breaks(earlier.theta, beyond)?);
                    }
                }
            }
            for k in 0..frictions::<D, N>() {
                let Some(s) = held.grip(k).direction::<f64>() else { continue };
                let least = if fresh[k] { -flat[k] } else { 0.0 };
                let on = |theta: f64| match look(theta) {
                    Ok(sight) => sight.place(k, s, least),
                    Err(_) => Place { theta, gap: f64::NAN, rate: f64::NAN },
                };
                let [from, to] = [&last, &here].map(|sight| sight.place(k, s, least));
                let low = dip(&on, from, to, interpolant.interval.h, FINEST);
                let below = low.or((to.gap < 0.0).then_some(to.theta));
                if let Some(below) = below {
                    let theta = falling(|theta| on(theta).gap, last.theta, below, 0.0);
                    meet(Meeting { theta, what: Met::Stops(k) });
                } else if flat[k] < to.gap + least {
                    fresh[k] = false;
                }
            }
            if first.is_some() {
                return Ok(first);
            }
            earlier = Some(core::mem::replace(&mut last, here));
        }
        self.now.fresh = fresh;
        Ok(None)
    }
}

/// Returns the frictions at a state.
///
/// # Errors
/// As [`Frictions::watch`].
fn see<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    free: &[D::Scalar; N],
    contacts: &Contacts,
    theta: f64,
) -> Result<Sight<D::Scalar>, Error> {
    let zero = D::Scalar::from_f64(0.0);
    let grasp = phase.grasp();
    let t = phase.t.to_f64();
    for k in 0..frictions::<D, N>() {
        let shares = grasp.shares.iter().flatten();
        let shares = shares.flat_map(|shares| (0..shares.ncols()).map(move |i| shares[(k, i)]));
        let sizes = grasp.magnitudes.iter().map(|part| part[k]).chain(shares);
        if let Some(value) = sizes.into_iter().find(|value| *value < zero) {
            let (friction, value) = (name::<D, N>(k), value.to_f64());
            return Err(Error::NegativeFriction { t, friction, value });
        }
    }
    let push = phase.push_with(Some(&grasp), free, contacts, false);
    let rubbed = phase.rubbed(&grasp, free, contacts, &push);
    if let Some(k) = rubbed.jam {
        return Err(Error::NoGrip { t, friction: name::<D, N>(k) });
    }
    Ok(Sight { theta, rates: grasp.rates[0], rubbed })
}
