//! A leg that swings from the hip: the knee bends one way only, and hits a stop where it is stretched
//! and where it is bent all the way.
//!
//! `cargo run --release --example bounce` prints the impacts and draws the path of the foot into
//! `target/bounce.svg`: it has a corner wherever the knee hits the stop.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::integrate::Event;
use pendulum_runtime::prelude::*;
use std::fmt::Write;

lagrangian! {
    pub struct Leg { m: [kg; 2], L: [m; 2], g: m/s^2 = 9.81 }
    coordinate φ: rad;
    coordinate ψ: rad;
    let knee = L[0] * [sin(φ), -cos(φ)];
    let foot = knee + L[1] * [sin(ψ), -cos(ψ)];
    kinetic = m[0]/2 * |dot(knee)|^2 + m[1]/2 * |dot(foot)|^2;
    potential = g*(m[0]*height(knee) + m[1]*height(foot));
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let leg = Leg::new([2.0, 1.0], [1.0, 0.9]);
    // The knee bends by φ − ψ from 0 to 2.2 rad; the stops give back 0.7 of the speed.
    let stop = Event::new(|_t, q, _v| (q[0] - q[1]) * (2.2 - (q[0] - q[1]))).falling();
    let stop = stop.then(|state| state.bounce(&leg, &[1.0, -1.0], 0.7));
    let swing =
        solve(&leg, (0.0, 7.0), [2.4, 0.9], [0.0, 0.0]).rtol(1e-9).events([stop]).dense().run()?;

    println!("  time    speed of the knee before and after      energy lost");
    for hit in &swing.events {
        let (q, v, w) = (hit.state.q, hit.state.v, hit.after.v);
        let lost = leg.energy_at(0.0, &q, &v) - leg.energy_at(0.0, &q, &w);
        println!("{:6.3} s {:9.4} {:9.4} rad/s {lost:18.6} J", hit.time, v[0] - v[1], w[0] - w[1]);
    }

    let place = |t: f64| {
        let q = swing.at(t).map_or([0.0; 2], |state| state.q);
        let (sin, cos) = (q.map(f64::sin), q.map(f64::cos));
        let knee = [300.0 + 140.0 * sin[0], 260.0 + 140.0 * cos[0]];
        (knee, [knee[0] + 126.0 * sin[1], knee[1] + 126.0 * cos[1]])
    };
    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 130 600 420' fill='none' stroke-linecap='round'>\n\
         <rect y='130' width='600' height='420' fill='#10141f'/>\n",
    );
    for k in 0..=100 {
        let ([x, y], [u, v]) = place(0.07 * f64::from(k));
        writeln!(
            svg,
            "<path d='M300 260L{x:.1} {y:.1}L{u:.1} {v:.1}' stroke='#8fa3c8' stroke-opacity='0.18' stroke-width='2'/>"
        )?;
    }
    // From blue to orange as time goes on.
    for part in 0..350 {
        let points = (0..=8).map(|k| place(0.02 * (f64::from(part) + f64::from(k) / 8.0)).1);
        let path: Vec<String> = points.map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
        let hue = 210.0 - 180.0 * f64::from(part) / 350.0;
        writeln!(
            svg,
            "<path d='M{}' stroke='hsl({hue:.0},85%,60%)' stroke-width='2.2'/>",
            path.join("L")
        )?;
    }
    for hit in &swing.events {
        let [x, y] = place(hit.state.t).1;
        let radius = 3.0 + (hit.state.v[0] - hit.state.v[1]).abs();
        writeln!(
            svg,
            "<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}' stroke='#ffffff' stroke-width='1.5'/>"
        )?;
    }
    writeln!(svg, "<circle cx='300' cy='260' r='5' fill='#ffffff'/>\n</svg>")?;
    std::fs::create_dir_all("target")?;
    std::fs::write("target/bounce.svg", svg)?;
    println!("\n{} impacts; the path of the foot is in target/bounce.svg", swing.events.len());
    Ok(())
}
