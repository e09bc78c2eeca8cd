#![doc = include_str!("../README.md")]

#[macro_use]
mod macros;

pub mod analysis;
pub mod body;
pub mod error;
#[cfg(any(feature = "gltf", feature = "svg"))]
pub mod import;
pub mod integrate;
pub mod jet;

pub mod motion;
pub mod real;
pub mod scene;
mod sealed;
mod simd;
pub mod system;
pub mod time;

#[doc(hidden)]
pub use system::generated as __private;

/// What a program that writes a `lagrangian!` block and integrates it needs.
pub mod prelude {
    pub use crate::integrate::{
        Auto, Direction, Dop853, Dprkn8, Dprkn12, Event, Gauss, Integrator, Leapfrog, Picard,
        QuinlanTremaine, Rk4, Rodas4, Srkn6b, Srkn11b, Srkn14a, SymplecticEuler, Taylor, Tsit5,
        solve,
    };
    pub use crate::motion::Motion;
    pub use crate::real::Real;
    pub use crate::system::{Driven, Dynamics, System, VelocityFree};
    pub use crate::{lagrangian, motion};
}

/// The blocks of the guides are tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/scenes.md")]
#[doc = include_str!("../../docs/control.md")]
struct Guides;
