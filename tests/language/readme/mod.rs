//! The first program of the README and its output.

use std::cell::RefCell;

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
