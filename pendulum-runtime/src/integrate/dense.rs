//! Dense output over a whole integration.

use super::piece::{Basis, Piece};
use super::solution::State;
use super::span::Span;
use crate::motion::Side;
use crate::real::Float;

/// The pieces of all steps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DenseOutput<T, const N: usize> {
    start: State<T, N>,
    /// The direction of time: 1 or −1.
    onwards: f64,
    /// The steps in order; those from a kink start with the state after it.
    spans: Vec<Span>,
    /// For each step the state at its start and the terms of both polynomials.
    values: Vec<[T; N]>,
    /// The number of terms, the same in all steps.
    terms: usize,
    basis: Basis,
    /// The last state.
    end: State<T, N>,
}

impl<T: Float, const N: usize> DenseOutput<T, N> {
    pub(crate) fn new(start: State<T, N>, onwards: f64) -> Self {
        Self { start, onwards, spans: Vec::new(), values: Vec::new(), terms: 0, basis: Basis::Nested, end: start }
    }

    /// Adds the next step and the state after it.
    pub(crate) fn push(&mut self, piece: &Piece<T, N>, end: State<T, N>) {
        (self.terms, self.basis) = (piece.terms, piece.basis);
        self.spans.push(piece.span);
        self.values.extend([piece.q0, piece.v0]);
        self.values.extend_from_slice(&piece.q[..piece.terms]);
        self.values.extend_from_slice(&piece.v[..piece.terms]);
        self.end = end;
    }

    /// The state at `t`, if it lies within.
    pub(crate) fn at(&self, t: f64, side: Side) -> Option<State<T, N>> {
        let onwards = self.onwards;
        if !(onwards * self.start.t <= onwards * t && onwards * t <= onwards * self.end.t) {
            return None;
        }
        let side = if onwards < 0.0 { side.opposite() } else { side };
        if side == Side::After && t == self.end.t {
            return Some(self.end);
        }
        // Steps that start before `t`; one that starts at `t` counts if the state beyond a kink is asked for.
        let started = self.spans.partition_point(|span| match side {
            Side::Before => 0.0 < -onwards * span.start.since(t),
            Side::After => 0.0 <= -onwards * span.start.since(t),
        });
        let Some(index) = started.checked_sub(1) else { return Some(self.start) };
        let span = &self.spans[index];
        let (theta, one) = (span.fraction(t), T::from_f64(1.0));
        let theta = if theta < one { theta } else { one };
        let values = &self.values[index * 2 * (self.terms + 1)..][..2 * (self.terms + 1)];
        let (states, terms) = values.split_at(2);
        let (q, v) = terms.split_at(self.terms);
        Some(State { t, q: self.basis.at(&states[0], q, theta), v: self.basis.at(&states[1], v, theta) })
    }
}
