//! Arithmetic of scalars, vectors and complex numbers.

use super::context::Lower;
use super::rate::{second_derivative, total_derivative};
use super::rotation::{self, Turned, ZERO};
use super::turn::{turned, without_common};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::mechanics::derivation::named_input;
use crate::messages::message;
use crate::messages::shared::{self, NO_ACCELERATION, NO_ACCELERATION_IN_CONSTRAINT, NO_JERK};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name;
use crate::syntax::text::text;
use std::mem::discriminant;

impl Lower<'_, '_, '_, '_> {
    /// Returns the total time derivative. If `may_rest` is set, a constant operand is allowed.
    pub(super) fn dot(&mut self, value: Value, expr: &Expr, may_rest: bool) -> Value {
        if let Value::Rotation(_) = value {
            let what = match &expr.kind {
                ExprKind::Name(name) => name::read(&name.to_string()).base,
                _ => text(expr),
            };
            let message = message!(
                "the derivative of a rotation is no vector; write `angular_velocity({what})`, or \
                 `dot({what}*u)` for a vector that it turns"
            );
            return self.wrong(expr, message);
        }
        self.rate(value, expr, may_rest)
    }

    /// Returns the total time derivative of numbers and vectors, and the angular velocity of a
    /// rotation.
    pub(super) fn rate(&mut self, value: Value, expr: &Expr, may_rest: bool) -> Value {
        let dependencies = self.dependencies(&value);
        let moving = Dependencies::TIME
            .or(Dependencies::COORDINATE)
            .or(Dependencies::VELOCITY)
            .or(Dependencies::INPUT);
        if value == Value::Bad {
            return value;
        }
        if dependencies.any(Dependencies::CONTROL) {
            return self.control_rate(&value, expr);
        }
        let what = text(expr);
        let velocity = dependencies.any(Dependencies::VELOCITY);
        let refusal = if dependencies.any(Dependencies::MULTIPLIER) {
            Some(message!(
                "the derivative of a reaction in `{what}` is not known; leave the reaction out of \
                 it"
            ))
        } else if dependencies.any(Dependencies::ACCELERATION) {
            Some(message!("the derivative of an acceleration in `{what}` {NO_JERK}"))
        } else if velocity && self.constrained {
            Some(message!(
                "the derivative of a velocity in `{what}` {NO_ACCELERATION_IN_CONSTRAINT}"
            ))
        } else if velocity && !self.accelerations {
            Some(message!("the derivative of a velocity in `{what}` {NO_ACCELERATION}"))
        } else if dependencies.any(Dependencies::ACCELERATION_INPUT) {
            Some(message!("`{what}` contains a third derivative of a driven input; they have two"))
        } else if !dependencies.any(moving) && !may_rest {
            Some(message!(
                "nothing in `{what}` moves, so its time derivative is zero; leave it out"
            ))
        } else {
            None
        };
        if let Some(message) = refusal {
            return self.wrong(expr, message);
        }
        self.rates_within(&value.scalars(), expr.range);
        let (positions, rates) = (self.positions.take(), std::mem::take(&mut self.rates));
        let accelerations = self.accelerations;
        let rate = |graph: &mut Graph, id: Id| match positions
            .as_ref()
            .and_then(|positions| positions.places.get(&id))
        {
            Some(&scalar) => graph.symbol(Symbol::Auxiliary(scalar)),
            None if accelerations => second_derivative(graph, id, &rates),
            None => total_derivative(graph, id, &rates),
        };
        let value = match value {
            Value::Turned(vector) => turned(vector.derivative(self.graph, ZERO, &rate)),
            Value::Rotation(rotation) => turned(rotation.angular_velocity(self.graph, &rate)),
            value => self.map(value, rate),
        };
        (self.positions, self.rates) = (positions, rates);
        value
    }

    /// Refuses the derivative of a value that contains a control input.
    pub(super) fn control_rate(&mut self, value: &Value, expr: &Expr) -> Value {
        match named_input(self.model, self.graph, &value.scalars(), None) {
            Some(name) => self.wrong(expr, shared::derivative_of_control(name)),
            None => Value::Bad,
        }
    }

    pub(super) fn dependencies(&self, value: &Value) -> Dependencies {
        let scalars = value.scalars();
        let each = scalars.iter().map(|&id| self.graph.dependencies(id));
        each.fold(Dependencies::default(), Dependencies::or)
    }

    /// Applies a function to all scalars of a value, a linear function if it is a turned vector.
    pub(super) fn map(&mut self, value: Value, mut map: impl FnMut(&mut Graph, Id) -> Id) -> Value {
        self.map_with(value, &mut map)
    }

    pub(super) fn map_with(
        &mut self,
        value: Value,
        map: &mut impl FnMut(&mut Graph, Id) -> Id,
    ) -> Value {
        match value {
            Value::Bad => Value::Bad,
            Value::Scalar(id) => Value::Scalar(map(self.graph, id)),
            Value::Plane { parts, complex } => {
                Value::Plane { parts: parts.map(|id| map(self.graph, id)), complex }
            }
            Value::Space(parts) => Value::Space(parts.map(|id| map(self.graph, id))),
            Value::Matrix(entries) => Value::Matrix(entries.map(|id| map(self.graph, id))),
            Value::Turned(vector) => turned(vector.map(self.graph, map)),
            rotation @ Value::Rotation(_) => rotation,
            Value::Family(members) => Value::Family(
                members.into_iter().map(|member| self.map_with(member, map)).collect(),
            ),
        }
    }

    pub(super) fn add(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match (a, b) {
            (Value::Bad, _) | (_, Value::Bad) => Value::Bad,
            (a @ Value::Matrix(_), _) | (_, a @ Value::Matrix(_)) => {
                self.unfit(expr, &a, ", and a sum has none; add vectors, as in `J*u + K*u`")
            }
            // An empty sum is zero, regardless of the shape of its terms.
            (Value::Scalar(Graph::ZERO), other) | (other, Value::Scalar(Graph::ZERO)) => other,
            (Value::Scalar(a), Value::Scalar(b)) => Value::Scalar(self.graph.add(a, b)),
            (
                Value::Plane { parts: a, complex: left },
                Value::Plane { parts: b, complex: right },
            ) => {
                let parts = [self.graph.add(a[0], b[0]), self.graph.add(a[1], b[1])];
                Value::Plane { parts, complex: left && right }
            }
            (Value::Plane { parts, complex: true }, Value::Scalar(real))
            | (Value::Scalar(real), Value::Plane { parts, complex: true }) => {
                Value::Plane { parts: [self.graph.add(parts[0], real), parts[1]], complex: true }
            }
            (Value::Space(a), Value::Space(b)) => {
                Value::Space([0, 1, 2].map(|k| self.graph.add(a[k], b[k])))
            }
            (Value::Space(a), Value::Turned(b)) => turned(Turned::from(a).plus(self.graph, &b)),
            (Value::Turned(a), Value::Space(b)) => turned(a.plus(self.graph, &Turned::from(b))),
            (Value::Turned(a), Value::Turned(b)) => turned(a.plus(self.graph, &b)),
            (Value::Rotation(_), _) | (_, Value::Rotation(_)) => {
                let message = message!(
                    "a sum of rotations is no rotation, and `{}` is one; add vectors that they \
                     turn, as in `A*u + B*u`",
                    text(expr)
                );
                self.wrong(expr, message)
            }
            (a, b) => {
                let others = match &a {
                    Value::Family(_) => "families".to_owned(),
                    a => format!("{}s", a.kind().trim_start_matches("a ")),
                };
                let instead = format!(
                    ", but the terms before it are {others}; a sum needs terms of one kind"
                );
                self.unfit(expr, &b, &instead)
            }
        }
    }

    /// Returns the sum of many values, all of which result from `expr`.
    ///
    /// All terms are summed in a single operation, because a sum that grows term by term would be
    /// rebuilt for each term.
    pub(super) fn total(&mut self, values: Vec<Value>, expr: &Expr) -> Value {
        let Some(first) = values.first().cloned() else { return Value::Scalar(Graph::ZERO) };
        let alike = |value: &Value| {
            discriminant(value) == discriminant(&first) && value.kind() == first.kind()
        };
        let summed = first.parts().is_some() || matches!(first, Value::Scalar(_));
        if summed && values.iter().all(alike) {
            let mut columns = 0..;
            return self.map(first, |graph, _| {
                let column = columns.next().unwrap_or(0);
                graph.total(values.iter().map(|value| value.scalars()[column]))
            });
        }
        let sum = values.into_iter().reduce(|sum, value| self.add(sum, value, expr));
        sum.unwrap_or(Value::Bad)
    }

    pub(super) fn multiply(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match (a, b) {
            (Value::Bad, _) | (_, Value::Bad) => Value::Bad,
            (
                Value::Scalar(a),
                b @ (Value::Scalar(_) | Value::Plane { .. } | Value::Space(_) | Value::Turned(_)),
            ) => self.map(b, |graph, id| graph.mul(a, id)),
            (a @ (Value::Plane { .. } | Value::Space(_) | Value::Turned(_)), Value::Scalar(b)) => {
                self.map(a, |graph, id| graph.mul(id, b))
            }
            (
                Value::Plane { parts: a, complex: left },
                Value::Plane { parts: b, complex: right },
            ) => Value::Plane { parts: self.complex_product(a, b), complex: left && right },
            (a, b) => {
                let (a, b) = (a.kind(), b.kind());
                self.wrong(
                    expr,
                    message!("{a} cannot be multiplied by {b}; write a component or an index"),
                )
            }
        }
    }

    pub(super) fn complex_product(&mut self, a: [Id; 2], b: [Id; 2]) -> [Id; 2] {
        let graph = &mut *self.graph;
        let (rr, ii) = (graph.mul(a[0], b[0]), graph.mul(a[1], b[1]));
        let (ri, ir) = (graph.mul(a[0], b[1]), graph.mul(a[1], b[0]));
        [graph.sub(rr, ii), graph.add(ri, ir)]
    }

    pub(super) fn divide(&mut self, a: Value, b: Value, expr: &Expr) -> Value {
        match b {
            Value::Bad => Value::Bad,
            Value::Scalar(b) if self.is_constant(b) && self.constant(b) == 0.0 => {
                self.wrong(expr, message!("division by zero; write another divisor"))
            }
            Value::Scalar(b) => match a {
                Value::Family(_) => self.multiply(a, Value::Scalar(b), expr),
                a => self.map(a, |graph, id| graph.div(id, b)),
            },
            Value::Plane { parts: [re, im], complex: true } => {
                let square = self.square(&[re, im]);
                let conjugate =
                    [re, self.graph.negative(im)].map(|part| self.graph.div(part, square));
                self.multiply(a, Value::Plane { parts: conjugate, complex: true }, expr)
            }
            other => self.unfit(
                expr,
                &other,
                ", and nothing can be divided by that; divide by its length `|u|`",
            ),
        }
    }

    pub(super) fn power(&mut self, base: &Expr, exponent: &Expr) -> Value {
        let value = match &base.kind {
            ExprKind::Magnitude(inner) => {
                let value = self.expr(inner);
                if let Value::Turned(vector) = &value
                    && self.integer(exponent).is_ok_and(|power| power == 2)
                    && self.by_terms(&value)
                {
                    let (vector, _, _) = Turned::common(vector, vector);
                    let square = Turned::inner_by_terms(self.graph, &vector, &vector);
                    return Value::Scalar(square);
                }
                let length = self.length(value, inner);
                self.real(length, base)
            }
            _ => self.expr(base),
        };
        let Some(power) = self.scalar(exponent) else { return Value::Bad };
        if let Node::Number(number) = self.graph.node(power)
            && number.within(60).is_none()
        {
            let message = message!(
                "this exponent is too long for exact arithmetic; write one of at most eighteen \
                 digits"
            );
            return self.wrong(exponent, message);
        }
        match value {
            Value::Bad => Value::Bad,
            Value::Scalar(Graph::ZERO) if self.integer(exponent).is_ok_and(|power| power < 0) => {
                self.wrong(base, message!("zero has no negative power; write another base"))
            }
            Value::Scalar(id) if self.without_power(id, power) => {
                let (own, exponent) = (text(base), text(exponent));
                let message = message!(
                    "`{own}` has powers with fixed exponents only, and `{exponent}` changes; \
                     write a positive base"
                );
                self.wrong(base, message)
            }
            Value::Scalar(id) => Value::Scalar(self.graph.general_power(id, power)),
            Value::Plane { parts, complex: true } => match self.integer(exponent) {
                Ok(count) if (0..=64).contains(&count) => {
                    let parts = (0..count).fold([Graph::ONE, Graph::ZERO], |product, _| {
                        self.complex_product(product, parts)
                    });
                    Value::Plane { parts, complex: true }
                }
                _ => {
                    let message = message!(
                        "a complex number has whole powers from 0 to 64 here; write `exp(i*φ)` \
                         for others"
                    );
                    self.wrong(exponent, message)
                }
            },
            other => {
                let found = text(base);
                let instead = match other {
                    Value::Rotation(_) => format!("{found}*{found}"),
                    Value::Matrix(_) => format!("{found}*({found}*u)"),
                    _ => format!("|{found}|^2"),
                };
                let instead = format!(", and only scalars have powers; write `{instead}`");
                self.unfit(base, &other, &instead)
            }
        }
    }

    /// Returns `true` if a constant is not positive and an exponent is not constant.
    fn without_power(&mut self, base: Id, exponent: Id) -> bool {
        self.is_constant(base) && !self.is_constant(exponent) && self.constant(base) <= 0.0
    }

    fn is_constant(&self, id: Id) -> bool {
        self.graph.dependencies(id) == Dependencies::default()
    }

    pub(super) fn cis(&mut self, angle: Id) -> Value {
        let parts = [self.graph.call(Function::Cos, angle), self.graph.call(Function::Sin, angle)];
        Value::Plane { parts, complex: true }
    }

    pub(super) fn inner(&mut self, a: &Expr, b: &Expr) -> Value {
        let (left, right) = (self.expr(a), self.expr(b));
        let by_terms = self.by_terms(&left) && self.by_terms(&right);
        let (left, right, _) = without_common(left, right);
        if let (Value::Turned(a), Value::Turned(b)) = (&left, &right)
            && by_terms
        {
            return Value::Scalar(Turned::inner_by_terms(self.graph, a, b));
        }
        let (left, right) = (self.components(left), self.components(right));
        match (left.parts(), right.parts()) {
            (Some(a), Some(b)) if a.len() == b.len() => Value::Scalar(self.graph.inner(a, b)),
            _ => self.no_vectors(b, "inner", &left, &right),
        }
    }

    pub(super) fn cross(&mut self, a: &Expr, b: &Expr) -> Value {
        let (left, right) = (self.expr(a), self.expr(b));
        let (left, right, turns) = without_common(left, right);
        let (left, right) = (self.components(left), self.components(right));
        let graph = &mut *self.graph;
        match (&left, &right) {
            (Value::Plane { parts: a, .. }, Value::Plane { parts: b, .. }) => {
                let (first, second) = (graph.mul(a[0], b[1]), graph.mul(a[1], b[0]));
                Value::Scalar(graph.sub(first, second))
            }
            (&Value::Space(a), &Value::Space(b)) => {
                let product = Turned::from(rotation::cross(graph, a, b));
                turned(turns.apply(graph, product))
            }
            _ => self.no_vectors(b, "cross", &left, &right),
        }
    }

    fn no_vectors(&mut self, expr: &Expr, function: &str, left: &Value, right: &Value) -> Value {
        if *left == Value::Bad || *right == Value::Bad {
            return Value::Bad;
        }
        let (left, right) = (left.kind(), right.kind());
        self.wrong(
            expr,
            message!("`{function}` takes two vectors of one length; these are {left} and {right}"),
        )
    }

    pub(super) fn magnitude(&mut self, inner: &Expr) -> Value {
        let value = self.expr(inner);
        self.length(value, inner)
    }

    fn length(&mut self, value: Value, inner: &Expr) -> Value {
        let value = match value {
            // Turns do not change a length.
            Value::Turned(vector) => turned(Turned::common(&vector, &vector).0),
            value => value,
        };
        let value = self.components(value);
        if let Some(load) = self.load(&value) {
            return Value::Scalar(load);
        }
        if let Some(parts) = value.parts() {
            let square = self.square(parts);
            return Value::Scalar(self.graph.sqrt(square));
        }
        let instead = match value {
            Value::Scalar(id) => return Value::Scalar(self.graph.call(Function::Abs, id)),
            Value::Bad => return Value::Bad,
            Value::Matrix(_) => ", which has no length; write that of a vector `J*u`",
            Value::Family(_) => "; write one of its members",
            _ => ", which has no length; write the vector that it turns, as in `|R*u|`",
        };
        self.unfit(inner, &value, instead)
    }

    pub(super) fn square(&mut self, parts: &[Id]) -> Id {
        self.graph.inner(parts, parts)
    }
}
