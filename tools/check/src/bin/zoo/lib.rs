//! Tests of the error control of the adaptive integrators on difficult systems.

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

pub use case::Method;
use case::Scalar;
use families::Family;
use indicatif::{ProgressBar, ProgressStyle};
use measure::{Measured, Measurement, clock, measure};
use report::Row;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The command-line options.
#[derive(Clone, Debug)]
pub struct Options {
    /// The number of starts of each family.
    pub count: usize,
    /// The index of a single run, if any.
    pub run: Option<usize>,
    /// Parts of the names of families; empty for all families.
    pub families: Vec<String>,
    /// The names of scalars; empty for all scalars.
    pub scalars: Vec<String>,
    /// The names of methods; empty for all methods. `Dop853` is always measured.
    pub methods: Vec<String>,
    /// The number of threads.
    pub threads: usize,
    /// `true` if times are measured.
    pub clock: bool,
    /// `true` if every run is printed.
    pub verbose: bool,
    /// The file of the table, if any.
    pub markdown: Option<std::path::PathBuf>,
    /// The file with a line for each measurement, if any.
    pub csv: Option<std::path::PathBuf>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            count: 60,
            run: None,
            families: Vec::new(),
            scalars: Vec::new(),
            methods: Vec::new(),
            threads: 2,
            clock: true,
            verbose: false,
            markdown: None,
            csv: None,
        }
    }
}

impl Options {
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
///
/// # Errors
/// Returns an error for names that no family, scalar or method has, and for files that cannot be
/// written.
pub fn run(options: &Options) -> std::io::Result<bool> {
    options.check().map_err(std::io::Error::other)?;
    let rows = measured(options);
    if !cfg!(feature = "all") {
        println!(
            "The families of the short test; `--features all` has the others, and more methods."
        );
    }
    if options.verbose {
        for row in &rows {
            for run in &row.runs {
                println!(
                    "{} run {}: tolerance {:.3e}, amplification {:.2e}, doubt {:.1e}\n    {}",
                    row.family.name,
                    run.run,
                    run.tolerance,
                    run.amplification,
                    run.doubt,
                    run.start
                );
                for m in &run.measurements {
                    println!(
                        "    {:8} error {:.2e} merit {:?} {}",
                        m.method.name(),
                        m.error,
                        m.merit,
                        m.stats
                    );
                }
            }
        }
    }
    print!("{}\n{}\n{}", report::table(&rows), report::references(&rows), report::summary(&rows));
    if let Some(path) = &options.markdown {
        std::fs::write(path, report::markdown(&rows))?;
    }
    if let Some(path) = &options.csv {
        std::fs::write(path, report::lines(&rows))?;
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

/// The error of a method in a run, divided by tolerance and amplification, or the error that it
/// returned.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The family.
    pub family: &'static str,
    /// The run.
    pub run: usize,
    /// The method.
    pub method: Method,
    /// The tolerance.
    pub tolerance: f64,
    /// The figure of merit.
    pub merit: Result<f64, String>,
}

/// Returns the measurements without printing. Runs without a reference are left out.
pub fn findings(options: &Options) -> Vec<Finding> {
    let rows = measured(options);
    let finding = |family, run: &Measured, m: &Measurement| {
        let (run, tolerance) = (run.run, run.tolerance);
        Finding {
            family,
            run,
            method: m.method,
            tolerance,
            merit: m.merit.clone().map(|merit| merit.0),
        }
    };
    let of = |row: &Row<'static>| -> Vec<Finding> {
        row.runs
            .iter()
            .flat_map(|run| run.measurements.iter().map(move |m| finding(row.family.name, run, m)))
            .collect()
    };
    rows.iter().flat_map(of).collect()
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
        let above = merits.iter().filter(|merit| 100.0 < **merit).count();
        let worse = report::worse(rows, method, 0.3);
        let bars = [
            ("at most 1 % of runs end in an error", failed * 100 <= merits.len()),
            ("at most 1 % of runs have no reference", lost * 100 <= all),
            ("median at most 1", report::quantile(&merits, 0.5) <= 1.0),
            ("at most 1 % above 100", !merits.is_empty() && above * 100 <= merits.len()),
            ("none above 1000", wrong.is_empty()),
            (
                "90 % in no family above 3 × that of Dop853, which counts as 0.3 at least",
                worse.is_empty(),
            ),
        ];
        for (bar, fine) in bars {
            println!("{:8} {} {bar}", method.name(), if fine { "meets " } else { "MISSES" });
            met &= fine;
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
    let bar = ProgressBar::new(jobs.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {eta} {msg}") {
        bar.set_style(style);
    }
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..options.threads {
            scope.spawn(|| {
                while let Some(&(f, run)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let measured = measure(chosen[f], run, &|method| options.wants(method));
                    if let Ok(mut results) = results.lock() {
                        results.push((f, run, measured));
                    }
                    bar.set_message(chosen[f].name);
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut results: Vec<(usize, usize, Result<Measured, String>)> =
        results.into_inner().unwrap_or_default();
    results.sort_by_key(|(f, run, _)| (*f, *run));
    let mut rows: Vec<Row<'static>> =
        chosen.iter().map(|family| Row { family, runs: Vec::new(), lost: Vec::new() }).collect();
    for (f, run, result) in results {
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
