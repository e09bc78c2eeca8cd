//! The Jacobians of the accelerations: as expressions if these are small, otherwise by dual
//! numbers.

use crate::algebra::expr::Id;
use crate::backend::Analysis;
use crate::mechanics::motion::Motion;
use crate::model::Quantity;
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl Analysis<'_, '_> {
    pub(super) fn jacobians(&self) -> TokenStream {
        let (krate, scalar, other, count) =
            (&self.krate, self.scalar(), self.other_scalar(), self.count());
        let name = &self.name();
        let [positions, velocities, parameters, controls] = match &self.motion {
            None => [(); 4].map(|()| quote!(::core::unimplemented!())),
            Some(Motion { jacobians: Some(columns), .. }) => self.written_jacobians(columns),
            Some(_) => self.dual_jacobians(),
        };
        let state = self.state();
        let controls = (self.model.driven < self.model.inputs.len()).then(|| {
            quote! {
                fn control_jacobian(&self, #state, columns: &mut [[#scalar; #count]]) { #controls }
            }
        });
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_mut, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #krate::system::Jacobians<#count> for #name<#scalar> {
                type Over<#other: #krate::scalar::Real> = #name<#other>;

                fn over<#other: #krate::scalar::Real>(&self, map: impl ::core::ops::FnMut(#scalar) -> #other) -> #name<#other> {
                    <Self as #krate::system::System<#count>>::map(self, map)
                }

                #[inline(always)]
                fn position_jacobian(&self, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #positions }

                #[inline(always)]
                fn velocity_jacobian(&self, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #velocities }

                fn parameter_jacobian(&self, #state, columns: &mut [[#scalar; #count]]) { #parameters }

                #controls
            }
        }
    }

    /// Returns the Jacobians as expressions.
    fn written_jacobians(&self, columns: &[Vec<Vec<Id>>; 4]) -> [TokenStream; 4] {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let size = count * count;
        let [positions, velocities, parameters, controls] = columns
            .each_ref()
            .map(|own| self.body(&schedule::of_derivatives(&self.graph, &own.concat())));
        let matrix = |entries: TokenStream| {
            quote! {
                let entries: [#scalar; #size] = #entries;
                #krate::__private::SMatrix::<#scalar, #count, #count>::from_column_slice(&entries)
            }
        };
        let listed = |entries: TokenStream, quantities: &[Quantity]| {
            let length = count * quantities.iter().map(Quantity::count).sum::<usize>();
            quote! {
                let entries: [#scalar; #length] = #entries;
                let all = #krate::__private::columns::<#scalar, #count>(&entries);
                for k in 0..all.len() {
                    if k < columns.len() {
                        columns[k] = all[k];
                    }
                }
            }
        };
        let parameters = listed(parameters, &self.model.parameters);
        let controls = listed(controls, &self.model.inputs[self.model.driven..]);
        [matrix(positions), matrix(velocities), parameters, controls]
    }

    /// Returns the Jacobians by dual numbers, with an evaluation of the accelerations for each
    /// column.
    fn dual_jacobians(&self) -> [TokenStream; 4] {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let (dual, name) = (quote!(#krate::scalar::Dual::<#scalar>), &self.name());
        let map = quote!(<Self as #krate::system::System<#count>>::map);
        let accelerations = quote!(<#name<#dual> as #krate::system::System<#count>>::accelerations);
        let at = quote!(#krate::system::At { t, q: &q, v: &v, inputs: &inputs });
        let inputs = (0..self.model.inputs.len()).map(Literal::usize_unsuffixed);
        let lifted = quote! {
            let inputs = (#(inputs.#inputs.map(#dual::constant),)*);
            let (mut q, mut v) = (q.map(#dual::constant), v.map(#dual::constant));
            let t = #dual::constant(t);
        };
        let matrix = |variable: TokenStream| {
            quote! {
                let system = #map(self, #dual::constant);
                #lifted
                let mut columns = [[#scalar::from_f64(0.0); #count]; #count];
                for k in 0..#count {
                    #variable[k].derivative = #scalar::from_f64(1.0);
                    columns[k] = #accelerations(&system, #at).map(|acceleration| acceleration.derivative);
                    #variable[k].derivative = #scalar::from_f64(0.0);
                }
                #krate::__private::SMatrix::<#scalar, #count, #count>::from_fn(|row, column| columns[column][row])
            }
        };
        let parameters = quote! {
            #lifted
            for k in 0..columns.len() {
                let mut index = 0usize;
                let system = #map(self, |parameter| {
                    let lifted = if index == k { #dual::variable(parameter) } else { #dual::constant(parameter) };
                    index += 1;
                    lifted
                });
                columns[k] = #accelerations(&system, #at).map(|acceleration| acceleration.derivative);
            }
        };
        let inputs = self.model.inputs.iter().enumerate().skip(self.model.driven);
        let components = inputs.flat_map(|(input, quantity)| {
            (0..quantity.count())
                .map(move |component| (Literal::usize_unsuffixed(input), component))
        });
        let components = components.enumerate().map(|(k, (input, component))| {
            quote! {
                if #k < columns.len() {
                    inputs.#input.position[#component].derivative = #scalar::from_f64(1.0);
                    columns[#k] = #accelerations(&system, #at).map(|acceleration| acceleration.derivative);
                    inputs.#input.position[#component].derivative = #scalar::from_f64(0.0);
                }
            }
        });
        let controls = quote! {
            let system = #map(self, #dual::constant);
            #lifted
            let mut inputs = inputs;
            #(#components)*
        };
        [matrix(quote!(q)), matrix(quote!(v)), parameters, controls]
    }
}
