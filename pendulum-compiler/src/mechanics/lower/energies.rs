//! The scalars of a block, as given by its statements.

use super::friction::Friction;
use super::output::Output;
use super::row::Row;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use std::collections::{BTreeMap, BTreeSet};

/// The scalars of a block.
#[derive(Debug, Default)]
pub(crate) struct Energies {
    pub(crate) kinetic: Option<Id>,
    pub(crate) potential: Option<Id>,
    pub(crate) lagrangian: Option<Id>,
    pub(crate) dissipation: Option<Id>,
    /// The generalized force of each coordinate.
    pub(crate) forces: Vec<Id>,
    /// The rates of the states, by their places among the scalar coordinates.
    pub(crate) rates: BTreeMap<usize, Id>,
    /// The scalars of the default of each parameter; none without a default.
    pub(crate) defaults: Vec<Vec<Id>>,
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
    /// The scalar rates with dry friction.
    pub(crate) frictions: Vec<Friction>,
    /// The multipliers whose size enters the magnitude of a friction: the first and their number.
    pub(crate) loads: Vec<[usize; 2]>,
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
    /// The generalized force of each velocity.
    pub(crate) forces: BTreeMap<Symbol, Id>,
    /// The rotations defined with `let`, whose symbols follow those of the coordinates.
    pub(crate) frames: Vec<Frame>,
    /// The scalars of each position.
    pub(crate) positions: Vec<Vec<usize>>,
    /// The value of each scalar.
    pub(crate) scalars: Vec<Id>,
    /// The holonomic constraints that are solved, in terms of positions where they contain them;
    /// `None` if there is a constraint of velocities.
    pub(crate) constraints: Option<Vec<Id>>,
}

/// A rotation defined with `let`, in terms of the coordinates and of the rotations before it.
#[derive(Debug)]
pub(crate) struct Frame {
    /// The matrix, row by row.
    pub(crate) entries: [Id; 9],
    /// The rates about the axes behind the rotation.
    pub(crate) rates: [Id; 3],
}

impl Energies {
    /// Returns the constraints of velocities, as indices of their statements.
    pub(crate) fn velocity_constraints(&self, graph: &Graph) -> BTreeSet<usize> {
        let velocity = |row: &&Row| graph.dependencies(row.value).any(Dependencies::VELOCITY);
        self.constraints.iter().filter(velocity).map(|row| row.statement).collect()
    }

    /// Returns all expressions of the energies.
    ///
    /// The expressions that are missing here become invalid if the graph is rebuilt. Every field is
    /// therefore named.
    pub(crate) fn roots(&mut self) -> Vec<&mut Id> {
        let Self {
            kinetic,
            potential,
            lagrangian,
            dissipation,
            forces,
            rates,
            defaults,
            families: _,
            lengths: _,
            outputs,
            constraints,
            limits,
            frictions,
            loads: _,
            extended,
        } = self;
        let single = [kinetic, potential, lagrangian, dissipation].into_iter().flatten();
        let outputs = outputs.iter_mut();
        let outputs = outputs.flat_map(|output| output.scalars.iter_mut().chain(&mut output.open));
        let rows = constraints.iter_mut().chain(limits);
        let rows = rows.flat_map(|row| [&mut row.value, &mut row.restitution]);
        single
            .chain(forces)
            .chain(rates.values_mut())
            .chain(defaults.iter_mut().flatten())
            .chain(outputs)
            .chain(rows)
            .chain(frictions.iter_mut().flat_map(Friction::roots))
            .chain(extended.iter_mut().flat_map(Extended::roots))
            .collect()
    }
}

impl Extended {
    /// Returns all expressions.
    fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let Self {
            lagrangian,
            kinetic,
            dissipation,
            forces,
            frames,
            positions: _,
            scalars,
            constraints,
        } = self;
        let single = [lagrangian, dissipation].into_iter().chain(kinetic.as_mut());
        let frames = frames.iter_mut().flat_map(|own| own.entries.iter_mut().chain(&mut own.rates));
        single
            .chain(forces.values_mut())
            .chain(frames)
            .chain(scalars)
            .chain(constraints.iter_mut().flatten())
    }
}
