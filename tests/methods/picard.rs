//! The `Picard` method on generated systems: reference digits, kinks, states within steps, single
//! precision, and errors.

use pendulum_runtime::error::{Error, Quantity};
use pendulum_runtime::integrate::{AdaptiveStep, FixedStep};
use pendulum_runtime::motion::{Curve, Function, Sinusoid};
use pendulum_runtime::prelude::*;

use systems::keys::keys;
use systems::pendulums::Hanging;
use systems::problems::{Double, Kepler, Simple};

lagrangian! {
    pub struct Falling { g }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
}

lagrangian! {
    /// A spring of the rate k with a damper.
    pub struct Sprung { k, c }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2;
    dissipation = c*ẋ^2/2;
}

lagrangian! {
    /// Defined above zero only.
    pub struct Root { k }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^(3/2);
}

lagrangian! {
    /// An atom about another, after Lennard-Jones.
    pub struct Atoms { ε }
    coordinate r;
    coordinate φ;
    lagrangian = (ṙ^2 + r^2*φ̇^2)/2 - 4*ε*(r^(-12) - r^(-6));
}

/// θ after 1000 s from 1.3 at rest with g/L = 9.8: 2 asin(k sn(K − ωt | k²)) with k = sin 0.65.
const AFTER_1000_S: f64 = 1.2960573950636069;
/// The same after 10 s with g/L = 1.
const AFTER_10_S: f64 = -1.1661603819329576;

#[test]
fn a_thousand_seconds() {
    let simple = Simple::new(9.8);
    for (rtol, bound) in [(1e-9, 1e-4), (1e-12, 1e-7), (1e-15, 2e-11), (1e-18, 2e-11)] {
        let solution =
            solve(&simple, (0.0, 1000.0), [1.3], [0.0]).method(Picard).rtol(rtol).run().unwrap();
        let error = (solution.end.q[0] - AFTER_1000_S).abs();
        assert!(error < bound, "{rtol}: {error:e}");
        assert_eq!(solution.stats.method, "Picard");
        assert!(solution.stats.rejected * 20 < solution.stats.accepted, "{}", solution.stats);
    }
}

/// Steps of equal length have order 16. Back with the reversed velocity, they pass the same
/// positions.
#[test]
fn equal_steps() {
    let simple = Simple::new(1.0);
    let error = |steps| {
        let end = solve(&simple, (0.0, 10.0), [1.3], [0.0])
            .method(Picard)
            .steps(steps)
            .run()
            .unwrap()
            .end;
        (end.q[0] - AFTER_10_S).abs()
    };
    let observed = (error(8) / error(12)).log(1.5);
    assert!((14.5..18.5).contains(&observed), "{observed}");
    assert!(error(20) < 2e-15 && error(200) < 2e-15, "{:e} {:e}", error(20), error(200));
    let run =
        |q, v| solve(&simple, (0.0, 1000.0), [q], [v]).method(Picard).step(0.5).run().unwrap().end;
    let there = run(0.05, 0.025);
    let back = run(there.q[0], -there.v[0]);
    let distance = (back.q[0] - 0.05).hypot(back.v[0] + 0.025);
    assert!(distance < 2e-15, "{distance:e}");
}

/// Tests accelerations with velocities and a variable mass matrix: the energy is conserved, and the
/// motion agrees with the Taylor series.
#[test]
fn coupled_pendulums() {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    let trusted = solve(&double, (0.0, 10.0), [2.0, 2.5], [0.0; 2])
        .method(Taylor::new())
        .rtol(1e-18)
        .run()
        .unwrap()
        .end;
    // The motion amplifies errors 1300 times.
    for rtol in [1e-6, 1e-9, 1e-12, 1e-15] {
        let end = solve(&double, (0.0, 10.0), [2.0, 2.5], [0.0; 2])
            .method(Picard)
            .rtol(rtol)
            .run()
            .unwrap()
            .end;
        let error = (0..2).fold(0.0, |error: f64, i| {
            error.max((end.q[i] - trusted.q[i]).abs()).max((end.v[i] - trusted.v[i]).abs())
        });
        println!("{rtol} {error:e}");
        assert!(error < 3000.0 * rtol, "{rtol}: {error:e}");
    }
}

#[test]
fn motions_of_every_kind() {
    let closure =
        Function::new(|t| [0.0, 0.5 * t * t]).velocity(|t| [0.0, t]).acceleration(|_| [0.0, 1.0]);
    let lifted = Hanging { m: 1.0, L: 0.5, g: 9.8 }.driven_by(closure);
    let end =
        solve(&lifted, (0.0, 5.0), [0.3], [0.0]).method(Picard).rtol(1e-13).run().unwrap().end;
    // A lift with the acceleration 1 increases gravity by 1.
    let heavier = solve(&Simple::new(2.0 * 10.8), (0.0, 5.0), [0.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-15)
        .run()
        .unwrap()
        .end;
    assert!((end.q[0] - heavier.q[0]).abs() < 1e-11, "{} {}", end.q[0], heavier.q[0]);
    let shaken =
        Hanging { m: 1.0, L: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.1], 2.0, [0.0, 0.4]));
    let run = |rtol| {
        solve(&shaken, (0.0, 20.0), [0.5], [0.0]).method(Picard).rtol(rtol).run().unwrap().end
    };
    let trusted = solve(&shaken, (0.0, 20.0), [0.5], [0.0])
        .method(Taylor::new())
        .rtol(1e-18)
        .run()
        .unwrap()
        .end;
    assert!(
        (run(1e-8).q[0] - trusted.q[0]).abs() < 1e-5
            && (run(1e-16).q[0] - trusted.q[0]).abs() < 1e-13
    );
}

/// Compares with the angles after five seconds of `kinks.rs`.
#[test]
fn keys_are_met() {
    let (times, values) = keys();
    let pendulum = Hanging::new(0.3, 0.5);
    let linear = pendulum.clone().driven_by(Curve::linear(&times, &values).unwrap());
    let catmull_rom = pendulum.clone().driven_by(Curve::catmull_rom(&times, &values).unwrap());
    let end = solve(&linear, (0.0, 5.0), [0.3], [0.0]).method(Picard).rtol(1e-14).run().unwrap();
    assert!((end.end.q[0] + 0.129608683467).abs() < 5e-12, "{}", end.end.q[0]);
    assert_eq!(end.stats.kinks, 120);
    let end =
        solve(&catmull_rom, (0.0, 5.0), [0.3], [0.0]).method(Picard).rtol(1e-14).run().unwrap();
    assert!((end.end.q[0] + 0.128838666144).abs() < 5e-12, "{}", end.end.q[0]);
    // Pieces of a spline meet within steps, where their third derivatives jump: that costs steps,
    // not digits.
    let spline = pendulum.driven_by(Curve::spline(&times, &values).unwrap());
    let end = |rtol| {
        solve(&spline, (0.0, 5.0), [0.3], [0.0]).method(Picard).rtol(rtol).run().unwrap().end.q[0]
    };
    let trusted = solve(&spline, (0.0, 5.0), [0.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-16)
        .run()
        .unwrap()
        .end
        .q[0];
    assert!(
        (end(1e-8) - trusted).abs() < 1e-6 && (end(1e-11) - trusted).abs() < 1e-9,
        "{} {trusted}",
        end(1e-8)
    );
}

/// The motion within steps is as accurate as at their ends.
#[test]
fn dense_output_is_exact() {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    let start = ([0.5, -0.25], [0.0; 2]);
    let trusted = solve(&double, (0.0, 20.0), start.0, start.1)
        .method(Taylor::new())
        .rtol(1e-18)
        .dense()
        .run()
        .unwrap();
    for rtol in [1e-5, 1e-8, 1e-11, 1e-14] {
        let solution = solve(&double, (0.0, 20.0), start.0, start.1)
            .method(Picard)
            .rtol(rtol)
            .dense()
            .run()
            .unwrap();
        for k in 0..=1000 {
            let t = 0.02 * f64::from(k);
            let (state, exact) = (solution.at(t).unwrap(), trusted.at(t).unwrap());
            for i in 0..2 {
                let error = (state.q[i] - exact.q[i]).abs().max((state.v[i] - exact.v[i]).abs());
                assert!(error < 100.0 * rtol, "{rtol} at {t}: {error:e}");
            }
        }
    }
}

/// Locates the first flip of the chaotic double pendulum.
#[test]
fn events_are_located() {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    let over = |_: f64, q: &[f64; 2], _: &[f64; 2]| q[1].abs() - 3.0 * core::f64::consts::PI;
    let events = [pendulum_runtime::integrate::Event::new(over).terminal()];
    let flip = |method: &str| {
        let problem = solve(&double, (0.0, 30.0), [2.0, 2.5], [0.0; 2]);
        let solution = match method {
            "Picard" => problem.method(Picard).rtol(1e-15).events(&events).run(),
            _ => problem.method(Taylor::new()).rtol(1e-18).events(&events).run(),
        };
        solution.unwrap().end.t
    };
    let (found, trusted) = (flip("Picard"), flip("Taylor"));
    assert!((found - trusted).abs() < 1e-9, "{found} {trusted}");
}

#[test]
fn motions_without_accelerations() {
    let falling = Falling::new(9.81);
    let solution = solve(&falling, (0.0, 100.0), [0.0, 3.0], [1.0, 2.0])
        .method(Picard)
        .rtol(1e-14)
        .run()
        .unwrap();
    assert!(solution.stats.accepted < 50, "{}", solution.stats);
    assert!(
        (solution.end.q[0] - 100.0).abs() < 1e-12
            && (solution.end.q[1] - (203.0 - 9.81 * 5000.0)).abs() < 1e-9
    );
    let rest = solve(&Simple::new(1.0), (0.0, 1e6), [0.0], [0.0]).method(Picard).run().unwrap();
    assert_eq!((rest.end.q, rest.end.v), ([0.0], [0.0]));
    assert!(rest.stats.accepted < 100, "{}", rest.stats);
    let fixed =
        solve(&Simple::new(1.0), (0.0, 10.0), [0.0], [0.0]).method(Picard).step(0.5).run().unwrap();
    assert_eq!(fixed.end.q, [0.0]);
    // A pivot at rest that starts to move.
    let (times, values) = ([0.0, 1.0, 2.0], [[0.0, 0.0], [0.0, 0.0], [0.5, 0.0]]);
    let pushed =
        Hanging { m: 1.0, L: 1.0, g: 9.8 }.driven_by(Curve::linear(&times, &values).unwrap());
    for end in [
        solve(&pushed, (0.0, 2.0), [0.0], [0.0]).method(Picard).step(0.1).run().unwrap().end,
        solve(&pushed, (0.0, 2.0), [0.0], [0.0]).method(Picard).rtol(1e-13).run().unwrap().end,
    ] {
        let trusted = solve(&pushed, (0.0, 2.0), [0.0], [0.0])
            .method(Taylor::new())
            .rtol(1e-15)
            .run()
            .unwrap()
            .end;
        assert!((end.q[0] - trusted.q[0]).abs() < 1e-12, "{} {}", end.q[0], trusted.q[0]);
    }
}

/// Tests a coordinate that is almost constant beside a moving one, and a coordinate whose
/// accelerations are only rounding errors.
#[test]
fn coordinates_of_other_sizes() {
    let kepler = Kepler::new(1.0);
    let solution = solve(&kepler, (0.0, 1.0), [1.0, 0.0], [0.1, 1e-12])
        .method(Picard)
        .rtol(1e-10)
        .run()
        .unwrap();
    let trusted = solve(&kepler, (0.0, 1.0), [1.0, 0.0], [0.1, 1e-12])
        .method(Taylor::new())
        .rtol(1e-16)
        .run()
        .unwrap();
    assert!((solution.end.q[0] - trusted.end.q[0]).abs() < 1e-9);
    assert!((solution.end.q[1] - trusted.end.q[1]).abs() < 1e-9);
}

#[test]
fn single_precision() {
    let simple = Simple::new(1.0f32);
    for rtol in [1e-5, 1e-7, 1e-12] {
        let end =
            solve(&simple, (0.0, 10.0), [1.3], [0.0]).method(Picard).rtol(rtol).run().unwrap().end;
        assert!((end.q[0] + 1.166_160_4).abs() < 3e-6 + 20.0 * rtol as f32, "{rtol}: {}", end.q[0]);
    }
    let end =
        solve(&simple, (0.0, 10.0), [1.3], [0.0]).method(Picard).step(0.25).run().unwrap().end;
    assert!((end.q[0] + 1.166_160_4).abs() < 3e-6, "{}", end.q[0]);
}

/// A stiff damper shortens adaptive steps. Fixed steps that are too long do not converge.
#[test]
fn stiff_systems() {
    let sprung = Sprung { k: 100.0, c: 400.0 };
    let solution =
        solve(&sprung, (0.0, 1.0), [1.0], [0.0]).method(Picard).rtol(1e-9).run().unwrap();
    let trusted =
        solve(&sprung, (0.0, 1.0), [1.0], [0.0]).method(Taylor::new()).rtol(1e-15).run().unwrap();
    assert!(
        (solution.end.q[0] - trusted.end.q[0]).abs() < 1e-8,
        "{}",
        solution.end.q[0] - trusted.end.q[0]
    );
    let failure =
        solve(&sprung, (0.0, 1.0), [1.0], [0.0]).method(Picard).step(0.2).run().unwrap_err();
    let Error::NoConvergence { step, coordinate, .. } = failure.error else { panic!("{failure}") };
    assert_eq!((step, coordinate.name), (0.2, "x"));
}

#[test]
fn errors_say_where() {
    // A fall into the centre from rest: the singularity is reached at π/(2√2).
    let kepler = Kepler::new(1.0);
    let failure = solve(&kepler, (0.0, 2.0), [1.0, 0.0], [0.0, 0.0])
        .method(Picard)
        .rtol(1e-12)
        .run()
        .unwrap_err();
    let t = failure.partial.end.t;
    assert!((t - 1.1107207345395915).abs() < 1e-6, "{failure:?}");
    let failure =
        solve(&Simple::new(f64::NAN), (0.0, 2.0), [1.0], [0.0]).method(Picard).run().unwrap_err();
    let Error::NotFinite { t, what: Quantity::Acceleration(coordinate), ref suspects } =
        failure.error
    else {
        panic!("{failure}")
    };
    assert_eq!((t, coordinate.name, suspects[0].parameter), (0.0, "q", "g"));
    let failure =
        solve(&Root { k: 1.0 }, (0.0, 10.0), [1.0], [0.0]).method(Picard).run().unwrap_err();
    assert!(
        matches!(failure.error, Error::NotFinite { what: Quantity::Acceleration(_), .. }),
        "{failure}"
    );
    let failure = solve(&Simple::new(1.0), (0.0, 10.0), [1.3], [0.0])
        .method(Picard)
        .rtol(0.0)
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Setting { name: "rtol", .. }));
    // A first step below the resolution of time is not a singularity.
    for (start, step) in [(0.0, 1e-250), (1e9, 1e-18)] {
        let failure = solve(&Simple::new(1.0), (start, start + 2.0), [1.3], [0.0])
            .method(Picard)
            .first_step(step)
            .run()
            .unwrap_err();
        assert!(
            matches!(failure.error, Error::Setting { name: "first_step", value, .. } if value == step),
            "{failure}"
        );
    }
}

/// With loose tolerances, the motion is less accurate but not wrong.
#[test]
fn loose_tolerances() {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    for exponent in 10..=50 {
        let rtol = 10f64.powf(-0.1 * f64::from(exponent));
        let solution = solve(&double, (0.0, 50.0), [0.5, -0.25], [0.0; 2])
            .method(Picard)
            .rtol(rtol)
            .run()
            .unwrap();
        let [before, after] = [([0.5, -0.25], [0.0; 2]), (solution.end.q, solution.end.v)]
            .map(|(q, v)| double.energy(At::of(0.0, &q, &v)));
        assert!((after - before).abs() < 30.0 * rtol, "{rtol}: {before} became {after}");
    }
}

/// A step that ends at a kink uses the side before the kink, and the next step uses the side after
/// it, so that a kink does not increase the error estimate.
#[test]
fn kinks_cost_no_attempts() {
    let pendulum = Hanging::new(1.0, 1.0);
    let times: Vec<f64> = (0..40).map(|k| 0.73 * f64::from(k)).collect();
    let keys: Vec<[f64; 2]> = (0..40)
        .map(|k| [0.2 * f64::sin(f64::from(k)), 0.1 * f64::cos(2.0 * f64::from(k))])
        .collect();
    let curve = Curve::catmull_rom(&times, &keys).unwrap();
    let end = 0.73 * 39.0;
    for rtol in [1e-6, 1e-12] {
        let of_keys = solve(&pendulum.clone().driven_by(curve.clone()), (0.0, end), [0.4], [0.0])
            .method(Picard)
            .rtol(rtol)
            .run()
            .unwrap();
        assert!(of_keys.stats.rejected < 20, "{rtol:e}: {:?}", of_keys.stats);
        // A force that alternates in direction.
        let turns = times[1..].to_vec();
        let push = Function::new(|t| {
            let before = turns.partition_point(|&turn| turn <= t);
            [if before % 2 == 0 { 1.0 } else { -1.0 }]
        });
        let pushed = Pushed::new().driven_by(push.kinks(&turns).resolution(1.0).unwrap());
        let pushed =
            solve(&pushed, (0.0, end), [0.4], [0.0]).method(Picard).rtol(rtol).run().unwrap();
        assert!(pushed.stats.rejected < 20, "{rtol:e}: {:?}", pushed.stats);
    }
}

lagrangian! {
    pub struct Pushed {}
    coordinate θ;
    driven f;
    kinetic = θ̇^2/2;
    potential = -cos(θ);
    force θ = f;
}

/// Fixed steps do not evaluate their end. Adaptive steps after them do not mistake the missing
/// value for a jump.
#[test]
fn adaptive_steps_go_on_after_fixed_ones() {
    let pendulum = Simple::new(9.8);
    let fixed = || {
        Integrator::new(&pendulum, Picard, 0.0, [0.4], [0.0])
            .unwrap()
            .control(FixedStep::new(0.05))
            .unwrap()
    };
    let mut one = fixed();
    one.advance_to(10.0).unwrap();
    let mut alone = Integrator::new(&pendulum, Picard, 10.0, *one.q(), *one.v()).unwrap();
    alone.advance_to(12.0).unwrap();
    let before = one.stats();
    let mut one = one.control(AdaptiveStep::default()).unwrap();
    one.advance_to(12.0).unwrap();
    let (rejected, most) = (one.stats().rejected - before.rejected, alone.stats().rejected + 3);
    assert!(rejected <= most, "{rejected} steps rejected after fixed ones, {most} at most");
}

/// Tests accelerations whose squares exceed the range of `f32`.
#[test]
fn large_and_small_accelerations_in_single_precision() {
    lagrangian! {
        pub struct Oscillator { w }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = w^2*x^2/2;
    }
    let fast = Oscillator::<f32>::new(1e16);
    let end = solve(&fast, (0.0, 2e-15), [1e-10], [0.0])
        .method(Picard)
        .rtol(1e-5)
        .atol(1e-16)
        .run()
        .unwrap()
        .end;
    assert!((end.q[0] - 1e-10 * 20.0f32.cos()).abs() < 1e-13, "{:e}", end.q[0]);
    let faint = solve(&Oscillator::<f32>::new(1.0), (0.0, 100.0), [1e-24], [0.0])
        .method(Picard)
        .rtol(1e-5)
        .run()
        .unwrap();
    assert!(faint.stats.accepted < 1000, "{:?}", faint.stats);
}

/// Tests an atom that falls repeatedly on the steep potential of another atom. At a loose
/// tolerance, it stays bound and near its reference. `Dop853` and `Picard` at 1e-14 agree in the
/// digits below.
#[test]
fn atoms_do_not_escape() {
    macro_rules! check {
        ($scalar:ty) => {
            let atoms = Atoms::<$scalar> { ε: 1.0 };
            let (q, v) = ([1.25, 0.0], [0.0, 0.25]);
            let end = solve(&atoms, (0.0, 20.0), q, v)
                .method(Picard)
                .rtol(1e-3)
                .atol(1e-3)
                .run()
                .unwrap()
                .end;
            let gained = (atoms.energy(At::of(0.0, &end.q, &end.v))
                - atoms.energy(At::of(0.0, &q, &v)))
            .abs();
            let off = [
                end.q[0] - 1.20391194092,
                end.q[1] - 5.793864941068,
                end.v[0] + 0.457679461712,
                end.v[1] - 0.269507335690,
            ];
            // The measured values are 6e-3 and 5e-4.
            assert!(off.iter().all(|off| off.abs() < 0.03), "{end:?}");
            assert!(gained < 3e-3, "{gained}");
        };
    }
    check!(f64);
    check!(f32);
}

/// An input without a value after a kink is named in the error, with the time.
#[test]
fn inputs_without_a_value_behind_a_kink_are_named() {
    let push = Function::new(|t| [if t == 1.0 { f64::NAN } else { 1.0 }]).kinks(&[1.0]);
    let pushed = Pushed::new().driven_by(push.resolution(1.0).unwrap());
    let failure = solve(&pushed, (0.0, 2.0), [0.4], [0.0]).method(Picard).run().unwrap_err();
    let Error::NotFinite { t, what: Quantity::Input { .. }, .. } = failure.error else {
        panic!("{failure}")
    };
    assert_eq!(t, 1.0);
}
