//! The cost of a pendulum in a scene: `cargo bench -p pendulum-runtime --bench scene [--features
//! rayon] [-- --quick] [CASE…]`, written to `target/scene.csv`.
//!
//! With `--threads`, the case `driven` runs with 10² to 10⁶ pendulums alternately on one thread and
//! on all threads; the output contains medians, minimum times and ratios.
//!
//! Each result is the median of the runs of a case. The same run measures a hand-written scalar
//! loop for comparison: leapfrog with `f64::sin` (`f32::sin`) for a single pendulum over a long
//! time. A step is one evaluation. All pendulums count, whether awake or asleep.
//!
//! | case | content |
//! |---|---|
//! | `free`, `still`, `driven` | no joints, joints at rest, joints that move: a frame of four ticks, one step each |
//! | `one_still` | `still` with all pendulums on one joint: the difference is the cost of joints at rest |
//! | `asleep50`, `asleep99` | `driven` with 50 or 99 percent of the joints temporarily at rest and their pendulums asleep |
//! | `hidden99` | `driven` with 99 percent of the pendulums hidden: a sampled joint serves one pendulum |
//! | `shared` | `driven` with all pendulums on ten joints: each joint is sampled once per time |
//! | `types` | `driven` with pendulums of three types on each joint, with equal steps |
//! | `position` | moving joints that do not appear in the equations: they are not sampled |
//! | `hurried` | `driven` with one pendulum in a hundred that needs 16 times as many steps: the others take their usual steps |
//! | `kinked` | keyed joints with a kink in every frame |

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::Scene;
use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

use systems::pendulums::{Hanging, MovingCompound, Simple};

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Following { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2 + m/2 * |ẋ|^2;
    potential = m*g*height(y) + m*g*height(x);
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Sprung { m: kg, L: m, k: N*m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y) + k/2*θ^2;
}

/// The number of ticks in a frame of 1/60 s.
const TICKS: u32 = 4;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Free,
    Still,
    OneStill,
    Driven,
    Asleep50,
    Asleep99,
    Hidden99,
    Shared,
    Types,
    Position,
    Hurried,
    Kinked,
}

const KINDS: [(Kind, &str); 12] = [
    (Kind::Free, "free"),
    (Kind::Still, "still"),
    (Kind::OneStill, "one_still"),
    (Kind::Driven, "driven"),
    (Kind::Asleep50, "asleep50"),
    (Kind::Asleep99, "asleep99"),
    (Kind::Hidden99, "hidden99"),
    (Kind::Shared, "shared"),
    (Kind::Types, "types"),
    (Kind::Position, "position"),
    (Kind::Hurried, "hurried"),
    (Kind::Kinked, "kinked"),
];

fn scene<T: Float>(pendulums: usize, joints: usize, kind: Kind) -> Scene<T> {
    let number = T::from_f64;
    let mut scene = Scene::<T>::new(240.0).expect("a rate");
    scene.set_tolerance(1e-2).expect("a tolerance");
    let joints = match kind {
        Kind::Shared => joints.min(10),
        Kind::OneStill => 1,
        _ => joints,
    };
    // One joint in `moving` moves.
    let moving = match kind {
        Kind::Asleep50 => 2,
        Kind::Asleep99 => 100,
        _ => 1,
    };
    // A joint that rests for an hour and then moves.
    let later =
        || Curve::linear(&[0.0, 3600.0, 3601.0], &[[0.0; 2], [0.0; 2], [0.1, 0.0]]).expect("keys");
    if 1 < moving {
        scene.set_sleep(Some(1e-3)).expect("a tolerance");
    }
    let moved =
        |k: usize| Sinusoid::new([0.05, 0.02], 6.0 + 6.0 * k as f64 / joints as f64, [0.0, 1.0]);
    let times: Vec<f64> = (0..600).map(|key| f64::from(key) / 60.0).collect();
    let values: Vec<[f64; 2]> =
        times.iter().map(|t| [0.02 * (t * 40.0).cos(), 0.02 * (t * 33.0).cos()]).collect();
    let mut hung = 0;
    for joint in 0..joints {
        let handle = match kind {
            Kind::Free | Kind::Still | Kind::OneStill => scene.joint(Still::new([0.0, 0.0])),
            Kind::Asleep50 | Kind::Asleep99 if joint % moving != 0 => scene.joint(later()),
            Kind::Kinked => {
                scene.joint(Curve::linear(&times, &values).and_then(Curve::looped).expect("keys"))
            }
            _ => scene.joint(moved(joint)),
        };
        while hung < pendulums * (joint + 1) / joints {
            let part = hung as f64 / pendulums as f64;
            let length =
                if kind == Kind::Hurried && hung % 100 == 0 { 0.002 } else { 0.3 + 0.5 * part };
            let (m, length, g, q, v) = (
                number(0.1),
                number(length),
                number(9.81),
                [number(if joint % moving == 0 { 1.0 - part } else { 0.0 })],
                [number(0.0)],
            );
            let done = match kind {
                Kind::Free => scene.hang((), Simple { m, L: length, g }, q, v).map(drop),
                Kind::Position => scene.hang(handle, Following { m, L: length, g }, q, v).map(drop),
                Kind::Types if hung % 3 == 1 => {
                    scene.hang(handle, Sprung { m, L: length, k: m, g }, q, v).map(drop)
                }
                Kind::Types if hung % 3 == 2 => {
                    let (c, inertia) = ([number(0.0), -length], m * length * length);
                    scene.hang(handle, MovingCompound { m, c, I: inertia, g }, q, v).map(drop)
                }
                _ => scene.hang(handle, Hanging { m, L: length, g }, q, v).map(drop),
            };
            done.expect("a pendulum");
            hung += 1;
        }
    }
    if kind == Kind::Hidden99 {
        for index in (0..pendulums as u32).filter(|index| index % 100 != 0) {
            let pendulum = scene.handle::<Hanging<T>, 1>(index).expect("a pendulum");
            scene.hide(pendulum).expect("a pendulum");
        }
    }
    if 1 < moving {
        scene.advance_ticks(32);
        let (awake, all) = scene.awake();
        assert!(awake <= all / moving + all / joints + 1, "{awake} of {all} are awake");
    }
    scene
}

/// Defines a function that returns the nanoseconds per step of the scalar loop with the sine of
/// `std`.
macro_rules! baseline {
    ($name:ident, $float:ident) => {
        fn $name(steps: usize) -> f64 {
            let (h, factor): ($float, $float) = (1.0 / 240.0, black_box(9.81 / 0.5));
            let (mut q, mut v): ($float, $float) = (black_box(1.0), 0.0);
            let start = Instant::now();
            for _ in 0..steps {
                q += 0.5 * h * v;
                v -= h * factor * q.sin();
                q += 0.5 * h * v;
            }
            black_box((q, v));
            1e9 * start.elapsed().as_secs_f64() / steps as f64
        }
    };
}

baseline!(baseline_f64, f64);
baseline!(baseline_f32, f32);

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

struct Case<'a> {
    name: &'a str,
    pendulums: usize,
    joints: usize,
    scalar: &'a str,
    threads: usize,
    baseline: fn(usize) -> f64,
    runs: usize,
}

impl Case<'_> {
    fn measure<T: Float>(&self, csv: &mut String, mut scene: Scene<T>) -> f64 {
        let frames = (50_000 / self.pendulums).clamp(1, 500);
        let runs = if self.pendulums < 100_000 { self.runs } else { 11 };
        scene.set_parallel(1 < self.threads);
        scene.advance_ticks(TICKS);
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..runs {
            let start = Instant::now();
            for _ in 0..frames {
                black_box(scene.advance_ticks(TICKS));
            }
            ours.push(
                1e9 * start.elapsed().as_secs_f64()
                    / (frames * self.pendulums * TICKS as usize) as f64,
            );
            theirs.push((self.baseline)(20_000));
        }
        let least = ours.iter().copied().fold(f64::INFINITY, f64::min);
        let (ours, theirs) = (median(ours), median(theirs));
        let Self { name, pendulums, joints, scalar, threads, .. } = self;
        println!(
            "{name:<14} {pendulums:>8} on {joints:>6}  {scalar}  {threads} threads  {ours:8.3} ns a step  {:6.3} of {theirs:.1} ns  {:8.3} ms a frame, at least {least:.3} ns",
            ours / theirs,
            1e-6 * ours * (pendulums * TICKS as usize) as f64
        );
        writeln!(csv, "{name},{pendulums},{joints},{threads},{scalar},{ours:.4},{theirs:.4}")
            .expect("a string");
        ours
    }
}

/// Advances driven pendulums alternately on one thread and on all threads, so that disturbances
/// affect both alike.
fn one_and_all(threads: usize) {
    println!(
        "driven pendulums, f64, ns a step: median and least, alternately on one thread and on {threads}"
    );
    for pendulums in [100, 1_000, 10_000, 100_000, 1_000_000] {
        let mut scenes = [false, true].map(|parallel| {
            let mut scene = scene::<f64>(pendulums, pendulums / 10, Kind::Driven);
            scene.set_parallel(parallel);
            scene.advance_ticks(100 * TICKS);
            scene
        });
        let frames = (200_000 / pendulums).clamp(2, 500);
        let mut times = [const { Vec::new() }; 2];
        for _ in 0..if pendulums < 1_000_000 { 101 } else { 25 } {
            for (scene, times) in scenes.iter_mut().zip(&mut times) {
                let start = Instant::now();
                for _ in 0..frames {
                    black_box(scene.advance_ticks(TICKS));
                }
                times.push(
                    1e9 * start.elapsed().as_secs_f64()
                        / (frames * pendulums * TICKS as usize) as f64,
                );
            }
        }
        let [one, all] =
            times.map(|times| (times.iter().copied().fold(f64::INFINITY, f64::min), median(times)));
        println!(
            "{pendulums:>8}  one {:7.3} {:7.3}  all {:7.3} {:7.3}  all over one {:.3} {:.3}",
            one.1,
            one.0,
            all.1,
            all.0,
            all.1 / one.1,
            all.0 / one.0
        );
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let quick = words.iter().any(|word| word == "--quick");
    if words.iter().any(|word| word == "--threads") {
        return one_and_all(std::thread::available_parallelism().map_or(1, usize::from));
    }
    let names: Vec<&String> = words.iter().filter(|word| !word.starts_with("--")).collect();
    let mut csv =
        String::from("case,pendulums,joints,threads,scalar,ns_per_pendulum_step,baseline_ns\n");
    let many = if cfg!(feature = "rayon") {
        std::thread::available_parallelism().map_or(1, usize::from)
    } else {
        1
    };
    let sizes = [(86, 9), (10_000, 1_000), (1_000_000, 100_000)];
    for (pendulums, joints) in if quick { &sizes[..2] } else { &sizes[..] }.iter().copied() {
        for (kind, name) in KINDS {
            // With separate keys for a hundred thousand joints, the benchmark would measure memory.
            let skipped = kind == Kind::Kinked && 1_000 < joints;
            if skipped || !(names.is_empty() || names.iter().any(|wanted| *wanted == name)) {
                continue;
            }
            for threads in if 1 < many && 86 < pendulums { vec![1, many] } else { vec![1] } {
                let runs = if quick { 15 } else { 51 };
                let case = |scalar, baseline| Case {
                    name,
                    pendulums,
                    joints,
                    scalar,
                    threads,
                    baseline,
                    runs,
                };
                case("f64", baseline_f64).measure(&mut csv, scene::<f64>(pendulums, joints, kind));
                case("f32", baseline_f32).measure(&mut csv, scene::<f32>(pendulums, joints, kind));
            }
        }
    }
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../target");
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(format!("{folder}/scene.csv"), csv))
        .expect("a folder to write to");
}
