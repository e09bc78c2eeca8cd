//! Prescribed motions, which drive the joints of a scene.
//!
//! A motion computes exactly the derivatives that the equations need, and returns the times of its
//! kinks, at which its position, velocity or acceleration jumps. At a kink it has two values, one
//! from each side.
//!
//! | keys or formula | motion | continuous | a key affects |
//! |---|---|---|---|
//! | keys of an animator | [`CatmullRom`] | velocity | four pieces of the curve |
//! | few keys, smooth | [`Spline`] | acceleration | the whole curve, less with distance |
//! | a cycle, such as a walk | [`Spline::periodic`] | acceleration, also at the seam | the whole curve |
//! | keys with sharp corners, such as blows | [`Linear`] | position | two pieces |
//! | frames of a captured motion | [`Clip`] | depends on its [`Interpolation`] | its neighbourhood |
//! | a harmonic shake | [`Sinusoid`] | all derivatives | – |
//! | a formula in Rust | [`Function`] | depends on the formula | – |
//! | a fixed point | [`Still`] | all derivatives | – |
//!
//! All curves go through their keys. [`Sinusoid`], [`Still`] and curves through keys are
//! [`Analytic`]: steps end at their kinks, and they support Taylor series and lanes.

mod analytic;
mod attenuated;
mod catmull_rom;
mod clip;
mod error;
mod function;
pub(crate) mod input;
mod linear;
mod motions;
pub(crate) mod piecewise;
mod prescribed;
mod projected;
mod sample;
pub(crate) mod series;
mod sinusoid;
mod spline;
mod still;
#[cfg(test)]
mod tests;

pub use analytic::Analytic;
pub use attenuated::Attenuated;
pub use catmull_rom::CatmullRom;
pub use clip::{Clip, Interpolation};
pub use error::MotionError;
pub use function::{Function, MaybeFunction, Missing};
pub use linear::Linear;
pub use motions::{AnalyticMotions, MaybeAnalytic, Motions};
pub(crate) use motions::{derivatives_of, shorter, sufficient};
pub use prescribed::Motion;
pub(crate) use prescribed::earlier;
pub use projected::Projected;
pub use sample::{Derivatives, Sample, Side};
pub use sinusoid::Sinusoid;
pub use spline::Spline;
pub use still::Still;
