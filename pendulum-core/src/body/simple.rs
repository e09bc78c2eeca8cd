//! Bodies of uniform density with closed-form moments.

use crate::body::error::BodyError;
use crate::body::moments::{Body, positive};

impl Body {
    /// Creates a point mass at `at`.
    pub fn point(mass: f64, at: [f64; 2]) -> Result<Self, BodyError> {
        Self { mass, center: at, central: [0.0; 3] }.checked()
    }

    /// Creates a thin straight rod between two points: mL²/12 about its centre.
    pub fn rod(mass: f64, from: [f64; 2], to: [f64; 2]) -> Result<Self, BodyError> {
        let half = [0.5 * (to[0] - from[0]), 0.5 * (to[1] - from[1])];
        let third = mass / 3.0;
        let central =
            [third * half[0] * half[0], third * half[0] * half[1], third * half[1] * half[1]];
        Self { mass, center: [from[0] + half[0], from[1] + half[1]], central }.checked()
    }

    /// Creates a rectangle centred on the pivot: m(w² + h²)/12.
    pub fn rectangle(mass: f64, width: f64, height: f64) -> Result<Self, BodyError> {
        let (width, height) = (positive("width", width)?, positive("height", height)?);
        Self {
            mass,
            center: [0.0; 2],
            central: [mass * width * width / 12.0, 0.0, mass * height * height / 12.0],
        }
        .checked()
    }

    /// Creates an ellipse centred on the pivot, with the semi-axes `a` along x and `b` along y:
    /// m(a² + b²)/4.
    pub fn ellipse(mass: f64, a: f64, b: f64) -> Result<Self, BodyError> {
        let (a, b) = (positive("semi-axis", a)?, positive("semi-axis", b)?);
        Self { mass, center: [0.0; 2], central: [0.25 * mass * a * a, 0.0, 0.25 * mass * b * b] }
            .checked()
    }

    /// Creates a disc centred on the pivot: mr²/2.
    pub fn disc(mass: f64, radius: f64) -> Result<Self, BodyError> {
        let radius = positive("radius", radius)?;
        Self::ellipse(mass, radius, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::{Body, BodyError};
    use crate::body::moments::tests::{close, same};

    #[test]
    fn rod_about_its_end_and_its_middle() {
        let rod = Body::rod(3.0, [0.0, 0.0], [0.0, -2.0]).unwrap();
        close(rod.inertia(), 3.0 * 4.0 / 3.0, 1e-15);
        close(rod.inertia_about_center(), 3.0 * 4.0 / 12.0, 1e-15);
        assert_eq!(rod.center, [0.0, -1.0]);
        let turned = Body::rod(3.0, [0.0, 0.0], [2.0, 0.0]).unwrap().rotated(-0.4);
        let (sin, cos) = crate::scalar::Real::sin_cos(-0.4_f64);
        same(turned, Body::rod(3.0, [0.0, 0.0], [2.0 * cos, 2.0 * sin]).unwrap(), 1e-15);
    }

    #[test]
    fn polyline_weighs_its_segments_by_length() {
        // An L-shaped line with a long and a short arm, 1 kg/m.
        let arms = [Body::rod(4.0, [0.0, 0.0], [4.0, 0.0]), Body::rod(1.0, [4.0, 0.0], [4.0, 1.0])];
        let line = Body::compound(arms.map(Result::unwrap)).unwrap();
        close(line.center[0], 2.4, 1e-15);
        close(line.center[1], 0.1, 1e-15);
        // 4³/3, and 1/12 + (16 + ¼).
        close(line.inertia(), 64.0 / 3.0 + 1.0 / 12.0 + 16.25, 1e-15);
    }

    #[test]
    fn rectangle_about_its_top_edge() {
        let plank = Body::rectangle(1.0, 40.0, 200.0).unwrap().translated([0.0, -100.0]);
        close(plank.inertia(), 13466.0 + 2.0 / 3.0, 1e-15);
    }

    #[test]
    fn disc_and_ellipse_about_centre_and_rim() {
        close(Body::disc(2.0, 3.0).unwrap().inertia(), 9.0, 1e-15);
        close(Body::disc(2.0, 3.0).unwrap().translated([3.0, 0.0]).inertia(), 27.0, 1e-15);
        close(Body::ellipse(2.0, 3.0, 1.0).unwrap().inertia(), 5.0, 1e-15);
        assert_eq!(Body::ellipse(1.0, 2.0, 2.0), Body::disc(1.0, 2.0));
    }

    #[test]
    fn point_has_no_extent() {
        let point = Body::point(2.0, [3.0, -4.0]).unwrap();
        assert_eq!((point.inertia(), point.inertia_about_center()), (50.0, 0.0));
    }

    #[test]
    fn sizes_and_masses_must_be_positive() {
        for bad in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            for (body, name) in [
                (Body::rectangle(1.0, bad, 1.0), "width"),
                (Body::rectangle(1.0, 1.0, bad), "height"),
                (Body::ellipse(1.0, 1.0, bad), "semi-axis"),
                (Body::disc(1.0, bad), "radius"),
                (Body::point(bad, [0.0; 2]), "mass"),
                (Body::rod(bad, [0.0; 2], [1.0, 0.0]), "mass"),
                (Body::rectangle(bad, 1.0, 2.0), "mass"),
                (Body::disc(bad, 1.0), "mass"),
            ] {
                assert!(
                    matches!(body, Err(BodyError::Argument { name: found, .. }) if found == name),
                    "{body:?}"
                );
            }
        }
        assert_eq!(Body::rod(1.0, [0.0; 2], [f64::NAN, 0.0]), Err(BodyError::OutOfRange));
        assert_eq!(Body::disc(1.0, 1e200), Err(BodyError::OutOfRange));
    }
}
