//! The arguments that integrators follow along each step.

use super::Emitter;
use crate::algebra::expr::Id;
use crate::backend::unicode::{self, Names};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

impl Emitter<'_, '_> {
    /// Returns `arguments` if there are switches or layers.
    pub(super) fn arguments_method(&self) -> Option<TokenStream> {
        let arguments = self.arguments.as_ref()?;
        let roots: Vec<Id> = arguments.switches.iter().chain(&arguments.layers).copied().collect();
        if roots.is_empty() {
            return None;
        }
        let (scalar, state, length) = (self.scalar(), self.state(), roots.len());
        let all = self.body(&schedule::program(&arguments.graph, &roots));
        Some(quote! {
            fn arguments(&self, #state, values: &mut [#scalar]) {
                let all: [#scalar; #length] = #all;
                for k in 0..#length {
                    if k < values.len() {
                        values[k] = all[k];
                    }
                }
            }
        })
    }

    /// Returns the switches and the layers as text.
    pub(super) fn argument_facts(&self, names: &Names) -> [Vec<String>; 2] {
        let Some(arguments) = &self.arguments else { return [Vec::new(), Vec::new()] };
        [&arguments.switches, &arguments.layers]
            .map(|ids| ids.iter().map(|&id| unicode::short(&arguments.graph, names, id)).collect())
    }
}
