//! Observers: functions that `solve` calls during an integration.

use crate::integrate::events::Occurrence;
use crate::integrate::state::State;
use crate::integrate::stats::Stats;
use crate::scalar::Float;
use core::fmt;
use core::ops::ControlFlow;

/// A step that `solve` has just taken, passed to the function given to
/// [`on_step`](crate::integrate::Solve::on_step).
pub struct Step<'s, T, const N: usize> {
    /// The state at the start of the step.
    pub start: State<T, N>,
    /// The state at the end of the step, beyond a kink and after the actions of events.
    pub end: State<T, N>,
    /// The counters of the integration so far.
    pub stats: Stats,
    /// The events found in the step, in order.
    pub events: &'s [Occurrence<T, N>],
    /// The interval of the whole integration.
    pub interval: (f64, f64),
    pub(crate) within: &'s mut dyn FnMut(f64) -> Option<State<T, N>>,
}

impl<T: Float, const N: usize> Step<'_, T, N> {
    /// Returns the completed fraction of the interval, from 0 to 1.
    pub fn progress(&self) -> f64 {
        let (start, end) = self.interval;
        if start == end { 1.0 } else { (self.end.t - start) / (end - start) }
    }

    /// Returns the state at the time `t` in seconds within the step, or `None` outside the step.
    ///
    /// If the method needs further evaluations for the interpolant, the first call performs them.
    pub fn at(&mut self, t: f64) -> Option<State<T, N>> {
        (self.within)(t)
    }
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Step<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { start, end, stats, events, interval, .. } = self;
        let mut step = f.debug_struct("Step");
        step.field("start", start).field("end", end).field("stats", stats);
        step.field("events", events).field("interval", interval).finish_non_exhaustive()
    }
}

/// A function called with each step.
pub(crate) type OfSteps<'a, T, const N: usize> =
    dyn FnMut(&mut Step<'_, T, N>) -> ControlFlow<()> + 'a;

/// A function called with each state.
pub(crate) type OfStates<'a, T, const N: usize> = dyn FnMut(State<T, N>) -> ControlFlow<()> + 'a;

/// The observers, if any.
pub(crate) struct Observers<'a, T, const N: usize> {
    pub(crate) steps: Option<Box<OfSteps<'a, T, N>>>,
    pub(crate) states: Option<Box<OfStates<'a, T, N>>>,
}

impl<T, const N: usize> Observers<'_, T, N> {
    pub(crate) fn none() -> Self {
        Self { steps: None, states: None }
    }
}

impl<T, const N: usize> fmt::Debug for Observers<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut observers = f.debug_struct("Observers");
        observers.field("steps", &self.steps.is_some());
        observers.field("states", &self.states.is_some()).finish()
    }
}
