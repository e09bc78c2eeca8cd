//! Numerically integrated bodies with error estimates.

use pendulum_core::body::{Body, BodyError};

/// A numerically integrated body with error estimates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The body.
    pub body: Body,
    /// The error of the mass in kg: a bound estimated by refinement, or one standard error of
    /// sampling.
    pub mass_error: f64,
    /// The error of each coordinate of the centre, in m.
    pub center_error: [f64; 2],
    /// The error of the moment of inertia about the pivot, in kg m².
    pub inertia_error: f64,
    /// The number of evaluations of the density.
    pub evaluations: usize,
}

/// ∫ρ, ∫ρ x, ∫ρ y, ∫ρ x², ∫ρ x y and ∫ρ y² about an origin close to the body.
pub(super) type Moments = [f64; 6];

/// Returns the body with these moments about `origin`.
pub(super) fn body(moments: &Moments, origin: [f64; 2]) -> Result<Body, BodyError> {
    let [mass, x, y, xx, xy, yy] = *moments;
    if mass <= 0.0 {
        return Err(BodyError::NoMass);
    }
    let (cx, cy) = (x / mass, y / mass);
    let central = [xx - cx * x, xy - cx * y, yy - cy * y];
    Body { mass, center: [origin[0] + cx, origin[1] + cy], central }.checked()
}

/// Evaluates `density` at `at`; an error if the value is negative, infinite or NaN.
pub(super) fn checked(
    density: &mut impl FnMut([f64; 2]) -> f64,
    at: [f64; 2],
) -> Result<f64, BodyError> {
    let value = density(at);
    if (0.0..f64::INFINITY).contains(&value) {
        Ok(value)
    } else {
        Err(BodyError::Density { at, value })
    }
}
