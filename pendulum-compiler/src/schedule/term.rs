//! Products that are terms of a sum under construction.

use crate::algebra::expr::Id;
use crate::algebra::number::Rational;

/// A product that is a term of a sum under construction.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term {
    pub(super) coefficient: Rational,
    pub(super) factors: Vec<(Factor, Rational)>,
}

/// A factor of a product. A sum with a `scale` is multiplied by a constant, which is distributed
/// into its terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Factor {
    pub(super) id: Id,
    /// The index of the constant in `Schedule::scales`.
    pub(super) scale: Option<usize>,
}

impl Factor {
    pub(super) fn plain(id: Id) -> Self {
        Self { id, scale: None }
    }
}

/// Divides a product by one of its factors.
pub(super) fn take(factors: &mut Vec<(Factor, Rational)>, (factor, exponent): (Factor, Rational)) {
    multiply(factors, factor, exponent.negative());
}

/// Multiplies a product by a power.
pub(super) fn multiply(factors: &mut Vec<(Factor, Rational)>, factor: Factor, exponent: Rational) {
    let own = factors.iter_mut().find(|(other, _)| *other == factor);
    match own.and_then(|(_, own)| own.add(exponent).map(|total| (own, total))) {
        Some((own, total)) => *own = total,
        // An exponent that cannot be added is kept as a separate factor.
        None => factors.push((factor, exponent)),
    }
    factors.retain(|(_, exponent)| !exponent.is_zero());
}

/// Returns the empty product.
pub(super) fn unit() -> Term {
    Term { coefficient: Rational::ONE, factors: Vec::new() }
}

/// Returns the coefficient that all terms share up to sign, otherwise one.
pub(super) fn common_coefficient(terms: &[Term]) -> Rational {
    let first = terms[0].coefficient;
    if terms.iter().all(|term| term.coefficient.abs() == first.abs()) {
        first
    } else {
        Rational::ONE
    }
}
