//! Contacts that open, blocks that break away, switches that are passed and events that happen for a
//! small part of a step, wherever in the step.

use core::f64::consts::{FRAC_PI_2, PI};
use pendulum_runtime::integrate::Event;
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A ball on a table that shakes.
    #[derive(Clone, Debug)]
    pub struct Shaken { a: m, ω: Hz, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit table: y >= a*sin(ω*t), restitution = 0;
}

lagrangian! {
    /// A ball on the floor that a gust lifts.
    #[derive(Clone, Debug)]
    pub struct Lifted { A: m/s^2, c: s, w: s, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    force y = A*exp(-((t - c)/w)^2);
    limit floor: y >= 0, restitution = 0;
}

lagrangian! {
    /// A block that a gust pushes.
    #[derive(Clone, Debug)]
    pub struct Pushed { A: m/s^2, c: s, w: s, F: m/s^2 }
    coordinate x: m;
    kinetic = ẋ^2/2;
    force x = A*exp(-((t - c)/w)^2);
    friction ground: ẋ, force = F;
}

lagrangian! {
    /// A stone that is heavier above a height.
    #[derive(Clone, Debug)]
    pub struct Thrown { F: m/s^2, c: m, g: m/s^2 = 9.81 }
    coordinate y: m;
    kinetic = ẏ^2/2;
    potential = g*y;
    force y = -F*(1 + sign(y - c))/2;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Swing { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    kinetic = L^2*θ̇^2/2;
    potential = -g*L*cos(θ);
}

/// Returns a number between two powers of ten.
fn power(random: &mut Random, from: f64, to: f64) -> f64 {
    10f64.powf(random.uniform(from, to))
}

/// Returns the zero of a function that falls between two arguments.
fn zero(function: impl Fn(f64) -> f64, [mut above, mut below]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = f64::midpoint(above, below);
        *(if 0.0 < function(middle) { &mut above } else { &mut below }) = middle;
    }
    above
}

/// A ball leaves a table whose acceleration is greater than g by a part d at most, where it is g, and
/// flies for about √(18 d)/ω.
#[test]
fn a_table_that_shakes_hardly_more_than_gravity_throws_a_ball() {
    let mut random = Random::new(1);
    for _ in 0..40 {
        let (ω, d, g) = (random.uniform(0.7, 9.0), power(&mut random, -5.0, -1.0), 9.81);
        let a = g * (1.0 + d) / (ω * ω);
        let left = (1.0 / (1.0 + d)).asin() / ω;
        let (y, v) = (a * (ω * left).sin(), a * ω * (ω * left).cos());
        let height = |s: f64| y + v * s - g * s * s / 2.0;
        let top = 2.0 * (FRAC_PI_2 / ω - left);
        let flight = zero(|s| height(s) - a * (ω * (left + s)).sin(), [top, 5.0 * top]);
        let (table, middle) = (Shaken { a, ω, g }, 0.6 * flight);
        for tolerance in [1e-4, 1e-7, 1e-10] {
            let run = |end| {
                let run = solve(&table, (0.0, end), [0.0], [a * ω]).rtol(tolerance).atol(tolerance);
                run.run().unwrap_or_else(|failure| panic!("{table:?}: {failure}"))
            };
            let off = (run(left + middle).end.q[0] - height(middle)).abs();
            assert!(off < 10.0 * tolerance, "{table:?} {tolerance}: {off:e}");
            let impacts = run(PI / ω).impacts;
            let [impact] = &impacts[..] else { panic!("{table:?} {tolerance}: {impacts:?}") };
            let late = impact.time.to_f64() - left - flight;
            assert!(late.abs() < 1e-4 * flight, "{table:?} {tolerance}: {late:e}");
        }
    }
}

#[test]
fn gusts_hardly_above_a_bound_lift_and_push() {
    let mut random = Random::new(2);
    for _ in 0..40 {
        let (c, w) = (random.uniform(1.0, 5.0), power(&mut random, -3.0, 0.0));
        let (d, bound) = (power(&mut random, -4.0, -0.5), random.uniform(1.0, 20.0));
        let force = |t: f64| bound * ((1.0 + d) * (-(t / w).powi(2)).exp() - 1.0);
        // Simpson's rule for the velocity, from the time at which the force reaches the bound.
        let start = -w * d.ln_1p().sqrt();
        let h = -start / 4096.0;
        let (mut t, mut v, mut x) = (start, 0.0, 0.0);
        while t < -16.0 * start {
            let [a, b, c] = [0.0, 0.5, 1.0].map(|part| force(t + part * h));
            let (middle, next) =
                (v + h / 24.0 * (5.0 * a + 8.0 * b - c), v + h / 6.0 * (a + 4.0 * b + c));
            if t > 0.0 && next < 0.0 {
                x += v * v / (-2.0 * a);
                break;
            }
            (t, v, x) = (t + h, next, x + h / 6.0 * (v + 4.0 * middle + next));
        }
        let block = Pushed { A: bound * (1.0 + d), c, w, F: bound };
        let ball = Lifted { A: bound * (1.0 + d), c, w, g: bound };
        for tolerance in [1e-4, 1e-7, 1e-10] {
            let run = solve(&block, (0.0, 9.0), [0.0], [0.0]).rtol(tolerance).atol(tolerance).run();
            let run = run.unwrap_or_else(|failure| panic!("{block:?}: {failure}"));
            let off = (run.end.q[0] - x).abs();
            assert!(off < 10.0 * tolerance + 1e-6 * x, "{block:?} {tolerance}: {off:e} of {x:e}");
            let [_, slip, _] = &run.frictions[..] else { panic!("{block:?}: {:?}", run.frictions) };
            let late = slip.start - c - start;
            assert!(late.abs() < -1e-2 * start, "{block:?} {tolerance}: {late:e}");
            let run = solve(&ball, (0.0, 9.0), [0.0], [0.0]).rtol(tolerance).atol(tolerance).run();
            let run = run.unwrap_or_else(|failure| panic!("{ball:?}: {failure}"));
            assert_eq!(run.impacts.len(), 1, "{ball:?} {tolerance}");
        }
    }
}

/// A stone that rises over the height by d is above it for about √(8 d/g).
#[test]
fn a_switch_hardly_passed_is_seen() {
    let mut random = Random::new(3);
    for _ in 0..200 {
        let (heavier, c, g) = (power(&mut random, 0.0, 2.0), random.uniform(0.5, 2.0), 9.81);
        let d = power(&mut random, -8.0, -4.0);
        let [start, beyond] = [c + d, d].map(|height| (2.0 * g * height).sqrt());
        let back = (start - beyond) / g + 2.0 * beyond / (g + heavier);
        let s = random.uniform(0.1, 0.3);
        let end = c - beyond * s - g * s * s / 2.0;
        let stone = Thrown { F: heavier, c, g };
        macro_rules! check {
            ($($method:expr),*) => {$(
                for tolerance in [1e-4, 1e-7, 1e-10] {
                    // What rises by fewer tolerances may stay below.
                    if d < 30.0 * tolerance {
                        continue;
                    }
                    let run = solve(&stone, (0.0, back + s), [0.0], [start]).method($method);
                    let run = run.rtol(tolerance).atol(tolerance).run();
                    let run = run.unwrap_or_else(|failure| panic!("{stone:?}: {failure}"));
                    // The time above depends on the root of the height.
                    let allowed = 100.0 * tolerance * (1.0 + 1.0 / beyond);
                    let (off, name) = ((run.end.q[0] - end).abs(), stringify!($method));
                    assert!(off < allowed, "{name}: {stone:?} {d:e} {tolerance}: {off:e}");
                }
            )*};
        }
        check!(Auto, Picard, Taylor::new(), Dop853);
    }
}

/// A swing that starts just before its turning point passes a level below it twice.
#[test]
fn two_events_just_after_the_start_are_found() {
    let (swing, mut random) = (Swing { L: 1.0, g: 9.81 }, Random::new(4));
    for _ in 0..60 {
        let (θ, ahead) = (random.uniform(0.3, 2.5), power(&mut random, -3.0, -1.0));
        let pull = 9.81 * f64::sin(θ);
        let v = pull * ahead;
        let top = (f64::cos(θ) - v * v / 19.62).acos();
        let level = top - (top - θ) * power(&mut random, -2.0, -0.3);
        let events = [Event::new(move |_, q: &[f64; 1], _: &[f64; 1]| q[0] - level)];
        macro_rules! check {
            ($($method:expr),*) => {$({
                let run = solve(&swing, (0.0, 0.2 + 3.0 * ahead), [θ], [v]).method($method);
                let run = run.rtol(1e-12).atol(1e-14).events(&events).run().unwrap();
                let name = stringify!($method);
                assert_eq!(run.events.len(), 2, "{name}: {θ} {ahead} {level}");
            })*};
        }
        check!(Auto, Picard, Taylor::new(), Dop853);
    }
}
