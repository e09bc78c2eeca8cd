//! Lowering of each kind of expression to its value.

use super::context::{LARGEST, Local, Lower, large_value};
use super::product::multiple_of_rotation;
use super::rotation::{Rotation, Turn};
use super::value::Value;
use crate::algebra::expr::{Graph, Id, Node, Symbol};
use crate::algebra::functions::{Function, Lowering, Word};
use crate::messages::{Text, message, shared};
use crate::model::{self, Element, Meaning};
use crate::syntax::ast::{Binder, Expr, ExprKind};
use crate::syntax::name::{self, Name};
use crate::syntax::text::text;
use std::collections::BTreeSet;

/// The limit on evaluations, and on operands in all expressions together. Nested sums could exceed
/// any time otherwise.
const LIMIT: usize = 1_000_000;

/// The limit on nested expressions and definitions. Deeper nesting would overflow the compiler's
/// stack.
const DEEPEST: usize = 1000;

impl Lower<'_, '_, '_, '_> {
    pub(super) fn scalar(&mut self, expr: &Expr) -> Option<Id> {
        let value = self.expr(expr);
        let instead = match value {
            Value::Scalar(id) => return Some(id),
            Value::Bad => return None,
            Value::Matrix(_) => "`inner(u, J*v)`",
            Value::Rotation(_) => "`inner(u, R*v)`",
            _ if self.vector_product(expr).is_some() => return None,
            _ => "`inner(u, v)`, `|u|` or a component",
        };
        let instead = format!(", but a scalar is needed here; write {instead}");
        self.unfit(expr, &value, &instead);
        None
    }

    pub(super) fn wrong(&mut self, expr: &Expr, message: Text) -> Value {
        self.errors.once(expr.source, expr.range, message);
        Value::Bad
    }

    /// Reports an expression whose value is of a kind that has no meaning where it stands.
    pub(super) fn unfit(&mut self, expr: &Expr, value: &Value, instead: &str) -> Value {
        self.wrong(expr, message!("`{}` is {}{instead}", text(expr), value.kind()))
    }

    pub(super) fn expr(&mut self, expr: &Expr) -> Value {
        self.work += 1;
        if LIMIT < self.work || LIMIT < self.graph.size() {
            let message = message!(
                "this block unfolds to more than a million expressions; write shorter sums"
            );
            self.errors.once(0, expr.range, message);
            return Value::Bad;
        }
        if DEEPEST <= self.depth {
            let message = message!(
                "definitions within definitions are nested too deeply here; write each `let` \
                 above its uses, and call fewer functions by functions"
            );
            self.errors.once(0, expr.range, message);
            return Value::Bad;
        }
        self.depth += 1;
        let value = self.kind(expr);
        self.depth -= 1;
        self.real(value, expr)
    }

    fn kind(&mut self, expr: &Expr) -> Value {
        match &expr.kind {
            ExprKind::Number(literal) => Value::Scalar(self.graph.literal(literal)),
            ExprKind::Name(name) => self.name(&name.to_string(), expr),
            ExprKind::Sum(items) => self.sum(items),
            ExprKind::Product(items) => self.product(items),
            ExprKind::Negative(inner) => {
                let value = self.expr(inner);
                if let Value::Rotation(_) = value {
                    return self.wrong(expr, multiple_of_rotation());
                }
                self.map(value, Graph::negative)
            }
            ExprKind::Power(base, exponent) => self.power(base, exponent),
            ExprKind::Call(name, items) => self.call(&name.to_string(), items, expr),
            ExprKind::Index(base, index) => self.member(base, index),
            ExprKind::Component(base, component) => {
                self.component(base, &component.to_string(), expr)
            }
            ExprKind::Vector(items) => self.vector(items, expr),
            ExprKind::Magnitude(inner) => self.magnitude(inner),
            ExprKind::SumOver(binder, term) => self.sum_over(binder, term),
            ExprKind::ProductOver(binder, factor) => self.product_over(binder, factor),
            ExprKind::Reaction(name, index, friction) => {
                self.reaction(name, index.as_deref(), *friction, expr)
            }
            ExprKind::Integral { point, body, integrand } => {
                self.integral(&point.to_string(), &body.to_string(), integrand)
            }
        }
    }

    pub(super) fn name(&mut self, text: &str, expr: &Expr) -> Value {
        let Name { base, dots } = name::read(text);
        if let Some(local) = self.local(&base) {
            let value = match local {
                Local::Value(value) => value.clone(),
                &Local::Index { value, .. } => Value::Scalar(self.graph.whole(value)),
            };
            return self.dotted(value, dots, expr);
        }
        // A declaration with one of these names has been refused; the name still has its declared
        // meaning.
        if dots == 0 && !self.model.names.contains_key(&base) {
            match base.as_str() {
                "t" => return Value::Scalar(self.graph.symbol(Symbol::Time)),
                "pi" => return Value::Scalar(self.graph.pi()),
                "i" => return Value::Plane { parts: [Graph::ZERO, Graph::ONE], complex: true },
                _ => {}
            }
        }
        let model = self.model;
        let Some(&meaning) = model.names.get(&base) else { return Value::Bad };
        match (meaning, dots) {
            (Meaning::Parameter(index), 0) if model.parameters[index].is_body() => {
                let what = model.parameters[index].body_kind();
                let message = message!(
                    "`{text}` is {what}; write `{text}.mass`, `{text}.center`, `{text}.inertia` \
                     or `integral(p in {text}, …)`"
                );
                self.wrong(expr, message)
            }
            (Meaning::Parameter(index), 0) => {
                self.whole.insert(index);
                self.quantity(&model.parameters[index], Symbol::Parameter)
            }
            (Meaning::Coordinate(index), _) => {
                let quantity = &model.coordinates[index];
                match dots {
                    _ if quantity.element == Element::Rotation || model.mechanical <= index => {
                        let value = self.quantity(quantity, Symbol::Coordinate);
                        self.dotted(value, dots, expr)
                    }
                    0 => self.quantity(quantity, Symbol::Coordinate),
                    1 => self.quantity(quantity, Symbol::Velocity),
                    2 if self.accelerations => self.quantity(quantity, Symbol::Acceleration),
                    _ => Value::Bad,
                }
            }
            (Meaning::Input(input), _) => {
                let (quantity, control) = (&model.inputs[input], model.is_control(input));
                let component = |scalar| scalar - quantity.first;
                match dots {
                    0 if control => self.quantity(quantity, |scalar| Symbol::Control {
                        input,
                        component: component(scalar),
                    }),
                    _ if quantity.element == Element::Rotation => {
                        let value = Value::Rotation(Rotation::of(self.driven_rotation(input)));
                        self.dotted(value, dots, expr)
                    }
                    0..=2 if !control => self.quantity(quantity, |scalar| Symbol::Input {
                        input,
                        component: component(scalar),
                        order: dots,
                    }),
                    _ => Value::Bad,
                }
            }
            (Meaning::Let(index), _) => {
                let definition = model.lets[index];
                if definition.arguments.is_some() {
                    return self.wrong(expr, shared::function_without_arguments(text));
                }
                let value = match &definition.index {
                    None => self.definition(index, None, expr.range),
                    Some(binder) => Value::Family(
                        self.range(binder)
                            .map(|k| self.definition(index, Some(k), expr.range))
                            .collect(),
                    ),
                };
                self.dotted(value, dots, expr)
            }
            (Meaning::Table(_), _) => self.wrong(expr, shared::function_without_arguments(text)),
            _ => Value::Bad,
        }
    }

    pub(super) fn quantity(
        &mut self,
        quantity: &model::Quantity,
        symbol: impl Fn(usize) -> Symbol,
    ) -> Value {
        match quantity.members {
            None => self.quantity_member(quantity, 0, &symbol),
            Some(length) => Value::Family(
                (0..length).map(|k| self.quantity_member(quantity, k, &symbol)).collect(),
            ),
        }
    }

    /// Returns one member of a family.
    pub(super) fn quantity_member(
        &mut self,
        quantity: &model::Quantity,
        k: usize,
        symbol: &impl Fn(usize) -> Symbol,
    ) -> Value {
        let first = quantity.first + k * quantity.element.count();
        let mut scalar = |offset: usize| self.graph.symbol(symbol(first + offset));
        match quantity.element {
            Element::Scalar => Value::Scalar(scalar(0)),
            Element::Vector(length) => Value::vector(&(0..length).map(scalar).collect::<Vec<Id>>()),
            Element::Matrix => Value::Matrix([0, 1, 2, 3, 4, 5].map(scalar)),
            Element::Rotation => Value::Rotation(Rotation::of(Turn::by_symbols(self.graph, first))),
            // Moments of bodies have symbols of their own, and tables are functions.
            Element::Body | Element::Solid | Element::Table => Value::Bad,
        }
    }

    pub(super) fn dotted(&mut self, value: Value, dots: u8, expr: &Expr) -> Value {
        (0..dots).fold(value, |value, _| self.dot(value, expr, false))
    }

    pub(super) fn call(&mut self, name: &str, items: &[Expr], expr: &Expr) -> Value {
        let base = name::read(name).base;
        if let Some(&Meaning::Let(index)) = self.model.names.get(&base)
            && self.model.lets[index].arguments.is_some()
        {
            let dots = name::read(name).dots;
            let arguments = items.iter().map(|item| self.expr(item)).collect();
            let value = self.apply(index, arguments, expr.range);
            return self.dotted(value, dots, expr);
        }
        if let (Some(&Meaning::Table(index)), [item]) = (self.model.names.get(&base), items) {
            let function = Function::Table(index, 0);
            let value = self.of_scalar(item, |graph, a| graph.call(function, a));
            return self.dotted(value, name::read(name).dots, expr);
        }
        match (Word::named(name).map(|word| word.lowering), items) {
            (Some(Lowering::Function(Function::Exp)), [item]) => self.exponential(item),
            (Some(Lowering::Function(Function::Abs)), [item]) => {
                let Some(a) = self.scalar(item) else { return Value::Bad };
                let load = self.load(&Value::Scalar(a));
                Value::Scalar(load.unwrap_or_else(|| self.graph.call(Function::Abs, a)))
            }
            (Some(Lowering::Function(function)), [item]) => {
                self.of_scalar(item, |graph, a| graph.call(function, a))
            }
            (Some(Lowering::Sqrt), [item]) => self.of_scalar(item, Graph::sqrt),
            (Some(Lowering::Transpose), [item]) => self.transpose(item),
            (Some(Lowering::AngularVelocity), [item]) => self.angular_velocity(item),
            (Some(Lowering::Cis), [item]) => {
                self.scalar(item).map_or(Value::Bad, |angle| self.cis(angle))
            }
            (Some(Lowering::Dot), [item]) => {
                let value = self.expr(item);
                self.dot(value, item, has_index(item))
            }
            (Some(Lowering::Perp), [item]) => match self.expr(item) {
                Value::Bad => Value::Bad,
                Value::Plane { parts: [x, y], complex } => {
                    Value::Plane { parts: [self.graph.negative(y), x], complex }
                }
                other => self.unfit(
                    item,
                    &other,
                    ", and a quarter turn needs a plane vector; write `perp([x, y])`",
                ),
            },
            (Some(Lowering::Height), [item]) => {
                let value = self.plain(item);
                match value.parts().and_then(<[Id]>::last) {
                    Some(&part) => Value::Scalar(part),
                    None if value == Value::Bad => Value::Bad,
                    None => {
                        let instead = ", and a height is that of a vector; write the scalar itself";
                        self.unfit(item, &value, instead)
                    }
                }
            }
            (Some(Lowering::Inner), [a, b]) => self.inner(a, b),
            (Some(Lowering::Cross), [a, b]) => self.cross(a, b),
            (Some(Lowering::Rotation), [a, b]) => self.rotation(a, b),
            (Some(Lowering::Atan2), [a, b]) => self.of_scalars(a, b, Graph::atan2),
            (Some(Lowering::Min), [a, b]) => self.of_scalars(a, b, Graph::min),
            (Some(Lowering::Max), [a, b]) => self.of_scalars(a, b, Graph::max),
            _ => {
                // The call has been reported, and the required kinds of its arguments are unknown.
                for item in items {
                    self.expr(item);
                }
                Value::Bad
            }
        }
    }

    fn of_scalar(&mut self, item: &Expr, function: impl FnOnce(&mut Graph, Id) -> Id) -> Value {
        self.scalar(item).map_or(Value::Bad, |a| Value::Scalar(function(self.graph, a)))
    }

    fn of_scalars(&mut self, a: &Expr, b: &Expr, function: fn(&mut Graph, Id, Id) -> Id) -> Value {
        // A mistake in an argument makes the call invalid.
        let Some(a) = self.scalar(a) else { return Value::Bad };
        let Some(b) = self.scalar(b) else { return Value::Bad };
        Value::Scalar(function(self.graph, a, b))
    }

    /// Returns the exponential of a real or complex number.
    fn exponential(&mut self, item: &Expr) -> Value {
        match self.expr(item) {
            Value::Plane { parts: [re, im], complex: true } => {
                let magnitude = self.graph.call(Function::Exp, re);
                let turn = self.cis(im);
                self.map(turn, |graph, id| graph.mul(magnitude, id))
            }
            Value::Scalar(id) => Value::Scalar(self.graph.call(Function::Exp, id)),
            Value::Bad => Value::Bad,
            other => self.unfit(
                item,
                &other,
                ", but the exponent is a number; write `exp(i*φ)` for a turn",
            ),
        }
    }

    pub(super) fn vector(&mut self, items: &[Expr], expr: &Expr) -> Value {
        let parts: Vec<Option<Id>> = items.iter().map(|item| self.scalar(item)).collect();
        if !(2..=3).contains(&parts.len()) {
            let count = items.len();
            let message = message!("a vector has two or three components; {count} stand here");
            return self.wrong(expr, message);
        }
        let parts: Option<Vec<Id>> = parts.into_iter().collect();
        parts.map_or(Value::Bad, |parts| Value::vector(&parts))
    }

    pub(super) fn sum_over(&mut self, binder: &Binder, term: &Expr) -> Value {
        let mut values = Vec::new();
        // The terms are counted before they are added, because a sum of too many takes minutes.
        let mut terms = BTreeSet::new();
        for k in self.range(binder) {
            self.bind(binder, k);
            let value = self.expr(term);
            self.unbind();
            for id in value.scalars() {
                let (_, bare) = self.graph.split(id);
                match self.graph.node(bare) {
                    Node::Sum(inner) => terms.extend(inner.iter().map(|&(term, _)| term)),
                    _ => _ = terms.insert(bare),
                }
            }
            // A vector has up to three sums, of which an energy may contain one.
            if 3 * LARGEST < terms.len() {
                return self.wrong(term, large_value());
            }
            values.push(value);
        }
        self.total(values, term)
    }

    pub(super) fn member(&mut self, base: &Expr, index: &Expr) -> Value {
        if let ExprKind::Name(ident) = &base.kind {
            let Name { base: text, dots } = name::read(&ident.to_string());
            let local = self.local(&text).is_some();
            if let Some(&Meaning::Let(definition)) = self.model.names.get(&text)
                && !local
                && let Some(binder) = &self.model.lets[definition].index
            {
                let range = self.range(binder);
                let k = match self.integer(index) {
                    Ok(k) if range.contains(&k) => k,
                    Ok(k) => {
                        let message = message!(
                            "`{text}[{k}]` does not exist; `{text}` is defined for {} to {}",
                            range.start,
                            range.end - 1
                        );
                        return self.wrong(index, message);
                    }
                    Err(_) => return self.wrong(index, shared::open_number("an index")),
                };
                let mut value = self.definition(definition, Some(k), base.range);
                for _ in 0..dots {
                    value = self.dot(value, base, true);
                }
                return value;
            }
            // A sum over pairs reads members many times, each without the rest of its family.
            let symbol: Option<fn(usize) -> Symbol> = match dots {
                0 => Some(Symbol::Coordinate),
                1 => Some(Symbol::Velocity),
                _ => None,
            };
            if let Some(&Meaning::Coordinate(family)) = self.model.names.get(&text)
                && (dots == 0 || family < self.model.mechanical)
                && !local
                && let coordinate = &self.model.coordinates[family]
                && let Some(length) = coordinate.members
                && let Some(symbol) = symbol
            {
                return match self.index(index, length, &ident.to_string()) {
                    Some(k) => {
                        let k = usize::try_from(k).unwrap_or(0);
                        self.quantity_member(coordinate, k, &symbol)
                    }
                    None => Value::Bad,
                };
            }
        }
        let value = self.indexed(base);
        let members = match self.components(value) {
            Value::Bad => return Value::Bad,
            Value::Family(members) => members,
            Value::Rotation(_) => return self.no_entries(base),
            value => match value.parts() {
                Some(parts) => parts.iter().copied().map(Value::Scalar).collect(),
                None => {
                    return self.unfit(base, &value, ", it has no members; leave out the index");
                }
            },
        };
        match self.index(index, members.len(), &text(base)) {
            Some(k) => members[usize::try_from(k).unwrap_or(0)].clone(),
            None => Value::Bad,
        }
    }

    /// Returns the value to which an index is applied.
    pub(super) fn indexed(&mut self, base: &Expr) -> Value {
        if let ExprKind::Name(ident) = &base.kind {
            let Name { base: text, dots: 0 } = name::read(&ident.to_string()) else {
                return self.expr(base);
            };
            let local = self.local(&text).is_some();
            if let Some(&Meaning::Parameter(index)) = self.model.names.get(&text)
                && !local
            {
                self.indexed.insert(index);
                return self.quantity(&self.model.parameters[index], Symbol::Parameter);
            }
        }
        self.expr(base)
    }

    pub(super) fn component(&mut self, base: &Expr, component: &str, expr: &Expr) -> Value {
        if let Some(index) = self.body(base) {
            return self.property(index, component);
        }
        let value = self.plain(base);
        if let Value::Rotation(_) = value {
            return self.no_entries(base);
        }
        let which = ["x", "y", "z"].iter().position(|own| *own == component);
        let part = value.parts().zip(which).and_then(|(parts, which)| parts.get(which));
        match (part, value.kind()) {
            (Some(&part), _) => Value::Scalar(part),
            _ if value == Value::Bad || which.is_none() => Value::Bad,
            (None, kind) => {
                let found = text(base);
                self.wrong(
                    expr,
                    message!("`{found}` is {kind}, it has no `.{component}`; write a vector"),
                )
            }
        }
    }
}

/// Returns `true` if an expression contains an index: a single member of a family may be at rest.
fn has_index(expr: &Expr) -> bool {
    let own = matches!(expr.kind, ExprKind::Index(..));
    own || !matches!(expr.kind, ExprKind::Integral { .. })
        && expr.parts().into_iter().any(has_index)
}
