//! Names that no statement mentions, as rustc itself warns of a variable that nobody reads.

use super::Emitter;
use crate::model::Model;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use syn::Attribute;

impl Emitter<'_, '_> {
    /// A function that reads none of these parameters, inputs and definitions: each is unused at
    /// its own name in the block.
    ///
    /// A leading underscore silences it, and so do `allow` and `expect` on the struct or on the
    /// field.
    pub(super) fn unmentioned(&self) -> Option<TokenStream> {
        // Statements that a mistake has left out may have mentioned them.
        let Model { unmentioned, unused, .. } = self.model;
        if self.motion.is_none() || unmentioned.is_empty() && unused.is_empty() {
            return None;
        }
        let level = |attribute: &&Attribute| {
            let levels = ["allow", "warn", "deny", "forbid"];
            expects_unused(attribute) || levels.iter().any(|level| attribute.path().is_ident(level))
        };
        let block = self.model.block;
        let levels = block.attributes.iter().filter(level);
        let arguments = unmentioned.iter().map(|&index| {
            let field = &block.fields[index];
            let (name, levels) = (&field.name, field.attributes.iter().filter(level));
            quote!(#(#levels)* #name: ())
        });
        Some(quote! {
            #(#levels)*
            #[allow(dead_code, non_snake_case, clippy::all, clippy::pedantic)]
            fn __unmentioned(#(#arguments,)* #(#unused: ()),*) {}
        })
    }

    /// Returns whether an attribute of the struct, or of the field with an index, goes to the
    /// function of the unmentioned parameters, and not to the struct or field itself.
    ///
    /// An expectation is fulfilled where the variable is unused, and not at the struct.
    pub(super) fn is_moved(&self, attribute: &Attribute, field: Option<usize>) -> bool {
        let unmentioned = &self.model.unmentioned;
        let some = !unmentioned.is_empty() || !self.model.unused.is_empty();
        let own = field.map_or(some, |index| unmentioned.contains(&index));
        expects_unused(attribute) && (own || self.motion.is_none())
    }
}

/// Returns true if an attribute is `#[expect(unused_variables)]` or `#[expect(unused)]`.
fn expects_unused(attribute: &Attribute) -> bool {
    let syn::Meta::List(list) = &attribute.meta else { return false };
    let unused =
        |token: TokenTree| token.to_string() == "unused" || token.to_string() == "unused_variables";
    list.path.is_ident("expect") && list.tokens.clone().into_iter().any(unused)
}
