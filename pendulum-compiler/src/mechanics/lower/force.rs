//! Generalized forces: a force F on a point x adds Fᵀ ∂ẋ/∂q̇, which is Fᵀ ∂x/∂q.
//!
//! The force on a coordinate is the case x = q, whose only derivative is one. A torque τ on a
//! rotation adds τᵀ ∂ω/∂q̇ with its angular velocity ω.

use super::context::Lower;
use super::rotation::Turned;
use super::value::Value;
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::messages::message;
use crate::syntax::ast::{Expr, Force};
use crate::syntax::text::text;
use std::collections::BTreeMap;
use std::mem::discriminant;

impl Lower<'_, '_, '_, '_> {
    /// Returns the generalized force of each velocity.
    pub(super) fn forces(&mut self) -> BTreeMap<Symbol, Id> {
        let mut forces = BTreeMap::new();
        for force in &self.model.forces {
            self.each(force.index.as_ref(), |lower, _| lower.force(force, &mut forces));
        }
        forces
    }

    /// Adds one force to the generalized forces.
    fn force(&mut self, force: &Force, forces: &mut BTreeMap<Symbol, Id>) {
        let Force { point, torque, expr, .. } = force;
        let place = self.expr(point);
        if !self.is_position(point, &place, *torque) {
            return;
        }
        // Behind rotations, rates are shorter than slopes.
        let rates = matches!(place, Value::Rotation(_) | Value::Turned(_))
            || self.graph.symbols(&place.scalars()).iter().any(is_of_rotation);
        let place = if rates { self.rate_without_states(place, point) } else { place };
        let value = match place {
            Value::Scalar(_) => self.scalar(expr).map_or(Value::Bad, Value::Scalar),
            _ => self.expr(expr),
        };
        if value == Value::Bad {
            return;
        }
        let (places, values): (Vec<Id>, Vec<Id>);
        if let (Some(place), Some(value)) = (in_space(&place), in_space(&value)) {
            // A force that turns with a body acts in the frame of the body.
            let pairs = Turned::pairs(self.graph, &place, &value);
            (places, values) =
                pairs.into_iter().flat_map(|(place, value)| place.into_iter().zip(value)).unzip();
        } else {
            let (place, value) = (self.components(place), self.components(value));
            if discriminant(&place) != discriminant(&value) {
                let instead =
                    format!(", but `{}` is {}; both have one shape", text(point), place.kind());
                self.unfit(expr, &value, &instead);
                return;
            }
            (places, values) = (place.scalars(), value.scalars());
        }
        let mut bounded = |expr, ids: &[Id]| ids.iter().all(|&id| self.within_bounds(expr, id));
        if !bounded(point, &places) || !bounded(expr, &values) {
            return;
        }
        let mut moves = false;
        let freedoms = self.model.freedoms();
        for symbol in self.graph.symbols(&places) {
            let velocity = match symbol {
                Symbol::Velocity(_) | Symbol::Auxiliary(_) if rates => symbol,
                Symbol::Coordinate(place) if !rates && place < freedoms => Symbol::Velocity(place),
                _ => continue,
            };
            let force = forces.entry(velocity).or_default();
            let mut terms = vec![(*force, Rational::ONE)];
            for (&place, &value) in places.iter().zip(&values) {
                let slope = derivative(self.graph, place, symbol);
                moves |= slope != Graph::ZERO;
                terms.push((self.graph.mul(value, slope), Rational::ONE));
            }
            *force = self.graph.sum(&terms);
        }
        if !moves {
            let message = message!(
                "no coordinate moves `{}`, so a {} does nothing there; write a coordinate or an \
                 expression of coordinates",
                text(point),
                if *torque { "torque" } else { "force" }
            );
            self.wrong(point, message);
        }
    }

    /// Returns the rate of a place at which all states rest. A force does no work on the rates of
    /// states, although they may contain velocities.
    fn rate_without_states(&mut self, place: Value, point: &Expr) -> Value {
        let rates = self.rates.clone();
        for rate in self.rates.values_mut() {
            *rate = Graph::ZERO;
        }
        let rate = self.rate(place, point, true);
        self.rates = rates;
        rate
    }

    /// Returns `true` if a force may act on a value: a number or a vector that contains neither
    /// velocities nor control inputs.
    fn is_position(&mut self, point: &Expr, value: &Value, torque: bool) -> bool {
        let dependencies = self.dependencies(value);
        let family = matches!(value, Value::Family(_));
        if !family && *value != Value::Bad && torque != matches!(value, Value::Rotation(_)) {
            let instead = if torque {
                ", and a torque acts on a rotation; write `force` for what acts on a point or an \
                 angle"
            } else {
                ", and a force acts on a point; write `torque` for what turns it"
            };
            self.unfit(point, value, instead);
        } else if let Value::Family(members) = value {
            let (name, count) = (text(point), members.len());
            let message = message!(
                "`{name}` is a family; write `{name}[k]`, or `{name}[k in 0..{count}]` for all"
            );
            self.wrong(point, message);
        } else if dependencies.any(Dependencies::CONTROL) {
            self.control_rate(value, point);
        } else if dependencies.any(Dependencies::VELOCITY) {
            let message = message!(
                "`{}` contains a velocity, and a force acts on a position; write what moves with \
                 it",
                text(point)
            );
            self.wrong(point, message);
        } else {
            return *value != Value::Bad;
        }
        false
    }
}

/// Returns a vector of space with the rotations before its terms.
fn in_space(value: &Value) -> Option<Turned> {
    match value {
        Value::Turned(vector) => Some(vector.clone()),
        &Value::Space(parts) => Some(Turned::from(parts)),
        _ => None,
    }
}

fn is_of_rotation(symbol: &Symbol) -> bool {
    matches!(symbol, Symbol::Entry(..))
}
