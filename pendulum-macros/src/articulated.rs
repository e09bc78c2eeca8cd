//! The equations of motion in sparse form: the velocities of `let` positions as further unknowns, eliminated from the leaves to the root.
//!
//! A chain written with positions yₖ has a full mass matrix, but one that comes from few numbers: yₖ is yₖ₋₁ and a link. With the
//! velocities uₛ of such positions z beside the coordinates' the Lagrangian Λ(q, q̇, u) has a sparse Hessian H, and the motion is the
//! stationary point of ½wᵀHw − Gᵀw over the accelerations w = (q̈, u̇) with u̇ᵢ = u̇ₚ + J q̈ + γ for each position zᵢ and its parent zₚ (Gauss
//! 1829). Putting the leaves into their parents and eliminating each joint behind them is the articulated-body recursion (Featherstone
//! 1983): the cost grows with the number of joints, and trees branch without fill-in.

use crate::collect;
use crate::diff::{derivative, substitute};
use crate::expr::{Contents, Graph, Id, Symbol};
use crate::lower::{Extended, total_derivative};
use crate::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// What the sparse form gives; the same functions as those of the dense form.
#[derive(Debug)]
pub(crate) struct Sparse {
    pub(crate) accelerations: Vec<Id>,
    pub(crate) velocities: Vec<Id>,
    pub(crate) momenta: Vec<Id>,
    pub(crate) momentum_rates: Vec<Id>,
    pub(crate) energy: Id,
    pub(crate) kinetic: Option<Id>,
    pub(crate) unsolved: Unsolved,
}

/// The equations of motion before they are solved.
#[derive(Debug, Default)]
pub(crate) struct Unsolved {
    /// The momenta of the coordinates and of the positions, in q and q̇.
    pub(crate) carried: Vec<Id>,
    /// What vanishes along the motion, one for each coordinate; the symbol `Auxiliary(k)` is the rate of `carried[k]`.
    pub(crate) equations: Vec<Id>,
}

/// A position, how it moves against its parent, and which coordinates do it.
#[derive(Debug)]
struct Joint {
    /// The scalars of the position, and the same components of the parent.
    scalars: Vec<usize>,
    parents: Vec<Option<usize>>,
    coordinates: Vec<usize>,
    /// ∂(z − zₚ)/∂q in units of the coordinates, a row for each scalar.
    jacobian: Vec<Vec<Id>>,
    /// d(z − zₚ)/dt, the same at q̇ = 0, and its rate at constant q̇.
    slip: Vec<Id>,
    drive: Vec<Id>,
    drift: Vec<Id>,
}

/// A symmetric matrix and the right sides that go with it.
#[derive(Debug, Default)]
struct Quadratic {
    entries: BTreeMap<(usize, usize), Id>,
    right: BTreeMap<usize, Id>,
}

/// How an unknown comes from those that are found before it.
#[derive(Debug)]
struct Step {
    unknown: usize,
    constant: Id,
    terms: Vec<(usize, Id)>,
}

/// The sparse form of a Lagrangian whose positions are written with `let`; `None` if there are none, or if it has none.
pub(crate) fn sparse(graph: &mut Graph, extended: &Extended, count: usize) -> Option<Sparse> {
    let lagrangian = collect::by_velocities(graph, extended.lagrangian)?;
    let used = graph.symbols(&[lagrangian, extended.dissipation]);
    if !used.iter().any(|symbol| matches!(symbol, Symbol::Auxiliary(_))) {
        return None;
    }
    let mut tree = Tree { graph, count, joints: Vec::new(), units: vec![Graph::ONE; count] };
    tree.grow(extended, &used);
    tree.forms(extended, lagrangian)
}

struct Tree<'g> {
    graph: &'g mut Graph,
    count: usize,
    /// Parents before children.
    joints: Vec<Joint>,
    /// The parameters that each coordinate always stands with, such as the length of its link.
    units: Vec<Id>,
}

impl Tree<'_> {
    /// Finds a parent for each position: the one from which the fewest coordinates lead to it.
    fn grow(&mut self, extended: &Extended, used: &BTreeSet<Symbol>) {
        let mut open: Vec<(BTreeSet<usize>, usize)> = Vec::new();
        for (index, position) in extended.positions.iter().enumerate() {
            let scalars: Vec<Id> = position.iter().map(|&scalar| extended.scalars[scalar]).collect();
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
                let slip: Vec<Id> =
                    own.iter().zip(theirs).map(|(&a, &b)| self.graph.sub(extended.scalars[a], extended.scalars[b])).collect();
                let length = self.coordinates(&slip).len();
                if length < best.0 {
                    best = (length, Some(other));
                }
            }
            found.push((*index, best.1));
        }
        // What no energy and no descendant needs is left out.
        let direct = |index: usize| extended.positions[index].iter().any(|&scalar| used.contains(&Symbol::Auxiliary(scalar)));
        let mut needed: BTreeSet<usize> = (0..extended.positions.len()).filter(|&index| direct(index)).collect();
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
        let slip: Vec<Id> = places.iter().map(|&place| total_derivative(self.graph, place)).collect();
        let still = |symbol: Symbol| matches!(symbol, Symbol::Velocity(_)).then_some(Graph::ZERO);
        let drive = slip.iter().map(|&slip| substitute(self.graph, slip, still)).collect();
        let drift = slip.iter().map(|&slip| total_derivative(self.graph, slip)).collect();
        Joint { scalars, parents, coordinates, jacobian, slip, drive, drift }
    }

    /// Draws what parameters alone decide out of each column of the Jacobians.
    fn measure(&mut self) {
        for coordinate in 0..self.count {
            let mut common: Option<Vec<(Id, Rational)>> = None;
            for joint in &self.joints {
                let Some(column) = joint.coordinates.iter().position(|&j| j == coordinate) else { continue };
                for row in &joint.jacobian {
                    if row[column] == Graph::ZERO {
                        continue;
                    }
                    let mut factors = self.graph.factors(row[column]);
                    factors.retain(|&(base, _)| !self.graph.contents(base).any(Contents::STATE));
                    common = Some(match common {
                        None => factors,
                        Some(common) => common.into_iter().filter(|factor| factors.contains(factor)).collect(),
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

    fn forms(&mut self, extended: &Extended, lagrangian: Id) -> Option<Sparse> {
        let count = self.count;
        let scalars: Vec<usize> = self.joints.iter().flat_map(|joint| joint.scalars.clone()).collect();
        // The place of a scalar among the unknowns comes after those of the coordinates.
        let symbols: BTreeMap<usize, Symbol> = (0..count)
            .map(|j| (j, Symbol::Velocity(j)))
            .chain(scalars.iter().map(|&scalar| (count + scalar, Symbol::Auxiliary(scalar))))
            .collect();
        let momenta: BTreeMap<usize, Id> =
            symbols.iter().map(|(&place, &symbol)| (place, derivative(self.graph, lagrangian, symbol))).collect();
        let mut masses = BTreeMap::new();
        let moving = Contents::VELOCITY.or(Contents::AUXILIARY);
        for (&row, &momentum) in &momenta {
            for (&column, &symbol) in symbols.range(..=row) {
                let entry = derivative(self.graph, momentum, symbol);
                if self.graph.contents(entry).any(moving) {
                    return None;
                }
                if entry != Graph::ZERO {
                    let entry = self.scaled(entry, &[row, column]);
                    masses.insert((column, row), entry);
                }
            }
        }
        let (velocities, drives) = self.rates();

        // Accelerations: the rates of the momenta at constant velocities, and the forces.
        let mut forces = BTreeMap::new();
        let mut rates = BTreeMap::new();
        for (&place, &symbol) in &symbols {
            let friction = derivative(self.graph, extended.dissipation, symbol);
            let mut terms = vec![(friction, Rational::MINUS_ONE)];
            if place < count {
                terms.push((extended.forces[place], Rational::ONE));
                terms.push((derivative(self.graph, lagrangian, Symbol::Coordinate(place)), Rational::ONE));
            }
            let rate = self.graph.sum(&terms);
            let drift = total_derivative(self.graph, momenta[&place]);
            let force = self.graph.sub(rate, drift);
            let force = collect::by_velocities(self.graph, force).unwrap_or(force);
            let force = self.at(force, &velocities);
            let rate = self.at(rate, &velocities);
            rates.insert(place, rate);
            let force = self.scaled(force, &[place]);
            forces.insert(place, force);
        }
        let drifts: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drift.clone()).collect();
        let accelerations = self.solve(&masses, forces, &drifts)?;

        // Velocities from momenta: the same unknowns, with the drive in place of the drift.
        let rest = |symbol: Symbol| matches!(symbol, Symbol::Velocity(_) | Symbol::Auxiliary(_)).then_some(Graph::ZERO);
        let mut right = BTreeMap::new();
        for (&place, &momentum) in &momenta {
            let offset = substitute(self.graph, momentum, rest);
            let own = if place < count { self.graph.symbol(Symbol::Momentum(place)) } else { Graph::ZERO };
            let value = self.graph.sub(own, offset);
            let value = self.scaled(value, &[place]);
            right.insert(place, value);
        }
        let drive: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drive.clone()).collect();
        let from_momenta = self.solve(&masses, right, &drive)?;

        let (all_momenta, all_rates) = self.gather(&momenta, &rates, &velocities);
        let unsolved = self.unsolved(&momenta, &rates, &velocities);
        let mut energy = vec![(lagrangian, Rational::MINUS_ONE)];
        for (&place, &symbol) in &symbols {
            let velocity = self.graph.symbol(symbol);
            let drive = drives.get(&(place.wrapping_sub(count))).copied().unwrap_or_default();
            let velocity = self.graph.sub(velocity, drive);
            energy.push((self.graph.mul(velocity, momenta[&place]), Rational::ONE));
        }
        let energy = self.graph.sum(&energy);
        let energy = collect::by_velocities(self.graph, energy).unwrap_or(energy);
        let energy = self.at(energy, &velocities);
        let kinetic = extended.kinetic.map(|kinetic| {
            let kinetic = collect::by_velocities(self.graph, kinetic).unwrap_or(kinetic);
            self.at(kinetic, &velocities)
        });
        let (momenta, momentum_rates) = (all_momenta, all_rates);
        Some(Sparse { accelerations, velocities: from_momenta, momenta, momentum_rates, energy, kinetic, unsolved })
    }

    /// The velocity of each scalar and the part of it that the drive alone makes, from the root to the leaves.
    fn rates(&mut self) -> (BTreeMap<usize, Id>, BTreeMap<usize, Id>) {
        let (mut velocities, mut drives) = (BTreeMap::new(), BTreeMap::new());
        for joint in &self.joints {
            for (row, (&scalar, parent)) in joint.scalars.iter().zip(&joint.parents).enumerate() {
                for (known, own) in [(&mut velocities, joint.slip[row]), (&mut drives, joint.drive[row])] {
                    let before = parent.and_then(|parent| known.get(&parent).copied()).unwrap_or_default();
                    let value = self.graph.add(before, own);
                    known.insert(scalar, self.graph.atom(value));
                }
            }
        }
        (velocities, drives)
    }

    /// An expression with the velocities of positions put in.
    fn at(&mut self, id: Id, velocities: &BTreeMap<usize, Id>) -> Id {
        if !self.graph.contents(id).any(Contents::AUXILIARY) {
            return id;
        }
        substitute(self.graph, id, |symbol| match symbol {
            Symbol::Auxiliary(scalar) => velocities.get(&scalar).copied(),
            _ => None,
        })
    }

    /// An entry in the units of its unknowns.
    fn scaled(&mut self, entry: Id, places: &[usize]) -> Id {
        let mut factors = vec![(entry, Rational::ONE)];
        factors.extend(places.iter().filter(|&&place| place < self.count).map(|&place| (self.units[place], Rational::MINUS_ONE)));
        self.graph.product(Rational::ONE, &factors)
    }

    /// Momenta and their rates: what the positions carry goes from the leaves to the root.
    fn gather(
        &mut self,
        momenta: &BTreeMap<usize, Id>,
        rates: &BTreeMap<usize, Id>,
        velocities: &BTreeMap<usize, Id>,
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
                let total = |tree: &mut Self, terms: &[(Id, Rational)]| {
                    let sum = tree.graph.sum(terms);
                    tree.graph.atom(sum)
                };
                let momentum = total(self, &carried[&(count + scalar)]);
                let force = total(self, &pushed[&(count + scalar)]);
                if let Some(parent) = parent {
                    carried.entry(count + parent).or_default().push((momentum, Rational::ONE));
                    pushed.entry(count + parent).or_default().push((force, Rational::ONE));
                }
                for (column, &j) in joint.coordinates.iter().enumerate() {
                    let arm = self.graph.mul(joint.jacobian[row][column], self.units[j]);
                    let turn = derivative(self.graph, joint.slip[row], Symbol::Coordinate(j));
                    carried.entry(j).or_default().push((self.graph.mul(arm, momentum), Rational::ONE));
                    pushed.entry(j).or_default().push((self.graph.mul(arm, force), Rational::ONE));
                    pushed.entry(j).or_default().push((self.graph.mul(turn, momentum), Rational::ONE));
                }
            }
        }
        self.joints = joints;
        let sums = |graph: &mut Graph, lists: &BTreeMap<usize, Vec<(Id, Rational)>>| {
            (0..count).map(|j| graph.sum(&lists[&j])).collect::<Vec<Id>>()
        };
        (sums(self.graph, &carried), sums(self.graph, &pushed))
    }

    /// d'Alembert's principle: ṗ less its cause, for the coordinates and for the positions, which hand it on from the leaves to the root. The
    /// rates of the lever arms ∂z/∂q are those of the velocities, ∂u/∂q, and go out.
    fn unsolved(
        &mut self,
        momenta: &BTreeMap<usize, Id>,
        rates: &BTreeMap<usize, Id>,
        velocities: &BTreeMap<usize, Id>,
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
                let total = self.graph.sum(&lost[&(self.count + scalar)]);
                let total = self.graph.atom(total);
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

    /// The unknowns of the coordinates, from masses, right sides and what each joint adds by itself.
    fn solve(&mut self, masses: &BTreeMap<(usize, usize), Id>, right: BTreeMap<usize, Id>, drift: &[Vec<Id>]) -> Option<Vec<Id>> {
        let mut system = Quadratic { entries: masses.clone(), right };
        let mut steps: Vec<Step> = Vec::new();
        let mut open: Vec<usize> = (0..self.count).rev().collect();
        let joints = std::mem::take(&mut self.joints);
        for index in (0..joints.len()).rev() {
            self.fold(&mut system, &joints[index], &drift[index], &mut steps);
            let (ready, rest) = open.iter().partition(|j| !joints[..index].iter().any(|joint| joint.coordinates.contains(j)));
            open = rest;
            let ready: Vec<usize> = ready;
            // What no position needs waits until the others are done.
            let (now, later): (Vec<usize>, Vec<usize>) =
                ready.into_iter().partition(|j| index == 0 || joints.iter().any(|joint| joint.coordinates.contains(j)));
            open.extend(later);
            for j in now {
                self.eliminate(&mut system, j, &mut steps)?;
            }
        }
        self.joints = joints;
        let mut found: BTreeMap<usize, Id> = BTreeMap::new();
        for step in steps.iter().rev() {
            let mut terms = vec![(step.constant, Rational::ONE)];
            for &(other, factor) in &step.terms {
                terms.push((self.graph.mul(factor, found[&other]), Rational::ONE));
            }
            let value = self.graph.sum(&terms);
            found.insert(step.unknown, self.graph.atom(value));
        }
        Some((0..self.count).map(|j| self.graph.div(found[&j], self.units[j])).collect())
    }

    /// Puts u̇ = u̇ₚ + J q̈ + γ in for the scalars of a joint.
    fn fold(&mut self, system: &mut Quadratic, joint: &Joint, drift: &[Id], steps: &mut Vec<Step>) {
        let count = self.count;
        let places: Vec<usize> = joint.scalars.iter().map(|&scalar| count + scalar).collect();
        // What each scalar is made of: unknowns with their factors.
        let parts: Vec<Vec<(usize, Id)>> = (0..places.len())
            .map(|row| {
                let parent = joint.parents[row].map(|parent| (count + parent, Graph::ONE));
                let own = joint.coordinates.iter().zip(&joint.jacobian[row]).map(|(&j, &factor)| (j, factor));
                parent.into_iter().chain(own).filter(|&(_, factor)| factor != Graph::ZERO).collect()
            })
            .collect();
        for (row, &place) in places.iter().enumerate() {
            steps.push(Step { unknown: place, constant: drift[row], terms: parts[row].clone() });
        }
        // Right sides of what stays, and of the scalars themselves.
        let touched: BTreeSet<usize> =
            system.entries.keys().filter(|(a, b)| places.contains(a) || places.contains(b)).flat_map(|&(a, b)| [a, b]).collect();
        for &other in &touched {
            let mut terms = vec![(system.right.get(&other).copied().unwrap_or_default(), Rational::ONE)];
            for (row, &place) in places.iter().enumerate() {
                let entry = system.entry(place, other);
                terms.push((self.graph.mul(entry, drift[row]), Rational::MINUS_ONE));
            }
            let value = self.graph.sum(&terms);
            system.right.insert(other, self.graph.atom(value));
        }
        let mut added: BTreeMap<usize, Vec<(Id, Rational)>> = BTreeMap::new();
        for (row, &place) in places.iter().enumerate() {
            let own = system.right.remove(&place).unwrap_or_default();
            for &(other, factor) in &parts[row] {
                added.entry(other).or_default().push((self.graph.mul(factor, own), Rational::ONE));
            }
        }
        for (other, mut terms) in added {
            terms.push((system.right.get(&other).copied().unwrap_or_default(), Rational::ONE));
            let value = self.graph.sum(&terms);
            system.right.insert(other, self.graph.atom(value));
        }
        self.congruence(system, &places, &parts, &touched);
    }

    /// H ← KᵀHK for the scalars at `places`, each of which is made of its `parts`.
    fn congruence(&mut self, system: &mut Quadratic, places: &[usize], parts: &[Vec<(usize, Id)>], touched: &BTreeSet<usize>) {
        // H K: one row for each scalar and each other unknown that is coupled to it, one column for each part.
        let others: Vec<usize> = touched.iter().copied().filter(|other| !places.contains(other)).collect();
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
                let value = self.graph.sum(&terms);
                half.insert((row, target), self.graph.atom(value));
            }
        }
        let mut added: BTreeMap<(usize, usize), Vec<(Id, Rational)>> = BTreeMap::new();
        let mut add = |a: usize, b: usize, value: Id| added.entry((a.min(b), a.max(b))).or_default().push((value, Rational::ONE));
        for &other in &others {
            for &target in &targets {
                let value = half[&(other, target)];
                add(other, target, value);
                // Both triangles of a product with itself.
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
            terms.push((system.entries.get(&key).copied().unwrap_or_default(), Rational::ONE));
            let value = self.graph.sum(&terms);
            system.set(key, self.graph.atom(value));
        }
    }

    /// Solves the row of `unknown` for it and puts it into the others.
    fn eliminate(&mut self, system: &mut Quadratic, unknown: usize, steps: &mut Vec<Step>) -> Option<()> {
        let pivot = system.entry(unknown, unknown);
        if pivot == Graph::ZERO {
            return None;
        }
        let inverse = self.graph.power(pivot, Rational::MINUS_ONE);
        // A moving reciprocal is taken once; one of parameters stays open and cancels.
        let inverse = if self.graph.contents(pivot).any(Contents::STATE) { self.graph.closed(inverse) } else { inverse };
        let row: Vec<(usize, Id)> = system.row(unknown);
        let right = system.right.remove(&unknown).unwrap_or_default();
        let times = |graph: &mut Graph, value: Id| {
            let value = graph.mul(value, inverse);
            if graph.contents(value).any(Contents::STATE) { graph.closed(value) } else { value }
        };
        let constant = times(self.graph, right);
        let mut terms = Vec::new();
        for &(other, entry) in &row {
            let factor = times(self.graph, entry);
            terms.push((other, self.graph.negative(factor)));
            for &(next, own) in row.iter().filter(|&&(next, _)| next <= other) {
                let old = system.entry(next, other);
                let product = self.graph.mul(own, factor);
                let value = self.graph.sub(old, product);
                system.set((next, other), self.graph.atom(value));
            }
            let old = system.right.get(&other).copied().unwrap_or_default();
            let product = self.graph.mul(entry, constant);
            let value = self.graph.sub(old, product);
            system.right.insert(other, self.graph.atom(value));
        }
        system.entries.retain(|(a, b), _| *a != unknown && *b != unknown);
        steps.push(Step { unknown, constant, terms });
        Some(())
    }

    /// The coordinates in some expressions.
    fn coordinates(&self, roots: &[Id]) -> BTreeSet<usize> {
        let index = |symbol| match symbol {
            Symbol::Coordinate(index) => Some(index),
            _ => None,
        };
        self.graph.symbols(roots).into_iter().filter_map(index).collect()
    }
}

impl Quadratic {
    fn entry(&self, a: usize, b: usize) -> Id {
        self.entries.get(&(a.min(b), a.max(b))).copied().unwrap_or_default()
    }

    fn set(&mut self, key: (usize, usize), value: Id) {
        if value == Graph::ZERO {
            self.entries.remove(&key);
        } else {
            self.entries.insert(key, value);
        }
    }

    /// The other entries of a row.
    fn row(&self, unknown: usize) -> Vec<(usize, Id)> {
        let other = |(&(a, b), &value): (&(usize, usize), &Id)| match (a == unknown, b == unknown) {
            (true, false) => Some((b, value)),
            (false, true) => Some((a, value)),
            _ => None,
        };
        self.entries.iter().filter_map(other).collect()
    }
}
