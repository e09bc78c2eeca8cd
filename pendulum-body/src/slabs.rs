//! Triangulation of polygons, with checks that their rings are valid.

use pendulum_core::body::BodyError;

/// A point in the plane.
pub(super) type Point = [f64; 2];
/// A triangle, given by its corners.
pub(super) type Triangle = [Point; 3];

/// A closed ring of points; the last point is joined to the first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ring {
    /// The points relative to a local origin.
    pub(super) points: Vec<Point>,
    /// 1 if the inside is to the left of the ring, −1 if it is to the right.
    pub(super) sign: f64,
}

impl Ring {
    /// Returns the edges from each point to the next.
    pub(super) fn edges(&self) -> impl Iterator<Item = (Point, Point)> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().copied().zip(next.copied())
    }
}

/// An edge that is not vertical, from left to right.
struct Edge {
    left: Point,
    right: Point,
    /// 1 if the inside is above the edge, −1 if it is below.
    turn: i32,
    ring: usize,
    index: usize,
}

impl Edge {
    /// Returns the height at `x`, exact at the ends.
    fn at(&self, x: f64) -> f64 {
        if x <= self.left[0] {
            self.left[1]
        } else if self.right[0] <= x {
            self.right[1]
        } else {
            let part = (x - self.left[0]) / (self.right[0] - self.left[0]);
            self.left[1] + part * (self.right[1] - self.left[1])
        }
    }
}

/// An edge in one slab, with its heights at both sides of the slab.
struct Crosser<'a> {
    edge: &'a Edge,
    left: f64,
    right: f64,
}

/// Divides the inside of `rings` into triangles, by a sweep from left to right over the vertical
/// slabs between neighbouring points.
///
/// The first ring is the outer ring. Returns an error if edges cross, or if the winding number of a
/// region is neither 0 nor 1. Edges may touch up to rounding errors of `size`, the largest
/// coordinate.
pub(super) fn triangles(rings: &[Ring], size: f64) -> Result<Vec<Triangle>, BodyError> {
    let slack = 64.0 * f64::EPSILON * size;
    let mut edges = edges(rings);
    edges.sort_by(|a, b| a.left[0].total_cmp(&b.left[0]));
    let mut stops: Vec<f64> =
        rings.iter().flat_map(|ring| ring.points.iter().map(|point| point[0])).collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();

    let mut triangles = Vec::new();
    let mut waiting = edges.iter().peekable();
    let mut active: Vec<&Edge> = Vec::new();
    for slab in stops.windows(2) {
        let (x0, x1) = (slab[0], slab[1]);
        active.retain(|edge| x0 < edge.right[0]);
        while let Some(edge) = waiting.next_if(|edge| edge.left[0] <= x0) {
            active.push(edge);
        }
        let mut slab: Vec<_> = active
            .iter()
            .map(|edge| Crosser { edge, left: edge.at(x0), right: edge.at(x1) })
            .collect();
        slab.sort_by(|a, b| (a.left + a.right).total_cmp(&(b.left + b.right)));

        let mut winding = 0;
        for pair in slab.windows(2) {
            let (below, above) = (&pair[0], &pair[1]);
            winding += below.edge.turn;
            let (left, right) = (above.left - below.left, above.right - below.right);
            if left < -slack || right < -slack {
                let [first, second] =
                    [below, above].map(|crosser| (crosser.edge.ring, crosser.edge.index));
                return Err(BodyError::Crossing { first, second });
            }
            if left <= slack && right <= slack {
                continue;
            }
            match winding {
                0 => {}
                1 => {
                    let (a, b) = ([x0, below.left], [x1, below.right]);
                    let (c, d) = ([x1, above.right], [x0, above.left]);
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
                _ if 0 < below.edge.ring => {
                    return Err(BodyError::HoleOutside { ring: below.edge.ring });
                }
                _ => return Err(BodyError::Winding { ring: 0, index: below.edge.index }),
            }
        }
    }
    Ok(triangles)
}

fn edges(rings: &[Ring]) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        let inwards = if points.sign < 0.0 { -1 } else { 1 };
        for (index, (from, to)) in points.edges().enumerate() {
            if from[0] < to[0] {
                edges.push(Edge { left: from, right: to, turn: inwards, ring, index });
            } else if to[0] < from[0] {
                edges.push(Edge { left: to, right: from, turn: -inwards, ring, index });
            }
        }
    }
    edges
}
