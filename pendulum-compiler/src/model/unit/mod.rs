//! Dimensions: unit expressions in terms of kilograms, metres, seconds, amperes and kelvins.

pub(crate) mod infer;

use super::integer::rational;
use crate::algebra::dimension::Dimension;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::messages::{Errors, Text, unit as messages};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::elsewhere;

/// Reads a unit expression, and reports an invalid one.
pub(crate) fn dimension(expr: &Expr, errors: &mut Errors) -> Option<Dimension> {
    let refuse = |errors: &mut Errors, message: Text| {
        errors.once(expr.source, expr.range, message);
        None
    };
    match &expr.kind {
        ExprKind::Name(name) => {
            let text = name.to_string();
            Dimension::of(&text).or_else(|| {
                let message = match elsewhere::unit(&text) {
                    Some(unit) => messages::untranslated_unit(&text, unit.instead, unit.factor),
                    None => messages::unknown_unit(&text),
                };
                refuse(errors, message)
            })
        }
        ExprKind::Number(Literal::Exact(Rational::ONE)) => Some(Dimension::PURE),
        ExprKind::Product(factors) => {
            let mut product = Dimension::PURE;
            for (over, factor) in factors {
                let power = if *over { Rational::MINUS_ONE } else { Rational::ONE };
                product = product.times(dimension(factor, errors)?, power)?;
            }
            Some(product)
        }
        ExprKind::Power(base, exponent) => match constant(exponent) {
            Some(power) => Dimension::PURE.times(dimension(base, errors)?, power),
            None => refuse(errors, messages::open_exponent()),
        },
        ExprKind::Number(_) => refuse(errors, messages::number_as_unit()),
        _ => refuse(errors, messages::no_unit()),
    }
}

/// Returns the value of an expression of numbers.
pub(crate) fn constant(expr: &Expr) -> Option<Rational> {
    rational(expr, &|_| None)
}
