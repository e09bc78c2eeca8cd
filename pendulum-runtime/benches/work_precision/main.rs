//! Run time as a function of the error, for every method over its settings and for the peers.
//!
//! `cargo bench -p pendulum-runtime --bench work_precision -- [SYSTEM…] [--quick] [--rounds N]
//! [--heyoka PYTHON] [--no-peers]`. `-- --draw TABLE NOTE` draws the pictures of an existing table
//! without measurements.
//!
//! The systems are defined in `tools/systems/src/work_precision`. The error is the largest
//! difference of any coordinate or velocity at any of the five output times from `reference.txt`. A
//! round runs all rows, every second round in reverse order. The time of a row is the median over
//! the rounds, and the ratio of two methods is the median of the ratios in each round. All
//! measurements run on one thread, one process at a time.
//!
//! The crates `ode_solvers` and `differential-equations` are measured by `benches/peers/rust`, a
//! package outside the workspace. The benchmark builds and starts this package, which waits while
//! other rows run; if the build fails, for example without network, the benchmark prints the error
//! and continues. `--heyoka` starts `benches/peers/heyoka.py` with the given Python in the same
//! way. Otherwise the pictures and the summary contain the previous table of this script in the
//! target folder, if there is one.
//!
//! The results are written to the target folder: `work-precision.csv` and
//! `work-precision-SYSTEM.svg`.

#![allow(mixed_script_confusables, missing_docs, unreachable_pub)]

mod checks;
#[macro_use]
mod methods;
mod peer;
mod plot;
mod reference;
mod summary;
mod table;

use methods::Subject;
use peer::Peer;
use pendulum_runtime::prelude::*;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use systems::work_precision as shared;
use systems::work_precision::measure::{Row, Run};
use systems::work_precision::problem::Problem;
use table::{Entry, Party};

const SYSTEMS: [&str; 10] = [
    "simple",
    "moving",
    "moving_compound",
    "elastic",
    "double_regular",
    "double_chaotic",
    "chain5",
    "kepler",
    "henon_heiles",
    "pythagorean",
];

/// Returns the rows of this crate. The numbers are approximate fastest angular frequencies, which
/// determine fixed steps.
fn ours(every: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    macro_rules! system {
        ($name:literal, $rate:literal, $dynamics:expr, [$($family:ident),+]) => {
            let mut subject = Subject::new(&mut rows, $name, $rate, every, $dynamics);
            $($family!(subject);)+
        };
    }
    system!("simple", 3.13, shared::simple(), [any, velocity_free]);
    system!("moving", 2.0, shared::moving(), [any, velocity_free]);
    system!("moving_compound", 3.05, shared::moving_compound(), [any, velocity_free]);
    system!("elastic", 2.83, shared::elastic(), [any]);
    system!("double_regular", 1.85, shared::double(), [any]);
    system!("double_chaotic", 4.0, shared::double(), [any]);
    system!("chain5", 3.55, shared::chain5(), [any]);
    system!("kepler", 3.46, shared::kepler(), [any, velocity_free]);
    system!("henon_heiles", 1.0, shared::henon_heiles(), [any, velocity_free]);
    // Equal steps would have to be those of the closest encounter.
    system!("pythagorean", 1.0, shared::pythagorean(), [encounters]);
    rows
}

/// The options on the command line.
struct Options {
    quick: bool,
    rounds: usize,
    systems: Vec<String>,
    heyoka: Option<String>,
    peers: bool,
    /// A table of previous measurements, and the note below its pictures.
    draw: Option<(PathBuf, String)>,
}

impl Options {
    fn parse() -> Result<Self, String> {
        let (systems, heyoka, draw) = (Vec::new(), None, None);
        let mut options = Self { quick: false, rounds: 0, systems, heyoka, peers: true, draw };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("`{word}` wants a value"));
            match word.as_str() {
                // Cargo adds this argument.
                "--bench" => {}
                "--quick" => options.quick = true,
                "--no-peers" => options.peers = false,
                "--draw" => options.draw = Some((value()?.into(), value()?)),
                "--heyoka" => options.heyoka = Some(value()?),
                "--rounds" => {
                    options.rounds =
                        value()?.parse().map_err(|error| format!("`--rounds`: {error}"))?;
                }
                _ if SYSTEMS.contains(&word.as_str()) => options.systems.push(word),
                _ => {
                    return Err(format!(
                        "`{word}` is neither an option nor one of {}",
                        SYSTEMS.join(", ")
                    ));
                }
            }
        }
        if options.rounds == 0 {
            options.rounds = if options.quick { 5 } else { 31 };
        }
        Ok(options)
    }
}

/// The source of an entry.
#[derive(Clone, Copy)]
enum Source {
    Row(usize),
    Peer(usize, usize),
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let began = Instant::now();
    let options = Options::parse()?;
    let target =
        Path::new(env!("CARGO_TARGET_TMPDIR")).parent().ok_or("no target folder")?.to_path_buf();
    if let Some((table, note)) = &options.draw {
        return draw(&target, note, &table::read(table)?);
    }
    let note = describe();
    println!("{note}");

    // One setting in `every` is run.
    let every = if options.quick { 2 } else { 1 };
    let mut rows = ours(every);
    let mut peers = start_peers(&options, &target);
    let mut sources: Vec<(Source, Entry)> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        sources.push((
            Source::Row(index),
            Entry::new([&row.system, &row.method, &row.setting].map(Clone::clone)),
        ));
    }
    for (number, peer) in peers.iter().enumerate() {
        for (index, row) in peer.rows.iter().enumerate() {
            let setting = peer.rows[..index].iter().filter(|other| other[..2] == row[..2]).count();
            if setting % every == 0 {
                sources.push((Source::Peer(number, index), Entry::new(row.clone())));
            }
        }
    }
    if !options.systems.is_empty() {
        sources.retain(|(_, entry)| options.systems.contains(&entry.system));
    }
    let place = |entry: &Entry| SYSTEMS.iter().position(|system| *system == entry.system);
    sources.sort_by_key(|(_, entry)| place(entry));

    // The time limit of the rounds for slow machines. It does not include the first round, in which
    // heyoka compiles.
    let limit = Duration::from_secs(if options.quick { 75 } else { 600 });
    let mut since = began;
    for round in 0..options.rounds {
        let start = Instant::now();
        let order: Vec<usize> = if round % 2 == 0 {
            (0..sources.len()).collect()
        } else {
            (0..sources.len()).rev().collect()
        };
        for index in order {
            let (source, entry) = &mut sources[index];
            if round == 0 || entry.result.is_ok() {
                let sample = match *source {
                    Source::Row(row) => rows[row].sample(),
                    Source::Peer(peer, row) => peers[peer].sample(row),
                };
                take(entry, sample);
            }
        }
        if round == 0 && !options.quick {
            since = Instant::now();
        }
        let left = limit.saturating_sub(since.elapsed());
        println!(
            "round {} of {}: {} rows in {:.1} s",
            round + 1,
            options.rounds,
            sources.len(),
            start.elapsed().as_secs_f64()
        );
        if left < start.elapsed() && 1 <= round && round + 1 < options.rounds {
            println!("no time for more rounds");
            break;
        }
    }
    peers.into_iter().for_each(Peer::end);

    let mut entries: Vec<Entry> = sources.into_iter().map(|(_, entry)| entry).collect();
    let csv = target.join("work-precision.csv");
    table::write(&csv, &entries)?;
    println!("written: {}", csv.display());
    for entry in entries.iter().filter(|entry| entry.result.is_err()) {
        let Entry { system, method, setting, result, .. } = entry;
        println!(
            "failed: {system}, {method}, {setting}: {}",
            result.as_ref().err().map_or("", String::as_str)
        );
    }

    if !entries.iter().any(|entry| entry.party() == Party::Heyoka) {
        let path = target.join("work-precision-heyoka.csv");
        match table::read(&path) {
            Ok(table) => {
                println!("heyoka as measured before: {}", path.display());
                let run = |entry: &Entry| entries.iter().any(|ours| ours.system == entry.system);
                let table: Vec<Entry> = table.into_iter().filter(run).collect();
                entries.extend(table);
            }
            Err(error) => println!("no times of heyoka ({}: {error})", path.display()),
        }
    }
    draw(&target, &note, &entries)?;
    println!();
    checks::forward_and_back();
    if !options.quick {
        checks::energy();
    }
    println!("\n{:.0} s", began.elapsed().as_secs_f64());
    Ok(())
}

/// Draws each system of a table and prints the summary.
fn draw(target: &Path, note: &str, entries: &[Entry]) -> Result<(), Box<dyn std::error::Error>> {
    let measured = |system: &&&str| entries.iter().any(|entry| entry.system == **system);
    let systems: Vec<&str> = SYSTEMS.iter().filter(measured).copied().collect();
    for system in &systems {
        let path = target.join(format!("work-precision-{system}.svg"));
        plot::draw(&path, system, note, entries)?;
    }
    summary::print(&systems, entries);
    Ok(())
}

/// Adds a sample to its entry.
fn take(entry: &mut Entry, sample: Result<(f64, Run), String>) {
    let checked = sample.and_then(|(seconds, run)| {
        let reference = reference::reference(&entry.system);
        if run.values.len() != reference.len() {
            return Err(format!("{} values instead of {}", run.values.len(), reference.len()));
        }
        let error = table::largest_error(&run.values, &reference);
        if !error.is_finite() {
            return Err("a value is not finite".to_string());
        }
        entry.samples.push(seconds);
        Ok((error, run.evaluations))
    });
    entry.result = checked;
}

/// Builds and starts the available peers.
fn start_peers(options: &Options, target: &Path) -> Vec<Peer> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut peers = Vec::new();
    let mut add = |what: &str, started: Result<Peer, String>| match started {
        Ok(peer) => {
            println!("{}", peer.versions);
            peers.push(peer);
        }
        Err(error) => println!("without {what}: {error}"),
    };
    if options.peers {
        let program =
            build_peers(&root.join("benches/peers/rust/Cargo.toml"), &target.join("peers"));
        add(
            "ode_solvers and differential-equations",
            program.and_then(|program| Peer::start(&mut Command::new(program))),
        );
    }
    if let Some(python) = &options.heyoka {
        let script = root.join("benches/peers/heyoka.py");
        add("heyoka", Peer::start(Command::new(python).arg(script).arg("--serve")));
    }
    peers
}

/// Builds the peers with the same profile and flags, and returns the path of the program.
fn build_peers(manifest: &Path, target: &Path) -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "--release", "--quiet", "--manifest-path"];
    let status =
        Command::new(cargo).args(arguments).arg(manifest).arg("--target-dir").arg(target).status();
    match status {
        Ok(status) if status.success() => {
            Ok(target.join("release").join(format!("peers{}", std::env::consts::EXE_SUFFIX)))
        }
        Ok(status) => Err(format!("{} was not built: {status}", manifest.display())),
        Err(error) => Err(error.to_string()),
    }
}

/// Returns a description of the versions and the processor.
fn describe() -> String {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("--version").output().ok();
    let rustc = output.and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .map_or("unknown processor", |rest| rest.trim_start_matches([' ', '\t', ':']));
    let rustc = rustc.split(" (").next().unwrap_or_default();
    let target = if cfg!(target_feature = "avx2") {
        "built for this processor"
    } else {
        "built without processor flags"
    };
    format!("pendulum {}, {rustc}, {model}, {target}", env!("CARGO_PKG_VERSION"))
}
