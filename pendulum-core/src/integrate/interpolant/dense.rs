//! Dense output over a whole integration.

use crate::integrate::interpolant::{Basis, Interpolant, KNOWN};
use crate::integrate::state::State;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::{Float, Octet};

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
    /// For each step, the limits in contact and the modes of the frictions, if the system has any.
    #[cfg_attr(feature = "serde", serde(default))]
    contacts: Vec<u64>,
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
            contacts: Vec::new(),
        }
    }

    /// Adds the next step, with the limits in contact if the system has any, and the state after
    /// the step.
    pub(crate) fn push(
        &mut self,
        interpolant: &Interpolant<T, N>,
        end: State<T, N>,
        contacts: Option<u64>,
    ) {
        self.contacts.extend(contacts);
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
        let step = self.step(index);
        let (theta, one) = (step.interval.fraction(t), T::from_f64(1.0));
        let (q, v) = step.at(if theta < one { theta } else { one });
        Some(State { t, q, v })
    }

    /// Returns the state at the start.
    pub(crate) fn start(&self) -> &State<T, N> {
        &self.start
    }

    /// Returns the last state.
    pub(crate) fn end(&self) -> &State<T, N> {
        &self.end
    }

    /// Returns the steps in order.
    pub(crate) fn steps(&self) -> impl Iterator<Item = DenseStep<'_, T, N>> {
        (0..self.intervals.len()).map(|index| self.step(index))
    }

    fn step(&self, index: usize) -> DenseStep<'_, T, N> {
        let (end, basis) = self.ends[index];
        let begin = if index == 0 { 0 } else { self.ends[index - 1].0 };
        let (states, terms) = self.values[begin..end].split_at(2);
        let contacts = self.contacts.get(index).copied().unwrap_or_default();
        DenseStep { interval: &self.intervals[index], states, terms, basis, contacts }
    }
}

/// The motion within one step of a [`DenseOutput`].
pub(crate) struct DenseStep<'a, T, const N: usize> {
    pub(crate) interval: &'a StepInterval,
    /// The coordinates and the velocities at the start.
    states: &'a [[T; N]],
    /// The terms of the coordinates, then as many of the velocities.
    terms: &'a [[T; N]],
    basis: Basis,
    /// The limits in contact, one bit per limit, and the modes of the frictions.
    pub(crate) contacts: u64,
}

impl<T: Float, const N: usize> DenseStep<'_, T, N> {
    /// Returns the number of terms of each polynomial.
    pub(crate) fn terms(&self) -> usize {
        self.terms.len() / 2
    }

    /// Returns the coordinates and the velocities at the start.
    pub(crate) fn start(&self) -> (&[T; N], &[T; N]) {
        (&self.states[0], &self.states[1])
    }

    /// Returns the coordinates and the velocities when the part `theta` of the step has passed.
    pub(crate) fn at(&self, theta: T) -> ([T; N], [T; N]) {
        let (q, v) = self.terms.split_at(self.terms());
        (self.basis.at(&self.states[0], q, theta), self.basis.at(&self.states[1], v, theta))
    }

    /// Returns the same at eight θ, at which the functions of each [`Basis`] are known.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    pub(crate) fn at_known(&self, functions: &Functions<T>) -> [[Octet<T>; N]; 2]
    where
        T: Float,
    {
        let functions = &functions.0[self.basis as usize];
        let (q, v) = self.terms.split_at(self.terms());
        let mut sums = [[Octet::splat(T::from_f64(0.0)); N]; 2];
        // Closures would not be inlined into the code for wide vectors.
        for (sum, (start, terms)) in sums.iter_mut().zip(self.states.iter().zip([q, v])) {
            for (term, function) in terms.iter().zip(functions).rev() {
                for i in 0..N {
                    sum[i] += *function * Octet::splat(term[i]);
                }
            }
            for i in 0..N {
                sum[i] = Octet::splat(start[i]) + sum[i];
            }
        }
        sums
    }
}

/// The values of the functions of each [`Basis`] at eight θ, for the same θ in many steps.
#[derive(Clone, Copy)]
pub(crate) struct Functions<T>([[Octet<T>; KNOWN]; 3]);

impl<T: Float> Functions<T> {
    pub(crate) fn new(theta: &[T; 8]) -> Self {
        Self([Basis::Nested, Basis::Powers, Basis::Legendre].map(|basis| {
            let at = theta.map(|theta| basis.known(theta));
            core::array::from_fn(|k| Octet(at.map(|functions| functions[k])))
        }))
    }
}
