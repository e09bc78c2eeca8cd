//! The accelerations in stages, for callers that store values which do not change between
//! evaluations.

use crate::backend::Analysis;
use crate::schedule::{Place, Stage};
use proc_macro2::TokenStream;
use quote::quote;

impl Analysis<'_, '_> {
    /// Returns the accelerations in four parts: values that depend on parameters, on time and
    /// inputs, on the position, and on velocities.
    pub(super) fn staged(&self) -> TokenStream {
        let (krate, scalar, count, name) = (&self.krate, self.scalar(), self.count(), &self.name());
        let missing = || (quote!(::core::unimplemented!()), 0);
        let (mut at_time, mut at_position, mut rest) = (missing(), missing(), missing().0);
        if let Some(program) = &self.accelerations {
            let [prepared, time, position] =
                [Stage::Parameters, Stage::Time, Stage::Position].map(|stage| program.kept(stage));
            let known: [(&str, &[Place]); 3] =
                [("prepared", &prepared), ("at_time", &time), ("at_position", &position)];
            at_time = (self.body_after(program, &time, &[]), time.len());
            at_position = (self.body_after(program, &position, &known[..2]), position.len());
            rest = self.body_after(program, &program.results, &known);
        }
        let ((at_time, times), (at_position, positions)) = (at_time, at_position);
        let system = quote!(#krate::system::System<#count>);
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #krate::system::Staged<#count> for #name<#scalar> {
                type AtTime = [#scalar; #times];
                type AtPosition = [#scalar; #positions];

                #[inline(always)]
                fn at_time(t: #scalar, inputs: &<Self as #system>::Inputs) -> [#scalar; #times] { #at_time }

                #[inline(always)]
                fn at_position(
                    &self, prepared: &<Self as #system>::Prepared, at_time: &[#scalar; #times], t: #scalar, q: &[#scalar; #count],
                    inputs: &<Self as #system>::Inputs,
                ) -> [#scalar; #positions] {
                    #at_position
                }

                #[inline(always)]
                fn accelerations_staged(
                    &self, prepared: &<Self as #system>::Prepared, at_time: &[#scalar; #times], at_position: &[#scalar; #positions],
                    t: #scalar, q: &[#scalar; #count], v: &[#scalar; #count], inputs: &<Self as #system>::Inputs,
                ) -> [#scalar; #count] {
                    #rest
                }
            }
        }
    }
}
