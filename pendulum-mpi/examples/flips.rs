//! Sums over double pendulums that depend on every bit of the end states: `mpirun -n 4 flips
//! [--members N] [--threads N] [--checkpoint FOLDER]`. Rank 0 prints the sums and the elapsed
//! seconds.

#![allow(mixed_script_confusables)]

use mpi::traits::Communicator;
use pendulum_mpi::Ranks;
use pendulum_runtime::prelude::*;
use std::time::Instant;

lagrangian! {
    pub struct Double { g }
    coordinate θ[2];
    let y[k in 0..2] = sum(j in 0..=k, [sin(θ[j]), -cos(θ[j])]);
    kinetic = |ẏ[0]|^2/2 + |ẏ[1]|^2/2;
    potential = g*(height(y[0]) + height(y[1]));
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().collect();
    let after = |name: &str| {
        words.iter().position(|word| word == name).and_then(|place| words.get(place + 1))
    };
    let number = |name: &str| after(name).and_then(|text| text.parse().ok());
    let (members, threads) =
        (number("--members").unwrap_or(2000), number("--threads").unwrap_or(1));
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let universe = mpi::initialize().ok_or("MPI does not start")?;
    let world = universe.world();
    let ranks = Ranks::new(&world);
    let start = Instant::now();
    let all = Ensemble::new(0..members, |k| Problem {
        system: Double::new(9.81),
        time: (0.0, 5.0 + (k % 7) as f64),
        q: [0.001 * (k % 3000) as f64, -0.5],
        v: [0.0; 2],
    });
    let all = all.rtol(1e-9).map(|_, solution| (solution.end.q[0].sin(), solution.end.v[1]));
    let identity = || (0.0, 0.0);
    let add = |a: (f64, f64), b: (f64, f64)| (a.0 + b.0, a.1 + b.1);
    let gathered = match after("--checkpoint") {
        Some(folder) => all.checkpoint(folder).fold_in(&ranks, identity, add, add)?,
        None => all.fold_in(&ranks, identity, add, add)?,
    };
    if let Some(gathered) = gathered {
        let (a, b): (f64, f64) = gathered.value;
        println!("{:016x} {:016x} of {}", a.to_bits(), b.to_bits(), gathered.tally.members);
        eprintln!(
            "{} ranks, {:.3} s, {} shards resumed",
            world.size(),
            start.elapsed().as_secs_f64(),
            gathered.resumed
        );
    }
    Ok(())
}
