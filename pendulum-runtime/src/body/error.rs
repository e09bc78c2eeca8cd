//! Errors of bodies.

use core::error::Error;
use core::fmt::{Display, Formatter, Result};

/// Reason for which a shape or a density is no body; rings count from the outer one, which is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
    /// A mass, density or length that is zero, negative, infinite or NaN.
    NotPositive {
        /// Its name.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A ring of fewer than three points.
    TooFewPoints {
        /// The ring.
        ring: usize,
        /// The number of its points.
        points: usize,
    },
    /// A point with an infinite or NaN coordinate.
    NotFinite {
        /// The ring.
        ring: usize,
        /// The point in it.
        index: usize,
    },
    /// A ring whose points lie on a line, up to rounding.
    NoArea {
        /// The ring.
        ring: usize,
    },
    /// Two edges that cross.
    Crossing {
        /// The ring of the one edge and the index of its first point.
        first: (usize, usize),
        /// The same of the other edge.
        second: (usize, usize),
    },
    /// A ring that runs around some place twice, or once in the wrong direction: a figure of eight
    /// that touches itself.
    Winding {
        /// The ring.
        ring: usize,
        /// The first point of the edge behind which it does.
        index: usize,
    },
    /// Curves that cross so often that to count what they surround would take minutes.
    Tangled {
        /// The crossings, or pairs of pieces that might cross, after which the search was given up.
        pairs: usize,
    },
    /// A hole outside of the outer ring or over another hole.
    HoleOutside {
        /// Its ring.
        ring: usize,
    },
    /// Nothing is left, or nothing was given.
    NoMass,
    /// A body with less inertia about its pivot than its mass has at its centre.
    LittleInertia {
        /// The moment of inertia that was given.
        inertia: f64,
        /// m|c|².
        least: f64,
    },
    /// Second moments that no distribution of mass has: a hole outside of its body, as a rule.
    Moments {
        /// ∫ρ x² dp, ∫ρ x y dp and ∫ρ y² dp about the centre.
        central: [f64; 3],
    },
    /// A density function that was negative, infinite or NaN.
    Density {
        /// The point.
        at: [f64; 2],
        /// The value that it returned.
        value: f64,
    },
    /// A relative tolerance outside of [10⁻¹³, 1).
    Tolerance {
        /// The tolerance asked for.
        rtol: f64,
    },
    /// A density that the quadrature could not resolve.
    Unresolved {
        /// The tolerance that was asked for.
        rtol: f64,
        /// The relative error that was reached.
        reached: f64,
        /// The number of evaluations of the density until then.
        evaluations: usize,
    },
    /// Too few samples for a standard error.
    TooFewSamples {
        /// The number of samples asked for.
        samples: usize,
    },
    /// Lengths or masses whose moments are beyond the range of `f64`.
    OutOfRange,
}

impl Display for BodyError {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::NotPositive { what, value } => {
                write!(f, "the {what} is {value}; it must be positive and finite")
            }
            Self::TooFewPoints { ring, points } => {
                write!(f, "{} has {points} points; it needs three or more", Ring(ring))
            }
            Self::NotFinite { ring, index } => {
                write!(f, "point {index} of {} is infinite or not a number", Ring(ring))
            }
            Self::NoArea { ring } => write!(
                f,
                "the points of {} lie on a line; use `Body::rod` for a thin body",
                Ring(ring)
            ),
            Self::Crossing { first, second } => {
                let (one, other) = (Ring(first.0), Ring(second.0));
                write!(
                    f,
                    "the edge from point {} of {one} crosses the edge from point {} of {other}",
                    first.1, second.1
                )?;
                write!(f, "; list the points in order around the boundary")
            }
            Self::Winding { ring, index } => {
                write!(
                    f,
                    "{} overlaps itself at the edge from point {index}; give each part as a polygon of its own",
                    Ring(ring)
                )
            }
            Self::Tangled { pairs } => {
                write!(
                    f,
                    "the curves may cross in more than {pairs} places; simplify them or cut them in parts"
                )
            }
            Self::HoleOutside { ring } => {
                write!(f, "{} is not inside the outer ring, or overlaps another hole", Ring(ring))
            }
            Self::NoMass => write!(
                f,
                "there is no mass: nothing was given, everything is cut out or the density is zero"
            ),
            Self::LittleInertia { inertia, least } => {
                write!(
                    f,
                    "the moment of inertia about the pivot is {inertia}; it cannot be below m|c|² = {least}"
                )
            }
            Self::Moments { central: [xx, xy, yy] } => {
                write!(
                    f,
                    "no body has the second moments [{xx}, {xy}, {yy}]; a hole must lie inside of what it is cut from"
                )
            }
            Self::Density { at: [x, y], value } => {
                write!(
                    f,
                    "the density at ({x}, {y}) is {value}; it must be finite and not negative"
                )
            }
            Self::Tolerance { rtol } => {
                write!(f, "the relative tolerance is {rtol}; it must be at least 1e-13 and below 1")
            }
            Self::Unresolved { rtol, reached, evaluations } => {
                write!(
                    f,
                    "the density needs more than {evaluations} evaluations for a relative error of {rtol}"
                )?;
                write!(
                    f,
                    " (reached {reached}); raise the tolerance, cut the shape along the jumps or use Monte Carlo"
                )
            }
            Self::TooFewSamples { samples } => {
                write!(f, "{samples} samples have no standard error; take two or more")
            }
            Self::OutOfRange => {
                write!(f, "a moment is beyond the range of f64; use metres and kilograms")
            }
        }
    }
}

impl Error for BodyError {}

/// A ring by name.
struct Ring(usize);

impl Display for Ring {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.0 == 0 { write!(f, "the outer ring") } else { write!(f, "hole {}", self.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::BodyError;

    #[test]
    fn messages_say_what_where_and_what_to_do() {
        let crossing = BodyError::Crossing { first: (0, 1), second: (2, 3) };
        assert_eq!(
            crossing.to_string(),
            "the edge from point 1 of the outer ring crosses the edge from point 3 of hole 2; \
             list the points in order around the boundary"
        );
        let density = BodyError::Density { at: [0.5, -1.0], value: -2.0 };
        assert_eq!(
            density.to_string(),
            "the density at (0.5, -1) is -2; it must be finite and not negative"
        );
    }
}
