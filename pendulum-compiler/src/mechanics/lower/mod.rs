//! Lowering of vectors, complex numbers and families to scalars: every expression of a block
//! becomes nodes of one graph.
//!
//! A plane vector is a complex number. `Value::Bad` represents an expression that has been
//! reported, so that each mistake results in one message.

mod arithmetic;
mod body;
pub(crate) mod constant;
mod constraint;
mod context;
mod energies;
mod force;
mod friction;
mod matrix;
mod output;
mod positions;
mod product;
mod rate;
mod rotation;
mod row;
mod state;
mod term;
mod turn;
mod value;

use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::REAL;
use crate::mechanics::attitude;
use crate::mechanics::derivation::named_input;
use crate::messages::{Errors, message};
use crate::model::Model;
use crate::syntax::ast::{Expr, ExprKind, Role};
use context::Lower;
pub(crate) use energies::{Energies, Extended, Frame};
pub(crate) use friction::Friction;
pub(crate) use output::Output;
use positions::PositionTracker;
pub(crate) use rate::{
    at_rest, at_rest_controls, chain, explicit_rate, second_derivative, total_derivative,
};
pub(crate) use row::Row;
use std::collections::{BTreeMap, BTreeSet};

/// Lowers all energies of a block.
pub(crate) fn energies(model: &Model, graph: &mut Graph, errors: &mut Errors) -> Energies {
    let mut energies = lower(model, graph, errors, None).0;
    // The sparse form has no rates of bodies.
    if errors.is_empty()
        && 1 < energies.forces.len()
        && !model.lets.is_empty()
        && attitude::rotations(model).is_empty()
        && model.mechanical == model.coordinates.len()
    {
        let holonomic = energies.velocity_constraints(graph).is_empty();
        energies.extended = extended(model, graph, holonomic, errors);
    }
    energies
}

/// Lowers a block again, with the velocities of its positions as unknowns.
///
/// Constraints are lowered in terms of positions only if all of them are `holonomic`, because the
/// rates of positions are not expressions.
fn extended(
    model: &Model,
    graph: &mut Graph,
    holonomic: bool,
    errors: &mut Errors,
) -> Option<Extended> {
    let tracker =
        |framed| Some(PositionTracker { constrained: holonomic, framed, ..Default::default() });
    let (mut energies, mut positions) = lower(model, graph, errors, tracker(true));
    let frames = positions.iter().flat_map(|own| own.frames.iter().flat_map(|own| own.entries));
    let frames: Vec<Id> = frames.collect();
    let entry = |symbol: &Symbol| matches!(symbol, Symbol::Entry(..));
    if !frames.is_empty() && !graph.symbols(&frames).iter().any(entry) {
        // The rates of a rotation that carries no other would be unknowns in vain.
        (energies, positions) = lower(model, graph, errors, tracker(false));
    }
    let PositionTracker { scalars, positions, frames, forces, .. } = positions?;
    let constraints = energies.constraints.iter();
    let held = constraints.filter(|row| !model.constraints[row.statement].redundant);
    let constraints = holonomic.then(|| held.map(|row| row.value).collect());
    let lagrangian = match energies.lagrangian {
        Some(lagrangian) => lagrangian,
        None => {
            graph.sub(energies.kinetic.unwrap_or_default(), energies.potential.unwrap_or_default())
        }
    };
    let dissipation = energies.dissipation.unwrap_or_default();
    Some(Extended {
        lagrangian,
        kinetic: energies.kinetic,
        dissipation,
        forces,
        frames,
        positions,
        scalars,
        constraints,
    })
}

/// Lowers all energies of a block, and records its positions if `positions` is given.
fn lower(
    model: &Model,
    graph: &mut Graph,
    errors: &mut Errors,
    positions: Option<PositionTracker>,
) -> (Energies, Option<PositionTracker>) {
    let mut lower = Lower {
        model,
        graph,
        errors,
        scope: Vec::new(),
        instances: BTreeMap::new(),
        open: Vec::new(),
        indexed: BTreeSet::new(),
        whole: BTreeSet::new(),
        work: 0,
        depth: 0,
        integrals: 0,
        positions,
        constants: BTreeMap::new(),
        accelerations: false,
        constrained: false,
        known: None,
        rates: BTreeMap::new(),
        rated: BTreeMap::new(),
        shapes: Vec::new(),
        contacts: Vec::new(),
        frictions: Vec::new(),
        loads: Vec::new(),
    };
    let energies = lower.block();
    (energies, lower.positions)
}

impl Lower<'_, '_, '_, '_> {
    fn block(&mut self) -> Energies {
        // The pattern has no `..`, so that every field of the model is considered here.
        let Model {
            parameters,
            lets,
            of_outputs,
            energies: contributions,
            forces: _,
            rates: _,
            constraints: _,
            limits: _,
            frictions: _,
            outputs: _,
            block: _,
            coordinates: _,
            mechanical: _,
            inputs: _,
            driven: _,
            names: _,
            tables: _,
            unmentioned: _,
            unused: _,
        } = self.model;
        let mut energies = Energies::default();
        for quantity in parameters {
            let default = quantity.default_items().map(|item| match item.kind {
                // A vector in place of a number has been reported.
                ExprKind::Vector(_) => None,
                _ => self.scalar(item),
            });
            energies.defaults.push(default.collect::<Option<_>>().unwrap_or_default());
        }
        self.find_rates();
        for (index, definition) in lets.iter().enumerate() {
            if definition.arguments.is_some() || of_outputs.contains(&index) {
                continue;
            }
            let (index_of_family, range) = (definition.index.as_ref(), definition.expr.range);
            self.each(index_of_family, |lower, k| _ = lower.definition(index, k, range));
        }
        self.lower_rates();
        for &(role, expr) in contributions {
            let Some(value) = self.outcome(expr) else { continue };
            if role != Role::Dissipation && self.has_enclosed_control(expr, value) {
                continue;
            }
            let slot = match role {
                Role::Kinetic => &mut energies.kinetic,
                Role::Potential => &mut energies.potential,
                Role::Lagrangian => &mut energies.lagrangian,
                Role::Dissipation => &mut energies.dissipation,
            };
            *slot = Some(match *slot {
                Some(sum) => self.graph.add(sum, value),
                None => value,
            });
        }
        let forces = self.forces();
        let force = |place| forces.get(&Symbol::Velocity(place)).copied().unwrap_or_default();
        energies.forces = (0..self.model.freedoms()).map(force).collect();
        if let Some(tracker) = &mut self.positions {
            tracker.forces = forces;
        }
        if self.positions.is_none() {
            energies.constraints = self.constraints();
            energies.limits = self.limits();
            energies.frictions = self.frictions(&energies.limits);
            energies.loads = std::mem::take(&mut self.loads);
            energies.outputs = self.outputs();
            energies.lengths = (0..lets.len()).map(|index| self.lengths(index)).collect();
        } else if self.positions.as_ref().is_some_and(|positions| positions.constrained) {
            self.known = Some(std::mem::take(&mut self.instances));
            energies.constraints = self.constraints();
        }
        energies.rates = std::mem::take(&mut self.rates);
        energies.families = self.indexed.difference(&self.whole).copied().collect();
        energies
    }

    /// Returns the lengths of a definition's value, as far as it has been lowered.
    fn lengths(&self, index: usize) -> Vec<usize> {
        let mut instances =
            self.instances.range((index, None)..=(index, Some(i64::MAX))).map(|(_, value)| value);
        let Some(first) = instances.next() else { return Vec::new() };
        let family = self.model.lets[index].index.as_ref().map(|_| 1 + instances.count());
        family.into_iter().chain(first.lengths()).collect()
    }

    /// Reports an energy that contains a control input outside of products and positive integer
    /// powers. The forces exerted by an input are measured relative to its value zero.
    fn has_enclosed_control(&mut self, expr: &Expr, value: Id) -> bool {
        let controlled = |id: Id| self.graph.dependencies(id).any(Dependencies::CONTROL);
        let enclosed = |&id: &Id| match self.graph.node(id) {
            Node::Product(_, factors) => factors.iter().find_map(|&(base, exponent)| {
                let whole = exponent.integer().is_some_and(|exponent| 0 < exponent);
                (!whole && controlled(base)).then_some(base)
            }),
            Node::Call(function, argument) => {
                (function.row().domain != REAL && controlled(*argument)).then_some(*argument)
            }
            Node::Atan2(..) => controlled(id).then_some(id),
            _ => None,
        };
        let Some(inner) = self.graph.reachable(&[value]).iter().find_map(enclosed) else {
            return false;
        };
        let Some(input) = named_input(self.model, self.graph, &[inner], None) else { return false };
        let message = message!(
            "the control input `{input}` stands in a divisor, a power or a function of an energy, \
             which may be no number where the input is zero; write what it does as a `force`"
        );
        self.errors.once(expr.source, expr.range, message);
        true
    }

    /// Returns an energy, unless it is too long.
    fn outcome(&mut self, expr: &Expr) -> Option<Id> {
        let value = self.scalar(expr)?;
        self.within_bounds(expr, value).then_some(value)
    }
}
