//! Tests with small files; the motions of their nodes are known in closed form or from matrices.

mod bakes;
mod errors;
mod files;
mod motions;
mod orientations;
mod wild;
mod writer;

use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use writer::Writer;

fn at(motion: &impl Motion<f64, 3>, t: f64, side: Side) -> Sample<f64, 3> {
    motion.sample(Time::new(t), side, Derivatives::ALL)
}

fn close(a: [f64; 3], b: [f64; 3], slack: f64) {
    assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() <= slack), "{a:?} is not {b:?}");
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
