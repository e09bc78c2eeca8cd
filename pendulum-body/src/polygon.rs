//! Polygons with holes.

use super::estimate::Estimate;
use super::monte_carlo::Region;
use super::quadrature;
use super::slabs::{Point, Ring, Triangle, triangles};
use super::sum::Sum;
use crate::positive;
use pendulum_core::body::{Body, BodyError};
use pendulum_core::scalar::Real;

/// A simple polygon, convex or not, with any number of holes.
///
/// The points of a ring are listed along its boundary in either direction; the last point is joined
/// to the first. Rings may touch, but must not cross or overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// A point close to the polygon. Local coordinates keep their accuracy far from the pivot.
    origin: Point,
    /// The outer ring and the holes, relative to the origin.
    rings: Vec<Ring>,
    /// Half of the larger side of the bounding box.
    radius: f64,
}

impl Polygon {
    /// Creates a polygon from a ring of points, in metres from the pivot.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, BodyError> {
        check(points, 0)?;
        let (low, high) = bounds(points);
        let half = [0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])];
        let origin = [low[0] + half[0], low[1] + half[1]];
        let radius = if half[0] < half[1] { half[1] } else { half[0] };
        Self { origin, rings: Vec::new(), radius }.with_ring(points, 1.0)
    }

    /// Adds a hole.
    pub fn hole(self, points: &[[f64; 2]]) -> Result<Self, BodyError> {
        check(points, self.rings.len())?;
        self.with_ring(points, -1.0)
    }

    /// Returns the area without the holes, in m².
    pub fn area(&self) -> f64 {
        self.rings.iter().map(|ring| ring.sign * signed_area(ring)).sum()
    }

    /// Returns the body of uniform `density` in kg/m².
    ///
    /// Sums over the edges (Hally 1987): first for the centre, relative to a point close to the
    /// polygon, then for the second moments about the centre.
    pub fn body(&self, density: f64) -> Result<Body, BodyError> {
        let density = positive("density", density)?;
        let mut sums = [Sum::default(); 3];
        for ring in &self.rings {
            for ([x0, y0], [x1, y1]) in ring.edges() {
                let cross = ring.sign * (x0 * y1 - x1 * y0);
                sums[0].add(cross / 2.0);
                sums[1].add(cross * (x0 + x1) / 6.0);
                sums[2].add(cross * (y0 + y1) / 6.0);
            }
        }
        let [area, x, y] = sums.map(Sum::value);
        let [cx, cy] = [x / area, y / area];

        let mut sums = [Sum::default(); 3];
        for ring in &self.rings {
            for (from, to) in ring.edges() {
                let [x0, y0] = [from[0] - cx, from[1] - cy];
                let [x1, y1] = [to[0] - cx, to[1] - cy];
                let cross = ring.sign * (x0 * y1 - x1 * y0);
                sums[0].add(cross * (x0 * x0 + x0 * x1 + x1 * x1) / 12.0);
                sums[1].add(cross * (2.0 * (x0 * y0 + x1 * y1) + (x0 * y1 + x1 * y0)) / 24.0);
                sums[2].add(cross * (y0 * y0 + y0 * y1 + y1 * y1) / 12.0);
            }
        }
        let central = sums.map(|sum| density * sum.value());
        Body { mass: density * area, center: [self.origin[0] + cx, self.origin[1] + cy], central }
            .checked()
    }

    /// Integrates the body of a `density` in kg/m², a function of the point, by adaptive quadrature
    /// with the relative tolerance `rtol`.
    ///
    /// Uses the rule of Radon (1948) with seven points per triangle. Triangles are divided in four
    /// until the estimated errors of the mass and, in units of the size of the polygon, of the
    /// other moments add up to less than `rtol` of the mass. Nine digits of a smooth density
    /// require some ten thousand evaluations; along a jump each further digit requires ten times as
    /// many. The quadrature can miss a feature much smaller than an eighth of the polygon, and a
    /// jump much smaller than the density itself.
    pub fn quadrature(
        &self,
        density: impl FnMut([f64; 2]) -> f64,
        rtol: f64,
    ) -> Result<Estimate, BodyError> {
        let [x, y] = self.origin;
        let triangles = self.triangles()?;
        quadrature::integrate(
            triangles,
            |[u, v]| ([x + u, y + v], 1.0),
            self.origin,
            self.radius,
            density,
            rtol,
        )
    }

    fn with_ring(mut self, points: &[Point], side: f64) -> Result<Self, BodyError> {
        let index = self.rings.len();
        let local = points
            .iter()
            .map(|point| [point[0] - self.origin[0], point[1] - self.origin[1]])
            .collect();
        let mut ring = Ring { points: local, sign: 1.0 };
        let area = signed_area(&ring);
        if !area.is_finite() {
            return Err(BodyError::OutOfRange);
        }
        ring.sign = side * area.signum();
        self.rings.push(ring);

        // Coordinates are rounded, so an area of the size of the rounding errors counts as zero.
        let least = 4.0 * points.len() as f64 * f64::EPSILON * self.extent() * self.radius;
        match self.triangles() {
            Err(BodyError::Crossing { first, second }) => {
                Err(BodyError::Crossing { first, second })
            }
            _ if area.abs() <= least => Err(BodyError::NoArea { ring: index }),
            Err(error) => Err(error),
            Ok(_) if self.spike(index).is_some() => {
                let (first, second) = self.spike(index).unwrap_or_default();
                Err(BodyError::Crossing { first: (index, first), second: (index, second) })
            }
            Ok(_) if self.area() <= least => Err(BodyError::NoMass),
            Ok(_) => Ok(self),
        }
    }

    /// Returns two neighbouring edges of a ring of which the second reverses the first, up to
    /// rounding.
    fn spike(&self, ring: usize) -> Option<(usize, usize)> {
        let points = &self.rings[ring].points;
        let count = points.len();
        // Skips edges of length zero.
        let corners: Vec<usize> =
            (0..count).filter(|&index| points[index] != points[(index + 1) % count]).collect();
        let slack = 4.0 * f64::EPSILON * self.extent();
        (0..corners.len()).map(|place| (corners[place], corners[(place + 1) % corners.len()])).find(
            |&(first, second)| {
                let edge = |index: usize| {
                    let ([x0, y0], [x1, y1]) = (points[index], points[(index + 1) % count]);
                    [x1 - x0, y1 - y0]
                };
                let ([a, b], [c, d]) = (edge(first), edge(second));
                let longer = Real::max(Real::max(a.abs(), b.abs()), Real::max(c.abs(), d.abs()));
                a * c + b * d < 0.0 && (a * d - b * c).abs() <= slack * longer
            },
        )
    }

    fn triangles(&self) -> Result<Vec<Triangle>, BodyError> {
        triangles(&self.rings, self.extent())
    }

    /// Returns a bound of the magnitude of the coordinates relative to the pivot.
    fn extent(&self) -> f64 {
        self.radius + self.origin[0].abs() + self.origin[1].abs()
    }
}

impl Region for Polygon {
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let (low, high) = bounds(&self.rings[0].points);
        let [x, y] = self.origin;
        ([x + low[0], y + low[1]], [x + high[0], y + high[1]])
    }

    /// Returns `true` if a ray from the point crosses the rings an odd number of times.
    fn contains(&self, point: [f64; 2]) -> bool {
        let [x, y] = [point[0] - self.origin[0], point[1] - self.origin[1]];
        let mut inside = false;
        for ([x0, y0], [x1, y1]) in self.rings.iter().flat_map(Ring::edges) {
            if (y0 <= y) != (y1 <= y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0) {
                inside = !inside;
            }
        }
        inside
    }
}

/// Checks that a ring has three points or more, all of them finite.
fn check(points: &[Point], ring: usize) -> Result<(), BodyError> {
    if points.len() < 3 {
        return Err(BodyError::TooFewPoints { ring, points: points.len() });
    }
    match points.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
        Some(index) => Err(BodyError::NotFinite { ring, index }),
        None => Ok(()),
    }
}

/// Returns the least and the greatest coordinates.
fn bounds(points: &[Point]) -> (Point, Point) {
    let (mut low, mut high) = (points[0], points[0]);
    for point in points {
        for axis in 0..2 {
            low[axis] = Real::min(low[axis], point[axis]);
            high[axis] = Real::max(high[axis], point[axis]);
        }
    }
    (low, high)
}

/// Returns half the sum of the cross products of neighbouring points, which is positive for
/// counter-clockwise rings.
fn signed_area(ring: &Ring) -> f64 {
    let mut sum = Sum::default();
    for ([x0, y0], [x1, y1]) in ring.edges() {
        sum.add(0.5 * (x0 * y1 - x1 * y0));
    }
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::super::{Body, BodyError, Region};
    use super::Polygon;
    use crate::random::Random;
    use crate::tests::{close, same};
    use pendulum_core::scalar::Real;

    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    const PENTAGON: [[f64; 2]; 5] =
        [[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [-1.0, -1.0], [1.0, -1.0]];

    fn uniform(points: &[[f64; 2]]) -> Body {
        Polygon::new(points).unwrap().body(1.0).unwrap()
    }

    fn moved(points: &[[f64; 2]], x: f64, y: f64) -> Vec<[f64; 2]> {
        points.iter().map(|point| [point[0] + x, point[1] + y]).collect()
    }

    /// Returns a star-shaped polygon about the origin with radii in [½, 1).
    fn star(random: &mut Random, points: usize) -> Vec<[f64; 2]> {
        let turn = 2.0 * core::f64::consts::PI / points as f64;
        let ray = |index| {
            let (sin, cos) = Real::sin_cos(turn * index as f64);
            let radius = 0.5 + 0.5 * random.unit();
            [radius * cos, radius * sin]
        };
        (0..points).map(ray).collect()
    }

    /// Returns the area of the triangles, and checks that none of them is reversed.
    fn covered(polygon: &Polygon) -> f64 {
        let area = |[a, b, c]: [[f64; 2]; 3]| {
            let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
            assert!(-1e-15 <= area);
            area
        };
        polygon.triangles().unwrap().into_iter().map(area).sum()
    }

    #[test]
    fn square_is_a_rectangle() {
        same(uniform(&SQUARE), Body::rectangle(4.0, 2.0, 2.0).unwrap(), 1e-15);
    }

    #[test]
    fn turned_square_is_a_diamond() {
        let diamond = uniform(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]);
        let side = core::f64::consts::SQRT_2;
        let square = Body::rectangle(2.0, side, side).unwrap();
        same(diamond, square.rotated(core::f64::consts::FRAC_PI_4), 1e-15);
        close(diamond.inertia(), 2.0 * 4.0 / 12.0, 1e-15);
    }

    #[test]
    fn pentagon_has_the_same_inertia_wherever_it_stands() {
        let pentagon = uniform(&PENTAGON);
        close(pentagon.mass, 7.0, 1e-15);
        close(pentagon.center[1], 4.0 / 21.0, 1e-15);
        // The mean of the corners, which is the origin, is not the centre of mass.
        close(pentagon.inertia(), 26.0 / 3.0, 1e-15);
        close(pentagon.inertia_about_center(), 26.0 / 3.0 - 16.0 / 63.0, 1e-15);
        let beside = uniform(&moved(&PENTAGON, 1.0, 0.0));
        same(beside, pentagon.translated([1.0, 0.0]), 1e-15);
    }

    #[test]
    fn slanted_polygon_has_positive_inertia() {
        let corners = [
            [-2.625452, 4.425248],
            [-3.101252, 8.107347],
            [-4.639852, 5.767548],
            [-4.937052, 4.040548],
            [-3.365452, 3.517048],
        ];
        let body = uniform(&corners);
        // The expected values are from rational arithmetic, `tests/data/polygon.py`.
        close(body.inertia_about_center(), 8.351756549639132, 1e-14);
        close(body.inertia(), 272.43122410991964, 1e-14);
    }

    #[test]
    fn distance_from_the_pivot_costs_no_digits() {
        // Multiples of 2⁻³⁰ are exact at 10⁶.
        let quantum = 1.0 / 1073741824.0;
        let mut random = Random::new(5);
        for _ in 0..20 {
            let star: Vec<_> = star(&mut random, 9)
                .iter()
                .map(|point| point.map(|x| (x / quantum).round() * quantum))
                .collect();
            let (near, far) = (uniform(&star), uniform(&moved(&star, 1e6, -1e6)));
            close(far.mass, near.mass, 1e-14);
            close(far.inertia_about_center(), near.inertia_about_center(), 1e-14);
            let apart =
                [far.center[0] - 1e6 - near.center[0], far.center[1] + 1e6 - near.center[1]];
            assert!(apart[0].abs() <= 1.2e-10 && apart[1].abs() <= 1.2e-10);
        }
    }

    #[test]
    fn direction_and_first_point_do_not_matter() {
        let mut random = Random::new(6);
        for _ in 0..20 {
            let mut star = star(&mut random, 8);
            let body = uniform(&star);
            star.rotate_left(3);
            same(uniform(&star), body, 1e-15);
            star.reverse();
            same(uniform(&star), body, 1e-15);
        }
    }

    #[test]
    fn spikes_are_refused() {
        let spike = |points: &[[f64; 2]]| Polygon::new(points).unwrap_err();
        let outward = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(spike(&outward), BodyError::Crossing { first: (0, 2), second: (0, 3) });
        // Spikes that are longer than the edge from which they start, point inwards, lie along an
        // edge, are rotated, or contain a point twice.
        let along = [[0.0, 0.0], [3.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(spike(&along), BodyError::Crossing { first: (0, 0), second: (0, 1) });
        let inward =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.7, 0.7], [0.7, 0.7], [1.0, 1.0], [0.0, 1.0]];
        assert!(matches!(spike(&inward), BodyError::Crossing { .. }));
        let turned: Vec<_> = outward
            .iter()
            .map(|[x, y]| [0.6 * x - 0.8 * y + 0.1, 0.8 * x + 0.6 * y - 0.3])
            .collect();
        assert!(matches!(spike(&turned), BodyError::Crossing { .. }));
        let frame = Polygon::new(&SQUARE).unwrap();
        let hole: Vec<_> = outward.iter().map(|[x, y]| [0.2 * x, 0.2 * y]).collect();
        assert!(matches!(frame.hole(&hole), Err(BodyError::Crossing { first: (1, _), .. })));
        // A sharp tip is not a spike.
        assert!(Polygon::new(&[[0.0, 0.0], [1.0, 1e-9], [1.0, 2e-9]]).is_ok());
    }

    #[test]
    fn triangle_about_its_tip() {
        // A feather: m/6 (a·a + a·b + b·b).
        let (a, b) = ([0.03, -0.2], [-0.01, -0.25]);
        let feather = uniform(&[[0.0, 0.0], a, b]);
        let [aa, ab, bb] =
            [a[0] * a[0] + a[1] * a[1], a[0] * b[0] + a[1] * b[1], b[0] * b[0] + b[1] * b[1]];
        close(feather.mass, 0.00475, 1e-14);
        close(feather.inertia(), feather.mass / 6.0 * (aa + ab + bb), 1e-14);
        close(feather.center[1], -0.15, 1e-15);
    }

    #[test]
    fn thin_polygon_is_a_rod() {
        let rod = uniform(&[[-1e-6, 0.0], [1e-6, 0.0], [1e-6, -3.0], [-1e-6, -3.0]]);
        close(rod.inertia(), rod.mass * 3.0, 1e-12);
    }

    #[test]
    fn many_sides_make_a_disc() {
        // A regular n-gon of circumradius R: I = m R² (2 + cos(2π/n))/6.
        let count = 100_000;
        let turn = 2.0 * core::f64::consts::PI / f64::from(count);
        let corner = |index| {
            let (sin, cos) = Real::sin_cos(turn * f64::from(index));
            [cos, sin]
        };
        let round = uniform(&(0..count).map(corner).collect::<Vec<_>>());
        let (sin, cos) = Real::sin_cos(turn);
        close(round.mass, 0.5 * f64::from(count) * sin, 1e-14);
        close(round.inertia(), round.mass * (2.0 + cos) / 6.0, 1e-14);
    }

    #[test]
    fn concave_polygon_is_the_sum_of_its_parts() {
        let corner =
            uniform(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        let lower = Body::rectangle(3.0, 3.0, 1.0).unwrap().translated([1.5, 0.5]);
        let upper = Body::rectangle(1.0, 1.0, 1.0).unwrap().translated([0.5, 1.5]);
        same(corner, lower + upper, 1e-15);
    }

    #[test]
    fn holes_are_cut_out_in_either_direction() {
        let mut hole = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.75], [0.0, 0.75]];
        let cut = Body::rectangle(0.375, 0.5, 0.75).unwrap().translated([0.25, 0.375]);
        let expected = uniform(&SQUARE).without(cut).unwrap();
        for _ in 0..2 {
            let frame = Polygon::new(&SQUARE).unwrap().hole(&hole).unwrap();
            close(frame.area(), 3.625, 1e-15);
            same(frame.body(1.0).unwrap(), expected, 1e-15);
            hole.reverse();
        }
    }

    #[test]
    fn rings_may_touch() {
        // Two holes that share a side with each other and with the outer ring.
        let comb = Polygon::new(&SQUARE).unwrap();
        let comb = comb.hole(&[[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]]).unwrap();
        let comb = comb.hole(&[[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0]]).unwrap();
        let rest =
            uniform(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [-1.0, 1.0]]);
        same(comb.body(1.0).unwrap(), rest, 1e-15);
        // A ring that touches itself in a point, with a hole as part of the ring.
        let loop_ = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [0.0, 0.0],
            [0.25, -0.5],
            [-0.25, -0.5],
            [0.0, 0.0],
            [-1.0, 1.0],
        ];
        assert!(Polygon::new(&loop_).is_ok());
    }

    #[test]
    fn turned_holes_may_touch_up_to_rounding() {
        let (sin, cos) = Real::sin_cos(0.7_f64);
        let turn = |points: &[[f64; 2]]| -> Vec<_> {
            points
                .iter()
                .map(|[x, y]| [cos * x - sin * y + 100.0, sin * x + cos * y - 100.0])
                .collect()
        };
        let frame = Polygon::new(&turn(&SQUARE)).unwrap();
        let notched =
            frame.hole(&turn(&[[-0.3, 0.2], [0.4, 0.2], [0.4, 1.0], [-0.3, 1.0]])).unwrap();
        close(notched.area(), 4.0 - 0.56, 1e-13);
    }

    #[test]
    fn crossing_edges_are_named() {
        let tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(matches!(
            Polygon::new(&tie),
            Err(BodyError::Crossing { first: (0, 0 | 2), second: (0, 0 | 2) })
        ));
        let uneven = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]];
        assert!(matches!(
            Polygon::new(&uneven),
            Err(BodyError::Crossing { first: (0, 0 | 2), second: (0, 0 | 2) })
        ));
        let square = Polygon::new(&SQUARE).unwrap();
        let across = square.hole(&[[0.5, 0.0], [2.0, 0.5], [0.5, 0.75]]);
        assert!(across.is_err(), "{across:?}");
    }

    #[test]
    fn rings_that_cover_twice_are_refused() {
        let eight = [[0.0, 0.0], [1.0, -1.0], [1.0, 1.0], [0.0, 0.0], [-2.0, -1.0], [-2.0, 1.0]];
        assert!(matches!(Polygon::new(&eight), Err(BodyError::Winding { ring: 0, .. })));
        let twice: Vec<_> = SQUARE.iter().chain(&SQUARE).copied().collect();
        assert!(matches!(Polygon::new(&twice), Err(BodyError::Winding { ring: 0, .. })));
    }

    #[test]
    fn holes_must_lie_inside_and_apart() {
        let square = Polygon::new(&SQUARE).unwrap();
        let outside = moved(&SQUARE, 5.0, 0.0);
        assert_eq!(square.clone().hole(&outside), Err(BodyError::HoleOutside { ring: 1 }));
        assert_eq!(
            square.clone().hole(&moved(&SQUARE, 0.0, 5.0)),
            Err(BodyError::HoleOutside { ring: 1 })
        );
        let around: Vec<_> = SQUARE.iter().map(|point| point.map(|x| 2.0 * x)).collect();
        assert_eq!(square.clone().hole(&around), Err(BodyError::HoleOutside { ring: 1 }));
        let [large, small] = [0.75, 0.25].map(|scale| SQUARE.map(|point| point.map(|x| scale * x)));
        let frame = square.hole(&large).unwrap();
        assert_eq!(frame.hole(&small), Err(BodyError::HoleOutside { ring: 2 }));
    }

    #[test]
    fn a_hole_as_large_as_the_polygon_leaves_nothing() {
        let nothing = |points: &[[f64; 2]]| Polygon::new(points).unwrap().hole(points);
        assert_eq!(nothing(&SQUARE), Err(BodyError::NoMass));
        assert_eq!(nothing(&star(&mut Random::new(8), 11)), Err(BodyError::NoMass));
    }

    #[test]
    fn whatever_is_accepted_is_a_body() {
        // Rings through a small grid. Most of them cross, touch or lie on a line.
        let mut random = Random::new(9);
        let mut accepted = [0; 2];
        for _ in 0..40_000 {
            let mut ring = |most| -> Vec<[f64; 2]> {
                let count = 3 + random.bits() % most;
                (0..count).map(|_| [0; 2].map(|_| (random.bits() % 5) as f64)).collect()
            };
            let (outer, inner) = (ring(4), ring(2));
            let Ok(polygon) = Polygon::new(&outer) else { continue };
            let pierced = polygon.clone().hole(&inner).ok();
            for (index, polygon) in [Some(polygon), pierced].into_iter().flatten().enumerate() {
                accepted[index] += 1;
                let body = polygon.body(1.0).unwrap();
                // Twice the area of a polygon on the grid is an integer; the triangles and the
                // edges give the same area.
                assert_eq!(2.0 * body.mass, (2.0 * body.mass).round());
                close(covered(&polygon), body.mass, 1e-14);
                let found = polygon.quadrature(|_| 1.0, 1e-12).unwrap().body;
                same(found, body, 1e-13);
            }
        }
        assert!(2000 < accepted[0] && 100 < accepted[1], "{accepted:?}");
    }

    #[test]
    fn bad_points_are_refused() {
        assert_eq!(Polygon::new(&[]), Err(BodyError::TooFewPoints { ring: 0, points: 0 }));
        assert_eq!(Polygon::new(&SQUARE[..2]), Err(BodyError::TooFewPoints { ring: 0, points: 2 }));
        let mut points = SQUARE;
        points[2][1] = f64::NAN;
        assert_eq!(Polygon::new(&points), Err(BodyError::NotFinite { ring: 0, index: 2 }));
        let square = Polygon::new(&SQUARE).unwrap();
        assert_eq!(square.clone().hole(&points), Err(BodyError::NotFinite { ring: 1, index: 2 }));
        assert_eq!(
            square.clone().hole(&SQUARE[1..3]),
            Err(BodyError::TooFewPoints { ring: 1, points: 2 })
        );
        for slope in [0.0, 1.0, 0.3] {
            let line = [0.0, 0.1, 0.7, 0.4].map(|x| [1e3 + x, slope * x]);
            assert_eq!(Polygon::new(&line), Err(BodyError::NoArea { ring: 0 }));
        }
        assert_eq!(Polygon::new(&[[1.0, 1.0]; 5]), Err(BodyError::NoArea { ring: 0 }));
        for scale in [1e160, 1e308] {
            assert_eq!(
                Polygon::new(&SQUARE.map(|point| point.map(|x| scale * x))),
                Err(BodyError::OutOfRange)
            );
        }
        for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                square.body(density),
                Err(BodyError::Argument { name: "density", .. })
            ));
        }
    }

    #[test]
    fn inside_is_inside() {
        let frame = Polygon::new(&moved(&SQUARE, 3.0, 0.0))
            .unwrap()
            .hole(&[[2.5, -0.5], [3.5, -0.5], [3.5, 0.5]])
            .unwrap();
        for (point, inside) in [
            ([2.1, 0.0], true),
            ([3.2, 0.0], false),
            ([2.8, 0.3], true),
            ([0.0, 0.0], false),
            ([3.0, 1.5], false),
        ] {
            assert_eq!(frame.contains(point), inside, "{point:?}");
        }
        assert_eq!(frame.bounds(), ([2.0, -1.0], [4.0, 1.0]));
    }

    #[test]
    fn triangles_cover_the_polygon_once() {
        let mut random = Random::new(7);
        for points in 3..40 {
            let star = star(&mut random, points);
            let small: Vec<_> = star.iter().map(|point| point.map(|x| 0.4 * x)).collect();
            let ring = Polygon::new(&star).unwrap().hole(&small).unwrap();
            let area = covered(&ring);
            close(area, ring.area(), 1e-13);
            close(area, 0.84 * Polygon::new(&star).unwrap().area(), 1e-13);
        }
    }
}
