//! The magnet at which a pendulum ends, for every start at rest over a plate with three magnets.
//!
//! `cargo run --release -p maps --bin basins -- --size 1000` writes `target/basins.png`: the colour
//! of a pixel is that of the magnet, and is darker the later the pendulum is caught.

#![allow(missing_docs)]

use maps::{Options, bar, bytes, mix, place};
use pendulum_runtime::ensemble::EnsembleError;
use pendulum_runtime::integrate::{Event, Status};
use pendulum_runtime::prelude::*;
use std::error::Error;
use std::ops::ControlFlow;

lagrangian! {
    /// A bob that hangs close over a plate, with damping; lengths in units of the magnets' distance
    /// from the middle.
    pub struct Magnetic { spring, damping, strength, gap }
    coordinate x;
    coordinate y;
    let bob = [x, y];
    kinetic = (ẋ^2 + ẏ^2)/2;
    let first = |bob - [0, 1]|^2;
    let second = |bob + [sqrt(3), 1]/2|^2;
    let third = |bob + [-sqrt(3), 1]/2|^2;
    potential = spring/2*|bob|^2;
    potential = -strength/sqrt(first + gap^2);
    potential = -strength/sqrt(second + gap^2);
    potential = -strength/sqrt(third + gap^2);
    dissipation = damping/2*(ẋ^2 + ẏ^2);
}

/// √3/2.
const HALF_ROOT: f64 = 0.8660254037844386;
const MAGNETS: [[f64; 2]; 3] = [[0.0, 1.0], [-HALF_ROOT, -0.5], [HALF_ROOT, -0.5]];

fn magnetic() -> Magnetic {
    Magnetic::new(0.2, 0.15, 1.0, 0.25)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::read("basins")?;
    let size = options.size;
    let system = magnetic();
    let energy = move |q: &[f64; 2], v: &[f64; 2]| system.energy(At::of(0.0, q, v));
    // A pendulum with less energy cannot pass between two magnets and stays with the nearer one.
    let bottom = energy(&MAGNETS[0], &[0.0; 2]);
    let barrier = bottom + 0.2 * (energy(&[0.0; 2], &[0.0; 2]) - bottom);
    let caught = Event::new(|_, q: &[f64; 2], v| energy(q, v) - barrier).falling().terminal();
    let progress = bar(size * size);
    let gathered = options.on_threads(|| -> Result<_, EnsembleError> {
        let map = Ensemble::new(0..size * size, |k| Problem {
            system: magnetic(),
            time: (0.0, 200.0),
            q: [place(k % size, size, 3.0), -place(k / size, size, 3.0)],
            v: [0.0; 2],
        })
        .rtol(1e-9)
        .events([caught])
        .map(|_, solution| {
            let [x, y] = solution.end.q;
            let distance = |k: usize| (x - MAGNETS[k][0]).hypot(y - MAGNETS[k][1]);
            let nearest = |a: usize, b: usize| if distance(b) < distance(a) { b } else { a };
            // A pendulum below the barrier from the start has no event.
            let time = if solution.status == Status::Completed { 0.0 } else { solution.end.t };
            ((0..3).fold(0, nearest), time)
        })
        .on_progress(|seen| {
            progress.set_position(seen.members);
            ControlFlow::Continue(())
        });
        match &options.checkpoint {
            Some(folder) => map.checkpoint(folder).collect(),
            None => map.collect(),
        }
    })??;
    progress.finish_and_clear();
    let mut counts = [0; 3];
    let colors = [[0.98, 0.72, 0.25], [0.85, 0.25, 0.33], [0.25, 0.55, 0.80]];
    let pixels = gathered.value.into_iter().map(|member| {
        let Some((magnet, time)) = member else { return [0; 3] };
        counts[magnet] += 1;
        bytes(mix(colors[magnet], [0.03, 0.03, 0.08], ((time - 5.0) / 45.0).max(0.0).sqrt()))
    });
    let pixels: Vec<_> = pixels.collect();
    println!("{counts:?} end at each magnet; {} failed", gathered.tally.failed);
    options.write(&pixels)
}
