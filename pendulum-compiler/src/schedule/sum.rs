//! Sums, factored greedily by the factors that most of their terms share.

use super::program::{add, mul};
use super::term::{Factor, Term, common_coefficient, take};
use super::{Op, Place, Schedule};
use crate::algebra::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// The limit on the depth of nesting when polynomials are factored as in Horner's scheme. It bounds
/// the use of the stack.
const DEPTH: usize = 64;

impl Schedule<'_> {
    /// Computes a sum of products. Returns its place and whether its value is the negative of that
    /// place.
    pub(super) fn sum(&mut self, terms: Vec<Term>) -> (Place, bool) {
        let mut spread = Vec::with_capacity(terms.len());
        for term in terms {
            match self.spread(&term) {
                Some(terms) => spread.extend(terms),
                None => spread.push(term),
            }
        }
        self.nested_sum(spread, 0)
    }

    /// Computes a sum inside `depth` other sums, each of which has a common factor extracted.
    fn nested_sum(&mut self, mut terms: Vec<Term>, depth: usize) -> (Place, bool) {
        let mut parts: Vec<(Place, bool)> = Vec::new();
        while depth < DEPTH
            && let Some((factor, shared)) = self.most_shared(&terms)
        {
            let mut inner = Vec::new();
            let mut rest = Vec::new();
            for (index, mut term) in terms.into_iter().enumerate() {
                if shared.contains(&index) {
                    take(&mut term.factors, factor);
                    inner.push(term);
                } else {
                    rest.push(term);
                }
            }
            let common = common_coefficient(&inner);
            for term in &mut inner {
                term.coefficient = term
                    .coefficient
                    .mul(common.reciprocal().unwrap_or(Rational::ONE))
                    .unwrap_or(term.coefficient);
            }
            let (sum, negative) = self.nested_sum(inner, depth + 1);
            let (outer, flipped) =
                self.product(&Term { coefficient: common, factors: vec![factor] });
            let place = self.program.push(mul(outer, sum));
            parts.push((place, negative != flipped));
            terms = rest;
        }
        for term in &terms {
            let part = self.product(term);
            parts.push(part);
        }
        // Start with a positive part, so that no negation is needed.
        let first = parts.iter().position(|&(_, negative)| !negative);
        let (start, flipped) = match first {
            Some(index) => (parts.remove(index).0, false),
            None => (parts.remove(0).0, true),
        };
        let mut total = start;
        for (part, negative) in parts {
            total = self.program.push(if negative == flipped {
                add(total, part)
            } else {
                Op::Sub(total, part)
            });
        }
        (total, flipped)
    }

    /// Returns the factor whose extraction saves most, and the terms that contain it.
    ///
    /// A factor that depends on more than parameters saves a multiplication in all terms but one. A
    /// constant saves one only in terms without another constant.
    fn most_shared(&mut self, terms: &[Term]) -> Option<((Factor, Rational), BTreeSet<usize>)> {
        let mut shared: BTreeMap<(Factor, bool), BTreeSet<usize>> = BTreeMap::new();
        for (index, term) in terms.iter().enumerate() {
            let vanishing = term.factors.iter().any(|&factor| self.vanishes(term, factor));
            for &(factor, exponent) in &term.factors {
                // Differences of these exponents are exact. A norm that its numerator outweighs
                // stays beside it.
                if exponent.within(30).is_none() || vanishing && !self.parameter_only(factor.id) {
                    continue;
                }
                shared.entry((factor, exponent.is_negative())).or_default().insert(index);
            }
        }
        let mut best: Option<(usize, (Factor, bool), BTreeSet<usize>)> = None;
        for (key, places) in shared {
            let parameter_only = key.0.scale.is_none() && self.parameter_only(key.0.id);
            let saved = if parameter_only {
                let alone = |&&index: &&usize| {
                    let (constant, _) = self.split(&terms[index]);
                    constant.coefficient == Rational::ONE && constant.factors.len() == 1
                };
                places.iter().filter(alone).count()
            } else {
                places.len()
            };
            if 2 <= saved && best.as_ref().is_none_or(|(other, ..)| *other < saved) {
                best = Some((saved, key, places));
            }
        }
        let (_, (factor, negative), places) = best?;
        let exponents = places.iter().filter_map(|&index| {
            let found = terms[index]
                .factors
                .iter()
                .find(|(other, exponent)| *other == factor && exponent.is_negative() == negative);
            found.map(|&(_, exponent)| exponent)
        });
        let exponent =
            exponents.reduce(|a, b| if b.abs().less(a.abs()) == Some(true) { b } else { a })?;
        Some(((factor, exponent), places))
    }
}
