//! What generated code names; no one else may rely on it.

pub use nalgebra::SMatrix;
pub use pendulum_macros::lagrangian;
