//! Regions bounded by lines and Bézier curves.

use super::sum::Sum;
use super::{Body, BodyError, positive};
use crate::real::Real;

type Point = [f64; 2];

/// Crossings, and pairs of pieces that might cross, are no more than so many.
const CROSSINGS: usize = 1 << 16;
const PAIRS: usize = 1 << 28;

/// Curves coincide that are no farther apart than this part of the whole.
const COINCIDE: f64 = 1e-9;

/// Straight pieces that stand for a curve where crossings and insides are looked for.
const CHORDS: usize = 16;

/// Nodes and weights of the Gauss–Legendre rule of six points on [−1, 1], exact for degree 11; Abramowitz and Stegun (1964), table 25.4.
const GAUSS: [(f64, f64); 3] = [
    (0.238619186083196909, 0.467913934572691047),
    (0.661209386466264514, 0.360761573048138608),
    (0.932469514203152028, 0.171324492379170345),
];

/// A region bounded by closed curves of lines and Bézier curves up to the third degree, which may cross and overlap.
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

/// What is inside of curves that cross or lie within each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// What they go around, counted with the direction.
    #[default]
    NonZero,
    /// What they go around an odd number of times.
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

/// A cubic Bézier curve; a line is one too.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Curve {
    points: [Point; 4],
    straight: bool,
}

/// A straight piece of a curve, from parameter `from` on.
#[derive(Clone, Copy)]
struct Chord {
    ends: [Point; 2],
    ring: usize,
    curve: usize,
    index: usize,
}

impl Outline {
    /// An outline without curves; begin with [`move_to`](Self::move_to).
    pub fn new(rule: FillRule) -> Self {
        Self { rule, rings: Vec::new(), start: [0.0; 2], at: [0.0; 2] }
    }

    /// Begins another closed run at a point, in metres from the pivot; the one before is closed by a line.
    #[must_use]
    pub fn move_to(mut self, to: Point) -> Self {
        self = self.closed();
        self.rings.push(Vec::new());
        (self.start, self.at) = (to, to);
        self
    }

    /// A line.
    #[must_use]
    pub fn line_to(self, to: Point) -> Self {
        let from = self.at;
        let third = |part: f64| [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        self.with([from, third(1.0 / 3.0), third(2.0 / 3.0), to], true)
    }

    /// A quadratic Bézier curve.
    #[must_use]
    pub fn quad_to(self, control: Point, to: Point) -> Self {
        let from = self.at;
        let toward = |end: Point| [0, 1].map(|axis| end[axis] + 2.0 / 3.0 * (control[axis] - end[axis]));
        self.with([from, toward(from), toward(to), to], false)
    }

    /// A cubic Bézier curve.
    #[must_use]
    pub fn cubic_to(self, first: Point, second: Point, to: Point) -> Self {
        let from = self.at;
        self.with([from, first, second, to], false)
    }

    /// The body of uniform `density` in kg/m².
    ///
    /// Green's theorem turns the moments into integrals along the curves, ∫x dA = ½∮x² dy and so on, which Gauss's rule of six
    /// points gives exactly up to rounding. Where curves cross they are cut, and each piece counts as the fill rule says for both
    /// of its sides. Two crossings of the same curves less than a sixteenth of a curve apart may be overlooked; what is wrong
    /// then is less than the sliver between them.
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
        // Coordinates come rounded; an area that this alone can make is none.
        let least = 4.0 * count as f64 * f64::EPSILON * extent * radius;
        let area = first[0];
        if area.abs() <= least {
            return Err(BodyError::NoArea { ring: 0 });
        }
        let center = [first[1] / area, first[2] / area];
        let [area, _, _, xx, xy, yy] = integrals(&pieces, center);
        let central = [xx, xy, yy].map(|moment| density * moment);
        Body { mass: density * area, center: [origin[0] + center[0], origin[1] + center[1]], central }.checked()
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

    /// The curves between all crossings with what lies to their left more than to their right: −1, 0 or 1.
    fn boundary(&self, slack: f64) -> Result<Vec<(Curve, f64)>, BodyError> {
        let cuts = self.cuts()?;
        // Runs of curves without a cut within, each with one answer.
        let mut runs: Vec<Vec<Curve>> = Vec::new();
        for (ring, cuts) in self.rings.iter().zip(&cuts) {
            runs.push(Vec::new());
            for (curve, cuts) in ring.iter().zip(cuts) {
                let mut from = 0.0;
                for &cut in cuts {
                    let last = runs.len() - 1;
                    if from < cut {
                        runs[last].push(curve.part(from, cut));
                    }
                    runs.push(Vec::new());
                    from = cut;
                }
                let last = runs.len() - 1;
                if from < 1.0 {
                    runs[last].push(curve.part(from, 1.0));
                }
            }
        }
        let chords: Vec<Vec<[Point; 2]>> = runs.iter().map(|run| run.iter().flat_map(Curve::chords).collect()).collect();
        let all: Vec<[Point; 2]> = chords.iter().flatten().copied().collect();
        let strips = [Strips::new(&all, 1), Strips::new(&all, 0)];
        let mut boundary = Vec::new();
        let mut before = 0;
        for (index, run) in runs.iter().enumerate() {
            let length = |chord: &[Point; 2]| {
                let [x, y] = [chord[1][0] - chord[0][0], chord[1][1] - chord[0][1]];
                x * x + y * y
            };
            let Some(longest) =
                (0..chords[index].len()).max_by(|&a, &b| length(&chords[index][a]).total_cmp(&length(&chords[index][b])))
            else {
                continue;
            };
            let right = winding_to_the_right(before + longest, chords[index][longest], &strips, slack);
            before += chords[index].len();
            let sides = [right + 1, right].map(|winding| i32::from(self.rule.inside(winding)));
            let weight = f64::from(sides[0] - sides[1]);
            boundary.extend(run.iter().map(|&curve| (curve, weight)));
        }
        Ok(boundary)
    }

    /// The parameters at which each curve of each ring is crossed, in order.
    fn cuts(&self) -> Result<Vec<Vec<Vec<f64>>>, BodyError> {
        let mut cuts: Vec<Vec<Vec<f64>>> = self.rings.iter().map(|ring| vec![Vec::new(); ring.len()]).collect();
        let mut chords = Vec::new();
        for (ring, curves) in self.rings.iter().enumerate() {
            for (curve, shape) in curves.iter().enumerate() {
                chords.extend(shape.chords().enumerate().map(|(index, ends)| Chord { ends, ring, curve, index }));
            }
        }
        let left = |chord: &Chord| Real::min(chord.ends[0][0], chord.ends[1][0]);
        let right = |chord: &Chord| Real::max(chord.ends[0][0], chord.ends[1][0]);
        chords.sort_by(|a, b| left(a).total_cmp(&left(b)));
        let [mut pairs, mut crossings] = [0, 0];
        for (k, one) in chords.iter().enumerate() {
            if PAIRS < pairs {
                return Err(BodyError::Tangled { pairs: PAIRS });
            }
            for other in chords[k + 1..].iter().take_while(|other| left(other) <= right(one)) {
                pairs += 1;
                let together = (one.ring, one.curve) == (other.ring, other.curve);
                if together && one.index.abs_diff(other.index) <= 1 {
                    continue;
                }
                let Some(at) = crossing(&one.ends, &other.ends) else { continue };
                crossings += 1;
                if CROSSINGS < crossings {
                    return Err(BodyError::Tangled { pairs: CROSSINGS });
                }
                let curves = [one, other].map(|chord| &self.rings[chord.ring][chord.curve]);
                let guess = [(one, at[0]), (other, at[1])]
                    .map(|(chord, at)| (chord.index as f64 + at) / self.rings[chord.ring][chord.curve].count() as f64);
                let found = refined(curves, guess);
                let ends = found.map(|parameter| {
                    if parameter <= 1e-9 {
                        0.0
                    } else if 1.0 - 1e-9 <= parameter {
                        1.0
                    } else {
                        parameter
                    }
                });
                // Where a curve goes on in the next nothing is crossed; where another passes through its end something is.
                let count = self.rings[one.ring].len();
                let goes_on = |from: usize, to: usize| ends[from] == 1.0 && ends[to] == 0.0;
                let next = |from: &Chord, to: &Chord| from.ring == to.ring && (from.curve + 1) % count == to.curve;
                if next(one, other) && goes_on(0, 1) || next(other, one) && goes_on(1, 0) {
                    continue;
                }
                for (chord, parameter) in [one, other].into_iter().zip(ends) {
                    cuts[chord.ring][chord.curve].push(parameter);
                }
            }
        }
        for cuts in cuts.iter_mut().flatten() {
            cuts.sort_by(f64::total_cmp);
            cuts.dedup_by(|later, earlier| *later - *earlier < 1e-9);
        }
        Ok(cuts)
    }
}

impl Curve {
    fn count(&self) -> usize {
        if self.straight { 1 } else { CHORDS }
    }

    fn at(&self, t: f64) -> Point {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        [0, 1].map(|k| s * s * (s * a[k] + 3.0 * t * b[k]) + t * t * (3.0 * s * c[k] + t * d[k]))
    }

    fn slope(&self, t: f64) -> Point {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        [0, 1].map(|k| 3.0 * (s * s * (b[k] - a[k]) + 2.0 * s * t * (c[k] - b[k]) + t * t * (d[k] - c[k])))
    }

    fn chords(&self) -> impl Iterator<Item = [Point; 2]> {
        let count = self.count();
        let point = move |index: usize| match index {
            0 => self.points[0],
            _ if index == count => self.points[3],
            _ => self.at(index as f64 / count as f64),
        };
        (0..count).map(move |index| [point(index), point(index + 1)])
    }

    /// The part between two parameters: de Casteljau (1959) in blossom form.
    fn part(&self, from: f64, to: f64) -> Self {
        if from == 0.0 && to == 1.0 {
            return *self;
        }
        let blossom = |parameters: [f64; 3]| {
            let mut points = self.points;
            for (level, t) in parameters.into_iter().enumerate() {
                for k in 0..3 - level {
                    points[k] = [0, 1].map(|axis| points[k][axis] + t * (points[k + 1][axis] - points[k][axis]));
                }
            }
            points[0]
        };
        let points = [[from, from, from], [from, from, to], [from, to, to], [to, to, to]].map(blossom);
        Self { points, ..*self }
    }
}

/// Where two chords cross, as shares of both; ends count.
fn crossing(one: &[Point; 2], other: &[Point; 2]) -> Option<[f64; 2]> {
    let [low, high] =
        [Real::min, Real::max].map(|pick: fn(f64, f64) -> f64| [one, other].map(|ends| pick(ends[0][1], ends[1][1])));
    if high[0] < low[1] || high[1] < low[0] {
        return None;
    }
    let along = |ends: &[Point; 2]| [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let cross = |a: Point, b: Point| a[0] * b[1] - a[1] * b[0];
    let (u, v) = (along(one), along(other));
    let between = [other[0][0] - one[0][0], other[0][1] - one[0][1]];
    let area = cross(u, v);
    let size = Real::sqrt((u[0] * u[0] + u[1] * u[1]) * (v[0] * v[0] + v[1] * v[1]));
    if area.abs() <= 1e-12 * size {
        return None;
    }
    let at = [cross(between, v) / area, cross(between, u) / area];
    at.iter().all(|share| (-1e-9..=1.0 + 1e-9).contains(share)).then_some(at)
}

/// The parameters at which two curves meet, near the crossing of their chords, by Newton's method.
fn refined(curves: [&Curve; 2], guess: [f64; 2]) -> [f64; 2] {
    let mut at = guess;
    for _ in 0..8 {
        let (p, q) = (curves[0].at(at[0]), curves[1].at(at[1]));
        let (u, v) = (curves[0].slope(at[0]), curves[1].slope(at[1]));
        let apart = [q[0] - p[0], q[1] - p[1]];
        let area = u[0] * v[1] - u[1] * v[0];
        let step = [(apart[0] * v[1] - apart[1] * v[0]) / area, (apart[0] * u[1] - apart[1] * u[0]) / area];
        let next = [at[0] + step[0], at[1] + step[1]];
        // Curves that touch have no single crossing; the chords' stands then.
        if !(0..2).all(|k| (next[k] - guess[k]).abs() < 2.0 / CHORDS as f64) {
            return guess;
        }
        at = next;
    }
    at
}

/// Which chords a line along the other axis may meet: by strips across one axis.
struct Strips {
    low: f64,
    /// Strips a metre.
    scale: f64,
    /// The chords that reach into each strip, with their numbers.
    chords: Vec<Vec<(usize, [Point; 2])>>,
}

impl Strips {
    fn new(chords: &[[Point; 2]], axis: usize) -> Self {
        let values = || chords.iter().flatten().map(|point| point[axis]);
        let (low, high) = (values().fold(f64::INFINITY, Real::min), values().fold(f64::NEG_INFINITY, Real::max));
        // A chord as long as everything stands in all of them.
        let count = 1 + 2 * Real::sqrt(chords.len() as f64) as usize;
        let scale = count as f64 / (high - low);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let mut strips = Self { low, scale, chords: vec![Vec::new(); count] };
        for (number, chord) in chords.iter().enumerate() {
            let [a, b] = chord.map(|point| strips.strip(point[axis]));
            for strip in &mut strips.chords[if a < b { a..=b } else { b..=a }] {
                strip.push((number, *chord));
            }
        }
        strips
    }

    /// Rounds the same way for a chord and what is asked of it.
    fn strip(&self, value: f64) -> usize {
        let place = (value - self.low) * self.scale;
        (place as usize).min(self.chords.len() - 1)
    }

    fn at(&self, value: f64) -> &[(usize, [Point; 2])] {
        &self.chords[self.strip(value)]
    }
}

/// How often curves wind around what lies to the right of the middle of chord `number`: their crossings with a ray, for
/// which the strips across y and across x are asked; what is nearer than `slack` coincides.
fn winding_to_the_right(number: usize, own: [Point; 2], strips: &[Strips; 2], slack: f64) -> i32 {
    let [x, y] = [0, 1].map(|axis| 0.5 * (own[0][axis] + own[1][axis]));
    // Chords that coincide are asked along one axis, whatever their rounding: no drawing has lines of just this slope.
    let steep = (own[1][0] - own[0][0]).abs() <= 0.7310585786 * (own[1][1] - own[0][1]).abs();
    let mut winding = 0;
    let met = if steep { strips[0].at(y) } else { strips[1].at(x) };
    for &(other, [from, to]) in met.iter().filter(|(other, _)| *other != number) {
        // The ray leads along x, or along y with the axes turned by a quarter.
        let (from, to, x, y) = if steep { (from, to, x, y) } else { ([from[1], -from[0]], [to[1], -to[0]], y, -x) };
        if (from[1] <= y) == (to[1] <= y) {
            continue;
        }
        let at = from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]);
        // Those that coincide lie as if each were a little beyond the one before.
        if if (x - at).abs() <= slack { number < other } else { x < at } {
            winding += if from[1] <= y { 1 } else { -1 };
        }
    }
    // The ray starts at the chord itself: on its right side if the chord leads up the ray's left.
    let up = if steep { own[0][1] < own[1][1] } else { own[1][0] < own[0][0] };
    if up { winding } else { winding - 1 }
}

/// Area, ∫x, ∫y, ∫x², ∫xy and ∫y² about a point.
fn integrals(boundary: &[(Curve, f64)], [cx, cy]: Point) -> [f64; 6] {
    let mut sums = [Sum::default(); 6];
    for (curve, weight) in boundary {
        for (node, share) in GAUSS.iter().flat_map(|&(node, share)| [(-node, share), (node, share)]) {
            let t = 0.5 + 0.5 * node;
            let ([x, y], [dx, dy]) = (curve.at(t), curve.slope(t));
            let [x, y] = [x - cx, y - cy];
            let scale = 0.5 * share * weight;
            sums[0].add(scale * 0.5 * (x * dy - y * dx));
            sums[1].add(scale * 0.5 * x * x * dy);
            sums[2].add(-scale * 0.5 * y * y * dx);
            sums[3].add(scale * x * x * x * dy / 3.0);
            sums[4].add(scale * 0.5 * x * x * y * dy);
            sums[5].add(-scale * y * y * y * dx / 3.0);
        }
    }
    sums.map(Sum::value)
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::super::tests::{close, same};
    use super::super::{Body, BodyError, Polygon};
    use super::{FillRule, Outline, Point};
    use crate::real::Real;
    use core::f64::consts::PI;

    fn ring(outline: Outline, points: &[Point]) -> Outline {
        points[1..].iter().fold(outline.move_to(points[0]), |outline, &point| outline.line_to(point))
    }

    fn square(outline: Outline, [x, y]: Point, half: f64, turn: bool) -> Outline {
        let mut corners = [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[a, b]| [x + a, y + b]);
        if turn {
            corners.reverse();
        }
        ring(outline, &corners)
    }

    fn both(draw: impl Fn(Outline) -> Outline) -> [f64; 2] {
        [FillRule::NonZero, FillRule::EvenOdd].map(|rule| draw(Outline::new(rule)).body(1.0).unwrap().mass)
    }

    #[test]
    fn lines_are_polygons() {
        let mut random = Random::new(3);
        for _ in 0..100 {
            let count = 3 + (random.bits() % 9) as usize;
            let mut points: Vec<Point> = (0..count)
                .map(|k| {
                    let (sin, cos) = Real::sin_cos(2.0 * PI * (k as f64 + 0.9 * random.unit()) / count as f64);
                    let radius = 0.3 + random.unit();
                    [3.0 + radius * cos, -7.0 + radius * sin]
                })
                .collect();
            let Ok(polygon) = Polygon::new(&points) else { continue };
            let expected = polygon.body(2.0).unwrap();
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                same(ring(Outline::new(rule), &points).body(2.0).unwrap(), expected, 1e-13);
                points.reverse();
            }
        }
    }

    /// A segment of a parabola, y from x² to 1: 4/3, its centre at 3/5, ∫x² = 4/15, ∫y² = 4/7.
    #[test]
    fn a_parabola_is_exact() {
        let outline = Outline::new(FillRule::NonZero).move_to([-1.0, 1.0]).quad_to([0.0, -1.0], [1.0, 1.0]);
        let body = outline.body(3.0).unwrap();
        close(body.mass, 4.0, 1e-15);
        close(body.center[1], 0.6, 1e-15);
        let [xx, xy, yy] = body.moments();
        close(xx, 3.0 * 4.0 / 15.0, 1e-15);
        close(yy, 3.0 * 4.0 / 7.0, 1e-15);
        assert!(xy.abs() < 1e-15);
    }

    /// The usual circle of four cubics is a circle within 2.7e-4; a fine polygon through its points agrees better.
    #[test]
    fn cubics_agree_with_fine_polygons() {
        let k = 0.5522847498307936;
        let circle = Outline::new(FillRule::NonZero)
            .move_to([1.0, 0.0])
            .cubic_to([1.0, k], [k, 1.0], [0.0, 1.0])
            .cubic_to([-k, 1.0], [-1.0, k], [-1.0, 0.0])
            .cubic_to([-1.0, -k], [-k, -1.0], [0.0, -1.0])
            .cubic_to([k, -1.0], [1.0, -k], [1.0, 0.0]);
        let body = circle.body(1.0).unwrap();
        close(body.mass, PI, 3e-4);
        close(body.inertia(), PI / 2.0, 6e-4);
        let polygon = |count: usize| {
            let points: Vec<Point> = circle.rings[0]
                .iter()
                .flat_map(|curve| (0..count).map(move |index| curve.at(index as f64 / count as f64)))
                .collect();
            Polygon::new(&points).unwrap().body(1.0).unwrap()
        };
        // Chords lose area in proportion to the square of their length; extrapolated, the loss of two lengths is gone.
        let (coarse, fine) = (polygon(200), polygon(400));
        close(body.mass, (4.0 * fine.mass - coarse.mass) / 3.0, 1e-10);
        close(body.inertia(), (4.0 * fine.inertia() - coarse.inertia()) / 3.0, 1e-10);
    }

    #[test]
    fn holes_follow_the_fill_rule() {
        let hole = |turn: bool| move |outline| square(square(outline, [0.0; 2], 1.0, false), [0.2, 0.1], 0.5, turn);
        assert_eq!(both(hole(true)).map(|mass| (mass * 1e9).round()), [3e9; 2]);
        assert_eq!(both(hole(false)).map(|mass| (mass * 1e9).round()), [4e9, 3e9]);
        let frame = hole(true)(Outline::new(FillRule::NonZero)).body(1.0).unwrap();
        let expected = Body::rectangle(4.0, 2.0, 2.0).unwrap();
        same(frame, expected.without(Body::rectangle(1.0, 1.0, 1.0).unwrap().translated([0.2, 0.1])).unwrap(), 1e-14);
    }

    #[test]
    fn overlaps_count_once_or_not_at_all() {
        // Two squares of four that share one, run either way.
        for turn in [false, true] {
            let masses = both(|outline| square(square(outline, [0.0; 2], 1.0, false), [1.0, 1.0], 1.0, turn));
            // In opposite directions, what both go around is gone around zero times.
            close(masses[0], if turn { 6.0 } else { 7.0 }, 1e-14);
            close(masses[1], 6.0, 1e-14);
        }
        // A pentagram, whose middle it goes around twice.
        let star: Vec<Point> = (0..5)
            .map(|k| {
                let (sin, cos) = Real::sin_cos(0.8 * PI * f64::from(k));
                [sin, cos]
            })
            .collect();
        let masses = both(|outline| ring(outline, &star));
        let tan = |degrees: f64| Real::tan(degrees * PI / 180.0);
        let inner = Real::cos(0.4 * PI) / Real::cos(0.2 * PI);
        let pentagon = 2.5 * Real::sin(0.4 * PI) * inner * inner;
        // Five points on sides of the pentagon, each a triangle of base angle 72°.
        let side = 2.0 * inner * Real::sin(0.2 * PI);
        let points = 5.0 * side * side / 4.0 * tan(72.0);
        close(masses[0], pentagon + points, 1e-14);
        close(masses[1], points, 1e-14);
        // A figure of eight, whose halves run in opposite directions.
        let eight = both(|outline| ring(outline, &[[-1.0, -1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0]]));
        close(eight[0], 2.0, 1e-14);
        close(eight[1], 2.0, 1e-14);
    }

    /// Two discs of radius 1 whose centres are 1 apart: a lens of 2π/3 − √3/2.
    #[test]
    fn curves_that_cross_are_cut() {
        let disc = |outline: Outline, x: f64| {
            // Sixteen arcs of cubics, which are a circle within 10⁻⁸.
            let step = PI / 8.0;
            let k = 4.0 / 3.0 * Real::tan(step / 4.0);
            let on = |angle: f64| Real::sin_cos(angle);
            (0..16).fold(outline.move_to([x + 1.0, 0.0]), |outline, arc| {
                let ((s0, c0), (s1, c1)) = (on(step * f64::from(arc)), on(step * f64::from(arc + 1)));
                let end = if arc == 15 { [x + 1.0, 0.0] } else { [x + c1, s1] };
                outline.cubic_to([x + c0 - k * s0, s0 + k * c0], [x + c1 + k * s1, s1 - k * c1], end)
            })
        };
        let lens = 2.0 * PI / 3.0 - Real::sqrt(3.0) / 2.0;
        let masses = both(|outline| disc(disc(outline, 0.0), 1.0));
        close(masses[0], 2.0 * PI - lens, 1e-7);
        close(masses[1], 2.0 * PI - 2.0 * lens, 1e-7);
        // A loop of a single cubic: in and out once.
        let looped = |outline: Outline| outline.move_to([0.0, 0.0]).cubic_to([3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]);
        let [union, parity] = both(looped);
        close(union, parity, 1e-13);
    }

    /// Rectangles on a grid share edges, parts of edges and corners; what they cover is counted by cells.
    #[test]
    fn edges_may_coincide() {
        let mut random = Random::new(5);
        for case in 0..300 {
            let count = 2 + case % 5;
            let mut pick = |below: u64| (random.bits() % below) as usize;
            let mut windings = [[0i32; 8]; 8];
            let mut corners = Vec::new();
            for _ in 0..count {
                let [left, low] = [pick(7), pick(7)];
                let [right, high] =
                    [left + 1 + pick(7 - left as u64 + 1).min(7 - left), low + 1 + pick(7 - low as u64 + 1).min(7 - low)];
                let back = pick(2) == 1;
                for row in &mut windings[low..high] {
                    row[left..right].iter_mut().for_each(|cell| *cell += if back { -1 } else { 1 });
                }
                let mut ring = [[left, low], [right, low], [right, high], [left, high]];
                if back {
                    ring.reverse();
                }
                ring.rotate_left(pick(4));
                corners.push(ring);
            }
            // As it is, by an eighth of a turn and by an odd angle.
            for [cos, sin] in [[1.0, 0.0], [0.7, 0.7], [0.3, -0.9]] {
                let at = |[x, y]: [usize; 2]| [cos * x as f64 - sin * y as f64, sin * x as f64 + cos * y as f64];
                for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                    let cells = windings.iter().flatten().filter(|&&winding| rule.inside(winding)).count();
                    let outline = corners.iter().fold(Outline::new(rule), |outline, corners| ring(outline, &corners.map(at)));
                    match outline.body(1.0) {
                        Ok(body) => close(body.mass, cells as f64 * (cos * cos + sin * sin), 1e-12),
                        Err(error) => assert_eq!((cells, error), (0, BodyError::NoArea { ring: 0 }), "{corners:?}"),
                    }
                }
            }
        }
    }

    /// The same curve twice, either way, and two leaves with a curve in common.
    #[test]
    fn curves_may_coincide() {
        let leaf = |outline: Outline| {
            outline.move_to([0.0, 0.0]).cubic_to([2.0, 1.0], [-1.0, 3.0], [0.0, 4.0]).quad_to([-3.0, 2.0], [0.0, 0.0])
        };
        let back = |outline: Outline| {
            outline.move_to([0.0, 0.0]).quad_to([-3.0, 2.0], [0.0, 4.0]).cubic_to([-1.0, 3.0], [2.0, 1.0], [0.0, 0.0])
        };
        let beside = |outline: Outline| {
            outline.move_to([0.0, 4.0]).cubic_to([-1.0, 3.0], [2.0, 1.0], [0.0, 0.0]).quad_to([5.0, 2.0], [0.0, 4.0])
        };
        let one = leaf(Outline::new(FillRule::NonZero)).body(1.0).unwrap().mass;
        let other = beside(Outline::new(FillRule::NonZero)).body(1.0).unwrap().mass;
        close(leaf(leaf(Outline::new(FillRule::NonZero))).body(1.0).unwrap().mass, one, 1e-13);
        assert_eq!(leaf(back(Outline::new(FillRule::NonZero))).body(1.0), Err(BodyError::NoArea { ring: 0 }));
        assert_eq!(leaf(leaf(Outline::new(FillRule::EvenOdd))).body(1.0), Err(BodyError::NoArea { ring: 0 }));
        for mass in both(|outline| beside(leaf(outline))) {
            close(mass, one + other, 1e-13);
        }
    }

    /// A grid of bars, each over all the others, and a scribble that nobody can count.
    #[test]
    fn many_crossings_are_counted_and_too_many_refused() {
        let bars = |outline: Outline| {
            (0..60).fold(outline, |outline, bar| {
                let (from, to) = (f64::from(bar), f64::from(bar) + 0.5);
                let outline = ring(outline, &[[from, -1.0], [to, -1.0], [to, 61.0], [from, 61.0]]);
                ring(outline, &[[-1.0, from], [61.0, from], [61.0, to], [-1.0, to]])
            })
        };
        let masses = both(bars);
        close(masses[0], 60.0 * 62.0 - 900.0, 1e-12);
        close(masses[1], 60.0 * 62.0 - 1800.0, 1e-12);
        let mut random = Random::new(8);
        let points: Vec<Point> = (0..1500).map(|_| [random.unit(), random.unit()]).collect();
        assert_eq!(ring(Outline::new(FillRule::EvenOdd), &points).body(1.0), Err(BodyError::Tangled { pairs: super::CROSSINGS }));
    }

    #[test]
    fn direction_and_place_do_not_matter() {
        let drawn = |[x, y]: Point| {
            let at = |p: Point| [p[0] + x, p[1] + y];
            Outline::new(FillRule::NonZero)
                .move_to(at([0.0, 0.0]))
                .cubic_to(at([2.0, 0.5]), at([2.0, -3.0]), at([0.0, -4.0]))
                .quad_to(at([-1.5, -2.0]), at([-0.5, -1.0]))
        };
        let near = drawn([0.0; 2]).body(1.0).unwrap();
        // Multiples of 2⁻²⁰ stay exact at 10⁴.
        let far = drawn([8192.0, -4096.0]).body(1.0).unwrap();
        same(far.with_pivot([8192.0, -4096.0]), near, 1e-11);
        let back = Outline::new(FillRule::EvenOdd)
            .move_to([0.0, 0.0])
            .line_to([-0.5, -1.0])
            .quad_to([-1.5, -2.0], [0.0, -4.0])
            .cubic_to([2.0, -3.0], [2.0, 0.5], [0.0, 0.0]);
        same(back.body(1.0).unwrap(), near, 1e-14);
    }

    #[test]
    fn outlines_without_area_are_refused() {
        let none = Outline::new(FillRule::NonZero);
        assert_eq!(none.body(1.0), Err(BodyError::NoMass));
        assert_eq!(none.clone().move_to([1.0, 2.0]).body(1.0), Err(BodyError::NoMass));
        let line = none.clone().move_to([1.0, 2.0]).line_to([3.0, 5.0]);
        assert_eq!(line.body(1.0), Err(BodyError::NoArea { ring: 0 }));
        let there_and_back = none.clone().move_to([1.0, 2.0]).cubic_to([3.0, 5.0], [3.0, 5.0], [1.0, 2.0]);
        assert_eq!(there_and_back.body(1.0), Err(BodyError::NoArea { ring: 0 }));
        let lost = none.move_to([0.0, 0.0]).line_to([f64::NAN, 1.0]).line_to([1.0, 0.0]);
        assert_eq!(lost.body(1.0), Err(BodyError::NotFinite { ring: 0, index: 1 }));
        assert!(matches!(lost.body(-1.0), Err(BodyError::NotPositive { .. })));
    }
}
