//! Tolerances below the rounding that accelerations inherit from coordinates: bodies close to each
//! other and far from the origin.

use core::f64::consts::TAU;
use pendulum_runtime::integrate::{Auto, Picard, solve};
use pendulum_runtime::lagrangian;
use systems::work_precision::problem::{Problem, lines};
use systems::work_precision::pythagorean;

lagrangian! {
    /// A planet about a star that is at `c`.
    #[derive(Clone, Debug)]
    struct Off { μ, c }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -μ/|[x - c, y]|;
}

lagrangian! {
    /// A weight on a stiffening spring whose end is at `c`.
    #[derive(Clone, Debug)]
    struct Spring { k, c }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*((x - c)^2/2 + (x - c)^4/4);
}

#[test]
fn a_planet_far_from_the_origin_takes_steps_of_the_same_order() {
    for e in [0.5, 0.9, 0.99_f64] {
        let (x, v) = (1.0 - e, ((1.0 + e) / (1.0 - e)).sqrt());
        for rtol in [1e-12, 1e-13, 1e-14, 1e-15] {
            let run = |c: f64| {
                let planet = Off::new(1.0, c);
                let run = solve(&planet, (0.0, 20.0), [c + x, 0.0], [0.0, v]);
                let run = run.method(Picard).rtol(rtol).atol(rtol).run().unwrap();
                ([run.end.q[0] - c, run.end.q[1]], run.stats.evaluations)
            };
            let (here, own) = run(0.0);
            for c in [100.0, 1e4, 1e6] {
                let (there, evaluations) = run(c);
                assert!(evaluations < 8 * own, "{e} {rtol} {c}: {evaluations} for {own}");
                // An error of c ε at the closest point, magnified as its square and by the time.
                let error = (there[0] - here[0]).hypot(there[1] - here[1]);
                let bound = 200.0 * c * f64::EPSILON / (x * x);
                assert!(error < bound, "{e} {rtol} {c}: {error:e} for {bound:e}");
            }
        }
    }
}

#[test]
fn in_f32_a_planet_far_from_the_origin_takes_steps_of_the_same_order() {
    for rtol in [1e-5, 1e-6, 1e-7] {
        let run = |c: f32| {
            let start = ([c + 0.1, 0.0], [0.0, 19.0_f32.sqrt()]);
            let planet = Off::new(1.0_f32, c);
            let run = solve(&planet, (0.0, 20.0), start.0, start.1);
            run.method(Picard).rtol(rtol).atol(rtol).run().unwrap().stats.evaluations
        };
        let own = run(0.0);
        for c in [10.0, 100.0, 1000.0] {
            assert!(run(c) < 8 * own, "{rtol} {c}");
        }
    }
}

#[test]
fn a_spring_far_from_the_origin_swings_as_one_at_it() {
    for rtol in [1e-12, 1e-14] {
        let run = |c: f64| {
            let spring = Spring::new(4.0, c);
            let run = solve(&spring, (0.0, 5.0 * TAU), [c + 0.5], [0.0]);
            let run = run.method(Picard).rtol(rtol).atol(rtol).run().unwrap();
            (run.end.q[0] - c, run.stats.evaluations)
        };
        let (here, own) = run(0.0);
        for c in [1e3, 1e6, 1e8] {
            let (there, evaluations) = run(c);
            assert!(evaluations < 8 * own, "{rtol} {c}: {evaluations} for {own}");
            assert!((there - here).abs() < 1e3 * c * f64::EPSILON, "{rtol} {c}: {there} {here}");
        }
    }
}

/// Their closest encounter, at t = 15.83, is a few thousandths wide.
#[test]
fn the_pythagorean_bodies_pass_their_encounters_at_every_tolerance() {
    let Problem { q, v, .. } = Problem::<6>::new("pythagorean");
    let bodies = pythagorean();
    let states: Vec<_> = lines("pythagorean").skip(1).take(2).collect();
    let times: Vec<f64> = states.iter().map(|line| line.1).collect();
    for rtol in [1e-11, 1e-13, 1e-14, 1e-15] {
        let run = solve(&bodies, (0.0, 24.0), q, v).method(Picard).rtol(rtol).atol(rtol);
        let run = run.t_stops(&times).t_eval(&times).run().unwrap();
        assert!(run.stats.evaluations < 80_000, "{rtol}: {}", run.stats.evaluations);
        for (k, (_, _, digits)) in states.iter().enumerate() {
            let reached = run.q[k].iter().chain(&run.v[k]);
            let error = reached.zip(digits).map(|(x, digits)| {
                let exact: f64 = digits.parse().unwrap();
                (x - exact).abs()
            });
            let error = error.fold(0.0, f64::max);
            // Rounding of a start is magnified a millionfold by the encounter.
            assert!(error < [1e-9, 1e-7][k], "{rtol}: {error:e}");
        }
    }
    let default = solve(&bodies, (0.0, 24.0), q, v).method(Auto).rtol(1e-15).atol(1e-15);
    assert!(default.run().unwrap().stats.evaluations < 80_000);
}
