//! An owl of a hundred feathers, each of which is a pendulum with the mass of its drawing.
//!
//! `cargo run --release --features svg --example owl [file.svg]` reads the drawing, whose groups
//! are joints (see `pendulum_runtime::import::svg`). It moves the keyed joints through a dance of
//! four seconds that repeats, simulates the feathers until their motion also repeats, and writes
//! `target/owl.svg`, which plays in a browser, and `target/owl.html`, a page with sliders for
//! gravity and damping.

#![allow(mixed_script_confusables)]

mod animation;
mod bake;
mod dance;
mod feather;
mod page;
mod rig;

use bake::{Baked, Course, Settings};
use indicatif::{ProgressBar, ProgressStyle};
use lexopt::Parser;
use lexopt::prelude::*;
use pendulum_runtime::import::svg::{Drawing, Role, Units};
use rig::Rig;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// The units of the drawing: with a millimetre per pixel, the owl is half a metre high; vanes weigh
/// 200 g/m².
const UNITS: Units = Units { pixel: 1e-3, density: 0.2 };

/// The choices of the page: five gravitational accelerations in m/s² and five damping ratios.
const GRAVITIES: [f64; 5] = [0.0, 4.905, 9.81, 14.715, 19.62];
const DAMPINGS: [f64; 5] = [0.04, 0.08, 0.16, 0.32, 0.64];

/// The settings of `target/owl.svg`, as indices into `GRAVITIES` and `DAMPINGS`.
const SHOWN: [usize; 2] = [2, 2];

const HELP: &str = "\
Lets the feathers of a drawing swing while its keyed joints dance.

cargo run --release --features svg --example owl [FILE.svg]

FILE.svg  the drawing, whose groups are joints; without it, an owl

Written: target/owl.svg, which plays in a browser, and target/owl.html, a page with sliders.";

fn main() -> ExitCode {
    match fly() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn fly() -> Result<(), Box<dyn Error>> {
    let mut path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/owl.svg").to_owned();
    let mut parser = Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Short('h') | Long("help") => {
                println!("{HELP}");
                return Ok(());
            }
            Value(value) => path = value.string()?,
            _ => return Err(argument.unexpected().into()),
        }
    }
    let text = fs::read_to_string(&path).map_err(|error| format!("{path}: {error}"))?;
    let drawing = Drawing::read(&text, UNITS).map_err(|error| format!("{path}: {error}"))?;
    let rig = Rig::new(&drawing).map_err(|error| format!("{path}: {error}"))?;

    // Hidden if stderr is not a terminal.
    let bar = ProgressBar::new(0);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}")?);

    // Only the owl as drawn, to measure the time of a frame.
    let shown = Settings { gravity: GRAVITIES[SHOWN[0]], damping: DAMPINGS[SHOWN[1]] };
    bar.set_message("loops of the owl as drawn");
    let start = Instant::now();
    let alone = bake::swing(&rig, &[shown], &bar)?;
    let seconds = start.elapsed().as_secs_f64();
    let frames = (alone.loops as usize + 1) * bake::FRAMES;

    // All settings of the page in one scene.
    let all: Vec<Settings> = GRAVITIES
        .iter()
        .flat_map(|&gravity| DAMPINGS.map(|damping| Settings { gravity, damping }))
        .collect();
    bar.set_message(format!("loops of the owl under {} settings", all.len()));
    let start = Instant::now();
    let baked = bake::swing(&rig, &all, &bar)?;
    let baking = start.elapsed().as_secs_f64();
    bar.finish_and_clear();

    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("target");
    fs::create_dir_all(&target)?;
    let animated = animation::draw(&text, &rig, &alone.courses[0]);
    fs::write(target.join("owl.svg"), &animated)?;
    let page = page::write(&text, &rig, &baked, [&GRAVITIES, &DAMPINGS], SHOWN);
    fs::write(target.join("owl.html"), &page)?;

    report(&drawing, &rig, &alone);
    println!(
        "time per frame: {:.1} µs at {} frames a second",
        1e6 * seconds / frames as f64,
        bake::RATE
    );
    let (count, many) = (all.len(), all.len() * rig.feathers.len());
    println!(
        "baked: {many} pendulums under {count} settings, {} loops in {baking:.2} s, gap {:.1e} rad",
        baked.loops, baked.gap
    );
    println!(
        "written: target/owl.svg ({} kB) and target/owl.html ({} kB)",
        animated.len() / 1000,
        page.len() / 1000
    );
    Ok(())
}

fn report(drawing: &Drawing, rig: &Rig<'_>, alone: &Baked) {
    let keyed: Vec<&str> = drawing
        .joints
        .iter()
        .filter(|joint| joint.role == Role::Keyed)
        .map(|joint| joint.name.as_str())
        .collect();
    println!("joints: {} ({})", keyed.len(), keyed.join(", "));
    let bodies = || rig.feathers.iter().map(|feather| feather.body);
    let mass: f64 = bodies().map(|body| body.mass).sum();
    let grams =
        |pick: fn(f64, f64) -> f64, first| 1e3 * bodies().map(|body| body.mass).fold(first, pick);
    println!(
        "pendulums: {} feathers of {:.2} g to {:.2} g, {:.1} g in all; {} shapes without fill weigh nothing",
        rig.feathers.len(),
        grams(f64::min, f64::INFINITY),
        grams(f64::max, 0.0),
        1e3 * mass,
        drawing.skipped.len()
    );
    let peak = alone.courses[0]
        .iter()
        .flat_map(Course::swings)
        .fold(0.0, |peak: f64, swing| peak.max(swing.abs()));
    let seconds = f64::from(alone.loops) * dance::PERIOD;
    println!(
        "simulated: {seconds:.2} s, {} loops of {:.0} s until they close with a gap of {:.1e} rad; largest swing {:.1}°",
        alone.loops,
        dance::PERIOD,
        alone.gap,
        peak.to_degrees()
    );
}
