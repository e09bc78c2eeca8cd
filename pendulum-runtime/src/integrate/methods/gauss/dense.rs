//! Dense output of the Gauss methods.

use super::tableau::Tableau;
use crate::integrate::interpolant::fit::{Condition, fit};
use crate::integrate::interpolant::{Piece, TERMS};
use crate::integrate::step::endpoint::Node;
use crate::integrate::step::interval::Span;
use crate::real::Float;

/// The polynomial of degree S + 1 through the velocities at both ends and at the stages, and its
/// integral (a cubic if S = 1).
pub(super) fn piece<T: Float, const N: usize, const S: usize>(
    span: &Span,
    from: &Node<T, N>,
    to: &Node<T, N>,
    stages: &[[T; N]; S],
) -> Piece<T, N> {
    let nodes = const { &Tableau::<S>::GAUSS.nodes };
    let mut piece = Piece::linear(span, from, to);
    let h = span.length::<T>();
    let zero = (Condition::Slope(0.0), [T::from_f64(0.0); N]);
    let (mut q, mut v) = ([zero; TERMS], [zero; TERMS]);
    for (j, (&node, stage)) in nodes.iter().zip(stages).enumerate() {
        q[j] = (Condition::Slope(node), stage.map(|v| h * v));
        v[j] = (Condition::Value(node), core::array::from_fn(|i| stage[i] - from.v.high[i]));
    }
    // The increment of the coordinates is a quadrature of the slopes at the stages, so one of them
    // is not needed.
    q[S - 1] = (Condition::Slope(0.0), from.v.high.map(|v| h * v));
    q[S] = (Condition::Slope(1.0), to.v.high.map(|v| h * v));
    fit(&mut piece.q, &q[..=S]);
    fit(&mut piece.v, &v[..S]);
    piece.terms = S + 2;
    piece
}
