//! Attitudes of solids and their rates of turning, converted from and to every common form.
//!
//! An attitude is a unit quaternion. It turns the components of a vector along the axes of a solid
//! into its components in space: `attitude * u`. Quaternions are Hamilton's, with the real part
//! first; angles are in radians, right-handed.
//!
//! ```
//! use pendulum_runtime::attitude::{Attitude, AttitudeError, Rates};
//! # fn main() -> Result<(), AttitudeError> {
//! // Heading, climb and bank of an aeroplane: turns about its own axes, one after the other.
//! let plane = Attitude::from_euler("zyx", [0.3, 0.1, -0.2])?;
//! let nose = plane * [1.0, 0.0, 0.0];
//! assert!((nose[2] + 0.1_f64.sin()).abs() < 1e-15);
//! let [heading, climb, bank] = plane.to_euler("zyx")?;
//! assert!((heading - 0.3).abs() + (climb - 0.1).abs() + (bank + 0.2).abs() < 1e-15);
//! // It rolls to the right with one radian in a second; the rates of its quaternion:
//! let [w, x, ..] = Rates::body([1.0, 0.0, 0.0]).derivative(plane);
//! # let _ = (w, x);
//! # Ok(())
//! # }
//! ```
//!
//! Constructors give NaN in all components if no attitude follows from their arguments, such as a
//! turn about the vector zero; integrations refuse a state that contains NaN.

mod euler;
mod quaternion;
mod rates;

pub use euler::AttitudeError;
pub use quaternion::Attitude;
pub(crate) use quaternion::product;
pub use rates::Rates;
