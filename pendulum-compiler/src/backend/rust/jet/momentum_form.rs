//! Taylor recurrences from equations that are not solved: sums of rates of momenta, which are
//! computed one order ahead.
//!
//! If positions are defined with `let`, ṗ requires few products. A chain has two products per link
//! in its momenta and two in its torques, whereas the number of products of its full mass matrix is
//! proportional to the square of its length. At order k
//! 1. the momenta are computed at order k + 1 with q̈\[k\] = 0, which omits a\[0\] v\[k+1\] from
//!    each product a v;
//! 2. with (k+1) p\[k+1\] for ṗ\[k\], the remainders of the equations are −M\[0\] q̈\[k\], where M
//!    is the mass matrix;
//! 3. the contributions of q̈\[k\] are added to the newest coefficients of the series.

use super::writer::Writer;
use crate::algebra::expr::{Id, Symbol};
use crate::algebra::functions::Function;
use crate::backend::rust::local;
use crate::mechanics::articulated::Unsolved;
use crate::mechanics::motion::Motion;
use crate::schedule::{self, Op, Place, Program, operands};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;

/// A product of constants, a velocity, and the sine or cosine of its coordinate. The constants
/// depend only on parameters.
struct Turn {
    constants: Vec<Place>,
    pair: Place,
    function: Function,
    coordinate: usize,
}

/// A sum a sin q + b cos q for a coordinate q with a turn.
struct Dot {
    pair: Place,
    factors: [Place; 2],
}

/// The assignment of operations to the parts of the equations.
pub(super) struct Plan<'p> {
    program: &'p Program,
    parameter_only: &'p [bool],
    carried: Vec<Place>,
    equations: Vec<Place>,
    /// The operations that the momenta depend on; `moved` contains those of them that depend on
    /// velocities.
    ahead: Vec<bool>,
    moved: Vec<bool>,
    /// The other operations that depend on rates.
    rated: Vec<bool>,
    turns: BTreeMap<Place, Turn>,
    /// Sums of two products that are computed together; `inside` contains the products that are
    /// then not computed separately.
    dots: BTreeMap<Place, Dot>,
    inside: Vec<bool>,
}

/// Returns the expressions that the jets of unsolved equations compute.
pub(super) fn roots(unsolved: &Unsolved) -> Vec<Id> {
    unsolved.carried.iter().chain(&unsolved.equations).copied().collect()
}

impl<'p> Plan<'p> {
    /// Creates the plan for the program of [`roots`]; `None` if a momentum is not an affine
    /// function of the velocities, composed of sums and products.
    pub(super) fn new(
        program: &'p Program,
        parameter_only: &'p [bool],
        unsolved: &Unsolved,
    ) -> Option<Self> {
        let (carried, equations) = program.results.split_at(unsolved.carried.len());
        let (carried, equations) = (carried.to_vec(), equations.to_vec());
        let count = program.ops.len();
        let mut ahead = vec![false; count];
        for place in &carried {
            ahead[place.0] = true;
        }
        let (mut moved, mut rated) = (vec![false; count], vec![false; count]);
        for (place, op) in program.ops.iter().enumerate().rev() {
            ahead[place] &= !parameter_only[place];
            if ahead[place] {
                mark(&mut ahead, op);
            }
        }
        for (place, op) in program.ops.iter().enumerate() {
            if let Op::Part(_, pair) = op {
                ahead[place] |= ahead[pair.0];
            }
            match op {
                Op::Load(Symbol::Velocity(_)) => moved[place] = ahead[place],
                Op::Load(Symbol::Auxiliary(_)) => rated[place] = true,
                _ => {
                    moved[place] =
                        ahead[place] && operands(op).iter().any(|operand| moved[operand.0]);
                    rated[place] = operands(op).iter().any(|operand| rated[operand.0]);
                }
            }
            let touched = if ahead[place] { &moved } else { &rated };
            let fine = match *op {
                Op::Load(_) | Op::Negative(_) | Op::Add(..) | Op::Sub(..) => true,
                Op::Mul(a, b) => !(touched[a.0] && touched[b.0]),
                Op::Div(_, b) => !touched[b.0],
                _ => false,
            };
            if touched[place] && !fine {
                return None;
            }
        }
        let (turns, dots, inside) = (BTreeMap::new(), BTreeMap::new(), vec![false; count]);
        let mut plan = Self {
            program,
            parameter_only,
            carried,
            equations,
            ahead,
            moved,
            rated,
            turns,
            dots,
            inside,
        };
        for place in (0..count).map(Place).filter(|place| plan.moved[place.0]) {
            if let Some(turn) = plan.turn(place) {
                plan.turns.insert(place, turn);
            }
        }
        let mut uses = vec![0; count];
        for place in program.ops.iter().flat_map(operands).chain(program.results.iter().copied()) {
            uses[place.0] += 1;
        }
        for place in (0..count).map(Place).filter(|place| !plan.ahead[place.0]) {
            if let Some((dot, products)) = plan.dot(place, &uses) {
                plan.dots.insert(place, dot);
                for product in products {
                    plan.inside[product.0] = true;
                }
            }
        }
        Some(plan)
    }

    /// Returns a sum as a dot product, with its two products.
    fn dot(&self, place: Place, uses: &[usize]) -> Option<(Dot, [Place; 2])> {
        let Op::Add(a, b) = self.program.ops[place.0] else { return None };
        let product = |place: Place| {
            let Op::Mul(a, b) = self.program.ops[place.0] else { return None };
            let of = |part: Place, factor: Place| match self.program.ops[part.0] {
                Op::Part(function, pair)
                    if !self.parameter_only[factor.0] && !self.ahead[factor.0] =>
                {
                    Some((function, pair, factor))
                }
                _ => None,
            };
            of(a, b).or_else(|| of(b, a)).filter(|_| uses[place.0] == 1)
        };
        let ((f, pair, first), (g, other, second)) = (product(a)?, product(b)?);
        let turned = self.turns.values().any(|turn| turn.pair == pair);
        let factors = if f == Function::Sin { [first, second] } else { [second, first] };
        (turned && pair == other && f != g).then_some((Dot { pair, factors }, [a, b]))
    }

    /// Returns a product as a turn.
    fn turn(&self, place: Place) -> Option<Turn> {
        let Op::Mul(a, b) = self.program.ops[place.0] else { return None };
        let (mut constants, mut velocity, mut part) = (Vec::new(), None, None);
        let mut open = vec![a, b];
        while let Some(factor) = open.pop() {
            match self.program.ops[factor.0] {
                _ if self.parameter_only[factor.0] => constants.push(factor),
                Op::Mul(a, b) => open.extend([a, b]),
                Op::Load(Symbol::Velocity(index)) if velocity.is_none() => velocity = Some(index),
                Op::Part(function, pair) if part.is_none() => part = Some((function, pair)),
                _ => return None,
            }
        }
        let ((function, pair), coordinate) = (part?, velocity?);
        let Op::SinCos(angle) = self.program.ops[pair.0] else { return None };
        let own = matches!(self.program.ops[angle.0], Op::Load(Symbol::Coordinate(index)) if index == coordinate);
        own.then_some(Turn { constants, pair, function, coordinate })
    }
}

impl Writer<'_, '_, '_> {
    /// Writes the statements for one order.
    pub(super) fn unsolved(&mut self, plan: &Plan<'_>, motion: &Motion) {
        let (ahead, turns) = self.momenta(plan);
        self.remainders(plan);
        let count = plan.equations.len();
        let (krate, rows) = (&self.analysis.krate, 0..count);
        let masses = self.masses_at_start(motion);
        let right: Vec<_> = plan.equations.iter().map(|&place| self.value(place)).collect();
        let names: Vec<_> = rows.clone().map(|row| local("a", row)).collect();
        let gains: Vec<_> = rows.clone().map(|row| local("g", row)).collect();
        let late = std::mem::take(&mut self.lines);
        let rows: Vec<usize> = rows.collect();
        let scalar = self.analysis.scalar();
        self.lines.extend(quote! {
            #(
                path.q[#rows][k + 1] = path.reciprocals.over(path.v[#rows][k], k + 1);
                path.v[#rows][k + 1] = #scalar::from_f64(0.0);
            )*
            for k in (if k == 0 { 0 } else { k + 1 })..k + 2 {
                let order = order.at(k);
                #ahead
            }
            #late
            if k == 0 {
                #masses
                work.factors.0 = #krate::jet::Factors::new(masses);
            }
            let [#(#names),*] = work.factors.0.accelerations([#(-(#right)),*], order);
            #(
                path.a[#rows][k] = #names;
                let #gains = path.reciprocals.over(#names, k + 1);
            )*
        });
        self.gains(plan, &turns);
    }

    /// Writes the momenta one order ahead. Returns the statements, and the pairs of products of a
    /// velocity with the sine and cosine of its coordinate.
    fn momenta(&mut self, plan: &Plan<'_>) -> (TokenStream, BTreeMap<Place, TokenStream>) {
        let mut products: BTreeMap<Place, TokenStream> = BTreeMap::new();
        for index in 0..plan.program.ops.len() {
            let place = Place(index);
            if !plan.ahead[index] {
                continue;
            }
            let turn =
                plan.turns.values().find(|turn| turn.pair == place).map(|turn| turn.coordinate);
            if let Some(coordinate) = turn {
                let (pair, product) = (self.pair(), self.pair());
                self.halves -= 4;
                let (s, c) = (local("s", index), local("c", index));
                self.lines.extend(quote! {
                    let [#s, #c] = series::turned(path, #coordinate, &#product, order);
                    #pair[k] = [#s, #c];
                    #product[k] = series::turning(path, #coordinate, &#pair, [#s, #c], order);
                });
                self.turned.insert(place, pair);
                products.insert(place, product);
            } else if let Some(turn) = plan.turns.get(&place) {
                let (product, part) =
                    (&products[&turn.pair], usize::from(turn.function == Function::Cos));
                let constants = turn.constants.iter().map(|&constant| self.constant(constant));
                let value = quote!(#product[k][#part] #(* #constants)*);
                self.name(place, &value);
            } else {
                self.operation(place);
            }
        }
        // A value that is used at the previous order or as a rate is stored as a series.
        let late = (0..plan.program.ops.len()).filter(|&index| {
            !plan.ahead[index] && !plan.parameter_only[index] && !plan.inside[index]
        });
        let read: Vec<Place> = late
            .flat_map(|index| operands(&plan.program.ops[index]))
            .chain(plan.carried.clone())
            .collect();
        for place in read.into_iter().chain(plan.equations.clone()) {
            if plan.ahead[place.0] && !matches!(plan.program.ops[place.0], Op::SinCos(_)) {
                let series = self.whole(place);
                self.values[place.0] = quote!(#series[k]);
            }
        }
        (std::mem::take(&mut self.lines), products)
    }

    /// Writes the remainders of the equations at q̈ = 0.
    fn remainders(&mut self, plan: &Plan<'_>) {
        for (index, op) in plan.program.ops.iter().enumerate() {
            if plan.ahead[index] || plan.parameter_only[index] || plan.inside[index] {
                continue;
            }
            if let Some(Dot { pair, factors: [a, b] }) = plan.dots.get(&Place(index)) {
                let (turned, other) = (self.turned[pair].clone(), self.pair());
                let (with_sin, with_cos) = (self.value(*a), self.value(*b));
                let newest = local("b", index);
                self.lines
                    .extend(quote!(let #newest = [#with_sin, #with_cos]; #other[k] = #newest;));
                self.paired.extend([(*a, quote!(#other[k][0])), (*b, quote!(#other[k][1]))]);
                self.name(Place(index), &quote!(series::dot(&#turned, &#other, #newest, order)));
                continue;
            }
            match *op {
                Op::Load(Symbol::Auxiliary(rate)) => {
                    let carried = plan.carried[rate];
                    let value = if plan.parameter_only[carried.0] {
                        let scalar = self.analysis.scalar();
                        quote!(#scalar::from_f64(0.0))
                    } else {
                        let series = self.whole(carried);
                        quote!(series::rate_of(&#series, order))
                    };
                    self.name(Place(index), &value);
                }
                _ => self.operation(Place(index)),
            }
        }
    }

    /// Returns the statements that compute the mass matrix at the start of the step as `masses`.
    fn masses_at_start(&self, motion: &Motion) -> TokenStream {
        let count = motion.mass_matrix.len();
        let roots: Vec<Id> =
            (0..count).flat_map(|i| motion.mass_matrix[i][..=i].iter().copied()).collect();
        let program = schedule::program(&self.analysis.graph, &roots);
        let known = |angle: Place| match program.ops[angle.0] {
            Op::Load(symbol @ Symbol::Coordinate(_)) => {
                self.turned.iter().find_map(|(pair, series)| {
                    let Op::SinCos(own) = self.program.ops[pair.0] else { return None };
                    matches!(self.program.ops[own.0], Op::Load(other) if other == symbol)
                        .then(|| quote!(#series[0]))
                })
            }
            _ => None,
        };
        // Sine and cosine of an angle from those computed already.
        let pair = |angle: Place| match program.ops[angle.0] {
            Op::Load(_) => known(angle),
            Op::Sub(a, b) => {
                let (a, b) = (known(a)?, known(b)?);
                Some(quote!([#a[0] * #b[1] - #a[1] * #b[0], #a[1] * #b[1] + #a[0] * #b[0]]))
            }
            _ => None,
        };
        let mut lines = TokenStream::new();
        for (index, op) in program.ops.iter().enumerate() {
            let at = |place: Place| {
                let name = local("m", place.0);
                quote!(#name)
            };
            let name = local("m", index);
            let value = match *op {
                Op::SinCos(angle) => pair(angle).unwrap_or_else(|| {
                    let angle = at(angle);
                    quote!({ let (s, c) = #angle.sin_cos(); [s, c] })
                }),
                Op::Call(function @ (Function::Sin | Function::Cos), angle)
                    if pair(angle).is_some() =>
                {
                    let (value, part) = (pair(angle), usize::from(function == Function::Cos));
                    quote!(#value[#part])
                }
                Op::Part(function, pair) => {
                    let (pair, part) = (at(pair), usize::from(function == Function::Cos));
                    quote!(#pair[#part])
                }
                Op::Load(Symbol::Time) => quote!(path.t),
                Op::Load(symbol) => match self.series_of(symbol) {
                    Some(series) => quote!(#series[0]),
                    None => self.analysis.operation(op, at),
                },
                _ => self.analysis.operation(op, at),
            };
            lines.extend(quote!(let #name = #value;));
        }
        let scalar = self.analysis.scalar();
        let mut results = program.results.iter().map(|place| local("m", place.0));
        let rows = (0..count).map(|i| {
            let known: Vec<_> = results.by_ref().take(i + 1).collect();
            let zeros = (i + 1..count).map(|_| quote!(#scalar::from_f64(0.0)));
            quote!([#(#known,)* #(#zeros),*])
        });
        let rows: Vec<_> = rows.collect();
        quote!(#lines let masses = [#(#rows),*];)
    }

    /// Writes the contributions of the accelerations to the newest coefficients.
    fn gains(&mut self, plan: &Plan<'_>, turns: &BTreeMap<Place, TokenStream>) {
        let mut gains: Vec<Option<TokenStream>> = vec![None; plan.program.ops.len()];
        let mut turned: Vec<Place> = Vec::new();
        let sinks: Vec<bool> = self.sinks(plan);
        // A rate may precede its momentum.
        let (momenta, others): (Vec<usize>, Vec<usize>) =
            (0..plan.program.ops.len()).partition(|&index| plan.ahead[index]);
        for index in momenta.into_iter().chain(others) {
            let (place, op) = (Place(index), &plan.program.ops[index]);
            if !(plan.moved[index] || plan.rated[index]) || !sinks[index] {
                continue;
            }
            let known = |gains: &[Option<TokenStream>], place: Place| gains[place.0].clone();
            let gain = if let Some(turn) = plan.turns.get(&place) {
                let (gain, part) =
                    (local("g", turn.coordinate), usize::from(turn.function == Function::Cos));
                let (pair, product) = (&self.turned[&turn.pair], &turns[&turn.pair]);
                if !turned.contains(&turn.pair) {
                    turned.push(turn.pair);
                    self.lines.extend(quote! {
                        #product[k + 1][0] += #gain * #pair[0][0];
                        #product[k + 1][1] += #gain * #pair[0][1];
                    });
                }
                let constants = turn.constants.iter().map(|&constant| self.constant(constant));
                Some(quote!(#gain * #pair[0][#part] #(* #constants)*))
            } else {
                match *op {
                    Op::Load(Symbol::Velocity(coordinate)) => {
                        let gain = local("g", coordinate);
                        gains[index] = Some(quote!(#gain));
                        continue;
                    }
                    Op::Load(Symbol::Auxiliary(rate)) => {
                        let scalar = self.analysis.scalar();
                        known(&gains, plan.carried[rate])
                            .map(|gain| quote!(#scalar::from_f64((k + 1) as ::core::primitive::f64) * #gain))
                    }
                    Op::Negative(a) => known(&gains, a).map(|a| quote!(-#a)),
                    Op::Add(a, b) => match (known(&gains, a), known(&gains, b)) {
                        (Some(a), Some(b)) => Some(quote!(#a + #b)),
                        (a, b) => a.or(b),
                    },
                    Op::Sub(a, b) => match (known(&gains, a), known(&gains, b)) {
                        (Some(a), Some(b)) => Some(quote!(#a - #b)),
                        (a, b) => a.or(b.map(|b| quote!(-#b))),
                    },
                    Op::Mul(a, b) => match (known(&gains, a), known(&gains, b)) {
                        (Some(gain), _) => Some(self.leading_times(&gain, b)),
                        (_, Some(gain)) => Some(self.leading_times(&gain, a)),
                        _ => None,
                    },
                    Op::Div(a, b) => known(&gains, a).map(|a| {
                        let b = self.leading_value(b);
                        quote!(#a / #b)
                    }),
                    _ => None,
                }
            };
            let Some(gain) = gain else { continue };
            let name = local("d", index);
            self.lines.extend(quote!(let #name = #gain;));
            gains[index] = Some(quote!(#name));
            if let Some(series) = self.series.get(&place) {
                let at = if plan.ahead[index] { quote!(k + 1) } else { quote!(k) };
                self.lines.extend(quote!(#series[#at] += #name;));
            }
            for (_, coefficient) in self.paired.iter().filter(|(paired, _)| *paired == place) {
                self.lines.extend(quote!(#coefficient += #name;));
            }
        }
    }

    /// Returns for each operation whether its gain is stored in a series or needed for one that is.
    fn sinks(&self, plan: &Plan<'_>) -> Vec<bool> {
        let mut sinks: Vec<bool> = (0..plan.program.ops.len())
            .map(|index| self.series.contains_key(&Place(index)))
            .collect();
        for (place, turn) in &plan.turns {
            sinks[place.0] |= self.turned.contains_key(&turn.pair);
        }
        for (place, _) in &self.paired {
            sinks[place.0] = true;
        }
        // Two passes, because a rate may precede its momentum.
        for _ in 0..2 {
            for (index, op) in plan.program.ops.iter().enumerate().rev() {
                if sinks[index] {
                    mark(&mut sinks, op);
                }
                if let (Op::Load(Symbol::Auxiliary(rate)), true) = (op, sinks[index]) {
                    sinks[plan.carried[*rate].0] = true;
                }
            }
        }
        sinks
    }

    /// Returns a gain times the leading coefficient of a factor.
    fn leading_times(&mut self, gain: &TokenStream, factor: Place) -> TokenStream {
        let factor = self.leading_value(factor);
        quote!(#gain * #factor)
    }

    /// Returns the leading coefficient of a place.
    fn leading_value(&mut self, place: Place) -> TokenStream {
        if self.parameter_only[place.0] {
            return self.constant(place);
        }
        let series = self.whole(place);
        quote!(#series[0])
    }
}

/// Marks the operands of an operation.
fn mark(marks: &mut [bool], op: &Op) {
    for operand in operands(op) {
        marks[operand.0] = true;
    }
}
