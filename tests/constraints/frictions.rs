//! Dry friction on joints and belts: rates that come to rest, and forces that break away.

use core::f64::consts::{PI, TAU};
use pendulum_runtime::analysis::equilibrium;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Event, Integrator, Slip};
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A block on the ground that a force pushes, with a strength that grows.
    #[derive(Clone, Debug)]
    pub struct Pushed { m: kg, F: N, S: N, L: N, R: N/s }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    force x = L + R*t;
    friction ground: ẋ, force = F, static = S;
}

lagrangian! {
    /// A block on a slope.
    #[derive(Clone, Debug)]
    pub struct Slope { m: kg, α: 1, μ: 1, g: m/s^2 = 9.8 }
    coordinate s: m;
    kinetic = m/2*ṡ^2;
    potential = -m*g*s*sin(α);
    friction ground: ṡ, force = μ*m*g*cos(α);
}

lagrangian! {
    /// A mass on a spring that rubs on the ground.
    #[derive(Clone, Debug)]
    pub struct Rubbing { m: kg, k: N/m, F: N, P: N, ω: Hz, φ: 1 }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
    force x = P*cos(ω*t + φ);
    friction ground: ẋ, force = F;
}

lagrangian! {
    /// A slider under a force that swings.
    #[derive(Clone, Debug)]
    pub struct Slider { m: kg, A: m, w: Hz, F: N }
    coordinate x: m;
    kinetic = m*ẋ^2/2;
    force x = m*A*w^2*sin(w*t);
    friction f: ẋ, force = F;
}

lagrangian! {
    /// A block on a spring and a belt.
    #[derive(Clone, Debug)]
    pub struct Belt { m: kg, k: N/m, F: N, S: N, u: m/s }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
    friction belt: ẋ - u, force = F, static = S;
}

lagrangian! {
    /// A shaft in two brakes.
    #[derive(Clone, Debug)]
    pub struct Brakes { F: 1/s^2, G: 1/s^2, S: 1/s^2, T: 1/s^2, R: 1/s^3 }
    coordinate φ: rad;
    kinetic = φ̇^2/2;
    force φ = R*t;
    friction first: φ̇, force = F, static = S;
    friction second: φ̇, force = G, static = T;
}

lagrangian! {
    /// A block on a belt that a motion drives.
    #[derive(Clone, Debug)]
    pub struct Carried { m: kg, F: N }
    coordinate x: m;
    driven u: m;
    kinetic = m/2*ẋ^2;
    friction belt: ẋ - u_dot, force = F;
}

lagrangian! {
    /// Three blocks between springs and a plate that drives them over the ground.
    #[derive(Clone, Debug)]
    pub struct Train { k: 1/s^2, K: 1/s^2, u: m/s, F: m/s^2 }
    coordinate x[3]: m;
    kinetic = sum(i in 0..3, ẋ[i]^2)/2;
    potential = k/2*((x[0] - x[1])^2 + (x[1] - x[2])^2) + sum(i in 0..3, K/2*(x[i] - u*t)^2);
    friction ground[i in 0..3]: ẋ[i], force = F;
}

lagrangian! {
    /// A pendulum whose joint rubs.
    #[derive(Clone, Debug)]
    pub struct Joint { L: m, M: m^2/s^2, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    kinetic = L^2*θ̇^2/2;
    potential = -g*L*cos(θ);
    friction pin: θ̇, force = M;
}

lagrangian! {
    /// The same pendulum as a bob on a rod.
    #[derive(Clone, Debug)]
    pub struct Bob { L: m, M: m^2/s^2, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    constraint rod: x^2 + y^2 = L^2;
    friction pin: (x*ẏ - y*ẋ)/L^2, force = M;
}

lagrangian! {
    /// A block and a block that it carries.
    #[derive(Clone, Debug)]
    pub struct Stack { m: kg, M: kg, F: N, G: N, R: N/s }
    coordinate x: m;
    coordinate y: m;
    kinetic = M/2*ẋ^2 + m/2*ẏ^2;
    force x = R*t;
    friction ground: ẋ, force = F;
    friction top: ẏ - ẋ, force = G;
}

lagrangian! {
    /// A wheel with a brake that a controller presses.
    #[derive(Clone, Debug)]
    pub struct Wheel { I: kg*m^2, M: N*m }
    coordinate φ: rad;
    input brake: N*m;
    kinetic = I/2*φ̇^2;
    force φ = M;
    friction shoe: φ̇, force = brake;
}

lagrangian! {
    /// A ball on the ground.
    #[derive(Clone, Debug)]
    pub struct Ball { m: kg, r: m, F: N }
    coordinate x: m;
    coordinate φ: rad;
    kinetic = m/2*(ẋ^2 + 2*r^2*φ̇^2/5);
    friction ground: ẋ - r*φ̇, force = F;
}

const RUBBING: Rubbing<f64> = Rubbing { m: 1.0, k: 1.0, F: 0.1, P: 0.0, ω: 1.0, φ: 0.0 };

fn near(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} instead of {expected}");
}

/// Returns the directions of a friction in order, with their starts.
fn modes(frictions: &[Slip], friction: usize) -> Vec<(i8, f64)> {
    let own = frictions.iter().filter(|slip| slip.friction == friction);
    own.map(|slip| (slip.direction, slip.start)).collect()
}

#[test]
fn a_block_slides_to_rest_on_level_ground() {
    let ground = Pushed { m: 1.0, F: 0.3 * 9.8, S: 0.0, L: 0.0, R: 0.0 };
    let solution = solve(&ground, (0.0, 5.0), [0.0], [10.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], 17.006802721088435, 1e-9);
    assert_eq!(solution.end.v, [0.0]);
    let [slip, rest] = &modes(&solution.frictions, 0)[..] else { panic!() };
    assert_eq!((slip.0, rest.0), (1, 0));
    near(rest.1, 10.0 / 2.94, 1e-9);
}

#[test]
fn a_block_stops_on_a_gentle_slope_and_never_on_a_steep_one() {
    let gentle = Slope { m: 2.0, α: 0.2, μ: 0.3, g: 9.8 };
    let slowing = 9.8 * (0.3 * f64::cos(0.2) - f64::sin(0.2));
    let solution = solve(&gentle, (0.0, 20.0), [0.0], [3.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], 9.0 / (2.0 * slowing), 1e-9);
    assert_eq!(solution.end.v, [0.0]);
    let steep = Slope { α: 0.4, ..gentle };
    let a = 9.8 * (f64::sin(0.4) - 0.3 * f64::cos(0.4));
    let solution = solve(&steep, (0.0, 3.0), [0.0], [0.0]).rtol(1e-10).run().unwrap();
    near(solution.end.q[0], 4.5 * a, 1e-9);
    // Uphill, it stops and turns at once.
    let solution = solve(&steep, (0.0, 3.0), [0.0], [-2.0]).rtol(1e-10).run().unwrap();
    let up = 9.8 * (f64::sin(0.4) + 0.3 * f64::cos(0.4));
    let (turn, top) = (2.0 / up, -2.0 / up);
    near(solution.end.q[0], top + a / 2.0 * (3.0 - turn).powi(2), 1e-9);
    assert_eq!(solution.frictions.len(), 2);
}

#[test]
fn a_push_below_static_moves_nothing() {
    let block = Pushed { m: 1.0, F: 1.0, S: 2.0, L: 1.99, R: 0.0 };
    let solution = solve(&block, (0.0, 100.0), [0.5], [0.0]).every(10.0).run().unwrap();
    assert!(solution.q.iter().all(|q| *q == [0.5]), "{:?}", solution.q);
    let [force] = &solution.friction_forces(&block).unwrap()[..] else { panic!() };
    assert!(force.iter().all(|force| (force + 1.99).abs() < 1e-15), "{force:?}");
    assert!(solution.stats.accepted < 100, "{}", solution.stats);
}

#[test]
fn a_push_breaks_away_at_static_and_slides_with_force() {
    let block = Pushed { m: 2.0, F: 1.0, S: 3.0, L: 0.0, R: 0.5 };
    let solution = solve(&block, (0.0, 9.0), [0.0], [0.0]).rtol(1e-10).run().unwrap();
    let rest = |t: f64| 0.5 * t.powi(3) / 6.0 - t * t / 2.0;
    let (start, slope) = (6.0_f64, 0.25 * 36.0 - 6.0);
    near(solution.end.q[0], (rest(9.0) - rest(start) - slope * 3.0) / 2.0, 1e-9);
    near(modes(&solution.frictions, 0)[1].1, 6.0, 1e-9);
}

#[test]
fn half_swings_shrink_by_twice_the_force() {
    let solution =
        solve(&RUBBING, (0.0, 30.0), [1.05], [0.0]).rtol(1e-10).atol(1e-10).run().unwrap();
    near(solution.end.q[0], -0.05, 1e-9);
    assert_eq!(solution.end.v, [0.0]);
    let modes = modes(&solution.frictions, 0);
    let directions: Vec<_> = modes.iter().map(|mode| mode.0).collect();
    assert_eq!(directions, [-1, 1, -1, 1, -1, 0]);
    for (k, (_, start)) in modes.iter().enumerate() {
        near(*start, k as f64 * PI, 1e-9);
    }
    assert!(solution.stats.accepted < 200, "{}", solution.stats);
}

#[test]
fn power_is_the_loss_by_friction() {
    let solution = solve(&RUBBING, (0.0, 30.0), [1.05], [0.0]).rtol(1e-10).every(0.01).run();
    let solution = solution.unwrap();
    let (power, [force]) =
        (solution.power(&RUBBING).unwrap(), &solution.friction_forces(&RUBBING).unwrap()[..])
    else {
        panic!()
    };
    for (k, state) in solution.iter().enumerate() {
        near(power[k], -0.1 * state.v[0].abs(), 1e-12);
        near(power[k], force[k] * state.v[0], 1e-12);
    }
    // Its spring holds what the friction holds.
    near(*force.last().unwrap(), -0.05, 1e-9);
    let energy = solution.energy(&RUBBING);
    near(energy[energy.len() - 1], energy[0] - 0.1 * (1.9 + 1.5 + 1.1 + 0.7 + 0.3), 1e-9);
}

#[test]
fn a_forced_slider_sticks_slides_and_turns() {
    let slider = Slider { m: 1.0, A: 1.0, w: TAU, F: 2.0 };
    let solution = solve(&slider, (0.0, 10.0), [0.0], [10.0]).rtol(1e-10).atol(1e-10).run();
    let solution = solution.unwrap();
    near(solution.end.q[0], 74.318082488, 1e-8);
    assert!(solution.stats.accepted < 1000, "{}", solution.stats);
    let rough = solve(&slider, (0.0, 10.0), [0.0], [10.0]).rtol(1e-4).atol(1e-4).run().unwrap();
    near(rough.end.q[0], 74.318082488, 1e-2);
}

#[test]
fn fixed_steps_end_at_changes_too() {
    let slider = Slider { m: 1.0, A: 1.0, w: TAU, F: 2.0 };
    let solution = solve(&slider, (0.0, 10.0), [0.0], [10.0]).method(Rk4).step(1e-3).run();
    near(solution.unwrap().end.q[0], 74.318082488, 1e-7);
    let solution = solve(&slider, (0.0, 10.0), [0.0], [10.0]).step(0.02).run();
    near(solution.unwrap().end.q[0], 74.318082488, 1e-7);
}

#[test]
fn an_oscillator_turns_twice_a_period_by_den_hartogs_formula() {
    // J. P. Den Hartog, Trans. ASME 53 (1931) 107: amplitude and phase of the motion without stops.
    for (β, friction) in [(0.8_f64, 0.3_f64), (1.4, 0.2), (0.6, 0.1)] {
        let (a, angle) = (1.0 / (1.0 - β * β), PI / β);
        let across = -friction * angle.sin() / (β * (1.0 + angle.cos()));
        let start = (a * a - across * across).sqrt();
        let φ = f64::atan2(across / a, start / a);
        let system = Rubbing { F: friction, P: 1.0, ω: β, φ, ..RUBBING };
        let end = 3.0 * TAU / β;
        let solution =
            solve(&system, (0.0, end), [start], [0.0]).rtol(1e-11).atol(1e-11).run().unwrap();
        near(solution.end.q[0], start, 2e-9);
        near(solution.end.v[0], 0.0, 2e-9);
        let turns = solution.frictions.iter().filter(|slip| slip.start > 0.0).count();
        assert!((5..=6).contains(&turns), "{:?}", solution.frictions);
    }
}

#[test]
fn a_block_on_a_belt_has_the_period_of_its_limit_cycle() {
    let (m, k, force, bound, u) = (2.0, 3.0, 0.5, 1.0, 0.3);
    let belt = Belt { m, k, F: force, S: bound, u };
    let solution = solve(&belt, (0.0, 60.0), [0.0], [0.3]).rtol(1e-10).atol(1e-10).run().unwrap();
    let (ω, y) = (f64::sqrt(k / m), (bound - force) / k);
    let period = (TAU - 2.0 * f64::atan(y * ω / u)) / ω + 2.0 * y / u;
    let slips: Vec<f64> = modes(&solution.frictions, 0)
        .iter()
        .filter(|(direction, _)| *direction == -1)
        .map(|(_, start)| *start)
        .collect();
    assert!(5 < slips.len());
    for pair in slips.windows(2) {
        near(pair[1] - pair[0], period, 1e-8);
    }
}

#[test]
fn a_belt_carries_what_sticks_to_it() {
    let belt = Belt { m: 1.0, k: 0.0, F: 0.5, S: 1.0, u: 0.3 };
    let solution = solve(&belt, (0.0, 5.0), [0.0], [0.0]).rtol(1e-10).every(0.1).run().unwrap();
    near(solution.end.q[0], 0.3 * 5.0 - 0.3 * 0.6 / 2.0, 1e-9);
    for state in solution.iter().filter(|state| 0.7 < state.t) {
        near(state.v[0], 0.3, 1e-16);
    }
}

#[test]
fn two_frictions_on_one_coordinate_hold_together() {
    let brakes = Brakes { F: 0.1, G: 0.2, S: 1.0, T: 0.5, R: 1.0 };
    let solution = solve(&brakes, (0.0, 3.0), [0.0], [0.0]).rtol(1e-10).atol(1e-10).run().unwrap();
    let start = 1.5_f64;
    let rest = |t: f64| t.powi(3) / 6.0 - start * start / 2.0 * t - 0.15 * (t - start).powi(2);
    near(solution.end.q[0], rest(3.0) - rest(start), 1e-9);
    for friction in 0..2 {
        near(modes(&solution.frictions, friction)[1].1, start, 1e-9);
    }
}

#[test]
fn a_stack_moves_as_one_until_its_top_slides() {
    // The ground breaks at R t = F; the top slides when the common acceleration reaches G/m.
    let stack = Stack { m: 1.0, M: 2.0, F: 0.5, G: 0.4, R: 0.5 };
    let solution = solve(&stack, (0.0, 5.0), [0.0; 2], [0.0; 2]).rtol(1e-10).atol(1e-10).run();
    let solution = solution.unwrap();
    let (first, second) = (1.0, (0.4 * 3.0 + 0.5) / 0.5);
    near(modes(&solution.frictions, 0)[1].1, first, 1e-9);
    near(modes(&solution.frictions, 1)[1].1, second, 1e-9);
    // Velocities and places at the second change, by integrals of (R t − F)/3.
    let speed = |t: f64| 0.5 * (t - first).powi(2) / 6.0;
    let place = |t: f64| 0.5 * (t - first).powi(3) / 18.0;
    let left = 5.0 - second;
    near(solution.end.q[1], place(second) + speed(second) * left + 0.2 * left * left, 1e-9);
    near(solution.end.v[1], speed(second) + 0.4 * left, 1e-9);
}

#[test]
fn three_blocks_agree_with_small_steps_of_a_set_valued_law() {
    let train = Train { k: 1.0, K: 0.3, u: 0.1, F: 0.5 };
    let start = [0.0, 0.1, -0.2];
    let solution = solve(&train, (0.0, 40.0), start, [0.0; 3]).rtol(1e-10).atol(1e-10).run();
    let solution = solution.unwrap();
    // J. J. Moreau's steps: an explicit change, which the friction then shortens.
    let reference = |count: u32| {
        let (mut q, mut v, h) = (start, [0.0_f64; 3], 40.0 / f64::from(count));
        for step in 0..count {
            let middle: [f64; 3] = core::array::from_fn(|i| q[i] + h / 2.0 * v[i]);
            let t = (f64::from(step) + 0.5) * h;
            for i in 0..3 {
                let mut a = 0.3 * (0.1 * t - middle[i]);
                for j in [i.wrapping_sub(1), i + 1].into_iter().filter(|j| *j < 3) {
                    a += middle[j] - middle[i];
                }
                let moved = v[i] + h * a;
                v[i] = f64::max(moved.abs() - h * 0.5, 0.0).copysign(moved);
                q[i] = middle[i] + h / 2.0 * v[i];
            }
        }
        q
    };
    let (coarse, fine) = (reference(200_000), reference(400_000));
    for i in 0..3 {
        near(fine[i], coarse[i], 1e-4);
        near(solution.end.q[i], fine[i], 1e-4);
    }
    let slips = solution.frictions.len();
    assert!(6 < slips && solution.stats.accepted < 40 * slips as u64, "{}", solution.stats);
}

#[test]
fn a_joint_rubs_alike_in_an_angle_and_on_a_rod() {
    let (joint, bob) = (Joint { L: 2.0, M: 3.0, g: 9.81 }, Bob { L: 2.0, M: 3.0, g: 9.81 });
    let angle = solve(&joint, (0.0, 20.0), [2.0], [0.3]).rtol(1e-11).atol(1e-11).every(0.5).run();
    let at = |θ: f64| [2.0 * θ.sin(), -2.0 * θ.cos()];
    let ([x, y], v) = (at(2.0), 0.3);
    let rod = solve(&bob, (0.0, 20.0), [x, y], [-y * v, x * v]).rtol(1e-11).atol(1e-11).every(0.5);
    let (angle, rod) = (angle.unwrap(), rod.run().unwrap());
    assert_eq!(angle.end.v, [0.0]);
    for (angle, rod) in angle.iter().zip(&rod) {
        let [x, y] = at(angle.q[0]);
        near(rod.q[0], x, 1e-8);
        near(rod.q[1], y, 1e-8);
    }
    let [tension] = &rod.reactions(&bob).unwrap()[..] else { panic!() };
    // At rest, a rod along r pulls by −2λ r, and the pin holds the rest of the weight across it.
    let θ = angle.end.q[0];
    near(-2.0 * 2.0 * tension[tension.len() - 1], 9.81 * θ.cos(), 1e-7);
}

#[test]
fn a_brake_that_opens_lets_go_at_once() {
    let wheel = Wheel { I: 0.5, M: 1.0 };
    let pressed = |t: f64| if t < 2.0 { 3.0 } else { 0.25 };
    let braked = wheel.controlled_by(move |t, _: &[f64; 1], _: &[f64; 1]| pressed(t));
    let solution = solve(&braked, (0.0, 4.0), [0.0], [4.0]).rtol(1e-10).t_stops(&[2.0]).run();
    let solution = solution.unwrap();
    // It slows by 4, stops after a second, and runs on by 1.5.
    near(solution.end.q[0], 2.0 + 1.5 / 2.0 * 4.0, 1e-9);
    let [_, stop, go] = &modes(&solution.frictions, 0)[..] else { panic!() };
    near(stop.1, 1.0, 1e-9);
    near(go.1, 2.0, 1e-9);
}

#[test]
fn a_kick_ends_sticking() {
    let kick = Event::at([1.0]).then(|state| state.v[0] = -2.0);
    let ground = Pushed { m: 1.0, F: 0.5, S: 1.0, L: 0.0, R: 0.0 };
    let solution =
        solve(&ground, (0.0, 10.0), [0.0], [0.0]).rtol(1e-10).events(&[kick]).run().unwrap();
    near(solution.end.q[0], -4.0, 1e-9);
    let directions: Vec<_> = modes(&solution.frictions, 0).iter().map(|mode| mode.0).collect();
    assert_eq!(directions, [0, -1, 0]);
}

#[test]
fn a_saved_run_goes_on_with_the_same_bits() {
    let belt = Belt { m: 2.0, k: 3.0, F: 0.5, S: 1.0, u: 0.3 };
    let mut run = Integrator::new(&belt, Dop853, 0.0, [0.0], [0.0]).unwrap();
    for _ in 0..60 {
        run.step().unwrap();
        let mut other = Integrator::new(&belt, Dop853, 0.0, [9.0], [1.0]).unwrap();
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
fn single_precision_rubs_too() {
    let ground = Pushed { m: 1.0_f32, F: 2.94, S: 0.0, L: 0.0, R: 0.0 };
    let solution = solve(&ground, (0.0, 5.0), [0.0], [10.0]).rtol(1e-5).atol(1e-5).run().unwrap();
    near(f64::from(solution.end.q[0]), 17.0068, 1e-3);
    assert_eq!(solution.end.v, [0.0]);
    let belt = Belt { m: 2.0_f32, k: 3.0, F: 0.5, S: 1.0, u: 0.3 };
    let solution = solve(&belt, (0.0, 60.0), [0.0], [0.0]).rtol(1e-5).atol(1e-5).run().unwrap();
    assert!(solution.stats.accepted < 1000, "{}", solution.stats);
}

#[test]
fn methods_that_do_not_know_friction_are_refused_by_name() {
    let ground = Pushed { m: 1.0, F: 0.5, S: 1.0, L: 0.0, R: 0.0 };
    let run = solve(&ground, (0.0, 1.0), [0.0], [0.0]);
    let error = run.method(Picard).run().unwrap_err().error;
    assert_eq!(error, Error::Friction { t: 0.0, friction: "ground", method: "Picard" });
    assert!(error.to_string().contains("use `Dop853`, `Rk4`"), "{error}");
}

/// The belt is as fast as the block after 1/3 s, and stops or turns after 1 s.
#[test]
fn what_sticks_to_a_belt_slides_on_where_the_belt_changes_its_speed() {
    let block = Carried { m: 1.0, F: 3.0 };
    for (end, x) in [(1.0, 1.0), (0.0, 0.5), (2.0, 11.0 / 6.0), (0.5, 17.0 / 24.0)] {
        for tolerance in [1e-4, 1e-10] {
            let keys = Curve::linear(&[0.0, 1.0, 2.0], &[[0.0], [1.0], [end]]).unwrap();
            let belt = block.clone().driven_by(keys);
            let run = solve(&belt, (0.0, 2.0), [0.0], [0.0]).rtol(tolerance).run().unwrap();
            near(run.end.q[0], x, 1e-12);
        }
    }
}

#[test]
fn there_is_no_way_back_over_friction() {
    let ground = Pushed { m: 1.0, F: 0.5, S: 1.0, L: 0.0, R: 0.0 };
    let error = solve(&ground, (1.0, 0.0), [0.0], [1.0]).run().unwrap_err().error;
    assert_eq!(error, Error::FrictionBack { t: 1.0, friction: "ground" });
}

#[test]
fn negative_magnitudes_are_refused_with_their_time() {
    let ground = Pushed { m: 1.0, F: 0.5, S: -1.0, L: 0.0, R: 0.0 };
    let error = solve(&ground, (0.0, 1.0), [0.0], [1.0]).run().unwrap_err().error;
    assert_eq!(error, Error::NegativeFriction { t: 0.0, friction: "ground", value: -1.0 });
    let ground = Pushed { F: f64::NAN, S: 1.0, ..ground };
    let error = solve(&ground, (0.0, 1.0), [0.0], [1.0]).run().unwrap_err().error;
    assert!(matches!(error, Error::NotFinite { .. }), "{error}");
}

#[test]
fn a_ball_that_slides_rolls_at_five_sevenths_of_its_speed() {
    let ball = Ball { m: 2.0, r: 0.3, F: 1.5 };
    let solution = solve(&ball, (0.0, 5.0), [0.0; 2], [3.5, 0.0]).rtol(1e-10).run().unwrap();
    near(solution.end.v[0], 2.5, 1e-10);
    near(solution.end.v[0], 0.3 * solution.end.v[1], 1e-15);
    near(solution.frictions[1].start, 1.0 / 0.75, 1e-9);
}

#[test]
fn a_spring_holds_what_a_belt_drags_at_equilibrium() {
    let belt = Belt { m: 2.0, k: 3.0, F: 0.5, S: 1.0, u: 0.3 };
    near(equilibrium(&belt, 0.0, [1.0]).unwrap()[0], 0.5 / 3.0, 1e-15);
    let back = Belt { u: -0.3, ..belt };
    near(equilibrium(&back, 0.0, [1.0]).unwrap()[0], -0.5 / 3.0, 1e-15);
}

#[test]
fn friction_has_nothing_to_hold_at_the_equilibrium_that_is_found() {
    near(equilibrium(&RUBBING, 0.0, [1.0]).unwrap()[0], 0.0, 1e-15);
}
