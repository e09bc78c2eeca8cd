//! The declarations and equations of a block as data, and its mistakes with their positions.

use crate::algebra::expr::{Id, Symbol};
use crate::backend::Analysis;
use crate::backend::names::Names;
use crate::backend::unicode;
use crate::mechanics::lower;
use crate::model::Quantity;
use crate::schedule::Operations;
use proc_macro2::LineColumn;
use std::fmt::Display;

/// The declarations and the equations of a block.
///
/// Formulas are in ASCII if the block is in ASCII, otherwise in Unicode. Families of coordinates
/// are expanded: there is an equation and a momentum for each scalar coordinate, in the order of
/// declaration.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Compiled {
    /// The name of the struct.
    pub name: String,
    /// The fields of the struct.
    pub parameters: Vec<Declaration>,
    /// The coordinates, followed by the states.
    pub coordinates: Vec<Declaration>,
    /// The driven inputs.
    pub inputs: Vec<Declaration>,
    /// The control inputs.
    pub controls: Vec<Declaration>,
    /// The outputs.
    pub outputs: Vec<Output>,
    /// The equations of motion, θ̈ = …, and those of states, ż = …. The right side of a very long
    /// equation is replaced by a remark.
    pub equations: Vec<String>,
    /// The equations in LaTeX in math mode, without delimiters.
    pub latex: Vec<String>,
    /// The equations as MathML elements.
    pub mathml: Vec<String>,
    /// The energy Σ q̇ p − L.
    pub energy: String,
    /// The rate of change of the energy, by forces, dissipation, time and driven inputs.
    pub power: String,
    /// The momenta ∂L/∂q̇.
    pub momenta: Vec<String>,
    /// The conserved momenta.
    pub conserved: Vec<String>,
    /// The operations of one evaluation of the accelerations.
    pub operations: Operations,
}

/// A declared parameter, coordinate or input.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Declaration {
    /// The name.
    pub name: String,
    /// The unit as written; empty without a unit.
    pub unit: String,
    /// The length of a vector, a family or a column of a matrix; `None` for a scalar and for a body.
    pub length: Option<usize>,
    /// The number of components of each member of a family of vectors, or of columns of a matrix.
    pub components: Option<usize>,
    /// `true` for a rigid body, in the plane or in space.
    pub body: bool,
}

/// An output: its declaration and its value.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Output {
    /// The name.
    pub name: String,
    /// The unit as written; empty without a unit.
    pub unit: String,
    /// The number of members of a family.
    pub members: Option<usize>,
    /// The number of components of a vector, or of each member of a family of vectors.
    pub components: Option<usize>,
    /// The value of each component of the first member, followed by those of the second, and so on.
    /// A very long one is replaced by a remark, as are energy, power and momenta.
    pub expressions: Vec<String>,
}

/// A mistake in a block.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Message {
    /// The mistake and advice on how to correct it.
    pub text: String,
    /// The position of the first token at fault.
    pub start: Position,
    /// The position after the last token at fault.
    pub end: Position,
}

/// A position in source text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line, counted from 1.
    pub line: usize,
    /// The number of characters (`char`) before the position in its line. θ̇ is two characters.
    pub column: usize,
}

impl Message {
    pub(crate) fn new(text: impl Display, span: proc_macro2::Span) -> Self {
        Self { text: text.to_string(), start: span.start().into(), end: span.end().into() }
    }
}

impl From<LineColumn> for Position {
    fn from(LineColumn { line, column }: LineColumn) -> Self {
        Self { line, column }
    }
}

impl Compiled {
    /// Creates the result; `None` without equations.
    pub(crate) fn new(analysis: Analysis<'_, '_>) -> Option<Self> {
        let Analysis {
            model,
            graph,
            energies,
            motion,
            equations: [equations, latex, mathml],
            accelerations,
            ..
        } = analysis;
        let (motion, accelerations) = (motion?, accelerations?);
        let names = Names::new(model, &energies);
        let (names_of_printed, printed) = Names::new(model, &energies).printed(model, &motion);
        let text = |id| unicode::short(&graph, &names, id);
        // Without a run, the forces of contacts and frictions are zero, which says nothing.
        let pushed = |&id: &Id| {
            let force = |own: &Symbol| matches!(own, Symbol::Contact(_) | Symbol::Friction(_));
            graph.symbols(&[id]).iter().any(force)
        };
        let shown = |output: &lower::Output| {
            if output.open.iter().any(pushed) { &output.open } else { &output.scalars }.clone()
        };
        let declared = |quantities: &[Quantity<'_>]| {
            let declaration = |quantity: &Quantity<'_>| Declaration {
                name: quantity.name.to_string(),
                unit: quantity.unit.clone(),
                length: quantity.lengths().first().copied(),
                components: quantity.lengths().get(1).copied(),
                body: quantity.is_body(),
            };
            quantities.iter().map(declaration).collect()
        };
        Some(Self {
            name: model.block.name.to_string(),
            parameters: declared(&model.parameters),
            coordinates: declared(&model.coordinates),
            inputs: declared(&model.inputs[..model.driven]),
            controls: declared(&model.inputs[model.driven..]),
            outputs: model
                .outputs
                .iter()
                .zip(&energies.outputs)
                .map(|(output, lowered)| Output {
                    name: output.declared.name.to_string(),
                    unit: output.declared.unit.clone(),
                    members: lowered.members,
                    components: lowered.components,
                    expressions: shown(lowered).iter().copied().map(text).collect(),
                })
                .collect(),
            energy: unicode::short(&graph, &names_of_printed, printed.energy),
            power: unicode::short(
                &graph,
                &names_of_printed,
                printed.constraints.power.unwrap_or(printed.power),
            ),
            momenta: motion.momenta[..model.freedoms()].iter().copied().map(text).collect(),
            conserved: motion
                .conserved
                .iter()
                .map(|conserved| unicode::conserved(&names, conserved))
                .collect(),
            operations: accelerations.count(),
            equations,
            latex,
            mathml,
        })
    }
}
