//! A block on a belt that runs, held by a spring: it sticks, tears itself off, slides back, and
//! sticks again. A violin's string moves in this way, and a brake that squeals.
//!
//! `cargo run --release --example stick_slip` prints the period of the limit cycle beside its
//! formula, and draws the motion into `target/stick-slip.svg`, sticking in orange.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use pictures::{Axis, Chart, Curve, Picture, color};
use std::error::Error;
use std::f64::consts::PI;

lagrangian! {
    pub struct Block { m: kg, k: N/m, u: m/s, F: N, S: N }
    coordinate x: m;
    kinetic   = m/2*ẋ^2;
    potential = k/2*x^2;
    friction belt: ẋ - u, force = F, static = S;
}

fn main() -> Result<(), Box<dyn Error>> {
    let block = Block::new(1.0, 100.0, 0.1, 2.0, 4.0);
    let run = solve(&block, (0.0, 5.0), [0.0], [0.0]).rtol(1e-10).dense().run()?;

    println!(" from s     to s");
    for part in &run.frictions {
        let what = if part.direction == 0 { "sticks" } else { "slides" };
        println!("{:7.4}  {:7.4}  {what}", part.start, part.end);
    }
    // The spring pulls the block off the belt at k x = S. It then swings about x = F/k until it is
    // as fast as the belt again.
    let Block { m, k, u, F, S, .. } = block;
    let ω = (k / m).sqrt();
    let formula = 2.0 * (S - F) / (k * u) + 2.0 / ω * (PI - (ω * (S - F) / (k * u)).atan());
    let sticks: Vec<f64> =
        run.frictions.iter().filter(|part| part.direction == 0).map(|part| part.start).collect();
    let [.., before, last] = sticks[..] else { return Err("the block does not stick".into()) };
    println!("period {:.10} s, by its formula {formula:.10} s", last - before);

    let mut phase = Chart::new(Axis::linear("x in m"), Axis::linear("velocity in m/s"));
    let mut course = Chart::new(Axis::linear("t in s"), Axis::linear("x in m"));
    for part in &run.frictions {
        let color = if part.direction == 0 { color::ORANGE } else { color::BLUE };
        let times = (0..=100).map(|i| part.start + 0.01 * f64::from(i) * (part.end - part.start));
        let states: Vec<_> = times.filter_map(|t| run.at(t).ok()).collect();
        let points = states.iter().map(|state| (state.q[0], state.v[0]));
        phase = phase.curve(Curve::new(points).color(color));
        course = course.curve(Curve::new(states.iter().map(|s| (s.t, s.q[0]))).color(color));
    }
    Picture::new("A block on a belt sticks (orange) and slips (blue)", (1000, 420))
        .chart(phase)
        .chart(course)
        .save("target/stick-slip.svg")?;
    println!("target/stick-slip.svg");
    Ok(())
}
