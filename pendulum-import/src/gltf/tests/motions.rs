//! Tests of motions of nodes: interpolation, hierarchies, derivatives, kinks, loops and rests.

use super::writer::Writer;
use super::{at, close, dancer, differentiable, kinks};
use crate::gltf::Gltf;
use pendulum_core::motion::{Curve, Derivatives, Motion, Projected, Sample, Side};
use pendulum_core::nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3, Vector4};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

#[test]
fn a_node_on_lines_moves_as_lines_do() {
    let mut file = Writer::default();
    file.channel(
        0,
        "translation",
        "LINEAR",
        &[0.5, 1.0, 2.0],
        &[0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, -4.0],
    );
    for bytes in [file.text(r#"{"name":"foot"}"#), file.binary(r#"{"name":"foot"}"#)] {
        let read = Gltf::read(&bytes).unwrap();
        assert_eq!(
            (read.node("foot").ok(), read.animation("dance").ok(), read.node("hand").ok()),
            (Some(0), Some(0), None)
        );
        let motion = read.motion(0, 0).unwrap();
        let lines = Curve::linear(&[0.5, 1.0, 2.0], &[[0.0; 3], [1.0, 2.0, 0.0], [1.0, 2.0, -4.0]])
            .unwrap();
        for k in 0..50 {
            let t = 0.05 * f64::from(k);
            for side in [Side::Before, Side::After] {
                assert_eq!(at(&motion, t, side), at(&lines, t, side));
            }
        }
        assert_eq!(kinks(&motion, 9.0), [0.5, 1.0, 2.0]);
        assert_eq!(motion.duration(), 2.0);
        let rest = |t| Motion::<f64, 3>::rest_until(&motion, t);
        assert_eq!([0.0, 0.5, 1.9, 2.0].map(rest), [0.5, 0.5, 1.9, f64::INFINITY]);
    }
}

fn rest(motion: &impl Motion<f64, 3>, t: f64) -> f64 {
    motion.rest_until(t)
}

/// Checks that the position is constant at rest, including both sides of every key.
fn constant(motion: &impl Motion<f64, 3>) {
    for k in -50..200 {
        let t = 0.1 * f64::from(k) + 0.01;
        let until = Real::min(rest(motion, t), t + 20.0);
        for share in [0.0, 0.3, 0.99, 1.0 - 1e-14] {
            assert_eq!(
                at(motion, t + share * (until - t), Side::After).position,
                at(motion, t, Side::After).position,
                "{t}"
            );
        }
    }
}

#[test]
fn nodes_rest_where_no_channel_moves_them() {
    let mut file = Writer::default();
    // Rests, moves and rests; jumps at 3 s only; rotates from 4 s to 5 s.
    let stays = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    file.channel(0, "translation", "LINEAR", &[0.0, 1.0, 2.0, 6.0], &stays);
    file.channel(
        0,
        "scale",
        "STEP",
        &[0.0, 2.5, 3.0, 6.0],
        &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 1.0, 1.0],
    );
    file.channel(1, "rotation", "LINEAR", &[4.0, 5.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let nodes = r#"{"children":[1]},{"translation":[1,0,0],"children":[2]},{"translation":[0,1,0]},{"translation":[0,9,0]}"#;
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let (parent, child) = (read.motion(0, 0).unwrap(), read.motion(0, 2).unwrap());
    let times = [-1.0, 0.5, 1.0, 1.5, 2.0, 2.7, 3.0, 4.5, 5.0, 6.0];
    assert_eq!(
        times.map(|t| rest(&parent, t)),
        [1.0, 1.0, 1.0, 1.5, 3.0, 3.0, f64::INFINITY, f64::INFINITY, f64::INFINITY, f64::INFINITY]
    );
    assert_eq!(
        times.map(|t| rest(&child, t)),
        [1.0, 1.0, 1.0, 1.5, 3.0, 3.0, 4.0, 4.5, f64::INFINITY, f64::INFINITY]
    );
    let looped = child.clone().looped().unwrap();
    constant(&parent);
    constant(&child);
    constant(&looped);
    assert!((rest(&looped, 8.2) - 9.0).abs() < 1e-12 && (rest(&looped, 11.5) - 12.0).abs() < 1e-12);
    assert_eq!(rest(&read.motion(0, 3).unwrap().looped().unwrap(), 1.0), f64::INFINITY);
}

/// A rod of two metres rotates about z by a quarter turn in a second, the shorter way in spite of
/// the different signs.
#[test]
fn a_turning_parent_carries_its_child_on_a_circle() {
    let half = 0.5f32.sqrt();
    let mut file = Writer::default();
    file.channel(
        0,
        "rotation",
        "LINEAR",
        &[0.0, 1.0, 2.0],
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half, 0.0, 0.0, 1.0, 0.0],
    );
    let bytes = file.binary(r#"{"children":[1]},{"translation":[2,0,0]}"#);
    let motion = Gltf::read(&bytes).unwrap().motion(0, 1).unwrap();
    let speed = core::f64::consts::FRAC_PI_2;
    for k in 1..20 {
        let t = 0.1 * f64::from(k);
        let (sin, cos) = Real::sin_cos(speed * t);
        let sample = at(&motion, t, Side::After);
        // The key in single precision is a rotation by π/2 within 10⁻⁷.
        close(sample.position, [2.0 * cos, 2.0 * sin, 0.0], 3e-7);
        close(sample.velocity, [-2.0 * speed * sin, 2.0 * speed * cos, 0.0], 1e-6);
        close(
            sample.acceleration,
            [-2.0 * speed * speed * cos, -2.0 * speed * speed * sin, 0.0],
            1e-6,
        );
    }
    // No kink at the middle key, because the speed is constant.
    assert_eq!(kinks(&motion, 9.0), [0.0, 2.0]);
}

#[test]
fn derivatives_are_those_of_the_position() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    for node in 0..4 {
        let motion = read.motion(0, node).unwrap();
        for t in differentiable(&motion) {
            let sample = at(&motion, t, Side::After);
            for wanted in [
                Derivatives::NONE,
                Derivatives::POSITION,
                Derivatives::VELOCITY,
                Derivatives::POSITION.union(Derivatives::ACCELERATION),
            ] {
                let some: Sample<f64, 3> = motion.sample(Time::new(t), Side::After, wanted);
                let kept = |derivative: Derivatives, value: [f64; 3]| {
                    if wanted.contains(derivative) { value } else { [0.0; 3] }
                };
                assert_eq!(some.position, kept(Derivatives::POSITION, sample.position));
                assert_eq!(some.velocity, kept(Derivatives::VELOCITY, sample.velocity));
                assert_eq!(some.acceleration, kept(Derivatives::ACCELERATION, sample.acceleration));
            }
        }
    }
}

/// Checks the positions against products of matrices.
#[test]
fn positions_are_those_of_matrices() {
    let mut file = Writer::default();
    let turns = [[0.0f32, 0.0, 0.0, 1.0], [0.48, 0.6, 0.0, 0.64]];
    file.channel(0, "rotation", "LINEAR", &[0.0, 1.0], &turns.concat());
    file.channel(1, "rotation", "LINEAR", &[0.0, 1.0], &[turns[1], turns[0]].concat());
    file.channel(1, "scale", "LINEAR", &[0.0, 1.0], &[1.0, 1.0, 1.0, 3.0, 0.5, 2.0]);
    let nodes = r#"{"children":[1],"translation":[1,2,3]},{"children":[2],"translation":[0,1,0]},{"translation":[0.5,0,-1]}"#;
    let motion = Gltf::read(&file.text(nodes)).unwrap().motion(0, 2).unwrap();
    let wide = turns.map(|[x, y, z, w]| {
        UnitQuaternion::from_quaternion(Quaternion::new(
            f64::from(w),
            f64::from(x),
            f64::from(y),
            f64::from(z),
        ))
    });
    for k in 0..=10 {
        let t = f64::from(k) / 10.0;
        let place = |x: [f64; 3]| Matrix4::new_translation(&Vector3::from(x));
        let scale =
            Matrix4::new_nonuniform_scaling(&Vector3::new(1.0 + 2.0 * t, 1.0 - 0.5 * t, 1.0 + t));
        let outer = place([1.0, 2.0, 3.0]) * wide[0].slerp(&wide[1], t).to_homogeneous();
        let inner = place([0.0, 1.0, 0.0]) * wide[1].slerp(&wide[0], t).to_homogeneous() * scale;
        let expected = outer * inner * Vector4::new(0.5, 0.0, -1.0, 1.0);
        close(
            at(&motion, t, Side::Before).position,
            [expected[0], expected[1], expected[2]],
            1e-12,
        );
    }
}

#[test]
fn kinks_stand_where_something_jumps() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let motion = read.motion(0, 3).unwrap();
    // The step at 1.25 s does not change the value. The middle key of the scale is a kink.
    assert_eq!(kinks(&motion, 9.0), [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 1.75, 2.0]);
    let [before, after] = [Side::Before, Side::After].map(|side| at(&motion, 1.5, side).position);
    assert!(0.5 < (0..3).map(|d| (before[d] - after[d]).abs()).sum::<f64>());
    // Both sides are equal between kinks.
    assert_eq!(at(&motion, 1.3, Side::Before), at(&motion, 1.3, Side::After));
}

#[test]
fn a_loop_repeats_and_its_seam_is_a_kink_unless_smooth() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let (once, looped) = (read.motion(0, 3).unwrap(), read.motion(0, 3).unwrap().looped().unwrap());
    for k in 0..40 {
        let t = 0.05 * f64::from(k) + 0.01;
        for turn in [-3.0, 0.0, 1.0, 1000.0] {
            let (a, b) = (at(&once, t, Side::After), at(&looped, t + 2.0 * turn, Side::After));
            close(a.position, b.position, 1e-10);
            close(a.acceleration, b.acceleration, 1e-8);
        }
    }
    assert_eq!(
        kinks(&looped, 2.5),
        [-0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 1.75, 2.0, 2.25, 2.5]
    );
    for (kink, period) in [(0.75, 0.0), (0.75, 2.0 * 777.0), (1.5, 2.0 * 333.0), (0.0, 20.0)] {
        let [a, b] = [Side::Before, Side::After].map(|side| at(&looped, kink + period, side));
        let before = if kink == 0.0 { 2.0 } else { kink };
        assert_eq!((a, b), (at(&once, before, Side::Before), at(&once, kink, Side::After)));
    }
    // A full turn of four quarters has no kink at the seam.
    let half = 0.5f32.sqrt();
    let mut wheel = Writer::default();
    let keys = [
        [0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, half, half],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, half, -half],
        [0.0, 0.0, 0.0, -1.0],
    ];
    wheel.channel(0, "rotation", "LINEAR", &[0.0, 1.0, 2.0, 3.0, 4.0], &keys.concat());
    let rim = Gltf::read(&wheel.text(r#"{"children":[1]},{"translation":[1,0,0]}"#))
        .unwrap()
        .motion(0, 1)
        .unwrap();
    assert_eq!(kinks(&rim.looped().unwrap(), 30.0), [0.0f64; 0]);
}

#[test]
fn a_plane_sees_two_directions() {
    let (file, nodes) = dancer();
    let motion = Gltf::read(&file.binary(nodes)).unwrap().motion(0, 2).unwrap();
    let space = at(&motion, 0.6, Side::After);
    let seen = Projected::new(motion, [[0.0, 0.0, -0.01], [0.0, 0.01, 0.0]]);
    let plane: Sample<f64, 2> = seen.sample(Time::new(0.6), Side::After, Derivatives::ALL);
    assert_eq!(plane.position, [-0.01 * space.position[2], 0.01 * space.position[1]]);
    assert_eq!(plane.acceleration, [-0.01 * space.acceleration[2], 0.01 * space.acceleration[1]]);
    assert_eq!(Motion::<f64, 2>::next_kink(&seen, 0.3), Some(0.5));
}
