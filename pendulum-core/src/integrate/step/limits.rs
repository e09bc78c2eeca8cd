//! Limits during an integration: gaps that close, contacts that end, and the velocities afterwards.

use crate::error::Error;
use crate::integrate::events::root;
use crate::integrate::field::contacts::{self, CLOSED, Contacts, Push, limits};
use crate::integrate::field::grasp::{Grip, frictions, has_frictions};
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::product;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::saved::Memory;
use crate::integrate::step::contact::{
    check_room, depths, facts, give_back, may_move, no_room, project, project_onto_contacts,
};
use crate::integrate::step::frictions::{Frictions, name};
use crate::integrate::step::meeting::{
    FINEST, HALVINGS, Meeting, Met, PARTS, Place, dip, falling, place,
};
use crate::integrate::step::standing::{Standing, Standings};
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, Limit, MOST_LIMITS as L, System};
use crate::time::Time;

/// The number of rounds of impacts at one time that use the restitutions of the limits; a plastic
/// impact of all limits then ends them. Rounds end by themselves when the rates have fallen to
/// rounding errors, and bodies without losses between two walls at an angle α after π/α impacts.
const IMPACTS: usize = 1000;
/// The rounding errors of the second rate of a gap above which a contact opens, or below which a
/// gap of zero becomes a contact again. Four times those that decide which contacts stay, so that
/// a contact that has opened does not return by rounding.
const DECIDED: f64 = 4.0;

use Standing::{Clear, Contact, Rising};

/// The relative and absolute tolerances of the steps, coordinates before velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy<const N: usize> {
    pub(crate) relative: f64,
    pub(crate) absolute: [[f64; N]; 2],
}

impl<const N: usize> Accuracy<N> {
    /// Returns the change of a velocity that the tolerances allow.
    pub(crate) fn allows(&self, coordinate: usize, v: f64) -> f64 {
        self.absolute[1][coordinate] + self.relative * v.abs()
    }
}

/// The limits of an integration.
#[derive(Clone, Debug)]
pub(crate) struct Limits<T, const N: usize> {
    standing: [Standing; L],
    /// The states of the gaps at the start of the last step.
    before: [Standing; L],
    /// The tolerances; `None` with steps of fixed length.
    pub(crate) accuracy: Option<Accuracy<N>>,
    /// The length of the last step before it was cut at a limit, if steps have a fixed length;
    /// otherwise zero.
    pub(crate) step: f64,
    /// The largest rate of the impacts at each limit. Those that follow carry its rounding error.
    fastest: [T; L],
    /// The impacts at the end of the last step.
    found: Vec<Impact<T, N>>,
    /// `true` if the impacts are not recorded, for which there is no memory.
    silent: bool,
    /// The dry frictions.
    pub(crate) frictions: Frictions,
}

impl<T: Float, const N: usize> Limits<T, N> {
    pub(crate) fn new(limits: usize, frictions: usize) -> Self {
        let found = Vec::with_capacity(limits);
        let frictions = Frictions::new(frictions);
        Self { found, silent: false, frictions, ..Self::silent(Standings::OPEN) }
    }

    /// Creates limits and frictions in states of an earlier step that do not record impacts.
    pub(crate) fn silent(standings: Standings) -> Self {
        Self {
            standing: standings.limits,
            before: standings.limits,
            accuracy: None,
            step: 0.0,
            fastest: [T::from_f64(0.0); L],
            found: Vec::new(),
            silent: true,
            frictions: Frictions::of(standings.frictions),
        }
    }

    /// Returns the states of all gaps and frictions.
    pub(crate) fn standings(&self) -> Standings {
        Standings { limits: self.standing, frictions: self.frictions.now }
    }

    /// Returns the limits in contact.
    pub(crate) fn contacts(&self) -> Contacts {
        self.standings().contacts()
    }

    /// Returns the limits that were in contact during the last step.
    pub(crate) fn began(&self) -> Contacts {
        let on = self.before.map(|standing| standing == Contact);
        Contacts::new(on, self.frictions.before.grips)
    }

    /// Returns the impacts at the end of the last step.
    pub(crate) fn found(&self) -> &[Impact<T, N>] {
        &self.found
    }

    /// Returns `true` if at least one limit is not open, or if there are frictions.
    pub(crate) fn is_close(&self) -> bool {
        self.standing.iter().any(|standing| *standing != Clear)
            || self.frictions.now.grips[0] != Grip::Absent
    }

    /// Begins a step.
    pub(crate) fn begin(&mut self) {
        self.before = self.standing;
        self.frictions.before = self.frictions.now;
        self.found.clear();
    }

    /// Restores the states at the start of the step.
    pub(crate) fn undo(&mut self) {
        self.standing = self.before;
        self.frictions.now = self.frictions.before;
        self.found.clear();
    }

    /// Resets all states, after the state of the system has been set.
    pub(crate) fn forget(&mut self) {
        (self.standing, self.step) = ([Clear; L], 0.0);
        self.fastest = [T::from_f64(0.0); L];
        self.frictions.forget();
    }

    /// Visits the data that one step passes to the next.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        const ALL: [Standing; 3] = [Clear, Rising, Contact];
        for standing in &mut self.standing {
            let mut index = ALL.iter().position(|other| other == standing).unwrap_or(0);
            memory.count(&mut index, ALL.len() - 1);
            *standing = ALL[index];
        }
        memory.scalars(&mut self.fastest);
        self.frictions.remember(memory);
        if memory.reads() {
            self.before = self.standing;
            self.found.clear();
        }
    }

    /// Returns the changes of the rate of each gap that the tolerances allow.
    fn slow<D: Dynamics<N, Scalar = T>>(&self, phase: &Phase<'_, D, N>) -> [T; L] {
        let [_, least] = phase.rounding();
        let least = least.map(|least| T::from_f64(16.0) * least);
        let Some(accuracy) = self.accuracy else { return least };
        let normals = phase.normals();
        core::array::from_fn(|i| {
            let sum = (0..N).fold(0.0, |sum, j| {
                sum + normals[(i, j)].to_f64().abs() * accuracy.allows(j, phase.v[j].to_f64())
            });
            // A velocity of zero has no rounding error, and the tolerances may allow none.
            let least = least[i] + T::from_f64(16.0) * T::EPSILON * self.fastest[i];
            let sum = T::from_f64(sum);
            if sum < least { least } else { sum }
        })
    }

    /// Returns the first meeting with a limit within the step of `interpolant`, if any.
    pub(crate) fn watch<D: Dynamics<N, Scalar = T>>(
        &mut self,
        dynamics: &D,
        interpolant: &Interpolant<T, N>,
        end: &Endpoint<T, N>,
        side: Side,
        mut free: impl FnMut(Time, &[T; N], &[T; N]) -> [T; N],
    ) -> Option<Meeting> {
        let zero = T::from_f64(0.0);
        let interval = &interpolant.interval;
        let place = |theta: f64| place(interpolant, end, theta);
        let at = |theta: f64| {
            let (t, q, v) = place(theta);
            Phase { dynamics, t, side, q: &q, v: &v }.gaps()
        };
        let (t, q, v) = place(0.0);
        let flat = Phase { dynamics, t, side, q: &q, v: &v }.rounding()[0];
        let flat = flat.map(|rounding| T::from_f64(CLOSED) * rounding);
        let held = self.contacts();
        let mut push = |theta: f64, may_open: bool| {
            let (t, q, v) = place(theta);
            let free = free(t, &q, &v);
            Phase { dynamics, t, side, q: &q, v: &v }.push(&free, &held, may_open)
        };
        // How far the second rate of a gap is above its rounding errors, or below.
        let decided = T::from_f64(DECIDED);
        let opens = |push: &Push<T, N>, i: usize| push.gaps[i] - decided * push.noise[i];
        let closes = |push: &Push<T, N>, i: usize| push.gaps[i] + decided * push.noise[i];
        let mut standing = self.standing;
        let mut last = (0.0, at(0.0));
        let mut pushes = held.any().then(|| [(0.0, push(0.0, false)); 2]);
        let mut first: Option<Meeting> = None;
        for k in 1..=PARTS {
            let theta = k as f64 / PARTS as f64;
            let here = (theta, at(theta));
            let mut meet = |theta: f64, what: Met| {
                if first.is_none_or(|first| theta < first.theta) {
                    first = Some(Meeting { theta, what });
                }
            };
            let pushed = held.any().then(|| push(theta, false));
            // Without a force that pulls, no contact opens. Otherwise others may push instead.
            let pulls = pushed.is_some_and(|push| push.multipliers.iter().any(|own| *own < zero));
            let mut supported = pulls.then(|| ([last.0, theta], push(theta, true)));
            if let (Some([earlier, before]), Some(pushed)) = (&mut pushes, pushed) {
                let (places, edges) = ([*earlier, *before, (theta, pushed)], [k == 2, k == PARTS]);
                if !pulls && 1 < k {
                    // A force may pull between places only.
                    let pulled = (0..limits::<D, N>()).filter(|i| held.has(*i)).filter_map(|i| {
                        let of = |push: &Push<T, N>| push.multipliers[i];
                        let mut force = |theta: T| Ok::<_, Error>(of(&push(theta.to_f64(), false)));
                        let points = places.map(|(theta, push)| (T::from_f64(theta), of(&push)));
                        root::hidden_dip(&mut force, points, edges).ok().flatten()
                    });
                    let low = pulled.map(Float::to_f64).reduce(f64::min);
                    supported = low.map(|low| ([earlier.0, low], push(low, true)));
                }
                (*earlier, *before) = (*before, places[2]);
            }
            for i in 0..limits::<D, N>() {
                let gap = |theta: f64| at(theta)[0][i];
                let (before, after) = (last.1[0][i], here.1[0][i]);
                // A gap that closes and opens within the part counts where it is below zero.
                let (mut theta, mut after) = (theta, after);
                if matches!(standing[i], Clear | Rising) {
                    // A gap that rises is zero up to rounding at first.
                    let least = if standing[i] == Rising { -flat[i].to_f64() } else { 0.0 };
                    let place = |theta: f64, gaps: &[[T; L]; 3]| Place::of(theta, gaps, i, least);
                    let look = |theta: f64| place(theta, &at(theta));
                    let [from, to] = [&last, &here].map(|(theta, gaps)| place(*theta, gaps));
                    if let Some(low) = dip(&look, from, to, interval.h, FINEST) {
                        (theta, after) = (low, gap(low));
                    }
                }
                match standing[i] {
                    Contact => {
                        let Some(([from, to], supported)) = &supported else { continue };
                        if zero < opens(supported, i) {
                            let shut = |theta: f64| -opens(&push(theta, true), i);
                            meet(falling(shut, *from, *to, zero), Met::Opens(i));
                        }
                    }
                    Clear if after < zero => {
                        meet(falling(gap, last.0, theta, zero), Met::Closes(i));
                    }
                    Clear => {}
                    Rising if flat[i] < after => standing[i] = Clear,
                    Rising => {
                        let mut up = theta;
                        for _ in 0..HALVINGS {
                            up = last.0 + 0.5 * (up - last.0);
                            if flat[i] < gap(up) {
                                break;
                            }
                        }
                        if flat[i] < gap(up) {
                            standing[i] = Clear;
                            if after < zero {
                                meet(falling(gap, up, theta, zero), Met::Closes(i));
                            }
                        } else if after < -flat[i] {
                            // The flight was too short to be seen. If the gap is below rounding
                            // already, it is met where it is twice as deep, so that time goes on.
                            let deeper = before + before;
                            let least = if deeper < -flat[i] { deeper } else { -flat[i] };
                            if after < least {
                                meet(falling(gap, last.0, theta, least), Met::Closes(i));
                            }
                        } else if here.1[1][i] < zero && closes(&push(theta, true), i) < zero {
                            // The limit pushes before its gap has opened by more than rounding.
                            meet(theta, Met::Closes(i));
                        }
                    }
                }
            }
            if let Some(first) = first {
                return Some(first);
            }
            last = here;
        }
        self.standing = standing;
        None
    }

    /// Makes a state fulfil the limits. All closed limits with closing gaps have impacts, in the
    /// order of declaration and in rounds, until no gap closes. Limits that stay closed then become
    /// contacts.
    ///
    /// `met` is the meeting at the end of the step, if any; the step has `crossed` a kink or not.
    /// Returns `true` if the motion or the set of contacts changes.
    ///
    /// # Errors
    /// Returns [`Error::Restitution`] for a restitution outside 0 … 1, and [`Error::NoRoom`] if
    /// limits approach each other and leave no room.
    pub(crate) fn resolve<D: Dynamics<N, Scalar = T>>(
        &mut self,
        dynamics: &D,
        endpoint: &mut Endpoint<T, N>,
        side: Side,
        (met, crossed): (Option<Meeting>, bool),
        free: impl Fn(&Endpoint<T, N>) -> [T; N],
    ) -> Result<bool, Error> {
        let zero = T::from_f64(0.0);
        let count = limits::<D, N>();
        let (contacts, before) = (self.contacts(), State::from(&*endpoint));
        let mut held = contacts;
        let phase = endpoint.phase(dynamics, side);
        let (slow, [gaps, ..], rounding) = (self.slow(&phase), phase.gaps(), phase.rounding());
        let what = met.map(|met| met.what);
        let met = |i: usize| [Met::Closes(i), Met::Opens(i)].map(Some).contains(&what);
        let released = |i: usize| what == Some(Met::Opens(i));
        let scale = phase.sizes()[1];
        let step = T::from_f64(self.step);
        let flat = rounding[0].map(|rounding| T::from_f64(CLOSED) * rounding);
        if crossed && held.any() {
            // What rests on a limit does not follow a jump that opens it.
            let [earlier, ..] = endpoint.phase(dynamics, side.opposite()).gaps();
            for i in 0..count {
                if held.has(i) && flat[i] < gaps[i] - earlier[i] {
                    held.set(i, false);
                    self.standing[i] = Clear;
                }
            }
        }
        let mut closed = held.open();
        for i in 0..count {
            closed.set(i, met(i) || held.has(i) || gaps[i] <= flat[i]);
        }
        if !closed.any() && !has_frictions::<D, N>() {
            if held != contacts {
                endpoint.a = None;
            }
            return Ok(held != contacts);
        }
        // Moves the state so that limits below zero, and limits that were met, have a gap of zero.
        // The others that are closed stay so: what lifts one limit would lower them.
        if (0..count).any(|i| met(i) && !held.has(i) || closed.has(i) && gaps[i] < zero) {
            project_onto_contacts(dynamics, endpoint, side, &closed, false);
            project(dynamics, endpoint, side);
            for i in (0..count).filter(|i| closed.has(*i) && gaps[*i] < -flat[*i]) {
                let fall = free(endpoint);
                give_back(dynamics, endpoint, side, &fall, i, -gaps[i]);
            }
        }
        let phase = endpoint.phase(dynamics, side);
        let restitutions = dynamics.system().restitutions(phase.at(&phase.momentum_inputs()));
        let mut struck = false;
        let noise = |i: usize| T::from_f64(8.0) * rounding[1][i];
        let mut quiet = false;
        for _ in 0..IMPACTS {
            quiet = true;
            for i in (0..count).filter(|i| closed.has(*i)) {
                let phase = endpoint.phase(dynamics, side);
                let rate = phase.gaps()[1][i];
                if -noise(i) <= rate || released(i) && -slow[i] <= rate {
                    continue;
                }
                let limit = facts::<D, N>(i);
                let value = restitutions[i].to_f64();
                if !(0.0..=1.0).contains(&value) {
                    let t = endpoint.t.to_f64();
                    return Err(Error::Restitution { t, limit: limit.name, value });
                }
                let one = T::from_f64(1.0);
                let e = restitutions[i];
                let earlier = State::from(&*endpoint);
                self.fastest[i] = self.fastest[i].max(-rate);
                let impulse = if const { has_frictions::<D, N>() } {
                    let t = endpoint.t.to_f64();
                    let refused = |k| Error::FrictionImpulse { t, friction: name::<D, N>(k) };
                    let (impulse, change) = phase.strike(i, rate, e).map_err(refused)?;
                    endpoint.v.add(one, &change);
                    impulse
                } else {
                    let normal = contacts::row(&phase.normals(), i);
                    let change = phase.response(&normal);
                    let impulse = -(one + e) * rate / product(&normal, &change);
                    endpoint.v.add(impulse, &change);
                    impulse
                };
                endpoint.a = None;
                (struck, quiet) = (true, false);
                let after = State::from(&*endpoint);
                let found = self.found.iter_mut().find(|found| found.limit == i);
                if let Some(found) = found {
                    found.impulse += impulse;
                    found.after = after;
                } else if !self.silent {
                    let (name, time, state) = (limit.name, endpoint.t, earlier);
                    self.found.push(Impact { limit: i, name, time, state, after, impulse });
                }
            }
            if quiet {
                break;
            }
        }
        if !quiet {
            let phase = endpoint.phase(dynamics, side);
            let ([_, rates, _], noise) = (phase.gaps(), core::array::from_fn(noise));
            let (change, impulses) = phase.stop(&closed, &rates, &noise);
            endpoint.v.add(T::from_f64(1.0), &change);
            let phase = endpoint.phase(dynamics, side);
            let [_, rates, _] = phase.gaps();
            let closes = |i: &usize| closed.has(*i) && rates[*i] < -(slow[*i] + noise[*i]);
            if let Some(limit) = (0..count).find(closes).filter(|_| may_move::<D, N>()) {
                return Err(no_room(&phase, limit, &closed));
            }
            let after = State::from(&*endpoint);
            for found in &mut self.found {
                found.impulse += impulses[found.limit];
                found.after = after;
            }
        }
        project(dynamics, endpoint, side);
        // Limits stay in contact if they open too slowly for a flight and if their force pushes.
        // The projection onto them slows down others, so that more may stay.
        let (mut slowest, mut staying) = (held.open(), held.open());
        let rubbing = <D::System as System<N>>::FACTS.frictions;
        let mut rest = self.frictions.rest(rubbing, what, struck || crossed);
        if const { has_frictions::<D, N>() } && !struck {
            for i in (0..count).filter(|i| held.has(*i) && !released(*i)) {
                staying.set(i, true);
            }
        }
        for _ in 0..=count + frictions::<D, N>() {
            if const { has_frictions::<D, N>() } {
                slowest.grips = rest.find(&endpoint.phase(dynamics, side), &scale);
                let resting = staying.with(slowest.grips);
                project_onto_contacts(dynamics, endpoint, side, &resting, true);
            }
            let free = free(endpoint);
            let phase = endpoint.phase(dynamics, side);
            let [_, rates, _] = phase.gaps();
            for i in (0..count).filter(|i| closed.has(*i) && rates[*i] <= slow[*i]) {
                slowest.set(i, true);
            }
            let push = loop {
                if const { has_frictions::<D, N>() } {
                    slowest.grips = rest.decide(&phase, &free, &slowest)?;
                }
                let push = phase.push(&free, &slowest, true);
                // Adds limits whose flight is too short for the precision of the coordinates, or of
                // what falls in a step: at rest in a corner at zero, coordinates have no rounding.
                let before = slowest;
                for i in (0..count).filter(|i| closed.has(*i)) {
                    let fall = -push.gaps[i];
                    let height = flat[i] + T::EPSILON * step * step * fall;
                    let most = T::from_f64(2.0) * height * fall;
                    if push.noise[i] < fall && rates[i] * rates[i] < most {
                        slowest.set(i, true);
                    }
                }
                if slowest == before {
                    break push;
                }
            };
            let before = staying;
            staying.grips = slowest.grips;
            for i in (0..count).filter(|i| slowest.has(*i)) {
                let touches = !released(i) && push.gaps[i] <= push.noise[i];
                staying.set(i, touches || zero < push.multipliers[i]);
            }
            if staying == before {
                break;
            }
            project_onto_contacts(dynamics, endpoint, side, &staying, true);
            project(dynamics, endpoint, side);
            let mut still = staying;
            for _ in 0..=count {
                project_onto_contacts(dynamics, endpoint, side, &still, true);
                // The end of a motion along some limits may close others.
                let [_, rates, _] = endpoint.phase(dynamics, side).gaps();
                let before = still;
                for i in (0..count).filter(|i| closed.has(*i) && !released(*i)) {
                    still.set(i, still.has(i) || rates[i] < -noise(i));
                }
                if still == before {
                    break;
                }
            }
        }
        for i in 0..count {
            self.standing[i] = match closed.has(i) {
                false => Clear,
                true if staying.has(i) => Contact,
                true => Rising,
            };
        }
        let [gaps, ..] = endpoint.phase(dynamics, side).gaps();
        let pressed = |i| i < count && (closed.has(i) || gaps[i] < zero);
        let pressed = Contacts::new(core::array::from_fn(pressed), held.grips);
        check_room(&endpoint.phase(dynamics, side), &pressed)?;
        self.frictions.set(&staying.grips, &rest);
        let after = State::from(&*endpoint);
        for found in &mut self.found {
            if staying.has(found.limit) {
                found.after = after;
            }
        }
        let changed = struck || staying != contacts || before.v != after.v || before.q != after.q;
        if changed {
            endpoint.a = None;
        }
        Ok(changed)
    }

    /// Checks that no gap is below zero at the start of an integration.
    ///
    /// # Errors
    /// Returns [`Error::Penetration`] for a gap below zero.
    pub(crate) fn check<D>(phase: &Phase<'_, D, N>) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
    {
        let [gaps, least] = depths(phase);
        let below = |i: &usize| gaps[*i] < -least[*i] || gaps[*i].to_f64().is_nan();
        let Some(i) = (0..limits::<D, N>()).find(below) else { return Ok(()) };
        let Limit { name, unit, .. } = facts::<D, N>(i);
        let (t, gap) = (phase.t.to_f64(), gaps[i].to_f64());
        Err(Error::Penetration { t, limit: name, gap, unit })
    }
}
