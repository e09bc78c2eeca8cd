//! The page of the gallery, and the pictures of pages as data, are those that their program writes.

#[path = "../src/bin/gallery/page.rs"]
mod page;

use page::{ILLUSTRATED, guide, page, pictures};

const ADVICE: &str =
    "is stale: `cargo run --release -p pictures --features compiler --bin gallery` writes it again";

#[test]
fn the_page_has_the_equations_that_the_compiler_derives() {
    let found = std::fs::read_to_string(guide().join("gallery.md")).unwrap();
    let expected = page().unwrap();
    for (found, expected) in found.split("\n## ").zip(expected.split("\n## ")) {
        assert_eq!(found, expected, "the page {ADVICE}");
    }
    assert_eq!(found.len(), expected.len(), "the page {ADVICE}");
}

#[test]
fn every_picture_of_a_page_is_there_as_data() {
    for name in ILLUSTRATED {
        let text = std::fs::read_to_string(guide().join(format!("{name}.md"))).unwrap();
        let data = std::fs::read_to_string(guide().join(format!("figures/{name}.uri"))).unwrap();
        assert!(data == pictures(&text).unwrap(), "figures/{name}.uri {ADVICE}");
        assert!(text.contains("!["), "{name}");
    }
}
