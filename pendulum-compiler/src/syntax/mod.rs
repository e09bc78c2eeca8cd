//! Tokens to a tree: names and places, no meaning.

pub(crate) mod ast;
pub(crate) mod derive;
pub(crate) mod name;
pub(crate) mod parse;
