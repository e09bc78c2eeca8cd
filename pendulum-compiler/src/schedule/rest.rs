//! Quotients by norms that vanish where the norm does.
//!
//! The derivative of |v| ẋ is |v| + ẋ²/|v|. At rest its value is zero, but that of the quotient is
//! 0/0. The numerator is of a higher degree in the velocities than the norm, so that the quotient
//! has the limit zero: such a norm is replaced by its maximum with a tiny number. Quotients of the
//! same degree, such as the direction x/|x|, have no limit, and stay NaN.

use super::term::{Factor, Term, multiply};
use super::{Op, Place, Schedule};
use crate::algebra::expr::{Graph, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;

/// The quantities in which degrees are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Small {
    Velocities,
    Coordinates,
    /// The bases of the squares of which a norm is the root.
    Parts(Id),
}

impl Schedule<'_> {
    /// Returns `true` if a factor of a product is in the divisor, a fractional power of a sum, and
    /// of a lower degree than the other factors together.
    pub(super) fn vanishes(&mut self, term: &Term, (factor, exponent): (Factor, Rational)) -> bool {
        if !exponent.is_negative() || exponent.is_integer() || self.parameter_only(factor.id) {
            return false;
        }
        let Node::Sum(_) = self.graph.node(factor.id) else { return false };
        let all = [Small::Velocities, Small::Coordinates, Small::Parts(factor.id)];
        let counted = if self.positions { &all[..] } else { &all[..1] };
        counted.iter().any(|&small| {
            let norm = self.degree(factor.id, small);
            let total: f64 = term
                .factors
                .iter()
                .map(|&(other, power)| match self.degree(other.id, small) {
                    _ if other == factor => norm * ratio(power),
                    degree => scaled(degree, power),
                })
                .sum();
            0.0 < norm && 1e-9 < total
        })
    }

    /// Returns the terms of a product with a sum in which a norm is outweighed by the other factors
    /// only: ẋẏ(1/|v| + 1).
    pub(super) fn spread(&mut self, term: &Term) -> Option<Vec<Term>> {
        (0..term.factors.len()).find_map(|index| {
            let (sum, exponent) = term.factors[index];
            if exponent != Rational::ONE || sum.scale.is_some() || self.parameter_only(sum.id) {
                return None;
            }
            let inner = self.terms(sum.id)?;
            let rooted = |&(id, _): &(Id, Rational)| {
                let mut factors = self.graph.factors(id).into_iter();
                factors.any(|(_, exponent)| exponent.is_negative() && !exponent.is_integer())
            };
            if !inner.iter().any(rooted) {
                return None;
            }
            let mut outer = term.factors.clone();
            outer.remove(index);
            let mut outweighed = false;
            let mut spread = Vec::with_capacity(inner.len());
            for (id, coefficient) in inner {
                let own = self.term(id, coefficient);
                let mut whole = own.clone();
                whole.coefficient = own.coefficient.mul(term.coefficient)?;
                for &(factor, power) in &outer {
                    multiply(&mut whole.factors, factor, power);
                }
                outweighed |= own
                    .factors
                    .iter()
                    .any(|&factor| !self.vanishes(&own, factor) && self.vanishes(&whole, factor));
                spread.push(whole);
            }
            outweighed.then_some(spread)
        })
    }

    /// Returns the power of a norm, or a tiny number where the norm is less. In `f32` too the
    /// number is neither zero nor infinite.
    pub(super) fn off_zero(&mut self, power: Place) -> Place {
        let Some(tiny) = Rational::new(1, 1 << 100) else { return power };
        let tiny = self.program.push(Op::Number(tiny));
        self.program.push(Op::Max(power, tiny))
    }

    /// Returns a lower bound on the degree of an expression in small quantities.
    fn degree(&mut self, id: Id, small: Small) -> f64 {
        if let Some(&degree) = self.degrees.get(&(small, id)) {
            return degree;
        }
        let parts = match small {
            Small::Parts(norm) => squares(self.graph, norm),
            _ => Vec::new(),
        };
        // Children have smaller ids, so that they are known before their parents.
        for node in self.graph.reachable(&[id]) {
            let known = |id: Id| self.degrees.get(&(small, id)).copied().unwrap_or(0.0);
            let degree = match self.graph.node(node) {
                _ if parts.contains(&node) => 1.0,
                Node::Symbol(Symbol::Velocity(_)) => {
                    f64::from(u8::from(small == Small::Velocities))
                }
                Node::Symbol(Symbol::Coordinate(_)) => {
                    f64::from(u8::from(small == Small::Coordinates))
                }
                Node::Sum(terms) => {
                    terms.iter().map(|&(term, _)| known(term)).fold(f64::INFINITY, f64::min)
                }
                Node::Product(_, factors) => {
                    factors.iter().map(|&(base, exponent)| scaled(known(base), exponent)).sum()
                }
                Node::Call(Function::Abs, inner) | Node::Atom(inner) => known(*inner),
                Node::Max(a, b) => known(*a).min(known(*b)),
                _ => 0.0,
            };
            self.degrees.insert((small, node), degree);
        }
        self.degrees.get(&(small, id)).copied().unwrap_or(0.0)
    }
}

/// Returns a bound on the degree of a power. An expression in a divisor may be of a higher degree
/// than its bound, so that there is no bound for its quotient.
fn scaled(degree: f64, exponent: Rational) -> f64 {
    if degree == 0.0 {
        0.0
    } else if exponent.is_negative() {
        f64::NEG_INFINITY
    } else {
        degree * ratio(exponent)
    }
}

fn ratio(value: Rational) -> f64 {
    value.numerator() as f64 / value.denominator() as f64
}

/// Returns the bases of a sum of squares, none if it is no such sum.
fn squares(graph: &Graph, sum: Id) -> Vec<Id> {
    let Node::Sum(terms) = graph.node(sum) else { return Vec::new() };
    let base = |&(term, _): &(Id, Rational)| match graph.node(term) {
        Node::Product(_, factors) => {
            let mut squares =
                factors.iter().filter(|(_, exponent)| *exponent == Rational::whole(2));
            match (squares.next(), squares.next()) {
                (Some(&(base, _)), None) => Some(base),
                _ => None,
            }
        }
        _ => None,
    };
    terms.iter().map(base).collect::<Option<Vec<Id>>>().unwrap_or_default()
}
