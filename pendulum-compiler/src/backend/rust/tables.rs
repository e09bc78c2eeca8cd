//! The pieces and knots of tables, and the arguments that they refuse.

use super::facts::metres;
use super::local;
use crate::algebra::expr::{Id, Node};
use crate::algebra::functions::{Function, GIVEN};
use crate::backend::Analysis;
use crate::model::Table;
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeSet;

impl<'a> Analysis<'a, '_> {
    /// Returns the numbers of all tables as statics.
    pub(super) fn tables(&self) -> TokenStream {
        let number = |value: &f64| {
            let size = Literal::f64_unsuffixed(value.abs());
            if value.is_sign_negative() { quote!(-#size) } else { quote!(#size) }
        };
        let written = |(&index, table): (&u8, &'a Table)| {
            table.written.as_ref().map(|(_, spline)| (usize::from(index), spline))
        };
        let items = self.model.tables.iter().filter_map(written).map(|(index, spline)| {
            let names = [local("rows", index), local("knots", index)];
            let [pieces, points] = names;
            let rows = spline.rows.iter().map(|row| {
                let numbers = row.iter().map(|value| {
                    if value.is_nan() { quote!(::core::f64::NAN) } else { number(value) }
                });
                quote!([#(#numbers),*])
            });
            let knots = spline.knots.iter().map(number);
            let counts = [spline.rows.len(), spline.knots.len()];
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

    /// Returns the `rows` or the `knots` of a table.
    pub(super) fn part_of_table(&self, index: u8, part: &str) -> TokenStream {
        let Table { name, written, .. } = &self.model.tables[&index];
        let own = local(part, index.into());
        let (krate, function) = (&self.krate, format_ident!("{part}_of"));
        if written.is_some() {
            quote!(&#own)
        } else {
            quote!(#krate::__private::#function(&self.#name))
        }
    }

    /// Returns `__given_tables` and `__tables_mut` if there are tables among the parameters.
    pub(super) fn given_tables(&self) -> Option<TokenStream> {
        let given = || self.model.tables.range(GIVEN..).map(|(_, own)| own);
        let names: Vec<&Ident> = given().map(|own| own.name).collect();
        // A power that is not known refuses the change of size before it is used.
        let powers = given().map(|own| own.dimensions.map(|unit| metres(unit).unwrap_or(0.0)));
        let powers = powers.map(|[argument, value]| quote!([#argument, #value]));
        let krate = &self.krate;
        (!names.is_empty()).then(|| {
            quote! {
                fn __given_tables(&self, visit: &mut dyn FnMut(&#krate::system::Table)) {
                    #(visit(&self.#names);)*
                }

                fn __tables_mut(
                    &mut self,
                    visit: &mut dyn FnMut(&mut #krate::system::Table, [f64; 2]),
                ) {
                    #(visit(&mut self.#names, #powers);)*
                }
            }
        })
    }

    /// Returns `__tables` if the equations contain tables that are refused beyond their points.
    pub(super) fn tables_method(&self) -> Option<TokenStream> {
        let roots = self.argument_roots()?;
        let refused = |&id: &Id| match *self.graph.node(id) {
            Node::Call(Function::Table(index, _), argument) => {
                let written = self.model.tables[&index].written.as_ref();
                written.is_none_or(|(own, _)| !own.linear).then_some((index, argument))
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
        let (krate, scalar) = (&self.krate, self.scalar());
        let (state, count) = (self.state(), arguments.len());
        let visits = refused.iter().enumerate().map(|(place, &(index, _))| {
            let (name, rows) =
                (self.model.tables[&index].name.to_string(), self.part_of_table(index, "rows"));
            quote! {
                if let ::core::option::Option::Some(ends) = #krate::__private::ends(#rows) {
                    visit(#name, ends, all[#place]);
                }
            }
        });
        Some(quote! {
            fn __tables(&self, #state, visit: &mut dyn FnMut(&'static str, [f64; 2], #scalar)) {
                let all: [#scalar; #count] = #all;
                #(#visits)*
            }
        })
    }
}
