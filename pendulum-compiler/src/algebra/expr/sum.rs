//! Sums: flat, sorted, with their content and common factors factored out.

use super::product::exact;
use super::{Graph, Id, Node, Terms};
use crate::algebra::expr::rule;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;

impl Graph {
    /// Returns Σ coefficient · term.
    pub(crate) fn sum(&mut self, terms: &[(Id, Rational)]) -> Id {
        let mut collected = Terms::new();
        for &(term, coefficient) in terms {
            self.add_term(&mut collected, term, coefficient);
        }
        self.finish_sum(collected)
    }

    /// Adds `coefficient · term` to `terms`; a sum is added term by term.
    pub(crate) fn add_term(&mut self, terms: &mut Terms, term: Id, coefficient: Rational) {
        if coefficient.is_zero() {
            return;
        }
        match self.node(term).clone() {
            Node::Number(value) => self.add_monomial(terms, Self::ONE, value, coefficient),
            Node::Sum(inner) => {
                for (id, own) in inner {
                    self.add_monomial(terms, id, own, coefficient);
                }
            }
            Node::Product(own, factors) if own != Rational::ONE => {
                let bare = self.bare_product(factors);
                match self.node(bare).clone() {
                    Node::Sum(inner) => match own.mul(coefficient) {
                        Some(outer) => {
                            for (id, coefficient) in inner {
                                self.add_monomial(terms, id, coefficient, outer);
                            }
                        }
                        None => self.add_monomial(terms, bare, own, coefficient),
                    },
                    _ => self.add_monomial(terms, bare, own, coefficient),
                }
            }
            _ => self.add_monomial(terms, term, Rational::ONE, coefficient),
        }
    }

    /// Adds `a · b · term` for a term without a coefficient. If the product overflows, it stays
    /// unevaluated.
    fn add_monomial(&mut self, terms: &mut Terms, term: Id, a: Rational, b: Rational) {
        let old = terms.get(&term).copied().unwrap_or(Rational::ZERO);
        if let Some(total) = a.mul(b).and_then(|product| product.add(old)) {
            if total.is_zero() {
                terms.remove(&term);
            } else {
                terms.insert(term, total);
            }
            return;
        }
        let a = self.intern(Node::Opaque(Literal::Exact(a)));
        let b = self.intern(Node::Opaque(Literal::Exact(b)));
        let product = self.product(
            Rational::ONE,
            &[(a, Rational::ONE), (b, Rational::ONE), (term, Rational::ONE)],
        );
        let count = terms.get(&product).copied().unwrap_or(Rational::ZERO);
        terms.insert(product, count.add(Rational::ONE).unwrap_or(Rational::ONE));
    }

    fn finish_sum(&mut self, mut terms: Terms) -> Id {
        self.work += terms.len();
        while !self.spent()
            && let Some(edit) = rule::rewrite_sum(self, &terms)
        {
            self.work += terms.len();
            for id in edit.removed {
                terms.remove(&id);
            }
            for (id, coefficient) in edit.added {
                self.add_term(&mut terms, id, coefficient);
            }
        }
        if self.spent() {
            return Self::ZERO;
        }
        if terms.len() < 2 {
            return match terms.pop_first() {
                None => Self::ZERO,
                Some((id, coefficient)) => self.scale(coefficient, id),
            };
        }
        let common = self.common_factors(&terms);
        if !common.is_empty() {
            let inverse: Vec<(Id, Rational)> =
                common.iter().map(|&(base, exponent)| (base, exponent.negative())).collect();
            let mut rest = Terms::new();
            for (id, coefficient) in terms {
                let mut factors = vec![(id, Rational::ONE)];
                factors.extend(&inverse);
                let quotient = self.product(Rational::ONE, &factors);
                self.add_term(&mut rest, quotient, coefficient);
            }
            let rest = self.finish_sum(rest);
            let mut factors = common;
            factors.push((rest, Rational::ONE));
            return self.product(Rational::ONE, &factors);
        }
        let mut content = terms
            .values()
            .copied()
            .reduce(|a, b| a.content(b).unwrap_or(Rational::ONE))
            .unwrap_or(Rational::ONE)
            .abs();
        if terms.values().next().is_some_and(|first| first.is_negative()) {
            content = content.negative();
        }
        let divided: Option<Vec<(Id, Rational)>> = content.reciprocal().and_then(|inverse| {
            terms
                .iter()
                .map(|(&id, &coefficient)| coefficient.mul(inverse).map(|own| (id, own)))
                .collect()
        });
        match divided {
            Some(divided) if content != Rational::ONE => {
                let primitive = self.intern(Node::Sum(divided));
                self.intern(Node::Product(content, vec![(primitive, Rational::ONE)]))
            }
            _ => self.intern(Node::Sum(terms.into_iter().collect())),
        }
    }

    /// Returns the factors that all terms have in common, with the exponents nearest to zero.
    fn common_factors(&self, terms: &Terms) -> Vec<(Id, Rational)> {
        let mut ids = terms.keys();
        let mut common = match ids.next() {
            Some(&id) if id != Self::ONE => self.factors(id),
            _ => return Vec::new(),
        };
        for &id in ids {
            if id == Self::ONE || common.is_empty() {
                return Vec::new();
            }
            let factors = self.factors(id);
            common.retain_mut(|(base, exponent)| {
                match factors.iter().find(|(other, _)| other == base) {
                    Some(&(_, other)) if other.is_negative() == exponent.is_negative() => {
                        if other.abs().less(exponent.abs()) == Some(true) {
                            *exponent = other;
                        }
                        true
                    }
                    _ => false,
                }
            });
        }
        // If division would not remove a factor from every term, the same factor would be found
        // again and the loop would not end.
        common.retain(|&(base, least)| {
            let divides = |&(other, exponent): &(Id, Rational)| {
                let rest = exact(exponent.add(least.negative()));
                other != base
                    || rest.is_some_and(|rest| {
                        rest.is_zero() || rest.is_negative() == least.is_negative()
                    })
            };
            terms.keys().all(|&id| self.factors(id).iter().all(divides))
        });
        common
    }
}

#[cfg(test)]
mod tests {
    use crate::algebra::expr::{Graph, Symbol};
    use crate::algebra::number::Rational;

    #[test]
    fn like_terms_and_common_factors_collect() {
        let mut g = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|k| g.symbol(Symbol::Parameter(k)));
        let ab = g.mul(a, b);
        let ac = g.mul(a, c);
        let left = g.add(ab, ac);
        let inner = g.add(c, b);
        assert_eq!(left, g.mul(inner, a));
        assert_eq!(g.sub(left, left), Graph::ZERO);
        let double = g.add(left, left);
        assert_eq!(double, g.scale(Rational::whole(2), left));
        let quotient = g.div(double, left);
        assert_eq!(quotient, g.whole(2));
    }
}
