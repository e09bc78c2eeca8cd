//! Positions defined with `let`, whose velocities become unknowns of the sparse form.

use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id};
use std::collections::BTreeMap;

/// The positions defined with `let` and found so far.
#[derive(Debug, Default)]
pub(super) struct PositionTracker {
    pub(super) scalars: Vec<Id>,
    pub(super) positions: Vec<Vec<usize>>,
    pub(super) places: BTreeMap<Id, usize>,
    /// `true` if constraints are expressed in terms of positions.
    pub(super) constrained: bool,
}

impl PositionTracker {
    /// Records the scalars of a value if all of them depend on the coordinates and not on
    /// velocities.
    pub(super) fn note(&mut self, graph: &Graph, value: &Value) {
        if let Value::Family(members) = value {
            return members.iter().for_each(|member| self.note(graph, member));
        }
        let parts = value.scalars();
        if parts.is_empty() || matches!(value, Value::Rotation(_)) {
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
