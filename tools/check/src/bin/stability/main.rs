//! The stress table: thirty ways in which simulations of mechanical systems fail, each
//! measured against a bar.
//!
//! `cargo run --release -p stability` prints a line for each measurement, writes
//! `target/stability.csv` and the pictures `target/stability-*.svg`, and fails if a bar is missed.
//! `--quick` takes less than a minute, `--long` an hour; `--only S7,S9` selects tests. With
//! `--known`, misses with a known reason, which are explained in
//! `pendulum-runtime/src/guide/accuracy.md`, do not count as failures.
//!
//! References are closed forms, published digits, results of arbitrary precision, or solutions of
//! the same equations in double-double. They are independent of the run under test.

#![allow(mixed_script_confusables)]

mod chains;
mod chaos;
mod contacts;
mod driven;
mod elliptic;
mod long;
mod many;
mod memory;
mod numbers;
mod output;
mod picture;
mod reference;
mod report;
mod scenes;
mod singular;
mod stiff;
mod systems;
mod tally;
mod walls;

use indicatif::{ProgressBar, ProgressStyle};
use report::{Report, Scale, Test};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

const THEMES: &[&[Test]] = &[
    long::TESTS,
    singular::TESTS,
    chaos::TESTS,
    driven::TESTS,
    stiff::TESTS,
    output::TESTS,
    chains::TESTS,
    contacts::TESTS,
    many::TESTS,
    walls::TESTS,
];

/// The number of tests that run concurrently.
const THREADS: usize = 2;

fn main() -> ExitCode {
    match table() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures the table. Returns `true` if every bar is met.
fn table() -> Result<bool, Box<dyn Error>> {
    let Choice { scale, tests, known } = chosen(std::env::args().skip(1))?;
    // The bar is hidden if stderr is not a terminal.
    let bar = ProgressBar::new(tests.len() as u64);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} {elapsed} {msg}")?);
    bar.enable_steady_tick(Duration::from_millis(500));
    let begun = Instant::now();
    let reports = run(scale, &tests, &bar);
    bar.finish_and_clear();

    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target");
    std::fs::create_dir_all(&target)?;
    let mut csv = "test,title,measurement,measured,least,bar,holds\n".to_owned();
    let (mut count, mut missed, mut failed) = (0, 0, 0);
    for (test, report) in tests.iter().zip(&reports) {
        for check in &report.checks {
            println!("{}", check.line(test.title));
            writeln!(csv, "{}", check.row(test.title))?;
            count += 1;
            missed += usize::from(!check.holds());
            failed += usize::from(!(check.holds() || known && check.is_explained()));
        }
    }
    std::fs::write(target.join("stability.csv"), csv)?;
    let curves: Vec<_> = reports.into_iter().flat_map(|report| report.curves).collect();
    let drawn = picture::draw(&target, &curves)?;
    println!(
        "{count} measurements, {missed} bars missed, {:.0} s; written to target/stability.csv{}{}",
        begun.elapsed().as_secs_f64(),
        if drawn.is_empty() { "" } else { " and target/" },
        drawn.join(", target/"),
    );
    Ok(failed == 0)
}

/// The options of the command line.
struct Choice {
    scale: Scale,
    tests: Vec<Test>,
    /// `true` if misses with a known reason do not count as failures.
    known: bool,
}

fn chosen(mut arguments: impl Iterator<Item = String>) -> Result<Choice, String> {
    let all: Vec<Test> = {
        let mut all: Vec<Test> = THEMES.iter().flat_map(|theme| theme.iter().copied()).collect();
        all.sort_by_key(|test| test.id[1..].parse::<u32>().unwrap_or(0));
        all
    };
    let (mut scale, mut only, mut known) = (Scale::Usual, None, false);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--quick" => scale = Scale::Quick,
            "--long" => scale = Scale::Long,
            "--known" => known = true,
            "--only" => {
                only = Some(
                    arguments.next().ok_or("`--only` needs names of tests after it, as S7,S9")?,
                );
            }
            other => {
                return Err(format!(
                    "`{other}` is unknown; give --quick, --long, --known or --only S7,S9"
                ));
            }
        }
    }
    let Some(only) = only else { return Ok(Choice { scale, tests: all, known }) };
    let names: Vec<&str> = only.split(',').map(str::trim).collect();
    if let Some(name) = names.iter().find(|name| !all.iter().any(|test| test.id == **name)) {
        return Err(format!("there is no test `{name}`; they are S1 to S30"));
    }
    let tests = all.into_iter().filter(|test| names.contains(&test.id)).collect();
    Ok(Choice { scale, tests, known })
}

/// Runs all tests, some of them concurrently. Returns their reports in order.
fn run(scale: Scale, tests: &[Test], bar: &ProgressBar) -> Vec<Report> {
    let reports: Vec<Mutex<Report>> =
        tests.iter().map(|test| Mutex::new(Report::new(test.id))).collect();
    let (next, running) = (AtomicUsize::new(0), Mutex::new(Vec::<&str>::new()));
    let say = |running: &[&str]| bar.set_message(running.join(", "));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(test) = tests.get(index) else { return };
            {
                let mut running = running.lock().unwrap();
                running.push(test.title);
                say(&running);
            }
            (test.run)(scale, &mut reports[index].lock().unwrap());
            let mut running = running.lock().unwrap();
            running.retain(|title| *title != test.title);
            say(&running);
            bar.inc(1);
        }
    };
    std::thread::scope(|scope| (0..THREADS).for_each(|_| drop(scope.spawn(work))));
    reports.into_iter().map(|report| report.into_inner().unwrap()).collect()
}
