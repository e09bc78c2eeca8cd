//! The compiler: its passes, in order.

use crate::algebra::expr::Graph;
use crate::backend::Analysis;
use crate::backend::latex;
use crate::backend::rust::Emitter;
use crate::backend::unicode;
use crate::backend::unicode::Names;
use crate::mechanics::euler_lagrange;
use crate::mechanics::lower;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::messages::Errors;
use crate::model;
use crate::model::unit;
use crate::model::{Model, Quantity};
use crate::schedule::{self, Count};
use crate::syntax::derive;
use crate::syntax::parse;
use proc_macro2::{LineColumn, TokenStream};
use quote::quote;

/// The items of a block of `lagrangian!`, with the path of the runtime in front.
///
/// The items are always there: each mistake adds a `compile_error!` at its tokens.
pub fn expand(input: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let items = passes(input, &mut errors, |analysis| Emitter::new(analysis).items());
    let errors = errors.into_tokens();
    quote!(#errors #items)
}

/// The model and the equations of a block, given as source text; no macro is needed.
///
/// # Errors
/// All mistakes, in the order in which the passes meet them.
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
/// let mistakes = pendulum_compiler::compile("struct Pendulum { L: m }\ncoordinate θ: rad;\nkinetic = L^2*ω^2/2;").unwrap_err();
/// assert!(mistakes[0].text.contains("`ω`"));
/// assert_eq!((mistakes[0].start.line, mistakes[0].start.column), (3, 14));
/// ```
pub fn compile(source: &str) -> Result<Compiled, Vec<Message>> {
    let tokens: TokenStream = match source.parse() {
        Ok(tokens) => tokens,
        Err(error) => return Err(vec![Message::new(error.to_string(), error.span())]),
    };
    let mut errors = Errors::default();
    let compiled = passes(quote!(::pendulum_runtime; #tokens), &mut errors, Compiled::new);
    match compiled.flatten() {
        Some(compiled) if errors.is_empty() => Ok(compiled),
        _ => Err(errors
            .into_iter()
            .map(|error| Message::new(error.to_string(), error.span()))
            .collect()),
    }
}

/// All passes, before `backend`; `None` if there is no block at all.
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
    if errors.is_empty() {
        unit::infer::check(&model, errors);
    }
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
    }))
}

/// The equations of motion in Unicode and in LaTeX; what they have in common is simplified once.
fn printed(
    model: &Model,
    graph: &mut Graph,
    energies: &Energies,
    motion: &Motion,
) -> [Vec<String>; 2] {
    let names = Names::new(model, &energies.families);
    let sides = unicode::sides(graph, &names, motion);
    let latex = latex::equations(graph, &names, motion, &sides);
    [unicode::equations(graph, &names, motion, &sides), latex]
}

/// A block as its tests see it; `None` if it is refused.
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

/// The model and the equations of a block.
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
    /// The equations of motion with their abbreviations, a line each: in Unicode, or in ASCII if
    /// the block is.
    pub equations: Vec<String>,
    /// The same lines in LaTeX.
    pub latex: Vec<String>,
    /// The energy, in the notation of the equations.
    pub energy: String,
    /// The power that forces, dissipation and motions supply.
    pub power: String,
    /// The momentum of each coordinate.
    pub momenta: Vec<String>,
    /// The momenta that are conserved.
    pub conserved: Vec<String>,
    /// The operations of one evaluation of the accelerations.
    pub operations: Operations,
}

/// A declared parameter, coordinate or driven input.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Declaration {
    /// Its name.
    pub name: String,
    /// Its unit, as written; empty without one.
    pub unit: String,
    /// The length of a vector or family; `None` for a scalar and a body.
    pub length: Option<usize>,
}

/// The operations of a program, after the part that parameters alone decide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Operations {
    /// Pairs of sine and cosine of one angle.
    pub sincos: usize,
    /// Other functions, roots among them.
    pub functions: usize,
    /// Products.
    pub mul: usize,
    /// Sums and differences.
    pub add: usize,
    /// Quotients.
    pub div: usize,
}

/// A mistake in a block.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Message {
    /// What is wrong, and what to do.
    pub text: String,
    /// The first character of the tokens at fault.
    pub start: Place,
    /// The one behind their last character.
    pub end: Place,
}

/// A place in source text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The line, from 1 on.
    pub line: usize,
    /// The character in the line, from 0 on.
    pub column: usize,
}

impl Message {
    fn new(text: String, span: proc_macro2::Span) -> Self {
        Self { text, start: span.start().into(), end: span.end().into() }
    }
}

impl From<LineColumn> for Place {
    fn from(LineColumn { line, column }: LineColumn) -> Self {
        Self { line, column }
    }
}

impl From<Count> for Operations {
    fn from(Count { sincos, functions, mul, add, div }: Count) -> Self {
        Self { sincos, functions, mul, add, div }
    }
}

impl Compiled {
    /// `None` without equations.
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
        let names = Names::new(model, &energies.families);
        let text = |id| unicode::expression(&graph, &names, id);
        let declared = |quantities: &[Quantity<'_>]| {
            let declaration = |quantity: &Quantity<'_>| Declaration {
                name: quantity.name.to_string(),
                unit: quantity.unit.clone(),
                length: quantity.length,
            };
            quantities.iter().map(declaration).collect()
        };
        Some(Self {
            name: model.block.name.to_string(),
            parameters: declared(&model.parameters),
            coordinates: declared(&model.coordinates),
            inputs: declared(&model.inputs),
            energy: text(motion.energy),
            power: text(motion.power),
            momenta: motion.momenta.iter().copied().map(text).collect(),
            conserved: motion
                .conserved
                .iter()
                .map(|conserved| unicode::conserved(&names, conserved))
                .collect(),
            operations: accelerations.count().into(),
            equations,
            latex,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Place, compile};

    #[test]
    fn the_model_is_what_is_declared() {
        let compiled = compile(
            "struct Cart { M: kg, g: m/s^2 } coordinate x: m; kinetic = M/2*ẋ^2*z; potential = M*g*x;",
        );
        // `z` is not declared: the mistake alone comes back.
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
        let at = |line, column| Place { line, column };
        assert_eq!(
            places("struct S {}\ncoordinate q;\nkinetic = q̇^2/2;\npotential = k*q;"),
            [(at(4, 12), at(4, 13))]
        );
        // Not even tokens.
        assert_eq!(places("struct S {\n").len(), 1);
        assert_eq!(places("").len(), 1);
    }
}
