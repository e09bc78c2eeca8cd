//! Golden files: a block, its printed equations, its operations and its facts.
//!
//! `UPDATE_GOLDEN=1 cargo test -p pendulum-macros` rewrites them; the difference is read in review.

use super::derived;
use crate::error::Errors;
use crate::expr::{Graph, Symbol};
use crate::{emit, latex, print, schedule};
use std::fmt::Write;
use std::path::Path;

const MARK: &str = "\n---\n";

#[test]
fn golden_files_hold() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let (source, expected) = text.split_once(MARK).unwrap_or((text.trim_end(), ""));
        let start = std::time::Instant::now();
        crate::expand::expand(format!("::pendulum_runtime; {source}").parse().unwrap());
        println!("{}: expanded in {:.2} ms", file.file_stem().unwrap().to_string_lossy(), 1e3 * start.elapsed().as_secs_f64());
        let found = report(source);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&file, format!("{source}{MARK}{found}")).unwrap();
        } else {
            assert_eq!(found, expected, "{}", file.display());
        }
    }
}

fn report(source: &str) -> String {
    let mut errors = Errors::default();
    let report = derived(source, &mut errors, |model, graph, motion, energies| {
        let names = print::Names::new(model, &energies.families);
        let mut text = String::new();
        for line in print::equations(graph, &names, motion) {
            writeln!(text, "{line}").unwrap();
        }
        for line in latex::equations(graph, &names, motion) {
            writeln!(text, "latex: {line}").unwrap();
        }
        let operations = |graph: &Graph, roots: &[_]| emit::operations(schedule::program(graph, roots).count());
        writeln!(text, "accelerations: {}", operations(graph, &motion.accelerations)).unwrap();
        writeln!(text, "energy = {}", print::expression(graph, &names, motion.energy)).unwrap();
        writeln!(text, "power = {}", print::expression(graph, &names, motion.power)).unwrap();
        for (index, &momentum) in motion.momenta.iter().enumerate() {
            writeln!(text, "p_{} = {}", names.coordinates[index], print::expression(graph, &names, momentum)).unwrap();
        }
        for conserved in &motion.conserved {
            writeln!(text, "conserved: {}", print::conserved(&names, conserved)).unwrap();
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
            let inputs = graph.symbols(roots).into_iter().filter(|symbol| matches!(symbol, Symbol::Input { .. }));
            inputs.map(|symbol| names.symbol(symbol)).collect::<Vec<_>>().join(", ")
        };
        if !model.inputs.is_empty() {
            writeln!(text, "inputs of the accelerations: {}", symbols(&motion.accelerations)).unwrap();
            writeln!(text, "inputs of the momenta: {}", symbols(&motion.momenta)).unwrap();
        }
        text
    });
    report.unwrap_or_else(|| panic!("{:?}", errors.messages()))
}
