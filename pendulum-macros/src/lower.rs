//! Vectors, complex numbers and families to scalars: every expression of a block becomes nodes of one graph.
//!
//! A plane vector is a complex number; `Value::Bad` stands for what has been reported, so that one mistake gives one message.

use crate::ast::{Binder, Expr, ExprKind, ForceIndex, Role};
use crate::check::{self, Meaning, Model};
use crate::diff;
use crate::error::{Errors, Range};
use crate::expr::{Contents, Function, Graph, Id, Symbol};
use crate::name::{self, Name};
use crate::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// More evaluations than this are refused: sums within sums would never end.
const LIMIT: usize = 2_000_000;

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
    /// The parameters of two or three components that are used by their indices alone: families, not vectors.
    pub(crate) families: BTreeSet<usize>,
}

impl Energies {
    /// Every expression in it.
    pub(crate) fn roots(&mut self) -> Vec<&mut Id> {
        let single = [&mut self.kinetic, &mut self.potential, &mut self.lagrangian, &mut self.dissipation];
        let single = single.into_iter().flatten();
        single.chain(&mut self.forces).chain(self.defaults.iter_mut().flatten()).collect()
    }
}

/// An expression by its components.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Bad,
    Scalar(Id),
    /// A plane vector; `complex` if it was written as a complex number, so that a real number may be added to it.
    Plane {
        parts: [Id; 2],
        complex: bool,
    },
    Space([Id; 3]),
    Family(Vec<Value>),
}

/// Lowers all energies of a block.
pub(crate) fn energies(model: &Model, graph: &mut Graph, errors: &mut Errors) -> Energies {
    let mut lower = Lower {
        model,
        graph,
        errors,
        scope: Vec::new(),
        indices: Vec::new(),
        ranges: Vec::new(),
        instances: BTreeMap::new(),
        open: Vec::new(),
        indexed: BTreeSet::new(),
        whole: BTreeSet::new(),
        work: 0,
    };
    lower.block()
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

struct Lower<'m, 'a, 'g, 'e> {
    model: &'m Model<'a>,
    graph: &'g mut Graph,
    errors: &'e mut Errors,
    /// The arguments of the functions that are open.
    scope: Vec<(String, Value)>,
    /// The indices that are bound.
    indices: Vec<(String, i64)>,
    /// The end of the range of each of them.
    ranges: Vec<usize>,
    /// The definitions that are done, by their index.
    instances: BTreeMap<(usize, Option<i64>), Value>,
    /// The definitions that are being evaluated.
    open: Vec<(usize, Option<i64>)>,
    /// The parameters that are used by their indices, and those that are used whole.
    indexed: BTreeSet<usize>,
    whole: BTreeSet<usize>,
    work: usize,
}

impl Lower<'_, '_, '_, '_> {
    fn block(&mut self) -> Energies {
        let mut energies = Energies::default();
        for quantity in &self.model.parameters {
            let default = quantity.default.filter(|_| quantity.length.is_none()).and_then(|default| self.scalar(default));
            energies.defaults.push(default);
        }
        for (index, definition) in self.model.lets.iter().enumerate() {
            if definition.arguments.is_some() {
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
            let Some(value) = self.scalar(expr) else { continue };
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
        energies.families = self.indexed.difference(&self.whole).copied().collect();
        energies
    }

    fn forces(&mut self, energies: &mut Energies) {
        let count = self.model.coordinates.iter().map(check::Quantity::count).sum();
        energies.forces = vec![Graph::ZERO; count];
        for force in &self.model.forces {
            let coordinate = &self.model.coordinates[force.coordinate];
            let members: Vec<(Option<&Binder>, i64)> = match (force.index, coordinate.length) {
                (None, None) => vec![(None, 0)],
                (None, Some(_)) => {
                    let name = force.name;
                    self.errors.at(
                        name.span(),
                        format!("`{name}` is a family; write `{name}[k]`, or `{name}[k in 0..{}]` for all", coordinate.count()),
                    );
                    continue;
                }
                (Some(_), None) => {
                    self.errors.at(force.name.span(), format!("`{}` is no family; write it without an index", force.name));
                    continue;
                }
                (Some(ForceIndex::One(index)), Some(length)) => match self.index(index, length, &force.name.to_string()) {
                    Some(k) => vec![(None, k)],
                    None => continue,
                },
                (Some(ForceIndex::Each(binder)), Some(length)) => {
                    let range = self.range(binder);
                    match range.clone().find(|k| !usize::try_from(*k).is_ok_and(|k| k < length)) {
                        Some(k) => {
                            self.errors.at(binder.high.range, outside(&force.name.to_string(), k, length));
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
                let value = self.scalar(force.expr);
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

    /// One instance of a definition.
    fn definition(&mut self, index: usize, k: Option<i64>, range: Range) -> Value {
        if let Some(value) = self.instances.get(&(index, k)) {
            return value.clone();
        }
        let definition = self.model.lets[index];
        if self.open.contains(&(index, k)) || 512 < self.open.len() {
            self.errors.once(
                definition.expr.source,
                range,
                format!("`{}` is defined by itself; break the circle", definition.name),
            );
            return Value::Bad;
        }
        self.open.push((index, k));
        let indices = std::mem::take(&mut self.indices);
        let ranges = std::mem::take(&mut self.ranges);
        let scope = std::mem::take(&mut self.scope);
        if let (Some(k), Some(binder)) = (k, &definition.index) {
            self.bind(binder, k);
        }
        let value = self.expr(&definition.expr);
        self.indices = indices;
        self.ranges = ranges;
        self.scope = scope;
        self.open.pop();
        self.instances.insert((index, k), value.clone());
        value
    }

    /// A function defined by `let`, applied.
    fn apply(&mut self, index: usize, arguments: Vec<Value>, range: Range) -> Value {
        let definition = self.model.lets[index];
        let names = definition.arguments.as_deref().unwrap_or_default();
        if names.len() != arguments.len() {
            return Value::Bad;
        }
        if self.open.iter().any(|&(other, _)| other == index) {
            self.errors.once(
                definition.expr.source,
                range,
                format!("`{}` is defined by itself; break the circle", definition.name),
            );
            return Value::Bad;
        }
        self.open.push((index, None));
        let indices = std::mem::take(&mut self.indices);
        let ranges = std::mem::take(&mut self.ranges);
        let bound = names.iter().map(|name| name::read(&name.to_string()).base).zip(arguments).collect();
        let scope = std::mem::replace(&mut self.scope, bound);
        let value = self.expr(&definition.expr);
        self.scope = scope;
        self.indices = indices;
        self.ranges = ranges;
        self.open.pop();
        value
    }

    /// The whole numbers of a range; a bad or endless one is reported and empty.
    fn range(&mut self, binder: &Binder) -> std::ops::Range<i64> {
        let mut end = |expr: &Expr, indices: &[(String, i64)]| match check::integer(expr, indices) {
            Ok(value) => Some(value),
            Err(range) => {
                self.errors.once(
                    expr.source,
                    range,
                    "the end of a range is a whole number known while compiling; write numbers and indices only",
                );
                None
            }
        };
        let (Some(low), Some(high)) = (end(&binder.low, &self.indices), end(&binder.high, &self.indices)) else { return 0..0 };
        let high = if binder.inclusive { high.saturating_add(1) } else { high };
        if 65536 < high.saturating_sub(low) {
            self.errors.once(
                binder.high.source,
                binder.high.range,
                "this range has more than 65536 members; write a shorter one",
            );
            return 0..0;
        }
        low..high
    }

    fn index(&mut self, expr: &Expr, length: usize, name: &str) -> Option<i64> {
        match check::integer(expr, &self.indices) {
            Ok(k) if (0..length as i64).contains(&k) => Some(k),
            Ok(k) => {
                // A range that is too long is one mistake, however often its index is used.
                let text = check::text(expr);
                let bound = self.indices.iter().rposition(|(name, _)| *name == name::read(&text).base);
                let source = bound.map_or(expr.source, |place| self.ranges[place]);
                self.errors.once(source, expr.range, outside(name, k, length));
                None
            }
            Err(range) => {
                self.errors.once(
                    expr.source,
                    range,
                    "an index is a whole number known while compiling; write numbers and indices only",
                );
                None
            }
        }
    }

    fn bind(&mut self, binder: &Binder, k: i64) {
        self.indices.push((plain(binder), k));
        self.ranges.push(binder.high.source);
    }

    fn unbind(&mut self) {
        self.indices.pop();
        self.ranges.pop();
    }

    fn scalar(&mut self, expr: &Expr) -> Option<Id> {
        match self.expr(expr) {
            Value::Scalar(id) => Some(id),
            Value::Bad => None,
            other => {
                self.wrong(
                    expr,
                    &format!(
                        "`{}` is {}, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component",
                        check::text(expr),
                        other.kind()
                    ),
                );
                None
            }
        }
    }

    fn wrong(&mut self, expr: &Expr, message: &str) -> Value {
        self.errors.once(expr.source, expr.range, message);
        Value::Bad
    }

    fn expr(&mut self, expr: &Expr) -> Value {
        self.work += 1;
        if LIMIT < self.work {
            self.errors.once(0, expr.range, "this block unfolds to more than two million expressions; write shorter sums");
            return Value::Bad;
        }
        match &expr.kind {
            ExprKind::Number(literal) => Value::Scalar(self.graph.literal(literal)),
            ExprKind::Name(name) => self.name(&name.to_string(), expr),
            ExprKind::Sum(items) => self.sum(items),
            ExprKind::Product(items) => self.product(items),
            ExprKind::Negative(inner) => {
                let value = self.expr(inner);
                self.map(value, super::expr::Graph::negative)
            }
            ExprKind::Power(base, exponent) => self.power(base, exponent),
            ExprKind::Call(name, items) => self.call(&name.to_string(), items, expr),
            ExprKind::Index(base, index) => self.member(base, index),
            ExprKind::Component(base, component) => self.component(base, &component.to_string(), expr),
            ExprKind::Vector(items) => self.vector(items, expr),
            ExprKind::Magnitude(inner) => self.magnitude(inner),
            ExprKind::SumOver(binder, term) => self.sum_over(binder, term),
            ExprKind::Integral { .. } => Value::Bad,
        }
    }

    fn name(&mut self, text: &str, expr: &Expr) -> Value {
        let Name { base, dots } = name::read(text);
        if let Some(&(_, k)) = self.indices.iter().rev().find(|(name, _)| *name == base) {
            return Value::Scalar(self.graph.whole(k));
        }
        if let Some((_, value)) = self.scope.iter().rev().find(|(name, _)| *name == base) {
            let value = value.clone();
            return self.dotted(value, dots, expr);
        }
        if dots == 0 {
            match base.as_str() {
                "t" => return Value::Scalar(self.graph.symbol(Symbol::Time)),
                "pi" => return Value::Scalar(self.graph.pi()),
                "i" => return Value::Plane { parts: [Graph::ZERO, Graph::ONE], complex: true },
                _ => {}
            }
        }
        match self.model.names.get(&base) {
            Some(&Meaning::Parameter(index)) if dots == 0 => {
                self.whole.insert(index);
                self.quantity(&self.model.parameters[index], Symbol::Parameter)
            }
            Some(&Meaning::Coordinate(index)) if dots == 0 => self.quantity(&self.model.coordinates[index], Symbol::Coordinate),
            Some(&Meaning::Coordinate(index)) if dots == 1 => self.quantity(&self.model.coordinates[index], Symbol::Velocity),
            Some(&Meaning::Input(input)) if dots <= 2 => {
                let quantity = &self.model.inputs[input];
                let first = quantity.first;
                self.quantity(quantity, |scalar| Symbol::Input { input, component: scalar - first, order: dots })
            }
            Some(&Meaning::Let(index)) => {
                let definition = self.model.lets[index];
                if definition.arguments.is_some() {
                    return self.wrong(expr, &format!("`{text}` is a function; write `{text}(…)`"));
                }
                let value = match &definition.index {
                    None => self.definition(index, None, expr.range),
                    Some(binder) => {
                        Value::Family(self.range(binder).map(|k| self.definition(index, Some(k), expr.range)).collect())
                    }
                };
                self.dotted(value, dots, expr)
            }
            _ => Value::Bad,
        }
    }

    fn quantity(&mut self, quantity: &check::Quantity, symbol: impl Fn(usize) -> Symbol) -> Value {
        let mut scalar = |offset: usize| self.graph.symbol(symbol(quantity.first + offset));
        let coordinate = matches!(symbol(quantity.first), Symbol::Coordinate(_) | Symbol::Velocity(_));
        match quantity.length {
            None => Value::Scalar(scalar(0)),
            Some(2) if !coordinate => Value::Plane { parts: [scalar(0), scalar(1)], complex: false },
            Some(3) if !coordinate => Value::Space([scalar(0), scalar(1), scalar(2)]),
            Some(length) => Value::Family((0..length).map(|k| Value::Scalar(scalar(k))).collect()),
        }
    }

    fn dotted(&mut self, value: Value, dots: u8, expr: &Expr) -> Value {
        (0..dots).fold(value, |value, _| self.dot(value, expr, false))
    }

    /// The total time derivative; `still` if the operand may be at rest.
    fn dot(&mut self, value: Value, expr: &Expr, still: bool) -> Value {
        let contents = self.contents(&value);
        let moving = Contents::TIME.or(Contents::COORDINATE).or(Contents::VELOCITY).or(Contents::INPUT);
        let what = check::text(expr);
        if value == Value::Bad {
            return value;
        }
        if contents.any(Contents::VELOCITY) {
            return self.wrong(expr, &format!("the derivative of a velocity in `{what}` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"));
        }
        if contents.any(Contents::ACCELERATION_INPUT) {
            return self.wrong(expr, &format!("`{what}` contains a third derivative of a driven input; they have two"));
        }
        if !contents.any(moving) && !still {
            return self.wrong(expr, &format!("nothing in `{what}` moves, so its time derivative is zero; leave it out"));
        }
        self.map(value, total_derivative)
    }

    fn contents(&self, value: &Value) -> Contents {
        match value {
            Value::Bad => Contents::default(),
            Value::Scalar(id) => self.graph.contents(*id),
            Value::Plane { parts, .. } => parts.iter().fold(Contents::default(), |all, &id| all.or(self.graph.contents(id))),
            Value::Space(parts) => parts.iter().fold(Contents::default(), |all, &id| all.or(self.graph.contents(id))),
            Value::Family(members) => members.iter().fold(Contents::default(), |all, member| all.or(self.contents(member))),
        }
    }

    fn map(&mut self, value: Value, mut map: impl FnMut(&mut Graph, Id) -> Id) -> Value {
        self.map_with(value, &mut map)
    }

    fn map_with(&mut self, value: Value, map: &mut impl FnMut(&mut Graph, Id) -> Id) -> Value {
        match value {
            Value::Bad => Value::Bad,
            Value::Scalar(id) => Value::Scalar(map(self.graph, id)),
            Value::Plane { parts, complex } => Value::Plane { parts: parts.map(|id| map(self.graph, id)), complex },
            Value::Space(parts) => Value::Space(parts.map(|id| map(self.graph, id))),
            Value::Family(members) => Value::Family(members.into_iter().map(|member| self.map_with(member, map)).collect()),
        }
    }

    fn sum(&mut self, items: &[(bool, Expr)]) -> Value {
        let mut total = None;
        for (minus, item) in items {
            let mut value = self.expr(item);
            if *minus {
                value = self.map(value, super::expr::Graph::negative);
            }
            total = Some(match total {
                None => value,
                Some(sum) => self.add(sum, value, item),
            });
        }
        total.unwrap_or(Value::Bad)
    }

    fn add(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match (a, b) {
            (Value::Bad, _) | (_, Value::Bad) => Value::Bad,
            (Value::Scalar(a), Value::Scalar(b)) => Value::Scalar(self.graph.add(a, b)),
            (Value::Plane { parts: a, complex: left }, Value::Plane { parts: b, complex: right }) => {
                let parts = [self.graph.add(a[0], b[0]), self.graph.add(a[1], b[1])];
                Value::Plane { parts, complex: left && right }
            }
            (Value::Plane { parts, complex: true }, Value::Scalar(real))
            | (Value::Scalar(real), Value::Plane { parts, complex: true }) => {
                Value::Plane { parts: [self.graph.add(parts[0], real), parts[1]], complex: true }
            }
            (Value::Space(a), Value::Space(b)) => Value::Space([0, 1, 2].map(|k| self.graph.add(a[k], b[k]))),
            (a, b) => {
                let message = format!(
                    "`{}` is {}, but the terms before it are {}; a sum needs terms of one kind",
                    check::text(expr),
                    b.kind(),
                    a.kind_plural()
                );
                self.wrong(expr, &message)
            }
        }
    }

    fn product(&mut self, items: &[(bool, Expr)]) -> Value {
        let mut total = Value::Scalar(Graph::ONE);
        for (index, (over, item)) in items.iter().enumerate() {
            let value = self.expr(item);
            total = if *over {
                self.divide(total, value, item)
            } else if index == 0 {
                value
            } else {
                self.multiply(total, value, item)
            };
        }
        total
    }

    fn multiply(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match (a, b) {
            (Value::Bad, _) | (_, Value::Bad) => Value::Bad,
            (Value::Scalar(a), b @ (Value::Scalar(_) | Value::Plane { .. } | Value::Space(_))) => {
                self.map(b, |graph, id| graph.mul(a, id))
            }
            (a @ (Value::Plane { .. } | Value::Space(_)), Value::Scalar(b)) => self.map(a, |graph, id| graph.mul(id, b)),
            (Value::Plane { parts: a, complex: left }, Value::Plane { parts: b, complex: right }) => {
                Value::Plane { parts: self.complex_product(a, b), complex: left && right }
            }
            (Value::Space(_), Value::Space(_)) => {
                self.wrong(expr, "the product of two space vectors is ambiguous; write `inner(u, v)` or `cross(u, v)`")
            }
            (a, b) => {
                let message = format!("{} cannot be multiplied by {}; write a component or an index", a.kind(), b.kind());
                self.wrong(expr, &message)
            }
        }
    }

    fn complex_product(&mut self, a: [Id; 2], b: [Id; 2]) -> [Id; 2] {
        let graph = &mut *self.graph;
        let (rr, ii) = (graph.mul(a[0], b[0]), graph.mul(a[1], b[1]));
        let (ri, ir) = (graph.mul(a[0], b[1]), graph.mul(a[1], b[0]));
        [graph.sub(rr, ii), graph.add(ri, ir)]
    }

    fn divide(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match b {
            Value::Bad => Value::Bad,
            Value::Scalar(Graph::ZERO) => self.wrong(expr, "division by zero; write another divisor"),
            Value::Scalar(b) => match a {
                Value::Family(_) => self.multiply(a, Value::Scalar(b), expr),
                a => self.map(a, |graph, id| graph.div(id, b)),
            },
            Value::Plane { parts: [re, im], complex: true } => {
                let square = self.square(&[re, im]);
                let conjugate = [re, self.graph.negative(im)].map(|part| self.graph.div(part, square));
                self.multiply(a, Value::Plane { parts: conjugate, complex: true }, expr)
            }
            other => {
                let message = format!(
                    "`{}` is {}, and nothing can be divided by that; divide by its length `|u|`",
                    check::text(expr),
                    other.kind()
                );
                self.wrong(expr, &message)
            }
        }
    }

    fn power(&mut self, base: &Expr, exponent: &Expr) -> Value {
        let value = self.expr(base);
        let Some(power) = self.scalar(exponent) else { return Value::Bad };
        match value {
            Value::Bad => Value::Bad,
            Value::Scalar(Graph::ZERO) if check::integer(exponent, &self.indices).is_ok_and(|power| power < 0) => {
                self.wrong(base, "zero has no negative power; write another base")
            }
            Value::Scalar(id) => Value::Scalar(self.graph.general_power(id, power)),
            Value::Plane { parts, complex: true } => match check::integer(exponent, &self.indices) {
                Ok(count) if (0..=64).contains(&count) => {
                    let parts = (0..count).fold([Graph::ONE, Graph::ZERO], |product, _| self.complex_product(product, parts));
                    Value::Plane { parts, complex: true }
                }
                _ => self.wrong(exponent, "a complex number has whole powers from 0 to 64 here; write `exp(i*φ)` for others"),
            },
            other => {
                let message = format!("`{}` is {}, and only scalars have powers; write `|u|^2`", check::text(base), other.kind());
                self.wrong(base, &message)
            }
        }
    }

    fn call(&mut self, name: &str, items: &[Expr], expr: &Expr) -> Value {
        let base = name::read(name).base;
        if let Some(&Meaning::Let(index)) = self.model.names.get(&base)
            && self.model.lets[index].arguments.is_some()
        {
            let dots = name::read(name).dots;
            let arguments = items.iter().map(|item| self.expr(item)).collect();
            let value = self.apply(index, arguments, expr.range);
            return self.dotted(value, dots, expr);
        }
        match (name, items) {
            ("dot", [item]) => {
                let value = self.expr(item);
                self.dot(value, item, has_index(item))
            }
            ("inner", [a, b]) => self.inner(a, b),
            ("cross", [a, b]) => self.cross(a, b),
            ("perp", [item]) => match self.expr(item) {
                Value::Bad => Value::Bad,
                Value::Plane { parts: [x, y], complex } => Value::Plane { parts: [self.graph.negative(y), x], complex },
                other => self.wrong(
                    item,
                    &format!(
                        "`{}` is {}, and a quarter turn needs a plane vector; write `perp([x, y])`",
                        check::text(item),
                        other.kind()
                    ),
                ),
            },
            ("height", [item]) => match self.expr(item) {
                Value::Bad => Value::Bad,
                Value::Plane { parts, .. } => Value::Scalar(parts[1]),
                Value::Space(parts) => Value::Scalar(parts[2]),
                other => self.wrong(
                    item,
                    &format!(
                        "`{}` is {}, and a height is that of a vector; write the scalar itself",
                        check::text(item),
                        other.kind()
                    ),
                ),
            },
            ("cis", [item]) => match self.scalar(item) {
                Some(angle) => self.cis(angle),
                None => Value::Bad,
            },
            ("exp", [item]) => match self.expr(item) {
                Value::Plane { parts: [re, im], complex: true } => {
                    let magnitude = self.graph.call(Function::Exp, re);
                    let turn = self.cis(im);
                    self.map(turn, |graph, id| graph.mul(magnitude, id))
                }
                Value::Scalar(id) => Value::Scalar(self.graph.call(Function::Exp, id)),
                Value::Bad => Value::Bad,
                other => self.wrong(
                    item,
                    &format!(
                        "`{}` is {}, but the exponent is a number; write `exp(i*φ)` for a turn",
                        check::text(item),
                        other.kind()
                    ),
                ),
            },
            _ => self.scalar_call(name, items),
        }
    }

    fn scalar_call(&mut self, name: &str, items: &[Expr]) -> Value {
        let values: Vec<Option<Id>> = items.iter().map(|item| self.scalar(item)).collect();
        let Some(values) = values.into_iter().collect::<Option<Vec<Id>>>() else { return Value::Bad };
        let graph = &mut *self.graph;
        Value::Scalar(match (name, values.as_slice()) {
            ("sqrt", &[a]) => graph.sqrt(a),
            ("atan2", &[y, x]) => graph.atan2(y, x),
            ("min", &[a, b]) => graph.min(a, b),
            ("max", &[a, b]) => graph.max(a, b),
            (_, &[a]) => match SCALAR.iter().find(|row| row.0 == name) {
                Some(&(_, function)) => graph.call(function, a),
                None => return Value::Bad,
            },
            _ => return Value::Bad,
        })
    }

    fn cis(&mut self, angle: Id) -> Value {
        let parts = [self.graph.call(Function::Cos, angle), self.graph.call(Function::Sin, angle)];
        Value::Plane { parts, complex: true }
    }

    fn inner(&mut self, a: &Expr, b: &Expr) -> Value {
        let (left, right) = (self.expr(a), self.expr(b));
        let pairs: Vec<(Id, Id)> = match (&left, &right) {
            (Value::Bad, _) | (_, Value::Bad) => return Value::Bad,
            (Value::Plane { parts: a, .. }, Value::Plane { parts: b, .. }) => a.iter().copied().zip(b.iter().copied()).collect(),
            (Value::Space(a), Value::Space(b)) => a.iter().copied().zip(b.iter().copied()).collect(),
            _ => {
                let message = format!("`inner` takes two vectors of one length; these are {} and {}", left.kind(), right.kind());
                return self.wrong(b, &message);
            }
        };
        let products: Vec<(Id, Rational)> = pairs.into_iter().map(|(a, b)| (self.graph.mul(a, b), Rational::ONE)).collect();
        Value::Scalar(self.graph.sum(&products))
    }

    fn cross(&mut self, a: &Expr, b: &Expr) -> Value {
        let (left, right) = (self.expr(a), self.expr(b));
        let graph = &mut *self.graph;
        let mut minor = |a: Id, b: Id, c: Id, d: Id| {
            let (first, second) = (graph.mul(a, b), graph.mul(c, d));
            graph.sub(first, second)
        };
        match (&left, &right) {
            (Value::Bad, _) | (_, Value::Bad) => Value::Bad,
            (Value::Plane { parts: a, .. }, Value::Plane { parts: b, .. }) => Value::Scalar(minor(a[0], b[1], a[1], b[0])),
            (Value::Space(a), Value::Space(b)) => {
                Value::Space([minor(a[1], b[2], a[2], b[1]), minor(a[2], b[0], a[0], b[2]), minor(a[0], b[1], a[1], b[0])])
            }
            _ => {
                let message = format!("`cross` takes two vectors of one length; these are {} and {}", left.kind(), right.kind());
                self.wrong(b, &message)
            }
        }
    }

    fn vector(&mut self, items: &[Expr], expr: &Expr) -> Value {
        let parts: Vec<Option<Id>> = items.iter().map(|item| self.scalar(item)).collect();
        if !(2..=3).contains(&parts.len()) {
            return self.wrong(expr, &format!("a vector has two or three components; {} stand here", items.len()));
        }
        match *parts.as_slice() {
            [Some(x), Some(y)] => Value::Plane { parts: [x, y], complex: false },
            [Some(x), Some(y), Some(z)] => Value::Space([x, y, z]),
            _ => Value::Bad,
        }
    }

    fn magnitude(&mut self, inner: &Expr) -> Value {
        match self.expr(inner) {
            Value::Bad => Value::Bad,
            Value::Scalar(id) => Value::Scalar(self.graph.call(Function::Abs, id)),
            Value::Plane { parts, .. } => {
                let square = self.square(&parts);
                Value::Scalar(self.graph.sqrt(square))
            }
            Value::Space(parts) => {
                let square = self.square(&parts);
                Value::Scalar(self.graph.sqrt(square))
            }
            other @ Value::Family(_) => {
                let message = format!("`{}` is {}; write one of its members", check::text(inner), other.kind());
                self.wrong(inner, &message)
            }
        }
    }

    fn square(&mut self, parts: &[Id]) -> Id {
        let squares: Vec<(Id, Rational)> =
            parts.iter().map(|&part| (self.graph.power(part, Rational::whole(2)), Rational::ONE)).collect();
        self.graph.sum(&squares)
    }

    fn sum_over(&mut self, binder: &Binder, term: &Expr) -> Value {
        let mut total: Option<Value> = None;
        for k in self.range(binder) {
            self.bind(binder, k);
            let value = self.expr(term);
            self.unbind();
            total = Some(match total {
                None => value,
                Some(sum) => self.add(sum, value, term),
            });
        }
        total.unwrap_or(Value::Scalar(Graph::ZERO))
    }

    fn member(&mut self, base: &Expr, index: &Expr) -> Value {
        if let ExprKind::Name(ident) = &base.kind {
            let Name { base: text, dots } = name::read(&ident.to_string());
            let local = self.scope.iter().any(|(name, _)| *name == text);
            if let Some(&Meaning::Let(definition)) = self.model.names.get(&text)
                && !local
                && let Some(binder) = &self.model.lets[definition].index
            {
                let range = self.range(binder);
                let k = match check::integer(index, &self.indices) {
                    Ok(k) if range.contains(&k) => k,
                    Ok(k) => {
                        let message =
                            format!("`{text}[{k}]` does not exist; `{text}` is defined for {} to {}", range.start, range.end - 1);
                        return self.wrong(index, &message);
                    }
                    Err(_) => {
                        return self
                            .wrong(index, "an index is a whole number known while compiling; write numbers and indices only");
                    }
                };
                let mut value = self.definition(definition, Some(k), base.range);
                for _ in 0..dots {
                    value = self.dot(value, base, true);
                }
                return value;
            }
        }
        let value = self.indexed(base);
        let members: Vec<Value> = match value {
            Value::Bad => return Value::Bad,
            Value::Family(members) => members,
            Value::Plane { parts, .. } => parts.map(Value::Scalar).to_vec(),
            Value::Space(parts) => parts.map(Value::Scalar).to_vec(),
            Value::Scalar(_) => {
                return self.wrong(base, &format!("`{}` is a scalar, it has no members; leave out the index", check::text(base)));
            }
        };
        match self.index(index, members.len(), &check::text(base)) {
            Some(k) => members[usize::try_from(k).unwrap_or(0)].clone(),
            None => Value::Bad,
        }
    }

    /// What an index is put to.
    fn indexed(&mut self, base: &Expr) -> Value {
        if let ExprKind::Name(ident) = &base.kind {
            let Name { base: text, dots: 0 } = name::read(&ident.to_string()) else { return self.expr(base) };
            let local = self.scope.iter().any(|(name, _)| *name == text);
            if let Some(&Meaning::Parameter(index)) = self.model.names.get(&text)
                && !local
            {
                self.indexed.insert(index);
                return self.quantity(&self.model.parameters[index], Symbol::Parameter);
            }
        }
        self.expr(base)
    }

    fn component(&mut self, base: &Expr, component: &str, expr: &Expr) -> Value {
        let value = self.expr(base);
        let which = match component {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return Value::Bad,
        };
        match value {
            Value::Bad => Value::Bad,
            Value::Plane { parts, .. } if which < 2 => Value::Scalar(parts[which]),
            Value::Space(parts) => Value::Scalar(parts[which]),
            other => self
                .wrong(expr, &format!("`{}` is {}, it has no `.{component}`; write a vector", check::text(base), other.kind())),
        }
    }
}

impl Value {
    fn kind(&self) -> &'static str {
        match self {
            Value::Bad => "unknown",
            Value::Scalar(_) => "a scalar",
            Value::Plane { complex: false, .. } => "a plane vector",
            Value::Plane { complex: true, .. } => "a complex number",
            Value::Space(_) => "a space vector",
            Value::Family(_) => "a family",
        }
    }

    fn kind_plural(&self) -> &'static str {
        match self {
            Value::Bad => "unknown",
            Value::Scalar(_) => "scalars",
            Value::Plane { complex: false, .. } => "plane vectors",
            Value::Plane { complex: true, .. } => "complex numbers",
            Value::Space(_) => "space vectors",
            Value::Family(_) => "families",
        }
    }
}

/// The functions of one scalar.
#[rustfmt::skip]
const SCALAR: &[(&str, Function)] = &[
    ("ln", Function::Ln), ("sin", Function::Sin), ("cos", Function::Cos), ("tan", Function::Tan),
    ("asin", Function::Asin), ("acos", Function::Acos), ("atan", Function::Atan),
    ("sinh", Function::Sinh), ("cosh", Function::Cosh), ("tanh", Function::Tanh),
    ("abs", Function::Abs), ("sign", Function::Sign),
];

/// Whether an index stands in an expression: one member of a family may be at rest.
fn has_index(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Integral { .. } => false,
        ExprKind::Index(..) => true,
        ExprKind::Sum(items) | ExprKind::Product(items) => items.iter().any(|(_, item)| has_index(item)),
        ExprKind::Negative(a) | ExprKind::Magnitude(a) | ExprKind::Component(a, _) => has_index(a),
        ExprKind::Power(a, b) => has_index(a) || has_index(b),
        ExprKind::Call(_, items) | ExprKind::Vector(items) => items.iter().any(has_index),
        ExprKind::SumOver(_, term) => has_index(term),
    }
}

fn plain(binder: &Binder) -> String {
    name::read(&binder.name.to_string()).base
}

fn outside(name: &str, k: i64, length: usize) -> String {
    format!("index {k} is out of range; `{name}` has {length} members, `{name}[0]` to `{name}[{}]`", length - 1)
}
