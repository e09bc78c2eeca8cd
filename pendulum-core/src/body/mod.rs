//! Rigid bodies as parameters of systems: mass, centre of mass and second moments, of [`Body`] in a
//! plane and of [`Solid`] in space.
//!
//! Polygons, outlines and bodies of varying density are in the crate `pendulum-body`.
//!
//! All lengths are in metres from the pivot, with the joint at angle zero. All masses are in
//! kilograms: shapes take a mass or a density, and no dimensionless factors.

mod error;
mod matrix;
mod moments;
mod shapes;
mod simple;
mod solid;

pub use error::BodyError;
pub use matrix::symmetric;
pub use moments::Body;
pub use solid::Solid;
