//! Elimination of positions and coordinates, from the leaves to the root.

use super::quadratic::{Entries, Places, Quadratic};
use super::tree::{Joint, Tree};
use crate::algebra::expr::{Dependencies, Graph, Id};
use crate::algebra::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// An equation for an unknown in terms of unknowns found before.
#[derive(Debug)]
struct Step {
    unknown: usize,
    constant: Id,
    terms: Vec<(usize, Id)>,
}

/// A solution with multipliers.
#[derive(Debug)]
pub(super) struct Solution {
    pub(super) unknowns: Vec<Id>,
    pub(super) multipliers: Vec<Id>,
    /// For each multiplier, its pivot divided by the pivot without the reduction by other
    /// multipliers.
    pub(super) independence: Vec<Id>,
}

/// The pivots of multipliers during elimination.
#[derive(Debug, Default)]
struct Pivots {
    /// The indices of all multipliers.
    multipliers: BTreeSet<usize>,
    /// For each multiplier, the terms of its pivot that result from coordinates.
    whole: BTreeMap<usize, Vec<(Id, Rational)>>,
    /// The unknowns reduced by other multipliers.
    reduced: BTreeSet<usize>,
    independence: Places,
}

impl Tree<'_> {
    /// Solves for the coordinates, given masses, right sides and the term of each joint that does
    /// not depend on the unknowns.
    pub(super) fn solve(
        &mut self,
        masses: &Entries,
        right: Places,
        drift: &[Vec<Id>],
    ) -> Option<Vec<Id>> {
        let solution = self.solve_with(masses, right, drift, &[])?;
        Some(solution.unknowns)
    }

    /// Solves with multipliers, each of which is given by its index and the coordinates of its row.
    pub(super) fn solve_with(
        &mut self,
        masses: &Entries,
        right: Places,
        drift: &[Vec<Id>],
        multipliers: &[(usize, BTreeSet<usize>)],
    ) -> Option<Solution> {
        let mut waiting: Vec<(usize, BTreeSet<usize>)> = multipliers.to_vec();
        let places: BTreeSet<usize> = multipliers.iter().map(|&(place, _)| place).collect();
        let mut pivots = Pivots { multipliers: places, ..Pivots::default() };
        let mut system = Quadratic { entries: masses.clone(), right };
        let mut steps: Vec<Step> = Vec::new();
        let mut open: Vec<usize> = (0..self.count).rev().collect();
        let joints = std::mem::take(&mut self.joints);
        for index in (0..joints.len()).rev() {
            self.fold(&mut system, &joints[index], &drift[index], &mut steps);
            let (ready, rest) = open
                .iter()
                .partition(|j| !joints[..index].iter().any(|joint| joint.movers.contains(j)));
            open = rest;
            let ready: Vec<usize> = ready;
            // A coordinate that no joint contains is eliminated last.
            let (now, later): (Vec<usize>, Vec<usize>) = ready
                .into_iter()
                .partition(|j| index == 0 || joints.iter().any(|joint| joint.movers.contains(j)));
            open.extend(later);
            for j in now {
                self.eliminate(&mut system, j, &mut steps, &mut pivots)?;
                for (_, row) in &mut waiting {
                    row.remove(&j);
                }
                let done: Vec<usize> = waiting
                    .extract_if(.., |(_, row)| row.is_empty())
                    .map(|(place, _)| place)
                    .collect();
                for place in done {
                    self.eliminate(&mut system, place, &mut steps, &mut pivots)?;
                }
            }
        }
        self.joints = joints;
        let mut found = Places::new();
        for step in steps.iter().rev() {
            let mut terms = vec![(step.constant, Rational::ONE)];
            for &(other, factor) in &step.terms {
                terms.push((self.graph.mul(factor, found[&other]), Rational::ONE));
            }
            found.insert(step.unknown, self.graph.atom_of(&terms));
        }
        let unknowns = (0..self.count).map(|j| self.graph.div(found[&j], self.units[j])).collect();
        let of = |places: &Places, rest: Id| {
            let value = |(place, _): &(usize, _)| places.get(place).copied().unwrap_or(rest);
            multipliers.iter().map(value).collect()
        };
        let independence = of(&pivots.independence, Graph::ONE);
        Some(Solution { unknowns, multipliers: of(&found, Graph::ZERO), independence })
    }

    /// Returns the mass matrix and the forces of the coordinates: all joints are substituted, and
    /// nothing is eliminated.
    pub(super) fn folded(
        &mut self,
        masses: &Entries,
        right: Places,
        drift: &[Vec<Id>],
    ) -> (Vec<Vec<Id>>, Vec<Id>) {
        let mut system = Quadratic { entries: masses.clone(), right };
        let joints = std::mem::take(&mut self.joints);
        for (joint, drift) in joints.iter().zip(drift).rev() {
            self.fold(&mut system, joint, drift, &mut Vec::new());
        }
        self.joints = joints;
        let places = 0..self.count;
        let mut mass = |i: usize, j| {
            let factors = [system.entry(i, j), self.units[i], self.units[j]];
            self.graph.product(Rational::ONE, &factors.map(|factor| (factor, Rational::ONE)))
        };
        let matrix = places.clone().map(|i| places.clone().map(|j| mass(i, j)).collect()).collect();
        let forces = places.map(|i| self.graph.mul(system.right(i), self.units[i])).collect();
        (matrix, forces)
    }

    /// Substitutes u̇ = u̇ₚ + J ẇ + γ for the velocities of a joint.
    fn fold(&mut self, system: &mut Quadratic, joint: &Joint, drift: &[Id], steps: &mut Vec<Step>) {
        let places = &joint.places;
        // The terms of each velocity: unknowns with their factors.
        let parts: Vec<Vec<(usize, Id)>> = (0..places.len())
            .map(|row| {
                let parent = joint.parents[row].map(|parent| (parent, Graph::ONE));
                let own =
                    joint.movers.iter().zip(&joint.jacobian[row]).map(|(&j, &factor)| (j, factor));
                parent.into_iter().chain(own).filter(|&(_, factor)| factor != Graph::ZERO).collect()
            })
            .collect();
        for (row, &place) in places.iter().enumerate() {
            steps.push(Step { unknown: place, constant: drift[row], terms: parts[row].clone() });
        }
        // The right sides of the remaining unknowns and of the scalars.
        let touched: BTreeSet<usize> = system
            .entries
            .keys()
            .filter(|(a, b)| places.contains(a) || places.contains(b))
            .flat_map(|&(a, b)| [a, b])
            .collect();
        for &other in &touched {
            let mut terms = vec![(system.right(other), Rational::ONE)];
            for (row, &place) in places.iter().enumerate() {
                let entry = system.entry(place, other);
                terms.push((self.graph.mul(entry, drift[row]), Rational::MINUS_ONE));
            }
            system.right.insert(other, self.graph.atom_of(&terms));
        }
        let mut added: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (row, &place) in places.iter().enumerate() {
            let own = system.right.remove(&place).unwrap_or_default();
            for &(other, factor) in &parts[row] {
                added.entry(other).or_default().push((self.graph.mul(factor, own), Rational::ONE));
            }
        }
        for (other, mut terms) in added {
            terms.push((system.right(other), Rational::ONE));
            system.right.insert(other, self.graph.atom_of(&terms));
        }
        self.congruence(system, places, &parts, &touched);
    }

    /// Replaces H by KᵀHK for the scalars at `places`, whose terms are `parts`.
    fn congruence(
        &mut self,
        system: &mut Quadratic,
        places: &[usize],
        parts: &[Vec<(usize, Id)>],
        touched: &BTreeSet<usize>,
    ) {
        // H K: a row for each scalar and for each other unknown coupled to one, a column for each
        // term.
        let others: Vec<usize> =
            touched.iter().copied().filter(|other| !places.contains(other)).collect();
        let targets: BTreeSet<usize> = parts.iter().flatten().map(|&(target, _)| target).collect();
        let mut half: BTreeMap<(usize, usize), Id> = BTreeMap::new();
        for &row in places.iter().chain(&others) {
            for &target in &targets {
                let mut terms = Vec::new();
                for (index, &place) in places.iter().enumerate() {
                    let entry = system.entry(row, place);
                    for &(_, factor) in parts[index].iter().filter(|&&(part, _)| part == target) {
                        terms.push((self.graph.mul(entry, factor), Rational::ONE));
                    }
                }
                half.insert((row, target), self.graph.atom_of(&terms));
            }
        }
        let mut added: BTreeMap<(usize, usize), Vec<(Id, Rational)>> = BTreeMap::new();
        let mut add = |a: usize, b: usize, value: Id| {
            added.entry((a.min(b), a.max(b))).or_default().push((value, Rational::ONE));
        };
        for &other in &others {
            for &target in &targets {
                let value = half[&(other, target)];
                add(other, target, value);
                // A product with itself occurs in both triangles.
                if other == target {
                    add(other, target, value);
                }
            }
        }
        for &column in &targets {
            for &row in targets.range(..=column) {
                let mut terms = Vec::new();
                for (index, &place) in places.iter().enumerate() {
                    for &(_, factor) in parts[index].iter().filter(|&&(part, _)| part == row) {
                        terms.push((self.graph.mul(factor, half[&(place, column)]), Rational::ONE));
                    }
                }
                let value = self.graph.sum(&terms);
                add(row, column, value);
            }
        }
        system.entries.retain(|(a, b), _| !places.contains(a) && !places.contains(b));
        for (key, mut terms) in added {
            terms.push((system.entry(key.0, key.1), Rational::ONE));
            system.set(key, self.graph.atom_of(&terms));
        }
    }

    /// Solves the row of `unknown` for it and substitutes the result in the other rows.
    fn eliminate(
        &mut self,
        system: &mut Quadratic,
        unknown: usize,
        steps: &mut Vec<Step>,
        pivots: &mut Pivots,
    ) -> Option<()> {
        let pivot = system.entry(unknown, unknown);
        if pivot == Graph::ZERO {
            return None;
        }
        let multiplier = pivots.multipliers.contains(&unknown);
        if multiplier && pivots.reduced.contains(&unknown) {
            let whole = self.graph.atom_of(&pivots.whole[&unknown]);
            pivots.independence.insert(unknown, self.graph.div(pivot, whole));
        }
        let inverse = self.graph.power(pivot, Rational::MINUS_ONE);
        // A reciprocal that depends on the state is computed once, and so is what it multiplies. A
        // reciprocal of parameters stays open so that it can cancel.
        let once = |graph: &mut Graph, value: Id| {
            let moving = graph.dependencies(value).any(Dependencies::STATE);
            if moving { graph.closed(value) } else { value }
        };
        let inverse = once(self.graph, inverse);
        let row: Vec<(usize, Id)> = system.row(unknown);
        let right = system.right.remove(&unknown).unwrap_or_default();
        let times = |graph: &mut Graph, value: Id| {
            let value = graph.mul(value, inverse);
            once(graph, value)
        };
        let constant = times(self.graph, right);
        let mut terms = Vec::new();
        for &(other, entry) in &row {
            let factor = times(self.graph, entry);
            terms.push((other, self.graph.negative(factor)));
            if pivots.multipliers.contains(&other) {
                if multiplier {
                    pivots.reduced.insert(other);
                } else {
                    let part = self.graph.mul(entry, factor);
                    pivots.whole.entry(other).or_default().push((part, Rational::MINUS_ONE));
                }
            }
            for &(next, own) in row.iter().filter(|&&(next, _)| next <= other) {
                let product = self.graph.mul(own, factor);
                let value = self.graph.sub(system.entry(next, other), product);
                system.set((next, other), self.graph.atom(value));
            }
            let product = self.graph.mul(entry, constant);
            let value = self.graph.sub(system.right(other), product);
            system.right.insert(other, self.graph.atom(value));
        }
        system.entries.retain(|(a, b), _| *a != unknown && *b != unknown);
        steps.push(Step { unknown, constant, terms });
        Some(())
    }
}
