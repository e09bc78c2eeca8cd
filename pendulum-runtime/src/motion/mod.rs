//! Prescribed motions: what drives the joints of a scene.
//!
//! A motion is asked for exactly the derivatives that the equations contain, and says where its
//! kinks are: the times at which its position, velocity or acceleration jumps. There it has two
//! values, one from each side.

mod analytic;
mod attenuated;
mod catmull_rom;
mod clip;
mod error;
mod function;
mod linear;
mod motions;
pub(crate) mod piecewise;
mod prescribed;
mod projected;
mod sample;
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
