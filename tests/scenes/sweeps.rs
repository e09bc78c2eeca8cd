//! Bodies that move fast do not pass bones within a tick.

use core::f64::consts::TAU;
use pendulum_runtime::motion::{Curve, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Bone, Collider, Handle, Joint, Scene, Shape};
use systems::random::Random;

type Frame = (Joint<3>, Joint<4>);
type Hung = Handle<Bone<f64>, 4>;

const LENGTH: f64 = 0.25;
const SIZE: f64 = 1e-3;
const IDENTITY: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const SPEEDS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
const BALL: Shape = Shape::Ball { center: [0.0; 3], radius: SIZE };

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The least distance of two lines between points: that of a point of the first line from the
/// second one is a convex function, whose minimum is found by trisection.
fn distance(one: [[f64; 3]; 2], [a, b]: [[f64; 3]; 2]) -> f64 {
    let on = |[a, b]: [[f64; 3]; 2], s: f64| core::array::from_fn(|i| a[i] + s * (b[i] - a[i]));
    let at = |s: f64| {
        let (p, along) = (on(one, s), minus(b, a));
        let square = dot(along, along);
        let t =
            if square == 0.0 { 0.0 } else { (dot(minus(p, a), along) / square).clamp(0.0, 1.0) };
        length(minus(p, on([a, b], t)))
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..80 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(a) < at(b) { high = b } else { low = a }
    }
    at(low)
}

/// A bone that stays wherever it is put, from the origin upwards.
fn loose(rate: f64) -> (Scene<f64>, Hung) {
    let mut scene = Scene::new(rate).unwrap();
    let frame = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
    let bone = scene.hang(frame, Bone::new(LENGTH, 0.0, 0.0), IDENTITY, [0.0; 4]).unwrap();
    (scene, bone)
}

/// The joint and the tip of a bone at the last tick.
fn ends(scene: &Scene<f64>, bone: Hung) -> [[f64; 3]; 2] {
    let seen = scene.observe(bone, 1.0);
    [seen.inputs.0.position, seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs)]
}

/// A frame that flies along a line in a quarter of a second, past its middle at half of the time.
fn flight(scene: &mut Scene<f64>, middle: [f64; 3], velocity: [f64; 3]) -> Frame {
    let at = |t: f64| core::array::from_fn(|i| middle[i] + t * velocity[i]);
    let place = Curve::linear(&[0.0, 0.25], &[at(-0.125), at(0.125)]).unwrap();
    (scene.joint(place), scene.joint(Still::new(IDENTITY)))
}

/// Asserts that a line along which a ball has flown does not cut a bone.
#[track_caller]
fn uncut(scene: &Scene<f64>, bone: Hung, middle: [f64; 3], velocity: [f64; 3]) {
    let line = [-1.0, 1.0].map(|t| core::array::from_fn(|i| middle[i] + t * velocity[i]));
    let left = distance(ends(scene, bone), line);
    assert!(0.5 * SIZE < left, "{velocity:?} past {middle:?}: {left:e}");
}

#[test]
fn a_ball_of_a_millimetre_passes_no_bone() {
    let mut random = Random::new(3);
    for rate in [24.0, 120.0] {
        for speed in SPEEDS {
            let (mut scene, bone) = loose(rate);
            let middle = [
                random.uniform(-0.05, 0.05),
                random.uniform(0.02, 0.24),
                random.uniform(-4e-4, 4e-4),
            ];
            let velocity = [speed, speed * random.uniform(-0.1, 0.1), 0.0];
            let frame = flight(&mut scene, middle, velocity);
            scene.set_colliders(bone, 0.0, &[Collider { frame, shape: BALL }]).unwrap();
            for _ in 0..(0.25 * rate) as u32 {
                scene.advance_ticks(1);
                let place = scene.joint_pose(frame.0, 1.0);
                let left = distance(ends(&scene, bone), [place; 2]) - SIZE;
                assert!(-1e-6 < left, "{speed}: {left:e}");
            }
            uncut(&scene, bone, middle, velocity);
            assert!(1e-4 < length(minus(ends(&scene, bone)[1], [0.0, LENGTH, 0.0])));
            assert!(scene.faults().is_empty());
        }
    }
}

#[test]
fn two_balls_at_once_pass_no_bone() {
    for speed in SPEEDS {
        let (mut scene, bone) = loose(120.0);
        let middles = [[0.0, 0.1, 3e-4], [0.01, 0.2, -2e-4]];
        let velocity = [speed, 0.0, 0.0];
        let frames = middles.map(|middle| flight(&mut scene, middle, velocity));
        let colliders = frames.map(|frame| Collider { frame, shape: BALL });
        scene.set_colliders(bone, 0.0, &colliders).unwrap();
        for _ in 0..30 {
            scene.advance_ticks(1);
            for frame in frames {
                let place = scene.joint_pose(frame.0, 1.0);
                let left = distance(ends(&scene, bone), [place; 2]) - SIZE;
                assert!(-1e-6 < left, "{speed}: {left:e}");
            }
        }
        for middle in middles {
            uncut(&scene, bone, middle, velocity);
        }
    }
}

#[test]
fn a_ball_that_a_program_throws_passes_no_bone() {
    for speed in SPEEDS {
        let (mut scene, bone) = loose(120.0);
        let (step, middle) = (speed / 24.0, [0.3, 0.15, 2e-4]);
        let at = |frame: f64| [(frame - 6.3) * step, middle[1], middle[2]];
        let frame = scene.live_frame(at(0.0), Attitude::identity()).unwrap();
        scene.set_colliders(bone, 0.0, &[Collider { frame, shape: BALL }]).unwrap();
        let count = if speed < 20.0 { 24 } else { 12 };
        for k in 1..=count {
            scene.move_to(frame.0, at(f64::from(k))).unwrap();
            scene.advance(1.0 / 24.0).unwrap();
            let place = scene.joint_pose(frame.0, 1.0);
            let left = distance(ends(&scene, bone), [place; 2]) - SIZE;
            assert!(-1e-6 < left, "{speed}: {left:e}");
        }
        uncut(&scene, bone, middle, [speed, 0.0, 0.0]);
    }
}

#[test]
fn a_capsule_that_turns_passes_no_bone() {
    for speed in SPEEDS {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        let aside = Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.25 * TAU).to_quaternion();
        // From 0.4 m towards the axis of the turn, past the end of the capsule.
        let frame = (scene.joint(Still::new([0.4, 0.0, 0.0])), scene.joint(Still::new(aside)));
        let bone = scene.hang(frame, Bone::new(LENGTH, 0.0, 0.0), aside, [0.0; 4]).unwrap();
        let turn = 0.25 * speed / 0.3;
        let angle = Curve::linear(&[0.0, 0.25], &[[1.0], [1.0 + turn]]).unwrap();
        let turning = scene.joint(Turning::new([0.0, 0.0, 1.0], angle));
        let frame = (scene.joint(Still::new([0.0, 0.0, 1e-4])), turning);
        let shape = Shape::Capsule { ends: [[0.1, 0.0, 0.0], [0.3, 0.0, 0.0]], radius: SIZE };
        scene.set_colliders(bone, 0.0, &[Collider { frame, shape }]).unwrap();
        for _ in 0..30 {
            scene.advance_ticks(1);
            let turn = Attitude::from_quaternion(scene.joint_pose(turning, 1.0));
            let line = [0.1, 0.3].map(|x| {
                let [x, y, z] = turn * [x, 0.0, 0.0];
                [x, y, z + 1e-4]
            });
            let left = distance(ends(&scene, bone), line) - SIZE;
            assert!(-1e-6 < left, "{speed}: {left:e}");
        }
        // At least once around, the capsule has moved the tip out of its way.
        if TAU < turn {
            let [x, y, z] = ends(&scene, bone)[1];
            assert!(0.299 < x.hypot(y) || 0.9 * SIZE < z.abs(), "{speed}: {:?}", [x, y, z]);
        }
    }
}

#[test]
fn planes_push_bones_before_them_at_any_speed() {
    for speed in SPEEDS {
        let (mut scene, bone) = loose(120.0);
        // From far above down to 5 cm above the joint.
        let (time, stop) = (0.25, 0.05);
        let place = [[0.0, stop + time * speed, 0.0], [0.0, stop, 0.0]];
        let place = scene.joint(Curve::linear(&[0.0, time], &place).unwrap());
        let frame = (place, scene.joint(Still::new(IDENTITY)));
        let shape = Shape::Half { point: [0.0; 3], normal: [0.1, -1.0, 0.0] };
        scene.set_colliders(bone, 0.0, &[Collider { frame, shape }]).unwrap();
        for _ in 0..45 {
            scene.advance_ticks(1);
            let off = minus(ends(&scene, bone)[1], scene.joint_pose(place, 1.0));
            let left = dot(off, [0.1, -1.0, 0.0]) / 1.01f64.sqrt();
            assert!(-1e-6 < left, "{speed}: {left:e}");
        }
    }
}

#[test]
fn a_ball_passes_no_bone_of_a_chain() {
    for speed in SPEEDS {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        let root = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
        let chain = scene.hang_chain(root, (0..4).map(|_| Bone::new(0.1, 0.0, 0.0))).unwrap();
        let (middle, velocity) = ([0.02, 0.17, 1e-4], [speed, 0.0, 0.0]);
        let frame = flight(&mut scene, middle, velocity);
        for &bone in &chain {
            scene.set_colliders(bone, 0.0, &[Collider { frame, shape: BALL }]).unwrap();
        }
        for _ in 0..30 {
            scene.advance_ticks(1);
            let place = scene.joint_pose(frame.0, 1.0);
            for &bone in &chain {
                let left = distance(ends(&scene, bone), [place; 2]) - SIZE;
                assert!(-1e-6 < left, "{speed}: {left:e}");
            }
        }
        uncut(&scene, chain[1], middle, velocity);
    }
}

#[test]
fn a_fast_ball_gives_no_velocity_and_takes_no_fault() {
    for speed in SPEEDS {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        let frame = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
        let bone = Bone::swinging(LENGTH, 1.0, 0.0).unwrap();
        let bone = scene.hang(frame, bone, IDENTITY, [0.0; 4]).unwrap();
        let frame = flight(&mut scene, [0.0, 0.2, 1e-4], [speed, 0.0, 0.0]);
        scene.set_colliders(bone, 0.0, &[Collider { frame, shape: BALL }]).unwrap();
        // The ball lifts the bone by its work, at most to the opposite of its rest.
        let (rest, most) = (scene.energy(bone), 4.0 * (0.5 * TAU * TAU));
        for _ in 0..30 {
            scene.advance_ticks(1);
            assert!(scene.energy(bone) - rest < most, "{speed}");
        }
        assert!(scene.faults().is_empty());
    }
}

#[test]
fn a_joint_inside_a_body_is_held_only_at_the_tip() {
    let (mut scene, bone) = loose(60.0);
    let frame = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
    // The bone leaves a ball as hair leaves a head.
    let shape = Shape::Ball { center: [0.02, -0.05, 0.0], radius: 0.1 };
    scene.set_colliders(bone, 0.01, &[Collider { frame, shape }]).unwrap();
    scene.advance_ticks(30);
    assert_eq!(scene.state(bone).0, IDENTITY);
    // A ball that holds all of it leaves it pointing straight out.
    let shape = Shape::Ball { center: [0.1, 0.0, 0.0], radius: 0.5 };
    scene.set_colliders(bone, 0.01, &[Collider { frame, shape }]).unwrap();
    scene.advance_ticks(30);
    let tip = ends(&scene, bone)[1];
    assert!(length(minus(tip, [-LENGTH, 0.0, 0.0])) < 1e-3, "{tip:?}");
    let before = scene.state(bone).0;
    scene.advance_ticks(30);
    let after = scene.state(bone).0;
    assert!((0..4).all(|i| (before[i] - after[i]).abs() < 1e-6), "it rests");
}

#[test]
fn frames_other_bones_and_threads_change_no_bit() {
    let run = |frames: &[f64], others: u32, fork: bool| {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        let root = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
        let frame = flight(&mut scene, [0.0, 0.15, 2e-4], [30.0, 0.0, 0.0]);
        let hung: Vec<_> = (0..=others)
            .map(|k| {
                let bone = Bone::swinging(LENGTH, 1.0 + 0.1 * f64::from(k), 0.1).unwrap();
                let bone = scene.hang(root, bone, IDENTITY, [0.0; 4]).unwrap();
                scene.set_colliders(bone, 0.0, &[Collider { frame, shape: BALL }]).unwrap();
                bone
            })
            .collect();
        scene.set_always_fork(fork);
        scene.set_parallel(fork);
        for &frame in frames {
            scene.advance(frame).unwrap();
        }
        scene.state(hung[0])
    };
    let alone = run(&[0.2], 0, false);
    assert_ne!(alone.0, IDENTITY);
    assert_eq!(run(&[1.0 / 60.0; 12], 0, false), alone);
    assert_eq!(run(&[0.01, 0.1, 0.003, 0.087], 40, true), alone);
}

/// A bone that leaves bodies at a finite speed is always compared with them exactly, and at an
/// enormous one it leaves as at once.
#[test]
fn bounds_of_what_is_far_change_no_bit() {
    let mut random = Random::new(11);
    let (mut touched, mut free) = (0, 0);
    for round in 0..40 {
        let rate = [24.0, 240.0][round % 2];
        let speed = 10f64.powf(random.uniform(-1.0, 2.5));
        let middle = [0, 1, 2].map(|_| random.uniform(-0.2, 0.2));
        let velocity = [speed, random.uniform(-speed, speed), 0.0];
        let shapes = [
            Shape::Ball { center: [0.0; 3], radius: random.uniform(1e-3, 0.15) },
            Shape::Capsule { ends: [[-0.3, 0.1, 0.0], [0.3, 0.2, 0.1]], radius: 0.02 },
            Shape::Half { point: [0.0, random.uniform(-0.1, 0.3), 0.0], normal: [0.2, 2.0, 0.0] },
            Shape::Inside { ends: [[0.0, 0.1, 0.0]; 2], radius: random.uniform(0.2, 0.6) },
        ];
        let run = |bodies: usize, leaves: f64| {
            let mut scene = Scene::<f64>::new(rate).unwrap();
            let place = scene.joint(Sinusoid::new([0.05, 0.02, 0.03], 7.0, [0.0, 1.0, 2.0]));
            let frame = (place, scene.joint(Still::new(IDENTITY)));
            let bone = Bone::swinging(LENGTH, 1.5, 0.2).unwrap().under([0.0, -9.81, 0.0]);
            let bone = scene.hang(frame, bone, IDENTITY, [0.0; 4]).unwrap();
            let flying = flight(&mut scene, middle, velocity);
            let frames = [flying, flying, frame, frame];
            let all = frames.into_iter().zip(shapes);
            let all = all.map(|(frame, shape)| Collider { frame, shape }).take(bodies);
            scene.set_colliders(bone, 0.01, &all.collect::<Vec<_>>()).unwrap();
            scene.set_push_out(bone, leaves).unwrap();
            let mut states = Vec::new();
            for _ in 0..(0.25 * rate) as u32 {
                scene.advance_ticks(1);
                states.push(scene.state(bone));
            }
            states
        };
        let bodies = 1 + round % 4;
        let bounded = run(bodies, f64::INFINITY);
        assert_eq!(bounded, run(bodies, 1e300), "{round}");
        if bounded == run(0, f64::INFINITY) { free += 1 } else { touched += 1 }
    }
    assert!(5 < touched && 5 < free, "{touched} {free}");
}
