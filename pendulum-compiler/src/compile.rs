//! The compiler: its passes, in order.

use crate::algebra::expr::Graph;
use crate::backend::Analysis;
use crate::backend::ide;
use crate::backend::latex;
use crate::backend::mathml;
use crate::backend::rust::Emitter;
use crate::backend::unicode;
use crate::backend::unicode::Names;
use crate::mechanics::euler_lagrange;
use crate::mechanics::lower;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::messages::{Errors, syntax};
use crate::model;
use crate::model::unit;
use crate::model::unit::infer::RowUnits;
use crate::model::{Model, Quantity};
use crate::schedule::{self, Operations};
use crate::syntax::derive;
use crate::syntax::parse;
use proc_macro2::{LineColumn, TokenStream};
use quote::quote;
use std::fmt::Display;

/// Expands a block of `lagrangian!` into Rust.
///
/// `input` is the path of the runtime, a semicolon and the block: `::pendulum_runtime; struct …`.
/// Each mistake results in a `compile_error!` at its tokens. If there are mistakes, the items are
/// emitted nevertheless, with `unimplemented!()` as bodies, unless the struct cannot be read. The
/// copy for editors precedes the items.
pub fn expand(input: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let tokens = input.clone();
    let items = passes(input, &mut errors, |analysis| {
        let copy = ide::copy(&tokens, Some(&analysis));
        let items = Emitter::new(analysis).items();
        (copy, items)
    });
    let (copy, items) = items.unwrap_or_else(|| (ide::copy(&tokens, None), TokenStream::new()));
    let errors = errors.into_tokens();
    quote!(#copy #errors #items)
}

/// Returns the keywords of the language as documented items, for editors.
#[doc(hidden)]
pub fn words() -> TokenStream {
    ide::words()
}

/// Compiles a block given as source text, outside of any macro. Returns its declarations and
/// equations.
///
/// # Errors
/// Returns all mistakes, in the order in which the passes find them.
///
/// # Memory
/// Outside of macros, `proc_macro2` stores every source text parsed by a thread until the thread
/// ends. A program that compiles an unlimited number of blocks has to use separate threads, or to
/// discard all spans of the thread with `proc_macro2::extra::invalidate_current_thread_spans`.
///
/// ```
/// let compiled = pendulum_compiler::compile(
///     "struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }
///      coordinate θ: rad;
///      kinetic = m/2*L^2*θ̇^2;
///      potential = -m*g*L*cos(θ);",
/// )
/// .unwrap();
/// assert_eq!(compiled.equations, ["θ̈ = −g·sin θ/L"]);
/// assert_eq!(compiled.operations.sincos, 1);
///
/// let block = "struct Pendulum { L: m }\ncoordinate θ: rad;\nkinetic = L^2*ω^2/2;";
/// let mistakes = pendulum_compiler::compile(block).unwrap_err();
/// assert!(mistakes[0].text.contains("`ω`"));
/// assert_eq!((mistakes[0].start.line, mistakes[0].start.column), (3, 14));
/// ```
pub fn compile(source: &str) -> Result<Compiled, Vec<Message>> {
    let tokens: TokenStream = match source.parse() {
        Ok(tokens) => tokens,
        Err(error) => return Err(vec![Message::new(syntax::broken_tokens(), error.span())]),
    };
    let mut errors = Errors::default();
    let compiled = passes(quote!(::pendulum_runtime; #tokens), &mut errors, Compiled::new);
    match compiled.flatten() {
        Some(compiled) if errors.is_empty() => Ok(compiled),
        _ => Err(errors.into_iter().map(|error| Message::new(&error, error.span())).collect()),
    }
}

/// Runs the passes and calls `backend` with their result; `None` if the struct cannot be read.
fn passes<R>(
    input: TokenStream,
    errors: &mut Errors,
    backend: impl FnOnce(Analysis<'_, '_>) -> R,
) -> Option<R> {
    let (krate, mut block) = parse::all(input, errors)?;
    derive::check(&mut block.attributes, errors);
    let model = model::resolve(&block, errors);
    let mut graph = Graph::new();
    let mut energies = lower::energies(&model, &mut graph, errors);
    let units = if errors.is_empty() {
        unit::infer::check(&model, &energies.velocity_constraints(&graph), errors)
    } else {
        RowUnits::default()
    };
    let motion = if errors.is_empty() {
        euler_lagrange::derive(&model, &mut graph, &mut energies, errors)
    } else {
        None
    };
    let equations = motion
        .as_ref()
        .map(|motion| printed(&model, &mut graph, &energies, motion))
        .unwrap_or_default();
    let accelerations =
        motion.as_ref().map(|motion| schedule::program(&graph, &motion.accelerations));
    Some(backend(Analysis {
        krate,
        model: &model,
        graph,
        energies,
        motion,
        equations,
        accelerations,
        units,
    }))
}

/// Returns the equations of motion in Unicode and in LaTeX. Right sides are shortened once for
/// both.
fn printed(
    model: &Model,
    graph: &mut Graph,
    energies: &Energies,
    motion: &Motion,
) -> [Vec<String>; 2] {
    let names = Names::new(model, energies);
    let sides = unicode::sides(graph, &names, motion);
    let latex = latex::equations(graph, &names, motion, &sides);
    [unicode::equations(graph, &names, motion, &sides), latex]
}

/// Analyzes a block for tests; `None` if it is refused.
#[cfg(test)]
pub(crate) fn derived<R>(
    source: &str,
    errors: &mut Errors,
    inspect: impl FnOnce(&Model, &mut Graph, &Motion, &Energies) -> R,
) -> Option<R> {
    let tokens = format!("::pendulum_runtime; {source}").parse().ok()?;
    let inspect = |mut analysis: Analysis<'_, '_>| {
        let motion = analysis.motion.as_ref()?;
        Some(inspect(analysis.model, &mut analysis.graph, motion, &analysis.energies))
    };
    passes(tokens, errors, inspect).flatten()
}

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
    /// The coordinates.
    pub coordinates: Vec<Declaration>,
    /// The driven inputs.
    pub inputs: Vec<Declaration>,
    /// The control inputs.
    pub controls: Vec<Declaration>,
    /// The outputs.
    pub outputs: Vec<Output>,
    /// The equations of motion, θ̈ = …. The right side of a very long equation is replaced by a
    /// remark.
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
    /// The length of a vector or family; `None` for a scalar and for a body.
    pub length: Option<usize>,
    /// `true` for a rigid body.
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
    fn new(text: impl Display, span: proc_macro2::Span) -> Self {
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
    fn new(analysis: Analysis<'_, '_>) -> Option<Self> {
        let Analysis {
            model,
            graph,
            energies,
            motion,
            equations: [equations, latex],
            accelerations,
            ..
        } = analysis;
        let (motion, accelerations) = (motion?, accelerations?);
        let names = Names::new(model, &energies);
        let text = |id| unicode::expression(&graph, &names, id);
        let declared = |quantities: &[Quantity<'_>]| {
            let declaration = |quantity: &Quantity<'_>| Declaration {
                name: quantity.name.to_string(),
                unit: quantity.unit.clone(),
                length: quantity.length,
                body: quantity.body,
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
                    expressions: lowered.scalars.iter().copied().map(text).collect(),
                })
                .collect(),
            energy: text(motion.energy),
            power: text(motion.constraints.power.unwrap_or(motion.power)),
            momenta: motion.momenta.iter().copied().map(text).collect(),
            conserved: motion
                .conserved
                .iter()
                .map(|conserved| unicode::conserved(&names, conserved))
                .collect(),
            operations: accelerations.count(),
            equations,
            mathml: latex.iter().map(|line| mathml::equation(line)).collect(),
            latex,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Position, compile};
    use crate::messages::syntax;

    #[test]
    fn the_model_is_what_is_declared() {
        let compiled = compile(
            "struct Cart { M: kg, g: m/s^2 } coordinate x: m; kinetic = M/2*ẋ^2*z; potential = M*g*x;",
        );
        // `z` is not declared. Only this mistake is reported.
        assert_eq!(compiled.unwrap_err().len(), 1);
        let compiled = compile(
            "struct Cart { M: kg, m: [kg; 2], l: m, g: m/s^2 } coordinate x: m; coordinate θ[2]: rad; driven u: [m; 2];
             kinetic = M/2*ẋ^2 + sum(k in 0..2, m[k]/2*(|[ẋ, 0] + u̇|^2 + l^2*θ̇[k]^2)); potential = M*g*x;",
        );
        let compiled = compiled.unwrap_or_else(|messages| panic!("{messages:?}"));
        let lengths: Vec<_> = compiled
            .coordinates
            .iter()
            .map(|declared| (declared.name.as_str(), declared.length))
            .collect();
        assert_eq!(lengths, [("x", None), ("θ", Some(2))]);
        assert_eq!(
            (compiled.parameters[1].unit.as_str(), compiled.inputs[0].length),
            ("kg", Some(2))
        );
        assert_eq!(
            (compiled.equations.len(), compiled.latex.len(), compiled.momenta.len()),
            (3, 3, 3)
        );
    }

    #[test]
    fn messages_know_their_places() {
        let places = |source| {
            compile(source)
                .unwrap_err()
                .into_iter()
                .map(|message| (message.start, message.end))
                .collect::<Vec<_>>()
        };
        let at = |line, column| Position { line, column };
        assert_eq!(
            places("struct S {}\ncoordinate q;\nkinetic = q̇^2/2;\npotential = k*q;"),
            [(at(4, 12), at(4, 13))]
        );
        // Columns count characters, and θ̇ is two.
        assert_eq!(
            places("struct S {} coordinate θ; kinetic = θ̇^2/2; potential = k*θ;"),
            [(at(1, 56), at(1, 57))]
        );
        let unclosed = compile("coordinate θ;\nstruct S {").unwrap_err();
        assert_eq!((unclosed.len(), &unclosed[0].text), (1, &syntax::broken_tokens().to_string()));
        assert_eq!(unclosed[0].start, at(2, 9));
        assert_eq!(places("").len(), 1);
    }
}
