//! The observation of each step, and the actions of the events found.

use super::accumulation::Next;
use super::{EventDetector, Place, side};
use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::events::{Condition, Event, Occurrence, Status};
use crate::integrate::field::first_in_state;
use crate::integrate::state::State;
use crate::scalar::Float;
use crate::time::Time;

/// The time over which rates are computed, as a fraction of the step.
const MOMENT: f64 = 1.0 / 4096.0;

/// The fraction of the rate before an act below which the rate after the act counts as zero.
const NONE: f64 = 1e-9;

impl<T: Float, const N: usize> EventDetector<'_, T, N> {
    /// Finds the events in the step that `integration` has just taken. If a terminal event or an
    /// event with an action has happened, moves the integration back to this event, performs the
    /// action, and returns the status if the integration ends there.
    ///
    /// If a function fails, the integration returns to the start of the step; if an action fails,
    /// to the event.
    #[inline]
    pub(crate) fn observe(
        &mut self,
        integration: &mut dyn Observed<T, N>,
    ) -> Result<Option<Status>, Error> {
        if self.is_idle() { Ok(None) } else { self.search_step(integration) }
    }

    /// Implements [`observe`](Self::observe) for at least one event.
    // As a part of `observe`, this code would prevent the inlining of `observe` into the loop over
    // steps.
    #[inline(never)]
    fn search_step(
        &mut self,
        integration: &mut dyn Observed<T, N>,
    ) -> Result<Option<Status>, Error> {
        self.backwards = integration.goes_back();
        let rooted = self.events.iter().any(|event| matches!(event.condition, Condition::Root(_)));
        let interpolant = if rooted {
            integration.interpolate();
            integration.interpolated()
        } else {
            None
        };
        let (end, beyond) = match integration.before_kink() {
            Some(before) => (*before, Some(*integration.end())),
            None => (*integration.end(), None),
        };
        if let Err(error) = self.step(interpolant, &end, beyond.as_ref()) {
            integration.retreat();
            let a = integration.accelerations();
            self.found.clear();
            // The functions have been evaluated at this state before.
            self.evaluate_start(integration.end(), &a).ok();
            return Err(error);
        }
        for occurrence in &mut self.found {
            if occurrence.time != end.t {
                integration.deliver(occurrence.time, &mut occurrence.state);
                occurrence.after = occurrence.state;
            }
        }
        let Some(stop) = self.count() else { return Ok(None) };
        let Occurrence { event, time, state, .. } = self.found[stop];
        let cut = time != end.t;
        if cut {
            // A jump needs a time that one word represents, for outputs, unless the scalar has two
            // words.
            let one_word =
                self.events[event].action.is_some() && f64::EPSILON <= T::EPSILON.to_f64();
            integration.cut(if one_word { Time::new(state.t) } else { time }, &state);
        }
        self.gather(integration, stop);
        self.happen(integration, stop, cut)
    }

    /// Counts the events found, up to the first event that stops the step; returns its index in the
    /// list of events found.
    fn count(&mut self) -> Option<usize> {
        for (index, occurrence) in self.found.iter().enumerate() {
            let track = &mut self.tracks[occurrence.event];
            track.count += 1;
            track.last = Some(occurrence.time);
            let event = &self.events[occurrence.event];
            let ends = event.terminal.is_some_and(|count| count <= track.count);
            if ends || event.action.is_some() {
                return Some(index);
            }
        }
        None
    }

    /// Removes the events found after the event that stops the step, except simultaneous ones. A
    /// function that is zero there up to rounding would not be found in the next step.
    fn gather(&mut self, integration: &mut dyn Observed<T, N>, stop: usize) {
        let Occurrence { time, state, .. } = self.found[stop];
        let mut kept = stop + 1;
        for index in stop + 1..self.found.len() {
            let found = self.found[index];
            let simultaneous = found.time == time || {
                let a = integration.accelerations();
                let place = Place::of(integration.end());
                self.value(found.event, &place)
                    .is_ok_and(|value| value.abs() <= self.rounding(found.event, &place, value, &a))
            };
            if simultaneous {
                let track = &mut self.tracks[found.event];
                track.count += 1;
                track.last = Some(time);
                self.found[kept] = Occurrence { time, state, after: state, ..found };
                kept += 1;
            }
        }
        self.found.truncate(kept);
        self.found[stop..].sort_unstable_by_key(|occurrence| occurrence.event);
    }

    /// Performs the actions of the events from `first` on, in order, and returns the status if one
    /// of them ends the integration; `cut` is `true` if the step was cut.
    fn happen(
        &mut self,
        integration: &mut dyn Observed<T, N>,
        first: usize,
        cut: bool,
    ) -> Result<Option<Status>, Error> {
        let (mut status, mut acted) = (None, false);
        for index in first..self.found.len() {
            let Occurrence { event, time, .. } = self.found[index];
            if let Some(action) = self.events[event].action.clone() {
                acted = true;
                let before = self.rate(integration, event);
                let mut state = State::from(integration.end());
                action(&mut state);
                state.t = integration.end().t.to_f64();
                if let Some(what) = first_in_state(integration.facts(), &state.q, &state.v) {
                    self.found.truncate(index);
                    return Err(Error::Action { t: time.to_f64(), event, what });
                }
                let same_place = state.q == integration.end().q.high;
                integration.jump(&state)?;
                self.found[index].after = state;
                let after = self.rate(integration, event);
                status =
                    status.or(self.acted(integration, event, time, same_place, before, after)?);
            }
            let Event { terminal, .. } = self.events[event];
            if terminal.is_some_and(|count| count <= self.tracks[event].count) {
                status = status.or(Some(Status::Event(event)));
            }
        }
        if cut || acted {
            let a = integration.accelerations();
            self.evaluate_start(integration.end(), &a)?;
            let place = Place::of(integration.end());
            for index in first..self.found.len() {
                let Occurrence { event, state, .. } = self.found[index];
                let there = Place { t: place.t, q: state.q, v: state.v };
                // An action may have moved the function away from zero.
                if !acted || self.value(event, &there).ok() == self.value(event, &place).ok() {
                    self.tracks[event].side = 0;
                }
            }
        }
        Ok(status)
    }

    /// Evaluates an act, with the rates of the function before and after it; returns the status if
    /// the event has come to rest.
    fn acted(
        &mut self,
        integration: &mut dyn Observed<T, N>,
        event: usize,
        time: Time,
        same_place: bool,
        before: Rate<T>,
        after: Rate<T>,
    ) -> Result<Option<Status>, Error> {
        let Condition::Root(_) = self.events[event].condition else { return Ok(None) };
        let t = time.to_f64();
        let slow = |speed: f64| before.value.abs().to_f64() < speed;
        if self.events[event].rest_below.is_some_and(slow) {
            return Ok(Some(Status::Rest(event)));
        }
        let number = T::from_f64;
        let through = side(before.value);
        let none = after.noise + before.noise + number(NONE) * before.value.abs();
        let changed = (after.value - before.value).abs();
        let stopped = after.value.abs() <= none && number(0.5) * before.value.abs() < changed;
        let next = self.tracks[event].acts.next(time);
        if same_place && through != 0 && stopped && self.shortly(integration, event) == through {
            // At the limit of the digits of the state, a series of bounces stops too.
            let limit = self.tracks[event].acts.limit(time);
            return match (self.events[event].rest_below, limit) {
                (Some(_), _) => Ok(Some(Status::Rest(event))),
                (None, Some(t)) => Err(Error::Accumulation { t, event }),
                (None, None) => Err(Error::EventStays { t, event }),
            };
        }
        let turned = same_place && side(after.value) == -through && after.noise < after.value.abs();
        let track = &mut self.tracks[event];
        track.expected = if turned { side(after.value) } else { 0 };
        match next {
            Next::Usual => Ok(None),
            Next::Still => Err(Error::EventStays { t, event }),
            Next::Accumulated(t) => Err(Error::Accumulation { t, event }),
        }
    }

    /// Returns the rate of the function of an event at the state of `integration`, in units per
    /// second.
    fn rate(&self, integration: &mut dyn Observed<T, N>, event: usize) -> Rate<T> {
        let zero = T::from_f64(0.0);
        let a = integration.accelerations();
        let moment = T::from_f64(MOMENT * integration.last_length().abs());
        let (Condition::Root(_), true) = (&self.events[event].condition, zero < moment) else {
            return Rate { value: zero, noise: zero };
        };
        let place = Place::of(integration.end());
        // A function may be undefined beyond its zero.
        let [before, here, after] =
            [-moment, zero, moment].map(|dt| self.value(event, &place.after(dt, &a)).ok());
        let (rise, length) = match (before, here, after) {
            (Some(before), _, Some(after)) => (after - before, moment + moment),
            (None, Some(here), Some(after)) => (after - here, moment),
            (Some(before), Some(here), None) => (here - before, moment),
            _ => (zero, moment),
        };
        let noise = here.map_or(zero, |here| self.rounding(event, &place, here, &a));
        Rate { value: rise / length, noise: noise / length }
    }

    /// Returns the side to which a function with a rate of zero moves after the state of
    /// `integration`.
    fn shortly(&self, integration: &mut dyn Observed<T, N>, event: usize) -> i8 {
        let a = integration.accelerations();
        let place = Place::of(integration.end());
        let dt = T::from_f64(0.125 * integration.last_length().abs());
        let rise = |place: &Place<T, N>| self.value(event, place).unwrap_or(T::from_f64(0.0));
        side(rise(&place.after(dt, &a)) - rise(&place))
    }
}

/// The rate of a function, and its rounding error.
#[derive(Clone, Copy)]
struct Rate<T> {
    value: T,
    noise: T,
}
