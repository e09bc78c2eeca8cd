//! The statements of the recurrences, written operation by operation.

use crate::algebra::expr::Symbol;
use crate::algebra::functions::Function;
use crate::backend::Analysis;
use crate::backend::rust::local;
use crate::model::Quantity;
use crate::schedule::{Op, Place, Program, Stage};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// The recurrences of a system: the statements for one order, the type of the work, the expression
/// for a new work, and the number of convolutions in halves.
pub(super) struct Recurrences {
    pub(super) lines: TokenStream,
    pub(super) kind: TokenStream,
    pub(super) work: TokenStream,
    pub(super) halves: usize,
}

/// The recurrences under construction.
pub(super) struct Writer<'e, 'm, 'a> {
    pub(super) analysis: &'e Analysis<'m, 'a>,
    pub(super) program: &'e Program,
    /// `true` for each place that depends only on parameters.
    pub(super) parameter_only: Vec<bool>,
    prepared: Vec<Place>,
    pub(super) lines: TokenStream,
    /// The current coefficients of the places that depend on more than parameters.
    pub(super) values: Vec<TokenStream>,
    /// The series of each place that is stored as a series.
    pub(super) series: BTreeMap<Place, TokenStream>,
    pub(super) slots: usize,
    pairs: usize,
    leading: usize,
    /// The number of convolutions so far, in halves.
    pub(super) halves: usize,
    /// The sines and cosines computed from turns; `paired` contains the coefficients of their
    /// factors.
    pub(super) turned: BTreeMap<Place, TokenStream>,
    pub(super) paired: Vec<(Place, TokenStream)>,
}

impl<'e, 'm, 'a> Writer<'e, 'm, 'a> {
    /// Creates a writer without statements.
    pub(super) fn new(analysis: &'e Analysis<'m, 'a>, program: &'e Program) -> Self {
        Self {
            analysis,
            program,
            parameter_only: program.parameter_only(),
            prepared: program.kept(Stage::Parameters),
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

    /// Returns the recurrences written so far, with matrices of these sizes to factor.
    pub(super) fn finish(self, factors: &[usize]) -> Recurrences {
        let Self { analysis, program, prepared, lines, slots, pairs, leading, halves, .. } = self;
        let (krate, scalar, length) = (&analysis.krate, analysis.scalar(), prepared.len());
        let prepare = analysis.body_after(program, &prepared, &[]);
        let kinds = factors.iter().map(|size| quote!(#krate::jet::Factors<#scalar, #size>));
        let kind =
            quote!(#krate::jet::Work<#scalar, (#(#kinds,)*), #slots, #pairs, #length, #leading>);
        let empty = factors.iter().map(|_| quote!(#krate::jet::Factors::zero()));
        let work = quote!(#krate::jet::Work::new(#prepare, (#(#empty,)*)));
        Recurrences { lines, kind, work, halves }
    }
}

impl Writer<'_, '_, '_> {
    /// Returns a number that depends only on parameters.
    pub(super) fn constant(&self, place: Place) -> TokenStream {
        match self.prepared.iter().position(|prepared| *prepared == place) {
            Some(index) => quote!(work.parameter_only[#index]),
            None => self.analysis.operation(&self.program.ops[place.0], |_| TokenStream::new()),
        }
    }

    /// Returns the coefficient at the current order.
    pub(super) fn value(&self, place: Place) -> TokenStream {
        if self.parameter_only[place.0] {
            let constant = self.constant(place);
            return quote!(series::constant(#constant, order));
        }
        self.values[place.0].clone()
    }

    /// Allocates a series.
    pub(super) fn slot(&mut self) -> TokenStream {
        let slot = self.slots;
        self.slots += 1;
        quote!(work.series[#slot])
    }

    /// Allocates a pair of series.
    pub(super) fn pair(&mut self) -> TokenStream {
        let pair = self.pairs;
        self.pairs += 1;
        self.halves += 4;
        quote!(work.pairs[#pair])
    }

    /// Allocates a series and stores this coefficient in it.
    pub(super) fn kept(&mut self, value: &TokenStream) -> TokenStream {
        let slot = self.slot();
        self.lines.extend(quote!(#slot[k] = #value;));
        slot
    }

    /// Allocates a number that depends only on the leading coefficients.
    pub(super) fn lead(&mut self) -> TokenStream {
        let lead = self.leading;
        self.leading += 1;
        quote!(&mut work.leading[#lead])
    }

    /// Returns the series of a place, which is stored from now on.
    pub(super) fn whole(&mut self, place: Place) -> TokenStream {
        if let Some(series) = self.series.get(&place) {
            return series.clone();
        }
        let value = self.value(place);
        let series = self.kept(&value);
        self.series.insert(place, series.clone());
        series
    }

    /// Stores the series j x\[j\].
    pub(super) fn rate(&mut self, value: &TokenStream) -> TokenStream {
        self.kept(&quote!(series::rate(#value, order)))
    }

    /// Names the coefficient of a place.
    pub(super) fn name(&mut self, place: Place, value: &TokenStream) {
        let name = local("x", place.0);
        self.lines.extend(quote!(let #name = #value;));
        self.values[place.0] = quote!(#name);
    }

    /// Names the coefficient of a place whose series is an argument of its own recurrence.
    pub(super) fn name_in(&mut self, place: Place, value: &TokenStream, slot: TokenStream) {
        self.name(place, value);
        let name = &self.values[place.0];
        self.lines.extend(quote!(#slot[k] = #name;));
        self.series.insert(place, slot);
    }

    /// Names a value that several statements use.
    pub(super) fn shared(
        &mut self,
        prefix: &str,
        place: Place,
        value: &TokenStream,
    ) -> TokenStream {
        let name = local(prefix, place.0);
        self.lines.extend(quote!(let #name = #value;));
        quote!(#name)
    }

    pub(super) fn operation(&mut self, place: Place) {
        match self.program.ops[place.0] {
            Op::Number(_) | Op::Literal(_) | Op::Pi => {}
            Op::Load(symbol) => self.load(place, symbol),
            Op::Negative(a) => {
                let a = self.value(a);
                self.name(place, &quote!(-#a));
            }
            Op::Add(a, b) | Op::Sub(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                let plus = matches!(self.program.ops[place.0], Op::Add(..));
                self.name(place, &if plus { quote!(#a + #b) } else { quote!(#a - #b) });
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
                let scalar = self.analysis.scalar();
                self.name(place, &quote!(#first * #a + (#scalar::from_f64(1.0) - #first) * #b));
            }
            Op::Call(function, a) => self.call(place, function, a),
            Op::SinCos(a) => self.sin_cos(place, a),
            // Both parts are named with the pair.
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

    /// Returns the series that is part of the path or the drive, if any.
    pub(super) fn series_of(&self, symbol: Symbol) -> Option<TokenStream> {
        Some(match symbol {
            Symbol::Coordinate(index) => quote!(path.q[#index]),
            Symbol::Velocity(index) => quote!(path.v[#index]),
            Symbol::Control { input, component } => {
                return self.series_of(Symbol::Input { input, component, order: 0 });
            }
            Symbol::Input { input, component, order } => {
                let before: usize =
                    self.analysis.model.inputs[..input].iter().map(Quantity::count).sum();
                let (index, order) = (before + component, usize::from(order));
                let order = format_ident!("{}", ["position", "velocity", "acceleration"][order]);
                quote!(drive[#index].#order)
            }
            _ => return None,
        })
    }

    pub(super) fn product(&mut self, place: Place, a: Place, b: Place) {
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

    pub(super) fn sin_cos(&mut self, place: Place, angle: Place) {
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

    /// Writes the accelerations of coordinates that are coupled by a mass matrix which depends on
    /// the state.
    pub(super) fn coupled(
        &mut self,
        index: usize,
        rows: &[usize],
        masses: &[Vec<Option<Place>>],
        forces: &[Place],
    ) {
        let (index, krate, scalar) =
            (Literal::usize_unsuffixed(index), &self.analysis.krate, self.analysis.scalar());
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
