//! The frames of expressions.

use super::frames::{Frame, SPACE};
use super::{Evidence, Local, Needs, Scan, Use};
use crate::algebra::functions::{Lowering, Word};
use crate::model::integer;
use crate::model::resolved::{Element, Meaning};
use crate::syntax::ast::{Binder, Expr, ExprKind};
use crate::syntax::name::plain;
use crate::syntax::text::text;
use std::ops::Range;

/// The limits on the depth of nesting and on evaluations, which protect the compiler's stack and
/// time. Beyond them, nothing is known.
const DEEPEST: usize = 200;
const LIMIT: usize = 200_000;

/// The value of an expression, as far as frames need it. `true` stands for what consists of
/// parameters and numbers alone.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// A number, a plane vector, or anything else without a frame.
    Plain(bool),
    Vector(Frame, bool),
    /// A matrix, by the parameter to which it belongs.
    Matrix(usize),
    Rotation(Rotation),
    Family(Vec<Value>),
}

impl Value {
    fn is_constant(&self) -> bool {
        match self {
            Self::Plain(constant) | Self::Vector(_, constant) => *constant,
            Self::Rotation(rotation) => rotation.constant,
            Self::Matrix(_) => true,
            Self::Family(members) => members.iter().all(Self::is_constant),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation {
    /// The frames to which and from which it leads.
    pub(super) ends: [Frame; 2],
    /// `true` for each of these to which a declared factor leads.
    led: [bool; 2],
    /// `true` if a factor is declared, and the number of factors about an axis.
    declared: bool,
    angles: usize,
    /// `true` if it consists of parameters and numbers alone.
    constant: bool,
}

impl Rotation {
    pub(super) fn declared(ends: [Frame; 2]) -> Self {
        Self { ends, led: [true, false], declared: true, angles: 0, constant: false }
    }

    /// Returns a product of rotations about axes.
    fn about(ends: [Frame; 2], angles: usize, constant: bool) -> Self {
        Self { ends, led: [false; 2], declared: false, angles, constant }
    }

    fn times(self, inner: Self) -> Self {
        Self {
            ends: [self.ends[0], inner.ends[1]],
            led: [self.led[0], inner.led[1]],
            declared: self.declared || inner.declared,
            angles: self.angles + inner.angles,
            constant: self.constant && inner.constant,
        }
    }

    /// Returns `true` for a rotation about an axis by one angle.
    pub(super) fn is_single(self) -> bool {
        !self.declared && self.angles == 1
    }

    /// Returns `true` if a name keeps its frames apart. An angle before a declared rotation may turn
    /// vectors within space, as in `rotation(n, φ)*R` beside `R`.
    fn keeps_apart(self) -> bool {
        !self.declared || self.led.contains(&true)
    }
}

impl<'a> Scan<'_, 'a> {
    pub(super) fn expr(&mut self, expr: &'a Expr) -> Value {
        if DEEPEST <= self.depth || LIMIT <= self.work {
            return Value::Plain(false);
        }
        self.depth += 1;
        self.work += 1;
        let value = self.kind(expr);
        self.depth -= 1;
        value
    }

    fn kind(&mut self, expr: &'a Expr) -> Value {
        match &expr.kind {
            ExprKind::Number(_) => Value::Plain(true),
            ExprKind::Name(name) => self.name(&plain(name)),
            ExprKind::Sum(items) => {
                let items: Vec<_> = items.iter().map(|(_, item)| (item, self.expr(item))).collect();
                self.common(&items)
            }
            ExprKind::Product(items) => self.product(items),
            ExprKind::Negative(inner) => self.expr(inner),
            ExprKind::Call(name, items) => self.call(&plain(name), items),
            ExprKind::Index(base, index) => self.member(base, index),
            ExprKind::Component(base, component) => match self.solid(base) {
                Some(solid) if component == "inertia" => Value::Matrix(solid),
                Some(solid) if component == "center" => {
                    let frame = self.frames.unknown();
                    self.note(solid, frame, text(expr), false, expr);
                    Value::Vector(frame, true)
                }
                Some(_) => Value::Plain(true),
                None => Value::Plain(self.expr(base).is_constant()),
            },
            ExprKind::Vector(items) if items.len() == 3 => {
                let constant = self.are_constant(items.iter());
                Value::Vector(self.frames.unknown(), constant)
            }
            ExprKind::SumOver(binder, term) => {
                let terms = self.over(binder, term);
                self.common(&terms)
            }
            ExprKind::ProductOver(binder, factor) => {
                let mut product = None;
                for (item, value) in self.over(binder, factor) {
                    let Value::Rotation(own) = value else { return value };
                    product = Some(self.behind(product, own, &[item], item));
                }
                let end = self.frames.unknown();
                Value::Rotation(product.unwrap_or(Rotation::about([end; 2], 0, true)))
            }
            ExprKind::Reaction(..) => Value::Plain(false),
            ExprKind::Integral { point, body, integrand } => {
                let mut value = Value::Plain(false);
                if let Some(&Meaning::Parameter(body)) = self.model.names.get(&plain(body))
                    && self.model.parameters[body].element == Element::Solid
                {
                    let frame = self.frames.unknown();
                    self.note(body, frame, point.to_string(), false, integrand);
                    value = Value::Vector(frame, false);
                }
                self.scope.push((plain(point), Local::Value(value)));
                let value = self.expr(integrand);
                self.scope.pop();
                value
            }
            ExprKind::Magnitude(_) | ExprKind::Power(..) | ExprKind::Vector(_) => {
                Value::Plain(self.are_constant(expr.parts().into_iter()))
            }
        }
    }

    fn are_constant(&mut self, items: impl Iterator<Item = &'a Expr>) -> bool {
        let values: Vec<_> = items.map(|item| self.expr(item)).collect();
        values.iter().all(Value::is_constant)
    }

    /// Returns the values for all indices.
    fn over(&mut self, binder: &Binder, item: &'a Expr) -> Vec<(&'a Expr, Value)> {
        let mut values = Vec::new();
        for k in self.range(binder) {
            self.bind(binder, k);
            values.push((item, self.expr(item)));
            self.scope.pop();
        }
        values
    }

    fn note(
        &mut self,
        parameter: usize,
        frame: Frame,
        text: String,
        multiplied: bool,
        item: &'a Expr,
    ) {
        self.uses.push(Use { parameter, frame, text, multiplied, item });
    }

    /// Returns the solid that an expression names.
    fn solid(&self, expr: &Expr) -> Option<usize> {
        let body = self.model.body(expr, |name| self.local(name).is_some());
        body.filter(|&index| self.model.parameters[index].element == Element::Solid)
    }

    fn local(&self, base: &str) -> Option<&Local> {
        self.scope.iter().rev().find(|(name, _)| name == base).map(|(_, local)| local)
    }

    fn name(&mut self, base: &str) -> Value {
        match self.local(base) {
            Some(Local::Value(Value::Vector(_, true))) => {
                return Value::Vector(self.frames.unknown(), true);
            }
            Some(Local::Value(value)) => return value.clone(),
            Some(Local::Index(_)) => return Value::Plain(true),
            None => {}
        }
        match self.model.names.get(base) {
            Some(&Meaning::Parameter(index)) => match self.model.parameters[index].element {
                Element::Vector(3) => Value::Vector(self.frames.unknown(), true),
                Element::Matrix => Value::Matrix(index),
                _ => Value::Plain(true),
            },
            Some(&Meaning::Let(index)) => match &self.model.lets[index].index {
                None => self.definition(index, None),
                Some(binder) => {
                    let members = self.range(binder);
                    Value::Family(members.map(|k| self.definition(index, Some(k))).collect())
                }
            },
            Some(meaning) => self.quantities[meaning].clone(),
            None => Value::Plain(base != "t"),
        }
    }

    /// Returns one instance of a definition. What may stand in several frames is evaluated anew.
    pub(super) fn definition(&mut self, index: usize, k: Option<i64>) -> Value {
        if let Some(value) = self.lets.get(&(index, k)) {
            return value.clone();
        }
        let definition = self.model.lets[index];
        let scope = std::mem::take(&mut self.scope);
        if let (Some(k), Some(binder)) = (k, &definition.index) {
            self.bind(binder, k);
        }
        let value = self.expr(&definition.expr);
        self.scope = scope;
        match &value {
            Value::Vector(_, true) => return value,
            Value::Rotation(own) if own.constant || own.is_single() => return value,
            Value::Rotation(own) if own.keeps_apart() => {
                let name = definition.name.to_string();
                let name = k.map_or(name.clone(), |k| format!("{name}[{k}]"));
                let [own, needed] = own.ends;
                let needs = Needs::Name(name);
                self.equation(own, needed, &definition.expr, Evidence::Name, needs);
            }
            _ => {}
        }
        self.lets.insert((index, k), value.clone());
        value
    }

    fn call(&mut self, base: &str, items: &'a [Expr]) -> Value {
        if let Some(&Meaning::Let(index)) = self.model.names.get(base)
            && let Some(arguments) = &self.model.lets[index].arguments
        {
            let values: Vec<_> = items.iter().map(|item| Local::Value(self.expr(item))).collect();
            let bound = arguments.iter().map(plain).zip(values).collect();
            let scope = std::mem::replace(&mut self.scope, bound);
            let value = self.expr(&self.model.lets[index].expr);
            self.scope = scope;
            return value;
        }
        let values: Vec<_> = items.iter().map(|item| (item, self.expr(item))).collect();
        let constant = values.iter().all(|(_, value)| value.is_constant());
        match (Word::named(base).map(|word| word.lowering), &values[..]) {
            (Some(Lowering::Dot), [(_, value)]) => value.clone(),
            (Some(Lowering::Height), &[(item, Value::Vector(frame, _))]) => {
                self.equation(frame, SPACE, item, Evidence::Height, Needs::Height);
                Value::Plain(constant)
            }
            (Some(Lowering::Transpose), &[(_, Value::Rotation(own))]) => {
                let ([target, source], [a, b]) = (own.ends, own.led);
                Value::Rotation(Rotation { ends: [source, target], led: [b, a], ..own })
            }
            (Some(Lowering::AngularVelocity), &[(_, Value::Rotation(own))]) => {
                // Those of a single angle are equal on both sides, and zero is everywhere.
                let anywhere = own.is_single() || own.constant;
                let frame = if anywhere { self.frames.unknown() } else { own.ends[0] };
                Value::Vector(frame, own.constant)
            }
            (Some(lowering @ (Lowering::Inner | Lowering::Cross)), values) => {
                match (self.common(values), lowering) {
                    (vector, Lowering::Cross) => vector,
                    _ => Value::Plain(constant),
                }
            }
            (Some(Lowering::Rotation), [(_, axis), _]) => {
                let end = self.frames.unknown();
                // An axis that moves has components of one frame, in which the rotation turns.
                let start = if axis.is_constant() { self.frames.unknown() } else { end };
                Value::Rotation(Rotation::about([end, start], 1, constant))
            }
            _ => Value::Plain(constant),
        }
    }

    /// Returns the common value of expressions, whose vectors have one frame.
    fn common(&mut self, items: &[(&'a Expr, Value)]) -> Value {
        let constant = items.iter().all(|(_, value)| value.is_constant());
        let mut vectors = items.iter().filter_map(|(item, value)| match value {
            Value::Vector(frame, _) => Some((*item, *frame)),
            _ => None,
        });
        let Some((first, needed)) = vectors.next() else { return Value::Plain(constant) };
        for (item, own) in vectors {
            self.equation(own, needed, item, Evidence::Sum, Needs::Beside(first));
        }
        Value::Vector(needed, constant)
    }

    /// Returns the product of scalars, of rotations, and of the vector behind them.
    fn product(&mut self, items: &'a [(bool, Expr)]) -> Value {
        let mut turn: Option<Rotation> = None;
        let mut factors = Vec::new();
        let mut vector = None;
        let mut constant = true;
        for (index, (_, item)) in items.iter().enumerate() {
            let item = unsigned(item);
            let mut value = self.expr(item);
            let matrix = matches!(value, Value::Matrix(_));
            if let Value::Matrix(parameter) = value {
                let rest = &items[index + 1..];
                value = self.product(rest);
                if let (&Value::Vector(frame, _), Some((_, last))) = (&value, rest.last()) {
                    let texts: Vec<_> = rest.iter().map(|(_, item)| text(item)).collect();
                    self.note(parameter, frame, texts.join("*"), true, last);
                }
            }
            constant &= value.is_constant();
            match (value, turn) {
                (Value::Rotation(own), _) => {
                    turn = Some(self.behind(turn, own, &factors, item));
                    factors.push(item);
                }
                (Value::Vector(own, _), Some(rotation)) if vector.is_none() => {
                    let [end, needed] = rotation.ends;
                    let needs = Needs::Before(factors.clone(), None);
                    self.equation(own, needed, item, Evidence::Product, needs);
                    vector = Some(end);
                }
                (Value::Vector(own, _), _) => vector = Some(own),
                _ => {}
            }
            if matrix {
                break;
            }
        }
        match (turn, vector) {
            (_, Some(frame)) => Value::Vector(frame, constant),
            (Some(rotation), None) => Value::Rotation(rotation),
            (None, None) => Value::Plain(constant),
        }
    }

    /// Returns the product of a rotation and the one behind it.
    fn behind(
        &mut self,
        outer: Option<Rotation>,
        inner: Rotation,
        factors: &[&'a Expr],
        item: &'a Expr,
    ) -> Rotation {
        let Some(outer) = outer else { return inner };
        let needs = Needs::Before(factors.to_vec(), Some((outer, inner)));
        self.equation(inner.ends[0], outer.ends[1], item, Evidence::Product, needs);
        outer.times(inner)
    }

    fn member(&mut self, base: &'a Expr, index: &'a Expr) -> Value {
        let k = self.integer(index);
        if let (ExprKind::Name(name), Some(k)) = (&base.kind, k)
            && let own = plain(name)
            && let Some(&Meaning::Let(definition)) = self.model.names.get(&own)
            && self.model.lets[definition].index.is_some()
            && self.local(&own).is_none()
        {
            return self.definition(definition, Some(k));
        }
        match (self.expr(base), k.map(usize::try_from)) {
            (Value::Family(mut members), Some(Ok(k))) if k < members.len() => {
                members.swap_remove(k)
            }
            (value, _) => Value::Plain(value.is_constant()),
        }
    }

    /// Returns the integers of a range; none if they are not known.
    pub(super) fn range(&self, binder: &Binder) -> Range<i64> {
        let [low, high] = [&binder.low, &binder.high].map(|end| self.integer(end));
        let (Some(low), Some(high)) = (low, high) else { return 0..0 };
        low..high.saturating_add(i64::from(binder.inclusive))
    }

    fn integer(&self, expr: &Expr) -> Option<i64> {
        let index = |name: &str| match self.local(name) {
            Some(&Local::Index(k)) => Some(k),
            _ => None,
        };
        integer(expr, &index).ok()
    }

    pub(super) fn bind(&mut self, binder: &Binder, k: i64) {
        self.scope.push((plain(&binder.name), Local::Index(k)));
    }
}

/// Returns a factor without its signs.
fn unsigned(expr: &Expr) -> &Expr {
    match &expr.kind {
        ExprKind::Negative(inner) => unsigned(inner),
        _ => expr,
    }
}
