//! Dry frictions during an integration: rates that become zero, and forces that break away.
//!
//! While a friction slides, the step ends where its rate becomes zero; while it sticks, where its
//! force exceeds the bound. What follows is decided there: sticking, sliding on, or sliding back.

use crate::error::Error;
use crate::integrate::field::cone::{group, heads};
use crate::integrate::field::contacts::{CLOSED, Contacts};
use crate::integrate::field::grasp::{Grip, frictions, has_vectors};
use crate::integrate::field::phase::Phase;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::course::{Course, Sight};
use crate::integrate::step::meeting::{Meeting, Met, PARTS};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Friction, MOST_FRICTIONS as F, System};
use crate::time::Time;

/// The rounding errors of a force above its bound with which a friction breaks away.
pub(super) const BREAKS: f64 = 64.0;
/// The number of changes at one time after which a run ends in an error. Each of sixteen frictions
/// may break away after another, and be stopped by it.
const STALLS: u32 = 256;

/// The modes of the frictions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

impl Modes {
    pub(crate) const NONE: Self = Self { grips: [Grip::Absent; F], fresh: [false; F] };

    /// Returns the number that stands for the mode of a friction.
    pub(crate) fn code(&self, friction: usize) -> usize {
        2 * (self.grips[friction] as usize) + usize::from(self.fresh[friction])
    }

    /// Sets a mode by its number; `None` if there is no such mode.
    pub(crate) fn set(&mut self, friction: usize, code: usize) -> Option<()> {
        (self.grips[friction], self.fresh[friction]) = (*Grip::ALL.get(code / 2)?, code % 2 == 1);
        (self.grips[friction] != Grip::Absent).then_some(())
    }
}

impl Frictions {
    pub(crate) fn new(count: usize) -> Self {
        let grip = |k| if k < count { Grip::Forwards } else { Grip::Absent };
        Self::of(Modes { grips: core::array::from_fn(grip), fresh: [false; F] })
    }

    /// Creates frictions in modes of an earlier step.
    pub(crate) fn of(now: Modes) -> Self {
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
    pub(crate) fn rest(&self, facts: &'static [Friction], what: Option<Met>, jumped: bool) -> Rest {
        let mut still = self.now.grips.map(|grip| grip == Grip::Sticks);
        let mut released = None;
        if jumped {
            return Rest { facts, still: [false; F], released };
        }
        match what {
            Some(Met::Stops(friction)) => {
                group(facts, friction).for_each(|k| still[k] = true);
            }
            Some(Met::Breaks { friction, forwards }) => released = Some((friction, forwards)),
            _ => {}
        }
        Rest { facts, still, released }
    }

    /// Sets the modes.
    pub(crate) fn set(&mut self, grips: &[Grip; F], rest: &Rest) {
        self.now.grips = *grips;
        for (k, Friction { components, .. }) in rest.facts.iter().enumerate() {
            // A vector has no sign.
            let scalar = *components == 1;
            self.now.fresh[k] = scalar && rest.still[k] && grips[k] != Grip::Sticks;
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
    facts: &'static [Friction],
    /// The frictions whose rates are zero.
    still: [bool; F],
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
        let small = |k: usize| grasp.rates[0][k].abs() <= D::Scalar::from_f64(CLOSED) * least[k];
        for own in heads(self.facts).map(|head| group(self.facts, head)) {
            let (all, vector) = (own.clone().all(small), 1 < own.len());
            for k in own {
                self.still[k] |= all;
                let forwards = vector || zero < grasp.rates[0][k];
                grips[k] = if self.still[k] { Grip::Sticks } else { Grip::sliding(forwards) };
            }
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
        let undecided = |k: usize| self.still[k] && contacts.grips[k] != Grip::Absent;
        let at_rest: [bool; F] = core::array::from_fn(undecided);
        for k in (0..F).filter(|k| at_rest[*k]) {
            contacts.grips[k] = Grip::Sticks;
        }
        if let Some((friction, forwards)) = self.released {
            let own = group(self.facts, friction);
            for k in own.clone() {
                (contacts.grips[k], self.still[k]) = (Grip::sliding(forwards), true);
            }
            let decided = decide(phase, free, &contacts)?;
            let a = phase.push(free, &decided, true).accelerations;
            let grasp = phase.grasp_with(free, &decided);
            let rates = grasp.after(&a);
            let (mut rate, mut noise) = (0.0, 0.0);
            for k in own.clone() {
                let s = grasp.direction(&decided, k).map_or(0.0, D::Scalar::to_f64);
                rate += s * rates[k].to_f64();
                noise += BREAKS * grasp.noise(k, free, &a).to_f64();
            }
            if -noise <= rate {
                return Ok(decided.grips);
            }
            self.released = None;
            own.for_each(|k| contacts.grips[k] = Grip::Sticks);
        }
        Ok(decide(phase, free, &contacts)?.grips)
    }
}

/// Returns the contacts with the modes of the frictions that stick, as [`Phase::decide`] does.
pub(super) fn decide<D: Dynamics<N, Scalar: Float>, const N: usize>(
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

/// Returns the name of a friction by its index.
pub(super) fn name<D: Dynamics<N>, const N: usize>(friction: usize) -> &'static str {
    <D::System as System<N>>::FACTS.frictions[friction].name
}

impl Frictions {
    /// Returns the first change of a friction within the step of `interpolant` that ends in `end`,
    /// if any before its fraction `until`, with the limits in contact and the modes `held`.
    ///
    /// A rate costs little, a force an evaluation of the accelerations: where all frictions slide
    /// and no limit is in contact, forces are computed only where a rate may reach zero.
    ///
    /// `allowed` are the changes of the velocities that the tolerances allow.
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
        (free, allowed): (impl Fn(Time, &[T; N], &[T; N]) -> [T; N], impl Fn(usize, T) -> f64),
    ) -> Result<Option<Meeting>, Error> {
        let course = Course { held, dynamics, interpolant, end, side, free };
        let forced = held.hold();
        let mut fresh = self.now.fresh;
        let watched = fresh.contains(&true) || const { has_vectors::<D, N>() };
        let flat = if watched { course.flat() } else { [0.0; F] };
        let theta = |part: f64| until * part / PARTS as f64;
        let count = const { frictions::<D, N>() };
        let facts = <D::System as System<N>>::FACTS.frictions;
        // A vector that turns by more than a right angle between two places may have been zero.
        let turns = |all: &[[f64; PARTS + 1]; F], k: usize, [from, to]: [usize; 2]| {
            let apart = |place: usize| group(facts, k).any(|k| flat[k] < all[k][place].abs());
            let product = group(facts, k).fold(0.0, |sum, k| sum + all[k][from] * all[k][to]);
            product < 0.0 && apart(from) && apart(to)
        };
        let far = |k: usize, all: &[[f64; PARTS + 1]; F]| {
            if facts[k].components != 1 {
                return !forced
                    && held.grip(k) != Grip::Backwards
                    && !(2..=PARTS).step_by(2).any(|to| turns(all, k, [to - 2, to]));
            }
            let rates: [f64; PARTS / 2 + 1] = core::array::from_fn(|i| all[k][2 * i]);
            let bend = bend(&rates);
            let slides = |s: f64| rates.iter().all(|rate| bend < s * rate);
            !(forced || fresh[k]) && held.grip(k).direction().is_some_and(slides)
        };
        let mut rates = [[0.0; PARTS + 1]; F];
        // An error counts only if nothing changes before.
        let mut refused: Option<(usize, Error)> = None;
        for part in (0..=PARTS).step_by(2).chain((1..PARTS).step_by(2)) {
            // Most steps are far from any change: every second place shows it.
            if part == 1 && refused.is_none() && heads(facts).all(|k| far(k, &rates)) {
                return Ok(None);
            }
            match course.rates(theta(part as f64)) {
                Ok(found) => (0..count).for_each(|k| rates[k][part] = found[k].to_f64()),
                Err(error) if refused.as_ref().is_none_or(|(first, _)| part < *first) => {
                    refused = Some((part, error));
                }
                Err(_) => {}
            }
        }
        let mut bends = [0.0; F];
        (0..count).for_each(|k| bends[k] = bend(&rates[k]));
        let (mut earlier, mut last): (Option<Sight<T>>, Option<Sight<T>>) = (None, None);
        if forced {
            let start = course.look(0.0)?;
            if let Some(meeting) = course.broken(&start)? {
                return Ok(Some(meeting));
            }
            last = Some(start);
        }
        for part in 1..=PARTS {
            if let Some((_, error)) = refused.take_if(|(place, _)| *place <= part) {
                return Err(error);
            }
            let mut first: Option<Meeting> = None;
            let mut meet = |found: Meeting| {
                if first.is_none_or(|first| found.theta < first.theta) {
                    first = Some(found);
                }
            };
            if let Some(before) = &last {
                let here = course.look(theta(part as f64))?;
                let edges = [part == 2, part == PARTS];
                if let Some(meeting) = course.breaks(earlier.as_ref(), before, &here, edges)? {
                    meet(meeting);
                }
                earlier = last.replace(here);
            }
            for k in heads(facts) {
                let Some(s) = held.grip(k).direction::<f64>() else { continue };
                if facts[k].components != 1 {
                    if turns(&rates, k, [part - 1, part]) {
                        let theta = theta(f64::max(part as f64 - 1.0, 0.5));
                        meet(Meeting { theta, what: Met::Turns });
                    }
                    continue;
                }
                let least = if fresh[k] { -flat[k] } else { 0.0 };
                let [before, after] = [part - 1, part].map(|part| s * rates[k][part] - least);
                let bend = bends[k];
                // A rate that turns nowhere crosses zero once or not at all.
                let turns = !(4.0 * bend < (after - before).abs() && 0.0 < before);
                let mut below = (after < 0.0).then(|| theta(part as f64));
                let far = bend < f64::min(before, after);
                if turns && !far {
                    let low = course.dips(k, (s, least), part, theta, (&rates[k], bend));
                    below = low.or(below);
                }
                if let Some(below) = below {
                    let from = theta((part - 1) as f64);
                    let theta = course.stops(k, s, least, [from, below]);
                    meet(Meeting { theta, what: Met::Stops(k) });
                } else if flat[k] < after + least {
                    fresh[k] = false;
                }
            }
            if const { has_vectors::<D, N>() } && first.is_none() {
                let [from, to] = [part - 1, part].map(|part| theta(part as f64));
                first = course.leaves([from, to], until == to, &allowed);
            }
            if first.is_some() {
                return Ok(first);
            }
        }
        self.now.fresh = fresh;
        Ok(None)
    }
}

/// Returns the distance from zero above which a rate, given at equal distances, does not reach zero
/// between two of them: four times what a parabola with the largest second difference falls by.
fn bend(rates: &[f64]) -> f64 {
    let second = rates.windows(3).map(|rates| (rates[0] - 2.0 * rates[1] + rates[2]).abs());
    0.5 * second.fold(0.0, |most, second| if most <= second { second } else { most })
}
