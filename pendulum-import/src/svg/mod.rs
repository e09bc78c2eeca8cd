//! Joints and bodies from drawings: SVG files whose groups are joints with filled shapes as bodies.
//!
//! A group is a joint if it contains a small shape, such as a circle, whose id is the name of the
//! group and the cause of the motion: `wing.keyed` in the group `wing` is the pivot of a joint
//! moved by keys, and `feather-7.pendulum` in `feather-7` is the pivot of a pendulum. The pivot is
//! the middle of the shape. The shape has no mass, may be transparent or have `visibility="hidden"`
//! (not `display="none"`), and can be drawn with any editor. Groups within groups are joints on
//! joints; groups without pivots only collect shapes.
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
//! The mass of a shape is its area under its fill rule, with exact Bézier curves and holes
//! ([`Outline`](pendulum_body::Outline)), times the density, times its opacity: the product of the
//! opacities of its fill, of the shape and of all groups around it. For gradients and patterns only
//! the `fill-opacity` counts, not the alpha of their colours; the alpha of a colour, as in `rgba`,
//! has eight bits. The masses of overlapping shapes are added. Strokes have no mass. Clip paths,
//! masks and filters have no effect on masses unless they are empty. Animations and scripts are
//! ignored. A circle consists of cubics, as drawn, with an area within 3·10⁻⁴ of that of a true
//! circle. Coordinates are those of `usvg`, in single precision.
//!
//! [`Drawing::skipped`] lists the shapes without mass by id, and the shapes of which a clip path or a
//! mask may hide a part that has mass. Texts are not supported; convert them
//! to paths.

mod drawing;
mod entities;
mod error;
mod read;
mod references;
mod size;
#[cfg(test)]
mod tests;

pub use drawing::{Drawing, DrawnJoint, Role, Skipped, Units, Why};
pub use error::DrawingError;
