//! Errors of drawings.

use crate::body::BodyError;
use core::fmt;

/// Reason for which a drawing cannot be read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DrawingError {
    /// The text is no SVG.
    Syntax(String),
    /// An element stands inside too many others.
    Deep {
        /// The line where it begins.
        line: u32,
        /// The most that are read.
        most: usize,
    },
    /// A unit is not a positive number.
    Unit {
        /// Its name.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A pivot stands in no group of its name.
    NoGroup {
        /// The id of the pivot.
        id: String,
    },
    /// A pivot has no place: its element has no size, or a transform without one.
    NoPlace {
        /// The id of the pivot.
        id: String,
    },
    /// Two pivots, or two groups, have one name.
    Twice {
        /// The name.
        name: String,
    },
    /// The group of a joint is sheared or scaled along one axis: turning it would change its shape.
    Sheared {
        /// The joint.
        name: String,
    },
    /// A pendulum in whose group nothing is filled.
    NoBody {
        /// The joint.
        name: String,
    },
    /// A shape of more than 16384 curves, or one with arcs, circles or corners beyond 10¹² pixels,
    /// which have no end of them.
    Large {
        /// The shape.
        id: String,
    },
    /// A shape that is no body.
    Body {
        /// The shape.
        id: String,
        /// The mistake in it.
        error: BodyError,
    },
}

impl fmt::Display for DrawingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Deep { line, most } => write!(
                f,
                "the element on line {line} stands inside more than {most} others; take it out of some groups"
            ),
            Self::Syntax(message) => write!(f, "{message}; give the text of an SVG file"),
            Self::Unit { what, value } => write!(f, "{value} {what}; give a positive number"),
            Self::NoGroup { id } => {
                write!(f, "the pivot `{id}` stands in no group of its name; put it into that group")
            }
            Self::NoPlace { id } => {
                write!(
                    f,
                    "the pivot `{id}` is not drawn; give it a size, a transform that keeps it, and no `display=\"none\"`"
                )
            }
            Self::Twice { name } => {
                write!(f, "`{name}` is there twice; give each joint a name and a pivot of its own")
            }
            Self::Sheared { name } => write!(
                f,
                "the joint `{name}` is sheared or stretched; apply the transform to its shapes"
            ),
            Self::NoBody { name } => {
                write!(f, "the pendulum `{name}` weighs nothing; fill one of its shapes")
            }
            Self::Large { id } => {
                write!(
                    f,
                    "`{id}` has more than 16384 curves or is larger than 1e12 pixels; simplify it or cut it in parts"
                )
            }
            Self::Body { id, error } => write!(f, "`{id}`: {error}"),
        }
    }
}

impl core::error::Error for DrawingError {}
