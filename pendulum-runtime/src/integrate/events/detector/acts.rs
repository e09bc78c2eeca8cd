//! Observes each step, and lets the events found in it act on the state.

use super::accumulation::Next;
use super::{EventDetector, Place, side};
use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::events::{Condition, Event, Occurrence, Status};
use crate::integrate::field::first_in_state;
use crate::integrate::state::State;
use crate::scalar::Float;
use crate::time::Time;

/// The time over which rates are taken, in parts of a step.
const MOMENT: f64 = 1.0 / 4096.0;

/// The part of a rate below which what an act leaves of it counts as none.
const NONE: f64 = 1e-9;

impl<T: Float, const N: usize> EventDetector<'_, T, N> {
    /// Finds what happened in the step that `integration` has just taken. If an event did that acts
    /// or is terminal, puts it back there, lets it act, and gives the status if the integration
    /// ends with it.
    ///
    /// If a function fails, it is put back to the start of the step; if an action does, to the
    /// event.
    #[inline]
    pub(crate) fn observe(
        &mut self,
        integration: &mut dyn Observed<T, N>,
    ) -> Result<Option<Status>, Error> {
        if self.is_idle() { Ok(None) } else { self.search_step(integration) }
    }

    /// [`observe`](Self::observe) for at least one event.
    // Inside, it would keep `observe` from being inlined into the loop over steps.
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
            // It has looked there before.
            self.look(integration.end(), &a).ok();
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
            // A jump has to have a time that outputs can name, unless the scalar sees the rest.
            let one_word =
                self.events[event].action.is_some() && f64::EPSILON <= T::EPSILON.to_f64();
            integration.cut(if one_word { Time::new(state.t) } else { time }, &state);
        }
        self.gather(integration, stop);
        self.happen(integration, stop, cut)
    }

    /// Counts what was found, up to the first event that stops the step; gives its index in the
    /// list of what was found.
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

    /// Drops what was found after the event that stops the step, except what happens at the same
    /// time: a function that is zero there to rounding would not be found on the way from there.
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

    /// Lets the events from `first` on act, one after the other, and gives the status if the
    /// integration ends with one of them; `cut` if the step was put back.
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
            self.look(integration.end(), &a)?;
            let place = Place::of(integration.end());
            for index in first..self.found.len() {
                let Occurrence { event, state, .. } = self.found[index];
                let there = Place { t: place.t, q: state.q, v: state.v };
                // An action may have taken the function away from zero.
                if !acted || self.value(event, &there).ok() == self.value(event, &place).ok() {
                    self.tracks[event].side = 0;
                }
            }
        }
        Ok(status)
    }

    /// Takes note of an act, with the rates of the function before and after it; gives the status
    /// if the event has come to rest.
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
            // Where the digits of the state end, a series of bounces stops too.
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

    /// The rate of the function of an event at the state of `integration`, in units a second.
    fn rate(&self, integration: &mut dyn Observed<T, N>, event: usize) -> Rate<T> {
        let zero = T::from_f64(0.0);
        let a = integration.accelerations();
        let moment = T::from_f64(MOMENT * integration.last_length().abs());
        let (Condition::Root(_), true) = (&self.events[event].condition, zero < moment) else {
            return Rate { value: zero, noise: zero };
        };
        let place = Place::of(integration.end());
        // A function may end where it is zero.
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

    /// The side to which the function goes from the state of `integration`, without a rate.
    fn shortly(&self, integration: &mut dyn Observed<T, N>, event: usize) -> i8 {
        let a = integration.accelerations();
        let place = Place::of(integration.end());
        let dt = T::from_f64(0.125 * integration.last_length().abs());
        let rise = |place: &Place<T, N>| self.value(event, place).unwrap_or(T::from_f64(0.0));
        side(rise(&place.after(dt, &a)) - rise(&place))
    }
}

/// The rate of a function, and what rounding may add to it.
#[derive(Clone, Copy)]
struct Rate<T> {
    value: T,
    noise: T,
}
