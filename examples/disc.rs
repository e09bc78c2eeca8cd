//! A coin that rolls across a table, leans, and returns on a curve.
//!
//! `cargo run --release --example disc` writes `target/disc.svg`: the coin seen from above at equal
//! times, and the path of its point of contact. The coin rolls without slipping: the constraints
//! are equations of velocities, which no choice of coordinates fulfils.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use pictures::{Chart, Curve, Picture, color};
use std::error::Error;
use std::f64::consts::TAU;

lagrangian! {
    /// Heading ψ, lean θ from upright to the right, spin φ; (X, Y) is the point of contact.
    pub struct Disc { r: m, g: m/s^2 = 9.81 }
    coordinate X: m;
    coordinate Y: m;
    coordinate ψ: rad;
    coordinate θ: rad;
    coordinate φ: rad;
    let center = [X + r*sin(θ)*sin(ψ), Y - r*sin(θ)*cos(ψ), r*cos(θ)];
    kinetic = |dot(center)|^2/2 + r^2/8*(θ̇^2 + ψ̇^2*cos(θ)^2) + r^2/4*(φ̇ + ψ̇*sin(θ))^2;
    potential = g*height(center);
    constraint along: Ẋ = r*φ̇*cos(ψ);
    constraint across: Ẏ = r*φ̇*sin(ψ);
    output middle: [m; 3] = center;
    output grip: m/s^2 = sqrt(reaction(along)^2 + reaction(across)^2);
}

fn main() -> Result<(), Box<dyn Error>> {
    let disc = Disc::new(0.3);
    let spin = 4.2;
    let v = [disc.r * spin, 0.0, -0.35, 0.9, spin];
    let solution = solve(&disc, (0.0, 6.0), [0.0, 0.0, 0.0, 0.2, 0.0], v)
        .rtol(1e-10)
        .atol(1e-10)
        .every(0.02)
        .run()?;
    let way = solution.q.iter().map(|q| (q[0], q[1]));
    let mut chart = Chart::drawing();
    for (k, state) in solution.iter().enumerate().step_by(5) {
        // The rim, seen from above.
        let [x, y, _] = disc.middle(state.t, &state.q, &state.v);
        let (heading, lean) = (state.q[2], state.q[3]);
        let rim = (0..=48).map(|j| {
            let (sin, cos) = (TAU * f64::from(j) / 48.0).sin_cos();
            let side = disc.r * cos * lean.sin();
            (
                x + disc.r * sin * heading.cos() + side * heading.sin(),
                y + disc.r * sin * heading.sin() - side * heading.cos(),
            )
        });
        let color = color::hue(210.0 + 120.0 * k as f64 / solution.len() as f64);
        chart = chart.curve(Curve::new(rim).color(color).width(1.2).filled());
    }
    Picture::new("A coin rolls across a table, leans, and comes round", (960, 640))
        .chart(chart.curve(Curve::new(way).color(color::ORANGE).width(3.0)))
        .save("target/disc.svg")?;
    let energy = solution.energy(&disc);
    let drift = energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max);
    let grip = solution.output(&disc, "grip")?.into_iter().fold(0.0, f64::max);
    println!("{}", solution.stats);
    println!("energy kept to {drift:.1e} J/kg, grip up to {grip:.2} N/kg; target/disc.svg");
    Ok(())
}
