//! Joints that pendulums carry: chains in which each pendulum moves those that hang on it.

use pendulum_runtime::integrate::{Dop853, Solution};
use pendulum_runtime::motion::{Function, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Bone, Handle, Joint, Resume, Scene, SceneError, SceneStatus};

lagrangian! {
    /// A point mass on a rod in the plane.
    #[derive(Clone, Debug)]
    pub struct Link { L: m, c: 1/s = 0, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
    dissipation = c*L^2/2*θ̇^2;
    output tip: [m; 2] = y;
    output height: m = height(y);
    output rate: [m/s; 2] = ẏ;
}

type Hung = Handle<Link<f64>, 1>;

fn shake() -> Sinusoid<2> {
    Sinusoid::new([0.05, 0.02], 7.0, [0.0, 1.0])
}

/// Hangs three links on a joint, each on the tip of the one before.
fn three(scene: &mut Scene<f64>, root: Joint<2>, damping: f64) -> Vec<Hung> {
    let mut joint = root;
    let mut links = Vec::new();
    for length in [0.3, 0.2, 0.1] {
        let link = Link { c: damping, ..Link::new(length) };
        links.push(scene.hang(joint, link, [0.1], [0.0]).unwrap());
        joint = scene.joint_on(links[links.len() - 1], "tip").unwrap();
    }
    links
}

/// A scene of 120 ticks a second with three links on a joint that moves.
fn shaken() -> (Scene<f64>, Vec<Hung>) {
    let mut scene = Scene::<f64>::new(120.0).unwrap();
    let root = scene.joint(shake());
    let links = three(&mut scene, root, 0.0);
    (scene, links)
}

fn product([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

/// The vector part of a ∘ y ∘ b*, for the axis y: bilinear, and its direction for equal factors.
fn turned(a: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let [_, turned @ ..] = product(product(a, [0.0, 0.0, 1.0, 0.0]), [w, -x, -y, -z]);
    turned
}

/// The rate of `value` at `t`, by differences within the times from 0 on.
fn rate<const D: usize>(value: impl Fn(f64) -> [f64; D], t: f64) -> [f64; D] {
    let h = 1e-4;
    if t < h {
        let [a, b, c] = [value(t), value(t + h), value(t + 2.0 * h)];
        return core::array::from_fn(|i| (4.0 * b[i] - 3.0 * a[i] - c[i]) / (2.0 * h));
    }
    let [a, b] = [value(t - h), value(t + h)];
    core::array::from_fn(|i| (b[i] - a[i]) / (2.0 * h))
}

#[test]
fn a_bone_on_a_bone_moves_as_by_solve() {
    let place = || Sinusoid::new([0.05, 0.02, 0.03], 7.0, [0.0, 1.0, 2.0]);
    let parent = || Turning::new([0.2, 0.3, 1.0], Sinusoid::new([0.6], 5.0, [0.0]));
    let first = Bone::swinging(0.2, 2.0, 0.2).unwrap().under([0.0, -9.81, 0.0]);
    let second = Bone::swinging(0.1, 3.0, 0.3).unwrap().under([0.0, -9.81, 0.0]);
    let start = [1.0, 0.0, 0.0, 0.0];

    let mut scene = Scene::<f64>::new(120.0).unwrap();
    scene.set_tolerance(1e-7).unwrap();
    let frame = (scene.joint(place()), scene.joint(parent()));
    let bones = scene.hang_chain(frame, [first.clone(), second.clone()]).unwrap();
    scene.advance_ticks(18);

    let end = 0.15;
    let driven = first.driven_by(place(), parent());
    let accurate = solve(&driven, (0.0, end + 1e-3), start, [0.0; 4]).method(Dop853);
    let moved: Solution<f64, 4> = accurate.rtol(1e-12).atol(1e-12).dense().run().unwrap();
    let q = |t: f64| moved.at(t).unwrap().q;
    let v = |t: f64| moved.at(t).unwrap().v;
    let (amplitude, phases) = ([0.05, 0.02, 0.03], [0.0, 1.0, 2.0]);
    let tip = |t: f64| -> [f64; 3] {
        let direction = turned(q(t), q(t));
        core::array::from_fn(|i| amplitude[i] * (7.0 * t + phases[i]).sin() + 0.2 * direction[i])
    };
    let tip_rate = |t: f64| -> [f64; 3] {
        let (one, other) = (turned(v(t), q(t)), turned(q(t), v(t)));
        core::array::from_fn(|i| {
            7.0 * amplitude[i] * (7.0 * t + phases[i]).cos() + 0.2 * (one[i] + other[i])
        })
    };
    let on = Function::new(tip).velocity(tip_rate).acceleration(|t| rate(tip_rate, t));
    let turn = Function::new(q).velocity(v).acceleration(|t| rate(v, t));
    let driven = second.driven_by(on, turn);
    let alone = solve(&driven, (0.0, end), start, [0.0; 4]).method(Dop853);
    let exact = alone.rtol(1e-9).atol(1e-9).run().unwrap().end;
    let (ours, speed) = scene.state(bones[1]);
    assert!(0.02 < ours[2].abs(), "it has moved: {ours:?}");
    for i in 0..4 {
        assert!((ours[i] - exact.q[i]).abs() < 1e-6, "{ours:?} {exact:?}");
        assert!((speed[i] - exact.v[i]).abs() < 1e-5, "{speed:?} {exact:?}");
    }
}

#[test]
fn a_carried_joint_is_where_the_output_is() {
    let mut scene = Scene::<f64>::new(120.0).unwrap();
    let root = scene.joint(shake());
    let link = scene.hang(root, Link::new(0.3), [0.1], [0.0]).unwrap();
    let tip: Joint<2> = scene.joint_on(link, "tip").unwrap();
    let height: Joint<1> = scene.joint_on(link, "height").unwrap();
    let late: Vec<_> = (0..5)
        .map(|_| {
            scene.advance_ticks(1);
            let seen = scene.observe(link, 1.0);
            let there = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
            assert_eq!(scene.joint_pose(tip, 1.0), there);
            assert_eq!(scene.joint_pose(height, 1.0), [there[1]]);
            let seen = scene.observe(link, 0.5);
            let there = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
            let between: [f64; 2] = scene.joint_pose(tip, 0.5);
            (between[0] - there[0]).abs().max((between[1] - there[1]).abs())
        })
        .collect();
    // The cubic of the pose is less accurate than the polynomial of the joint.
    assert!(late.iter().all(|apart| *apart < 1e-6), "{late:?}");
}

#[test]
fn frames_other_chains_and_threads_change_no_bit() {
    let run = |frames: &[f64], others: bool, fork: bool| {
        let (mut scene, links) = shaken();
        if others {
            let root = scene.joint(Sinusoid::new([0.1, 0.0], 3.0, [0.0, 0.0]));
            let more: Vec<_> = (0..12).flat_map(|_| three(&mut scene, root, 0.5)).collect();
            scene.set_damping(more[4], 0.3).unwrap();
        }
        scene.set_always_fork(fork);
        scene.set_parallel(fork);
        for &frame in frames {
            scene.advance(frame).unwrap();
        }
        links.iter().map(|&link| scene.state(link)).collect::<Vec<_>>()
    };
    let alone = run(&[0.25], false, false);
    assert_eq!(run(&[1.0 / 60.0; 15], false, false), alone);
    assert_eq!(run(&[1.0 / 144.0; 36], true, false), alone);
    assert_eq!(run(&[0.01, 0.1, 0.003, 0.137], true, true), alone);
}

#[test]
fn a_chain_falls_asleep_and_wakes_with_its_root() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let root = scene.live([0.0, 0.0]).unwrap();
    let links = three(&mut scene, root, 20.0);
    scene.set_sleep(Some(1e-2)).unwrap();
    scene.advance_ticks(400);
    let asleep = |scene: &Scene<f64>| {
        links.iter().filter(|&&link| scene.status(link) != SceneStatus::Awake).count()
    };
    assert_eq!((asleep(&scene), scene.awake()), (3, (0, 3)));
    let (before, snapshot) = (scene.state(links[2]).0, scene.snapshot());
    scene.advance_ticks(40);
    assert_eq!(scene.state(links[2]).0, before);
    scene.restore(&snapshot).unwrap();
    assert_eq!(asleep(&scene), 3);
    scene.advance_ticks(40);
    assert_eq!(asleep(&scene), 3);
    scene.move_to(root, [0.1, 0.0]).unwrap();
    scene.advance_ticks(3);
    assert_eq!(asleep(&scene), 0);
    assert_ne!(scene.state(links[2]).0, before);
}

#[test]
fn what_hangs_on_a_pendulum_wakes_when_it_is_changed() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let root = scene.live([0.0, 0.0]).unwrap();
    let links = three(&mut scene, root, 20.0);
    scene.set_sleep(Some(1e-2)).unwrap();
    scene.advance_ticks(400);
    assert_eq!(scene.awake(), (0, 3));
    scene.set_parameter(links[0], "L", 0.4).unwrap();
    assert_eq!(scene.awake(), (3, 3));
}

#[test]
fn snapshots_restore_chains_to_the_bit() {
    let (mut scene, links) = shaken();
    scene.advance(0.1).unwrap();
    let snapshot = scene.snapshot();
    let tip = scene.joint_on::<Link<f64>, 1, 2>(links[2], "tip").unwrap();
    let pose = scene.joint_pose(tip, 0.3);
    scene.advance(0.1).unwrap();
    let end = scene.checksum();
    scene.restore(&snapshot).unwrap();
    assert_eq!(scene.joint_pose(tip, 0.3), pose);
    scene.advance(0.1).unwrap();
    assert_eq!(scene.checksum(), end);
}

#[test]
fn a_teleport_of_the_root_is_not_felt_along_the_chain() {
    let run = |place: f64| {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        let root = scene.live([0.0, 0.0]).unwrap();
        let links = three(&mut scene, root, 1.0);
        scene.advance(0.1).unwrap();
        scene.teleport(root, [place, 0.0]).unwrap();
        let tip: Joint<2> = scene.joint_on(links[2], "tip").unwrap();
        let place = scene.joint_pose(tip, 1.0)[0];
        scene.advance(0.1).unwrap();
        (place, links.iter().map(|&link| scene.state(link)).collect::<Vec<_>>())
    };
    let ((near, here), (far, there)) = (run(0.0), run(10.0));
    assert!((far - near - 10.0).abs() < 1e-12);
    for ((q, v), (other_q, other_v)) in here.iter().zip(&there) {
        assert!((q[0] - other_q[0]).abs() < 1e-9 && (v[0] - other_v[0]).abs() < 1e-7);
    }
}

#[test]
fn a_state_that_is_set_is_not_felt_by_what_hangs_there() {
    let (mut scene, links) = shaken();
    let tip: Joint<2> = scene.joint_on(links[0], "tip").unwrap();
    scene.advance(0.1).unwrap();
    let before = scene.state(links[1]);
    scene.set_state(links[0], [1.2], [0.0]).unwrap();
    let seen = scene.observe(links[0], 1.0);
    let there = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
    assert_eq!(scene.joint_pose(tip, 1.0), there);
    assert_eq!(scene.state(links[1]), before);
    scene.advance_ticks(1);
    let (after, bound) = (scene.state(links[1]).1[0], 100.0 / 120.0);
    // Only accelerations act: in a tick they are less than 100 rad/s².
    assert!((after - before.1[0]).abs() < bound, "{after} {before:?}");
}

#[test]
fn a_pendulum_that_carries_a_joint_is_not_removed() {
    let (mut scene, links) = shaken();
    let before = scene.checksum();
    let error = scene.remove(links[0]).unwrap_err();
    assert_eq!(error, SceneError::CarriesJoint { kind: "Link", index: 0, joint: 1 });
    assert!(error.to_string().contains("remove the joint first"), "{error}");
    assert_eq!(scene.checksum(), before);
}

#[test]
fn a_chain_is_removed_from_its_end_and_its_places_are_used_again() {
    let mut scene = Scene::<f64>::new(120.0).unwrap();
    let root = scene.joint(shake());
    for _ in 0..3 {
        let link = scene.hang(root, Link::new(0.3), [0.1], [0.0]).unwrap();
        let tip: Joint<2> = scene.joint_on(link, "tip").unwrap();
        let next = scene.hang(tip, Link::new(0.2), [0.1], [0.0]).unwrap();
        scene.advance_ticks(2);
        assert!(matches!(scene.remove_joint(tip), Err(SceneError::Carries { .. })));
        scene.remove(next).unwrap();
        assert!(scene.remove(link).is_err());
        scene.remove_joint(tip).unwrap();
        scene.remove(link).unwrap();
        scene.advance_ticks(2);
    }
    // What takes the places of a joint and a pendulum is not carried.
    let link = scene.hang(root, Link::new(0.3), [0.1], [0.0]).unwrap();
    let other = scene.joint(shake());
    assert_eq!(format!("{other:?} {}", link.index()), "Joint(1) 0");
    scene.set_motion(other, shake(), pendulum_runtime::scene::Preserve::Swing).unwrap();
    scene.remove(link).unwrap();
}

#[test]
fn a_bundle_removes_a_chain_and_its_joints() {
    let mut scene = Scene::<f64>::new(120.0).unwrap();
    let (bundle, links) = scene
        .bundle(|scene| {
            let root = scene.joint(shake());
            Ok(three(scene, root, 0.0))
        })
        .unwrap();
    // A joint outside of the bundle.
    let tip: Joint<2> = scene.joint_on(links[1], "tip").unwrap();
    let before = scene.checksum();
    assert!(matches!(scene.remove_bundle(&bundle), Err(SceneError::CarriesJoint { .. })));
    assert_eq!(scene.checksum(), before);
    scene.remove_joint(tip).unwrap();
    scene.remove_bundle(&bundle).unwrap();
    assert_eq!(scene.awake(), (0, 0));
    scene.advance_ticks(3);
}

#[test]
fn a_pendulum_that_fails_does_not_make_others_fail() {
    let mut scene = Scene::<f64>::new(120.0).unwrap();
    let bad = |t: f64| if t < 0.05 { 0.0 } else { f64::NAN };
    let root = scene.joint(
        Function::new(|_: f64| [0.0, 0.0])
            .velocity(|_: f64| [0.0, 0.0])
            .acceleration(move |t: f64| [bad(t), 0.0]),
    );
    let links = three(&mut scene, root, 0.0);
    scene.advance(0.2).unwrap();
    assert_eq!(scene.status(links[0]), SceneStatus::Failed);
    assert_eq!(scene.faults().len(), 1);
    for &link in &links[1..] {
        let (q, v) = scene.state(link);
        assert!(scene.status(link) == SceneStatus::Awake && q[0].is_finite() && v[0].abs() < 9.0);
    }
}

#[test]
fn a_hidden_pendulum_is_rigid_and_shows_itself_where_it_is() {
    let (mut scene, links) = shaken();
    let tip: Joint<2> = scene.joint_on(links[0], "tip").unwrap();
    scene.hide(links[0]).unwrap();
    scene.advance(0.1).unwrap();
    let angle = scene.state(links[0]).0[0];
    let root = shake();
    let at =
        |i: usize, a: f64, p: f64| a * (7.0 * 0.1 + p).sin() + 0.3 * [angle.sin(), -angle.cos()][i];
    let there: [f64; 2] = scene.joint_pose(tip, 1.0);
    assert!((there[0] - at(0, 0.05, 0.0)).abs() < 1e-15, "{there:?} {root:?}");
    assert!((there[1] - at(1, 0.02, 1.0)).abs() < 1e-15, "{there:?}");
    assert!(scene.state(links[1]).1[0].is_finite());
    scene.show(links[0], Resume::CatchUp { longest: 1.0 }).unwrap();
    let seen = scene.observe(links[0], 1.0);
    let there = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
    assert_eq!(scene.joint_pose(tip, 1.0), there);
    scene.hide(links[2]).unwrap();
    scene.advance(0.1).unwrap();
    scene.show(links[2], Resume::CatchUp { longest: 1.0 }).unwrap();
    scene.advance_ticks(1);
    assert!(scene.state(links[2]).1[0].is_finite() && scene.faults().is_empty());
}

#[test]
fn outputs_that_cannot_carry_are_refused_by_name() {
    let (mut scene, links) = shaken();
    let before = scene.checksum();
    let refused = |error: SceneError, words: &str| {
        let text = error.to_string();
        assert!(text.contains(words), "{text}");
    };
    let link = links[2];
    refused(scene.joint_on::<_, 1, 2>(link, "tipp").unwrap_err(), "`tipp`");
    refused(scene.joint_on::<_, 1, 3>(link, "tip").unwrap_err(), "components");
    refused(scene.joint_on::<_, 1, 2>(link, "rate").unwrap_err(), "independent of velocities");
    let rest = Attitude::identity();
    refused(scene.frame_on(link, ["tip", "tip"], [0.0; 3], rest).unwrap_err(), "components");
    let nowhere = Attitude::from_quaternion([f64::NAN; 4]);
    assert!(scene.frame_on(link, ["tip", "tip"], [0.0; 3], nowhere).is_err());
    let mut other = Scene::<f64>::new(60.0).unwrap();
    assert!(other.joint_on::<_, 1, 2>(link, "tip").is_err());
    let tip: Joint<2> = scene.joint_on(link, "tip").unwrap();
    refused(scene.move_to(tip, [0.0; 2]).unwrap_err(), "joint");
    let moved = scene.set_motion(tip, shake(), pendulum_runtime::scene::Preserve::Swing);
    refused(moved.unwrap_err(), "set the state of this pendulum");
    assert_eq!(scene.checksum(), before);
}

#[test]
fn a_motion_without_acceleration_moves_nothing_that_carries() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let place = scene.joint(Function::new(|t: f64| [0.1 * t, 0.0, 0.0]));
    let turn = scene.joint(Turning::new([0.0, 1.0, 0.0], Sinusoid::new([0.1], 2.0, [0.0])));
    let bone = Bone::swinging(0.1, 1.0, 0.3).unwrap();
    assert!(matches!(
        scene.hang((place, turn), bone.clone(), [1.0, 0.0, 0.0, 0.0], [0.0; 4]),
        Err(SceneError::Derivative { .. })
    ));
    let place = scene.joint(Sinusoid::new([0.1, 0.0, 0.0], 3.0, [0.0; 3]));
    // The acceleration of its attitude is not needed by the bone, but by what it carries.
    let bare =
        scene.joint(Function::new(|_: f64| [1.0, 0.0, 0.0, 0.0]).velocity(|_: f64| [0.0; 4]));
    let bone = scene.hang((place, bare), bone, [1.0, 0.0, 0.0, 0.0], [0.0; 4]).unwrap();
    let frame = scene.frame_on(bone, ["tip", "turn"], [0.0; 3], Attitude::identity());
    assert!(matches!(frame, Err(SceneError::Derivative { input: "P", derivative: 2 })));
}

#[test]
fn loops_close_and_warm_up_with_chains() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let root = scene.joint(Sinusoid::new([0.05, 0.0], core::f64::consts::TAU, [0.0, 0.0]));
    let links = three(&mut scene, root, 6.0);
    scene.warm_up(1.0).unwrap();
    let closed = scene.close_loop(60, 20, 1e-6).unwrap();
    assert!(closed.gap <= 1e-6, "{closed:?}");
    let keys = scene.bake(&links, 60, 1e-3).unwrap();
    let (first, last) = (keys[2].at(0.0), keys[2].at(60.0));
    assert!((first[0] - last[0]).abs() < 1e-5, "{first:?} {last:?}");
}

#[test]
fn a_chain_that_is_reset_is_at_rest() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let frame =
        scene.live_frame([0.0; 3], Attitude::from_axis_angle([0.0, 0.0, 1.0], 1.2)).unwrap();
    let bone = Bone::swinging(0.1, 1.5, 0.3).unwrap().under([0.0, -9.81, 0.0]);
    let chain = scene.hang_chain(frame, [bone.clone(), bone.clone(), bone]).unwrap();
    scene.reset_all_to_rest().unwrap();
    let rest: Vec<_> = chain.iter().map(|&bone| scene.state(bone).0).collect();
    assert!(1e-2 < (rest[2][0] - rest[0][0]).abs(), "it bends: {rest:?}");
    scene.advance_ticks(10);
    for (&bone, rest) in chain.iter().zip(&rest) {
        let q = scene.state(bone).0;
        assert!((0..4).all(|i| (q[i] - rest[i]).abs() < 1e-8), "{q:?} {rest:?}");
    }
}

#[test]
fn a_chain_that_cannot_hang_leaves_nothing_behind() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let frame = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    let [slow, fast] = [1.0, 1e6].map(|hertz| Bone::swinging(0.1, hertz, 0.3).unwrap());
    let refused = scene.hang_chain(frame, [slow.clone(), slow.clone(), fast]);
    assert!(matches!(refused, Err(SceneError::Frequency { .. })));
    assert_eq!(scene.awake(), (0, 0));
    scene.remove_joint(frame.0).unwrap();
    assert!(scene.hang_chain(frame, [slow]).is_err());
    assert!(scene.hang_chain(frame, Vec::<Bone>::new()).unwrap().is_empty());
}

#[test]
fn a_bone_rests_at_an_attitude_relative_to_the_one_before() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let root = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.4);
    let bend = Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.7);
    let frame = scene.live_frame([0.0; 3], root).unwrap();
    let bone = Bone::swinging(0.1, 3.0, 0.9).unwrap();
    let start = root.to_quaternion();
    let first = scene.hang(frame, bone.clone(), start, [0.0; 4]).unwrap();
    let frame = scene.frame_on(first, ["tip", "turn"], [0.0; 3], bend).unwrap();
    let second = scene.hang(frame, bone, start, [0.0; 4]).unwrap();
    scene.reset_to_rest(second).unwrap();
    let (q, exact) = (scene.state(second).0, (root * bend).to_quaternion());
    assert!((0..4).all(|i| (q[i] - exact[i]).abs() < 1e-9), "{q:?} {exact:?}");
}

#[test]
fn long_chains_hang_and_are_removed() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let root = scene.live([0.0, 0.0]).unwrap();
    let (bundle, links) = scene
        .bundle(|scene| {
            let mut joint = root;
            let mut links = Vec::new();
            for _ in 0..300 {
                links.push(scene.hang(joint, Link::new(0.1), [0.0], [0.0])?);
                joint = scene.joint_on(links[links.len() - 1], "tip")?;
            }
            Ok(links)
        })
        .unwrap();
    scene.set_state(links[0], [0.2], [0.0]).unwrap();
    scene.move_to(root, [0.1, 0.0]).unwrap();
    scene.advance_ticks(2);
    assert!(scene.state(links[299]).0[0].is_finite());
    scene.remove_bundle(&bundle).unwrap();
    assert_eq!(scene.awake(), (0, 0));
}

#[test]
fn single_numbers_hang_chains_too() {
    let turn = Attitude::from_axis_angle([0.0, 0.0, 1.0], 1.2).to_quaternion();
    let mut double = Scene::<f64>::new(60.0).unwrap();
    let mut single = Scene::<f32>::new(60.0).unwrap();
    let place = || Sinusoid::new([0.05, 0.02, 0.03], 7.0, [0.0, 1.0, 2.0]);
    let frames = (
        (double.joint(place()), double.joint(Still::new(turn))),
        (single.joint(place()), single.joint(Still::new(turn))),
    );
    let exact = [3.0, 2.0].map(|hertz| Bone::<f64>::swinging(0.1, hertz, 0.3).unwrap());
    let short = [3.0, 2.0].map(|hertz| Bone::<f32>::swinging(0.1, hertz, 0.3).unwrap());
    let exact = double.hang_chain(frames.0, exact).unwrap()[1];
    let short = single.hang_chain(frames.1, short).unwrap()[1];
    double.advance(0.3).unwrap();
    single.advance(0.3).unwrap();
    let (exact, short) = (double.state(exact).0, single.state(short).0);
    assert!(0.02 < (exact[0] - turn[0]).abs().max((exact[3] - turn[3]).abs()), "{exact:?}");
    for i in 0..4 {
        assert!((exact[i] - f64::from(short[i])).abs() < 1e-4, "{exact:?} {short:?}");
    }
}

#[test]
fn a_chain_that_is_shaken_by_its_length_in_each_frame_does_not_fail() {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let frame = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    let bone = Bone::swinging(0.06, 2.5, 0.3).unwrap().under([0.0, -9.81, 0.0]);
    let bones = scene.hang_chain(frame, vec![bone; 5]).unwrap();
    let mut hidden = [false; 5];
    for _ in 0..120 {
        let place = [0; 3].map(|_| 0.05 * (2.0 * random() - 1.0));
        scene.move_to(frame.0, place).unwrap();
        for (&bone, hidden) in bones.iter().zip(&mut hidden) {
            if random() < 0.1 {
                *hidden = !*hidden;
                if *hidden {
                    scene.hide(bone).unwrap();
                } else {
                    scene.show(bone, Resume::Unchanged).unwrap();
                }
            }
        }
        scene.advance(1.0 / 60.0).unwrap();
        assert!(scene.faults().is_empty(), "{}", scene.faults()[0]);
    }
}

#[test]
fn ticks_in_shorter_steps_have_the_same_bits_for_every_division_into_frames() {
    let run = |frame: u32| {
        let mut scene = Scene::<f64>::new(60.0).unwrap();
        for k in 0..9 {
            // Up to 2000 m/s² at a bone of 6 cm.
            let quick = if k % 4 == 0 { 200.0 } else { 5.0 };
            let place = scene.joint(Sinusoid::new([0.05, 0.0, 0.02], quick, [f64::from(k); 3]));
            let turn = scene.joint(Still::new(Attitude::identity().to_quaternion()));
            let bone = Bone::swinging(0.06, 2.5, 0.1).unwrap();
            let start = Attitude::identity().to_quaternion();
            scene.hang((place, turn), bone, start, [0.0; 4]).unwrap();
        }
        for _ in 0..20 / frame {
            scene.advance_ticks(frame);
        }
        assert!(scene.faults().is_empty(), "{}", scene.faults()[0]);
        scene.checksum()
    };
    let whole = run(20);
    for frame in [1, 5] {
        assert_eq!(run(frame), whole, "{frame}");
    }
}
