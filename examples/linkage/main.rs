//! Andrews' squeezing mechanism: seven bodies in three closed loops, driven by a motor.
//!
//! `cargo run --release --example linkage` writes `target/linkage.svg`: the mechanism at eight
//! times within 0.03 s.

#![allow(mixed_script_confusables, confusable_idents, missing_docs)]

mod andrews;

use andrews::Andrews;
use pendulum_runtime::prelude::*;
use pictures::{Chart, Curve, Picture, color};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let m = [0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498];
    let inertia = [2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5];
    let fixed = ([-0.06934, -0.00227], [-0.03635, 0.03273], [0.014, 0.072]);
    let own = Andrews::new(m, inertia, fixed.0, fixed.1, fixed.2);
    // `assemble` closes the loops at coordinates near this guess.
    let guess = [-0.0617, 0.0, 0.4553, 0.2227, 0.4874, -0.2227, 1.2305];
    let start = assemble(&own, 0.0, guess, [0.0; 7]).hold("Θ").run()?;
    let solution = solve(&own, (0.0, 0.03), start.q, start.v)
        .rtol(1e-12)
        .atol(1e-12)
        .every(0.03 / 7.0)
        .run()?;
    let mut chart = Chart::drawing();
    for (k, State { t, q, v }) in solution.iter().enumerate() {
        let (dx, dy) = (0.12 * (k % 4) as f64, -0.11 * (k / 4) as f64);
        let at = |[x, y]: [f64; 2]| (x + dx, y + dy);
        let (pin, p, hook) = (own.crank_pin(t, &q, &v), own.joint(t, &q, &v), own.hook(t, &q, &v));
        for (points, color) in [
            (vec![own.C, hook], color::OCHRE),
            (vec![own.B, hook, p, own.B], color::BLUE),
            (vec![own.A, own.left(t, &q, &v), p], color::GREEN),
            (vec![own.A, own.right(t, &q, &v), p], color::PINK),
            (vec![[0.0; 2], pin, p], color::ORANGE),
        ] {
            chart = chart.curve(Curve::new(points.into_iter().map(at)).color(color).width(3.5));
        }
        for point in [[0.0; 2], own.A, own.B, own.C] {
            chart = chart.dot(at(point), 4.0, color::TEXT);
        }
        chart = chart.text(at([-0.03, -0.032]), format!("{:.1} ms", 1e3 * t), color::TEXT);
    }
    Picture::new("Andrews' squeezing mechanism: seven bodies, three loops, one motor", (1040, 560))
        .chart(chart)
        .save("target/linkage.svg")?;
    let State { t, q, v } = &solution.end;
    println!("{}", solution.stats);
    println!(
        "β = {:.12} rad at 0.03 s; the first loop pulls with {:.3} N",
        q[0],
        own.pull(*t, q, v)
    );
    Ok(())
}
