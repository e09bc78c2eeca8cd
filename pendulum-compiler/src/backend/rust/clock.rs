//! The limit on steps that results from functions of time in the equations.

use crate::algebra::expr::Id;
use crate::backend::Analysis;
use crate::mechanics::clock;
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

impl Analysis<'_, '_> {
    /// Returns `longest_step` if the accelerations, the frictions or the gaps of limits contain a
    /// function of time.
    pub(super) fn longest_step(&self) -> Option<TokenStream> {
        let motion = self.motion.as_ref()?;
        let gaps: Vec<Id> = motion.constraints.limits.iter().map(|limit| limit.value).collect();
        let frictions = motion.constraints.frictions.iter().map(|friction| friction.rate);
        let rates = motion.states.iter().map(|state| state[0]);
        let forces = motion.accelerations.iter().copied().chain(rates).chain(frictions);
        let forces: Vec<Id> = forces.chain(self.grips()).collect();
        let (graph, features) = clock::features(&self.graph, &forces, &gaps);
        if features.is_empty() {
            return None;
        }
        let (krate, scalar, count) = (&self.krate, self.scalar(), features.len());
        let roots: Vec<Id> =
            features.iter().flat_map(|feature| [feature.rate, feature.since]).collect();
        let values = self.body(&schedule::program(&graph, &roots));
        let numbers = 2 * count;
        Some(quote! {
            fn longest_step(&self, t: #scalar, widths: #scalar) -> #scalar {
                let all: [#scalar; #numbers] = #values;
                #krate::__private::longest_step(&all, widths)
            }
        })
    }
}
