//! Errors, collected and reported together at the tokens of the user.

use super::Text;
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::BTreeSet;

/// The first and the last token of a piece of source.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub(crate) first: Span,
    pub(crate) last: Span,
}

impl Range {
    pub(crate) fn to(self, end: Range) -> Range {
        Range { first: self.first, last: end.last }
    }

    /// Creates an error that underlines the whole range.
    pub(crate) fn error(self, message: Text) -> syn::Error {
        let mut tokens = Ident::new("first", self.first).into_token_stream();
        tokens.extend(Ident::new("last", self.last).into_token_stream());
        syn::Error::new_spanned(tokens, message)
    }
}

impl From<Span> for Range {
    fn from(span: Span) -> Range {
        Range { first: span, last: span }
    }
}

/// All errors of a block.
#[derive(Debug, Default)]
pub(crate) struct Errors {
    errors: Vec<syn::Error>,
    sources: BTreeSet<usize>,
}

impl Errors {
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.errors.push(error);
    }

    pub(crate) fn at(&mut self, range: impl Into<Range>, message: Text) {
        self.push(range.into().error(message));
    }

    /// Reports at most one error for each `source`, so that an expression that is wrong for several
    /// indices is reported once.
    pub(crate) fn once(&mut self, source: usize, range: Range, message: Text) {
        if self.sources.insert(source) {
            self.at(range, message);
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.errors.len()
    }

    #[cfg(test)]
    pub(crate) fn messages(&self) -> Vec<String> {
        self.errors.iter().map(ToString::to_string).collect()
    }

    /// Returns a `compile_error!` for each error, without its path: at the user's tokens, `::core` is
    /// a module of the user's crate in edition 2015. The macro's own tokens would add a note about
    /// the macro to each message.
    pub(crate) fn into_tokens(self) -> TokenStream {
        let is_path = |token: &TokenTree| match token {
            TokenTree::Punct(sign) => sign.as_char() == ':',
            token => token.to_string() == "core",
        };
        let call = |error: syn::Error| error.to_compile_error().into_iter().skip_while(is_path);
        self.errors.into_iter().flatten().flat_map(call).collect()
    }
}

impl IntoIterator for Errors {
    type Item = syn::Error;
    type IntoIter = std::vec::IntoIter<syn::Error>;

    fn into_iter(self) -> Self::IntoIter {
        self.errors.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use crate::compile;

    /// In edition 2015, `::core` at a token of the user is not the standard library.
    #[test]
    fn refusals_name_no_crate_at_the_tokens_of_the_user() {
        let block = "::p; struct S { m: kg } coordinate x; kinetic = m*ẋ^2; potential = y + z;";
        let tokens = compile::expand(block.parse().unwrap()).to_string();
        let calls = tokens.match_indices("compile_error").map(|(place, _)| &tokens[..place]);
        let before = calls.map(|before| before.trim_end().chars().last()).collect::<Vec<_>>();
        assert_eq!(before.len(), 2, "{tokens}");
        assert!(!before.contains(&Some(':')), "{tokens}");
    }
}
