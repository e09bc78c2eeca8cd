//! The first program of the README and its output.

use std::cell::RefCell;

thread_local! {
    static PRINTED: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Records the output of the program.
macro_rules! print {
    ($($part:tt)*) => {
        super::PRINTED.with_borrow_mut(|text| text.push_str(&format!($($part)*)))
    };
}

/// Records the output and a line break.
macro_rules! println {
    ($($part:tt)*) => {
        print!("{}\n", format_args!($($part)*))
    };
}

mod program;

/// The README contains exactly the program and its output.
#[test]
fn the_readme_shows_what_its_first_program_prints() {
    let readme = include_str!("../../../README.md");
    // `main` of the program is public because the test calls it.
    let text = include_str!("program.rs").replace("pub(crate) fn main", "fn main");
    assert!(readme.contains(&format!("```rust\n{text}```")), "the program is another one");
    program::main().unwrap();
    let printed = PRINTED.take();
    assert!(readme.contains(&format!("```text\n{printed}```")), "the program prints\n{printed}");
}
