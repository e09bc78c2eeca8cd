//! The equations of motion in sparse form: the velocities of `let` positions are further unknowns,
//! which are eliminated from the leaves to the root.
//!
//! In a chain, each position is yₖ = yₖ₋₁ plus a link. Its mass matrix is full but depends on few
//! quantities. With the velocities uₛ of positions z in addition to those of the coordinates, the
//! Lagrangian Λ(q, q̇, u) has a sparse Hessian H. The motion is the stationary point of ½wᵀHw − Gᵀw
//! over the accelerations w = (q̈, u̇) with u̇ᵢ = u̇ₚ + J q̈ + γ for each position zᵢ and its
//! parent zₚ (Gauss 1829). Substituting the leaves into their parents and eliminating each joint
//! afterwards is the articulated-body recursion (Featherstone 1983): the cost is proportional to
//! the number of joints, and trees branch without fill-in.

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
use crate::mechanics::lower::{Extended, total_derivative};
use std::collections::BTreeMap;
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
/// there are no positions or no sparse form.
pub(crate) fn sparse(graph: &mut Graph, extended: &Extended, count: usize) -> Option<Sparse> {
    let lagrangian = velocity_polynomial::by_velocities(graph, extended.lagrangian)?;
    let mut used = graph.symbols(&[lagrangian, extended.dissipation]);
    let held = extended.constraints.as_deref().unwrap_or_default();
    used.extend(graph.symbols(held).into_iter().filter_map(|symbol| match symbol {
        Symbol::Position(scalar) => Some(Symbol::Auxiliary(scalar)),
        _ => None,
    }));
    if !used.iter().any(|symbol| matches!(symbol, Symbol::Auxiliary(_))) {
        return None;
    }
    let mut tree = Tree { graph, count, joints: Vec::new(), units: vec![Graph::ONE; count] };
    tree.build_tree(extended, &used);
    tree.forms(extended, lagrangian)
}

impl Tree<'_> {
    fn forms(&mut self, extended: &Extended, lagrangian: Id) -> Option<Sparse> {
        let count = self.count;
        let scalars: Vec<usize> =
            self.joints.iter().flat_map(|joint| joint.scalars.clone()).collect();
        // The scalars of positions follow the coordinates in the order of the unknowns.
        let symbols: BTreeMap<usize, Symbol> = (0..count)
            .map(|j| (j, Symbol::Velocity(j)))
            .chain(scalars.iter().map(|&scalar| (count + scalar, Symbol::Auxiliary(scalar))))
            .collect();
        let momenta: BTreeMap<usize, Id> = symbols
            .iter()
            .map(|(&place, &symbol)| (place, derivative(self.graph, lagrangian, symbol)))
            .collect();
        let mut masses = BTreeMap::new();
        let moving = Dependencies::VELOCITY.or(Dependencies::AUXILIARY);
        for (&row, &momentum) in &momenta {
            for (&column, &symbol) in symbols.range(..=row) {
                let entry = derivative(self.graph, momentum, symbol);
                if self.graph.dependencies(entry).any(moving) {
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
                let slope = derivative(self.graph, lagrangian, Symbol::Coordinate(place));
                terms.push((slope, Rational::ONE));
            }
            let rate = self.graph.sum(&terms);
            let drift = total_derivative(self.graph, momenta[&place], &BTreeMap::new());
            let force = self.graph.sub(rate, drift);
            let force = velocity_polynomial::collected(self.graph, force);
            let force = self.at(force, &velocities);
            let rate = self.at(rate, &velocities);
            rates.insert(place, rate);
            let force = self.scaled(force, &[place]);
            forces.insert(place, force);
        }
        let drifts: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drift.clone()).collect();
        let held = self.held(extended, &masses, &forces, &drifts, &velocities);
        let accelerations = self.solve(&masses, forces, &drifts)?;

        // Velocities from momenta: the same unknowns, with the drive in place of the drift.
        let rest = |symbol: Symbol| {
            matches!(symbol, Symbol::Velocity(_) | Symbol::Auxiliary(_)).then_some(Graph::ZERO)
        };
        let mut right = BTreeMap::new();
        for (&place, &momentum) in &momenta {
            let offset = substitute(self.graph, momentum, rest);
            let own = (place < count).then(|| self.graph.symbol(Symbol::Momentum(place)));
            let value = self.graph.sub(own.unwrap_or_default(), offset);
            let value = self.scaled(value, &[place]);
            right.insert(place, value);
        }
        let drive: Vec<Vec<Id>> = self.joints.iter().map(|joint| joint.drive.clone()).collect();
        let from_momenta = self.solve(&masses, right, &drive)?;

        let (all_momenta, all_rates) = self.backward_pass(&momenta, &rates, &velocities);
        let unsolved = self.unsolved(&momenta, &rates, &velocities);
        let mut energy = vec![(lagrangian, Rational::MINUS_ONE)];
        for (&place, &symbol) in &symbols {
            let velocity = self.graph.symbol(symbol);
            let drive = drives.get(&(place.wrapping_sub(count))).copied().unwrap_or_default();
            let velocity = self.graph.sub(velocity, drive);
            energy.push((self.graph.mul(velocity, momenta[&place]), Rational::ONE));
        }
        let energy = self.graph.sum(&energy);
        let energy = velocity_polynomial::collected(self.graph, energy);
        let energy = self.at(energy, &velocities);
        let kinetic = extended.kinetic.map(|kinetic| {
            let kinetic = velocity_polynomial::collected(self.graph, kinetic);
            self.at(kinetic, &velocities)
        });
        Some(Sparse {
            accelerations,
            velocities: from_momenta,
            momenta: all_momenta,
            momentum_rates: all_rates,
            energy,
            kinetic,
            unsolved,
            held,
        })
    }
}
