//! Mass matrices that are singular, nearly singular or not positive: an error with the state, or an
//! accurate motion.
//!
//! The determinant of the double pendulum is m₁ m₂ + m₂² sin²(θ₀ − θ₁) times lengths: it vanishes
//! at every state if the second mass is zero, and at aligned links if the first mass is zero. If a
//! mass is negative, a pivot is negative. The inertia of `Fading` decreases to zero.

use pendulum_runtime::error::{Coordinate, Error, Quantity};
use pendulum_runtime::integrate::{Batch, Failure, FixedStep, Problem, Solution};
use pendulum_runtime::motion::Curve;
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

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Fading { end: s, loss: kg/s }
    coordinate w: m;
    coordinate u: m;
    kinetic = end*loss*ẇ^2/2 + (end - t)*loss*u̇^2/2;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Ballast { m: kg }
    coordinate u: m;
    driven x: 1;
    kinetic = m*(1 - x)*u̇^2/2;
}

const START: [f64; 2] = [0.5, 0.625];
const TEN: (f64, f64) = (0.0, 10.0);

type Outcome = Result<Solution<f64, 2>, Failure<f64, 2>>;

/// Runs every kind of method from the same start. The last number is the distance from a singular
/// state at which the method may stop.
fn everybody(system: &Double) -> [(&'static str, Outcome, f64); 5] {
    let run = || solve(system, TEN, START, [0.0; 2]);
    // `extreme_masses_lose_no_digits` compares two runs to 1e-12. Their rounding errors differ, and
    // therefore also the lengths of their steps. With `atol` = 1e-6, the default, the resulting
    // differences of the errors exceed 1e-12; with 1e-9 they are small enough.
    [
        ("Rk4", run().method(Rk4).step(0.01).run(), 0.3),
        ("Dop853", run().method(Dop853).atol(1e-9).max_steps(20_000).run(), 0.01),
        ("Taylor", run().method(Taylor::new()).max_steps(20_000).run(), 0.01),
        ("Gauss", run().method(Gauss::<3>::new()).step(0.01).run(), 0.3),
        ("Rodas4", run().method(Rodas4).step(0.01).run(), f64::INFINITY),
    ]
}

/// Returns the coordinate and the time of an error, if any.
fn place(error: &Error) -> Option<(Coordinate, f64)> {
    match *error {
        Error::NotFinite {
            t,
            what:
                Quantity::Acceleration(it)
                | Quantity::Velocity(it)
                | Quantity::Position(it)
                | Quantity::Series(it),
            ..
        }
        | Error::StepSizeUnderflow { t, coordinate: it, .. }
        | Error::NegativeInertia { t, coordinate: it, .. }
        | Error::NoConvergence { t, coordinate: it, .. } => Some((it, t)),
        _ => None,
    }
}

#[test]
fn a_mass_that_is_zero_is_named_at_once() {
    for (m, parameter) in [([1.0, 0.0], "m[1]"), ([0.0, 0.0], "m[0]")] {
        for (method, outcome, _) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            let (coordinate, t) =
                place(&failure.error).unwrap_or_else(|| panic!("{method}: {failure}"));
            assert!(coordinate.name == "θ[0]" && (0.0..0.01).contains(&t), "{method}: {failure}");
            assert!(
                failure
                    .to_string()
                    .contains(&format!("check parameter `{parameter}`, which is 0.0")),
                "{method}: {failure}"
            );
            // The state before the step is kept.
            assert_eq!(
                (failure.partial.end.t, failure.partial.end.q, failure.partial.end.v),
                (0.0, START, [0.0; 2]),
                "{method}"
            );
        }
    }
}

#[test]
fn a_matrix_that_becomes_singular_stops_the_motion_there() {
    for m in [[0.0, 1.0], [1e-300, 1.0]] {
        let mut times = Vec::new();
        for (method, outcome, reach) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            let (coordinate, t) =
                place(&failure.error).unwrap_or_else(|| panic!("{method}: {failure}"));
            let end = failure.partial.end;
            assert!(["θ[0]", "θ[1]"].contains(&coordinate.name), "{method}: {failure}");
            // The error and the kept state belong to the same step.
            assert!(end.t <= t && t <= end.t + 0.011, "{method}: {failure} after {}", end.t);
            assert!(end.q.iter().chain(&end.v).all(|x| x.is_finite()), "{method}: {failure}");
            let sine = (end.q[0] - end.q[1]).sin();
            let share = m[0] / m[1] + sine * sine;
            if reach < 0.1 {
                assert!(
                    share.abs() < reach,
                    "{method} with {m:?}: {failure} at {share} from a singular state"
                );
                times.push(t);
            }
        }
        for pair in times.windows(2) {
            assert!((pair[0] - pair[1]).abs() < 1e-3 * pair[0], "{m:?}: {times:?}");
        }
    }
}

/// A negative pivot is an error before the first step, with the coordinate and the negative masses.
#[test]
fn negative_inertia_is_refused_at_once() {
    let cases = [
        ([1.0, -1.2], "θ[0]", "`m[1]`, which is -1.2"),
        ([1.0, -0.5], "θ[1]", "`m[1]`, which is -0.5"),
        ([-0.7, 1.0], "θ[1]", "`m[0]`, which is -0.7"),
        ([-2.0, 1.0], "θ[0]", "`m[0]`, which is -2.0"),
        ([-1.0, -1.0], "θ[0]", "`m[0]`, which is -1.0, `m[1]`, which is -1.0"),
    ];
    for (m, name, masses) in cases {
        let system = Double::new(m);
        for (method, outcome, _) in everybody(&system) {
            let failure = outcome.unwrap_err();
            let Error::NegativeInertia { t: 0.0, coordinate, pivot, .. } = failure.error else {
                panic!("{method}: {failure}")
            };
            assert!(coordinate.name == name && pivot < -0.1, "{method}: {failure}");
            assert!(
                failure.to_string().ends_with(&format!("; check parameter {masses}")),
                "{method}: {failure}"
            );
            assert_eq!((failure.partial.end.t, failure.partial.end.q), (0.0, START), "{method}");
        }
        assert!(matches!(
            Integrator::new(&system, Rk4, 0.0, START, [0.0; 2]),
            Err(Error::NegativeInertia { .. })
        ));
        let problem = Problem { system, time: TEN, q: START, v: [0.0; 2] };
        let outcome = Batch::new().run(&[problem]).unwrap().remove(0);
        assert!(
            matches!(outcome, Err(Failure { error: Error::NegativeInertia { .. }, .. })),
            "{m:?}"
        );
    }
}

/// The pivots m₁ + m₂ and 1 precede the negative pivot: with opposite masses, the first pivot is
/// zero, and the matrix is singular.
#[test]
fn masses_that_cancel_are_an_error_too() {
    for m in [[1.0, -1.0], [-1.0, 1.0]] {
        for (method, outcome, _) in everybody(&Double::new(m)) {
            let failure = outcome.unwrap_err();
            assert!(
                failure.partial.end.t < 10.0 && failure.partial.stats.accepted <= 20_000,
                "{method}: {failure}"
            );
        }
    }
}

/// Methods with step control stop where the inertia reaches zero. Fixed steps pass this point; the
/// error occurs at the end of the run or after 64 steps, with the state before the last step.
#[test]
fn inertia_that_ends_on_the_way_is_seen() {
    let system = Fading::new(1.0, 1.0);
    let run = |end: f64| solve(&system, (0.0, end), [0.0, 0.0], [1.0, 0.5]);
    for failure in [
        run(3.0).method(Dop853).run().unwrap_err(),
        run(3.0).method(Taylor::new()).run().unwrap_err(),
    ] {
        assert!((failure.partial.end.t - 1.0).abs() < 1e-3, "{failure}");
    }
    // The seventh and last step ends beyond the zero; the fourth step also does, but is not
    // checked.
    let failure = run(2.1).method(Rk4).step(0.3).run().unwrap_err();
    let Error::NegativeInertia { t: 2.1, coordinate, pivot, .. } = failure.error else {
        panic!("{failure}")
    };
    assert_eq!(
        (coordinate.name, coordinate.index, pivot, failure.partial.stats.accepted),
        ("u", 1, 1.0 - 2.1, 6),
        "{failure}"
    );
    assert!(
        (failure.partial.end.t - 1.8).abs() < 1e-9
            && failure.partial.end.v.iter().all(|v| v.abs() < 10.0),
        "{failure}"
    );
    assert!(
        failure
            .to_string()
            .contains("the inertia of `u` is negative, -1.1; the kinetic energy has to be"),
        "{failure}"
    );
    // Without an end of the run, the error occurs at step 64.
    let start = |control| {
        Integrator::new(&system, Rk4, 0.0, [0.0; 2], [1.0, 0.5]).unwrap().control(control).unwrap()
    };
    let mut integrator = start(FixedStep::new(0.3));
    let (steps, error) =
        (1..=64).find_map(|step| integrator.step().err().map(|error| (step, error))).unwrap();
    assert!(matches!(error, Error::NegativeInertia { .. }), "{error}");
    assert!(
        steps == 64 && (integrator.t() - 63.0 * 0.3).abs() < 1e-9,
        "{steps}: {}",
        integrator.t()
    );
    // The state before the step is kept, and the next step returns the same error.
    assert_eq!(integrator.step().unwrap_err(), error);
    // A reset to a time with inertia succeeds, and a reset to a time without inertia fails.
    assert!(matches!(
        integrator.reset(1.5, [0.0; 2], [1.0, 0.5]),
        Err(Error::NegativeInertia { .. })
    ));
    assert!(matches!(
        integrator.displace([0.0, 3.0], [0.0; 2]),
        Err(Error::NegativeInertia { .. })
    ));
    integrator.reset(-1.0, [0.0; 2], [1.0, 0.5]).unwrap();
    integrator.step().unwrap();
}

/// Tests inertia that depends on a driven input with kinks.
#[test]
fn inertia_that_a_motion_takes_away_is_seen_at_the_kink() {
    let motion = Curve::linear(&[0.0, 1.0, 1.5, 2.0], &[[0.0], [0.5], [2.0], [2.0]]).unwrap();
    let dynamics = Ballast::new(1.0).driven_by(motion);
    let failure =
        solve(&dynamics, (0.0, 10.0), [0.0], [0.0]).method(Rk4).step(0.5).run().unwrap_err();
    let Error::NegativeInertia { t: 1.5, coordinate, .. } = failure.error else {
        panic!("{failure}")
    };
    assert_eq!((coordinate.name, failure.partial.end.t), ("u", 1.0), "{failure}");
}

/// A nearly zero or a huge mass decouples the links: both motions agree.
#[test]
fn extreme_masses_lose_no_digits() {
    for (light, heavy) in everybody(&Double::new([1.0, 1e-300]))
        .into_iter()
        .zip(everybody(&Double::new([1e300, 1.0])))
    {
        let (method, light, _) = light;
        let (a, b) = (light.unwrap().end, heavy.1.unwrap().end);
        for (x, y) in a.q.iter().chain(&a.v).zip(b.q.iter().chain(&b.v)) {
            assert!((x - y).abs() < 1e-12, "{method}: {a:?} and {b:?}");
        }
    }
}

/// With masses (2⁻¹⁰, 1), the condition number of the mass matrix reaches thousands, and the errors
/// agree with this condition number.
#[test]
fn a_nearly_singular_matrix_costs_digits_but_no_more() {
    // The reference at t = 1 was computed with 24 digits.
    let exact =
        [0.493547065607356616, 0.373820183363494690, -0.202714512709385865, -0.294198496168008011];
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

/// The angle of polar coordinates has no inertia at the origin: a fall through the origin and a
/// start at the origin are errors.
#[test]
fn the_origin_of_polar_coordinates_is_refused() {
    let failure = solve(&Polar::new(), TEN, [0.0, 0.0], [0.0, 1.0]).run().unwrap_err();
    let (coordinate, t) = place(&failure.error).unwrap();
    assert_eq!((coordinate.name, t), ("φ", 0.0), "{failure}");
    for part in [
        "at t = 0.0 the acceleration of `φ` is not finite; the mass matrix may be singular",
        "at a pole of angles or of polar coordinates take components with a constraint",
    ] {
        assert!(failure.to_string().contains(part), "{failure}");
    }
}
