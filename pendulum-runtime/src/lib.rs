//! Equations of motion from energies, integrated fast and to any accuracy.
//!
//! [`lagrangian!`] takes the kinetic and the potential energy of a mechanical system, derives its
//! equations of motion at compile time, and emits them as Rust code. [`solve`] integrates them.
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
//!     println!("{}\n", SpringPendulum::FACTS.equations);
//!     println!("{}", motion.table().with("energy", "J", motion.energy(&pendulum))?);
//!     Ok(())
//! }
//! ```
//!
//! # Where to go
//!
//! | task | code | page |
//! |---|---|---|
//! | describe a system | a block of [`lagrangian!`] | [the language](guide::language) |
//! | start with an example | an existing block | [the gallery](guide::gallery) |
//! | compute a motion with an error bound | [`solve`]`(&system, (0.0, 10.0), q, v).rtol(1e-9).run()?` | [choosing a method](guide::choosing_a_method) |
//! | read columns and tables, take steps by hand | `.every(0.1)`, `.dense()`, `.start()?` | [results](guide::results) |
//! | prescribe the motion of a pivot | `driven x: [m; 2];` and `.driven_by(motion)` | [motions](guide::motions) |
//! | import motions from BVH and glTF, joints and bodies from SVG | features `bvh`, `gltf` and `svg` | `import` |
//! | add a controller | `input f: N;` and `.controlled_by(\|t, q, v\| …)` | [control](guide::control) |
//! | add impacts, or end a run at an event | `.events([…])` | [control](guide::control#impacts) |
//! | turn bodies in space | `coordinate R: rotation;` `B: solid` | [space](guide::space) |
//! | add closed loops, rolling, end stops | `constraint loop: …;` `limit rail: …;` | [constraints](guide::constraints) |
//! | simulate many pendulums in every frame of an animation | [`Scene`](scene::Scene) | [scenes](guide::scenes) |
//! | compute thousands of motions on all cores | [`Ensemble`](ensemble::Ensemble) | [ensembles](guide::ensembles) |
//! | fit parameters to measurements | `.dense()`, `run.sensitivities(&system, ["b"])?` | [fit](guide::fit) |
//! | find equilibria, modes, state spaces, Lyapunov exponents, sections | functions of [`analysis`] | [analysis](guide::analysis) |
//! | compute 31 digits | [`DoubleDouble`](scalar::DoubleDouble) as scalar | [`scalar`] |
//! | compare errors and times with other projects | | [accuracy](guide::accuracy) |
//!
//! # What a block gives
//!
//! A block defines a struct with public fields, generic over its scalar type. The struct has
//! accelerations, energy, power, momenta and their inverse, mass matrix, forces, Jacobians, Taylor
//! coefficients, a method for each `output`, and facts as constants (names, equations, conserved
//! quantities, the derivatives of inputs that are needed). Each function is generated separately
//! from one graph of expressions, so unused functions cost nothing. A system written naively in
//! Cartesian coordinates costs as much as one simplified by hand: the accelerations of two links of
//! a chain take 17 multiplications, 7 additions and 2 divisions. For nine and more links the
//! elimination runs from the leaves to the root, and each further link costs 32 multiplications.
//!
//! # Guarantees
//!
//! - The results have the same bits on every machine, in debug and release builds: the crate has
//!   its own elementary functions.
//! - Steps do not allocate memory, and there is no `unsafe` code.
//! - A method that is wrong for a system does not compile for this system.
//! - Invalid input results in an error that names the time and the coordinate, not in a panic.
//!
//! # Features
//!
//! | feature | default | adds | depends on |
//! |---|---|---|---|
//! | `scene` | yes | `scene`: many pendulums in every frame of an animation | `pendulum-scene` |
//! | `ensemble` | yes | `ensemble`: thousands of motions on all cores | `pendulum-ensemble` |
//! | `simd` | yes | the widest vectors of the machine, detected at run time, in scenes, batches and `Picard` | `pulp` |
//! | `rayon` | no | threads in scenes and ensembles | `rayon` |
//! | `csv` | no | tables of solutions as comma-separated values | `csv` |
//! | `serde` | no | reading and writing of solutions, states, bodies, baked motions and snapshots | `serde` |
//! | `bvh` | no | `import::bvh`: motions from motion capture | `pendulum-import` |
//! | `gltf` | no | `import::gltf`: motions from the animations of glTF 2.0 files, and back into them | `pendulum-import`, `serde_json`, `base64` |
//! | `svg` | no | `import::svg`: joints and bodies from drawings | `pendulum-import`, `usvg`, `svgtypes` |
//!
//! All other modules are those of `pendulum-core` and `pendulum-body`. Each of these crates can also
//! be used alone.
//!
//! [`solve`]: integrate::solve
#![cfg_attr(docsrs, feature(doc_cfg))]

// Text only, which programs do not need.
#[cfg(any(doc, doctest))]
pub mod guide;

#[doc(inline)]
pub use pendulum_body as body;
#[doc(inline)]
pub use pendulum_core::{
    analysis, attitude, error, integrate, jet, lagrangian, motion, nalgebra, scalar, simd, system,
    time,
};
#[cfg(feature = "ensemble")]
#[doc(inline)]
pub use pendulum_ensemble as ensemble;
#[cfg(any(feature = "bvh", feature = "gltf", feature = "svg"))]
#[doc(inline)]
pub use pendulum_import as import;
#[cfg(feature = "scene")]
#[doc(inline)]
pub use pendulum_scene as scene;

/// Tests the programs of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The names for programs that write a `lagrangian!` block and integrate it.
///
/// The trait [`System`](crate::system::System) is imported without its name, and
/// [`Event`](crate::integrate::Event) is not imported, because game engines have types of these
/// names.
pub mod prelude {
    pub use pendulum_core::prelude::*;
    #[cfg(feature = "ensemble")]
    pub use pendulum_ensemble::Ensemble;
}
