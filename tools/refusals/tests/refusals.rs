//! Blocks that do not compile: each message is ours, whole, at the user's token. And blocks that do.
//!
//! `UPDATE_GOLDEN=1 cargo test -p refusals` rewrites the expected messages, which stand beside the
//! blocks. The compiler runs here on each file alone, against the library that cargo has built
//! already: a project for each file would build the library again.

#![allow(missing_docs)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where the library was built and where programs are written.
struct Build {
    root: PathBuf,
    folder: PathBuf,
    output: PathBuf,
}

impl Build {
    /// Finds the library in the profile of this test.
    fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
        let output = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let target = output.parent().unwrap();
        let (profile, folder) =
            if cfg!(debug_assertions) { ("test", "debug") } else { ("release", "release") };
        let built = Command::new(env!("CARGO"))
            .current_dir(&root)
            .args(["build", "--quiet", "--package", "pendulum-runtime", "--profile", profile])
            .arg("--target-dir")
            .arg(target)
            .status();
        assert!(built.unwrap().success(), "the library does not compile");
        Self { folder: target.join(folder), root, output }
    }

    /// The files of a folder below `tests`, in order.
    fn cases(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.root.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.ends_with(".rs"))
            .map(|name| format!("{folder}/{name}"))
            .collect();
        names.sort();
        assert!(!names.is_empty(), "{folder}");
        names
    }

    /// The program of a file.
    fn program(&self, case: &str) -> PathBuf {
        self.output.join(case.replace('/', "-").replace(".rs", ""))
    }

    fn compile(&self, case: &str) -> Output {
        let library = self.folder.join("libpendulum_runtime.rlib");
        Command::new("rustc")
            .current_dir(&self.root)
            .args(["--edition", "2024", "--crate-type", "bin", "--verbose", case, "--extern"])
            .arg(format!("pendulum_runtime={}", library.display()))
            .arg("-L")
            .arg(format!("dependency={}", self.folder.join("deps").display()))
            .arg("-o")
            .arg(self.program(case))
            .output()
            .unwrap()
    }
}

/// Asserts that no case has anything to complain about, on all processors.
fn check(cases: &[String], complaint: impl Fn(&str) -> Option<String> + Sync) {
    let (next, complaints) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Some(text) = complaint(case) {
                        complaints.lock().unwrap().push(format!("{case}: {text}"));
                    }
                }
            });
        }
    });
    let complaints = complaints.into_inner().unwrap();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn refused_blocks_say_what_to_do() {
    let build = Build::new();
    check(&build.cases("tests/refusals"), |case| {
        let Output { status, stderr, .. } = build.compile(case);
        if status.success() {
            return Some("compiles".into());
        }
        let file = build.root.join(case).with_extension("stderr");
        let found = normalized(&String::from_utf8(stderr).unwrap(), &build.root);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&file, found).unwrap();
            return None;
        }
        let expected = std::fs::read_to_string(&file).unwrap_or_default();
        (found != expected).then(|| format!("says\n{found}\nand not\n{expected}"))
    });
}

#[test]
fn accepted_blocks_run() {
    let build = Build::new();
    check(&build.cases("tests/blocks"), |case| {
        let compiled = build.compile(case);
        if !compiled.status.success() {
            return Some(String::from_utf8(compiled.stderr).unwrap());
        }
        let run = Command::new(build.program(case)).output().unwrap();
        (!run.status.success()).then(|| String::from_utf8(run.stderr).unwrap())
    });
}

/// The messages without what changes with the library: lines of its files and their numbers, and
/// the width that the longest number gives to the margin; and without the compiler's summary.
fn normalized(text: &str, root: &Path) -> String {
    let text = text.replace(&format!("{}/", root.display()), "");
    let paragraphs = text.trim().split("\n\n").filter(|paragraph| {
        ["error: aborting", "Some errors have", "For more information"]
            .iter()
            .all(|summary| !paragraph.starts_with(summary))
    });
    paragraphs.map(paragraph).collect::<Vec<_>>().join("\n\n") + "\n"
}

/// A line's number, if it has one, and what follows the margin, if it has one.
fn margin(line: &str) -> Option<(&str, &str)> {
    let rest = line.trim_start();
    let end = rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len());
    let (number, rest) = rest.split_at(end);
    let rest = rest.trim_start();
    let marked = ["|", "= ", "-->", ":::"].iter().any(|mark| rest.starts_with(mark));
    (marked && line.starts_with([' ', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']))
        .then_some((number, rest))
}

fn paragraph(text: &str) -> String {
    let mut own = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        match margin(line) {
            Some((_, rest)) if rest.starts_with("-->") || rest.starts_with(":::") => {
                own = rest.contains(" tests/");
                let place = if own { rest } else { rest.split(".rs:").next().unwrap_or(rest) };
                lines.push((
                    Some(""),
                    if own || place == rest { place.into() } else { format!("{place}.rs") },
                ));
            }
            Some((number, rest)) => lines.push((Some(if own { number } else { "" }), rest.into())),
            None => lines.push((None, line.to_owned())),
        }
    }
    let width = lines.iter().filter_map(|(number, _)| *number).map(str::len).max().unwrap_or(0);
    let lines = lines.into_iter().map(|(number, rest)| match number {
        None => rest,
        Some(_) if rest.starts_with("-->") || rest.starts_with(":::") => {
            format!("{:width$}{rest}", "")
        }
        Some(number) => format!("{number:>width$} {rest}"),
    });
    lines.collect::<Vec<_>>().join("\n")
}
