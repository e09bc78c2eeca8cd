//! Blocks that do not compile: each message is ours, whole, at the user's token. And blocks that do.

#![allow(mixed_script_confusables)]

mod blocks;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// `UPDATE_GOLDEN=1` rewrites the expected messages.
#[test]
fn refused_blocks_say_what_to_do() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("refused");
    let found = messages(&compiled());
    let names: BTreeSet<&String> = found.keys().collect();
    let sources = sources(&folder);
    assert_eq!(names, sources.iter().collect(), "blocks with messages, and all blocks");
    let mut differ = Vec::new();
    for (name, found) in &found {
        let path = folder.join(name).with_extension("stderr");
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, found).unwrap();
            continue;
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        if *found != expected {
            differ.push(format!("{name}: expected\n{expected}\nfound\n{found}"));
        }
    }
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}

/// What the compiler says to all programs of `refused`.
///
/// They are built beside the tests, with the libraries that are already there.
fn compiled() -> String {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."));
    cargo.args(["build", "--workspace", "--profile", "test", "--keep-going", "--color", "never"]);
    cargo.args(["--quiet", "--features", "refusals/refused"]);
    for phase in ["expansion", "names", "types", "lints", "instances"] {
        cargo.args(["--example", phase]);
    }
    let output = cargo.output().expect("cargo starts");
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(!output.status.success(), "blocks that must not compile did\n{text}");
    text
}

/// The messages for each source, in their order.
fn messages(text: &str) -> BTreeMap<String, String> {
    let mut all: BTreeMap<String, String> = BTreeMap::new();
    // Programs are compiled side by side: the last line of one and the first of another may touch.
    let text = text.replace("\nerror", "\n\nerror").replace("\nFor more", "\n\nFor more");
    for message in text.split("\n\n").map(|message| message.trim_matches('\n')) {
        let place = message.lines().nth(1).and_then(|line| line.trim_start().strip_prefix("--> "));
        let Some(place) = place else { continue };
        let file = place.split(':').next().unwrap_or(place);
        let name = file.strip_prefix("tools/refusals/refused/").unwrap_or(file);
        let text = all.entry(name.to_owned()).or_default();
        text.push_str(&without_places(message));
        text.push_str("\n\n");
    }
    all
}

/// Without the folder of the blocks, and without what moves with each change of the library: the
/// numbers of its lines and the widths that follow from them.
fn without_places(message: &str) -> String {
    let mut lines = Vec::new();
    let mut of_the_block = true;
    for line in message.replace("tools/refusals/refused/", "").lines() {
        if line.contains("full name for the type") || line.contains("full type name") {
            continue;
        }
        let inner = line.trim_start();
        let digits = inner.len() - inner.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (number, rest) = inner.split_at(digits);
        if let Some(place) = rest.strip_prefix("--> ") {
            let file = place.split(':').next().unwrap_or(place);
            of_the_block = !file.starts_with("pendulum-runtime/");
            lines.push(format!("    --> {}", if of_the_block { place } else { file }));
        } else if rest.trim_start().starts_with('|') || rest.starts_with("= ") {
            let number = if of_the_block { number } else { "" };
            lines.push(format!("{number:>4} {}", rest.trim_start()));
        } else if let Some(rest) = inner.strip_prefix("...") {
            lines.push(format!("...  {}", rest.trim_start()));
        } else {
            lines.push(line.to_owned());
        }
    }
    lines.join("\n")
}

/// All sources below a folder by their paths in it, but for the programs themselves.
fn sources(folder: &Path) -> Vec<String> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    entries(folder)
        .iter()
        .flat_map(|phase| entries(phase))
        .filter(|file| {
            file.extension().is_some_and(|end| end == "rs") && !file.ends_with("main.rs")
        })
        .map(|file| file.strip_prefix(folder).unwrap().to_str().unwrap().replace('\\', "/"))
        .collect()
}
