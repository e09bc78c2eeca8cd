//! A tail of five bones on a head, at several frame rates: as bones of a scene, and by the formula of
//! VRM spring bones, which contains the frame time.
//!
//! `cargo run --release --example frame_rates` prints how far the tips are apart and writes the
//! animation `target/frame-rates.svg`.

mod bones;
mod formula;
mod stage;

use pendulum_runtime::scene::{SceneError, VrmSpring};
use pictures::color;
use stage::{Stage, Tails};
use std::f64::consts::PI;

/// The number of bones, and the length of each in metres.
const BONES: usize = 5;
const LENGTH: f64 = 0.07;
/// The settings of all bones.
const SPRING: VrmSpring = VrmSpring {
    stiffness: 0.3,
    gravity_power: 0.1,
    gravity_dir: [0.0, -1.0, 0.0],
    drag_force: 0.3,
    frame_rate: 60.0,
};
const SECONDS: u32 = 6;

/// The positions of the ends of the bones, the head first, along the plane and up.
type Tail = [[f64; 2]; BONES + 1];

/// Returns the place of the head along the plane, its velocity and its acceleration: it sways at
/// 0.5 Hz, and it starts to the right and back, each within 0.6 seconds.
fn head(t: f64) -> [f64; 3] {
    let mut all =
        [0.08 * (PI * t).sin(), 0.08 * PI * (PI * t).cos(), -0.08 * PI * PI * (PI * t).sin()];
    for (start, way) in [(2.0, 0.2), (4.0, -0.2)] {
        let s = ((t - start) / 0.6).clamp(0.0, 1.0);
        all[0] += way * (s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
        all[1] += way / 0.6 * (30.0 * s * s * (1.0 - s) * (1.0 - s));
        all[2] += way / 0.36 * (60.0 * s * (1.0 - s) * (1.0 - 2.0 * s));
    }
    [all[0] - 0.1, all[1], all[2]]
}

/// Returns the times of the ends of the frames at a rate, or of irregular frames. Every sixth of a
/// second is among them.
fn frames(rate: Option<u32>) -> Vec<f64> {
    let (mut times, mut random) = (vec![0.0], 1_u64);
    for sixth in 0..6 * SECONDS {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let count = rate.map_or(3 + (random >> 61) as u32, |rate| rate / 6);
        for frame in 1..=count {
            let passed = f64::from(frame) / f64::from(count);
            // Of irregular frames, the first ones are the longest.
            let passed = if rate.is_none() { passed.sqrt() } else { passed };
            times.push((f64::from(sixth) + passed) / 6.0);
        }
    }
    times
}

/// Returns the largest distance in metres between the tips in two runs, every sixth of a second.
fn apart(run: &[(f64, Tail)], other: &[(f64, Tail)]) -> f64 {
    let tips = |run: &[(f64, Tail)]| -> Vec<[f64; 2]> {
        let sixths = run.iter().filter(|(t, _)| (6.0 * t - (6.0 * t).round()).abs() < 1e-9);
        sixths.map(|(_, tail)| tail[BONES]).collect()
    };
    let both = tips(run).into_iter().zip(tips(other));
    both.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rates = [Some(24), Some(30), Some(60), Some(144), None];
    let mut stages = ["bones in a scene", "the formula of VRM spring bones"].map(Stage::new);
    let usual = frames(Some(60));
    let usual = [bones::run(&usual)?, formula::run(&usual)];
    println!("largest distance of the tip from that at 60 frames a second");
    println!("{:>18}  {:>16}  {:>14}", "frames a second", "bones in a scene", "formula of VRM");
    for (rate, color) in rates.into_iter().zip(color::CURVES) {
        let times = frames(rate);
        let runs = [bones::run(&times)?, formula::run(&times)];
        let name = rate.map_or("irregular".to_owned(), |rate| format!("{rate}"));
        let apart = [0, 1].map(|side| 100.0 * apart(&runs[side], &usual[side]));
        println!("{name:>18}  {:>13.2} cm  {:>11.2} cm", apart[0], apart[1]);
        for ((stage, run), apart) in stages.iter_mut().zip(runs).zip(apart) {
            let color = format!("rgb({},{},{})", color.0, color.1, color.2);
            let label = format!("{name}: {apart:.1} cm");
            stage.tails.push(Tails { run, color, label });
        }
    }
    stage::save(&stages, "target/frame-rates.svg")?;
    println!("written: target/frame-rates.svg");
    Ok(())
}
