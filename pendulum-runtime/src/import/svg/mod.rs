//! Joints and bodies from drawings: an SVG file whose groups are joints and whose filled shapes are
//! what hangs on them.
//!
//! A group is a joint if a small shape in it, such as a circle, names it and says what moves it: in
//! the group `wing` the shape `wing.keyed` is the pivot of a joint moved by keys, in `feather-7`
//! the shape `feather-7.pendulum` that of one that swings. Its middle is the pivot. It weighs
//! nothing, may be transparent or have `visibility="hidden"` (not `display="none"`), and any editor
//! can draw it. Groups within groups are joints on joints; other groups only collect shapes.
//!
//! ```
//! use pendulum_runtime::import::svg::{Drawing, Role, Units};
//!
//! let text = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
//!   <g id="arm"><circle id="arm.keyed" cx="50" cy="20" r="1"/>
//!     <rect x="45" y="20" width="10" height="30"/>
//!     <g id="sign"><circle id="sign.pendulum" cx="50" cy="50" r="1" fill="none"/>
//!       <path d="M40 50h20v30h-20z" fill="#a52" fill-opacity="0.5"/></g></g>
//! </svg>"##;
//! // A millimetre a pixel, and two kilograms a square metre where it is opaque.
//! let drawing = Drawing::read(text, Units { pixel: 1e-3, density: 2.0 })?;
//! let sign = &drawing.joints[1];
//! assert_eq!((sign.name.as_str(), sign.role, sign.parent), ("sign", Role::Pendulum, Some(0)));
//! let body = sign.body.unwrap();
//! assert!((body.mass - 0.5 * 2.0 * 0.020 * 0.030).abs() < 1e-9);
//! assert!((body.center[1] + 0.015).abs() < 1e-9); // below its pivot: y points up
//! # Ok::<(), pendulum_runtime::import::svg::DrawingError>(())
//! ```
//!
//! What a shape weighs: its area under its fill rule, Bézier curves and holes exactly
//! ([`Outline`](crate::body::Outline)), times the density, times its opacity: that of its fill and
//! those of the shape and of all groups around it. Of a gradient or a pattern only this opacity
//! counts, not its colours'; that of a colour, as in `rgba`, has eight bits. Shapes that overlap
//! weigh twice. Strokes weigh nothing; clip paths, masks and filters take nothing away unless they
//! are empty; animations and scripts are passed over. A circle is weighed as drawn, of cubics, with
//! an area within 3·10⁻⁴ of a true one. Coordinates are those of `usvg`, in single precision.
//!
//! What weighs nothing is listed in [`Drawing::skipped`] with its id. Texts are not read: turn them
//! into paths.

mod error;
mod read;
mod size;
#[cfg(test)]
mod tests;

pub use error::DrawingError;

use crate::body::Body;
use core::fmt;

/// What a drawing is measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Metres in a pixel, the drawing's unit of length.
    pub pixel: f64,
    /// The density of what is opaque, in kg/m².
    pub density: f64,
}

/// The joints of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Parents stand before their children, otherwise in the order of the drawing.
    pub joints: Vec<Joint>,
    /// Shapes that weigh nothing.
    pub skipped: Vec<Skipped>,
    /// The number of filled shapes that stand on no joint.
    pub loose: usize,
    /// Width and height in pixels.
    pub size: [f64; 2],
}

/// A group of a drawing with a pivot.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The id of the group.
    pub name: String,
    /// What moves it.
    pub role: Role,
    /// The joint on which it stands.
    pub parent: Option<usize>,
    /// The pivot in metres, from the upper left corner of the drawing, y up: what is drawn has a
    /// negative y.
    pub pivot: [f64; 2],
    /// What is filled in the group but not on further joints in it, as seen from the pivot, as
    /// drawn; nothing if nothing is.
    pub body: Option<Body>,
    /// The number of shapes in the body.
    pub shapes: usize,
    /// The pivot in the group's own coordinates, in pixels, y down.
    pub anchor: [f64; 2],
    /// Whether the group is mirrored: then it turns the other way in its own coordinates.
    pub mirrored: bool,
    /// Pixels of the drawing in a unit of the group's own coordinates.
    pub scale: f64,
    /// The byte of the text after the opening tag of the group, where an `animateTransform` may
    /// stand.
    pub inside: usize,
}

impl Joint {
    /// The arguments of SVG's `rotate` that turn the group about its pivot by an angle in radians,
    /// counter-clockwise.
    pub fn rotation(&self, angle: f64) -> [f64; 3] {
        let degrees = angle.to_degrees();
        [if self.mirrored { degrees } else { -degrees }, self.anchor[0], self.anchor[1]]
    }
}

/// What moves a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Keys.
    Keyed,
    /// Gravity and the joint on which it hangs.
    Pendulum,
}

/// A shape that weighs nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// Its id, or the line of the text on which an element without one begins.
    pub id: String,
    /// Why it weighs nothing.
    pub why: Why,
}

/// Why a shape weighs nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// It has no fill, at most a stroke.
    NoFill,
    /// It is not visible.
    Hidden,
    /// Its opacity is zero.
    Transparent,
    /// It has no area.
    NoArea,
    /// It is an image.
    Image,
    /// It is a text.
    Text,
    /// It is not drawn: it has no size, a transform that leaves none, `display="none"`, or a clip
    /// path or filter that is empty or missing.
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
