//! Rust code for a derived block: the struct, its constructor and the implementations of the
//! runtime's traits.

mod arguments;
mod clock;
mod constraints;
pub(crate) mod documentation;
mod facts;
mod jacobian;
pub(crate) mod jet;
mod operation;
mod outputs;
mod program;
mod staged;
mod start;
mod structure;
mod system;
mod tables;
mod unmentioned;

use crate::algebra::expr::Id;
use crate::backend::{Analysis, unlocated};
use crate::mechanics::lower::Friction;
use crate::model::Quantity;
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// The names that the generated code binds, without those of the block and those that begin with
/// `__`.
#[rustfmt::skip]
const OWN: &[&str] = &[
    "acceleration", "all", "at_position", "at_time", "both", "column", "columns", "controller", "drive", "entries", "first", "index", "inputs",
    "k", "law", "lifted", "map", "order", "p", "parameter", "path", "period", "places", "position", "prepared", "q", "row", "system", "t", "target", "time", "unit", "v", "value",
    "values", "velocity", "widths", "work", "written",
];

// After a mistake, when there are no equations, all bodies are `unimplemented!()`, so that there
// are no further errors.
impl Analysis<'_, '_> {
    /// Returns all items of a block.
    pub(crate) fn items(mut self) -> TokenStream {
        let structure = self.structure();
        let constructor = self.constructor();
        let system = self.system();
        let split = self.split_energy();
        let marker = self.marker();
        let staged = self.staged();
        let jacobians = self.jacobians();
        let jets = self.jets();
        let (open, tables) = (self.open_names(), self.tables());
        let unmentioned = self.unmentioned();
        let outputs = self.output_methods();
        let (output_trait, sampled_outputs) = self.output_trait();
        let (start, setters) = self.start();
        let conditions = self.model.block.conditions();
        quote! {
            #structure
            #(#conditions)*
            #[allow(deprecated)]
            const _: () = {
                #open #tables
                #constructor #setters #outputs #sampled_outputs #system #split #staged #marker #jacobians #jets #unmentioned
            };
            #start
            #output_trait
        }
    }

    /// Returns empty functions with the names that the generated code binds.
    ///
    /// A constant or a unit struct with such a name in the user's scope would turn the binding into
    /// a pattern. The function hides the constant or struct, and a binding may shadow a function.
    fn open_names(&self) -> TokenStream {
        let own = OWN.iter().map(|name| Ident::new(name, Span::call_site()));
        let declared = self.model.parameters.iter().chain(&self.model.inputs).map(|quantity| {
            let mut name = quantity.name.clone();
            name.set_span(name.span().located_at(Span::call_site()));
            name
        });
        let names: BTreeMap<String, Ident> =
            own.chain(declared).map(|name| (name.to_string(), name)).collect();
        let names = names.values();
        quote!(#(#[allow(dead_code, non_snake_case)] fn #names() {})*)
    }

    /// Returns the name of the struct for uses other than its declaration. Its span makes editors
    /// show the struct only once.
    pub(crate) fn name(&self) -> Ident {
        unlocated(&self.model.block.name)
    }

    /// Returns the type parameter of the scalar, which is another letter if the struct has the
    /// usual name `T`.
    pub(crate) fn scalar(&self) -> Ident {
        format_ident!("{}", if self.model.block.name == "T" { "S" } else { "T" })
    }

    /// Returns the type parameter of a second scalar, which is another letter if the struct has the
    /// usual name `U`.
    pub(crate) fn other_scalar(&self) -> Ident {
        format_ident!("{}", if self.model.block.name == "U" { "V" } else { "U" })
    }

    /// Returns the state with the samples of the inputs, as a pattern and as an expression.
    fn at(&self) -> TokenStream {
        let krate = &self.krate;
        quote!(#krate::system::At { t, q, v, inputs })
    }

    /// Returns the argument of a function of the state.
    fn state(&self) -> TokenStream {
        let (krate, at, scalar, count) = (&self.krate, self.at(), self.scalar(), self.count());
        quote!(#at: #krate::system::At<'_, #scalar, Self::Inputs, #count>)
    }

    /// Returns statements that copy an array into the slice `values`, as far as it reaches.
    fn copied(&self, all: &TokenStream, length: usize) -> TokenStream {
        let scalar = self.scalar();
        quote! {
            let all: [#scalar; #length] = #all;
            for k in 0..#length {
                if k < values.len() {
                    values[k] = all[k];
                }
            }
        }
    }

    /// Returns the magnitudes of all frictions with their shares.
    fn grips(&self) -> impl Iterator<Item = Id> {
        self.energies.frictions.iter().flat_map(Friction::magnitudes)
    }

    pub(crate) fn count(&self) -> usize {
        self.model.coordinates.iter().map(Quantity::count).sum()
    }
}

/// Returns a generated name that cannot collide with a name of the user.
pub(crate) fn local(prefix: &str, index: usize) -> Ident {
    Ident::new(&format!("__{prefix}{index}"), Span::mixed_site())
}
