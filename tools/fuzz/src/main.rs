//! Random input for all readers: the whole expansion of `lagrangian!` on tokens, broken blocks and
//! random systems, and the reader of motion capture.
//!
//! `cargo run --release -p fuzz -- --seconds 1200 --seed 1` runs cases of all targets in turn until
//! the time is over and prints a line for each target. It fails if a case panicked, took longer
//! than ten seconds or needed more than a gigabyte. `--only TARGET --seed N --count 1` repeats a
//! single case, `--only equations --count 100000` runs this number of cases of a target.

mod files;
mod memory;
mod target;
mod watch;

use indicatif::{ProgressBar, ProgressStyle};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use target::{TARGETS, Target, Verdict};

/// The longest time of a case.
const LONGEST: Duration = Duration::from_secs(10);

/// The largest memory during a case, including the program, in bytes.
const LARGEST: u64 = 1 << 30;

/// The time of each target per turn.
const SLICE: Duration = Duration::from_millis(100);

/// The options of a run.
struct Plan {
    seconds: f64,
    seed: u64,
    count: Option<u64>,
    only: Option<String>,
}

/// The results of a target.
#[derive(Default)]
struct Tally {
    cases: u64,
    refused: u64,
    /// The longest time, with its seed.
    slowest: (Duration, u64),
    failures: Vec<(u64, String)>,
    peak: u64,
    spent: Duration,
}

fn main() -> ExitCode {
    let plan = match plan() {
        Ok(plan) => plan,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    };
    let targets: Vec<&Target> = TARGETS
        .iter()
        .filter(|target| plan.only.as_ref().is_none_or(|name| name == target.name))
        .collect();
    if targets.is_empty() {
        let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
        eprintln!("no such target; choose one of {}", names.join(", "));
        return ExitCode::FAILURE;
    }
    // The report contains the text of a panic with its seed.
    std::panic::set_hook(Box::new(|_| {}));
    let watch = watch::Watch::start(LONGEST * 6);
    let tallies = run(&plan, &targets, &watch);
    report(&targets, &tallies)
}

fn run(plan: &Plan, targets: &[&Target], watch: &watch::Watch) -> Vec<Tally> {
    let bar = ProgressBar::new(1000);
    if let Ok(style) =
        ProgressStyle::with_template("{bar:40} {percent:>3} % {elapsed_precise} {msg}")
    {
        bar.set_style(style);
    }
    let mut tallies: Vec<Tally> = targets.iter().map(|_| Tally::default()).collect();
    let start = Instant::now();
    loop {
        let passed = match plan.count {
            Some(count) => {
                tallies.iter().map(|tally| tally.cases).sum::<u64>() as f64
                    / (count * tallies.len() as u64) as f64
            }
            None => start.elapsed().as_secs_f64() / plan.seconds,
        };
        bar.set_position((1000.0 * passed) as u64);
        if 1.0 <= passed {
            break;
        }
        for (target, tally) in targets.iter().zip(&mut tallies) {
            bar.set_message(format!("{} {}", target.name, tally.cases));
            memory::forget_peak();
            let clock = Instant::now();
            while clock.elapsed() < SLICE && plan.count.is_none_or(|count| tally.cases < count) {
                case(target, plan.seed.wrapping_add(tally.cases), tally, watch);
            }
            tally.spent += clock.elapsed();
            tally.peak = tally.peak.max(memory::peak().unwrap_or(0));
        }
    }
    bar.finish_and_clear();
    tallies
}

/// Runs a case of a target.
fn case(target: &Target, seed: u64, tally: &mut Tally, watch: &watch::Watch) {
    let timed = || {
        watch.begin(target.name, seed);
        let clock = Instant::now();
        let verdict = catch_unwind(AssertUnwindSafe(|| (target.case)(seed)));
        watch.end();
        (verdict, clock.elapsed())
    };
    let (verdict, mut time) = timed();
    if LONGEST < time {
        // Other processes may have used the machine. The case is repeated, and the shorter time
        // counts.
        time = time.min(timed().1);
    }
    tally.cases += 1;
    if tally.slowest.0 < time {
        tally.slowest = (time, seed);
    }
    match verdict {
        Ok(Verdict::Taken) => {}
        Ok(Verdict::Refused) => tally.refused += 1,
        Ok(Verdict::Wrong(what)) => tally.failures.push((seed, what)),
        Err(panic) => {
            let text = panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| panic.downcast_ref::<&str>().copied());
            tally.failures.push((seed, format!("panicked: {}", text.unwrap_or("without a word"))));
        }
    }
    if LONGEST < time {
        tally.failures.push((seed, format!("took {:.1} s", time.as_secs_f64())));
    }
}

fn report(targets: &[&Target], tallies: &[Tally]) -> ExitCode {
    println!(
        "{:<16} {:>10} {:>10} {:>9} {:>12} {:>20} {:>10}",
        "target", "cases", "refused", "seconds", "slowest ms", "its seed", "peak MB"
    );
    let mut failed = false;
    for (target, tally) in targets.iter().zip(tallies) {
        let (time, seed) = tally.slowest;
        println!(
            "{:<16} {:>10} {:>10} {:>9.0} {:>12.1} {seed:>20} {:>10}",
            target.name,
            tally.cases,
            tally.refused,
            tally.spent.as_secs_f64(),
            1e3 * time.as_secs_f64(),
            tally.peak >> 20
        );
        for (seed, what) in &tally.failures {
            failed = true;
            println!("  --only {} --seed {seed} --count 1: {what}", target.name);
        }
        if LARGEST < tally.peak {
            failed = true;
            println!("  {}: a case needed more than {} MB", target.name, LARGEST >> 20);
        }
    }
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn plan() -> Result<Plan, String> {
    let mut plan = Plan { seconds: 10.0, seed: 0, count: None, only: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next().ok_or_else(|| format!("`{word}` needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("`{value}` is no whole number"));
        match word.as_str() {
            "--seconds" => {
                plan.seconds = value.parse().map_err(|_| format!("`{value}` is no number"))?;
            }
            "--seed" => plan.seed = number()?,
            "--count" => plan.count = Some(number()?),
            "--only" => plan.only = Some(value),
            _ => {
                return Err(format!(
                    "`{word}` is unknown; known are --seconds, --seed, --count and --only"
                ));
            }
        }
    }
    Ok(plan)
}
