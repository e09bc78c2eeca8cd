//! The `lagrangian!` macro of the `pendulum` workspace: a Lagrangian in, Rust out.

use error::Errors;
use proc_macro2::TokenStream;

mod ast;
mod check;
mod collect;
mod diff;
mod emit;
mod error;
mod expr;
mod jacobian;
mod latex;
mod lower;
mod mirror;
mod modular;
mod motion;
mod name;
mod number;
mod order;
mod parse;
mod print;
mod rule;
mod schedule;
mod solve;
mod symmetry;
#[cfg(test)]
mod tests;
mod unit;

/// Takes a Lagrangian and emits a type that implements `pendulum_runtime::system::System`.
#[doc = include_str!("../language.md")]
#[proc_macro]
pub fn lagrangian(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand(input.into()).into()
}

/// The compiler: parse, check, lower, derive, emit. The items are always there, whatever is wrong with the block.
fn expand(input: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let Some((krate, block)) = parse::all(input, &mut errors) else {
        return errors.into_tokens();
    };
    let model = check::resolve(&block, &mut errors);
    let mut graph = expr::Graph::new();
    let mut energies = lower::energies(&model, &mut graph, &mut errors);
    if errors.is_empty() {
        unit::infer::check(&model, &mut errors);
    }
    let motion = if errors.is_empty() { motion::canonical(&model, &mut graph, &mut energies, &mut errors) } else { None };
    let items = emit::Emitter { krate, model: &model, graph, motion, energies }.items();
    let errors = errors.into_tokens();
    quote::quote!(#errors #items)
}
