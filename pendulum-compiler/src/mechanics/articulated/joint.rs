//! Joints: a parent for each position, and its motion relative to the parent.

use super::tree::{Joint, Tree};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::lower::{Extended, at_rest, total_derivative};
use std::collections::{BTreeMap, BTreeSet};

impl Tree<'_> {
    /// Finds a parent for each position: the position from which the difference contains the fewest
    /// coordinates.
    pub(super) fn build_tree(&mut self, extended: &Extended, used: &BTreeSet<Symbol>) {
        let mut open: Vec<(BTreeSet<usize>, usize)> = Vec::new();
        for (index, position) in extended.positions.iter().enumerate() {
            let scalars: Vec<Id> =
                position.iter().map(|&scalar| extended.scalars[scalar]).collect();
            open.push((self.coordinates(&scalars), index));
        }
        open.sort_by_key(|(coordinates, index)| (coordinates.len(), *index));
        let mut found: Vec<(usize, Option<usize>)> = Vec::new();
        for (place, (coordinates, index)) in open.iter().enumerate() {
            let own = &extended.positions[*index];
            let mut best = (coordinates.len(), None);
            for &(_, other) in &open[..place] {
                let theirs = &extended.positions[other];
                if theirs.len() != own.len() {
                    continue;
                }
                let slip: Vec<Id> = own
                    .iter()
                    .zip(theirs)
                    .map(|(&a, &b)| self.graph.sub(extended.scalars[a], extended.scalars[b]))
                    .collect();
                let length = self.coordinates(&slip).len();
                if length < best.0 {
                    best = (length, Some(other));
                }
            }
            found.push((*index, best.1));
        }
        // A position that is used neither by an energy nor by a descendant is left out.
        let direct = |index: usize| {
            extended.positions[index]
                .iter()
                .any(|&scalar| used.contains(&Symbol::Auxiliary(scalar)))
        };
        let mut needed: BTreeSet<usize> =
            (0..extended.positions.len()).filter(|&index| direct(index)).collect();
        for &(index, parent) in found.iter().rev() {
            if let (true, Some(parent)) = (needed.contains(&index), parent) {
                needed.insert(parent);
            }
        }
        for (index, parent) in found {
            if needed.contains(&index) {
                let joint = self.joint(extended, index, parent);
                self.joints.push(joint);
            }
        }
        self.measure();
    }

    fn joint(&mut self, extended: &Extended, index: usize, parent: Option<usize>) -> Joint {
        let scalars = extended.positions[index].clone();
        let parents: Vec<Option<usize>> = match parent {
            Some(parent) => extended.positions[parent].iter().copied().map(Some).collect(),
            None => vec![None; scalars.len()],
        };
        let places: Vec<Id> = scalars
            .iter()
            .zip(&parents)
            .map(|(&own, parent)| match parent {
                Some(parent) => self.graph.sub(extended.scalars[own], extended.scalars[*parent]),
                None => extended.scalars[own],
            })
            .collect();
        let coordinates: Vec<usize> = self.coordinates(&places).into_iter().collect();
        let slope = |graph: &mut Graph, place: Id| -> Vec<Id> {
            coordinates.iter().map(|&j| derivative(graph, place, Symbol::Coordinate(j))).collect()
        };
        let jacobian = places.iter().map(|&place| slope(self.graph, place)).collect();
        let slip: Vec<Id> = places
            .iter()
            .map(|&place| total_derivative(self.graph, place, &BTreeMap::new()))
            .collect();
        let drive = slip.iter().map(|&slip| at_rest(self.graph, slip)).collect();
        let drift =
            slip.iter().map(|&slip| total_derivative(self.graph, slip, &BTreeMap::new())).collect();
        Joint { scalars, parents, coordinates, jacobian, slip, drive, drift }
    }

    /// Extracts the common factors of parameters from each column of the Jacobians.
    fn measure(&mut self) {
        for coordinate in 0..self.count {
            let mut common: Option<Vec<(Id, Rational)>> = None;
            for joint in &self.joints {
                let Some(column) = joint.coordinates.iter().position(|&j| j == coordinate) else {
                    continue;
                };
                for row in &joint.jacobian {
                    if row[column] == Graph::ZERO {
                        continue;
                    }
                    let mut factors = self.graph.factors(row[column]);
                    factors.retain(|&(base, _)| {
                        !self.graph.dependencies(base).any(Dependencies::STATE)
                    });
                    common = Some(match common {
                        None => factors,
                        Some(common) => {
                            common.into_iter().filter(|factor| factors.contains(factor)).collect()
                        }
                    });
                }
            }
            let unit = self.graph.product(Rational::ONE, &common.unwrap_or_default());
            self.units[coordinate] = unit;
            for joint in &mut self.joints {
                if let Some(column) = joint.coordinates.iter().position(|&j| j == coordinate) {
                    for row in &mut joint.jacobian {
                        row[column] = self.graph.div(row[column], unit);
                    }
                }
            }
        }
    }

    /// Returns the coordinates in some expressions.
    pub(super) fn coordinates(&self, roots: &[Id]) -> BTreeSet<usize> {
        let index = |symbol| match symbol {
            Symbol::Coordinate(index) => Some(index),
            _ => None,
        };
        self.graph.symbols(roots).into_iter().filter_map(index).collect()
    }
}
