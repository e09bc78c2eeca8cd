//! The arguments that integrators follow along each step.

use crate::algebra::expr::Id;
use crate::algebra::spline::Spline;
use crate::backend::Analysis;
use crate::mechanics::arguments::{self, Arguments};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

impl Analysis<'_, '_> {
    /// Returns the switches and layers in the equations, limits and frictions, if there are
    /// equations.
    pub(super) fn arguments(&self) -> Option<Arguments> {
        let roots = self.argument_roots()?;
        let digits = self.model.tables.iter().map(|(&index, own)| {
            let written = own.written.as_ref();
            (index, written.map_or(Spline::MOST_DIGITS, |(_, spline)| spline.digits()))
        });
        let digits = digits.collect();
        Some(arguments::arguments(&self.graph, &roots, &digits))
    }

    /// Returns the accelerations, gaps and magnitudes of frictions, if there are equations.
    pub(super) fn argument_roots(&self) -> Option<Vec<Id>> {
        let motion = self.motion.as_ref()?;
        let gaps = motion.constraints.limits.iter().map(|limit| limit.value);
        let rates = motion.states.iter().map(|state| state[0]);
        let roots = motion.accelerations.iter().copied().chain(rates).chain(gaps);
        Some(roots.chain(self.grips()).collect())
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
