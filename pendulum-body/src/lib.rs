//! Rigid planar bodies: mass, centre of mass and second moments of simple shapes, polygons with
//! holes, and outlines of Bézier curves, with uniform or varying density.
//!
//! All lengths are in metres from the pivot, with the joint at angle zero. All masses are in
//! kilograms: shapes take a mass or a density, and no dimensionless factors.
//!
//! ```
//! use pendulum_runtime::body::{Body, Polygon};
//!
//! // A feather of 40 g/m² that hangs from its tip, and a bead of 1 g at its end.
//! let vane = Polygon::new(&[[0.0, 0.0], [0.03, -0.2], [-0.01, -0.25]])?.body(0.04)?;
//! let feather = vane + Body::point(0.001, [0.0, -0.2])?;
//! assert!((feather.mass - 0.00119).abs() < 1e-15);
//! assert!(feather.inertia_about_center() < feather.inertia());
//! # Ok::<(), pendulum_runtime::body::BodyError>(())
//! ```

mod ellipse;
mod error;
mod estimate;
mod moments;
mod monte_carlo;
mod outline;
mod polygon;
mod quadrature;
pub(crate) mod random;
mod simple;
mod slabs;
mod sum;

pub use ellipse::Ellipse;
pub use error::BodyError;
pub use estimate::Estimate;
pub use moments::Body;
pub use monte_carlo::Region;
pub use outline::{FillRule, Outline};
pub use polygon::Polygon;
