//! The derivation of the equations of motion from the energies.

pub(crate) mod arguments;
pub(crate) mod articulated;
pub(crate) mod attitude;
mod bounds;
pub(crate) mod clock;
pub(crate) mod constraint;
mod derivation;
pub(crate) mod euler_lagrange;
pub(crate) mod jacobian;
pub(crate) mod lower;
pub(crate) mod motion;
pub(crate) mod quaternion;
pub(crate) mod sign;
pub(crate) mod solve;
mod state;
pub(crate) mod symmetry;
