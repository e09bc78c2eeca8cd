//! Constrained systems: `cargo bench -p pendulum-runtime --bench constraints`.
//!
//! The error and the time of a bob on a rod in Cartesian coordinates, of the same pendulum in its
//! angle, of Andrews' squeezing mechanism, and of a slider with dry friction beside smooth friction
//! over a width of 1e-6. `-- --radau Rscript` compiles
//! `benches/peers/andrews` and runs RADAU5 on it through deSolve for R, with the same definition of
//! the error.

#![allow(mixed_script_confusables, confusable_idents, missing_docs)]

use pendulum_runtime::prelude::*;
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use systems::constrained::{ANDREWS_END, ANDREWS_START, Bob, Simple, andrews};

lagrangian! {
    /// A slider under a force that swings, with dry friction.
    pub struct Slider { m: kg, A: m, w: Hz, F: N }
    coordinate x: m;
    kinetic = m*ẋ^2/2;
    force x = m*A*w^2*sin(w*t);
    friction f: ẋ, force = F;
}

lagrangian! {
    /// The same slider with smooth friction over the width u.
    pub struct Smooth { m: kg, A: m, w: Hz, F: N, u: m/s }
    coordinate x: m;
    kinetic = m*ẋ^2/2;
    force x = m*A*w^2*sin(w*t) - F*tanh(ẋ/u);
}

macro_rules! slider {
    ($name:literal, $system:expr, $method:expr, $rtol:expr) => {{
        let (system, mut times, mut end) = ($system, Vec::new(), 0.0);
        for _ in 0..101 {
            let clock = Instant::now();
            let run = solve(black_box(&system), (0.0, 10.0), [0.0], [10.0]);
            end = run.method($method).rtol($rtol).atol($rtol).run().unwrap().end.q[0];
            times.push(clock.elapsed().as_secs_f64());
        }
        println!(
            "slider, {:8} {:.0e}: error {:.0e} in {:7.1} µs",
            $name,
            $rtol,
            (end - 74.318_082_488).abs(),
            1e6 * median(times)
        );
    }};
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

macro_rules! bob {
    ($name:literal, $method:expr, $rtol:expr) => {{
        let (bob, simple) = (Bob::new(1.0, 1.0), Simple::new(1.0));
        let start = [1f64.sin(), -1f64.cos()];
        let (mut times, mut errors) = ([Vec::new(), Vec::new()], [0.0; 2]);
        let exact = solve(&simple, (0.0, 50.0), [1.0], [0.0]).rtol(1e-14).atol(1e-14).run();
        let exact = exact.unwrap().end.q[0];
        for _ in 0..21 {
            let clock = Instant::now();
            let run = solve(black_box(&bob), (0.0, 50.0), start, [0.0; 2]);
            let end = run.method($method).rtol($rtol).atol($rtol).run().unwrap().end;
            times[0].push(clock.elapsed().as_secs_f64());
            errors[0] = (end.q[0].atan2(-end.q[1]) - exact).abs();
            let clock = Instant::now();
            let run = solve(black_box(&simple), (0.0, 50.0), [1.0], [0.0]);
            let end = run.method($method).rtol($rtol).atol($rtol).run().unwrap().end;
            times[1].push(clock.elapsed().as_secs_f64());
            errors[1] = (end.q[0] - exact).abs();
        }
        let [cartesian, angle] = times.map(median);
        println!(
            "bob, {:7} {:.0e}: Cartesian {:8.1} µs with error {:.0e}, angle {:8.1} µs with {:.0e}, ratio {:.2}",
            $name,
            $rtol,
            1e6 * cartesian,
            errors[0],
            1e6 * angle,
            errors[1],
            cartesian / angle
        );
    }};
}

macro_rules! andrews {
    ($name:literal, $method:expr, $rtol:expr) => {{
        let own = andrews();
        let (mut times, mut error) = (Vec::new(), 0.0f64);
        for _ in 0..41 {
            let clock = Instant::now();
            let run = solve(black_box(&own), (0.0, 0.03), ANDREWS_START, [0.0; 7]);
            let end = run.method($method).rtol($rtol).atol($rtol).run().unwrap().end;
            times.push(clock.elapsed().as_secs_f64());
            error = (0..7).fold(0.0, |worst, k| {
                worst.max(((end.q[k] - ANDREWS_END[0][k]) / ANDREWS_END[0][k]).abs())
            });
        }
        println!(
            "Andrews, {:7} {:.0e}: error {error:.1e} in {:7.1} µs",
            $name,
            $rtol,
            1e6 * median(times)
        );
    }};
}

fn main() {
    for rtol in [1e-6, 1e-9, 1e-12] {
        bob!("Picard", Picard, rtol);
        bob!("Dop853", Dop853, rtol);
        bob!("Taylor", Taylor::new(), rtol);
    }
    for digits in 4..=12 {
        let rtol = 10f64.powi(-digits);
        andrews!("Picard", Picard, rtol);
        andrews!("Dop853", Dop853, rtol);
        andrews!("Taylor", Taylor::new(), rtol);
    }
    for digits in 4..=9 {
        let rtol = 10f64.powi(-digits);
        let w = core::f64::consts::TAU;
        slider!("friction", Slider::new(1.0, 1.0, w, 2.0), Dop853, rtol);
        slider!("tanh", Smooth::new(1.0, 1.0, w, 2.0, 1e-6), Rodas4, rtol);
    }
    let mut arguments = std::env::args();
    if let (Some(_), Some(program)) = (arguments.find(|word| word == "--radau"), arguments.next()) {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/peers/andrews");
        let library = std::env::temp_dir().join("andrews.so");
        let built = Command::new("cc")
            .args(["-O2", "-shared", "-fPIC", "-o"])
            .arg(&library)
            .arg(format!("{folder}/andrews.c"))
            .arg("-lm")
            .status();
        let run = Command::new(program).arg(format!("{folder}/andrews.R")).arg(&library).output();
        match (built, run) {
            (Ok(built), Ok(run)) if built.success() => {
                println!(
                    "RADAU5: tolerance, error, seconds\n{}",
                    String::from_utf8_lossy(&run.stdout)
                );
            }
            (built, run) => println!("RADAU5 cannot be run: {built:?}, {run:?}"),
        }
    }
}
