//! Parameters that no statement mentions, as rustc itself warns of a variable that nobody reads.

use super::Emitter;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use syn::Attribute;

impl Emitter<'_, '_> {
    /// A function that reads none of these parameters: each is unused at its own name in the block.
    ///
    /// A leading underscore silences it, and so do `allow` and `expect` on the field or on the
    /// struct.
    pub(super) fn unmentioned(&self) -> Option<TokenStream> {
        // What a mistake has left out may have mentioned them.
        if self.motion.is_none() || self.model.unmentioned.is_empty() {
            return None;
        }
        let level = |attribute: &&Attribute| {
            let levels = ["allow", "warn", "deny", "forbid"];
            expects_unused(attribute) || levels.iter().any(|level| attribute.path().is_ident(level))
        };
        let block = self.model.block;
        let levels = block.attributes.iter().filter(level);
        let arguments = self.model.unmentioned.iter().map(|&index| {
            let field = &block.fields[index];
            let (name, levels) = (&field.name, field.attributes.iter().filter(level));
            quote!(#(#levels)* #name: ())
        });
        Some(quote! {
            #(#levels)*
            #[allow(dead_code, non_snake_case, clippy::all, clippy::pedantic)]
            fn __unmentioned(#(#arguments),*) {}
        })
    }

    /// Returns whether an attribute of the struct, or of the field with an index, goes to the
    /// function of the unmentioned parameters, and not to the struct or field itself.
    ///
    /// An expectation is fulfilled where the variable is unused, and not at the struct.
    pub(super) fn is_moved(&self, attribute: &Attribute, field: Option<usize>) -> bool {
        let unmentioned = &self.model.unmentioned;
        let own = field.map_or(!unmentioned.is_empty(), |index| unmentioned.contains(&index));
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
