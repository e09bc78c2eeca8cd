//! Errors of drawings.

use core::fmt;
use pendulum_body::BodyError;

/// The reason for which a drawing cannot be read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DrawingError {
    /// The text is not valid SVG.
    Syntax(String),
    /// An element is nested too deeply.
    Deep {
        /// The line on which the element begins.
        line: u32,
        /// The greatest supported depth.
        most: usize,
    },
    /// A unit is not a positive number.
    Unit {
        /// The name of the unit.
        what: &'static str,
        /// The value of the unit.
        value: f64,
    },
    /// A pivot is not inside a group of its name.
    NoGroup {
        /// The id of the pivot.
        id: String,
    },
    /// A pivot has no position: its element has no size, or a transform that leaves none.
    NoPlace {
        /// The id of the pivot.
        id: String,
    },
    /// Two pivots or two groups have the same name.
    Twice {
        /// The name.
        name: String,
    },
    /// The group of a joint is sheared or scaled along one axis, so that its rotation would change
    /// its shape.
    Sheared {
        /// The joint.
        name: String,
    },
    /// The group of a pendulum contains no filled shape.
    NoBody {
        /// The joint.
        name: String,
    },
    /// A shape has more than 16384 curves, or has arcs, circles or corners beyond 10¹² pixels,
    /// which would be converted to far too many curves.
    Large {
        /// The shape.
        id: String,
    },
    /// A shape does not define a body.
    Body {
        /// The shape.
        id: String,
        /// The error of the body.
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
