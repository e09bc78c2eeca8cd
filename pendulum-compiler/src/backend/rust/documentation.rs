//! The documentation of a struct for hover and rustdoc: its equations and their cost.

use crate::algebra::expr::Graph;
use crate::backend::Analysis;
use crate::backend::names::Names;
use crate::backend::unicode;
use crate::mechanics::attitude;
use proc_macro2::TokenStream;
use quote::quote;
use std::fmt::Write;

impl Analysis<'_, '_> {
    /// Returns the equations, their cost and conserved quantities, for hover and rustdoc.
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
        // An energy may depend on time although no equation does.
        if motion.power == Graph::ZERO && motion.constraints.frictions.is_empty() {
            conserved.push("the energy".into());
        }
        let count = accelerations.count();
        let documented =
            self.model.block.attributes.iter().any(|attribute| attribute.path().is_ident("doc"));
        let title = if documented { "\n\n" } else { "" };
        let [unicode, _, mathml] = self.equations.each_ref();
        let equations =
            format!("{title}# Equations of motion\n\n```text\n{}\n```", unicode.join("\n"));
        let drawn = format!("{title}# Equations of motion\n\n{}", drawn(mathml));
        let mut text = String::from("\n");
        let _ = write!(text, "One evaluation takes {count}.");
        if let Some((_, name)) = attitude::rotations(self.model).first() {
            let letter = if self.model.block.ascii { "Omega" } else { "Ω" };
            let _ = write!(
                text,
                " `{letter}_{name}` are the rates of `{name}` about the axes of its body, \
                 `{name}.xz` is an entry of its matrix."
            );
        }
        if !conserved.is_empty() {
            let _ = write!(text, " Conserved: {}.", conserved.join(", "));
        }
        let unused = self.unused(&names);
        if !unused.is_empty() {
            let list = unused.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let _ = write!(text, " The equations do not need {list}.");
        }
        text.push_str(&self.constraint_documentation());
        let outputs =
            self.model.outputs.iter().map(|output| {
                format!("`{}`{}", output.declared.name, in_unit(&output.declared.unit))
            });
        text.push_str(&section("Outputs", outputs));
        // Monospaced fonts draw dots beside their letters, and editors do not show MathML.
        quote! {
            #[cfg_attr(not(doc), doc = #equations)]
            #[cfg_attr(doc, doc = #drawn)]
            #[doc = #text]
        }
    }
}

/// Returns a section of the documentation with a line for each item, nothing without items.
pub(super) fn section(title: &str, items: impl Iterator<Item = String>) -> String {
    let items: Vec<String> = items.map(|item| format!("- {item}\n")).collect();
    let title = format!("\n\n# {title}\n\n");
    if items.is_empty() { String::new() } else { title + &items.concat() }
}

/// Returns a unit as a part of a sentence; empty without a unit.
pub(super) fn in_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" in {unit}") }
}

/// Returns equations in MathML, with an element for each line.
fn drawn(mathml: &[String]) -> String {
    let mut text = String::new();
    for line in mathml {
        let _ = writeln!(text, "<div style=\"margin: 0.5em 0\">{line}</div>\n");
    }
    text
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

    /// Editors get text, and rustdoc gets MathML.
    #[test]
    fn the_equations_stand_there_for_editors_and_for_browsers() {
        let block = "::p; struct S { m: kg, g: m/s^2 } coordinate q: m; \
                     kinetic = m/2*q_dot^2; potential = m*g*q;";
        let found: String = expand(block.parse().unwrap()).to_string().split_whitespace().collect();
        let text = "#[cfg_attr(not(doc),doc=\"#Equationsofmotion\\n\\n```text\\nq_ddot=-g\\n```";
        assert!(found.contains(text), "{found}");
        assert!(found.contains("<mover><mrow><mi>q</mi></mrow><mo>..</mo></mover><mo>=</mo>"));
        assert_eq!(found.matches("#[cfg_attr(doc,doc=").count(), 1);
    }
}
