//! The units of a block: checked where they are written, and inferred from sums otherwise.
//!
//! Every quantity without a unit is an unknown. A unit is a known dimension times powers of
//! unknowns. Each sum, function argument and energy yields an equation that is linear in the
//! exponents. The first equation that contains no unknown and does not hold is reported.

mod differ;
mod expression;

use crate::algebra::dimension::Dimension;
use crate::algebra::number::Rational;
use crate::messages::{Errors, Text, message};
use crate::model::resolved::{Friction, Model, Quantity};
use crate::syntax::ast::{self, Binder, Expr, Role, Slip};
use crate::syntax::name::plain;
use crate::syntax::text::text;
use expression::Pure;
use std::collections::{BTreeMap, BTreeSet};

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
    /// For each parameter, its dimension.
    pub(crate) parameters: Vec<Option<Dimension>>,
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
            parameters: vec![None; model.parameters.len()],
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

    /// Returns the unit times a power of the second.
    fn seconds(&self, power: i64) -> Found {
        self.times(&Self::of(Dimension::whole([0, 0, 1, 0, 0])), Rational::whole(power))
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
            mechanical: _,
            inputs,
            lets,
            of_outputs,
            energies,
            forces,
            rates,
            constraints: _,
            limits: _,
            frictions: _,
            outputs: _,
            block: _,
            driven: _,
            names: _,
            tables: _,
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
                Role::Dissipation => found.seconds(1).unwrap_or(found),
                _ => found,
            };
            let times = if role == Role::Dissipation { " times a second" } else { "" };
            let Some((expected, first, of_first)) = &energy else {
                energy = Some((found, expr, times));
                continue;
            };
            if !self.unify(&found, expected) {
                self.differ(
                    [(&found, expr, times), (expected, first, of_first)],
                    "all energies of a block have one unit",
                );
            }
        }
        self.energy = energy.as_ref().map(|(unit, ..)| unit.clone());
        for own in rates {
            self.rate(own);
        }
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
            if let (Some(found), Some(expected)) = (found, expected) {
                self.expect(expr, &found, &expected, |found, expected| {
                    let (own, name) = (text(expr), text(place));
                    if *torque {
                        message!("`{own}` is {found}, but a torque on `{name}` is {expected}")
                    } else {
                        message!(
                            "`{own}` is {found}, but a force on `{name}` is {expected}, an energy \
                             per unit of `{name}`"
                        )
                    }
                });
            }
        }
    }

    /// Checks the rate of a state: the unit of the state per second.
    fn rate(&mut self, rate: &ast::Force) {
        let ast::Force { point: state, index, expr, .. } = rate;
        let (own, found) =
            self.indexed(index.as_ref(), |units| (units.expr(state), units.expr(expr)));
        if let (Some(found), Some(expected)) = (found, own.and_then(|own| own.seconds(-1))) {
            self.expect(expr, &found, &expected, |found, expected| {
                message!(
                    "`{}` is {found}, but the rate of `{}` is {expected}",
                    text(expr),
                    text(state)
                )
            });
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
            self.gap(limit);
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
                let (Some(found), Some(expected)) = (found, &expected) else { continue };
                self.expect(own, &found, expected, |found, expected| {
                    let (wrong, rate) = (text(own), text(rate));
                    if friction.limit.is_some() {
                        message!(
                            "`{wrong}` is {found}, but a coefficient of friction along `{rate}` \
                             is {expected}"
                        )
                    } else {
                        message!(
                            "`{wrong}` is {found}, but a friction on `{rate}` is {expected}, a \
                             power per unit of `{rate}`"
                        )
                    }
                });
            }
        }
    }

    /// Returns the unit of the force of a friction: power per unit of its rate.
    fn grip(&mut self, friction: &Friction) -> Found {
        let rate = self.indexed(friction.index, |units| units.expr(&friction.slip.rate))?;
        self.energy.as_ref()?.times(&rate.seconds(1)?, Rational::MINUS_ONE)
    }

    /// Returns the unit of the reaction of a limit: energy per unit of its gap.
    fn push(&mut self, limit: usize) -> Found {
        let gap = self.gap(self.model.limits[limit])?;
        self.energy.as_ref()?.times(&gap, Rational::MINUS_ONE)
    }

    fn gap(&mut self, limit: &ast::Limit) -> Found {
        self.sides(limit.index.as_ref(), &limit.difference, "a limit")
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
        if self.velocities.contains(&constraint) { unit.seconds(-1) } else { Some(unit) }
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
        let limits = self.model.limits.iter().map(|limit| {
            let gap = self.gap(limit);
            shown(self, &gap).unwrap_or_default()
        });
        let limits = limits.collect();
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
        let parameters = self.model.parameters.iter().enumerate().map(|(index, own)| {
            let unit = self.resolved(&Self::quantity(index, own));
            unit.unknown.is_empty().then_some(unit.known)
        });
        let parameters = parameters.collect();
        RowUnits { constraints, limits, frictions, definitions, parameters }
    }

    fn outputs(&mut self) {
        for output in &self.model.outputs {
            let expr = &output.statement.expr;
            let found = self.indexed(output.statement.index.as_ref(), |units| units.expr(expr));
            let Quantity { name, unit, .. } = &output.declared;
            if let (Some(found), Some(declared)) = (found, output.declared.dimension) {
                self.expect(expr, &found, &Unit::of(declared), |found, _| {
                    let own = text(expr);
                    message!("`{own}` is {found}, but `{name}` is declared in {unit}")
                });
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

    /// Makes the unit of an expression the expected one, or reports both. Returns `false` then.
    fn expect(
        &mut self,
        expr: &Expr,
        found: &Unit,
        expected: &Unit,
        message: impl FnOnce(String, String) -> Text,
    ) -> bool {
        let fits = self.unify(found, expected);
        if !fits {
            let message = message(self.shown(found), self.shown(expected));
            self.errors.once(expr.source, expr.range, message);
        }
        fits
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
}
