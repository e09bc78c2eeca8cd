//! States of first order, compared with closed forms and with other descriptions of the same motion.

use core::f64::consts::PI;
use pendulum_runtime::analysis::{equilibrium, linearize, state_space};
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Event, Gauss, Rodas4, Taylor};
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A low pass behind a wheel that nothing moves.
    #[derive(Clone, Debug)]
    pub struct Filter { J: kg*m^2, T: s }
    coordinate φ: rad;
    driven u: V;
    state z: V;
    kinetic = J/2*φ̇^2;
    rate z = (u - z)/T;
    output slope: V/s = ż;
}

lagrangian! {
    /// A low pass behind a square wave.
    #[derive(Clone, Debug)]
    pub struct Switched { J: kg*m^2, T: s, ω: Hz }
    coordinate φ: rad;
    state z;
    kinetic = J/2*φ̇^2;
    rate z = (sign(sin(ω*t)) - z)/T;
}

lagrangian! {
    /// A low pass behind a control input, with another behind it.
    #[derive(Clone, Debug)]
    pub struct Held { J: kg*m^2, T: s }
    coordinate φ: rad;
    input u: V;
    state z[2]: V;
    kinetic = J/2*φ̇^2;
    rate z[0] = (u - z[0])/T;
    rate z[1] = (z[0] - z[1])/T;
}

lagrangian! {
    /// A mass under a controller with integral action, and a load.
    #[derive(Clone, Debug)]
    pub struct Integral { m: kg, p: N/m, d: N*s/m, c: N/(m*s), F: N }
    coordinate x: m;
    input L: N;
    state z: m*s;
    kinetic = m/2*ẋ^2;
    force x = F + L - p*x - d*ẋ - c*z;
    rate z = x;
    output pull: N = m*ẍ;
}

lagrangian! {
    /// A block on a bristle (LuGre), pulled by a spring whose end runs.
    #[derive(Clone, Debug)]
    pub struct Bristle { m: kg, k: N/m, V: m/s, S: N, C: N, v: m/s, s: N/m, d: N*s/m }
    coordinate x: m;
    state z: m;
    let g = C + (S - C)*exp(-(ẋ/v)^2);
    kinetic = m/2*ẋ^2;
    potential = k/2*(V*t - x)^2;
    force x = -(s*z + d*ż);
    rate z = ẋ - s*abs(ẋ)/g*z;
}

lagrangian! {
    /// A ball on a spring, whose length a state follows.
    #[derive(Clone, Debug)]
    pub struct Followed { m: kg, k: N/m, g: m/s^2 = 9.81 }
    coordinate x: m;
    state z: m;
    kinetic = m/2*ẋ^2;
    potential = m*g*x;
    force x = -k*z;
    rate z = ẋ;
    limit floor: x >= 0, restitution = 0.8;
}

lagrangian! {
    /// The same without a state.
    #[derive(Clone, Debug)]
    pub struct Plain { m: kg, k: N/m, o: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    potential = m*g*x + k/2*(x - o)^2;
    limit floor: x >= 0, restitution = 0.8;
}

lagrangian! {
    /// A sledge that falls on rough ground and comes to rest there.
    #[derive(Clone, Debug)]
    pub struct Sledge { m: kg, μ: 1, k: N/m, V: m/s, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    state z: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = m*g*p.y + k/2*(p.x - V*t)^2;
    rate z = dot(p);
    limit floor: p.y >= 0, restitution = 0;
    friction grip: dot(p).x, force = μ*reaction(floor);
}

lagrangian! {
    /// A spring whose stiffness follows the deflection late.
    #[derive(Clone, Debug)]
    pub struct Aging { m: kg, k: N/m, a: N/m^3, T: s }
    coordinate x: m;
    state z: m^2;
    kinetic = m/2*ẋ^2;
    potential = (k + a*z)/2*x^2;
    rate z = (x^2 - z)/T;
    output own_energy: J = m/2*ẋ^2 + (k + a*z)/2*x^2;
}

lagrangian! {
    /// A body with a motor that lags.
    #[derive(Clone, Debug)]
    pub struct Lagging { B: solid, M: N*m, T: s }
    coordinate R: rotation;
    state l: [N*m; 3];
    kinetic = integral(p in B, |dot(R*p)|^2 / 2);
    torque R = l;
    rate l = (M*[0, 0, 1] - l)/T;
}

fn integral() -> Integral {
    Integral::new(1.0, 11.0, 6.0, 6.0, 2.0)
}

/// The deflection and the state of the mass with integral action at `t`, whose poles are −1, −2 and
/// −3, for a step of the load by 2 N.
fn integrated(t: f64) -> [f64; 2] {
    let [a, b, c] = [1.0, 2.0, 3.0].map(|pole| (-pole * t).exp());
    [2.0 * (a / 2.0 - b + c / 2.0), 2.0 * ((1.0 - a) / 2.0 - (1.0 - b) / 2.0 + (1.0 - c) / 6.0)]
}

/// The voltage of a low pass from zero behind a sine of amplitude one.
fn filtered(t: f64, ω: f64, time: f64) -> f64 {
    let a = ω * time;
    ((ω * t).sin() - a * (ω * t).cos() + a * (-t / time).exp()) / (1.0 + a * a)
}

#[test]
fn a_filter_follows_a_sine() {
    let ω = 3.0;
    let filter = Filter::new(1.0, 0.2).driven_by(Sinusoid::new([1.0], ω, [0.0]));
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let times: Vec<f64> = (1..=60).map(|k| 0.1 * f64::from(k)).collect();
        let worst = |found: &[[f64; 2]]| {
            let errors = times.iter().zip(found).map(|(&t, q)| (q[1] - filtered(t, ω, 0.2)).abs());
            errors.fold(0.0, f64::max)
        };
        let problem = || solve(&filter, (0.0, 6.0), [0.0; 2], [0.0; 2]).rtol(rtol).atol(rtol);
        let default = problem().t_eval(&times).run().unwrap();
        let dop853 = problem().method(Dop853).t_eval(&times).run().unwrap();
        for (name, run) in [("default", &default), ("dop853", &dop853)] {
            println!(
                "{name} {rtol:e}: {:.3} tolerances, {} steps",
                worst(&run.q) / rtol,
                run.stats.accepted
            );
            assert!(worst(&run.q) < 10.0 * rtol.max(2e-15), "{name} {rtol:e} {:e}", worst(&run.q));
        }
        // The place among the velocities holds the rate.
        for (q, (v, &t)) in default.q.iter().zip(default.v.iter().zip(&times)) {
            assert!((v[1] - ((ω * t).sin() - q[1]) / 0.2).abs() < 1e-13);
        }
    }
}

#[test]
fn a_filter_behind_a_square_wave_jumps_in_its_rate() {
    let (ω, time) = (2.0, 0.3);
    let system = Switched::new(1.0, time, ω);
    // Over half a period, z decays towards ±1.
    let decay = (-PI / ω / time).exp();
    let mut z = 0.0;
    for (half, sign) in (0..6).map(|half| (half, if half % 2 == 0 { 1.0 } else { -1.0 })) {
        z = sign + (z - sign) * decay;
        let end = f64::from(half + 1) * PI / ω;
        for rtol in [1e-6, 1e-10] {
            let problem = || solve(&system, (0.0, end), [0.0; 2], [0.0; 2]).rtol(rtol).atol(rtol);
            let default = problem().run().unwrap();
            let dop853 = problem().method(Dop853).run().unwrap();
            for run in [&default, &dop853] {
                println!("{rtol:e}: {:.3} tolerances", (run.end.q[1] - z).abs() / rtol);
                assert!((run.end.q[1] - z).abs() < 20.0 * rtol, "{half} {rtol:e}");
            }
        }
    }
}

lagrangian! {
    /// States whose rates jump where a point has turned about half the plane, and at the start.
    #[derive(Clone, Debug)]
    pub struct Turning { J: kg*m^2, ω: Hz }
    coordinate φ: rad;
    state z[2];
    kinetic = J/2*φ̇^2;
    rate z[0] = ω*atan2(sin(φ), cos(φ));
    rate z[1] = ω*sign(φ);
}

#[test]
fn no_jump_of_a_rate_is_passed_over() {
    let system = Turning::new(1.0, 1.0);
    for rtol in [1e-6, 1e-9] {
        let problem =
            || solve(&system, (0.0, 5.0), [0.0; 3], [1.0, 0.0, 0.0]).rtol(rtol).atol(rtol);
        let default = problem().run().unwrap();
        let dop853 = problem().method(Dop853).run().unwrap();
        // φ = t.
        let expected = PI * PI / 2.0 + ((5.0 - 2.0 * PI).powi(2) - PI * PI) / 2.0;
        for run in [default, dop853] {
            println!("{:e} {:e} {}", run.end.q[1] - expected, run.end.q[2] - 5.0, run.stats);
            assert!((run.end.q[1] - expected).abs() < 50.0 * rtol);
            assert!((run.end.q[2] - 5.0).abs() < 50.0 * rtol);
        }
    }
}

lagrangian! {
    /// A state that would have to stay where its rate jumps.
    #[derive(Clone, Debug)]
    pub struct Sliding { J: kg*m^2, ω: Hz }
    coordinate φ: rad;
    state z;
    kinetic = J/2*φ̇^2;
    rate z = -ω*sign(z);
}

#[test]
fn a_state_that_would_stay_at_a_jump_stays_or_ends_the_run() {
    let system = Sliding::new(1.0, 1.0);
    for z in [1.0, -0.3] {
        let problem = || solve(&system, (0.0, 3.0), [0.0, z], [0.0; 2]);
        for outcome in [problem().run(), problem().method(Dop853).run()] {
            match outcome {
                Ok(run) => assert!(run.end.q[1].abs() < 1e-8, "{}", run.end.q[1]),
                Err(failure) => {
                    assert!(matches!(failure.error, Error::Sliding { .. }), "{}", failure.error);
                    assert!(failure.error.to_string().contains("where z changes"));
                }
            }
        }
    }
}

#[test]
fn linear_models_count_states_once() {
    let system = integral().controlled_by(|_, _: &[f64; 2], _| 0.0);
    let rest = equilibrium(&system, 0.0, [0.4, 0.0]).unwrap();
    assert!(rest[0].abs() < 1e-14 && (rest[1] - 2.0 / 6.0).abs() < 1e-14, "{rest:?}");
    let small = linearize(&system, 0.0, &rest, &[0.0; 2]);
    let mut modes: Vec<f64> =
        small.damped_modes().unwrap().iter().map(|mode| mode.eigenvalue.re).collect();
    modes.sort_by(f64::total_cmp);
    assert!(
        modes.len() == 3 && (0..3).all(|k| (modes[k] + 3.0 - k as f64).abs() < 1e-10),
        "{modes:?}"
    );
    // The mass on its spring, while the state is held.
    let normal = small.normal_modes().unwrap();
    assert!((normal.squared_frequencies[0] - 11.0).abs() < 1e-12);
    assert_eq!((normal.squared_frequencies.len(), normal.shapes.nrows()), (1, 2));
    let model = state_space(&system, 0.0, &rest, &[0.0; 2]);
    assert_eq!((&model.coordinates[..], &model.velocities[..]), (&[0, 1][..], &[0][..]));
    // x, z, ẋ.
    assert_eq!(model.a.as_slice(), [0.0, 1.0, -11.0, 0.0, 0.0, -6.0, 1.0, 0.0, -6.0]);
    assert_eq!(model.b.as_slice(), [0.0, 0.0, 1.0]);
    assert_eq!((model.c.as_slice(), model.d.as_slice()), (&[-11.0, -6.0, -6.0][..], &[1.0][..]));
}

#[test]
fn linear_models_take_controls_in_rates_and_rotations() {
    let system = Held::new(1.0, 0.2).sampled(0.1, |_, _: &[f64; 3], _| 0.0);
    solve(&system, (0.0, 0.1), [0.0; 3], [0.0; 3]).run().unwrap();
    let model = state_space(&system, 0.0, &[0.0; 3], &[0.0; 3]);
    assert_eq!(model.b.as_slice(), [0.0, 5.0, 0.0, 0.0]);
    assert_eq!(model.a.column(1).as_slice(), [0.0, -5.0, 5.0, 0.0]);
    let body = pendulum_runtime::body::Solid::cuboid(2.0, [0.3, 0.4, 0.5]).unwrap();
    let lagging = Lagging::new(body, 1.0, 0.5);
    let start = Lagging::start().l([0.0, 0.0, 1.0]);
    let modes = linearize(&lagging, 0.0, &start.q, &start.v).damped_modes().unwrap();
    let states = modes.iter().filter(|mode| (mode.eigenvalue.re + 2.0).abs() < 1e-9).count();
    let model = state_space(&lagging, 0.0, &start.q, &start.v);
    assert_eq!((states, model.coordinates.len(), model.velocities.len()), (3, 6, 3));
}

#[test]
fn a_step_of_a_driven_input_jumps_in_the_rate() {
    let steps = Curve::steps(&[0.0, 1.0], &[[2.0], [-1.0]]).unwrap();
    let filter = Filter::new(1.0, 0.5).driven_by(steps);
    let run = solve(&filter, (0.0, 3.0), [0.0; 2], [0.0; 2]).rtol(1e-10).run().unwrap();
    let before = 2.0 * (1.0 - (-2.0_f64).exp());
    let expected = -1.0 + (before + 1.0) * (-4.0_f64).exp();
    assert!((run.end.q[1] - expected).abs() < 1e-9);
}

#[test]
fn states_follow_samples() {
    let time = 0.2;
    let system = Held::new(1.0, time).sampled(0.1, |t, _: &[f64; 3], _| (7.0 * t).sin());
    let run = solve(&system, (0.0, 2.0), [0.0; 3], [0.0; 3]).rtol(1e-11).run().unwrap();
    let (mut a, mut b) = (0.0_f64, 0.0_f64);
    for k in 0..20 {
        let u = (7.0 * 0.1 * f64::from(k)).sin();
        let (decay, h) = ((-0.1_f64 / time).exp(), 0.1 / time);
        // d(b − u)/dt = ((a − u) − (b − u))/T.
        (a, b) = (u + (a - u) * decay, u + ((b - u) + (a - u) * h) * decay);
    }
    assert!((run.end.q[1] - a).abs() < 1e-10 && (run.end.q[2] - b).abs() < 1e-10);
}

#[test]
fn integral_action_removes_the_load_with_every_method() {
    let system = integral().controlled_by(|_, _: &[f64; 2], _| 0.0);
    let [x, z] = integrated(4.0);
    let start = ([0.0; 2], [0.0; 2]);
    let problem = || solve(&system, (0.0, 4.0), start.0, start.1);
    let runs = [
        ("default", 1e-10, problem().rtol(1e-10).atol(1e-10).run().unwrap().end),
        ("dop853", 1e-10, problem().method(Dop853).rtol(1e-10).atol(1e-10).run().unwrap().end),
        ("picard", 1e-10, problem().method(Picard).rtol(1e-10).atol(1e-10).run().unwrap().end),
        ("rodas", 1e-6, problem().method(Rodas4).rtol(1e-8).atol(1e-8).run().unwrap().end),
        ("rk4", 1e-8, problem().method(Rk4).step(0.005).run().unwrap().end),
    ];
    for (name, bound, end) in runs {
        println!("{name} {:e} {:e}", end.q[0] - x, end.q[1] - z);
        assert!((end.q[0] - x).abs() < 5.0 * bound && (end.q[1] - z).abs() < 5.0 * bound, "{name}");
        assert!((end.v[1] - end.q[0]).abs() < 1e-15, "{name}");
    }
}

#[test]
fn places_of_rates_are_set_and_not_read() {
    let system = integral().controlled_by(|_, _: &[f64; 2], _| 0.0);
    let run = |rate: f64| solve(&system, (0.0, 1.0), [0.3, 0.1], [0.2, rate]).run().unwrap();
    assert_eq!(run(0.0).end, run(17.0).end);
    let output = run(3.0).end;
    assert_eq!(output.v[1], output.q[0]);
}

/// A bristle against the classical method of Runge and Kutta for three equations of first order.
#[test]
fn bristles_stick_and_slip() {
    let own = Bristle::new(1.0, 2.0, 0.1, 1.5, 1.0, 0.05, 1e3, 30.0);
    let slope = |t: f64, [x, w, z]: [f64; 3]| {
        let g = own.C + (own.S - own.C) * (-(w / own.v).powi(2)).exp();
        let rate = w - own.s * w.abs() / g * z;
        [w, (own.k * (own.V * t - x) - own.s * z - own.d * rate) / own.m, rate]
    };
    let (mut y, count, end) = ([0.0; 3], 400_000, 20.0);
    let h = end / f64::from(count);
    for k in 0..count {
        let t = h * f64::from(k);
        let moved = |k: [f64; 3], s: f64| core::array::from_fn(|i| y[i] + s * h * k[i]);
        let a = slope(t, y);
        let b = slope(t + 0.5 * h, moved(a, 0.5));
        let c = slope(t + 0.5 * h, moved(b, 0.5));
        let d = slope(t + h, moved(c, 1.0));
        for i in 0..3 {
            y[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
    }
    for rtol in [1e-6, 1e-8, 1e-10] {
        let problem = || solve(&own, (0.0, end), [0.0; 2], [0.0; 2]).rtol(rtol).atol(rtol);
        let default = problem().run().unwrap();
        let dop853 = problem().method(Dop853).run().unwrap();
        for run in [default, dop853] {
            let State { q, v, .. } = run.end;
            let errors = [q[0] - y[0], v[0] - y[1], q[1] - y[2]].map(f64::abs);
            println!("{rtol:e} {errors:?} {}", run.stats);
            assert!(errors.iter().all(|error| *error < 1e3 * rtol + 1e-9), "{rtol:e} {errors:?}");
        }
    }
}

#[test]
fn states_go_on_through_impacts_and_kicks() {
    let (state, plain) = (Followed::new(0.5, 3.0), Plain::new(0.5, 3.0, 0.4));
    let kick = || Event::at([1.3]).then(|state: &mut State<f64, 2>| state.v[0] += 1.0);
    let other = || Event::at([1.3]).then(|state: &mut State<f64, 1>| state.v[0] += 1.0);
    // z = x − 0.4.
    for rtol in [1e-8, 1e-11] {
        let a = solve(&state, (0.0, 3.0), [1.0, 0.6], [0.0; 2]).rtol(rtol).events([kick()]);
        let b = solve(&plain, (0.0, 3.0), [1.0], [0.0]).rtol(rtol).events([other()]);
        let (a, b) = (a.run().unwrap(), b.run().unwrap());
        assert!(1 < a.impacts.len());
        assert_eq!(a.impacts.len(), b.impacts.len());
        println!("{rtol:e} {:e}", a.end.q[0] - b.end.q[0]);
        assert!((a.end.q[0] - b.end.q[0]).abs() < 100.0 * rtol);
        assert!((a.end.q[1] + 0.4 - a.end.q[0]).abs() < 100.0 * rtol);
        assert_eq!(a.end.v[0], a.end.v[1]);
    }
}

#[test]
fn rates_feel_contacts_and_frictions() {
    let sledge = Sledge::new(1.0, 0.4, 5.0, 0.25);
    let start = ([0.0, 0.5, 0.0, 0.5], [0.7, 0.0, 0.0, 0.0]);
    let run = solve(&sledge, (0.0, 6.0), start.0, start.1).rtol(1e-9).every(0.1).run().unwrap();
    for (q, v) in run.q.iter().zip(&run.v) {
        assert!((q[0] - q[2]).abs() < 1e-8 && (q[1] - q[3]).abs() < 1e-8, "{q:?}");
        assert!(v[0] == v[2] && v[1] == v[3]);
    }
    assert!(!run.frictions.is_empty());
}

#[test]
fn power_counts_the_states_in_energies() {
    let system = Aging::new(1.0, 4.0, 3.0, 0.7);
    let run = solve(&system, (0.0, 3.0), [1.0, 0.2], [0.5, 0.0]).rtol(1e-12).dense().run().unwrap();
    let energy = |t: f64| {
        let State { q, v, .. } = run.at(t).unwrap();
        let energy = system.energy_at(t, &q, &v);
        let expected = 0.5 * (v[0] * v[0] + (4.0 + 3.0 * q[1]) * q[0] * q[0]);
        assert!((energy - expected).abs() < 1e-12);
        energy
    };
    for t in [0.5, 1.0, 2.0] {
        let State { q, v, .. } = run.at(t).unwrap();
        let h = 1e-3;
        let slope = (8.0 * (energy(t + h) - energy(t - h))
            - (energy(t + 2.0 * h) - energy(t - 2.0 * h)))
            / (12.0 * h);
        assert!((slope - system.power_at(t, &q, &v)).abs() < 1e-8, "{t}");
    }
}

#[test]
fn states_stand_beside_rotations() {
    let body = pendulum_runtime::body::Solid::cuboid(2.0, [0.3, 0.4, 0.5]).unwrap();
    let system = Lagging::new(body, 1.0, 0.5);
    let start = Lagging::start();
    let run = solve(&system, (0.0, 2.0), start.q, start.v).rtol(1e-10).run().unwrap();
    let expected = 1.0 - (-4.0_f64).exp();
    assert!((run.end.q[6] - expected).abs() < 1e-9, "{:?}", run.end.q);
    // About a fixed axis: J ω = ∫ l dt.
    let spin = 2.0 - 0.5 * expected;
    let inertia = 2.0 / 12.0 * (0.09 + 0.16);
    let [w, _, _, z] = [0, 1, 2, 3].map(|k| run.end.q[k]);
    let [rw, _, _, rz] = [0, 1, 2, 3].map(|k| run.end.v[k]);
    assert!((2.0 * (w * rz - z * rw) - spin / inertia).abs() < 1e-8);
}

#[test]
fn single_precision_integrates_states() {
    let filter = Filter::<f32>::new(1.0, 0.2).driven_by(Sinusoid::new([1.0], 3.0, [0.0]));
    let run = solve(&filter, (0.0, 2.0), [0.0; 2], [0.0; 2]).rtol(1e-5).run().unwrap();
    assert!((f64::from(run.end.q[1]) - filtered(2.0, 3.0, 0.2)).abs() < 2e-5);
}

lagrangian! {
    /// Two links and a state that the speed of the second one drives.
    #[derive(Clone, Debug)]
    pub struct Links { m: kg, L: m, T: s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    state z: m/s;
    let y[k in 0..2] = sum(j in 0..=k, L*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m*g*height(y[k]));
    force y[1] = -m/T/4*[z, 0];
    rate z = (ẏ[1].x - z)/T;
}

#[test]
fn series_and_implicit_methods_integrate_states() {
    let links = Links::new(1.0, 0.5, 0.3);
    let problem = || solve(&links, (0.0, 2.0), [1.0, 1.4, 0.3], [0.0; 3]);
    let expected = problem().method(Dop853).rtol(1e-12).run().unwrap().end.q;
    let runs = [
        problem().rtol(1e-10).run().unwrap().end,
        problem().method(Taylor::default()).rtol(1e-10).run().unwrap().end,
        problem().method(Gauss::<4>::new()).step(0.01).run().unwrap().end,
    ];
    for end in runs {
        let errors: [f64; 3] = core::array::from_fn(|k| (end.q[k] - expected[k]).abs());
        println!("{errors:?}");
        assert!(errors.iter().all(|error| *error < 1e-8), "{errors:?}");
    }
    // Back to the start.
    let end = problem().rtol(1e-12).run().unwrap().end;
    let back = solve(&links, (2.0, 1.0), end.q, end.v).rtol(1e-12).run().unwrap().end;
    let there = solve(&links, (0.0, 1.0), [1.0, 1.4, 0.3], [0.0; 3]).rtol(1e-12).run().unwrap().end;
    assert!((0..3).all(|k| (back.q[k] - there.q[k]).abs() < 1e-8));
}

lagrangian! {
    /// A bob on a rod, above a floor; pivot and floor follow states.
    #[derive(Clone, Debug)]
    pub struct Carried { m: kg, L: m, V: m/s, U: m/s, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    state p: m;
    state f: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x - p, y]| = L;
    limit wall: x - f >= 0, restitution = 0.5;
    rate p = V;
    rate f = U;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Standing { m: kg, L: m, V: m/s, w: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x, y]| = L;
    limit wall: x + V*t >= -w, restitution = 0.5;
}

#[test]
fn constraints_and_limits_follow_states() {
    let (v, u) = (0.3, 0.2);
    let (carried, standing) = (Carried::new(1.0, 1.0, v, u), Standing::new(1.0, 1.0, v - u, 0.2));
    let (x, y) = (0.6, -0.8);
    let own = solve(&carried, (0.0, 3.0), [x, y, 0.0, -0.2], [v, 0.0, 0.0, 0.0]).rtol(1e-10);
    let other = solve(&standing, (0.0, 3.0), [x, y], [0.0; 2]).rtol(1e-10);
    let (own, other) = (own.run().unwrap(), other.run().unwrap());
    assert!(!own.impacts.is_empty());
    assert_eq!(own.impacts.len(), other.impacts.len());
    assert!((own.end.q[0] - 3.0 * v - other.end.q[0]).abs() < 1e-7);
    assert!((own.end.v[0] - v - other.end.v[0]).abs() < 1e-7);
    assert!((own.end.q[2] - 3.0 * v).abs() < 1e-12);
}

#[test]
fn ensembles_integrate_states_one_by_one() {
    let problem = |index: usize| Problem {
        system: Links::new(1.0, 0.5, 0.1 + 0.1 * index as f64),
        time: (0.0, 1.0),
        q: [1.0, 1.4, 0.3],
        v: [0.0; 3],
    };
    let all = Ensemble::new(0..6, problem).rtol(1e-9);
    let all = all.map(|_, solution| solution.end).collect().unwrap();
    for (index, member) in all.value.into_iter().enumerate() {
        let Problem { system, time, q, v } = problem(index);
        let alone = solve(&system, time, q, v).rtol(1e-9).run().unwrap().end;
        assert_eq!(member.unwrap(), alone);
    }
}

#[test]
fn facts_name_the_states() {
    let facts = Integral::FACTS;
    assert_eq!((facts.coordinates, facts.states), (&["x", "z"][..], 1));
    assert_eq!(facts.coordinate_units[1], "m*s");
    assert!(facts.equations.contains("ż = x"), "{}", facts.equations);
    assert!(!facts.velocity_free && !facts.separable);
    assert_eq!(Held::FACTS.coordinates, ["φ", "z[0]", "z[1]"]);
    const { assert!(Held::FACTS.controlled_rates && !Integral::FACTS.controlled_rates) };
}
