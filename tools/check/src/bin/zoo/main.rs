//! The table of error control of the adaptive integrators on systems that are not gentle:
//! `cargo run --release -p check --features all --bin zoo -- [--quick] [--family NAME] [--scalar
//! f32|f64|dd] [--method NAME] [--count N] [--run K] [--threads N] [--no-time] [--verbose]
//! [--markdown PATH]`.
//!
//! Without `--features all`, the build takes a fraction of the time and contains only the families
//! of the test. `--profile zoo` instead of `--release` builds faster after a change. `--family` and
//! `--method` may be given several times. The program fails if a bar is missed.

#![allow(mixed_script_confusables)]

#[macro_use]
mod trial;

mod blocks;
mod case;
mod families;
mod measure;
#[cfg(feature = "all")]
mod more_blocks;
#[cfg(feature = "all")]
mod more_families;
mod motions;
#[cfg(feature = "all")]
mod narrow;
mod random;
mod report;
#[cfg(test)]
mod tests;

use case::{Method, Scalar};
use check::crowd;
use check::report::Report;
use families::Family;
use lexopt::prelude::*;
use measure::{Measured, Measurement, clock, measure};
use report::Row;
use std::error::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    match Options::read().and_then(|options| run(&options)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

/// The command-line options.
#[derive(Clone, Debug, Default)]
struct Options {
    /// The number of starts of each family.
    count: usize,
    /// The index of a single run, if any.
    run: Option<usize>,
    /// Parts of the names of families; empty for all families.
    families: Vec<String>,
    /// The names of scalars; empty for all scalars.
    scalars: Vec<String>,
    /// The names of methods; empty for all methods. `Dop853` is always measured.
    methods: Vec<String>,
    /// The number of threads.
    threads: usize,
    /// `true` if times are measured.
    clock: bool,
    /// `true` if every run is printed.
    verbose: bool,
    /// The file of the table, if any.
    markdown: Option<std::path::PathBuf>,
}

impl Options {
    fn read() -> Result<Self, Box<dyn Error>> {
        let mut options = Self { count: 60, threads: 2, clock: true, ..Self::default() };
        let mut parser = lexopt::Parser::from_env();
        while let Some(argument) = parser.next()? {
            match argument {
                Long("quick") => options.count = 10,
                Long("count") => options.count = parser.value()?.parse()?,
                Long("run") => options.run = Some(parser.value()?.parse()?),
                Long("family") => options.families.push(parser.value()?.string()?),
                Long("scalar") => options.scalars.push(parser.value()?.string()?),
                Long("method") => options.methods.push(parser.value()?.string()?),
                Long("threads") => options.threads = parser.value()?.parse()?,
                Long("no-time") => options.clock = false,
                Long("verbose") => options.verbose = true,
                Long("markdown") => options.markdown = Some(parser.value()?.into()),
                _ => return Err(argument.unexpected().into()),
            }
        }
        Ok(options)
    }

    fn wants(&self, method: Method) -> bool {
        let wanted = |name: &String| name.eq_ignore_ascii_case(method.name());
        method == Method::Dop853 || self.methods.is_empty() || self.methods.iter().any(wanted)
    }

    /// Checks that every name exists.
    fn check(&self) -> Result<(), String> {
        for name in &self.families {
            if !families().any(|family| family.name.contains(name.as_str())) {
                return Err(format!(
                    "no family is called `{name}`; without `--features all` only some are there"
                ));
            }
        }
        for name in &self.scalars {
            if !families().any(|family| family.scalar.name() == name) {
                return Err(format!(
                    "no family has the scalar `{name}`; there are `f32`, `f64` and `dd`"
                ));
            }
        }
        for name in &self.methods {
            if !Method::ALL.iter().any(|method| method.name().eq_ignore_ascii_case(name)) {
                let names = Method::ALL.map(Method::name).join("`, `");
                return Err(format!("no method is called `{name}`; there are `{names}`"));
            }
        }
        Ok(())
    }

    fn chosen(&self) -> Vec<&'static Family> {
        let named = |family: &&Family| {
            let exact = |part: &String| families().any(|family| family.name == part);
            let name = |part: &String| {
                if exact(part) { family.name == part } else { family.name.contains(part.as_str()) }
            };
            let scalar = |name: &String| name == family.scalar.name();
            (self.families.is_empty() || self.families.iter().any(name))
                && (self.scalars.is_empty() || self.scalars.iter().any(scalar))
        };
        families().filter(named).collect()
    }
}

/// Runs the measurements and prints the results. Returns `true` if all bars are met.
fn run(options: &Options) -> Result<bool, Box<dyn Error>> {
    options.check()?;
    let rows = measured(options);
    if !cfg!(feature = "all") {
        println!(
            "The families of the short test; `--features all` has the others, and more methods."
        );
    }
    if options.verbose {
        for row in &rows {
            for run in &row.runs {
                let Measured { run, tolerance, amplification, doubt, start, measurements } = run;
                println!(
                    "{} run {run}: tolerance {tolerance:.3e}, amplification {amplification:.2e}, \
                     doubt {doubt:.1e}\n    {start}",
                    row.family.name
                );
                for Measurement { method, error, merit, stats, .. } in measurements {
                    let name = method.name();
                    println!("    {name:8} error {error:.2e} merit {merit:?} {stats}");
                }
            }
        }
    }
    print!("{}\n{}\n{}", report::table(&rows), report::references(&rows), report::summary(&rows));
    if let Some(path) = &options.markdown {
        std::fs::write(path, report::markdown(&rows))?;
    }
    for method in Method::ALL.into_iter().filter(|method| !BARRED.contains(method)) {
        tell(&report::wrong(&rows, method, 1000.0), 5);
    }
    Ok(bars(options, &rows))
}

/// The methods to which the bars apply.
const BARRED: [Method; 2] = [Method::Default, Method::Picard];

/// Prints at most `most` lines.
fn tell(lines: &[String], most: usize) {
    lines.iter().take(most).for_each(|line| println!("    {line}"));
    if most < lines.len() {
        println!("    and {} more", lines.len() - most);
    }
}

/// Checks the bars of `Picard` and of the default method.
fn bars(options: &Options, rows: &[Row<'_>]) -> bool {
    let mut met = true;
    for method in BARRED {
        if !options.wants(method) {
            continue;
        }
        if !rows.iter().any(|row| row.family.scalar != Scalar::Wide) && method == Method::Picard {
            // `Picard` has only the precision of `f64` and is not measured in double-double.
            continue;
        }
        let wrong = report::wrong(rows, method, 1000.0);
        let merits = report::merits(rows, method);
        let failed = report::failed(rows, method);
        let (lost, all) = report::lost(rows);
        let above = report::above(&merits, 100.0);
        let worse = report::worse(rows, method, 0.3);
        let runs = merits.len() as f64;
        let mut report = Report::new(method.name());
        report.row("errors in 100 runs").at_most(100.0 * failed as f64 / runs, 1.0);
        report
            .row("runs without a reference in 100")
            .at_most(100.0 * lost as f64 / all as f64, 1.0);
        report.row("median").at_most(report::quantile(&merits, 0.5), 1.0);
        report.row("runs above 100 in 100").at_most(100.0 * above as f64 / runs, 1.0);
        report.row("runs above 1000").at_most(wrong.len() as f64, 0.0);
        report
            .row("families whose 90 % are above 3 × those of Dop853, which count as 0.3 at least")
            .at_most(worse.len() as f64, 0.0);
        for check in &report.checks {
            println!("{}", check.line("error control"));
            met &= check.holds();
        }
        tell(&worse, worse.len());
        tell(&wrong, 40);
    }
    met
}

/// All families of this build.
fn families() -> impl Iterator<Item = &'static Family> {
    #[cfg(feature = "all")]
    let others = more_families::MORE.iter().chain(narrow::NARROW);
    #[cfg(not(feature = "all"))]
    let others: [&Family; 0] = [];
    families::SHORT.iter().chain(others)
}

/// Measures all runs of the chosen families.
fn measured(options: &Options) -> Vec<Row<'static>> {
    let chosen = options.chosen();
    let runs: Vec<usize> =
        options.run.map_or_else(|| (0..options.count).collect(), |run| vec![run]);
    let jobs: Vec<(usize, usize)> =
        (0..chosen.len()).flat_map(|f| runs.iter().map(move |run| (f, *run))).collect();
    let results = crowd::run(
        jobs.len(),
        options.threads,
        |index| chosen[jobs[index].0].name,
        |index| measure(chosen[jobs[index].0], jobs[index].1, &|method| options.wants(method)),
    );
    let mut rows: Vec<Row<'static>> =
        chosen.iter().map(|family| Row { family, runs: Vec::new(), lost: Vec::new() }).collect();
    for ((f, run), result) in jobs.into_iter().zip(results) {
        match result {
            Ok(mut measured) => {
                if options.clock {
                    clock(chosen[f], &mut measured);
                }
                rows[f].runs.push(measured);
            }
            Err(why) => rows[f].lost.push((run, why)),
        }
    }
    rows
}
