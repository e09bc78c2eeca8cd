//! Equations as text.

use super::derive;
use crate::{latex, print};
use std::collections::BTreeSet;

/// The equations of a block in Unicode and in LaTeX.
fn printed(source: &str) -> [Vec<String>; 2] {
    derive(source, |model, graph, motion| {
        let names = print::Names::new(model, &BTreeSet::new());
        [print::equations(graph, &names, motion), latex::equations(graph, &names, motion)]
    })
}

#[test]
fn powers_in_latex_hold_together() {
    for (force, expected) in [
        ("(c*q)^(5/2)", "\\left(c q\\right)^{5/2}"),
        ("(c/q)^(5/2)", "\\left(\\frac{c}{q}\\right)^{5/2}"),
        ("(2/3)^(1/3)", "\\left(\\frac{2}{3}\\right)^{1/3}"),
        ("2^(1/3)", "2^{1/3}"),
        ("q^(5/2)", "q^{5/2}"),
        ("(c + q)^3", "\\left(c + q\\right)^{3}"),
        ("abs(q)^3", "\\left|q\\right|^{3}"),
        ("sqrt(c*q)", "\\sqrt{c q}"),
        ("sin(q)^2", "\\sin^{2} q"),
    ] {
        let [_, latex] = printed(&format!("struct S {{ c }} coordinate q; kinetic = q_dot^2/2; force q = {force};"));
        assert_eq!(latex, [format!("\\ddot{{q}} = {expected}")], "{force}");
    }
}

/// What is shared stands once in the graph, but wherever it is used in a text.
#[test]
fn what_is_too_long_is_not_written_out() {
    let shared: Vec<String> = (0..40).map(|k| format!("let a{} = sin(a{k})*exp(a{k});", k + 1)).collect();
    let chain: Vec<String> = (0..1000).map(|k| format!("let a{} = sin(a{k});", k + 1)).collect();
    for (lets, last) in [(shared.concat(), "a40"), (chain.concat(), "a1000")] {
        let block = format!(
            "struct S {{ m }} coordinate q; coordinate z; coordinate w; let a0 = q; {lets} kinetic = (q_dot^2 + w_dot^2 + w_dot*z_dot + z_dot^2)/2;"
        );
        let [text, latex] = printed(&format!("{block} potential = {last} + w;"));
        assert_eq!(text[0], "q̈ = … (too long to write out)");
        assert_eq!(latex[0], "\\ddot{q} = \\ldots\\text{ (too long to write out)}");
        assert_eq!((&text[1][..], &latex[1][..]), ("z̈ + (1/2)·ẅ = 0", "\\ddot{z} + \\frac{1}{2} \\ddot{w} = 0"));
        let [text, latex] = printed(&format!("{block} force z = {last};"));
        assert_eq!((&text[0][..], &latex[0][..]), ("q̈ = 0", "\\ddot{q} = 0"));
        assert_eq!(text[1], "z̈ = … (too long to write out)");
        assert_eq!(latex[1], "\\ddot{z} = \\ldots\\text{ (too long to write out)}");
    }
}
