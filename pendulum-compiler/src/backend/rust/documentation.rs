//! The documentation of a struct for hover and rustdoc: its equations and their cost.

use super::Emitter;
use crate::algebra::expr::Graph;
use crate::backend::unicode::{self, Names};
use crate::mechanics::attitude;
use proc_macro2::TokenStream;
use quote::quote;
use std::fmt::Write;

impl Emitter<'_, '_> {
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
        if !self.model.outputs.is_empty() {
            text.push_str("\n\n# Outputs\n\n");
            for output in &self.model.outputs {
                let (name, unit) = (output.declared.name, &output.declared.unit);
                let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
                let _ = writeln!(text, "- `{name}`{unit}");
            }
        }
        // Monospaced fonts draw dots beside their letters, and editors do not show MathML.
        quote! {
            #[cfg_attr(not(doc), doc = #equations)]
            #[cfg_attr(doc, doc = #drawn)]
            #[doc = #text]
        }
    }
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
