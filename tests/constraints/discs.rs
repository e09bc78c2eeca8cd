//! Dry friction against rates of vectors: in the plane, in space, and in contacts.

use core::f64::consts::PI;
use pendulum_runtime::attitude::{Attitude, Rates};
use pendulum_runtime::integrate::Integrator;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::{At, System};
use systems::random::Random;

lagrangian! {
    /// A puck on a table, which one force pushes along x, and another by a growing one along y.
    #[derive(Clone, Debug)]
    pub struct Puck { m: kg, P: N, R: N/s, F: N, S: N }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = -P*p.x - R*t*p.y;
    friction ground: dot(p), force = F, static = S;
}

lagrangian! {
    /// A puck that moves in space through a medium with dry friction.
    #[derive(Clone, Debug)]
    pub struct Mote { m: kg, F: N, S: N, P: N }
    coordinate p: [m; 3];
    kinetic = m/2*|dot(p)|^2;
    potential = -P*(p.x + 2*p.y + 2*p.z)/3;
    friction medium: dot(p), force = F, static = S;
}

lagrangian! {
    /// A billiard ball, with its turns about the axes of the table.
    #[derive(Clone, Debug)]
    pub struct Ball { m: kg, r: m, F: N }
    coordinate p: [m; 2];
    coordinate α: rad;
    coordinate β: rad;
    kinetic = m/2*|dot(p)|^2 + m*r^2/5*(α̇^2 + β̇^2);
    friction cloth: dot(p) + r*[-β̇, α̇], force = F;
}

lagrangian! {
    /// The same ball with a rotation.
    #[derive(Clone, Debug)]
    pub struct Solid { m: kg, r: m, F: N }
    coordinate x: [m; 3];
    coordinate R: rotation;
    kinetic = m/2*|dot(x)|^2 + m*r^2/5*|angular_velocity(R)|^2;
    friction cloth: dot(x) + cross(angular_velocity(R), [0, 0, -r]), force = F;
}

lagrangian! {
    /// A block on a table that turns faster and faster.
    #[derive(Clone, Debug)]
    pub struct Table { m: kg, A: 1/s^2, F: N, S: N }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    friction plate: dot(p) - perp(p)*A*t, force = F, static = S;
}

lagrangian! {
    /// A block on a spring to a point beside the axis of a table that turns.
    #[derive(Clone, Debug)]
    pub struct Dragged { m: kg, k: N/m, c: m, Ω: rad/s, F: N, D: kg/s }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = k/2*|p - [c, 0]|^2;
    dissipation = D/2*|dot(p)|^2;
    friction plate: dot(p) - perp(p)*Ω, force = F;
}

lagrangian! {
    /// A block and a block that it carries over the ground, pulled along a line.
    #[derive(Clone, Debug)]
    pub struct Stack { m: kg, M: kg, F: N, G: N, R: N/s, φ: 1 }
    coordinate x: [m; 2];
    coordinate y: [m; 2];
    kinetic = M/2*|dot(x)|^2 + m/2*|dot(y)|^2;
    potential = -R*t*inner(x, [cos(φ), sin(φ)]);
    friction ground: dot(x), force = F;
    friction top: dot(y) - dot(x), force = G;
}

lagrangian! {
    /// Three pucks between springs and a handle that goes round.
    #[derive(Clone, Debug)]
    pub struct Train { k: 1/s^2, K: 1/s^2, A: m, ω: rad/s, F: m/s^2 }
    coordinate x: [m; 2];
    coordinate y: [m; 2];
    coordinate z: [m; 2];
    let handle = A*[cos(ω*t), sin(ω*t)];
    kinetic = (|dot(x)|^2 + |dot(y)|^2 + |dot(z)|^2)/2;
    potential = k/2*(|x - y|^2 + |y - z|^2) + K/2*|x - handle|^2;
    friction first: dot(x), force = F;
    friction second: dot(y), force = F;
    friction third: dot(z), force = F;
}

lagrangian! {
    /// A block over a rough floor.
    #[derive(Clone, Debug)]
    pub struct Thrown { m: kg, μ: 1, e: 1, g: m/s^2 = 9.8 }
    coordinate p: [m; 3];
    kinetic = m/2*|dot(p)|^2;
    potential = m*g*p.z;
    limit floor: p.z >= 0, restitution = e, friction = μ along [dot(p).x, dot(p).y];
}

lagrangian! {
    /// A block on a belt and a block on it, between springs, which a force swings round.
    #[derive(Clone, Debug)]
    pub struct Pair { m: kg, M: kg, k: N/m, K: N/m, A: N, ω: rad/s, u: m/s, F: N, G: N }
    coordinate x: [m; 2];
    coordinate y: [m; 2];
    kinetic = M/2*|dot(x)|^2 + m/2*|dot(y)|^2;
    potential = k/2*|x|^2 + K/2*|x - y|^2 - A*inner(y, [cos(ω*t), sin(ω*t)]);
    friction belt: dot(x) - [u, 0], force = F;
    friction top: dot(y) - dot(x), force = G;
}

lagrangian! {
    /// A body whose tip falls onto a rough floor.
    #[derive(Clone, Debug)]
    pub struct Dart { m: kg, J: [kg*m^2; 3], c: [m; 3], μ: 1, e: 1, g: m/s^2 = 9.8 }
    coordinate x: [m; 3];
    coordinate R: rotation;
    let tip = x + R*c;
    let Ω = transpose(R)*angular_velocity(R);
    kinetic = m/2*|dot(x)|^2 + (J.x*Ω.x^2 + J.y*Ω.y^2 + J.z*Ω.z^2)/2;
    potential = m*g*x.z;
    limit floor: tip.z >= 0, restitution = e, friction = μ along [dot(tip).x, dot(tip).y];
}

const PUCK: Puck<f64> = Puck { m: 1.0, P: 0.0, R: 0.0, F: 2.94, S: 0.0 };

fn near(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} instead of {expected}");
}

/// The hodograph of a puck with the friction F across the force P: with the angle α between its
/// velocity ρ and the force, ρ̇ = (P cos α − F)/m and ρ α̇ = −P sin α/m. So ρ sin α = C u^n with
/// u = tan(α/2) and n = F/P, and F ρ + P ρ cos α falls by (F² − P²)/m a second.
#[test]
fn a_puck_across_a_force_turns_into_it_and_comes_to_rest() {
    for (ratio, angle) in [(1.2_f64, 1.5_f64), (1.5, 2.5), (3.0, 0.7), (8.0, 2.0)] {
        let (m, force, speed) = (2.0, 1.25, 3.0);
        let puck = Puck { m, P: force, F: ratio * force, ..PUCK };
        let u = (angle / 2.0).tan();
        let c = speed * angle.sin() / u.powf(ratio);
        let f = ratio * force;
        let stop = m * speed * (f + force * angle.cos()) / (f * f - force * force);
        let scale = m * c * c / (4.0 * force);
        let [low, high] = [2.0 * ratio - 2.0, 2.0 * ratio + 2.0];
        let x = scale * (u.powf(low) / low - u.powf(high) / high);
        let [low, high] = [2.0 * ratio - 1.0, 2.0 * ratio + 1.0];
        let y = 2.0 * scale * (u.powf(low) / low + u.powf(high) / high);
        let start = [speed * angle.cos(), speed * angle.sin()];
        let solution = solve(&puck, (0.0, 30.0), [0.0; 2], start).rtol(1e-10).atol(1e-10);
        let solution = solution.max_steps(2000).run().unwrap();
        near(solution.end.q[0], x, 1e-9);
        near(solution.end.q[1], y, 1e-9);
        assert_eq!(solution.end.v, [0.0; 2]);
        let rest = solution.frictions.iter().find(|slip| slip.direction == 0).unwrap();
        near(rest.start, stop, 1e-9);
    }
}

#[test]
fn a_force_beyond_the_friction_carries_the_puck_away() {
    let (f, force) = (1.0, 1.5);
    let puck = Puck { P: force, F: f, ..PUCK };
    for (angle, tolerance, most) in
        [(2.0_f64, 1e-10, 1e-10), (3.0, 1e-10, 1e-9), (PI - 1e-4, 1e-12, 1e-4)]
    {
        let start = [2.0 * angle.cos(), 2.0 * angle.sin()];
        let run = solve(&puck, (0.0, 8.0), [0.0; 2], start).rtol(tolerance).atol(tolerance / 100.0);
        let run = run.max_steps(300).run().unwrap();
        let sum = |v: [f64; 2]| f * v[0].hypot(v[1]) + force * v[0];
        near(sum(run.end.v), sum(start) + (force * force - f * f) * 8.0, 1e-8);
        // The logarithm of C, which a puck that nearly turns back multiplies by its speed over the
        // least one.
        let size = |v: [f64; 2]| v[1].ln() - f / force * (v[1].atan2(v[0]) / 2.0).tan().ln();
        near(size(run.end.v), size(start), most);
        assert!(run.frictions.iter().all(|slip| slip.direction == 1));
    }
}

#[test]
fn a_straight_slide_ends_alike_in_every_direction() {
    for φ in [0.0_f64, 0.3, 0.785, 2.2, -1.9] {
        let start = [10.0 * φ.cos(), 10.0 * φ.sin()];
        for (tolerance, most) in [(1e-4, 40), (1e-10, 40)] {
            let run = solve(&PUCK, (0.0, 5.0), [0.0; 2], start).rtol(tolerance).run().unwrap();
            near(run.end.q[0], 17.006802721088435 * φ.cos(), 1e-9);
            near(run.end.q[1], 17.006802721088435 * φ.sin(), 1e-9);
            assert_eq!(run.end.v, [0.0; 2]);
            assert!(run.stats.accepted < most, "{}", run.stats);
        }
        let run = solve(&PUCK, (0.0, 5.0), [0.0; 2], start).method(Rk4).step(0.01).run().unwrap();
        near(run.end.q[0].hypot(run.end.q[1]), 17.006802721088435, 1e-9);
    }
}

/// In a square, each of the components would hold.
#[test]
fn the_length_of_the_reaction_decides_what_breaks_away() {
    let held = Puck { P: 0.8, R: 0.1, F: 1.0, S: 1.0, ..PUCK };
    let run = solve(&held, (0.0, 7.0), [0.0; 2], [0.0; 2]).rtol(1e-10).every(0.5).run().unwrap();
    let [x, y] = &run.friction_forces(&held).unwrap()[..] else { panic!() };
    for (k, t) in run.t.iter().enumerate().filter(|(_, t)| **t < 5.9) {
        near(x[k], -0.8, 1e-15);
        near(y[k], -0.1 * t, 1e-15);
        assert_eq!(run.q[k], [0.0; 2]);
    }
    for slip in run.frictions.iter().filter(|slip| slip.direction == 0) {
        near(slip.end, 6.0, 1e-9);
    }
    assert!(0.0 < run.end.q[0] && 0.0 < run.end.q[1], "{:?}", run.end);
}

#[test]
fn what_breaks_away_begins_against_its_reaction() {
    // A moment later, S − F accelerates it in the direction (3, 4)/5.
    let puck = Puck { m: 1.0, P: 1.5, R: 1.0, F: 1.0, S: 2.5 };
    let run = solve(&puck, (0.0, 2.0 + 1e-4), [0.0; 2], [0.0; 2]).rtol(1e-10).atol(1e-16);
    let run = run.every(2.0).run().unwrap();
    near(run.end.v[0], 0.9e-4, 1e-8);
    near(run.end.v[1], 1.2e-4, 1e-8);
    // The outputs at this moment contain the force of sliding in its direction.
    let start = Puck { P: 6.0, R: 0.0, F: 1.0, S: 2.5, ..PUCK };
    let run = solve(&start, (0.0, 1.0), [0.0; 2], [0.0; 2]).every(0.5).run().unwrap();
    let forces = run.friction_forces(&start).unwrap();
    assert_eq!((forces[0][0], forces[1][0]), (-1.0, 0.0));
}

#[test]
fn a_block_leaves_a_table_that_turns_faster_and_faster() {
    // The reaction m r √(A² + (A t)⁴) reaches S.
    let (m, radius, rate, bound) = (2.0_f64, 0.7, 0.5, 3.0);
    let table = Table { m, A: rate, F: 2.0, S: bound };
    let leaves = (((bound / (m * radius)).powi(2) - rate * rate).sqrt()).sqrt() / rate;
    let run = solve(&table, (0.0, leaves + 0.5), [radius, 0.0], [0.0; 2]).rtol(1e-11).atol(1e-11);
    let run = run.run().unwrap();
    let stick = run.frictions.iter().find(|slip| slip.direction == 0).unwrap();
    assert_eq!(stick.start, 0.0);
    near(stick.end, leaves, 1e-9);
    assert!(radius < run.end.q[0].hypot(run.end.q[1]));
}

/// Its force does not fall where it breaks away, and its rate turns as it leaves zero.
#[test]
fn what_breaks_away_slowly_turns_without_a_step_for_each_turn() {
    let table = Table { m: 2.0, A: 0.5, F: 3.0, S: 0.0 };
    let run = |tolerance: f64| {
        let run = solve(&table, (0.0, 4.0), [0.7, 0.0], [0.0; 2]).rtol(tolerance).atol(tolerance);
        run.max_steps(3000).run().unwrap()
    };
    let (coarse, fine, finest) = (run(1e-6), run(1e-9), run(1e-11));
    assert_eq!(fine.frictions.len(), 4);
    for i in 0..2 {
        near(coarse.end.q[i], finest.end.q[i], 1e-5);
        near(fine.end.q[i], finest.end.q[i], 1e-8);
    }
}

#[test]
fn a_block_on_a_spring_is_dragged_to_the_circle_of_thales() {
    // At rest, the spring pulls against the table: p ⊥ p − c, and k |p − c| = F.
    let block = Dragged { m: 1.0_f64, k: 4.0, c: 1.0, Ω: 2.0, F: 1.2, D: 1.0 };
    let run = solve(&block, (0.0, 80.0), [1.0, 0.0], [0.0; 2]).rtol(1e-10).atol(1e-12);
    let end = run.run().unwrap().end;
    near(end.q[0].hypot(end.q[1]), f64::sqrt(1.0 - 0.09), 1e-9);
    near((end.q[0] - 1.0).hypot(end.q[1]), 0.3, 1e-9);
}

#[test]
fn in_space_a_ball_bounds_the_force() {
    let mote = Mote { m: 2.0, F: 1.5, S: 0.0, P: 0.0 };
    let run = solve(&mote, (0.0, 6.0), [0.0; 3], [2.0, -1.0, 2.0]).rtol(1e-10).run().unwrap();
    for (x, part) in run.end.q.iter().zip([2.0, -1.0, 2.0]) {
        near(*x, part * 2.0, 1e-9);
    }
    assert_eq!(run.end.v, [0.0; 3]);
    near(run.frictions[3].start, 4.0, 1e-9);
    for (push, moves) in [(1.49, false), (1.51, true)] {
        let mote = Mote { P: push, ..mote };
        let end = solve(&mote, (0.0, 2.0), [0.0; 3], [0.0; 3]).run().unwrap().end;
        let reached = if moves { 0.01 } else { 0.0 };
        for (x, part) in end.q.iter().zip([1.0, 2.0, 2.0]) {
            near(*x, part / 3.0 * reached, 1e-12);
        }
    }
}

/// The slip falls in a straight line, so that the centre moves along a parabola, and rolls on
/// straight with 5/7 of the velocity and 2/7 of what the spin gives.
#[test]
fn a_billiard_ball_with_side_spin_rolls_on_after_a_parabola() {
    let (m, r, force) = (0.2, 0.03, 0.4);
    let (v, spin) = ([2.0_f64, 0.5], [30.0, -40.0]);
    let ball = Ball { m, r, F: force };
    let start = [v[0], v[1], spin[0], spin[1]];
    let run = solve(&ball, (0.0, 3.0), [0.0; 4], start).rtol(1e-10).atol(1e-12).run().unwrap();
    let slip: [f64; 2] = [v[0] - r * spin[1], v[1] + r * spin[0]];
    let size = slip[0].hypot(slip[1]);
    let stop = 2.0 * size * m / (7.0 * force);
    for i in 0..2 {
        let a = -force / m * slip[i] / size;
        near(run.end.v[i], v[i] - 2.0 / 7.0 * slip[i], 1e-10);
        let place = v[i] * stop + a * stop * stop / 2.0 + (3.0 - stop) * (v[i] + a * stop);
        near(run.end.q[i], place, 1e-9);
    }
    assert_eq!(run.frictions.len(), 4);
    near(run.frictions[2].start, stop, 1e-9);
    // The same ball as a solid.
    let solid = Solid { m, r, F: force };
    let start = Solid::start().x([0.0; 3], [v[0], v[1], 0.0]);
    let start = start.R(Attitude::identity(), Rates::body([spin[0], spin[1], 0.0]));
    let other = solve(&solid, (0.0, 3.0), start.q, start.v).rtol(1e-10).atol(1e-12).run().unwrap();
    for i in 0..2 {
        near(other.end.q[i], run.end.q[i], 1e-8);
    }
}

/// Along a line, vectors move as scalars do, whatever the direction of the line.
#[test]
fn a_stack_in_the_plane_moves_as_one_until_its_top_slides() {
    let (first, second) = (1.0, (0.4 * 3.0 + 0.5) / 0.5);
    let speed = |t: f64| 0.5 * (t - first).powi(2) / 6.0;
    let place = |t: f64| 0.5 * (t - first).powi(3) / 18.0;
    let left = 5.0 - second;
    for φ in [0.0_f64, 0.4, 1.9, -2.5] {
        let stack = Stack { m: 1.0, M: 2.0, F: 0.5, G: 0.4, R: 0.5, φ };
        let run = solve(&stack, (0.0, 5.0), [0.0; 4], [0.0; 4]).rtol(1e-10).atol(1e-10);
        let run = run.run().unwrap();
        let ends = |name: &str| {
            let mut own = run.frictions.iter().filter(|slip| slip.name == name);
            own.next().map(|slip| slip.end).unwrap()
        };
        near(ends("ground.x"), first, 1e-9);
        near(ends("top.y"), second, 1e-9);
        let [x, y] = [run.end.q[2], run.end.q[3]];
        let along = place(second) + speed(second) * left + 0.2 * left * left;
        near(x * φ.cos() + y * φ.sin(), along, 1e-9);
        near(y * φ.cos() - x * φ.sin(), 0.0, 1e-9);
    }
}

#[test]
fn three_pucks_agree_with_small_steps_of_a_set_valued_law() {
    let train = Train { k: 1.0, K: 2.0, A: 1.0, ω: 1.0, F: 0.4 };
    let start = [0.3, 0.1, -0.2, 0.0, 0.1, 0.4];
    let run = solve(&train, (0.0, 20.0), start, [0.0; 6]).rtol(1e-10).atol(1e-10);
    let run = run.max_steps(20_000).run().unwrap();
    // J. J. Moreau's steps: an explicit change, which the friction then shortens.
    let reference = |count: u32| {
        let (mut q, mut v, h) = (start, [0.0_f64; 6], 20.0 / f64::from(count));
        for step in 0..count {
            let middle: [f64; 6] = core::array::from_fn(|i| q[i] + h / 2.0 * v[i]);
            let t = (f64::from(step) + 0.5) * h;
            let handle = [t.cos(), t.sin()];
            for body in 0..3 {
                let moved: [f64; 2] = core::array::from_fn(|i| {
                    let own = middle[2 * body + i];
                    let mut a = if body == 0 { 2.0 * (handle[i] - own) } else { 0.0 };
                    for other in [body.wrapping_sub(1), body + 1].into_iter().filter(|k| *k < 3) {
                        a += middle[2 * other + i] - own;
                    }
                    v[2 * body + i] + h * a
                });
                let size = moved[0].hypot(moved[1]);
                for i in 0..2 {
                    let left = f64::max(size - h * 0.4, 0.0) / f64::max(size, 1e-300);
                    v[2 * body + i] = moved[i] * left;
                    q[2 * body + i] = middle[2 * body + i] + h / 2.0 * v[2 * body + i];
                }
            }
        }
        q
    };
    let (coarse, fine) = (reference(200_000), reference(400_000));
    for i in 0..6 {
        near(fine[i], coarse[i], 1e-4);
        near(run.end.q[i], fine[i], 1e-4);
    }
    assert!(6 < run.frictions.len() && run.stats.accepted < 5000, "{}", run.stats);
}

#[test]
fn a_thrown_block_is_slowed_along_its_way_where_it_lands() {
    let block = Thrown { m: 2.0, μ: 0.3, e: 0.0, g: 9.8 };
    let down = f64::sqrt(4.0 + 2.0 * 9.8);
    let (flight, left) = ((2.0 + down) / 9.8, 4.0 - 0.3 * down);
    let along = 4.0 * flight + left * left / (2.0 * 2.94);
    for φ in [0.0_f64, 0.5, 2.0] {
        let start = [4.0 * φ.cos(), 4.0 * φ.sin(), 2.0];
        let run = solve(&block, (0.0, 5.0), [0.0, 0.0, 1.0], start).rtol(1e-10).atol(1e-12);
        let run = run.run().unwrap();
        near(run.end.q[0], along * φ.cos(), 1e-9);
        near(run.end.q[1], along * φ.sin(), 1e-9);
        assert_eq!(run.end.v, [0.0; 3]);
        let [landing] = &run.impacts[..] else { panic!("{:?}", run.impacts) };
        near(landing.after.v[0].hypot(landing.after.v[1]), left, 1e-9);
        let slow = [start[0] / 4.0, start[1] / 4.0, 2.0];
        let run = solve(&block, (0.0, 5.0), [0.0, 0.0, 1.0], slow).rtol(1e-10).run().unwrap();
        near(run.end.q[0], flight * φ.cos(), 1e-9);
        assert_eq!(run.end.v, [0.0; 3]);
    }
}

/// Some come to rest with a force just below the friction: the direction of what is left turns
/// faster than tolerances see.
#[test]
#[allow(non_snake_case)]
fn pairs_on_a_belt_move_alike_at_all_tolerances() {
    let mut random = Random::new(1);
    for member in 0..12 {
        let mut number = |low, high| random.uniform(low, high);
        let [m, M, k] = [number(0.5, 2.0), number(0.5, 2.0), number(0.5, 4.0)];
        let [K, A, ω] = [number(0.0, 4.0), number(0.0, 2.0), number(0.5, 3.0)];
        let [u, F, G] = [number(0.0, 0.5), number(0.1, 1.5), number(0.1, 1.5)];
        let pair = Pair { m, M, k, K, A, ω, u, F, G };
        let [q, v] = [[(); 4]; 2].map(|both| both.map(|()| number(-1.0, 1.0)));
        let run = |tolerance: f64| {
            let run = solve(&pair, (0.0, 6.0), q, v).rtol(tolerance).atol(tolerance);
            run.max_steps(3000).run().unwrap().end.q
        };
        let (coarse, fine) = (run(1e-6), run(1e-10));
        for i in 0..4 {
            assert!((coarse[i] - fine[i]).abs() < 1e-5, "{member}: {coarse:?} {fine:?}");
        }
    }
}

#[test]
#[allow(non_snake_case)]
fn impacts_in_space_never_add_energy() {
    let mut random = Random::new(39);
    let mut count = 0;
    for _ in 0..10 {
        let mut three = |low, high| [(); 3].map(|()| random.uniform(low, high));
        let (J, c, [μ, e, _]) = (three(0.2, 0.35), three(-1.0, 1.0), three(0.0, 1.0));
        let dart = Dart { m: 1.0, J, c, μ, e, g: 9.8 };
        let start = Dart::start().x([0.0, 0.0, 2.0], three(-4.0, 4.0));
        let start = start.R(Attitude::identity(), Rates::body(three(-5.0, 5.0)));
        let run = solve(&dart, (0.0, 1.5), start.q, start.v).rtol(1e-8).run().unwrap();
        for impact in &run.impacts {
            let energy = |v: &[f64; 7]| dart.energy(At::of(0.0, &impact.state.q, v));
            let (before, after) = (energy(&impact.state.v), energy(&impact.after.v));
            assert!(after <= before + 1e-12 * before.abs(), "{dart:?} {impact:?}");
            count += 1;
        }
    }
    assert!(20 < count, "{count}");
}

#[test]
fn a_block_above_its_floor_rubs_nowhere() {
    let block = Thrown { m: 2.0, μ: 0.3, e: 0.5, g: 9.8 };
    let run = solve(&block, (0.0, 2.0), [0.0, 0.0, 1.0], [0.0; 3]).rtol(1e-10).run().unwrap();
    assert_eq!((run.end.q[0], run.end.q[1]), (0.0, 0.0));
    assert!(1 < run.impacts.len());
}

#[test]
fn power_is_the_force_times_the_length_of_the_rate() {
    let puck = Puck { P: 1.0, F: 1.5, ..PUCK };
    let run =
        solve(&puck, (0.0, 8.0), [0.0; 2], [-1.0, 2.0]).rtol(1e-10).every(0.01).run().unwrap();
    let power = run.power(&puck).unwrap();
    for (k, state) in run.iter().enumerate() {
        near(power[k], -1.5 * state.v[0].hypot(state.v[1]), 1e-12);
    }
}

#[test]
fn a_saved_run_goes_on_with_the_same_bits() {
    let puck = Puck { P: 1.0, R: 0.3, F: 1.5, ..PUCK };
    let mut run = Integrator::new(&puck, Dop853, 0.0, [0.0; 2], [-1.0, 2.0]).unwrap();
    for _ in 0..60 {
        run.step().unwrap();
        let mut other = Integrator::new(&puck, Dop853, 0.0, [9.0; 2], [1.0; 2]).unwrap();
        other.restore(&run.save()).unwrap();
        let mut same = run.clone();
        for _ in 0..3 {
            same.step().unwrap();
            other.step().unwrap();
            assert_eq!(same.state(), other.state());
        }
    }
}

#[test]
fn single_precision_stops_in_the_plane_too() {
    let puck = Puck { m: 1.0_f32, P: 0.0, R: 0.0, F: 2.94, S: 0.0 };
    let run = solve(&puck, (0.0, 5.0), [0.0; 2], [6.0, 8.0]).rtol(1e-5).atol(1e-5).run().unwrap();
    near(f64::from(run.end.q[0]), 0.6 * 17.0068, 1e-3);
    assert_eq!(run.end.v, [0.0; 2]);
    assert!(run.stats.accepted < 200, "{}", run.stats);
}
