//! Taylor recurrences: a statement for each operation of the equations, the same at every order.
//!
//! A value used only by sums and constants is a number at the current order; a value used by a
//! product or a function is stored as a series. If coordinates are coupled by a mass matrix that
//! depends on the state, M q̈ = f is solved order by order: M\[0\] q̈\[k\] = f\[k\] − Σ M\[j\]
//! q̈\[k−j\] over 1 ≤ j ≤ k, with M\[0\] factored once. The loops over the order are part of the
//! runtime.

mod function;
mod momentum_form;
mod sine_oscillator;
mod writer;

use crate::algebra::expr::{Dependencies, Graph, Id};
use crate::backend::Analysis;
use crate::mechanics::articulated::Unsolved;
use crate::mechanics::motion::Motion;
use crate::mechanics::solve;
use crate::model::Quantity;
use crate::schedule::{self, Place, Program};
use momentum_form::Plan;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use sine_oscillator::oscillator_operations;
use std::collections::BTreeMap;
use writer::{Recurrences, Writer};

/// The largest number of convolutions, in halves, of a system whose orders are unrolled, and the
/// largest number of a system whose sums are inlined loops.
const MOST_UNROLLED: usize = 10;
const MOST_LOOPED: usize = 80;

/// The largest number of convolutions, in halves, of a system for which higher orders are
/// efficient, because the remaining work of a step is at least as expensive.
const MOST_CHEAP: usize = 4;

/// The equations as a program. For each block of the mass matrix, its rows and the results of the
/// program that belong to it.
pub(crate) struct Equations {
    pub(crate) program: Program,
    pub(crate) blocks: Vec<Block>,
}

/// Coordinates coupled by the mass matrix.
pub(crate) enum Block {
    /// The accelerations are results of the program.
    Explicit(Vec<(usize, Place)>),
    /// For each row, the nonzero entries of the lower triangle, and the force.
    Coupled { rows: Vec<usize>, masses: Vec<Vec<Option<Place>>>, forces: Vec<Place> },
}

/// Returns the equations that the jets of a motion compute.
pub(crate) fn equations(graph: &Graph, motion: &Motion) -> Equations {
    let blocks = solve::blocks(&motion.mass_matrix);
    let constrained = !motion.constraints.held.is_empty();
    let moving = |rows: &[usize]| {
        let dependencies = |&row: &usize| {
            rows.iter().map(move |&column| graph.dependencies(motion.mass_matrix[row][column]))
        };
        !constrained
            && 1 < rows.len()
            && rows
                .iter()
                .flat_map(dependencies)
                .any(|dependencies| dependencies.any(Dependencies::STATE))
    };
    let mut roots: Vec<Id> = Vec::new();
    for rows in &blocks {
        if moving(rows) {
            for (i, &row) in rows.iter().enumerate() {
                let entries = rows[..=i].iter().map(|&column| motion.mass_matrix[row][column]);
                roots.extend(entries.filter(|&entry| entry != Graph::ZERO));
            }
            roots.extend(rows.iter().map(|&row| motion.forces[row]));
        } else {
            roots.extend(rows.iter().map(|&row| motion.accelerations[row]));
        }
    }
    let program = schedule::of_series(graph, &roots);
    let mut results = program.results.iter().copied();
    let mut next = || results.next().unwrap_or(Place(0));
    let blocks = blocks
        .into_iter()
        .map(|rows| {
            if !moving(&rows) {
                return Block::Explicit(rows.into_iter().map(|row| (row, next())).collect());
            }
            let mut masses = Vec::new();
            for (i, &row) in rows.iter().enumerate() {
                let entry = |&column: &usize| {
                    (motion.mass_matrix[row][column] != Graph::ZERO).then(&mut next)
                };
                masses.push(rows[..=i].iter().map(entry).collect());
            }
            let forces = rows.iter().map(|_| next()).collect();
            Block::Coupled { rows, masses, forces }
        })
        .collect();
    Equations { program, blocks }
}

impl Analysis<'_, '_> {
    /// Returns the implementation of `Jets`.
    pub(crate) fn jets(&self) -> TokenStream {
        let (krate, scalar, count, name) = (&self.krate, self.scalar(), self.count(), &self.name());
        let components: usize = self.model.inputs.iter().map(Quantity::count).sum();
        let unknown = quote!(::core::unimplemented!());
        let (kind, unrolling, per_digit, work, body) = match &self.motion {
            None => (quote!(()), format_ident!("Looped"), quote!(0.7), unknown.clone(), unknown),
            Some(motion) => self.recurrences(motion),
        };
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_mut, unused_parens, unused_imports, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #krate::jet::Jets<#count> for #name<#scalar> {
                type Work = #kind;
                type Drive = [#krate::jet::InputSeries<#scalar>; #components];
                type Unrolling = #krate::jet::#unrolling;
                const PER_DIGIT: ::core::primitive::f64 = #per_digit;

                fn work(&self) -> Self::Work { #work }

                fn drive() -> Self::Drive { [#krate::jet::InputSeries::zero(); #components] }

                #[inline(always)]
                fn coefficient<O: #krate::jet::Order>(
                    &self, order: O, path: &mut #krate::jet::Path<#scalar, #count>, drive: &Self::Drive, work: &mut Self::Work,
                ) {
                    use #krate::jet::series;
                    let k = order.index();
                    #body
                }
            }
        }
    }

    /// Returns the type of the work, the kind of loops over the order, the orders per digit, the
    /// expression for a new work and the statements for one order.
    fn recurrences(
        &self,
        motion: &Motion,
    ) -> (TokenStream, proc_macro2::Ident, TokenStream, TokenStream, TokenStream) {
        let Equations { program, blocks } = equations(&self.graph, motion);
        let solved = self.solved(&program, &blocks);
        let coupled = matches!(&blocks[..], [Block::Coupled { .. }]);
        let unsolved = motion
            .unsolved
            .as_ref()
            .filter(|_| coupled)
            .and_then(|unsolved| self.unsolved(motion, unsolved));
        let Recurrences { lines, kind, work, halves } = match unsolved {
            Some(unsolved) if 2 * unsolved.halves < solved.halves => unsolved,
            _ => solved,
        };
        let unrolling = match halves {
            0..=MOST_UNROLLED => "Unrolled",
            _ if halves <= MOST_LOOPED => "Looped",
            _ => "Called",
        };
        let unrolling = format_ident!("{unrolling}");
        let per_digit = if halves <= MOST_CHEAP { quote!(0.8) } else { quote!(0.7) };
        (kind, unrolling, per_digit, work, lines)
    }

    /// Returns the recurrences of accelerations. Coupled coordinates are solved in series with the
    /// mass matrix.
    fn solved(&self, program: &Program, blocks: &[Block]) -> Recurrences {
        let mut writer = Writer::new(self, program);
        let explicit = blocks.iter().filter_map(|block| match block {
            Block::Explicit(rows) => Some(rows),
            Block::Coupled { .. } => None,
        });
        let oscillators: BTreeMap<usize, _> = explicit
            .flatten()
            .filter_map(|&(row, place)| {
                oscillator_operations(program, &writer.parameter_only, row, place)
                    .map(|own| (row, own))
            })
            .collect();
        for place in 0..program.ops.len() {
            if !writer.parameter_only[place]
                && !oscillators.values().any(|own| own.contains(&Place(place)))
            {
                writer.operation(Place(place));
            }
        }
        let mut factors = Vec::new();
        for block in blocks {
            match block {
                Block::Explicit(rows) => {
                    for &(row, place) in rows {
                        if oscillators.contains_key(&row) {
                            writer.sine_oscillator(row, place);
                        } else {
                            let value = writer.value(place);
                            writer.lines.extend(quote!(path.a[#row][k] = #value;));
                        }
                    }
                }
                Block::Coupled { rows, masses, forces } => {
                    writer.coupled(factors.len(), rows, masses, forces);
                    factors.push(rows.len());
                }
            }
        }
        writer.finish(&factors)
    }

    /// Returns the recurrences of equations that are not solved, if they exist.
    fn unsolved(&self, motion: &Motion, unsolved: &Unsolved) -> Option<Recurrences> {
        let program = schedule::of_series(&self.graph, &momentum_form::roots(unsolved));
        let parameter_only = program.parameter_only();
        let plan = Plan::new(&program, &parameter_only, unsolved)?;
        let mut writer = Writer::new(self, &program);
        writer.unsolved(&plan, motion);
        Some(writer.finish(&[unsolved.equations.len()]))
    }
}
