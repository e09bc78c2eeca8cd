//! Prescribed motions: what drives the joints of a scene.
//!
//! A motion is asked for exactly the derivatives that the equations contain, and says where its
//! kinks are: the times at which its position, velocity or acceleration jumps. There it has two
//! values, one from each side.
//!
//! | keys or formula | motion | continuous | a key moves |
//! |---|---|---|---|
//! | keys of an animator | [`CatmullRom`] | velocity | four pieces of the curve |
//! | few keys, gently | [`Spline`] | acceleration | the whole curve, less with distance |
//! | a cycle, such as a walk | [`Spline::periodic`] | acceleration, over the seam too | the whole curve |
//! | keys whose corners are meant, such as blows | [`Linear`] | position | two pieces |
//! | frames of a captured motion | [`Clip`] | by its [`Interpolation`] | its neighbourhood |
//! | a harmonic shake | [`Sinusoid`] | everything | – |
//! | a formula in Rust | [`Function`] | what the formula is | – |
//! | a point that stays | [`Still`] | everything | – |
//!
//! All curves go through their keys. [`Sinusoid`], [`Still`] and curves through keys are
//! [`Analytic`]: steps end on their kinks, and Taylor series and lanes take them.

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
