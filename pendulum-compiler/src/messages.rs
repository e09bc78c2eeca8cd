//! Errors, gathered and reported together, at the user's own tokens, and the texts that several
//! passes have in common.

use proc_macro2::{Ident, Span, TokenStream};
use quote::ToTokens;
use std::collections::BTreeSet;
use std::fmt::Display;

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

    /// An error that underlines the whole range.
    pub(crate) fn error(self, message: impl Display) -> syn::Error {
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

/// All that is wrong with a block.
#[derive(Debug, Default)]
pub(crate) struct Errors {
    errors: Vec<syn::Error>,
    sources: BTreeSet<usize>,
}

impl Errors {
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.errors.push(error);
    }

    pub(crate) fn at(&mut self, range: impl Into<Range>, message: impl Display) {
        self.push(range.into().error(message));
    }

    /// Reports at most one error for each `source`: an expression that is wrong for one index is
    /// wrong once.
    pub(crate) fn once(&mut self, source: usize, range: Range, message: impl Display) {
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

    /// One `compile_error!` for each.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.errors.iter().map(syn::Error::to_compile_error).collect()
    }
}

impl IntoIterator for Errors {
    type Item = syn::Error;
    type IntoIter = std::vec::IntoIter<syn::Error>;

    fn into_iter(self) -> Self::IntoIter {
        self.errors.into_iter()
    }
}

/// Advice about a unit in a formula.
pub(crate) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";

/// Advice instead of a comparison.
pub(crate) const TELL_CASES_APART: &str = "write `max`, `min`, `abs` or `sign` to tell cases apart";

/// A second derivative of what has only one; `what` as written.
pub(crate) fn acceleration(what: impl Display) -> String {
    format!(
        "{what} is an acceleration, and a Lagrangian has none; only driven inputs have a second \
         derivative"
    )
}

/// An acceleration in a constraint or a limit; `what` as written.
pub(crate) fn constrained_acceleration(what: impl Display) -> String {
    format!("{what} is an acceleration; a constraint holds positions or velocities")
}

/// A third derivative of what has two; `what` as written.
pub(crate) fn jerk(what: impl Display) -> String {
    format!("{what} is a third derivative; coordinates have two, in outputs")
}

/// The derivative of a control input.
pub(crate) fn no_derivative(input: impl Display) -> String {
    format!("`{input}` has no derivative; declare it `driven`")
}

/// A control input of which the equations would need the derivative.
pub(crate) fn control_in_momenta(input: impl Display) -> String {
    format!(
        "the momenta contain the control input `{input}`, so the equations would contain its \
         derivative; declare it `driven`, or write what it does as a `force`"
    )
}

/// A control input where the potential energy at zero may be no number.
pub(crate) fn control_in_divisor(input: impl Display) -> String {
    format!(
        "the control input `{input}` stands in a divisor, a power or a function of an energy, \
         which may be no number where the input is zero; write what it does as a `force`"
    )
}

/// A unit as it is written between the brackets of a vector.
pub(crate) fn unit_of(unit: &str) -> &str {
    if unit.is_empty() { "_" } else { unit }
}

/// A definition that needs its own value.
pub(crate) fn circular(name: impl Display) -> String {
    format!("`{name}` is defined by itself; break the circle")
}

/// A number that has to be known while compiling and is not.
pub(crate) fn unknown_number(what: &str) -> String {
    format!("{what} is a whole number known while compiling; write numbers and indices only")
}

/// A call with a wrong number of arguments.
pub(crate) fn arguments(function: impl Display, expected: usize, found: usize) -> String {
    let expected =
        if expected == 1 { "one argument".into() } else { format!("{expected} arguments") };
    format!("`{function}` takes {expected}; {found} stand here")
}

/// A call of a function of two vectors with other things.
pub(crate) fn two_vectors(function: &str, left: &str, right: &str) -> String {
    format!("`{function}` takes two vectors of one length; these are {left} and {right}")
}

/// Something else where a scalar is needed.
pub(crate) fn no_scalar(found: &str, kind: &str, instead: &str) -> String {
    format!("`{found}` is {kind}, but a scalar is needed here; write {instead}")
}

/// Rust in a formula.
pub(crate) fn rust(found: impl Display, instead: &str) -> String {
    format!("`{found}` is Rust, which has no place in a formula; {instead}")
}

/// Two operands side by side.
pub(crate) fn no_operator(instead: &str) -> String {
    format!("there is no implicit multiplication; write {instead}")
}

/// A token that cannot stand in its place.
pub(crate) fn unexpected(found: &str, expected: impl Display) -> String {
    format!("{found} is not expected here; expected {expected}")
}
