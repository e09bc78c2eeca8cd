//! A tree of positions: what the steps of the sparse form work on.

use crate::algebra::expr::{Graph, Id};
use crate::algebra::number::Rational;

/// A position, how it moves against its parent, and which coordinates do it.
#[derive(Debug)]
pub(super) struct Joint {
    /// The scalars of the position, and the same components of the parent.
    pub(super) scalars: Vec<usize>,
    pub(super) parents: Vec<Option<usize>>,
    pub(super) coordinates: Vec<usize>,
    /// ∂(z − zₚ)/∂q in units of the coordinates, a row for each scalar.
    pub(super) jacobian: Vec<Vec<Id>>,
    /// d(z − zₚ)/dt, the same at q̇ = 0, and its rate at constant q̇.
    pub(super) slip: Vec<Id>,
    pub(super) drive: Vec<Id>,
    pub(super) drift: Vec<Id>,
}

/// The joints of a system, and the graph of their expressions.
pub(super) struct Tree<'g> {
    pub(super) graph: &'g mut Graph,
    pub(super) count: usize,
    /// Parents before children.
    pub(super) joints: Vec<Joint>,
    /// The parameters that each coordinate always stands with, such as the length of its link.
    pub(super) units: Vec<Id>,
}

impl Tree<'_> {
    /// An entry in the units of its unknowns.
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
