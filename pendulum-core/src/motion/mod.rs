//! Prescribed motions, which drive the joints of a scene.
//!
//! A motion computes exactly the derivatives that the equations need, and returns the times of its
//! kinks, at which its position, velocity or acceleration jumps. At a kink it has two values, one
//! from each side.
//!
//! | keys or formula | motion | continuous | a key affects |
//! |---|---|---|---|
//! | keys of an animator | [`Curve::catmull_rom`] | velocity | four pieces of the curve |
//! | few keys, smooth | [`Curve::spline`], [`Curve::clamped`] | acceleration | the whole curve, less with distance |
//! | a cycle, such as a walk | [`Curve::periodic`] | acceleration, also at the seam | the whole curve |
//! | keys with sharp corners, such as blows | [`Curve::linear`] | position | two pieces |
//! | keys with jumps, such as cuts | [`Curve::steps`] | – | one piece |
//! | keys and velocities, such as those of a file | [`Curve::hermite`] | velocity | two pieces |
//! | a harmonic shake | [`Sinusoid`] | all derivatives | – |
//! | a formula in Rust | [`Function`] | depends on the formula | – |
//! | a fixed point | [`Still`] | all derivatives | – |
//! | keys of an attitude, smooth | [`Attitudes::spline`] | angular acceleration | the whole curve, less with distance |
//! | keys of an attitude, turns at constant rates | [`Attitudes::slerp`] | attitude | two pieces |
//! | a turn about an axis | [`Turning`] | as its angle | as of its angle |
//! | any motion at another time or speed, or in a loop | [`Clip`] | as the motion | as of the motion |
//! | a motion that passes into another | [`Fade`] | as the motions, up to the acceleration | as of the motions |
//!
//! All curves go through their keys, and [`starting`](Curve::starting), [`speed`](Curve::speed) and
//! [`looped`](Curve::looped) determine when. [`Sinusoid`], [`Still`] and [`Curve`] are
//! [`Analytic`]: steps end at their kinks, and they support Taylor series and lanes.

mod analytic;
mod attenuated;
mod attitudes;
mod clip;
mod curve;
mod error;
mod fade;
mod function;
pub(crate) mod input;
mod motions;
mod piecewise;
mod prescribed;
mod projected;
mod sample;
pub(crate) mod series;
mod sinusoid;
pub(crate) mod spline;
mod still;
#[cfg(test)]
mod tests;
mod turning;

pub use analytic::Analytic;
pub use attenuated::Attenuated;
pub use attitudes::Attitudes;
pub use clip::Clip;
pub use curve::Curve;
pub use error::MotionError;
pub use fade::Fade;
pub use function::Function;
pub(crate) use motions::AnalyticMotions;
pub use motions::Motions;
pub(crate) use motions::{shorter, sufficient};
pub use prescribed::Motion;
pub(crate) use prescribed::earlier;
pub use projected::Projected;
pub use sample::{Derivatives, Sample, Side};
pub use sinusoid::Sinusoid;
pub use still::Still;
pub use turning::Turning;
