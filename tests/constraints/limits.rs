//! Limits during a run: impacts, contacts and releases.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Event, Integrator, impact};
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A shuttle between two walls.
    #[derive(Clone, Debug)]
    pub struct Shuttle { m: kg, w: m, e: 1 }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    limit left: x + w >= 0, restitution = e;
    limit right: w >= x, restitution = e;
}

lagrangian! {
    /// A ball over a floor.
    #[derive(Clone, Debug)]
    pub struct Ball { e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit floor: y >= 0, restitution = e;
}

lagrangian! {
    /// A ball on a floor that is driven up and down.
    #[derive(Clone, Debug)]
    pub struct Shaken { a: m, ω: Hz, e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit floor: y >= a*sin(ω*t), restitution = e;
}

lagrangian! {
    /// A ball on a floor that somebody moves.
    #[derive(Clone, Debug)]
    pub struct Lifted { e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    driven floor: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit ground: y >= floor, restitution = e;
}

lagrangian! {
    /// A double pendulum whose second link cannot fold back.
    #[derive(Clone, Debug)]
    pub struct Knee { e: 1, g: 1/s^2 = 9.81 }
    coordinate α: rad;
    coordinate β: rad;
    let a = [sin(α), -cos(α)];
    let b = a + [sin(β), -cos(β)];
    kinetic = (|ȧ|^2 + |ḃ|^2)/2;
    potential = g*(height(a) + height(b));
    limit stop: β - α >= -0.1, restitution = e;
}

lagrangian! {
    /// A cart between two walls, on a spring, which drifts along them.
    #[derive(Clone, Debug)]
    pub struct Cart { k: 1/s^2, L: m }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = k*x^2/2;
    limit left: x + L >= 0, restitution = 1;
    limit right: L >= x, restitution = 1;
}

lagrangian! {
    /// A bead on a circle over a floor.
    #[derive(Clone, Debug)]
    pub struct Bead { r: m, h: m, e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    constraint circle: x^2 + y^2 = r^2;
    limit floor: y + h >= 0, restitution = e;
}

lagrangian! {
    /// The same bead in one angle from below.
    #[derive(Clone, Debug)]
    pub struct BeadAngle { r: m, h: m, e: 1, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    kinetic = r^2*θ̇^2/2;
    potential = -g*r*cos(θ);
    limit floor: h - r*cos(θ) >= 0, restitution = e;
}

lagrangian! {
    /// A block on a dome: it slides down and leaves it.
    #[derive(Clone, Debug)]
    pub struct Dome { r: m, e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    limit dome: x^2 + y^2 >= r^2, restitution = e;
}

lagrangian! {
    /// A ball in a corner.
    #[derive(Clone, Debug)]
    pub struct Corner { e: 1, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*(y + x/2);
    limit wall: x >= 0, restitution = e;
    limit floor: y >= 0, restitution = e;
}

lagrangian! {
    /// Two balls on a rod in a corner between a floor and a wall.
    #[derive(Clone, Debug)]
    pub struct Dumbbell { L: m, e: 1, f: 1, gx: m/s^2, gy: m/s^2 }
    coordinate x: m;
    coordinate y: m;
    coordinate u: m;
    coordinate w: m;
    kinetic = (ẋ^2 + ẏ^2 + u̇^2 + ẇ^2)/2;
    potential = gx*(x + u) + gy*(y + w);
    constraint rod: (u-x)^2 + (w-y)^2 = L^2;
    limit first: y >= 0, restitution = e;
    limit second: w >= 0, restitution = f;
    limit third: x >= 0, restitution = e;
    limit fourth: u >= 0, restitution = f;
}

lagrangian! {
    /// A ball over a floor of ridges.
    #[derive(Clone, Debug)]
    pub struct Ridges { a: m, k: 1/m, g: m/s^2 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    limit floor: y >= a*sin(k*x), restitution = 1;
}

/// The height of the end of a rod on the floor is rounded as the rod is long, even at zero.
#[test]
fn a_turning_rod_leaves_the_floor() {
    let mut random = Random::new(12);
    for _ in 0..40 {
        let [a, b, angle] = [(); 3].map(|()| random.uniform(-1.0, 1.0));
        let (length, turn) = (1.0 + 0.5 * b, 2.0 * random.uniform(-1.0, 1.0));
        let (e, f) = (0.5 + 0.5 * a, if b < 0.0 { 0.0 } else { b });
        let rod = Dumbbell { L: length, e, f, gx: 2.0 + a, gy: 9.81 };
        let arm = [length * (3.1 * angle).cos(), length * (3.1 * angle).sin()];
        let corner = [length + 0.1 * (1.0 + a), length + 0.1 * (1.0 + b)];
        let q = [corner[0], corner[1], corner[0] + arm[0], corner[1] + arm[1]];
        let v = [a, 0.0, a - turn * arm[1], turn * arm[0]];
        let run = solve(&rod, (0.0, 6.0), q, v).rtol(1e-10).atol(1e-10).every_step();
        let run = run.max_steps(20_000).run().unwrap();
        let mut least = f64::INFINITY;
        for state in &run {
            let energy = rod.energy(At::of(state.t, &state.q, &state.v));
            assert!(energy < least + 1e-7, "{energy} after {least} at {}: {rod:?}", state.t);
            least = f64::min(least, energy);
            assert!(state.q.iter().all(|q| -1e-9 < *q), "{state:?}: {rod:?}");
        }
    }
}

/// On a parabola the steps are as long as the flight, over many ridges.
#[test]
fn a_ball_flies_over_no_ridge_that_is_too_high() {
    let mut random = Random::new(3);
    for _ in 0..40 {
        let (a, k) = (random.uniform(0.01, 0.3), random.uniform(2.0, 60.0));
        let (g, u) = (random.uniform(0.1, 9.81), random.uniform(0.5, 3.0));
        let (y, v) = (a + random.uniform(0.01, 2.0), random.uniform(0.0, 1.2) * g);
        let ridges = Ridges { a, k, g };
        let run = solve(&ridges, (0.0, 3.0), [0.0, y], [u, v]).rtol(1e-9).run().unwrap();
        let ends = run.impacts.iter().map(|impact| (impact.state, impact.after));
        let mut from = State { t: 0.0, q: [0.0, y], v: [u, v] };
        for (end, after) in ends.chain([(run.end, run.end)]) {
            let count = (50.0 * k * (end.q[0] - from.q[0]).abs()).max(20.0) as usize;
            for n in 1..count {
                let s = (end.t - from.t) * n as f64 / count as f64;
                let (x, y) = (from.q[0] + from.v[0] * s, from.q[1] + (from.v[1] - 0.5 * g * s) * s);
                let gap = y - a * (k * x).sin();
                assert!(-1e-7 < gap, "{gap:e} at {}: {ridges:?}", from.t + s);
            }
            from = after;
        }
    }
}

#[test]
fn a_ball_comes_to_rest() {
    let ball = Ball { e: 0.8, g: 9.81 };
    let times: Vec<f64> = (0..100).map(|k| 0.06 * f64::from(k)).collect();
    let rest = 4.063712769;
    let run = |solution: Solution<f64, 1>| {
        let last = solution.impacts.last().unwrap();
        assert!((last.time.to_f64() - rest).abs() < 2e-9, "{:?}", last.time);
        assert_eq!(last.after.v[0], 0.0);
        for state in &solution {
            assert!(-1e-15 < state.q[0]);
            if rest < state.t {
                assert_eq!((state.q[0], state.v[0]), (0.0, 0.0));
            }
        }
        // Before impact k, the ball falls from 0.8^(2k) m.
        let first = (2.0f64 / 9.81).sqrt();
        for (k, impact) in solution.impacts.iter().enumerate().take(40) {
            let speed = (2.0f64 * 9.81).sqrt() * 0.8f64.powi(k as i32);
            let time = first * (1.0 + 2.0 * (0.8 - 0.8f64.powi(k as i32 + 1)) / 0.2);
            assert!(
                (impact.time.to_f64() - time).abs() < 1e-12,
                "{k} {}",
                impact.time.to_f64() - time
            );
            assert!((impact.state.v[0] + speed).abs() < 1e-11, "{k}");
            assert!((impact.impulse - 1.8 * speed).abs() < 1e-11, "{k}");
            assert_eq!((impact.limit, impact.name), (0, "floor"));
        }
        assert!(solution.events.is_empty());
    };
    run(solve(&ball, (0.0, 6.0), [1.0], [0.0])
        .method(Dop853)
        .rtol(1e-10)
        .t_eval(&times)
        .run()
        .unwrap());
    run(solve(&ball, (0.0, 6.0), [1.0], [0.0]).rtol(1e-10).t_eval(&times).run().unwrap());
    run(solve(&ball, (0.0, 6.0), [1.0], [0.0])
        .method(Rk4)
        .step(0.01)
        .t_eval(&times)
        .run()
        .unwrap());
}

#[test]
fn methods_without_contacts_say_so() {
    let ball = Ball { e: 0.5, g: 9.81 };
    let failure = solve(&ball, (0.0, 6.0), [1.0], [0.0]).method(Picard).run().unwrap_err();
    assert!(matches!(failure.error, Error::Contact { limit: "floor", method: "Picard", .. }));
    let failure = solve(&ball, (0.0, 6.0), [1.0], [0.0]).method(Taylor::new()).run().unwrap_err();
    assert!(matches!(failure.error, Error::Contact { limit: "floor", method: "Taylor", .. }));
    // Methods without contacts support impacts.
    let bounces = solve(&ball, (0.0, 1.2), [1.0], [0.0]).method(Picard).run().unwrap();
    let other = solve(&ball, (0.0, 1.2), [1.0], [0.0]).method(Taylor::new()).run().unwrap();
    assert_eq!((bounces.impacts.len(), other.impacts.len()), (3, 3));
    assert!((bounces.end.q[0] - other.end.q[0]).abs() < 1e-9);
}

#[test]
fn a_shaken_floor_throws_the_ball() {
    // The ball leaves when the floor falls faster than the ball: a ω² sin ωt = g.
    let (a, ω) = (0.5, 6.0);
    let ball = Shaken { a, ω, e: 0.0, g: 9.81 };
    let go = (9.81 / (a * ω * ω)).asin() / ω;
    let up =
        solve(&ball, (0.0, 0.3), [0.0], [a * ω]).method(Dop853).rtol(1e-11).dense().run().unwrap();
    let before = up.at(0.5 * go).unwrap();
    assert!((before.q[0] - a * (ω * 0.5 * go).sin()).abs() < 1e-11);
    let (y, v) = (a * (ω * go).sin(), a * ω * (ω * go).cos());
    let s = 0.3 - go;
    let end = up.end;
    assert!((end.q[0] - (y + v * s - 0.5 * 9.81 * s * s)).abs() < 1e-9, "{end:?}");
    // The ball lands again, without a rebound.
    let later = solve(&ball, (0.0, 3.0), [0.0], [a * ω])
        .method(Dop853)
        .rtol(1e-10)
        .every(0.01)
        .run()
        .unwrap();
    assert!(!later.impacts.is_empty());
    for state in &later {
        assert!(-1e-9 < state.q[0] - a * (ω * state.t).sin(), "{state:?}");
    }
}

#[test]
fn a_stop_takes_the_energy_that_its_restitution_says() {
    let e = 0.6;
    let knee = Knee { e, g: 9.81 };
    let run =
        solve(&knee, (0.0, 3.0), [1.0, 1.3], [0.0, 0.0]).method(Dop853).rtol(1e-12).run().unwrap();
    assert!(3 < run.impacts.len());
    for impact in &run.impacts {
        let (q, v) = (impact.state.q, impact.state.v);
        let energy = |v: &[f64; 2]| knee.energy(At::of(0.0, &q, v));
        let inverse = knee.mass_matrix(At::of(0.0, &q, &v)).try_inverse().unwrap();
        let effective = inverse[(0, 0)] - 2.0 * inverse[(0, 1)] + inverse[(1, 1)];
        let speed = v[1] - v[0];
        let lost = (1.0 - e * e) * speed * speed / (2.0 * effective);
        let found = energy(&v) - energy(&impact.after.v);
        assert!((found - lost).abs() < 1e-12 * (1.0 + lost), "{found} {lost}");
        assert!((q[1] - q[0] + 0.1).abs() < 1e-14);
        assert!((impact.after.v[1] - impact.after.v[0] + e * speed).abs() < 1e-13);
    }
    // The energy changes only at impacts.
    let energy = |state: &State<f64, 2>| knee.energy(At::of(0.0, &state.q, &state.v));
    let lost: f64 = run.impacts.iter().map(|i| energy(&i.state) - energy(&i.after)).sum();
    let start = knee.energy(At::of(0.0, &[1.0, 1.3], &[0.0; 2]));
    assert!((start - lost - energy(&run.end)).abs() < 1e-9);
}

#[test]
fn a_cart_in_a_box_keeps_its_energy_over_a_thousand_bounces() {
    let cart = Cart { k: 2.0, L: 0.3 };
    let start = 0.5 * 9.25;
    let run = solve(&cart, (0.0, 205.0), [0.0, 0.0], [3.0, 0.5])
        .method(Dop853)
        .rtol(1e-12)
        .run()
        .unwrap();
    assert!(1000 < run.impacts.len(), "{}", run.impacts.len());
    for (k, impact) in run.impacts.iter().enumerate() {
        assert_eq!(impact.limit, 1 - k % 2);
    }
    let energy = cart.energy(At::of(0.0, &run.end.q, &run.end.v));
    assert!((energy - start).abs() < 1e-10 * start, "{}", energy - start);
    // The time between walls, from the sine.
    let k = 2.0f64.sqrt();
    let half = 2.0 * (0.3 * k / 3.0).asin() / k;
    let last = run.impacts.last().unwrap().time.to_f64();
    let expected = half * (run.impacts.len() as f64 - 0.5);
    assert!((last - expected).abs() < 1e-10, "{}", last - expected);
}

#[test]
fn every_method_bounces() {
    let cart = Cart { k: 2.0, L: 0.3 };
    let start = ([0.1, 0.0], [1.0, 0.5]);
    let trusted = solve(&cart, (0.0, 5.1), start.0, start.1).method(Dop853).rtol(1e-13);
    let trusted = trusted.run().unwrap();
    assert!(7 < trusted.impacts.len(), "{}", trusted.impacts.len());
    let check = |name: &str, run: Solution<f64, 2>, allowed: f64| {
        assert_eq!(run.impacts.len(), trusted.impacts.len(), "{name}");
        for (a, b) in run.impacts.iter().zip(&trusted.impacts) {
            let late = a.time.to_f64() - b.time.to_f64();
            assert!(late.abs() < allowed, "{name}: {late:e} at {:?}", b.time);
        }
        for i in 0..2 {
            assert!((run.end.q[i] - trusted.end.q[i]).abs() < allowed, "{name}");
            assert!((run.end.v[i] - trusted.end.v[i]).abs() < allowed, "{name}");
        }
    };
    macro_rules! adaptive {
        ($($method:expr),*) => {$(
            let run = solve(&cart, (0.0, 5.1), start.0, start.1).method($method).rtol(1e-10);
            check(stringify!($method), run.run().unwrap(), 1e-7);
        )*};
    }
    macro_rules! fixed {
        ($($method:expr, $allowed:expr;)*) => {$(
            let run = solve(&cart, (0.0, 5.1), start.0, start.1).method($method).step(0.01);
            check(stringify!($method), run.run().unwrap(), $allowed);
        )*};
    }
    adaptive!(Auto, Picard, Taylor::new(), Dprkn12, Rodas4);
    fixed! {
        Leapfrog, 1e-4;
        Rk4, 1e-7;
        Srkn14a, 1e-11;
        Gauss::<3>::new(), 1e-10;
    }
}

#[test]
fn a_bead_on_a_constraint_bounces_as_in_one_angle() {
    let (r, h, e) = (1.0, 0.8, 0.7);
    let bead = Bead { r, h, e, g: 9.81 };
    let angle = BeadAngle { r, h, e, g: 9.81 };
    let start = 2.0f64;
    let run = solve(&bead, (0.0, 8.0), [start.sin(), -start.cos()], [0.0; 2])
        .method(Dop853)
        .rtol(1e-12)
        .run()
        .unwrap();
    let other = solve(&angle, (0.0, 8.0), [start], [0.0]).method(Dop853).rtol(1e-12).run().unwrap();
    assert!(10 < run.impacts.len());
    for (a, b) in run.impacts.iter().zip(&other.impacts).take(20) {
        assert!((a.time.to_f64() - b.time.to_f64()).abs() < 1e-9);
        let (x, y) = (b.after.q[0].sin(), -b.after.q[0].cos());
        let (vx, vy) = (b.after.v[0] * -y, b.after.v[0] * x);
        assert!((a.after.q[0] - x).abs() < 1e-9 && (a.after.q[1] - y).abs() < 1e-9);
        assert!((a.after.v[0] - vx).abs() < 1e-8 && (a.after.v[1] - vy).abs() < 1e-8);
        // The impulse kept the constraint.
        let rate = 2.0 * (a.after.q[0] * a.after.v[0] + a.after.q[1] * a.after.v[1]);
        assert!(rate.abs() < 1e-13);
    }
    // Both beads end at rest on the floor.
    assert!((run.end.q[1] + h).abs() < 1e-14 && run.end.v[0].abs() < 1e-12, "{:?}", run.end);
    assert!((other.end.q[0] - (0.8f64).acos()).abs() < 1e-13);
}

#[test]
fn impacts_by_hand_keep_constraints() {
    let bead = Bead { r: 1.0, h: 0.8, e: 0.7, g: 9.81 };
    let (q, v) = ([0.6, -0.8], [-0.8, -0.6]);
    let change = impact(&bead, 0.0, &q, &v, &[0.0, 1.0], 0.7);
    // The velocity along the circle, 1, is reversed.
    assert!((change[0] - 1.7 * 0.8).abs() < 1e-14 && (change[1] - 1.7 * 0.6).abs() < 1e-14);
    let mut state = State { t: 0.0, q, v };
    state.bounce(&bead, &[0.0, 3.0], 0.7);
    assert!((state.v[0] - 0.7 * 0.8).abs() < 1e-14 && (state.v[1] - 0.7 * 0.6).abs() < 1e-14);
}

#[test]
fn a_block_leaves_a_dome_at_two_thirds_of_its_height() {
    let dome = Dome { r: 2.0, e: 0.0, g: 9.81 };
    let (angle, speed) = (0.1f64, 0.3);
    let (q, v) =
        ([2.0 * angle.sin(), 2.0 * angle.cos()], [speed * angle.cos(), -speed * angle.sin()]);
    let run = solve(&dome, (0.0, 2.0), q, v).method(Dop853).rtol(1e-11).dense().run().unwrap();
    // From the energy and cos θ = v²/(g r) at the point at which the reaction vanishes.
    let height = (0.5 * speed * speed / 9.81 + q[1]) / 1.5;
    let mut run_on = Integrator::new(&dome, Dop853, 0.0, q, v).unwrap();
    let mut last = run_on.state();
    while run_on.t() < 2.0 {
        run_on.step().unwrap();
        assert!(run_on.impacts().is_empty());
        let state = run_on.state();
        let radius = state.q[0].hypot(state.q[1]);
        if 2.0 + 1e-12 < radius {
            break;
        }
        last = state;
    }
    assert!((last.q[1] - height).abs() < 1e-5, "{} {height}", last.q[1]);
    // The free flight after the release depends on the time of the release, and tests it
    // accurately.
    let end = run.end;
    let energy = |state: &State<f64, 2>| dome.energy(At::of(0.0, &state.q, &state.v));
    let start = State { t: 0.0, q, v };
    assert!((energy(&end) - energy(&start)).abs() < 1e-8);
    // The horizontal speed after the release is constant.
    let there = (height * 9.81f64).sqrt();
    assert!((end.v[0] - there * height / 2.0).abs() < 1e-8, "{}", end.v[0] - there * height / 2.0);
    assert!(2.0 < end.q[0].hypot(end.q[1]) && run.impacts.is_empty());
}

#[test]
fn several_limits_act_in_order() {
    let corner = Corner { e: 0.5, g: 9.81 };
    // The ball hits both limits at once; they are orthogonal, so that both rates are reversed.
    let run = solve(&corner, (0.0, 0.15), [0.1, 0.1], [-1.0, -1.0]).method(Dop853);
    let run = run.rtol(1e-10).run().unwrap();
    assert_eq!(run.impacts[0].name, "floor");
    let rest = solve(&corner, (0.0, 9.0), [0.1, 0.1], [-1.0, -1.0]).rtol(1e-9).run().unwrap();
    assert_eq!((rest.end.q, rest.end.v), ([0.0; 2], [0.0; 2]));
    let struck = Integrator::new(&corner, Dop853, 0.0, [0.0, 0.0], [-1.0, -2.0]).unwrap();
    assert_eq!(struck.v(), &[0.5, 1.0]);
}

#[test]
fn bounces_slide_on_and_fall() {
    // A body that is dropped near the top of a dome bounces, slides and leaves.
    for (e, aside) in [(0.0, 0.01), (0.2, 0.02), (0.5, 0.01), (0.7, 0.001), (0.3, 0.3)] {
        let dome = Dome { r: 2.0, e, g: 9.81 };
        let start = State { t: 0.0, q: [aside, 2.2], v: [0.0, 0.0] };
        let run = solve(&dome, (0.0, 6.0), start.q, start.v).rtol(1e-9).every(0.001).run();
        let run = run.unwrap_or_else(|failure| panic!("{e}: {failure}"));
        let energy = |state: &State<f64, 2>| dome.energy(At::of(0.0, &state.q, &state.v));
        let lost: f64 = run.impacts.iter().map(|i| energy(&i.state) - energy(&i.after)).sum();
        assert!(0.0 < lost || e == 1.0);
        let off = energy(&start) - lost - energy(&run.end);
        assert!(off.abs() < 1e-5, "{e}: {off}");
        for state in &run {
            assert!(2.0 - 1e-8 < state.q[0].hypot(state.q[1]), "{e}: {state:?}");
        }
        assert!(run.end.q[1] < 0.0);
        assert!(run.stats.accepted < 2000, "{}", run.stats.accepted);
    }
}

#[test]
fn a_ball_chatters_on_a_shaken_floor() {
    for (e, a) in [(0.0, 0.1), (0.3, 0.1), (0.5, 0.2), (0.8, 0.1), (0.5, 0.01)] {
        let ball = Shaken { a, ω: 12.0, e, g: 9.81 };
        let run = solve(&ball, (0.0, 20.0), [1.0], [0.0]).rtol(1e-8).every(0.001).run();
        let run = run.unwrap_or_else(|failure| panic!("{e} {a}: {failure}"));
        for state in &run {
            assert!(-1e-7 < state.q[0] - a * (12.0 * state.t).sin(), "{e} {a}: {state:?}");
        }
        for impact in &run.impacts {
            let floor = a * 12.0 * (12.0 * impact.time.to_f64()).cos();
            assert!(impact.state.v[0] < floor && 0.0 <= impact.impulse);
        }
        if a == 0.01 {
            // A floor that never falls faster than the ball keeps the ball.
            let t = run.end.t;
            assert!((run.end.q[0] - a * (12.0 * t).sin()).abs() < 1e-15, "{:?}", run.end);
        }
    }
}

#[test]
fn a_floor_that_jerks_throws() {
    // The floor is at rest, then rises at 2 m/s, and then stops.
    for e in [0.0, 0.5] {
        let floor = Curve::linear(&[0.0, 1.0, 1.5, 2.0], &[[0.0], [0.0], [1.0], [1.0]]).unwrap();
        let ball = Lifted { e, g: 9.81 }.driven_by(floor);
        let run = solve(&ball, (0.0, 2.0), [0.0], [0.0]).rtol(1e-10).dense().run().unwrap();
        let thrown = run.impacts[0];
        assert_eq!((thrown.time.to_f64(), thrown.state.v[0]), (1.0, 0.0));
        assert!((thrown.after.v[0] - 2.0 * (1.0 + e)).abs() < 1e-14);
        assert_eq!(run.at(0.9).unwrap().q, [0.0]);
        if e == 0.0 {
            // The ball moves with the floor and leaves it when the floor stops.
            assert!((run.at(1.4).unwrap().q[0] - 0.8).abs() < 1e-14);
            let s = 0.3;
            let flight = 1.0 + 2.0 * s - 0.5 * 9.81 * s * s;
            assert!((run.at(1.5 + s).unwrap().q[0] - flight).abs() < 1e-12);
        }
    }
}

#[test]
fn nothing_pushes_where_nothing_pulls() {
    // Without weight, the ball stays at the wall after a plastic impact.
    let ball = Ball { e: 0.0, g: 0.0 };
    let run = solve(&ball, (0.0, 9.0), [1.0], [-0.5]).run().unwrap();
    assert_eq!((run.end.q, run.end.v, run.impacts.len()), ([0.0], [0.0], 1));
    let run = solve(&Ball { e: 1.0, g: 0.0 }, (0.0, 9.0), [1.0], [-0.5]).run().unwrap();
    assert!((run.end.q[0] - 3.5).abs() < 1e-12 && run.impacts.len() == 1);
}

#[test]
fn contact_is_saved_and_resumed() {
    let dome = Dome { r: 2.0, e: 0.0, g: 9.81 };
    let (q, v) = ([0.0, 2.0], [0.4, 0.0]);
    let mut whole = Integrator::new(&dome, Dop853, 0.0, q, v).unwrap();
    whole.advance_to(0.3).unwrap();
    let saved = whole.save();
    let mut other = Integrator::new(&dome, Dop853, 0.0, q, v).unwrap();
    other.restore(&saved).unwrap();
    whole.advance_to(1.5).unwrap();
    other.advance_to(1.5).unwrap();
    assert_eq!(whole.state(), other.state());
    assert_eq!(whole.stats(), other.stats());
}

#[test]
fn limits_in_single_precision() {
    let ball = Ball { e: 0.8f32, g: 9.81 };
    let run = solve(&ball, (0.0, 6.0), [1.0f32], [0.0]).method(Dop853).run().unwrap();
    assert_eq!((run.end.q[0], run.end.v[0]), (0.0, 0.0));
    let last = run.impacts.last().unwrap().time.to_f64();
    assert!((last - 4.063712769).abs() < 1e-3, "{last}");
}

#[test]
fn events_look_on() {
    let ball = Ball { e: 0.8, g: 9.81 };
    let top = Event::new(|_t, _q, v: &[f64; 1]| v[0]).falling();
    let run = solve(&ball, (0.0, 3.0), [1.0], [0.0]).method(Dop853).rtol(1e-10).events([top]).run();
    let run = run.unwrap();
    let first = (2.0f64 / 9.81).sqrt();
    assert!((run.events[0].time.to_f64() - first * 1.8).abs() < 1e-9);
    let half = Event::new(|_t, q: &[f64; 1], _v| q[0] - 0.5).rising().terminal();
    let run =
        solve(&ball, (0.0, 3.0), [1.0], [0.0]).method(Dop853).rtol(1e-10).events([half]).run();
    let run = run.unwrap();
    assert_eq!((run.impacts.len(), run.events.len()), (1, 1));
    assert!((run.end.q[0] - 0.5).abs() < 1e-12 && 0.0 < run.end.v[0]);
}

#[test]
fn what_is_wrong_is_named() {
    let error =
        solve(&Ball { e: 0.8, g: 9.81 }, (0.0, 1.0), [-1.0], [0.0]).run().unwrap_err().error;
    assert_eq!(
        error.to_string(),
        "at t = 0.0 the gap of the limit floor is -1.0 m; begin with a state in which it is not negative"
    );
    for e in [1.5, -0.1, f64::NAN] {
        let error = solve(&Ball { e, g: 9.81 }, (0.0, 1.0), [1.0], [0.0]).run().unwrap_err().error;
        assert!(matches!(error, Error::Restitution { limit: "floor", .. }), "{error}");
    }
}

/// A coordinate may have several limits.
#[test]
fn a_shuttle_goes_between_two_walls() {
    let shuttle = Shuttle::new(1.3, 1.0, 1.0);
    let solution = solve(&shuttle, (0.0, 10.5), [0.0], [1.0]).run().unwrap();
    let times: Vec<f64> = solution.impacts.iter().map(|impact| impact.time.to_f64()).collect();
    assert_eq!(times.len(), 5);
    for (k, (time, impact)) in times.iter().zip(&solution.impacts).enumerate() {
        assert!((time - (1.0 + 2.0 * k as f64)).abs() < 1e-12, "{time}");
        assert_eq!(impact.name, ["right", "left"][k % 2]);
    }
    assert!((solution.end.q[0] + 0.5).abs() < 1e-12 && (solution.end.v[0] + 1.0).abs() < 1e-15);
    let plastic = Shuttle::new(1.3, 1.0, 0.0);
    let end = solve(&plastic, (0.0, 3.0), [0.0], [1.0]).run().unwrap().end;
    assert!((end.q[0] - 1.0).abs() < 1e-12 && end.v[0].abs() < 1e-15);
}

/// A parameter that occurs only in a limit, its restitution or a constraint is needed.
#[test]
fn parameters_of_limits_and_constraints_are_needed() {
    assert_eq!(Shuttle::<f64>::FACTS.unused, ["m"]);
    assert!(Bead::<f64>::FACTS.unused.is_empty());
    assert_eq!(crate::pushed::Leaning::<f64>::FACTS.unused, ["m"]);
}
