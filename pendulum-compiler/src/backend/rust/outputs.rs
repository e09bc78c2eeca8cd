//! The outputs: a method for each, access by index, and a trait that samples the inputs.

use crate::backend::Analysis;
use crate::backend::unlocated;
use crate::mechanics::lower;
use crate::model::{self, Element};
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

impl Analysis<'_, '_> {
    /// Returns the declared outputs with their scalars.
    fn all_outputs(&self) -> impl Iterator<Item = (&model::Output<'_>, Option<&lower::Output>)> {
        let lowered = self.energies.outputs.iter().map(Some).chain(std::iter::repeat(None));
        let lowered = lowered.map(|output| output.filter(|_| self.motion.is_some()));
        self.model.outputs.iter().zip(lowered)
    }

    /// Returns a method for each output.
    pub(super) fn output_methods(&self) -> Option<TokenStream> {
        if self.model.outputs.is_empty() {
            return None;
        }
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let (name, visibility) = (self.name(), &self.model.block.visibility);
        let inputs = (!self.model.inputs.is_empty())
            .then(|| quote!(, inputs: &<Self as #krate::system::System<#count>>::Inputs));
        let methods = self.all_outputs().map(|(output, lowered)| {
            let (method, kind) = (output.declared.name, self.output_type(output, lowered));
            let documentation = documentation(output);
            let body = self.output_body(lowered);
            quote! {
                #documentation
                #[inline]
                #visibility fn #method(&self, t: #scalar, q: &[#scalar; #count], v: &[#scalar; #count] #inputs) -> #kind { #body }
            }
        });
        Some(quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real> #name<#scalar> { #(#methods)* }
        })
    }

    /// Returns the same methods for a system with its motions and controllers, which provide the
    /// inputs.
    ///
    /// The first item is the trait, which is placed beside the struct, and the second is its
    /// implementation.
    pub(super) fn output_trait(&self) -> (TokenStream, TokenStream) {
        if self.model.outputs.is_empty() || self.model.inputs.is_empty() {
            return (TokenStream::new(), TokenStream::new());
        }
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let block = self.model.block;
        let (name, visibility) = (self.name(), &block.visibility);
        let own = format_ident!("{name}Outputs", span = block.name.span());
        let conditions = block.conditions();
        let signatures: Vec<(TokenStream, &Ident, TokenStream)> = self
            .all_outputs()
            .map(|(output, lowered)| {
                let (method, kind) = (output.declared.name, self.output_type(output, lowered));
                let signature = quote!(
                    fn #method(&self, t: ::core::primitive::f64, q: &[#scalar; #count], v: &[#scalar; #count]) -> #kind
                );
                (documentation(output), method, signature)
            })
            .collect();
        let declared = signatures
            .iter()
            .map(|(documentation, _, signature)| quote!(#documentation #signature;));
        let defined = signatures.iter().map(|(_, method, signature)| {
            quote! {
                #signature {
                    let time = #krate::time::Time::new(t);
                    let inputs = #krate::system::Dynamics::<#count>::inputs_with(
                        self, time, #krate::motion::Side::After, #krate::system::Purpose::Outputs, q, v,
                    );
                    let system = #krate::system::Dynamics::<#count>::system(self);
                    system.#method(#krate::system::scalar_time::<#scalar>(time), q, v, &inputs)
                }
            }
        });
        let text = format!(
            "The outputs of a [`{name}`] whose inputs are driven or controlled; at a kink those after it."
        );
        let declaration = quote! {
            #(#conditions)*
            #[doc = #text]
            #[allow(non_snake_case)]
            #visibility trait #own<#scalar: #krate::scalar::Real> { #(#declared)* }
        };
        let own = unlocated(&own);
        let implementation = quote! {
            #[automatically_derived]
            #[allow(non_snake_case, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::scalar::Real, __D> #own<#scalar> for __D
            where
                __D: #krate::system::Dynamics<#count, System = #name<#scalar>, Scalar = #scalar>,
            {
                #(#defined)*
            }
        };
        (declaration, implementation)
    }

    /// Returns the method of `System` that computes an output by its index.
    pub(super) fn output_by_index(&self) -> Option<TokenStream> {
        if self.model.outputs.is_empty() {
            return None;
        }
        let (scalar, count) = (self.scalar(), self.count());
        let (at, state) = (self.at(), self.state());
        let arm = |index: usize, length: usize, all: TokenStream| {
            let copied = self.copied(&all, length);
            quote!(#index => { #copied })
        };
        let arms = self.all_outputs().enumerate().map(|(index, (_, lowered))| {
            let length = lowered.map_or(1, |output| output.scalars.len());
            arm(index, length, self.output_scalars(lowered))
        });
        let open: Vec<TokenStream> = self
            .all_outputs()
            .enumerate()
            .filter_map(|(index, (_, lowered))| {
                let open = &lowered?.open;
                (!open.is_empty()).then(|| arm(index, open.len(), self.roots(open)))
            })
            .collect();
        let open = (!open.is_empty()).then(|| {
            quote! {
                fn output_of(
                    &self, index: ::core::primitive::usize, #state,
                    accelerations: &[#scalar; #count], [multipliers, __contacts, __frictions]: [&[#scalar]; 3], values: &mut [#scalar],
                ) {
                    match index {
                        #(#open)*
                        _ => Self::output(self, index, #at, values),
                    }
                }
            }
        });
        Some(quote! {
            fn output(
                &self, index: ::core::primitive::usize, #state, values: &mut [#scalar],
            ) {
                match index { #(#arms)* _ => {} }
            }

            #open
        })
    }

    /// Returns the outputs as facts.
    pub(super) fn output_facts(&self) -> Vec<TokenStream> {
        let krate = &self.krate;
        let fact = |(output, lowered): (&model::Output<'_>, Option<&lower::Output>)| {
            let (name, unit) = (output.declared.name.to_string(), &output.declared.unit);
            let (members, components) = shape(output, lowered);
            let [members, components] = [members, components].map(option);
            let rotation = is_rotation(output, lowered);
            quote!(#krate::system::Output {
                name: #name, unit: #unit, members: #members, components: #components, rotation: #rotation
            })
        };
        self.all_outputs().map(fact).collect()
    }

    fn output_type(&self, output: &model::Output, lowered: Option<&lower::Output>) -> TokenStream {
        let (krate, scalar) = (&self.krate, self.scalar());
        let (members, components) = shape(output, lowered);
        let member = match components {
            _ if is_rotation(output, lowered) => quote!(#krate::attitude::Attitude<#scalar>),
            None => quote!(#scalar),
            Some(length) => quote!([#scalar; #length]),
        };
        members.map_or(member.clone(), |count| quote!([#member; #count]))
    }

    fn output_scalars(&self, lowered: Option<&lower::Output>) -> TokenStream {
        match lowered {
            None => quote!([::core::unimplemented!()]),
            Some(lowered) => self.body(&schedule::program(&self.graph, &lowered.scalars)),
        }
    }

    fn output_body(&self, lowered: Option<&lower::Output>) -> TokenStream {
        let Some(output) = lowered else { return quote!(::core::unimplemented!()) };
        let (scalar, length) = (self.scalar(), output.scalars.len());
        let all = self.output_scalars(lowered);
        let member = |first: usize| match output.components {
            None => quote!(all[#first]),
            Some(components) => {
                let places = first..first + components;
                let all = quote!([#(all[#places]),*]);
                let krate = &self.krate;
                if output.rotation {
                    quote!(#krate::attitude::Attitude::from_quaternion(#all))
                } else {
                    all
                }
            }
        };
        let value = match output.members {
            None => member(0),
            Some(members) => {
                let step = output.components.unwrap_or(1);
                let members = (0..members).map(|k| member(k * step));
                quote!([#(#members),*])
            }
        };
        quote! {
            let all: [#scalar; #length] = #all;
            #value
        }
    }
}

/// Returns the lengths of the family and of the vector, as declared if the output has a mistake.
fn shape(
    output: &model::Output,
    lowered: Option<&lower::Output>,
) -> (Option<usize>, Option<usize>) {
    match lowered {
        Some(lowered) => (lowered.members, lowered.components),
        None => (output.statement.index.as_ref().map(|_| 0), output.declared.length()),
    }
}

fn is_rotation(output: &model::Output, lowered: Option<&lower::Output>) -> bool {
    lowered.map_or(output.declared.element == Element::Rotation, |lowered| lowered.rotation)
}

fn option(length: Option<usize>) -> TokenStream {
    match length {
        None => quote!(::core::option::Option::None),
        Some(length) => quote!(::core::option::Option::Some(#length)),
    }
}

/// Returns the user's documentation, or a text with the name of the output, followed by its unit.
fn documentation(output: &model::Output) -> TokenStream {
    let (own, unit) = (&output.statement.documentation, &output.declared.unit);
    let name = output.declared.name;
    let text = match (own.is_empty(), unit.as_str()) {
        (true, "") => format!("The output `{name}` at the time `t` in seconds."),
        (true, unit) => format!("The output `{name}` in {unit}, at the time `t` in seconds."),
        (false, "") => String::new(),
        (false, unit) => format!("\n\nUnit: {unit}."),
    };
    let text = (!text.is_empty()).then(|| quote!(#[doc = #text]));
    quote!(#own #text)
}
