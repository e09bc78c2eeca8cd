//! The struct of a block, its constructor and the methods that bind motions to its driven inputs.

use crate::backend::Analysis;
use crate::model::{Element, Quantity};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};

impl Analysis<'_, '_> {
    pub(super) fn structure(&self) -> TokenStream {
        let block = self.model.block;
        let (visibility, name, scalar) = (&block.visibility, &block.name, self.scalar());
        let attributes =
            block.attributes.iter().filter(|attribute| !self.is_moved(attribute, None));
        let documentation = self.documentation();
        let fields = block.fields.iter().zip(&self.model.parameters).enumerate().map(
            |(index, (field, quantity))| {
                let attributes = field
                    .attributes
                    .iter()
                    .filter(|attribute| !self.is_moved(attribute, Some(index)));
                let name = &field.name;
                let kind = self.field_type(quantity, &scalar);
                let documented =
                    field.attributes.iter().any(|attribute| attribute.path().is_ident("doc"));
                let text = match (documented, quantity.unit.as_str()) {
                    (true, "") => String::new(),
                    (true, unit) => format!("\n\nUnit: {unit}."),
                    (false, "") => format!("The parameter `{name}`."),
                    (false, unit) => format!("The parameter `{name}` in {unit}."),
                };
                let text = (!text.is_empty()).then(|| quote!(#[doc = #text]));
                quote! { #(#attributes)* #text pub #name: #kind, }
            },
        );
        let empty = self
            .has_no_scalar()
            .then(|| quote! { #[doc(hidden)] pub __scalar: ::core::marker::PhantomData<#scalar>, });
        // If another item has the same name, rustc shows the tokens from the visibility to the name
        // instead of the whole block.
        let visibility = located(visibility.to_token_stream(), None);
        let place = visibility.is_empty().then(|| name.span());
        let keyword = located(quote!(struct), Some(place.unwrap_or_else(Span::call_site)));
        let head = located(quote!(#name < ), Some(name.span()));
        let tail = located(quote!( > { #(#fields)* #empty }), Some(name.span()));
        quote! {
            #(#attributes)*
            #documentation
            #[allow(non_snake_case)]
            #visibility #keyword #head #scalar = ::core::primitive::f64 #tail
        }
    }

    pub(super) fn constructor(&self) -> TokenStream {
        let (name, scalar, krate) = (&self.name(), self.scalar(), &self.krate);
        let mut arguments = Vec::new();
        let mut values = Vec::new();
        for (index, quantity) in self.model.parameters.iter().enumerate() {
            let field = quantity.name;
            let default = self.energies.defaults.get(index).filter(|items| !items.is_empty());
            match default.map(|items| self.roots(items)) {
                Some(all) if quantity.length().is_some() => values.push(quote!(#field: #all)),
                Some(all) => values.push(quote!(#field: { let [value] = #all; value })),
                None if quantity.default.is_some() => {
                    values.push(quote!(#field: ::core::unimplemented!()));
                }
                None => {
                    let kind = self.field_type(quantity, &scalar);
                    arguments.push(quote!(#field: #kind));
                    values.push(quote!(#field));
                }
            }
        }
        if self.has_no_scalar() {
            values.push(quote!(__scalar: ::core::marker::PhantomData));
        }
        let (driven, controlled) = (self.driven_by(), self.controlled_by());
        let facts = self.inherent_facts();
        let visibility = &self.model.block.visibility;
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #name<#scalar> {
                /// The system with the given parameters, in the order of declaration; those with a
                /// default take it.
                #[must_use]
                #visibility fn new(#(#arguments),*) -> Self {
                    Self { #(#values),* }
                }

                #driven

                #controlled
            }

            #facts
        }
    }

    /// Returns the facts as an inherent constant, which does not require a trait.
    fn inherent_facts(&self) -> TokenStream {
        let (krate, name, count) = (&self.krate, &self.name(), self.count());
        let visibility = &self.model.block.visibility;
        quote! {
            #[automatically_derived]
            #[allow(dead_code)]
            impl #name<::core::primitive::f64> {
                /// Facts about the system that are known before it runs.
                #visibility const FACTS: #krate::system::Facts = <Self as #krate::system::System<#count>>::FACTS;
            }
        }
    }

    /// Returns the methods that bind a control law to a system without driven inputs; with driven
    /// inputs, methods of these names whose bound says that `driven_by` comes first.
    fn controlled_by(&self) -> Option<TokenStream> {
        if self.model.driven == self.model.inputs.len() {
            return None;
        }
        if 0 < self.model.driven {
            let (krate, count) = (&self.krate, self.count());
            let visibility = &self.model.block.visibility;
            let bound = quote!(where Self: #krate::system::Dynamics<#count>);
            return Some(quote! {
                #[doc(hidden)]
                #visibility fn controlled_by<__F>(self, _: __F) -> Self #bound { self }

                #[doc(hidden)]
                #visibility fn sampled<__F>(self, _: ::core::primitive::f64, _: __F) -> Self #bound { self }
            });
        }
        let slots = self.slots();
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let visibility = &self.model.block.visibility;
        let kinds: Vec<TokenStream> =
            self.model.inputs.iter().map(|input| self.field_type(input, &scalar)).collect();
        let kind = if let [kind] = kinds.as_slice() { kind.clone() } else { quote!((#(#kinds),*)) };
        let state =
            quote!((::core::primitive::f64, &[#scalar; #count], &[#scalar; #count]) -> #kind);
        let names: Vec<String> =
            self.model.inputs.iter().map(|input| format!("`{}`", input.name)).collect();
        let names = names.join(", ");
        let (continuous, held) = (
            format!(
                "The system under a feedback law: {names} from the time in seconds, the coordinates and the velocities."
            ),
            format!(
                "The system under a controller that is asked every `period` seconds for {names}, which keep their values in between."
            ),
        );
        Some(quote! {
            #[doc = #continuous]
            #visibility fn controlled_by<__F>(self, law: __F) -> #krate::system::Controlled<Self, (#slots), __F, #kind>
            where
                __F: ::core::ops::Fn #state,
            {
                let driven = #krate::system::Driven { system: self, motions: (#slots) };
                #krate::system::Uncontrolled { driven }.controlled_by(law)
            }

            #[doc = #held]
            #visibility fn sampled<__F>(self, period: ::core::primitive::f64, controller: __F) -> #krate::system::Sampled<Self, (#slots), __F, #kind>
            where
                __F: ::core::ops::FnMut #state + ::core::clone::Clone,
            {
                let driven = #krate::system::Driven { system: self, motions: (#slots) };
                #krate::system::Uncontrolled { driven }.sampled(period, controller)
            }
        })
    }

    /// Returns the slots of the control inputs among the motions, each with a comma.
    fn slots(&self) -> TokenStream {
        let krate = &self.krate;
        let slots = (self.model.driven..self.model.inputs.len())
            .map(|_| quote!(#krate::system::ControlSlot,));
        quote!(#(#slots)*)
    }

    /// Returns the method that binds a motion to each driven input.
    fn driven_by(&self) -> Option<TokenStream> {
        let inputs = &self.model.inputs[..self.model.driven];
        if inputs.is_empty() {
            return None;
        }
        let (krate, scalar, visibility) =
            (&self.krate, self.scalar(), &self.model.block.visibility);
        let names: Vec<&Ident> = inputs.iter().map(|input| input.name).collect();
        let types: Vec<Ident> = (0..names.len()).map(|index| format_ident!("M{index}")).collect();
        let bounds = inputs.iter().zip(&types).map(|(input, motion)| {
            let dimension = input.count();
            quote!(#motion: #krate::motion::Motion<#scalar, #dimension>)
        });
        let (sufficient, slots) = (self.sufficient(), self.slots());
        let driven = quote!(#krate::system::Driven { system: self, motions: (#(#names,)* #slots) });
        let kind = quote!(#krate::system::Driven<Self, (#(#types,)* #slots)>);
        let (kind, value) = if self.model.driven == self.model.inputs.len() {
            (kind, driven)
        } else {
            let kind = quote!(#krate::system::Uncontrolled<Self, (#(#types,)* #slots)>);
            (kind, quote!(#krate::system::Uncontrolled { driven: #driven }))
        };
        Some(quote! {
            /// The system driven by a motion for each of its driven inputs, in the order of
            /// declaration.
            ///
            /// Does not compile if a motion lacks a derivative that the equations or the outputs
            /// need.
            #visibility fn driven_by<#(#bounds),*>(self, #(#names: #types),*) -> #kind {
                #sufficient
                #value
            }
        })
    }

    /// Returns assertions that the motions passed to `driven_by` provide all derivatives needed by
    /// the system.
    ///
    /// The assertions are inside `driven_by`, so that rustc reports the call. Each is a separate
    /// constant with the span of the input's declaration, so that one failure does not hide
    /// another.
    fn sufficient(&self) -> TokenStream {
        let (krate, scalar, system) = (&self.krate, self.scalar(), &self.name());
        let purposes = self.needed();
        let driven = &self.model.inputs[..self.model.driven];
        let assertions = driven.iter().enumerate().filter_map(|(index, quantity)| {
            let needs = |order: usize| purposes.iter().any(|inputs| inputs[index][order]);
            let (name, motion, dimension) = (quantity.name, format_ident!("M{index}"), quantity.count());
            let has = |constant: &str| {
                let constant = format_ident!("{constant}");
                quote!(<#motion as #krate::motion::Motion<#scalar, #dimension>>::HAS.contains(#krate::motion::Derivatives::#constant))
            };
            let lacks = |what: &str, calls: &str| {
                format!(
                    "`{system}` needs the {what} of `{name}`, which its motion lacks; give the `Function` its {calls}, or take another \
                     motion"
                )
            };
            let velocity = needs(1).then(|| (has("VELOCITY"), lacks("velocity", "`.velocity(…)`")));
            let acceleration = needs(2).then(|| (has("ACCELERATION"), lacks("acceleration", "`.acceleration(…)`")));
            let both = match (&velocity, &acceleration) {
                (Some((velocity, _)), Some((acceleration, _))) => {
                    let message = lacks("velocity and the acceleration", "`.velocity(…)` and `.acceleration(…)`");
                    Some((quote!(#velocity || #acceleration), message))
                }
                (None, None) => return None,
                _ => None,
            };
            let each = [both, velocity, acceleration].into_iter().flatten();
            let place = Some(name.span());
            let each = each.map(|(condition, message)| located(quote!(::core::assert!(#condition, #message);), place));
            Some(located(quote!(const { #(#each)* };), place))
        });
        assertions.collect()
    }

    /// Returns `true` if no field of the struct contains the scalar.
    pub(super) fn has_no_scalar(&self) -> bool {
        self.model.parameters.iter().all(|quantity| quantity.element == Element::Table)
    }

    /// Returns the type of a parameter or an input.
    fn field_type(&self, quantity: &Quantity, scalar: &Ident) -> TokenStream {
        let krate = &self.krate;
        match quantity.length() {
            _ if quantity.element == Element::Solid => quote!(#krate::body::Solid<#scalar>),
            _ if quantity.is_body() => quote!(#krate::body::Body<#scalar>),
            _ if quantity.element == Element::Table => quote!(#krate::system::Table),
            None => quote!(#scalar),
            Some(length) => quote!([#scalar; #length]),
        }
    }
}

/// Returns the same tokens as code of the macro, shown at `place`, or each at its own position.
fn located(tokens: TokenStream, place: Option<Span>) -> TokenStream {
    let own = |mut token: TokenTree| {
        token.set_span(Span::call_site().located_at(place.unwrap_or(token.span())));
        token
    };
    tokens.into_iter().map(own).collect()
}
