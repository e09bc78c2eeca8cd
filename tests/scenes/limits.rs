//! Colliders and bounds of bones.

use pendulum_runtime::motion::Still;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{
    Bone, Bound, Collider, Handle, Joint, Scene, SceneError, SceneStatus, Shape,
};
use systems::random::Random;

type Frame = (Joint<3>, Joint<4>);
type Hung = Handle<Bone<f64>, 4>;

const LENGTH: f64 = 0.25;
const RADIUS: f64 = 0.01;
const IDENTITY: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|a| a * a).sum::<f64>().sqrt()
}

/// The distance of a point from a line between two points.
fn distance(p: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
    let (along, off) = (minus(b, a), minus(p, a));
    let square = length(along).powi(2);
    let dot: f64 = (0..3).map(|i| along[i] * off[i]).sum();
    let t = if square == 0.0 { 0.0 } else { (dot / square).clamp(0.0, 1.0) };
    length(core::array::from_fn(|i| off[i] - t * along[i]))
}

/// The distance between a bone and the surface of a shape at the origin, without turn; negative
/// inside. The distance of a point on a line from a capsule is a convex function, whose minimum is
/// found by trisection.
fn clearance(shape: &Shape, joint: [f64; 3], tip: [f64; 3]) -> f64 {
    let (ends, radius) = match *shape {
        Shape::Half { point, normal } => {
            let off = minus(tip, point);
            let height: f64 = (0..3).map(|i| off[i] * normal[i]).sum();
            return height / length(normal) - RADIUS;
        }
        Shape::Inside { ends, radius } => return radius - RADIUS - distance(tip, ends),
        Shape::Ball { center, radius } => ([center; 2], radius),
        Shape::Capsule { ends, radius } => (ends, radius),
        _ => panic!("another shape"),
    };
    let at = |s: f64| distance(core::array::from_fn(|i| joint[i] + s * (tip[i] - joint[i])), ends);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(a) < at(b) { high = b } else { low = a }
    }
    at(low) - radius - RADIUS
}

/// A scene with a bone of 0.25 m on a live frame, and a frame at the origin.
fn scene(rate: f64, turn: Attitude, bone: Bone) -> (Scene<f64>, Frame, Frame, Hung) {
    let mut scene = Scene::new(rate).unwrap();
    let frame = scene.live_frame([0.0, 0.3, 0.0], turn).unwrap();
    let origin = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
    let bone = scene.hang(frame, bone, turn.to_quaternion(), [0.0; 4]).unwrap();
    (scene, frame, origin, bone)
}

/// The joint and the tip of a bone at the last tick.
fn ends(scene: &Scene<f64>, bone: Hung) -> [[f64; 3]; 2] {
    let seen = scene.observe(bone, 1.0);
    [seen.inputs.0.position, seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs)]
}

fn heavy() -> Bone {
    Bone::swinging(LENGTH, 1.0, 0.1).unwrap().under([0.0, -9.81, 0.0])
}

fn sideways() -> Attitude {
    Attitude::from_axis_angle([0.0, 0.0, 1.0], 1.5)
}

fn shapes() -> [Shape; 4] {
    [
        Shape::Ball { center: [-0.12, 0.0, 0.02], radius: 0.15 },
        Shape::Capsule { ends: [[-0.2, 0.05, -0.3], [-0.1, 0.05, 0.3]], radius: 0.04 },
        Shape::Half { point: [0.0, 0.1, 0.0], normal: [0.5, 2.0, 0.0] },
        Shape::Inside { ends: [[0.0, 0.3, -0.1], [0.0, 0.3, 0.1]], radius: 0.23 },
    ]
}

#[test]
fn bones_do_not_enter_what_they_are_shaken_against() {
    for shape in shapes() {
        let (mut scene, frame, origin, bone) = scene(60.0, sideways(), heavy());
        scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
        let (mut random, mut touched) = (Random::new(5), 0);
        for tick in 0..120 {
            let place = [0.3, 0.6, 0.3].map(|size| size * random.uniform(-0.05, 0.05));
            scene.move_to(frame.0, [place[0], 0.3 + place[1], place[2]]).unwrap();
            scene.advance_ticks(1);
            let [joint, tip] = ends(&scene, bone);
            let left = clearance(&shape, joint, tip);
            assert!(-1e-6 < left, "{shape:?} at tick {tick}: {left:e}");
            touched += i32::from(left < 1e-6);
        }
        assert!(0 < touched, "{shape:?}");
        assert!(scene.faults().is_empty());
    }
}

#[test]
fn energy_does_not_grow_on_bodies_that_rest() {
    for shape in shapes() {
        let bone = Bone::swinging(LENGTH, 0.7, 0.0).unwrap().under([0.0, -9.81, 0.0]);
        let (mut scene, _, origin, bone) = scene(120.0, sideways(), bone);
        scene.set_tolerance(1e-6).unwrap();
        scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
        scene.set_bounds(bone, &[Bound::Cone(1.4)]).unwrap();
        // A bone that is inside at the beginning is lifted out.
        scene.advance_ticks(1);
        let (mut before, mut touched) = (scene.energy(bone), 0);
        for tick in 0..100 {
            scene.advance_ticks(1);
            let [joint, tip] = ends(&scene, bone);
            touched += i32::from(clearance(&shape, joint, tip) < 1e-6);
            let energy = scene.energy(bone);
            // g/L is 39/s².
            assert!(energy < before + 39.0 * 1e-5, "{shape:?} at {tick}: {before} {energy}");
            before = energy;
        }
        assert!(20 < touched, "{shape:?}: {touched}");
    }
}

#[test]
fn a_bone_stays_in_its_cone() {
    let bone = Bone::swinging(LENGTH, 1.0, 0.05).unwrap().under([0.0, -9.81, 0.0]);
    let (mut scene, frame, _, bone) = scene(60.0, sideways(), bone);
    scene.set_bounds(bone, &[Bound::Cone(0.3)]).unwrap();
    let mut most = 0.0f64;
    for tick in 0..60 {
        let turn = 1.5 + 0.8 * (0.4 * f64::from(tick)).sin();
        let turn = Attitude::from_axis_angle([0.0, 0.2, 1.0], turn);
        scene.move_to(frame.1, turn.to_quaternion()).unwrap();
        scene.advance_ticks(1);
        let axis = Attitude::from_quaternion(scene.state(bone).0) * [0.0, 1.0, 0.0];
        let middle = turn * [0.0, 1.0, 0.0];
        let angle = 2.0 * (0.5 * length(minus(axis, middle))).asin();
        assert!(angle < 0.3 + 1e-6, "{angle} at {tick}");
        most = most.max(angle);
    }
    assert!(0.299 < most, "{most}");
}

#[test]
fn a_steady_wind_acts_as_gravity_does() {
    let run = |gravity: [f64; 3], wind: [f64; 3]| {
        let bone = Bone::swinging(LENGTH, 1.0, 0.3).unwrap().under(gravity);
        let (mut scene, _, _, bone) = scene(240.0, sideways(), bone);
        scene.set_tolerance(1e-6).unwrap();
        let wind = scene.joint(Still::new(wind));
        scene.set_wind(bone, Some(wind)).unwrap();
        let mut next = || {
            scene.advance_ticks(60);
            scene.state(bone).0[3]
        };
        [(); 8].map(|()| next())
    };
    let (blown, exact) = (run([0.0, -6.0, 0.0], [3.0, -3.0, 1.0]), run([3.0, -9.0, 1.0], [0.0; 3]));
    // The first half of a kick is missing, which decays.
    for (k, (blown, exact)) in blown.iter().zip(&exact).enumerate() {
        let bound = if k < 4 { 1e-2 } else { 2e-4 };
        assert!((blown - exact).abs() < bound, "{k}: {blown} {exact}");
    }
}

#[test]
fn a_wind_wakes_and_a_calm_changes_no_bit() {
    let bone = Bone::swinging(LENGTH, 2.0, 0.5).unwrap();
    let (mut scene, _, _, bone) = scene(60.0, Attitude::identity(), bone);
    scene.set_sleep(Some(1e-3)).unwrap();
    let wind = scene.live([0.0; 3]).unwrap();
    scene.set_wind(bone, Some(wind)).unwrap();
    scene.advance_ticks(20);
    assert_eq!(scene.state(bone).0, IDENTITY);
    assert_eq!(scene.status(bone), SceneStatus::Asleep(i64::MAX));
    scene.move_to(wind, [2.0, 0.0, 0.0]).unwrap();
    scene.advance_ticks(60);
    assert_eq!(scene.status(bone), SceneStatus::Awake);
    // The direction of rest is that of the spring and the wind.
    let up = 16.0 * core::f64::consts::PI.powi(2);
    scene.set_sleep(None).unwrap();
    for _ in 0..300 {
        scene.move_to(wind, [2.0, 0.0, 0.0]).unwrap();
        scene.advance_ticks(1);
    }
    let tip = Attitude::from_quaternion(scene.state(bone).0) * [0.0, 1.0, 0.0];
    assert!((tip[0] / tip[1] - 2.0 / LENGTH / up).abs() < 1e-3, "{tip:?}");
    let mut other = Scene::<f64>::new(60.0).unwrap();
    assert!(other.set_wind(bone, None).is_err());
    let foreign = other.live([0.0; 3]).unwrap();
    other.remove_joint(foreign).unwrap();
    assert!(scene.set_wind(bone, Some(foreign)).is_err());
}

/// The turn of a bone relative to its frame.
fn relative(scene: &Scene<f64>, bone: Hung, frame: Attitude) -> Attitude {
    frame.inverse() * Attitude::from_quaternion(scene.state(bone).0)
}

#[test]
fn a_bone_on_a_hinge_turns_about_its_axis_between_its_angles() {
    let bone = Bone::swinging(LENGTH, 1.0, 0.05).unwrap().under([0.0, -9.81, 0.0]);
    let (mut scene, frame, _, bone) = scene(120.0, sideways(), bone);
    let axis = [0.6, 0.0, 0.8];
    scene.set_bounds(bone, &[Bound::Hinge { axis, from: -0.2, to: 0.3 }]).unwrap();
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for tick in 0..150 {
        let turn = 1.5 + 0.9 * (0.15 * f64::from(tick)).sin();
        let turn = Attitude::from_axis_angle([0.1, 0.2, 1.0], turn);
        scene.move_to(frame.1, turn.to_quaternion()).unwrap();
        scene.advance_ticks(1);
        let vector = relative(&scene, bone, turn).to_rotation_vector();
        let angle: f64 = (0..3).map(|i| axis[i] * vector[i]).sum();
        let off = length(core::array::from_fn(|i| vector[i] - angle * axis[i]));
        assert!(off < 1e-6 && (-0.2 - 1e-6..0.3 + 1e-6).contains(&angle), "{angle} {off:e}");
        (least, most) = (least.min(angle), most.max(angle));
    }
    assert!(least < -0.199 && 0.299 < most, "{least} {most}");
}

#[test]
fn a_hinge_swings_as_a_pendulum_of_one_angle() {
    // Without gravity, small swings about the axis have the frequency of the bone.
    let bone = Bone::swinging(LENGTH, 1.0, 0.0).unwrap();
    let (mut scene, _, _, bone) = scene(480.0, Attitude::identity(), bone);
    scene.set_tolerance(1e-6).unwrap();
    let axis = [1.0, 0.0, 0.0];
    scene.set_bounds(bone, &[Bound::Hinge { axis, from: -1.0, to: 1.0 }]).unwrap();
    let start = Attitude::from_axis_angle(axis, 1e-3).to_quaternion();
    scene.set_state(bone, start, [0.0; 4]).unwrap();
    for tick in 1..=240 {
        scene.advance_ticks(1);
        let angle = relative(&scene, bone, Attitude::identity()).to_rotation_vector()[0];
        let exact = 1e-3 * (core::f64::consts::TAU * f64::from(tick) / 480.0).cos();
        assert!((angle - exact).abs() < 1e-6, "{angle} {exact}");
    }
}

#[test]
fn a_bone_stays_within_its_twist() {
    let bone = Bone::swinging(LENGTH, 1.0, 0.05).unwrap().under([2.0, -9.81, 1.0]);
    let (mut scene, frame, _, bone) = scene(120.0, sideways(), bone);
    scene.set_bounds(bone, &[Bound::Twist(0.15)]).unwrap();
    let mut most = 0.0f64;
    for tick in 0..150 {
        let turn = Attitude::from_axis_angle([0.0, 1.0, 0.0], 2.0 * (0.1 * f64::from(tick)).sin());
        let turn = sideways() * turn;
        scene.move_to(frame.1, turn.to_quaternion()).unwrap();
        scene.advance_ticks(1);
        let relative = relative(&scene, bone, turn);
        // What remains after the shortest turn between the directions.
        let swing = Attitude::from_directions([0.0, 1.0, 0.0], relative * [0.0, 1.0, 0.0]);
        let twist = (swing.inverse() * relative).to_rotation_vector();
        assert!(length(twist) < 0.15 + 1e-6, "{twist:?}");
        most = most.max(length(twist));
    }
    assert!(0.149 < most, "{most}");
}

#[test]
fn energy_does_not_grow_at_bounds_that_rest() {
    let hinge = Bound::Hinge { axis: [0.2, 0.0, 1.0], from: -0.3, to: 0.4 };
    for bounds in [vec![hinge], vec![Bound::Cone(0.5), Bound::Twist(0.1)]] {
        let bone = Bone::swinging(LENGTH, 0.7, 0.0).unwrap().under([1.0, -9.81, 2.0]);
        let (mut scene, _, _, bone) = scene(120.0, sideways(), bone);
        scene.set_tolerance(1e-6).unwrap();
        scene.set_bounds(bone, &bounds).unwrap();
        scene.advance_ticks(1);
        let mut before = scene.energy(bone);
        for tick in 0..150 {
            scene.advance_ticks(1);
            let energy = scene.energy(bone);
            assert!(energy < before + 39.0 * 1e-5, "{bounds:?} at {tick}: {before} {energy}");
            before = energy;
        }
    }
}

#[test]
fn a_body_that_moves_takes_the_bone_with_it_and_lets_it_go() {
    let bone = Bone::swinging(LENGTH, 2.0, 0.5).unwrap();
    let (mut scene, _, _, bone) = scene(120.0, Attitude::identity(), bone);
    let ball = scene.live_frame([-0.3, 0.45, 0.02], Attitude::identity()).unwrap();
    let shape = Shape::Ball { center: [0.0; 3], radius: 0.05 };
    scene.set_colliders(bone, RADIUS, &[Collider { frame: ball, shape }]).unwrap();
    let mut most = 0.0f64;
    for tick in 1..=240 {
        let center = [-0.3 + 0.005 * f64::from(tick.min(120)), 0.45, 0.02];
        scene.move_to(ball.0, center).unwrap();
        scene.advance_ticks(1);
        let [joint, tip] = ends(&scene, bone);
        let left = clearance(&shape, minus(joint, center), minus(tip, center));
        assert!(-1e-6 < left, "{left:e} at {tick}");
        most = most.max(tip[0]);
    }
    assert!(0.08 < most, "{most}");
    assert!(ends(&scene, bone)[1][0].abs() < 1e-3, "it springs back");
}

#[test]
fn a_bone_that_is_inside_leaves_at_once_without_velocity() {
    let (mut scene, _, origin, bone) = scene(120.0, sideways(), Bone::new(LENGTH, 0.0, 0.0));
    let shape = Shape::Ball { center: [-0.2, 0.22, 0.0], radius: 0.1 };
    scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
    let [joint, tip] = ends(&scene, bone);
    assert!(clearance(&shape, joint, tip) < -1e-2);
    scene.advance_ticks(1);
    let [joint, tip] = ends(&scene, bone);
    assert!(-1e-6 < clearance(&shape, joint, tip));
    assert_eq!(scene.state(bone).1, [0.0; 4]);
}

#[test]
fn a_bone_that_is_inside_leaves_at_the_speed_that_is_set() {
    let around = [
        Shape::Ball { center: [-0.2, 0.22, 0.0], radius: 0.1 },
        Shape::Capsule { ends: [[-0.2, 0.25, -0.3], [-0.2, 0.25, 0.3]], radius: 0.1 },
        Shape::Half { point: [-0.25, 0.35, 0.0], normal: [0.0, 2.0, 0.0] },
    ];
    let (rate, speed) = (120.0, 0.1);
    for shape in around {
        let (mut scene, _, origin, bone) = scene(rate, sideways(), Bone::new(LENGTH, 0.0, 0.0));
        scene.set_push_out(bone, speed).unwrap();
        scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
        let left = |scene: &Scene<f64>| {
            let [joint, tip] = ends(scene, bone);
            clearance(&shape, joint, tip)
        };
        let start = left(&scene);
        assert!(start < -0.01, "{shape:?}: {start}");
        for tick in 1..=150 {
            scene.advance_ticks(1);
            let expected = (start + speed * f64::from(tick) / rate).min(0.0);
            let off = left(&scene) - expected;
            assert!(off.abs() < 1e-7 * f64::from(tick + 10), "{shape:?} at {tick}: {off:e}");
            assert_eq!(scene.state(bone).1, [0.0; 4], "no velocity");
        }
    }
}

/// Gravity presses the bone into the body.
#[test]
fn what_leaves_slowly_gains_no_velocity() {
    let bone = Bone::new(LENGTH, 0.0, 0.0).under([0.0, -9.81, 0.0]);
    let (mut scene, _, origin, bone) = scene(120.0, sideways(), bone);
    let half = Shape::Half { point: [-0.25, 0.35, 0.0], normal: [0.0, 1.0, 0.0] };
    scene.set_push_out(bone, 0.05).unwrap();
    scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape: half }]).unwrap();
    let mut before = f64::NEG_INFINITY;
    for tick in 0..240 {
        scene.advance_ticks(1);
        let [joint, tip] = ends(&scene, bone);
        let depth = clearance(&half, joint, tip);
        assert!(before - 1e-6 < depth && depth < 1e-6, "{depth} after {before}");
        assert!(length(scene.state(bone).1[..3].try_into().unwrap()) < 1e-6, "tick {tick}");
        before = depth;
    }
    assert!(-1e-6 < before, "{before}");
}

/// A slow way out of one body is none for what comes later.
#[test]
fn a_fast_ball_passes_no_bone_that_leaves_another_body() {
    let (mut scene, _, origin, bone) = scene(120.0, sideways(), Bone::new(LENGTH, 0.0, 0.0));
    let half = Shape::Half { point: [-0.25, 0.35, 0.0], normal: [0.0, 1.0, 0.0] };
    let ball = Shape::Ball { center: [0.0; 3], radius: 1e-3 };
    // From below, so that the ball pushes the bone out of the half as well.
    let thrown = scene.live_frame([-0.1, 0.1, 0.0], Attitude::identity()).unwrap();
    scene.set_push_out(bone, 0.05).unwrap();
    let colliders =
        [Collider { frame: origin, shape: half }, Collider { frame: thrown, shape: ball }];
    scene.set_colliders(bone, RADIUS, &colliders).unwrap();
    for frame in 1..=4 {
        let center = [-0.1, 0.1 + 0.15 * f64::from(frame), 0.0];
        scene.move_to(thrown.0, center).unwrap();
        scene.advance_ticks(1);
        let [joint, tip] = ends(&scene, bone);
        let left = clearance(&ball, minus(joint, center), minus(tip, center));
        assert!(-1e-6 < left, "{left} in frame {frame}");
    }
    assert!(0.45 < ends(&scene, bone)[1][1], "the ball takes the bone along");
}

#[test]
fn speeds_that_push_nothing_out_are_refused() {
    let (mut scene, _, _, bone) = scene(120.0, sideways(), heavy());
    for speed in [0.0, -1.0, f64::NAN] {
        let refused = scene.set_push_out(bone, speed);
        assert!(matches!(refused, Err(SceneError::Setting { name: "speed", .. })), "{speed}");
    }
}

#[test]
fn a_bone_that_is_pushed_along_itself_gives_way() {
    let (mut scene, _, origin, bone) =
        scene(60.0, Attitude::identity(), Bone::new(LENGTH, 9.0, 1.0));
    let shape = Shape::Ball { center: [0.0, 0.6, 0.0], radius: 0.06 };
    scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
    scene.advance_ticks(1);
    let [joint, tip] = ends(&scene, bone);
    assert!(-1e-6 < clearance(&shape, joint, tip), "{tip:?}");
}

#[test]
fn two_bodies_act_together() {
    let (mut scene, _, origin, bone) = scene(60.0, sideways(), heavy());
    let corner = [[0.3, 1.0, 0.0], [1.0, 0.3, 0.1]];
    let halves = corner.map(|normal| Shape::Half { point: [-0.1, 0.15, 0.0], normal });
    let colliders = halves.map(|shape| Collider { frame: origin, shape });
    scene.set_colliders(bone, RADIUS, &colliders).unwrap();
    for _ in 0..60 {
        scene.advance_ticks(1);
        let [joint, tip] = ends(&scene, bone);
        for shape in &halves {
            assert!(-1e-6 < clearance(shape, joint, tip));
        }
    }
}

#[test]
fn bodies_that_are_not_touched_change_no_bit() {
    let run = |limited: bool| {
        let (mut scene, frame, origin, bone) = scene(120.0, sideways(), heavy());
        if limited {
            let shape = Shape::Half { point: [0.0, -1.0, 0.0], normal: [0.0, 1.0, 0.0] };
            scene.set_colliders(bone, RADIUS, &[Collider { frame: origin, shape }]).unwrap();
            scene.set_bounds(bone, &[Bound::Cone(3.0)]).unwrap();
        }
        scene.move_to(frame.0, [0.01, 0.3, 0.0]).unwrap();
        scene.advance(0.1).unwrap();
        scene.state(bone)
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn a_body_wakes_the_bone_that_it_enters() {
    let bone = Bone::swinging(LENGTH, 2.0, 0.5).unwrap();
    let (mut scene, _, _, bone) = scene(60.0, Attitude::identity(), bone);
    let ball = scene.live_frame([-0.3, 0.45, 0.02], Attitude::identity()).unwrap();
    let shape = Shape::Ball { center: [0.0; 3], radius: 0.05 };
    scene.set_colliders(bone, RADIUS, &[Collider { frame: ball, shape }]).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    scene.advance_ticks(20);
    assert_eq!(scene.status(bone), SceneStatus::Asleep(i64::MAX));
    scene.move_to(ball.0, [-0.1, 0.45, 0.02]).unwrap();
    scene.advance_ticks(1);
    assert_eq!(scene.status(bone), SceneStatus::Asleep(i64::MAX));
    scene.teleport(ball.0, [-0.02, 0.45, 0.02]).unwrap();
    scene.advance_ticks(1);
    assert_eq!(scene.status(bone), SceneStatus::Awake);
    let [joint, tip] = ends(&scene, bone);
    let center = [-0.02, 0.45, 0.02];
    assert!(-1e-6 < clearance(&shape, minus(joint, center), minus(tip, center)));
}

#[test]
fn what_is_carried_by_a_bone_is_a_body_for_later_ones_only() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let frame = scene.live_frame([0.0; 3], sideways()).unwrap();
    let chain = scene.hang_chain(frame, [heavy(), heavy(), heavy()]).unwrap();
    let tip = scene.frame_on(chain[0], ["tip", "turn"], [0.0; 3], Attitude::identity()).unwrap();
    let shape = Shape::Ball { center: [0.0, -0.1, 0.0], radius: 0.05 };
    let collider = Collider { frame: tip, shape };
    let error = scene.set_colliders(chain[0], RADIUS, &[collider]).unwrap_err();
    assert!(error.to_string().contains("move after them"), "{error}");
    scene.set_colliders(chain[2], RADIUS, &[collider]).unwrap();
    let floor = Shape::Half { point: [0.0, -0.3, 0.0], normal: [0.0, 1.0, 0.0] };
    let ground = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    for &bone in &chain {
        scene.set_colliders(bone, RADIUS, &[Collider { frame: ground, shape: floor }]).unwrap();
    }
    for _ in 0..60 {
        scene.advance_ticks(1);
        for &bone in &chain {
            let [joint, tip] = ends(&scene, bone);
            // A bone whose joint is on the floor may lie on it, but reaches it from everywhere.
            assert!(-1e-6 < clearance(&floor, joint, tip), "{tip:?}");
        }
    }
}

#[test]
fn bodies_and_limits_go_with_their_joints_and_bones() {
    let (mut scene, frame, _, bone) = scene(60.0, sideways(), heavy());
    let ground = scene.live_frame([0.0; 3], Attitude::identity()).unwrap();
    let shape = Shape::Half { point: [0.0, 0.2, 0.0], normal: [0.0, 1.0, 0.0] };
    scene.set_colliders(bone, RADIUS, &[Collider { frame: ground, shape }]).unwrap();
    scene.advance_ticks(30);
    let [joint, tip] = ends(&scene, bone);
    assert!(-1e-6 < clearance(&shape, joint, tip));
    scene.remove_joint(ground.0).unwrap();
    scene.advance_ticks(20);
    let [joint, tip] = ends(&scene, bone);
    assert!(clearance(&shape, joint, tip) < -1e-2, "it falls through: {tip:?}");
    let collider = Collider { frame: ground, shape };
    assert!(matches!(scene.set_colliders(bone, RADIUS, &[collider]), Err(SceneError::Joint(_))));
    // What takes the place of a bone has no limits.
    scene.set_bounds(bone, &[Bound::Cone(0.1)]).unwrap();
    scene.remove(bone).unwrap();
    let next = scene.hang(frame, heavy(), sideways().to_quaternion(), [0.0; 4]).unwrap();
    assert_eq!(next.index(), bone.index());
    scene.advance_ticks(20);
    let axis = Attitude::from_quaternion(scene.state(next).0) * [0.0, 1.0, 0.0];
    assert!(0.2 < length(minus(axis, sideways() * [0.0, 1.0, 0.0])));
}

#[test]
fn numbers_that_make_no_body_are_refused() {
    let (mut scene, _, origin, bone) = scene(60.0, sideways(), heavy());
    let mut refused = |radius: f64, shape: Shape| {
        let result = scene.set_colliders(bone, radius, &[Collider { frame: origin, shape }]);
        assert!(matches!(result, Err(SceneError::Setting { .. })), "{shape:?}");
    };
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        refused(0.0, Shape::Ball { center: [0.0; 3], radius: bad });
        refused(0.0, Shape::Capsule { ends: [[0.0; 3]; 2], radius: bad });
        refused(0.0, Shape::Inside { ends: [[0.0; 3]; 2], radius: bad });
    }
    refused(0.0, Shape::Inside { ends: [[0.0; 3]; 2], radius: 0.0 });
    refused(0.0, Shape::Half { point: [0.0; 3], normal: [0.0; 3] });
    refused(0.0, Shape::Half { point: [f64::NAN; 3], normal: [0.0, 1.0, 0.0] });
    refused(0.0, Shape::Ball { center: [0.0, f64::INFINITY, 0.0], radius: 1.0 });
    refused(-0.1, Shape::Ball { center: [0.0; 3], radius: 1.0 });
    refused(f64::NAN, Shape::Ball { center: [0.0; 3], radius: 1.0 });
    let mut refused = |bound: Bound| {
        let result = scene.set_bounds(bone, &[bound]);
        assert!(matches!(result, Err(SceneError::Setting { .. })), "{bound:?}");
    };
    for angle in [-0.1, 4.0, f64::NAN] {
        refused(Bound::Cone(angle));
        refused(Bound::Twist(angle));
        refused(Bound::Hinge { axis: [1.0, 0.0, 0.0], from: 0.0, to: angle });
    }
    refused(Bound::Hinge { axis: [1.0, 0.0, 0.0], from: 0.5, to: 0.2 });
    refused(Bound::Hinge { axis: [1.0, 0.0, 0.0], from: -4.0, to: 0.2 });
    refused(Bound::Hinge { axis: [0.0; 3], from: 0.0, to: 1.0 });
    refused(Bound::Hinge { axis: [f64::NAN; 3], from: 0.0, to: 1.0 });
    let mut other = Scene::<f64>::new(60.0).unwrap();
    assert!(other.set_bounds(bone, &[]).is_err());
}
