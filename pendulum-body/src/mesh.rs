//! Solids with a surface of triangles.

use super::sum::Sum;
use crate::positive;
use pendulum_core::body::{BodyError, Solid};
use std::collections::BTreeMap;

/// A closed surface of triangles in space, such as an exported part of a CAD program.
///
/// The corners of each triangle are listed counter-clockwise as seen from outside. Every edge
/// belongs to as many triangles in one direction as in the other. There may be several parts and
/// cavities, whose triangles are seen from inside them; parts that overlap count several times.
///
/// ```
/// use pendulum_runtime::body::{BodyError, Mesh};
/// # fn main() -> Result<(), BodyError> {
/// let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let corner = Mesh::new(&points, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let solid = corner.solid(6.0)?;
/// assert!((solid.mass - 1.0).abs() < 1e-15);
/// assert!((solid.center[0] - 0.25).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// A point close to the mesh. Local coordinates keep their accuracy far from the origin.
    near: [f64; 3],
    /// The corners of each triangle, relative to that point.
    triangles: Vec<[[f64; 3]; 3]>,
}

impl Mesh {
    /// Creates a mesh from its points in metres and the numbers of the points of each triangle.
    ///
    /// # Errors
    /// If a point is not finite or missing, if the triangles do not close a surface, if their
    /// corners are listed clockwise as seen from outside, or if they enclose no volume.
    pub fn new(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, BodyError> {
        let fault = |triangle, fault| BodyError::Triangle { triangle, fault };
        let mut corners = Vec::with_capacity(triangles.len());
        for (triangle, numbers) in triangles.iter().enumerate() {
            let [a, b, c] = numbers.map(|number| points.get(number as usize).copied());
            let (Some(a), Some(b), Some(c)) = (a, b, c) else {
                return Err(fault(triangle, "has the number of a point that does not exist"));
            };
            if [a, b, c].iter().flatten().any(|part| !part.is_finite()) {
                return Err(fault(triangle, "has a point that is infinite or not a number"));
            }
            corners.push([a, b, c]);
        }
        closed(triangles)?;
        let bound = |start: f64, choose: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|k| corners.iter().flatten().map(|at| at[k]).fold(start, choose))
        };
        let (low, high) = (bound(f64::INFINITY, f64::min), bound(f64::NEG_INFINITY, f64::max));
        if corners.is_empty() {
            return Err(BodyError::NoMass);
        }
        let near = [0, 1, 2].map(|k| 0.5 * low[k] + 0.5 * high[k]);
        let triangles = corners.iter().map(|triangle| triangle.map(|at| apart(at, near)));
        let mesh = Self { near, triangles: triangles.collect() };
        let volume = mesh.volume();
        // Coordinates are rounded, so a volume of the size of the rounding errors counts as none.
        let far = |at: &[f64; 3]| at.iter().fold(0.0, |far: f64, part| far.max(part.abs()));
        let radius = mesh.triangles.iter().flatten().map(far).fold(0.0, f64::max);
        let extent = radius + far(&near);
        let least = 4.0 * mesh.triangles.len() as f64 * f64::EPSILON * extent * radius * radius;
        if !volume.is_finite() || !least.is_finite() {
            return Err(BodyError::OutOfRange);
        }
        if volume <= least {
            return Err(BodyError::Argument {
                name: "volume of the mesh",
                value: volume,
                required: "positive, with corners counter-clockwise as seen from outside",
            });
        }
        Ok(mesh)
    }

    /// Creates a mesh from triangles that are given by their corners in metres, as in an STL file.
    /// Corners are the same point if they are equal.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_triangles(triangles: &[[[f64; 3]; 3]]) -> Result<Self, BodyError> {
        let (mut points, mut numbers) = (Vec::new(), BTreeMap::new());
        let mut number = |at: [f64; 3]| {
            // Both zeros are equal.
            *numbers.entry(at.map(|part| (part + 0.0).to_bits())).or_insert_with(|| {
                points.push(at);
                points.len() as u32 - 1
            })
        };
        let triangles: Vec<_> = triangles.iter().map(|corners| corners.map(&mut number)).collect();
        Self::new(&points, &triangles)
    }

    /// Returns the volume in m³.
    pub fn volume(&self) -> f64 {
        let mut sum = Sum::default();
        for &triangle in &self.triangles {
            sum.add(spat(triangle) / 6.0);
        }
        sum.value()
    }

    /// Returns the solid of uniform `density` in kg/m³.
    ///
    /// Sums over the tetrahedra from a point to the triangles, with the moments of Tonon (2004):
    /// first for the centre, relative to a point close to the mesh, then for the second moments
    /// about the centre.
    pub fn solid(&self, density: f64) -> Result<Solid, BodyError> {
        let density = positive("density", density)?;
        let mut sums = [Sum::default(); 3];
        for &triangle in &self.triangles {
            let [a, b, c] = triangle;
            let weight = spat(triangle) / 24.0;
            for (k, sum) in sums.iter_mut().enumerate() {
                sum.add(weight * (a[k] + b[k] + c[k]));
            }
        }
        let volume = self.volume();
        let center = sums.map(|sum| sum.value() / volume);

        let mut sums = [Sum::default(); 6];
        for &triangle in &self.triangles {
            let triangle = triangle.map(|at| apart(at, center));
            let [a, b, c] = triangle;
            let weight = spat(triangle) / 120.0;
            let total = [0, 1, 2].map(|k| a[k] + b[k] + c[k]);
            for (sum, [i, k]) in sums.iter_mut().zip(PAIRS) {
                let corners = a[i] * a[k] + b[i] * b[k] + c[i] * c[k];
                sum.add(weight * (total[i] * total[k] + corners));
            }
        }
        Solid {
            mass: density * volume,
            center: [0, 1, 2].map(|k| self.near[k] + center[k]),
            central: sums.map(|sum| density * sum.value()),
        }
        .checked()
    }
}

/// The components of the second moments, in the order of [`Solid::central`].
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Returns a · (b × c), six times the volume of a tetrahedron.
fn spat([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn apart(at: [f64; 3], from: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| at[k] - from[k])
}

/// Checks that each edge is passed as often in one direction as in the other.
fn closed(triangles: &[[u32; 3]]) -> Result<(), BodyError> {
    // For both directions of each edge, how often it is passed and the last triangle that passes
    // it.
    let mut edges: BTreeMap<[u32; 2], [(usize, usize); 2]> = BTreeMap::new();
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let (ends, side) = if from < to { ([from, to], 0) } else { ([to, from], 1) };
            let passed = &mut edges.entry(ends).or_default()[side];
            *passed = (passed.0 + 1, triangle);
        }
    }
    let edges = edges.iter().filter(|(ends, _)| ends[0] != ends[1]);
    // The first triangle at fault.
    let mut found: Option<(usize, &'static str)> = None;
    for (_, &[(there, one), (back, other)]) in edges.filter(|(_, [a, b])| a.0 != b.0) {
        let triangle = if back < there { one } else { other };
        let fault = if there.min(back) == 0 && there.max(back) == 2 {
            "passes an edge in the same direction as its neighbour; list its corners the other way"
        } else {
            "has an edge without a neighbour; close the mesh there"
        };
        if found.is_none_or(|(first, _)| triangle < first) {
            found = Some((triangle, fault));
        }
    }
    match found {
        None => Ok(()),
        Some((triangle, fault)) => Err(BodyError::Triangle { triangle, fault }),
    }
}

#[cfg(test)]
mod tests {
    use super::{Mesh, apart};
    use pendulum_core::attitude::Attitude;
    use pendulum_core::body::{BodyError, Solid};

    /// Checks that mass, centre and second moments agree, in units of the size of the solid.
    fn same(a: Solid, b: Solid, relative: f64) {
        let trace: f64 = b.central[..3].iter().sum();
        let size = (trace / b.mass).sqrt();
        assert!((a.mass - b.mass).abs() <= relative * b.mass, "{a:?} is not {b:?}");
        for k in 0..3 {
            assert!((a.center[k] - b.center[k]).abs() <= relative * size, "{a:?} is not {b:?}");
        }
        for k in 0..6 {
            assert!((a.central[k] - b.central[k]).abs() <= relative * trace, "{a:?} is not {b:?}");
        }
    }

    const CORNERS: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn unit_points() -> Vec<[f64; 3]> {
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    }

    /// Returns the corners of a box centred on the origin, and its triangles.
    fn block(size: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let points = (0..8).map(|k| {
            [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -0.5 } else { 0.5 } * size[axis])
        });
        let mut triangles = Vec::new();
        for axis in 0..3 {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            let high = 1 << axis;
            triangles.extend([[0, u | v, u], [0, v, u | v]]);
            triangles.extend([[high, high | u, high | u | v], [high, high | u | v, high | v]]);
        }
        (points.collect(), triangles)
    }

    /// Returns a ball of triangles, each of which is divided in four some times.
    fn ball(divisions: usize) -> Vec<[[f64; 3]; 3]> {
        let axes = |signs: [f64; 3]| {
            let corners = [[signs[0], 0.0, 0.0], [0.0, signs[1], 0.0], [0.0, 0.0, signs[2]]];
            let [a, b, c] = corners;
            if signs[0] * signs[1] * signs[2] < 0.0 { [a, c, b] } else { [a, b, c] }
        };
        let sign = |k: u32| if k == 0 { -1.0 } else { 1.0 };
        let mut triangles: Vec<_> =
            (0..8).map(|k| axes([sign(k & 1), sign(k & 2), sign(k & 4)])).collect();
        for _ in 0..divisions {
            let middle = |a: [f64; 3], b: [f64; 3]| {
                let sum = [0, 1, 2].map(|k| a[k] + b[k]);
                let length = sum.iter().map(|part| part * part).sum::<f64>().sqrt();
                sum.map(|part| part / length)
            };
            triangles = triangles
                .into_iter()
                .flat_map(|[a, b, c]| {
                    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        triangles
    }

    #[test]
    fn a_box_is_its_closed_form() {
        let size = [1.0, 2.0, 0.5];
        let (points, triangles) = block(size);
        let mesh = Mesh::new(&points, &triangles).unwrap();
        same(mesh.solid(3.0).unwrap(), Solid::cuboid(3.0, size).unwrap(), 1e-15);
        let turn = Attitude::from_euler("zxz", [0.3, 1.0, -2.0]).unwrap();
        let turned: Vec<_> = points.iter().map(|&at| turn * at).collect();
        let turned = Mesh::new(&turned, &triangles).unwrap();
        let exact = Solid::cuboid(3.0, size).unwrap().rotated(turn);
        same(turned.solid(3.0).unwrap(), exact, 2e-15);
    }

    #[test]
    fn a_tetrahedron_is_its_closed_form() {
        // ∫x² = 1/60 and ∫xy = 1/120 over the volume 1/6, about the corner.
        let solid = Mesh::new(&unit_points(), &CORNERS).unwrap().solid(6.0).unwrap();
        let [square, product] = [0.1 - 0.0625, 0.05 - 0.0625];
        let central = [square, square, square, product, product, product];
        same(solid, Solid { mass: 1.0, center: [0.25; 3], central }, 1e-15);
    }

    #[test]
    fn far_away_only_digits_of_the_points_are_lost() {
        let (points, triangles) = block([1.0, 2.0, 0.5]);
        let offset = [1048576.0, -4194304.0, 2097152.0];
        let moved: Vec<_> = points.iter().map(|&at| apart(at, offset)).collect();
        let solid = Mesh::new(&moved, &triangles).unwrap().solid(1.0).unwrap();
        let exact = Solid::cuboid(1.0, [1.0, 2.0, 0.5]).unwrap();
        same(solid, exact.translated(offset.map(|part: f64| -part)), 1e-15);
    }

    #[test]
    fn finer_balls_converge_to_the_ball() {
        // Errors fall by four with each division; extrapolation removes this term.
        let solids = [4, 5]
            .map(|divisions| Mesh::from_triangles(&ball(divisions)).unwrap().solid(1.0).unwrap());
        let exact = Solid::ball(4.0 / 3.0 * core::f64::consts::PI, 1.0).unwrap();
        let off = solids.map(|solid| solid.mass / exact.mass - 1.0);
        assert!((off[0] / off[1] - 4.0).abs() < 0.02 && off[1].abs() < 2e-3, "{off:?}");
        let better = |pick: fn(Solid) -> f64| {
            let [coarse, fine] = solids.map(pick);
            ((4.0 * fine - coarse) / 3.0 / pick(exact) - 1.0).abs()
        };
        assert!(better(|solid| solid.mass) < 1e-5, "{}", better(|solid| solid.mass));
        let second = better(|solid| solid.central[2]);
        assert!(second < 3e-5, "{second}");
    }

    #[test]
    fn a_cavity_is_cut_out() {
        let (mut points, mut triangles) = block([2.0, 2.0, 2.0]);
        let (inner, faces) = block([1.0, 0.5, 0.25]);
        points.extend(inner);
        triangles.extend(faces.iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]));
        let hollow = Mesh::new(&points, &triangles).unwrap().solid(1.0).unwrap();
        let hole = Solid::cuboid(0.125, [1.0, 0.5, 0.25]).unwrap();
        let exact = Solid::cuboid(8.0, [2.0; 3]).unwrap().without(hole).unwrap();
        same(hollow, exact, 1e-15);
    }

    #[test]
    fn parts_may_share_an_edge() {
        let (mut points, mut triangles) = block([1.0; 3]);
        // The second box shares the edge of the points 3 and 7.
        let (other, faces) = block([1.0; 3]);
        points.extend(other.iter().map(|&at| apart(at, [-1.0, -1.0, 0.0])));
        let joined = |k: u32| match k {
            0 => 3,
            4 => 7,
            k => k + 8,
        };
        triangles.extend(faces.iter().map(|face| face.map(joined)));
        let solid = Mesh::new(&points, &triangles).unwrap().solid(1.0).unwrap();
        let one = Solid::cuboid(1.0, [1.0; 3]).unwrap();
        same(solid, one + one.translated([1.0, 1.0, 0.0]), 1e-15);
    }

    #[test]
    fn open_meshes_name_a_triangle_at_the_hole() {
        let error = Mesh::new(&unit_points(), &CORNERS[..3]).unwrap_err();
        assert!(matches!(error, BodyError::Triangle { triangle: 0, .. }));
        assert_eq!(
            error.to_string(),
            "triangle 0 has an edge without a neighbour; close the mesh there"
        );
        let (points, mut triangles) = block([1.0; 3]);
        triangles.swap_remove(7);
        assert!(matches!(Mesh::new(&points, &triangles), Err(BodyError::Triangle { .. })));
    }

    #[test]
    fn a_triangle_that_is_turned_over_is_named() {
        let (points, mut triangles) = block([1.0; 3]);
        triangles[11].swap(0, 1);
        let Err(BodyError::Triangle { fault, .. }) = Mesh::new(&points, &triangles) else {
            panic!("accepted");
        };
        assert!(fault.contains("same direction"), "{fault}");
    }

    #[test]
    fn meshes_that_are_inside_out_or_flat_are_refused() {
        let (points, triangles) = block([1.0; 3]);
        let inside_out: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let Err(BodyError::Argument { name, value, .. }) = Mesh::new(&points, &inside_out) else {
            panic!("accepted");
        };
        assert_eq!((name, value), ("volume of the mesh", -1.0));
        for height in [0.0, 1e-17] {
            let flat: Vec<_> = points.iter().map(|&[x, y, z]| [x, y, height * z]).collect();
            let error = Mesh::new(&flat, &triangles);
            assert!(matches!(error, Err(BodyError::Argument { .. })), "{height}");
        }
        assert_eq!(Mesh::new(&[], &[]), Err(BodyError::NoMass));
    }

    #[test]
    fn points_that_are_none_are_refused() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut points = unit_points();
            points[3][1] = bad;
            let error = Mesh::new(&points, &CORNERS);
            assert!(matches!(error, Err(BodyError::Triangle { triangle: 1, .. })), "{bad}");
        }
        let missing = Mesh::new(&unit_points()[..3], &CORNERS).unwrap_err();
        assert_eq!(missing.to_string(), "triangle 1 has the number of a point that does not exist");
        let huge: Vec<_> = unit_points().iter().map(|at| at.map(|part| part * 1e150)).collect();
        assert_eq!(Mesh::new(&huge, &CORNERS), Err(BodyError::OutOfRange));
    }

    #[test]
    fn triangles_without_area_change_nothing() {
        let (points, mut triangles) = block([1.0; 3]);
        triangles.push([2, 2, 5]);
        let solid = Mesh::new(&points, &triangles).unwrap().solid(1.0).unwrap();
        same(solid, Solid::cuboid(1.0, [1.0; 3]).unwrap(), 1e-15);
    }
}
