//! Polynomials in time.

use super::{CORNERS, HIGHEST, Search};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// A polynomial in time, u = a tᵈ + …. It may contain |v| for linear functions v.
#[derive(Clone)]
pub(super) struct Polynomial {
    /// The polynomial with v in place of each |v|; unchanged if d = 1 and there are several |v|.
    pub(super) smooth: Id,
    pub(super) degree: i64,
    /// The coefficient a, which is constant along the motion. For several |v| it is a bound on the
    /// slope.
    pub(super) leading: Id,
    /// The time at which the derivative of order d − 1 is zero, or the times of the corners if d =
    /// 1 and there are |v|; empty if there are too many.
    pub(super) middles: Vec<Id>,
    pub(super) cornered: bool,
    /// `true` if all terms of the expression are part of the polynomial.
    pub(super) whole: bool,
}

impl Search {
    /// Returns the sum of those terms of an expression that are polynomials in time, or `None` if
    /// there are none or if their leading coefficient is not constant.
    pub(super) fn polynomial(&mut self, id: Id) -> Option<Polynomial> {
        if let Some(known) = self.polynomials.get(&id) {
            return known.clone();
        }
        let polynomial = self.derived_polynomial(id);
        self.polynomials.insert(id, polynomial.clone());
        polynomial
    }

    fn derived_polynomial(&mut self, id: Id) -> Option<Polynomial> {
        let all = self.terms(id);
        let mut terms = all.clone();
        terms.retain(|&(term, _)| self.degree(term).is_some());
        let whole = terms.len() == all.len();
        let sum = self.graph.sum(&terms);
        let mut degree = self.degree(sum).filter(|degree| (1..=HIGHEST).contains(degree))?;
        let magnitudes = self.magnitudes(sum);
        if degree == 1 && 1 < magnitudes.len() {
            let leading = self.steepest(sum)?;
            let middles = self.corners_of(&magnitudes);
            return Some(Polynomial {
                smooth: sum,
                degree,
                leading,
                middles,
                cornered: true,
                whole,
            });
        }
        let smooth = self.branch(sum, &magnitudes, 0);
        let mut derivatives = vec![smooth];
        for order in 0..degree {
            let next = derivative(&mut self.graph, derivatives[order as usize], Symbol::Time);
            derivatives.push(next);
        }
        while 0 < degree && derivatives[degree as usize] == Graph::ZERO {
            degree -= 1;
        }
        let last = derivatives[degree as usize];
        if degree == 0 || self.moves(last) || self.has_state(last) {
            return None;
        }
        let factorial: i64 = (1..=degree).product();
        let leading =
            self.graph.product(Rational::new(1, factorial.into())?, &[(last, Rational::ONE)]);
        let middles = match magnitudes.as_slice() {
            [_] if degree == 1 => self.corners_of(&magnitudes),
            // The derivative before the last is linear.
            _ => vec![self.zero(derivatives[degree as usize - 1])?],
        };
        Some(Polynomial {
            smooth,
            degree,
            leading,
            middles,
            cornered: !magnitudes.is_empty(),
            whole,
        })
    }

    /// Returns the time at which a linear function of time is zero, or `None` for a constant.
    fn zero(&mut self, line: Id) -> Option<Id> {
        let slope = derivative(&mut self.graph, line, Symbol::Time);
        if slope == Graph::ZERO {
            return None;
        }
        let start = self.at(line, Graph::ZERO);
        let quotient = self.graph.div(start, slope);
        Some(self.graph.negative(quotient))
    }

    /// Returns the degree in time of an expression that is a polynomial apart from magnitudes of
    /// linear functions, or `None` for any other expression.
    fn degree(&mut self, id: Id) -> Option<i64> {
        if let Some(&known) = self.degrees.get(&id) {
            return known;
        }
        for node in self.graph.reachable(&[id]) {
            if !self.degrees.contains_key(&node) {
                let degree = self.degree_from_children(node);
                self.degrees.insert(node, degree);
            }
        }
        self.degrees[&id]
    }

    fn degree_from_children(&self, id: Id) -> Option<i64> {
        if !self.moves(id) {
            return Some(0);
        }
        match self.graph.node(id) {
            Node::Symbol(Symbol::Time) => Some(1),
            Node::Sum(terms) => {
                terms.iter().try_fold(0, |most, (term, _)| Some(self.degrees[term]?.max(most)))
            }
            Node::Product(_, factors) => factors.iter().try_fold(0i64, |sum, (base, exponent)| {
                let degree = self.degrees[base]?;
                if degree == 0 {
                    return Some(sum);
                }
                let exponent =
                    exponent.integer().filter(|exponent| (1..=HIGHEST).contains(exponent))?;
                Some(sum + degree * exponent).filter(|degree| *degree <= HIGHEST)
            }),
            Node::Atom(inner) => self.degrees[inner],
            Node::Call(Function::Abs, inner) => self.degrees[inner].filter(|degree| *degree == 1),
            _ => None,
        }
    }

    /// Returns the magnitudes of time-dependent arguments in an expression, inner ones first.
    fn magnitudes(&self, id: Id) -> Vec<Id> {
        let moving = |node: &Id| match *self.graph.node(*node) {
            Node::Call(Function::Abs, argument) => self.moves(argument),
            _ => false,
        };
        self.graph.reachable(&[id]).into_iter().filter(moving).collect()
    }

    /// Replaces each magnitude in an expression by its argument, negated if the bit of the
    /// magnitude in `signs` is set.
    fn branch(&mut self, id: Id, magnitudes: &[Id], signs: usize) -> Id {
        if magnitudes.is_empty() {
            return id;
        }
        let mut known: BTreeMap<Id, Id> = BTreeMap::new();
        for node in self.graph.reachable(&[id]) {
            let old = self.graph.node(node).clone();
            let result = match (&old, magnitudes.iter().position(|magnitude| *magnitude == node)) {
                (Node::Call(_, argument), Some(place)) if signs >> place & 1 == 1 => {
                    self.graph.negative(known[argument])
                }
                (Node::Call(_, argument), Some(_)) => known[argument],
                _ => self.graph.rebuilt(&old, |child| known[&child]),
            };
            known.insert(node, result);
        }
        known[&id]
    }

    /// Returns the times at which magnitudes of linear functions have a corner, for both signs of
    /// the magnitudes inside them. Empty if there are too many.
    fn corners_of(&mut self, magnitudes: &[Id]) -> Vec<Id> {
        let mut corners = Vec::new();
        for &magnitude in magnitudes {
            let argument = self.graph.children(magnitude)[0];
            let inner = self.magnitudes(argument);
            if CORNERS < corners.len() + inner.len() {
                return Vec::new();
            }
            for signs in 0..1 << inner.len() {
                let line = self.branch(argument, &inner, signs);
                if let Some(corner) = self.zero(line)
                    && !corners.contains(&corner)
                {
                    corners.push(corner);
                }
            }
        }
        if CORNERS < corners.len() { Vec::new() } else { corners }
    }

    /// Returns a bound on the slope of a sum of magnitudes of linear functions, the sum of the
    /// magnitudes of all slopes.
    fn steepest(&mut self, id: Id) -> Option<Id> {
        let mut slopes: BTreeMap<Id, Id> = BTreeMap::new();
        for node in self.graph.reachable(&[id]) {
            let slope = match self.graph.node(node).clone() {
                _ if !self.moves(node) => Graph::ZERO,
                Node::Sum(terms) => {
                    let slopes: Vec<(Id, Rational)> = terms
                        .iter()
                        .map(|(term, coefficient)| (slopes[term], coefficient.abs()))
                        .collect();
                    self.graph.sum(&slopes)
                }
                Node::Product(coefficient, factors) => {
                    let (moving, fixed): (Vec<_>, Vec<_>) =
                        factors.into_iter().partition(|&(base, _)| self.moves(base));
                    let constant = self.graph.product(coefficient, &fixed);
                    let magnitude = self.graph.call(Function::Abs, constant);
                    self.graph.mul(magnitude, slopes[&moving.first()?.0])
                }
                Node::Call(_, argument) | Node::Atom(argument) => slopes[&argument],
                _ => Graph::ONE,
            };
            slopes.insert(node, slope);
        }
        Some(slopes[&id])
            .filter(|&slope| slope != Graph::ZERO && !self.moves(slope) && !self.has_state(slope))
    }
}
