//! A tree of positions and rotations, on which the steps of the sparse form operate.

use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::attitude::along_turns;
use std::collections::BTreeMap;

/// A position or a rotation, its motion relative to its parents and the velocities of that motion.
#[derive(Debug)]
pub(super) struct Joint {
    /// The places of the velocities u: of the components of a position, or of the rates about the
    /// axes behind a rotation; `parents` are the same components of the parent of a position.
    pub(super) places: Vec<usize>,
    pub(super) parents: Vec<Option<usize>>,
    /// The places of the coordinates, and of the rates of rotations before this.
    pub(super) movers: Vec<usize>,
    /// ∂(u − uₚ)/∂w for the movers, in the units of the coordinates, a row for each place.
    pub(super) jacobian: Vec<Vec<Id>>,
    /// u − uₚ. `drive` is its value at w = 0, and `drift` is its rate at constant w.
    pub(super) slip: Vec<Id>,
    pub(super) drive: Vec<Id>,
    pub(super) drift: Vec<Id>,
}

/// The joints of a system, and the graph of their expressions.
///
/// The unknowns have places: the coordinates, followed by the rotations with four places each, of
/// which the last three are used, and by the components of positions.
pub(super) struct Tree<'g> {
    pub(super) graph: &'g mut Graph,
    /// The number of coordinates, and the place of the first component of a position.
    pub(super) count: usize,
    pub(super) wide: usize,
    /// The joints, parents before children.
    pub(super) joints: Vec<Joint>,
    /// The values of the symbols of rotations and of the velocities of positions.
    pub(super) values: BTreeMap<Symbol, Id>,
    /// For each coordinate, the parameters that always multiply it, such as the length of its link.
    pub(super) units: Vec<Id>,
}

impl Tree<'_> {
    /// Returns the symbol of the velocity at a place.
    pub(super) fn symbol(&self, place: usize) -> Symbol {
        match place.checked_sub(self.wide) {
            Some(scalar) => Symbol::Auxiliary(scalar),
            None => Symbol::Velocity(place),
        }
    }

    /// Returns the place of a velocity.
    pub(super) fn place(&self, symbol: Symbol) -> Option<usize> {
        match symbol {
            Symbol::Velocity(place) => Some(place),
            Symbol::Auxiliary(scalar) => Some(self.wide + scalar),
            _ => None,
        }
    }

    /// Substitutes the values of rotations and of the velocities of positions.
    pub(super) fn at(&mut self, id: Id) -> Id {
        let rotations = self.count < self.wide;
        if !rotations && !self.graph.dependencies(id).any(Dependencies::AUXILIARY) {
            return id;
        }
        substitute(self.graph, id, |symbol| self.values.get(&symbol).copied())
    }

    /// Returns the slope of an expression along the motion of each mover.
    pub(super) fn slopes(&mut self, id: Id, movers: &[usize]) -> Vec<Id> {
        let mut turns: BTreeMap<usize, [Id; 3]> = BTreeMap::new();
        let mut slope = |&place: &usize| match place.checked_sub(self.count) {
            None => derivative(self.graph, id, Symbol::Coordinate(place)),
            Some(part) if place < self.wide => {
                let first = place - part % 4;
                let own = turns.entry(first).or_insert_with(|| along_turns(self.graph, id, first));
                own[place - first - 1]
            }
            Some(_) => Graph::ZERO,
        };
        movers.iter().map(&mut slope).collect()
    }

    /// Divides an entry by the units of its unknowns.
    pub(super) fn scaled(&mut self, entry: Id, places: &[usize]) -> Id {
        let mut factors = vec![(entry, Rational::ONE)];
        factors.extend(
            places
                .iter()
                .filter(|&&place| place < self.count)
                .map(|&place| (self.units[place], Rational::MINUS_ONE)),
        );
        self.graph.product(Rational::ONE, &factors)
    }
}
