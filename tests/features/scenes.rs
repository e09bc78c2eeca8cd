//! Snapshots of scenes as text.

use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::scene::{Scene, SceneError, Snapshot, Stop};
use systems::pendulums::{Double, Hanging, Simple};
use systems::random::Random;

/// Creates a scene with pendulums of several types on joints that move smoothly, with kinks, or not
/// at all.
fn zoo() -> Scene<f64> {
    let mut scene = Scene::new(240.0).unwrap();
    scene.set_tolerance(1e-3).unwrap();
    let mut random = Random::new(1);
    let kinks = Curve::linear(&[0.2, 0.61, 0.9], &[[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]).unwrap();
    let joints = [
        scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0])),
        scene.joint(kinks),
        scene.joint(Still::new([1.0, 2.0])),
    ];
    for index in 0..30 {
        let length = random.uniform(0.02, 1.0);
        let (q, v) = ([random.uniform(-2.0, 2.0)], [random.uniform(-1.0, 1.0)]);
        let joint = joints[index % 3];
        scene.hang(joint, Hanging::new(0.1, length), q, v).unwrap();
        scene.hang((), Simple::new(0.1, length), q, v).unwrap();
        let double = Double::new(0.1, 0.2 + length, 1e-4);
        scene.hang(joint, double, [q[0], 0.1], [v[0], 0.0]).unwrap();
    }
    scene
}

#[test]
fn snapshots_can_be_written_and_read() {
    let mut scene = zoo();
    let handle = scene.handle::<Hanging<f64>, 1>(4).unwrap();
    // A limit on one side only, because JSON has no infinity.
    scene.set_limits(handle, [-0.2], [f64::INFINITY], Stop::Hard { restitution: 0.5 }).unwrap();
    scene.advance(0.71).unwrap();
    let snapshot = scene.snapshot();
    let text = serde_json::to_string(&snapshot).unwrap();
    let read: Snapshot<f64> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, snapshot);
    // A damaged snapshot is refused, and the scene continues unchanged.
    let clock = serde_json::to_value(&snapshot).unwrap()["clock"].to_string();
    for (good, bad) in [
        ("\"Leapfrog\",1", "\"Leapfrog\",0"),
        ("\"Rk4\",1", "\"Srkn6b\",1"),
        ("\"Rk4\",1", "\"Rk4\",4000000000"),
    ] {
        assert!(text.contains(good), "{good}");
        let damaged: Snapshot<f64> = serde_json::from_str(&text.replacen(good, bad, 1)).unwrap();
        assert!(matches!(scene.restore(&damaged), Err(SceneError::Snapshot(_))), "{bad}");
    }
    let damaged = text.replacen(&clock, "[9223372036854775807,0,[0.0,0.0]]", 1);
    assert!(matches!(
        scene.restore(&serde_json::from_str(&damaged).unwrap()),
        Err(SceneError::Snapshot(_))
    ));
    scene.advance(0.9).unwrap();
    let mut other = zoo();
    other.restore(&read).unwrap();
    other.advance(0.9).unwrap();
    assert_eq!(other.checksum(), scene.checksum());
}

#[test]
fn snapshots_hold_the_positions_of_live_joints() {
    const FRAME: f64 = 1.0 / 64.0;
    let mut scene = Scene::new(256.0).unwrap();
    let joint = scene.live([0.0, 0.0]).unwrap();
    scene.hang(joint, Hanging::new(0.1, 0.3), [0.2], [0.1]).unwrap();
    let shake = |scene: &mut Scene<f64>, begin: u32| {
        for frame in begin..begin + 10 {
            let t = FRAME * f64::from(frame + 1);
            scene.move_to(joint, [0.05 * (4.0 * t).sin(), 0.02 * (7.0 * t).sin()]).unwrap();
            scene.advance(FRAME).unwrap();
        }
    };
    shake(&mut scene, 0);
    let text = serde_json::to_string(&scene.snapshot()).unwrap();
    shake(&mut scene, 10);
    let end = scene.checksum();
    scene.restore(&serde_json::from_str(&text).unwrap()).unwrap();
    shake(&mut scene, 10);
    assert_eq!(scene.checksum(), end);
}
