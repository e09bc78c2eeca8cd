//! The state of a lowering: names in scope, finished definitions, indices and ranges.

use super::positions::PositionTracker;
use super::row::Shape;
use super::value::Value;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::messages::{Errors, Range, Text, message, shared};
use crate::model::{self, Model};
use crate::syntax::ast::{Binder, Expr, Let};
use crate::syntax::name::{self, plain};
use crate::syntax::text::text;
use std::collections::{BTreeMap, BTreeSet};

/// The limit on the depth of the nodes of an energy or a force. Deeper expressions would overflow
/// the compiler's stack; nested definitions add to the depth.
const DEEPEST_NODE: usize = 1200;

/// The limit on the number of nodes of an energy or a force. The equations of larger expressions
/// would take minutes to derive and to compile.
pub(super) const LARGEST: usize = 8000;

/// The local meaning of a name within an expression.
pub(super) enum Local {
    /// An argument of a function or a point of integration.
    Value(Value),
    /// An index, and the source of the end of its range.
    Index { value: i64, source: usize },
}

/// The state of a lowering.
pub(super) struct Lower<'m, 'a, 'g, 'e> {
    pub(super) model: &'m Model<'a>,
    pub(super) graph: &'g mut Graph,
    pub(super) errors: &'e mut Errors,
    /// The bound indices, arguments and points, inner ones last.
    pub(super) scope: Vec<(String, Local)>,
    /// The finished definitions, by index and member.
    pub(super) instances: BTreeMap<(usize, Option<i64>), Value>,
    /// The definitions under evaluation.
    pub(super) open: Vec<(usize, Option<i64>)>,
    /// The parameters used with indices; `whole` contains those used without.
    pub(super) indexed: BTreeSet<usize>,
    pub(super) whole: BTreeSet<usize>,
    pub(super) work: usize,
    /// The number of expressions under evaluation.
    pub(super) depth: usize,
    /// The number of enclosing integrals.
    pub(super) integrals: usize,
    /// The positions whose velocities become symbols.
    pub(super) positions: Option<PositionTracker>,
    /// The values of expressions without symbols.
    pub(super) constants: BTreeMap<Id, f64>,
    /// `true` in outputs, where velocities have derivatives.
    pub(super) accelerations: bool,
    /// `true` in a constraint or a limit.
    pub(super) constrained: bool,
    /// The definitions whose positions are replaced by symbols from now on.
    pub(super) known: Option<BTreeMap<(usize, Option<i64>), Value>>,
    /// The shapes of the constraints.
    pub(super) shapes: Vec<Shape>,
    /// The rates of states lowered so far, by their places among the scalar coordinates.
    pub(super) rates: BTreeMap<usize, Id>,
    /// For the first scalar of each state or of its member, the statement of its rate with the
    /// index of the family; taken out while the rate is lowered.
    pub(super) rated: BTreeMap<usize, (usize, Option<i64>)>,
    /// The shapes of the limits, and of the frictions.
    pub(super) contacts: Vec<Shape>,
    pub(super) frictions: Vec<Shape>,
    /// The multipliers whose size enters the magnitude of a friction: the first and their number.
    pub(super) loads: Vec<[usize; 2]>,
}

impl Lower<'_, '_, '_, '_> {
    /// Returns `true` if a value is within the limits; otherwise reports it.
    pub(super) fn within_bounds(&mut self, expr: &Expr, value: Id) -> bool {
        let nodes = self.graph.reachable(&[value]);
        if LARGEST < nodes.len() {
            self.errors.once(expr.source, expr.range, large_value());
            return false;
        }
        let mut depths: BTreeMap<Id, usize> = BTreeMap::new();
        for id in nodes {
            let depth =
                self.graph.children(id).iter().map(|child| depths[child] + 1).max().unwrap_or(0);
            depths.insert(id, depth);
        }
        if DEEPEST_NODE < depths[&value] {
            let message = message!(
                "this unfolds to more than {DEEPEST_NODE} functions and operations within one \
                 another; write a shorter chain"
            );
            self.errors.once(expr.source, expr.range, message);
            return false;
        }
        true
    }

    /// Returns one instance of a definition.
    pub(super) fn definition(&mut self, index: usize, k: Option<i64>, range: Range) -> Value {
        if let Some(value) = self.instances.get(&(index, k)) {
            return value.clone();
        }
        if let Some(value) = self.position(index, k) {
            return value;
        }
        let definition = self.model.lets[index];
        if self.open.contains(&(index, k)) {
            return self.circular(definition, range);
        }
        self.open.push((index, k));
        let scope = std::mem::take(&mut self.scope);
        if let (Some(k), Some(binder)) = (k, &definition.index) {
            self.bind(binder, k);
        }
        let mut value = self.expr(&definition.expr);
        self.scope = scope;
        self.open.pop();
        if self.positions.is_some() {
            value = self.components(value);
        }
        if let Some(positions) = &mut self.positions {
            value = match value {
                Value::Rotation(own) => {
                    Value::Rotation(positions.frame(self.graph, self.model.freedoms(), own))
                }
                value => value,
            };
            positions.note(self.graph, &value);
        }
        self.instances.insert((index, k), value.clone());
        value
    }

    /// Returns a definition as symbols of its positions, if positions are replaced by symbols.
    fn position(&mut self, index: usize, k: Option<i64>) -> Option<Value> {
        let value = self.known.as_ref()?.get(&(index, k))?.clone();
        if let Value::Rotation(_) = value {
            return Some(value);
        }
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

    /// Applies a function defined by `let`.
    pub(super) fn apply(&mut self, index: usize, arguments: Vec<Value>, range: Range) -> Value {
        let definition = self.model.lets[index];
        let names = definition.arguments.as_deref().unwrap_or_default();
        if names.len() != arguments.len() {
            return Value::Bad;
        }
        if self.open.iter().any(|&(other, _)| other == index) {
            return self.circular(definition, range);
        }
        self.open.push((index, None));
        let bound = names.iter().map(name::plain);
        let bound = bound.zip(arguments.into_iter().map(Local::Value)).collect();
        let scope = std::mem::replace(&mut self.scope, bound);
        let value = self.expr(&definition.expr);
        self.scope = scope;
        self.open.pop();
        value
    }

    /// Reports a definition that depends on its own value.
    fn circular(&mut self, definition: &Let, range: Range) -> Value {
        let message = message!("`{}` is defined by itself; break the circle", definition.name);
        self.errors.once(definition.expr.source, range, message);
        Value::Bad
    }

    /// Returns the integers of a range. A range that is invalid or too long is reported, and the
    /// result is empty.
    pub(super) fn range(&mut self, binder: &Binder) -> std::ops::Range<i64> {
        let end = |lower: &mut Self, expr: &Expr| match lower.integer(expr) {
            Ok(value) => Some(value),
            Err(range) => {
                let message = shared::open_number("the end of a range");
                lower.errors.once(expr.source, range, message);
                None
            }
        };
        let (Some(low), Some(high)) = (end(self, &binder.low), end(self, &binder.high)) else {
            return 0..0;
        };
        let high = if binder.inclusive { high.saturating_add(1) } else { high };
        if 65536 < high.saturating_sub(low) {
            let message = message!("this range has more than 65536 members; write a shorter one");
            self.errors.once(binder.high.source, binder.high.range, message);
            return 0..0;
        }
        low..high
    }

    pub(super) fn index(&mut self, expr: &Expr, length: usize, name: &str) -> Option<i64> {
        match self.integer(expr) {
            Ok(k) if (0..length as i64).contains(&k) => Some(k),
            Ok(k) => {
                // A range that is too long is reported once, independent of the number of uses of
                // its index.
                let text = text(expr);
                let source = match self.local(&name::read(&text).base) {
                    Some(Local::Index { source, .. }) => *source,
                    _ => expr.source,
                };
                let message = shared::index_out_of_range(name, k, length);
                self.errors.once(source, expr.range, message);
                None
            }
            Err(range) => {
                self.errors.once(expr.source, range, shared::open_number("an index"));
                None
            }
        }
    }

    /// Returns the local meaning of a name within an expression.
    pub(super) fn local(&self, name: &str) -> Option<&Local> {
        self.scope.iter().rev().find(|(own, _)| own == name).map(|(_, local)| local)
    }

    /// Evaluates an integer expression of numbers and indices, or returns the range of the part
    /// that is not an integer.
    pub(super) fn integer(&self, expr: &Expr) -> Result<i64, Range> {
        let index = |name: &str| match self.local(name) {
            Some(&Local::Index { value, .. }) => Some(value),
            _ => None,
        };
        model::integer(expr, &index)
    }

    /// Evaluates for each index of a family, or once without one.
    pub(super) fn each(
        &mut self,
        index: Option<&Binder>,
        mut evaluate: impl FnMut(&mut Self, Option<i64>),
    ) {
        let Some(binder) = index else { return evaluate(self, None) };
        for k in self.range(binder) {
            self.bind(binder, k);
            evaluate(self, Some(k));
            self.unbind();
        }
    }

    pub(super) fn bind(&mut self, binder: &Binder, k: i64) {
        self.scope
            .push((plain(&binder.name), Local::Index { value: k, source: binder.high.source }));
    }

    pub(super) fn unbind(&mut self) {
        self.scope.pop();
    }
}

/// The message about an energy or a force with too many nodes.
pub(super) fn large_value() -> Text {
    message!("this unfolds to more than {LARGEST} different expressions; write a shorter sum")
}
