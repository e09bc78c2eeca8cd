//! Lowering of rotations, and of vectors behind them.

use super::context::Lower;
use super::rotation::{MOST_FACTORS, Rotation, Turn, Turned};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::quaternion;
use crate::messages::message;
use crate::syntax::ast::{Binder, Expr, ExprKind};
use crate::syntax::text::text;

impl Lower<'_, '_, '_, '_> {
    /// Returns a value with the components of turned vectors.
    pub(super) fn components(&mut self, value: Value) -> Value {
        match value {
            Value::Turned(vector) => Value::Space(vector.components(self.graph)),
            Value::Family(members) => {
                Value::Family(members.into_iter().map(|member| self.components(member)).collect())
            }
            value => value,
        }
    }

    /// Returns the value of an expression with the components of turned vectors.
    pub(super) fn plain(&mut self, expr: &Expr) -> Value {
        let value = self.expr(expr);
        self.components(value)
    }

    /// Refuses an entry of a rotation.
    pub(super) fn no_entries(&mut self, expr: &Expr) -> Value {
        let found = text(expr);
        let message = message!(
            "`{found}` is a rotation, whose entries have no names; write `inner(u, {found}*v)` \
             for the entry between two directions"
        );
        self.wrong(expr, message)
    }

    /// Returns `true` if products of a vector are sums over pairs of its terms: those of rates,
    /// which are collected by velocities later, and of points, which are integrated.
    pub(super) fn by_terms(&self, value: &Value) -> bool {
        let each = Dependencies::VELOCITY.or(Dependencies::AUXILIARY).or(Dependencies::POINT);
        self.dependencies(value).any(each)
    }

    /// Returns `rotation(axis, angle)`.
    pub(super) fn rotation(&mut self, axis: &Expr, angle: &Expr) -> Value {
        let value = self.expr(axis);
        let value = self.components(value);
        let Some(angle) = self.scalar(angle) else { return Value::Bad };
        let parts = match value {
            Value::Bad => return Value::Bad,
            Value::Space(parts) => parts,
            Value::Plane { .. } => {
                let message = message!(
                    "`{}` is a plane vector, and a rotation turns about an axis in space; write \
                     three components, or turn plane vectors with `cis(φ)*u`",
                    text(axis)
                );
                return self.wrong(axis, message);
            }
            other => {
                let instead = ", and an axis is a space vector; write `rotation([0, 0, 1], φ)`";
                return self.unfit(axis, &other, instead);
            }
        };
        let square = self.square(&parts);
        let constant = self.graph.dependencies(square) == Dependencies::default();
        if constant && self.constant(square) == 0.0 {
            let message =
                message!("`{}` has no direction; write an axis that is not zero", text(axis));
            return self.wrong(axis, message);
        }
        let length = self.graph.sqrt(square);
        let parts = parts.map(|part| self.graph.div(part, length));
        Value::Rotation(Rotation::of(Turn::about(self.graph, parts, angle)))
    }

    /// Returns the value of an expression that has to be a rotation.
    fn rotation_of(&mut self, expr: &Expr, what: &str) -> Option<Rotation> {
        match self.expr(expr) {
            Value::Rotation(rotation) => Some(rotation),
            Value::Bad => None,
            other => {
                let instead = format!(
                    ", and {what} is that of a rotation; write one, as in `rotation(n, φ)`"
                );
                self.unfit(expr, &other, &instead);
                None
            }
        }
    }

    pub(super) fn transpose(&mut self, expr: &Expr) -> Value {
        match self.rotation_of(expr, "a transpose") {
            Some(rotation) => Value::Rotation(rotation.inverse(self.graph)),
            None => Value::Bad,
        }
    }

    pub(super) fn angular_velocity(&mut self, expr: &Expr) -> Value {
        match self.rotation_of(expr, "an angular velocity") {
            Some(rotation) => self.rate(Value::Rotation(rotation), expr, true),
            None => Value::Bad,
        }
    }

    /// Returns the rotation of a driven input, a quaternion q of any length.
    ///
    /// A motion that is given by keys or by a formula is seldom a unit quaternion to rounding, and
    /// between keys that are joined by straight lines it is far from one. Its matrix is therefore
    /// that of q/|q|, and its rates are 2 q* q̇/|q|².
    pub(super) fn driven_rotation(&mut self, input: usize) -> Turn {
        let graph = &mut *self.graph;
        let [q, v] = [0, 1].map(|order| {
            [0, 1, 2, 3].map(|component| graph.symbol(Symbol::Input { input, component, order }))
        });
        let squares = q.map(|part| (graph.power(part, Rational::whole(2)), Rational::ONE));
        let square = graph.sum(&squares);
        // Closed, so that it is divided by once.
        let square = graph.power(square, Rational::MINUS_ONE);
        let square = graph.closed(square);
        let scale = graph.power(square, Rational::HALF);
        let [q, v] = [q, v].map(|parts| parts.map(|part| graph.mul(part, scale)));
        let back = quaternion::conjugate(graph, q);
        let [_, x, y, z] = quaternion::product(graph, Rational::whole(2), back, v);
        let rates = [x, y, z].map(|rate| graph.closed(rate));
        let entries = quaternion::matrix(graph, q).map(|entry| graph.closed(entry));
        Turn::by_matrix(q, entries, rates)
    }

    /// Returns the product of two rotations, or refuses one of too many factors.
    pub(super) fn compose(&mut self, a: Rotation, b: &Rotation, expr: &Expr) -> Option<Rotation> {
        let product = a.times(self.graph, b);
        if MOST_FACTORS < product.factors() {
            let message = message!(
                "this is a product of more than {MOST_FACTORS} rotations; write a shorter chain"
            );
            self.wrong(expr, message);
            return None;
        }
        Some(product)
    }

    /// Returns `product(k in 0..n, A[k])`.
    pub(super) fn product_over(&mut self, binder: &Binder, factor: &Expr) -> Value {
        let mut product = Some(Rotation::default());
        for k in self.range(binder) {
            self.bind(binder, k);
            let next = self.rotation_of(factor, "a `product` over an index");
            self.unbind();
            product = match (product, next) {
                (Some(product), Some(next)) => self.compose(product, &next, factor),
                _ => None,
            };
            if product.is_none() {
                return Value::Bad;
            }
        }
        product.map_or(Value::Bad, Value::Rotation)
    }

    /// Returns a factor without its signs, and `true` if they are an odd number: the sign of
    /// `-R*u` belongs to the product.
    pub(super) fn unsigned(expr: &Expr) -> (bool, &Expr) {
        match &expr.kind {
            ExprKind::Negative(inner) => {
                let (minus, inner) = Self::unsigned(inner);
                (!minus, inner)
            }
            _ => (false, expr),
        }
    }

    /// Returns the image of a value behind the rotation before it.
    pub(super) fn image(&mut self, rotation: &Rotation, value: Value, expr: &Expr) -> Value {
        match value {
            Value::Space(parts) => turned(rotation.apply(self.graph, Turned::from(parts))),
            Value::Turned(vector) => turned(rotation.apply(self.graph, vector)),
            Value::Plane { .. } => {
                let message = message!(
                    "`{}` is a plane vector, and a rotation turns vectors in space; write three \
                     components, or `cis(φ)*u` in the plane",
                    text(expr)
                );
                self.wrong(expr, message)
            }
            Value::Bad => Value::Bad,
            other => self.unfit(expr, &other, ", and a rotation turns a space vector"),
        }
    }
}

/// Returns a vector as a value, by components if nothing turns it.
pub(super) fn turned(vector: Turned) -> Value {
    match vector.whole() {
        Some(parts) => Value::Space(parts),
        None => Value::Turned(vector),
    }
}

/// Returns two vectors without the turns that stand before all of both, and these turns.
pub(super) fn without_common(a: Value, b: Value) -> (Value, Value, Rotation) {
    match (a, b) {
        (Value::Turned(a), Value::Turned(b)) => {
            let (a, b, turns) = Turned::common(&a, &b);
            // They stay turned vectors, even if nothing is left before them.
            (Value::Turned(a), Value::Turned(b), turns)
        }
        (a, b) => (a, b, Rotation::default()),
    }
}
