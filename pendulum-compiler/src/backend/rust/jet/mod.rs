//! Taylor recurrences: one line for each operation of the equations, the same for every order.
//!
//! What only sums and constants touch is a number at the order in question; what a product or a
//! function reads is kept as a series. Where coordinates are coupled by a mass matrix that moves, M
//! q̈ = f is solved order by order: M\[0\] q̈\[k\] = f\[k\] − Σ M\[j\] q̈\[k−j\] over 1 ≤ j ≤ k,
//! with M\[0\] factored once. Loops over the order live in the runtime.

mod function;
mod momentum_form;
mod sine_oscillator;

use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::functions::Function;
use crate::backend::rust::{Emitter, local};
use crate::mechanics::articulated::Unsolved;
use crate::mechanics::motion::Motion;
use crate::mechanics::solve;
use crate::model::Quantity;
use crate::schedule::{self, Op, Place, Program, Stage};
use momentum_form::Plan;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use sine_oscillator::swing;
use std::collections::BTreeMap;

/// The most convolutions, in halves, of a system whose orders are unrolled, and of one whose sums
/// are loops in their places.
const MOST_UNROLLED: usize = 10;
const MOST_LOOPED: usize = 80;

/// The most convolutions, in halves, of a system for which higher orders pay: the rest of a step
/// costs as much.
const MOST_CHEAP: usize = 4;

/// The number of coefficients of a series of the runtime.
const LENGTH: usize = 32;

/// The equations as a program: for each block of the mass matrix its rows, and what the program's
/// results mean for it.
pub(crate) struct Equations {
    pub(crate) program: Program,
    pub(crate) blocks: Vec<Block>,
}

/// Coordinates that the mass matrix couples.
pub(crate) enum Block {
    /// The accelerations are results of the program.
    Explicit(Vec<(usize, Place)>),
    /// The rows, for each the entries of the lower triangle that are not zero, and the forces.
    Coupled { rows: Vec<usize>, masses: Vec<Vec<Option<Place>>>, forces: Vec<Place> },
}

/// The equations that the jets of a motion compute.
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

impl Emitter<'_, '_> {
    /// The implementation of `Jets`.
    pub(crate) fn jets(&self) -> TokenStream {
        let (krate, scalar, count, name) =
            (&self.krate, self.scalar(), self.count(), &self.model.block.name);
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

    /// The type of the work, how orders are gone through and how many pay, the new work and the
    /// statements for one order.
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

    /// The recurrences of accelerations, where coordinates are coupled in series with the mass
    /// matrix.
    fn solved(&self, program: &Program, blocks: &[Block]) -> Recurrences {
        let (parameter_only, prepared) =
            (program.parameter_only(), program.kept(Stage::Parameters));
        let mut writer = Writer::new(self, program, parameter_only, &prepared);
        let explicit = blocks.iter().filter_map(|block| match block {
            Block::Explicit(rows) => Some(rows),
            Block::Coupled { .. } => None,
        });
        let swings: BTreeMap<usize, _> = explicit
            .flatten()
            .filter_map(|&(row, place)| {
                swing(program, &writer.parameter_only, row, place).map(|own| (row, own))
            })
            .collect();
        for place in 0..program.ops.len() {
            if !writer.parameter_only[place]
                && !swings.values().any(|own| own.contains(&Place(place)))
            {
                writer.operation(Place(place));
            }
        }
        let mut factors = Vec::new();
        for block in blocks {
            match block {
                Block::Explicit(rows) => {
                    for &(row, place) in rows {
                        if swings.contains_key(&row) {
                            writer.swing(row, place);
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

    /// The recurrences of equations that are not solved, where they have any.
    fn unsolved(&self, motion: &Motion, unsolved: &Unsolved) -> Option<Recurrences> {
        let program = schedule::of_series(&self.graph, &momentum_form::roots(unsolved));
        let (parameter_only, prepared) =
            (program.parameter_only(), program.kept(Stage::Parameters));
        let plan = Plan::new(&program, &parameter_only, unsolved)?;
        let mut writer = Writer::new(self, &program, parameter_only.clone(), &prepared);
        writer.unsolved(&plan, motion);
        Some(writer.finish(&[unsolved.equations.len()]))
    }
}

/// The recurrences of a system: the statements for one order, the type of the work and a new one,
/// and the convolutions in halves.
struct Recurrences {
    lines: TokenStream,
    kind: TokenStream,
    work: TokenStream,
    halves: usize,
}

/// The statements under construction.
struct Writer<'e, 'm, 'a> {
    emitter: &'e Emitter<'m, 'a>,
    program: &'e Program,
    /// True for each place that parameters alone decide.
    parameter_only: Vec<bool>,
    prepared: &'e [Place],
    lines: TokenStream,
    /// The coefficients of the places that move.
    values: Vec<TokenStream>,
    /// The series of each place that is kept.
    series: BTreeMap<Place, TokenStream>,
    slots: usize,
    pairs: usize,
    leading: usize,
    /// The convolutions so far, in halves.
    halves: usize,
    /// The sines and cosines that are found from turns, and the coefficients of what they are
    /// multiplied by.
    turned: BTreeMap<Place, TokenStream>,
    paired: Vec<(Place, TokenStream)>,
}

impl<'e, 'm, 'a> Writer<'e, 'm, 'a> {
    /// Nothing written yet.
    fn new(
        emitter: &'e Emitter<'m, 'a>,
        program: &'e Program,
        parameter_only: Vec<bool>,
        prepared: &'e [Place],
    ) -> Self {
        Self {
            emitter,
            parameter_only,
            program,
            prepared,
            lines: TokenStream::new(),
            values: vec![TokenStream::new(); program.ops.len()],
            series: BTreeMap::new(),
            slots: 0,
            pairs: 0,
            leading: 0,
            halves: 0,
            turned: BTreeMap::new(),
            paired: Vec::new(),
        }
    }

    /// The recurrences written so far, with matrices of these sizes to factor.
    fn finish(self, factors: &[usize]) -> Recurrences {
        let Self { emitter, program, prepared, lines, slots, pairs, leading, halves, .. } = self;
        let (krate, scalar, length) = (&emitter.krate, emitter.scalar(), prepared.len());
        let prepare = emitter.body_after(program, prepared, &[]);
        let kinds = factors.iter().map(|size| quote!(#krate::jet::Factors<#scalar, #size>));
        let kind =
            quote!(#krate::jet::Work<#scalar, (#(#kinds,)*), #slots, #pairs, #length, #leading>);
        let empty = factors.iter().map(|_| quote!(#krate::jet::Factors::zero()));
        let work = quote!(#krate::jet::Work::new(#prepare, (#(#empty,)*)));
        Recurrences { lines, kind, work, halves }
    }
}

impl Writer<'_, '_, '_> {
    /// A number that parameters alone decide.
    fn constant(&self, place: Place) -> TokenStream {
        match self.prepared.iter().position(|prepared| *prepared == place) {
            Some(index) => quote!(work.still[#index]),
            None => self.emitter.operation(&self.program.ops[place.0], |_| TokenStream::new()),
        }
    }

    /// The coefficient at this order.
    fn value(&self, place: Place) -> TokenStream {
        if self.parameter_only[place.0] {
            let constant = self.constant(place);
            return quote!(series::constant(#constant, order));
        }
        self.values[place.0].clone()
    }

    /// A new series.
    fn slot(&mut self) -> TokenStream {
        let slot = self.slots;
        self.slots += 1;
        quote!(work.series[#slot])
    }

    /// A new pair of series.
    fn pair(&mut self) -> TokenStream {
        let pair = self.pairs;
        self.pairs += 1;
        self.halves += 4;
        quote!(work.pairs[#pair])
    }

    /// A new series with this coefficient.
    fn kept(&mut self, value: &TokenStream) -> TokenStream {
        let slot = self.slot();
        self.lines.extend(quote!(#slot[k] = #value;));
        slot
    }

    /// A new number that the leading coefficients decide.
    fn lead(&mut self) -> TokenStream {
        let lead = self.leading;
        self.leading += 1;
        quote!(&mut work.leading[#lead])
    }

    /// The series of a place.
    fn whole(&mut self, place: Place) -> TokenStream {
        if let Some(series) = self.series.get(&place) {
            return series.clone();
        }
        let value = self.value(place);
        let series = self.kept(&value);
        self.series.insert(place, series.clone());
        series
    }

    /// The series of j x[j].
    fn rate(&mut self, value: &TokenStream) -> TokenStream {
        self.kept(&quote!(series::rate(#value, order)))
    }

    /// Names the coefficient of a place.
    fn name(&mut self, place: Place, value: &TokenStream) {
        let name = local("x", place.0);
        self.lines.extend(quote!(let #name = #value;));
        self.values[place.0] = quote!(#name);
    }

    /// Names the coefficient of a place whose series the recurrence reads itself.
    fn name_in(&mut self, place: Place, value: &TokenStream, slot: TokenStream) {
        self.name(place, value);
        let name = &self.values[place.0];
        self.lines.extend(quote!(#slot[k] = #name;));
        self.series.insert(place, slot);
    }

    /// A value that several lines read.
    fn shared(&mut self, prefix: &str, place: Place, value: &TokenStream) -> TokenStream {
        let name = local(prefix, place.0);
        self.lines.extend(quote!(let #name = #value;));
        quote!(#name)
    }

    fn operation(&mut self, place: Place) {
        match self.program.ops[place.0] {
            Op::Number(_) | Op::Literal(_) | Op::Pi => {}
            Op::Load(symbol) => self.load(place, symbol),
            Op::Negative(a) => {
                let a = self.value(a);
                self.name(place, &quote!(-#a));
            }
            Op::Add(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.name(place, &quote!(#a + #b));
            }
            Op::Sub(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.name(place, &quote!(#a - #b));
            }
            Op::Mul(a, b) => self.product(place, a, b),
            Op::Div(a, b) => {
                let (a, b, slot, lead) = (self.value(a), self.whole(b), self.slot(), self.lead());
                self.halves += 2;
                self.name_in(place, &quote!(series::quotient(#a, &#b, &#slot, #lead, order)), slot);
            }
            Op::Sqrt(a) => {
                let (a, slot, lead) = (self.value(a), self.slot(), self.lead());
                self.halves += 1;
                self.name_in(place, &quote!(series::sqrt(#a, &#slot, #lead, order)), slot);
            }
            Op::Powf(a, b) => self.power(place, a, b),
            Op::Atan2(y, x) => self.angle(place, y, x),
            Op::Max(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                let (a, b) = (self.shared("a", place, &a), self.shared("b", place, &b));
                let lead = self.lead();
                let first = self.shared(
                    "l",
                    place,
                    &quote!(series::leading(|| (#a - #b).step(), #lead, order)),
                );
                let scalar = self.emitter.scalar();
                self.name(place, &quote!(#first * #a + (#scalar::from_f64(1.0) - #first) * #b));
            }
            Op::Call(function, a) => self.call(place, function, a),
            Op::SinCos(a) => self.sin_cos(place, a),
            // Both parts have been named with the pair.
            Op::Part(function, pair) => {
                let name = local(if function == Function::Sin { "s" } else { "c" }, pair.0);
                self.values[place.0] = quote!(#name);
            }
        }
    }

    fn load(&mut self, place: Place, symbol: Symbol) {
        let Some(series) = self.series_of(symbol) else {
            self.values[place.0] = quote!(series::time(path.t, order));
            return;
        };
        self.values[place.0] = quote!(#series[k]);
        self.series.insert(place, series);
    }

    /// The series that the path or the drive has.
    fn series_of(&self, symbol: Symbol) -> Option<TokenStream> {
        Some(match symbol {
            Symbol::Coordinate(index) => quote!(path.q[#index]),
            Symbol::Velocity(index) => quote!(path.v[#index]),
            Symbol::Control { input, component } => {
                return self.series_of(Symbol::Input { input, component, order: 0 });
            }
            Symbol::Input { input, component, order } => {
                let before: usize =
                    self.emitter.model.inputs[..input].iter().map(Quantity::count).sum();
                let (index, order) = (before + component, usize::from(order));
                let order = format_ident!("{}", ["position", "velocity", "acceleration"][order]);
                quote!(drive[#index].#order)
            }
            _ => return None,
        })
    }

    fn product(&mut self, place: Place, a: Place, b: Place) {
        let value = match (self.parameter_only[a.0], self.parameter_only[b.0]) {
            (true, _) => {
                let (a, b) = (self.constant(a), self.value(b));
                quote!(#a * #b)
            }
            (_, true) => {
                let (a, b) = (self.value(a), self.constant(b));
                quote!(#a * #b)
            }
            _ if a == b => {
                self.halves += 1;
                let a = self.whole(a);
                quote!(series::square(&#a, order))
            }
            _ => {
                self.halves += 2;
                let (a, b) = (self.whole(a), self.whole(b));
                quote!(series::product(&#a, &#b, order))
            }
        };
        self.name(place, &value);
    }

    fn sin_cos(&mut self, place: Place, angle: Place) {
        let pair = self.pair();
        let (s, c) = (local("s", place.0), local("c", place.0));
        let value = if let Op::Load(Symbol::Coordinate(index)) = self.program.ops[angle.0] {
            quote!(series::sin_cos_of_coordinate(path, #index, &#pair, order))
        } else {
            let x = self.value(angle);
            let rate = self.rate(&x);
            quote!(series::sin_cos(#x, &#rate, &#pair, &path.reciprocals, order))
        };
        self.lines.extend(quote! { let [#s, #c] = #value; #pair[k] = [#s, #c]; });
    }

    /// The accelerations of coordinates that a moving mass matrix couples.
    fn coupled(
        &mut self,
        index: usize,
        rows: &[usize],
        masses: &[Vec<Option<Place>>],
        forces: &[Place],
    ) {
        let (index, krate, scalar) =
            (Literal::usize_unsuffixed(index), &self.emitter.krate, self.emitter.scalar());
        let size = rows.len();
        let entry = |i: usize, j: usize| masses[i.max(j)][i.min(j)];
        let mut right = Vec::new();
        for (i, &force) in forces.iter().enumerate() {
            let mut sum = self.value(force);
            for (j, &column) in rows.iter().enumerate() {
                if let Some(mass) = entry(i, j).filter(|mass| !self.parameter_only[mass.0]) {
                    let mass = self.whole(mass);
                    self.halves += 2;
                    sum.extend(quote!(- series::behind(&#mass, &path.a[#column], order)));
                }
            }
            right.push(sum);
        }
        let matrix = (0..size).map(|i| {
            let entries = (0..size).map(|j| match entry(i, j).filter(|_| j <= i) {
                None => quote!(#scalar::from_f64(0.0)),
                Some(mass) => self.value(mass),
            });
            quote!([#(#entries),*])
        });
        let names: Vec<_> = rows.iter().map(|&row| local("a", row)).collect();
        let matrix = quote!([#(#matrix),*]);
        self.lines.extend(quote! {
            if k == 0 {
                work.factors.#index = #krate::jet::Factors::new(#matrix);
            }
            let [#(#names),*] = work.factors.#index.solve([#(#right),*]);
            #(path.a[#rows][k] = #names;)*
        });
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn series_are_as_long_as_in_the_runtime() {
        assert_eq!(super::LENGTH, pendulum_runtime::jet::LENGTH);
    }
}
