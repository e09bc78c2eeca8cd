//! Refusals of scenes: pendulums that are too fast, invalid masses, and handles and joints of other
//! scenes.

use pendulum_runtime::integrate::Leapfrog;
use pendulum_runtime::motion::Still;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Handle, Preserve, Scene, SceneError, Stop};
use std::f64::consts::TAU;
use systems::pendulums::Hanging;

lagrangian! {
    /// A mass on a spring with a dashpot.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Damped { m: kg, k: N/m, c: kg/s, #[allow(unused)] g: m/s^2 = 9.81 }
    coordinate u: m;
    kinetic = m/2 * u_dot^2;
    potential = k/2 * u^2;
    dissipation = c/2 * u_dot^2;
}

lagrangian! {
    /// A mass on a spring.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sprung { m: kg, k: N/m, #[allow(unused)] g: m/s^2 = 9.81 }
    coordinate u: m;
    kinetic = m/2 * u_dot^2;
    potential = k/2 * u^2;
}

lagrangian! {
    /// A bob on a rod, in absolute coordinates.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    driven p: [m; 2];
    kinetic = m/2*(x_dot^2 + y_dot^2);
    potential = m*g*y;
    constraint rod: |[x, y] - p| = L;
}

const FREQUENCIES: [f64; 3] = [20.3, 200.3, 2000.3];

/// A pendulum either keeps the tolerance of the scene or is refused. The test compares a spring of
/// up to 2 kHz at sixty ticks a second with its closed form.
#[test]
fn fast_springs_are_right_or_refused() {
    let (mut right, mut refused) = (0, 0);
    for frequency in FREQUENCIES {
        for exponent in [2, 3, 5, 7, 9, 12] {
            let (omega, tolerance) = (TAU * frequency, 10f64.powi(-exponent));
            let mut scene = Scene::<f64>::new(60.0).unwrap();
            scene.set_tolerance(tolerance).unwrap();
            // The phase after a quarter of a second is `omega`/4 radians.
            let bound = (1.5 * tolerance * omega / 4.0).min(2.0) + 1e-10;
            match scene.hang((), Sprung::new(0.1, 0.1 * omega * omega), [1.0], [0.0]) {
                Ok(spring) => {
                    scene.advance(0.25).unwrap();
                    let ([u], _) = scene.state(spring);
                    let expected = (omega / 4.0).cos();
                    assert!(
                        (u - expected).abs() < bound,
                        "{frequency} Hz, {tolerance}: {u} for {expected}"
                    );
                    right += 1;
                }
                Err(SceneError::Frequency { frequency: found, .. }) => {
                    assert!((found / omega - 1.0).abs() < 1e-6);
                    refused += 1;
                }
                Err(error) => panic!("{error}"),
            }
            // RK4 is the method because of the dashpot.
            let decay = 0.7;
            let damped = Damped::new(0.1, 0.1 * (omega * omega + decay * decay), 0.2 * decay);
            match scene.hang((), damped, [1.0], [-decay]) {
                Ok(spring) => {
                    let start = scene.time();
                    scene.advance(0.25).unwrap();
                    assert_eq!(scene.time() - start, 0.25);
                    let ([u], _) = scene.state(spring);
                    let expected = (-0.25 * decay).exp() * (omega / 4.0).cos();
                    assert!(
                        (u - expected).abs() < bound && u.abs() < 1.0,
                        "{frequency} Hz, {tolerance}: {u} for {expected}"
                    );
                    right += 1;
                }
                Err(SceneError::Frequency { .. }) => refused += 1,
                Err(error) => panic!("{error}"),
            }
        }
    }
    assert!(12 < right && 8 < refused, "{right} right, {refused} refused");
}

#[test]
fn what_makes_a_pendulum_too_fast_is_refused_and_changes_nothing() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let refused = scene.hang((), Sprung::new(0.1, 1e15), [1.0], [0.0]);
    let message = refused.unwrap_err().to_string();
    assert!(
        message
            .starts_with("`Sprung` 0 swings with 1.000e8 rad/s, which takes more than 1024 steps")
            && message.contains("put a rod in place of a stiff spring"),
        "{message}"
    );
    // The refused pendulum leaves no trace: the snapshot of an empty scene still fits.
    let empty = Scene::<f64>::new(60.0).unwrap().snapshot();
    scene.restore(&empty).unwrap();
    let spring = scene.hang((), Sprung::new(0.1, 1e3), [1.0], [0.0]).unwrap();
    scene.hang((), Sprung::new(0.1, 1e3), [0.5], [0.0]).unwrap();
    scene.advance(0.1).unwrap();
    let before = scene.snapshot();
    let fast = |done: Result<(), SceneError>| {
        assert!(matches!(done, Err(SceneError::Frequency { index: 0, .. })), "{done:?}");
    };
    fast(scene.set_parameter(spring, "k", 1e15));
    fast(scene.set_parameter_everywhere("m", 1e-13).map(drop));
    fast(scene.set_limits(spring, [-1.0], [1.0], Stop::Soft { stiffness: 1e18 }));
    assert_eq!(scene.snapshot(), before);
    // At 2 kHz and this tolerance, SRKN6b is possible and leapfrog is not.
    scene.set_tolerance(1e-5).unwrap();
    scene.hang((), Sprung::new(0.1, 0.1 * (TAU * 2000.0).powi(2)), [1.0], [0.0]).unwrap();
    let before = scene.snapshot();
    let leapfrog = scene.set_method::<Sprung, 1, _>(Leapfrog);
    assert!(matches!(leapfrog, Err(SceneError::Frequency { index: 2, .. })), "{leapfrog:?}");
    assert_eq!(scene.snapshot(), before);
}

#[test]
fn negative_masses_are_refused() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let negative = |done: Result<(), SceneError>| {
        let message = done.unwrap_err().to_string();
        assert!(
            message.contains("is negative, -0.1; check parameter `m`, which is -0.1"),
            "{message}"
        );
    };
    negative(scene.hang(joint, Hanging::new(-0.1, 1.0), [0.0], [0.0]).map(drop));
    negative(scene.hang(joint, Bob::new(-0.1, 1.0), [0.0, -1.0], [0.0, 0.0]).map(drop));
    let hanging = scene.hang(joint, Hanging::new(0.1, 1.0), [0.0], [0.0]).unwrap();
    let bob = scene.hang(joint, Bob::new(0.1, 1.0), [0.0, -1.0], [0.0, 0.0]).unwrap();
    let before = scene.snapshot();
    negative(scene.set_parameter(hanging, "m", -0.1));
    negative(scene.set_parameter(bob, "m", -0.1));
    negative(scene.set_parameter_everywhere("m", -0.1).map(drop));
    assert_eq!(scene.snapshot(), before);
}

/// Compares two equal scenes, so that every number of one scene also exists in the other.
#[test]
fn handles_and_joints_of_another_scene_are_refused() {
    let build = || {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joint = scene.joint(Still::new([0.0, 0.0]));
        let hanging = scene.hang(joint, Hanging::new(0.1, 1.0), [0.3], [0.0]).unwrap();
        (scene, joint, hanging)
    };
    let ((mut scene, ..), (other, joint, hanging)) = (build(), build());
    let before = scene.snapshot();
    let pendulum: Result<(), _> = Err(SceneError::Pendulum { kind: "Hanging", index: 0 });
    assert_eq!(scene.set_parameter(hanging, "L", 2.0), pendulum);
    assert_eq!(scene.set_damping(hanging, 2.0), pendulum);
    assert_eq!(scene.set_state(hanging, [0.0], [0.0]), pendulum);
    assert_eq!(scene.set_limits(hanging, [0.0], [0.0], Stop::Soft { stiffness: 1.0 }), pendulum);
    assert_eq!(scene.mirror(hanging, [-1.0]), pendulum);
    assert_eq!(scene.reset_to_rest(hanging), pendulum);
    assert_eq!(scene.wake(hanging), pendulum);
    assert_eq!(scene.hide(hanging), pendulum);
    assert_eq!(scene.bake(&[hanging], 3, 0.0).map(drop), pendulum);
    let refused = scene.hang(joint, Hanging::new(0.1, 1.0), [0.0], [0.0]);
    assert_eq!(refused.map(drop), Err(SceneError::Joint(0)));
    let refused = scene.set_motion(joint, Still::new([1.0, 0.0]), Preserve::Swing);
    assert_eq!(refused, Err(SceneError::Joint(0)));
    assert_eq!(scene.snapshot(), before);
    // The handle with the same number in this scene.
    let own: Handle<Hanging<f64>, 1> = scene.handle(0).unwrap();
    assert!(own != hanging && own.index() == hanging.index());
    assert_eq!(scene.state(own), other.state(hanging));
    assert_eq!(scene.handle::<Hanging<f64>, 1>(1), None);
}

#[test]
#[should_panic(expected = "`Hanging` 0 is not in this scene")]
fn reading_a_pendulum_of_another_scene_panics() {
    let mut other = Scene::<f64>::new(240.0).unwrap();
    let joint = other.joint(Still::new([0.0, 0.0]));
    let hanging = other.hang(joint, Hanging::new(0.1, 1.0), [0.3], [0.0]).unwrap();
    let _ = Scene::<f64>::new(240.0).unwrap().state(hanging);
}

#[test]
fn parameters_that_are_not_there_are_answered_by_those_that_are() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let spring = scene.hang((), Sprung::new(0.1, 1e3), [1.0], [0.0]).unwrap();
    let message = |done: Result<(), SceneError>| done.unwrap_err().to_string();
    let expected = "there is no parameter `l`; there are `m`, `k`, `g`";
    assert_eq!(message(scene.set_parameter(spring, "l", 1.0)), expected);
    let expected = "there is no parameter `l`; there are `g`, `k`, `m`";
    assert_eq!(message(scene.set_parameter_everywhere("l", 1.0).map(drop)), expected);
    let expected = "parameter `k` cannot be NaN; give a finite number";
    assert_eq!(message(scene.set_parameter(spring, "k", f64::NAN)), expected);
}
