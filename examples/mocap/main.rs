//! Feathers on somebody who jumps: compound pendulums driven by captured motion.
//!
//! `cargo run --release --example mocap [file.bvh [metres per unit]]` reads a clip, hangs a pendulum on both hands, the head and the hips,
//! integrates its equations, which `lagrangian!` derives, and those derived by hand, and writes `target/mocap.csv` and
//! `target/mocap.svg`, which plays in a browser.

#![allow(mixed_script_confusables)]

mod bvh;
mod hand;
mod picture;
mod run;
mod stage;

use bvh::Bvh;
use hand::Hand;
use indicatif::{ProgressBar, ProgressStyle};
use pendulum_runtime::body::{Body, Polygon};
use pendulum_runtime::motion::{Clip, Interpolation, Side};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use picture::{Picture, Worn};
use run::{Swing, swing};
use stage::{Plane, find, limbs};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Instant;

lagrangian! {
    /// A flat body that hangs by its end from a moving point, with a little friction there.
    pub struct Tag {
        /// The body as seen from its pivot.
        B: body,
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
}

/// What is hung where: label, names of the joint in plain letters, length in metres, colour.
const PLACES: [(&str, &[&str], f64, &str); 4] = [
    ("left hand", &["lefthand", "lhand", "handl", "leftwrist", "lwrist", "wristl"], 0.16, "#0072b2"),
    ("right hand", &["righthand", "rhand", "handr", "rightwrist", "rwrist", "wristr"], 0.16, "#d55e00"),
    ("head", &["head", "neck"], 0.12, "#009e73"),
    ("hips", &["hips", "hip", "pelvis", "root"], 0.2, "#b0488f"),
];

/// The right half of a feather of length one that hangs from the origin, from the quill down.
const FEATHER: [[f64; 2]; 9] = [
    [0.012, 0.0],
    [0.018, -0.16],
    [0.09, -0.24],
    [0.14, -0.36],
    [0.16, -0.52],
    [0.15, -0.68],
    [0.11, -0.84],
    [0.05, -0.95],
    [0.0, -1.0],
];

/// Thin leather, in kg/m².
const DENSITY: f64 = 1.1;

/// The time in which a swing decays to 1/e, in seconds.
const DECAY: f64 = 1.0;

/// Keys a second: the second differences of captured motion are noise above.
const KEYS: f64 = 30.0;

/// Samples between two keys.
const FINE: usize = 4;

/// A clip is shown up to this time, in seconds.
const LONGEST: f64 = 600.0;

/// A pendulum and how it swings.
struct Hung {
    label: &'static str,
    color: &'static str,
    joint: usize,
    outline: Vec<[f64; 2]>,
    /// The joint on its spline, at the times of the swings.
    pivot: Vec<[f64; 2]>,
    spline: Swing,
    linear: Swing,
    hand: Swing,
    /// The largest difference to the hand-written accelerations, and the largest acceleration.
    difference: [f64; 2],
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/jumps.bvh").into());
    let scale = match arguments.next() {
        Some(text) => metres(&text)?,
        None => 1.0,
    };
    let text = fs::read_to_string(&path).map_err(|error| format!("{path}: {error}"))?;
    let bvh = Bvh::read(&text).map_err(|error| format!("{path}: {error}"))?;
    let start = Instant::now();

    // Frames, thinned to keys that are a whole number of frames apart.
    let rate = 1.0 / bvh.frame_time;
    let every = (rate / KEYS).round().max(1.0) as usize;
    let count = (bvh.frames() - 1) / every + 1;
    let seconds = ((count - 1) * every) as f64 / rate;
    if count < 2 {
        return Err(format!("{path}: {} frames are too short a clip; give one of a second or more", bvh.frames()).into());
    }
    if LONGEST < seconds {
        return Err(format!("{path}: a clip of {seconds:.0} s; cut it to {LONGEST} s or less").into());
    }
    let times: Vec<f64> = (0..=(count - 1) * FINE).map(|k| (k * every) as f64 / (rate * FINE as f64)).collect();
    let poses: Vec<Vec<[f64; 3]>> = (0..count).map(|key| bvh.pose(key * every)).collect();
    let height = extent(&poses[0]) * scale;
    if !(0.3 < height && height < 3.5) {
        return Err(format!("{path}: somebody {height:.2} m tall; give the metres in a unit after the path, as 0.01 or 0.0564").into());
    }

    let hips = find(&bvh, PLACES[3].1).unwrap_or(0);
    let walk: Vec<[f64; 3]> = poses.iter().map(|pose| pose[hips]).collect();
    let plane = Plane::fit(&walk, scale);
    let poses: Vec<Vec<[f64; 3]>> = poses.iter().map(|pose| pose.iter().map(|&at| plane.view(at)).collect()).collect();

    let names: Vec<&str> = bvh.joints.iter().filter(|joint| !joint.end).map(|joint| joint.name.as_str()).collect();
    let places: Vec<_> = PLACES.iter().filter_map(|place| find(&bvh, place.1).map(|joint| (place, joint))).collect();
    if places.is_empty() {
        return Err(format!("{path}: no hand, head or hips among the joints {}; rename one", names.join(", ")).into());
    }

    // Hidden where stderr is no terminal.
    let bar = ProgressBar::new(3 * places.len() as u64);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?);
    let mut pendulums = Vec::new();
    for &(&(label, _, length, color), joint) in &places {
        bar.set_message(label);
        let keys: Vec<_> = poses.iter().map(|pose| [pose[joint][0], pose[joint][1]]).collect();
        pendulums.push(hang((label, color, length), joint, &keys, rate / every as f64, &times, &bar)?);
    }
    bar.finish_and_clear();
    let elapsed = start.elapsed().as_secs_f64();

    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("target");
    fs::create_dir_all(&target)?;
    fs::write(target.join("mocap.csv"), sheet(&times, &pendulums))?;
    let worn = pendulums.iter().map(|hung| Worn {
        label: hung.label,
        color: hung.color,
        joint: hung.joint,
        outline: &hung.outline,
        pivot: &hung.pivot,
        spline: &hung.spline.angles,
        linear: &hung.linear.angles,
    });
    let picture = Picture {
        limbs: limbs(&bvh.joints),
        head: find(&bvh, PLACES[2].1),
        poses: &poses,
        worn: worn.collect(),
        seconds,
        fine: FINE,
    };
    fs::write(target.join("mocap.svg"), picture.draw())?;

    report(&pendulums);
    println!("joints: {} ({})", names.len(), names.join(", "));
    println!("pendulums: {} ({})", pendulums.len(), places.iter().map(|(place, _)| place.0).collect::<Vec<_>>().join(", "));
    println!("written: target/mocap.csv, target/mocap.svg");
    println!("simulated: {seconds:.2} s, {} times, in {elapsed:.3} s", 3 * pendulums.len());
    let [difference, largest] = [0, 1].map(|k| pendulums.iter().map(|hung| hung.difference[k]).fold(0.0, f64::max));
    let end = pendulums.iter().map(|hung| apart(&hung.spline, &hung.hand).1).fold(0.0, f64::max);
    println!(
        "largest difference to the hand-written equation: {difference:.1e} rad/s² of {largest:.0} rad/s², {end:.1e} rad at the end"
    );
    Ok(())
}

/// Hangs a feather from a joint and swings it through the clip.
fn hang(
    (label, color, length): (&'static str, &'static str, f64),
    joint: usize,
    keys: &[[f64; 2]],
    rate: f64,
    times: &[f64],
    bar: &ProgressBar,
) -> Result<Hung, Box<dyn Error>> {
    let outline = feather(length);
    let body = Polygon::new(&outline)?.body(DENSITY)?;
    let damping = 2.0 * body.inertia() / DECAY;
    let spline = Clip::new(rate, keys, 1, Interpolation::Spline)?;
    let linear = Clip::new(rate, keys, 1, Interpolation::Linear)?;

    let generated = Tag::new(body, damping).driven_by(spline.clone());
    let by_hand = Driven::new(written(body, damping), (spline.clone(),));
    let swings = [
        counted(bar, || swing(&generated, times)),
        counted(bar, || swing(&Tag::new(body, damping).driven_by(linear), times)),
        counted(bar, || swing(&by_hand, times)),
    ];
    let [spline_swing, linear_swing, hand_swing] = swings;

    let mut difference = [0.0f64; 2];
    for ((&t, &q), &v) in times.iter().zip(&spline_swing.angles).zip(&spline_swing.speeds) {
        let [ours] = generated.accelerations_at(Time::new(t), Side::Before, &[q], &[v]);
        let [theirs] = by_hand.accelerations_at(Time::new(t), Side::Before, &[q], &[v]);
        difference = [difference[0].max((ours - theirs).abs()), difference[1].max(ours.abs())];
    }
    let at = |&t: &f64| Motion::<f64, 2>::sample(&spline, Time::new(t), Side::Before, pendulum_runtime::motion::Orders::POSITION).position;
    let pivot = times.iter().map(at).collect();
    Ok(Hung { label, color, joint, outline, pivot, spline: spline_swing, linear: linear_swing, hand: hand_swing, difference })
}

fn written(body: Body, damping: f64) -> Hand {
    Hand { body, damping, g: 9.81 }
}

fn counted<T>(bar: &ProgressBar, work: impl FnOnce() -> T) -> T {
    let done = work();
    bar.inc(1);
    done
}

/// The outline of a feather that hangs from the origin by its quill.
fn feather(length: f64) -> Vec<[f64; 2]> {
    let left = FEATHER.iter().rev().skip(1).map(|&[x, y]| [-x, y]);
    FEATHER.into_iter().chain(left).map(|point| point.map(|value| value * length)).collect()
}

fn metres(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    value.filter(|&value| 0.0 < value && value.is_finite()).ok_or_else(|| {
        format!("`{text}` metres in a unit of the file; give a positive number, as 0.01 for centimetres")
    })
}

/// The height of a pose.
fn extent(pose: &[[f64; 3]]) -> f64 {
    let heights = || pose.iter().map(|at| at[1]);
    heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
}

/// The largest difference of the angles, and that at the end.
fn apart(a: &Swing, b: &Swing) -> (f64, f64) {
    let differences = || a.angles.iter().zip(&b.angles).map(|(a, b)| (a - b).abs());
    (differences().fold(0.0, f64::max), differences().last().unwrap_or(0.0))
}

/// The table of the swings.
fn report(pendulums: &[Hung]) {
    let peak = |swing: &Swing| swing.angles.iter().fold(0.0f64, |peak, angle| peak.max(angle.abs())).to_degrees();
    println!("{:<12}{:>10}{:>14}{:>20}", "", "peak swing", "linear keys", "largest difference");
    for hung in pendulums {
        println!(
            "{:<12}{:>9.1}°{:>13.1}°{:>19.1}°",
            hung.label,
            peak(&hung.spline),
            peak(&hung.linear),
            apart(&hung.spline, &hung.linear).0.to_degrees()
        );
    }
}

/// Comma-separated values: the time, then the pivot on its spline, the angle on it, on linear keys, and by hand.
fn sheet(times: &[f64], pendulums: &[Hung]) -> String {
    let mut text = String::from("t [s]");
    for hung in pendulums {
        for column in ["x [m]", "y [m]", "angle spline [rad]", "angle linear keys [rad]", "angle hand-written [rad]"] {
            let _ = write!(text, ",{} {column}", hung.label);
        }
    }
    for (row, t) in times.iter().enumerate() {
        let _ = write!(text, "\n{t:.6}");
        for hung in pendulums {
            let [x, y] = hung.pivot[row];
            let angles = [&hung.spline, &hung.linear, &hung.hand].map(|swing| swing.angles[row]);
            let _ = write!(text, ",{x:.6},{y:.6},{:.9},{:.9},{:.9}", angles[0], angles[1], angles[2]);
        }
    }
    text.push('\n');
    text
}
