//! The stress table: thirty ways in which simulations of mechanical systems fail, each
//! measured against a bar.
//!
//! `cargo run --release -p check --bin stability` prints a line for each measurement, writes
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
mod scenes;
mod singular;
mod stiff;
mod systems;
mod tally;
mod walls;

use check::crowd;
use check::report::{Report, Scale, Test};
use lexopt::prelude::*;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

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
    let Choice { scale, tests, known } = chosen()?;
    let begun = Instant::now();
    let reports = crowd::run(
        tests.len(),
        THREADS,
        |index| tests[index].title,
        |index| {
            let mut report = Report::new(tests[index].id);
            (tests[index].run)(scale, &mut report);
            report
        },
    );

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

fn chosen() -> Result<Choice, Box<dyn Error>> {
    let mut tests: Vec<Test> = THEMES.concat();
    tests.sort_by_key(|test| test.id[1..].parse::<u32>().unwrap_or(0));
    let (mut scale, mut only, mut known) = (Scale::Usual, String::new(), false);
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("quick") => scale = Scale::Quick,
            Long("long") => scale = Scale::Long,
            Long("known") => known = true,
            Long("only") => only = parser.value()?.string()?,
            _ => return Err(argument.unexpected().into()),
        }
    }
    let names: Vec<&str> = only.split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
    if let Some(name) = names.iter().find(|name| !tests.iter().any(|test| test.id == **name)) {
        return Err(format!("there is no test `{name}`; they are S1 to S30").into());
    }
    tests.retain(|test| names.is_empty() || names.contains(&test.id));
    Ok(Choice { scale, tests, known })
}
