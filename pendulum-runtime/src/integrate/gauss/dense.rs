//! Dense output of the Gauss methods.

use super::tableau::Tableau;
use crate::integrate::linear::Factors;
use crate::integrate::node::Node;
use crate::integrate::piece::{Piece, TERMS};
use crate::integrate::span::Span;
use crate::real::Float;

/// The polynomial of degree S + 1 through the velocities at both ends and at the stages, and its integral (a cubic if S = 1).
pub(super) fn piece<T: Float, const N: usize, const S: usize>(
    span: &Span,
    from: &Node<T, N>,
    to: &Node<T, N>,
    stages: &[[T; N]; S],
) -> Piece<T, N> {
    let nodes = const { &Tableau::<S>::GAUSS.nodes };
    let mut piece = Piece::linear(span, from, to);
    let h = T::from_f64(span.h);
    // Of the velocities the increment is known, and the other terms follow from the stages. Of the coordinates the increment and the
    // slopes at both ends and at all stages but the last are enough: the increment is a quadrature of the stages.
    let inner = Factors::<f64, TERMS, 1>::new(|_, _| {
        core::array::from_fn(|row| if row < S { shifted(&terms(nodes[row]).0) } else { unit(row) })
    });
    let slopes = Factors::<f64, TERMS, 1>::new(|_, _| {
        core::array::from_fn(|row| match row {
            _ if row + 1 < S => shifted(&terms(nodes[row]).1),
            _ if row < S => shifted(&terms(0.0).1),
            _ if row == S => shifted(&terms(1.0).1),
            _ => unit(row),
        })
    });
    for k in 0..N {
        let mut v = [[0.0; TERMS]];
        let mut q = [[0.0; TERMS]];
        let (dq, dv) = (piece.q[0][k], piece.v[0][k]);
        for i in 0..S {
            let rise = stages[i][k] - from.v.high[k];
            v[0][i] = (rise - T::from_f64(nodes[i]) * dv).to_f64();
            q[0][i] = (h * stages[i][k] - dq).to_f64();
        }
        q[0][S - 1] = (h * from.v.high[k] - dq).to_f64();
        q[0][S] = (h * to.v.high[k] - dq).to_f64();
        inner.solve(&mut v);
        slopes.solve(&mut q);
        for term in 0..=S {
            piece.q[term + 1][k] = T::from_f64(q[0][term]);
            if term < S {
                piece.v[term + 1][k] = T::from_f64(v[0][term]);
            }
        }
    }
    piece.terms = S + 2;
    piece
}

/// The polynomials θ, θ(1−θ), θ²(1−θ), … that the terms of a piece multiply, and their derivatives.
fn terms(theta: f64) -> ([f64; TERMS], [f64; TERMS]) {
    let (mut values, mut slopes) = ([0.0; TERMS], [0.0; TERMS]);
    let (mut value, mut slope) = (1.0, 0.0);
    for term in 0..TERMS {
        let (factor, direction) = if term % 2 == 0 { (theta, 1.0) } else { (1.0 - theta, -1.0) };
        (value, slope) = (value * factor, slope * factor + value * direction);
        (values[term], slopes[term]) = (value, slope);
    }
    (values, slopes)
}

/// Without the first term; the place at the end is empty.
fn shifted(terms: &[f64; TERMS]) -> [f64; TERMS] {
    core::array::from_fn(|k| if k + 1 < TERMS { terms[k + 1] } else { 0.0 })
}

/// A row that leaves an unused unknown at zero.
fn unit(row: usize) -> [f64; TERMS] {
    core::array::from_fn(|k| f64::from(u8::from(k == row)))
}
