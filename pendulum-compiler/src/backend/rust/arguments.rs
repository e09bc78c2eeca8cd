//! The arguments that integrators follow along each step.

use crate::algebra::expr::Id;
use crate::backend::Analysis;
use crate::mechanics::arguments::{self, Arguments};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

impl Analysis<'_, '_> {
    /// Returns the switches and layers in the equations, limits and frictions, if there are
    /// equations.
    pub(super) fn arguments(&self) -> Option<Arguments> {
        let motion = self.motion.as_ref()?;
        let gaps = motion.constraints.limits.iter().map(|limit| limit.value);
        let roots = motion.accelerations.iter().copied().chain(gaps).chain(self.grips());
        Some(arguments::arguments(&self.graph, &roots.collect::<Vec<Id>>()))
    }

    /// Returns `arguments` if there are switches or layers.
    pub(super) fn arguments_method(&self, arguments: &Arguments) -> Option<TokenStream> {
        let roots = [&arguments.switches[..], &arguments.layers].concat();
        if roots.is_empty() {
            return None;
        }
        let (scalar, state) = (self.scalar(), self.state());
        let all = self.body(&schedule::program(&arguments.graph, &roots));
        let copied = self.copied(&all, roots.len());
        Some(quote! {
            fn arguments(&self, #state, values: &mut [#scalar]) { #copied }
        })
    }
}
