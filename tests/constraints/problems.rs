//! Problems with known digits and closed forms.

use core::f64::consts::FRAC_PI_2;
use pendulum_runtime::analysis::equilibrium;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::Event;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;
use systems::constrained::{
    ANDREWS_END, ANDREWS_START, Ball, Bob, CAR_AXIS_START, Disc, Loops2, Simple, Sleigh, andrews,
    car_axis, four_bar,
};

/// The multipliers at the start, with the sign of this crate.
const ANDREWS_REACTIONS: [f64; 6] = [
    -199.17534810453862818624,
    29.755309974971763324416,
    -23.066543611622151128617,
    -31.452725275771137075385,
    -22.642494786394378577713,
    -11.617392352611255906901,
];

/// The car axis at t = 3, recomputed.
const CAR_AXIS_END: [[f64; 4]; 2] = [
    [
        0.0493455784275240921315,
        0.4969894602300081067629,
        1.0417425248854261151948,
        0.3739110272653658193579,
    ],
    [
        -0.0770583684035920842839,
        0.0074468665920684164914,
        0.0175568157535417366297,
        0.7703410437796010631206,
    ],
];

/// The multipliers at t = 3.
const CAR_AXIS_REACTIONS: [f64; 2] = [-0.00473688659085332653, -0.00110468033125956584];

/// Returns the largest error of a state, divided by 1 + |expected value|.
fn error<const N: usize>(end: &State<f64, N>, expected: &[[f64; N]; 2]) -> f64 {
    let found = end.q.iter().chain(&end.v);
    let expected = expected.iter().flatten();
    found.zip(expected).fold(0.0, |worst, (a, b)| worst.max((a - b).abs() / (1.0 + b.abs())))
}

/// Returns the largest misfit in units of the rounding error of its terms, whose sum is about
/// `scale`.
fn misfit<S: System<N, Scalar = f64, Inputs = ()>, const N: usize>(
    system: &S,
    state: &State<f64, N>,
    scale: f64,
) -> f64 {
    let misfits = system.misfits(At::of(state.t, &state.q, &state.v));
    misfits[0].iter().fold(0.0, |worst: f64, g| worst.max(g.abs())) / (f64::EPSILON * scale)
}

/// Runs with the methods for all systems at several tolerances.
macro_rules! with_each_method {
    (|$method:ident, $rtol:ident| $body:block) => {
        for $rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
            {
                let $method = Picard;
                $body
            }
            {
                let $method = Dop853;
                $body
            }
            {
                let $method = Taylor::new();
                $body
            }
            {
                let $method = Auto;
                $body
            }
        }
    };
}

#[test]
fn andrews_mechanism_has_its_digits() {
    let system = andrews();
    with_each_method!(|method, rtol| {
        let solution = solve(&system, (0.0, 0.03), ANDREWS_START, [0.0; 7])
            .method(method)
            .rtol(rtol)
            .atol(rtol)
            .run()
            .unwrap();
        let (end, name) = (&solution.end, solution.stats.method);
        let worst = error(end, &ANDREWS_END);
        assert!(worst < 100.0 * rtol, "{name} at {rtol:e}: {worst:e}");
        let reactions = system.reactions(At::of(end.t, &end.q, &end.v));
        let apart = reactions.iter().zip(ANDREWS_REACTIONS).map(|(a, b)| (a - b).abs() / b.abs());
        let apart = apart.fold(0.0, f64::max);
        if rtol < 2e-12 {
            assert!(worst < 1e-11 && apart < 1e-8, "{name}: {worst:e}, {apart:e}");
        }
        // The terms of g are at most 0.07.
        assert!(misfit(&system, end, 0.07) < 4.0, "{}", misfit(&system, end, 0.07));
    });
}

#[test]
fn the_car_axis_has_its_digits() {
    let system = car_axis();
    let [q, v] = CAR_AXIS_START;
    with_each_method!(|method, rtol| {
        let solution =
            solve(&system, (0.0, 3.0), q, v).method(method).rtol(rtol).atol(rtol).run().unwrap();
        let (end, name) = (&solution.end, solution.stats.method);
        let worst = error(end, &CAR_AXIS_END);
        assert!(worst < 100.0 * rtol, "{name} at {rtol:e}: {worst:e}");
        let reactions = system.reactions(At::of(end.t, &end.q, &end.v));
        let apart = reactions.iter().zip(CAR_AXIS_REACTIONS).map(|(a, b)| (a - b).abs() / b.abs());
        let apart = apart.fold(0.0, f64::max);
        if rtol < 2e-12 {
            assert!(worst < 1e-11 && apart < 1e-8, "{name}: {worst:e}, {apart:e}");
        }
        assert!(misfit(&system, end, 2.0) < 4.0, "{}", misfit(&system, end, 2.0));
    });
}

/// Returns the start of upright loops, with the velocity `v` of the upper ends.
fn upright<const N: usize>(uprights: usize, v: f64) -> [[f64; N]; 2] {
    let q = core::array::from_fn(|k| if k < uprights { FRAC_PI_2 } else { 0.0 });
    let v = core::array::from_fn(|k| if k < uprights { -v } else { 0.0 });
    [q, v]
}

/// Returns the angle of all uprights of two loops after 10 s, from the upright start with the
/// velocity v.
fn turned(v: f64) -> f64 {
    let end = solve(&Turning::new(1.0), (0.0, 10.0), [FRAC_PI_2], [-v]).rtol(1e-14).run();
    end.unwrap().end.q[0]
}

/// Two loops pass through change points, where all bars lie in a line and another branch begins;
/// all uprights turn as one pendulum.
#[test]
fn loops_keep_their_branch_at_change_points() {
    let system = Loops2::new(1.0, 1.0);
    let [q, v] = upright::<5>(3, 1.0);
    // θ is measured from upright, clockwise.
    let θ = 31.750597186976101817;
    let b = [0.32845811154081537865, 0.94451853817860096216];
    assert!((FRAC_PI_2 - turned(1.0) - θ).abs() < 1e-11);
    macro_rules! apart {
        ($method:expr, $rtol:expr) => {{
            let run = solve(&system, (0.0, 10.0), q, v).method($method).rtol($rtol).atol($rtol);
            let end = run.max_steps(10_000).run().unwrap().end;
            (0..3).fold(0.0, |worst: f64, k| {
                let (sin, cos) = end.q[k].sin_cos();
                let place = (cos - b[0]).abs().max((sin - b[1]).abs());
                worst.max((FRAC_PI_2 - end.q[k] - θ).abs()).max(place)
            })
        }};
    }
    let found = [apart!(Picard, 1e-6), apart!(Picard, 1e-9), apart!(Dop853, 1e-6)];
    assert!(found[0] < 1e-3 && found[1] < 1e-6 && found[2] < 1e-3, "{found:?}");
    let found = [apart!(Taylor::new(), 1e-8), apart!(Dop853, 1e-10)];
    assert!(found[0] < 3e-6 && found[1] < 3e-8, "{found:?}");
    let found = [apart!(Dop853, 1e-12), apart!(Picard, 1e-12)];
    assert!(found.iter().all(|off| *off < 1e-9), "{found:?}");
}

/// For every start and tolerance, the motion is correct or ends with an error: a step that ends so
/// near to a change point that rounding makes the branches indistinguishable is refused.
#[test]
fn no_start_leads_to_another_branch() {
    let system = Loops2::new(1.0, 1.0);
    let (mut right, mut refused) = (0, 0);
    for k in 0..8 {
        let speed = 0.3 + 0.31 * f64::from(k);
        let exact = turned(speed);
        let [q, v] = upright::<5>(3, speed);
        macro_rules! check {
            ($method:expr, $rtol:expr) => {
                match solve(&system, (0.0, 10.0), q, v)
                    .method($method)
                    .rtol($rtol)
                    .atol($rtol)
                    .max_steps(3_000)
                    .run()
                {
                    Ok(run) => {
                        let off = run.end.q[..3].iter().map(|q| (q - exact).abs());
                        let off = off.fold(0.0, f64::max);
                        assert!(off < 2e4 * $rtol, "{speed} {}: {off}", $rtol);
                        right += 1;
                    }
                    Err(failure) => {
                        let known = matches!(
                            failure.error,
                            Error::DependentConstraints { .. }
                                | Error::Inconsistent { .. }
                                | Error::MaxSteps { .. }
                        );
                        assert!(known, "{speed} {}: {}", $rtol, failure.error);
                        refused += 1;
                    }
                }
            };
        }
        check!(Picard, 1e-5);
        check!(Picard, 1e-8);
        check!(Picard, 1e-12);
        check!(Taylor::new(), 1e-10);
    }
    assert!(16 <= right && 0 < refused, "{right} {refused}");
}

/// A reset to a state near a change point is handled like any other start.
#[test]
fn a_reset_near_a_change_point_begins_anew() {
    let system = Loops2::new(1.0, 1.0);
    let [q, v] = upright::<5>(3, 1.0);
    let begin = || Integrator::new(&system, Picard, 0.0, q, v).unwrap();
    let states = |run: &mut Integrator<'_, 5, _, Picard>| -> Vec<_> {
        (0..40).map(|_| run.step().map(|()| run.state()).unwrap()).collect()
    };
    let fresh = states(&mut begin());
    for steps in [12, 20, 30] {
        let mut run = begin();
        for _ in 0..steps {
            run.step().unwrap();
        }
        run.reset(0.0, q, v).unwrap();
        assert_eq!(states(&mut run), fresh, "{steps}");
    }
}

lagrangian! {
    /// The uprights of two loops, which turn as one.
    pub struct Turning { L: m, g: m/s^2 = 9.81 }
    coordinate φ: rad;
    kinetic = 3/2*L^2*φ̇^2;
    potential = 7/2*g*L*sin(φ);
}

/// Over 2000 s the misfits are rounding errors at every output, and the angle equals that of
/// minimal coordinates.
#[test]
fn a_bob_stays_on_its_rod() {
    let (bob, simple) = (Bob::new(1.0, 1.0), Simple::new(1.0));
    let (end, rtol) = (2000.0, 1e-10);
    let angle = solve(&simple, (0.0, end), [1.0], [0.0]).rtol(rtol).atol(rtol).run().unwrap().end;
    let start = [1f64.sin(), -1f64.cos()];
    let run = solve(&bob, (0.0, end), start, [0.0; 2]).rtol(rtol).atol(rtol).every(0.01);
    let solution = run.run().unwrap();
    for state in &solution {
        assert!(misfit(&bob, &state, 1.0) <= 4.0, "{}", state.t);
        let rate = bob.misfits(At::of(state.t, &state.q, &state.v))[1][0];
        assert!(rate.abs() < 4.0 * f64::EPSILON * 8.0, "{rate:e}");
    }
    let end = solution.end;
    let apart = (end.q[0].atan2(-end.q[1]) - angle.q[0]).abs();
    let drift =
        bob.energy(At::of(0.0, &end.q, &end.v)) - bob.energy(At::of(0.0, &start, &[0.0; 2]));
    println!("angle off by {apart:e} rad, energy by {drift:e} J");
    assert!(apart < 100.0 * rtol && drift.abs() < 100.0 * rtol, "{apart:e} {drift:e}");
}

/// Compares Chaplygin's sleigh with its closed form: u = A tanh s, ω = B sech s.
#[test]
fn the_sleigh_follows_its_closed_form() {
    let (m, inertia, a) = (1.3, 0.4, 0.25);
    let system = Sleigh::new(m, inertia, a);
    let about = inertia + m * a * a;
    let (speed, s0) = (0.9, -0.7);
    let b = speed * (m / about).sqrt();
    let k = m * a * speed / about;
    let start = |s: f64| (speed * s.tanh(), b / s.cosh());
    let (u, ω) = start(s0);
    let t = 5.0;
    let end =
        solve(&system, (0.0, t), [0.0; 3], [u, 0.0, ω]).rtol(1e-12).atol(1e-13).run().unwrap().end;
    let s = k * t + s0;
    let (u, ω) = start(s);
    let turn = (b / k) * 2.0 * ((s / 2.0).tanh().atan() - (s0 / 2.0).tanh().atan());
    let (sin, cos) = end.q[2].sin_cos();
    assert!((end.q[2] - turn).abs() < 1e-10, "{} {turn}", end.q[2]);
    assert!((end.v[0] * cos + end.v[1] * sin - u).abs() < 1e-10);
    assert!((end.v[2] - ω).abs() < 1e-10);
    // The blade pushes with m I u ω/I_a.
    let side = system.side(t, &end.q, &end.v);
    let expected = m * inertia / about * u * ω;
    assert!((side.abs() - expected.abs()).abs() < 1e-9, "{side} {expected}");
}

/// A disc with a constant lean rolls in a circle. The test uses the closed form of its speed.
#[test]
fn a_disc_rolls_in_a_circle() {
    let (m, r) = (1.1, 0.4);
    let (a, c, g) = (m * r * r / 4.0, m * r * r / 2.0, 9.81);
    let system = Disc { m, r, A: a, C: c, g };
    let (lean, n) = (0.3f64, 6.0);
    // (C − A + m r²) Ω² sin θ cos θ + (C + m r²) Ω n cos θ + m g r sin θ = 0, n = φ̇.
    let (x, y, z) = (
        (c - a + m * r * r) * lean.sin() * lean.cos(),
        (c + m * r * r) * n * lean.cos(),
        m * g * r * lean.sin(),
    );
    let turning = (-y + (y * y - 4.0 * x * z).sqrt()) / (2.0 * x);
    let start = [0.0, 0.0, 0.0, lean, 0.0];
    let v = [r * n, 0.0, turning, 0.0, n];
    let end = solve(&system, (0.0, 3.0), start, v).rtol(1e-11).atol(1e-12).run().unwrap().end;
    assert!((end.q[3] - lean).abs() < 1e-8, "{}", end.q[3]);
    assert!((end.q[2] - 3.0 * turning).abs() < 1e-8 && (end.q[4] - 3.0 * n).abs() < 1e-8);
    // The point of contact goes in a circle of radius r n/|Ω|.
    let radius = r * n / turning;
    let (sin, cos) = (3.0 * turning).sin_cos();
    assert!(
        (end.q[0] - radius * sin).abs() < 1e-8 && (end.q[1] - radius * (1.0 - cos)).abs() < 1e-8
    );
}

/// An upright disc wobbles with ω² = 0.8 (3 n² − g/r).
#[test]
fn an_upright_disc_wobbles() {
    let (m, r, g) = (1.0, 0.5, 9.81);
    let system = Disc { m, r, A: m * r * r / 4.0, C: m * r * r / 2.0, g };
    let n = 5.0;
    let ω = (0.8f64 * (3.0 * n * n - g / r)).sqrt();
    let small = 1e-5;
    // The lean is a cosine; the heading changes with ψ̇ = −2 n θ to first order.
    let v = [r * n, 0.0, -2.0 * n * small, 0.0, n];
    let period = core::f64::consts::TAU / ω;
    let end = solve(&system, (0.0, period), [0.0, 0.0, 0.0, small, 0.0], v)
        .rtol(1e-12)
        .atol(1e-15)
        .run()
        .unwrap()
        .end;
    assert!((end.q[3] / small - 1.0).abs() < 1e-6, "{}", end.q[3] / small);
}

/// A ball on a turntable moves in circles with 2/7 of the rate of the table (Earnshaw 1844).
#[test]
fn a_ball_on_a_turntable_goes_in_circles() {
    let (m, r, rate) = (0.7, 0.1, 3.0);
    let system = Ball { m, r, J: 0.4 * m * r * r, Ω: rate };
    let (q, velocity) = ([0.3, -0.1, 0.0, 0.0], [0.2, 0.5]);
    // Rolling: ẋ − r β̇ = −Ω y, ẏ + r α̇ = Ω x.
    let v = [
        velocity[0],
        velocity[1],
        (rate * q[0] - velocity[1]) / r,
        (velocity[0] + rate * q[1]) / r,
    ];
    let period = core::f64::consts::TAU / (rate * 2.0 / 7.0);
    let middle =
        solve(&system, (0.0, period / 4.0), q, v).rtol(1e-12).atol(1e-13).run().unwrap().end;
    // A quarter of a circle turns the velocity by a quarter.
    assert!((middle.v[0] + velocity[1]).abs() < 1e-10 && (middle.v[1] - velocity[0]).abs() < 1e-10);
    let end = solve(&system, (0.0, period), q, v).rtol(1e-12).atol(1e-13).run().unwrap().end;
    assert!((end.q[0] - q[0]).abs() < 1e-10 && (end.q[1] - q[1]).abs() < 1e-10, "{:?}", end.q);
}

/// A start that does not fulfil its constraints is refused with its name; rounding errors are
/// corrected.
#[test]
fn starts_have_to_fulfil_the_constraints() {
    let bob = Bob::new(1.0, 1.0);
    let run = |q, v| solve(&bob, (0.0, 1.0), q, v).run();
    let error = run([1.1, 0.0], [0.0, 0.0]).unwrap_err().to_string();
    assert!(
        error.contains("constraint rod is off by 0.21") && error.contains("assemble"),
        "{error}"
    );
    let error = run([1.0, 0.0], [0.5, 0.0]).unwrap_err().to_string();
    assert!(error.contains("rate of the constraint rod is off by 1.0"), "{error}");
    run([1.0 + 1e-13, 0.0], [0.0, 1.0]).unwrap();
    // The misfit of a constraint of velocities has the unit of the constraint.
    let sleigh = Sleigh::new(1.0, 0.4, 0.25);
    let error = solve(&sleigh, (0.0, 1.0), [0.0; 3], [0.0, 0.5, 0.0]).run().unwrap_err();
    assert!(error.to_string().contains("the constraint blade is off by 0.5 m/s; begin"), "{error}");
}

/// Tests the constraints at every step of every kind of method, also in `f32`.
#[test]
fn other_methods_and_scalars_keep_the_constraints() {
    let single = Bob { m: 1.0f32, L: 1.0, g: 9.81 };
    let solution =
        solve(&single, (0.0, 20.0), [1.0, 0.0], [0.0, 0.0]).rtol(1e-5).every_step().run().unwrap();
    for state in &solution {
        let [g, rate] = single.misfits(At::of(0.0, &state.q, &state.v));
        assert!(g[0].abs() <= 4.0 * f32::EPSILON && rate[0].abs() <= 32.0 * f32::EPSILON);
    }
    let bob = Bob::new(1.0, 1.0);
    macro_rules! fixed {
        ($($method:expr),*) => {$({
            let run = solve(&bob, (0.0, 5.0), [1.0, 0.0], [0.0, 0.0]).method($method).step(0.005);
            let solution = run.every_step().run().unwrap();
            for state in &solution {
                assert!(misfit(&bob, &state, 1.0) <= 4.0, "{}", solution.stats);
            }
            let energy = bob.energy(At::of(5.0, &solution.end.q, &solution.end.v));
            assert!(energy.abs() < 1e-3, "{}: {energy}", solution.stats);
        })*};
    }
    fixed!(Rk4, Gauss::<2>::new(), Gauss::<3>::new().newton(), Dop853, Picard);
    let stiff = solve(&bob, (0.0, 5.0), [1.0, 0.0], [0.0, 0.0]).method(Rodas4).run().unwrap();
    assert!(misfit(&bob, &stiff.end, 1.0) <= 4.0);
}

/// Outputs, events and dense states are on the constraints, and the interpolant agrees with the
/// ends of the steps.
#[test]
fn states_within_steps_are_on_the_constraints() {
    let bob = Bob::new(1.0, 1.0);
    let start = || solve(&bob, (0.0, 3.0), [1.0, 0.0], [0.0, 0.0]).rtol(1e-6).atol(1e-6);
    let lowest = Event::new(|_, q: &[f64; 2], _| q[0]).falling();
    let solution = start().every(0.017).events([lowest]).dense().run().unwrap();
    assert!(1 < solution.events.len());
    for state in solution.iter().chain(solution.events.iter().map(|event| event.state)) {
        assert!(misfit(&bob, &state, 1.0) <= 4.0, "{}", state.t);
    }
    let mut run = start().start().unwrap();
    for _ in 0..10 {
        run.step().unwrap();
        let (q, v) = run.interpolant().unwrap().at(1.0);
        let end = run.state();
        for i in 0..2 {
            assert!((q[i] - end.q[i]).abs() < 1e-14 && (v[i] - end.v[i]).abs() < 1e-13);
        }
    }
}

/// An equilibrium fulfils the constraints.
#[test]
fn equilibria_are_on_the_constraints() {
    let bob = Bob::new(1.3, 0.7);
    let rest = equilibrium(&bob, 0.0, [0.3, -0.9]).unwrap();
    assert!(rest[0].abs() < 1e-14 && (rest[1] + 0.7).abs() < 1e-14, "{rest:?}");
    let above = equilibrium(&bob, 0.0, [0.05, 0.8]).unwrap();
    assert!(above[0].abs() < 1e-14 && (above[1] - 0.7).abs() < 1e-14, "{above:?}");
    let bars = four_bar();
    let rest = equilibrium(&bars, 0.0, [-1.5, 0.2, -1.2]).unwrap();
    let [g, _] = bars.misfits(At::of(0.0, &rest, &[0.0; 3]));
    let a = bars.accelerations(At::of(0.0, &rest, &[0.0; 3]));
    assert!(g.iter().all(|g| g.abs() < 1e-14) && a.iter().all(|a| a.abs() < 1e-11), "{a:?}");
}

/// A run that is saved and resumed has the same bits and the same extremes.
#[test]
fn runs_are_saved_and_resumed() {
    let system = car_axis();
    let [q, v] = CAR_AXIS_START;
    macro_rules! resumed {
        ($($method:expr),*) => {$({
            let start = || Integrator::new(&system, $method, 0.0, q, v).unwrap();
            let (mut whole, mut first) = (start(), start());
            whole.advance_to(2.0).unwrap();
            for _ in 0..7 {
                first.step().unwrap();
            }
            let saved = first.save();
            let mut second = start();
            second.restore(&saved).unwrap();
            assert_eq!(second.stats(), first.stats());
            for _ in 0..5 {
                (first.step().unwrap(), second.step().unwrap());
                assert_eq!((first.q(), first.v()), (second.q(), second.v()));
            }
            assert_eq!(first.stats(), second.stats());
        })*};
    }
    resumed!(Picard, Dop853, Taylor::new(), Auto);
}

lagrangian! {
    /// A bead that is carried along, and another one that is free.
    pub struct Carried { a: m, w: Hz }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    constraint ride: x = a*cos(w*t);
}

/// If only the time is not small, the tolerance includes the rounding error of the time.
#[test]
fn starts_may_be_as_far_off_as_time_is_rounded() {
    let carried = Carried::new(1.0, 2.0);
    solve(&carried, (FRAC_PI_2, 2.0), [-1.0, 0.0], [0.0; 2]).run().unwrap();
    solve(&carried, (FRAC_PI_2 / 2.0, 2.0), [0.0; 2], [-2.0, 0.0]).run().unwrap();
    let error = solve(&carried, (FRAC_PI_2, 2.0), [-1.0, 0.0], [1e-9, 0.0]).run().unwrap_err();
    assert!(error.to_string().contains("the rate of the constraint ride"), "{error}");
}
