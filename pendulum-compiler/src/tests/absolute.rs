//! Paths in generated code: they refer to Rust's own items, whatever names the user declares.

use super::golden;
use crate::compile::expand;
use proc_macro2::{TokenStream, TokenTree};

/// The primitive types, and the names that the prelude and the crates of the standard library add
/// to every scope.
#[rustfmt::skip]
const COMMON: &[&str] = &[
    "f32", "f64", "u8", "u16", "u32", "u64", "u128", "usize", "i8", "i16", "i32", "i64", "i128", "isize", "bool", "char", "str",
    "Option", "Some", "None", "Result", "Ok", "Err", "Vec", "String", "Box", "ToString", "ToOwned", "AsRef", "AsMut", "Into", "From",
    "TryFrom", "TryInto", "Iterator", "IntoIterator", "Extend", "FromIterator", "DoubleEndedIterator", "ExactSizeIterator",
    "Clone", "Copy", "Default", "Debug", "Eq", "PartialEq", "Ord", "PartialOrd", "Send", "Sync", "Sized", "Unpin", "Drop", "drop",
    "Fn", "FnMut", "FnOnce", "AsyncFn", "AsyncFnMut", "AsyncFnOnce", "core", "std", "alloc",
    "assert", "assert_eq", "debug_assert", "panic", "unimplemented", "unreachable", "todo", "concat", "matches", "vec", "format",
];

/// Finds the names of [`COMMON`] that are not part of an absolute path. Attributes are skipped.
fn relative(tokens: TokenStream, found: &mut Vec<String>) {
    let mut before = [' '; 3];
    let mut names = false;
    for tree in tokens {
        let mark = match &tree {
            TokenTree::Group(group) => {
                // The modules of names are separate scopes.
                if before[2] != '#' && !std::mem::take(&mut names) {
                    relative(group.stream(), found);
                }
                'g'
            }
            TokenTree::Ident(name) => {
                // `.map` is a method, `a::b` is relative to `a`, and `::a` is a crate.
                let follows = before[2] == '.' || before[1..] == [':', ':'];
                if !follows && COMMON.iter().any(|common| name == common) {
                    found.push(name.to_string());
                }
                names = before[2] == 'i' && name == "__block";
                'i'
            }
            TokenTree::Punct(punct) => punct.as_char(),
            TokenTree::Literal(_) => 'l',
        };
        before = [before[1], before[2], mark];
    }
}

#[test]
fn generated_paths_are_absolute() {
    let empty = "struct Empty {} coordinate x; kinetic = x_dot^2/2; potential = x^4;";
    let implicit = "struct Implicit { m } coordinate x; lagrangian = m*x_dot^4 + m*x_dot^2;";
    let broken =
        "struct Broken { m } coordinate x; driven y; kinetic = m*x_dot^2 + y_dot + nothing;";
    let sources = golden::sources_of_blocks();
    assert!(10 < sources.len());
    for source in sources.iter().map(String::as_str).chain([empty, implicit, broken]) {
        let mut found = Vec::new();
        let items = expand(format!("::pendulum_runtime; {source}").parse().unwrap());
        // Declarations of the user's names are not paths, and no golden block declares one of these
        // names.
        relative(items, &mut found);
        assert!(found.is_empty(), "{found:?} in the expansion of {source}");
    }
}

/// If another system has the same name as the struct, an implementation whose number of coordinates
/// is inferred would cause a second error.
#[test]
fn generated_code_names_the_number_of_coordinates() {
    for source in golden::sources_of_blocks() {
        let items = expand(format!("::pendulum_runtime; {source}").parse().unwrap()).to_string();
        assert!(items.contains(":: System <"), "{source}");
        for name in ["System", "Jacobians", "Staged", "SplitEnergy", "Jets"] {
            assert!(
                !items.contains(&format!(":: {name} ::")),
                "`{name}` without its number in the expansion of {source}"
            );
        }
    }
}

/// The search finds relative paths.
#[test]
fn relative_paths_are_found() {
    let mut found = Vec::new();
    let tokens = "#[derive(Clone)] struct S<T = f64>(::core::primitive::f64); fn f() { a.drop(); core::f(Some(1usize)) }";
    relative(tokens.parse().unwrap(), &mut found);
    assert_eq!(found, ["f64", "core", "Some"]);
}
