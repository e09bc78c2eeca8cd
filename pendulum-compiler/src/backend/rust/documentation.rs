//! The documentation of a struct for hover and rustdoc: its equations and their cost.

use super::Emitter;
use crate::algebra::expr::Graph;
use crate::backend::unicode::{self, Names};
use crate::schedule::Operations;
use proc_macro2::TokenStream;
use quote::quote;
use std::fmt::Write;

impl Emitter<'_, '_> {
    /// The equations, their cost and what they leave out, for hover and rustdoc.
    pub(super) fn documentation(&self) -> TokenStream {
        let names = Names::new(self.model, &self.energies);
        let (Some(motion), Some(accelerations)) = (&self.motion, &self.accelerations) else {
            return TokenStream::new();
        };
        let mut conserved: Vec<String> = motion
            .conserved
            .iter()
            .map(|conserved| format!("`{}`", unicode::conserved(&names, conserved)))
            .collect();
        // An energy may contain a time that no equation does.
        if motion.power == Graph::ZERO {
            conserved.push("the energy".into());
        }
        let count = accelerations.count();
        let documented =
            self.model.block.attributes.iter().any(|attribute| attribute.path().is_ident("doc"));
        let mut text = String::new();
        if documented {
            text.push_str("\n\n");
        }
        text.push_str("# Equations of motion\n\n```text\n");
        for line in &self.equations[0] {
            text.push_str(line);
            text.push('\n');
        }
        text.push_str("```\n\n");
        let _ = write!(text, "One evaluation takes {}.", operations(count));
        if !conserved.is_empty() {
            let _ = write!(text, " Conserved: {}.", conserved.join(", "));
        }
        let unused = self.unused(&names);
        if !unused.is_empty() {
            let list = unused.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let _ = write!(text, " The equations do not need {list}.");
        }
        text.push_str(&self.constraint_documentation());
        if !self.model.outputs.is_empty() {
            text.push_str("\n\n# Outputs\n\n");
            for output in &self.model.outputs {
                let (name, unit) = (output.declared.name, &output.declared.unit);
                let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
                let _ = writeln!(text, "- `{name}`{unit}");
            }
        }
        quote!(#[doc = #text])
    }
}

/// A count of operations in words.
pub(crate) fn operations(count: Operations) -> String {
    let rows = [
        (count.sincos, "sine–cosine pair"),
        (count.functions, "other function"),
        (count.mul, "multiplication"),
        (count.add, "addition"),
        (count.div, "division"),
    ];
    let parts: Vec<String> = rows
        .into_iter()
        .filter(|&(number, _)| 0 < number)
        .map(|(number, what)| format!("{number} {what}{}", if number == 1 { "" } else { "s" }))
        .collect();
    if parts.is_empty() { "no operation".into() } else { parts.join(", ") }
}

#[cfg(test)]
mod tests {
    use crate::compile::expand;

    #[test]
    fn the_energy_is_announced_where_its_power_vanishes() {
        for (conserved, statements) in [
            (false, "driven h: m; potential = m*g*(h + q);"),
            (false, "potential = m*g*q + m*g^2*t^2;"),
            (false, "potential = m*g*q; dissipation = m*g/2*q_dot;"),
            (false, "potential = m*g*q; force q = m*g;"),
            (true, "potential = m*g*q;"),
            (true, "potential = m*g*q; force q = 0;"),
        ] {
            let block = format!(
                "::p; struct S {{ m: kg, g: m/s^2 }} coordinate q: m; kinetic = m/2*q_dot^2; {statements}"
            );
            let found = expand(block.parse().unwrap()).to_string();
            assert!(!found.contains("compile_error"), "{found}");
            assert_eq!(found.contains("the energy"), conserved, "{statements}");
        }
    }
}
