//! Propagation along the tree: velocities from the root to the leaves, momenta and their rates from
//! the leaves to the root.

use super::Unsolved;
use super::quadratic::Places;
use super::tree::Tree;
use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

impl Tree<'_> {
    /// Returns the velocity of each scalar, and its velocity at q̇ = 0, computed from the root to
    /// the leaves.
    pub(super) fn rates(&mut self) -> (Places, Places) {
        let (mut velocities, mut drives) = (Places::new(), Places::new());
        for joint in &self.joints {
            for (row, (&scalar, parent)) in joint.scalars.iter().zip(&joint.parents).enumerate() {
                for (known, own) in
                    [(&mut velocities, joint.slip[row]), (&mut drives, joint.drive[row])]
                {
                    let before =
                        parent.and_then(|parent| known.get(&parent).copied()).unwrap_or_default();
                    let value = self.graph.add(before, own);
                    known.insert(scalar, self.graph.atom(value));
                }
            }
        }
        (velocities, drives)
    }

    /// Substitutes the velocities of positions in an expression.
    pub(super) fn at(&mut self, id: Id, velocities: &Places) -> Id {
        if !self.graph.dependencies(id).any(Dependencies::AUXILIARY) {
            return id;
        }
        substitute(self.graph, id, |symbol| match symbol {
            Symbol::Auxiliary(scalar) => velocities.get(&scalar).copied(),
            _ => None,
        })
    }

    /// Returns the momenta and their rates. The contributions of the positions are accumulated from
    /// the leaves to the root.
    pub(super) fn backward_pass(
        &mut self,
        momenta: &Places,
        rates: &Places,
        velocities: &Places,
    ) -> (Vec<Id>, Vec<Id>) {
        let count = self.count;
        let mut carried: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        let mut pushed: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (&place, &momentum) in momenta {
            let momentum = self.at(momentum, velocities);
            carried.insert(place, vec![(momentum, Rational::ONE)]);
            pushed.insert(place, vec![(rates[&place], Rational::ONE)]);
        }
        let joints = std::mem::take(&mut self.joints);
        for joint in joints.iter().rev() {
            for (row, (&scalar, parent)) in joint.scalars.iter().zip(&joint.parents).enumerate() {
                let momentum = self.graph.atom_of(&carried[&(count + scalar)]);
                let force = self.graph.atom_of(&pushed[&(count + scalar)]);
                if let Some(parent) = parent {
                    carried.entry(count + parent).or_default().push((momentum, Rational::ONE));
                    pushed.entry(count + parent).or_default().push((force, Rational::ONE));
                }
                for (column, &j) in joint.coordinates.iter().enumerate() {
                    let arm = self.graph.mul(joint.jacobian[row][column], self.units[j]);
                    let turn = derivative(self.graph, joint.slip[row], Symbol::Coordinate(j));
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
        velocities: &Places,
    ) -> Unsolved {
        let mut carried = Vec::new();
        let mut lost: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (&place, &momentum) in momenta {
            let mut terms = vec![(rates[&place], Rational::MINUS_ONE)];
            if momentum != Graph::ZERO {
                terms.push((self.graph.symbol(Symbol::Auxiliary(carried.len())), Rational::ONE));
                carried.push(self.at(momentum, velocities));
            }
            lost.insert(place, terms);
        }
        let joints = std::mem::take(&mut self.joints);
        for joint in joints.iter().rev() {
            for (row, (&scalar, parent)) in joint.scalars.iter().zip(&joint.parents).enumerate() {
                let total = self.graph.atom_of(&lost[&(self.count + scalar)]);
                if let Some(parent) = parent {
                    lost.entry(self.count + parent).or_default().push((total, Rational::ONE));
                }
                for (column, &j) in joint.coordinates.iter().enumerate() {
                    let arm = self.graph.mul(joint.jacobian[row][column], self.units[j]);
                    lost.entry(j).or_default().push((self.graph.mul(arm, total), Rational::ONE));
                }
            }
        }
        self.joints = joints;
        let equations = (0..self.count).map(|j| self.graph.sum(&lost[&j])).collect();
        Unsolved { carried, equations }
    }
}
