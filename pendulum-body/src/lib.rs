//! Rigid bodies: mass, centre of mass and second moments. [`Body`] is one in a plane: simple shapes,
//! polygons with holes, and outlines of Bézier curves, with uniform or varying density. [`Solid`] is
//! one in space: simple shapes, and the inside of a [`Mesh`] of triangles.
//!
//! All lengths are in metres from the pivot of a body, with the joint at angle zero, or from the
//! origin of a solid. All masses are in kilograms: shapes take a mass or a density, and no
//! dimensionless factors.
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
#![cfg_attr(docsrs, feature(doc_cfg))]

mod ellipse;
mod estimate;
mod mesh;
mod monte_carlo;
mod outline;
mod polygon;
mod quadrature;
mod random;
mod slabs;
mod sum;

pub use ellipse::Ellipse;
pub use estimate::Estimate;
pub use mesh::Mesh;
pub use monte_carlo::Region;
pub use outline::{FillRule, Outline};
pub use polygon::Polygon;

pub use pendulum_core::body::{Body, BodyError, Solid, symmetric};

/// Returns `value` if it is positive and finite.
fn positive(name: &'static str, value: f64) -> Result<f64, BodyError> {
    if 0.0 < value && value < f64::INFINITY {
        Ok(value)
    } else {
        Err(BodyError::Argument { name, value, required: "positive and finite" })
    }
}

#[cfg(test)]
mod tests {
    use crate::Body;

    pub(crate) fn close(a: f64, b: f64, relative: f64) {
        assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b}");
    }

    /// Checks that mass, centre and second moments agree, in units of the size of the body.
    pub(crate) fn same(a: Body, b: Body, relative: f64) {
        let size = (b.inertia() / b.mass).sqrt();
        close(a.mass, b.mass, relative);
        for index in 0..2 {
            let apart = (a.center[index] - b.center[index]).abs();
            assert!(apart <= relative * size, "{a:?} is not {b:?}");
        }
        for index in 0..3 {
            let apart = (a.central[index] - b.central[index]).abs();
            assert!(apart <= relative * b.inertia(), "{a:?} is not {b:?}");
        }
    }
}
