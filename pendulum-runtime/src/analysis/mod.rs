//! Analysis of systems: small motions about a state, and sensitivities of a motion.

mod linearization;
mod state_space;
mod variational;

pub use linearization::{Linearization, ModeError, NormalModes, linearize};
pub use state_space::{StateSpace, state_space};
pub use variational::{Variational, variational_size};
