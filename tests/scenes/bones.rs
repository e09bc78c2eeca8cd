//! The bone that scenes provide: its settings, its state of rest and its small swings.

use core::f64::consts::TAU;
use pendulum_runtime::motion::{Curve, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Bone, Handle, Scene, SceneError, VrmSpring};

const REST: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

fn length(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A scene of 120 ticks a second with a bone on a frame at rest.
fn still(bone: Bone, frame: Attitude, start: Attitude) -> (Scene<f64>, Handle<Bone, 4>) {
    let mut scene = Scene::new(120.0).unwrap();
    scene.set_tolerance(1e-7).unwrap();
    let joints =
        (scene.joint(Still::new([0.3, 0.1, 0.2])), scene.joint(Still::new(frame.to_quaternion())));
    let bone = scene.hang(joints, bone, start.to_quaternion(), [0.0; 4]).unwrap();
    (scene, bone)
}

/// The direction of a bone.
fn direction(scene: &Scene<f64>, bone: Handle<Bone, 4>) -> [f64; 3] {
    Attitude::from_quaternion(scene.state(bone).0) * [0.0, 1.0, 0.0]
}

/// The direction in which a tail of the specification `VRMC_springBone` comes to rest, by its
/// formula at 60 frames a second.
fn fixed_point_of_vrm(spring: &VrmSpring, length_of_bone: f64, axis: [f64; 3]) -> [f64; 3] {
    let (dt, mut current, mut previous) = (1.0 / 60.0, axis, axis);
    current = current.map(|x| x * length_of_bone);
    previous = previous.map(|x| x * length_of_bone);
    for _ in 0..20_000 {
        let next: [f64; 3] = core::array::from_fn(|i| {
            let inertia = (current[i] - previous[i]) * (1.0 - spring.drag_force);
            let external = dt * spring.gravity_power * spring.gravity_dir[i];
            current[i] + inertia + dt * spring.stiffness * axis[i] + external
        });
        let scale = length_of_bone / length(next);
        (previous, current) = (current, next.map(|x| scale * x));
    }
    current.map(|x| x / length_of_bone)
}

#[test]
fn a_bone_rests_where_the_formula_of_vrm_rests() {
    let frame = Attitude::from_axis_angle([0.3, 0.5, -1.0], 1.1);
    let axis = frame * [0.0, 1.0, 0.0];
    for gravity_power in [0.0, 0.1, 0.5, 1.0, 3.0] {
        let spring = VrmSpring { stiffness: 0.8, gravity_power, ..VrmSpring::default() };
        let (mut scene, bone) = still(spring.bone(0.2).unwrap(), frame, frame);
        scene.reset_to_rest(bone).unwrap();
        let (ours, theirs) = (direction(&scene, bone), fixed_point_of_vrm(&spring, 0.2, axis));
        let apart = length(core::array::from_fn(|i| ours[i] - theirs[i]));
        assert!(apart < 1e-6, "{gravity_power}: {ours:?} {theirs:?}");
    }
}

#[test]
fn a_bone_that_is_let_go_comes_to_the_same_rest() {
    let frame = Attitude::from_axis_angle([1.0, 0.0, 0.2], 1.3);
    let settings = Bone::swinging(0.1, 3.0, 0.9).unwrap().under([0.0, -9.81, 0.0]);
    let (mut scene, bone) = still(settings, frame, Attitude::from_axis_angle([0.0, 0.3, 1.0], 0.4));
    scene.advance(1.5).unwrap();
    let swung = scene.state(bone).0;
    scene.reset_to_rest(bone).unwrap();
    let rest = scene.state(bone).0;
    assert!((0..4).all(|i| (swung[i] - rest[i]).abs() < 1e-8), "{swung:?} {rest:?}");
}

/// The angle of a bone about the axis x of its frame after `t` in a small swing from `start`, with
/// the angular frequency `omega` without damping and half the damping `decay`.
fn swing(start: f64, omega: f64, decay: f64, t: f64) -> f64 {
    let damped = (omega * omega - decay * decay).sqrt();
    start * (-decay * t).exp() * ((damped * t).cos() + decay / damped * (damped * t).sin())
}

#[test]
fn small_swings_have_the_frequency_and_the_ratio_of_the_settings() {
    let start = 2e-4;
    for (frequency, ratio) in [(2.0, 0.05), (4.0, 0.3), (8.0, 0.9)] {
        // About an axis that swings the bone, and about the bone itself.
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            let settings = Bone::swinging(0.1, frequency, ratio).unwrap();
            let turned = Attitude::from_axis_angle(axis, start);
            let (mut scene, bone) = still(settings, Attitude::identity(), turned);
            for tick in 1..=30 {
                scene.advance_ticks(1);
                let q = scene.state(bone).0;
                let angle = 2.0 * (axis[0] * q[1] + axis[1] * q[2]);
                let omega = TAU * frequency;
                let exact = swing(start, omega, ratio * omega, f64::from(tick) / 120.0);
                assert!((angle - exact).abs() < 1e-5 * start, "{frequency}: {angle} {exact}");
            }
        }
    }
}

#[test]
fn gravity_adds_to_the_spring() {
    let (frequency, start, length) = (1.0, 2e-4, 0.3);
    for gravity in [-9.81, 9.81] {
        let settings = Bone::swinging(length, frequency, 0.0).unwrap().under([0.0, gravity, 0.0]);
        let (turned, up) = (Attitude::from_axis_angle([1.0, 0.0, 0.0], start), TAU * frequency);
        let (mut scene, bone) = still(settings, Attitude::identity(), turned);
        scene.advance(0.1).unwrap();
        let angle = 2.0 * scene.state(bone).0[1];
        let square = up * up + gravity / length;
        let exact = if 0.0 < square {
            (0.1 * square.sqrt()).cos()
        } else {
            (0.1 * (-square).sqrt()).cosh()
        };
        assert!((angle - start * exact).abs() < 1e-6 * start, "{angle} {exact}");
    }
}

#[test]
fn after_a_hundred_turns_of_the_parent_nothing_is_twisted() {
    let mut scene = Scene::new(60.0).unwrap();
    let angle = Curve::clamped(&[0.0, 6.0], &[[0.0], [100.0 * TAU]], [0.0], [0.0]).unwrap();
    let joints =
        (scene.joint(Still::new([0.0; 3])), scene.joint(Turning::new([0.0, 1.0, 0.0], angle)));
    let bone = scene.hang(joints, Bone::swinging(0.1, 2.0, 0.6).unwrap(), REST, [0.0; 4]).unwrap();
    scene.advance(9.0).unwrap();
    let q = scene.state(bone).0;
    let twist = 2.0 * q[2].atan2(q[0]);
    assert!(twist.sin().abs() < 1e-6 && 0.0 < twist.cos(), "{twist:e}");
}

#[test]
fn a_bone_follows_a_parent_that_turns_steadily_without_lag() {
    let mut scene = Scene::new(60.0).unwrap();
    let angle = Curve::linear(&[0.0, 10.0], &[[0.0], [20.0]]).unwrap();
    let parent = Turning::new([0.0, 1.0, 0.0], angle);
    let joints = (scene.joint(Still::new([0.0; 3])), scene.joint(parent));
    let bone = scene.hang(joints, Bone::swinging(0.1, 2.0, 0.6).unwrap(), REST, [0.0; 4]).unwrap();
    scene.advance(4.0).unwrap();
    let [w, _, y, _] = scene.state(bone).0;
    assert!((2.0 * y.atan2(w) - 8.0).sin().abs() < 1e-6);
}

#[test]
fn a_frame_aside_of_a_tip_moves_and_turns_with_the_bone() {
    let aside = [0.1, -0.2, 0.05];
    let start = |rate: f64| {
        let mut scene = Scene::<f64>::new(rate).unwrap();
        scene.set_tolerance(1e-7).unwrap();
        let place = scene.joint(Sinusoid::new([0.05, 0.0, 0.02], 9.0, [0.0; 3]));
        let turn = scene.joint(Turning::new([0.3, 1.0, 0.0], Sinusoid::new([0.5], 7.0, [0.0])));
        let start = scene.joint_pose(turn, 1.0);
        let bone = Bone::swinging(0.1, 2.0, 0.2).unwrap();
        let bone = scene.hang((place, turn), bone, start, [0.0; 4]).unwrap();
        let frame = scene.frame_on(bone, ["tip", "turn"], aside, Attitude::identity()).unwrap();
        (scene, bone, frame)
    };
    let ((mut scene, bone, frame), (mut fine, _, exact)) = (start(120.0), start(240.0));
    for _ in 0..15 {
        scene.advance_ticks(1);
        let seen = scene.observe(bone, 1.0);
        let tip = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
        let off = Attitude::from_quaternion(seen.q) * aside;
        let place = scene.joint_pose(frame.0, 1.0);
        assert!((0..3).all(|i| (place[i] - tip[i] - off[i]).abs() < 1e-12), "{place:?}");
        // In the middle of a tick it is where velocities and accelerations lead it.
        fine.advance_ticks(1);
        let (middle, exact) = (scene.joint_pose(frame.0, 0.5), fine.joint_pose(exact.0, 1.0));
        assert!((0..3).all(|i| (middle[i] - exact[i]).abs() < 5e-7), "{middle:?} {exact:?}");
        fine.advance_ticks(1);
    }
    let nowhere = [f64::NAN, 0.0, 0.0];
    assert!(scene.frame_on(bone, ["tip", "turn"], nowhere, Attitude::identity()).is_err());
}

#[test]
fn settings_of_vrm_become_accelerations_at_their_frame_rate() {
    let spring =
        VrmSpring { stiffness: 0.7, gravity_power: 0.2, drag_force: 0.4, ..VrmSpring::default() };
    let bone: Bone = spring.bone(0.2).unwrap();
    assert_eq!((bone.stiffness, bone.damping), (60.0 * 0.7 / 0.2, 60.0 * 0.4));
    assert_eq!(bone.gravity, [0.0, -60.0 * 0.2, 0.0]);
    let bone: Bone = VrmSpring { frame_rate: 30.0, ..spring }.bone(0.2).unwrap();
    assert_eq!((bone.stiffness, bone.damping), (30.0 * 0.7 / 0.2, 30.0 * 0.4));
}

#[test]
fn settings_that_make_no_bone_are_refused_by_name() {
    let name = |bone: Result<Bone<f32>, SceneError>| match bone {
        Err(SceneError::Setting { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(name(Bone::swinging(bad, 1.0, 0.3)), "length");
        assert_eq!(name(Bone::swinging(0.1, bad, 0.3)), "frequency");
        assert_eq!(name(VrmSpring::default().bone(bad)), "length");
        assert_eq!(
            name(VrmSpring { frame_rate: bad, ..VrmSpring::default() }.bone(0.1)),
            "frameRate"
        );
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(name(Bone::swinging(0.1, 1.0, bad)), "ratio");
        assert_eq!(
            name(VrmSpring { stiffness: bad, ..VrmSpring::default() }.bone(0.1)),
            "stiffness"
        );
        assert_eq!(
            name(VrmSpring { drag_force: bad, ..VrmSpring::default() }.bone(0.1)),
            "dragForce"
        );
    }
    let heavy = VrmSpring { gravity_power: f64::INFINITY, ..VrmSpring::default() };
    assert_eq!(name(heavy.bone(0.1)), "gravity");
    // What is finite in `f64` but not in `f32`.
    assert_eq!(name(Bone::swinging(0.1, 1e30, 0.3)), "stiffness");
    assert_eq!(name(Bone::swinging(1e-60, 1.0, 0.3)), "1/length");
}
