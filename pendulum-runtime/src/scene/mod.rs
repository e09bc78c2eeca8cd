//! Scenes: many systems on many joints, and nothing computed that the scene does not need.
//!
//! A [`Scene`] holds joints, each with a [`Motion`](crate::motion::Motion), and pendulums that hang
//! on them, of any type that `lagrangian!` generates. [`Scene::advance`] takes frame times and does
//! whole ticks of a fixed length, so that the motion does not depend on how time is cut into
//! frames; [`Scene::pose`] interpolates between the last two ticks.
//!
//! ```
//! # #![allow(mixed_script_confusables)]
//! use pendulum_runtime::motion::Sinusoid;
//! use pendulum_runtime::prelude::*;
//! use pendulum_runtime::scene::Scene;
//!
//! lagrangian! {
//!     pub struct Feather { m: kg, L: m, g: m/s^2 = 9.81 }
//!     coordinate θ: rad;
//!     driven x: [m; 2];
//!     let y = x + L * [sin(θ), -cos(θ)];
//!     kinetic = m/2 * |ẏ|^2;
//!     potential = m*g*height(y);
//! }
//!
//! let mut scene = Scene::<f32>::new(240.0)?;
//! let wing = scene.joint(Sinusoid::new([0.0, 0.05], 12.0, [0.0, 0.0]));
//! let feathers = (0..20).map(|k| scene.hang(wing, Feather::new(0.01, 0.05 + 0.002 * k as f32), [0.0], [0.0]));
//! let feathers: Vec<_> = feathers.collect::<Result<_, _>>()?;
//! for _frame in 0..60 {
//!     scene.advance(1.0 / 60.0)?;
//!     let angle = scene.pose(feathers[3], scene.alpha())[0];
//! #   assert!(angle.abs() < 1.0);
//! }
//! # Ok::<(), pendulum_runtime::scene::SceneError>(())
//! ```
//!
//! # Computation
//!
//! Pendulums of one type that take the same steps stand in blocks of 32 lanes, structures of
//! arrays, and go through eight ticks at a time; the code is compiled for several instruction sets
//! and the widest is chosen while running (feature `simd`). Every lane has the bits that the
//! pendulum would have alone, so neither its neighbours, nor the number of threads (feature
//! `rayon`), nor the machine can be seen in the result.
//!
//! Velocity-free systems take leapfrog or SRKN6b, all others RK4, in as many equal steps a tick as
//! the [tolerance](Scene::set_tolerance) asks for: the method that needs fewer evaluations. Steps
//! are cut at the kinks of the motions, and there the momenta carry the state over.
//!
//! Constraints hold at the ends of all steps to rounding; [poses](Scene::pose) between ticks keep
//! them to the error of the cubic. A pendulum whose parameters or joints change goes to the nearest
//! state that fulfils them, one that a tick has thrown off them is frozen as a fault. Constrained
//! pendulums do not fall asleep.

// Each row of files uses only the rows below it:
//
// features/            abilities beside ticks: commands, visibility, sleep, snapshot, bake, cycle
// advance.rs, state.rs frames and ticks; states of pendulums, read and written
// scene.rs             joints, hanging, settings
// group/               pendulums of one type: the ones awake, the criterion for sleep, saved states
// lanes/               32 pendulums side by side: blocks, their kernel, buckets of equal steps
// sampling/            joints, the clock, the times at which a joint is sampled, tracks
// threads/             the decision to fork a batch

mod advance;
mod error;
mod features;
mod group;
mod handle;
mod lanes;
mod sampling;
#[allow(clippy::module_inception)]
mod scene;
mod state;
mod threads;

pub use advance::Advanced;
pub use error::{SceneError, SceneFault};
pub use features::bake::Baked;
pub use features::commands::Stop;
pub use features::cycle::Closed;
pub use features::snapshot::Snapshot;
pub use features::visibility::Resume;
pub use group::change::Preserve;
pub use group::saved::GroupState;
pub use group::status::SceneStatus;
pub use handle::Handle;
pub use lanes::system::SceneSystem;
pub use sampling::from_numbers::{Anchor, FromNumbers, Numbers};
pub use sampling::joint::Joint;
pub use sampling::scheme::{Fixed, Scheme};
pub use scene::Scene;
pub use state::Observation;
