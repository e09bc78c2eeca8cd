//! The numbers of files of each format are the same in every build.

use pendulum_runtime::import::bvh::Bvh;
use pendulum_runtime::import::gltf::Gltf;
use pendulum_runtime::import::svg::{Drawing, Units};
use pendulum_runtime::motion::{Derivatives, Motion, Side};
use pendulum_runtime::time::Time;
use systems::fingerprints;

/// Returns the line of a motion: positions, velocities and accelerations.
fn moved(name: &str, motion: &impl Motion<f64, 3>) -> String {
    let numbers = (0..40).flat_map(|k| {
        let time = Time::new(0.11 * f64::from(k) - 0.3);
        let sample = motion.sample(time, Side::After, Derivatives::ALL);
        [sample.position, sample.velocity, sample.acceleration].concat()
    });
    format!("import {name} {:016x}", fingerprints::hash(numbers))
}

#[test]
fn files_have_the_bits_that_are_checked_in() {
    let jumps = Bvh::read(include_str!("../../examples/data/jumps.bvh")).unwrap();
    let tip = &jumps.joints().last().unwrap().name;
    let hand = jumps.motion(tip, 0.01).unwrap();

    let dance = Gltf::read(include_bytes!("../../examples/data/dance.gltf")).unwrap();
    let toe = dance.motion(0, dance.node("toe").unwrap()).unwrap();

    let text = include_str!("../../examples/data/owl.svg");
    let owl = Drawing::read(text, Units { pixel: 1e-3, density: 0.4 }).unwrap();
    let numbers = owl.joints.iter().flat_map(|joint| {
        let body = joint
            .body
            .map_or([0.0; 4], |body| [body.mass, body.center[0], body.center[1], body.inertia()]);
        [joint.pivot[0], joint.pivot[1], joint.scale].into_iter().chain(body)
    });
    let drawn = format!("import svg {:016x}", fingerprints::hash(numbers));

    let found = [moved("bvh", &hand), moved("gltf", &toe), drawn];
    fingerprints::compare(&found, |line| line.starts_with("import "));
}
