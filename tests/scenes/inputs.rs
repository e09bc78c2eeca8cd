//! Control inputs in scenes: values that are held until the program sets others.

use pendulum_runtime::motion::{Curve, Function, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{Float, Real};
use pendulum_runtime::scene::{Handle, Preserve, Scene, SceneError, SceneStatus};
use systems::pendulums::Hanging;

lagrangian! {
    /// A pendulum with a motor on its axis.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Motor { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    input u: N*m;
    kinetic = m/2*L^2*θ̇^2;
    potential = -m*g*L*cos(θ);
    force θ = u;
}

lagrangian! {
    /// A damped pendulum on a moving joint, blown at its tip and turned at its axis.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Blown { m: kg, L: m, c: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    input wind: [N; 2];
    input torque: N*m;
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y) - inner(wind, y);
    dissipation = c/2*θ̇^2;
    force θ = torque;
    output pull: N = |wind|;
    output tip: [m; 2] = y;
    output pushed: [m; 2] = y + L/(m*g)*wind;
}

lagrangian! {
    /// A cart with an engine.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Cart { m: kg }
    coordinate s: m;
    input u: N;
    kinetic = m/2*ṡ^2;
    force s = u;
    output hook: [m; 2] = [s, 0];
}

/// The eighth of a second in which `t` lies.
fn eighth(t: f64) -> u32 {
    (8.0 * t).floor() as u32
}

/// Advances a scene of 256 ticks a second to two seconds, and sets the inputs before each eighth.
fn two_seconds<T: Float>(scene: &mut Scene<T>, mut set: impl FnMut(&mut Scene<T>, u32)) {
    for part in 0..16 {
        set(scene, part);
        scene.advance_ticks(32);
    }
}

fn torque(pendulum: u32, eighth: u32) -> f64 {
    0.2 * (f64::from(pendulum) + 0.7 * f64::from(eighth)).sin()
}

#[test]
fn held_inputs_have_the_bits_of_a_sampled_controller() {
    let mut scene = Scene::<f64>::new(256.0).unwrap();
    scene.set_tolerance(1e-2).unwrap();
    let motors: Vec<(u32, Handle<Motor<f64>, 1>)> = (0..40)
        .map(|k| {
            let motor = Motor::new(0.3, 0.3 + 0.04 * f64::from(k));
            (k, scene.hang((), motor, [0.1 * f64::from(k)], [0.0]).unwrap())
        })
        .collect();
    two_seconds(&mut scene, |scene, part| {
        for &(k, motor) in &motors {
            scene.set_inputs(motor, torque(k, part)).unwrap();
        }
    });
    for &(k, motor) in &motors {
        let alone = scene.system(motor).sampled(0.125, move |t, _, _| torque(k, eighth(t)));
        let run = solve(&alone, (0.0, 2.0), [0.1 * f64::from(k)], [0.0]);
        let end = run.method(Rk4).steps(512).run().unwrap().end;
        assert_eq!(scene.state(motor), (end.q, end.v));
    }
}

/// Hangs pendulums that are blown on a joint that moves smoothly.
fn blown<T: Float>(scene: &mut Scene<T>) -> Vec<(u32, Handle<Blown<T>, 1>)> {
    let number = T::from_f64;
    let joint = scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
    let hang = |k: u32| {
        let blown = Blown::new(number(0.2), number(0.3 + 0.04 * f64::from(k)), number(0.01));
        (k, scene.hang(joint, blown, [number(0.1)], [number(0.0)]).unwrap())
    };
    (0..40).map(hang).collect()
}

fn wind<T: Real>(pendulum: u32, eighth: u32) -> ([T; 2], T) {
    let number = |by: f64| T::from_f64(torque(pendulum, eighth) + by);
    ([number(0.3), number(-0.1)], number(0.0))
}

#[test]
fn driven_and_control_inputs_have_the_bits_of_a_single_run() {
    fn same<T: Float>(mut scene: Scene<T>) {
        let zero = T::from_f64(0.0);
        let all = blown(&mut scene);
        two_seconds(&mut scene, |scene, part| {
            for &(k, pendulum) in &all {
                scene.set_inputs(pendulum, wind(k, part)).unwrap();
            }
        });
        for &(k, pendulum) in &all {
            let motion = Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]);
            let alone = scene.system(pendulum).driven_by(motion);
            let alone = alone.sampled(0.125, move |t, _, _| wind(k, eighth(t)));
            let run = solve(&alone, (0.0, 2.0), [T::from_f64(0.1)], [zero]);
            let end = run.method(Rk4).steps(512).run().unwrap().end;
            assert_eq!(scene.state(pendulum), (end.q, end.v));
        }
    }
    same(Scene::<f64>::new(256.0).unwrap());
    same(Scene::<f32>::new(256.0).unwrap());
}

#[test]
fn inputs_act_between_kinks_within_a_tick() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_tolerance(1e-9).unwrap();
    let times: Vec<f64> = (0..20).map(|key| f64::from(key) / 11.0).collect();
    let values: Vec<[f64; 2]> = (0..20).map(|key| [0.01 * f64::from(key % 3), 0.0]).collect();
    let keys = Curve::linear(&times, &values).unwrap();
    let joint = scene.joint(keys.clone());
    let pendulum = scene.hang(joint, Blown::new(0.2, 0.5, 0.01), [0.1], [0.0]).unwrap();
    scene.set_inputs(pendulum, ([0.3, 0.1], 0.2)).unwrap();
    scene.advance(1.5).unwrap();
    let alone = scene.system(pendulum).driven_by(keys).controlled_by(|_, _, _| ([0.3, 0.1], 0.2));
    let exact = solve(&alone, (0.0, 1.5), [0.1], [0.0]).rtol(1e-12).atol(1e-13).run().unwrap();
    let ([q], [v]) = scene.state(pendulum);
    assert!((q - exact.end.q[0]).abs() < 1e-8, "{q} for {}", exact.end.q[0]);
    assert!((v - exact.end.v[0]).abs() < 1e-7, "{v} for {}", exact.end.v[0]);
}

#[test]
fn threads_and_neighbours_change_no_bits() {
    let end = |always: bool, alone: Option<usize>| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        scene.set_always_fork(always);
        let mut all = blown(&mut scene);
        if let Some(alone) = alone {
            for (_, pendulum) in all.iter().filter(|(k, _)| *k as usize != alone) {
                scene.remove(*pendulum).unwrap();
            }
            all = vec![all[alone]];
        }
        two_seconds(&mut scene, |scene, part| {
            for &(k, pendulum) in &all {
                scene.set_inputs(pendulum, wind(k, part)).unwrap();
            }
        });
        all.iter().map(|&(_, pendulum)| scene.state(pendulum)).collect::<Vec<_>>()
    };
    let all = end(false, None);
    assert_eq!(end(true, None), all);
    assert_eq!(end(false, Some(37)), [all[37]]);
}

#[test]
fn snapshots_hold_inputs() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let all = blown(&mut scene);
    for &(k, pendulum) in &all {
        scene.set_inputs(pendulum, wind(k, 3)).unwrap();
    }
    scene.advance(0.3).unwrap();
    let (kept, checksum) = (scene.snapshot(), scene.checksum());
    scene.advance(0.3).unwrap();
    let after = scene.snapshot();
    scene.set_inputs(all[5].1, ([0.0; 2], 0.0)).unwrap();
    assert_ne!(scene.checksum(), after.checksum());
    scene.restore(&kept).unwrap();
    assert_eq!(scene.checksum(), checksum);
    scene.advance(0.3).unwrap();
    assert_eq!(scene.snapshot(), after);
    // Another scene that was built in the same way.
    let mut other = Scene::<f64>::new(240.0).unwrap();
    blown(&mut other);
    other.restore(&kept).unwrap();
    other.advance(0.3).unwrap();
    assert_eq!(other.snapshot(), after);
}

#[test]
fn inputs_are_zero_at_first_also_in_a_place_that_is_used_again() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let cart = scene.hang((), Cart::new(1.0), [0.0], [0.0]).unwrap();
    scene.advance(0.5).unwrap();
    assert_eq!(scene.state(cart), ([0.0], [0.0]));
    scene.set_inputs(cart, 2.0).unwrap();
    scene.advance(0.5).unwrap();
    let ([s], [v]) = scene.state(cart);
    assert!((s - 0.25).abs() < 1e-14 && (v - 1.0).abs() < 1e-14, "{s} {v}");
    scene.remove(cart).unwrap();
    let cart = scene.hang((), Cart::new(1.0), [0.0], [0.0]).unwrap();
    scene.advance(0.5).unwrap();
    assert_eq!(scene.state(cart), ([0.0], [0.0]));
}

#[test]
fn changes_of_other_things_keep_inputs() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let pendulum = scene.hang(joint, Blown::new(0.2, 0.5, 0.01), [0.1], [0.0]).unwrap();
    scene.set_inputs(pendulum, ([3.0, 4.0], 0.0)).unwrap();
    scene.set_parameter(pendulum, "L", 0.4).unwrap();
    scene.set_state(pendulum, [0.2], [0.0]).unwrap();
    scene.set_motion(joint, Still::new([1.0, 0.0]), Preserve::Swing).unwrap();
    scene.hide(pendulum).unwrap();
    scene.wake(pendulum).unwrap();
    scene.advance(0.1).unwrap();
    let seen = scene.observe(pendulum, 1.0);
    assert_eq!(seen.system.pull(seen.t, &seen.q, &seen.v, &seen.inputs), 5.0);
}

#[test]
fn other_inputs_wake_a_sleeper_and_equal_ones_do_not() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let pendulum = scene.hang(joint, Blown::new(0.2, 0.5, 0.2), [0.1], [0.0]).unwrap();
    scene.set_inputs(pendulum, ([0.5, 0.0], 0.1)).unwrap();
    scene.advance(20.0).unwrap();
    assert!(matches!(scene.status(pendulum), SceneStatus::Asleep(_)));
    // It sleeps where the forces of the inputs balance gravity.
    let ([q], _) = scene.state(pendulum);
    let force = 0.5 * (0.5 * q.cos()) + 0.1 - 0.2 * 9.81 * 0.5 * q.sin();
    assert!(force.abs() < 2e-3, "{force}");
    scene.set_inputs(pendulum, ([0.5, 0.0], 0.1)).unwrap();
    assert!(matches!(scene.status(pendulum), SceneStatus::Asleep(_)));
    scene.set_inputs(pendulum, ([0.5, 0.0], 0.0)).unwrap();
    assert_eq!(scene.status(pendulum), SceneStatus::Awake);
    scene.reset_to_rest(pendulum).unwrap();
    let ([q], _) = scene.state(pendulum);
    assert!((q.tan() - 0.5 / (0.2 * 9.81)).abs() < 1e-9, "{q}");
}

#[test]
fn values_that_are_not_finite_are_refused_by_name() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let pendulum = scene.hang(joint, Blown::new(0.2, 0.5, 0.01), [0.1], [0.0]).unwrap();
    scene.set_inputs(pendulum, ([1.0, 2.0], 3.0)).unwrap();
    let before = scene.snapshot();
    for (values, name, component) in [
        (([0.0, f64::NAN], 0.0), "wind", 1),
        (([f64::INFINITY, 0.0], 0.0), "wind", 0),
        (([0.0, 0.0], f64::NAN), "torque", 0),
    ] {
        let error = scene.set_inputs(pendulum, values).unwrap_err();
        let SceneError::Input { input, component: found, .. } = error else { panic!("{error}") };
        assert_eq!((input, found), (name, component));
        assert!(error.to_string().contains("give a finite number"), "{error}");
    }
    assert_eq!(scene.snapshot(), before);
    scene.remove(pendulum).unwrap();
    let gone = scene.set_inputs(pendulum, ([0.0; 2], 0.0));
    assert!(matches!(gone, Err(SceneError::Pendulum { .. })), "{gone:?}");
}

#[test]
fn a_carried_joint_has_the_acceleration_that_an_input_causes() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let cart = scene.hang((), Cart::new(2.0), [0.0], [0.0]).unwrap();
    let hook = scene.joint_on::<_, 1, 2>(cart, "hook").unwrap();
    scene.set_inputs(cart, 6.0).unwrap();
    // The cart moves by 3/2 t².
    let ramp = Function::new(|t: f64| [1.5 * t * t, 0.0])
        .velocity(|t| [3.0 * t, 0.0])
        .acceleration(|_| [3.0, 0.0]);
    let ramp = scene.joint(ramp);
    let carried = scene.hang(hook, Hanging::new(0.1, 0.3), [0.0], [0.0]).unwrap();
    let driven = scene.hang(ramp, Hanging::new(0.1, 0.3), [0.0], [0.0]).unwrap();
    scene.advance(1.0).unwrap();
    let ([a], [b]) = (scene.state(carried).0, scene.state(driven).0);
    assert!(0.01 < b.abs() && (a - b).abs() < 1e-9, "{a} for {b}");
}

#[test]
fn an_output_of_an_input_carries_no_joint() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let pendulum = scene.hang(joint, Blown::new(0.2, 0.5, 0.01), [0.1], [0.0]).unwrap();
    scene.joint_on::<_, 1, 2>(pendulum, "tip").unwrap();
    let refused = scene.joint_on::<_, 1, 2>(pendulum, "pushed").unwrap_err();
    assert!(refused.to_string().contains("independent of velocities and control inputs"));
}

#[test]
fn a_feedback_law_between_ticks_is_a_sampled_controller() {
    let mut scene = Scene::<f64>::new(256.0).unwrap();
    let law = |q: f64, v: f64| -3.0 * (q - 0.5) - v;
    let motor = scene.hang((), Motor::new(0.3, 0.5), [0.1], [0.0]).unwrap();
    for _ in 0..512 {
        let ([q], [v]) = scene.state(motor);
        scene.set_inputs(motor, law(q, v)).unwrap();
        scene.advance_ticks(1);
    }
    let alone = scene.system(motor).sampled(1.0 / 256.0, move |_, q, v| law(q[0], v[0]));
    let run = solve(&alone, (0.0, 2.0), [0.1], [0.0]).method(Rk4).steps(512).run().unwrap();
    assert_eq!(scene.state(motor), (run.end.q, run.end.v));
}
