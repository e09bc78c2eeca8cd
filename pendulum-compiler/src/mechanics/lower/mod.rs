//! Vectors, complex numbers and families to scalars: every expression of a block becomes nodes of
//! one graph.
//!
//! A plane vector is a complex number; `Value::Bad` stands for what has been reported, so that one
//! mistake gives one message.

mod body;
pub(crate) mod constant;
mod constraint;
mod output;
mod term;
mod value;

use crate::algebra::diff;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::REAL;
use crate::algebra::number::Rational;
use crate::messages::{Errors, Range, lower as messages};
use crate::model::{self, Model};
use crate::syntax::ast::{Binder, Expr, ForceIndex, Role};
use crate::syntax::name;
use crate::syntax::text::text;
pub(crate) use constraint::Row;
pub(crate) use output::Output;
use std::collections::{BTreeMap, BTreeSet};
use value::Value;

/// More evaluations, or operands in all expressions together, are refused: sums within sums would
/// never end.
const LIMIT: usize = 2_000_000;

/// Expressions and definitions within one another beyond this are refused: they would overflow the
/// compiler's stack.
const DEEPEST: usize = 1000;

/// The same for the nodes of an energy or a force, which definitions above one another nest as
/// well.
const DEEPEST_NODE: usize = 1200;

/// An energy or a force of more nodes is refused: its equations would take minutes to derive and to
/// compile.
const LARGEST: usize = 8000;

/// The scalars of a block.
#[derive(Debug, Default)]
pub(crate) struct Energies {
    pub(crate) kinetic: Option<Id>,
    pub(crate) potential: Option<Id>,
    pub(crate) lagrangian: Option<Id>,
    pub(crate) dissipation: Option<Id>,
    /// One generalized force for each coordinate.
    pub(crate) forces: Vec<Id>,
    /// The default of each parameter that has one.
    pub(crate) defaults: Vec<Option<Id>>,
    /// The parameters of two or three components that are used by their indices alone: families,
    /// not vectors.
    pub(crate) families: BTreeSet<usize>,
    pub(crate) outputs: Vec<Output>,
    /// The scalar constraints that are solved, and after them the redundant ones.
    pub(crate) constraints: Vec<Row>,
    /// The scalar limits.
    pub(crate) limits: Vec<Row>,
    /// The same with the velocities of positions as symbols of their own; `None` where no position
    /// is written with `let`.
    pub(crate) extended: Option<Extended>,
}

/// The energies of a block in which the velocities of `let` positions stand as symbols of their
/// own.
#[derive(Debug, Default)]
pub(crate) struct Extended {
    pub(crate) lagrangian: Id,
    pub(crate) kinetic: Option<Id>,
    pub(crate) dissipation: Id,
    pub(crate) forces: Vec<Id>,
    /// The scalars of each position.
    pub(crate) positions: Vec<Vec<usize>>,
    /// The value of each scalar.
    pub(crate) scalars: Vec<Id>,
    /// The holonomic constraints that are solved, in terms of positions where those stand in them;
    /// none if there is one of velocities.
    pub(crate) constraints: Option<Vec<Id>>,
}

impl Energies {
    /// The constraints that hold velocities, by the indices of their statements.
    pub(crate) fn velocity_constraints(&self, graph: &Graph) -> BTreeSet<usize> {
        let velocity = |row: &&Row| graph.dependencies(row.value).any(Dependencies::VELOCITY);
        self.constraints.iter().filter(velocity).map(|row| row.statement).collect()
    }

    /// Every expression in it.
    pub(crate) fn roots(&mut self) -> Vec<&mut Id> {
        let single =
            [&mut self.kinetic, &mut self.potential, &mut self.lagrangian, &mut self.dissipation];
        let single = single.into_iter().flatten();
        let extended = self.extended.iter_mut().flat_map(|extended| {
            let single = [&mut extended.lagrangian, &mut extended.dissipation]
                .into_iter()
                .chain(extended.kinetic.as_mut());
            let constraints = extended.constraints.iter_mut().flatten();
            single.chain(&mut extended.forces).chain(&mut extended.scalars).chain(constraints)
        });
        let rows = self.constraints.iter_mut().chain(&mut self.limits);
        let rows = rows.flat_map(|row| [&mut row.value, &mut row.restitution]);
        single
            .chain(&mut self.forces)
            .chain(self.defaults.iter_mut().flatten())
            .chain(
                self.outputs
                    .iter_mut()
                    .flat_map(|output| output.scalars.iter_mut().chain(&mut output.open)),
            )
            .chain(rows)
            .chain(extended)
            .collect()
    }
}

/// Lowers all energies of a block.
pub(crate) fn energies(model: &Model, graph: &mut Graph, errors: &mut Errors) -> Energies {
    let mut energies = lower(model, graph, errors, None).0;
    if errors.is_empty() && 1 < energies.forces.len() && !model.lets.is_empty() {
        let holonomic = energies.velocity_constraints(graph).is_empty();
        energies.extended = extended(model, graph, holonomic, errors);
    }
    energies
}

/// Lowers a block once more, with the velocities of its positions as unknowns.
///
/// Constraints are lowered in terms of positions, whose rates are no expressions: only where all
/// are `holonomic`.
fn extended(
    model: &Model,
    graph: &mut Graph,
    holonomic: bool,
    errors: &mut Errors,
) -> Option<Extended> {
    let (energies, positions) = lower(
        model,
        graph,
        errors,
        Some(PositionTracker { constrained: holonomic, ..PositionTracker::default() }),
    );
    let PositionTracker { scalars, positions, .. } = positions?;
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
        forces: energies.forces,
        positions,
        scalars,
        constraints,
    })
}

/// The positions written with `let` that have been met.
#[derive(Debug, Default)]
struct PositionTracker {
    scalars: Vec<Id>,
    positions: Vec<Vec<usize>>,
    places: BTreeMap<Id, usize>,
    /// Constraints are told in terms of them.
    constrained: bool,
}

impl PositionTracker {
    /// Notes the scalars of a value that move with the coordinates.
    fn note(&mut self, graph: &Graph, value: &Value) {
        if let Value::Family(members) = value {
            return members.iter().for_each(|member| self.note(graph, member));
        }
        let parts = value.scalars();
        if parts.is_empty() {
            return;
        }
        let other = Dependencies::VELOCITY
            .or(Dependencies::AUXILIARY)
            .or(Dependencies::POINT)
            .or(Dependencies::ACCELERATION_INPUT);
        let other = other.or(Dependencies::VELOCITY_INPUT);
        let position = |id: &Id| {
            graph.dependencies(*id).any(Dependencies::COORDINATE)
                && !graph.dependencies(*id).any(other)
        };
        if !parts.iter().all(position) || parts.iter().any(|id| self.places.contains_key(id)) {
            return;
        }
        let first = self.scalars.len();
        for (offset, &id) in parts.iter().enumerate() {
            self.places.insert(id, first + offset);
        }
        self.scalars.extend(parts);
        self.positions.push((first..self.scalars.len()).collect());
    }
}

/// Lowers all energies of a block, and notes its positions if that is wanted.
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
        shapes: Vec::new(),
    };
    let energies = lower.block();
    (energies, lower.positions)
}

/// dx/dt along any motion, by the chain rule through coordinates, driven inputs and time.
pub(crate) fn total_derivative(graph: &mut Graph, id: Id) -> Id {
    let mut terms = Vec::new();
    for symbol in graph.symbols(&[id]) {
        let rate = match symbol {
            Symbol::Time => Graph::ONE,
            Symbol::Coordinate(index) => graph.symbol(Symbol::Velocity(index)),
            Symbol::Input { input, component, order } if order < 2 => {
                graph.symbol(Symbol::Input { input, component, order: order + 1 })
            }
            _ => continue,
        };
        let partial = diff::derivative(graph, id, symbol);
        terms.push((graph.mul(partial, rate), Rational::ONE));
    }
    graph.sum(&terms)
}

/// dx/dt along the motion itself, where velocities have derivatives.
fn second_derivative(graph: &mut Graph, id: Id) -> Id {
    let mut terms = vec![(total_derivative(graph, id), Rational::ONE)];
    for symbol in graph.symbols(&[id]) {
        if let Symbol::Velocity(index) = symbol {
            let partial = diff::derivative(graph, id, symbol);
            let acceleration = graph.symbol(Symbol::Acceleration(index));
            terms.push((graph.mul(partial, acceleration), Rational::ONE));
        }
    }
    graph.sum(&terms)
}

/// The meaning of a name that holds in one expression.
enum Local {
    /// An argument of a function or a point of integration.
    Value(Value),
    /// An index, and the source of the end of its range.
    Index { value: i64, source: usize },
}

struct Lower<'m, 'a, 'g, 'e> {
    model: &'m Model<'a>,
    graph: &'g mut Graph,
    errors: &'e mut Errors,
    /// The indices, arguments and points that are bound, the inner ones last.
    scope: Vec<(String, Local)>,
    /// The definitions that are done, by their index.
    instances: BTreeMap<(usize, Option<i64>), Value>,
    /// The definitions that are being evaluated.
    open: Vec<(usize, Option<i64>)>,
    /// The parameters that are used by their indices, and those that are used whole.
    indexed: BTreeSet<usize>,
    whole: BTreeSet<usize>,
    work: usize,
    /// The number of expressions that are being evaluated.
    depth: usize,
    /// The number of integrals that are open.
    integrals: usize,
    /// The positions whose velocities become symbols.
    positions: Option<PositionTracker>,
    /// The values of expressions without symbols.
    constants: BTreeMap<Id, f64>,
    /// True if velocities have derivatives: in outputs.
    accelerations: bool,
    /// True in a constraint or a limit.
    constrained: bool,
    /// The definitions whose positions stand for themselves from now on.
    known: Option<BTreeMap<(usize, Option<i64>), Value>>,
    /// The shapes of the constraints.
    shapes: Vec<constraint::Shape>,
}

impl Lower<'_, '_, '_, '_> {
    fn block(&mut self) -> Energies {
        let mut energies = Energies::default();
        for quantity in &self.model.parameters {
            let default = quantity
                .default
                .filter(|_| quantity.length.is_none())
                .and_then(|default| self.scalar(default));
            energies.defaults.push(default);
        }
        for (index, definition) in self.model.lets.iter().enumerate() {
            if definition.arguments.is_some() || self.model.of_outputs.contains(&index) {
                continue;
            }
            match &definition.index {
                None => {
                    self.definition(index, None, definition.expr.range);
                }
                Some(binder) => {
                    for k in self.range(binder) {
                        self.definition(index, Some(k), definition.expr.range);
                    }
                }
            }
        }
        for &(role, expr) in &self.model.energies {
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
        self.forces(&mut energies);
        if self.positions.is_none() {
            energies.constraints = self.constraints();
            energies.limits = self.limits();
            energies.outputs = self.outputs();
        } else if self.positions.as_ref().is_some_and(|positions| positions.constrained) {
            self.known = Some(std::mem::take(&mut self.instances));
            energies.constraints = self.constraints();
        }
        energies.families = self.indexed.difference(&self.whole).copied().collect();
        energies
    }

    /// Reports an energy in which a control input stands elsewhere than in products and whole
    /// powers: forces that it exerts count from its value zero on.
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
        for symbol in self.graph.symbols(&[inner]) {
            if let Symbol::Control { input, .. } = symbol {
                let message = messages::control_in_divisor(self.model.inputs[input].name);
                self.errors.once(expr.source, expr.range, message);
                return true;
            }
        }
        false
    }

    fn forces(&mut self, energies: &mut Energies) {
        let count = self.model.coordinates.iter().map(model::Quantity::count).sum();
        energies.forces = vec![Graph::ZERO; count];
        for force in &self.model.forces {
            let coordinate = &self.model.coordinates[force.coordinate];
            let members: Vec<(Option<&Binder>, i64)> = match (force.index, coordinate.length) {
                (None, None) => vec![(None, 0)],
                (None, Some(_)) => {
                    let message = messages::force_on_family(force.name, coordinate.count());
                    self.errors.at(force.name.span(), message);
                    continue;
                }
                (Some(_), None) => {
                    self.errors.at(force.name.span(), messages::index_of_force(force.name));
                    continue;
                }
                (Some(ForceIndex::One(index)), Some(length)) => {
                    match self.index(index, length, &force.name.to_string()) {
                        Some(k) => vec![(None, k)],
                        None => continue,
                    }
                }
                (Some(ForceIndex::Each(binder)), Some(length)) => {
                    let range = self.range(binder);
                    match range.clone().find(|k| !usize::try_from(*k).is_ok_and(|k| k < length)) {
                        Some(k) => {
                            let name = force.name.to_string();
                            let message = messages::index_out_of_range(&name, k, length);
                            self.errors.at(binder.high.range, message);
                            continue;
                        }
                        None => range.map(|k| (Some(binder), k)).collect(),
                    }
                }
            };
            for (binder, k) in members {
                if let Some(binder) = binder {
                    self.bind(binder, k);
                }
                let value = self.outcome(force.expr);
                if binder.is_some() {
                    self.unbind();
                }
                let slot = coordinate.first + usize::try_from(k).unwrap_or(0);
                if let Some(value) = value {
                    energies.forces[slot] = self.graph.add(energies.forces[slot], value);
                }
            }
        }
    }

    /// An energy or a force, unless it is too long.
    fn outcome(&mut self, expr: &Expr) -> Option<Id> {
        let value = self.scalar(expr)?;
        self.within_bounds(expr, value).then_some(value)
    }

    /// Reports a value that is too long.
    fn within_bounds(&mut self, expr: &Expr, value: Id) -> bool {
        let nodes = self.graph.reachable(&[value]);
        if LARGEST < nodes.len() {
            self.errors.once(expr.source, expr.range, messages::large_value(LARGEST));
            return false;
        }
        let mut depths: BTreeMap<Id, usize> = BTreeMap::new();
        for id in nodes {
            let depth =
                self.graph.children(id).iter().map(|child| depths[child] + 1).max().unwrap_or(0);
            depths.insert(id, depth);
        }
        if DEEPEST_NODE < depths[&value] {
            self.errors.once(expr.source, expr.range, messages::deep_value(DEEPEST_NODE));
            return false;
        }
        true
    }

    /// One instance of a definition.
    fn definition(&mut self, index: usize, k: Option<i64>, range: Range) -> Value {
        if let Some(value) = self.instances.get(&(index, k)) {
            return value.clone();
        }
        if let Some(value) = self.position(index, k) {
            return value;
        }
        let definition = self.model.lets[index];
        if self.open.contains(&(index, k)) {
            let message = messages::circular_definition(&definition.name);
            self.errors.once(definition.expr.source, range, message);
            return Value::Bad;
        }
        self.open.push((index, k));
        let scope = std::mem::take(&mut self.scope);
        if let (Some(k), Some(binder)) = (k, &definition.index) {
            self.bind(binder, k);
        }
        let value = self.expr(&definition.expr);
        self.scope = scope;
        self.open.pop();
        if let Some(positions) = &mut self.positions {
            positions.note(self.graph, &value);
        }
        self.instances.insert((index, k), value.clone());
        value
    }

    /// A definition as symbols of its positions, where they stand for themselves.
    fn position(&mut self, index: usize, k: Option<i64>) -> Option<Value> {
        let value = self.known.as_ref()?.get(&(index, k))?.clone();
        let positions = self.positions.as_ref()?;
        let places = positions.places.clone();
        let all = !value.scalars().is_empty()
            && value.scalars().iter().all(|scalar| places.contains_key(scalar));
        let symbol = |graph: &mut Graph, id: Id| match places.get(&id) {
            Some(&place) => graph.symbol(Symbol::Position(place)),
            None => id,
        };
        all.then(|| self.map(value, symbol))
    }

    /// A function defined by `let`, applied.
    fn apply(&mut self, index: usize, arguments: Vec<Value>, range: Range) -> Value {
        let definition = self.model.lets[index];
        let names = definition.arguments.as_deref().unwrap_or_default();
        if names.len() != arguments.len() {
            return Value::Bad;
        }
        if self.open.iter().any(|&(other, _)| other == index) {
            let message = messages::circular_definition(&definition.name);
            self.errors.once(definition.expr.source, range, message);
            return Value::Bad;
        }
        self.open.push((index, None));
        let bound = names.iter().map(|name| name::read(&name.to_string()).base);
        let bound = bound.zip(arguments.into_iter().map(Local::Value)).collect();
        let scope = std::mem::replace(&mut self.scope, bound);
        let value = self.expr(&definition.expr);
        self.scope = scope;
        self.open.pop();
        value
    }

    /// The whole numbers of a range; a bad or endless one is reported and empty.
    fn range(&mut self, binder: &Binder) -> std::ops::Range<i64> {
        let end = |lower: &mut Self, expr: &Expr| match lower.integer(expr) {
            Ok(value) => Some(value),
            Err(range) => {
                lower.errors.once(expr.source, range, messages::open_end_of_range());
                None
            }
        };
        let (Some(low), Some(high)) = (end(self, &binder.low), end(self, &binder.high)) else {
            return 0..0;
        };
        let high = if binder.inclusive { high.saturating_add(1) } else { high };
        if 65536 < high.saturating_sub(low) {
            self.errors.once(binder.high.source, binder.high.range, messages::long_range());
            return 0..0;
        }
        low..high
    }

    fn index(&mut self, expr: &Expr, length: usize, name: &str) -> Option<i64> {
        match self.integer(expr) {
            Ok(k) if (0..length as i64).contains(&k) => Some(k),
            Ok(k) => {
                // A range that is too long is one mistake, however often its index is used.
                let text = text(expr);
                let source = match self.local(&name::read(&text).base) {
                    Some(Local::Index { source, .. }) => *source,
                    _ => expr.source,
                };
                let message = messages::index_out_of_range(name, k, length);
                self.errors.once(source, expr.range, message);
                None
            }
            Err(range) => {
                self.errors.once(expr.source, range, messages::open_index());
                None
            }
        }
    }

    /// The meaning of a name that holds in one expression.
    fn local(&self, name: &str) -> Option<&Local> {
        self.scope.iter().rev().find(|(own, _)| own == name).map(|(_, local)| local)
    }

    /// A whole number made of numbers and indices; the range that is none otherwise.
    fn integer(&self, expr: &Expr) -> Result<i64, Range> {
        let index = |name: &str| match self.local(name) {
            Some(&Local::Index { value, .. }) => Some(value),
            _ => None,
        };
        model::integer(expr, &index)
    }

    fn bind(&mut self, binder: &Binder, k: i64) {
        self.scope.push((plain(binder), Local::Index { value: k, source: binder.high.source }));
    }

    fn unbind(&mut self) {
        self.scope.pop();
    }
}

fn plain(binder: &Binder) -> String {
    name::read(&binder.name.to_string()).base
}
