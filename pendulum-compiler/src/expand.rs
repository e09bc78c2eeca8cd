//! The compiler: parse, check, lower, derive, emit.

use crate::error::Errors;
use crate::{check, derive, emit, expr, lower, motion, parse, unit};
use proc_macro2::TokenStream;

/// The items of a block. They are always there, whatever is wrong with the block.
pub fn expand(input: TokenStream) -> TokenStream {
    let mut errors = Errors::default();
    let Some((krate, mut block)) = parse::all(input, &mut errors) else {
        return errors.into_tokens();
    };
    derive::check(&mut block.attributes, &mut errors);
    let model = check::resolve(&block, &mut errors);
    let mut graph = expr::Graph::new();
    let mut energies = lower::energies(&model, &mut graph, &mut errors);
    if errors.is_empty() {
        unit::infer::check(&model, &mut errors);
    }
    let motion = if errors.is_empty() { motion::canonical(&model, &mut graph, &mut energies, &mut errors) } else { None };
    let items = emit::Emitter::new(krate, &model, graph, motion, energies).items();
    let errors = errors.into_tokens();
    quote::quote!(#errors #items)
}
