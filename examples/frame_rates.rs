//! The swing of a shaken pendulum at several frame rates: a scene's, and that of the spring bones
//! of VRM, whose formula contains the frame time.
//!
//! `cargo run --release --example frame_rates` prints the peaks and writes
//! `target/frame-rates.svg`.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Scene, SceneError};
use std::f64::consts::PI;
use std::fmt::Write;

lagrangian! {
    pub struct Bone { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

const RATES: [u32; 5] = [24, 30, 60, 120, 240];
/// Shaken by 5 cm at 2 Hz.
const AMPLITUDE: f64 = 0.05;
const OMEGA: f64 = 4.0 * PI;
const LENGTH: f64 = 0.1;
const SECONDS: u32 = 20;

/// Angles in degrees at the ends of the frames.
type Curve = Vec<(f64, f64)>;

/// A pendulum of 10 cm in a scene, with a damping of 4/s: its angles at the ends of the frames, and
/// the largest of all ticks in the second half.
fn scene(rate: u32) -> Result<(Curve, f64), SceneError> {
    let mut scene = Scene::<f64>::new(240.0)?;
    let hand = scene.joint(Sinusoid::new([AMPLITUDE, 0.0], OMEGA, [0.0, 0.0]));
    let bone = scene.hang(hand, Bone::new(0.01, LENGTH), [0.0], [0.0])?;
    scene.set_damping(bone, 4.0)?;
    let (mut curve, mut peak) = (Curve::new(), 0.0f64);
    for frame in 1..=SECONDS * rate {
        if 2 * (frame - 1) == SECONDS * rate {
            // Frames see the swing where they happen to look; the keys of a bake are all ticks.
            let baked = scene.bake(&[bone], 240 * SECONDS / 2, 0.0)?;
            peak = baked[0].keys().map(|(_, q, _)| q[0].to_degrees().abs()).fold(0.0, f64::max);
        }
        scene.advance(1.0 / f64::from(rate))?;
        curve.push((f64::from(frame) / f64::from(rate), scene.state(bone).0[0].to_degrees()));
    }
    Ok((curve, peak))
}

/// The formula of VRMC_springBone 1.0: stiffness 1, drag force 0.1, no gravity.
fn spring_bone(rate: u32) -> (Curve, f64) {
    let dt = 1.0 / f64::from(rate);
    let (mut current, mut previous, mut curve) = ([0.0, -LENGTH], [0.0, -LENGTH], Curve::new());
    for frame in 1..=SECONDS * rate {
        let t = f64::from(frame) * dt;
        let hand = AMPLITUDE * (OMEGA * t).sin();
        let inertia = [0, 1].map(|i| (current[i] - previous[i]) * (1.0 - 0.1));
        let next = [current[0] + inertia[0] - hand, current[1] + inertia[1] - dt];
        let length = next[0].hypot(next[1]);
        previous = current;
        current = [hand + LENGTH * next[0] / length, LENGTH * next[1] / length];
        curve.push((t, (current[0] - hand).atan2(-current[1]).to_degrees()));
    }
    let late = curve.iter().filter(|(t, _)| f64::from(SECONDS) / 2.0 < *t);
    let peak = late.fold(0.0f64, |peak, (_, angle)| peak.max(angle.abs()));
    (curve, peak)
}

/// Two panels of curves over the last second and a half, one colour a rate.
fn picture(panels: &[(&str, Vec<(Curve, f64)>)]) -> Result<String, std::fmt::Error> {
    const COLOURS: [&str; 5] = ["#d1495b", "#edae49", "#66a182", "#2e8bc0", "#30336b"];
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 860 360\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"860\" height=\"360\" fill=\"white\"/>\n",
    );
    let (from, to) = (f64::from(SECONDS) - 1.5, f64::from(SECONDS));
    for (panel, (title, curves)) in panels.iter().enumerate() {
        let left = 60.0 + 400.0 * panel as f64;
        let most = curves.iter().map(|(_, peak)| *peak).fold(0.0, f64::max) * 1.1;
        let point = |t: f64, angle: f64| {
            (left + 340.0 * (t - from) / (to - from), 170.0 - 120.0 * angle / most)
        };
        writeln!(
            svg,
            "<text x=\"{}\" y=\"28\" text-anchor=\"middle\" font-size=\"15\">{title}</text>",
            left + 170.0
        )?;
        writeln!(
            svg,
            "<rect x=\"{left}\" y=\"50\" width=\"340\" height=\"240\" fill=\"none\" stroke=\"#999\"/>"
        )?;
        let step = if 30.0 < most { 20.0 } else { 10.0 };
        for line in -3..=3 {
            let angle = f64::from(line) * step;
            if angle.abs() < most {
                let (_, y) = point(from, angle);
                writeln!(svg, "<path d=\"M{left} {y:.1}h340\" stroke=\"#e4e4e4\"/>")?;
                writeln!(
                    svg,
                    "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{angle}°</text>",
                    left - 6.0,
                    y + 4.0
                )?;
            }
        }
        for (index, ((curve, peak), colour)) in curves.iter().zip(COLOURS).enumerate() {
            let seen = curve.iter().filter(|(t, _)| from <= *t + 1e-9);
            let points: Vec<String> = seen
                .map(|&(t, angle)| point(t, angle))
                .map(|(x, y)| format!("{x:.1},{y:.1}"))
                .collect();
            // Those that lie on each other are seen through each other.
            let (width, dashes) =
                if panel == 0 { (2.0, format!("6 {}", 6 * index)) } else { (1.6, "none".into()) };
            let points = points.join(" ");
            writeln!(
                svg,
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\"/>"
            )?;
            let (x, rate) = (left + 68.0 * index as f64, RATES[index]);
            writeln!(svg, "<text x=\"{x}\" y=\"318\" fill=\"{colour}\">{rate} fps</text>")?;
            writeln!(svg, "<text x=\"{x}\" y=\"336\" fill=\"{colour}\">{peak:.1}°</text>")?;
        }
    }
    writeln!(svg, "<text x=\"20\" y=\"327\" font-size=\"12\" fill=\"#555\">peak</text>")?;
    svg.push_str("</svg>\n");
    Ok(svg)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ours = RATES.iter().map(|&rate| scene(rate)).collect::<Result<Vec<_>, _>>()?;
    let theirs: Vec<_> = RATES.iter().map(|&rate| spring_bone(rate)).collect();
    println!("{:>6}  {:>20}  {:>12}", "fps", "pendulum in a scene", "spring bone");
    for ((rate, ours), theirs) in RATES.iter().zip(&ours).zip(&theirs) {
        println!("{rate:>6}  {:>19.12}°  {:>11.1}°", ours.1, theirs.1);
    }
    let svg =
        picture(&[("a pendulum in a scene", ours), ("the formula of VRM spring bones", theirs)])?;
    std::fs::create_dir_all("target")?;
    std::fs::write("target/frame-rates.svg", svg)?;
    println!("written: target/frame-rates.svg");
    Ok(())
}
