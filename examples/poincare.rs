//! The Poincaré section of a double pendulum: islands of order in a chaotic sea.
//!
//! `cargo run --release --example poincare` writes `target/poincare.svg`: the angle and the
//! momentum of the lower link whenever the upper link swings through the vertical to the right, for
//! motions of equal energy. The eighty thousand dots form one SVG path for each motion, which chart
//! crates do not support.

#![allow(mixed_script_confusables, missing_docs)]

use indicatif::ProgressBar;
use pendulum_runtime::analysis::poincare;
use pendulum_runtime::prelude::*;
use pictures::{RGBColor, color};
use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write;

lagrangian! {
    /// Two links of equal length and mass; lengths, masses and g are one.
    pub struct Double { g }
    coordinate θ[2];
    let y[k in 0..2] = sum(j in 0..=k, [sin(θ[j]), -cos(θ[j])]);
    kinetic = |ẏ[0]|^2/2 + |ẏ[1]|^2/2;
    potential = g*(height(y[0]) + height(y[1]));
}

/// The energy of the motions. The system has the energy −3 at rest and −1 with the lower link
/// upright.
const ENERGY: f64 = -1.5;
const MOTIONS: usize = 160;
const CROSSINGS: usize = 500;

/// Returns the velocities at θ = (0, `angle`) with the energy `ENERGY` and the momentum p = θ̇₁ +
/// θ̇₀ cos θ₁ of the lower link, if they exist.
fn velocities(angle: f64, p: f64) -> Option<[f64; 2]> {
    let square = 2.0 * (ENERGY + 2.0 + angle.cos()) - p * p;
    let first = (square / (2.0 - angle.cos() * angle.cos())).sqrt();
    (0.0 < square).then(|| [first, p - first * angle.cos()])
}

fn main() -> Result<(), Box<dyn Error>> {
    let double = Double::new(1.0);
    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-640 -400 1280 800' font-family='sans-serif' font-size='18'>\n",
    );
    let (mut count, mut drift) = (0, 0.0_f64);
    // Hidden if stderr is not a terminal.
    for motion in ProgressBar::new(MOTIONS as u64).wrap_iter(0..MOTIONS) {
        // Starts on a spiral of the golden angle cover the allowed area evenly.
        let (radius, turn) = ((motion as f64 + 0.5) / MOTIONS as f64, 2.399963 * motion as f64);
        let (angle, p) = (2.0 * radius.sqrt() * turn.cos(), 1.7 * radius.sqrt() * turn.sin());
        let Some(v) = velocities(angle, p) else { continue };
        let section = poincare(&double, (0.0, 1e5), [0.0, angle], v, |_, q, _| q[0].sin());
        let mut dots = String::new();
        for state in section.rtol(1e-10).start()?.take(CROSSINGS) {
            let State { t, q, v } = state?;
            let angle = q[1] - 2.0 * PI * (q[1] / (2.0 * PI)).round();
            let p = v[1] + v[0] * q[1].cos();
            write!(dots, "M{:.1} {:.1}h0", 290.0 * angle, -205.0 * p)?;
            drift = drift.max((double.energy_at(t, &q, &v) - ENERGY).abs());
            count += 1;
        }
        let RGBColor(r, g, b) = color::hue(360.0 * radius);
        writeln!(
            svg,
            "<path d='{dots}' stroke='rgb({r},{g},{b})' stroke-width='1.7' stroke-linecap='round'/>"
        )?;
    }
    writeln!(
        svg,
        "<text x='0' y='380' fill='#76767c' text-anchor='middle'>angle of the lower link</text>\n\
         <text transform='translate(-620 0) rotate(-90)' fill='#76767c' text-anchor='middle'>its momentum</text></svg>"
    )?;
    std::fs::write("target/poincare.svg", svg)?;
    println!("{count} crossings, energy kept to {drift:.1e}; target/poincare.svg");
    Ok(())
}
