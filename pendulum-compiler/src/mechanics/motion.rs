//! The equations of motion of a block and the quantities derived with them.

use crate::algebra::expr::{Dependencies, Graph, Id};
use crate::mechanics::articulated::Unsolved;
use crate::mechanics::constraint::Constraints;
use crate::mechanics::lower::{Energies, Friction};
use crate::mechanics::symmetry::Conserved;

/// The equations of motion and the quantities derived with them: roots in one graph.
#[derive(Debug, Default)]
pub(crate) struct Motion {
    pub(crate) accelerations: Vec<Id>,
    pub(crate) momenta: Vec<Id>,
    /// The rows of the symmetric mass matrix.
    pub(crate) mass_matrix: Vec<Vec<Id>>,
    pub(crate) forces: Vec<Id>,
    /// For each scalar state, its rate, and the derivative of its rate with the accelerations as
    /// symbols.
    pub(crate) states: Vec<[Id; 2]>,
    pub(crate) momentum_rates: Vec<Id>,
    /// Equations, energy and power in the rates of bodies, for printed equations; `None` without
    /// rotations.
    pub(crate) in_rates: Option<Box<Motion>>,
    /// The equations before they are solved, if positions are defined with `let`.
    pub(crate) unsolved: Option<Unsolved>,
    /// q̇ as a function of p; `None` if L is not quadratic in the velocities.
    pub(crate) velocities: Option<Vec<Id>>,
    pub(crate) energy: Id,
    pub(crate) power: Id,
    pub(crate) kinetic: Option<Id>,
    pub(crate) potential: Option<Id>,
    /// The columns of ∂q̈/∂q, ∂q̈/∂q̇, ∂q̈/∂parameters and ∂q̈/∂u with the control inputs u; `None`
    /// if they would be too long.
    pub(crate) jacobians: Option<[Vec<Vec<Id>>; 4]>,
    pub(crate) cyclic: Vec<usize>,
    pub(crate) conserved: Vec<Conserved>,
    pub(crate) constraints: Constraints,
    pub(crate) autonomous: bool,
    pub(crate) explicit_time: bool,
    pub(crate) separable: bool,
    pub(crate) velocity_free: bool,
    /// `true` if all constraints are holonomic, the mass matrix is constant and the forces do not
    /// depend on velocities.
    pub(crate) holonomic: bool,
    pub(crate) linear: bool,
    pub(crate) constant_mass_matrix: bool,
    pub(crate) nonconservative: bool,
}

impl Motion {
    /// Returns all expressions of the motion but those that are only printed.
    pub(crate) fn roots(&mut self) -> Vec<&mut Id> {
        let lists = [&mut self.accelerations, &mut self.momenta, &mut self.forces];
        let lists = lists.into_iter().chain([&mut self.momentum_rates]).flatten();
        let lists = lists.chain(self.states.iter_mut().flatten());
        let single = [&mut self.energy, &mut self.power].into_iter();
        let single = single.chain(&mut self.kinetic).chain(&mut self.potential);
        let masses = self.mass_matrix.iter_mut().flatten();
        let velocities = self.velocities.iter_mut().flatten();
        let conserved = self.conserved.iter_mut().map(|conserved| &mut conserved.value);
        let jacobians = self.jacobians.iter_mut().flatten().flatten().flatten();
        let unsolved = self.unsolved.iter_mut();
        let unsolved = unsolved.flat_map(|own| own.carried.iter_mut().chain(&mut own.equations));
        let all = lists.chain(masses).chain(velocities).chain(conserved).chain(jacobians);
        all.chain(unsolved).chain(self.constraints.roots()).chain(single).collect()
    }

    /// Finds what methods and scenes ask of the equations.
    pub(super) fn find_facts(&mut self, graph: &mut Graph, energies: &Energies) {
        let all = |roots: &[Id]| {
            roots.iter().fold(Dependencies::default(), |all, &id| all.or(graph.dependencies(id)))
        };
        let masses = all(&self.mass_matrix.concat());
        let state = Dependencies::COORDINATE.or(Dependencies::VELOCITY);
        let time = Dependencies::TIME.or(Dependencies::INPUT);
        let forces = all(&self.forces);
        self.constant_mass_matrix = !masses.any(state.or(time));
        // A control input may be a function of the velocities.
        let moving = Dependencies::VELOCITY.or(Dependencies::CONTROL);
        let free = self.constraints.held.is_empty();
        let rubbed = !self.constraints.frictions.is_empty();
        let rows = self.constraints.held.iter().flat_map(|row| [row.value, row.rate, row.drift]);
        self.holonomic = !free
            && self.constraints.held.iter().all(|row| row.holonomic)
            && self.constant_mass_matrix
            && !rubbed
            && !forces.any(moving);
        let forces = forces.or(all(&rows.collect::<Vec<Id>>()));
        let free = free && !rubbed;
        self.velocity_free = free && self.constant_mass_matrix && !forces.any(moving);
        self.linear = free && self.constant_mass_matrix && graph.linear(&self.forces);
        // A state is integrated from its rate, whatever the acceleration in its place contains.
        let free = free && self.states.is_empty();
        self.velocity_free &= free;
        self.holonomic &= self.states.is_empty();
        let rates = self.constraints.frictions.iter().flat_map(|row| [row.rate, row.drift]);
        let rates = rates.chain(self.states.iter().map(|state| state[0]));
        let grips = energies.frictions.iter().flat_map(Friction::magnitudes);
        let frictions = all(&rates.chain(grips).collect::<Vec<Id>>());
        let dependencies = forces.or(all(&self.momenta)).or(masses).or(frictions);
        self.autonomous = !dependencies.any(time);
        let gaps: Vec<Id> = self.constraints.limits.iter().map(|limit| limit.value).collect();
        self.explicit_time = dependencies.or(all(&gaps)).any(Dependencies::TIME);
        let moving = all(self.velocities.as_deref().unwrap_or_default());
        let explicit = self.velocities.is_some() && !moving.any(Dependencies::COORDINATE);
        self.separable = free && self.constant_mass_matrix && explicit && !self.nonconservative;
    }
}
