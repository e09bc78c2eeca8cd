//! Constraints, limits and frictions: their methods of `System`, and their facts.

use super::documentation::{in_unit, section};
use crate::algebra::expr::{Graph, Id};
use crate::backend::Analysis;
use crate::mechanics::attitude;
use crate::mechanics::constraint::{Constraint, Constraints, MOST_FRICTIONS, MOST_LIMITS};
use crate::mechanics::lower::Friction;
use proc_macro2::TokenStream;
use quote::quote;

impl Analysis<'_, '_> {
    /// Returns the methods for the kinds of constraints, limits and frictions that exist.
    pub(super) fn constraint_methods(&self) -> TokenStream {
        let Some(motion) = &self.motion else { return TokenStream::new() };
        let Constraints { held, redundant, limits, frictions, .. } = &motion.constraints;
        let constraints = (!held.is_empty()).then(|| self.held_methods(&motion.constraints));
        let redundant = (!redundant.is_empty()).then(|| {
            let misfits = self.misfits(redundant);
            let state = self.state();
            let (scalar, count) = (self.scalar(), self.count());
            quote! {
                fn redundant_misfits(&self, #state) -> [[#scalar; #count]; 2] { #misfits }
            }
        });
        let limits = (!limits.is_empty()).then(|| self.limit_methods(limits));
        let frictions = (!frictions.is_empty()).then(|| self.friction_methods(frictions));
        quote!(#constraints #redundant #limits #frictions)
    }

    fn held_methods(&self, constraints: &Constraints) -> TokenStream {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let state = self.state();
        let misfits = self.misfits(&constraints.held);
        let scales = self.matrix(
            &[
                column(&constraints.held, |row| row.scales[0]),
                column(&constraints.held, |row| row.scales[1]),
            ],
            count,
        );
        let correction = self.padded(&constraints.correction, Graph::ZERO, count);
        let jacobian = self.gradients(&constraints.held, count);
        let reactions = self.padded(&constraints.multipliers, Graph::ZERO, count);
        let independence = self.padded(&constraints.independence, Graph::ONE, count);
        quote! {
            #[inline]
            fn misfits(&self, #state) -> [[#scalar; #count]; 2] { #misfits }

            #[inline]
            fn misfit_scales(&self, #state) -> [[#scalar; #count]; 2] { #scales }

            #[inline]
            fn correction(&self, #state, target: &[#scalar; #count]) -> [#scalar; #count] { #correction }

            fn constraint_jacobian(&self, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #jacobian }

            fn reactions(&self, #state) -> [#scalar; #count] { #reactions }

            #[inline]
            fn independence(&self, #state) -> [#scalar; #count] { #independence }
        }
    }

    fn limit_methods(&self, limits: &[Constraint]) -> TokenStream {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let state = self.state();
        let rows = [
            column(limits, |limit| limit.value),
            column(limits, |limit| limit.rate),
            column(limits, |limit| limit.drift),
        ];
        let gaps = self.matrix(&rows, MOST_LIMITS);
        let jacobian = self.gradients(limits, MOST_LIMITS);
        let restitutions: Vec<Id> =
            self.energies.limits.iter().map(|limit| limit.restitution).collect();
        let restitutions = self.padded(&restitutions, Graph::ZERO, MOST_LIMITS);
        quote! {
            #[inline]
            fn gaps(&self, #state) -> [[#scalar; #MOST_LIMITS]; 3] { #gaps }

            fn gap_jacobian(&self, #state) -> #krate::__private::SMatrix<#scalar, #MOST_LIMITS, #count> { #jacobian }

            fn restitutions(&self, #state) -> [#scalar; #MOST_LIMITS] { #restitutions }
        }
    }

    fn friction_methods(&self, frictions: &[Constraint]) -> TokenStream {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let state = self.state();
        let rows = [column(frictions, |row| row.rate), column(frictions, |row| row.drift)];
        let slips = self.matrix(&rows, MOST_FRICTIONS);
        let jacobian = self.gradients(frictions, MOST_FRICTIONS);
        let grips = [0, 1]
            .map(|k| self.energies.frictions.iter().map(|friction| friction.grips[k]).collect());
        let grips = self.matrix(&grips, MOST_FRICTIONS);
        let shared = |friction: &Friction| {
            friction.shares.iter().flatten().any(|&share| share != Graph::ZERO)
        };
        let shares = self.energies.frictions.iter().any(shared).then(|| {
            let [force, bound] = [0, 1].map(|k| {
                let rows = self.energies.frictions.iter().map(|own| own.shares[k].clone());
                self.rows(rows, MOST_FRICTIONS, MOST_LIMITS)
            });
            let matrix = quote!(#krate::__private::SMatrix<#scalar, #MOST_FRICTIONS, #MOST_LIMITS>);
            quote! {
                fn grip_shares(&self, #state) -> [#matrix; 2] { [#force, #bound] }
            }
        });
        quote! {
            #[inline]
            fn slips(&self, #state) -> [[#scalar; #MOST_FRICTIONS]; 2] { #slips }

            fn slip_jacobian(&self, #state) -> #krate::__private::SMatrix<#scalar, #MOST_FRICTIONS, #count> { #jacobian }

            #[inline]
            fn grips(&self, #state) -> [[#scalar; #MOST_FRICTIONS]; 2] { #grips }

            #shares
        }
    }

    /// Returns an array of `length` entries: `roots`, followed by `rest`.
    fn padded(&self, roots: &[Id], rest: Id, length: usize) -> TokenStream {
        let mut roots = roots.to_vec();
        roots.resize(length, rest);
        self.roots(&roots)
    }

    /// Returns rows of `count` entries.
    fn matrix(&self, rows: &[Vec<Id>], count: usize) -> TokenStream {
        let scalar = self.scalar();
        let mut all = Vec::new();
        for row in rows {
            let mut row = row.clone();
            row.resize(count, Graph::ZERO);
            all.extend(row);
        }
        let size = all.len();
        let flat = self.roots(&all);
        let rows = (0..rows.len()).map(|row| {
            let places = row * count..(row + 1) * count;
            quote!([#(all[#places]),*])
        });
        quote! {
            let all: [#scalar; #size] = #flat;
            [#(#rows),*]
        }
    }

    /// Returns the values and rates of constraints.
    fn misfits(&self, rows: &[Constraint]) -> TokenStream {
        let value = |row: &Constraint| if row.holonomic { row.value } else { Graph::ZERO };
        self.matrix(&[column(rows, value), column(rows, |row| row.rate)], self.count())
    }

    /// Returns the gradients as a matrix of `height` rows.
    fn gradients(&self, rows: &[Constraint], height: usize) -> TokenStream {
        self.rows(rows.iter().map(|row| row.gradient.clone()), height, self.count())
    }

    /// Returns a matrix of `height` rows and `width` columns, with zeros behind the given rows and
    /// their entries.
    fn rows(
        &self,
        rows: impl Iterator<Item = Vec<Id>>,
        height: usize,
        width: usize,
    ) -> TokenStream {
        let (krate, scalar) = (&self.krate, self.scalar());
        let mut all = Vec::new();
        for mut row in rows {
            row.resize(width, Graph::ZERO);
            all.extend(row);
        }
        all.resize(height * width, Graph::ZERO);
        let (flat, size) = (self.roots(&all), height * width);
        quote! {{
            let entries: [#scalar; #size] = #flat;
            #krate::__private::SMatrix::<#scalar, #height, #width>::from_row_slice(&entries)
        }}
    }

    /// Returns the constraints, the limits and the frictions as facts.
    pub(super) fn constraint_facts(&self) -> [Vec<TokenStream>; 3] {
        let krate = &self.krate;
        let Some(motion) = &self.motion else { return [const { Vec::new() }; 3] };
        let constraints = motion.constraints.rows(&self.energies).map(|(constraint, row)| {
            let row = match row {
                Ok(row) => row,
                Err(name) => {
                    let name = attitude::norm(name);
                    return quote!(#krate::system::Constraint::new(#name, "1", true));
                }
            };
            let [unit, reaction] = &self.units.constraints[row.statement];
            let (name, holonomic) = (&row.name, constraint.holonomic);
            let redundant =
                self.model.constraints[row.statement].redundant.then(|| quote!(.redundant()));
            quote! {
                #krate::system::Constraint::new(#name, #unit, #holonomic)
                    .with_reaction_unit(#reaction) #redundant
            }
        });
        let limits = self.energies.limits.iter().map(|row| {
            let (name, unit) = (&row.name, &self.units.limits[row.statement]);
            quote!(#krate::system::Limit::new(#name, #unit))
        });
        let frictions = self.energies.frictions.iter().map(|row| {
            let [unit, reaction] = &self.units.frictions[row.statement];
            let (name, components) = (&row.name, row.components);
            quote! {
                #krate::system::Friction::new(#name, #unit, #components)
                    .with_reaction_unit(#reaction)
            }
        });
        [constraints.collect(), limits.collect(), frictions.collect()]
    }

    /// Returns the lines about constraints, limits and frictions in the documentation of the struct.
    pub(super) fn constraint_documentation(&self) -> String {
        let Some(motion) = &self.motion else { return String::new() };
        let constraints =
            motion.constraints.rows(&self.energies).filter_map(|(constraint, row)| {
                let row = row.ok()?;
                let kind = if constraint.holonomic { "positions" } else { "velocities" };
                let [unit, of_reaction] = self.units.constraints[row.statement].each_ref();
                let reaction = if self.model.constraints[row.statement].redundant {
                    "redundant: checked, not solved".to_owned()
                } else {
                    format!("its multiplier{}", in_unit(of_reaction))
                };
                Some(format!("`{}` holds {kind}{}; {reaction}", row.name, in_unit(unit)))
            });
        let limits = self
            .energies
            .limits
            .iter()
            .map(|row| format!("`{}`{}", row.name, in_unit(&self.units.limits[row.statement])));
        let frictions = self.energies.frictions.iter().map(|row| {
            let [unit, of_force] = self.units.frictions[row.statement].each_ref();
            let (unit, of_force) = (in_unit(unit), in_unit(of_force));
            format!("`{}` acts against a rate{unit}; its force{of_force}", row.name)
        });
        let constraints = section("Constraints", constraints);
        constraints + &section("Limits", limits) + &section("Frictions", frictions)
    }
}

fn column(rows: &[Constraint], pick: impl Fn(&Constraint) -> Id) -> Vec<Id> {
    rows.iter().map(pick).collect()
}
