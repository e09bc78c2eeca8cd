//! Analysis of systems: equilibria, small motions about a state, linear models from inputs to
//! outputs, sensitivities of a motion, Lyapunov exponents, Poincaré sections.

mod collocation;
mod equilibrium;
mod jump;
mod linearization;
mod lyapunov;
mod modes;
mod poincare;
mod radau;
mod reduction;
mod sensitivity;
mod state_space;
mod variational;

pub use equilibrium::{EquilibriumError, EquilibriumFailure, equilibrium};
pub use linearization::{Linearization, ModeError, NormalModes, linearize};
pub use lyapunov::{Lyapunov, LyapunovError, LyapunovSpectrum, lyapunov};
pub use modes::DampedMode;
pub use poincare::{Crossings, Section, poincare};
pub use state_space::{StateSpace, state_space};
pub use variational::{Variational, variational_size};
