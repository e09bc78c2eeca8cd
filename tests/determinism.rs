//! Hashes of the final states of all methods on many systems, which are the same in every build.
//!
//! Test and release profile, with and without the machine's own instructions
//! (`RUSTFLAGS="-C target-cpu=native"`), must agree with `data/determinism.txt`.
//! `UPDATE_GOLDEN=1 cargo test --test determinism` rewrites the file after an intended change of
//! the digits.

#![allow(missing_docs)]

use systems::fingerprints;

#[test]
fn final_states_have_the_bits_that_are_checked_in() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/determinism.txt");
    let found = fingerprints::all();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(path, found.join("\n") + "\n").unwrap();
        return;
    }
    let text = std::fs::read_to_string(path).unwrap();
    let expected: Vec<&str> = text.lines().collect();
    let differ: Vec<String> = found
        .iter()
        .zip(&expected)
        .filter(|(found, expected)| found != expected)
        .map(|(a, b)| format!("{a} for {b}"))
        .collect();
    assert!(
        differ.is_empty() && found.len() == expected.len(),
        "{} lines for {}\n{}",
        found.len(),
        expected.len(),
        differ.join("\n")
    );
}

#[test]
fn lanes_have_the_bits_of_single_systems() {
    for (system, lanes) in fingerprints::lanes_that_differ(500) {
        assert_eq!(lanes, 0, "{system}");
    }
}
