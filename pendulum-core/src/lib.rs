//! The core of pendulum: equations of motion from energies, and their integration.
//!
//! [`lagrangian!`] derives the equations at compile time, [`solve`](integrate::solve) integrates
//! them, and [`analysis`] finds equilibria, modes and Lyapunov exponents. Most programs depend on
//! the crate `pendulum-runtime`, which contains all of this, with scenes, ensembles, shapes and
//! files, and with the guide. This crate alone is for programs that need nothing else.
//!
//! ```
//! use pendulum_core::prelude::*;
//!
//! lagrangian! {
//!     pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
//!     coordinate theta: rad;
//!     let bob = L * [sin(theta), -cos(theta)];
//!     kinetic = |dot(bob)|^2/2;
//!     potential = g*height(bob);
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A quarter of the period of a small swing.
//! let quarter = core::f64::consts::FRAC_PI_2 * (0.5_f64 / 9.81).sqrt();
//! let swing = solve(&Pendulum::new(0.5), (0.0, quarter), [1e-4], [0.0]).rtol(1e-9).run()?;
//! assert!(swing.end.q[0].abs() < 1e-11);
//! # Ok(())
//! # }
//! ```
//!
//! Modules use only those above them: [`scalar`], [`time`], [`attitude`], [`body`] (bodies as
//! parameters), [`motion`](mod@motion), [`system`], [`jet`], [`integrate`], [`analysis`].
#![cfg_attr(docsrs, feature(doc_cfg))]

#[macro_use]
mod macros;

pub mod analysis;
pub mod attitude;
pub mod body;
pub mod error;
pub mod integrate;
pub mod jet;
pub mod motion;
pub mod scalar;
pub mod simd;
pub mod system;
pub mod time;

/// The crate of the matrices and vectors in this crate's interface.
pub use nalgebra;

#[doc(hidden)]
pub use system::generated as __private;

/// The names for programs that write a `lagrangian!` block and integrate it.
///
/// The trait [`System`](crate::system::System) is imported without its name, and
/// [`Event`](crate::integrate::Event) is not imported, because game engines have types of these
/// names.
pub mod prelude {
    pub use crate::attitude::{Attitude, Rates};
    pub use crate::body::Solid;
    pub use crate::integrate::methods::names::*;
    pub use crate::integrate::{
        Batch, Direction, Integrator, Problem, Solution, State, assemble, solve,
    };
    pub use crate::motion::Motion;
    pub use crate::scalar::Real;
    pub use crate::system::{At, Driven, Dynamics, Jacobians, System as _, Table, VelocityFree};
    pub use crate::{lagrangian, motion};
}
