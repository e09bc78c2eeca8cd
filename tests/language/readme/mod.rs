//! The first program of the README, what it prints, and the links of the pages around it.

use std::cell::RefCell;
use std::fs;
use std::path::Path;

thread_local! {
    static PRINTED: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Keeps what the program prints.
macro_rules! print {
    ($($part:tt)*) => {
        super::PRINTED.with_borrow_mut(|text| text.push_str(&format!($($part)*)))
    };
}

/// The same, and ends the line.
macro_rules! println {
    ($($part:tt)*) => {
        print!("{}\n", format_args!($($part)*))
    };
}

mod program;

/// The README holds the program and its output, letter for letter.
#[test]
fn the_readme_shows_what_its_first_program_prints() {
    let readme = include_str!("../../../README.md");
    // Its `main` is called from here.
    let text = include_str!("program.rs").replace("pub(crate) fn main", "fn main");
    assert!(readme.contains(&format!("```rust\n{text}```")), "the program is another one");
    program::main().unwrap();
    let printed = PRINTED.take();
    assert!(readme.contains(&format!("```text\n{printed}```")), "the program prints\n{printed}");
}

/// Every link to a file of the repository leads to one.
#[test]
fn links_between_files_lead_to_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut links = 0;
    for page in ["README.md", "CONTRIBUTING.md", "examples/README.md", "docs/architecture.md"] {
        let page = root.join(page);
        let text = fs::read_to_string(&page).unwrap();
        for part in text.split("](").skip(1) {
            let target = part.split([')', '#']).next().unwrap();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            let file = page.parent().unwrap().join(target);
            assert!(file.exists(), "{} links {target}, which is not there", page.display());
            links += 1;
        }
    }
    assert!(links > 20, "{links}");
}
