//! Fragments: an `$e:expr` that a macro of the user passes on is enclosed in invisible brackets.

use crate::compile::expand;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// Returns the stream with each `?(…)` replaced by a group with `delimiter`, either a fragment or a
/// group in parentheses.
fn replaced(tokens: TokenStream, delimiter: Delimiter) -> TokenStream {
    let mut marked = false;
    let mut result = TokenStream::new();
    for tree in tokens {
        match tree {
            TokenTree::Punct(punct) if punct.as_char() == '?' => {
                marked = true;
                continue;
            }
            TokenTree::Group(group) => {
                let around = if marked { delimiter } else { group.delimiter() };
                result.extend([TokenTree::from(Group::new(
                    around,
                    replaced(group.stream(), delimiter),
                ))]);
            }
            tree => result.extend([tree]),
        }
        marked = false;
    }
    result
}

fn expanded(statements: &str, delimiter: Delimiter) -> String {
    let block = format!(
        "::p; struct W {{ k }} coordinate q; let c = [k, 1]; kinetic = q_dot^2/2; {statements}"
    );
    expand(replaced(block.parse().unwrap(), delimiter)).to_string()
}

/// Returns an expansion without the copy for editors, which differs between fragments and
/// parentheses.
fn items(expansion: &str) -> &str {
    &expansion[expansion.find("struct W").unwrap()..]
}

#[test]
fn a_fragment_is_an_operand() {
    for operand in ["1 + q", "-q", "-2", "k*q", "-2^q", "k/q"] {
        for around in [
            "?()",
            "k*2*?()",
            "k*?()^2",
            "-?()^2",
            "k/?()",
            "k - ?()",
            "?() - k",
            "2^?()",
            "sin(?())",
            "|?()|",
            "[?(), k].x",
            "?(?())^3",
        ] {
            let statement =
                format!("potential = {};", around.replace("?()", &format!("?({operand})")));
            let found = expanded(&statement, Delimiter::None);
            assert!(!found.contains("compile_error"), "{statement}: {found}");
            let written = expanded(&statement, Delimiter::Parenthesis);
            assert_eq!(items(&found), items(&written), "{statement}");
        }
    }
}

#[test]
fn names_numbers_units_and_ranges_may_be_fragments() {
    for (statement, written) in [
        ("potential = ?(sin)(q);", "potential = sin(q);"),
        ("potential = ?(?(sin))(q);", "potential = sin(q);"),
        ("potential = ?(c[?(1)])*q;", "potential = c[1]*q;"),
        ("potential = ?(c)[?(1)]*q + ?([q, 1]).x;", "potential = c[1]*q + [q, 1].x;"),
        ("driven x: ?([m; ?(2)]);", "driven x: [m; 2];"),
        ("driven x: ?(m/s^2);", "driven x: m/s^2;"),
        ("potential = sum(k in ?(0..3), k*q);", "potential = sum(k in 0..3, k*q);"),
        ("potential = sum(k in ?(1)..=?(1 + 2), k*q);", "potential = sum(k in 1..=1 + 2, k*q);"),
    ] {
        let found = expanded(statement, Delimiter::None);
        assert!(!found.contains("compile_error"), "{statement}: {found}");
        assert_eq!(found, expanded(written, Delimiter::None), "{statement}");
    }
    for statement in [
        "potential = k ?(-q);",
        "potential = ?(q) ?(q);",
        "potential = ?(1 + q)(q);",
        "potential = ?(q, q);",
        "potential = ?();",
    ] {
        assert_eq!(
            expanded(statement, Delimiter::None).matches("compile_error").count(),
            1,
            "{statement}"
        );
    }
}
