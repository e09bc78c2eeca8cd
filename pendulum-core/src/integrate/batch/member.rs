//! A motion in a lane.

use super::problem::{Batched, Posed, Problem};
use crate::integrate::events::Event;
use crate::integrate::events::detector::EventDetector;
use crate::integrate::output::{Output, Recorder};
use crate::integrate::stats::Stats;
use crate::integrate::times::{direction, precedes};
use crate::system::Dynamics;
use crate::time::Time;

/// The records to keep of each motion of a batch, in addition to its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recording<'a, T, const N: usize> {
    pub(crate) output: Output<'a>,
    pub(crate) dense: bool,
    /// Events with functions and without actions.
    pub(crate) events: &'a [Event<'a, T, N>],
}

impl<T, const N: usize> Recording<'_, T, N> {
    /// Returns `true` if there is anything to keep.
    pub(super) fn is_any(&self) -> bool {
        !matches!(self.output, Output::End) || self.dense || !self.events.is_empty()
    }
}

/// A motion in a lane.
pub(super) struct Member<'a, D: Batched<N>, const N: usize> {
    pub(super) index: usize,
    pub(super) problem: Posed<'a, D, N>,
    pub(super) recorder: Recorder<'a, 'a, D::Scalar, N>,
    pub(super) detector: EventDetector<'a, D::Scalar, N>,
    /// The accelerations at the start, if they have been computed.
    pub(super) a: Option<[D::Scalar; N]>,
    /// The counters, without the steps since `Run::begun`.
    pub(super) stats: Stats,
}

impl<D: Batched<N>, const N: usize> Member<'_, D, N> {
    /// Returns the first time after `t` at which the series cease to be valid: a break, or the end.
    ///
    /// Returns `t` itself if a motion returns a break or a kink that is not after `t`. No step is
    /// so short, and `Taylor` returns the error.
    pub(super) fn next_end(&self, t: Time) -> f64 {
        let Problem { system, time: (start, end), .. } = &*self.problem;
        let (interval, now) = ((*start, *end), t.to_f64());
        let found = if end < start { system.last_break(now) } else { system.next_break(now) };
        let next = found.filter(|time| !precedes(*end, *time, interval)).unwrap_or(*end);
        let ordered = |time: f64| precedes(now, time, interval);
        if ordered(next) && ordered(self.next_kink(t)) { next } else { now }
    }

    /// Returns the first kink after `t`, infinite if there is none.
    pub(super) fn next_kink(&self, t: Time) -> f64 {
        let Problem { system, time: (start, end), .. } = &*self.problem;
        let (t, onwards) = (t.to_f64(), direction(*start, *end));
        let kink = if onwards < 0.0 { system.last_kink(t) } else { Dynamics::next_kink(system, t) };
        kink.unwrap_or(onwards * f64::INFINITY)
    }
}
