//! A bone on a joint that a hand moves, which the program knows only at the end of each frame.
//!
//! `cargo run --release --example live` prints how far the bone is from its motion on the known
//! formula of the hand, at several frame rates, with exact and with smoothed joints.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::motion::Function;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Live, Scene, SceneError};

lagrangian! {
    pub struct Bone { m: kg, L: m, k: N*m/rad, c: N*m*s/rad }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = k/2*θ^2;
    dissipation = c/2*θ̇^2;
}

/// The position of the hand, and its derivatives: swings of 0.7 and 3 Hz.
fn hand(t: f64) -> [f64; 3] {
    let mut all = [0.0; 3];
    for (size, ω) in [(0.03, 4.4), (0.005, 18.8)] {
        let (sin, cos) = (ω * t).sin_cos();
        all[0] += size * (1.0 - cos);
        all[1] += size * ω * sin;
        all[2] += size * ω * ω * cos;
    }
    all
}

/// Returns the largest difference between a bone on a live joint and one on the formula at the ends
/// of frames, and the largest angle, in radians.
fn difference(live: Live<2>, rate: f64) -> Result<[f64; 2], SceneError> {
    let known = Function::new(|t| [hand(t)[0], 0.0])
        .velocity(|t| [hand(t)[1], 0.0])
        .acceleration(|t| [hand(t)[2], 0.0]);
    // 1.5 Hz and three tenths of the critical damping.
    let bone = || Bone::new(0.1, 0.3, 0.8, 0.051);
    let mut scene = Scene::<f64>::new(240.0)?;
    let (live, known) = (scene.live(live)?, scene.joint(known));
    scene.teleport(live, [0.0, 0.0])?; // so that the first frame is felt
    let told = scene.hang(live, bone(), [0.0], [0.0])?;
    let true_ = scene.hang(known, bone(), [0.0], [0.0])?;
    let [mut apart, mut swing] = [0.0f64; 2];
    for frame in 1..=(10.0 * rate) as u32 {
        // A program would read the mouse here.
        scene.move_to(live, [hand(f64::from(frame) / rate)[0], 0.0])?;
        scene.advance(1.0 / rate)?;
        let [told, true_] = [told, true_].map(|bone| scene.pose(bone, scene.alpha())[0]);
        (apart, swing) = (apart.max((told - true_).abs()), swing.max(true_.abs()));
    }
    Ok([apart, swing])
}

fn main() -> Result<(), SceneError> {
    println!("frames a second    difference, exact    smoothed (one frame late)");
    for rate in [24.0, 60.0, 144.0] {
        let [exact, swing] = difference(Live::new([0.0, 0.0]), rate)?;
        let [smoothed, _] = difference(Live::new([0.0, 0.0]).smoothed(), rate)?;
        let [exact, smoothed] = [exact, smoothed].map(|apart| 100.0 * apart / swing);
        println!("{rate:15} {exact:17.3} % {smoothed:11.3} % of the swing of {swing:.3} rad");
    }
    Ok(())
}
