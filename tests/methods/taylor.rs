//! The `Taylor` method on generated systems: forwards, backwards, over kinks, in single precision,
//! and with errors.

use pendulum_runtime::error::{Error, Quantity};
use pendulum_runtime::integrate::{AdaptiveStep, Solution};
use pendulum_runtime::motion::{Curve, Side};
use pendulum_runtime::prelude::*;

use systems::keys::keys;
use systems::pendulums::Hanging;
use systems::problems::{Kepler, Simple};

lagrangian! {
    pub struct Falling { g }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
}

lagrangian! {
    /// A ball and a wall at the origin, e-fold on 1/k.
    pub struct Thrown { k }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = exp(-k*x);
}

lagrangian! {
    /// A force that begins at c.
    pub struct Pushed { c, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = 1 - 1/(1 + exp((t - c)/w));
}

/// Returns the distance between the start and the end of a pendulum with small swings: `there`
/// integrates to t = 1000, and `back` integrates back to 0.
fn there_and_back(
    start: [f64; 2],
    there: impl Fn([f64; 2]) -> [f64; 2],
    back: impl Fn([f64; 2]) -> [f64; 2],
) -> f64 {
    let [q, v] = back(there(start));
    (q - start[0]).hypot(v - start[1])
}

/// Equal steps of a symmetric method, back with the reversed velocity, pass the same positions.
#[test]
fn forth_and_back_over_a_thousand_seconds_in_equal_steps() {
    let simple: Simple = Simple::new(9.8);
    let run = |q, v| {
        solve(&simple, (0.0, 1000.0), [q], [v]).method(Srkn14a).step(1.0 / 32.0).run().unwrap().end
    };
    let there = |[q, v]: [f64; 2]| {
        let end = run(q, v);
        [end.q[0], end.v[0]]
    };
    let back = |[q, v]: [f64; 2]| {
        let end = run(q, -v);
        [end.q[0], -end.v[0]]
    };
    let distance = there_and_back([0.05, 0.025], there, back);
    assert!(distance <= 4e-16, "{distance:e}");
}

/// The error on the way back is a random walk due to rounding; the test uses the root mean square
/// over 24 starts.
#[test]
fn forth_and_back_over_a_thousand_seconds() {
    let simple: Simple = Simple::new(9.8);
    for (method, tolerance, bound) in [
        (Taylor::new().order(20), 1e-18, 1.5e-15),
        (Taylor::new(), 1e-18, 3e-15),
        (Taylor::new(), 1e-15, 4e-15),
    ] {
        let run = |time, [q, v]: [f64; 2]| {
            let end =
                solve(&simple, time, [q], [v]).method(method).rtol(tolerance).run().unwrap().end;
            [end.q[0], end.v[0]]
        };
        let squares = (0..24).map(f64::from).map(|k| {
            let start = [0.05 * (1.0 + 0.013 * k), 0.025 * (1.0 + 0.007 * k)];
            there_and_back(
                start,
                |state| run((0.0, 1000.0), state),
                |state| run((1000.0, 0.0), state),
            )
            .powi(2)
        });
        let mean = (squares.sum::<f64>() / 24.0).sqrt();
        assert!(mean <= bound, "{tolerance}: {mean:e}");
    }
    let control = AdaptiveStep::new().rtol(1e-18);
    let mut integrator = Integrator::new(&simple, Taylor::new().order(20), 0.0, [0.05], [0.025])
        .unwrap()
        .control(control)
        .unwrap();
    integrator.advance_to(1000.0).unwrap();
    integrator.advance_to(0.0).unwrap();
    let distance = (integrator.q()[0] - 0.05).hypot(integrator.v()[0] - 0.025);
    assert!(distance <= 4e-15, "{distance:e}");
}

/// Compares with the angles after five seconds of `kinks.rs`, and integrates back over all keys.
#[test]
fn keys_are_met_in_both_directions() {
    let (times, values) = keys();
    let pendulum = Hanging::new(0.3, 0.5);
    let linear = pendulum.clone().driven_by(Curve::linear(&times, &values).unwrap());
    let catmull_rom = pendulum.clone().driven_by(Curve::catmull_rom(&times, &values).unwrap());
    let spline = pendulum.driven_by(Curve::spline(&times, &values).unwrap());
    let end = |solution: Solution<f64, 1>| (solution.end.q, solution.end.v, solution.stats.kinks);
    macro_rules! forth_and_back {
        ($dynamics:expr, $expected:expr, $kinks:expr) => {
            let (q, v, kinks) = end(solve($dynamics, (0.0, 5.0), [0.3], [0.0])
                .method(Taylor::new())
                .rtol(1e-16)
                .run()
                .unwrap());
            assert!((q[0] - $expected).abs() < 5e-12, "{}", q[0]);
            assert_eq!(kinks, $kinks);
            // There is a key at t = 5: the resulting velocity belongs to the side after the key,
            // and the run back starts on the side before it.
            let control = AdaptiveStep::new().rtol(1e-16);
            let mut integrator = Integrator::new($dynamics, Taylor::new(), 0.0, [0.3], [0.0])
                .unwrap()
                .control(control)
                .unwrap();
            integrator.advance_to(5.0).unwrap();
            assert_eq!((*integrator.q(), *integrator.v()), (q, v));
            integrator.advance_to(1.0).unwrap();
            integrator.advance_to(2.0).unwrap();
            integrator.advance_to(0.01).unwrap();
            let start = solve($dynamics, (0.0, 0.01), [0.3], [0.0])
                .method(Taylor::new())
                .rtol(1e-16)
                .run()
                .unwrap()
                .end;
            let distance =
                (integrator.q()[0] - start.q[0]).abs().max((integrator.v()[0] - start.v[0]).abs());
            assert!(distance < 1e-13, "{distance:e}");
        };
    }
    forth_and_back!(&linear, -0.129608683467, 120);
    forth_and_back!(&catmull_rom, -0.128838666144, 120);
    let dop853 =
        solve(&spline, (0.0, 5.0), [0.3], [0.0]).rtol(1e-13).atol(1e-13).run().unwrap().end.q[0];
    forth_and_back!(&spline, dop853, 0);
}

/// The run back over kinks has the same states as the run forth, on the same side of each kink.
#[test]
fn dense_output_has_one_history() {
    let (times, values) = keys();
    let linear = Hanging::new(0.3, 0.5).driven_by(Curve::linear(&times, &values).unwrap());
    let forth = solve(&linear, (0.01, 2.01), [0.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-16)
        .dense()
        .run()
        .unwrap();
    let (q, v) = (forth.end.q, forth.end.v);
    let outputs: Vec<f64> = (0..=200).map(|i| 2.01 - 0.01 * f64::from(i)).collect();
    let problem = solve(&linear, (2.01, 0.01), q, v).method(Taylor::new()).rtol(1e-16).dense();
    let back = problem.t_eval(&outputs[..200]).run().unwrap();
    assert_eq!(back.t, outputs[..200]);
    for (index, t) in outputs[..200].iter().enumerate() {
        let known = forth.at(*t).unwrap();
        assert!((known.q[0] - back.q[index][0]).abs() < 1e-13, "{t}");
    }
    for key in [1.0, 1.5, 12.0 / 24.0] {
        for side in [Side::Before, Side::After] {
            let (a, b) = (forth.at_side(key, side).unwrap(), back.at_side(key, side).unwrap());
            assert!(
                (a.q[0] - b.q[0]).abs() < 1e-13 && (a.v[0] - b.v[0]).abs() < 1e-13,
                "{key}, {side:?}"
            );
        }
    }
    let every = solve(&linear, (2.01, 0.01), q, v).method(Taylor::new()).every(0.5).run().unwrap();
    assert_eq!(every.t.len(), 5);
    assert_eq!((every.t[0], every.t[4]), (2.01, 0.01));
}

/// Dense output is as accurate as the steps.
#[test]
fn dense_output_is_exact() {
    let simple = Simple::new(1.0);
    let solution = solve(&simple, (0.0, 10.0), [1.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-16)
        .dense()
        .run()
        .unwrap();
    for i in 1..40 {
        let t = 0.25 * f64::from(i);
        let stopped = solve(&simple, (0.0, t), [1.3], [0.0])
            .method(Taylor::new())
            .rtol(1e-18)
            .run()
            .unwrap()
            .end;
        let state = solution.at(t).unwrap();
        assert!(
            (state.q[0] - stopped.q[0]).abs() < 2e-15 && (state.v[0] - stopped.v[0]).abs() < 2e-15,
            "{t}"
        );
    }
}

/// A polynomial and an equilibrium each take one step.
#[test]
fn series_that_end() {
    let falling = Falling::new(9.81);
    let solution = solve(&falling, (0.0, 100.0), [0.0, 3.0], [1.0, 2.0])
        .method(Taylor::new())
        .rtol(1e-15)
        .run()
        .unwrap();
    assert!(solution.stats.accepted < 50, "{}", solution.stats);
    assert!(
        (solution.end.q[0] - 100.0).abs() < 1e-12
            && (solution.end.q[1] - (203.0 - 9.81 * 5000.0)).abs() < 1e-10
    );
    let rest =
        solve(&Simple::new(1.0), (0.0, 1e6), [0.0], [0.0]).method(Taylor::new()).run().unwrap();
    assert_eq!((rest.end.q, rest.stats.accepted), ([0.0], 1));
    let simple = Simple::new(1.0);
    let mut integrator = Integrator::new(&simple, Taylor::new(), 0.0, [0.0], [0.0]).unwrap();
    integrator.step().unwrap();
    assert_eq!(integrator.t(), 1.0);
}

/// A release from a symmetric position: three of four orders vanish.
#[test]
fn lacunary_series() {
    let simple = Simple::new(9.81);
    let q = [core::f64::consts::FRAC_PI_2];
    let loose =
        solve(&simple, (0.0, 1.0), q, [0.0]).method(Taylor::new()).rtol(1e-6).run().unwrap().end.q
            [0];
    let tight =
        solve(&simple, (0.0, 1.0), q, [0.0]).method(Taylor::new()).rtol(1e-16).run().unwrap().end.q
            [0];
    assert!((loose - tight).abs() < 1e-5, "{loose} {tight}");
}

#[test]
fn single_precision() {
    let simple = Simple::new(1.0f32);
    let end = solve(&simple, (0.0, 10.0), [1.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-7)
        .run()
        .unwrap()
        .end;
    assert!((end.q[0] + 1.166_160_4).abs() < 2e-6, "{}", end.q[0]);
}

#[test]
fn fixed_steps_and_settings() {
    let simple: Simple = Simple::new(1.0);
    let exact = -1.1661603819329576;
    let solution =
        solve(&simple, (0.0, 10.0), [1.3], [0.0]).method(Taylor::new()).step(0.25).run().unwrap();
    assert_eq!(solution.stats.accepted, 40);
    assert!((solution.end.q[0] - exact).abs() < 5e-15);
    let error = |order, steps| {
        let end = solve(&simple, (0.0, 10.0), [1.3], [0.0])
            .method(Taylor::new().order(order))
            .steps(steps)
            .run()
            .unwrap()
            .end;
        (end.q[0] - exact).abs()
    };
    for order in [2, 3, 4, 5, 6, 7] {
        let observed = (error(order, 160) / error(order, 320)).log2();
        assert!(
            (order as f64 - 0.4..order as f64 + 1.4).contains(&observed),
            "order {order}: {observed}"
        );
    }
    let steps = |max| {
        let problem = solve(&simple, (0.0, 10.0), [1.3], [0.0]).method(Taylor::new()).rtol(1e-15);
        problem.max_step(max).run().unwrap().stats.accepted
    };
    assert_eq!(steps(0.1), 100);
    let failure = solve(&simple, (0.0, 10.0), [1.3], [0.0])
        .method(Taylor::new())
        .rtol(0.0)
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Setting { name: "rtol", .. }));
}

/// Each coordinate has its own tolerance.
#[test]
fn tolerances_by_coordinate() {
    let kepler = Kepler::new(1.0);
    let steps = |x: f64, y: f64| {
        let problem =
            solve(&kepler, (0.0, 6.0), [1.0, 0.0], [0.0, 1.0]).method(Taylor::new()).rtol(1e-14);
        problem.atol_each([x, y], [x, y]).run().unwrap().stats.accepted
    };
    assert!(2 * steps(1e-2, 1e-2) < steps(1e-14, 1e-2));
}

/// The exponential function overflows at c + 709.8 w; the acceleration stays finite.
#[test]
fn a_series_that_overflows_is_not_blamed_on_the_motion() {
    let pushed: Pushed = Pushed { c: 0.0, w: 0.01 };
    let run = || solve(&pushed, (0.0, 10.0), [0.0], [0.0]);
    let failure = run().method(Taylor::new()).run().unwrap_err();
    let Error::NotFinite { t, what: Quantity::Series(coordinate), .. } = failure.error else {
        panic!("{failure}")
    };
    assert!(5.0 < t && t < 10.0 && coordinate.name == "x", "{failure}");
    assert!(failure.to_string().contains("overflows"), "{failure}");
    // v = t − ln 2 w from the middle of the step on.
    let end = run().method(Dop853).run().unwrap().end;
    assert!((end.v[0] - 10.0 + 0.01 * 2f64.ln()).abs() < 1e-4, "{}", end.v[0]);
}

#[test]
fn errors_say_where() {
    // A fall into the centre from rest: the singularity is reached at π/(2√2).
    let kepler = Kepler::new(1.0);
    let failure = solve(&kepler, (0.0, 2.0), [1.0, 0.0], [0.0, 0.0])
        .method(Taylor::new())
        .rtol(1e-12)
        .run()
        .unwrap_err();
    let t = failure.partial.end.t;
    assert!((t - 1.1107207345395915).abs() < 1e-6, "{failure:?}");
    let failure = solve(&Simple::new(f64::NAN), (0.0, 2.0), [1.0], [0.0])
        .method(Taylor::new())
        .run()
        .unwrap_err();
    let Error::NotFinite { t, what: Quantity::Acceleration(coordinate), ref suspects } =
        failure.error
    else {
        panic!("{failure}")
    };
    assert_eq!((t, coordinate.name, suspects[0].parameter), (0.0, "q", "g"));
    let failure = solve(&Simple::new(1.0), (2.0, 0.0), [1.0], [0.0])
        .method(Taylor::new())
        .t_eval(&[0.5, 1.0])
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Times { index: 1, .. }));
    // A first step below the resolution of time is not a singularity.
    for (start, step) in [(0.0, 1e-250), (1e9, 1e-18)] {
        let failure = solve(&Simple::new(1.0), (start, start + 2.0), [1.3], [0.0])
            .method(Taylor::new())
            .first_step(step)
            .run()
            .unwrap_err();
        assert!(
            matches!(failure.error, Error::Setting { name: "first_step", value, .. } if value == step),
            "{failure}"
        );
    }
}

/// Tests a wall that the series does not contain: steps are halved before the wall, and no step
/// passes through it.
#[test]
fn no_step_goes_through_a_wall() {
    // A ball falls with g to the floor and is decelerated by k − g, which takes a fraction g/(k −
    // g) of the time and of the height. It then rises with its first speed, and the motion repeats.
    let (g, y) = (10.0_f64, 1.0_f64);
    let (fall, speed) = ((2.0 * y / g).sqrt(), (2.0 * g * y).sqrt());
    for (k, rtol, bounces) in [
        (1e3, 1e-14, 1.0),
        (1e4, 1e-13, 1.0),
        (1e5, 1e-12, 1.0),
        (1e6, 1e-11, 1.0),
        (1e3, 1e-6, 1.0),
        (1e3, 1e-9, 1.0),
        (1e4, 1e-10, 12.0),
    ] {
        let contact = 2.0 * speed / (k - g);
        let flight = 1.0 - fall - contact;
        let expected = speed * flight - g * flight * flight / 2.0;
        let end = 1.0 + (bounces - 1.0) * (2.0 * fall + contact);
        for at in [0.0, 1e3, 1e6] {
            let floor = Floor::new(g, k, at);
            let down = solve(&floor, (0.0, end), [at + y], [0.0]).method(Taylor::new());
            let down = down.rtol(rtol).atol(rtol).run().unwrap();
            let error = (down.end.q[0] - at - expected).abs();
            // In the floor, the rounding error of the height also causes an error of the time.
            let rounding = f64::EPSILON * at * (1.0 + 0.1 * k);
            let most = 100.0 * bounces * (rtol.max(1e-10) * (1.0 + at) + rounding);
            assert!(error < most, "k = {k:e}, at {at:e}, rtol = {rtol:e}: {error:e}");
            assert!(
                f64::from(down.stats.rejected as u32) < 300.0 * bounces,
                "k = {k:e}, at {at:e}, {rtol:e}: {:?}",
                down.stats
            );
        }
    }
}

lagrangian! {
    /// A ball over a floor that throws it back.
    pub struct Floor { g, k, at }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = g*y;
    force y = k*(1 - sign(y - at))/2;
}

/// A reset discards the effects of a jump: the bits equal those of a new integrator.
#[test]
fn a_reset_forgets_jumps() {
    let floor = Floor::new(10.0, 1e4, 0.0);
    let mut used = Integrator::new(&floor, Taylor::new(), 0.0, [1.0], [0.0]).unwrap();
    used.advance_to(0.4).unwrap();
    while used.stats().rejected == 0 {
        used.step().unwrap();
    }
    let mut new = Integrator::new(&floor, Taylor::new(), 0.0, [1.5], [0.0]).unwrap();
    used.reset(0.0, [1.5], [0.0]).unwrap();
    for t in [0.3, 0.6, 1.0] {
        used.advance_to(t).unwrap();
        new.advance_to(t).unwrap();
        assert_eq!(used.state(), new.state());
    }
}

/// Tests a wall that affects the accelerations at the end of a step, but not the series far from
/// it: v = u tanh(k u (t − s)/2) and e^(−kx) = (u²/2)/cosh²(k u (t − s)/2), with the time s of the
/// bounce.
#[test]
fn walls_are_met() {
    for (k, x, v) in [(200.0f64, 1.0f64, -1.0f64), (200.0, 0.3, -3.0), (500.0, 1.0, -1.0)] {
        let u = (v * v + 2.0 * (-k * x).exp()).sqrt();
        let s = 2.0 / (k * u) * (0.5 * u * u * (k * x).exp()).sqrt().acosh();
        let end = 2.0 * s;
        // Far from the wall cosh z is e^z/2.
        let exact = [u * (end - s) + (2.0 / (u * u)).ln() / k - 4.0f64.ln() / k, u];
        for rtol in [1e-6, 1e-9, 1e-12] {
            let run = solve(&Thrown::new(k), (0.0, end), [x], [v])
                .method(Taylor::new())
                .rtol(rtol)
                .run()
                .unwrap();
            let off = (run.end.q[0] - exact[0]).abs().max((run.end.v[0] - exact[1]).abs()) / rtol;
            assert!(off < 100.0, "k = {k}, {rtol}: {off} tolerances");
            assert!(0 < run.stats.rejected, "k = {k}, {rtol}: {}", run.stats);
        }
    }
}
