//! Ellipses.

use super::estimate::Estimate;
use super::monte_carlo::Region;
use super::quadrature;
use super::slabs::Triangle;
use crate::positive;
use pendulum_core::body::{Body, BodyError};
use pendulum_core::scalar::Real;

/// An ellipse in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    center: [f64; 2],
    a: f64,
    b: f64,
    sin: f64,
    cos: f64,
}

impl Ellipse {
    /// Creates an ellipse with its `center` relative to the pivot, and the semi-axes `a` and `b` in
    /// metres. `angle` in radians is the direction of `a`.
    pub fn new(center: [f64; 2], a: f64, b: f64, angle: f64) -> Result<Self, BodyError> {
        let (sin, cos) = Real::sin_cos(angle);
        if [center[0], center[1], sin].iter().any(|number| !number.is_finite()) {
            return Err(BodyError::OutOfRange);
        }
        Ok(Self { center, a: positive("semi-axis", a)?, b: positive("semi-axis", b)?, sin, cos })
    }

    /// Creates a disc about `center`.
    pub fn disc(center: [f64; 2], radius: f64) -> Result<Self, BodyError> {
        Self::new(center, positive("radius", radius)?, radius, 0.0)
    }

    /// Returns the area π a b in m².
    pub fn area(&self) -> f64 {
        core::f64::consts::PI * self.a * self.b
    }

    /// Returns the body of uniform `density` in kg/m².
    pub fn body(&self, density: f64) -> Result<Body, BodyError> {
        let mass = positive("density", density)? * self.area();
        let [along, across] = [0.25 * mass * self.a * self.a, 0.25 * mass * self.b * self.b];
        let (ss, sc, cc) = (self.sin * self.sin, self.sin * self.cos, self.cos * self.cos);
        let central = [cc * along + ss * across, sc * (along - across), ss * along + cc * across];
        Body { mass, center: self.center, central }.checked()
    }

    /// Integrates the body of a `density` in kg/m², a function of the point, as
    /// [`Polygon::quadrature`](super::Polygon::quadrature), but in polar coordinates.
    pub fn quadrature(
        &self,
        density: impl FnMut([f64; 2]) -> f64,
        rtol: f64,
    ) -> Result<Estimate, BodyError> {
        let map = |[s, angle]: [f64; 2]| {
            let (sin, cos) = Real::sin_cos(angle);
            (self.point(s * self.a * cos, s * self.b * sin), self.a * self.b * s)
        };
        let radius = if self.a < self.b { self.b } else { self.a };
        quadrature::integrate(sectors(), map, self.center, radius, density, rtol)
    }

    /// Returns the point with the coordinates `u` and `v` along the axes.
    fn point(&self, u: f64, v: f64) -> [f64; 2] {
        [
            self.center[0] + (self.cos * u - self.sin * v),
            self.center[1] + (self.sin * u + self.cos * v),
        ]
    }
}

impl Region for Ellipse {
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let square = |a: f64, b: f64| (a * a + b * b).sqrt();
        let [x, y] = [
            square(self.a * self.cos, self.b * self.sin),
            square(self.a * self.sin, self.b * self.cos),
        ];
        ([self.center[0] - x, self.center[1] - y], [self.center[0] + x, self.center[1] + y])
    }

    fn contains(&self, point: [f64; 2]) -> bool {
        let [x, y] = [point[0] - self.center[0], point[1] - self.center[1]];
        let [u, v] =
            [(self.cos * x + self.sin * y) / self.a, (self.cos * y - self.sin * x) / self.b];
        u * u + v * v <= 1.0
    }
}

/// Returns the triangles of radius in [0, 1] and angle in [0, 2π]: eight sectors of two triangles.
fn sectors() -> Vec<Triangle> {
    let angle = |k: u32| core::f64::consts::FRAC_PI_4 * f64::from(k);
    let halves = |k| {
        let (from, to) = (angle(k), angle(k + 1));
        [[[0.0, from], [1.0, from], [1.0, to]], [[0.0, from], [1.0, to], [0.0, to]]]
    };
    (0..8).flat_map(halves).collect()
}

#[cfg(test)]
mod tests {
    use super::{Body, BodyError, Ellipse, Region};
    use crate::tests::{close, same};

    fn slanted() -> Ellipse {
        Ellipse::new([0.5, -2.0], 1.5, 0.25, 0.6).unwrap()
    }

    #[test]
    fn uniform_ellipse_has_its_formula() {
        let body = slanted().body(2.0).unwrap();
        same(
            body,
            Body::ellipse(2.0 * slanted().area(), 1.5, 0.25)
                .unwrap()
                .rotated(0.6)
                .translated([0.5, -2.0]),
            1e-15,
        );
        same(
            Ellipse::disc([0.0; 2], 2.0).unwrap().body(1.0).unwrap(),
            Body::disc(4.0 * core::f64::consts::PI, 2.0).unwrap(),
            1e-15,
        );
    }

    #[test]
    fn quadrature_finds_the_formula() {
        let (exact, found) =
            (slanted().body(2.0).unwrap(), slanted().quadrature(|_| 2.0, 1e-9).unwrap());
        same(found.body, exact, 1e-9);
        assert!((found.body.mass - exact.mass).abs() <= found.mass_error + 1e-14);
    }

    #[test]
    fn density_that_falls_off_to_the_rim() {
        // ρ = 1 − r² on the unit disc: m = π/2, I = π/6.
        let dome = |[x, y]: [f64; 2]| 1.0 - (x * x + y * y);
        let disc = Ellipse::disc([0.0; 2], 1.0).unwrap();
        let body =
            disc.quadrature(|p| if dome(p) < 0.0 { 0.0 } else { dome(p) }, 1e-8).unwrap().body;
        close(body.mass, core::f64::consts::FRAC_PI_2, 1e-8);
        close(body.inertia(), core::f64::consts::FRAC_PI_6, 1e-8);
    }

    #[test]
    fn bounds_hold_the_ellipse_tightly() {
        let (low, high) = slanted().bounds();
        let mut reach = [0.0_f64; 2];
        for k in 0..1000 {
            let (sin, cos) =
                pendulum_core::scalar::Real::sin_cos(f64::from(k) * 0.006283185307179587_f64);
            let point = slanted().point(1.5 * cos, 0.25 * sin);
            assert!(
                low[0] <= point[0]
                    && point[0] <= high[0]
                    && low[1] <= point[1]
                    && point[1] <= high[1]
            );
            assert!(slanted().contains(slanted().point(1.499 * cos, 0.249 * sin)));
            assert!(!slanted().contains(slanted().point(1.501 * cos, 0.251 * sin)));
            reach = [reach[0].max(point[0] - 0.5), reach[1].max(point[1] + 2.0)];
        }
        close(reach[0], high[0] - 0.5, 1e-5);
        close(reach[1], high[1] + 2.0, 1e-5);
    }

    #[test]
    fn impossible_ellipses_are_refused() {
        assert!(matches!(
            Ellipse::new([0.0; 2], 0.0, 1.0, 0.0),
            Err(BodyError::Argument { name: "semi-axis", .. })
        ));
        assert!(matches!(
            Ellipse::disc([0.0; 2], -1.0),
            Err(BodyError::Argument { name: "radius", .. })
        ));
        assert_eq!(Ellipse::new([0.0; 2], 1.0, 1.0, f64::INFINITY), Err(BodyError::OutOfRange));
        assert_eq!(Ellipse::disc([f64::NAN, 0.0], 1.0), Err(BodyError::OutOfRange));
        assert!(matches!(slanted().body(-1.0), Err(BodyError::Argument { name: "density", .. })));
    }
}
