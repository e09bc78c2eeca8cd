//! Limits that move towards each other until there is no room between them.

use core::f64::consts::PI;
use pendulum_runtime::error::Error;
use pendulum_runtime::motion::{Curve, Function, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;
use systems::random::{Random, some};

lagrangian! {
    /// A ball between two walls that approach each other.
    #[derive(Clone, Debug)]
    pub struct Pressed { a, b, e, g }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = g*x;
    limit left: x >= a*t, restitution = e;
    limit right: 1 - b*t >= x, restitution = e;
}

lagrangian! {
    /// A ball between a floor and a lid that somebody moves.
    #[derive(Clone, Debug)]
    pub struct Covered { e, g }
    coordinate x;
    driven top;
    kinetic = ẋ^2/2;
    potential = g*x;
    limit floor: x >= 0, restitution = e;
    limit lid: top >= x, restitution = e;
}

lagrangian! {
    /// Two blocks under a lid that comes down.
    #[derive(Clone, Debug)]
    pub struct Piled { d, s, e, g }
    coordinate z[2];
    kinetic = (ż[0]^2 + ż[1]^2)/2;
    potential = g*(z[0] + z[1]);
    limit floor: z[0] >= 0, restitution = e;
    limit between: z[1] - z[0] >= d, restitution = e;
    limit lid: 2 - s*t >= z[1], restitution = e;
}

lagrangian! {
    /// A ball in a groove under a lid that comes down.
    #[derive(Clone, Debug)]
    pub struct Grooved { k, s, e }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = 9.81*y;
    limit one: y >= k*x, restitution = e;
    limit two: y >= -k*x, restitution = e;
    limit lid: 1 - s*t >= y, restitution = e;
}

lagrangian! {
    /// A ball that touches two walls, one of which moves faster and faster.
    #[derive(Clone, Debug)]
    pub struct Touched { b }
    coordinate x;
    kinetic = ẋ^2/2;
    limit left: x >= 0, restitution = 0;
    limit right: 0 >= x + b*t^2, restitution = 0;
}

lagrangian! {
    /// Four blocks over a floor.
    #[derive(Clone, Debug)]
    pub struct Blocks { m: [1; 4], d, e, f, g }
    coordinate z[4];
    kinetic = sum(i in 0..4, m[i]*ż[i]^2/2);
    potential = g*sum(i in 0..4, m[i]*z[i]);
    limit floor: z[0] >= 0, restitution = e;
    limit first: z[1] - z[0] >= d, restitution = f;
    limit second: z[2] - z[1] >= d, restitution = e;
    limit third: z[3] - z[2] >= d, restitution = f;
}

/// Asserts that a run ends when there is no room, at `$room`, between two of the limits `$between`.
macro_rules! ends {
    ($dynamics:expr, $end:expr, $q:expr, $v:expr, $room:expr, $between:expr) => {
        for tolerance in [1e-4, 1e-7, 1e-10] {
            let run = solve($dynamics, (0.0, $end), $q, $v).rtol(tolerance).max_steps(5000);
            let failure = run.run().unwrap_err();
            let message = failure.error.to_string();
            let Error::NoRoom { t, limit, other } = failure.error else { panic!("{message}") };
            assert!((t - $room).abs() < 1e-6 + tolerance, "{message}, not at {}", $room);
            let between: &[&str] = &$between;
            assert!(between.contains(&limit) && Some(limit) != other, "{message}");
            assert!(other.is_some_and(|other| between.contains(&other)), "{message}");
            assert!(message.contains("leaves no room"), "{message}");
        }
    };
}

#[test]
fn walls_that_meet_leave_no_room() {
    for (e, g) in [(0.0, 0.0), (0.5, 0.0), (0.0, 9.81), (0.3, -9.81)] {
        for (a, b) in [(0.1, 0.1), (0.0, 0.4), (0.3, 0.01)] {
            let pressed = Pressed { a, b, e, g };
            ends!(&pressed, 20.0, [0.5], [0.3], 1.0 / (a + b), ["left", "right"]);
        }
    }
    let single = Pressed { a: 0.1f32, b: 0.3, e: 0.5, g: 0.0 };
    let failure = solve(&single, (0.0, 20.0), [0.5], [0.3]).max_steps(5000).run().unwrap_err();
    let Error::NoRoom { t, .. } = failure.error else { panic!("{}", failure.error) };
    assert!((t - 2.5).abs() < 1e-4, "{t}");
}

#[test]
fn a_lid_on_the_floor_leaves_no_room() {
    let swings = Sinusoid::new([1.2], 1.0, [2.0]);
    let keys = Curve::linear(&[0.0, 1.0, 2.0, 3.0], &[[1.0], [0.5], [-0.5], [-1.0]]).unwrap();
    let jump = Function::new(|t| [if t < 1.0 { 1.0 } else { -1.0 }])
        .velocity(|_| [0.0])
        .acceleration(|_| [0.0])
        .kinks(&[1.0]);
    let names = ["floor", "lid"];
    for (e, g) in [(0.0, 0.0), (0.5, 9.81)] {
        let covered = Covered { e, g };
        let swung = covered.clone().driven_by(swings);
        ends!(&swung, 10.0, [0.5], [0.3], PI - 2.0, names);
        let keyed = covered.clone().driven_by(keys.clone());
        ends!(&keyed, 3.0, [0.5], [0.3], 1.5, names);
        let jumped = covered.driven_by(jump.clone());
        ends!(&jumped, 3.0, [0.5], [0.3], 1.0, names);
    }
}

#[test]
fn a_lid_on_blocks_leaves_no_room() {
    for (e, g) in [(0.0, 9.81), (0.4, 9.81), (0.0, 0.0)] {
        let piled = Piled { d: 0.2, s: 0.5, e, g };
        ends!(&piled, 10.0, [0.5, 1.0], [0.3, -0.1], 3.6, ["floor", "between", "lid"]);
    }
}

#[test]
fn a_lid_on_a_groove_leaves_no_room() {
    for e in [0.0, 0.5] {
        let grooved = Grooved { k: 0.7, s: 0.5, e };
        ends!(&grooved, 10.0, [0.1, 0.3], [0.3, -0.1], 2.0, ["one", "two", "lid"]);
    }
}

/// Both limits are in contact, and neither rate tells that they will overlap.
#[test]
fn contacts_that_overlap_are_an_error() {
    for b in [1e-3, 0.1, 1e3] {
        let run = solve(&Touched { b }, (0.0, 3.0), [0.0], [0.0]).t_stops(&[0.125]).run();
        let failure = run.unwrap_err();
        let Error::NoRoom { t, .. } = failure.error else { panic!("{}", failure.error) };
        assert!((0.0..=0.125).contains(&t), "{t}");
    }
}

/// A wall without losses gives the ball twice its rate at each impact.
#[test]
fn walls_without_losses_are_no_hang() {
    let pressed = Pressed { a: 0.1, b: 0.1, e: 1.0, g: 0.0 };
    let failure = solve(&pressed, (0.0, 20.0), [0.5], [0.3]).max_steps(3000).run().unwrap_err();
    assert!(matches!(failure.error, Error::NoRoom { .. } | Error::MaxSteps { .. }));
    assert!(failure.partial.end.t < 5.0 + 1e-9, "{}", failure.partial.end.t);
}

/// The walls come as near as a hundredth.
#[test]
fn walls_that_do_not_meet_leave_room() {
    for e in [0.0, 0.5] {
        let covered = Covered { e, g: 0.0 }.driven_by(
            Function::new(|t: f64| [1.0 + 0.99 * t.sin()])
                .velocity(|t: f64| [0.99 * t.cos()])
                .acceleration(|t: f64| [-0.99 * t.sin()]),
        );
        let end = solve(&covered, (0.0, 10.0), [0.5], [0.3]).rtol(1e-8).run().unwrap().end;
        assert!((0.0..=1.99).contains(&end.q[0]), "{end:?}");
    }
}

/// Without gravity, the meetings of blocks lie less apart than a time resolves.
#[test]
fn blocks_without_weight_come_apart() {
    let mut random = Random::new(36);
    for _ in some(0..42) {
        let tolerance = 10f64.powf(random.uniform(-8.0, -3.0));
        let [a, b, r, s] = [0.2, 0.2, -1.0, -1.0].map(|least| random.uniform(least, 1.0));
        let (e, f) = (random.of(&[0.0, 0.3]), random.of(&[0.0, 0.5]));
        let blocks = Blocks { m: [a, b, 1.0, 2.0 * a * b], d: 0.1, e, f, g: 0.0 };
        let (q, v) = ([0.2 * b, 0.6, 1.2, 2.0 + a], [r, s, 0.0, -r]);
        let run = solve(&blocks, (0.0, 10.0), q, v).rtol(tolerance).atol(1e-30).run();
        let end = run.unwrap_or_else(|failure| panic!("{blocks:?}: {failure}")).end;
        let energy = |q: &[f64; 4], v: &[f64; 4]| blocks.energy(At::of(0.0, q, v));
        let gained = energy(&end.q, &end.v) - energy(&q, &v);
        assert!(gained <= 1e-12, "{blocks:?}: {gained:e}");
        let [gaps, ..] = blocks.gaps(At::of(10.0, &end.q, &end.v));
        assert!(gaps.iter().all(|gap| -1e-12 <= *gap), "{gaps:?}");
    }
}

/// No step from zero is short enough for an absolute tolerance of zero, but lines and parabolas
/// need no tolerance.
#[test]
fn blocks_that_leave_zero_need_no_tolerance() {
    for g in [0.0, -2.0] {
        let blocks = Blocks { m: [1.0; 4], d: 0.1, e: 0.0, f: 0.0, g };
        let (q, v) = ([0.0, 0.2, 0.4, 0.6], [0.5, 0.6, 0.7, 0.8]);
        let end = solve(&blocks, (0.0, 2.0), q, v).atol(1e-300).run().unwrap().end;
        for i in 0..4 {
            assert!((end.q[i] - (q[i] + 2.0 * v[i] - 2.0 * g)).abs() < 1e-12, "{g}: {end:?}");
        }
    }
}
