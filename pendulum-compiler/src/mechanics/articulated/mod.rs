//! The equations of motion in sparse form: the velocities of `let` positions and rotations are
//! further unknowns, which are eliminated from the leaves to the root.
//!
//! In a chain, each position is yₖ = yₖ₋₁ plus a link. Its mass matrix is full but depends on few
//! quantities. With the velocities uₛ of positions z in addition to those of the coordinates, the
//! Lagrangian Λ(q, q̇, u) has a sparse Hessian H. The motion is the stationary point of ½wᵀHw − Gᵀw
//! over the accelerations w = (q̈, u̇) with u̇ᵢ = u̇ₚ + J q̈ + γ for each position zᵢ and its
//! parent zₚ (Gauss 1829). Substituting the leaves into their parents and eliminating each joint
//! afterwards is the articulated-body recursion (Featherstone 1983): the cost is proportional to
//! the number of joints, and trees branch without fill-in.
//!
//! A rotation of a chain has the rates Ω about its own axes in place of velocities. They are those
//! of its parent, turned by the joint between them, plus what the joint adds, and positions on it
//! move with Ω × r. As Ω is no derivative of positions, its row has the term Ω × ∂Λ/∂Ω of Poincaré's
//! equations and the slope along turns (see `attitude`). Written out in q̇, the rates of the n-th
//! hinge would be products of n factors, and their squares polynomials of millions of terms.

mod constraint;
mod eliminate;
mod joint;
mod propagate;
mod quadratic;
mod tree;

use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::velocity_polynomial;
use crate::mechanics::attitude;
use crate::mechanics::lower::{Extended, at_rest_controls, total_derivative};
use std::collections::{BTreeMap, BTreeSet};
use tree::Tree;

/// The results of the sparse form, which equal those of the dense form.
#[derive(Debug)]
pub(crate) struct Sparse {
    pub(crate) accelerations: Vec<Id>,
    pub(crate) velocities: Vec<Id>,
    pub(crate) momenta: Vec<Id>,
    pub(crate) momentum_rates: Vec<Id>,
    pub(crate) energy: Id,
    pub(crate) kinetic: Option<Id>,
    pub(crate) unsolved: Unsolved,
    /// The mass matrix and the forces, if no other form is derived.
    pub(crate) dense: Option<(Vec<Vec<Id>>, Vec<Id>)>,
    /// The accelerations under constraints; `None` without constraints or if they have no sparse
    /// form.
    pub(crate) held: Option<Held>,
}

impl Sparse {
    /// Returns what is emitted of a form that replaces the dense one.
    pub(crate) fn roots(&self) -> impl Iterator<Item = Id> {
        let Unsolved { carried, equations } = &self.unsolved;
        let lists = [&self.accelerations, &self.velocities, carried, equations];
        lists.into_iter().flatten().copied().chain([self.energy])
    }
}

/// The accelerations under constraints and the quantities solved with them.
#[derive(Debug)]
pub(crate) struct Held {
    pub(crate) accelerations: Vec<Id>,
    pub(crate) multipliers: Vec<Id>,
    pub(crate) correction: Vec<Id>,
    pub(crate) independence: Vec<Id>,
}

/// The equations of motion before they are solved.
#[derive(Debug, Default)]
pub(crate) struct Unsolved {
    /// The momenta of the coordinates and of the positions, as functions of q and q̇.
    pub(crate) carried: Vec<Id>,
    /// Expressions that vanish along the motion, one for each coordinate. The symbol `Auxiliary(k)`
    /// is the rate of `carried[k]`.
    pub(crate) equations: Vec<Id>,
}

/// Returns the sparse form of a Lagrangian whose positions are defined with `let`, or `None` if
/// there are no positions or no sparse form. If it is needed `alone`, the mass matrix and the forces
/// are derived too.
pub(crate) fn sparse(
    graph: &mut Graph,
    extended: &Extended,
    count: usize,
    alone: bool,
) -> Option<Sparse> {
    let lagrangian = velocity_polynomial::by_velocities(graph, extended.lagrangian)?;
    let wide = count + 4 * extended.frames.len();
    let mut roots = vec![lagrangian, extended.dissipation];
    roots.extend(extended.forces.values().chain(extended.constraints.iter().flatten()));
    let used: BTreeSet<usize> = graph
        .symbols(&roots)
        .into_iter()
        .chain(extended.forces.keys().copied())
        .flat_map(|symbol| match symbol {
            Symbol::Velocity(place) if count <= place => vec![place],
            Symbol::Entry(first, _) => vec![first + 1],
            Symbol::Position(scalar) | Symbol::Auxiliary(scalar) => vec![wide + scalar],
            _ => Vec::new(),
        })
        .collect();
    if used.is_empty() {
        return None;
    }
    let units = vec![Graph::ONE; count];
    let mut tree = Tree { graph, count, wide, joints: Vec::new(), values: BTreeMap::new(), units };
    tree.build_tree(extended, &used);
    tree.forms(extended, lagrangian, alone)
}

impl Tree<'_> {
    fn forms(&mut self, extended: &Extended, lagrangian: Id, alone: bool) -> Option<Sparse> {
        let count = self.count;
        let moved = self.joints.iter().flat_map(|joint| joint.places.iter().copied());
        let symbols: BTreeMap<usize, Symbol> =
            (0..count).chain(moved).map(|place| (place, self.symbol(place))).collect();
        let momenta: BTreeMap<usize, Id> = symbols
            .iter()
            .map(|(&place, &symbol)| (place, derivative(self.graph, lagrangian, symbol)))
            .collect();
        let mut masses = BTreeMap::new();
        let drives = self.rates(&extended.frames);
        let moving = Dependencies::VELOCITY.or(Dependencies::AUXILIARY);
        for (&row, &momentum) in &momenta {
            for (&column, &symbol) in symbols.range(..=row) {
                let entry = derivative(self.graph, momentum, symbol);
                if self.graph.dependencies(entry).any(moving) {
                    return None;
                }
                if entry != Graph::ZERO {
                    let entry = self.at(entry);
                    let entry = self.scaled(entry, &[row, column]);
                    masses.insert((column, row), entry);
                }
            }
        }

        // Accelerations: the rates of the momenta at constant velocities, and the forces.
        let mut forces = BTreeMap::new();
        let (mut rates, mut turned) = (BTreeMap::new(), BTreeMap::new());
        for first in
            (count..self.wide).step_by(4).filter(|first| symbols.contains_key(&(first + 1)))
        {
            let own = [1, 2, 3].map(|k| momenta[&(first + k)]);
            let own = attitude::turned(self.graph, first, own);
            turned.extend((first + 1..).zip(own));
        }
        let places: Vec<usize> = symbols.keys().copied().collect();
        let slopes = self.slopes(lagrangian, &places);
        for ((&place, &symbol), slope) in symbols.iter().zip(slopes) {
            let friction = derivative(self.graph, extended.dissipation, symbol);
            let mut terms = vec![(friction, Rational::MINUS_ONE)];
            if let Some(&force) = extended.forces.get(&symbol) {
                terms.push((force, Rational::ONE));
            }
            terms.push((slope, Rational::ONE));
            let rate = self.graph.sum(&terms);
            let drift = total_derivative(self.graph, momenta[&place], &BTreeMap::new());
            let mut force = self.graph.sub(rate, drift);
            if let Some(turned) = turned.get_mut(&place) {
                force = self.graph.sub(force, *turned);
                *turned = self.at(*turned);
            }
            let force = velocity_polynomial::collected(self.graph, force);
            let force = self.at(force);
            let rate = self.at(rate);
            rates.insert(place, rate);
            let force = self.scaled(force, &[place]);
            forces.insert(place, force);
        }
        let drifts: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drift.clone()).collect();
        let held = self.held(extended, &masses, &forces, &drifts);
        let dense = alone.then(|| self.folded(&masses, forces.clone(), &drifts));
        let accelerations = self.solve(&masses, forces, &drifts)?;

        // Velocities from momenta: the same unknowns, with the drive in place of the drift.
        let rest = |symbol: Symbol| {
            matches!(symbol, Symbol::Velocity(_) | Symbol::Auxiliary(_)).then_some(Graph::ZERO)
        };
        let mut right = BTreeMap::new();
        for (&place, &momentum) in &momenta {
            let offset = substitute(self.graph, momentum, rest);
            let own = (place < count).then(|| self.graph.symbol(Symbol::Momentum(place)));
            let offset = self.at(offset);
            let value = self.graph.sub(own.unwrap_or_default(), offset);
            let value = self.scaled(value, &[place]);
            right.insert(place, value);
        }
        let drive: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drive.clone()).collect();
        let from_momenta = self.solve(&masses, right, &drive)?;

        let (all_momenta, all_rates) = self.backward_pass(&momenta, &rates);
        let unsolved = self.unsolved(&momenta, &rates, &turned);
        let own = at_rest_controls(self.graph, lagrangian);
        let mut energy = vec![(own, Rational::MINUS_ONE)];
        for (&place, &symbol) in &symbols {
            let velocity = self.graph.symbol(symbol);
            let drive = drives.get(&place).copied().unwrap_or_default();
            let velocity = self.graph.sub(velocity, drive);
            energy.push((self.graph.mul(velocity, momenta[&place]), Rational::ONE));
        }
        let energy = self.graph.sum(&energy);
        let energy = velocity_polynomial::collected(self.graph, energy);
        let energy = self.at(energy);
        let kinetic = extended.kinetic.map(|kinetic| {
            let kinetic = velocity_polynomial::collected(self.graph, kinetic);
            self.at(kinetic)
        });
        Some(Sparse {
            accelerations,
            velocities: from_momenta,
            momenta: all_momenta,
            momentum_rates: all_rates,
            energy,
            kinetic,
            unsolved,
            dense,
            held,
        })
    }
}
