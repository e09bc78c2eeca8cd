//! A block with resolved names: its quantities, definitions and statements.

use crate::algebra::dimension::Dimension;
use crate::syntax::ast::{self, Binder, Block, Expr, ForceIndex, Let, Role};
use proc_macro2::Ident;
use std::collections::{BTreeMap, BTreeSet};

/// A block with resolved names.
pub(crate) struct Model<'a> {
    pub(crate) block: &'a Block,
    pub(crate) parameters: Vec<Quantity<'a>>,
    pub(crate) coordinates: Vec<Quantity<'a>>,
    /// The driven inputs, followed by the control inputs.
    pub(crate) inputs: Vec<Quantity<'a>>,
    /// The number of driven inputs.
    pub(crate) driven: usize,
    pub(crate) outputs: Vec<Output<'a>>,
    pub(crate) lets: Vec<&'a Let>,
    pub(crate) energies: Vec<(Role, &'a Expr)>,
    pub(crate) forces: Vec<Force<'a>>,
    /// The constraints that are solved, followed by the redundant ones.
    pub(crate) constraints: Vec<&'a ast::Constraint>,
    pub(crate) limits: Vec<&'a ast::Limit>,
    pub(crate) names: BTreeMap<String, Meaning>,
    /// The parameters that no statement mentions.
    pub(crate) unmentioned: BTreeSet<usize>,
    /// The inputs and definitions that no other statement mentions.
    pub(crate) unused: Vec<&'a Ident>,
    /// The definitions used only by outputs. They may contain accelerations.
    pub(crate) of_outputs: BTreeSet<usize>,
}

/// The expressions of a statement that contributes to the equations of motion.
pub(super) struct Contribution<'a> {
    /// The index of a family.
    pub(super) index: Option<&'a Binder>,
    pub(super) exprs: Vec<&'a Expr>,
    /// `true` for a constraint or a limit: a message about an acceleration then names them in place
    /// of the Lagrangian.
    pub(super) constraint: bool,
}

impl<'a> Model<'a> {
    /// Returns the contributions of energies, forces, constraints and limits, in this order. All
    /// passes over names use this list.
    ///
    /// The names in a statement that is missing here are not checked. Every field is therefore
    /// named.
    pub(super) fn contributions(&self) -> Vec<Contribution<'a>> {
        let Self {
            energies,
            forces,
            constraints,
            limits,
            // The passes over names read definitions and outputs in their own order.
            lets: _,
            outputs: _,
            // Declarations, and results of the passes.
            block: _,
            parameters: _,
            coordinates: _,
            inputs: _,
            driven: _,
            names: _,
            unmentioned: _,
            unused: _,
            of_outputs: _,
        } = self;
        let of = |index, exprs, constraint| Contribution { index, exprs, constraint };
        let energies = energies.iter().map(|&(_, expr)| of(None, vec![expr], false));
        let forces = forces.iter().map(|force| match force.index {
            None => of(None, vec![force.expr], false),
            Some(ForceIndex::One(index)) => of(None, vec![index, force.expr], false),
            Some(ForceIndex::Each(binder)) => of(Some(binder), vec![force.expr], false),
        });
        let constraints =
            constraints.iter().map(|own| of(own.index.as_ref(), vec![&own.difference], true));
        let limits = limits
            .iter()
            .map(|own| of(own.index.as_ref(), vec![&own.difference, &own.restitution], true));
        energies.chain(forces).chain(constraints).chain(limits).collect()
    }

    /// Returns `true` if an input is a control input.
    pub(crate) fn is_control(&self, input: usize) -> bool {
        self.driven <= input
    }
}

/// A declared parameter, coordinate, input or output.
pub(crate) struct Quantity<'a> {
    pub(crate) name: &'a Ident,
    /// The length of a vector or family; `None` for a scalar.
    pub(crate) length: Option<usize>,
    /// The number of scalars declared before it.
    pub(crate) first: usize,
    pub(crate) dimension: Option<Dimension>,
    pub(crate) unit: String,
    pub(crate) default: Option<&'a Expr>,
    /// `true` for a rigid body, with mass, centre and central moments.
    pub(crate) body: bool,
}

impl Quantity<'_> {
    /// Returns the number of scalars.
    pub(crate) fn count(&self) -> usize {
        if self.body { 6 } else { self.length.unwrap_or(1) }
    }
}

/// An `output` statement.
pub(crate) struct Output<'a> {
    /// The name, unit and length as declared.
    pub(crate) declared: Quantity<'a>,
    pub(crate) statement: &'a ast::Output,
}

/// A `force` statement.
pub(crate) struct Force<'a> {
    pub(crate) coordinate: usize,
    pub(crate) name: &'a Ident,
    pub(crate) index: Option<&'a ForceIndex>,
    pub(crate) expr: &'a Expr,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Meaning {
    Parameter(usize),
    Coordinate(usize),
    Input(usize),
    Let(usize),
}
