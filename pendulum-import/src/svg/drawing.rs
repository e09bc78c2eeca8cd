//! The joints of a drawing, and the shapes whose mass is not what one expects.

use core::fmt;
use pendulum_body::Body;

/// Units of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// The length of a pixel, the drawing's unit of length, in metres.
    pub pixel: f64,
    /// The density of opaque areas in kg/m².
    pub density: f64,
}

/// The joints of a drawing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Drawing {
    /// The joints, with parents before their children, and otherwise in the order of the drawing.
    pub joints: Vec<DrawnJoint>,
    /// The shapes without mass, and those with mass that is not drawn.
    pub skipped: Vec<Skipped>,
    /// The number of filled shapes outside of all joints.
    pub loose: usize,
    /// The width and height in pixels.
    pub size: [f64; 2],
}

/// A group of a drawing with a pivot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DrawnJoint {
    /// The id of the group.
    pub name: String,
    /// The cause of the joint's motion.
    pub role: Role,
    /// The index of the joint on which this joint stands.
    pub parent: Option<usize>,
    /// The pivot in metres, from the upper left corner of the drawing, with y upwards: points of
    /// the drawing have a negative y.
    pub pivot: [f64; 2],
    /// The body of the filled shapes in the group, except for shapes on joints within the group,
    /// relative to the pivot in the drawn position; `None` without such shapes.
    pub body: Option<Body>,
    /// The number of shapes in the body.
    pub shapes: usize,
    /// The pivot in the coordinates of the group, in pixels, with y downwards.
    pub anchor: [f64; 2],
    /// `true` if the group is mirrored, so that its rotation is reversed in its own coordinates.
    pub mirrored: bool,
    /// The number of pixels of the drawing per unit of the group's coordinates.
    pub scale: f64,
    /// The index of the byte of the text after the opening tag of the group, at which an
    /// `animateTransform` may be inserted.
    pub inside: usize,
}

impl DrawnJoint {
    /// Returns the arguments of SVG's `rotate` that rotate the group about its pivot by an angle in
    /// radians, counter-clockwise.
    pub fn rotation(&self, angle: f64) -> [f64; 3] {
        let degrees = angle.to_degrees();
        [if self.mirrored { degrees } else { -degrees }, self.anchor[0], self.anchor[1]]
    }
}

/// The cause of the motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Role {
    /// Keys move the joint.
    Keyed,
    /// Gravity and the motion of the parent joint move the joint.
    Pendulum,
}

/// A shape without mass, or with mass that is not drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Skipped {
    /// The id of the shape, or the element and its line in the text if it has no id.
    pub id: String,
    /// The reason.
    pub why: Why,
}

/// The reason for which a shape has no mass, or more than one sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Why {
    /// The shape has no fill, at most a stroke.
    NoFill,
    /// The shape is not visible.
    Hidden,
    /// The opacity is zero.
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
    /// A clip path, of the shape or of a group around it, may hide a part of the shape, which has
    /// mass all the same.
    Clipped,
    /// A mask, of the shape or of a group around it, may hide a part of the shape, which has mass
    /// all the same.
    Masked,
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let why = match self.why {
            Why::NoFill => "has no fill",
            Why::Hidden => "is not visible",
            Why::Transparent => "is transparent",
            Why::NoArea => "has no area",
            Why::Image => "is an image",
            Why::Clipped => "is clipped, but weighs as much as the whole; cut its outline instead",
            Why::Masked => "is masked, but weighs as much as the whole; cut its outline instead",
            Why::Text => "is a text; turn it into paths",
            Why::NotDrawn => {
                "is not drawn: it has no size, a transform that leaves none, `display=\"none\"`, or an empty clip path or filter"
            }
        };
        write!(f, "`{}` {why}", self.id)
    }
}
