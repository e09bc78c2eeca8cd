//! Lowering of constraints and limits to scalars.

use super::context::Lower;
use super::row::{Row, Shape};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::number::Rational;
use crate::messages::{message, shared};
use crate::syntax::ast::{Binder, Expr};
use crate::syntax::name;
use crate::syntax::text::text;
use proc_macro2::Ident;

impl Lower<'_, '_, '_, '_> {
    /// Returns the scalars of all constraints, with the solved constraints first.
    pub(super) fn constraints(&mut self) -> Vec<Row> {
        self.constrained = true;
        let mut rows = Vec::new();
        for (statement, constraint) in self.model.constraints.iter().enumerate() {
            let (name, index) = (&constraint.name, constraint.index.as_ref());
            let difference = &constraint.difference;
            let shape = self.members(&mut rows, name, index, |lower, rows, name| {
                lower.member_rows(rows, statement, name, difference, None)
            });
            self.shapes.push(shape);
        }
        self.constrained = false;
        rows
    }

    /// Returns the scalars of all limits.
    pub(super) fn limits(&mut self) -> Vec<Row> {
        self.constrained = true;
        let mut rows = Vec::new();
        for (statement, limit) in self.model.limits.iter().enumerate() {
            let (name, index) = (&limit.name, limit.index.as_ref());
            let restitution = Some(&limit.restitution);
            let shape = self.members(&mut rows, name, index, |lower, rows, name| {
                lower.member_rows(rows, statement, name, &limit.difference, restitution)
            });
            self.contacts.push(shape);
        }
        self.constrained = false;
        rows
    }

    /// Adds the rows of each member of a family, or those of a single one, by `member`, which takes
    /// the name of the member and returns the number of components, or 0 for a scalar.
    pub(super) fn members<R>(
        &mut self,
        rows: &mut Vec<R>,
        name: &Ident,
        index: Option<&Binder>,
        mut member: impl FnMut(&mut Self, &mut Vec<R>, &str) -> usize,
    ) -> Shape {
        let first = rows.len();
        let own = name.to_string();
        let Some(binder) = index else {
            let components = member(self, rows, &own);
            return Shape { first, members: None, components };
        };
        let range = self.range(binder);
        if range.is_empty() {
            let message = shared::empty_family(&own);
            self.errors.once(binder.high.source, binder.high.range, message);
        }
        let (mut members, mut width) = (0, 0);
        for k in range.clone() {
            self.bind(binder, k);
            let name = format!("{own}[{}]", k - range.start);
            let before = rows.len();
            let components = member(self, rows, &name);
            self.unbind();
            if rows.len() == before {
                break;
            }
            members += 1;
            width = components;
        }
        Shape { first, members: Some(members), components: width }
    }

    /// Adds the scalars of one member. Returns the number of components, or 0 for a scalar.
    fn member_rows(
        &mut self,
        rows: &mut Vec<Row>,
        statement: usize,
        name: &str,
        difference: &Expr,
        restitution: Option<&Expr>,
    ) -> usize {
        let [left, right] = difference.sides().map(|side| {
            let value = self.expr(side);
            (side, self.components(value))
        });
        if left.1 == Value::Bad || right.1 == Value::Bad {
            return 0;
        }
        if [&left, &right].into_iter().any(|(_, value)| matches!(value, Value::Rotation(_))) {
            let [a, b] = [left, right].map(|(side, _)| text(side));
            let message = message!(
                "rotations are no sides of an equation; write directions that shall agree, as in \
                 `inner({a}*u, {b}*v) = 0` for two or three pairs of vectors"
            );
            self.wrong(difference, message);
            return 0;
        }
        for (side, value) in [&left, &right] {
            if let Value::Family(members) = value {
                self.whole_family(difference, side, name, members.len());
                return 0;
            }
        }
        let zero = |value: &Value| *value == Value::Scalar(Graph::ZERO);
        let complex = |value: &Value| matches!(value, Value::Plane { complex: true, .. });
        let alike = left.1.scalars().len() == right.1.scalars().len()
            || [&left.1, &right.1].into_iter().any(|value| zero(value) || complex(value));
        if !alike {
            let [left, right] =
                [left, right].map(|(side, value)| format!("`{}` is {}", text(side), value.kind()));
            let message = message!("{left}, but {right}; both sides have one shape");
            self.wrong(difference, message);
            return 0;
        }
        let value = self.expr(difference);
        let value = self.components(value);
        let scalars = value.scalars();
        if !scalars.iter().all(|&scalar| self.within_bounds(difference, scalar)) {
            return 0;
        }
        let vector = !matches!(value, Value::Scalar(_));
        let bound = match restitution {
            Some(_) if vector => {
                self.unfit(difference, &value, ", and a limit is one number; write a component");
                None
            }
            Some(restitution) => self.restitution(restitution),
            None => Some(Graph::ZERO),
        };
        let Some(restitution) = bound else { return 0 };
        for (k, &value) in scalars.iter().enumerate() {
            let name =
                if vector { format!("{name}.{}", ["x", "y", "z"][k.min(2)]) } else { name.into() };
            rows.push(Row { statement, name, value, restitution });
        }
        if vector { scalars.len() } else { 0 }
    }

    /// Reports a family where the row `name` takes one member of it.
    pub(super) fn whole_family(&mut self, at: &Expr, family: &Expr, name: &str, count: usize) {
        let own = text(family);
        let message = message!(
            "`{own}` is a family; write it for one member, as `{name}[k in 0..{count}]: …` with \
             `{own}[k]`"
        );
        self.wrong(at, message);
    }

    /// Returns a restitution, which may depend only on parameters and numbers.
    fn restitution(&mut self, expr: &Expr) -> Option<Id> {
        let value = self.scalar(expr)?;
        if self.graph.dependencies(value).any(Dependencies::STATE) {
            let text = text(expr);
            let message =
                message!("`{text}` moves, and a restitution is made of parameters and numbers");
            self.wrong(expr, message);
            return None;
        }
        if let Node::Number(number) = self.graph.node(value)
            && (number.is_negative()
                || Rational::ONE.add(number.negative()).is_none_or(Rational::is_negative))
        {
            let text = text(expr);
            let message = message!(
                "`{text}` is no restitution; write a number from 0, no rebound, to 1, no loss"
            );
            self.wrong(expr, message);
            return None;
        }
        Some(value)
    }

    /// Returns the multipliers of a constraint, the reactions of a limit or the forces of a friction.
    pub(super) fn reaction(
        &mut self,
        ident: &Ident,
        index: Option<&Expr>,
        friction: bool,
        expr: &Expr,
    ) -> Value {
        let (model, base) = (self.model, name::plain(ident));
        let named = |own: &Ident| name::plain(own) == base;
        let constraint = model.constraints.iter().position(|own| named(&own.name));
        let limit = model.limits.iter().position(|own| named(&own.name) && !friction);
        let rubbed = model.frictions.iter().position(|own| named(own.name));
        let (symbol, shape): (fn(usize) -> Symbol, _) = match (constraint, limit, rubbed) {
            (Some(constraint), ..) => (Symbol::Multiplier, self.shapes.get(constraint).copied()),
            (_, Some(limit), _) => (Symbol::Contact, self.contacts.get(limit).copied()),
            (.., Some(rubbed)) => (Symbol::Friction, self.frictions.get(rubbed).copied()),
            _ => return Value::Bad,
        };
        let Some(shape) = shape else { return Value::Bad };
        let width = shape.components.max(1);
        let member = |graph: &mut Graph, k: usize| {
            let scalar = |offset| graph.symbol(symbol(shape.first + k * width + offset));
            let parts: Vec<Id> = (0..width).map(scalar).collect();
            if shape.components == 0 { Value::Scalar(parts[0]) } else { Value::vector(&parts) }
        };
        match (shape.members, index) {
            (None, None) => member(self.graph, 0),
            (None, Some(_)) => {
                self.wrong(expr, message!("`{ident}` is no family; write `reaction({ident})`"))
            }
            (Some(members), None) => {
                Value::Family((0..members).map(|k| member(self.graph, k)).collect())
            }
            // The constraint has no members because of a mistake that has been reported.
            (Some(0), Some(_)) => Value::Bad,
            (Some(members), Some(index)) => match self.index(index, members, &ident.to_string()) {
                Some(k) => member(self.graph, usize::try_from(k).unwrap_or(0)),
                None => Value::Bad,
            },
        }
    }
}
