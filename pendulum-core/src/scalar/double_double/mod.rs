//! Two-word numbers, with twice the digits of `f64`.

mod angle;
mod decimal;
mod exponential;
mod number;
mod real;

pub use decimal::ParseError;
pub use number::DoubleDouble;
