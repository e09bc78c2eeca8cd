//! Constants distributed into sums in which every term has a constant already.

use super::term::{Term, multiply};
use super::{Place, Schedule};
use crate::algebra::expr::{Graph, Id, Node};
use crate::algebra::number::Rational;

impl Schedule<'_> {
    /// Computes a sum with a constant distributed into its terms.
    pub(super) fn scaled_sum(&mut self, sum: Id, scale: usize) -> (Place, bool) {
        if let Some(&done) = self.scaled.get(&(sum, scale)) {
            return done;
        }
        let Some(terms) = self.terms(sum) else { return (self.value(sum), false) };
        let constant = self.scales[scale].clone();
        let mut scaled = Vec::new();
        for (id, coefficient) in terms {
            let mut term = self.term(id, coefficient);
            let inner = term.factors.iter().position(|&(factor, exponent)| {
                exponent == Rational::ONE && self.takes_in(factor.id, 2)
            });
            if let Some(index) = inner {
                term.factors[index].0.scale = Some(scale);
            } else {
                term.coefficient =
                    term.coefficient.mul(constant.coefficient).unwrap_or(term.coefficient);
                for &(factor, exponent) in &constant.factors {
                    multiply(&mut term.factors, factor, exponent);
                }
            }
            scaled.push(term);
        }
        let done = self.sum(scaled);
        self.scaled.insert((sum, scale), done);
        done
    }

    /// Returns `true` if a constant can be distributed into a sum without additional products:
    /// every term has a constant already, or contains such a sum.
    ///
    /// A sum with more than `most` uses is excluded, because it would be computed twice.
    pub(super) fn takes_in(&self, id: Id, most: usize) -> bool {
        let Some(terms) = self.terms(id) else { return false };
        if self.parameter_only(id) || most < self.uses.get(&id).copied().unwrap_or(0) {
            return false;
        }
        let terms = &terms;
        terms.iter().all(|&(term, coefficient)| {
            if coefficient.within(60).is_none() {
                return false;
            }
            let factors = self.graph.factors(term);
            let constant = coefficient.abs() != Rational::ONE
                || term == Graph::ONE
                || factors.iter().any(|&(base, _)| self.parameter_only(base));
            constant
                || factors.iter().any(|&(base, exponent)| {
                    exponent == Rational::ONE && self.takes_in(base, self.occurrences(base, terms))
                })
        })
    }

    pub(super) fn scale(&mut self, constant: Term) -> usize {
        if let Some(known) = self.scales.iter().position(|scale| *scale == constant) {
            return known;
        }
        self.scales.push(constant);
        self.scales.len() - 1
    }

    /// Returns the terms of a sum or of the sum in an atom.
    pub(super) fn terms(&self, id: Id) -> Option<Vec<(Id, Rational)>> {
        match self.graph.node(id) {
            Node::Sum(terms) => Some(terms.clone()),
            Node::Atom(inner) if self.uses.get(inner).copied().unwrap_or(0) < 2 => {
                self.terms(*inner)
            }
            _ => None,
        }
    }

    /// Returns the number of terms that contain a factor.
    fn occurrences(&self, id: Id, terms: &[(Id, Rational)]) -> usize {
        terms
            .iter()
            .filter(|&&(term, _)| self.graph.factors(term).iter().any(|&(base, _)| base == id))
            .count()
    }
}
