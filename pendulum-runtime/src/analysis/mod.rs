//! Analysis of systems: small motions about a state, and sensitivities of a motion.

mod linearization;
mod variational;

pub use linearization::{Linearization, ModeError, NormalModes, linearize};
pub use variational::{Variational, variational_size};
