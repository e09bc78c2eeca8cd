//! The units of expressions.

use super::{DEEPEST, Found, Unit, Units};
use crate::algebra::dimension::Dimension;
use crate::algebra::functions::{UnitRule, Word};
use crate::algebra::number::{Literal, Rational};
use crate::messages::message;
use crate::model::resolved::Meaning;
use crate::model::unit::constant;
use crate::syntax::ast::{self, Expr, ExprKind};
use crate::syntax::name::{self, Name, plain};
use crate::syntax::text::text;
use std::fmt;

/// A place that requires a pure number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pure<'a> {
    Argument(&'a str),
    Base,
    Exponent,
    Restitution,
}

impl fmt::Display for Pure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument(function) => write!(f, "the argument of `{function}`"),
            Self::Base => f.write_str("the base of a power with a non-constant exponent"),
            Self::Exponent => f.write_str("an exponent"),
            Self::Restitution => f.write_str("a restitution"),
        }
    }
}

impl Units<'_, '_, '_> {
    /// Reports a unit that is not that of a pure number.
    pub(super) fn pure(&mut self, expr: &Expr, place: Pure) {
        let Some(unit) = self.expr(expr) else { return };
        self.expect(expr, &unit, &Unit::pure(), |unit, _| {
            let found = text(expr);
            let instead = match (unit.as_str(), place) {
                ("s", Pure::Argument("sin" | "cos" | "tan" | "cis" | "sinc")) => {
                    "multiply it by an angular frequency, such as a parameter `omega: rad/s`"
                        .to_owned()
                }
                ("s", _) => "divide it by a time, such as a parameter `tau: s`".to_owned(),
                ("m", _) => "divide it by a length, such as a parameter `a: m`".to_owned(),
                _ => format!("divide it by a quantity in {unit}"),
            };
            message!("`{found}` is {unit}, but {place} is a pure number; {instead}")
        });
    }

    /// Returns the common unit of several expressions, and reports the first that differs.
    pub(super) fn common<'x>(
        &mut self,
        items: impl Iterator<Item = &'x Expr>,
        whole: &str,
    ) -> Found {
        let mut common: Option<(Unit, &Expr)> = None;
        for item in items {
            let Some(found) = self.expr(item) else { continue };
            let Some((expected, first)) = &common else {
                common = Some((found, item));
                continue;
            };
            if !self.unify(&found, expected) {
                let rule = format!("{whole} needs one unit");
                self.differ([(&found, item, ""), (expected, first, "")], &rule);
                return None;
            }
        }
        common.map(|(unit, _)| unit)
    }

    pub(super) fn expr(&mut self, expr: &Expr) -> Found {
        if DEEPEST <= self.depth {
            return None;
        }
        self.depth += 1;
        let found = self.kind(expr);
        self.depth -= 1;
        found
    }

    fn kind(&mut self, expr: &Expr) -> Found {
        match &expr.kind {
            ExprKind::Number(Literal::Exact(Rational::ZERO)) => None,
            ExprKind::Number(_) => Some(Unit::pure()),
            ExprKind::Name(ident) => self.name(&ident.to_string()),
            ExprKind::Sum(items) => self.common(items.iter().map(|(_, item)| item), "a sum"),
            ExprKind::Product(items) => {
                let mut product = Some(Unit::pure());
                for (over, item) in items {
                    let factor = self.expr(item);
                    let power = if *over { Rational::MINUS_ONE } else { Rational::ONE };
                    product = product
                        .zip(factor)
                        .and_then(|(product, factor)| product.times(&factor, power));
                }
                product
            }
            ExprKind::Component(inner, component)
                if self.model.body(inner, |_| false).is_some() =>
            {
                let exponents = match component.to_string().as_str() {
                    "mass" => [1, 0, 0, 0, 0],
                    "center" => [0, 1, 0, 0, 0],
                    _ => [1, 2, 0, 0, 0],
                };
                Some(Unit::of(Dimension::whole(exponents)))
            }
            ExprKind::Negative(inner)
            | ExprKind::Magnitude(inner)
            | ExprKind::Component(inner, _)
            | ExprKind::Index(inner, _) => self.expr(inner),
            ExprKind::Power(base, exponent) => {
                if let Some(power) = constant(exponent) {
                    return self.expr(base).and_then(|unit| Unit::pure().times(&unit, power));
                }
                self.pure(base, Pure::Base);
                self.pure(exponent, Pure::Exponent);
                Some(Unit::pure())
            }
            ExprKind::Call(name, items) => self.call(&name.to_string(), items),
            ExprKind::Vector(items) => self.common(items.iter(), "a vector"),
            ExprKind::ProductOver(binder, factor) => {
                self.indexed(Some(binder), |units| units.expr(factor))
            }
            ExprKind::SumOver(binder, term) => self.indexed(Some(binder), |units| units.expr(term)),
            ExprKind::Reaction(name, _, friction) => {
                let (model, base) = (self.model, plain(name));
                let mut limits = model.limits.iter();
                if let Some(limit) = limits.position(|own| plain(&own.name) == base && !friction) {
                    return self.push(limit);
                }
                if let Some(friction) = model.frictions.iter().find(|own| plain(own.name) == base) {
                    return self.grip(friction);
                }
                let same = |own: &&ast::Constraint| plain(&own.name) == base;
                let index = model.constraints.iter().position(same)?;
                self.reaction(index)
            }
            ExprKind::Integral { point, integrand, .. } => {
                let length = Dimension::whole([0, 1, 0, 0, 0]);
                let mass = Dimension::whole([1, 0, 0, 0, 0]);
                self.scope.push((plain(point), Some(Unit::of(length))));
                let found = self.expr(integrand);
                self.scope.pop();
                found.and_then(|unit| unit.times(&Unit::of(mass), Rational::ONE))
            }
        }
    }

    fn name(&mut self, text: &str) -> Found {
        let Name { base, dots } = name::read(text);
        let model = self.model;
        let found =
            if let Some((_, found)) = self.scope.iter().rev().find(|(name, _)| *name == base) {
                found.clone()
            } else {
                let (parameters, coordinates) = (model.parameters.len(), model.coordinates.len());
                match (base.as_str(), model.names.get(&base)) {
                    (_, Some(&Meaning::Parameter(index))) => {
                        Some(Self::quantity(index, &model.parameters[index]))
                    }
                    (_, Some(&Meaning::Coordinate(index))) => {
                        Some(Self::quantity(parameters + index, &model.coordinates[index]))
                    }
                    (_, Some(&Meaning::Input(index))) => {
                        Some(Self::quantity(parameters + coordinates + index, &model.inputs[index]))
                    }
                    (_, Some(&Meaning::Let(index))) => self.definition(index),
                    ("t", None) => Unit::pure().seconds(1),
                    _ => Some(Unit::pure()),
                }
            };
        found.and_then(|unit| unit.seconds(-i64::from(dots)))
    }

    /// Returns the unit of the value of a table, and reports an argument of another unit.
    fn tabulated(&mut self, index: u8, item: &Expr) -> Found {
        let model = self.model;
        let [argument, value] = model.tables[&index].dimensions;
        if let (Some(found), Some(expected)) = (self.expr(item), argument) {
            self.expect(item, &found, &Unit::of(expected), |found, expected| {
                let name = model.tables[&index].name;
                message!(
                    "`{}` is {found}, but the argument of `{name}` is {expected}; divide or \
                     multiply it",
                    text(item)
                )
            });
        }
        value.map(Unit::of)
    }

    fn call(&mut self, name: &str, items: &[Expr]) -> Found {
        let Name { base, dots } = name::read(name);
        if let Some(&Meaning::Let(index)) = self.model.names.get(&base)
            && self.model.lets[index].arguments.is_some()
        {
            let arguments = items.iter().map(|item| self.expr(item)).collect();
            let found = self.apply(index, arguments);
            return found.and_then(|unit| unit.seconds(-i64::from(dots)));
        }
        if let (Some(&Meaning::Table(index)), [item]) = (self.model.names.get(&base), items) {
            let found = self.tabulated(index, item);
            return found.and_then(|unit| unit.seconds(-i64::from(dots)));
        }
        let units = Word::named(name).map_or(UnitRule::Pure, |word| word.units);
        match (units, items) {
            (UnitRule::Same, [item]) => self.expr(item),
            (UnitRule::Root, [item]) => {
                self.expr(item).and_then(|unit| Unit::pure().times(&unit, Rational::HALF))
            }
            (UnitRule::Rate, [item]) => self.expr(item).and_then(|unit| unit.seconds(-1)),
            (UnitRule::Product, [a, b]) => {
                let (a, b) = (self.expr(a), self.expr(b));
                a.zip(b).and_then(|(a, b)| a.times(&b, Rational::ONE))
            }
            (UnitRule::Any, [item]) => {
                self.expr(item);
                Some(Unit::pure())
            }
            (UnitRule::Turn, [axis, angle]) => {
                self.expr(axis);
                self.pure(angle, Pure::Argument(name));
                Some(Unit::pure())
            }
            (UnitRule::Common, items) => self.common(items.iter(), &format!("`{name}`")),
            (UnitRule::Ratio, items) => {
                self.common(items.iter(), &format!("`{name}`"));
                Some(Unit::pure())
            }
            // A wrong number of arguments has been reported.
            (
                UnitRule::Pure
                | UnitRule::Same
                | UnitRule::Root
                | UnitRule::Rate
                | UnitRule::Product
                | UnitRule::Any
                | UnitRule::Turn,
                _,
            ) => {
                for item in items {
                    self.pure(item, Pure::Argument(name));
                }
                Some(Unit::pure())
            }
        }
    }
}
