//! Messages about two units that have to be equal.

use super::{Unit, Units};
use crate::algebra::dimension::Dimension;
use crate::algebra::number::Rational;
use crate::messages::message;
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::text::{operand, text};

impl Units<'_, '_, '_> {
    /// Reports two units that `rule` makes equal, of two expressions with what is counted with
    /// them, such as " times a second", at the one that is wrong.
    ///
    /// An energy in joules is right, and otherwise the first of two. If the square of a factor
    /// would make the other an energy, as of the norm in `m/2*|v|`, the square is forgotten.
    pub(super) fn differ(&mut self, [own, first]: [(&Unit, &Expr, &str); 2], rule: &str) {
        let is_first = self.is_joule(own.0) && !self.is_joule(first.0);
        let (wrong, right) = if is_first { (first, own) } else { (own, first) };
        let missing = self.ratio(right.0, wrong.0).filter(|_| self.is_joule(right.0));
        let square = missing.and_then(|missing| self.square_of(wrong.1, &missing));
        let advice = square.map_or_else(String::new, |square| format!(": write `{square}`"));
        let (found, expected) = (self.shown(wrong.0), self.shown(right.0));
        let message = message!(
            "`{}`{} is {found}, but `{}`{} is {expected}; {rule}{advice}",
            text(wrong.1),
            wrong.2,
            text(right.1),
            right.2
        );
        self.errors.once(wrong.1.source, wrong.1.range, message);
    }

    fn is_joule(&self, unit: &Unit) -> bool {
        let joule = Unit::of(Dimension::whole([1, 2, -2, 0, 0]));
        self.ratio(unit, &joule) == Some(Unit::pure())
    }

    /// Returns the square of the factor of an expression that has the unit `missing`.
    fn square_of(&mut self, expr: &Expr, missing: &Unit) -> Option<String> {
        let mut factors = match &expr.kind {
            ExprKind::Product(factors) => {
                factors.iter().filter(|(over, _)| !over).map(|(_, factor)| factor).collect()
            }
            ExprKind::Negative(inner) => return self.square_of(inner, missing),
            _ => vec![expr],
        };
        factors.retain(|factor| !matches!(factor.kind, ExprKind::Power(..)));
        let factor = factors
            .into_iter()
            .find(|factor| self.expr(factor).is_some_and(|own| self.resolved(&own) == *missing));
        factor.map(|factor| format!("{}^2", operand(factor)))
    }

    /// Returns the quotient of two units, with every solved unknown replaced.
    fn ratio(&self, a: &Unit, b: &Unit) -> Option<Unit> {
        Some(self.resolved(&a.times(b, Rational::MINUS_ONE)?))
    }
}
