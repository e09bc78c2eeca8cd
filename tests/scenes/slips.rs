//! Dry friction of bones on colliders, against closed forms.

use pendulum_runtime::motion::{Still, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{
    Bone, CenteredBone, Collider, Handle, Joint, Scene, SceneError, Shape,
};
use systems::random::Random;

type Frame = (Joint<3>, Joint<4>);

const G: f64 = 9.81;
const LENGTH: f64 = 0.25;
const IDENTITY: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn along(scene: &Scene<f64>, bone: Handle<Bone, 4>) -> [f64; 3] {
    Attitude::from_quaternion(scene.state(bone).0) * [0.0, 1.0, 0.0]
}

fn still(scene: &mut Scene<f64>, place: [f64; 3]) -> Frame {
    (scene.joint(Still::new(place)), scene.joint(Still::new(IDENTITY)))
}

/// A bone without spring and damping on a slope of the angle `slope` about the axis z, which it
/// touches with its joint: its direction is turned by `start` from straight down the slope.
fn on_slope(rate: f64, slope: f64, start: f64) -> (Scene<f64>, Handle<Bone, 4>, Collider) {
    let mut scene = Scene::new(rate).unwrap();
    let frame = still(&mut scene, [0.0; 3]);
    let bone = Bone::new(LENGTH, 0.0, 0.0).under([0.0, -G, 0.0]);
    let down = Attitude::from_axis_angle([0.0, 0.0, 1.0], slope);
    // In the axes of the slope, y is out of it and x up: −x is down.
    let axis = Attitude::from_directions([0.0, 1.0, 0.0], [-start.cos(), 0.0, start.sin()]);
    let bone = scene.hang(frame, bone, (down * axis).to_quaternion(), [0.0; 4]).unwrap();
    let shape = Shape::Half { point: [0.0; 3], normal: down * [0.0, 1.0, 0.0] };
    (scene, bone, Collider { frame, shape })
}

/// The angle of a bone on a slope from straight down.
fn angle(scene: &Scene<f64>, bone: Handle<Bone, 4>, slope: f64) -> f64 {
    let [x, _, z] = Attitude::from_axis_angle([0.0, 0.0, 1.0], -slope) * along(scene, bone);
    z.atan2(-x)
}

#[test]
fn a_bone_sticks_on_a_slope_whose_tangent_is_below_the_coefficient() {
    let (slope, start) = (0.5f64, 1.2f64);
    // Across itself the bone is pulled by g·sin(slope)·sin(start), and pressed by g·cos(slope).
    let limit = slope.tan() * start.sin();
    for (factor, slips) in [(1.02, false), (2.0, false), (0.98, true), (0.0, true)] {
        let (mut scene, bone, collider) = on_slope(240.0, slope, start);
        scene.set_colliders(bone, 0.0, &[collider]).unwrap();
        scene.set_friction(bone, factor * limit).unwrap();
        scene.advance_ticks(480);
        let moved = start - angle(&scene, bone, slope);
        if slips {
            assert!(0.03 < moved.abs(), "{factor}: {moved:e}");
        } else {
            assert!(moved.abs() < 1e-5, "{factor}: {moved:e}");
        }
    }
}

#[test]
fn a_bone_slides_down_a_slope_as_the_law_of_energy_says() {
    let (slope, start, coefficient) = (0.6f64, 1.4f64, 0.3);
    for (rate, bound) in [(240.0, 1e-2), (960.0, 2.5e-3)] {
        let (mut scene, bone, collider) = on_slope(rate, slope, start);
        scene.set_tolerance(1e-7).unwrap();
        scene.set_colliders(bone, 0.0, &[collider]).unwrap();
        scene.set_friction(bone, coefficient).unwrap();
        let mut last = start;
        for tick in 1..3 * rate as i32 {
            scene.advance_ticks(1);
            let angle = angle(&scene, bone, slope);
            if last <= angle {
                // It has turned around, or rests.
                assert!(rate as i32 / 4 < tick);
                break;
            }
            last = angle;
            let (_, v) = scene.state(bone);
            let square: f64 = v.iter().map(|part| 4.0 * part * part).sum();
            let fallen = slope.sin() * (angle.cos() - start.cos());
            let lost = coefficient * slope.cos() * (start - angle);
            let exact = 2.0 * G / LENGTH * (fallen - lost);
            // The square of the greatest rate is 20/s².
            assert!((square - exact).abs() < 20.0 * bound, "{angle}: {square} {exact}");
        }
        // The way back: all that it has gained is lost.
        let end = |angle: f64| {
            slope.sin() * (angle.cos() - start.cos()) - coefficient * slope.cos() * (start - angle)
        };
        let (mut low, mut high) = (-start, 0.5 * start);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if end(middle) < 0.0 { low = middle } else { high = middle }
        }
        assert!((last - low).abs() < bound * 3.0, "{last} {low}");
    }
}

/// A bone that lies on the top of a ball of 5 m, which turns about the axis of the bone at `speed`
/// at its surface.
fn on_ball(speed: f64, coefficient: f64) -> (Scene<f64>, Handle<Bone, 4>) {
    let mut scene = Scene::new(240.0).unwrap();
    let frame = still(&mut scene, [0.0; 3]);
    let bone = Bone::new(LENGTH, 0.0, 0.0).under([0.0, -G, 0.0]);
    let flat = Attitude::from_directions([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
    let bone = scene.hang(frame, bone, flat.to_quaternion(), [0.0; 4]).unwrap();
    let place = scene.joint(Still::new([0.8 * LENGTH, -5.0, 0.0]));
    let line = move |t: f64| [speed / 5.0 * t];
    let line = pendulum_runtime::motion::Function::new(line);
    let line = line.velocity(move |_| [speed / 5.0]).acceleration(|_| [0.0]);
    let turn = scene.joint(Turning::new([1.0, 0.0, 0.0], line));
    let shape = Shape::Ball { center: [0.0; 3], radius: 5.0 };
    scene.set_colliders(bone, 0.0, &[Collider { frame: (place, turn), shape }]).unwrap();
    scene.set_friction(bone, coefficient).unwrap();
    (scene, bone)
}

#[test]
fn a_ball_that_turns_drags_a_bone_by_the_coefficient_times_its_weight() {
    // About x, the top of the ball moves along z.
    let (mut scene, bone) = on_ball(4.0, 0.3);
    for _ in 0..6 {
        scene.advance_ticks(4);
        let (_, v) = scene.state(bone);
        let rate = v.iter().map(|part| 4.0 * part * part).sum::<f64>().sqrt();
        let exact = 0.3 * G / LENGTH * scene.time();
        assert!((rate - exact).abs() < 5e-3 * exact, "{rate} {exact}");
        assert!(0.0 < along(&scene, bone)[2]);
    }
}

#[test]
fn a_bone_on_a_ball_that_turns_slowly_goes_with_its_surface() {
    let (mut scene, bone) = on_ball(0.05, 0.5);
    scene.advance_ticks(12);
    for _ in 0..10 {
        let before = along(&scene, bone)[2];
        scene.advance_ticks(4);
        // The surface moves by 0.05 m/s, 0.2 m from the joint.
        let moved = 0.8 * LENGTH * (along(&scene, bone)[2] - before) / (4.0 / 240.0);
        assert!((moved - 0.05).abs() < 1e-3, "{moved}");
    }
}

#[test]
fn energy_does_not_grow_by_friction_on_bodies_that_rest() {
    let shapes = [
        Shape::Ball { center: [-0.12, 0.0, 0.02], radius: 0.15 },
        Shape::Capsule { ends: [[-0.2, 0.05, -0.3], [-0.1, 0.05, 0.3]], radius: 0.04 },
        Shape::Half { point: [0.0, 0.1, 0.0], normal: [0.5, 2.0, 0.3] },
        Shape::Inside { ends: [[0.0, 0.3, -0.1], [0.0, 0.3, 0.1]], radius: 0.23 },
    ];
    let mut random = Random::new(9);
    for case in 0..12 {
        let mut scene = Scene::<f64>::new(120.0).unwrap();
        scene.set_tolerance(1e-6).unwrap();
        let turn = Attitude::from_axis_angle([0.0, 0.0, 1.0], 1.5).to_quaternion();
        let frame = (scene.joint(Still::new([0.0, 0.3, 0.0])), scene.joint(Still::new(turn)));
        let origin = still(&mut scene, [0.0; 3]);
        let bone = Bone::swinging(LENGTH, 0.7, 0.0).unwrap().under([0.0, -G, 0.0]);
        let rates = Rates::space([(); 3].map(|()| random.uniform(-3.0, 3.0)));
        let start = rates.derivative(Attitude::from_quaternion(turn));
        let bone = scene.hang(frame, bone, turn, start).unwrap();
        let colliders = [0, 1].map(|k| Collider { frame: origin, shape: shapes[(case + k) % 4] });
        scene.set_colliders(bone, 0.02, &colliders[..=case % 2]).unwrap();
        scene.set_friction(bone, [0.1, 0.5, 2.0][case / 4]).unwrap();
        scene.advance_ticks(1);
        let mut before = scene.energy(bone);
        for tick in 0..60 {
            scene.advance_ticks(1);
            let energy = scene.energy(bone);
            // g/L is 39/s².
            assert!(energy < before + 39.0 * 1e-5, "{case} at {tick}: {before} {energy}");
            before = energy;
        }
    }
}

#[test]
fn a_coefficient_of_zero_changes_no_bit_and_others_do() {
    let run = |coefficient: Option<f64>| {
        let (mut scene, bone, collider) = on_slope(240.0, 0.5, 1.0);
        scene.set_colliders(bone, 0.0, &[collider]).unwrap();
        if let Some(coefficient) = coefficient {
            scene.set_friction(bone, coefficient).unwrap();
        }
        scene.advance_ticks(120);
        scene.state(bone).0.map(f64::to_bits)
    };
    assert_eq!(run(None), run(Some(0.0)));
    assert_ne!(run(None), run(Some(0.1)));
}

#[test]
fn a_bone_with_a_center_that_rests_slips_as_others_do() {
    let (mut scene, bone, collider) = on_slope(240.0, 0.5, 1.2);
    let middle = Attitude::from_axis_angle([0.3, 1.0, 0.0], 0.8);
    let place = scene.joint(Still::new([1.0, 0.0, 2.0]));
    let turn = scene.joint(Still::new(middle.to_quaternion()));
    let own = Bone::new(LENGTH, 0.0, 0.0).under([0.0, -G, 0.0]).centered();
    let start = middle.inverse() * Attitude::from_quaternion(scene.state(bone).0);
    let anchor = (collider.frame.0, collider.frame.1, place, turn);
    let own: Handle<CenteredBone, 4> =
        scene.hang(anchor, own, start.to_quaternion(), [0.0; 4]).unwrap();
    scene.set_colliders(bone, 0.0, &[collider]).unwrap();
    scene.set_friction(bone, 0.2).unwrap();
    scene.set_colliders(own, 0.0, &[collider]).unwrap();
    scene.set_friction(own, 0.2).unwrap();
    for _ in 0..10 {
        scene.advance_ticks(12);
        let turn = middle * Attitude::from_quaternion(scene.state(own).0);
        assert!(1.0 - 1e-10 < dot(turn * [0.0, 1.0, 0.0], along(&scene, bone)));
    }
}

#[test]
fn coefficients_that_are_none_are_refused() {
    let (mut scene, bone, _) = on_slope(240.0, 0.5, 1.0);
    for value in [-0.1, f64::INFINITY, f64::NAN] {
        let error = scene.set_friction(bone, value).unwrap_err();
        assert!(matches!(error, SceneError::Setting { name: "friction", .. }), "{error}");
    }
}
