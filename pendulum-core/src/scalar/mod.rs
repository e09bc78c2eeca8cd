//! Scalars of generated code.

mod double_double;
mod dual;
pub(crate) mod exact;
mod float;
mod lanes;
pub(crate) mod real;
mod sinc;
mod trig;

pub use double_double::{DoubleDouble, ParseError};
pub use dual::Dual;
pub use lanes::{Lanes, Octet};
pub use real::{Float, Real};
