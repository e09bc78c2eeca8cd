//! Dimensions: unit expressions in terms of kilograms, metres, seconds, amperes and kelvins.

pub(crate) mod infer;

use super::integer::rational;
use crate::algebra::dimension::Dimension;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::messages::{Errors, Text, message};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::elsewhere::{self, ForeignUnit};

/// The description of a valid unit.
const FORM: &str = "a unit is a product, quotient or power of `kg`, `m`, `s`, `rad`, `N`, `J`, \
                    `W`, `Hz`, `A`, `V`, `C`, `F`, `H`, `ohm`, `T`, `K` and `1`";

/// The message about a name that is not a unit.
pub(crate) fn unknown_unit(name: &str) -> Text {
    message!("unknown unit `{name}`; {FORM}")
}

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
                    Some(ForeignUnit { instead, factor: Some(factor) }) => message!(
                        "unknown unit `{text}`; write `{instead}`: 1 {text} is {factor} {instead}"
                    ),
                    Some(ForeignUnit { instead, factor: None }) => {
                        message!("unknown unit `{text}`; write `{instead}`")
                    }
                    None if elsewhere::TYPES.contains(&text.as_str()) => message!(
                        "`{text}` is a type, and a unit stands here; write `kg`, `m` and so on, or \
                         `1` for a pure number"
                    ),
                    None => match elsewhere::quantity(&text) {
                        Some(unit) => message!("unknown unit `{text}`; write `{unit}`"),
                        None => unknown_unit(&text),
                    },
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
            None => refuse(errors, message!("this exponent is no number; {FORM}")),
        },
        ExprKind::Number(_) => refuse(errors, message!("a number is no unit; {FORM}")),
        _ => refuse(errors, message!("this is no unit; {FORM}")),
    }
}

/// Returns the value of an expression of numbers.
pub(crate) fn constant(expr: &Expr) -> Option<Rational> {
    rational(expr, &|_| None)
}
