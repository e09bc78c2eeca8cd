//! Limits that move with time: narrow walls, vibrating floors, and walls that somebody drives.

use pendulum_runtime::motion::{Curve, Function, Sinusoid};
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A ball that rests until a wall passes.
    #[derive(Clone, Debug)]
    pub struct Paddle { m: kg, c: s, w: s, h: m, e: 1 }
    coordinate y: m;
    kinetic = m*ẏ^2/2;
    limit wall: y >= h*exp(-((t-c)/w)^2), restitution = e;
}

lagrangian! {
    /// A ball over a floor that vibrates.
    #[derive(Clone, Debug)]
    pub struct Vibrating { a: m, ω: Hz, e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit floor: y >= a*sin(ω*t), restitution = e;
}

lagrangian! {
    /// A ball over a floor that somebody moves.
    #[derive(Clone, Debug)]
    pub struct Moved { e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    driven floor: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit ground: y >= floor, restitution = e;
}

lagrangian! {
    /// A shuttle between a wall that swings and one that a kick sends over its path.
    #[derive(Clone, Debug)]
    pub struct Gate { L: m, a: m, ω: Hz, c: s, w: s }
    coordinate x: m;
    kinetic = ẋ^2/2;
    limit left: x >= a*cos(ω*t), restitution = 1;
    limit right: L >= x*(1 + 1/(1 + ((t-c)/w)^2)), restitution = 1;
}

/// A ball over a floor, with a struct of its own for each function of time.
macro_rules! floors {
    ($($name:ident { $($floor:tt)* })*) => {$(
        lagrangian! {
            #[derive(Clone, Debug)]
            pub struct $name { h, ω }
            coordinate y;
            kinetic = ẏ^2/2;
            potential = y;
            limit floor: y >= $($floor)*, restitution = 1;
        }
    )*};
}

floors! {
    Combed { h*cos(ω*t)^100 }
    Spiked { h/(1 + 100*sin(ω*t)^2) }
    Peaked { h/(1.02 - cos(ω*t)) }
    Kicked { h*exp(-100*(1 - cos(ω*t))) }
    Rising { h*sin(ω*t^2)/20 }
    Swung { h*sin(8*sin(ω*t))/20 }
    Pulsed { h/cosh(100*ω*(t-4)) }
}

/// Asserts that a ball on parabolas between its impacts stays above `wall` at `count` times each.
///
/// The wall is sampled so finely that an impact that was missed is found, whatever the errors of
/// earlier impacts have grown to.
fn never_below(
    run: &Solution<f64, 1>,
    start: [f64; 3],
    g: f64,
    count: u32,
    wall: impl Fn(f64) -> f64,
) {
    let impacts =
        run.impacts.iter().map(|impact| (impact.time.to_f64(), &impact.state, &impact.after));
    let mut from = start;
    for (t, state, after) in impacts.chain([(run.end.t, &run.end, &run.end)]) {
        let [begin, y, v] = from;
        let height = |s: f64| y + v * s - 0.5 * g * s * s;
        for k in 1..count {
            let s = (t - begin) * f64::from(k) / f64::from(count);
            let gap = height(s) - wall(begin + s);
            assert!(-1e-8 < gap, "{gap:e} at {}, impacts {}", begin + s, run.impacts.len());
        }
        assert!((height(t - begin) - state.q[0]).abs() < 1e-8, "{t}: {state:?}");
        from = [t, after.q[0], after.v[0]];
    }
}

#[test]
fn a_narrow_wall_hits_a_ball_at_rest() {
    // The wall passes y at t = c − w √ln(h/y), with the rate 2 √ln(h/y) y/w.
    for k in 0..12 {
        let part = f64::from(k) / 12.0;
        let (c, w, e) = (1.3 + 7.9 * part, 0.3 * 1e-3f64.powf(part), 0.5 + 0.5 * part);
        let (m, h, y) = (1.0 + part, 1.0 + 9.0 * part, (1.0 + 9.0 * part) * (0.4 + 0.5 * part));
        let depth = (h / y).ln().sqrt();
        let (met, rate) = (c - w * depth, 2.0 * depth * y / w);
        let end = y + (1.0 + e) * rate * (10.0 - met);
        let paddle = Paddle { m, c, w, h, e };
        macro_rules! check {
            ($($method:expr),*) => {$(
                let run = solve(&paddle, (0.0, 10.0), [y], [0.0]).method($method).rtol(1e-9);
                let run = run.run().unwrap();
                let name = stringify!($method);
                assert_eq!(run.impacts.len(), 1, "{name}: {paddle:?}");
                let off = run.impacts[0].time.to_f64() - met;
                assert!(off.abs() < 1e-9 * w.max(1e-4), "{name}: {off:e} for {paddle:?}");
                let off = run.end.q[0] - end;
                assert!(off.abs() < 1e-7 * end, "{name}: {off:e} for {paddle:?}");
            )*};
        }
        check!(Auto, Picard, Taylor::new(), Dop853, Rodas4);
    }
    // The default tolerance, and single precision.
    let paddle = Paddle { m: 1.0, c: 4.0, w: 0.03, h: 1.0, e: 1.0 };
    let run = solve(&paddle, (0.0, 10.0), [0.5], [0.0]).run().unwrap();
    assert!((run.end.q[0] - 334.9).abs() < 0.1, "{:?}", run.end);
    for w in [0.3, 0.03, 0.003] {
        let paddle = Paddle { m: 1.0f32, c: 4.0, w, h: 1.0, e: 1.0 };
        let run = solve(&paddle, (0.0, 10.0), [0.5f32], [0.0]).run().unwrap();
        let met = 4.0 - f64::from(w) * 2.0f64.ln().sqrt();
        let off = run.impacts[0].time.to_f64() - met;
        assert!(run.impacts.len() == 1 && off.abs() < 1e-5, "{w}: {off:e}");
    }
}

#[test]
fn a_ball_meets_every_crest_of_a_vibrating_floor() {
    let (a, g) = (0.1, 9.81);
    for (k, ω) in [1.0, 7.3, 30.0, 100.0, 315.7, 1000.0].into_iter().enumerate() {
        // A larger amplitude throws the fast balls away.
        let a = a * f64::min(1.0, 10.0 / ω);
        let (e, y, end) = ([1.0, 0.7][k % 2], 2.0 * a, 0.6);
        let wall = |t: f64| a * (ω * t).sin();
        let count = 200 + (20.0 * ω) as u32;
        let floor = Vibrating { a, ω, e, g };
        let moved = Moved { e, g }.driven_by(Sinusoid::new([a], ω, [0.0]));
        macro_rules! check {
            ($($method:expr),*) => {$(
                let run = solve(&floor, (0.0, end), [y], [0.0]).method($method).rtol(1e-9).run();
                let first = run.as_ref().unwrap().impacts[0].time;
                never_below(&run.unwrap(), [0.0, y, 0.0], g, count, wall);
                let run = solve(&moved, (0.0, end), [y], [0.0]).method($method).rtol(1e-9).run();
                let run = run.unwrap();
                assert!((run.impacts[0].time.to_f64() - first.to_f64()).abs() < 1e-8, "{ω}");
                never_below(&run, [0.0, y, 0.0], g, count, wall);
            )*};
        }
        check!(Auto, Dop853);
    }
}

#[test]
fn a_kick_of_a_driven_floor_is_no_secret() {
    let (h, w, g) = (0.8, 0.004, 9.81);
    for c in [0.37, 0.9, 1.55] {
        let wall = move |t: f64| h * (-((t - c) / w).powi(2)).exp();
        let rate = move |t: f64| -2.0 * (t - c) / (w * w) * wall(t);
        let bend = move |t: f64| (4.0 * ((t - c) / w).powi(2) - 2.0) / (w * w) * wall(t);
        let kick = Function::new(move |t| [wall(t)])
            .velocity(move |t| [rate(t)])
            .acceleration(move |t| [bend(t)])
            .resolution(w)
            .unwrap();
        let moved = Moved { e: 1.0, g }.driven_by(kick);
        // Thrown from 0.3 m, the ball would be down again after 2 s.
        let v = 0.5 * g * 2.0 - 0.15;
        let height = |t: f64| 0.3 + v * t - 0.5 * g * t * t;
        let meets = height(c) < h;
        let run = solve(&moved, (0.0, 1.9), [0.3], [v]).rtol(1e-9).run().unwrap();
        assert_eq!(!run.impacts.is_empty(), meets, "{c}");
        never_below(&run, [0.0, 0.3, v], g, 20_000, wall);
    }
}

/// Returns the height at the end of a ball that begins on a floor of straight pieces, without
/// rebound: it rides, flies where a piece is less steep than its velocity, and lands.
fn ridden(keys: &[(f64, f64)], g: f64) -> f64 {
    let (mut y, mut v, mut flies) = (keys[0].1, 0.0, false);
    for pair in keys.windows(2) {
        let ((mut from, height), (to, next)) = (pair[0], pair[1]);
        let slope = (next - height) / (to - from);
        flies = v > slope || flies && height < y;
        if flies {
            // The gap h + u s − g s²/2 is zero once more.
            let (h, u) = (y - height, v - slope);
            let s = (u + (u * u + 2.0 * g * h).sqrt()) / g;
            let s = if from + s < to { s } else { to - from };
            (y, v, flies) = (y + v * s - 0.5 * g * s * s, v - g * s, from + s == to);
            from += s;
        }
        if !flies {
            (y, v) = (y + slope * (to - from), slope);
        }
    }
    y
}

/// Where a floor turns away under a ball, the ball leaves it with the velocity of the floor.
#[test]
fn a_ball_rides_on_a_floor_of_straight_pieces() {
    let mut random = Random::new(5);
    for _ in 0..40 {
        let mut t = 0.0;
        let keys: Vec<(f64, f64)> = (0..24)
            .map(|_| {
                t += random.uniform(0.02, 0.12);
                (t, random.uniform(-3e-3, 3e-3))
            })
            .collect();
        let (times, values): (Vec<f64>, Vec<[f64; 1]>) =
            keys.iter().map(|&(t, height)| (t, [height])).unzip();
        let moved = Moved { e: 0.0, g: 9.81 }.driven_by(Curve::linear(&times, &values).unwrap());
        let (start, end) = (times[0], times[23]);
        let run = solve(&moved, (start, end), [keys[0].1], [0.0]).rtol(1e-9).max_steps(2000);
        let y = run.run().unwrap().end.q[0];
        assert!((y - ridden(&keys, 9.81)).abs() < 1e-7, "{y} in {keys:?}");
    }
}

#[test]
fn two_walls_move_at_once() {
    let gate = Gate { L: 2.0, a: 0.2, ω: 200.0, c: 1.7, w: 0.002 };
    let run = solve(&gate, (0.0, 3.0), [1.3], [-0.05]).rtol(1e-9).run().unwrap();
    // Until the kick, the shuttle drifts freely; then the right wall meets it where
    // x (1 + 1/(1 + u²)) = 2 with u = (t − c)/w.
    let x = |t: f64| 1.3 - 0.05 * t;
    let (mut before, mut after) = (1.65, 1.7);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (before + after);
        let u: f64 = (middle - 1.7) / 0.002;
        if x(middle) * (1.0 + 1.0 / (1.0 + u * u)) < 2.0 {
            before = middle;
        } else {
            after = middle;
        }
    }
    let first = &run.impacts[0];
    assert_eq!(first.name, "right");
    assert!((first.time.to_f64() - before).abs() < 1e-9, "{:?} for {before}", first.time);
    // It is sent to the left wall, and never passes it.
    assert!(run.impacts.iter().any(|impact| impact.name == "left"));
    never_below(&run, [0.0, 1.3, -0.05], 0.0, 20_000, |t| 0.2 * (200.0 * t).cos());
}

/// Functions of functions of time are narrower than these.
#[test]
fn floors_are_as_narrow_as_their_functions() {
    macro_rules! check {
        ($($name:ident, |$h:ident, $ω:ident, $t:ident| $wall:expr;)*) => {$(
            let mut random = Random::new(17);
            for _ in 0..12 {
                let ($h, $ω) = (random.uniform(0.5, 3.0), random.uniform(1.0, 9.0));
                let wall = |$t: f64| $wall;
                let (y, v) = (wall(0.0) + $h * random.uniform(0.01, 0.8), random.uniform(1.0, 2.4));
                let floor = $name { h: $h, ω: $ω };
                let run = solve(&floor, (0.0, 5.0), [y], [v]).rtol(1e-10).run().unwrap();
                never_below(&run, [0.0, y, v], 1.0, 10_000, wall);
            }
        )*};
    }
    check! {
        Combed, |h, ω, t| h * (ω * t).cos().powi(100);
        Spiked, |h, ω, t| h / (1.0 + 100.0 * (ω * t).sin().powi(2));
        Peaked, |h, ω, t| h / (1.02 - (ω * t).cos());
        Kicked, |h, ω, t| h * (-100.0 * (1.0 - (ω * t).cos())).exp();
        Rising, |h, ω, t| h * (ω * t * t).sin() / 20.0;
        Swung, |h, ω, t| h * (8.0 * (ω * t).sin()).sin() / 20.0;
        Pulsed, |h, ω, t| h / (100.0 * ω * (t - 4.0)).cosh();
    }
}

/// The lift costs the body's velocity, and what lies on a floor does not follow it down.
#[test]
fn a_floor_that_jumps_lifts_what_it_meets() {
    let floor = Curve::steps(&[0.0, 0.3, 0.6], &[[0.0], [0.4], [0.1]]).unwrap();
    let run = |g: f64, e: f64, y: f64, v: f64| {
        let moved = Moved { e, g }.driven_by(floor.clone());
        solve(&moved, (0.0, 1.0), [y], [v]).rtol(1e-9).run().unwrap().end
    };
    let weightless = run(0.0, 0.5, 0.1, 0.0);
    assert!((weightless.q[0] - 0.4).abs() < 1e-15 && weightless.v == [0.0], "{weightless:?}");
    // At 0.3 s it is at 0.235 and falls at 0.7; what it has at 0.4 is 0.4, reversed.
    let bouncing = run(1.0, 1.0, 0.4, -0.4);
    assert!((bouncing.q[0] - (0.475 + 0.04 - 0.08)).abs() < 1e-9, "{bouncing:?}");
    // From 0.6 s on it falls again.
    let resting = run(1.0, 0.0, 0.0, 0.0);
    assert!((resting.q[0] - (0.4 - 0.08)).abs() < 1e-9 && resting.v[0] < -0.39, "{resting:?}");
    // A small jump, in single precision: the body falls onto the floor.
    let floor = Curve::steps(&[0.0, 0.5], &[[1.0], [0.999]]).unwrap();
    let moved = Moved::<f32> { e: 0.0, g: 9.81 }.driven_by(floor);
    let run = solve(&moved, (0.0, 1.0), [1.0], [0.0]).rtol(1e-5).run().unwrap();
    let [impact] = &run.impacts[..] else { panic!("{:?}", run.impacts) };
    assert!((impact.state.v[0] + f32::sqrt(2.0 * 9.81 * 1e-3)).abs() < 1e-3, "{impact:?}");
}
