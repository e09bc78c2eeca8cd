//! The editor's view: every name of a block in plain Rust, for hover, completion and go to
//! definition.
//!
//! The items exist only for rust-analyzer; rustc does not compile them. Declarations come from the
//! model and uses from the tokens, so that names are found even in a block that does not parse. A
//! use is a path into a module that contains exactly the names allowed at its position. Editors
//! take completions from this module.

mod names;
mod scan;
mod words;

use super::Analysis;
use crate::syntax::ast::Block;
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use scan::{BLOCK, Binding, Place, Scan};
pub(crate) use words::modules as words;

/// Returns a hidden function that mentions every name of a block, and the modules of the names.
///
/// `input` is the input of the macro; `analysis` is `None` if the struct cannot be read.
pub(crate) fn copy(input: &TokenStream, analysis: Option<&Analysis>) -> TokenStream {
    let mut trees = input.clone().into_iter();
    let krate: TokenStream = trees
        .by_ref()
        .take_while(|tree| !matches!(tree, TokenTree::Punct(sign) if sign.as_char() == ';'))
        .collect();
    let scan = scan::scan(trees.collect());
    let copy = Copy { krate: &krate, analysis, scan: &scan };
    let modules = copy.modules();
    let uses = scan.names.iter().map(|(name, place)| copy.usage(name.as_ref(), *place));
    let block = analysis.map(|analysis| analysis.model.block);
    let conditions = block.into_iter().flat_map(Block::conditions);
    quote! {
        #(#conditions)*
        #[allow(unexpected_cfgs, deprecated)]
        const _: () = {
            #[cfg(rust_analyzer)]
            fn __names() { #(#uses)* }
            #[cfg(rust_analyzer)]
            #[allow(nonstandard_style, unused)]
            mod __block { #modules }
        };
    }
}

struct Copy<'c, 'm, 'a> {
    krate: &'c TokenStream,
    analysis: Option<&'c Analysis<'m, 'a>>,
    scan: &'c Scan,
}

impl Copy<'_, '_, '_> {
    /// Returns a name as an expression with its own span, or a path of the same length at a
    /// position where a name could be inserted.
    fn usage(&self, name: Option<&Ident>, place: Place) -> TokenStream {
        if name.is_some_and(is_keyword) {
            return TokenStream::new();
        }
        let name = name.map_or_else(|| quote!(__none), ToTokens::to_token_stream);
        let krate = self.krate;
        let words = |module: &str| {
            let module = format_ident!("{module}");
            quote!(#krate::__private::words::#module)
        };
        let module = match place {
            Place::Statement => words("statements"),
            Place::Choice => words("choices"),
            Place::Unit => words("units"),
            Place::Component => words("components"),
            Place::Constraint => quote!(__block::constraints),
            Place::Expression(scope) => {
                let scope = module(scope);
                quote!(__block::#scope)
            }
        };
        quote!(let _ = #module::#name;)
    }

    /// Returns the modules of names: of constraints, of the block and of each of its scopes.
    fn modules(&self) -> TokenStream {
        let krate = self.krate;
        let [constraints, others] = self.declarations();
        let scopes = self.scan.scopes.iter().enumerate().map(|(index, scope)| {
            let (own, outer) = (module(index + 1), module(scope.outer));
            let names = scope.names.iter().filter(|(name, _)| !is_keyword(name));
            let names = names.map(|(name, binding)| Self::bound(name, binding));
            quote! {
                pub mod #own {
                    use #krate::__private::words::Quantity;
                    pub use super::#outer::*;
                    #(#names)*
                }
            }
        });
        let block = module(BLOCK);
        quote! {
            pub mod constraints {
                use #krate::__private::words::Constraint;
                #constraints
            }
            pub mod #block {
                use #krate::__private::words::Quantity;
                use #krate::body::Body;
                pub use #krate::__private::words::expressions::*;
                #others
            }
            #(#scopes)*
        }
    }

    /// Returns the item of a name bound in a scope.
    fn bound(name: &Ident, binding: &Binding) -> TokenStream {
        match binding {
            Binding::Index(range) => {
                let text = format!("An index in {range}.");
                quote!(#[doc = #text] pub static #name: usize;)
            }
            Binding::Point(body) => {
                let text = format!("A point of the body `{body}` at the angle zero, in m.");
                quote!(#[doc = #text] pub static #name: [f64; 2];)
            }
            Binding::Argument => {
                quote!(#[doc = "An argument."] pub static #name: &dyn Quantity;)
            }
        }
    }
}

/// Returns `true` if a name is a keyword of Rust, so that no item can have it.
fn is_keyword(name: &Ident) -> bool {
    syn::parse_str::<Ident>(&name.to_string()).is_err()
}

/// Returns the name of the module of a scope.
fn module(scope: usize) -> Ident {
    format_ident!("scope{scope}")
}
