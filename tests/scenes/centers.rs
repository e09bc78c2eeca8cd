//! Bones with a center: what the center does is not felt, only motion relative to it.

use pendulum_runtime::motion::{Function, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Bone, CenteredBone, Collider, Handle, Joint, Scene, Shape};

type Frame = (Joint<3>, Joint<4>);

const AXIS: [f64; 3] = [0.2, 1.0, 0.3];
const PLACE: [f64; 3] = [0.6, 0.9, 0.3];
const ABOVE: [f64; 3] = [0.05, 0.7, -0.1];

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] + b[i])
}

fn apart<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (0..D).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// The distance of two quaternions of attitudes, which have either sign.
fn turned(a: [f64; 4], b: [f64; 4]) -> f64 {
    apart(a, b).min(apart(a, b.map(|part| -part)))
}

fn heavy() -> Bone {
    Bone::swinging(0.15, 1.5, 0.2).unwrap().under([0.0, -9.81, 0.0])
}

/// The attitude of a bone in space.
fn in_space(scene: &Scene<f64>, bone: Handle<CenteredBone, 4>) -> Attitude {
    let seen = scene.observe(bone, 1.0);
    seen.system.turn(seen.t, &seen.q, &seen.v, &seen.inputs)
}

/// The center of a character at `t`, 0.6 m to and fro and 1.2 rad from side to side.
fn center(t: f64) -> ([f64; 3], Attitude) {
    let place = core::array::from_fn(|i| PLACE[i] * (3.0 * t + i as f64).sin());
    (place, Attitude::from_axis_angle(AXIS, 1.2 * (4.0 * t).sin()))
}

/// The joints of the center.
fn moving(scene: &mut Scene<f64>) -> Frame {
    let place = scene.joint(Sinusoid::new(PLACE, 3.0, [0.0, 1.0, 2.0]));
    (place, scene.joint(Turning::new(AXIS, Sinusoid::new([1.2], 4.0, [0.0]))))
}

/// The derivatives of a function, to the fourth power of 2 ms.
fn rates<const D: usize>(f: impl Fn(f64) -> [f64; D], t: f64) -> [[f64; D]; 2] {
    let h = 2e-3;
    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| f(t + k * h));
    [
        core::array::from_fn(|i| (a[i] - e[i] + 8.0 * (d[i] - b[i])) / (12.0 * h)),
        core::array::from_fn(|i| {
            (16.0 * (b[i] + d[i]) - a[i] - e[i] - 30.0 * c[i]) / (12.0 * h * h)
        }),
    ]
}

fn joint<const D: usize>(
    scene: &mut Scene<f64>,
    f: impl Fn(f64) -> [f64; D] + Copy + Send + Sync + 'static,
    push: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
) -> Joint<D> {
    let acceleration = move |t| -> [f64; D] {
        let (rates, push) = (rates(f, t)[1], push(t));
        core::array::from_fn(|i| rates[i] - push[i])
    };
    let motion = Function::new(f).velocity(move |t| rates(f, t)[0]).acceleration(acceleration);
    scene.joint(motion)
}

#[test]
fn a_bone_with_a_center_moves_as_a_bone_in_the_space_of_the_center() {
    let place = |t: f64| [0.3 * (5.0 * t).sin(), 0.2 * t * t, 0.1 * (2.0 * t).cos()];
    let parent = |t: f64| Attitude::from_axis_angle([1.0, -0.4, 0.2], 0.7 * (6.0 * t).sin());
    let seen = move |t: f64| {
        let (c, turn) = center(t);
        turn.inverse() * plus(place(t), c.map(|part| -part))
    };
    let relative = move |t: f64| (center(t).1.inverse() * parent(t)).to_quaternion();
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_tolerance(1e-7).unwrap();
    let turning = move |t: f64| parent(t).to_quaternion();
    let frame = (joint(&mut scene, place, |_| [0.0; 3]), joint(&mut scene, turning, |_| [0.0; 4]));
    let middle = moving(&mut scene);
    let start = Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.3).to_quaternion();
    let anchor = (frame.0, frame.1, middle.0, middle.1);
    let ours = scene.hang(anchor, heavy().centered(), start, [0.0; 4]).unwrap();
    // The same bone on joints that are seen from the center, where gravity turns: its acceleration
    // is taken from that of the joint.
    let gravity = |t: f64| center(t).1.inverse() * [0.0, -9.81, 0.0];
    let on = (joint(&mut scene, seen, gravity), joint(&mut scene, relative, |_| [0.0; 4]));
    let light = Bone::swinging(0.15, 1.5, 0.2).unwrap();
    let exact = scene.hang(on, light, start, [0.0; 4]).unwrap();
    for _ in 0..3 {
        scene.advance(0.05).unwrap();
        let ((q, v), (other_q, other_v)) = (scene.state(ours), scene.state(exact));
        assert!(turned(q, other_q) < 1e-6, "{q:?} {other_q:?}");
        assert!(turned(v, other_v) < 1e-5, "{v:?} {other_v:?}");
        let space = (center(scene.time()).1 * Attitude::from_quaternion(other_q)).to_quaternion();
        assert!(turned(in_space(&scene, ours).to_quaternion(), space) < 1e-6);
    }
}

#[test]
fn a_center_that_rests_changes_nothing() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_tolerance(1e-6).unwrap();
    let frame = moving(&mut scene);
    let turn = Attitude::from_axis_angle([0.4, -0.2, 1.0], 1.9);
    let middle =
        (scene.joint(Still::new([0.4, 1.0, -3.0])), scene.joint(Still::new(turn.to_quaternion())));
    let shape = Shape::Ball { center: [0.05, 0.1, 0.02], radius: 0.05 };
    let plain = scene.hang_chain(frame, [heavy(), heavy()]).unwrap();
    let anchor = (frame.0, frame.1, middle.0, middle.1);
    let bones = [heavy().centered(), heavy().centered()];
    let centered = scene.hang_chain(anchor, bones).unwrap();
    scene.set_colliders(plain[1], 0.01, &[Collider { frame, shape }]).unwrap();
    scene.set_colliders(centered[1], 0.01, &[Collider { frame, shape }]).unwrap();
    for tick in 0..40 {
        scene.advance_ticks(1);
        for (&plain, &centered) in plain.iter().zip(&centered) {
            let ours = in_space(&scene, centered).to_quaternion();
            let off = turned(ours, scene.state(plain).0);
            assert!(off < 1e-9, "{tick}: {off:e}");
        }
    }
}

#[test]
fn a_chain_whose_center_moves_with_its_frame_rests() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let middle = moving(&mut scene);
    let above = |t: f64| {
        let (c, turn) = center(t);
        plus(c, turn * ABOVE)
    };
    let place = joint(&mut scene, above, |_| [0.0; 3]);
    let light = || Bone::swinging(0.15, 1.5, 0.2).unwrap();
    let anchor = (place, middle.1, middle.0, middle.1);
    let bones = [light().centered(), light().centered()];
    let bones = scene.hang_chain(anchor, bones).unwrap();
    let felt = scene.hang_chain((place, middle.1), [light()]).unwrap();
    let mut most = [0.0f64; 3];
    for _ in 0..120 {
        scene.advance_ticks(1);
        for (most, &bone) in most.iter_mut().zip(&bones) {
            *most = most.max(turned(scene.state(bone).0, [1.0, 0.0, 0.0, 0.0]));
        }
        let frame = Attitude::from_quaternion(scene.joint_pose(middle.1, 1.0));
        most[2] = most[2].max(turned(scene.state(felt[0]).0, frame.to_quaternion()));
    }
    // The place is differentiated to 1e-8; the tip of the first bone is a polynomial in each tick.
    assert!(most[0] < 1e-8 && most[1] < 1e-7 && 0.3 < most[2], "{most:?}");
}

/// A character of live frames, its hips and its head, with an ear of three bones.
fn character() -> (Scene<f64>, Frame, Frame, Vec<Handle<CenteredBone, 4>>) {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let hips = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    let head = scene.live_frame(ABOVE, Attitude::identity()).unwrap();
    let bones = [0.1; 3].map(|length| Bone::swinging(length, 2.0, 0.3).unwrap().centered());
    let ear = scene.hang_chain((head.0, head.1, hips.0, hips.1), bones).unwrap();
    (scene, hips, head, ear)
}

#[test]
fn a_character_that_walks_and_turns_moves_no_bone_with_a_center() {
    let run = |turn: f64| {
        let (mut scene, hips, head, ear) = character();
        let mut most = 0.0f64;
        for frame in 1..=30 {
            let t = f64::from(frame) / 60.0;
            let place = [1.4 * t, 0.03 * (20.0 * t).sin(), 0.0];
            let turn = Attitude::from_axis_angle([0.0, 1.0, 0.0], turn * (3.0 * t).sin());
            scene.move_to(hips.0, place).unwrap();
            scene.move_to(hips.1, turn.to_quaternion()).unwrap();
            scene.move_to(head.0, plus(place, turn * ABOVE)).unwrap();
            scene.move_to(head.1, turn.to_quaternion()).unwrap();
            scene.advance(1.0 / 60.0).unwrap();
            let rest = [1.0, 0.0, 0.0, 0.0];
            let off = ear.iter().map(|&bone| turned(scene.state(bone).0, rest));
            most = off.fold(most, f64::max);
        }
        most
    };
    assert!(run(0.0) < 1e-12, "{:e}", run(0.0));
    // Within a frame a place is told without the turn of the hips: it goes along a parabola.
    assert!(run(1.0) < 5e-3, "{:e}", run(1.0));
}

/// UniVRM #240.
#[test]
fn a_character_that_is_teleported_and_turned_moves_no_bone_with_a_center() {
    let (mut scene, hips, head, ear) = character();
    let swing = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.2).to_quaternion();
    scene.set_state(ear[1], swing, [0.0; 4]).unwrap();
    scene.advance(0.1).unwrap();
    let before = scene.snapshot();
    let run = |scene: &mut Scene<f64>| {
        scene.advance(0.2).unwrap();
        ear.iter().map(|&bone| scene.state(bone)).collect::<Vec<_>>()
    };
    let stayed = run(&mut scene);
    scene.restore(&before).unwrap();
    let turn = Attitude::from_axis_angle([0.1, 1.0, -0.3], 2.5);
    let place = [30.0, -2.0, 7.0];
    scene.teleport(hips.0, place).unwrap();
    scene.teleport(hips.1, turn.to_quaternion()).unwrap();
    scene.teleport(head.0, plus(place, turn * ABOVE)).unwrap();
    scene.teleport(head.1, turn.to_quaternion()).unwrap();
    for ((q, v), (other_q, other_v)) in stayed.iter().zip(&run(&mut scene)) {
        assert!(turned(*q, *other_q) < 1e-12 && turned(*v, *other_v) < 1e-11, "{q:?} {other_q:?}");
    }
    assert!(1e-3 < turned(stayed[1].0, [1.0, 0.0, 0.0, 0.0]), "it swings: {stayed:?}");
}

#[test]
fn bones_with_a_center_do_not_enter_what_the_character_carries() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let middle = moving(&mut scene);
    let frame =
        (scene.joint(Still::new([0.0, 0.3, 0.0])), scene.joint(Still::new([1.0, 0.0, 0.0, 0.0])));
    let bone = Bone::swinging(0.25, 0.4, 0.1).unwrap().under([0.0, -9.81, 0.0]).centered();
    let bone = scene.hang_chain((frame.0, frame.1, middle.0, middle.1), [bone]).unwrap()[0];
    let shape = Shape::Ball { center: [0.0, 0.45, 0.0], radius: 0.12 };
    let ball = (scene.joint(Sinusoid::new([0.2, 0.05, 0.2], 5.0, [0.0, 1.0, 2.0])), frame.1);
    scene.set_colliders(bone, 0.01, &[Collider { frame: ball, shape }]).unwrap();
    let (mut touched, mut least) = (0, 1.0f64);
    for _ in 0..200 {
        scene.advance_ticks(1);
        let along = in_space(&scene, bone) * [0.0, 0.25, 0.0];
        let off: [f64; 3] =
            core::array::from_fn(|i| scene.joint_pose(ball.0, 1.0)[i] + [0.0, 0.15, 0.0][i]);
        let dot: f64 = (0..3).map(|i| off[i] * along[i]).sum();
        let foot = along.map(|part| (dot / 0.0625).clamp(0.0, 1.0) * part);
        let (joint, left) = (apart(off, [0.0; 3]), apart(off, foot) - 0.13);
        // What contains the joint holds the tip alone.
        let left = if joint < 0.13 { apart(off, along) - 0.13 } else { left };
        assert!(-1e-6 < left, "{left:e}");
        touched += i32::from(left < 1e-6);
        least = least.min(left);
    }
    assert!(10 < touched, "{touched} {least}");
    assert!(scene.faults().is_empty());
}
