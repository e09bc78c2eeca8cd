//! Integers known at compile time: lengths, indices and ends of ranges.

use crate::algebra::number::{Literal, Rational};
use crate::messages::Range;
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name;

/// Evaluates an integer expression with the values of the indices in scope, or returns the range of
/// the expression.
pub(crate) fn integer(expr: &Expr, bound: &dyn Fn(&str) -> Option<i64>) -> Result<i64, Range> {
    rational(expr, bound).and_then(Rational::integer).ok_or(expr.range)
}

/// Evaluates an expression of numbers and of the indices in scope.
pub(super) fn rational(expr: &Expr, bound: &dyn Fn(&str) -> Option<i64>) -> Option<Rational> {
    match &expr.kind {
        ExprKind::Number(Literal::Exact(value)) => Some(*value),
        ExprKind::Name(ident) => {
            let name = name::read(&ident.to_string());
            bound(&name.base).filter(|_| name.dots == 0).map(Rational::whole)
        }
        ExprKind::Negative(inner) => Some(rational(inner, bound)?.negative()),
        ExprKind::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (minus, term)| {
            let term = rational(term, bound)?;
            sum.add(if *minus { term.negative() } else { term })
        }),
        ExprKind::Product(factors) => {
            factors.iter().try_fold(Rational::ONE, |product, (over, factor)| {
                let factor = rational(factor, bound)?;
                product.mul(if *over { factor.reciprocal()? } else { factor })
            })
        }
        _ => None,
    }
}
