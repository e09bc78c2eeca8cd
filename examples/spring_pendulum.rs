//! A pendulum on a spring whose energy moves from the spring to the swing and back: columns of a
//! solution, its energy, and a table as CSV.
//!
//! `cargo run --release --features csv --example spring_pendulum` prints the table, and writes
//! `target/spring-pendulum.csv` and `target/spring-pendulum.svg`.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use pictures::{Axis, Chart, Curve, Picture, color};
use std::error::Error;

lagrangian! {
    pub struct SpringPendulum { m: kg, k: N/m, L: m, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate θ: rad;
    let y = r * [sin(θ), -cos(θ)];
    kinetic   = m/2 * |ẏ|^2;
    potential = k/2 * (r - L)^2 + m*g*height(y);
}

fn main() -> Result<(), Box<dyn Error>> {
    // The spring vibrates twice while the pendulum swings once: k/m = 4 g/(L + m g/k).
    let pendulum = SpringPendulum::new(1.0, 3.0 * 9.81, 1.0);
    let rest = 1.0 + 1.0 / 3.0;
    let (q, v) = ([rest + 0.25, 0.02], [0.0, 0.0]);
    let solution = solve(&pendulum, (0.0, 60.0), q, v).rtol(1e-11).every(0.02).run()?;

    let energy = solution.energy(&pendulum);
    let (r, θ) = (solution.column("r")?, solution.column("θ")?);
    let table = solution.table().with("energy", "J", energy.clone())?;
    println!("{table}\n{}", solution.stats);
    let drift = energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max);
    println!("energy kept to {drift:.1e} J");
    table.to_csv(std::fs::File::create("target/spring-pendulum.csv")?)?;

    // The path of the bob, with a colour that changes with time.
    let bob = solution.q.iter().map(|[r, θ]| (r * θ.sin(), -r * θ.cos()));
    let path = Chart::drawing().title("path of the bob").way(bob, (200.0, 360.0));
    let curve = |values: Vec<f64>, color, name| {
        Curve::new(solution.t.iter().copied().zip(values)).color(color).name(name)
    };
    let stretch = r.iter().map(|r| r - rest).collect();
    let columns = Chart::new(Axis::linear("t in s"), Axis::linear("stretch in m, angle in rad"))
        .curve(curve(stretch, color::BLUE, "stretch"))
        .curve(curve(θ, color::ORANGE, "angle"));
    Picture::new("A spring gives its energy to the swing, and takes it back", (1000, 460))
        .chart(path)
        .chart(columns)
        .save("target/spring-pendulum.svg")?;
    println!("target/spring-pendulum.csv, target/spring-pendulum.svg");
    Ok(())
}
