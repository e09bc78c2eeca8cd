#![doc = include_str!("../README.md")]

#[macro_use]
mod macros;

pub mod analysis;
pub mod body;
pub mod ensemble;
pub mod error;
// Text alone, which programs need not carry.
#[cfg(any(doc, doctest))]
pub mod guide;
#[cfg(any(feature = "gltf", feature = "svg"))]
pub mod import;
pub mod integrate;
pub mod jet;

pub mod motion;
pub mod scalar;
pub mod scene;
mod sealed;
mod simd;
pub mod system;
pub mod time;

/// The crate of the matrices and vectors that this one gives.
pub use nalgebra;

#[doc(hidden)]
pub use system::generated as __private;

/// The names for a program that writes a `lagrangian!` block and integrates it.
///
/// The methods of [`System`](crate::system::System) come along, its name does not: engines have a
/// `System` and an [`Event`](crate::integrate::Event) of their own.
pub mod prelude {
    pub use crate::ensemble::Ensemble;
    pub use crate::integrate::{
        Auto, Batch, Direction, Dop853, Dprkn8, Dprkn12, Gauss, Integrator, Leapfrog, Picard,
        Problem, QuinlanTremaine, Rattle, Rk4, Rodas4, Solution, Srkn6b, Srkn14a, State,
        SymplecticEuler, Taylor, Tsit5, assemble, solve,
    };
    pub use crate::motion::Motion;
    pub use crate::scalar::Real;
    pub use crate::system::{Driven, Dynamics, Jacobians, System as _, VelocityFree};
    pub use crate::{lagrangian, motion};
}
