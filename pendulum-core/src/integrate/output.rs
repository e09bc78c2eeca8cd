//! The recording of the states that a solution stores.

use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::events::{Occurrence, Status};
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::first_in_state;
use crate::integrate::interpolant::dense::DenseOutput;
use crate::integrate::observe::OfStates;
use crate::integrate::solution::{Failure, RunNumber, Solution};
use crate::integrate::state::State;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::slip::Slip;
use crate::integrate::stats::Stats;
use crate::integrate::times::{direction, in_order, precedes};
use crate::scalar::Float;
use crate::system::label::Source;
use crate::system::{Facts, Friction};
use crate::time::Time;

/// The maximum number of states that an output interval may produce.
const MOST: f64 = 1e7;
/// The same limit for states that are streamed and not stored: a count that `f64` holds exactly.
const MOST_STREAMED: f64 = 1e15;

/// The states requested, besides the last one.
#[derive(Clone, Copy, Debug)]
pub enum Output<'a> {
    /// None.
    End,
    /// The states at these times.
    Times(&'a [f64]),
    /// The states at multiples of an interval.
    Every(f64),
    /// The states at both ends of each step.
    Steps,
}

impl Output<'_> {
    /// Checks the output times; `streamed` is `true` if the states are not stored.
    pub(crate) fn check(&self, start: f64, end: f64, streamed: bool) -> Result<(), Error> {
        match *self {
            Output::Times(times) => in_order("t_eval", times, start, end),
            Output::Every(interval) => {
                // More states than this are probably a mistake, and would fill the memory.
                let fine = 0.0 < interval
                    && interval < f64::INFINITY
                    && (end - start).abs() / interval
                        <= if streamed { MOST_STREAMED } else { MOST };
                let required = "positive, finite and give ten million states at most; lengthen it, or take them one by one with `on_output`";
                if fine {
                    Ok(())
                } else {
                    Err(Error::Setting { name: "every", value: interval, required })
                }
            }
            Output::End | Output::Steps => Ok(()),
        }
    }

    /// Returns the output time with this index.
    fn time(&self, index: usize, (start, end): (f64, f64)) -> Option<f64> {
        match *self {
            Output::Times(times) => times.get(index).copied(),
            Output::Every(_) if index == 0 => Some(start),
            Output::Every(interval) => {
                let t = start + direction(start, end) * (index as f64 * interval);
                // A multiple that misses the end by rounding means the end; the rounding errors are
                // larger for times far from zero.
                let rounding = 1e-9 * interval + 4.0 * f64::EPSILON * (start.abs() + end.abs());
                let rounding = if rounding < 0.5 * interval { rounding } else { 0.5 * interval };
                let close = (t - end).abs() < rounding;
                if close { Some(end) } else { Some(t).filter(|t| precedes(*t, end, (start, end))) }
            }
            Output::End | Output::Steps => None,
        }
    }
}

/// A recorder of the requested output of an integration.
pub(crate) struct Recorder<'a, 'f, T, const N: usize> {
    output: Output<'a>,
    interval: (f64, f64),
    /// The direction of time: 1 or −1.
    onwards: f64,
    /// The index of the next output time.
    index: usize,
    /// The next output time, infinite if there is none.
    next: f64,
    dense: Option<DenseOutput<T, N>>,
    t: Vec<f64>,
    q: Vec<[T; N]>,
    v: Vec<[T; N]>,
    /// The limits in contact at each of these states, one bit per limit, and the modes of the
    /// frictions; empty for systems without either.
    contacts: Vec<u64>,
    limited: bool,
    events: Vec<Occurrence<T, N>>,
    impacts: Vec<Impact<T, N>>,
    frictions: Vec<Slip>,
    labels: Source,
    /// The function that takes the states, if they are streamed.
    stream: Option<&'f mut OfStates<'a, T, N>>,
    /// `true` if the function has requested the end of the integration.
    pub(crate) cancelled: bool,
}

impl<'a, 'f, T: Float, const N: usize> Recorder<'a, 'f, T, N> {
    pub(crate) fn new(
        output: Output<'a>,
        interval: (f64, f64),
        facts: &'static Facts,
        stream: Option<&'f mut OfStates<'a, T, N>>,
    ) -> Self {
        let onwards = direction(interval.0, interval.1);
        Self {
            output,
            interval,
            onwards,
            index: 0,
            next: onwards * f64::INFINITY,
            dense: None,
            t: Vec::new(),
            q: Vec::new(),
            v: Vec::new(),
            contacts: Vec::new(),
            limited: !(facts.limits.is_empty() && facts.frictions.is_empty()),
            events: Vec::new(),
            impacts: Vec::new(),
            frictions: Vec::new(),
            labels: Source::Facts(facts),
            stream,
            cancelled: false,
        }
    }

    /// Returns the next output time, infinite if there is none.
    pub(crate) fn next_time(&self) -> f64 {
        self.next
    }

    /// Returns `true` if the states are streamed and not stored.
    pub(crate) fn streams(&self) -> bool {
        self.stream.is_some()
    }

    /// Begins with the state at the start.
    pub(crate) fn begin(&mut self, start: State<T, N>, contacts: u64, dense: bool) {
        self.dense = dense.then(|| DenseOutput::new(start, self.onwards));
        self.next = self.time(0);
        match self.output {
            Output::Steps => self.push(start, contacts),
            _ => self.push_while_next_is(start, contacts),
        }
    }

    /// Returns the output time with this index; infinite if there is none.
    fn time(&self, index: usize) -> f64 {
        self.output.time(index, self.interval).unwrap_or(self.onwards * f64::INFINITY)
    }

    /// Records the step that `integration` has just taken.
    #[inline]
    pub(crate) fn step(&mut self, integration: &mut impl Observed<T, N>) -> Result<(), Error> {
        if self.dense.is_some()
            || self.onwards * self.next <= self.onwards * integration.end().t.to_f64()
        {
            self.within(integration)?;
        }
        if let Output::Steps = self.output {
            let [during, after] = integration.contacts();
            if let Some(before) = integration.before_kink() {
                self.push(before.into(), during);
            }
            self.push((integration.end()).into(), after);
        }
        Ok(())
    }

    /// Records the events found in the step.
    pub(crate) fn events(&mut self, found: &[Occurrence<T, N>]) {
        self.events.extend_from_slice(found);
    }

    /// Records the impacts in the step.
    #[inline]
    pub(crate) fn impacts(&mut self, found: &[Impact<T, N>]) {
        self.impacts.extend_from_slice(found);
    }

    /// Records the modes of the frictions with these facts from `t` on.
    pub(crate) fn modes(&mut self, facts: &'static [Friction], t: f64, contacts: u64) {
        let contacts = Contacts::from_bits(contacts);
        for (friction, Friction { name, components, .. }) in facts.iter().enumerate() {
            let sign = |s: f64| if *components == 1 { s as i8 } else { 1 };
            let direction = contacts.grip(friction).direction().map_or(0, sign);
            let last = self.frictions.iter_mut().rev().find(|slip| slip.friction == friction);
            if let Some(last) = last {
                last.end = t;
                if last.direction == direction {
                    continue;
                }
            }
            self.frictions.push(Slip { friction, name, start: t, end: t, direction });
        }
    }

    /// Records the states within the step and at its end.
    ///
    /// A polynomial between two finite ends is not necessarily finite: over a long step, h²
    /// overflows before h does.
    fn within(&mut self, integration: &mut dyn Observed<T, N>) -> Result<(), Error> {
        let (end, state) = (integration.end().t, State::from(integration.end()));
        let [during, after] = integration.contacts();
        if self.dense.is_some() || 0.0 < self.onwards * end.since(self.next) {
            integration.interpolate();
            let Some(interpolant) = integration.interpolated() else { return Ok(()) };
            let facts = integration.facts();
            let not_finite = |t: f64, q: &[T; N], v: &[T; N]| {
                let what = first_in_state(facts, q, v);
                what.map_or(Ok(()), |what| Err(Error::NotFinite { t, what, suspects: Vec::new() }))
            };
            if self.dense.is_some() {
                let mut terms = interpolant.q[..interpolant.terms].iter().zip(&interpolant.v);
                terms.try_for_each(|(q, v)| not_finite(end.to_f64(), q, v))?;
            }
            while 0.0 < self.onwards * end.since(self.next) {
                let (q, v) = interpolant.at(interpolant.interval.fraction(self.next));
                not_finite(self.next, &q, &v)?;
                let mut state = State { t: self.next, q, v };
                integration.deliver(Time::new(self.next), &mut state);
                self.push(state, during);
                self.advance();
            }
            if let Some(dense) = &mut self.dense {
                dense.push(interpolant, state, self.limited.then_some(during));
            }
        }
        self.push_while_next_is(state, after);
        Ok(())
    }

    fn push_while_next_is(&mut self, state: State<T, N>, contacts: u64) {
        while self.next == state.t {
            self.push(state, contacts);
            self.advance();
        }
    }

    fn push(&mut self, state: State<T, N>, contacts: u64) {
        if let Some(stream) = &mut self.stream {
            self.cancelled = self.cancelled || stream(state).is_break();
            return;
        }
        self.keep(state, contacts);
    }

    fn keep(&mut self, State { t, q, v }: State<T, N>, contacts: u64) {
        if self.limited {
            self.contacts.push(contacts);
        }
        self.t.push(t);
        self.q.push(q);
        self.v.push(v);
    }

    fn advance(&mut self) {
        self.index += 1;
        self.next = self.time(self.index);
    }

    /// Creates the solution that ends with `end`.
    pub(crate) fn finish(
        mut self,
        end: State<T, N>,
        touching: u64,
        status: Status,
        stats: Stats,
    ) -> Solution<T, N> {
        if let Output::End = self.output {
            self.push(end, touching);
        }
        if self.stream.is_some() {
            self.keep(end, touching);
        }
        let Self { dense, t, q, v, contacts, events, impacts, frictions: all, labels, .. } = self;
        // Changes at one time leave intervals without length.
        let mut frictions: Vec<Slip> = Vec::new();
        // A force may come back below its bound at the time at which it was found above it.
        for slip in all.into_iter().filter(|slip| slip.start != slip.end) {
            match frictions.iter_mut().rev().find(|last| last.friction == slip.friction) {
                Some(last) if (last.direction, last.end) == (slip.direction, slip.start) => {
                    last.end = slip.end;
                }
                _ => frictions.push(slip),
            }
        }
        let run = RunNumber::default();
        Solution {
            t,
            q,
            v,
            end,
            status,
            events,
            impacts,
            frictions,
            stats,
            dense,
            contacts,
            labels,
            run,
        }
    }

    /// Creates the failure whose last state is `end`.
    pub(crate) fn fail(
        self,
        error: Error,
        end: State<T, N>,
        touching: u64,
        stats: Stats,
    ) -> Failure<T, N> {
        Failure { error, partial: Box::new(self.finish(end, touching, Status::Failed, stats)) }
    }
}
