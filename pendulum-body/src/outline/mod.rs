//! Regions bounded by lines and Bézier curves.

mod crossing;
mod curve;
mod green;
#[cfg(test)]
mod tests;
mod winding;

use crate::positive;
use curve::{Curve, Point};
use green::integrals;
use pendulum_core::body::{Body, BodyError};
use pendulum_core::scalar::Real;

/// The distance, relative to the radius of the outline, up to which curves coincide.
const COINCIDE: f64 = 1e-9;

/// A region bounded by closed runs of lines and of Bézier curves up to the third degree, which may
/// cross and overlap.
///
/// ```
/// use pendulum_runtime::body::{FillRule, Outline};
/// // A feather: down one side in a curve, back on the other.
/// let vane = Outline::new(FillRule::NonZero)
///     .move_to([0.0, 0.0])
///     .cubic_to([0.02, -0.05], [0.02, -0.1], [0.0, -0.12])
///     .cubic_to([-0.02, -0.1], [-0.02, -0.05], [0.0, 0.0])
///     .body(0.04)?;
/// assert!(vane.center[0].abs() < 1e-15);
/// # Ok::<(), pendulum_runtime::body::BodyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    rule: FillRule,
    /// The curves of each closed run.
    rings: Vec<Vec<Curve>>,
    start: Point,
    at: Point,
}

/// The rule that defines the inside of curves that cross or lie within each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FillRule {
    /// Points whose winding number is not zero are inside.
    #[default]
    NonZero,
    /// Points whose winding number is odd are inside.
    EvenOdd,
}

impl FillRule {
    fn inside(self, winding: i32) -> bool {
        match self {
            Self::NonZero => winding != 0,
            Self::EvenOdd => winding % 2 != 0,
        }
    }
}

impl Outline {
    /// Creates an outline without curves; the first call should be [`move_to`](Self::move_to).
    pub fn new(rule: FillRule) -> Self {
        Self { rule, rings: Vec::new(), start: [0.0; 2], at: [0.0; 2] }
    }

    /// Begins another closed run at a point, in metres from the pivot, and closes the run before
    /// with a line.
    #[must_use]
    pub fn move_to(mut self, to: Point) -> Self {
        self = self.closed();
        self.rings.push(Vec::new());
        (self.start, self.at) = (to, to);
        self
    }

    /// Adds a line.
    #[must_use]
    pub fn line_to(self, to: Point) -> Self {
        let from = self.at;
        let third = |part: f64| [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        self.with([from, third(1.0 / 3.0), third(2.0 / 3.0), to], true)
    }

    /// Adds a quadratic Bézier curve.
    #[must_use]
    pub fn quad_to(self, control: Point, to: Point) -> Self {
        let from = self.at;
        let toward =
            |end: Point| [0, 1].map(|axis| end[axis] + 2.0 / 3.0 * (control[axis] - end[axis]));
        self.with([from, toward(from), toward(to), to], false)
    }

    /// Adds a cubic Bézier curve.
    #[must_use]
    pub fn cubic_to(self, first: Point, second: Point, to: Point) -> Self {
        let from = self.at;
        self.with([from, first, second, to], false)
    }

    /// Returns the body of uniform `density` in kg/m².
    ///
    /// Green's theorem turns the moments into integrals along the curves, ∫x dA = ½∮x² dy and so
    /// on, which the Gauss rule of six points integrates exactly up to rounding. Curves are cut at
    /// their crossings, and the fill rule determines the weight of each piece from the winding
    /// numbers on its two sides. Two crossings of the same curves that are less than a sixteenth of
    /// a curve apart may be missed; the error is then smaller than the area between them.
    pub fn body(&self, density: f64) -> Result<Body, BodyError> {
        let density = positive("density", density)?;
        let whole = self.clone().closed();
        let points = || whole.rings.iter().flatten().flat_map(|curve| curve.points);
        if let Some(index) = points().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
            return Err(BodyError::NotFinite { ring: 0, index });
        }
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for point in points() {
            for axis in 0..2 {
                bounds[0][axis] = Real::min(bounds[0][axis], point[axis]);
                bounds[1][axis] = Real::max(bounds[1][axis], point[axis]);
            }
        }
        if points().next().is_none() {
            return Err(BodyError::NoMass);
        }
        let origin = [0, 1].map(|axis| 0.5 * (bounds[0][axis] + bounds[1][axis]));
        let radius = Real::max(bounds[1][0] - origin[0], bounds[1][1] - origin[1]);
        let extent = radius + origin[0].abs() + origin[1].abs();

        let count = points().count();
        let pieces = whole.moved(origin).boundary(COINCIDE * radius)?;
        let first = integrals(&pieces, [0.0; 2]);
        // Coordinates are rounded, so an area of the size of the rounding errors counts as zero.
        let least = 4.0 * count as f64 * f64::EPSILON * extent * radius;
        let area = first[0];
        if area.abs() <= least {
            return Err(BodyError::NoArea { ring: 0 });
        }
        let center = [first[1] / area, first[2] / area];
        let [area, _, _, xx, xy, yy] = integrals(&pieces, center);
        let central = [xx, xy, yy].map(|moment| density * moment);
        Body {
            mass: density * area,
            center: [origin[0] + center[0], origin[1] + center[1]],
            central,
        }
        .checked()
    }

    fn with(mut self, points: [Point; 4], straight: bool) -> Self {
        if self.rings.is_empty() {
            self.rings.push(Vec::new());
        }
        let last = self.rings.len() - 1;
        self.at = points[3];
        self.rings[last].push(Curve { points, straight });
        self
    }

    fn closed(self) -> Self {
        let (start, open) = (self.start, self.rings.last().is_some_and(|ring| !ring.is_empty()));
        if open && self.at != start { self.line_to(start) } else { self }
    }

    fn moved(mut self, origin: Point) -> Self {
        for curve in self.rings.iter_mut().flatten() {
            curve.points = curve.points.map(|[x, y]| [x - origin[0], y - origin[1]]);
        }
        self
    }
}
