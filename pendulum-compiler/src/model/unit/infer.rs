//! The units of a block: checked where they are written, and inferred from sums otherwise.
//!
//! Every quantity without a unit is an unknown. A unit is a known dimension times powers of
//! unknowns. Each sum, function argument and energy yields an equation that is linear in the
//! exponents. The first equation that contains no unknown and does not hold is reported.

mod differ;

use super::{Dimension, constant};
use crate::algebra::functions::{UnitRule, Word};
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::messages::{Errors, message};
use crate::model::resolved::{Friction, Meaning, Model, Quantity};
use crate::syntax::ast::{self, Binder, Expr, ExprKind, Role, Slip};
use crate::syntax::name::{self, Name, plain};
use crate::syntax::text::text;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The limit on the depth of nesting, which protects the compiler's stack. Every definition is also
/// checked separately.
const DEEPEST: usize = 200;

/// The inferred units, for documentation and editors.
#[derive(Debug, Default)]
pub(crate) struct RowUnits {
    /// For each constraint, its unit and that of its multiplier; empty if unknown.
    pub(crate) constraints: Vec<[String; 2]>,
    /// For each limit, its unit; empty if unknown.
    pub(crate) limits: Vec<String>,
    /// For each friction, the unit of its rate and that of its force; empty if unknown.
    pub(crate) frictions: Vec<[String; 2]>,
    /// For each definition without arguments, its dimension.
    pub(crate) definitions: Vec<Option<Dimension>>,
}

/// Checks a block without mistakes if any of its quantities has a unit. Returns the units of its
/// constraints, limits and frictions.
///
/// `velocities` are the constraints of velocities. The power of a multiplier λ is λ times the rate
/// of a position for other constraints, but λ times a velocity for these.
pub(crate) fn check(model: &Model, velocities: &BTreeSet<usize>, errors: &mut Errors) -> RowUnits {
    if !errors.is_empty() {
        return RowUnits::default();
    }
    let quantities = || model.parameters.iter().chain(&model.coordinates).chain(&model.inputs);
    let outputs = model.outputs.iter().map(|output| &output.declared);
    if quantities().chain(outputs).all(|quantity| quantity.unit.is_empty() && !quantity.is_body()) {
        let unknown = String::new;
        return RowUnits {
            constraints: vec![[unknown(), unknown()]; model.constraints.len()],
            limits: vec![unknown(); model.limits.len()],
            frictions: vec![[unknown(), unknown()]; model.frictions.len()],
            definitions: vec![None; model.lets.len()],
        };
    }
    let mut units = Units {
        model,
        errors,
        solved: BTreeMap::new(),
        scope: Vec::new(),
        lets: BTreeMap::new(),
        open: Vec::new(),
        depth: 0,
        unknowns: 0,
        energy: None,
        velocities,
        constraints: Vec::new(),
    };
    units.block();
    units.rows()
}

/// A known dimension times powers of unknowns.
#[derive(Clone, Debug, PartialEq)]
struct Unit {
    known: Dimension,
    unknown: BTreeMap<usize, Rational>,
}

impl Unit {
    fn of(known: Dimension) -> Self {
        Self { known, unknown: BTreeMap::new() }
    }

    fn pure() -> Self {
        Self::of(Dimension::PURE)
    }

    /// Returns `self` · `other`^`power`.
    fn times(&self, other: &Self, power: Rational) -> Option<Self> {
        let mut unknown = self.unknown.clone();
        for (&name, &exponent) in &other.unknown {
            let total =
                unknown.get(&name).copied().unwrap_or(Rational::ZERO).add(exponent.mul(power)?)?;
            if total.is_zero() {
                unknown.remove(&name);
            } else {
                unknown.insert(name, total);
            }
        }
        Some(Self { known: self.known.times(other.known, power)?, unknown })
    }
}

/// A place that requires a pure number.
#[derive(Clone, Copy, Debug)]
enum Pure<'a> {
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

/// The unit of an expression, or `None` if the unit is arbitrary or a mistake has been reported.
type Found = Option<Unit>;

struct Units<'m, 'a, 'e> {
    model: &'m Model<'a>,
    errors: &'e mut Errors,
    /// The solved unknowns, in terms of other unknowns.
    solved: BTreeMap<usize, Unit>,
    scope: Vec<(String, Found)>,
    lets: BTreeMap<usize, Found>,
    open: Vec<usize>,
    /// The number of expressions under evaluation.
    depth: usize,
    unknowns: usize,
    /// The unit of the energies; `constraints` contains the units of the constraints.
    energy: Found,
    constraints: Vec<Found>,
    /// The constraints of velocities.
    velocities: &'m BTreeSet<usize>,
}

impl Units<'_, '_, '_> {
    fn block(&mut self) {
        // The pattern has no `..`, so that every field of the model is considered here.
        let Model {
            parameters,
            coordinates,
            inputs,
            lets,
            of_outputs,
            energies,
            forces,
            constraints: _,
            limits: _,
            frictions: _,
            outputs: _,
            block: _,
            driven: _,
            names: _,
            unmentioned: _,
            unused: _,
        } = self.model;
        // There is an unknown for each quantity, with or without a unit.
        self.unknowns = parameters.len() + coordinates.len() + inputs.len();
        for index in 0..lets.len() {
            // Reactions occur in the definitions of outputs and require the units of energies.
            let late = of_outputs.contains(&index);
            if lets[index].arguments.is_none() && !late {
                self.definition(index);
            }
        }
        let mut energy: Option<(Unit, &Expr, &str)> = None;
        for &(role, expr) in energies {
            let Some(found) = self.expr(expr) else { continue };
            let found = match role {
                Role::Dissipation => {
                    found.times(&Unit::of(second()), Rational::ONE).unwrap_or(found)
                }
                _ => found,
            };
            let times = if role == Role::Dissipation { " times a second" } else { "" };
            match &energy {
                None => energy = Some((found, expr, times)),
                Some((expected, first, of_first)) => {
                    if !self.unify(&found, expected) {
                        self.differ(
                            [(&found, expr, times), (expected, first, of_first)],
                            "all energies of a block have one unit",
                        );
                    }
                }
            }
        }
        self.energy = energy.as_ref().map(|(unit, ..)| unit.clone());
        self.constraints();
        self.limits();
        self.frictions();
        for &index in of_outputs {
            if lets[index].arguments.is_none() {
                self.definition(index);
            }
        }
        self.outputs();
        let Some((energy, ..)) = energy else { return };
        for force in forces {
            let ast::Force { point: place, index, torque, expr } = force;
            let (point, found) =
                self.indexed(index.as_ref(), |units| (units.expr(place), units.expr(expr)));
            let expected = point.and_then(|point| energy.times(&point, Rational::MINUS_ONE));
            if let (Some(found), Some(expected)) = (found, expected)
                && !self.unify(&found, &expected)
            {
                let (found, expected) = (self.shown(&found), self.shown(&expected));
                let (own, name) = (text(expr), text(place));
                let message = if *torque {
                    message!("`{own}` is {found}, but a torque on `{name}` is {expected}")
                } else {
                    message!(
                        "`{own}` is {found}, but a force on `{name}` is {expected}, an energy per \
                         unit of `{name}`"
                    )
                };
                self.errors.once(expr.source, expr.range, message);
            }
        }
    }

    fn constraints(&mut self) {
        for constraint in &self.model.constraints {
            let found =
                self.sides(constraint.index.as_ref(), &constraint.difference, "a constraint");
            self.constraints.push(found);
        }
    }

    fn limits(&mut self) {
        for limit in &self.model.limits {
            self.sides(limit.index.as_ref(), &limit.difference, "a limit");
            self.indexed(limit.index.as_ref(), |units| {
                units.pure(&limit.restitution, Pure::Restitution);
            });
        }
    }

    fn frictions(&mut self) {
        for friction in &self.model.frictions {
            let Slip { rate, force, bound } = friction.slip;
            let grip = self.grip(friction);
            let reaction = friction.limit.map(|limit| self.push(limit));
            let expected = match reaction {
                None => grip,
                Some(reaction) => grip
                    .zip(reaction)
                    .and_then(|(grip, push)| grip.times(&push, Rational::MINUS_ONE)),
            };
            for own in [force].into_iter().chain(bound) {
                let found = self.indexed(friction.index, |units| units.expr(own));
                if let (Some(found), Some(expected)) = (found, &expected)
                    && !self.unify(&found, expected)
                {
                    let (found, expected) = (self.shown(&found), self.shown(expected));
                    let (wrong, rate) = (text(own), text(rate));
                    let message = if friction.limit.is_some() {
                        message!(
                            "`{wrong}` is {found}, but a coefficient of friction along `{rate}` \
                             is {expected}"
                        )
                    } else {
                        message!(
                            "`{wrong}` is {found}, but a friction on `{rate}` is {expected}, a \
                             power per unit of `{rate}`"
                        )
                    };
                    self.errors.once(own.source, own.range, message);
                }
            }
        }
    }

    /// Returns the unit of the force of a friction: power per unit of its rate.
    fn grip(&mut self, friction: &Friction) -> Found {
        let rate = self.indexed(friction.index, |units| units.expr(&friction.slip.rate))?;
        let rate = rate.times(&Unit::of(second()), Rational::ONE)?;
        self.energy.as_ref()?.times(&rate, Rational::MINUS_ONE)
    }

    /// Returns the unit of the reaction of a limit: energy per unit of its gap.
    fn push(&mut self, limit: usize) -> Found {
        let limit = self.model.limits[limit];
        let gap = self.sides(limit.index.as_ref(), &limit.difference, "a limit")?;
        self.energy.as_ref()?.times(&gap, Rational::MINUS_ONE)
    }

    /// Returns the common unit of the two sides of a constraint or a limit.
    fn sides(&mut self, index: Option<&Binder>, difference: &Expr, whole: &str) -> Found {
        self.indexed(index, |units| units.common(difference.sides().into_iter(), whole))
    }

    /// Returns what `find` returns with the index of a family or a sum in scope.
    fn indexed<R>(&mut self, index: Option<&Binder>, find: impl FnOnce(&mut Self) -> R) -> R {
        let depth = self.scope.len();
        if let Some(binder) = index {
            self.scope.push((plain(&binder.name), Some(Unit::pure())));
        }
        let found = find(self);
        self.scope.truncate(depth);
        found
    }

    /// Returns the unit of the multiplier of a constraint: energy per unit of a position, or power
    /// per unit of a velocity.
    fn reaction(&self, constraint: usize) -> Found {
        let own = self.constraints.get(constraint)?.clone()?;
        let unit = self.energy.as_ref()?.times(&own, Rational::MINUS_ONE)?;
        if self.velocities.contains(&constraint) {
            unit.times(&Unit::of(second()), Rational::MINUS_ONE)
        } else {
            Some(unit)
        }
    }

    /// Returns the units of constraints, limits and frictions, as far as they are known.
    fn rows(&mut self) -> RowUnits {
        let shown = |units: &Self, found: &Found| {
            let unit = units.resolved(found.as_ref()?);
            if !unit.unknown.is_empty() {
                return None;
            }
            let pure = unit.known == Dimension::PURE;
            Some(if pure { "1".to_owned() } else { unit.known.to_string() })
        };
        let constraints = self.constraints.iter().enumerate().map(|(index, own)| {
            let reaction = self.reaction(index);
            [shown(self, own), shown(self, &reaction)].map(Option::unwrap_or_default)
        });
        let constraints = constraints.collect();
        let limits: Vec<_> = self
            .model
            .limits
            .iter()
            .map(|limit| {
                let found = self.sides(limit.index.as_ref(), &limit.difference, "a limit");
                shown(self, &found).unwrap_or_default()
            })
            .collect();
        let frictions = self.model.frictions.iter().map(|friction| {
            let rate = self.indexed(friction.index, |units| units.expr(&friction.slip.rate));
            let force = self.grip(friction);
            [shown(self, &rate), shown(self, &force)].map(Option::unwrap_or_default)
        });
        let frictions = frictions.collect();
        let definitions = (0..self.model.lets.len()).map(|index| {
            let unit = self.resolved(self.lets.get(&index)?.as_ref()?);
            unit.unknown.is_empty().then_some(unit.known)
        });
        let definitions = definitions.collect();
        RowUnits { constraints, limits, frictions, definitions }
    }

    fn outputs(&mut self) {
        for output in &self.model.outputs {
            let expr = &output.statement.expr;
            let found = self.indexed(output.statement.index.as_ref(), |units| units.expr(expr));
            if let (Some(found), Some(declared)) = (found, output.declared.dimension)
                && !self.unify(&found, &Unit::of(declared))
            {
                let (own, found) = (text(expr), self.shown(&found));
                let Quantity { name, unit, .. } = &output.declared;
                let message = message!("`{own}` is {found}, but `{name}` is declared in {unit}");
                self.errors.once(expr.source, expr.range, message);
            }
        }
    }

    fn definition(&mut self, index: usize) -> Found {
        if let Some(found) = self.lets.get(&index) {
            return found.clone();
        }
        // Half of the depth is reserved for the definition, whose unit is stored.
        if self.open.contains(&index) || DEEPEST / 2 <= self.depth {
            return None;
        }
        self.open.push(index);
        let definition = self.model.lets[index];
        let scope = std::mem::take(&mut self.scope);
        let found = self.indexed(definition.index.as_ref(), |units| units.expr(&definition.expr));
        self.scope = scope;
        self.open.pop();
        self.lets.insert(index, found.clone());
        found
    }

    fn apply(&mut self, index: usize, arguments: Vec<Found>) -> Found {
        if self.open.contains(&index) {
            return None;
        }
        self.open.push(index);
        let definition = self.model.lets[index];
        let names = definition.arguments.iter().flatten().map(plain);
        let scope = std::mem::replace(&mut self.scope, names.zip(arguments).collect());
        let found = self.expr(&definition.expr);
        self.scope = scope;
        self.open.pop();
        found
    }

    fn quantity(unknown: usize, quantity: &Quantity) -> Unit {
        match quantity.dimension {
            Some(known) => Unit::of(known),
            None => {
                Unit { known: Dimension::PURE, unknown: BTreeMap::from([(unknown, Rational::ONE)]) }
            }
        }
    }

    /// Returns a unit with every solved unknown replaced.
    fn resolved(&self, unit: &Unit) -> Unit {
        let mut result = Unit::of(unit.known);
        for (&name, &exponent) in &unit.unknown {
            let part = match self.solved.get(&name) {
                Some(solution) => self.resolved(solution),
                None => Unit {
                    known: Dimension::PURE,
                    unknown: BTreeMap::from([(name, Rational::ONE)]),
                },
            };
            result = result.times(&part, exponent).unwrap_or(result);
        }
        result
    }

    /// Makes two units equal by solving for an unknown if necessary. Returns `false` if they cannot
    /// be equal.
    fn unify(&mut self, a: &Unit, b: &Unit) -> bool {
        let Some(quotient) = a.times(b, Rational::MINUS_ONE) else { return true };
        let mut rest = self.resolved(&quotient);
        let Some((name, exponent)) = rest.unknown.pop_last() else {
            return rest.known == Dimension::PURE;
        };
        // The equation is name^exponent · rest = 1.
        if let Some(solution) =
            exponent.reciprocal().and_then(|power| Unit::pure().times(&rest, power.negative()))
        {
            self.solved.insert(name, solution);
        }
        true
    }

    fn shown(&self, unit: &Unit) -> String {
        let resolved = self.resolved(unit);
        if resolved.unknown.is_empty() {
            return resolved.known.to_string();
        }
        let quantities =
            self.model.parameters.iter().chain(&self.model.coordinates).chain(&self.model.inputs);
        let names: Vec<String> = quantities.map(|quantity| quantity.name.to_string()).collect();
        let unknown: Vec<String> = resolved
            .unknown
            .keys()
            .map(|&index| format!("the unit of `{}`", names[index]))
            .collect();
        format!("{} times {}", resolved.known, unknown.join(" and "))
    }

    /// Reports a unit that is not that of a pure number.
    fn pure(&mut self, expr: &Expr, place: Pure) {
        if let Some(unit) = self.expr(expr)
            && !self.unify(&unit, &Unit::pure())
        {
            let (found, unit) = (text(expr), self.shown(&unit));
            let instead = match (unit.as_str(), place) {
                ("s", Pure::Argument("sin" | "cos" | "tan" | "cis" | "sinc")) => {
                    "multiply it by an angular frequency, such as a parameter `omega: rad/s`"
                        .to_owned()
                }
                ("s", _) => "divide it by a time, such as a parameter `tau: s`".to_owned(),
                ("m", _) => "divide it by a length, such as a parameter `a: m`".to_owned(),
                _ => format!("divide it by a quantity in {unit}"),
            };
            let message = message!("`{found}` is {unit}, but {place} is a pure number; {instead}");
            self.errors.once(expr.source, expr.range, message);
        }
    }

    /// Returns the common unit of several expressions, and reports the first that differs.
    fn common<'x>(&mut self, items: impl Iterator<Item = &'x Expr>, whole: &str) -> Found {
        let mut common: Option<(Unit, &Expr)> = None;
        for item in items {
            let Some(found) = self.expr(item) else { continue };
            match &common {
                None => common = Some((found, item)),
                Some((expected, first)) => {
                    if !self.unify(&found, expected) {
                        let rule = format!("{whole} needs one unit");
                        self.differ([(&found, item, ""), (expected, first, "")], &rule);
                        return None;
                    }
                }
            }
        }
        common.map(|(unit, _)| unit)
    }

    fn expr(&mut self, expr: &Expr) -> Found {
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
            ExprKind::Component(inner, component) if self.body(inner) => {
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

    /// Returns `true` if an expression is the name of a body.
    fn body(&self, expr: &Expr) -> bool {
        let ExprKind::Name(ident) = &expr.kind else { return false };
        match self.model.names.get(&plain(ident)) {
            Some(&Meaning::Parameter(index)) => self.model.parameters[index].is_body(),
            _ => false,
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
                    ("t", None) => Some(Unit::of(second())),
                    _ => Some(Unit::pure()),
                }
            };
        found.and_then(|unit| unit.times(&Unit::of(second()), Rational::whole(-i64::from(dots))))
    }

    fn call(&mut self, name: &str, items: &[Expr]) -> Found {
        let Name { base, dots } = name::read(name);
        if let Some(&Meaning::Let(index)) = self.model.names.get(&base)
            && self.model.lets[index].arguments.is_some()
        {
            let arguments = items.iter().map(|item| self.expr(item)).collect();
            let found = self.apply(index, arguments);
            return found.and_then(|unit| {
                unit.times(&Unit::of(second()), Rational::whole(-i64::from(dots)))
            });
        }
        let units = Word::named(name).map_or(UnitRule::Pure, |word| word.units);
        match (units, items) {
            (UnitRule::Same, [item]) => self.expr(item),
            (UnitRule::Root, [item]) => {
                self.expr(item).and_then(|unit| Unit::pure().times(&unit, Rational::HALF))
            }
            (UnitRule::Rate, [item]) => self
                .expr(item)
                .and_then(|unit| unit.times(&Unit::of(second()), Rational::MINUS_ONE)),
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

fn second() -> Dimension {
    Dimension::whole([0, 0, 1, 0, 0])
}
