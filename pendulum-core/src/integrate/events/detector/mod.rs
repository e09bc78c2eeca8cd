//! The search for events within each step.

mod accumulation;
mod acts;
pub(crate) mod quiet;
mod search;

use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::events::{Condition, Direction, Event, Occurrence};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::state::saved::Memory;
use crate::integrate::times::in_order;
use crate::scalar::Float;
use crate::system::scalar_time;
use crate::time::Time;
use accumulation::Acts;
use search::Search;

/// The events of an integration, with their histories.
#[derive(Clone, Debug)]
pub(crate) struct EventDetector<'a, T, const N: usize> {
    events: Vec<Event<'a, T, N>>,
    tracks: Vec<Track<T>>,
    /// The relative tolerance of the steps, and the absolute tolerances of coordinates and of
    /// velocities; `None` for steps without tolerances.
    pub(crate) accuracy: Option<(f64, [[f64; N]; 2])>,
    /// `true` if the last step went back in time.
    backwards: bool,
    /// `true` if the next step is the first of a smooth stretch, without usable values before its
    /// start.
    fresh: bool,
    /// The events of the last step, in order.
    found: Vec<Occurrence<T, N>>,
}

/// The history of an event up to the state reached.
#[derive(Clone, Copy, Debug)]
struct Track<T> {
    /// The value of the function.
    value: T,
    /// The side of zero on which the value lies: its sign, or 0 just after a root.
    side: i8,
    /// The number of occurrences of the event.
    count: u64,
    /// The time of the last occurrence.
    last: Option<Time>,
    /// The index of the next known time.
    next: usize,
    /// The side expected after an act that has reversed the function; 0 if it is unknown.
    expected: i8,
    acts: Acts,
}

/// The distance from the ends of a step, as a fraction of the step, of the points that show if the
/// function falls or rises at the ends.
const NEAR: f64 = 1e-4;
/// The typical ratio of the error of a solution to the tolerances of its steps, at most.
const GROWTH: f64 = 100.0;
/// The points at which functions are evaluated, as fractions of the step.
pub(crate) const POINTS: [f64; 11] =
    [-NEAR, 0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0 - NEAR, 1.0];

impl<'a, T: Float, const N: usize> EventDetector<'a, T, N> {
    pub(crate) fn new(events: &[Event<'a, T, N>]) -> Self {
        let track = Track {
            value: T::from_f64(0.0),
            side: 0,
            count: 0,
            last: None,
            next: 0,
            expected: 0,
            acts: Acts::default(),
        };
        Self {
            events: events.to_vec(),
            tracks: vec![track; events.len()],
            accuracy: None,
            backwards: false,
            fresh: true,
            found: Vec::with_capacity(events.len()),
        }
    }

    /// Returns `true` if there are no events.
    #[inline]
    pub(crate) fn is_idle(&self) -> bool {
        self.events.is_empty()
    }

    /// Returns the index of the first event with an action.
    pub(crate) fn acting(&self) -> Option<usize> {
        self.events.iter().position(|event| event.action.is_some())
    }

    /// Returns the events found in the last step, in order.
    pub(crate) fn found(&self) -> &[Occurrence<T, N>] {
        &self.found
    }

    /// Begins the search at the state of `integration`.
    pub(crate) fn begin(&mut self, integration: &mut dyn Observed<T, N>) -> Result<(), Error> {
        if self.is_idle() {
            return Ok(());
        }
        let a = integration.accelerations();
        self.found.clear();
        for track in &mut self.tracks {
            (track.expected, track.acts) = (0, Acts::default());
        }
        self.evaluate_start(integration.end(), &a)
    }

    /// Visits the history of each event.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        // For a list of another length, words are missing or left over.
        memory.flag(&mut self.fresh);
        if memory.reads() {
            self.found.clear();
        }
        for (track, event) in self.tracks.iter_mut().zip(&self.events) {
            let times = match &event.condition {
                Condition::Times(times) => times.len(),
                Condition::Root(_) => 0,
            };
            let Track { value, side, count, last, next, expected, acts } = track;
            memory.scalar(value);
            for side in [side, expected] {
                let mut index = (*side + 1) as usize;
                memory.count(&mut index, 2);
                *side = index as i8 - 1;
            }
            memory.word(count);
            memory.maybe(last, || Time::new(0.0), Memory::time);
            memory.count(next, times);
            acts.remember(memory);
        }
    }

    /// Evaluates the functions at the start of the next step; `a` are the accelerations there.
    fn evaluate_start(&mut self, endpoint: &Endpoint<T, N>, a: &[T; N]) -> Result<(), Error> {
        self.fresh = true;
        for index in 0..self.events.len() {
            match &self.events[index].condition {
                Condition::Times(times) => {
                    in_order("events", times, f64::NEG_INFINITY, f64::INFINITY)?;
                    self.tracks[index].next =
                        times.partition_point(|time| *time <= endpoint.t.to_f64());
                }
                Condition::Root(_) => {
                    let place = Place::of(endpoint);
                    let value = self.value(index, &place)?;
                    let track = &mut self.tracks[index];
                    (track.value, track.side) = (value, side(value));
                    if value.abs() <= self.rounding(index, &place, value, a) {
                        self.tracks[index].side = 0;
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the first known time between the time `t` and `target`, or `target`.
    pub(crate) fn next_time(&self, t: f64, target: f64) -> f64 {
        if target < t {
            let times = self.events.iter().filter_map(|event| match &event.condition {
                Condition::Times(times) => {
                    times[..times.partition_point(|time| *time < t)].last().copied()
                }
                Condition::Root(_) => None,
            });
            return times.fold(target, |first, time| if first < time { time } else { first });
        }
        let times = self.events.iter().zip(&self.tracks).filter_map(|(event, track)| match &event
            .condition
        {
            Condition::Times(times) => times.get(track.next).copied(),
            Condition::Root(_) => None,
        });
        times.fold(target, |first, time| if time < first { time } else { first })
    }

    /// Finds the events in the step of `interpolant`, which ended in `end` and, after a kink, in
    /// `beyond`.
    fn step(
        &mut self,
        interpolant: Option<&Interpolant<T, N>>,
        end: &Endpoint<T, N>,
        beyond: Option<&Endpoint<T, N>>,
    ) -> Result<(), Error> {
        self.found.clear();
        for index in 0..self.events.len() {
            match &self.events[index].condition {
                Condition::Times(times) if self.backwards => {
                    let at = end.t.to_f64();
                    // The times ahead if the integration turns forwards again.
                    self.tracks[index].next = times.partition_point(|time| *time <= at);
                    if times.binary_search_by(|time| time.total_cmp(&at)).is_ok() {
                        self.found.push(occurrence(index, end));
                    }
                }
                Condition::Times(times) => {
                    while times
                        .get(self.tracks[index].next)
                        .is_some_and(|time| *time <= end.t.to_f64())
                    {
                        self.tracks[index].next += 1;
                        self.found.push(occurrence(index, end));
                    }
                }
                Condition::Root(_) => {
                    if let Some(interpolant) = interpolant {
                        Search { detector: self, index, interpolant, end }.run()?;
                    }
                    if let Some(beyond) = beyond {
                        self.jump(index, beyond)?;
                    }
                }
            }
        }
        self.fresh = beyond.is_some();
        if let Some(beyond) = beyond {
            for occurrence in self.found.iter_mut().filter(|occurrence| occurrence.time == beyond.t)
            {
                (occurrence.state, occurrence.after) = (beyond.into(), beyond.into());
            }
        }
        let (start, onwards) = (end.t.to_f64(), if self.backwards { -1.0 } else { 1.0 });
        let before = |a: &Occurrence<T, N>| (onwards * a.time.since(start), a.event);
        self.found.sort_unstable_by(|a, b| {
            before(a).partial_cmp(&before(b)).unwrap_or(core::cmp::Ordering::Equal)
        });
        Ok(())
    }

    /// Checks for a jump of a function over zero at a kink.
    fn jump(&mut self, index: usize, beyond: &Endpoint<T, N>) -> Result<(), Error> {
        let value = self.value(index, &Place::of(beyond))?;
        let (before, here) = (self.tracks[index].side, side(value));
        if before != 0 && here == -before && self.counts(index, here) {
            self.found.push(occurrence(index, beyond));
        }
        (self.tracks[index].value, self.tracks[index].side) = (value, here);
        Ok(())
    }

    /// Returns `true` if the event has happened so shortly before the step that a dip around the
    /// start of the step belongs to the same occurrence.
    fn recent(&self, index: usize, interval: &StepInterval) -> bool {
        let start = interval.start;
        let since = |last: Time| (last.since(start.to_f64()) - start.low()).abs();
        self.tracks[index].last.is_some_and(|last| since(last) <= 4.0 * NEAR * interval.h.abs())
    }

    /// Returns the distance from zero within which an extremum around `place` counts as a root.
    fn tolerance(&self, index: usize, place: &Place<T, N>) -> Result<T, Error> {
        match self.events[index] {
            Event { direction: Direction::Rising | Direction::Falling, .. } => Ok(T::from_f64(0.0)),
            Event { tolerance: Some(tolerance), .. } => Ok(T::from_f64(tolerance)),
            _ => {
                let usual = self.allowance(index, place)?;
                let Some((rtol, atol)) = self.accuracy else { return Ok(usual) };
                // Strict tolerances give better solutions, in which a shallow dip through zero is
                // known to be two roots. No tolerance gives more digits than the scalar has.
                let least = 10.0 * T::EPSILON.to_f64();
                let error = |i: usize, y: T| {
                    let own = atol[i / N][i % N].max(least);
                    T::from_f64(GROWTH)
                        * (T::from_f64(rtol.max(least)) * y.abs() + T::from_f64(own))
                };
                let own = self.changes(index, place, self.value(index, place)?, error);
                Ok(if own < usual { own } else { usual })
            }
        }
    }

    fn counts(&self, index: usize, here: i8) -> bool {
        // Directions refer to increasing time.
        let here = if self.backwards { -here } else { here };
        match self.events[index].direction {
            Direction::Both => true,
            Direction::Rising => here == 1,
            Direction::Falling => here == -1,
        }
    }

    /// Returns the value of the function at a state.
    fn value(&self, index: usize, place: &Place<T, N>) -> Result<T, Error> {
        let Condition::Root(function) = &self.events[index].condition else {
            return Ok(T::from_f64(0.0));
        };
        let value = function(place.t, &place.q, &place.v);
        if value.to_f64().is_nan() {
            Err(Error::Event { t: place.t.to_f64(), event: index })
        } else {
            Ok(value)
        }
    }

    /// Returns the change of the function if the state and the time change by a few rounding
    /// errors.
    fn rounding(&self, index: usize, place: &Place<T, N>, value: T, a: &[T; N]) -> T {
        let unit = T::from_f64(4.0) * T::EPSILON;
        let dt = unit * place.t.abs();
        let later = Place {
            t: place.t + dt,
            q: core::array::from_fn(|i| place.q[i] + dt * place.v[i]),
            v: core::array::from_fn(|i| place.v[i] + dt * a[i]),
        };
        // The step reports accelerations that are not finite, and a function may be undefined
        // beyond this point.
        let zero = T::from_f64(0.0);
        let later =
            if a.iter().all(|a| a.is_finite()) { self.value(index, &later) } else { Ok(value) };
        let drift = later.map_or(zero, |later| (later - value).abs());
        drift + self.changes(index, place, value, |_, y| unit * y.abs())
    }

    /// Returns the change of the function by the typical errors of a solution.
    fn allowance(&self, index: usize, place: &Place<T, N>) -> Result<T, Error> {
        let unit = T::EPSILON.sqrt() / T::from_f64(16.0);
        let value = self.value(index, place)?;
        Ok(self.changes(index, place, value, |_, y| unit * (T::from_f64(1.0) + y.abs())))
    }

    /// Returns Σ |change of the function| over changes of each component of the state, of which the
    /// velocities follow the coordinates.
    fn changes(
        &self,
        index: usize,
        place: &Place<T, N>,
        value: T,
        change: impl Fn(usize, T) -> T,
    ) -> T {
        let mut sum = T::from_f64(0.0);
        for i in 0..2 * N {
            let mut other = *place;
            let y = if i < N { &mut other.q[i] } else { &mut other.v[i - N] };
            *y += change(i, *y);
            sum += self
                .value(index, &other)
                .map_or(T::from_f64(0.0), |changed| (changed - value).abs());
        }
        sum
    }
}

/// Creates an occurrence at an endpoint, before the action.
fn occurrence<T: Float, const N: usize>(event: usize, end: &Endpoint<T, N>) -> Occurrence<T, N> {
    Occurrence { event, time: end.t, state: end.into(), after: end.into() }
}

/// A time and the state at that time.
#[derive(Clone, Copy)]
pub(crate) struct Place<T, const N: usize> {
    pub(crate) t: T,
    pub(crate) q: [T; N],
    pub(crate) v: [T; N],
}

impl<T: Float, const N: usize> Place<T, N> {
    /// Returns the place at an endpoint.
    pub(crate) fn of(end: &Endpoint<T, N>) -> Self {
        Self { t: scalar_time(end.t), q: end.q.high, v: end.v.high }
    }

    /// Returns the place a short time later, with constant accelerations.
    fn after(&self, dt: T, a: &[T; N]) -> Self {
        let half = T::from_f64(0.5) * dt;
        Self {
            t: self.t + dt,
            q: core::array::from_fn(|i| self.q[i] + dt * (self.v[i] + half * a[i])),
            v: core::array::from_fn(|i| self.v[i] + dt * a[i]),
        }
    }

    /// Returns the place at `theta` on the dense output.
    fn on(interpolant: &Interpolant<T, N>, theta: T) -> Self {
        let (q, v) = interpolant.at(theta);
        Self {
            t: scalar_time::<T>(interpolant.interval.start) + theta * interpolant.interval.length(),
            q,
            v,
        }
    }
}

/// Returns the sign of a value: −1, 0 or 1.
fn side<T: Float>(value: T) -> i8 {
    let zero = T::from_f64(0.0);
    i8::from(zero < value) - i8::from(value < zero)
}
