//! Blocks that compile though their names, attributes or spellings are awkward.

mod attributes;
mod constants;
mod fragments;
mod no_parameters;
mod spellings;
mod types;
