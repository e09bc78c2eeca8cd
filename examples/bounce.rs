//! A leg that swings from the hip. The knee bends in one direction only, and hits a stop when it is
//! fully stretched or fully bent.
//!
//! `cargo run --release --example bounce` prints the impacts and draws the path of the foot into
//! `target/bounce.svg`: the path has a corner at each impact.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::integrate::Event;
use pendulum_runtime::prelude::*;
use pictures::{Chart, Curve, Picture, color};

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
    // The knee bends by φ − ψ from 0 to 2.2 rad; the coefficient of restitution of the stops is
    // 0.7.
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

    // The positions of the knee and the foot.
    let place = |t: f64| {
        let q = swing.at(t).map_or([0.0; 2], |state| state.q);
        let (sin, cos) = (q.map(f64::sin), q.map(f64::cos));
        let knee = (sin[0], -cos[0]);
        (knee, (knee.0 + 0.9 * sin[1], knee.1 - 0.9 * cos[1]))
    };
    let mut chart = Chart::drawing();
    for k in 0..=100 {
        let (knee, foot) = place(0.07 * f64::from(k));
        chart = chart.curve(Curve::new([(0.0, 0.0), knee, foot]).opacity(0.25));
    }
    chart = chart.way((0..=2800).map(|k| place(f64::from(k) / 400.0).1), (210.0, 30.0));
    for hit in &swing.events {
        let hard = (hit.state.v[0] - hit.state.v[1]).abs();
        chart = chart.dot(place(hit.state.t).1, 2.0 + hard / 2.0, color::ORANGE);
    }
    Picture::new("The foot of a leg whose knee hits its stops", (960, 640))
        .chart(chart.dot((0.0, 0.0), 5.0, color::TEXT))
        .save("target/bounce.svg")?;
    println!("\n{} impacts; the path of the foot is in target/bounce.svg", swing.events.len());
    Ok(())
}
