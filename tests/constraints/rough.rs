//! Dry friction in the contacts of limits, which begin, press and open.

use core::f64::consts::PI;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::Rk4;
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A block whose friction fades towards a place behind a wall.
    #[derive(Clone, Debug)]
    pub struct Bay { k: 1/s^2, w: m, L: m }
    coordinate x: m;
    kinetic = ẋ^2/2;
    limit wall: w >= x, restitution = 1;
    friction ground: ẋ, force = k*(L - x);
}

lagrangian! {
    /// A block over a rough floor, which a force drags and another lifts.
    #[derive(Clone, Debug)]
    pub struct Block { m: kg, μ: 1, e: 1, L: N, R: N/s, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    force x = L;
    force y = R*t;
    limit floor: y >= 0, restitution = e;
    friction grip: ẋ, force = μ*reaction(floor);
}

lagrangian! {
    /// A block on a slope, pressed to it by its weight.
    #[derive(Clone, Debug)]
    pub struct Hillside { α: 1, μ: 1, σ: 1, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*(y*cos(α) - x*sin(α));
    limit slope: y >= 0, restitution = 0;
    friction grip: ẋ, force = μ*reaction(slope), static = σ*reaction(slope);
}

lagrangian! {
    /// A ladder of length 2a between a floor and a wall, at the angle θ from upright.
    #[derive(Clone, Debug)]
    pub struct Ladder { a: m, μ: 1, ν: 1, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    kinetic = (ẋ^2 + ẏ^2 + a^2*θ̇^2/3)/2;
    potential = g*y;
    limit floor: y - a*cos(θ) >= 0, restitution = 0;
    limit wall: x - a*sin(θ) >= 0, restitution = 0;
    friction foot: dot(x + a*sin(θ)), force = μ*reaction(floor);
    friction top: dot(y + a*cos(θ)), force = ν*reaction(wall);
}

lagrangian! {
    /// A rod with one end on a rough floor, at the angle θ from lying.
    #[derive(Clone, Debug)]
    pub struct Rod { a: m, μ: 1, e: 1, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    kinetic = (ẋ^2 + ẏ^2 + a^2*θ̇^2/3)/2;
    potential = g*y;
    limit floor: y - a*sin(θ) >= 0, restitution = e;
    friction tip: dot(x - a*cos(θ)), force = μ*reaction(floor);
}

lagrangian! {
    /// A box on two feet over a rough floor that brakes beneath it.
    #[derive(Clone, Debug)]
    pub struct Crate { w: m, h: m, μ: 1, g: m/s^2 = 9.8 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    let left = [x - w*cos(θ) + h*sin(θ), y - w*sin(θ) - h*cos(θ)];
    let right = [x + w*cos(θ) + h*sin(θ), y + w*sin(θ) - h*cos(θ)];
    kinetic = (ẋ^2 + ẏ^2 + (w^2 + h^2)*θ̇^2/3)/2;
    potential = g*y;
    limit first: height(left) >= 0, restitution = 0;
    limit second: height(right) >= 0, restitution = 0;
    friction heel: dot(left).x, force = μ*reaction(first);
    friction toe: dot(right).x, force = μ*reaction(second);
}

lagrangian! {
    /// Two rods, one on the other, whose end strikes a rough wall.
    #[derive(Clone, Debug)]
    pub struct Arm { h: m, L: m, μ: 1, e: 1 }
    coordinate θ: rad;
    coordinate φ: rad;
    let elbow = L*[sin(θ), -cos(θ)];
    let middle = elbow + L/2*[sin(φ), -cos(φ)];
    let tip = elbow + L*[sin(φ), -cos(φ)];
    kinetic = (|dot(elbow)|^2/3 + |dot(middle)|^2 + L^2*φ̇^2/12)/2;
    limit wall: h + height(tip) >= 0, restitution = e;
    friction end: dot(tip).x, force = μ*reaction(wall);
}

fn near(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} instead of {expected}");
}

const BLOCK: Block<f64> = Block { m: 2.0, μ: 0.3, e: 0.0, L: 0.0, R: 0.0, g: 9.8 };

#[test]
fn a_block_on_a_floor_slides_to_rest() {
    let solution = solve(&BLOCK, (0.0, 5.0), [0.0; 2], [10.0, 0.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], 17.006802721088435, 1e-9);
    near(solution.frictions[1].start, 10.0 / 2.94, 1e-9);
    assert_eq!((solution.end.v, solution.end.q[1]), ([0.0; 2], 0.0));
}

#[test]
fn a_thrown_block_loses_speed_where_it_lands_and_slides_to_rest() {
    let solution = solve(&BLOCK, (0.0, 5.0), [0.0, 1.0], [4.0, 2.0]).rtol(1e-10).run().unwrap();
    let down = f64::sqrt(4.0 + 2.0 * 9.8);
    let (flight, left) = ((2.0 + down) / 9.8, 4.0 - 0.3 * down);
    near(solution.end.q[0], 4.0 * flight + left * left / (2.0 * 2.94), 1e-9);
    let [landing] = &solution.impacts[..] else { panic!("{:?}", solution.impacts) };
    near(landing.impulse, 2.0 * down, 1e-9);
    near(landing.after.v[0], left, 1e-9);
    // Slow blocks stop as they land.
    let solution = solve(&BLOCK, (0.0, 5.0), [0.0, 1.0], [1.0, 2.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], flight, 1e-9);
    assert_eq!(solution.end.v, [0.0; 2]);
}

#[test]
fn a_block_that_bounces_is_slowed_by_each_bounce() {
    let bouncing = Block { e: 0.5, ..BLOCK };
    let solution = solve(&bouncing, (0.0, 10.0), [0.0, 1.0], [9.0, 0.0]).rtol(1e-10).run().unwrap();
    let mut down = f64::sqrt(2.0 * 9.8);
    let (mut speed, mut place) = (9.0, 9.0 * down / 9.8);
    for _ in 0..60 {
        speed -= 0.3 * 1.5 * down;
        down *= 0.5;
        place += speed * 2.0 * down / 9.8;
    }
    near(solution.end.q[0], place + speed * speed / (2.0 * 2.94), 1e-7);
    assert!(solution.stats.accepted < 1000, "{}", solution.stats);
}

#[test]
fn a_block_that_is_lifted_breaks_away_slides_and_leaves() {
    let lifted = Block { L: 3.0, R: 4.0, ..BLOCK };
    let solution = solve(&lifted, (0.0, 6.0), [0.0; 2], [0.0; 2]).rtol(1e-10).every(0.5).run();
    let solution = solution.unwrap();
    let (start, open) = ((19.6 - 10.0) / 4.0, 4.9);
    near(solution.frictions[0].end, start, 1e-9);
    // m ẍ = L − μ(m g − R t) up to the lift, L beyond.
    let speed = |t: f64| (0.6 * (t * t - start * start) - 2.88 * (t - start)) / 2.0;
    let place = |t: f64| {
        let cubes = 0.2 * (t.powi(3) - start.powi(3)) - 0.6 * start * start * (t - start);
        (cubes - 1.44 * (t - start).powi(2)) / 2.0
    };
    let left = 6.0 - open;
    near(solution.end.q[0], place(open) + speed(open) * left + 0.75 * left * left, 1e-8);
    near(solution.end.q[1], 4.0 * left.powi(3) / 12.0, 1e-8);
    let ([floor], [grip]) = (
        &solution.contact_forces(&lifted).unwrap()[..],
        &solution.friction_forces(&lifted).unwrap()[..],
    ) else {
        panic!()
    };
    for (k, t) in solution.t.iter().enumerate() {
        near(floor[k], f64::max(19.6 - 4.0 * t, 0.0), 1e-8);
        let held = if *t < start { -3.0 } else { -0.3 * floor[k] };
        near(grip[k], held, 1e-8);
    }
}

#[test]
fn a_block_on_a_slope_holds_by_static_and_slides_by_force() {
    let held = Hillside { α: 0.3, μ: 0.2, σ: 0.31, g: 9.8 };
    let at = |system: &Hillside<f64>, v| {
        solve(system, (0.0, 2.0), [0.0; 2], [v, 0.0]).rtol(1e-10).run().unwrap().end
    };
    assert_eq!(at(&held, 0.0).q, [0.0; 2]);
    let a = 9.8 * (f64::sin(0.3) - 0.2 * f64::cos(0.3));
    near(at(&held, 1.0).q[0], 2.0 + 2.0 * a, 1e-9);
    near(at(&Hillside { σ: 0.3, ..held }, 0.0).q[0], 2.0 * a, 1e-9);
}

#[test]
fn a_ladder_slips_beyond_the_angle_of_its_frictions() {
    let ladder = Ladder { a: 1.5, μ: 0.4, ν: 0.3, g: 9.8 };
    let critical = f64::atan(2.0 * 0.4 / (1.0 - 0.4 * 0.3));
    for (off, holds) in [(-0.3, true), (-1e-6, true), (1e-6, false), (0.2, false)] {
        let θ = critical + off;
        let start = [1.5 * θ.sin(), 1.5 * θ.cos(), θ];
        let solution = solve(&ladder, (0.0, 3.0), start, [0.0; 3]).rtol(1e-9).atol(1e-9);
        let end = solution.max_steps(10_000).run().unwrap().end;
        assert_eq!((end.q[2] - θ).abs() < 1e-9, holds, "{off}: {end:?}");
    }
}

#[test]
fn a_crate_that_slides_stops_with_both_feet_on_the_floor() {
    let box_ = Crate { w: 1.0, h: 0.5, μ: 0.4, g: 9.8 };
    let solution =
        solve(&box_, (0.0, 3.0), [0.0, 0.5, 0.0], [3.0, 0.0, 0.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], 9.0 / (2.0 * 3.92), 1e-9);
    near(solution.end.q[2], 0.0, 1e-12);
    assert!(solution.end.v.iter().all(|v| v.abs() < 1e-15), "{:?}", solution.end);
    // A tall one, with μ beyond w/h, tips over its toe.
    let tall = Crate { w: 0.2, h: 1.0, ..box_ };
    let solution =
        solve(&tall, (0.0, 0.3), [0.0, 1.0, 0.0], [3.0, 0.0, 0.0]).rtol(1e-10).run().unwrap();
    assert!(solution.end.q[2] < -0.01, "{:?}", solution.end);
}

#[test]
fn the_rod_of_painleve_runs_below_its_critical_friction_only() {
    // P. Painlevé (1895): at tan θ = 2 a force of the floor closes the contact for μ > 4/3.
    let θ = f64::atan(2.0);
    let run = |μ: f64| {
        let rod = Rod { a: 1.0, μ, e: 0.0, g: 9.8 };
        solve(&rod, (0.0, 0.01), [0.0, θ.sin(), θ], [-2.0, 0.0, 0.0]).rtol(1e-9).run()
    };
    let back = |μ: f64| {
        let rod = Rod { a: 1.0, μ, e: 0.0, g: 9.8 };
        solve(&rod, (0.0, 0.01), [0.0, θ.sin(), θ], [2.0, 0.0, 0.0]).rtol(1e-9).run()
    };
    let below = [run(1.3), back(1.3)];
    assert!(below.iter().all(Result::is_ok), "{below:?}");
    let above: Vec<_> = [run(1.4), back(1.4)].into_iter().filter_map(Result::err).collect();
    let [failure] = &above[..] else { panic!("{above:?}") };
    assert!(matches!(failure.error, Error::NoGrip { friction: "tip", .. }), "{failure}");
}

#[test]
fn impacts_with_friction_never_add_energy() {
    let mut random = Random::new(39);
    let mut count = 0;
    for _ in 0..200 {
        let rod = Rod {
            a: random.uniform(0.5, 2.0),
            μ: random.uniform(0.0, 1.2),
            e: random.uniform(0.0, 1.0),
            g: 9.8,
        };
        let θ = random.uniform(0.1, PI - 0.1);
        let start = [0.0, rod.a * θ.sin() + random.uniform(0.01, 1.0), θ];
        let v = [(); 3].map(|()| random.uniform(-4.0, 4.0));
        let run = solve(&rod, (0.0, 0.6), start, v).rtol(1e-8).run();
        let impacts = match run {
            Ok(solution) => solution.impacts,
            Err(failure) => failure.partial.impacts,
        };
        for impact in &impacts {
            let energy =
                |v: &[f64; 3]| v[0] * v[0] + v[1] * v[1] + rod.a * rod.a * v[2] * v[2] / 3.0;
            let (before, after) = (energy(&impact.state.v), energy(&impact.after.v));
            assert!(after <= before * (1.0 + 1e-12), "{rod:?} {impact:?}");
            count += 1;
        }
    }
    assert!(100 < count, "{count}");
}

/// T. R. Kane (1984): the laws of Newton and Coulomb together let this impact add more than half to
/// the energy.
#[test]
fn the_double_pendulum_of_kane_gains_no_energy_at_a_wall() {
    let (θ, φ, v) = (f64::to_radians(20.0), f64::to_radians(30.0), [-0.1, -0.2]);
    let half = (θ - φ).cos() / 2.0;
    let energy = |v: &[f64; 2]| (4.0 * v[0] * v[0] + v[1] * v[1]) / 6.0 + half * v[0] * v[1];
    let closing = |v: &[f64; 2]| θ.sin() * v[0] + φ.sin() * v[1];
    let along = |v: &[f64; 2]| θ.cos() * v[0] + φ.cos() * v[1];
    let response = |normal: [f64; 2]| {
        let size = 4.0 / 9.0 - half * half;
        let [a, b] = normal;
        [(a / 3.0 - half * b) / size, (4.0 / 3.0 * b - half * a) / size]
    };
    // The impulses that reverse half of the one rate, and end the other.
    let (press, rub) = (response([θ.sin(), φ.sin()]), response([θ.cos(), φ.cos()]));
    let (a, b, c) = (closing(&press), closing(&rub), along(&rub));
    let (normal, other) = (-1.5 * closing(&v), -along(&v));
    let (impulse, shear) = (normal * c - b * other, a * other - b * normal);
    assert!(shear.abs() < 0.5 * impulse, "it sticks: {shear} {impulse}");
    let size = a * c - b * b;
    let gained = [0, 1].map(|i| v[i] + (impulse * press[i] + shear * rub[i]) / size);
    assert!(1.5 * energy(&v) < energy(&gained));

    let arm = Arm { h: θ.cos() + φ.cos(), L: 1.0, μ: 0.5, e: 0.5 };
    let solution = solve(&arm, (0.0, 0.01), [θ, φ], v).rtol(1e-10).run().unwrap();
    let [impact] = &solution.impacts[..] else { panic!("{:?}", solution.impacts) };
    // The end slides, stops and leaves in the same direction as before the impact: the three
    // straight pieces of the path, with 30 digits.
    near(impact.after.v[0], -0.198932335971350997, 1e-14);
    near(impact.after.v[1], 0.223136785376607379, 1e-14);
    near(impact.impulse, 0.118399688472988844, 1e-14);
    assert!(energy(&impact.after.v) <= energy(&v) * (1.0 + 1e-12), "{impact:?}");
}

#[test]
fn a_ladder_that_falls_into_its_corner_moves_alike_at_all_tolerances() {
    let ladder = Ladder { a: 1.3, μ: 0.73, ν: 0.07, g: 9.8 };
    let run = |tolerance: f64| {
        let run = solve(&ladder, (0.0, 0.8), [1.23, 1.0, 0.91], [0.0; 3]);
        run.rtol(tolerance).atol(tolerance).run().unwrap()
    };
    let (fine, coarse) = (run(1e-10), run(1e-7));
    for i in 0..3 {
        near(coarse.end.q[i], fine.end.q[i], 1e-6);
    }
    // What strikes stays, with rates that are zero: floor and wall.
    let [.., last] = &fine.impacts[..] else { panic!() };
    let ([x, y, turn], θ) = (last.after.v, last.after.q[2]);
    near(y + 1.3 * turn * θ.sin(), 0.0, 1e-14);
    near(x - 1.3 * turn * θ.cos(), 0.0, 1e-14);
}

/// A step of half a second would end at 1.1 m, where the magnitude is negative.
#[test]
fn what_lies_behind_a_wall_does_not_count() {
    let bay = Bay { k: 1e-3, w: 0.5, L: 1.0 };
    let run = solve(&bay, (0.0, 0.5), [0.1], [2.0]).method(Rk4).step(0.5).run().unwrap();
    assert_eq!(run.impacts.len(), 1);
    assert!((run.end.q[0] + 0.1).abs() < 1e-3, "{}", run.end.q[0]);
}
