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
