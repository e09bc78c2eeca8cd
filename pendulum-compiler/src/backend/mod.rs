//! What is written of a block: Rust, its equations in Unicode and LaTeX, and a copy for editors.

mod cancel;
pub(crate) mod ide;
pub(crate) mod latex;
pub(crate) mod rust;
pub(crate) mod unicode;
