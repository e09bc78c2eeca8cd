//! Lowering of the rates of states.
//!
//! A rate may contain those of other states, `dot(z)` of any of them, and definitions that contain
//! them. It is therefore lowered when it is first needed, as a definition.

use super::context::Lower;
use super::value::Value;
use crate::algebra::expr::{Dependencies, Id, Symbol};
use crate::mechanics::derivation::named_input;
use crate::messages::{Range, message};
use crate::model::{Meaning, Model, Quantity};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name::plain;
use crate::syntax::text::text;
use std::mem::discriminant;

impl Lower<'_, '_, '_, '_> {
    /// Finds the statement of the rate of each state, and reports states with none or with two.
    pub(super) fn find_rates(&mut self) {
        let (model, before) = (self.model, self.errors.len());
        for (statement, rate) in model.rates.iter().enumerate() {
            self.each(rate.index.as_ref(), |lower, k| {
                let Some(first) = lower.rated_place(&rate.point) else { return };
                if lower.rated.insert(first, (statement, k)).is_some() {
                    let state = text(&rate.point);
                    let message = message!("the rate of `{state}` stands twice; write one");
                    lower.wrong(&rate.point, message);
                }
            });
        }
        if before < self.errors.len() || model.block.recovery.declarations {
            return;
        }
        for state in &model.coordinates[model.mechanical..] {
            let width = state.element.count();
            let Some(k) = (0..state.members.unwrap_or(1))
                .find(|k| !self.rated.contains_key(&(state.first + k * width)))
            else {
                continue;
            };
            let name = state.name;
            let message = match state.members {
                Some(count) if self.rated.range(state.scalars()).next().is_none() => message!(
                    "the state `{name}` has no rate; write `rate {name}[k in 0..{count}] = …;`"
                ),
                Some(_) => {
                    message!("the state `{name}[{k}]` has no rate; write `rate {name}[{k}] = …;`")
                }
                None => message!("the state `{name}` has no rate; write `rate {name} = …;`"),
            };
            self.errors.at(name.span(), message);
        }
    }

    /// Returns the first scalar of the state, or of the member, on the left side of a rate.
    fn rated_place(&mut self, point: &Expr) -> Option<usize> {
        let (base, index) = match &point.kind {
            ExprKind::Index(base, index) => (&**base, Some(&**index)),
            _ => (point, None),
        };
        let ExprKind::Name(name) = &base.kind else { return None };
        let Some(&Meaning::Coordinate(place)) = self.model.names.get(&plain(name)) else {
            return None;
        };
        let state = &self.model.coordinates[place];
        let k = match (state.members, index) {
            (None, None) => 0,
            (Some(members), Some(index)) => {
                usize::try_from(self.index(index, members, &name.to_string())?).ok()?
            }
            (Some(members), None) => {
                let message = message!(
                    "`{name}` is a family; write `rate {name}[k in 0..{members}] = …;` with \
                     `{name}[k]`"
                );
                self.wrong(point, message);
                return None;
            }
            (None, Some(_)) => {
                let message = message!("`{name}` is no family; write `rate {name} = …;`");
                self.wrong(point, message);
                return None;
            }
        };
        Some(state.first + k * state.element.count())
    }

    /// Lowers the rates of all states.
    pub(super) fn lower_rates(&mut self) {
        while let Some((&first, &(statement, _))) = self.rated.first_key_value() {
            self.lower_rate(first, self.model.rates[statement].expr.range);
        }
    }

    /// Lowers the rates of the states in `ids`, before their derivative is taken at `range`.
    pub(super) fn rates_within(&mut self, ids: &[Id], range: Range) {
        if self.model.mechanical == self.model.coordinates.len() {
            return;
        }
        for symbol in self.graph.symbols(ids) {
            if let Symbol::Coordinate(place) = symbol
                && let Some((state, k)) = member(self.model, place)
                && !self.rates.contains_key(&place)
            {
                self.lower_rate(state.first + k * state.element.count(), range);
            }
        }
    }

    /// Lowers the rate of the state, or of the member, whose first scalar is `first`. A rate that
    /// contains itself is reported at `range`.
    fn lower_rate(&mut self, first: usize, range: Range) {
        let model = self.model;
        let Some((state, index)) = member(model, first) else { return };
        let Some((statement, k)) = self.rated.remove(&first) else {
            // It is being lowered, or its statement is missing, which has been reported.
            if self.errors.is_empty() {
                let source = model.rates.first().map_or(0, |own| own.expr.source);
                let name = state.name;
                let message = message!("the rate of `{name}` contains itself; break the circle");
                self.errors.once(source, range, message);
            }
            return;
        };
        let rate = model.rates[statement];
        let own = self.quantity_member(state, index, &Symbol::Coordinate);
        let outer = (std::mem::take(&mut self.scope), self.accelerations, self.constrained);
        (self.accelerations, self.constrained) = (false, false);
        if let (Some(k), Some(binder)) = (k, &rate.index) {
            self.bind(binder, k);
        }
        let value = match own {
            Value::Scalar(_) => self.scalar(&rate.expr).map_or(Value::Bad, Value::Scalar),
            _ => self.plain(&rate.expr),
        };
        (self.scope, self.accelerations, self.constrained) = outer;
        if value == Value::Bad {
            return;
        }
        if discriminant(&own) != discriminant(&value) {
            let (state, kind) = (text(&rate.point), own.kind());
            let instead = format!(", but `{state}` is {kind}; both have one shape");
            self.unfit(&rate.expr, &value, &instead);
            return;
        }
        let scalars = value.scalars();
        if !scalars.iter().all(|&scalar| self.within_bounds(&rate.expr, scalar)) {
            return;
        }
        if self.dependencies(&value).any(Dependencies::ACCELERATION_INPUT) {
            let input = named_input(model, self.graph, &scalars, Some(2));
            let input = input.map_or_else(String::new, ToString::to_string);
            let message = message!(
                "the derivative of this rate contains the third one of `{input}`, and driven \
                 inputs have two; leave its second derivative out"
            );
            self.wrong(&rate.expr, message);
            return;
        }
        self.rates.extend((first..).zip(scalars));
    }
}

/// Returns the state that has the scalar at `place`, and the index of its member.
fn member<'m, 'a>(model: &'m Model<'a>, place: usize) -> Option<(&'m Quantity<'a>, usize)> {
    let mut states = model.coordinates[model.mechanical..].iter();
    let state = states.find(|state| state.scalars().contains(&place))?;
    Some((state, (place - state.first) / state.element.count()))
}
