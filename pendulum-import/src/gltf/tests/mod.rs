//! Tests with small files; the motions of their nodes are known in closed form or from matrices.

mod bakes;
mod errors;
mod files;
mod hung;
mod motions;
mod orientations;
mod springs;
mod wild;
mod writer;

use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use writer::Writer;

fn at<const D: usize>(motion: &impl Motion<f64, D>, t: f64, side: Side) -> Sample<f64, D> {
    motion.sample(Time::new(t), side, Derivatives::ALL)
}

#[track_caller]
fn close<const D: usize>(a: [f64; D], b: [f64; D], slack: f64) {
    assert!((0..D).all(|axis| (a[axis] - b[axis]).abs() <= slack), "{a:?} is not {b:?}");
}

fn kinks<const D: usize>(motion: &impl Motion<f64, D>, until: f64) -> Vec<f64> {
    let next = |t: &f64| motion.next_kink(*t).filter(|&kink| kink <= until);
    core::iter::successors(next(&-1.0), next).collect()
}

/// Compares the derivatives of a motion with differences, except near kinks, and returns the times.
#[track_caller]
fn differentiable<const D: usize>(motion: &impl Motion<f64, D>) -> Vec<f64> {
    let (h, kinks) = (1e-3, kinks(motion, 9.0));
    let mut times: Vec<f64> = (0..200).map(|k| 0.0053 + 0.01 * f64::from(k)).collect();
    times.retain(|t| kinks.iter().all(|kink| 2.5 * h <= (kink - t).abs()));
    for &t in &times {
        let x = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(motion, t + k * h, Side::After).position);
        let sample = at(motion, t, Side::After);
        // Central differences of fourth order.
        let first = |d: usize| (x[0][d] - 8.0 * x[1][d] + 8.0 * x[3][d] - x[4][d]) / (12.0 * h);
        let second = |d: usize| {
            (-x[0][d] + 16.0 * x[1][d] - 30.0 * x[2][d] + 16.0 * x[3][d] - x[4][d]) / (12.0 * h * h)
        };
        close(sample.velocity, core::array::from_fn(first), 1e-8);
        close(sample.acceleration, core::array::from_fn(second), 1e-6);
    }
    times
}

/// Three nodes with all kinds of channels and interpolations, and a matrix.
fn dancer() -> (Writer, &'static str) {
    let mut file = Writer::default();
    let quaternion = |axis: [f32; 3], angle: f32| {
        let (sin, cos) = Real::sin_cos(f64::from(angle) / 2.0);
        [axis[0] * sin as f32, axis[1] * sin as f32, axis[2] * sin as f32, cos as f32]
    };
    let turns = [
        quaternion([0.6, 0.0, 0.8], 0.3),
        quaternion([0.0, 1.0, 0.0], 1.4),
        quaternion([0.0, 0.6, -0.8], 2.0),
    ];
    let mut curved = Vec::new();
    for (key, turn) in turns.iter().enumerate() {
        let tangent = [0.3 - key as f32, 0.2, 0.5 * key as f32, -0.4];
        curved.extend(tangent.iter().chain(turn).chain(&tangent));
    }
    let curve: Vec<f32> = (0..27).map(|k| ((7 * k) % 11) as f32 * 0.2 - 1.0).collect();
    let grow = [1.0, 1.0, 1.0, 2.0, 1.5, 0.5, 1.0, 0.5, 1.25];
    file.channel(0, "translation", "CUBICSPLINE", &[0.0, 0.5, 2.0], &curve);
    file.channel(0, "rotation", "LINEAR", &[0.25, 1.0, 1.75], &turns.concat());
    file.channel(1, "scale", "LINEAR", &[0.0, 1.0, 2.0], &grow);
    file.channel(1, "rotation", "CUBICSPLINE", &[0.0, 0.75, 2.0], &curved);
    file.channel(
        3,
        "translation",
        "STEP",
        &[0.0, 1.25, 1.5],
        &[1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    );
    let nodes = r#"{"name":"hips","children":[1]},
        {"name":"spine","translation":[0.1,1,0],"children":[2]},
        {"name":"neck","matrix":[1,0,0,0, 0.25,2,0,0, 0,0,1,0, 0,0.5,0,1],"children":[3]},
        {"name":"head","rotation":[0,0,0,1]}"#;
    (file, nodes)
}
