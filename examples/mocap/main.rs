//! Feathers on a person who jumps: compound pendulums driven by captured motion.
//!
//! `cargo run --release --example mocap [FILE.bvh [METRES]]` reads a clip and hangs a pendulum on
//! each hand, the head and the hips. It integrates the equations that `lagrangian!` derives and
//! those derived by hand, and writes `target/mocap.csv` and `target/mocap.svg`, an animation that
//! plays in a browser.

#![allow(mixed_script_confusables)]

mod hand;
mod hung;
mod picture;
mod sheet;
mod stage;

use hung::{Hung, Place};
use indicatif::{ProgressBar, ProgressStyle};
use lexopt::Parser;
use lexopt::prelude::*;
use pendulum_runtime::import::bvh::Bvh;
use pendulum_runtime::prelude::*;
use picture::{Picture, Worn};
use stage::{Plane, find, limbs};
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

lagrangian! {
    /// A flat body that hangs by its end from a moving point, with a little friction there.
    pub struct Tag {
        /// The body as seen from its pivot.
        B: body,
        /// Its tip as seen from the pivot.
        end: [m; 2],
        /// The friction at the pivot.
        c: N*m*s,
        /// The gravitational acceleration.
        g: m/s^2 = 9.81,
    }

    coordinate θ: rad;
    driven x: [m; 2];

    let r(p) = x + cis(θ)*p;
    kinetic     = integral(p in B, |dot(r(p))|^2 / 2);
    potential   = integral(p in B, g*height(r(p)));
    dissipation = c/2 * θ̇^2;

    output tip: [m; 2] = r(end);
}

/// The places of the pendulums: both hands, the head and the hips.
const PLACES: [Place; 4] = [
    Place {
        label: "left hand",
        names: &["lefthand", "lhand", "handl", "leftwrist", "lwrist", "wristl"],
        length: 0.32,
        color: "#0072b2",
    },
    Place {
        label: "right hand",
        names: &["righthand", "rhand", "handr", "rightwrist", "rwrist", "wristr"],
        length: 0.32,
        color: "#d55e00",
    },
    Place { label: "head", names: &["headend", "head"], length: 0.24, color: "#009e73" },
    Place {
        label: "hips",
        names: &["hips", "hip", "pelvis", "root"],
        length: 0.4,
        color: "#b0488f",
    },
];

/// The name of the joint around which the head is drawn.
const HEAD: &[&str] = &["head"];

/// Keys a second. At higher rates, the second differences of captured motion are noise.
const KEYS: f64 = 30.0;

/// Samples per interval between two keys.
const FINE: usize = 4;

/// The longest part of a clip that is shown, in seconds.
const LONGEST: f64 = 600.0;

const HELP: &str = "\
Hangs feathers on somebody who was captured, and draws how they swing.

cargo run --release --example mocap [FILE.bvh [METRES]]

FILE.bvh  the clip; without it, somebody who jumps
METRES    metres in a unit of the file, as 0.01; without it, 1

Written: target/mocap.svg, which plays in a browser, and target/mocap.csv.";

fn main() -> ExitCode {
    match swing() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn swing() -> Result<(), Box<dyn Error>> {
    let Some((path, scale)) = arguments()? else {
        println!("{HELP}");
        return Ok(());
    };
    let mut bvh = Bvh::open(&path)?;
    if let Some(note) = bvh.note() {
        eprintln!("{note}");
    }
    let jumps = bvh.jumps();
    if jumps.first() == Some(&1) {
        eprintln!("{path}: frame 0 is a pose before the motion, which is left out");
        bvh = bvh.cut(1..)?;
    }
    if let Some(jump) = jumps.iter().find(|&&jump| 1 < jump) {
        eprintln!("{path}: somebody jumps to frame {jump} from another place; feathers will fly");
    }
    let start = Instant::now();

    // Frames, thinned to keys that are a whole number of frames apart.
    let rate = 1.0 / bvh.frame_time();
    let every = (rate / KEYS).round().max(1.0) as usize;
    let count = (bvh.frames() - 1) / every + 1;
    let seconds = ((count - 1) * every) as f64 / rate;
    if count < 2 {
        return Err(format!(
            "{path}: {} frames are too short a clip; give one of a second or more",
            bvh.frames()
        )
        .into());
    }
    if LONGEST < seconds {
        return Err(
            format!("{path}: a clip of {seconds:.0} s; cut it to {LONGEST} s or less").into()
        );
    }
    let times: Vec<f64> =
        (0..=(count - 1) * FINE).map(|k| (k * every) as f64 / (rate * FINE as f64)).collect();
    let poses: Vec<Vec<[f64; 3]>> = (0..count).map(|key| bvh.pose(key * every)).collect();
    let height = extent(&poses[0]) * scale;
    if !(0.3 < height && height < 3.5) {
        return Err(
            format!("{path}: somebody {height:.2} m tall; give the metres in a unit after the path, as 0.01 or 0.0564").into()
        );
    }

    let hips = find(&bvh, PLACES[3].names).unwrap_or(0);
    let walk: Vec<[f64; 3]> = poses.iter().map(|pose| pose[hips]).collect();
    let plane = Plane::fit(&walk, scale);
    let poses: Vec<Vec<[f64; 3]>> =
        poses.iter().map(|pose| pose.iter().map(|&at| plane.view(at)).collect()).collect();

    let names: Vec<&str> =
        bvh.joints().iter().filter(|joint| !joint.end).map(|joint| joint.name.as_str()).collect();
    let places: Vec<_> = PLACES
        .iter()
        .filter_map(|place| find(&bvh, place.names).map(|joint| (place, joint)))
        .collect();
    if places.is_empty() {
        return Err(format!(
            "{path}: no hand, head or hips among the joints {}; rename one",
            names.join(", ")
        )
        .into());
    }

    // Hidden if stderr is not a terminal.
    let bar = ProgressBar::new(3 * places.len() as u64);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?);
    let mut pendulums = Vec::new();
    for &(&place, joint) in &places {
        bar.set_message(place.label);
        let keys: Vec<_> = poses.iter().map(|pose| [pose[joint][0], pose[joint][1]]).collect();
        pendulums.push(Hung::swing(place, joint, &keys, rate / every as f64, &times, &bar)?);
    }
    bar.finish_and_clear();
    let elapsed = start.elapsed().as_secs_f64();

    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("target");
    fs::create_dir_all(&target)?;
    fs::write(target.join("mocap.csv"), sheet::values(&times, &pendulums))?;
    let worn = pendulums.iter().map(|hung| Worn {
        label: hung.place.label,
        color: hung.place.color,
        joint: hung.joint,
        outline: &hung.outline,
        pivot: &hung.pivot,
        tips: &hung.tips,
        spline: &hung.spline.angles,
        linear: &hung.linear.angles,
    });
    let picture = Picture {
        limbs: limbs(bvh.joints()),
        head: find(&bvh, HEAD),
        poses: &poses,
        worn: worn.collect(),
        seconds,
        fine: FINE,
    };
    fs::write(target.join("mocap.svg"), picture.draw())?;

    println!("{}", sheet::swings(&pendulums));
    println!("joints: {} ({})", names.len(), names.join(", "));
    let labels: Vec<&str> = places.iter().map(|(place, _)| place.label).collect();
    println!(
        "pendulums: {} ({}), written to target/mocap.csv and target/mocap.svg",
        labels.len(),
        labels.join(", ")
    );
    println!(
        "simulated: {seconds:.2} s, {} swings, in {:.1} ms",
        3 * pendulums.len(),
        1e3 * elapsed
    );
    println!("largest difference to the hand-written equation: {}", sheet::difference(&pendulums));
    Ok(())
}

/// Returns the path of the clip and the metres in one of its units, or `None` after `--help`.
fn arguments() -> Result<Option<(String, f64)>, Box<dyn Error>> {
    let mut path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/jumps.bvh").to_owned();
    let (mut scale, mut parser, mut count) = (1.0, Parser::from_env(), 0);
    while let Some(argument) = parser.next()? {
        match argument {
            Short('h') | Long("help") => return Ok(None),
            Value(value) if count == 0 => path = value.string()?,
            Value(value) if count == 1 => scale = metres(&value.string()?)?,
            _ => return Err(argument.unexpected().into()),
        }
        count += 1;
    }
    Ok(Some((path, scale)))
}

fn metres(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    value.filter(|&value| 0.0 < value && value.is_finite()).ok_or_else(|| {
        format!(
            "`{text}` metres in a unit of the file; give a positive number, as 0.01 for centimetres"
        )
    })
}

/// Returns the height of a pose.
fn extent(pose: &[[f64; 3]]) -> f64 {
    let heights = || pose.iter().map(|at| at[1]);
    heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
}
