//! The pieces and knots of tables, and the arguments that they refuse.

use super::local;
use crate::algebra::expr::{Id, Node};
use crate::algebra::functions::Function;
use crate::backend::Analysis;
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

impl Analysis<'_, '_> {
    /// Returns the numbers of all tables as statics.
    pub(super) fn tables(&self) -> TokenStream {
        let number = |value: &f64| {
            let size = Literal::f64_unsuffixed(value.abs());
            if value.is_sign_negative() { quote!(-#size) } else { quote!(#size) }
        };
        let items = self.model.tables.iter().enumerate().map(|(index, table)| {
            let names = [local("rows", index), local("knots", index)];
            let [pieces, points] = names;
            let rows = table.spline.rows.iter().map(|row| {
                let numbers = row.iter().map(|value| {
                    if value.is_nan() { quote!(::core::f64::NAN) } else { number(value) }
                });
                quote!([#(#numbers),*])
            });
            let knots = table.spline.knots.iter().map(number);
            let counts = [table.spline.rows.len(), table.spline.knots.len()];
            let [count, bounds] = counts;
            quote! {
                #[allow(dead_code, non_upper_case_globals)]
                static #pieces: [[f64; 5]; #count] = [#(#rows),*];
                #[allow(dead_code, non_upper_case_globals)]
                static #points: [f64; #bounds] = [#(#knots),*];
            }
        });
        items.collect()
    }

    /// Returns `__tables` if the equations contain tables that are refused beyond their points.
    pub(super) fn tables_method(&self) -> Option<TokenStream> {
        let roots = self.argument_roots()?;
        let refused = |&id: &Id| match *self.graph.node(id) {
            Node::Call(Function::Table(index, _), argument) => {
                let table = &self.model.tables[usize::from(index)];
                (!table.statement.linear).then_some((index, argument))
            }
            _ => None,
        };
        let refused: BTreeSet<(u8, Id)> =
            self.graph.reachable(&roots).iter().filter_map(refused).collect();
        if refused.is_empty() {
            return None;
        }
        let arguments: Vec<Id> = refused.iter().map(|&(_, argument)| argument).collect();
        let all = self.body(&schedule::program(&self.graph, &arguments));
        let (scalar, state, count) = (self.scalar(), self.state(), arguments.len());
        let visits = refused.iter().enumerate().map(|(place, &(index, _))| {
            let table = &self.model.tables[usize::from(index)];
            let (name, points) = (table.statement.name.to_string(), local("rows", index.into()));
            let last = table.spline.rows.len().saturating_sub(1);
            quote!(visit(#name, [#points[0][0], #points[#last][0]], all[#place]);)
        });
        Some(quote! {
            fn __tables(&self, #state, visit: &mut dyn FnMut(&'static str, [f64; 2], #scalar)) {
                let all: [#scalar; #count] = #all;
                #(#visits)*
            }
        })
    }
}
