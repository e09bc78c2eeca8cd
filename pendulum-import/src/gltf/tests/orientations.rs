//! Tests of orientations of nodes, against products of matrices.

use super::writer::Writer;
use super::{at, dancer, differentiable, kinks};
use crate::gltf::{Gltf, NodeMotion};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Motion, Sample, Side};
use pendulum_core::nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use pendulum_core::scalar::Real;

fn rotation([x, y, z, w]: [f64; 4]) -> Matrix3<f64> {
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    *turn.to_rotation_matrix().matrix()
}

fn scaling(scale: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(scale))
}

/// The axes of a node whose linear part in the world is `linear`.
fn axes(linear: &Matrix3<f64>) -> Matrix3<f64> {
    let mut axes = *linear;
    for mut column in axes.column_iter_mut() {
        column.normalize_mut();
    }
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    axes
}

#[track_caller]
fn close(motion: &NodeMotion<4>, t: f64, expected: &Matrix3<f64>, slack: f64) {
    let found = Attitude::from_quaternion(at(motion, t, Side::After).position).to_matrix();
    assert!((found - expected).amax() < slack, "{found} is not {expected}");
}

/// The quaternions of a file, twice as long as they should be.
const TURNS: [[f32; 4]; 3] = [[0.96, 1.2, 0.0, 1.28], [0.0, -1.2, 1.6, 0.0], [0.0, 0.0, 0.0, 2.0]];

fn wide(turn: usize) -> [f64; 4] {
    TURNS[turn].map(f64::from)
}

/// A parent that turns from one of `TURNS` to the next, a child at rest with the last, both scaled.
fn scaled(outer: [f64; 3], inner: [f64; 3]) -> NodeMotion<4> {
    let mut file = Writer::default();
    file.channel(0, "rotation", "LINEAR", &[0.0, 1.0], &TURNS[..2].concat());
    let nodes = format!(
        r#"{{"scale":{outer:?},"translation":[1,2,3],"children":[1]}},
        {{"rotation":[0,0.6,0,-0.8],"scale":{inner:?},"translation":[0,1,0]}}"#
    );
    Gltf::read(&file.binary(&nodes)).unwrap().orientation(0, 1).unwrap()
}

#[test]
fn orientations_are_those_of_matrices() {
    let motion = scaled([3.0; 3], [0.5; 3]);
    let inner = rotation([0.0, f64::from(0.6f32), 0.0, f64::from(-0.8f32)]);
    close(&motion, 0.0, &(rotation(wide(0)) * inner), 1e-15);
    close(&motion, 1.0, &(rotation(wide(1)) * inner), 1e-15);
    let [from, to] = [0, 1].map(|turn| {
        let [x, y, z, w] = wide(turn);
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
    });
    let middle = *from.slerp(&to, 0.3).to_rotation_matrix().matrix();
    close(&motion, 0.3, &(middle * inner), 1e-14);
}

#[test]
fn an_odd_number_of_mirrors_leaves_the_second_and_third_axis() {
    let inner = rotation([0.0, f64::from(0.6f32), 0.0, f64::from(-0.8f32)]);
    for signs in 0..64 {
        let sign = |bit: usize| if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
        let (outer, own) = ([0, 1, 2].map(|bit| 2.0 * sign(bit)), [3, 4, 5].map(sign));
        let linear = rotation(wide(0)) * scaling(outer) * inner * scaling(own);
        close(&scaled(outer, own), 0.0, &axes(&linear), 1e-14);
    }
}

#[test]
fn lengths_of_scales_do_not_turn() {
    let inner = rotation([0.0, f64::from(0.6f32), 0.0, f64::from(-0.8f32)]);
    close(&scaled([0.1, 7.0, 1.0], [2.0, 0.5, 3.0]), 0.0, &(rotation(wide(0)) * inner), 1e-15);
}

/// Returns a file whose first node stands on the world by a matrix and has a child.
fn on_a_matrix(linear: &Matrix3<f64>) -> Gltf {
    let mut file = Writer::default();
    file.channel(1, "rotation", "STEP", &[0.0, 1.0], &TURNS[..2].concat());
    let columns: Vec<String> = (0..3)
        .map(|k| format!("{},{},{},0", linear[(0, k)], linear[(1, k)], linear[(2, k)]))
        .collect();
    let nodes = format!(
        r#"{{"name":"hip","matrix":[{},4,5,6,1],"children":[1]}},{{"name":"leg"}}"#,
        columns.join(",")
    );
    Gltf::read(&file.binary(&nodes)).unwrap()
}

#[test]
fn a_matrix_has_the_orientation_of_its_columns() {
    for scale in [[1.0, 1.0, 1.0], [2.0, 0.5, 30.0], [-1.0, 2.0, 1.0], [1.0, -1.0, -1.0]] {
        let linear = rotation(wide(0)) * scaling(scale);
        let file = on_a_matrix(&linear);
        close(&file.orientation(0, 0).unwrap(), 0.0, &axes(&linear), 1e-6);
    }
    let mirrored = rotation(wide(0)) * scaling([-1.0, 1.0, 1.0]);
    let leg = on_a_matrix(&mirrored).orientation(0, 1).unwrap();
    close(&leg, 0.5, &axes(&(mirrored * rotation(wide(0)))), 1e-6);
    close(&leg, 1.0, &axes(&(mirrored * rotation(wide(1)))), 1e-6);
}

#[test]
fn a_matrix_with_shear_or_without_an_axis_is_refused_by_name() {
    let mut shear = Matrix3::identity();
    shear[(0, 1)] = 0.01;
    for (linear, what) in [
        (shear, "nodes[0] `hip`: its matrix has shear; "),
        (scaling([1.0, 0.0, 1.0]), "nodes[0] `hip`: its matrix has a column of length zero; "),
    ] {
        for node in 0..2 {
            let message = on_a_matrix(&linear).orientation(0, node).unwrap_err().to_string();
            assert!(message.starts_with(what), "{message}");
        }
        assert!(on_a_matrix(&linear).motion(0, 1).is_ok());
    }
}

#[test]
fn a_scale_that_changes_its_sign_is_refused_by_name() {
    let orientation = |interpolation: &str, scale: &[f32]| {
        let mut file = Writer::default();
        file.channel(0, "scale", interpolation, &[0.0, 1.0], scale);
        Gltf::read(&file.binary(r#"{"name":"hat"}"#)).unwrap().orientation(0, 0)
    };
    let refused = |interpolation: &str, scale: &[f32]| {
        let message = orientation(interpolation, scale).unwrap_err().to_string();
        assert!(message.starts_with("nodes[0] `hat`: its scale changes its sign"), "{message}");
    };
    refused("LINEAR", &[1.0, 1.0, 1.0, 1.0, -1.0, 1.0]);
    refused("STEP", &[1.0, 1.0, 1.0, 1.0, 1.0, -1.0]);
    // The ends are positive and the cubic swings below zero between them.
    let mut swing = [1.0; 18];
    (swing[6], swing[9]) = (-20.0, 20.0);
    refused("CUBICSPLINE", &swing);
    // What only appears or vanishes does not change its sign.
    assert!(orientation("LINEAR", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).is_ok());
    assert!(orientation("STEP", &[-1.0, 1.0, 1.0, 0.0, 1.0, 1.0]).is_ok());
    let mut grows = [1.0; 18];
    (grows[6], grows[9]) = (-3.0, 3.0);
    assert!(orientation("CUBICSPLINE", &grows).is_ok());
}

#[test]
fn derivatives_are_those_of_the_orientation() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    for node in 0..2 {
        let motion = read.orientation(0, node).unwrap();
        for t in differentiable(&motion) {
            let sample = at(&motion, t, Side::After);
            let length: f64 = sample.position.iter().map(|part| part * part).sum();
            assert!((length - 1.0).abs() < 1e-14, "{length}");
        }
    }
}

#[test]
fn kinks_are_those_of_rotations() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    // Lines have a kink at every key; keys of translations and scales do not matter.
    assert_eq!(kinks(&read.orientation(0, 0).unwrap(), 9.0), [0.25, 1.0, 1.75]);
    let inner = read.orientation(0, 1).unwrap();
    assert_eq!(kinks(&inner, 9.0), [0.0, 0.25, 0.75, 1.0, 1.75, 2.0]);
    let rest = |t| Motion::<f64, 4>::rest_until(&inner, t);
    assert_eq!([-1.0, 1.0, 2.0].map(rest), [0.0, 1.0, f64::INFINITY]);
}

/// The quaternion of a full turn ends with the other sign, and begins anew with its own.
#[test]
fn a_wheel_that_turns_on_has_kinks_between_its_turns_only() {
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
    let wheel = Gltf::read(&wheel.text("{}")).unwrap().orientation(0, 0).unwrap();
    let looped = wheel.looped().unwrap();
    assert_eq!(kinks(&looped, 12.0), [0.0, 4.0, 8.0, 12.0]);
    for k in -80..80 {
        let t = 0.25 * f64::from(k);
        let (sin, cos) = Real::sin_cos(t * core::f64::consts::FRAC_PI_4);
        for side in [Side::Before, Side::After] {
            let Sample { position: [w, x, y, z], velocity, .. } = at(&looped, t, side);
            let sign = (w * cos + z * sin).signum();
            assert!((w - sign * cos).abs() < 1e-7 && (z - sign * sin).abs() < 1e-7);
            let speed = w * velocity[3] - z * velocity[0];
            assert!((speed - core::f64::consts::FRAC_PI_4).abs() < 1e-6 && x == 0.0 && y == 0.0);
        }
    }
}
