//! The compiler: its passes, in order.

use crate::algebra::expr::Graph;
use crate::backend::Analysis;
use crate::backend::compiled::{Compiled, Message};
use crate::backend::ide;
use crate::backend::names::Names;
use crate::backend::unicode;
use crate::backend::{latex, layout, mathml};
use crate::mechanics::euler_lagrange;
use crate::mechanics::lower;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::messages::{Errors, message};
use crate::model;
use crate::model::Model;
use crate::model::{frame, unit};
use crate::schedule;
use crate::syntax::derive;
use crate::syntax::parse;
use proc_macro2::TokenStream;
use quote::quote;

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
        let items = analysis.items();
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
        Err(error) => {
            let message = message!(
                "this cannot be read: a bracket, a quote or a comment is not closed, or a \
                 character does not belong to the language"
            );
            return Err(vec![Message::new(message, error.span())]);
        }
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
    let units = unit::infer::check(&model, &energies.velocity_constraints(&graph), errors);
    frame::check(&model, errors);
    let motion = euler_lagrange::derive(&model, &mut graph, &mut energies, errors);
    let equations = printed(&model, &mut graph, &energies, motion.as_ref());
    let accelerations =
        motion.as_ref().map(|motion| schedule::program(&graph, &motion.accelerations));
    let model = &model;
    Some(backend(Analysis {
        krate,
        model,
        graph,
        energies,
        motion,
        equations,
        accelerations,
        units,
    }))
}

/// Returns the equations of motion in Unicode, LaTeX and MathML, none without a motion. Right sides are
/// shortened once for all.
fn printed(
    model: &Model,
    graph: &mut Graph,
    energies: &Energies,
    motion: Option<&Motion>,
) -> [Vec<String>; 3] {
    let Some(motion) = motion else { return Default::default() };
    let (names, motion) = Names::new(model, energies).printed(model, motion);
    let sides = unicode::sides(graph, &names, motion);
    let formulas = layout::equations(graph, &names, motion, &sides);
    let [latex, mathml] = [latex::equation, mathml::equation]
        .map(|written| formulas.iter().map(|formula| written(formula)).collect());
    [unicode::equations(graph, &names, motion, &sides), latex, mathml]
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

#[cfg(test)]
mod tests {
    use super::compile;
    use crate::backend::compiled::Position;

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
        assert_eq!(unclosed.len(), 1);
        assert!(unclosed[0].text.starts_with("this cannot be read: "));
        assert_eq!(unclosed[0].start, at(2, 9));
        assert_eq!(places("").len(), 1);
    }
}
