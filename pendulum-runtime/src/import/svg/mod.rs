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
//! The mass of a shape is its area under its fill rule, Bézier curves and holes exactly
//! ([`Outline`](crate::body::Outline)), times the density, times its opacity: that of its fill and
//! those of the shape and of all groups around it. Of a gradient or a pattern only this opacity
//! counts, not its colours'; that of a colour, as in `rgba`, has eight bits. Shapes that overlap
//! weigh twice. Strokes weigh nothing; clip paths, masks and filters take nothing away unless they
//! are empty; animations and scripts are passed over. A circle is weighed as drawn, of cubics, with
//! an area within 3·10⁻⁴ of a true one. Coordinates are those of `usvg`, in single precision.
//!
//! A shape that weighs nothing is listed in [`Drawing::skipped`] with its id. Texts are not read:
//! turn them into paths.

mod drawing;
mod error;
mod read;
mod size;
#[cfg(test)]
mod tests;

pub use drawing::{Drawing, DrawnJoint, Role, Skipped, Units, Why};
pub use error::DrawingError;
