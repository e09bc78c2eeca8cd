//! Parameters that no statement mentions, as rustc itself warns of a variable that nobody reads.

use super::Emitter;
use proc_macro2::TokenStream;
use quote::quote;
use syn::Attribute;

impl Emitter<'_, '_> {
    /// A function that reads none of these parameters: each is unused at its own name in the block.
    ///
    /// A leading underscore and an `allow` on the field or on the struct silence it as they do everywhere.
    pub(super) fn unmentioned(&self) -> Option<TokenStream> {
        // What a mistake has left out may have mentioned them.
        if self.motion.is_none() || self.model.unmentioned.is_empty() {
            return None;
        }
        let level =
            |attribute: &&Attribute| ["allow", "warn", "deny", "forbid"].iter().any(|level| attribute.path().is_ident(level));
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
}
