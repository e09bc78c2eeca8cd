//! Control inputs: feedback in continuous time and sampled controllers, compared with the same laws
//! in the Lagrangian and with closed forms.

use pendulum_runtime::error::{Error, Quantity};
use pendulum_runtime::integrate::State;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

lagrangian! {
    #[derive(Clone)]
    pub struct Arm { m: kg, L: m, b: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    input τ: N*m;
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
    dissipation = b/2 * θ̇^2;
    force θ = τ;
}

lagrangian! {
    /// The same with its law.
    pub struct Written { m: kg, L: m, b: N*m*s, p: N*m, d: N*m*s, a: N*m, w: Hz, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
    dissipation = b/2 * θ̇^2;
    force θ = p*(1 - θ) - d*θ̇ + a*sin(w*t);
}

lagrangian! {
    /// Two links on a moving hand, with a motor at each joint.
    pub struct Robot { m: [kg; 2], l: [m; 2], g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    input τ: N*m;
    input pull: [N; 2];
    let y[k in 0..2] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k])) - inner(pull, y[1]);
    force θ[0] = τ;
}

lagrangian! {
    /// The same with its law.
    pub struct WrittenRobot { m: [kg; 2], l: [m; 2], p: N*m, c: N*s/m, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    let y[k in 0..2] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
    force θ[0] = -p*θ[0] - c*l[0]*θ̇[0]*l[0]*cos(θ[0])^2;
    force θ[1] = -c*l[1]*θ̇[1]*l[1]*cos(θ[1])^2;
}

const LAW: [f64; 4] = [40.0, 6.0, 3.0, 2.0];

#[allow(clippy::trivially_copy_pass_by_ref)]
fn law(t: f64, q: &[f64; 1], v: &[f64; 1]) -> f64 {
    let [p, d, a, w] = LAW;
    p * (1.0 - q[0]) - d * v[0] + a * (w * t).sin()
}

fn written() -> Written {
    let [p, d, a, w] = LAW;
    Written::new(1.0, 0.5, 0.1, p, d, a, w)
}

fn assert_near(found: &State<f64, 1>, expected: &State<f64, 1>, bound: f64) {
    assert_eq!(found.t, expected.t);
    let error = f64::max((found.q[0] - expected.q[0]).abs(), (found.v[0] - expected.v[0]).abs());
    assert!(error < bound, "{error}: {found:?} {expected:?}");
}

/// Closures and force statements give the same motion with every kind of method.
#[test]
fn feedback_is_a_force() {
    let arm = Arm::new(1.0, 0.5, 0.1).controlled_by(law);
    let span = (0.0, 3.0);
    let exact = solve(&written(), span, [0.0], [0.0]).rtol(1e-14).run().unwrap().end;
    macro_rules! adaptive {
        ($($method:expr, $rtol:expr, $bound:expr;)+) => {$({
            let run = solve(&arm, span, [0.0], [0.0]).method($method).rtol($rtol).atol($rtol).run().unwrap();
            assert_near(&run.end, &exact, $bound);
        })+};
    }
    adaptive! {
        Auto, 1e-13, 1e-12;
        Picard, 1e-13, 1e-12;
        Dop853, 1e-13, 1e-12;
        Rodas4, 1e-8, 1e-6;
    }
    macro_rules! fixed {
        ($($method:expr, $steps:expr, $bound:expr;)+) => {$({
            let run = solve(&arm, span, [0.0], [0.0]).method($method).steps($steps).run().unwrap();
            assert_near(&run.end, &exact, $bound);
        })+};
    }
    fixed! {
        Auto, 600, 1e-12;
        Rk4, 3000, 1e-10;
        Gauss::<4>::new(), 600, 1e-12;
        Gauss::<4>::new().newton(), 600, 1e-12;
        Dop853, 600, 1e-12;
        SymplecticEuler, 100_000, 1e-3;
    }
}

/// Stiff feedback requires the derivatives of the law in the Jacobians.
#[test]
fn rodas_sees_the_law() {
    let arm = Arm::new(1.0, 0.5, 0.1).controlled_by(|_, q, v| -1e5 * (q[0] - 0.5) - 1e4 * v[0]);
    let stiff = solve(&arm, (0.0, 1.0), [0.0], [0.0]).method(Rodas4).rtol(1e-6).atol(1e-6);
    let run = stiff.run().unwrap();
    assert!(run.stats.accepted < 300, "{}", run.stats);
    let explicit = solve(&arm, (0.0, 1.0), [0.0], [0.0]).method(Dop853).rtol(1e-10).run().unwrap();
    assert!(explicit.stats.accepted > 3000, "{}", explicit.stats);
    assert_near(&run.end, &explicit.end, 1e-5);
}

#[test]
fn several_inputs_and_motions() {
    let hand = || Sinusoid::new([0.1, 0.05], 5.0, [0.0, 0.3]);
    let (m, l) = ([1.0, 0.7], [0.6, 0.4]);
    // A damper between the tip of each link and the side, as horizontal forces along the chain.
    let robot = Robot::new(m, l).driven_by(hand()).controlled_by(move |_, q, v| {
        let slow = |k: usize| 0.8 * l[k] * v[k] * l[k] * q[k].cos() * q[k].cos();
        // The pull exerts l cos θ fₓ on each angle: the torque compensates for the first link.
        let pull = -slow(1) / (l[1] * q[1].cos());
        let on_first = l[0] * q[0].cos() * pull;
        (-5.0 * q[0] - slow(0) - on_first, [pull, 0.0])
    });
    let written = WrittenRobot::new(m, l, 5.0, 0.8).driven_by(hand());
    let start = ([0.5, -0.3], [0.0, 1.0]);
    for rtol in [1e-8, 1e-12] {
        let a = solve(&robot, (0.0, 1.0), start.0, start.1).rtol(rtol).run().unwrap();
        let b = solve(&written, (0.0, 1.0), start.0, start.1).rtol(rtol).run().unwrap();
        for i in 0..2 {
            assert!((a.end.q[i] - b.end.q[i]).abs() < 30.0 * rtol, "{a:?} {b:?}");
            assert!((a.end.v[i] - b.end.v[i]).abs() < 30.0 * rtol);
        }
        assert_eq!(a.stats.method, "Picard");
    }
}

/// ∫ P dt is the change of the energy, also with a law in a potential.
#[test]
fn the_power_of_a_controller_is_part_of_the_balance() {
    let robot = Robot::new([1.0, 0.7], [0.6, 0.4])
        .driven_by(Sinusoid::new([0.1, 0.05], 5.0, [0.0, 0.3]))
        .controlled_by(|t, q, v| (q[1] - v[0], [(3.0 * t).sin(), q[0] * v[1]]));
    let count = 4000;
    let times: Vec<f64> = (0..=count).map(|k| 2.0 * f64::from(k) / f64::from(count)).collect();
    let run = solve(&robot, (0.0, 2.0), [0.5, -0.3], [0.0, 1.0]).rtol(1e-12).t_eval(&times).run();
    let run = run.unwrap();
    let at = |k: usize| (run.t[k], &run.q[k], &run.v[k]);
    // Simpson's rule.
    let power = |k: usize| {
        let (t, q, v) = at(k);
        robot.power_at(t, q, v)
    };
    let h = 2.0 / f64::from(count);
    let work: f64 = (0..count as usize / 2)
        .map(|k| h / 3.0 * (power(2 * k) + 4.0 * power(2 * k + 1) + power(2 * k + 2)))
        .sum();
    let energy = |k: usize| {
        let (t, q, v) = at(k);
        robot.energy_at(t, q, v)
    };
    let gained = energy(count as usize) - energy(0);
    assert!((work - gained).abs() < 1e-9 * (1.0 + work.abs()), "{work} {gained}");
    assert!(work.abs() > 0.1);
}

lagrangian! {
    pub struct Cart { m: kg }
    coordinate s: m;
    input u: N;
    kinetic = m/2*ṡ^2;
    potential = 0;
    force s = u;
    output force: N = u;
}

/// A held force moves a cart along parabolas. The test compares s and v with the exact recursion.
#[test]
fn a_zero_order_hold_gives_parabolas() {
    let (period, m) = (0.125, 2.0);
    let mut integral = 0.0;
    let controller = move |_: f64, q: &[f64; 1], v: &[f64; 1]| {
        integral += 1.0 - q[0];
        3.0 * (1.0 - q[0]) - 2.0 * v[0] + 0.5 * integral
    };
    let cart = Cart::new(m).sampled(period, controller);
    let (mut s, mut v, mut own) = (0.0, 0.0, controller);
    for k in 0..40 {
        let a = own(f64::from(k) * period, &[s], &[v]) / m;
        (s, v) = (s + v * period + a * period * period / 2.0, v + a * period);
    }
    let start = || solve(&cart, (0.0, 5.0), [0.0], [0.0]);
    for run in [
        start().run(),
        start().method(Picard).run(),
        start().method(Dop853).run(),
        start().method(Rk4).step(0.3).run(),
        start().method(Gauss::<2>::new()).step(0.3).run(),
        start().method(Rodas4).run(),
    ] {
        let run = run.unwrap();
        assert!((run.end.q[0] - s).abs() < 1e-12, "{} {s} {}", run.end.q[0], run.stats);
        assert!((run.end.v[0] - v).abs() < 1e-12);
    }
    // Each run starts with the original controller; outputs use its recorded samples.
    let first = start().run().unwrap();
    assert_eq!(first.end, start().run().unwrap().end);
    assert_eq!(cart.force(0.06, &[0.0], &[0.0]), 3.0 + 0.5);
    assert_eq!(cart.force(0.0, &[0.0], &[0.0]), 3.5);
    assert_ne!(cart.force(0.126, &[0.0], &[0.0]), 3.5);
}

/// Dense output and output times between samples lie on the parabolas.
#[test]
fn output_between_samples() {
    let cart = Cart::new(1.0)
        .sampled(0.5, |t, _: &[f64; 1], _: &[f64; 1]| if t < 0.75 { 1.0 } else { -1.0 });
    let run = solve(&cart, (0.0, 2.0), [0.0], [0.0]).dense().run().unwrap();
    for k in 0..=200 {
        let t = f64::from(k) * 0.01;
        let exact =
            if t <= 1.0 { t * t / 2.0 } else { 0.5 + (t - 1.0) - (t - 1.0) * (t - 1.0) / 2.0 };
        assert!((run.at(t).unwrap().q[0] - exact).abs() < 1e-12, "{t}");
    }
    assert_eq!(run.stats.kinks, 4);
}

#[test]
fn mistakes_of_controllers_have_a_time_and_a_name() {
    let arm = Arm::new(1.0, 0.5, 0.1);
    let wild = arm.clone().controlled_by(|t, _, _| if t < 0.7 { 0.0 } else { f64::NAN });
    for failure in [
        solve(&wild, (0.0, 2.0), [0.3], [0.0]).run().unwrap_err(),
        solve(&wild, (0.0, 2.0), [0.3], [0.0]).method(Dop853).run().unwrap_err(),
        solve(&wild, (0.0, 2.0), [0.3], [0.0]).method(Rk4).step(0.01).run().unwrap_err(),
    ] {
        let Error::NotFinite { t, what, .. } = failure.error else { panic!("{failure:?}") };
        assert_eq!(what, Quantity::Control { name: "τ", component: 0 });
        assert!((0.69..1.5).contains(&t), "{t}");
        assert!(failure.partial.end.t < 0.7001 && failure.partial.end.q[0].is_finite());
        assert!(failure.to_string().contains("`τ`") && failure.to_string().contains("controller"));
    }
    let sampled = arm.clone().sampled(0.1, |t, _, _| if t < 0.75 { 0.0 } else { f64::INFINITY });
    let failure = solve(&sampled, (0.0, 2.0), [0.3], [0.0]).run().unwrap_err();
    assert_eq!(failure.partial.end.t, 0.8);
    assert!(failure.to_string().contains("t = 0.8"), "{failure}");
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let sampled = arm.clone().sampled(period, |_, _, _| 0.0);
        let failure = solve(&sampled, (0.0, 2.0), [0.3], [0.0]).run().unwrap_err();
        assert!(failure.to_string().contains("`period`"), "{failure}");
    }
}

/// A second integration of a sampled system is refused, because the samples would be mixed.
#[test]
fn a_sampled_controller_serves_one_integration() {
    let arm = Arm::new(1.0, 0.5, 0.1).sampled(0.1, |_, q, v| -q[0] - v[0]);
    let mut first = Integrator::new(&arm, Dop853, 0.0, [0.3], [0.0]).unwrap();
    first.advance_to(0.45).unwrap();
    let mut second = Integrator::new(&arm, Dop853, 0.0, [0.3], [0.0]).unwrap();
    second.advance_to(0.45).unwrap();
    assert_eq!(first.state(), second.state());
    assert!(matches!(first.advance_to(1.0), Err(Error::Controller { .. })));
    second.advance_to(1.0).unwrap();
    let own = arm.clone();
    let mut third = Integrator::new(&own, Dop853, 0.0, [0.3], [0.0]).unwrap();
    third.advance_to(0.45).unwrap();
    third.advance_to(1.0).unwrap();
    assert_eq!(third.state(), second.state());
}

/// `linearize` linearizes the closed loop.
#[test]
fn the_closed_loop_is_linearized() {
    let arm = Arm::new(2.0, 0.5, 0.1);
    let open = pendulum_runtime::analysis::linearize(
        &arm.clone().controlled_by(|_, _, _| 0.0),
        0.0,
        &[0.0],
        &[0.0],
    );
    let closed = pendulum_runtime::analysis::linearize(
        &arm.controlled_by(|_, q, v| -7.0 * q[0] - 3.0 * v[0].sin()),
        0.0,
        &[0.0],
        &[0.0],
    );
    assert!((closed.stiffness[(0, 0)] - open.stiffness[(0, 0)] - 7.0).abs() < 1e-8);
    assert!((closed.damping[(0, 0)] - open.damping[(0, 0)] - 3.0).abs() < 1e-8);
}

/// A sampled run cannot be restored, because the state of a closure cannot be saved.
#[test]
fn a_sampled_run_cannot_be_taken_up_again() {
    let arm = Arm::new(1.0, 0.5, 0.1).sampled(0.1, |_, q, v| -q[0] - v[0]);
    let mut run = Integrator::new(&arm, Dop853, 0.0, [0.3], [0.0]).unwrap();
    run.advance_to(0.45).unwrap();
    let saved = run.save();
    let before = run.state();
    assert_eq!(run.restore(&saved), Err(Error::SavedController));
    assert_eq!(run.state(), before);
    // A run with a law without state can be restored.
    let arm = Arm::new(1.0, 0.5, 0.1).controlled_by(|_, q, v| -q[0] - v[0]);
    let mut run = Integrator::new(&arm, Picard, 0.0, [0.3], [0.0]).unwrap();
    run.advance_to(0.45).unwrap();
    let saved = run.save();
    run.advance_to(1.0).unwrap();
    let mut other = Integrator::new(&arm, Picard, 0.0, [0.1], [0.7]).unwrap();
    other.restore(&saved).unwrap();
    other.advance_to(1.0).unwrap();
    assert_eq!(run.state(), other.state());
}

/// Returns a controller that sums its inputs, so that its values depend on the number of calls.
fn summing() -> impl FnMut(f64, &[f64; 1], &[f64; 1]) -> f64 + Clone {
    let mut sum = 0.0;
    move |_, q, v| {
        sum += q[0];
        -sum - v[0]
    }
}

#[test]
fn a_reset_begins_the_controller_anew() {
    let arm = Arm::new(1.0, 0.5, 0.1).sampled(0.1, summing());
    let mut run = Integrator::new(&arm, Dop853, 0.0, [0.3], [0.0]).unwrap();
    run.advance_to(0.45).unwrap();
    let first = run.state();
    for _ in 0..2 {
        run.reset(0.0, [0.3], [0.0]).unwrap();
        run.advance_to(0.45).unwrap();
        assert_eq!(run.state(), first);
    }
}

/// A clone of an integration shares the controller of a borrowed system, but not of an owned one.
#[test]
fn a_clone_does_not_share_a_sampled_controller() {
    let arm = Arm::new(1.0, 0.5, 0.1).sampled(0.1, summing());
    let mut run = Integrator::new(&arm, Dop853, 0.0, [0.3], [0.0]).unwrap();
    run.advance_to(0.45).unwrap();
    let mut copy = run.clone();
    assert!(matches!(copy.advance_to(1.0), Err(Error::Controller { .. })));
    run.advance_to(1.0).unwrap();
    let mut own = Integrator::owning(arm.clone(), Dop853, 0.0, [0.3], [0.0]).unwrap();
    own.advance_to(0.45).unwrap();
    let mut copy = own.clone();
    own.advance_to(1.0).unwrap();
    copy.advance_to(1.0).unwrap();
    assert_eq!((own.state(), copy.state()), (run.state(), run.state()));
}

/// Periods below the resolution of floating-point time are refused immediately.
#[test]
fn a_period_moves_the_time_on() {
    let arm = Arm::new(1.0, 0.5, 0.1);
    for (start, period) in [(1.0, 1e-20), (1.0, 1e-300), (1e9, 1e-8), (1e300, 0.1), (-1.0, 1e-17)] {
        let sampled = arm.clone().sampled(period, |_, _, _| 0.0);
        let mut run = Integrator::new(&sampled, Dop853, start, [0.3], [0.0]).unwrap();
        let error = run.step().unwrap_err();
        assert!(matches!(error, Error::Setting { name: "period", .. }), "{error}");
    }
}

lagrangian! {
    #[derive(Clone)]
    pub struct Motor { J: kg*m^2 }
    coordinate θ: rad;
    input τ: N*m;
    kinetic = J/2 * θ̇^2;
    potential = 0;
    force θ = τ;
    output torque: N*m = τ;
}

/// The samples of a later run are not used for an earlier solution: outputs are refused.
#[test]
fn samples_belong_to_one_solution() {
    let motor = Motor::new(2.0).sampled(0.1, |_, θ, _| 1.0 - θ[0]);
    let run = |start: f64| solve(&motor, (0.0, 1.0), [start], [0.0]).every(0.25).run().unwrap();
    let first = run(0.0);
    let (torque, power) = (first.output(&motor, "torque").unwrap(), first.power(&motor).unwrap());
    assert_eq!(torque[0], 1.0);
    // A clone keeps the samples.
    let kept = motor.clone();
    let second = run(5.0);
    assert_eq!(second.output(&motor, "torque").unwrap()[0], -4.0);
    let message = first.output(&motor, "torque").unwrap_err().to_string();
    assert!(message.contains("clone the system for each run"), "{message}");
    let message = first.power(&motor).unwrap_err().to_string();
    assert!(message.starts_with("`power` needs the values of the sampled controller"), "{message}");
    assert!(first.accelerations(&motor).is_err() && first.table_with_outputs(&motor).is_err());
    assert!(first.reactions(&motor).is_err() && first.contact_forces(&motor).is_err());
    assert!(first.work(&motor).is_err() && first.friction_forces(&motor).is_err());
    // The energy and the names of columns need no samples.
    assert_eq!(first.energy(&motor), first.energy(&kept));
    assert!(first.output(&motor, "speed").unwrap_err().to_string().contains("no column `speed`"));
    assert_eq!(first.output(&kept, "torque").unwrap(), torque);
    assert_eq!(first.power(&kept).unwrap(), power);
    assert!(second.output(&kept, "torque").is_err());
    // A system that has not run has no samples.
    let fresh = Motor::new(2.0).sampled(0.1, |_, θ, _| 1.0 - θ[0]);
    assert!(first.output(&fresh, "torque").is_err());
}

lagrangian! {
    pub struct Loaded { m: kg, load: kg, k: N/m^3 }
    coordinate x: m;
    kinetic = (m + load)/2 * ẋ^2;
    potential = k/4 * x^4;
}

/// A zero parameter with which the first steps succeed is not named as a cause of a growing motion.
#[test]
fn steps_that_are_too_long_name_no_parameter() {
    let failure = solve(&Loaded::new(1.0, 0.0, 1e4), (0.0, 10.0), [1.0], [0.0])
        .method(Rk4)
        .step(0.25)
        .run()
        .unwrap_err();
    let message = failure.to_string();
    assert!(matches!(&failure.error, Error::NotFinite { suspects, .. } if suspects.is_empty()));
    assert!(message.contains("the steps are too long") && !message.contains("load"), "{message}");
    // With a mass of zero, the parameter is the cause.
    let failure = solve(&Loaded::new(0.0, 0.0, 1e4), (0.0, 10.0), [1.0], [0.0])
        .method(Rk4)
        .step(0.25)
        .run()
        .unwrap_err();
    assert!(failure.to_string().contains("`load`, which is 0.0"), "{failure}");
}
