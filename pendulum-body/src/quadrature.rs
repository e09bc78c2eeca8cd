//! Moments of a density by adaptive quadrature.

use super::estimate::{Estimate, Moments, body, checked};
use super::slabs::{Point, Triangle};
use super::sum::Sum;
use pendulum_core::body::BodyError;
use pendulum_core::scalar::Real;

/// The rule of Radon (1948), exact to degree five: weights, and two barycentric coordinates of each
/// point.
const WEIGHTS: [f64; 7] = [0.225, WEIGHT_A, WEIGHT_A, WEIGHT_A, WEIGHT_B, WEIGHT_B, WEIGHT_B];
const POINTS: [Point; 7] = [
    [1.0 / 3.0, 1.0 / 3.0],
    [A, A],
    [A, 1.0 - 2.0 * A],
    [1.0 - 2.0 * A, A],
    [B, B],
    [B, 1.0 - 2.0 * B],
    [1.0 - 2.0 * B, B],
];
/// (6 − √15)/21, (6 + √15)/21, (155 − √15)/1200 and (155 + √15)/1200.
const A: f64 = 0.10128650732345633;
const B: f64 = 0.47014206410511505;
const WEIGHT_A: f64 = 0.12593918054482717;
const WEIGHT_B: f64 = 0.13239415278850616;

/// The quarters of a triangle as [u₀, v₀, h]: local coordinates u′ of a quarter are u = u₀ + h u′.
const PLACES: [[f64; 3]; 4] = [[0.0, 0.0, 0.5], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5], [0.5, 0.5, -0.5]];

/// Points just inside the corners and the midpoints of the sides. The density there is used only
/// for the error estimate.
const PROBES: [Point; 6] = [
    [EDGE, EDGE],
    [1.0 - 2.0 * EDGE, EDGE],
    [EDGE, 1.0 - 2.0 * EDGE],
    [0.5 - EDGE, EDGE],
    [EDGE, 0.5 - EDGE],
    [0.5 - EDGE, 0.5 - EDGE],
];
const EDGE: f64 = 1e-6;

/// The least number of triangles at the start.
const FIRST: usize = 64;
/// The number of evaluations after which the density is unresolved.
const LIMIT: usize = 2_000_000;

/// The weight of [`roughness`]. With this value, the estimates exceed the errors of all jumps in
/// the tests.
const CAUTION: f64 = 6.0;

/// The result of the rule on a triangle.
#[derive(Clone, Copy, Default)]
struct Sample {
    moments: Moments,
    /// The means of f, f u, f v and f², where f is the density times the growth of the area, and u
    /// and v are the second and third barycentric coordinates.
    fit: [f64; 4],
}

/// A triangle, its quarters and the results on them.
struct Cell {
    quarters: [(Triangle, Sample); 4],
    /// The sum over the quarters.
    fine: Moments,
    /// The estimated error of each moment.
    error: Moments,
}

/// Integrates the body over `triangles`. `map` maps a point to the plane, and returns the factor by
/// which areas grow, too.
///
/// The result on each triangle is compared with the result on its quarters, and the roughness of
/// the density is estimated. Triangles whose errors, in units of the mass, exceed their share of
/// `rtol` are replaced by their quarters until the sum of all errors is below the tolerance.
pub(super) fn integrate(
    triangles: Vec<Triangle>,
    map: impl Fn(Point) -> (Point, f64),
    origin: Point,
    radius: f64,
    mut density: impl FnMut(Point) -> f64,
    rtol: f64,
) -> Result<Estimate, BodyError> {
    if !(1e-13..1.0).contains(&rtol) {
        let required = "at least 1e-13 and below 1";
        return Err(BodyError::Argument { name: "relative tolerance", value: rtol, required });
    }
    let mut integrand = |point| {
        let (place, growth) = map(point);
        Ok((place, growth * checked(&mut density, place)?))
    };
    let mut cells = Vec::new();
    let mut pending = Vec::new();
    for triangle in divided(triangles) {
        pending.push((triangle, sample(&triangle, origin, &mut integrand)?));
    }
    let mut evaluations = WEIGHTS.len() * pending.len();

    loop {
        evaluations += (4 * WEIGHTS.len() + PROBES.len()) * pending.len();
        for (triangle, coarse) in pending.drain(..) {
            cells.push(Cell::new(&triangle, &coarse.moments, origin, radius, &mut integrand)?);
        }

        let (mut sums, mut errors) = ([Sum::default(); 6], [0.0; 6]);
        for cell in &cells {
            sums.iter_mut().zip(cell.fine).for_each(|(sum, part)| sum.add(part));
            add(&mut errors, &cell.error);
        }
        let sum = sums.map(Sum::value);
        let allowed = rtol * sum[0];
        if worst(&errors, radius) <= allowed {
            return estimate(&sum, &errors, origin, evaluations);
        }
        if LIMIT <= evaluations {
            return Err(BodyError::Unresolved {
                rtol,
                reached: worst(&errors, radius) / sum[0],
                evaluations,
            });
        }
        let share = allowed / cells.len() as f64;
        let mut kept = Vec::with_capacity(cells.len());
        for cell in cells {
            if worst(&cell.error, radius) <= share {
                kept.push(cell);
            } else {
                pending.extend(cell.quarters);
            }
        }
        cells = kept;
    }
}

impl Cell {
    fn new(
        triangle: &Triangle,
        coarse: &Moments,
        origin: Point,
        radius: f64,
        integrand: &mut impl FnMut(Point) -> Result<(Point, f64), BodyError>,
    ) -> Result<Self, BodyError> {
        let mut quarters = quarters(triangle).map(|quarter| (quarter, Sample::default()));
        let (mut fine, mut fit) = ([0.0; 6], [0.0; 4]);
        for ((quarter, found), [u, v, half]) in quarters.iter_mut().zip(PLACES) {
            *found = sample(quarter, origin, integrand)?;
            add(&mut fine, &found.moments);
            let [f, fu, fv, ff] = found.fit.map(|mean| 0.25 * mean);
            add(&mut fit, &[f, u * f + half * fu, v * f + half * fv, ff]);
        }
        // At a jump of the density the difference may vanish by coincidence, even in all cells
        // along the jump at once.
        let rough = roughness(triangle, &fit, integrand)?;
        let chance = CAUTION * rough * rough.sqrt() * fine[0];
        let square = radius * radius;
        let units = [1.0, radius, radius, square, square, square];
        let error = core::array::from_fn(|k| (fine[k] - coarse[k]).abs() + chance * units[k]);
        Ok(Self { quarters, fine, error })
    }
}

/// Computes the squared distance of f from a linear function, relative to its mean square. For a
/// smooth f it is of order h⁴ in the size h of the triangle, so that its power 3/2 decreases like
/// the error of the rule. At a jump it is independent of h.
fn roughness(
    triangle: &Triangle,
    [f, fu, fv, ff]: &[f64; 4],
    integrand: &mut impl FnMut(Point) -> Result<(Point, f64), BodyError>,
) -> Result<f64, BodyError> {
    // The covariances of u and v on a triangle are 1/18 and −1/36; their inverse gives the slopes
    // of the best linear function.
    let (u, v) = (fu - f / 3.0, fv - f / 3.0);
    let slopes = [24.0 * u + 12.0 * v, 12.0 * u + 24.0 * v];
    let mut rest = ff - f * f - (slopes[0] * u + slopes[1] * v);
    // Only the probes can detect a jump between the boundary and the outermost points of the rule.
    for [u, v] in PROBES {
        let linear = f + slopes[0] * (u - 1.0 / 3.0) + slopes[1] * (v - 1.0 / 3.0);
        let apart = integrand(at(triangle, u, v))?.1 - linear;
        rest = Real::max(rest, 0.1 * apart * apart);
    }
    Ok(if 0.0 < rest && 0.0 < *ff { Real::min(rest / ff, 1.0) } else { 0.0 })
}

/// Computes the result, with the errors of centre and inertia from those of the moments.
fn estimate(
    sum: &Moments,
    errors: &Moments,
    origin: Point,
    evaluations: usize,
) -> Result<Estimate, BodyError> {
    let body = body(sum, origin)?;
    let [x, y] = [origin[0].abs(), origin[1].abs()];
    let reach = [(body.center[0] - origin[0]).abs(), (body.center[1] - origin[1]).abs()];
    Ok(Estimate {
        body,
        mass_error: errors[0],
        center_error: [
            (errors[1] + reach[0] * errors[0]) / body.mass,
            (errors[2] + reach[1] * errors[0]) / body.mass,
        ],
        inertia_error: errors[3]
            + errors[5]
            + 2.0 * (x * errors[1] + y * errors[2])
            + (x * x + y * y) * errors[0],
        evaluations,
    })
}

/// Returns the largest error of the moments in units of the mass.
fn worst(errors: &Moments, radius: f64) -> f64 {
    let square = radius * radius;
    let [mass, x, y, xx, xy, yy] = *errors;
    [x / radius, y / radius, xx / square, xy / square, yy / square]
        .into_iter()
        .fold(mass, Real::max)
}

/// Applies the rule to one triangle.
fn sample(
    triangle: &Triangle,
    origin: Point,
    integrand: &mut impl FnMut(Point) -> Result<(Point, f64), BodyError>,
) -> Result<Sample, BodyError> {
    let [a, b, c] = triangle;
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let mut sample = Sample::default();
    for (weight, [u, v]) in WEIGHTS.iter().zip(POINTS) {
        let (place, f) = integrand(at(triangle, u, v))?;
        let [x, y] = [place[0] - origin[0], place[1] - origin[1]];
        let (mass, mean) = (weight * area * f, weight * f);
        add(
            &mut sample.moments,
            &[mass, mass * x, mass * y, mass * x * x, mass * x * y, mass * y * y],
        );
        add(&mut sample.fit, &[mean, mean * u, mean * v, mean * f]);
    }
    Ok(sample)
}

/// Returns the point with the barycentric coordinates 1 − u − v, u and v.
fn at([a, b, c]: &Triangle, u: f64, v: f64) -> Point {
    [a[0] + u * (b[0] - a[0]) + v * (c[0] - a[0]), a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1])]
}

/// Divides the triangles until there are at least [`FIRST`].
fn divided(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    while !triangles.is_empty() && triangles.len() < FIRST {
        triangles = triangles.iter().flat_map(quarters).collect();
    }
    triangles
}

/// Returns the four triangles between corners and midpoints.
fn quarters([a, b, c]: &Triangle) -> [Triangle; 4] {
    let middle = |p: &Point, q: &Point| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [bc, ca, ab]]
}

fn add<const N: usize>(sum: &mut [f64; N], other: &[f64; N]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += other;
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::super::{Body, BodyError, Polygon};
    use super::{LIMIT, Triangle, sample};
    use crate::tests::{close, same};
    use pendulum_core::scalar::Real;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn square() -> Polygon {
        Polygon::new(&SQUARE).unwrap()
    }

    #[test]
    fn rule_is_exact_to_degree_five() {
        let triangle: Triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (i, j) in (0..6).flat_map(|i| (0..6 - i).map(move |j| (i, j))) {
            let power = |x: f64, n: i32| (0..n).map(|_| x).product::<f64>();
            let monomial = &mut |[x, y]: [f64; 2]| Ok(([x, y], power(x, i) * power(y, j)));
            let found = sample(&triangle, [0.0; 2], monomial).unwrap().moments[0];
            // ∫ xⁱ yʲ = i! j!/(i + j + 2)!.
            close(found, factorial(i) * factorial(j) / factorial(i + j + 2), 1e-14);
        }
    }

    #[test]
    fn uniform_density_agrees_with_the_edges() {
        let corner =
            Polygon::new(&[[5.0, 0.0], [8.0, 0.5], [8.0, 1.0], [6.0, 1.0], [6.5, 2.0], [5.5, 2.5]])
                .unwrap();
        let corner = corner.hole(&[[5.5, 0.5], [6.0, 0.75], [5.75, 1.5]]).unwrap();
        let found = corner.quadrature(|_| 3.0, 1e-12).unwrap();
        same(found.body, corner.body(3.0).unwrap(), 1e-13);
        assert!(found.inertia_error < 1e-12 * found.body.inertia());
    }

    #[test]
    fn gradient_on_a_square() {
        // ρ = x: m = 1/2, c = (2/3, 1/2), ∫ρx² = 1/4, ∫ρxy = 1/6, ∫ρy² = 1/6.
        let body = square().quadrature(|[x, _]| x, 1e-13).unwrap().body;
        let exact =
            Body { mass: 0.5, center: [2.0 / 3.0, 0.5], central: [1.0 / 36.0, 0.0, 1.0 / 24.0] };
        same(body, exact, 1e-14);
    }

    #[test]
    fn smooth_density_meets_its_tolerance() {
        // ρ = exp(x + y): every moment is a product of ∫eˣ = e − 1, ∫x eˣ = 1 and ∫x² eˣ = e − 2.
        let e = Real::exp(1.0_f64);
        for rtol in [1e-4, 1e-7, 1e-10, 1e-13] {
            let found = square().quadrature(|[x, y]| Real::exp(x + y), rtol).unwrap();
            let (mass, center) = ((e - 1.0) * (e - 1.0), 1.0 / (e - 1.0));
            close(found.body.mass, mass, rtol);
            close(found.body.center[0], center, rtol);
            close(found.body.inertia(), 2.0 * (e - 2.0) * (e - 1.0), rtol);
            close(found.body.moments()[1], 1.0, 2.0 * rtol);
            assert!((found.body.mass - mass).abs() <= found.mass_error + 4e-15);
        }
    }

    #[test]
    fn estimates_bound_the_errors_of_jumps() {
        // The density is twice as large to the right of x = c + a (y − ½), a line that crosses only
        // the upper and lower sides: m = 2 − c.
        let mut random = Random::new(1);
        for index in 0..300 {
            let c = random.unit();
            let a = [0.0, 1.0, random.unit()][index % 3] * 2.0 * Real::min(c, 1.0 - c);
            let found = square()
                .quadrature(|[x, y]| if x < c + a * (y - 0.5) { 1.0 } else { 2.0 }, 1e-3)
                .unwrap();
            let mass = 2.0 - c;
            assert!((found.body.mass - mass).abs() <= found.mass_error, "{found:?} {mass}");
            assert!(found.mass_error <= 1e-3 * found.body.mass);
            // ∫ρx = ½ + ½ − ½∫(c + a(y − ½))² dy.
            let center = (1.0 - 0.5 * c * c - a * a / 24.0) / mass;
            assert!(
                (found.body.center[0] - center).abs() <= found.center_error[0],
                "{found:?} {center}"
            );
        }
    }

    #[test]
    fn densities_beyond_the_tolerance_are_refused_with_what_was_reached() {
        let found =
            square().quadrature(|[x, y]| if x * x + y * y < 0.3 { 1.0 } else { 2.0 }, 1e-12);
        let Err(BodyError::Unresolved { rtol, reached, evaluations }) = found else {
            panic!("{found:?}")
        };
        assert!(
            rtol == 1e-12 && rtol < reached && reached < 1e-2 && LIMIT <= evaluations,
            "{found:?}"
        );
    }

    #[test]
    fn corner_singularity_is_refined() {
        // ρ = √x: m = 2/3, ∫ρx = 2/5.
        let found = square().quadrature(|[x, _]| x.sqrt(), 1e-6).unwrap();
        close(found.body.mass, 2.0 / 3.0, 1e-6);
        close(found.body.center[0], 0.6, 1e-6);
    }

    #[test]
    fn densities_that_are_none_are_refused_where_they_are() {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let found =
                square().quadrature(|[x, y]| if 0.5 < x && y < 0.25 { bad } else { 1.0 }, 1e-6);
            assert!(
                matches!(found, Err(BodyError::Density { at: [x, y], .. }) if 0.5 < x && y < 0.25),
                "{found:?}"
            );
        }
        assert_eq!(square().quadrature(|_| 0.0, 1e-6), Err(BodyError::NoMass));
        for rtol in [0.0, 1e-14, 1.0, f64::NAN] {
            let refused = square().quadrature(|_| 1.0, rtol);
            assert!(matches!(refused, Err(BodyError::Argument { name: "relative tolerance", .. })));
        }
    }
}
