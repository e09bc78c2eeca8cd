//! Removal of pendulums, joints and bundles.

use pendulum_runtime::motion::{Sinusoid, Still};
use pendulum_runtime::scene::{Handle, Joint, Scene, SceneError};

use systems::pendulums::{Double, Hanging};

type Single = Handle<Hanging<f64>, 1>;

/// A scene with five pendulums of different lengths on a joint that moves.
fn five() -> (Scene<f64>, Joint<2>, Vec<Single>) {
    let mut scene = Scene::new(240.0).unwrap();
    let joint = scene.joint(Sinusoid::new([0.05, 0.0], 8.0, [0.0, 0.0]));
    let hung = (0..5).map(|index| hang(&mut scene, joint, index)).collect();
    (scene, joint, hung)
}

fn hang(scene: &mut Scene<f64>, joint: Joint<2>, index: u32) -> Single {
    let length = 0.1 + 0.1 * f64::from(index);
    scene.hang(joint, Hanging::new(0.1, length), [0.1], [0.0]).unwrap()
}

#[test]
fn the_others_keep_their_bits() {
    let (mut scene, _, hung) = five();
    let (mut all, _, same) = five();
    scene.advance(0.1).unwrap();
    scene.remove(hung[1]).unwrap();
    scene.remove(hung[4]).unwrap();
    assert_eq!(scene.awake(), (3, 3));
    scene.advance(0.3).unwrap();
    all.advance(0.4).unwrap();
    for index in [0, 2, 3] {
        assert_eq!(scene.state(hung[index]), all.state(same[index]));
    }
    let mut poses = Vec::new();
    scene.poses::<Hanging<f64>, 1>(1.0, &mut poses);
    assert_eq!(poses, [0, 2, 3].map(|index| all.state(same[index]).0));
}

#[test]
fn old_handles_are_errors_and_never_another_pendulum() {
    let (mut scene, joint, hung) = five();
    scene.remove(hung[2]).unwrap();
    assert!(scene.handle::<Hanging<f64>, 1>(2).is_none());
    let refused = |scene: &mut Scene<f64>| {
        let error = scene.set_state(hung[2], [0.5], [0.0]).unwrap_err();
        assert_eq!(error, SceneError::Pendulum { kind: "Hanging", index: 2 });
        assert!(error.to_string().contains("has been removed"), "{error}");
        assert!(scene.remove(hung[2]).is_err() && scene.hide(hung[2]).is_err());
        assert!(scene.set_parameter(hung[2], "L", 0.1).is_err());
    };
    refused(&mut scene);
    let next = hang(&mut scene, joint, 7);
    assert_eq!(next.index(), 2);
    assert_ne!(next, hung[2]);
    assert_eq!(scene.handle(2), Some(next));
    let before = scene.checksum();
    refused(&mut scene);
    assert_eq!(scene.checksum(), before);
}

#[test]
fn a_pendulum_in_place_of_another_has_the_bits_of_a_new_one() {
    let (mut scene, joint, hung) = five();
    scene.set_damping(hung[3], 2.0).unwrap();
    scene.hide(hung[3]).unwrap();
    scene.remove(hung[3]).unwrap();
    let next = hang(&mut scene, joint, 3);
    let (mut other, _, same) = five();
    for scene in [&mut scene, &mut other] {
        scene.advance(0.3).unwrap();
    }
    assert_eq!(scene.state(next), other.state(same[3]));
    assert_eq!(scene.status(next), other.status(same[3]));
}

#[test]
fn joints_that_carry_something_stay() {
    let (mut scene, joint, hung) = five();
    let error = scene.remove_joint(joint).unwrap_err();
    assert_eq!(error, SceneError::Carries { joint: 0, inputs: 5 });
    for &pendulum in &hung {
        scene.remove(pendulum).unwrap();
    }
    scene.remove_joint(joint).unwrap();
    assert_eq!(scene.remove_joint(joint), Err(SceneError::Joint(0)));
    scene.advance(0.1).unwrap();
    // Its place is used again, under another name.
    let next = scene.joint(Still::new([3.0, 4.0]));
    assert_eq!(format!("{joint:?} {next:?}"), "Joint(0) Joint(0)");
    assert_ne!(joint, next);
    let system = Hanging::new(0.1, 0.3);
    assert_eq!(scene.hang(joint, system, [0.1], [0.0]), Err(SceneError::Joint(0)));
    assert_eq!(scene.joint_pose(next, 1.0), [3.0, 4.0]);
}

#[test]
fn a_joint_in_place_of_another_is_felt_as_a_new_one() {
    // The earlier joint is at rest, so that its samples are kept; the next one moves, with kinks.
    for first in [true, false] {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        if first {
            let still = scene.joint(Still::new([3.0, 4.0]));
            let bob = hang(&mut scene, still, 0);
            scene.advance(0.1).unwrap();
            scene.remove(bob).unwrap();
            scene.remove_joint(still).unwrap();
        } else {
            scene.advance(0.1).unwrap();
        }
        let joint = scene.joint(crate::interface::keys());
        let bob = hang(&mut scene, joint, 0);
        scene.advance(0.5).unwrap();
        let mut fresh = Scene::<f64>::new(240.0).unwrap();
        fresh.advance(0.1).unwrap();
        let joint = fresh.joint(crate::interface::keys());
        let same = hang(&mut fresh, joint, 0);
        fresh.advance(0.5).unwrap();
        assert_eq!(scene.state(bob), fresh.state(same), "{first}");
    }
}

#[test]
fn removed_live_joints_are_not_moved() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| scene.live([x, 0.0]).unwrap());
    scene.remove_joint(b).unwrap();
    assert_eq!(scene.move_to(b, [0.0, 0.0]), Err(SceneError::Joint(1)));
    assert_eq!(scene.teleport(b, [0.0, 0.0]), Err(SceneError::Joint(1)));
    let next = scene.live([5.0, 0.0]).unwrap();
    for joint in [a, c, next] {
        scene.move_to(joint, [0.0, 7.0]).unwrap();
    }
    assert_eq!(scene.advance(0.1).unwrap().jumped, 3);
    assert_eq!(scene.joint_pose(next, 1.0), [0.0, 7.0]);
    assert!(scene.move_to(b, [0.0, 0.0]).is_err());
}

/// Adds a character: a live joint and one that moves, with pendulums on them.
fn spawn(scene: &mut Scene<f64>) -> Result<(Joint<2>, Single), SceneError> {
    let head = scene.live([0.0, 0.0])?;
    let tail = scene.joint(Sinusoid::new([0.05, 0.0], 8.0, [0.0, 0.0]));
    scene.hang(tail, Double::new(0.1, 0.2, 1e-4), [0.1, 0.2], [0.0, 0.0])?;
    let ear = scene.hang(head, Hanging::new(0.1, 0.3), [0.1], [0.0])?;
    Ok((head, ear))
}

#[test]
fn a_bundle_takes_all_that_was_added_with_it() {
    let (mut scene, _, hung) = five();
    let (character, (head, ear)) = scene.bundle(spawn).unwrap();
    assert_eq!(scene.awake().1, 7);
    scene.remove(ear).unwrap();
    scene.remove_bundle(&character).unwrap();
    assert_eq!(scene.awake().1, 5);
    assert!(scene.move_to(head, [0.0, 0.0]).is_err());
    let error = scene.remove_bundle(&character).unwrap_err();
    assert_eq!(error, SceneError::Bundle);
    assert!(error.to_string().contains("bundle"), "{error}");
    scene.advance(0.1).unwrap();
    scene.status(hung[4]);
}

#[test]
fn a_bundle_whose_joint_carries_another_pendulum_stays() {
    let (mut scene, ..) = five();
    let (character, (head, ear)) = scene.bundle(spawn).unwrap();
    let other = hang(&mut scene, head, 1);
    assert!(matches!(
        scene.remove_bundle(&character),
        Err(SceneError::Carries { joint: 1, inputs: 1 })
    ));
    scene.status(ear);
    scene.remove(other).unwrap();
    scene.remove_bundle(&character).unwrap();
}

#[test]
fn a_bundle_that_fails_leaves_nothing() {
    let (mut scene, ..) = five();
    let failed = scene.bundle(|scene| {
        spawn(scene)?;
        scene.live([f64::NAN])
    });
    assert!(matches!(failed, Err(SceneError::Position { .. })));
    assert_eq!(scene.awake().1, 5);
    assert_eq!(format!("{:?}", scene.live([0.0]).unwrap()).len(), "Joint(1)".len());
}

#[test]
fn inner_bundles_belong_to_the_outer_one() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let (outer, inner) = scene.bundle(|scene| scene.bundle(spawn)).unwrap();
    scene.remove_bundle(&outer).unwrap();
    assert_eq!(scene.awake(), (0, 0));
    assert_eq!(scene.remove_bundle(&inner.0), Err(SceneError::Bundle));
}

#[test]
fn a_day_of_spawning_uses_the_same_places_again() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let mut characters = std::collections::VecDeque::new();
    for round in 0..500 {
        let (character, (head, ear)) = scene.bundle(spawn).unwrap();
        assert!(ear.index() < 3, "{ear:?}");
        assert!(format!("{head:?}").len() == "Joint(5)".len(), "{head:?}");
        characters.push_back((character, ear));
        if 2 < characters.len() {
            let (character, ear) = characters.pop_front().unwrap();
            scene.status(ear);
            scene.remove_bundle(&character).unwrap();
        }
        if round % 50 == 0 {
            scene.advance(0.01).unwrap();
        }
    }
    assert_eq!(scene.awake(), (4, 4));
}

#[test]
fn snapshots_hold_what_lives_and_are_refused_by_others() {
    let (mut scene, joint, hung) = five();
    let all = scene.snapshot();
    scene.remove(hung[1]).unwrap();
    let four = scene.snapshot();
    assert!(matches!(scene.restore(&all), Err(SceneError::Snapshot(_))));
    scene.advance(0.2).unwrap();
    let end = scene.checksum();
    scene.restore(&four).unwrap();
    scene.advance(0.2).unwrap();
    assert_eq!(scene.checksum(), end);
    // As many as before, but not the same.
    hang(&mut scene, joint, 6);
    assert!(matches!(scene.restore(&all), Err(SceneError::Snapshot(_))));
    // A scene that was built of those that live takes them in their order.
    let mut built = Scene::<f64>::new(240.0).unwrap();
    let joint = built.joint(Sinusoid::new([0.05, 0.0], 8.0, [0.0, 0.0]));
    let same = [0, 2, 3, 4].map(|index| hang(&mut built, joint, index));
    built.restore(&four).unwrap();
    scene.remove(scene.handle::<Hanging<f64>, 1>(1).unwrap()).unwrap();
    scene.restore(&four).unwrap();
    for scene in [&mut scene, &mut built] {
        scene.advance(0.2).unwrap();
    }
    for (old, new) in [0, 2, 3, 4].into_iter().zip(same) {
        assert_eq!(scene.state(hung[old]), built.state(new));
    }
}

#[test]
fn removed_sleepers_do_not_wake_others() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let hook = scene.joint(Still::new([0.0, 0.0]));
    let bobs: Vec<_> =
        (0..3).map(|_| scene.hang(hook, Hanging::new(0.1, 0.3), [0.0], [0.0]).unwrap()).collect();
    scene.set_sleep(Some(1e-3)).unwrap();
    scene.advance(0.2).unwrap();
    assert_eq!(scene.awake(), (0, 3));
    scene.remove(bobs[0]).unwrap();
    scene.advance(0.2).unwrap();
    assert_eq!(scene.awake(), (0, 2));
    let next = scene.hang(hook, Hanging::new(0.1, 0.3), [0.5], [0.0]).unwrap();
    scene.advance(0.2).unwrap();
    assert_eq!(scene.awake(), (1, 3));
    assert_ne!(scene.state(next).0, [0.5]);
}
