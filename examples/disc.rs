//! A coin that is rolled across a table, leans, and comes round.
//!
//! `cargo run --release --example disc` writes `target/disc.svg`: the coin seen from above at equal
//! times, and the path of its point of contact. It rolls without slipping: the constraints hold
//! velocities, and no coordinates fulfil them by themselves.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;

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
    let (x, y) = (solution.column("X")?, solution.column("Y")?);
    let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (left, right, low, high) =
        (least(&x) - 0.6, most(&x) + 0.6, least(&y) - 0.6, most(&y) + 0.6);
    let scale = 1240.0 / (right - left).max(1.6 * (high - low));
    let place = |x: f64, y: f64| (20.0 + scale * (x - left), 20.0 + scale * (high - y));
    let (width, tall) = (40.0 + scale * (right - left), 40.0 + scale * (high - low));
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width:.0} {tall:.0}'>\n\
         <rect width='{width:.0}' height='{tall:.0}' fill='#101418'/>\n"
    );
    let mut path = String::new();
    for (x, y) in x.iter().zip(&y) {
        let (x, y) = place(*x, *y);
        write!(path, "{}{x:.1} {y:.1}", if path.is_empty() { "M" } else { "L" })?;
    }
    writeln!(svg, "<path d='{path}' fill='none' stroke='#e9b44c' stroke-width='3'/>")?;
    for (k, state) in solution.iter().enumerate().step_by(5) {
        // The rim, seen from above.
        let [x, y, _] = disc.middle(state.t, &state.q, &state.v);
        let (heading, lean) = (state.q[2], state.q[3]);
        let mut rim = String::new();
        for j in 0..48 {
            let (sin, cos) = (TAU * f64::from(j) / 48.0).sin_cos();
            let side = disc.r * cos * lean.sin();
            let (a, b) = place(
                x + disc.r * sin * heading.cos() + side * heading.sin(),
                y + disc.r * sin * heading.sin() - side * heading.cos(),
            );
            write!(rim, "{}{a:.1} {b:.1}", if j == 0 { "M" } else { "L" })?;
        }
        let light = 90 + 150 * k / solution.len();
        writeln!(
            svg,
            "<path d='{rim}Z' fill='#5aa9e6' fill-opacity='0.06' stroke='rgb({},{light},{})' stroke-width='2'/>",
            light / 2,
            80 + 2 * light / 3
        )?;
    }
    svg.push_str("</svg>\n");
    std::fs::write("target/disc.svg", svg)?;
    let energy = solution.energy(&disc);
    let drift = energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max);
    let grip = most(&solution.output(&disc, "grip")?);
    println!("{}", solution.stats);
    println!("energy kept to {drift:.1e} J/kg, grip up to {grip:.2} N/kg; target/disc.svg");
    Ok(())
}
