//! The start of a motion, whose coordinates and velocities are set by name.

use crate::backend::{Analysis, unlocated};
use crate::model::{Element, Quantity};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Analysis<'_, '_> {
    /// Returns the struct of starts, which is placed beside that of the system, and its methods.
    ///
    /// An output called `start` was there before and keeps its name.
    pub(super) fn start(&self) -> (TokenStream, TokenStream) {
        let block = self.model.block;
        let mut outputs = self.model.outputs.iter();
        if outputs.any(|output| output.declared.name == "start") {
            return (TokenStream::new(), TokenStream::new());
        }
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let (name, visibility, conditions) = (self.name(), &block.visibility, block.conditions());
        let own = unlocated(&format_ident!("{name}Start", span = block.name.span()));
        let text = format!("A start of a [`{name}`]: its coordinates and velocities.");
        // A program that begins with numbers of its own is not to be warned of dead code.
        let declaration = quote! {
            #(#conditions)*
            #[doc = #text]
            #[derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            )]
            #[allow(dead_code)]
            #visibility struct #own<#scalar = ::core::primitive::f64> {
                /// The coordinates.
                pub q: [#scalar; #count],
                /// The velocities.
                pub v: [#scalar; #count],
            }
        };
        let rotations = self.model.coordinates.iter();
        let rotations = rotations.filter(|own| own.element == Element::Rotation);
        let units = rotations.flat_map(|rotation| rotation.scalars().step_by(4));
        let setters = self.model.coordinates.iter().map(|coordinate| self.setter(coordinate));
        let methods = quote! {
            #[automatically_derived]
            #[allow(dead_code)]
            impl<#scalar: #krate::scalar::Real> #name<#scalar> {
                /// A start at rest with all coordinates zero and all rotations along the axes of
                /// space; methods with the names of the coordinates change it.
                #[must_use]
                #visibility fn start() -> #own<#scalar> {
                    let [value, unit] = [0.0, 1.0].map(<#scalar as #krate::scalar::Real>::from_f64);
                    let mut q = [value; #count];
                    #(q[#units] = unit;)*
                    #own { q, v: [value; #count] }
                }
            }

            #[automatically_derived]
            #[allow(dead_code, non_snake_case, unused_mut, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #own<#scalar> { #(#setters)* }
        };
        (declaration, methods)
    }

    /// Returns the method that sets a state. Its rate is not set, because it follows.
    fn state_setter(&self, state: &Quantity) -> TokenStream {
        let (scalar, name, visibility) = (self.scalar(), state.name, &self.model.block.visibility);
        let (places, length) = (state.scalars(), state.element.count());
        let (first, last) = (places.start, places.end);
        let (kind, values) = match (state.element, state.members) {
            (Element::Scalar, None) => (quote!(#scalar), quote!([value])),
            (Element::Scalar, Some(members)) => (quote!([#scalar; #members]), quote!(value)),
            (_, None) => (quote!([#scalar; #length]), quote!(value)),
            (_, Some(members)) => {
                (quote!([[#scalar; #length]; #members]), quote!(*value.as_flattened()))
            }
        };
        let unit =
            if state.unit.is_empty() { String::new() } else { format!(" in {}", state.unit) };
        let text = format!("Sets the state `{name}`{unit}.");
        quote! {
            #[doc = #text]
            #[must_use]
            #visibility fn #name(mut self, value: #kind) -> Self {
                let values: &[#scalar] = &#values;
                self.q[#first..#last].copy_from_slice(values);
                self
            }
        }
    }

    /// Returns the method that sets a coordinate and its velocity.
    fn setter(&self, coordinate: &Quantity) -> TokenStream {
        let (krate, scalar, name) = (&self.krate, self.scalar(), coordinate.name);
        let visibility = &self.model.block.visibility;
        let (first, length) = (coordinate.first, coordinate.element.count());
        let (mut position, mut velocity) = (quote!(#scalar), quote!(#scalar));
        let mut body = quote! {
            self.q[first] = position;
            self.v[first] = velocity;
        };
        if self.model.freedoms() <= first {
            return self.state_setter(coordinate);
        }
        if coordinate.element != Element::Scalar {
            let places = quote!(first..first + #length);
            body = quote! {
                self.q[#places].copy_from_slice(&position);
                self.v[#places].copy_from_slice(&velocity);
            };
            (position, velocity) = (quote!([#scalar; #length]), quote!([#scalar; #length]));
        }
        if coordinate.element == Element::Rotation {
            body = quote! {
                let velocity = velocity.derivative(position);
                let position = position.to_quaternion();
                #body
            };
            position = quote!(#krate::attitude::Attitude<#scalar>);
            velocity = quote!(#krate::attitude::Rates<#scalar>);
        }
        body = match coordinate.members {
            None => quote! {
                let first = #first;
                #body
            },
            Some(members) => {
                (position, velocity) =
                    (quote!([#position; #members]), quote!([#velocity; #members]));
                quote! {
                    let all = (position, velocity);
                    for index in 0..#members {
                        let (position, velocity) = (all.0[index], all.1[index]);
                        let first = #first + #length * index;
                        #body
                    }
                }
            }
        };
        let text = if coordinate.element == Element::Rotation {
            format!("Sets the attitude of `{name}` and its rates.")
        } else if coordinate.unit.is_empty() {
            format!("Sets `{name}` and its velocity.")
        } else {
            format!("Sets `{name}` in {} and its velocity.", coordinate.unit)
        };
        quote! {
            #[doc = #text]
            #[must_use]
            #visibility fn #name(mut self, position: #position, velocity: #velocity) -> Self {
                #body
                self
            }
        }
    }
}
