//! Joints that the program moves while the scene runs.

use pendulum_runtime::motion::{Function, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Handle, Joint, Live, Resume, Scene, SceneError, SceneStatus};
use std::f64::consts::TAU;

use systems::pendulums::{Double, Hanging};
use systems::random::Random;

lagrangian! {
    /// A bone that springs back.
    #[derive(Clone, Debug)]
    pub struct Bone { m: kg, L: m, k: N*m/rad, c: N*m*s/rad }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = k/2*θ^2;
    dissipation = c/2*θ̇^2;
}

lagrangian! {
    /// A bob on a rod, in coordinates relative to its joint.
    #[derive(Clone, Debug)]
    pub struct Rod { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate u: m;
    coordinate w: m;
    driven x: [m; 2];
    let y = x + [u, w];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
    constraint rod: u^2 + w^2 = L^2;
}

const FRAME: f64 = 1.0 / 64.0;

/// A scene with four ticks a frame and a pendulum on a live joint, which is where it was told to be
/// last.
fn hung() -> (Scene<f64>, Joint<2>, Handle<Hanging<f64>, 1>) {
    let mut scene = Scene::new(256.0).unwrap();
    let joint = scene.live([0.0, 0.0]).unwrap();
    scene.teleport(joint, [0.0, 0.0]).unwrap();
    let pendulum = scene.hang(joint, Hanging::new(0.1, 0.3), [0.2], [0.1]).unwrap();
    (scene, joint, pendulum)
}

fn hand(t: f64) -> [f64; 2] {
    [0.05 * (4.0 * t).sin(), 0.02 * (7.0 * t).sin()]
}

/// Moves a joint by hand for some frames from `begin` on.
fn shake(scene: &mut Scene<f64>, joint: Joint<2>, begin: u32, frames: u32) {
    for frame in begin..begin + frames {
        scene.move_to(joint, hand(FRAME * f64::from(frame + 1))).unwrap();
        assert_eq!(scene.advance(FRAME).unwrap().jumped, 0);
    }
}

#[test]
fn at_the_end_of_a_frame_the_joint_is_exactly_where_it_was_told() {
    let (mut scene, joint, _) = hung();
    for frame in 1..50 {
        let told = hand(FRAME * f64::from(frame));
        scene.move_to(joint, told).unwrap();
        if frame % 2 == 0 {
            scene.advance(FRAME).unwrap();
        } else {
            scene.advance_ticks(4);
        }
        assert_eq!(scene.joint_pose(joint, 1.0), told);
    }
}

#[test]
fn the_last_position_before_a_frame_counts() {
    let (mut one, joint, _) = hung();
    let (mut other, other_joint, _) = hung();
    for frame in 1..20 {
        let told = hand(FRAME * f64::from(frame));
        one.move_to(joint, told).unwrap();
        for wrong in [[1.0, 2.0], [-3.0, 0.0], told] {
            other.move_to(other_joint, wrong).unwrap();
        }
        for scene in [&mut one, &mut other] {
            scene.advance(FRAME).unwrap();
        }
    }
    assert_eq!(one.checksum(), other.checksum());
}

#[test]
fn a_frame_without_a_tick_only_replaces_the_position() {
    let (mut one, joint, _) = hung();
    let (mut other, other_joint, _) = hung();
    for frame in 1..20 {
        let told = hand(FRAME * f64::from(frame));
        one.move_to(joint, told).unwrap();
        one.advance(FRAME).unwrap();
        other.move_to(other_joint, [1.0, 1.0]).unwrap();
        assert_eq!(other.advance(FRAME / 8.0).unwrap().ticks, 0);
        other.move_to(other_joint, told).unwrap();
        other.advance(FRAME * 7.0 / 8.0).unwrap();
    }
    assert_eq!(one.checksum(), other.checksum());
}

#[test]
fn a_joint_that_is_not_told_in_a_frame_rests_after_it() {
    let (mut scene, joint, _) = hung();
    shake(&mut scene, joint, 0, 10);
    let told = scene.joint_pose(joint, 1.0);
    scene.advance(FRAME).unwrap();
    assert_eq!(scene.joint_pose(joint, 1.0), told);
    assert_ne!(scene.joint_pose(joint, 0.5), told);
    scene.advance(FRAME).unwrap();
    assert_eq!(scene.joint_pose(joint, 0.5), told);
}

#[test]
fn the_first_position_is_a_jump_that_is_not_felt() {
    let mut scene = Scene::<f64>::new(256.0).unwrap();
    let joint = scene.live([0.0, 0.0]).unwrap();
    let pendulum = scene.hang(joint, Hanging::new(0.1, 0.3), [0.2], [0.1]).unwrap();
    scene.advance(FRAME).unwrap();
    scene.move_to(joint, [5.0, 1.0]).unwrap();
    assert_eq!(scene.advance(FRAME).unwrap().jumped, 1);
    assert_eq!(scene.joint_pose(joint, 0.0), [5.0, 1.0]);
    let (mut still, _, calm) = hung();
    still.advance(2.0 * FRAME).unwrap();
    assert_eq!(scene.state(pendulum), still.state(calm));
}

#[test]
fn a_jump_in_a_frame_with_dropped_time_is_not_felt() {
    let (mut scene, joint, pendulum) = hung();
    scene.set_longest_frame(FRAME).unwrap();
    scene.move_to(joint, [5.0, 1.0]).unwrap();
    let advanced = scene.advance(2.0).unwrap();
    assert_eq!((advanced.dropped, advanced.jumped), (2.0 - FRAME, 1));
    let (mut still, _, calm) = hung();
    still.advance(FRAME).unwrap();
    assert_eq!(scene.state(pendulum), still.state(calm));
}

#[test]
fn a_jump_during_a_pause_is_not_felt_and_a_motion_that_goes_on_is() {
    let (mut scene, joint, pendulum) = hung();
    let (mut unpaused, other, swinging) = hung();
    for (scene, joint) in [(&mut scene, joint), (&mut unpaused, other)] {
        shake(scene, joint, 0, 10);
    }
    let pause = |scene: &mut Scene<f64>| {
        scene.set_paused(true);
        scene.advance(1.0).unwrap();
        scene.set_paused(false);
    };
    pause(&mut scene);
    for (scene, joint) in [(&mut scene, joint), (&mut unpaused, other)] {
        shake(scene, joint, 10, 10);
    }
    assert_eq!(scene.state(pendulum), unpaused.state(swinging));

    pause(&mut scene);
    scene.move_to(joint, [5.0, 1.0]).unwrap();
    assert_eq!(scene.advance(FRAME).unwrap().jumped, 1);
    unpaused.teleport(other, [5.0, 1.0]).unwrap();
    unpaused.advance(FRAME).unwrap();
    assert_eq!(scene.state(pendulum), unpaused.state(swinging));
}

#[test]
fn a_teleport_is_not_felt() {
    let (mut scene, joint, pendulum) = hung();
    shake(&mut scene, joint, 0, 10);
    let before = scene.state(pendulum);
    scene.move_to(joint, [9.0, 9.0]).unwrap();
    scene.teleport(joint, [5.0, 1.0]).unwrap();
    assert_eq!(scene.state(pendulum), before);
    scene.advance(FRAME).unwrap();
    assert_eq!([0.0, 0.3, 1.0].map(|part| scene.joint_pose(joint, part)), [[5.0, 1.0]; 3]);
    // It swings as on a joint at rest.
    let mut still = Scene::<f64>::new(256.0).unwrap();
    let hook = still.joint(Still::new([0.0, 0.0]));
    let calm = still.hang(hook, Hanging::new(0.1, 0.3), before.0, before.1).unwrap();
    still.advance(FRAME).unwrap();
    let apart = scene.state(pendulum).0[0] - still.state(calm).0[0];
    assert!(apart.abs() < 1e-15, "{apart}");
}

#[test]
fn jumps_keep_constraints() {
    let mut scene = Scene::<f64>::new(256.0).unwrap();
    let joint = scene.live([0.0, 0.0]).unwrap();
    let bob = scene.hang(joint, Rod::new(1.0, 0.5), [0.3, -0.4], [0.4, 0.3]).unwrap();
    scene.move_to(joint, [7.0, 0.0]).unwrap();
    assert_eq!(scene.advance(FRAME).unwrap().jumped, 1);
    scene.teleport(joint, [-7.0, 0.0]).unwrap();
    shake(&mut scene, joint, 0, 0);
    for frame in 1..60 {
        let [x, y] = hand(FRAME * f64::from(frame));
        scene.move_to(joint, [x - 7.0, y]).unwrap();
        assert_eq!(scene.advance(FRAME).unwrap().failed, 0);
        let [u, w] = scene.state(bob).0;
        assert!((u.hypot(w) - 0.5).abs() < 1e-15);
    }
}

#[test]
fn snapshots_hold_the_positions() {
    let (mut scene, joint, _) = hung();
    shake(&mut scene, joint, 0, 10);
    // In the middle of a tick, and with a position for a frame that has not come.
    scene.move_to(joint, hand(FRAME * 10.6)).unwrap();
    scene.advance(0.6 * FRAME).unwrap();
    scene.move_to(joint, hand(FRAME * 10.8)).unwrap();
    let snapshot = scene.snapshot();
    let go_on = |scene: &mut Scene<f64>| {
        scene.advance(0.2 * FRAME).unwrap();
        shake(scene, joint, 11, 10);
        (scene.checksum(), scene.joint_pose(joint, 0.7))
    };
    let end = go_on(&mut scene);
    scene.move_to(joint, [1.0, 1.0]).unwrap();
    scene.restore(&snapshot).unwrap();
    assert_eq!(scene.snapshot(), snapshot);
    assert_eq!(go_on(&mut scene), end);
    scene.live([0.0]).unwrap();
    assert!(matches!(scene.restore(&snapshot), Err(SceneError::Snapshot(_))));
}

#[test]
fn baking_and_loops_leave_live_joints_alone() {
    let (mut scene, joint, pendulum) = hung();
    let (mut other, other_joint, _) = hung();
    for (scene, joint) in [(&mut scene, joint), (&mut other, other_joint)] {
        shake(scene, joint, 0, 10);
    }
    scene.bake(&[pendulum], 20, 1e-3).unwrap();
    for (scene, joint) in [(&mut scene, joint), (&mut other, other_joint)] {
        shake(scene, joint, 10, 10);
    }
    assert_eq!(scene.checksum(), other.checksum());
    let told = scene.joint_pose(joint, 1.0);
    scene.warm_up(1.0).unwrap();
    assert_eq!(scene.joint_pose(joint, 1.0), told);
    scene.close_loop(16, 2, 1e-3).unwrap();
    assert_eq!(scene.joint_pose(joint, 1.0), told);
}

#[test]
fn what_hangs_on_a_resting_joint_sleeps_until_it_moves() {
    let (mut scene, joint, pendulum) = hung();
    scene.set_damping(pendulum, 20.0).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    shake(&mut scene, joint, 0, 3);
    let told = scene.joint_pose(joint, 1.0);
    for _ in 0..200 {
        scene.move_to(joint, told).unwrap();
        scene.advance(FRAME).unwrap();
    }
    assert_eq!(scene.status(pendulum), SceneStatus::Asleep(i64::MAX));
    let asleep = scene.state(pendulum);
    scene.move_to(joint, [told[0] + 0.1, told[1]]).unwrap();
    scene.advance(FRAME).unwrap();
    assert_eq!(scene.status(pendulum), SceneStatus::Awake);
    assert_ne!(scene.state(pendulum), asleep);
}

#[test]
fn a_sleeping_pendulum_wakes_in_the_tick_in_which_its_joint_moves() {
    let (mut scene, joint, pendulum) = hung();
    let (mut awake, other, swinging) = hung();
    for (scene, joint, pendulum) in [(&mut scene, joint, pendulum), (&mut awake, other, swinging)] {
        scene.reset_to_rest(pendulum).unwrap();
        scene.advance(1.0).unwrap();
        scene.move_to(joint, [0.1, 0.0]).unwrap();
    }
    scene.set_sleep(Some(1e-3)).unwrap();
    scene.advance_ticks(32);
    awake.advance_ticks(32);
    assert_eq!(scene.state(pendulum), awake.state(swinging));
}

#[test]
fn positions_that_are_no_numbers_are_refused_and_change_nothing() {
    let (mut scene, joint, _) = hung();
    shake(&mut scene, joint, 0, 5);
    scene.move_to(joint, hand(FRAME * 6.0)).unwrap();
    let before = scene.snapshot();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let message = scene.move_to(joint, [0.0, bad]).unwrap_err().to_string();
        assert_eq!(
            message,
            format!("component 1 of the position of joint 0 is {bad:?}; give a finite number")
        );
        assert!(scene.teleport(joint, [bad, 0.0]).is_err() && scene.live([bad]).is_err());
    }
    assert_eq!(format!("{before:?}"), format!("{:?}", scene.snapshot()));
}

#[test]
fn joints_that_follow_a_motion_are_not_moved() {
    let (mut scene, live, _) = hung();
    let prescribed = scene.joint(Sinusoid::new([0.1, 0.0], 1.0, [0.0, 0.0]));
    for refused in [scene.move_to(prescribed, [0.0, 0.0]), scene.teleport(prescribed, [0.0, 0.0])] {
        let error = refused.unwrap_err();
        assert_eq!(error, SceneError::NotLive(1));
        assert!(error.to_string().contains("`live`"), "{error}");
    }
    let mut other = Scene::<f64>::new(240.0).unwrap();
    assert_eq!(other.move_to(live, [0.0, 0.0]), Err(SceneError::Joint(0)));
    // A live joint that gets a motion is live no more.
    scene
        .set_motion(live, Still::new([0.0, 0.0]), pendulum_runtime::scene::Preserve::Swing)
        .unwrap();
    assert_eq!(scene.move_to(live, [0.0, 0.0]), Err(SceneError::NotLive(0)));
    scene.advance(FRAME).unwrap();
}

/// A hundred pendulums and double pendulums on ten live joints, one of which is smooth.
fn crowd(scene: &mut Scene<f64>, only: Option<usize>) -> Vec<f64> {
    let mut random = Random::new(3);
    let joints: Vec<_> = (0..10)
        .map(|k| {
            let live = Live::new([0.0, 0.0]);
            scene.live(if k == 3 { live.smoothed() } else { live }).unwrap()
        })
        .collect();
    let (mut single, mut double) = (Vec::new(), Vec::new());
    for index in 0..100 {
        let length = random.uniform(0.1, 0.5);
        let joint = joints[index % 10];
        if only.is_none_or(|only| only == index) {
            single.push(scene.hang(joint, Hanging::new(0.1, length), [0.1], [0.0]).unwrap());
            let chain = Double::new(0.1, length, 1e-4);
            double.push(scene.hang(joint, chain, [0.1, 0.2], [0.0, 0.0]).unwrap());
        }
    }
    for frame in 0..40 {
        for (k, &joint) in joints.iter().enumerate() {
            let [x, y] = hand(FRAME * frame as f64 + k as f64);
            // Some are told in some frames only.
            if (frame + k) % 7 != 0 {
                scene.move_to(joint, [x, y]).unwrap();
            }
        }
        scene.advance(FRAME * if frame % 3 == 0 { 0.3 } else { 1.1 }).unwrap();
    }
    let single = single.iter().flat_map(|&handle| scene.state(handle).0);
    single.chain(double.iter().flat_map(|&handle| scene.state(handle).0)).collect()
}

#[test]
fn the_same_calls_give_the_same_bits_on_any_number_of_threads() {
    let (mut alone, mut together) = (Scene::new(240.0).unwrap(), Scene::new(240.0).unwrap());
    alone.set_parallel(false);
    together.set_always_fork(true);
    assert_eq!(crowd(&mut alone, None), crowd(&mut together, None));
}

#[test]
fn every_lane_has_the_bits_of_a_pendulum_alone() {
    let all = crowd(&mut Scene::new(240.0).unwrap(), None);
    for index in [0, 13, 77] {
        let own = crowd(&mut Scene::new(240.0).unwrap(), Some(index));
        let double = [all[100 + 2 * index], all[101 + 2 * index]];
        assert_eq!(own, [all[index], double[0], double[1]]);
    }
}

/// The largest difference between a pendulum on a live joint and one that follows the formula, over
/// its largest angle.
fn error<S>(
    system: &S,
    formula: impl Fn(f64) -> f64 + Copy + Send + Sync + 'static,
    rates: [fn(f64) -> f64; 2],
    mut frame: impl FnMut() -> f64,
) -> f64
where
    S: pendulum_runtime::scene::SceneSystem<f64, 1> + Clone,
    S::Inputs: pendulum_runtime::scene::Anchored<Joint<2>>,
{
    let mut scenes = [Scene::<f64>::new(240.0).unwrap(), Scene::new(240.0).unwrap()];
    let joint = scenes[0].live([formula(0.0), 0.0]).unwrap();
    scenes[0].teleport(joint, [formula(0.0), 0.0]).unwrap();
    let exact = Function::new(move |t: f64| [formula(t), 0.0])
        .velocity(move |t: f64| [rates[0](t), 0.0])
        .acceleration(move |t: f64| [rates[1](t), 0.0]);
    let exact = scenes[1].joint(exact);
    let joints = [joint, exact];
    let handles: [_; 2] =
        core::array::from_fn(|k| scenes[k].hang(joints[k], system.clone(), [0.0], [0.0]).unwrap());
    let (mut t, mut off, mut swing) = (0.0, 0.0f64, 0.0f64);
    while t < 10.0 {
        let length = frame();
        t += length;
        scenes[0].move_to(joint, [formula(t), 0.0]).unwrap();
        let [live, true_] = core::array::from_fn(|k| {
            scenes[k].advance(length).unwrap();
            scenes[k].state(handles[k]).0[0]
        });
        (off, swing) = (off.max((live - true_).abs()), swing.max(true_.abs()));
    }
    off / swing
}

#[test]
fn a_hand_that_shakes_a_pendulum_is_followed_within_a_percent() {
    const OMEGA: f64 = TAU * 0.64;
    for rate in [30.0, 60.0, 144.0] {
        let rates: [fn(f64) -> f64; 2] =
            [|t| 0.05 * OMEGA * (OMEGA * t).sin(), |t| 0.05 * OMEGA * OMEGA * (OMEGA * t).cos()];
        let path = |t: f64| 0.05 * (1.0 - (OMEGA * t).cos());
        let error = error(&Hanging::new(0.1, 0.3), path, rates, || 1.0 / rate);
        assert!(error < 0.01, "{rate}: {error}");
    }
}

#[test]
fn a_bone_follows_sines_up_to_three_hertz_within_two_percent_at_any_frame_rate() {
    const PARTS: [(f64, f64); 3] = [(0.03, 0.7), (0.01, 1.9), (0.005, 3.0)];
    let path = |t: f64| PARTS.iter().map(|(a, f)| a * (1.0 - (TAU * f * t).cos())).sum::<f64>();
    let rates: [fn(f64) -> f64; 2] = [
        |t| PARTS.iter().map(|(a, f)| a * TAU * f * (TAU * f * t).sin()).sum(),
        |t| PARTS.iter().map(|(a, f)| a * (TAU * f).powi(2) * (TAU * f * t).cos()).sum(),
    ];
    let (m, length, omega) = (0.1, 0.3, TAU * 1.5);
    let inertia = m * length * length;
    let bone = Bone::new(m, length, inertia * omega * omega, 2.0 * 0.3 * omega * inertia);
    for rate in [24.0, 30.0, 60.0, 144.0] {
        let error = error(&bone, path, rates, || 1.0 / rate);
        assert!(error < 0.02, "{rate}: {error}");
    }
    let mut random = Random::new(7);
    let error = error(&bone, path, rates, || 1.0 / random.uniform(24.0, 144.0));
    assert!(error < 0.02, "random: {error}");
}

#[test]
fn a_hidden_pendulum_catches_up_with_the_frames_that_its_joint_remembers() {
    let (mut scene, joint, hidden) = hung();
    scene.set_tolerance(1e-8).unwrap();
    let seen = scene.hang(joint, Hanging::new(0.1, 0.3), [0.2], [0.1]).unwrap();
    for (frames, known) in [(2, true), (20, false)] {
        scene.set_state(hidden, scene.state(seen).0, scene.state(seen).1).unwrap();
        scene.hide(hidden).unwrap();
        shake(&mut scene, joint, 0, frames);
        scene.show(hidden, Resume::CatchUp { longest: 10.0 }).unwrap();
        let apart = (scene.state(hidden).0[0] - scene.state(seen).0[0]).abs();
        // Earlier frames are forgotten.
        assert!(if known { apart < 1e-4 } else { apart < 0.5 }, "{apart}");
    }
}

/// On a joint that jumps to and fro by up to 3 cm in each frame, pendulums turn by up to a radian in
/// a tick. Steps that fit their small swings would make them ever faster.
#[test]
fn what_a_restless_hand_shakes_swings_as_in_shorter_ticks() {
    let run = |rate: f64| {
        let mut scene = Scene::<f64>::new(rate).unwrap();
        let joint = scene.live([0.0, 0.0]).unwrap();
        let pendulums: Vec<_> = (0..8)
            .map(|k| {
                let length = 0.1 + 0.02 * f64::from(k);
                let bone = Bone::new(0.1, length, 0.05, 0.5 * length * length);
                scene.hang(joint, bone, [0.2], [0.0]).unwrap()
            })
            .collect();
        let mut random = Random::new(5);
        let mut angles = Vec::new();
        for _ in 0..10 {
            let place = [(); 2].map(|()| random.uniform(-0.03, 0.03));
            scene.move_to(joint, place).unwrap();
            scene.advance(FRAME).unwrap();
            angles.extend(pendulums.iter().map(|&pendulum| scene.state(pendulum).0[0]));
        }
        angles
    };
    let (coarse, fine) = (run(128.0), run(4096.0));
    let mut apart: Vec<f64> = coarse.iter().zip(&fine).map(|(a, b)| (a - b).abs()).collect();
    apart.sort_by(f64::total_cmp);
    let [middle, most] = [apart[40], apart[79]];
    assert!(middle < 0.05 && most < 0.25, "{middle:.1e} {most:.1e}");
}

/// The same hand, with pendulums whose forces grow with the squares of their velocities.
#[test]
fn what_a_restless_hand_shakes_gains_no_energy_from_long_steps() {
    let mut scene = Scene::<f64>::new(128.0).unwrap();
    let joint = scene.live([0.0, 0.0]).unwrap();
    let pendulums: Vec<_> = (0..8)
        .map(|k| {
            let length = 0.1 + 0.02 * f64::from(k);
            scene.hang(joint, Double::new(0.1, length, 1e-4), [0.2, 0.1], [0.0; 2]).unwrap()
        })
        .collect();
    let mut random = Random::new(5);
    for _ in 0..60 {
        scene.move_to(joint, [(); 2].map(|()| random.uniform(-0.03, 0.03))).unwrap();
        scene.advance(FRAME).unwrap();
        for &pendulum in &pendulums {
            let [a, b] = scene.state(pendulum).1;
            // The joint itself reaches 15 m/s.
            assert!(a.abs().max(b.abs()) < 2000.0, "{a} {b}");
        }
    }
    assert!(scene.faults().is_empty(), "{:?}", scene.faults());
}
