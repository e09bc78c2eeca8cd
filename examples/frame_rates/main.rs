//! The swing of a shaken pendulum at several frame rates: in a scene, and by the formula of VRM
//! spring bones, which contains the frame time.
//!
//! `cargo run --release --example frame_rates` prints the peaks and writes
//! `target/frame-rates.svg`.

#![allow(mixed_script_confusables, missing_docs)]

mod spring_bone;

use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Scene, SceneError};
use pictures::{Axis, Chart, Curve, Picture, color};
use spring_bone::spring_bone;
use std::f64::consts::PI;

lagrangian! {
    pub struct Bone { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

const RATES: [u32; 5] = [24, 30, 60, 120, 240];
/// The amplitude of the pivot in metres; its frequency is 2 Hz.
const AMPLITUDE: f64 = 0.05;
const OMEGA: f64 = 4.0 * PI;
const LENGTH: f64 = 0.1;
const SECONDS: u32 = 20;

/// Times and angles in degrees at the ends of the frames, and the largest angle of the second half.
type Swing = (Vec<(f64, f64)>, f64);

/// Simulates a pendulum of 10 cm in a scene, with a damping of 4/s.
fn scene(rate: u32) -> Result<Swing, SceneError> {
    let mut scene = Scene::<f64>::new(240.0)?;
    let hand = scene.joint(Sinusoid::new([AMPLITUDE, 0.0], OMEGA, [0.0, 0.0]));
    let bone = scene.hang(hand, Bone::new(0.01, LENGTH), [0.0], [0.0])?;
    scene.set_damping(bone, 4.0)?;
    let (mut curve, mut peak) = (Vec::new(), 0.0f64);
    for frame in 1..=SECONDS * rate {
        if 2 * (frame - 1) == SECONDS * rate {
            // Frames sample the swing at few times; with a bound of zero, the keys of `bake`
            // include all ticks.
            let baked = scene.bake(&[bone], 240 * SECONDS / 2, 0.0)?;
            peak = baked[0].keys().map(|(_, q, _)| q[0].to_degrees().abs()).fold(0.0, f64::max);
        }
        scene.advance(1.0 / f64::from(rate))?;
        curve.push((f64::from(frame) / f64::from(rate), scene.state(bone).0[0].to_degrees()));
    }
    Ok((curve, peak))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let end = f64::from(SECONDS);
    let chart = |title| {
        let (time, angle) = (Axis::linear("t in s"), Axis::linear("").unit("°"));
        Chart::new(time.range(end - 1.5, end), angle.range(-50.0, 50.0)).title(title)
    };
    let mut charts = ["a pendulum in a scene", "the formula of VRM spring bones"].map(chart);
    println!("{:>6}  {:>20}  {:>12}", "fps", "pendulum in a scene", "spring bone");
    for (rate, color) in RATES.into_iter().zip(color::CURVES) {
        let swings = [scene(rate)?, spring_bone(rate)];
        println!("{rate:>6}  {:>19.12}°  {:>11.1}°", swings[0].1, swings[1].1);
        for (chart, (angles, peak)) in charts.iter_mut().zip(swings) {
            let curve = Curve::new(angles).color(color).name(format!("{rate} fps, {peak:.1}°"));
            *chart = chart.clone().curve(curve);
        }
    }
    let [ours, theirs] = charts;
    Picture::new("Five frame rates: one swing in a scene, five in the formula", (1000, 380))
        .chart(ours)
        .chart(theirs)
        .save("target/frame-rates.svg")?;
    println!("written: target/frame-rates.svg");
    Ok(())
}
