//! The accelerations, energies, momenta and forces: `System`, and the traits of systems whose
//! energy splits or whose forces do not depend on velocities.

use crate::algebra::diff;
use crate::algebra::expr::{Dependencies, Id, Symbol};
use crate::backend::Analysis;
use crate::mechanics::motion::Motion;
use crate::model::{Element, Quantity};
use crate::schedule::{self, Stage};
use proc_macro2::TokenStream;
use quote::quote;

/// The limit on the operations that are written twice: of accelerations, both at once and in stages,
/// and of rates of momenta, both as functions of velocities and of momenta. The values of longer
/// programs fit in no registers anyway.
const MOST_REPEATED: usize = 2000;

impl Analysis<'_, '_> {
    pub(super) fn system(&mut self) -> TokenStream {
        let hamilton = self.hamilton();
        let (krate, scalar, other, count) =
            (&self.krate, self.scalar(), self.other_scalar(), self.count());
        let (name, at) = (&self.name(), self.at());
        let dimensions = self.model.inputs.iter().map(Quantity::count);
        let arguments = self.arguments();
        let facts = self.facts(arguments.as_ref());
        let mapped = self.model.parameters.iter().map(|quantity| {
            let field = quantity.name;
            if quantity.is_body() || quantity.length().is_some() {
                quote!(#field: self.#field.map(&mut map))
            } else if quantity.element == Element::Table {
                quote!(#field: ::core::clone::Clone::clone(&self.#field))
            } else {
                quote!(#field: map(self.#field))
            }
        });
        let empty = self.has_no_scalar().then(|| quote!(__scalar: ::core::marker::PhantomData));
        let vector = |pick: fn(&Motion) -> Vec<Id>| self.output(|motion| Some(pick(motion)));
        let (prepare, accelerations, prepared) = self.accelerations();
        let momenta = vector(|motion| motion.momenta.clone());
        let forces = vector(|motion| motion.forces.clone());
        let same =
            self.motion.as_ref().is_some_and(|motion| motion.momentum_rates == motion.forces);
        let momentum_rates = if same {
            Some(quote!(<Self as #krate::system::System<#count>>::forces(self, #at)))
        } else {
            vector(|motion| motion.momentum_rates.clone())
        };
        let energy = vector(|motion| vec![motion.energy]);
        let power = vector(|motion| vec![motion.power]);
        let (longest_step, rates) = (self.longest_step(), self.state_rates());
        let arguments = arguments.and_then(|own| self.arguments_method(&own));
        let (tables, given_tables) = (self.tables_method(), self.given_tables());
        let (output, constraints) = (self.output_by_index(), self.constraint_methods());
        let velocities = self.output(|motion| motion.velocities.clone());
        let velocities = velocities.unwrap_or_else(
            || quote!(#krate::__private::newton::<#count, Self>(self, t, q, p, inputs)),
        );
        let matrix = self.mass_matrix();
        let conserved = self.output(|motion| {
            Some(motion.conserved.iter().map(|conserved| conserved.value).collect())
        });
        let length = self.motion.as_ref().map_or(0, |motion| motion.conserved.len());
        let conserved = self.copied(&quote!(#conserved), length);
        let state = self.state();
        let system = quote!(#krate::system::System<#count>);
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_mut, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #krate::system::System<#count> for #name<#scalar> {
                type Scalar = #scalar;
                type Inputs = (#(#krate::motion::Sample<#scalar, #dimensions>,)*);
                type With<#other: #krate::scalar::Real> = #name<#other>;
                type Prepared = [#scalar; #prepared];

                const FACTS: #krate::system::Facts = #facts;

                fn map<#other: #krate::scalar::Real>(&self, mut map: impl ::core::ops::FnMut(#scalar) -> #other) -> #name<#other> {
                    Self::With::<#other> { #(#mapped,)* #empty }
                }

                #[inline]
                fn prepare(&self) -> [#scalar; #prepared] { #prepare }

                #[inline]
                fn accelerations_prepared(&self, prepared: &[#scalar; #prepared], #state) -> [#scalar; #count] {
                    #accelerations
                }

                #[inline]
                fn accelerations(&self, #state) -> [#scalar; #count] {
                    <Self as #system>::accelerations_prepared(self, &<Self as #system>::prepare(self), #at)
                }

                #[inline]
                fn energy(&self, #state) -> #scalar { let [value] = #energy; value }

                #[inline]
                fn power(&self, #state) -> #scalar { let [value] = #power; value }

                #[inline]
                fn momenta(&self, #state) -> [#scalar; #count] { #momenta }

                #[inline]
                fn velocities(&self, t: #scalar, q: &[#scalar; #count], p: &[#scalar; #count], inputs: &Self::Inputs) -> [#scalar; #count] {
                    #velocities
                }

                #[inline]
                fn mass_matrix(&self, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #matrix }

                #[inline]
                fn forces(&self, #state) -> [#scalar; #count] { #forces }

                fn conserved(&self, #state, values: &mut [#scalar]) { #conserved }

                #[inline]
                fn momentum_rates(&self, #state) -> [#scalar; #count] { #momentum_rates }

                #hamilton

                #rates

                #longest_step

                #arguments #tables #given_tables

                #output

                #constraints
            }
        }
    }

    /// Returns `state_rates` if there are states.
    fn state_rates(&self) -> Option<TokenStream> {
        let motion = self.motion.as_ref().filter(|motion| !motion.states.is_empty())?;
        let (scalar, count, state) = (self.scalar(), self.count(), self.state());
        let first = count - motion.states.len();
        let roots: Vec<Id> = [0, 1]
            .into_iter()
            .flat_map(|k| motion.states.iter().map(move |state| state[k]))
            .collect();
        let (length, values) = (roots.len(), self.roots(&roots));
        let states = motion.states.len();
        Some(quote! {
            fn state_rates(&self, #state, accelerations: &[#scalar; #count]) -> [[#scalar; #count]; 2] {
                let all: [#scalar; #length] = #values;
                let mut rates = [*v, *accelerations];
                for k in 0..#states {
                    rates[0][#first + k] = all[k];
                    rates[1][#first + k] = all[#states + k];
                }
                rates
            }
        })
    }

    pub(super) fn split_energy(&self) -> Option<TokenStream> {
        if self.motion.as_ref().is_some_and(|motion| motion.potential.is_none()) {
            return None;
        }
        let kinetic = self.output(|motion| motion.kinetic.map(|id| vec![id]));
        let potential = self.output(|motion| motion.potential.map(|id| vec![id]));
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let name = &self.name();
        let state = self.state();
        Some(quote! {
            #[automatically_derived]
            #[allow(unused_variables, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #krate::system::SplitEnergy<#count> for #name<#scalar> {
                #[inline]
                fn kinetic_energy(&self, #state) -> #scalar { let [value] = #kinetic; value }

                #[inline]
                fn potential_energy(&self, #state) -> #scalar { let [value] = #potential; value }
            }
        })
    }

    pub(super) fn marker(&self) -> Option<TokenStream> {
        let (krate, scalar, count, name) = (&self.krate, self.scalar(), self.count(), &self.name());
        let marker = match &self.motion {
            Some(motion) if motion.holonomic => quote!(Holonomic),
            Some(motion) if !motion.velocity_free => return None,
            _ => quote!(VelocityFree),
        };
        Some(quote! {
            #[automatically_derived]
            impl<#scalar: #krate::scalar::Real> #krate::system::#marker<#count> for #name<#scalar> {}
        })
    }

    fn mass_matrix(&self) -> TokenStream {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let flat = self.output(|motion| Some(motion.mass_matrix.concat()));
        if self.motion.is_none() {
            return quote!(#flat);
        }
        let size = count * count;
        quote! {
            let entries: [#scalar; #size] = #flat;
            #krate::__private::SMatrix::<#scalar, #count, #count>::from_row_slice(&entries)
        }
    }

    /// Returns the accelerations in two parts, values that depend only on parameters and the
    /// remaining operations, and the number of values passed between the parts.
    fn accelerations(&self) -> (TokenStream, TokenStream, usize) {
        let Some(program) = &self.accelerations else {
            return (quote!(::core::unimplemented!()), quote!(::core::unimplemented!()), 0);
        };
        let prepared = program.kept(Stage::Parameters);
        let prepare = self.body_after(program, &prepared, &[]);
        let accelerations = if MOST_REPEATED < program.ops.len() {
            let (krate, count) = (&self.krate, self.count());
            let staged = quote!(<Self as #krate::system::Staged<#count>>);
            quote! {
                let at_time = #staged::at_time(t, inputs);
                let at_position = #staged::at_position(self, prepared, &at_time, t, q, inputs);
                #staged::accelerations_staged(self, prepared, &at_time, &at_position, t, q, v, inputs)
            }
        } else {
            self.body_after(program, &program.results, &[("prepared", &prepared)])
        };
        (prepare, accelerations, prepared.len())
    }

    /// Returns velocities and momentum rates as functions of the momenta, with shared operations
    /// computed once; `None` if velocities are found by iteration, if the rates do not depend on
    /// velocities, or if they are long.
    fn hamilton(&mut self) -> Option<TokenStream> {
        let (mut roots, rates) = {
            let motion = self.motion.as_ref()?;
            (motion.velocities.clone()?, motion.momentum_rates.clone())
        };
        let moving = |&rate: &Id| self.graph.dependencies(rate).any(Dependencies::VELOCITY);
        if !rates.iter().any(moving)
            || MOST_REPEATED < schedule::program(&self.graph, &rates).ops.len()
        {
            // Too little is shared for a second copy of the rates.
            return None;
        }
        let velocities: Vec<Id> =
            roots.iter().map(|&velocity| self.graph.closed(velocity)).collect();
        for rate in rates {
            let value = |symbol| match symbol {
                Symbol::Velocity(index) => velocities.get(index).copied(),
                _ => None,
            };
            roots.push(diff::substitute(&mut self.graph, rate, value));
        }
        let program = schedule::program(&self.graph, &roots);
        let both = self.body(&program);
        let (scalar, count) = (self.scalar(), self.count());
        let (all, parts) = (2 * count, 0..count);
        let (first, second) = (parts.clone(), parts.map(|index| index + count));
        Some(quote! {
            #[inline]
            fn hamilton(
                &self, t: #scalar, q: &[#scalar; #count], p: &[#scalar; #count], inputs: &Self::Inputs,
            ) -> ([#scalar; #count], [#scalar; #count]) {
                let both: [#scalar; #all] = #both;
                ([#(both[#first]),*], [#(both[#second]),*])
            }
        })
    }
}
