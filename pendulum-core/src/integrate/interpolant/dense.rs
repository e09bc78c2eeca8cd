//! Dense output over a whole integration.

use crate::integrate::interpolant::{Basis, Interpolant};
use crate::integrate::state::State;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::Float;

/// The polynomials of all steps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub(crate) struct DenseOutput<T, const N: usize> {
    start: State<T, N>,
    /// The direction of time: 1 or −1.
    onwards: f64,
    /// The intervals of the steps in order; a step from a kink starts with the state after the
    /// kink.
    intervals: Vec<StepInterval>,
    /// For each step, the index after its last value, and the basis of its terms.
    ends: Vec<(usize, Basis)>,
    /// For each step, the state at its start and the terms of both polynomials.
    #[cfg_attr(feature = "serde", serde(with = "crate::integrate::state::arrays::rows"))]
    values: Vec<[T; N]>,
    /// The last state.
    end: State<T, N>,
}

#[cfg(feature = "serde")]
impl<T, const N: usize> DenseOutput<T, N> {
    /// Returns `true` if each step has its states and terms, and `false` for damaged data.
    pub(crate) fn is_sound(&self) -> bool {
        let mut begin = 0;
        let whole = self.ends.iter().all(|&(end, _)| {
            let sound = end.checked_sub(begin).is_some_and(|count| 2 <= count && count % 2 == 0);
            begin = end;
            sound
        });
        whole && self.intervals.len() == self.ends.len() && begin == self.values.len()
    }
}

impl<T: Float, const N: usize> DenseOutput<T, N> {
    pub(crate) fn new(start: State<T, N>, onwards: f64) -> Self {
        Self {
            start,
            onwards,
            intervals: Vec::new(),
            ends: Vec::new(),
            values: Vec::new(),
            end: start,
        }
    }

    /// Adds the next step and the state after the step.
    pub(crate) fn push(&mut self, interpolant: &Interpolant<T, N>, end: State<T, N>) {
        self.intervals.push(interpolant.interval);
        self.values.extend([interpolant.q0, interpolant.v0]);
        self.values.extend_from_slice(&interpolant.q[..interpolant.terms]);
        self.values.extend_from_slice(&interpolant.v[..interpolant.terms]);
        self.ends.push((self.values.len(), interpolant.basis));
        self.end = end;
    }

    /// Returns the times of the first and the last state.
    pub(crate) fn interval(&self) -> (f64, f64) {
        (self.start.t, self.end.t)
    }

    /// Returns the state at `t`, or `None` outside the interval.
    pub(crate) fn at(&self, t: f64, side: Side) -> Option<State<T, N>> {
        let onwards = self.onwards;
        if !(onwards * self.start.t <= onwards * t && onwards * t <= onwards * self.end.t) {
            return None;
        }
        let side = if onwards < 0.0 { side.opposite() } else { side };
        if side == Side::After && t == self.end.t {
            return Some(self.end);
        }
        // The number of steps that start before `t`. A step that starts at `t` counts if `side`
        // selects the state beyond a kink.
        let started = self.intervals.partition_point(|interval| match side {
            Side::Before => 0.0 < -onwards * interval.start.since(t),
            Side::After => 0.0 <= -onwards * interval.start.since(t),
        });
        let Some(index) = started.checked_sub(1) else { return Some(self.start) };
        let interval = &self.intervals[index];
        let (theta, one) = (interval.fraction(t), T::from_f64(1.0));
        let theta = if theta < one { theta } else { one };
        let (end, basis) = self.ends[index];
        let begin = if index == 0 { 0 } else { self.ends[index - 1].0 };
        let (states, terms) = self.values[begin..end].split_at(2);
        let (q, v) = terms.split_at(terms.len() / 2);
        Some(State { t, q: basis.at(&states[0], q, theta), v: basis.at(&states[1], v, theta) })
    }
}
