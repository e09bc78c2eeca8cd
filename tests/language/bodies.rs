//! Bodies in a Lagrangian: the exact moving compound pendulum, the note's approximation, and the
//! integrals.

use pendulum_runtime::body::{Body, Polygon};
use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::SplitEnergy;
use pendulum_runtime::system::System;

use systems::random::Random;

lagrangian! {
    /// The whole enchilada of note §6, exactly.
    pub struct Exact { B: body, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    driven x: [m; 2];

    let r(p) = x + cis(θ)*p;
    kinetic   = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
}

lagrangian! {
    /// The note's approximation: the forcing of a point mass, the weight of the body.
    pub struct Approximate { B: body, L: m, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    driven x: [m; 2];

    let y = L * [sin(θ), -cos(θ)];
    kinetic   = B.inertia/(2*L^2) * |ẋ + ẏ|^2;
    potential = B.mass*g*height(cis(θ)*B.center);
}

lagrangian! {
    /// A body whose points move against each other, so that all second moments matter.
    pub struct Sheared { B: body, k: 1/s^2 = 1/3 }

    coordinate a: 1;
    coordinate b: 1;

    let r(p) = [p.x*(1 + a) + a*p.y, b*p.x - p.y/2];
    kinetic = integral(p in B, |dot(r(p))|^2/2);
    potential = k*integral(p in B, height(r(p))^2 + inner(r(p), p)/3);
}

fn shaken(acceleration: [f64; 2]) -> (Sample<f64, 2>,) {
    (Sample { position: [0.3, -0.2], velocity: [1.5, 0.7], acceleration },)
}

#[test]
fn a_point_mass_needs_no_correction() {
    let (mass, length) = (0.7, 1.3);
    let body = Body::point(mass, [0.0, -length]).unwrap();
    for θ in [-2.0, 0.1, 1.0, 4.0] {
        let inputs = shaken([3.0, -5.0]);
        let at = At { t: 0.0, q: &[θ], v: &[0.4], inputs: &inputs };
        let exact = Exact::new(body).accelerations(at)[0];
        let approximate = Approximate::new(body, length).accelerations(at)[0];
        assert!((exact - approximate).abs() < 1e-13 * exact.abs().max(1.0));
    }
}

/// A rod of length l about its end has I = m l²/3 and its centre at l/2. With L as the distance to
/// the centre, the note's forcing is that of a point mass at the centre, which is I/(m L²) = 4/3 of
/// the exact forcing.
#[test]
fn a_rod_is_shaken_four_thirds_too_hard_by_the_approximation() {
    let rod = Body::rod(0.7, [0.0, 0.0], [0.0, -2.0]).unwrap();
    let weightless = |g: f64, acceleration| {
        let inputs = shaken(acceleration);
        let mut exact = Exact::new(rod);
        let mut approximate = Approximate::new(rod, 1.0);
        (exact.g, approximate.g) = (g, g);
        let at = At { t: 0.0, q: &[0.6], v: &[0.4], inputs: &inputs };
        (exact.accelerations(at)[0], approximate.accelerations(at)[0])
    };
    let (exact, approximate) = weightless(0.0, [2.0, -1.0]);
    assert!((approximate / exact - 4.0 / 3.0).abs() < 1e-14);
    let (exact, approximate) = weightless(9.81, [0.0, 0.0]);
    assert!((approximate / exact - 1.0).abs() < 1e-14);
}

/// The motion of a rigid body depends only on m, c and I, and the documentation names no other
/// properties.
#[test]
fn a_rigid_body_is_three_numbers() {
    let facts = <Exact as System<1>>::FACTS;
    let printed = "θ̈ = −B.mass·(g·(B.center.x·cos θ − B.center.y·sin θ) + ẍ.y·(B.center.x·cos θ − B.center.y·sin θ) \
                   − ẍ.x·(B.center.x·sin θ + B.center.y·cos θ))/B.inertia";
    assert_eq!(facts.equations, printed);
    assert_eq!(facts.parameters.len(), 7);
    assert!(facts.unused.is_empty());
}

/// Integrates a quadratic function over a polygon of density one, by the midpoint rule on the
/// triangles between its edges and the origin. The rule is exact for the second degree, and
/// independent of the library.
fn over_polygon(points: &[[f64; 2]], f: impl Fn([f64; 2]) -> f64) -> f64 {
    let mut total = 0.0;
    for (index, &a) in points.iter().enumerate() {
        let b = points[(index + 1) % points.len()];
        let area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
        let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        total += area / 3.0 * (f(middle(a, b)) + f(middle(a, [0.0; 2])) + f(middle(b, [0.0; 2])));
    }
    total
}

/// Returns a star-shaped polygon, whose edges do not cross.
fn polygon(random: &mut Random) -> Vec<[f64; 2]> {
    let count = 3 + (random.bits() % 9) as usize;
    let center = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
    (0..count)
        .map(|k| {
            let angle =
                core::f64::consts::TAU * (k as f64 + random.uniform(0.0, 0.9)) / count as f64;
            let radius = random.uniform(0.2, 1.0);
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        })
        .collect()
}

#[test]
fn integrals_agree_with_quadrature_over_random_polygons() {
    let mut random = Random::new(6);
    for _ in 0..300 {
        let points = polygon(&mut random);
        let body = Polygon::new(&points).unwrap().body(1.0).unwrap();
        let (θ, ω) = (random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
        let inputs = shaken([0.0; 2]);
        let (x, dx) = (inputs.0.position, inputs.0.velocity);
        let (s, c) = θ.sin_cos();
        let place = |p: [f64; 2]| [x[0] + c * p[0] - s * p[1], x[1] + s * p[0] + c * p[1]];
        let velocity =
            |p: [f64; 2]| [dx[0] - ω * (place(p)[1] - x[1]), dx[1] + ω * (place(p)[0] - x[0])];
        let kinetic =
            over_polygon(&points, |p| 0.5 * (velocity(p)[0].powi(2) + velocity(p)[1].powi(2)));
        let potential = over_polygon(&points, |p| 9.81 * place(p)[1]);
        let exact = Exact::new(body);
        let at = At { t: 0.0, q: &[θ], v: &[ω], inputs: &inputs };
        assert!((exact.kinetic_energy(at) - kinetic).abs() < 1e-13 * kinetic.abs().max(1.0));
        assert!((exact.potential_energy(at) - potential).abs() < 1e-12 * potential.abs().max(1.0));

        let (q, v) = (
            [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)],
            [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)],
        );
        let moved = |p: [f64; 2]| [p[0] * (1.0 + q[0]) + q[0] * p[1], q[1] * p[0] - 0.5 * p[1]];
        let speed = |p: [f64; 2]| [p[0] * v[0] + v[0] * p[1], v[1] * p[0]];
        let kinetic = over_polygon(&points, |p| 0.5 * (speed(p)[0].powi(2) + speed(p)[1].powi(2)));
        let potential = over_polygon(&points, |p| {
            moved(p)[1].powi(2) + (moved(p)[0] * p[0] + moved(p)[1] * p[1]) / 3.0
        }) / 3.0;
        let (sheared, at) = (Sheared::new(body), At::of(0.0, &q, &v));
        assert!((sheared.kinetic_energy(at) - kinetic).abs() < 1e-13 * kinetic.max(1.0));
        assert!(
            (sheared.potential_energy(at) - potential).abs() < 1e-13 * potential.abs().max(1.0)
        );
    }
}
