//! Tokens to a tree: names and places, no meaning.

pub(crate) mod ast;
pub(crate) mod derive;
pub(crate) mod elsewhere;
pub(crate) mod name;
pub(crate) mod parse;
pub(crate) mod text;
