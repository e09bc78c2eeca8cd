//! Mass matrices that are singular, nearly singular or not positive: an error that says where, or a motion that is right.
//!
//! The determinant of the double pendulum is m₁ m₂ + m₂² sin²(θ₀ − θ₁) times lengths: it vanishes at every state if the second mass is zero,
//! where the links are aligned if the first is, and at an angle between them if the masses have opposite signs.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::error::{Coordinate, Error, Quantity};
use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::prelude::*;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Double { m: [kg; 2], l: m = 1, g: m/s^2 = 1 }
    coordinate θ[2];
    let y[k in 0..2] = sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Polar { }
    coordinate r;
    coordinate φ;
    kinetic = (ṙ^2 + r^2*φ̇^2)/2;
    potential = r;
}

const START: [f64; 2] = [0.5, 0.625];
const TEN: (f64, f64) = (0.0, 10.0);

type Outcome = Result<Solution<f64, 2>, Failure<f64, 2>>;

/// The same start with every kind of method; the last number is the distance from a singular state at which it may stop.
fn everybody(system: &Double) -> [(&'static str, Outcome, f64); 6] {
    let run = || solve(system, TEN, START, [0.0; 2]);
    [
        ("Rk4", run().method(Rk4).step(0.01).run(), 0.3),
        ("Tsit5", run().method(Tsit5).max_steps(20_000).run(), 0.01),
        ("Dop853", run().method(Dop853).max_steps(20_000).run(), 0.01),
        ("Taylor", run().method(Taylor::new()).max_steps(20_000).run(), 0.01),
        ("Gauss", run().method(Gauss::<3>::new()).step(0.01).run(), 0.3),
        ("Rodas4", run().method(Rodas4).step(0.01).run(), f64::INFINITY),
    ]
}

/// The coordinate that an error names, and the time.
fn place(error: &Error) -> Option<(Coordinate, f64)> {
    match *error {
        Error::NotFinite { t, what: Quantity::Acceleration(it) | Quantity::Velocity(it) | Quantity::Position(it), .. }
        | Error::StepSizeUnderflow { t, coordinate: it, .. }
        | Error::NoConvergence { t, coordinate: it, .. } => Some((it, t)),
        _ => None,
    }
}

#[test]
fn a_mass_that_is_zero_is_named_at_once() {
    for (m, parameter) in [([1.0, 0.0], "m[1]"), ([0.0, 0.0], "m[0]")] {
        for (method, outcome, _) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            let (coordinate, t) = place(&failure.error).unwrap_or_else(|| panic!("{method}: {failure}"));
            assert!(coordinate.name == "θ[0]" && (0.0..0.01).contains(&t), "{method}: {failure}");
            assert!(failure.to_string().contains(&format!("check parameter `{parameter}`, which is 0.0")), "{method}: {failure}");
            // The state before is kept.
            assert_eq!((failure.partial.end.t, failure.partial.end.q, failure.partial.end.v), (0.0, START, [0.0; 2]), "{method}");
        }
    }
}

#[test]
fn a_matrix_that_becomes_singular_stops_the_motion_there() {
    for m in [[0.0, 1.0], [1e-300, 1.0], [1.0, -1.2]] {
        let mut times = Vec::new();
        for (method, outcome, reach) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            let (coordinate, t) = place(&failure.error).unwrap_or_else(|| panic!("{method}: {failure}"));
            let end = failure.partial.end;
            assert!(["θ[0]", "θ[1]"].contains(&coordinate.name), "{method}: {failure}");
            // Where the error is and what is kept belong to one step.
            assert!(end.t <= t && t <= end.t + 0.011, "{method}: {failure} after {}", end.t);
            assert!(end.q.iter().chain(&end.v).all(|x| x.is_finite()), "{method}: {failure}");
            let sine = (end.q[0] - end.q[1]).sin();
            let share = m[0] / m[1] + sine * sine;
            if reach < 0.1 {
                assert!(share.abs() < reach, "{method} with {m:?}: {failure} at {share} from a singular state");
                times.push(t);
            }
        }
        for pair in times.windows(2) {
            assert!((pair[0] - pair[1]).abs() < 1e-3 * pair[0], "{m:?}: {times:?}");
        }
    }
}

/// Velocities without bound before the matrix is singular: many short steps, but no more than allowed, and an error.
#[test]
fn no_method_goes_on_for_ever() {
    for m in [[1.0, -1.0], [-1.0, 1.0], [-0.7, 1.0], [1.0, -0.5]] {
        for (method, outcome, _) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            assert!(failure.partial.end.t < 10.0 && failure.partial.stats.accepted <= 20_000, "{method}: {failure}");
        }
    }
}

/// L and −L have the same motion, to the last bit: a negative pivot is no mistake.
#[test]
fn negative_masses_move_as_positive_ones() {
    for (positive, negative) in everybody(&Double::new([1.0, 1.0])).into_iter().zip(everybody(&Double::new([-1.0, -1.0]))) {
        let (method, positive, _) = positive;
        let (a, b) = (positive.unwrap(), negative.1.unwrap());
        assert_eq!((a.end.q, a.end.v), (b.end.q, b.end.v), "{method}");
    }
}

/// A mass that is nearly nothing, or all there is, decouples the links: the digits of both are the same.
#[test]
fn extreme_masses_lose_no_digits() {
    for (light, heavy) in everybody(&Double::new([1.0, 1e-300])).into_iter().zip(everybody(&Double::new([1e300, 1.0]))) {
        let (method, light, _) = light;
        let (a, b) = (light.unwrap().end, heavy.1.unwrap().end);
        for (x, y) in a.q.iter().chain(&a.v).zip(b.q.iter().chain(&b.v)) {
            assert!((x - y).abs() < 1e-12, "{method}: {a:?} and {b:?}");
        }
    }
}

/// With masses (2⁻¹⁰, 1) the condition of the mass matrix reaches thousands, and the error what that explains.
#[test]
fn a_nearly_singular_matrix_costs_digits_but_no_more() {
    // 24 digits at t = 1.
    let exact = [0.493547065607356616, 0.373820183363494690, -0.202714512709385865, -0.294198496168008011];
    let system = Double::new([1.0 / 1024.0, 1.0]);
    let run = || solve(&system, (0.0, 1.0), START, [0.0; 2]);
    let ends = [
        ("Dop853", run().method(Dop853).rtol(1e-13).atol(1e-13).run(), 1e-9),
        ("Taylor", run().method(Taylor::new()).rtol(1e-15).run(), 1e-10),
        ("Gauss", run().method(Gauss::<4>::new()).step(1e-4).run(), 1e-9),
        ("Rk4", run().method(Rk4).step(1e-4).run(), 1e-7),
    ];
    for (method, outcome, bar) in ends {
        let end = outcome.unwrap().end;
        for (x, exact) in end.q.iter().chain(&end.v).zip(exact) {
            assert!((x - exact).abs() < bar, "{method}: {x} and {exact}");
        }
    }
}

/// The angle of polar coordinates has no inertia at the origin: falling through it is an error, beginning there too.
#[test]
fn the_origin_of_polar_coordinates_is_refused() {
    let failure = solve(&Polar::new(), TEN, [0.0, 0.0], [0.0, 1.0]).run().unwrap_err();
    let (coordinate, t) = place(&failure.error).unwrap();
    assert_eq!((coordinate.name, t), ("φ", 0.0), "{failure}");
    assert!(failure.to_string().contains("the mass matrix may be singular"), "{failure}");
}
