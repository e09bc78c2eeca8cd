//! Systems as `lagrangian!` generates them, and together with the motions that drive them and with
//! their controllers.

mod constraints;
mod control;
mod dynamics;
mod equations;
mod facts;
mod feedback;
#[doc(hidden)]
pub mod generated;
mod inputs;
pub(crate) mod label;
mod lane_system;
pub(crate) mod name;

pub use crate::motion::input::{Input, Purpose};
pub use constraints::{Constraint, Limit, MOST_LIMITS};
pub use control::{ControlSlot, ControlValues, Controlled, Sampled, Uncontrolled};
pub(crate) use dynamics::is_constrained;
pub use dynamics::{Driven, Dynamics, MOST_CONTROLS, scalar_time};
pub use equations::{Holonomic, Jacobians, SplitEnergy, Staged, System, VelocityFree};
pub use facts::Facts;
pub(crate) use feedback::feedback_jacobians;
pub use inputs::{ControlSamples, NoInputs, Output, Samples};
pub use lane_system::{Arrangement, InLanes, InOctets, LaneSystem};
