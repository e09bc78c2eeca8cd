//! What an integration gives back.

use crate::error::Error;
use crate::integrate::events::{Occurrence, Status};
use crate::integrate::interpolant::dense::DenseOutput;
use crate::integrate::state::State;
use crate::motion::Side;
use crate::scalar::Float;
use core::fmt;

/// The motion over an interval, at the times asked for.
///
/// At a kink the velocities have two values; where one is given, it is the one after the kink.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Solution<T, const N: usize> {
    /// The output times; only the last time reached if none were asked for.
    pub t: Vec<f64>,
    /// The coordinates at each of them.
    pub q: Vec<[T; N]>,
    /// The velocities at each of them.
    pub v: Vec<[T; N]>,
    /// The last state reached: where the interval ends, at a terminal event, or before the step
    /// that failed.
    pub end: State<T, N>,
    /// Why it ended there.
    pub status: Status,
    /// The events that have happened, in order.
    pub events: Vec<Occurrence<T, N>>,
    /// What it took.
    pub stats: Stats,
    pub(crate) dense: Option<DenseOutput<T, N>>,
}

impl<T: Float, const N: usize> Solution<T, N> {
    /// The state at any time between start and end, from the dense output; at a kink the state
    /// after it.
    ///
    /// `None` outside the interval and if `dense` was not asked for.
    pub fn at(&self, t: f64) -> Option<State<T, N>> {
        self.at_side(t, Side::After)
    }

    /// The same, at a kink from the given side.
    pub fn at_side(&self, t: f64, side: Side) -> Option<State<T, N>> {
        self.dense.as_ref()?.at(t, side)
    }
}

/// What an integration took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Stats {
    /// The name of the method.
    pub method: &'static str,
    /// Evaluations of the accelerations, those for dense output included. [`Taylor`](crate::integrate::Taylor)
    /// counts an order of its series as one; the one at the end of each step, by which it checks
    /// them, is not counted.
    pub evaluations: u64,
    /// Steps taken.
    pub accepted: u64,
    /// Steps tried and rejected by step control.
    pub rejected: u64,
    /// Kinks crossed.
    pub kinks: u64,
}

impl Stats {
    pub(crate) const fn new(method: &'static str) -> Self {
        Self { method, evaluations: 0, accepted: 0, rejected: 0, kinks: 0 }
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, evaluations, accepted, rejected, kinks } = self;
        write!(
            f,
            "{method}: {accepted} steps, {rejected} rejected, {kinks} kinks, {evaluations} evaluations"
        )
    }
}

/// An integration that stopped before its end, with all that was reached until then.
///
/// Both ways of printing it say what went wrong; `{:?}` adds the last state and the counters.
#[derive(Clone)]
pub struct Failure<T, const N: usize> {
    /// Why.
    pub error: Error,
    /// The solution until then; its `end` is the last good state.
    pub partial: Box<Solution<T, N>>,
}

impl<T, const N: usize> fmt::Display for Failure<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Failure<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Solution { end: State { t, q, v }, stats, .. } = &*self.partial;
        write!(f, "{}\n  reached: t = {t:?}, q = {q:?}, v = {v:?}\n  {stats}", self.error)
    }
}

impl<T: fmt::Debug, const N: usize> std::error::Error for Failure<T, N> {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}
