//! Dry friction that the reactions of constraints press: on wires, walls and pins.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::Rk4;
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A bead on a hoop, which lies or stands.
    #[derive(Clone, Debug)]
    pub struct Hoop { R: m, μ: 1, g: m/s^2 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    constraint ring: (x^2 + y^2)/(2*R) = R/2;
    friction wire: (x*ẏ - y*ẋ)/R, force = μ*abs(reaction(ring));
    output push: m/s^2 = reaction(ring);
    output rub: m/s^2 = reaction(wire);
}

lagrangian! {
    /// A bead on a straight wire at the angle α, whose friction slides by the horizontal rate.
    #[derive(Clone, Debug)]
    pub struct Line { α: 1, μ: 1, σ: 1, P: m/s^2, R: m/s^3, g: m/s^2 = 9.8 }
    coordinate p: [m; 2];
    let n = [-sin(α), cos(α)];
    kinetic = |ṗ|^2/2;
    potential = g*p.y;
    force p.x = P + R*t;
    constraint wire: inner(p, n) = 0;
    friction grip: dot(p).x, force = μ*abs(reaction(wire)), static = σ*abs(reaction(wire));
    output push: m/s^2 = reaction(wire);
}

lagrangian! {
    /// A block on a wall, which a force with a slope presses to it.
    #[derive(Clone, Debug)]
    pub struct Wall { P: m/s^2, β: 1, μ: 1, σ: 1, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    force x = P*cos(β);
    force y = P*sin(β);
    constraint wall: x = 0;
    friction grip: ẏ, force = μ*|reaction(wall)|, static = σ*|reaction(wall)|;
}

lagrangian! {
    /// A body on a pin of radius r, which rubs under the length of the pin's force.
    #[derive(Clone, Debug)]
    pub struct Pin { L: m, k: m^2, r: m, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    coordinate θ: rad;
    kinetic = (|ṗ|^2 + k*θ̇^2)/2;
    potential = g*p.y;
    constraint pin: p = L*[sin(θ), -cos(θ)];
    friction joint: θ̇, force = r*|reaction(pin)|;
    output rub: m^2/s^2 = reaction(joint);
}

lagrangian! {
    /// Two beads on rough rods side by side, with a spring between them.
    #[derive(Clone, Debug)]
    pub struct Beads { μ: 1, k: 1/s^2, d: m, P: m/s^2 }
    coordinate p[2]: [m; 2];
    kinetic = sum(i in 0..2, |ṗ[i]|^2/2);
    potential = k/2*|p[1] - p[0]|^2;
    force p[0].x = P;
    constraint rod[i in 0..2]: p[i].y = i*d;
    friction grip[i in 0..2]: ṗ[i].x, force = μ*abs(reaction(rod[i]));
    output push: [m/s^2; 2] = reaction(rod);
}

lagrangian! {
    /// A bead on a wire that a motion drives, with a stop.
    #[derive(Clone, Debug)]
    pub struct Carried { μ: 1, L: m, e: 1 }
    coordinate x: m;
    coordinate y: m;
    driven s: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    constraint wire: y = s;
    limit stop: L - x >= 0, restitution = e;
    friction grip: ẋ, force = μ*abs(reaction(wire));
}

lagrangian! {
    /// A puck between two plates, which turn it aside.
    #[derive(Clone, Debug)]
    pub struct Puck { μ: 1, N: m/s^2 }
    coordinate p: [m; 3];
    kinetic = |ṗ|^2/2;
    force p.z = N;
    constraint plate: p.z = 0;
    friction grip: [dot(p).x, dot(p).y], force = μ*abs(reaction(plate));
}

lagrangian! {
    /// A bead on a wire that a wheel lifts and turns: what sticks leaves one freedom.
    #[derive(Clone, Debug)]
    pub struct Crank { α: 1, μ: 1, J: m^2, k: 1/s^2, P: m^2/s^2, ω: Hz, L: m, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    kinetic = (ẋ^2 + ẏ^2 + J*θ̇^2)/2;
    potential = g*y + k/2*(x^2 + L^2*θ^2);
    force θ = P*sin(ω*t);
    constraint wire: y = α*x + L*θ/5;
    friction grip: ẋ + L*θ̇/3, force = μ*abs(reaction(wire));
}

fn near(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} instead of {expected}");
}

#[test]
fn a_bead_on_a_flat_rough_hoop_loses_its_speed_by_the_angle() {
    let hoop = Hoop { R: 1.0, μ: 0.4, g: 0.0 };
    for (s, v) in [(1.0, 3.0), (-1.0, 2.0)] {
        let solution = solve(&hoop, (0.0, 6.0), [1.0, 0.0], [0.0, s * v]).rtol(1e-11).atol(1e-11);
        let solution = solution.every(0.5).run().unwrap();
        for state in &solution {
            let slower = 1.0 + 0.4 * v * state.t;
            let (φ, speed) = (slower.ln() / 0.4, v / slower);
            let [x, y] = state.q;
            near(x, φ.cos(), 1e-9);
            near(y, s * φ.sin(), 1e-9);
            near(state.v[0].hypot(state.v[1]), v * (-0.4 * φ).exp(), 1e-9);
            near(hoop.push(state.t, &state.q, &state.v), -speed * speed, 1e-9);
        }
        let [rub] = &solution.friction_forces(&hoop).unwrap()[..] else { panic!() };
        near(rub[0], -s * 0.4 * v * v, 1e-12);
        let power = solution.power(&hoop).unwrap();
        near(power[0], -0.4 * v.powi(3), 1e-12);
    }
}

/// The equations in the angle, by Taylor series with 20 digits between the changes of the sign of
/// the reaction and of the rate.
#[test]
fn a_bead_on_a_standing_rough_hoop_comes_to_rest() {
    let hoop = Hoop { R: 0.5, μ: 0.3, g: 9.81 };
    for (speed, angle, time) in
        [(17.0, 6.127751613825793, 1.991987537450519), (16.0, 6.159624378748658, 2.209091149232874)]
    {
        let solution = solve(&hoop, (0.0, 4.0), [0.0, -0.5], [0.5 * speed, 0.0]);
        let solution = solution.rtol(1e-11).atol(1e-11).run().unwrap();
        near(solution.end.q[0], 0.5 * f64::sin(angle), 1e-9);
        near(solution.end.q[1], -0.5 * f64::cos(angle), 1e-9);
        assert!(solution.end.v.iter().all(|v| v.abs() < 1e-30), "{:?}", solution.end.v);
        let last = solution.frictions.last().unwrap();
        assert_eq!((last.name, last.direction), ("wire", 0));
        near(last.start, time, 1e-8);
        // While it rests, the wire holds its weight.
        let forces = solution.friction_forces(&hoop).unwrap();
        near(*forces[0].last().unwrap(), 9.81 * f64::sin(angle), 1e-9);
        assert!(solution.stats.accepted < 2000, "{}", solution.stats);
    }
    // In fixed steps, kinks of the force lie within.
    let solution = solve(&hoop, (0.0, 4.0), [0.0, -0.5], [8.5, 0.0]).method(Rk4).step(1e-3).run();
    near(solution.unwrap().end.q[0], 0.5 * f64::sin(6.127751613825793), 1e-4);
}

/// With the rate ẋ, the friction φ along x and the reaction λ, λ = (g cos α + P sin α) + φ sin α
/// and φ = −s μ |λ|; the acceleration along the wire is P cos α − g sin α + φ cos α.
#[test]
fn a_friction_that_presses_its_own_wire_has_the_force_that_it_presses() {
    let mut random = Random::new(39);
    let mut jams = 0;
    for _ in 0..200 {
        let [α, μ, push] =
            [random.uniform(-1.4, 1.4), random.uniform(0.0, 1.5), random.uniform(-30.0, 30.0)];
        let line = Line { α, μ, σ: 0.0, P: push, R: 0.0, g: 9.8 };
        let (sin, cos) = (f64::sin(α), f64::cos(α));
        let s = if random.uniform(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
        let run = solve(&line, (0.0, 0.01), [0.0; 2], [100.0 * s * cos, 100.0 * s * sin]);
        let run = run.rtol(1e-11).run();
        if 1.0 <= μ * sin.abs() {
            let error = run.unwrap_err().error;
            assert!(matches!(error, Error::NoGrip { friction: "grip", .. }), "{error}");
            jams += 1;
            continue;
        }
        let alone = 9.8 * cos + push * sin;
        // λ = alone + φ sin α solves λ (1 + s μ sin α sign λ) = alone.
        let λ = alone / (1.0 + s * μ * sin * alone.signum());
        let a = push * cos - 9.8 * sin - s * μ * λ.abs() * cos;
        let solution = run.unwrap();
        let along = 100.0 * s * 0.01 + a * 0.01 * 0.01 / 2.0;
        near(solution.end.q[0], along * cos, 1e-12);
        near(solution.end.q[1], along * sin, 1e-12);
    }
    assert!(10 < jams, "{jams}");
}

#[test]
fn a_bead_on_a_straight_wire_sticks_up_to_its_static_reaction() {
    // At rest, φ keeps ẍ = 0: φ = g tan α − P, and λ = g cos α + g sin² α/cos α, in any direction.
    let (α, σ) = (0.4_f64, 0.6);
    let line = Line { α, μ: 0.3, σ, P: 0.0, R: 2.0, g: 9.8 };
    let solution = solve(&line, (0.0, 8.0), [0.0; 2], [0.0; 2]).rtol(1e-11).atol(1e-11).run();
    let solution = solution.unwrap();
    let λ = 9.8 / α.cos();
    let start = 0.5 * (9.8 * α.tan() + σ * λ);
    assert!(9.8 * α.tan() < σ * λ);
    let [rest, slide] = &solution.frictions[..] else { panic!("{:?}", solution.frictions) };
    assert_eq!((rest.direction, slide.direction), (0, 1));
    near(slide.start, start, 1e-9);
    // It slides with λ (1 + μ sin α) = g cos α + P sin α.
    let (sin, cos) = (α.sin(), α.cos());
    let force = |t: f64| 2.0 * t * cos - 9.8 * sin;
    let pressed = |t: f64| (9.8 * cos + 2.0 * t * sin) / (1.0 + 0.3 * sin);
    let a = |t: f64| force(t) - 0.3 * cos * pressed(t);
    let slope = (a(8.0) - a(start)) / (8.0 - start);
    let left: f64 = 8.0 - start;
    let along = a(start) * left.powi(2) / 2.0 + slope * left.powi(3) / 6.0;
    near(solution.end.q[0], along * cos, 1e-9);
}

#[test]
fn a_block_that_is_pressed_to_a_wall_falls_rests_or_rises() {
    for (push, β, a) in [
        (20.0, 0.0, 9.8 - 8.0),
        (20.0, 0.1, 0.0),
        (30.0, 0.0, 0.0),
        (40.0, 1.2, 0.4 * 40.0 * f64::cos(1.2) + 9.8 - 40.0 * f64::sin(1.2)),
        (-20.0, 0.0, 9.8 - 8.0),
    ] {
        let wall = Wall { P: push, β, μ: 0.4, σ: 0.45, g: 9.8 };
        let solution = solve(&wall, (0.0, 2.0), [0.0; 2], [0.0; 2]).rtol(1e-11).run().unwrap();
        near(solution.end.q[1], -2.0 * a, 1e-9);
        let [force] = &solution.friction_forces(&wall).unwrap()[..] else { panic!() };
        let own = 9.8 - push * f64::sin(β);
        near(force[0], own - a, 1e-12);
    }
}

/// The equation in the angle, where the moment is the root of a quadratic, by Taylor series with 20
/// digits.
#[test]
fn a_pin_rubs_under_the_length_of_its_force() {
    let pin = Pin { L: 0.3, k: 0.02, r: 0.04, g: 9.81 };
    let at = |θ: f64| [0.3 * θ.sin(), -0.3 * θ.cos(), θ];
    let solution = solve(&pin, (0.0, 4.0), at(1.2), [0.0; 3]).rtol(1e-11).atol(1e-11).run();
    let solution = solution.unwrap();
    near(solution.end.q[2], -0.09632113665572082, 1e-9);
    let stops: Vec<f64> = solution.frictions.iter().map(|own| own.end).collect();
    for (found, expected) in stops.iter().zip([
        0.6467794708100813,
        1.267661373799417,
        1.877150054003621,
        2.482848510428953,
    ]) {
        near(*found, expected, 1e-9);
    }
    assert!(solution.end.v.iter().all(|v| v.abs() < 1e-30), "{:?}", solution.end);
}

/// The equations with each sign of the reaction and of the rate, by Taylor series with 14 digits.
#[test]
fn what_sticks_on_a_wire_breaks_away_while_the_rest_moves() {
    let crank = Crank { α: -0.5, μ: 0.4, J: 0.5, k: 3.6, P: 0.6, ω: 3.0, L: 1.0, g: 9.8 };
    let (q, v) = ([0.97, -0.326, 0.795], [1.114, -0.1612, 1.979]);
    for tolerance in [1e-6, 1e-8, 1e-11] {
        let solution = solve(&crank, (0.0, 5.0), q, v).rtol(tolerance).atol(tolerance).run();
        let end = solution.unwrap();
        near(end.end.q[0], 1.574875280656295, 30.0 * tolerance + 1e-10);
        near(end.end.q[2], -0.3477443620255777, 30.0 * tolerance + 1e-10);
        let modes: Vec<i8> = end.frictions.iter().map(|own| own.direction).collect();
        assert_eq!(modes, [1, 0, -1, 0], "{:?}", end.frictions);
        for (own, expected) in
            end.frictions.iter().zip([0.25220898172799, 2.9315370858203, 3.2853036398069])
        {
            near(own.end, expected, 30.0 * tolerance + 1e-9);
        }
    }
}

#[test]
fn members_of_families_rub_by_their_own_reactions() {
    // The spring presses both beads by k d.
    let beads = Beads { μ: 0.25, k: 2.0, d: 0.8, P: 3.0 };
    let solution = solve(&beads, (0.0, 1.0), [0.0, 0.0, 0.0, 0.8], [0.0; 4]).rtol(1e-11).every(0.1);
    let solution = solution.run().unwrap();
    // The first moves by ẍ = P − μ k d − k x, until the spring pulls the second off.
    let whole = (3.0 - 0.4) / 2.0;
    let free = f64::acos(1.0 - 0.2 / whole) / 2.0_f64.sqrt();
    near(solution.q[1][0], whole * (1.0 - f64::cos(0.1 * 2.0_f64.sqrt())), 1e-9);
    let starts: Vec<_> = solution.frictions.iter().filter(|own| own.name == "grip[1]").collect();
    assert_eq!((starts[0].direction, starts[1].direction), (0, 1), "{:?}", solution.frictions);
    near(starts[1].start, free, 1e-9);
    let [push, other] = beads.push(0.0, &solution.q[0], &solution.v[0]);
    near(push, -1.6, 1e-12);
    near(other, 1.6, 1e-12);
}

#[test]
fn a_puck_between_plates_slides_straight_and_stops() {
    let puck = Puck { μ: 0.2, N: 5.0 };
    let solution = solve(&puck, (0.0, 9.0), [0.0; 3], [3.0, 4.0, 0.0]).rtol(1e-11).run().unwrap();
    near(solution.end.q[0], 0.6 * 12.5, 1e-9);
    near(solution.end.q[1], 0.8 * 12.5, 1e-9);
    assert_eq!(solution.end.v, [0.0; 3]);
}

#[test]
fn a_stop_along_the_wire_leaves_the_wire_without_an_impulse() {
    // s = sin(t)/2 presses by sin(t)/2.
    let carried = Carried { μ: 0.5, L: 1.0, e: 0.5 }.driven_by(Sinusoid::new([0.5], 1.0, [0.0]));
    let run = solve(&carried, (0.0, 3.0), [0.0; 2], [2.0, 0.5]).rtol(1e-11).atol(1e-11).run();
    let (speed, place) =
        (|t: f64| 2.0 - 0.25 * (1.0 - t.cos()), |t: f64| 2.0 * t - 0.25 * (t - t.sin()));
    let mut t = 0.5;
    for _ in 0..9 {
        t -= (place(t) - 1.0) / speed(t);
    }
    let back = (0.25 * t.cos() - 0.5 * speed(t)) * (3.0 - t) - 0.25 * (f64::sin(3.0) - t.sin());
    let end = run.unwrap().end;
    near(end.q[0], 1.0 + back, 1e-9);
    near(end.q[1], 0.5 * f64::sin(3.0), 1e-12);
}

#[test]
fn a_constraint_that_jumps_is_an_error_and_names_the_friction() {
    let carried = Carried { μ: 0.5, L: 9.0, e: 0.0 };
    let jumps = carried.driven_by(Curve::linear(&[0.0, 1.0, 2.0], &[[0.0], [0.0], [1.0]]).unwrap());
    let error = solve(&jumps, (0.0, 2.0), [0.0; 2], [2.0, 0.0]).run().unwrap_err().error;
    assert_eq!(error, Error::FrictionImpulse { t: 1.0, friction: "grip" });
}
