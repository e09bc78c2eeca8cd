//! Several limits at once: impacts that accumulate, and rest.

use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;
use systems::random::Random;

lagrangian! {
    /// A plate that stands on two edges and may rock from one to the other.
    #[derive(Clone, Debug)]
    pub struct Plate { a: m, b: m, e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    coordinate θ: rad;
    kinetic = ẏ^2/2 + (a^2+b^2)*θ̇^2/6;
    potential = g*y;
    limit l: y - a*sin(θ) - b*cos(θ) >= 0, restitution = e;
    limit r: y + a*sin(θ) - b*cos(θ) >= 0, restitution = e;
}

lagrangian! {
    /// A box that tumbles on its four corners.
    #[derive(Clone, Debug)]
    pub struct Tumbling { a: m, b: m, e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    kinetic = (ẋ^2 + ẏ^2)/2 + (a^2+b^2)*θ̇^2/6;
    potential = g*y;
    limit ll: y - a*sin(θ) - b*cos(θ) >= 0, restitution = e;
    limit lr: y + a*sin(θ) - b*cos(θ) >= 0, restitution = e;
    limit ul: y - a*sin(θ) + b*cos(θ) >= 0, restitution = e;
    limit ur: y + a*sin(θ) + b*cos(θ) >= 0, restitution = e;
}

lagrangian! {
    /// A ball over three lines through one point.
    #[derive(Clone, Debug)]
    pub struct Lines { k: [1; 3], e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    limit one: y >= k[0]*x, restitution = e;
    limit two: y >= k[1]*x, restitution = e;
    limit three: y >= k[2]*x, restitution = e;
}

lagrangian! {
    /// Three blocks that fall on each other.
    #[derive(Clone, Debug)]
    pub struct Stack { m: [kg; 3], d: m, e: 1, g: m/s^2 = 9.81 }
    coordinate z[3]: m;
    kinetic = sum(i in 0..3, m[i]*ż[i]^2/2);
    potential = sum(i in 0..3, m[i]*g*z[i]);
    limit floor: z[0] >= 0, restitution = e;
    limit lower: z[1] - z[0] >= d, restitution = e;
    limit upper: z[2] - z[1] >= d, restitution = e;
}

lagrangian! {
    /// Two beads on rods over a floor: both rest on it, locked by the rods.
    #[derive(Clone, Debug)]
    pub struct Rods { L: m, h: m, e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    coordinate u: m;
    coordinate w: m;
    kinetic = (ẋ^2 + ẏ^2 + u̇^2 + ẇ^2)/2;
    potential = g*(y + w);
    constraint r1: x^2 + y^2 = L^2;
    constraint r2: (u - x)^2 + (w - y)^2 = L^2;
    limit first: y + h >= 0, restitution = e;
    limit second: w + h >= 0, restitution = e;
}

/// Checks a run from rest or not, whose limits do not move: no gap is below zero by more than the
/// tolerance, the energy never grows by more, and there are no more than `impacts`. Returns the
/// end.
fn loses_energy<S: System<N, Scalar = f64, Inputs = ()>, const N: usize>(
    name: &str,
    system: &S,
    run: &Solution<f64, N>,
    tolerance: f64,
    impacts: usize,
) -> State<f64, N> {
    let energy = |state: &State<f64, N>| system.energy(At::of(0.0, &state.q, &state.v));
    let start = energy(&run.iter().next().unwrap());
    let (mut least, scale) = (start, 10.0f64.max(start.abs()));
    for state in run.iter().chain([run.end]) {
        let now = energy(&state);
        let grown = now - least;
        assert!(grown <= 10.0 * tolerance * scale, "{name}: {grown:e} at {}", state.t);
        least = least.min(now);
        let [gaps, ..] = system.gaps(At::of(0.0, &state.q, &state.v));
        for gap in &gaps[..S::FACTS.limits.len()] {
            assert!(-10.0 * tolerance <= *gap, "{name}: {gap:e} at {}", state.t);
        }
    }
    assert!(run.impacts.len() <= impacts, "{name}: {} impacts", run.impacts.len());
    for impact in &run.impacts {
        assert!(0.0 <= impact.impulse, "{name}: {impact:?}");
        let (before, after) = (energy(&impact.state), energy(&impact.after));
        assert!(after <= before + 10.0 * tolerance * scale, "{name}: {impact:?}");
    }
    run.end
}

/// The time of rest is that of the same impacts with 40 digits: flights and swings about one edge
/// in closed form or by quadrature, the last swings as a geometric series.
#[test]
fn a_plate_that_rocks_comes_to_rest() {
    let (a, b) = (0.24883028869833954, 0.9016301173347349);
    let plate = Plate::new(a, b, 0.5);
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
        let start = [0.9066330138782649, 0.0208984146196296];
        let run = solve(&plate, (0.0, 3.0), start, [0.0; 2]).rtol(tolerance).every_step().run();
        let run = run.unwrap_or_else(|failure| panic!("{tolerance}: {failure}"));
        let end = loses_energy("plate", &plate, &run, tolerance, 1000);
        assert!((end.q[0] - b).abs() < 1e-15 && end.q[1].abs() < 1e-15, "{tolerance}: {end:?}");
        assert_eq!(end.v, [0.0; 2]);
        let last = run.impacts.last().unwrap().time.to_f64();
        let off = (last - 0.36464157).abs();
        // The last impacts are too slow for the precision of the coordinates.
        assert!(off < 1e-6 + 5.0 * tolerance, "{tolerance}: {last}");
    }
}

/// The plate at steps of fixed length and in single precision, and with other restitutions.
#[test]
fn plates_rest_with_every_scalar_and_step() {
    for e in [0.0, 0.4] {
        let plate = Plate::new(0.5, 0.2, e);
        let run = solve(&plate, (0.0, 4.0), [0.35, 0.1], [0.0, 1.0]).method(Rk4).step(0.01);
        let run = run.every_step().run().unwrap_or_else(|failure| panic!("{e}: {failure}"));
        let end = loses_energy("Rk4", &plate, &run, 1e-9, 2000);
        assert!((end.q[0] - 0.2).abs() < 1e-15 && end.v == [0.0; 2], "{e}: {end:?}");
        let single = Plate::new(0.5f32, 0.2, e as f32);
        let run = solve(&single, (0.0, 4.0), [0.35f32, 0.1], [0.0, 1.0]).run();
        let end = run.unwrap_or_else(|failure| panic!("{e}: {failure}")).end;
        assert!((end.q[0] - 0.2).abs() < 1e-6 && end.q[1].abs() < 1e-6, "{e}: {end:?}");
        assert_eq!(end.v, [0.0; 2]);
    }
}

/// The coordinates and velocities of a thin plate at rest are zero, and so are their rounding
/// errors.
#[test]
fn thin_plates_rest_in_single_precision() {
    let mut random = Random::new(8);
    for _ in 0..10 {
        let e = if random.once_in(4) { 0.0 } else { random.uniform(0.0, 0.9) };
        let step = 10f64.powf(random.uniform(-2.5, -1.5));
        let start = [random.uniform(0.3, 0.6), random.uniform(-0.4, 0.4)].map(|x| x as f32);
        let plate = Plate::new(0.5f32, 0.0, e as f32);
        let run = solve(&plate, (0.0, 6.0), start, [0.0, 1.0]).method(Rk4).step(step);
        let run = run.max_steps(20_000).run().unwrap_or_else(|e| panic!("{plate:?} {step}: {e}"));
        let end = run.end;
        assert!(end.q[0].abs() < 1e-6 && end.q[1].abs() < 1e-6, "{plate:?} {step}: {end:?}");
        assert_eq!(end.v, [0.0; 2], "{plate:?} {step}");
    }
}

#[test]
fn a_box_tumbles_on_its_corners_and_rests() {
    for (tolerance, e) in [(1e-5, 0.3), (1e-8, 0.5), (1e-10, 0.0), (1e-12, 0.6)] {
        let tumbling = Tumbling::new(0.5, 0.3, e);
        let (q, v) = ([0.0, 0.9, 0.6], [0.4, 0.0, -0.7]);
        let run = solve(&tumbling, (0.0, 6.0), q, v).rtol(tolerance).every_step().run();
        let run = run.unwrap_or_else(|failure| panic!("{tolerance}: {failure}"));
        let end = loses_energy("box", &tumbling, &run, tolerance, 2000);
        // Nothing acts along the floor.
        assert!((end.q[0] - 2.4).abs() < 1e-13 && (end.v[0] - 0.4).abs() < 1e-15, "{end:?}");
        let sides = end.q[2] / core::f64::consts::FRAC_PI_2;
        let height = if sides.round() % 2.0 == 0.0 { 0.3 } else { 0.5 };
        assert!((sides - sides.round()).abs() < 1e-15, "{tolerance}: {end:?}");
        assert!((end.q[1] - height).abs() < 1e-15, "{tolerance}: {end:?}");
        assert_eq!(end.v[1..], [0.0; 2]);
    }
}

#[test]
fn lines_through_one_point_hold_a_ball() {
    for (e, tolerance) in [(0.3, 1e-4), (0.3, 1e-7), (0.3, 1e-12), (0.0, 1e-6)] {
        let lines = Lines::new([0.677, -0.332, 0.8], e);
        let (q, v) = ([-0.1, 1.0], [0.5, 0.0]);
        let run = solve(&lines, (0.0, 12.0), q, v).rtol(tolerance).every_step().run();
        let run = run.unwrap_or_else(|failure| panic!("{e} {tolerance}: {failure}"));
        let end = loses_energy("lines", &lines, &run, tolerance, 2000);
        assert!(end.q.iter().all(|q| q.abs() < 1e-15), "{e} {tolerance}: {end:?}");
        assert_eq!(end.v, [0.0; 2]);
    }
}

#[test]
fn blocks_that_fall_on_each_other_stand() {
    for (e, tolerance) in [(0.0, 1e-6), (0.4, 1e-5), (0.5, 1e-9), (0.3, 1e-12)] {
        let stack = Stack::new([2.0, 0.3, 1.1], 0.1, e);
        let (q, v) = ([0.3, 0.7, 1.5], [0.0, 1.0, -2.0]);
        let run = solve(&stack, (0.0, 9.0), q, v).rtol(tolerance).every_step().run();
        let run = run.unwrap_or_else(|failure| panic!("{e} {tolerance}: {failure}"));
        let end = loses_energy("stack", &stack, &run, tolerance, 4000);
        for (z, expected) in end.q.iter().zip([0.0, 0.1, 0.2]) {
            assert!((z - expected).abs() < 1e-15, "{e} {tolerance}: {end:?}");
        }
        assert_eq!(end.v, [0.0; 3]);
    }
}

/// A floor at zero has no rounding errors of its own, and a tolerance may allow none: each block
/// that comes to rest on another one would bounce ever lower, after each bounce of the one above.
#[test]
fn blocks_stand_without_an_absolute_tolerance() {
    for (m, e, v, tolerance) in [
        ([45.086280302583766, 0.38365102121832145, 0.06026529293479888], 0.5, 1.7587, 4.7e-4),
        ([2.0, 0.3, 1.1], 0.4, -2.0, 1e-6),
        ([0.3, 40.0, 1.0], 0.3, 0.5, 1e-9),
    ] {
        let stack = Stack::new(m, 0.1, e);
        let (q, v) = ([0.0, 0.7, 0.8], [0.0, -0.94, v]);
        let run = solve(&stack, (0.0, 9.0), q, v).rtol(tolerance).atol(1e-200).every_step();
        let run = run.max_steps(60_000).run();
        let run = run.unwrap_or_else(|failure| panic!("{e} {tolerance}: {failure}"));
        let end = loses_energy("stack", &stack, &run, tolerance, 10_000);
        for (z, expected) in end.q.iter().zip([0.0, 0.1, 0.2]) {
            assert!((z - expected).abs() < 1e-15, "{e} {tolerance}: {end:?}");
        }
        assert_eq!(end.v, [0.0; 3]);
    }
}

/// Two contacts and two constraints leave the beads nowhere to go.
#[test]
fn beads_on_rods_rest_while_locked() {
    for (angles, h, e, tolerance) in [
        ([1.0f64, 0.9], 0.8, 0.4, 1e-6),
        ([0.7, 1.3], 0.7, 0.0, 1e-9),
        ([1.2, 0.6], 0.75, 0.6, 1e-4),
        ([0.6, 0.7], 0.65, 0.3, 1e-12),
    ] {
        let rods = Rods::new(1.0, h, e);
        let (x, y) = angles[0].sin_cos();
        let (u, w) = (x + angles[1].sin(), y + angles[1].cos());
        let run = solve(&rods, (0.0, 10.0), [x, y, u, w], [0.0; 4]).rtol(tolerance);
        let run = run.every_step().run();
        let run = run.unwrap_or_else(|failure| panic!("{h} {e}: {failure}"));
        let end = loses_energy("rods", &rods, &run, tolerance, 2000);
        assert!((end.q[1] + h).abs() < 1e-14 && (end.q[3] + h).abs() < 1e-14, "{h}: {end:?}");
        assert!((end.q[0].abs() - (1.0 - h * h).sqrt()).abs() < 1e-14, "{h}: {end:?}");
        assert!(((end.q[2] - end.q[0]).abs() - 1.0).abs() < 1e-14, "{h}: {end:?}");
        assert_eq!(end.v, [0.0; 4]);
    }
}
