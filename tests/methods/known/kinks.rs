//! Motions whose velocity jumps: steps end at the kinks, and the momenta do not change there.

use super::systems::{LinearKeys, MovingPendulum, moving, pendulum};
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{Dop853, Integrator, Leapfrog, Rk4, Srkn6b, Srkn14a, solve};
use pendulum_runtime::motion::Side;
use pendulum_runtime::scalar::Real;
use pendulum_runtime::system::{Driven, Dynamics};

type Keyed = Driven<MovingPendulum<f64>, (LinearKeys,)>;

/// Returns a pendulum driven by noisy keys at 24 frames a second, joined by straight lines: 120
/// kinks in 5 s.
fn keyed() -> Keyed {
    let mut random = 12345_u32;
    let mut keys = Vec::new();
    for i in 0..400 {
        random = random.wrapping_mul(1664525).wrapping_add(1013904223);
        let noise = f64::from(random >> 8) / 16777216.0 - 0.5;
        keys.push(0.1 * Real::sin(0.12 * f64::from(i)) + 0.004 * noise);
    }
    // Only splines need the first key, because they use keys outside of a segment.
    keys.remove(0);
    Driven::new(MovingPendulum { length: 0.5, g: 9.81 }, (LinearKeys { rate: 24.0, keys },))
}

/// θ(5), from θ = 0.3 at rest.
const EXACT: f64 = -0.129608683467;

fn error(method: impl Method<Keyed, 1>, steps_per_key: u32) -> f64 {
    let step = 1.0 / (24.0 * f64::from(steps_per_key));
    let solution =
        solve(&keyed(), (0.0, 5.0), [0.3], [0.0]).method(method).step(step).run().unwrap();
    assert_eq!(solution.stats.accepted, u64::from(120 * steps_per_key));
    assert_eq!(solution.stats.kinks, 120);
    (solution.end.q[0] - EXACT).abs()
}

#[test]
fn aligned_steps_with_impulses() {
    // Published: leapfrog 3.2e-3 and 1.9e-4, SRKN6b 2.6e-8 and 1.0e-10 with 1 and 4 steps a key.
    assert!(error(Leapfrog, 1) < 6.4e-3);
    assert!(error(Leapfrog, 4) < 3.8e-4);
    assert!(error(Srkn6b, 1) < 5.2e-8);
    assert!(error(Srkn6b, 4) < 2e-10);
    assert!(error(Srkn14a, 1) < 1e-11);
    assert!(error(Rk4, 4) < 2e-7);
    assert!(error(Dop853, 1) < 1e-11);
}

#[test]
fn leapfrog_looks_at_each_segment_once() {
    let solution =
        solve(&keyed(), (0.0, 5.0), [0.3], [0.0]).method(Leapfrog).step(1.0 / 24.0).run().unwrap();
    assert_eq!(solution.stats.evaluations, 120);
}

#[test]
fn adaptive_steps_land_on_kinks() {
    let solution = solve(&keyed(), (0.0, 5.0), [0.3], [0.0])
        .method(Dop853)
        .rtol(1e-10)
        .atol(1e-10)
        .run()
        .unwrap();
    assert!((solution.end.q[0] - EXACT).abs() < 1e-9, "{}", solution.stats);
    assert_eq!(solution.stats.kinks, 120);
    // One step per key is sufficient, and no step is rejected once the step size is found.
    assert!(solution.stats.accepted < 130 && solution.stats.rejected < 5, "{}", solution.stats);
}

#[test]
fn an_undriven_interval_is_not_divided() {
    let formula = |_| [[0.0; 2]; 3];
    let driven = |period| moving(formula, period);
    let smooth = solve(&driven(f64::INFINITY), (0.0, 10.0), [1.3], [0.0])
        .method(Rk4)
        .step(0.1)
        .run()
        .unwrap();
    let kinked =
        solve(&driven(0.5), (0.0, 10.0), [1.3], [0.0]).method(Rk4).step(0.1).run().unwrap();
    // A kink without a jump does not change the state, including its low words. Steps of a fifth of
    // ½ are steps of 0.1.
    assert_eq!((kinked.stats.kinks, smooth.stats.kinks), (20, 0));
    assert!((smooth.end.q[0] - kinked.end.q[0]).abs() < 1e-15);
    assert_eq!(kinked.stats.evaluations, smooth.stats.evaluations);
}

#[test]
fn cutting_at_kinks_does_not_shorten_later_steps() {
    let formula = |_| [[0.0; 2]; 3];
    let run = |period| {
        let driven = moving(formula, period);
        solve(&driven, (0.0, 100.0), [1.3], [0.0]).method(Dop853).run().unwrap().stats.accepted
    };
    let (smooth, kinked) = (run(f64::INFINITY), run(9.7));
    assert!(kinked <= smooth + 2 * 10, "{kinked} steps, {smooth} without kinks");
}

#[test]
fn the_shortest_cut_does_not_shorten_later_steps() {
    let system = pendulum();
    let run = |stops: &[f64]| {
        let problem =
            solve(&system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).rtol(1e-9).atol(1e-9);
        let stats = problem.t_stops(stops).run().unwrap().stats;
        stats.accepted + stats.rejected
    };
    let plain = run(&[]);
    // The error of such a short step is rounding.
    for gap in [1e-3, 1e-6, 1e-9, 1e-14] {
        let stops: Vec<f64> = (1..10).flat_map(|k| [f64::from(k), f64::from(k) + gap]).collect();
        let cut = run(&stops);
        assert!(cut <= plain + 3 * 9, "{cut} steps with stops {gap:e} apart, {plain} without");
    }
}

#[test]
fn momenta_are_equal_on_both_sides() {
    let driven = keyed();
    let mut integrator = Integrator::new(&driven, Dop853, 0.0, [0.3], [0.0]).unwrap();
    let kink = 3.0 / 24.0;
    integrator.advance_to(kink).unwrap();
    let solution = solve(&driven, (0.0, 1.0), [0.3], [0.0]).method(Dop853).dense().run().unwrap();
    let (before, after) =
        (solution.at_side(kink, Side::Before).unwrap(), solution.at(kink).unwrap());
    assert!((before.q[0] - after.q[0]).abs() < 1e-15);
    // Δθ̇ = −Δẋ cos θ / l.
    let velocity = |side| {
        driven.inputs(kink.into(), side, pendulum_runtime::system::Purpose::Momenta).0.velocity[0]
    };
    let jump = velocity(Side::After) - velocity(Side::Before);
    assert!(1e-3 < jump.abs());
    assert!((after.v[0] - before.v[0] + jump * before.q[0].cos() / 0.5).abs() < 1e-14);
    assert!((after.v[0] - integrator.v()[0]).abs() < 1e-6);
}

#[test]
fn every_step_records_both_sides() {
    let solution = solve(&keyed(), (0.0, 0.25), [0.3], [0.0])
        .method(Srkn6b)
        .step(1.0)
        .every_step()
        .run()
        .unwrap();
    // Six segments of one step each: the start, and two states at each of six kinks.
    assert_eq!(solution.t.len(), 13);
    for pair in solution.t[1..].chunks(2) {
        assert_eq!(pair[0], pair[1]);
    }
    assert!(solution.v[1] != solution.v[2] && solution.q[1] == solution.q[2]);
}

#[test]
fn an_integration_continued_at_a_kink_is_the_same_integration() {
    let driven = keyed();
    let whole =
        solve(&driven, (0.0, 2.0), [0.3], [0.0]).method(Srkn6b).step(1.0 / 24.0).run().unwrap().end;
    let first =
        solve(&driven, (0.0, 1.0), [0.3], [0.0]).method(Srkn6b).step(1.0 / 24.0).run().unwrap().end;
    let second = solve(&driven, (1.0, 2.0), first.q, first.v)
        .method(Srkn6b)
        .step(1.0 / 24.0)
        .run()
        .unwrap()
        .end;
    assert!((whole.q[0] - second.q[0]).abs() < 1e-15 && (whole.v[0] - second.v[0]).abs() < 1e-14);
}
