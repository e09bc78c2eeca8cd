//! Expressions as a graph that stores equal expressions once, with exact numbers.

pub(crate) mod diff;
pub(crate) mod dimension;
pub(crate) mod expr;
pub(crate) mod functions;
pub(crate) mod number;
pub(crate) mod order;
pub(crate) mod prime_field;
pub(crate) mod spline;
pub(crate) mod value_numbering;
pub(crate) mod velocity_polynomial;
