//! Golden files: a block, its printed equations, its operations and its facts.
//!
//! `UPDATE_GOLDEN=1 cargo test -p pendulum-compiler` rewrites them. The difference is checked in
//! review.

use super::{derived, in_latex};
use crate::algebra::expr::{Graph, Symbol};
use crate::backend::{names, unicode};
use crate::mechanics::motion::Motion;
use crate::messages::Errors;
use crate::schedule;
use std::fmt::Write;
use std::path::{Path, PathBuf};

const MARK: &str = "\n---\n";

#[test]
fn golden_files_hold() {
    let files = files();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let (source, expected) = text.split_once(MARK).unwrap_or((text.trim_end(), ""));
        let start = std::time::Instant::now();
        crate::compile::expand(format!("::pendulum_runtime; {source}").parse().unwrap());
        println!(
            "{}: expanded in {:.2} ms",
            file.file_stem().unwrap().to_string_lossy(),
            1e3 * start.elapsed().as_secs_f64()
        );
        let found = report(source);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&file, format!("{source}{MARK}{found}")).unwrap();
        } else {
            assert_eq!(found, expected, "{}", file.display());
        }
    }
}

/// Returns the golden files.
fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Returns the blocks of the golden files.
pub(super) fn sources_of_blocks() -> Vec<String> {
    let texts = files().into_iter().map(|file| std::fs::read_to_string(file).unwrap());
    texts
        .map(|text| {
            text.split_once(MARK).map_or_else(|| text.clone(), |(source, _)| source.to_owned())
        })
        .collect()
}

/// All other systems of the repository: tests, examples, documentation.
#[test]
fn every_system_in_the_repository() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = String::new();
    let mut count = 0;
    for file in sources(&root) {
        let text = std::fs::read_to_string(&file).unwrap();
        let name = file.strip_prefix(&root).unwrap().display().to_string();
        for block in blocks(&text) {
            let mut errors = Errors::default();
            let title = block
                .split('{')
                .next()
                .unwrap_or_default()
                .split_whitespace()
                .last()
                .unwrap_or_default()
                .to_owned();
            writeln!(found, "== {name}: {title}").unwrap();
            match attempt(&block, &mut errors, false) {
                Some(report) => found.push_str(&report),
                None => writeln!(found, "refused: {}", errors.messages().join("; ")).unwrap(),
            }
            count += 1;
        }
    }
    assert!(60 < count, "{count}");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden-repository.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, found).unwrap();
    } else {
        let expected = std::fs::read_to_string(&file).unwrap_or_default();
        for (found, expected) in found.split("== ").zip(expected.split("== ")) {
            assert_eq!(found, expected);
        }
        assert_eq!(found.len(), expected.len());
    }
}

/// Returns the files that may contain systems.
fn sources(root: &Path) -> Vec<PathBuf> {
    let mut pending = [
        "README.md",
        "tests",
        "examples",
        "tools/check/src/bin/stability",
        "tools/refusals/tests/blocks",
        "tools/systems",
        "pendulum-body/src",
        "pendulum-core/src",
        "pendulum-ensemble/src",
        "pendulum-import/src",
        "pendulum-runtime/src",
        "pendulum-runtime/benches",
        "pendulum-scene/src",
    ]
    .map(|part| root.join(part))
    .to_vec();
    let mut files = Vec::new();
    while let Some(path) = pending.pop() {
        assert!(path.exists(), "{} has moved", path.display());
        if path.is_dir() {
            pending.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|kind| kind == "rs" || kind == "md")
            // A link to another of these files.
            && !path.is_symlink()
            // The blocks of the generator have a separate test.
            && !path.components().any(|part| part.as_os_str() == "random_systems")
        {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Returns the text between the braces of each `lagrangian!` that is not part of another macro.
fn blocks(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (start, _) in text.match_indices("lagrangian! {") {
        let inside = &text[start + "lagrangian! {".len()..];
        let mut depth = 1;
        let end = inside.char_indices().find_map(|(place, letter)| {
            depth += i32::from(letter == '{') - i32::from(letter == '}');
            (depth == 0).then_some(place)
        });
        let line = text[..start].rsplit('\n').next().unwrap_or_default();
        let comment = ["///", "//!"].into_iter().find(|mark| line.trim_start().starts_with(mark));
        if let Some(end) = end
            && !inside[..end].contains('$')
        {
            let lines = inside[..end].lines();
            let bare = lines.map(|line| match comment {
                Some(mark) => {
                    let line = line.trim_start().strip_prefix(mark).unwrap_or(line);
                    // A line that rustdoc hides.
                    line.trim_start().strip_prefix("# ").unwrap_or(line)
                }
                // A hidden line in a guide.
                None => line.strip_prefix("# ").unwrap_or(line),
            });
            let block = bare.collect::<Vec<_>>().join("\n");
            // Prose about the macro is not a block.
            if block.contains("struct") && block.parse::<proc_macro2::TokenStream>().is_ok() {
                found.push(block);
            }
        }
    }
    found
}

fn report(source: &str) -> String {
    let mut errors = Errors::default();
    attempt(source, &mut errors, true).unwrap_or_else(|| panic!("{:?}", errors.messages()))
}

/// Returns the content of a golden file; energies, momenta and LaTeX are included only if `whole`
/// is set. Returns `None` if the block is refused.
fn attempt(source: &str, errors: &mut Errors, whole: bool) -> Option<String> {
    derived(source, errors, |model, graph, motion, energies| {
        let names = names::Names::new(model, energies);
        let mut text = String::new();
        let (own, printed) = names::Names::new(model, energies).printed(model, motion);
        let sides = unicode::sides(graph, &own, printed);
        for line in unicode::equations(graph, &own, printed, &sides) {
            writeln!(text, "{line}").unwrap();
        }
        for line in in_latex(graph, &own, printed, &sides).into_iter().filter(|_| whole) {
            writeln!(text, "latex: {line}").unwrap();
        }
        let operations =
            |graph: &Graph, roots: &[_]| schedule::program(graph, roots).count().to_string();
        writeln!(text, "accelerations: {}", operations(graph, &motion.accelerations)).unwrap();
        if whole {
            outputs(&mut text, graph, &names, motion);
            for (output, lowered) in model.outputs.iter().zip(&energies.outputs) {
                for (index, &scalar) in lowered.scalars.iter().enumerate() {
                    let value = unicode::expression(graph, &names, scalar);
                    writeln!(text, "output {}, {index} = {value}", output.declared.name).unwrap();
                }
            }
        }
        let constraints = &motion.constraints;
        if !constraints.held.is_empty() {
            for (what, roots) in
                [("multipliers", &constraints.multipliers), ("correction", &constraints.correction)]
            {
                writeln!(text, "{what}: {}", operations(graph, roots)).unwrap();
            }
        }
        for conserved in &motion.conserved {
            writeln!(text, "conserved: {}", unicode::conserved(&names, conserved)).unwrap();
        }
        let facts = [
            (motion.autonomous, "autonomous"),
            (motion.separable, "separable"),
            (motion.velocity_free, "velocity-free"),
            (motion.constant_mass_matrix, "constant mass matrix"),
            (motion.nonconservative, "nonconservative"),
        ];
        let facts: Vec<&str> = facts.into_iter().filter(|fact| fact.0).map(|fact| fact.1).collect();
        writeln!(text, "facts: {}", facts.join(", ")).unwrap();
        let symbols = |roots: &[_]| {
            let inputs = graph
                .symbols(roots)
                .into_iter()
                .filter(|symbol| matches!(symbol, Symbol::Input { .. } | Symbol::Control { .. }));
            inputs.map(|symbol| names.symbol(symbol)).collect::<Vec<_>>().join(", ")
        };
        if !model.inputs.is_empty() {
            writeln!(text, "inputs of the accelerations: {}", symbols(&motion.accelerations))
                .unwrap();
            writeln!(text, "inputs of the momenta: {}", symbols(&motion.momenta)).unwrap();
        }
        text
    })
}

fn outputs(text: &mut String, graph: &Graph, names: &names::Names, motion: &Motion) {
    writeln!(text, "energy = {}", unicode::expression(graph, names, motion.energy)).unwrap();
    writeln!(
        text,
        "power = {}",
        unicode::expression(graph, names, motion.constraints.power.unwrap_or(motion.power))
    )
    .unwrap();
    for (index, &momentum) in motion.momenta.iter().enumerate() {
        writeln!(
            text,
            "p_{} = {}",
            names.coordinates[index],
            unicode::expression(graph, names, momentum)
        )
        .unwrap();
    }
}
