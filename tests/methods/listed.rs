//! Every public method stands in every list of methods.

use std::collections::BTreeSet;
use std::path::Path;

/// The text of a file of the repository.
fn text(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The words of a text: letters, digits and nothing else.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|letter: char| !letter.is_alphanumeric()).collect()
}

#[test]
fn no_list_of_methods_misses_one() {
    let module = text("pendulum-core/src/integrate/mod.rs");
    let methods: Vec<&str> = module
        .lines()
        .filter_map(|line| line.trim().strip_prefix("pub use super::")?.strip_suffix(';'))
        // Other programs' steps come from a folder beside the methods.
        .filter(|path| !path.starts_with("step::"))
        .filter_map(|path| Some(path.rsplit_once("::")?.1))
        // Functions are exported beside them.
        .filter(|name| name.starts_with(char::is_uppercase))
        .collect();
    assert!(methods.contains(&"Auto") && methods.contains(&"Picard"), "{methods:?}");

    let table: String = module.lines().filter(|line| line.starts_with("//! |")).collect();
    let determinism = text("tests/data/determinism.txt");
    // A name there ends in the order or the number of stages: `Gauss4`, `Rattle2`.
    let fingerprints: BTreeSet<&str> = words(&determinism)
        .into_iter()
        .flat_map(|word| [word, word.trim_end_matches(|letter: char| letter.is_ascii_digit())])
        .collect();
    let guide = text("pendulum-runtime/src/guide/choosing_a_method.md");
    let files = ["methods/known/order", "methods/gauss", "methods/picard"];
    let files = files.into_iter().chain(["methods/stiff", "methods/taylor", "constraints/rattle"]);
    let orders: Vec<String> = files.map(|file| text(&format!("tests/{file}.rs"))).collect();
    let lists = [
        ("the table of integrate/mod.rs", words(&table)),
        ("guide/choosing_a_method.md", words(&guide)),
        ("tests/data/determinism.txt", fingerprints),
        ("the tests of orders and errors", orders.iter().flat_map(|text| words(text)).collect()),
    ];
    let mut missing = Vec::new();
    for (list, names) in &lists {
        // `Auto` steps with other methods; the sentence below the table names it.
        let absent = methods.iter().filter(|&&method| method != "Auto" && !names.contains(method));
        missing.extend(absent.map(|method| format!("`{method}` is missing in {list}")));
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
