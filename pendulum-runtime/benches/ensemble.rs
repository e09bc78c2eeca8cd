//! Ensembles: flip times of 100 × 100 double pendulums, end states at order 20, threads, and
//! memory.
//!
//! `cargo bench -p pendulum-runtime --features rayon --bench ensemble [-- --heyoka PYTHON]`; the
//! arguments `flip`, `ends`, `threads`, `rates`, `driven` and `memory` select single benchmarks.
//! With `--heyoka`, `benches/peers/heyoka_ensemble.py` runs alternately in every round, and ratios
//! are medians of the ratios in each round.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::integrate::{Event, Problem};
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use std::f64::consts::PI;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;
use systems::pendulums::Simple;
use systems::problems::{Double, Five};

lagrangian! {
    /// A pendulum on a joint that moves.
    #[derive(Clone, Debug)]
    pub struct OnJoint { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: m;
    let y = [x + L*sin(θ), -L*cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
}

const ROUNDS: usize = 7;
const SIDE: usize = 100;
const SECONDS: f64 = 100.0;
const TOLERANCE: f64 = 1e-9;

/// Returns problem k: a double pendulum of equal links at rest, with initial angles from −3 to 3
/// rad.
fn flip_start(side: usize, k: usize) -> Problem<Double, 2> {
    let angle = |i: usize| -3.0 + 6.0 * (i as f64 + 0.5) / side as f64;
    Problem {
        system: Double::new([1.0; 2], [1.0; 2], 9.81),
        time: (0.0, SECONDS),
        q: [angle(k % side), angle(k / side)],
        v: [0.0; 2],
    }
}

/// Returns the times at which the lower links turn over, or the end time.
fn flips(side: usize) -> Vec<f64> {
    let over = Event::new(|_, q: &[f64; 2], _| q[1] * q[1] - PI * PI).terminal();
    let all = Ensemble::new(0..side * side, |k| flip_start(side, k)).rtol(TOLERANCE);
    let all = all.events([over]).map(|_, solution| solution.end.t).collect();
    all.map_or_else(
        |_| Vec::new(),
        |all| all.value.into_iter().map(|t| t.unwrap_or(f64::NAN)).collect(),
    )
}

/// Returns the flip time of pendulum k, computed with scalars of two words.
fn flip_in_two_words(side: usize, k: usize) -> f64 {
    let Problem { system, time, q, v } = flip_start(side, k);
    let two = DoubleDouble::from_f64;
    let pi = two(PI) * two(PI);
    let over = Event::of(move |_, q: &[DoubleDouble; 2], _: &[DoubleDouble; 2]| q[1] * q[1] - pi)
        .terminal();
    let system = system.map(two);
    let run = solve(&system, time, q.map(two), v.map(two)).method(Taylor::new());
    run.rtol(1e-27).events([over]).run().map_or(f64::NAN, |solution| solution.end.t)
}

/// Returns the end states of 512 motions at order 20 and the machine epsilon as tolerance.
fn ends(name: &str) -> Vec<f64> {
    let amplitude = |k: usize| 0.1 + 2.9 * k as f64 / 512.0;
    if name == "pendulum" {
        let problems: Vec<_> = (0..512)
            .map(|k| Problem {
                system: Simple { m: 1.0, L: 1.0, g: 9.8 },
                time: (0.0, 100.0),
                q: [amplitude(k)],
                v: [0.0],
            })
            .collect();
        let outcomes = Batch::new().order(20).rtol(f64::EPSILON).run(&problems).unwrap_or_default();
        return outcomes.iter().flatten().map(|solution| solution.end.q[0]).collect();
    }
    let problems: Vec<_> = (0..512)
        .map(|k| Problem {
            system: Double::new([1.0; 2], [1.0; 2], 1.0),
            time: (0.0, 20.0),
            q: [0.5 * amplitude(k), -0.25 * amplitude(k)],
            v: [0.0; 2],
        })
        .collect();
    let outcomes = Batch::new().order(20).rtol(f64::EPSILON).run(&problems).unwrap_or_default();
    let angle = |i: usize| outcomes.iter().flatten().map(move |solution| solution.end.q[i]);
    angle(0).chain(angle(1)).collect()
}

/// A process that runs heyoka.
struct Heyoka {
    _child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Heyoka {
    fn start(python: &str) -> std::io::Result<Self> {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/peers/heyoka_ensemble.py");
        let mut child = Command::new(python)
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let broken = || std::io::Error::other("no pipe");
        let input = child.stdin.take().ok_or_else(broken)?;
        let mut output = BufReader::new(child.stdout.take().ok_or_else(broken)?);
        let mut version = String::new();
        output.read_line(&mut version)?;
        print!("{version}");
        Ok(Self { _child: child, input, output })
    }

    /// Runs a task, and returns its seconds and results.
    fn run(&mut self, task: &str) -> std::io::Result<(f64, Vec<f64>)> {
        writeln!(self.input, "{task}")?;
        let (mut seconds, mut numbers) = (String::new(), String::new());
        self.output.read_line(&mut seconds)?;
        self.output.read_line(&mut numbers)?;
        let number = |word: &str| word.parse().unwrap_or(f64::NAN);
        let seconds = seconds.split(' ').next().map_or(f64::NAN, number);
        Ok((seconds, numbers.split_whitespace().map(number).collect()))
    }
}

fn timed<R>(run: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = run();
    (start.elapsed().as_secs_f64(), result)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Runs `work` on `threads` threads.
fn on<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "rayon")]
    if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        return pool.install(work);
    }
    let _ = threads;
    work()
}

/// Runs `own` and the tasks of heyoka alternately, and prints times and ratios.
fn beside(
    name: &str,
    tasks: &[(&str, String)],
    heyoka: &mut Option<Heyoka>,
    own: impl Fn() -> Vec<f64>,
) -> std::io::Result<[Vec<f64>; 2]> {
    let (mut times, mut found) = (Vec::new(), [own(), Vec::new()]);
    let mut peers = vec![(Vec::new(), Vec::new()); tasks.len()];
    for task in tasks {
        if let Some(heyoka) = heyoka {
            heyoka.run(&task.1)?;
        }
    }
    for _ in 0..ROUNDS {
        let (seconds, numbers) = timed(&own);
        times.push(seconds);
        found[0] = numbers;
        let Some(heyoka) = heyoka else { continue };
        for (task, (peer, ratio)) in tasks.iter().zip(&mut peers) {
            let (theirs, numbers) = heyoka.run(&task.1)?;
            found[1] = numbers;
            peer.push(theirs);
            ratio.push(seconds / theirs);
        }
    }
    println!("{name:<28} {:8.1} ms", 1e3 * median(times));
    for ((way, _), (peer, ratio)) in tasks.iter().zip(peers) {
        if !peer.is_empty() {
            println!(
                "    heyoka, {way:<18} {:8.1} ms   ratio {:.2}",
                1e3 * median(peer),
                median(ratio)
            );
        }
    }
    Ok(found)
}

fn flip(heyoka: &mut Option<Heyoka>) -> std::io::Result<()> {
    for threads in [1, 2] {
        let task = |way: &str| format!("flip {SIDE} {SECONDS} {TOLERANCE:e} {threads} {way}");
        let tasks = [("ensemble", task("ensemble")), ("one copy a thread", task("loop"))];
        let name = format!("flip {SIDE} × {SIDE}, {threads} threads");
        let found = beside(&name, &tasks, heyoka, || on(threads, || flips(SIDE)))?;
        if threads == 1 {
            continue;
        }
        // A sample of a hundred pendulums. Early flips are not dominated by chaos.
        let exact: Vec<_> =
            (0..100).map(|k| 7 + 97 * k).map(|k| (k, flip_in_two_words(SIDE, k))).collect();
        for (name, found) in ["own", "heyoka"].into_iter().zip(found) {
            if found.is_empty() {
                continue;
            }
            let error = |&(k, exact): &(usize, f64)| (found[k] - exact).abs();
            for limit in [5.0, 20.0, 99.9] {
                let early: Vec<_> = exact.iter().filter(|(_, t)| *t < limit).map(error).collect();
                let (count, worst) = (early.len(), early.iter().copied().fold(0.0, f64::max));
                println!(
                    "    error of {name}: {count} of 100 turn over before {limit} s, median {:.1e} s, worst {worst:.1e} s",
                    median(early)
                );
            }
        }
    }
    Ok(())
}

fn end_states(heyoka: &mut Option<Heyoka>) -> std::io::Result<()> {
    for name in ["pendulum", "double"] {
        let task = |way: &str| format!("ends {name} 1 {way}");
        let tasks = [("ensemble", task("ensemble")), ("one copy a thread", task("loop"))];
        beside(&format!("ends {name}, 1 thread"), &tasks, heyoka, || ends(name))?;
    }
    Ok(())
}

/// Compares one thread and two threads for ensembles of several sizes.
fn threads() {
    for n in [1, 8, 9, 16, 64, 1024, 10_000] {
        let run = || {
            let all = Ensemble::new(0..n, |k| flip_start(100, 17 * k % 10_000)).rtol(TOLERANCE);
            all.map(|_, solution| solution.end.q[0]).reduce(|| 0.0, |a, b| a + b).ok();
        };
        let repeat = (2000 / n).clamp(1, 20);
        let (mut ones, mut ratios) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let [one, two] = [1, 2].map(|threads| {
                on(threads, || {
                    timed(|| (0..repeat).for_each(|_| run())).0 / f64::from(repeat as u32)
                })
            });
            ones.push(one);
            ratios.push(one / two);
        }
        println!(
            "{n:>6} members: one thread {:8.2} ms, two are {:.2} × as fast",
            1e3 * median(ones),
            median(ratios)
        );
    }
}

/// Measures the members per second on one thread, for end states after ten seconds.
fn rates() {
    fn rate(name: &str, run: impl Fn() -> usize) {
        let rates = (0..ROUNDS).map(|_| timed(&run)).map(|(seconds, n)| n as f64 / seconds);
        println!("{name:<40} {:9.0} members a second", median(rates.collect()));
    }
    macro_rules! measure {
        ($name:literal, $n:literal, $problem:expr) => {
            for rtol in [1e-6, 1e-9, 1e-12] {
                rate(&format!("{}, rtol {rtol:e}, lanes", $name), || {
                    let all = Ensemble::new(0..$n, $problem).rtol(rtol);
                    let all = all.map(|_, solution| solution.end.q[0]);
                    all.reduce(|| 0.0, f64::max).map_or(0, |all| all.tally.members as usize)
                });
                rate(&format!("{}, rtol {rtol:e}, Picard alone", $name), || {
                    let all = Ensemble::new(0..$n, $problem).rtol(rtol).method(Picard);
                    let all = all.map(|_, solution| solution.end.q[0]);
                    all.reduce(|| 0.0, f64::max).map_or(0, |all| all.tally.members as usize)
                });
            }
        };
    }
    let time = (0.0, 10.0);
    measure!("simple pendulum", 2000, |k: usize| Problem {
        system: Simple { m: 1.0, L: 1.0, g: 9.81 },
        time,
        q: [1e-3 * k as f64],
        v: [0.0],
    });
    measure!("double pendulum", 1000, |k: usize| Problem {
        system: Double::new([1.0; 2], [1.0; 2], 9.81),
        time,
        q: [2e-3 * k as f64, 1e-3 * k as f64],
        v: [0.0; 2],
    });
    measure!("five links", 200, |k: usize| Problem {
        system: Five::new([1.0; 5], [0.2; 5], 9.81),
        time,
        q: [1e-2 * k as f64; 5],
        v: [0.0; 5],
    });
}

/// Measures the members per second of a pendulum on a moving joint on one thread, in lanes and one
/// by one.
fn driven() {
    fn rate(name: &str, run: impl Fn() -> u64) -> f64 {
        let rates = (0..ROUNDS).map(|_| timed(&run)).map(|(seconds, n)| n as f64 / seconds);
        let rate = median(rates.collect());
        println!("{name:<56} {rate:9.0} members a second");
        rate
    }
    macro_rules! all {
        ($name:literal, $way:literal, $problem:ident, $rtol:ident $(, $method:expr)?) => {
            rate(&format!("{}, rtol {:e}, {}", $name, $rtol, $way), || {
                let all = Ensemble::new(0..2000, $problem).rtol($rtol)$(.method($method))?;
                let all = all.map(|_, solution| solution.end.q[0]);
                all.reduce(|| 0.0, f64::max).map_or(0, |all| all.tally.members)
            })
        };
    }
    macro_rules! measure {
        ($name:literal, $joint:expr) => {
            let joint = $joint;
            let problem = |k: usize| Problem {
                system: OnJoint { L: 1.0 + 1e-4 * k as f64, g: 9.81 }.driven_by(joint.clone()),
                time: (0.0, 10.0),
                q: [1e-3 * k as f64],
                v: [0.0],
            };
            for rtol in [1e-6, 1e-9, 1e-12] {
                let lanes = all!($name, "lanes", problem, rtol);
                let picard = all!($name, "Picard alone", problem, rtol, Picard);
                let taylor = all!($name, "Taylor alone", problem, rtol, Taylor::new());
                println!("    lanes are {:.2} and {:.2} × as fast", lanes / picard, lanes / taylor);
            }
        };
    }
    measure!("shaken", Sinusoid::new([0.1], 6.0, [0.3]));
    let times: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
    let places: Vec<[f64; 1]> = (0..=20).map(|k| [0.1 * (1.7 * f64::from(k)).sin()]).collect();
    let Ok(spline) = Curve::spline(&times, &places) else { return };
    measure!("keyed, smooth", spline);
    let Ok(lines) = Curve::linear(&times, &places) else { return };
    measure!("keyed, with kinks", lines);
}

/// Returns the peak memory of this process in kibibytes.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM:"));
    line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok()).unwrap_or(0)
}

/// Reduces `n` members to a histogram and prints the peak memory; runs in a separate process.
fn histogram(n: usize) {
    let all = Ensemble::new(0..n, |k| Problem {
        system: Simple { m: 1.0, L: 1.0, g: 9.81 },
        time: (0.0, 0.5),
        q: [3.0 * (k as f64 / n as f64)],
        v: [0.0],
    });
    let bin = |q: f64| ((q + 4.0) / 8.0 * 100.0) as usize;
    let gathered = all.map(move |_, solution| bin(solution.end.q[0])).fold(
        || vec![0_u64; 100],
        |mut bins, bin| {
            bins[bin] += 1;
            bins
        },
        |mut bins, more| {
            bins.iter_mut().zip(more).for_each(|(bin, more)| *bin += more);
            bins
        },
    );
    let total = gathered.map_or(0, |gathered| gathered.value.iter().sum());
    println!("{total} members reduced to a histogram: {} KiB at most", peak());
}

fn main() -> std::io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let after = |name: &str| {
        words.iter().position(|word| word == name).and_then(|place| words.get(place + 1))
    };
    if let Some(n) = after("--histogram").and_then(|n| n.parse().ok()) {
        histogram(n);
        return Ok(());
    }
    let mut heyoka = after("--heyoka").map(|python| Heyoka::start(python)).transpose()?;
    let names = ["flip", "ends", "threads", "rates", "driven", "memory"];
    let any = words.iter().any(|word| names.contains(&word.as_str()));
    let wanted = |name: &str| !any || words.iter().any(|word| word == name);
    if wanted("flip") {
        flip(&mut heyoka)?;
    }
    if wanted("ends") {
        end_states(&mut heyoka)?;
    }
    if wanted("threads") {
        threads();
    }
    if wanted("rates") {
        rates();
    }
    if wanted("driven") {
        driven();
    }
    if wanted("memory") {
        for n in ["1000000", "10000000"] {
            Command::new(std::env::current_exe()?).args(["--histogram", n]).status()?;
        }
    }
    Ok(())
}
