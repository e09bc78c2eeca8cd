//! Bodies in space: coordinates and driven inputs that are rotations.

use pendulum_runtime::integrate::Dop853;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Handle, Joint, Scene, SceneError, SceneStatus};
use pendulum_runtime::time::Time;

lagrangian! {
    /// A bone on a moving, turning parent, which springs back to its rest direction.
    #[derive(Clone, Debug)]
    pub struct Bone {
        m: kg, L: m, k: N*m, kt: N*m, c: N*m*s,
        axis: [1; 3] = [0, 1, 0], side: [1; 3] = [1, 0, 0], up: [1; 3] = [0, 1, 0], g: m/s^2 = 9.81,
    }
    driven x: [m; 3];
    driven P: rotation;
    coordinate R: rotation;
    let d = R*axis;
    let tip = x + L*d;
    kinetic   = m/2*|dot(tip)|^2 + m*L^2/20*|angular_velocity(R)|^2;
    potential = m*g*inner(up, tip) - k*inner(d, P*axis) - kt*inner(R*side, P*side);
    dissipation = c/2*|angular_velocity(R) - angular_velocity(P)|^2;
}

fn bone() -> Bone<f64> {
    let (m, l) = (0.1, 0.3);
    let inertia = m * l * l;
    Bone::new(m, l, inertia * 90.0, inertia * 9.0, inertia * 4.0)
}

fn shake() -> Sinusoid<3> {
    Sinusoid::new([0.05, 0.02, 0.0], 7.0, [0.0, 1.0, 0.0])
}

fn nod() -> Turning<Sinusoid<1>> {
    Turning::new([0.2, 0.3, 1.0], Sinusoid::new([0.6], 5.0, [0.0]))
}

fn length(q: [f64; 4]) -> f64 {
    q.iter().map(|q| q * q).sum::<f64>().sqrt()
}

const START: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

#[test]
fn a_bone_moves_as_by_solve_and_keeps_its_length() {
    let mut scene = Scene::new(240.0).unwrap();
    scene.set_tolerance(1e-6).unwrap();
    let joints = (scene.joint(shake()), scene.joint(nod()));
    let handle = scene.hang(joints, bone(), START, [0.0; 4]).unwrap();
    let (system, parent) = (bone(), (shake(), nod()));
    let driven = system.driven_by(parent.0, parent.1);
    let exact = solve(&driven, (0.0, 0.25), START, [0.0; 4]);
    let end = exact.method(Dop853).rtol(1e-11).atol(1e-11).run().unwrap().end;
    for _ in 0..15 {
        scene.advance(1.0 / 60.0).unwrap();
        let q = scene.state(handle).0;
        assert!((length(q) - 1.0).abs() <= 4.4e-16, "{:e}", length(q) - 1.0);
    }
    let (q, v) = scene.state(handle);
    for i in 0..4 {
        assert!((q[i] - end.q[i]).abs() < 1e-7 && (v[i] - end.v[i]).abs() < 1e-6, "{q:?} {end:?}");
    }
}

#[test]
fn every_bone_has_the_bits_of_one_alone() {
    let run = |only: Option<u32>| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joints = (scene.joint(shake()), scene.joint(nod()));
        let still = scene.joint(Still::new([0.0; 3]));
        let bones = (0..5).filter(|index| only.is_none_or(|only| only == *index)).map(|index| {
            let start = Attitude::from_axis_angle([1.0, 0.3, 0.0], 0.1 * f64::from(index));
            let joints = if index % 2 == 0 { joints } else { (still, joints.1) };
            scene.hang(joints, bone(), start.to_quaternion(), [0.0; 4]).unwrap()
        });
        let bones: Vec<_> = bones.collect();
        scene.advance(0.05).unwrap();
        bones.iter().map(|&bone| scene.state(bone)).collect::<Vec<_>>()
    };
    let all = run(None);
    for index in [0, 3] {
        assert_eq!(run(Some(index)), [all[index as usize]]);
    }
}

/// A scene with a bone on a live frame at rest, turned from its state of rest by an angle about the
/// axis x of its joint.
fn rested(angle: f64) -> (Scene<f64>, (Joint<3>, Joint<4>), Handle<Bone<f64>, 4>) {
    let mut scene = Scene::new(240.0).unwrap();
    let frame = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    let tilted = Attitude::from_axis_angle([1.0, 0.0, 0.0], angle);
    let bone = scene.hang(frame, bone(), tilted.to_quaternion(), [0.0; 4]).unwrap();
    (scene, frame, bone)
}

#[test]
fn a_bone_that_is_reset_is_at_rest() {
    let (mut scene, _, bone) = rested(0.7);
    scene.reset_to_rest(bone).unwrap();
    let (q, v) = scene.state(bone);
    assert_eq!(v, [0.0; 4]);
    assert!((0..4).all(|i| (q[i] - START[i]).abs() < 1e-9), "{q:?}");
}

#[test]
fn a_bone_sleeps_when_it_cannot_turn_by_more_than_the_tolerance() {
    // The softest turn is the twist, of kt; a component of q is half an angle. Its energy for the
    // tolerance is 2 kt tolerance²; that of a swing is (k − m g L) angle²/2, here 0.26 angle².
    let tolerance = 1e-3;
    for (angle, status) in
        [(0.7 * tolerance, SceneStatus::Asleep(i64::MAX)), (1.5 * tolerance, SceneStatus::Awake)]
    {
        let (mut scene, _, bone) = rested(angle);
        scene.set_sleep(Some(tolerance)).unwrap();
        scene.advance_ticks(17);
        assert_eq!(scene.status(bone), status, "{angle}");
    }
}

#[test]
fn a_bone_wakes_when_its_frame_turns() {
    let (mut scene, frame, bone) = rested(1e-4);
    scene.teleport(frame.1, START).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    scene.advance_ticks(17);
    assert_eq!(scene.status(bone), SceneStatus::Asleep(i64::MAX));
    let turned = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.1).to_quaternion();
    scene.move_to(frame.1, turned).unwrap();
    scene.advance_ticks(4);
    assert_eq!(scene.status(bone), SceneStatus::Awake);
    assert!(1e-3 < scene.state(bone).0[1]);
}

#[test]
fn a_bone_on_a_live_frame_follows_one_on_the_formula() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let sample = |t: f64| -> ([f64; 3], [f64; 4]) {
        let (t, side, wanted) = (Time::new(t), Side::After, Derivatives::POSITION);
        let place: Sample<f64, 3> = shake().sample(t, side, wanted);
        let turn: Sample<f64, 4> = nod().sample(t, side, wanted);
        (place.position, turn.position)
    };
    let (place, turn) = sample(0.0);
    let live = scene.live_frame(place, Attitude::from_quaternion(turn)).unwrap();
    // The history of the frame.
    for frame in -4..=0 {
        let (place, turn) = sample(f64::from(frame) / 60.0);
        if frame == -4 {
            scene.teleport(live.0, place).unwrap();
            scene.teleport(live.1, turn).unwrap();
        }
        scene.move_to(live.0, place).unwrap();
        scene.move_to(live.1, turn).unwrap();
        scene.advance(1.0 / 60.0).unwrap();
    }
    let start = Attitude::from_quaternion(sample(0.0).1).to_quaternion();
    // The formula runs five frames later than the scene.
    let late = (scene.joint(Later(shake())), scene.joint(Later(nod())));
    let bones = [live, late].map(|joints| scene.hang(joints, bone(), start, [0.0; 4]).unwrap());
    let [mut apart, mut swing] = [0.0f64; 2];
    for frame in 1..=15 {
        let (place, turn) = sample(f64::from(frame) / 60.0);
        scene.move_to(live.0, place).unwrap();
        // The sign of a quaternion has no effect.
        scene.move_to(live.1, turn.map(|part| -2.0 * part)).unwrap();
        scene.advance(1.0 / 60.0).unwrap();
        let [told, true_] = bones.map(|bone| scene.state(bone).0);
        for i in 0..4 {
            (apart, swing) =
                (apart.max((told[i] - true_[i]).abs()), swing.max(true_[i] - start[i]));
        }
    }
    assert!(0.05 < swing && apart < 2e-3 * swing, "{apart} of {swing}");
}

/// A motion that is five frames late.
struct Later<M>(M);

impl<M: Motion<f64, D>, const D: usize> Motion<f64, D> for Later<M> {
    const HAS: Derivatives = M::HAS;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<f64, D> {
        self.0.sample(t + -5.0 / 60.0, side, wanted)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn quaternions_without_a_direction_are_refused_and_change_nothing() {
    let (mut scene, frame, _) = rested(0.0);
    scene.move_to(frame.1, [0.0, 1.0, 0.0, 0.0]).unwrap();
    let before = scene.snapshot();
    for bad in [[0.0; 4], [1e200; 4].map(|part: f64| part * 1e200), [f64::NAN, 0.0, 0.0, 1.0]] {
        assert!(scene.move_to(frame.1, bad).is_err() && scene.teleport(frame.1, bad).is_err());
    }
    let none = Attitude::from_quaternion([0.0; 4]);
    assert!(matches!(scene.live_frame([0.0; 3], none), Err(SceneError::Position { joint: 3, .. })));
    assert_eq!(scene.snapshot(), before);
}

#[test]
fn snapshots_hold_attitudes() {
    let (mut scene, frame, _) = rested(0.1);
    let turn = |scene: &mut Scene<f64>, frames: core::ops::Range<i32>| {
        for index in frames {
            let axis = [1.0, 0.1 * f64::from(index), 0.0];
            let attitude = Attitude::from_axis_angle(axis, 0.1 * f64::from(index));
            scene.move_to(frame.1, attitude.to_quaternion()).unwrap();
            scene.advance(0.7 / 60.0).unwrap();
        }
        (scene.checksum(), scene.joint_pose(frame.1, 0.3))
    };
    turn(&mut scene, 0..5);
    let snapshot = scene.snapshot();
    let end = turn(&mut scene, 5..10);
    scene.restore(&snapshot).unwrap();
    assert_eq!(turn(&mut scene, 5..10), end);
}
