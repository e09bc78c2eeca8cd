//! Joints: the parents of each position and rotation, and its motion relative to them.

use super::tree::{Joint, Tree};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::lower::{Extended, at_rest, total_derivative};
use std::collections::{BTreeMap, BTreeSet};

impl Tree<'_> {
    /// Adds the rotations and positions that are `used` or carry others.
    ///
    /// The parent of a position is that from which the difference contains the fewest coordinates
    /// and rotations. Rotations contain their parents.
    pub(super) fn build_tree(&mut self, extended: &Extended, used: &BTreeSet<usize>) {
        // The coordinates that move each rotation and each position.
        let mut open: Vec<(BTreeSet<usize>, bool, usize)> = Vec::new();
        for (index, frame) in extended.frames.iter().enumerate() {
            open.push((self.movers_of_all(&frame.entries, &open), false, index));
        }
        for (index, position) in extended.positions.iter().enumerate() {
            let scalars: Vec<Id> =
                position.iter().map(|&scalar| extended.scalars[scalar]).collect();
            open.push((self.movers_of_all(&scalars, &open), true, index));
        }
        open.sort_by_key(|&(ref all, moves, index)| (all.len(), moves, index));
        let mut before: Vec<usize> = Vec::new();
        for (_, moves, index) in open {
            let joint = if moves {
                let parent = self.parent(extended, index, &before);
                before.push(index);
                self.position(extended, index, parent)
            } else {
                let rates = extended.frames[index].rates.to_vec();
                let first = self.count + 4 * index + 1;
                self.joint((first..first + 3).collect(), vec![None; 3], rates)
            };
            self.joints.push(joint);
        }
        let mut needed = used.clone();
        let mut joints = std::mem::take(&mut self.joints);
        joints.reverse();
        joints.retain(|joint| {
            let own = joint.places.iter().any(|place| needed.contains(place));
            if own {
                needed.extend(joint.parents.iter().flatten().chain(&joint.movers));
            }
            own
        });
        joints.reverse();
        self.joints = joints;
        self.measure();
    }

    /// Returns the coordinates in some expressions and in the rotations there.
    fn movers_of_all(
        &self,
        roots: &[Id],
        known: &[(BTreeSet<usize>, bool, usize)],
    ) -> BTreeSet<usize> {
        let own = self.coordinates(roots).into_iter();
        own.flat_map(|place| match place.checked_sub(self.count) {
            Some(part) => known[part / 4].0.clone(),
            None => BTreeSet::from([place]),
        })
        .collect()
    }

    /// Returns the position among those `before` that carries a position.
    fn parent(&mut self, extended: &Extended, index: usize, before: &[usize]) -> Option<usize> {
        let own = &extended.positions[index];
        let scalars: Vec<Id> = own.iter().map(|&scalar| extended.scalars[scalar]).collect();
        let mut best = (self.coordinates(&scalars).len(), None);
        for &other in before {
            let theirs = &extended.positions[other];
            if theirs.len() != own.len() {
                continue;
            }
            let slip: Vec<Id> = scalars
                .iter()
                .zip(theirs)
                .map(|(&own, &other)| self.graph.sub(own, extended.scalars[other]))
                .collect();
            let length = self.coordinates(&slip).len();
            if length < best.0 {
                best = (length, Some(other));
            }
        }
        best.1
    }

    fn position(&mut self, extended: &Extended, index: usize, parent: Option<usize>) -> Joint {
        let scalars = &extended.positions[index];
        let parents: Vec<Option<usize>> = match parent {
            Some(parent) => extended.positions[parent].iter().copied().map(Some).collect(),
            None => vec![None; scalars.len()],
        };
        let mut slip = Vec::new();
        for (&own, parent) in scalars.iter().zip(&parents) {
            let place = match parent {
                Some(parent) => self.graph.sub(extended.scalars[own], extended.scalars[*parent]),
                None => extended.scalars[own],
            };
            slip.push(total_derivative(self.graph, place, &BTreeMap::new()));
        }
        let place = |scalar: usize| self.wide + scalar;
        let parents = parents.into_iter().map(|parent| parent.map(place)).collect();
        self.joint(scalars.iter().copied().map(place).collect(), parents, slip)
    }

    fn joint(&mut self, places: Vec<usize>, parents: Vec<Option<usize>>, slip: Vec<Id>) -> Joint {
        let symbols = self.graph.symbols(&slip);
        let movers: Vec<usize> =
            symbols.into_iter().filter_map(|symbol| self.place(symbol)).collect();
        let slope = |graph: &mut Graph, slip: Id| -> Vec<Id> {
            movers.iter().map(|&j| derivative(graph, slip, Symbol::Velocity(j))).collect()
        };
        let jacobian = slip.iter().map(|&slip| slope(self.graph, slip)).collect();
        let drive = slip.iter().map(|&slip| at_rest(self.graph, slip)).collect();
        let drift =
            slip.iter().map(|&slip| total_derivative(self.graph, slip, &BTreeMap::new())).collect();
        Joint { places, parents, movers, jacobian, slip, drive, drift }
    }

    /// Extracts the common factors of parameters from each column of the Jacobians.
    fn measure(&mut self) {
        for coordinate in 0..self.count {
            let mut common: Option<Vec<(Id, Rational)>> = None;
            for joint in &self.joints {
                let Some(column) = joint.movers.iter().position(|&j| j == coordinate) else {
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
                if let Some(column) = joint.movers.iter().position(|&j| j == coordinate) {
                    for row in &mut joint.jacobian {
                        row[column] = self.graph.div(row[column], unit);
                    }
                }
            }
        }
    }

    /// Returns the coordinates in some expressions, and the first place of each rotation.
    pub(super) fn coordinates(&self, roots: &[Id]) -> BTreeSet<usize> {
        let index = |symbol| match symbol {
            Symbol::Coordinate(index) | Symbol::Entry(index, _) => Some(index),
            _ => None,
        };
        self.graph.symbols(roots).into_iter().filter_map(index).collect()
    }
}
