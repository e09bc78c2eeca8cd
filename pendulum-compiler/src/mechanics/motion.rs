//! The equations of motion of a block and the quantities derived with them.

use crate::algebra::expr::Id;
use crate::mechanics::articulated::Unsolved;
use crate::mechanics::constraint::Constraints;
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
}
