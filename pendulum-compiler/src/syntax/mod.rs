//! Tokens to a syntax tree: names and spans, before name resolution.

pub(crate) mod ast;
pub(crate) mod derive;
pub(crate) mod elsewhere;
pub(crate) mod name;
pub(crate) mod parse;
pub(crate) mod text;
