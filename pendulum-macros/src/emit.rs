//! Rust for a derived block: the struct, its constructor and the implementation of the runtime's traits.

use crate::check::{Model, Quantity};
use crate::diff;
use crate::expr::{Function, Graph, Id, Moment, Symbol};
use crate::latex;
use crate::lower::Energies;
use crate::mirror;
use crate::motion::Motion;
use crate::number::Rational;
use crate::print::{self, Names};
use crate::schedule::{self, Count, Op, Place, Program, Stage};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The names of ours that the generated code binds, besides those of the block and those that begin with `__`.
#[rustfmt::skip]
const OWN: &[&str] = &[
    "acceleration", "all", "at_position", "at_time", "both", "column", "columns", "drive", "entries", "index", "inputs", "k", "lifted",
    "map", "order", "p", "parameter", "path", "prepared", "q", "row", "system", "t", "v", "value", "values", "work",
];

/// What the emitter writes about and with.
pub(crate) struct Emitter<'m, 'a> {
    pub(crate) krate: TokenStream,
    pub(crate) model: &'m Model<'a>,
    pub(crate) graph: Graph,
    /// `None` after an error: then every body is left open, so that the mistake gives one message.
    pub(crate) motion: Option<Motion>,
    pub(crate) energies: Energies,
}

impl Emitter<'_, '_> {
    /// All items of a block.
    pub(crate) fn items(mut self) -> TokenStream {
        let structure = self.structure();
        let constructor = self.constructor();
        let system = self.system();
        let split = self.split_energy();
        let marker = self.marker();
        let staged = self.staged();
        let jacobians = self.jacobians();
        let jets = self.jets();
        let mirror = mirror::function(self.model.block);
        let open = self.open_names();
        quote! {
            #structure
            const _: () = {
                #open
                #constructor #system #split #staged #marker #jacobians #jets
            };
            #mirror
        }
    }

    /// Functions of the names that the generated code binds.
    ///
    /// A constant or a unit struct of such a name in the user's scope would turn the binding into a pattern; behind a function of
    /// the name it is out of sight, and a binding may shadow a function.
    fn open_names(&self) -> TokenStream {
        let own = OWN.iter().map(|name| Ident::new(name, Span::call_site()));
        let declared = self.model.parameters.iter().chain(&self.model.inputs).map(|quantity| {
            let mut name = quantity.name.clone();
            name.set_span(name.span().located_at(Span::call_site()));
            name
        });
        let names: BTreeMap<String, Ident> = own.chain(declared).map(|name| (name.to_string(), name)).collect();
        let names = names.values();
        quote!(#(#[allow(dead_code, non_snake_case)] fn #names() {})*)
    }

    /// The scalar's type parameter; another letter if the struct took the usual one.
    pub(crate) fn scalar(&self) -> Ident {
        format_ident!("{}", if self.model.block.name == "T" { "S" } else { "T" })
    }

    fn field_type(&self, quantity: &Quantity, scalar: &Ident) -> TokenStream {
        let krate = &self.krate;
        match quantity.length {
            _ if quantity.body => quote!(#krate::body::Body<#scalar>),
            None => quote!(#scalar),
            Some(length) => quote!([#scalar; #length]),
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.model.coordinates.iter().map(Quantity::count).sum()
    }

    fn structure(&mut self) -> TokenStream {
        let block = self.model.block;
        let (attributes, visibility, name, scalar) = (&block.attributes, &block.visibility, &block.name, self.scalar());
        let documentation = self.documentation();
        let fields = block.fields.iter().zip(&self.model.parameters).map(|(field, quantity)| {
            let (attributes, name) = (&field.attributes, &field.name);
            let kind = self.field_type(quantity, &scalar);
            let documented = attributes.iter().any(|attribute| attribute.path().is_ident("doc"));
            let text = match (documented, quantity.unit.as_str()) {
                (true, "") => String::new(),
                (true, unit) => format!("\n\nUnit: {unit}."),
                (false, "") => format!("The parameter `{name}`."),
                (false, unit) => format!("The parameter `{name}` in {unit}."),
            };
            let text = (!text.is_empty()).then(|| quote!(#[doc = #text]));
            quote! { #(#attributes)* #text pub #name: #kind, }
        });
        let empty =
            block.fields.is_empty().then(|| quote! { #[doc(hidden)] pub __scalar: ::core::marker::PhantomData<#scalar>, });
        quote! {
            #(#attributes)*
            #documentation
            #[allow(non_snake_case)]
            #visibility struct #name<#scalar = f64> { #(#fields)* #empty }
        }
    }

    fn constructor(&self) -> TokenStream {
        let (name, scalar, krate) = (&self.model.block.name, self.scalar(), &self.krate);
        let mut arguments = Vec::new();
        let mut values = Vec::new();
        for (index, quantity) in self.model.parameters.iter().enumerate() {
            let field = quantity.name;
            match self.energies.defaults.get(index).copied().flatten() {
                Some(default) => {
                    let program = schedule::program(&self.graph, &[default]);
                    let body = self.body(&program);
                    values.push(quote!(#field: { let [value] = #body; value }));
                }
                None if quantity.default.is_some() => values.push(quote!(#field: ::core::unimplemented!())),
                None => {
                    let kind = self.field_type(quantity, &scalar);
                    arguments.push(quote!(#field: #kind));
                    values.push(quote!(#field));
                }
            }
        }
        if self.model.parameters.is_empty() {
            values.push(quote!(__scalar: ::core::marker::PhantomData));
        }
        let driven = self.driven_by();
        let visibility = &self.model.block.visibility;
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::real::Real> #name<#scalar> {
                /// The system with the given parameters, in the order of declaration; those with a default take it.
                #[must_use]
                #visibility fn new(#(#arguments),*) -> Self {
                    Self { #(#values),* }
                }

                #driven
            }
        }
    }

    /// The method that binds a motion to each driven input.
    fn driven_by(&self) -> Option<TokenStream> {
        if self.model.inputs.is_empty() {
            return None;
        }
        let (krate, scalar, count, visibility) = (&self.krate, self.scalar(), self.count(), &self.model.block.visibility);
        let names: Vec<&Ident> = self.model.inputs.iter().map(|input| input.name).collect();
        let types: Vec<Ident> = (0..names.len()).map(|index| format_ident!("M{index}")).collect();
        let bounds = self.model.inputs.iter().zip(&types).map(|(input, motion)| {
            let dimension = input.count();
            quote!(#motion: #krate::motion::Motion<#scalar, #dimension>)
        });
        Some(quote! {
            /// The system driven by a motion for each of its driven inputs, in the order of declaration.
            #visibility fn driven_by<#(#bounds),*>(self, #(#names: #types),*) -> #krate::system::Driven<Self, (#(#types,)*)> {
                #krate::system::Driven::new::<#count>(self, (#(#names,)*))
            }
        })
    }

    fn system(&mut self) -> TokenStream {
        let (krate, scalar, count) = (self.krate.clone(), self.scalar(), self.count());
        let name = &self.model.block.name;
        let dimensions = self.model.inputs.iter().map(Quantity::count);
        let facts = self.facts();
        let mapped = self.model.parameters.iter().map(|quantity| {
            let field = quantity.name;
            if quantity.body || quantity.length.is_some() {
                quote!(#field: self.#field.map(&mut map))
            } else {
                quote!(#field: map(self.#field))
            }
        });
        let empty = self.model.parameters.is_empty().then(|| quote!(__scalar: ::core::marker::PhantomData));
        let vector = |emitter: &mut Self, pick: fn(&Motion) -> Vec<Id>| emitter.output(|motion| Some(pick(motion)));
        let (prepare, accelerations, prepared) = self.accelerations();
        let momenta = vector(self, |motion| motion.momenta.clone());
        let forces = vector(self, |motion| motion.forces.clone());
        let momentum_rates = vector(self, |motion| motion.momentum_rates.clone());
        let energy = vector(self, |motion| vec![motion.energy]);
        let power = vector(self, |motion| vec![motion.power]);
        let hamilton = self.hamilton();
        let velocities = self.output(|motion| motion.velocities.clone());
        let velocities = velocities.unwrap_or_else(|| quote!(#krate::__private::newton(self, t, q, p, inputs)));
        let matrix = self.mass_matrix();
        let conserved = self.output(|motion| Some(motion.conserved.iter().map(|conserved| conserved.value).collect()));
        let length = self.motion.as_ref().map_or(0, |motion| motion.conserved.len());
        let conserved = quote! {
            let all: [#scalar; #length] = #conserved;
            for k in 0..#length {
                if k < values.len() {
                    values[k] = all[k];
                }
            }
        };
        let state = quote!(q: &[#scalar; #count], v: &[#scalar; #count], inputs: &Self::Inputs);
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_mut, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::real::Real> #krate::system::System<#count> for #name<#scalar> {
                type Scalar = #scalar;
                type Inputs = (#(#krate::motion::Sample<#scalar, #dimensions>,)*);
                type With<U: #krate::real::Real> = #name<U>;
                type Prepared = [#scalar; #prepared];

                const FACTS: #krate::system::Facts = #facts;

                fn map<U: #krate::real::Real>(&self, mut map: impl ::core::ops::FnMut(#scalar) -> U) -> #name<U> {
                    #name { #(#mapped,)* #empty }
                }

                #[inline]
                fn prepare(&self) -> [#scalar; #prepared] { #prepare }

                #[inline]
                fn accelerations_prepared(&self, prepared: &[#scalar; #prepared], t: #scalar, #state) -> [#scalar; #count] {
                    #accelerations
                }

                #[inline]
                fn accelerations(&self, t: #scalar, #state) -> [#scalar; #count] {
                    #krate::system::System::accelerations_prepared(self, &#krate::system::System::prepare(self), t, q, v, inputs)
                }

                #[inline]
                fn energy(&self, t: #scalar, #state) -> #scalar { let [value] = #energy; value }

                #[inline]
                fn power(&self, t: #scalar, #state) -> #scalar { let [value] = #power; value }

                #[inline]
                fn momenta(&self, t: #scalar, #state) -> [#scalar; #count] { #momenta }

                #[inline]
                fn velocities(&self, t: #scalar, q: &[#scalar; #count], p: &[#scalar; #count], inputs: &Self::Inputs) -> [#scalar; #count] {
                    #velocities
                }

                #[inline]
                fn mass_matrix(&self, t: #scalar, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #matrix }

                #[inline]
                fn forces(&self, t: #scalar, #state) -> [#scalar; #count] { #forces }

                fn conserved(&self, t: #scalar, #state, values: &mut [#scalar]) { #conserved }

                #[inline]
                fn momentum_rates(&self, t: #scalar, #state) -> [#scalar; #count] { #momentum_rates }

                #hamilton
            }
        }
    }

    fn split_energy(&mut self) -> Option<TokenStream> {
        if self.motion.as_ref().is_some_and(|motion| motion.potential.is_none()) {
            return None;
        }
        let kinetic = self.output(|motion| motion.kinetic.map(|id| vec![id]));
        let potential = self.output(|motion| motion.potential.map(|id| vec![id]));
        let (krate, scalar, count) = (self.krate.clone(), self.scalar(), self.count());
        let name = &self.model.block.name;
        let state = quote!(q: &[#scalar; #count], v: &[#scalar; #count], inputs: &Self::Inputs);
        Some(quote! {
            #[automatically_derived]
            #[allow(unused_variables, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::real::Real> #krate::system::SplitEnergy<#count> for #name<#scalar> {
                #[inline]
                fn kinetic_energy(&self, t: #scalar, #state) -> #scalar { let [value] = #kinetic; value }

                #[inline]
                fn potential_energy(&self, t: #scalar, #state) -> #scalar { let [value] = #potential; value }
            }
        })
    }

    fn marker(&self) -> Option<TokenStream> {
        if self.motion.as_ref().is_some_and(|motion| !motion.velocity_free) {
            return None;
        }
        let (krate, scalar, count, name) = (&self.krate, self.scalar(), self.count(), &self.model.block.name);
        Some(quote! {
            #[automatically_derived]
            impl<#scalar: #krate::real::Real> #krate::system::VelocityFree<#count> for #name<#scalar> {}
        })
    }

    fn jacobians(&mut self) -> TokenStream {
        let (krate, scalar, count, name) = (self.krate.clone(), self.scalar(), self.count(), &self.model.block.name);
        let written = self.motion.as_ref().is_none_or(|motion| motion.jacobians.is_some());
        let [positions, velocities, parameters] = if written { self.written_jacobians() } else { self.dual_jacobians() };
        let state = quote!(q: &[#scalar; #count], v: &[#scalar; #count], inputs: &Self::Inputs);
        let inputs = (0..self.model.inputs.len()).map(Literal::usize_unsuffixed);
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_mut, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::real::Real> #krate::system::Jacobians<#count> for #name<#scalar> {
                type Over<U: #krate::real::Real> = #name<U>;

                fn over<U: #krate::real::Real>(&self, map: impl ::core::ops::FnMut(#scalar) -> U) -> #name<U> {
                    #krate::system::System::map(self, map)
                }

                fn inputs_over<U: #krate::real::Real>(
                    inputs: &Self::Inputs,
                    map: impl ::core::ops::Fn(#scalar) -> U,
                ) -> <#name<U> as #krate::system::System<#count>>::Inputs {
                    (#(inputs.#inputs.map(&map),)*)
                }

                fn position_jacobian(&self, t: #scalar, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #positions }

                fn velocity_jacobian(&self, t: #scalar, #state) -> #krate::__private::SMatrix<#scalar, #count, #count> { #velocities }

                fn parameter_jacobian(&self, t: #scalar, #state, columns: &mut [[#scalar; #count]]) { #parameters }
            }
        }
    }

    /// The Jacobians as expressions.
    fn written_jacobians(&mut self) -> [TokenStream; 3] {
        let (krate, scalar, count) = (self.krate.clone(), self.scalar(), self.count());
        let size = count * count;
        let flat = [0, 1, 2].map(|which| self.output(|motion| Some(motion.jacobians.as_ref()?[which].concat())));
        let [positions, velocities, parameters] = flat;
        if self.motion.is_none() {
            return [quote!(#positions), quote!(#velocities), quote!(#parameters)];
        }
        let matrix = |entries: Option<TokenStream>| {
            quote! {
                let entries: [#scalar; #size] = #entries;
                #krate::__private::SMatrix::<#scalar, #count, #count>::from_column_slice(&entries)
            }
        };
        let length = count * self.model.parameters.iter().map(Quantity::count).sum::<usize>();
        let parameters = quote! {
            let entries: [#scalar; #length] = #parameters;
            let all = #krate::__private::columns::<#scalar, #count>(&entries);
            for k in 0..all.len() {
                if k < columns.len() {
                    columns[k] = all[k];
                }
            }
        };
        [matrix(positions), matrix(velocities), parameters]
    }

    /// The Jacobians by dual numbers: one evaluation of the accelerations for each column.
    fn dual_jacobians(&self) -> [TokenStream; 3] {
        let (krate, scalar, count) = (&self.krate, self.scalar(), self.count());
        let inputs = (0..self.model.inputs.len()).map(Literal::usize_unsuffixed);
        let dual = quote!(#krate::real::Dual::<#scalar>);
        let lifted = quote! {
            let inputs = (#(inputs.#inputs.map(#dual::constant),)*);
            let (mut q, mut v) = (q.map(#dual::constant), v.map(#dual::constant));
            let t = #dual::constant(t);
        };
        let matrix = |variable: TokenStream| {
            quote! {
                let system = #krate::system::System::map(self, #dual::constant);
                #lifted
                let mut columns = [[#scalar::from_f64(0.0); #count]; #count];
                for k in 0..#count {
                    #variable[k].derivative = #scalar::from_f64(1.0);
                    columns[k] = #krate::system::System::accelerations(&system, t, &q, &v, &inputs).map(|acceleration| acceleration.derivative);
                    #variable[k].derivative = #scalar::from_f64(0.0);
                }
                #krate::__private::SMatrix::<#scalar, #count, #count>::from_fn(|row, column| columns[column][row])
            }
        };
        let parameters = quote! {
            #lifted
            for k in 0..columns.len() {
                let mut index = 0usize;
                let system = #krate::system::System::map(self, |parameter| {
                    let lifted = if index == k { #dual::variable(parameter) } else { #dual::constant(parameter) };
                    index += 1;
                    lifted
                });
                columns[k] = #krate::system::System::accelerations(&system, t, &q, &v, &inputs).map(|acceleration| acceleration.derivative);
            }
        };
        [matrix(quote!(q)), matrix(quote!(v)), parameters]
    }

    fn mass_matrix(&mut self) -> TokenStream {
        let (krate, scalar, count) = (self.krate.clone(), self.scalar(), self.count());
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

    /// A block that computes an array of roots; `None` if there are no such roots.
    fn output(&mut self, pick: impl Fn(&Motion) -> Option<Vec<Id>>) -> Option<TokenStream> {
        match &self.motion {
            None => Some(quote!(::core::unimplemented!())),
            Some(motion) => {
                let roots = pick(motion)?;
                let program = schedule::program(&self.graph, &roots);
                Some(self.body(&program))
            }
        }
    }

    /// The statements of a program: an operation that is read once stands where it is read.
    fn body(&self, program: &Program) -> TokenStream {
        self.body_after(program, &program.results, &[])
    }

    /// The statements that lead to `results`, given arrays of values that are known already.
    pub(crate) fn body_after(&self, program: &Program, results: &[Place], arrays: &[(&str, &[Place])]) -> TokenStream {
        let given = |index: usize| {
            arrays.iter().find_map(|(name, places)| {
                let place = places.iter().position(|place| place.0 == index)?;
                let name = Ident::new(name, Span::call_site());
                Some(quote!(#name[#place]))
            })
        };
        let mut readers = vec![0usize; program.ops.len()];
        for result in results {
            readers[result.0] += 1;
        }
        for (index, op) in program.ops.iter().enumerate().rev() {
            if 0 < readers[index] && given(index).is_none() {
                for place in schedule::operands(op) {
                    readers[place.0] += 1;
                }
            }
        }
        let mut statements = TokenStream::new();
        let mut values: Vec<TokenStream> = Vec::with_capacity(program.ops.len());
        let mut depths: Vec<usize> = Vec::with_capacity(program.ops.len());
        for (index, op) in program.ops.iter().enumerate() {
            if let Some(value) = given(index) {
                values.push(value);
                depths.push(0);
                continue;
            }
            if readers[index] == 0 {
                values.push(TokenStream::new());
                depths.push(0);
                continue;
            }
            let at = |place: Place| values[place.0].clone();
            let depth = 1 + schedule::operands(op).iter().map(|place| depths[place.0]).max().unwrap_or(0);
            if let Op::SinCos(angle) = op {
                let (sin, cos) = (local("s", index), local("c", index));
                let angle = at(*angle);
                statements.extend(quote!(let (#sin, #cos) = #angle.sin_cos();));
                values.push(TokenStream::new());
                depths.push(0);
                continue;
            }
            let value = self.operation(op, at);
            let free = matches!(op, Op::Load(_) | Op::Part(..));
            if free || readers[index] < 2 && depth < 16 {
                values.push(value);
                depths.push(if free { 0 } else { depth });
            } else {
                let name = local("v", index);
                statements.extend(quote!(let #name = #value;));
                values.push(quote!(#name));
                depths.push(0);
            }
        }
        let results = results.iter().map(|place| values[place.0].clone());
        quote!({ #statements [#(#results),*] })
    }

    /// The accelerations in two parts: what parameters alone decide, and the rest; with the number of values between them.
    fn accelerations(&self) -> (TokenStream, TokenStream, usize) {
        let Some(motion) = &self.motion else {
            return (quote!(::core::unimplemented!()), quote!(::core::unimplemented!()), 0);
        };
        let program = schedule::program(&self.graph, &motion.accelerations);
        let prepared = program.kept(Stage::Parameters);
        let prepare = self.body_after(&program, &prepared, &[]);
        (prepare, self.body_after(&program, &program.results, &[("prepared", &prepared)]), prepared.len())
    }

    /// The accelerations in four parts: what parameters decide, what time and inputs decide, what the position adds, and the rest.
    fn staged(&self) -> TokenStream {
        let (krate, scalar, count, name) = (&self.krate, self.scalar(), self.count(), &self.model.block.name);
        let missing = || (quote!(::core::unimplemented!()), 0);
        let (mut at_time, mut at_position, mut rest) = (missing(), missing(), missing().0);
        if let Some(motion) = &self.motion {
            let program = schedule::program(&self.graph, &motion.accelerations);
            let [prepared, time, position] = [Stage::Parameters, Stage::Time, Stage::Position].map(|stage| program.kept(stage));
            let known: [(&str, &[Place]); 3] = [("prepared", &prepared), ("at_time", &time), ("at_position", &position)];
            at_time = (self.body_after(&program, &time, &[]), time.len());
            at_position = (self.body_after(&program, &position, &known[..2]), position.len());
            rest = self.body_after(&program, &program.results, &known);
        }
        let ((at_time, times), (at_position, positions)) = (at_time, at_position);
        let system = quote!(#krate::system::System<#count>);
        quote! {
            #[automatically_derived]
            #[allow(non_snake_case, unused_variables, unused_parens, unreachable_code, clippy::all, clippy::pedantic)]
            impl<#scalar: #krate::real::Real> #krate::system::Staged<#count> for #name<#scalar> {
                type AtTime = [#scalar; #times];
                type AtPosition = [#scalar; #positions];

                #[inline(always)]
                fn at_time(t: #scalar, inputs: &<Self as #system>::Inputs) -> [#scalar; #times] { #at_time }

                #[inline(always)]
                fn at_position(
                    &self, prepared: &<Self as #system>::Prepared, at_time: &[#scalar; #times], t: #scalar, q: &[#scalar; #count],
                    inputs: &<Self as #system>::Inputs,
                ) -> [#scalar; #positions] {
                    #at_position
                }

                #[inline(always)]
                fn accelerations_staged(
                    &self, prepared: &<Self as #system>::Prepared, at_time: &[#scalar; #times], at_position: &[#scalar; #positions],
                    t: #scalar, q: &[#scalar; #count], v: &[#scalar; #count], inputs: &<Self as #system>::Inputs,
                ) -> [#scalar; #count] {
                    #rest
                }
            }
        }
    }

    /// Velocities and momentum rates from momenta, with what they share computed once; `None` where velocities are found by iteration.
    fn hamilton(&mut self) -> Option<TokenStream> {
        let (mut roots, rates) = {
            let motion = self.motion.as_ref()?;
            (motion.velocities.clone()?, motion.momentum_rates.clone())
        };
        let velocities: Vec<Id> = roots.iter().map(|&velocity| self.graph.closed(velocity)).collect();
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

    pub(crate) fn operation(&self, op: &Op, at: impl Fn(Place) -> TokenStream) -> TokenStream {
        let scalar = self.scalar();
        let call = |method: &str, place: Place| {
            let (value, method) = (at(place), format_ident!("{method}"));
            quote!(#value.#method())
        };
        let binary = |method: &str, a: Place, b: Place| {
            let (a, b, method) = (at(a), at(b), format_ident!("{method}"));
            quote!(#a.#method(#b))
        };
        match *op {
            Op::Number(value) => number(value, &scalar),
            Op::Literal(ref literal) => decimal(literal, &scalar),
            Op::Pi => quote!(#scalar::pi()),
            Op::Load(symbol) => self.load(symbol),
            Op::Negative(a) => {
                let a = at(a);
                quote!((-#a))
            }
            Op::Add(a, b) => {
                let (a, b) = (at(a), at(b));
                quote!((#a + #b))
            }
            Op::Sub(a, b) => {
                let (a, b) = (at(a), at(b));
                quote!((#a - #b))
            }
            Op::Mul(a, b) => {
                let (a, b) = (at(a), at(b));
                quote!((#a * #b))
            }
            Op::Div(a, b) => {
                let (a, b) = (at(a), at(b));
                quote!((#a / #b))
            }
            Op::Sqrt(a) => call("sqrt", a),
            Op::Powf(a, b) => binary("powf", a, b),
            Op::Atan2(a, b) => binary("atan2", a, b),
            Op::Max(a, b) => binary("max", a, b),
            Op::Call(function, a) => call(method(function), a),
            Op::SinCos(_) => TokenStream::new(),
            Op::Part(function, pair) => {
                let name = local(if function == Function::Sin { "s" } else { "c" }, pair.0);
                quote!(#name)
            }
        }
    }

    fn load(&self, symbol: Symbol) -> TokenStream {
        match symbol {
            Symbol::Parameter(scalar) => {
                let quantity = self.model.parameters.iter().rfind(|quantity| quantity.first <= scalar);
                let Some(quantity) = quantity else { return TokenStream::new() };
                let (name, offset) = (quantity.name, scalar - quantity.first);
                match quantity.length {
                    _ if quantity.body => match offset {
                        0 => quote!(self.#name.mass),
                        1 | 2 => {
                            let component = offset - 1;
                            quote!(self.#name.center[#component])
                        }
                        _ => {
                            let component = offset - 3;
                            quote!(self.#name.central[#component])
                        }
                    },
                    Some(_) => quote!(self.#name[#offset]),
                    None => quote!(self.#name),
                }
            }
            Symbol::Moment(first, moment) => {
                let body = self.model.parameters.iter().rfind(|quantity| quantity.first <= first);
                let Some(name) = body.map(|body| body.name) else { return TokenStream::new() };
                match moment {
                    Moment::Inertia => quote!(self.#name.inertia()),
                    Moment::Difference => quote!((self.#name.moments()[0] - self.#name.moments()[2])),
                    Moment::Product => quote!(self.#name.moments()[1]),
                }
            }
            // Points of integration are gone when the integral is done, velocities of positions when the equations are solved.
            Symbol::Point(..) | Symbol::Auxiliary(_) => quote!(::core::unreachable!()),
            Symbol::Time => quote!(t),
            Symbol::Coordinate(index) => quote!(q[#index]),
            Symbol::Velocity(index) => quote!(v[#index]),
            Symbol::Momentum(index) => quote!(p[#index]),
            Symbol::Input { input, component, order } => {
                let input = Literal::usize_unsuffixed(input);
                let order = format_ident!("{}", ["position", "velocity", "acceleration"][usize::from(order.min(2))]);
                quote!(inputs.#input.#order[#component])
            }
        }
    }

    fn facts(&mut self) -> TokenStream {
        let krate = self.krate.clone();
        let names = Names::new(self.model, &self.energies.families);
        let name = self.model.block.name.to_string();
        let (coordinates, parameters) = (&names.coordinates, &names.parameters);
        let units = self.model.parameters.iter().flat_map(|quantity| {
            if quantity.body {
                return ["kg", "m", "m", "kg*m^2", "kg*m^2", "kg*m^2"].map(String::from).to_vec();
            }
            vec![quantity.unit.clone(); quantity.count()]
        });
        let inputs = self.inputs();
        let Some(motion) = &self.motion else {
            return quote!(#krate::__private::facts(#krate::__private::Known {
                name: #name, coordinates: &[#(#coordinates),*], parameters: &[#(#parameters),*], units: &[#(#units),*], inputs: &[#(#inputs),*],
                autonomous: false, explicit_time: false, separable: false, velocity_free: false, constant_mass_matrix: false, nonconservative: false,
                smooth: false, cyclic: &[], conserved: &[], unused: &[], equations: "", latex: "",
            }));
        };
        let (autonomous, explicit_time, separable, velocity_free, constant_mass_matrix, nonconservative) = (
            motion.autonomous,
            motion.explicit_time,
            motion.separable,
            motion.velocity_free,
            motion.constant_mass_matrix,
            motion.nonconservative,
        );
        let smooth = self.graph.smooth(&motion.accelerations);
        let cyclic = motion.cyclic.clone();
        let conserved: Vec<String> = motion.conserved.iter().map(|conserved| print::conserved(&names, conserved)).collect();
        let unused = self.unused(&names);
        let equations = self.equations(&names).join("\n");
        let latex = match &self.motion {
            Some(motion) => latex::equations(&mut self.graph, &names, motion).join("\n"),
            None => String::new(),
        };
        quote!(#krate::__private::facts(#krate::__private::Known {
            name: #name, coordinates: &[#(#coordinates),*], parameters: &[#(#parameters),*], units: &[#(#units),*], inputs: &[#(#inputs),*],
            autonomous: #autonomous, explicit_time: #explicit_time, separable: #separable, velocity_free: #velocity_free, constant_mass_matrix: #constant_mass_matrix,
            nonconservative: #nonconservative, smooth: #smooth, cyclic: &[#(#cyclic),*], conserved: &[#(#conserved),*], unused: &[#(#unused),*], equations: #equations, latex: #latex,
        }))
    }

    /// The derivatives of each driven input that each purpose needs.
    fn inputs(&self) -> Vec<TokenStream> {
        let krate = &self.krate;
        let purposes: Vec<Vec<Symbol>> = match &self.motion {
            None => vec![Vec::new(); 4],
            Some(motion) => {
                let of = |lists: &[&[Id]]| self.graph.symbols(&lists.concat()).into_iter().collect();
                let masses = motion.mass_matrix.concat();
                let energies: Vec<Id> = [Some(motion.energy), motion.kinetic, motion.potential].into_iter().flatten().collect();
                vec![
                    of(&[&motion.accelerations, &motion.forces]),
                    of(&[&motion.momenta, &motion.momentum_rates, motion.velocities.as_deref().unwrap_or_default(), &masses]),
                    of(&[&energies]),
                    of(&[&[motion.power]]),
                ]
            }
        };
        let describe = |(index, quantity): (usize, &Quantity)| {
            let (name, components) = (quantity.name.to_string(), quantity.count());
            let orders = purposes.iter().map(|symbols| {
                let has = |wanted: u8| {
                    symbols
                        .iter()
                        .any(|symbol| matches!(symbol, Symbol::Input { input, order, .. } if *input == index && *order == wanted))
                };
                let parts = [("POSITION", 0), ("VELOCITY", 1), ("ACCELERATION", 2)]
                    .into_iter()
                    .filter(|&(_, order)| has(order))
                    .map(|(part, _)| format_ident!("{part}"));
                quote!(#krate::motion::Orders::NONE #(.and(#krate::motion::Orders::#parts))*)
            });
            let purposes = ["accelerations", "momenta", "energy", "power"].map(|purpose| format_ident!("{purpose}"));
            quote!(#krate::system::Input { name: #name, components: #components, #(#purposes: #orders),* })
        };
        self.model.inputs.iter().enumerate().map(describe).collect()
    }

    fn unused(&self, names: &Names) -> Vec<String> {
        let Some(motion) = &self.motion else { return Vec::new() };
        let mut needed = self.graph.symbols(&motion.accelerations);
        for quantity in &self.model.parameters {
            // A moment about the pivot is made of all that a body has.
            if needed.iter().any(|symbol| matches!(symbol, Symbol::Moment(first, _) if *first == quantity.first)) {
                needed.extend((quantity.first..quantity.first + quantity.count()).map(Symbol::Parameter));
            }
        }
        let all = names.parameters.iter().enumerate();
        all.filter(|(index, _)| !needed.contains(&Symbol::Parameter(*index))).map(|(_, name)| name.clone()).collect()
    }

    fn equations(&mut self, names: &Names) -> Vec<String> {
        match &self.motion {
            None => Vec::new(),
            Some(motion) => print::equations(&mut self.graph, names, motion),
        }
    }

    /// The equations, their cost and what they leave out, for hover and rustdoc.
    fn documentation(&mut self) -> TokenStream {
        let names = Names::new(self.model, &self.energies.families);
        let Some(motion) = &self.motion else { return TokenStream::new() };
        let accelerations = motion.accelerations.clone();
        let mut conserved: Vec<String> =
            motion.conserved.iter().map(|conserved| format!("`{}`", print::conserved(&names, conserved))).collect();
        if motion.autonomous && !motion.nonconservative {
            conserved.push("the energy".into());
        }
        let count = schedule::program(&self.graph, &accelerations).count();
        let documented = self.model.block.attributes.iter().any(|attribute| attribute.path().is_ident("doc"));
        let mut text = String::new();
        if documented {
            text.push_str("\n\n");
        }
        text.push_str("# Equations of motion\n\n```text\n");
        for line in self.equations(&names) {
            text.push_str(&line);
            text.push('\n');
        }
        text.push_str("```\n\n");
        let _ = write!(text, "One evaluation takes {}.", operations(count));
        if !conserved.is_empty() {
            let _ = write!(text, " Conserved: {}.", conserved.join(", "));
        }
        let unused = self.unused(&names);
        if !unused.is_empty() {
            let list = unused.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let _ = write!(text, " The equations do not need {list}.");
        }
        quote!(#[doc = #text])
    }
}

/// A count of operations in words.
pub(crate) fn operations(count: Count) -> String {
    let rows = [
        (count.sincos, "sine–cosine pair"),
        (count.functions, "other function"),
        (count.mul, "multiplication"),
        (count.add, "addition"),
        (count.div, "division"),
    ];
    let parts: Vec<String> = rows
        .into_iter()
        .filter(|&(number, _)| 0 < number)
        .map(|(number, what)| format!("{number} {what}{}", if number == 1 { "" } else { "s" }))
        .collect();
    if parts.is_empty() { "no operation".into() } else { parts.join(", ") }
}

/// A name of ours that no user can write.
pub(crate) fn local(prefix: &str, index: usize) -> Ident {
    Ident::new(&format!("__{prefix}{index}"), Span::mixed_site())
}

fn number(value: Rational, scalar: &Ident) -> TokenStream {
    let sign = value.is_negative().then(|| quote!(-));
    if !value.fits_double() {
        // The nearest double, and what it leaves off for scalars of more digits.
        let (high, low) = value.abs().words();
        let (high, rest) = (Literal::f64_unsuffixed(high), Literal::f64_unsuffixed(low.abs()));
        let rest_sign = (value.is_negative() != (low < 0.0)).then(|| quote!(-));
        return quote!((#scalar::from_f64(#sign #high) + #scalar::from_f64(#rest_sign #rest)));
    }
    let (top, bottom) = (value.numerator() as f64, value.denominator() as f64);
    let (top, bottom) = (Literal::f64_unsuffixed(top.abs()), Literal::f64_unsuffixed(bottom));
    if value.is_integer() { quote!(#scalar::from_f64(#sign #top)) } else { quote!(#scalar::ratio(#sign #top, #bottom)) }
}

fn decimal(literal: &crate::ast::Literal, scalar: &Ident) -> TokenStream {
    match literal {
        crate::ast::Literal::Exact(value) => number(*value, scalar),
        crate::ast::Literal::Decimal(digits) => {
            let value = Literal::f64_unsuffixed(digits.parse().unwrap_or(f64::NAN));
            quote!(#scalar::from_f64(#value))
        }
    }
}

fn method(function: Function) -> &'static str {
    match function {
        Function::Sin => "sin",
        Function::Cos => "cos",
        Function::Tan => "tan",
        Function::Asin => "asin",
        Function::Acos => "acos",
        Function::Atan => "atan",
        Function::Sinh => "sinh",
        Function::Cosh => "cosh",
        Function::Tanh => "tanh",
        Function::Exp => "exp",
        Function::Ln => "ln",
        Function::Abs => "abs",
        Function::Sign => "sign",
        Function::Step => "step",
    }
}
