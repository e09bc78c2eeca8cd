//! The scalars of a block, as given by its statements.

use super::output::Output;
use super::row::Row;
use crate::algebra::expr::{Dependencies, Graph, Id};
use std::collections::BTreeSet;

/// The scalars of a block.
#[derive(Debug, Default)]
pub(crate) struct Energies {
    pub(crate) kinetic: Option<Id>,
    pub(crate) potential: Option<Id>,
    pub(crate) lagrangian: Option<Id>,
    pub(crate) dissipation: Option<Id>,
    /// The generalized force of each coordinate.
    pub(crate) forces: Vec<Id>,
    /// The default of each parameter, if any.
    pub(crate) defaults: Vec<Option<Id>>,
    /// The parameters of two or three components that are used only with indices. They are
    /// families, not vectors.
    pub(crate) families: BTreeSet<usize>,
    /// For each definition, the lengths of its value, outermost first.
    pub(crate) lengths: Vec<Vec<usize>>,
    pub(crate) outputs: Vec<Output>,
    /// The scalar constraints: those that are solved, followed by the redundant ones.
    pub(crate) constraints: Vec<Row>,
    /// The scalar limits.
    pub(crate) limits: Vec<Row>,
    /// The energies with the velocities of positions as separate symbols; `None` if no position is
    /// defined with `let`.
    pub(crate) extended: Option<Extended>,
}

/// The energies of a block with the velocities of `let` positions as separate symbols.
#[derive(Debug, Default)]
pub(crate) struct Extended {
    pub(crate) lagrangian: Id,
    pub(crate) kinetic: Option<Id>,
    pub(crate) dissipation: Id,
    pub(crate) forces: Vec<Id>,
    /// The scalars of each position.
    pub(crate) positions: Vec<Vec<usize>>,
    /// The value of each scalar.
    pub(crate) scalars: Vec<Id>,
    /// The holonomic constraints that are solved, in terms of positions where they contain them;
    /// `None` if there is a constraint of velocities.
    pub(crate) constraints: Option<Vec<Id>>,
}

impl Energies {
    /// Returns the constraints of velocities, as indices of their statements.
    pub(crate) fn velocity_constraints(&self, graph: &Graph) -> BTreeSet<usize> {
        let velocity = |row: &&Row| graph.dependencies(row.value).any(Dependencies::VELOCITY);
        self.constraints.iter().filter(velocity).map(|row| row.statement).collect()
    }

    /// Returns all expressions of the energies.
    pub(crate) fn roots(&mut self) -> Vec<&mut Id> {
        let single =
            [&mut self.kinetic, &mut self.potential, &mut self.lagrangian, &mut self.dissipation];
        let single = single.into_iter().flatten();
        let extended = self.extended.iter_mut().flat_map(|extended| {
            let single = [&mut extended.lagrangian, &mut extended.dissipation]
                .into_iter()
                .chain(extended.kinetic.as_mut());
            let constraints = extended.constraints.iter_mut().flatten();
            single.chain(&mut extended.forces).chain(&mut extended.scalars).chain(constraints)
        });
        let rows = self.constraints.iter_mut().chain(&mut self.limits);
        let rows = rows.flat_map(|row| [&mut row.value, &mut row.restitution]);
        single
            .chain(&mut self.forces)
            .chain(self.defaults.iter_mut().flatten())
            .chain(
                self.outputs
                    .iter_mut()
                    .flat_map(|output| output.scalars.iter_mut().chain(&mut output.open)),
            )
            .chain(rows)
            .chain(extended)
            .collect()
    }
}
