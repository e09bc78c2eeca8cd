//! The joints of a drawing and the shapes that weigh nothing.

use crate::body::Body;
use core::fmt;

/// Units of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Metres in a pixel, the drawing's unit of length.
    pub pixel: f64,
    /// The density of what is opaque, in kg/m².
    pub density: f64,
}

/// The joints of a drawing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Drawing {
    /// Parents stand before their children, otherwise in the order of the drawing.
    pub joints: Vec<DrawnJoint>,
    /// Shapes that weigh nothing.
    pub skipped: Vec<Skipped>,
    /// The number of filled shapes that stand on no joint.
    pub loose: usize,
    /// Width and height in pixels.
    pub size: [f64; 2],
}

/// A group of a drawing with a pivot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DrawnJoint {
    /// The id of the group.
    pub name: String,
    /// The cause of its motion.
    pub role: Role,
    /// The joint on which it stands.
    pub parent: Option<usize>,
    /// The pivot in metres, from the upper left corner of the drawing, y up: what is drawn has a
    /// negative y.
    pub pivot: [f64; 2],
    /// The body that the filled shapes make in the group and not on further joints in it, as seen
    /// from the pivot, as drawn; `None` without such shapes.
    pub body: Option<Body>,
    /// The number of shapes in the body.
    pub shapes: usize,
    /// The pivot in the group's own coordinates, in pixels, y down.
    pub anchor: [f64; 2],
    /// True if the group is mirrored: then it turns the other way in its own coordinates.
    pub mirrored: bool,
    /// Pixels of the drawing in a unit of the group's own coordinates.
    pub scale: f64,
    /// The byte of the text after the opening tag of the group, where an `animateTransform` may
    /// stand.
    pub inside: usize,
}

impl DrawnJoint {
    /// The arguments of SVG's `rotate` that turn the group about its pivot by an angle in radians,
    /// counter-clockwise.
    pub fn rotation(&self, angle: f64) -> [f64; 3] {
        let degrees = angle.to_degrees();
        [if self.mirrored { degrees } else { -degrees }, self.anchor[0], self.anchor[1]]
    }
}

/// Cause of the motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Role {
    /// Keys.
    Keyed,
    /// Gravity and the joint on which it hangs.
    Pendulum,
}

/// A shape that weighs nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// Its id, or the line of the text on which an element without one begins.
    pub id: String,
    /// The reason.
    pub why: Why,
}

/// Reason for which a shape weighs nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Why {
    /// The shape has no fill, at most a stroke.
    NoFill,
    /// The shape is not visible.
    Hidden,
    /// Its opacity is zero.
    Transparent,
    /// The shape has no area.
    NoArea,
    /// The element is an image.
    Image,
    /// The element is a text.
    Text,
    /// The element is not drawn: it has no size, a transform that leaves none, `display="none"`, or
    /// a clip path or filter that is empty or missing.
    NotDrawn,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let why = match self.why {
            Why::NoFill => "has no fill",
            Why::Hidden => "is not visible",
            Why::Transparent => "is transparent",
            Why::NoArea => "has no area",
            Why::Image => "is an image",
            Why::Text => "is a text; turn it into paths",
            Why::NotDrawn => {
                "is not drawn: it has no size, a transform that leaves none, `display=\"none\"`, or an empty clip path or filter"
            }
        };
        write!(f, "`{}` {why}", self.id)
    }
}
