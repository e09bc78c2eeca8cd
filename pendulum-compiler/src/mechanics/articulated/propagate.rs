//! Propagation along the tree: velocities from the root to the leaves, momenta and their rates from
//! the leaves to the root.

use super::Unsolved;
use super::quadratic::Places;
use super::tree::{Joint, Tree};
use crate::algebra::diff::substitute;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::lower::Frame;
use std::collections::BTreeMap;

impl Tree<'_> {
    /// Finds the values of rotations and of the velocities of positions, and returns the velocities
    /// at q̇ = 0, computed from the root to the leaves.
    pub(super) fn rates(&mut self, frames: &[Frame]) -> Places {
        for (k, frame) in frames.iter().enumerate() {
            for (entry, &own) in frame.entries.iter().enumerate() {
                let own = self.at(own);
                let own = self.graph.closed(own);
                self.values.insert(Symbol::Entry(self.count + 4 * k, entry), own);
            }
        }
        let mut drives = BTreeMap::new();
        for joint in std::mem::take(&mut self.joints) {
            for (row, (&place, &parent)) in joint.places.iter().zip(&joint.parents).enumerate() {
                let own = self.symbol(place);
                let parent = parent.map(|parent| self.symbol(parent));
                let rate = self.at(joint.slip[row]);
                let drive = substitute(self.graph, joint.slip[row], |symbol| match symbol {
                    Symbol::Velocity(j) if j < self.count => Some(Graph::ZERO),
                    _ => drives.get(&symbol).or_else(|| self.values.get(&symbol)).copied(),
                });
                for (known, own_value) in [(&mut self.values, rate), (&mut drives, drive)] {
                    let before = parent.and_then(|parent| known.get(&parent).copied());
                    let value = self.graph.add(before.unwrap_or_default(), own_value);
                    known.insert(own, self.graph.atom(value));
                }
            }
            self.joints.push(joint);
        }
        let mut joints = std::mem::take(&mut self.joints);
        for joint in &mut joints {
            let own = joint.jacobian.iter_mut().flatten().chain(&mut joint.drive);
            own.chain(&mut joint.drift).for_each(|id| *id = self.at(*id));
        }
        self.joints = joints;
        drives
            .into_iter()
            .filter_map(|(symbol, drive)| Some((self.place(symbol)?, drive)))
            .collect()
    }

    /// Returns the momenta and their rates. The contributions of the positions are accumulated from
    /// the leaves to the root.
    pub(super) fn backward_pass(&mut self, momenta: &Places, rates: &Places) -> (Vec<Id>, Vec<Id>) {
        let count = self.count;
        let mut carried: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        let mut pushed: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (&place, &momentum) in momenta {
            let momentum = self.at(momentum);
            carried.insert(place, vec![(momentum, Rational::ONE)]);
            pushed.insert(place, vec![(rates[&place], Rational::ONE)]);
        }
        let joints = std::mem::take(&mut self.joints);
        for joint in joints.iter().rev() {
            for (row, (place, &parent)) in joint.places.iter().zip(&joint.parents).enumerate() {
                let momentum = self.graph.atom_of(&carried[place]);
                let force = self.graph.atom_of(&pushed[place]);
                if let Some(parent) = parent {
                    carried.entry(parent).or_default().push((momentum, Rational::ONE));
                    pushed.entry(parent).or_default().push((force, Rational::ONE));
                }
                let turns = self.slopes(joint.slip[row], &joint.movers);
                for (column, (&j, turn)) in joint.movers.iter().zip(turns).enumerate() {
                    let arm = self.arm(joint, row, column);
                    let turn = self.at(turn);
                    let carry = self.graph.mul(arm, momentum);
                    carried.entry(j).or_default().push((carry, Rational::ONE));
                    let push = [self.graph.mul(arm, force), self.graph.mul(turn, momentum)];
                    pushed.entry(j).or_default().extend(push.map(|part| (part, Rational::ONE)));
                }
            }
        }
        self.joints = joints;
        let sums = |graph: &mut Graph, lists: &BTreeMap<usize, Vec<(Id, Rational)>>| {
            (0..count).map(|j| graph.sum(&lists[&j])).collect::<Vec<Id>>()
        };
        (sums(self.graph, &carried), sums(self.graph, &pushed))
    }

    /// Returns the equations of d'Alembert's principle: ṗ minus its cause, for the coordinates and
    /// for the positions, whose contributions are accumulated from the leaves to the root. The
    /// rates of the lever arms ∂z/∂q equal the gradients ∂u/∂q of the velocities, so that these
    /// terms cancel.
    pub(super) fn unsolved(
        &mut self,
        momenta: &Places,
        rates: &Places,
        turned: &Places,
    ) -> Unsolved {
        let mut carried = Vec::new();
        let mut lost: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (&place, &momentum) in momenta {
            let mut terms = vec![(rates[&place], Rational::MINUS_ONE)];
            if let Some(&turned) = turned.get(&place) {
                terms.push((turned, Rational::ONE));
            }
            if momentum != Graph::ZERO {
                terms.push((self.graph.symbol(Symbol::Auxiliary(carried.len())), Rational::ONE));
                carried.push(self.at(momentum));
            }
            lost.insert(place, terms);
        }
        let joints = std::mem::take(&mut self.joints);
        for joint in joints.iter().rev() {
            for (row, (place, &parent)) in joint.places.iter().zip(&joint.parents).enumerate() {
                let total = self.graph.atom_of(&lost[place]);
                if let Some(parent) = parent {
                    lost.entry(parent).or_default().push((total, Rational::ONE));
                }
                for (column, &j) in joint.movers.iter().enumerate() {
                    let arm = self.arm(joint, row, column);
                    lost.entry(j).or_default().push((self.graph.mul(arm, total), Rational::ONE));
                }
            }
        }
        self.joints = joints;
        let equations = (0..self.count).map(|j| self.graph.sum(&lost[&j])).collect();
        Unsolved { carried, equations }
    }

    /// Returns ∂u/∂w for a row and a column of a joint.
    fn arm(&mut self, joint: &Joint, row: usize, column: usize) -> Id {
        let own = joint.jacobian[row][column];
        match self.units.get(joint.movers[column]) {
            Some(&unit) => self.graph.mul(own, unit),
            None => own,
        }
    }
}
