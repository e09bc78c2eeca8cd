//! Dimensions: what a unit expression means in kilograms, metres and seconds.

pub(crate) mod infer;

use crate::algebra::number::Rational;
use crate::backend::unicode;
use crate::messages::Errors;
use crate::syntax::ast::{Expr, ExprKind, Literal};
use std::fmt;

/// Exponents of kilogram, metre and second; the radian is a pure number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dimension(pub(crate) [Rational; 3]);

impl Dimension {
    pub(crate) const PURE: Self = Self([Rational::ZERO; 3]);

    pub(crate) fn of(name: &str) -> Option<Self> {
        #[rustfmt::skip]
        let exponents = match name {
            "rad" => [0, 0,  0],
            "kg"  => [1, 0,  0],
            "m"   => [0, 1,  0],
            "s"   => [0, 0,  1],
            "Hz"  => [0, 0, -1],
            "N"   => [1, 1, -2],
            "J"   => [1, 2, -2],
            "W"   => [1, 2, -3],
            _ => return None,
        };
        Some(Self(exponents.map(Rational::whole)))
    }

    /// `self` · `other`^`power`.
    pub(crate) fn times(self, other: Self, power: Rational) -> Option<Self> {
        let mut result = self;
        for (own, other) in result.0.iter_mut().zip(other.0) {
            *own = own.add(other.mul(power)?)?;
        }
        Some(result)
    }
}

impl fmt::Display for Dimension {
    /// As one would write it: kg·m/s².
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = |sign: bool| {
            let powers = ["kg", "m", "s"]
                .into_iter()
                .zip(self.0)
                .filter(move |(_, power)| !power.is_zero() && power.is_negative() == sign);
            powers.map(|(name, power)| match power.abs() {
                Rational::ONE => name.to_owned(),
                power => match power.integer() {
                    Some(power) => format!("{name}{}", unicode::superscript(power)),
                    None => format!("{name}^({power})"),
                },
            })
        };
        let above: Vec<String> = named(false).collect();
        let below: Vec<String> = named(true).collect();
        let top = match (above.is_empty(), below.is_empty()) {
            (true, true) => return write!(f, "a pure number"),
            (true, false) => "1".to_owned(),
            _ => above.join("·"),
        };
        match below.as_slice() {
            [] => write!(f, "{top}"),
            [one] => write!(f, "{top}/{one}"),
            several => write!(f, "{top}/({})", several.join("·")),
        }
    }
}

/// Reads a unit expression; reports what is no unit.
pub(crate) fn dimension(expr: &Expr, errors: &mut Errors) -> Option<Dimension> {
    let refuse = |errors: &mut Errors, what: &str| {
        errors.once(
            expr.source,
            expr.range,
            format!("{what}; a unit is a product, quotient or power of `kg`, `m`, `s`, `rad`, `N`, `J`, `W`, `Hz` and `1`"),
        );
        None
    };
    match &expr.kind {
        ExprKind::Name(name) => {
            let text = name.to_string();
            Dimension::of(&text).or_else(|| refuse(errors, &format!("unknown unit `{text}`")))
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
            None => refuse(errors, "this exponent is no number"),
        },
        ExprKind::Number(_) => refuse(errors, "a number is no unit"),
        _ => refuse(errors, "this is no unit"),
    }
}

/// The value of an expression of numbers.
pub(crate) fn constant(expr: &Expr) -> Option<Rational> {
    match &expr.kind {
        ExprKind::Number(Literal::Exact(value)) => Some(*value),
        ExprKind::Negative(inner) => Some(constant(inner)?.negative()),
        ExprKind::Product(factors) => factors.iter().try_fold(Rational::ONE, |product, (over, factor)| {
            let factor = constant(factor)?;
            product.mul(if *over { factor.reciprocal()? } else { factor })
        }),
        ExprKind::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (minus, term)| {
            let term = constant(term)?;
            sum.add(if *minus { term.negative() } else { term })
        }),
        _ => None,
    }
}
