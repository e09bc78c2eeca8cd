//! Positions and rotations defined with `let`, whose velocities become unknowns of the sparse form.

use super::energies::Frame;
use super::rate::total_derivative;
use super::rotation::{Rotation, Turn};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use std::collections::BTreeMap;

/// The positions defined with `let` and found so far.
#[derive(Debug, Default)]
pub(super) struct PositionTracker {
    pub(super) scalars: Vec<Id>,
    pub(super) positions: Vec<Vec<usize>>,
    pub(super) places: BTreeMap<Id, usize>,
    /// `true` if constraints are expressed in terms of positions.
    pub(super) constrained: bool,
    /// `true` if rotations become symbols.
    pub(super) framed: bool,
    /// The rotations defined with `let`, each with the turn of symbols that stands for it.
    pub(super) turns: Vec<(Rotation, Turn)>,
    pub(super) frames: Vec<Frame>,
    /// The generalized force of each velocity.
    pub(super) forces: BTreeMap<Symbol, Id>,
}

/// What changes otherwise than a position.
const OTHER: Dependencies = Dependencies::VELOCITY
    .or(Dependencies::AUXILIARY)
    .or(Dependencies::POINT)
    .or(Dependencies::ACCELERATION_INPUT)
    .or(Dependencies::VELOCITY_INPUT);

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
        let position = |id: &Id| {
            graph.dependencies(*id).any(Dependencies::COORDINATE)
                && !graph.dependencies(*id).any(OTHER)
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

    /// Returns a rotation as a turn whose entries and rates are symbols: those of a rotation behind
    /// the `count` coordinates and the rotations before it.
    pub(super) fn frame(&mut self, graph: &mut Graph, count: usize, own: Rotation) -> Rotation {
        let shortened = own.shortened(&self.turns);
        let scalars = shortened.scalars();
        let depend = |other| scalars.iter().any(|&id| graph.dependencies(id).any(other));
        let fixed = !depend(Dependencies::COORDINATE) || depend(OTHER);
        if !self.framed || fixed || shortened.is_one_matrix() {
            return shortened;
        }
        let first = count + 4 * self.frames.len();
        let rate = |graph: &mut Graph, id| total_derivative(graph, id, &BTreeMap::new());
        let (entries, rates) = (shortened.entries(graph), shortened.rates(graph, &rate));
        self.frames.push(Frame { entries, rates });
        let turn = Turn::by_symbols(graph, first);
        self.turns.push((own, turn));
        Rotation::of(turn)
    }
}
