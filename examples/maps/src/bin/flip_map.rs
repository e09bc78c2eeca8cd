//! The time that a double pendulum takes to turn over, for every start at rest.
//!
//! `cargo run --release -p maps --bin flip_map -- --size 1000` writes `target/flip_map.png`: the
//! angle of the upper link goes from −180° to 180° from left to right, and that of the lower link
//! from bottom to top. The sooner one of the links turns over, the brighter is the pixel. In the
//! black region in the middle the energy is too low for a turn.

#![allow(mixed_script_confusables, missing_docs)]

use maps::{Options, bar, bytes, mix, place};
use pendulum_runtime::ensemble::EnsembleError;
use pendulum_runtime::integrate::{Event, Status};
use pendulum_runtime::prelude::*;
use std::error::Error;
use std::f64::consts::PI;
use std::ops::ControlFlow;

lagrangian! {
    /// Two links of equal length and mass.
    pub struct Double { l: m, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    let y[k in 0..2] = sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = |ẏ[0]|^2/2 + |ẏ[1]|^2/2;
    potential = g*(height(y[0]) + height(y[1]));
}

/// The longest time in units of √(l/g).
const LONGEST: f64 = 1000.0;

fn problem(k: usize, size: usize) -> Problem<Double, 2> {
    let q = [place(k % size, size, PI), -place(k / size, size, PI)];
    // The least energy for a turn is that of an upright lower link below a hanging upper link.
    let turns = 2.0 * q[0].cos() + q[1].cos() <= 1.0;
    let system = Double::new(1.0);
    let end = if turns { LONGEST / system.g.sqrt() } else { 0.0 };
    Problem { system, time: (0.0, end), q, v: [0.0; 2] }
}

/// Returns the colour of a time: from white for short times over yellow, red and blue to dark for
/// long times, and black without a turn.
fn color(time: Option<f64>) -> [u8; 3] {
    const COLORS: [[f64; 3]; 6] = [
        [1.0, 1.0, 0.92],
        [1.0, 0.86, 0.35],
        [0.93, 0.38, 0.18],
        [0.58, 0.12, 0.35],
        [0.18, 0.13, 0.42],
        [0.05, 0.06, 0.16],
    ];
    let Some(time) = time else { return [0; 3] };
    let place = 5.0 * (time.max(1.0).ln() / LONGEST.ln());
    let index = (place as usize).min(4);
    bytes(mix(COLORS[index], COLORS[index + 1], place - index as f64))
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::read("flip_map")?;
    let size = options.size;
    let over = |link: usize| Event::new(move |_, q: &[f64; 2], _| q[link] * q[link] - PI * PI);
    let progress = bar(size * size);
    let gathered = options.on_threads(|| -> Result<_, EnsembleError> {
        let map = Ensemble::new(0..size * size, |k| problem(k, size))
            .rtol(1e-9)
            .events([over(0).terminal(), over(1).terminal()])
            .map(|_, solution| match solution.status {
                Status::Event(_) => Some(solution.end.t * 9.81_f64.sqrt()),
                _ => None,
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
    let turned = gathered.value.iter().flatten().flatten().count();
    println!("{turned} of {} turn over; {} failed", size * size, gathered.tally.failed);
    options.write(&gathered.value.into_iter().map(|time| color(time.flatten())).collect::<Vec<_>>())
}
