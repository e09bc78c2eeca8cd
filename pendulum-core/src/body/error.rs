//! Errors of bodies.

use core::error::Error;
use core::fmt::{Display, Formatter, Result};

/// The reason for which a shape or a density does not define a body. Ring 0 is the outer ring.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
    /// An argument is out of its range.
    Argument {
        /// The quantity.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The range of valid values.
        required: &'static str,
    },
    /// A ring has fewer than three points.
    TooFewPoints {
        /// The ring.
        ring: usize,
        /// The number of points of the ring.
        points: usize,
    },
    /// A point has an infinite or NaN coordinate.
    NotFinite {
        /// The ring.
        ring: usize,
        /// The index of the point in the ring.
        index: usize,
    },
    /// The points of a ring lie on a line, up to rounding.
    NoArea {
        /// The ring.
        ring: usize,
    },
    /// Two edges cross.
    Crossing {
        /// The ring of the first edge and the index of the edge's first point.
        first: (usize, usize),
        /// The ring of the second edge and the index of the edge's first point.
        second: (usize, usize),
    },
    /// A ring winds twice around a region, or once in the wrong direction, such as a figure of
    /// eight that touches itself.
    Winding {
        /// The ring.
        ring: usize,
        /// The index of the first point of the edge below the region.
        index: usize,
    },
    /// Curves cross so often that computing their winding numbers would take minutes.
    Tangled {
        /// The number of crossings, or of pairs of chords that might cross, at which the search
        /// ended.
        pairs: usize,
    },
    /// A hole lies outside of the outer ring or overlaps another hole.
    HoleOutside {
        /// The ring of the hole.
        ring: usize,
    },
    /// There is no mass: everything is cut out, or nothing is given.
    NoMass,
    /// The moment of inertia about the pivot is less than m|c|².
    LittleInertia {
        /// The given moment of inertia.
        inertia: f64,
        /// m|c|².
        least: f64,
    },
    /// No distribution of mass has these second moments; usually a hole lies outside of its body.
    Moments {
        /// ∫ρ x² dp, ∫ρ x y dp and ∫ρ y² dp about the centre of mass.
        central: [f64; 3],
    },
    /// No distribution of mass has this inertia: the greatest of the principal moments exceeds the
    /// sum of the others. Usually a hole lies outside of its solid, or numbers are mixed up.
    Inertia {
        /// The principal moments about the centre of mass, in ascending order.
        principal: [f64; 3],
    },
    /// A triangle of a mesh does not close its surface.
    Triangle {
        /// The triangle, counted from zero.
        triangle: usize,
        /// What it has or does.
        fault: &'static str,
    },
    /// A density function returned a negative, infinite or NaN value.
    Density {
        /// The point.
        at: [f64; 2],
        /// The value returned.
        value: f64,
    },
    /// The quadrature could not resolve the density.
    Unresolved {
        /// The requested tolerance.
        rtol: f64,
        /// The relative error reached.
        reached: f64,
        /// The number of evaluations of the density.
        evaluations: usize,
    },
    /// Lengths or masses have moments beyond the range of `f64`.
    OutOfRange,
}

impl Display for BodyError {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Argument { name, value, required } => {
                write!(f, "the {name} is {value}; it must be {required}")
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
            Self::Inertia { principal: [a, b, c] } => {
                write!(
                    f,
                    "no solid has the principal moments of inertia {a}, {b} and {c} about its centre of mass"
                )?;
                write!(
                    f,
                    ": none may exceed the sum of the others; a hole must lie inside of what it is cut from"
                )
            }
            Self::Triangle { triangle, fault } => write!(f, "triangle {triangle} {fault}"),
            Self::Density { at: [x, y], value } => {
                write!(
                    f,
                    "the density at ({x}, {y}) is {value}; it must be finite and not negative"
                )
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
            Self::OutOfRange => {
                write!(f, "a moment is beyond the range of f64; use metres and kilograms")
            }
        }
    }
}

impl Error for BodyError {}

/// The name of a ring, for display.
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
        let flat = crate::body::Body::rectangle(1.0, 1.0, 0.0).unwrap_err();
        assert_eq!(flat.to_string(), "the height is 0; it must be positive and finite");
        let density = BodyError::Density { at: [0.5, -1.0], value: -2.0 };
        assert_eq!(
            density.to_string(),
            "the density at (0.5, -1) is -2; it must be finite and not negative"
        );
    }
}
