//! Equations of motion from energies, integrated fast and to any accuracy.
//!
//! [`lagrangian!`] takes the kinetic and the potential energy of a mechanical system, derives its
//! equations of motion while your crate compiles, and emits them as Rust. [`solve`] integrates
//! them.
//!
//! ```
//! use pendulum_runtime::prelude::*;
//!
//! lagrangian! {
//!     /// A bob on a spring; the air slows its swing.
//!     pub struct SpringPendulum { m: kg, k: N/m, L: m, b: kg/s, g: m/s^2 = 9.81 }
//!     coordinate r: m;
//!     coordinate theta: rad;
//!     let bob = r * [sin(theta), -cos(theta)];
//!     kinetic = m/2 * |dot(bob)|^2;
//!     potential = m*g*height(bob) + k/2 * (r - L)^2;
//!     dissipation = b/2 * (r*theta_dot)^2;
//! }
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let pendulum = SpringPendulum::new(1.0, 40.0, 0.5, 0.1);
//!     let motion = solve(&pendulum, (0.0, 2.0), [0.5, 1.0], [0.0; 2]).rtol(1e-9).every(0.4).run()?;
//!     let theta = motion.column("theta")?;
//!     assert!((theta[5] - 0.415406).abs() < 1e-6);
//!     // The equations of motion, the states and the energy.
//!     println!("{}\n", SpringPendulum::<f64>::FACTS.equations);
//!     println!("{}", motion.table().with("energy", "J", motion.energy(&pendulum))?);
//!     Ok(())
//! }
//! ```
//!
//! # Where to go
//!
//! | you want | write | page |
//! |---|---|---|
//! | to describe a system | a block of [`lagrangian!`] | [the language](guide::language) |
//! | systems to begin with | a block that is there | [the gallery](guide::gallery) |
//! | a motion with an error bound | [`solve`]`(&system, (0.0, 10.0), q, v).rtol(1e-9).run()?` | [choosing a method](guide::choosing_a_method) |
//! | a pivot that follows a known motion | `driven x: [m; 2];` and `.driven_by(motion)` | [`motion`](mod@motion) |
//! | motions from BVH and glTF, joints and bodies from SVG | features `bvh`, `gltf` and `svg` | `import` |
//! | a controller | `input f: N;` and `.controlled_by(\|t, q, v\| …)` | [control](guide::control) |
//! | impacts, and runs that end when something happens | `.events([…])` | [control](guide::control#impacts) |
//! | closed loops, rolling, end stops | `constraint loop: …;` `limit rail: …;` | [constraints](guide::constraints) |
//! | many pendulums in every frame of an animation | [`Scene`](scene::Scene) | [scenes](guide::scenes) |
//! | thousands of motions on all cores | [`Ensemble`](ensemble::Ensemble) | [ensembles](guide::ensembles) |
//! | equilibria, modes, state spaces, Lyapunov exponents, sections | functions of [`analysis`] | [`analysis`] |
//! | 31 digits | [`DoubleDouble`](scalar::DoubleDouble) as scalar | [`scalar`] |
//! | the size of errors, and times beside other projects | | [accuracy](guide::accuracy) |
//!
//! # What a block gives
//!
//! A struct with public fields, generic over its scalar type, and for it: accelerations, energy,
//! power, momenta and their inverse, mass matrix, forces, Jacobians, Taylor coefficients, a method
//! for each `output`, and facts as constants (names, equations, conserved quantities, the
//! derivatives of inputs that are needed). Each is generated on its own from one graph of
//! expressions, so what a program does not call costs nothing. Written naively in Cartesian
//! coordinates, a system costs as much as one that is simplified by hand: the accelerations of two
//! links of a chain take 17 multiplications, 7 additions and 2 divisions. From nine links on the
//! elimination goes from the leaves to the root, and each further link costs 32 multiplications.
//!
//! # Guarantees
//!
//! - The same bits come out on every machine, in debug and release: the elementary functions are
//!   the crate's own.
//! - A step allocates nothing, and there is no `unsafe`.
//! - A method that is wrong for a system does not compile for it.
//! - Bad input is an error that names time and coordinate, not a panic.
//!
//! # Features
//!
//! | feature | default | adds | depends on |
//! |---|---|---|---|
//! | `simd` | yes | the widest vectors that the machine has, found out while running, in scenes, batches and `Picard` | `pulp` |
//! | `rayon` | no | threads in scenes and ensembles | `rayon` |
//! | `csv` | no | tables of solutions as comma-separated values | `csv` |
//! | `serde` | no | reading and writing of solutions, states, bodies, baked motions and snapshots | `serde` |
//! | `bvh` | no | `import::bvh`: motions from motion capture | |
//! | `gltf` | no | `import::gltf`: motions from the animations of glTF 2.0 files | `gltf`, `base64` |
//! | `svg` | no | `import::svg`: joints and bodies from drawings | `usvg`, `svgtypes` |
//!
//! [`solve`]: integrate::solve
#![cfg_attr(docsrs, feature(doc_cfg))]

#[macro_use]
mod macros;

pub mod analysis;
pub mod body;
pub mod ensemble;
pub mod error;
// Text alone, which programs need not carry.
#[cfg(any(doc, doctest))]
pub mod guide;
#[cfg(any(feature = "bvh", feature = "gltf", feature = "svg"))]
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

/// The programs of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The names for a program that writes a `lagrangian!` block and integrates it.
///
/// The methods of [`System`](crate::system::System) come along, its name does not: engines have a
/// `System` and an [`Event`](crate::integrate::Event) of their own.
pub mod prelude {
    pub use crate::ensemble::Ensemble;
    pub use crate::integrate::methods::names::*;
    pub use crate::integrate::{
        Batch, Direction, Integrator, Problem, Solution, State, assemble, solve,
    };
    pub use crate::motion::Motion;
    pub use crate::scalar::Real;
    pub use crate::system::{Driven, Dynamics, Jacobians, System as _, VelocityFree};
    pub use crate::{lagrangian, motion};
}
