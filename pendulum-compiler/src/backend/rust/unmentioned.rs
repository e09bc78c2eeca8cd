//! Names that no statement mentions, reported by the unused-variable lint of rustc.

use crate::backend::Analysis;
use crate::model::Model;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use syn::Attribute;

impl Analysis<'_, '_> {
    /// Returns a function that does not use these parameters, inputs and definitions. rustc warns
    /// of each at its name in the block.
    ///
    /// A leading underscore silences the warning, and so do `allow` and `expect` on the struct or
    /// on the field.
    pub(super) fn unmentioned(&self) -> Option<TokenStream> {
        // Statements lost because of a mistake may have mentioned the names.
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

    /// Returns `true` if an attribute of the struct, or of the field with an index, applies to the
    /// function of the unmentioned parameters instead of to the struct or field.
    ///
    /// An expectation is fulfilled at an unused variable but not at the struct.
    pub(super) fn is_moved(&self, attribute: &Attribute, field: Option<usize>) -> bool {
        let unmentioned = &self.model.unmentioned;
        let some = !unmentioned.is_empty() || !self.model.unused.is_empty();
        let own = field.map_or(some, |index| unmentioned.contains(&index));
        expects_unused(attribute) && (own || self.motion.is_none())
    }
}

/// Returns `true` if an attribute is `#[expect(unused_variables)]` or `#[expect(unused)]`.
fn expects_unused(attribute: &Attribute) -> bool {
    let syn::Meta::List(list) = &attribute.meta else { return false };
    let unused =
        |token: TokenTree| token.to_string() == "unused" || token.to_string() == "unused_variables";
    list.path.is_ident("expect") && list.tokens.clone().into_iter().any(unused)
}
