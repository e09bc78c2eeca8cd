//! Systems as `lagrangian!` generates them, and together with the motions that drive them.

mod dynamics;
mod equations;
mod facts;
#[doc(hidden)]
pub mod generated;
mod inputs;

pub use dynamics::{Driven, Dynamics, scalar_time};
pub use equations::{Jacobians, SplitEnergy, Staged, System, VelocityFree};
pub use facts::Facts;
pub use inputs::{Input, NoInputs, Purpose, Samples};
