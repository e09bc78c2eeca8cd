//! What users of spring bones report of other engines, as tests of bones.

use pendulum_runtime::attitude::Attitude;
use pendulum_runtime::motion::{Function, Sinusoid, Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Bone, Collider, Handle, Joint, Resume, Scene, Shape};
use systems::random::Random;

type Frame = (Joint<3>, Joint<4>);
type Hung = Handle<Bone<f64>, 4>;

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn attitude(scene: &Scene<f64>, bone: Hung) -> Attitude {
    Attitude::from_quaternion(scene.state(bone).0)
}

fn tail(scene: &mut Scene<f64>, frame: Frame, bone: &Bone) -> Vec<Hung> {
    scene.hang_chain(frame, [bone.clone(), bone.clone(), bone.clone()]).unwrap()
}

/// The largest difference of the attitudes of two chains.
fn apart(scenes: [&Scene<f64>; 2], bones: [&[Hung]; 2]) -> f64 {
    let of = |k: usize| bones[k].iter().flat_map(move |&bone| scenes[k].state(bone).0);
    of(0).zip(of(1)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn on_a_platform_that_moves_steadily_hair_hangs_as_on_one_that_rests() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let aside = Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.7);
    let bone = Bone::swinging(0.1, 1.5, 0.1).unwrap().under([0.0, -9.81, 0.0]);
    let [rests, moves] = [[0.0; 3], [30.0, 0.0, -4.0]].map(|velocity| {
        let place = Function::new(move |t: f64| velocity.map(|part| part * t));
        let place = place.velocity(move |_| velocity).acceleration(|_| [0.0; 3]);
        let frame = (scene.joint(place), scene.joint(Still::new(aside.to_quaternion())));
        tail(&mut scene, frame, &bone)
    });
    for _ in 0..60 {
        scene.advance(1.0 / 30.0).unwrap();
        assert!(apart([&scene, &scene], [&rests, &moves]) < 1e-9);
    }
    assert!(scene.state(rests[2]).1.iter().any(|rate| 1e-3 < rate.abs()), "it swings");
}

#[test]
fn hair_stays_behind_on_the_side_that_its_head_leaves_whatever_the_axes() {
    let mut random = Random::new(11);
    for _ in 0..20 {
        let vector = [(); 3].map(|()| random.uniform(-1.0, 1.0));
        let turn = Attitude::from_rotation_vector(vector.map(|part| 3.0 * part));
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let head = scene.live_frame([0.0; 3], turn).unwrap();
        let bone = Bone::swinging(0.1, 1.5, 0.3).unwrap();
        let bone = scene.hang(head, bone, turn.to_quaternion(), [0.0; 4]).unwrap();
        let before = turn * [0.0, 1.0, 0.0];
        for frame in 1..=8 {
            let way = 0.002 * f64::from(frame * frame);
            scene.move_to(head.0, vector.map(|part| way * part)).unwrap();
            scene.advance(1.0 / 60.0).unwrap();
        }
        let swing = minus(attitude(&scene, bone) * [0.0, 1.0, 0.0], before);
        // What lies along the bone itself moves nothing.
        let across = minus(vector, before.map(|part| dot(vector, before) * part));
        let square = dot(across, across).sqrt();
        assert!(dot(swing, across) < -0.03 * square * square, "{swing:?} by {across:?}");
    }
}

#[test]
fn a_character_of_another_size_moves_alike_at_the_same_times() {
    let bone = Bone::swinging(0.1, 1.5, 0.2).unwrap().under([0.0, -9.81, 0.0]);
    let run = |scale: f64| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let place = Sinusoid::new([0.05, 0.02, 0.0].map(|part| scale * part), 9.0, [0.0, 1.0, 0.0]);
        let turn = Turning::new([0.0, 0.0, 1.0], Sinusoid::new([0.4], 4.0, [0.0]));
        let frame = (scene.joint(place), scene.joint(turn));
        let bones = tail(&mut scene, frame, &bone.resized(scale).unwrap());
        scene.advance_ticks(480);
        (scene, bones)
    };
    let (here, bones) = run(1.0);
    for (scale, bound) in [(0.25, 0.0), (2.0, 0.0), (0.1, 1e-11), (17.0, 1e-11)] {
        let (there, others) = run(scale);
        let off = apart([&here, &there], [&bones, &others]);
        assert!(off <= bound, "{scale}: {off:e}");
    }
}

#[test]
fn gusts_move_hair_alike_at_every_frame_rate() {
    let run = |frames: &mut dyn FnMut() -> f64| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let head = (
            scene.joint(Still::new([0.0; 3])),
            scene.joint(Turning::new([1.0, 0.0, 0.0], Sinusoid::new([0.1], 3.0, [0.0]))),
        );
        let gusts = |t: f64| [4.0 + 3.0 * (5.0 * t).sin() * (1.3 * t).sin(), 0.0, (2.0 * t).cos()];
        let wind = scene.joint(Function::new(gusts));
        let bones = tail(&mut scene, head, &Bone::swinging(0.1, 1.5, 0.3).unwrap());
        for &bone in &bones {
            scene.set_wind(bone, Some(wind)).unwrap();
        }
        let mut t = 0.0;
        while t < 2.0 {
            let dt = frames().min(2.0 - t);
            scene.advance(dt).unwrap();
            t += dt;
        }
        let states = bones.iter().map(|&bone| scene.state(bone).0.map(f64::to_bits));
        states.collect::<Vec<_>>()
    };
    let expected = run(&mut || 1.0 / 60.0);
    for rate in [24.0, 30.0, 144.0] {
        assert_eq!(run(&mut || 1.0 / rate), expected, "{rate}");
    }
    let mut random = Random::new(3);
    assert_eq!(run(&mut || random.uniform(0.002, 0.05)), expected);
}

/// A character is hidden by levels of detail while it walks on, a collider goes with its part, and
/// bones are shown again in another order than they were hidden.
#[test]
fn bones_that_a_level_of_detail_hides_and_shows_neither_fail_nor_fly() {
    for resume in [Resume::Unchanged, Resume::Rest, Resume::CatchUp { longest: 0.5 }] {
        let mut random = Random::new(21);
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let head = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
        let bone = Bone::swinging(0.1, 1.5, 0.3).unwrap().under([0.0, -9.81, 0.0]);
        let bones = tail(&mut scene, head, &bone);
        let chest = scene.live_frame([0.05, 0.1, 0.0], Attitude::identity()).unwrap();
        let shape = Shape::Ball { center: [0.0; 3], radius: 0.04 };
        for &bone in &bones {
            scene.set_colliders(bone, 0.01, &[Collider { frame: chest, shape }]).unwrap();
        }
        let (mut place, mut hidden) = ([0.0; 3], [false; 3]);
        for frame in 0..240 {
            place = place.map(|part| part + 0.01);
            scene.move_to(head.0, place).unwrap();
            if frame < 120 {
                scene.move_to(chest.0, [place[0] + 0.05, place[1] + 0.1, place[2]]).unwrap();
            } else if frame == 120 {
                scene.remove_joint(chest.0).unwrap();
                scene.remove_joint(chest.1).unwrap();
            }
            let k = (random.bits() % 3) as usize;
            if hidden[k] {
                scene.show(bones[k], resume).unwrap();
            } else {
                scene.hide(bones[k]).unwrap();
            }
            hidden[k] = !hidden[k];
            scene.advance(1.0 / 60.0).unwrap();
            for &bone in &bones {
                let rate = scene.state(bone).1.map(|part| 2.0 * part);
                assert!(rate.iter().all(|part| part.abs() < 60.0), "{resume:?}: {rate:?}");
            }
        }
        assert!(scene.faults().is_empty(), "{resume:?}");
    }
}

/// The head jumps, a pause passes and frames are dropped: no jump is felt.
#[test]
fn hair_does_not_feel_jumps_of_its_head_at_any_frame_rate() {
    for rate in [24.0, 30.0, 60.0, 144.0] {
        let run = |jumps: bool| {
            let mut scene = Scene::<f64>::new(240.0).unwrap();
            scene.set_longest_frame(0.5).unwrap();
            let head = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
            let aside = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.5).to_quaternion();
            let bones = tail(&mut scene, head, &Bone::swinging(0.1, 1.5, 0.3).unwrap());
            scene.set_state(bones[0], aside, [0.0; 4]).unwrap();
            for frame in 1..=12 {
                if jumps && frame % 3 == 0 {
                    scene.teleport(head.0, [f64::from(frame), -7.0, 3.0]).unwrap();
                }
                scene.advance(1.0 / rate).unwrap();
                if jumps && frame == 7 {
                    scene.set_paused(true);
                    scene.advance(1.0).unwrap();
                    scene.set_paused(false);
                    scene.move_to(head.0, [100.0, 0.0, 0.0]).unwrap();
                }
            }
            (scene, bones)
        };
        let ((here, bones), (there, others)) = (run(false), run(true));
        let off = apart([&here, &there], [&bones, &others]);
        assert!(off < 1e-9, "{rate}: {off:e}");
    }
}
