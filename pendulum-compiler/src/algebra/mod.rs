//! Expressions as a graph in which equal ones are one, with exact numbers.

pub(crate) mod diff;
pub(crate) mod dimension;
pub(crate) mod expr;
pub(crate) mod functions;
pub(crate) mod number;
pub(crate) mod order;
pub(crate) mod prime_field;
pub(crate) mod value_numbering;
pub(crate) mod velocity_polynomial;
