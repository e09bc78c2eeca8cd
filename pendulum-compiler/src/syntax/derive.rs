//! The traits that a block derives for its struct. Traits that cannot be derived are reported at
//! their names.

use crate::messages::{Errors, Range, Text, message};
use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::{Attribute, Path, Token};

/// Reports the derived traits that the struct cannot have, and removes them from its attributes.
/// Otherwise rustc would report an error in generated code.
pub(crate) fn check(attributes: &mut [Attribute], errors: &mut Errors) {
    for attribute in attributes {
        let all = paths(attribute);
        let mut kept: Punctuated<Path, Token![,]> = Punctuated::new();
        for path in &all {
            match underivable(path) {
                Some(message) => {
                    let last = path.segments.last().map_or(path.span(), Spanned::span);
                    errors.at(Range { first: path.span(), last }, message);
                }
                None => kept.push(path.clone()),
            }
        }
        if kept.len() < all.len()
            && let syn::Meta::List(list) = &mut attribute.meta
        {
            list.tokens = quote!(#kept);
        }
    }
}

/// The message about a trait that floating-point numbers do not implement; `None` for all other
/// traits.
fn underivable(path: &Path) -> Option<Text> {
    let name = standard(path)?;
    let instead = match name.as_str() {
        "Eq" => "leave it out, `PartialEq` compares them",
        "Hash" => "leave it out and hash the bits of the fields",
        "Ord" => "leave it out, `PartialOrd` compares them",
        _ => return None,
    };
    Some(message!(
        "`{name}` cannot be derived: the parameters are floating-point numbers, which do not have \
         it; {instead}"
    ))
}

/// Returns the traits of a `derive` attribute; empty for any other attribute.
fn paths(attribute: &Attribute) -> Punctuated<Path, Token![,]> {
    let tokens = match &attribute.meta {
        syn::Meta::List(list) if list.path.is_ident("derive") => list.tokens.clone(),
        _ => TokenStream::new(),
    };
    Punctuated::parse_terminated.parse2(tokens).unwrap_or_default()
}

/// Returns the name of a trait of the standard library: a single name, or a path that begins with
/// `core` or `std`.
fn standard(path: &Path) -> Option<String> {
    let first = path.segments.first()?;
    let known = path.segments.len() == 1 || first.ident == "core" || first.ident == "std";
    known.then(|| path.segments.last().map(|last| last.ident.to_string()))?
}
