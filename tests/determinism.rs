//! Hashes of the final states of all methods on many systems and of the numbers of every other
//! feature, which are the same in every build.
//!
//! Test and release profile, with and without the machine's own instructions
//! (`RUSTFLAGS="-C target-cpu=native"`), must agree with `data/determinism.txt`.
//! `UPDATE_GOLDEN=1 cargo test --test determinism` rewrites the file after an intended change of
//! the digits.

#![allow(missing_docs)]

use systems::fingerprints;
use systems::random::Random;

/// Returns position, velocity and acceleration.
#[cfg(any(feature = "bvh", feature = "gltf"))]
fn at(motion: &impl pendulum_runtime::motion::Motion<f64, 3>, t: f64) -> [[f64; 3]; 3] {
    use pendulum_runtime::motion::{Derivatives, Side};
    let time = pendulum_runtime::time::Time::new(t);
    let sample = motion.sample(time, Side::After, Derivatives::ALL);
    [sample.position, sample.velocity, sample.acceleration]
}

/// Returns a line for each format of files that this build reads.
fn imports() -> Vec<String> {
    #[allow(unused_mut)]
    let mut lines = Vec::new();
    #[cfg(any(feature = "bvh", feature = "gltf"))]
    let mut moved = |name: &str, motion: &dyn Fn(f64) -> [[f64; 3]; 3]| {
        let times = (0..40).map(|k| 0.11 * f64::from(k) - 0.3);
        let numbers = times.flat_map(|t| motion(t).into_iter().flatten().collect::<Vec<_>>());
        lines.push(format!("import {name} {:016x}", fingerprints::hash(numbers)));
    };
    #[cfg(feature = "bvh")]
    {
        let text = include_str!("../examples/data/jumps.bvh");
        let body = pendulum_runtime::import::bvh::Bvh::read(text).unwrap();
        let tip = body.joints().last().unwrap().name.clone();
        let hand = body.motion(&tip, 0.01).unwrap();
        moved("bvh", &|t| at(&hand, t));
    }
    #[cfg(feature = "gltf")]
    {
        let bytes = include_bytes!("../examples/data/dance.gltf");
        let file = pendulum_runtime::import::gltf::Gltf::read(bytes).unwrap();
        let toe = file.motion(0, file.node("toe").unwrap()).unwrap();
        moved("gltf", &|t| at(&toe, t));
    }
    #[cfg(feature = "svg")]
    {
        use pendulum_runtime::import::svg::{Drawing, Units};
        let text = include_str!("../examples/data/owl.svg");
        let owl = Drawing::read(text, Units { pixel: 1e-3, density: 0.4 }).unwrap();
        let numbers = owl.joints.iter().flat_map(|joint| {
            let body = joint.body.map_or([0.0; 4], |body| {
                [body.mass, body.center[0], body.center[1], body.inertia()]
            });
            [joint.pivot[0], joint.pivot[1], joint.scale].into_iter().chain(body)
        });
        lines.push(format!("import svg {:016x}", fingerprints::hash(numbers)));
    }
    lines
}

#[test]
fn final_states_have_the_bits_that_are_checked_in() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/determinism.txt");
    let mut found = fingerprints::all();
    found.extend(imports());
    let text = std::fs::read_to_string(path).unwrap();
    // A build without a format of files has no line of it.
    let formats = [cfg!(feature = "bvh"), cfg!(feature = "gltf"), cfg!(feature = "svg")];
    let formats = formats.into_iter().zip(["import bvh ", "import gltf ", "import svg "]);
    let unread: Vec<_> = formats.filter(|(read, _)| !read).map(|(_, name)| name).collect();
    let is_unread = |line: &&str| unread.iter().any(|name| line.starts_with(name));
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        found.extend(text.lines().filter(is_unread).map(str::to_owned));
        std::fs::write(path, found.join("\n") + "\n").unwrap();
        return;
    }
    let expected: Vec<&str> = text.lines().filter(|line| !is_unread(line)).collect();
    let differ: Vec<String> = found
        .iter()
        .zip(&expected)
        .filter(|(found, expected)| found != expected)
        .map(|(a, b)| format!("{a} for {b}"))
        .collect();
    assert!(
        differ.is_empty() && found.len() == expected.len(),
        "{} lines for {}\n{}",
        found.len(),
        expected.len(),
        differ.join("\n")
    );
}

#[test]
fn lanes_have_the_bits_of_single_systems() {
    for (system, lanes) in fingerprints::lanes_that_differ(500) {
        assert_eq!(lanes, 0, "{system}");
    }
}

#[test]
fn random_numbers_are_those_of_the_reference() {
    // Published with the Java original for the seed 1234567.
    let mut random = Random::new(1234567);
    let expected = [6457827717110365317, 3203168211198807973, 9817491932198370423];
    assert_eq!([0; 3].map(|_| random.bits()), expected);
}
