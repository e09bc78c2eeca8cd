//! From the graph to a straight program: binary operations in order, shared ones once.
//!
//! Sums are factored greedily by what most of their terms share, quotients share one division, sine and cosine of one angle come
//! together, and those of a difference of angles are products where both angles are there anyway.

use crate::ast::Literal;
use crate::expr::{Function, Graph, Id, Node, Symbol};
use crate::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// The place of an operation in its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place(pub(crate) usize);

/// An operation; its operands stand before it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Op {
    Number(Rational),
    Literal(Literal),
    Pi,
    Load(Symbol),
    Negative(Place),
    Add(Place, Place),
    Sub(Place, Place),
    Mul(Place, Place),
    Div(Place, Place),
    Sqrt(Place),
    Powf(Place, Place),
    Atan2(Place, Place),
    Max(Place, Place),
    Call(Function, Place),
    /// Sine and cosine of one angle, which `Part`s take apart.
    SinCos(Place),
    Part(Function, Place),
}

/// The operations of one output.
#[derive(Debug, Default)]
pub(crate) struct Program {
    pub(crate) ops: Vec<Op>,
    pub(crate) results: Vec<Place>,
    places: BTreeMap<Op, Place>,
}

/// How many of each operation a program has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    pub(crate) sincos: usize,
    pub(crate) functions: usize,
    pub(crate) mul: usize,
    pub(crate) add: usize,
    pub(crate) div: usize,
}

impl Program {
    pub(crate) fn count(&self) -> Count {
        let mut count = Count::default();
        for op in &self.ops {
            match op {
                Op::SinCos(_) | Op::Call(Function::Sin | Function::Cos, _) => count.sincos += 1,
                Op::Mul(..) => count.mul += 1,
                Op::Add(..) | Op::Sub(..) => count.add += 1,
                Op::Div(..) => count.div += 1,
                Op::Sqrt(_) | Op::Powf(..) | Op::Atan2(..) | Op::Max(..) | Op::Call(..) => count.functions += 1,
                Op::Number(_) | Op::Literal(_) | Op::Pi | Op::Load(_) | Op::Negative(_) | Op::Part(..) => {}
            }
        }
        count
    }

    fn push(&mut self, op: Op) -> Place {
        if let Some(&place) = self.places.get(&op) {
            return place;
        }
        let place = Place(self.ops.len());
        self.ops.push(op.clone());
        self.places.insert(op, place);
        place
    }
}

/// The program that computes `roots`.
pub(crate) fn program(graph: &Graph, roots: &[Id]) -> Program {
    let mut angles: BTreeMap<Id, BTreeSet<Function>> = BTreeMap::new();
    for id in graph.reachable(roots) {
        if let Node::Call(function @ (Function::Sin | Function::Cos), argument) = *graph.node(id) {
            angles.entry(argument).or_default().insert(function);
        }
    }
    let mut schedule = Schedule {
        graph,
        program: Program::default(),
        done: BTreeMap::new(),
        differences: BTreeMap::new(),
        pairs: BTreeSet::new(),
    };
    schedule.angles(&angles);
    // Children have smaller ids: going up in order keeps the recursion shallow.
    for id in schedule.graph.reachable(roots) {
        if matches!(schedule.graph.node(id), Node::Atom(_) | Node::Call(..)) {
            schedule.value(id);
        }
    }
    let results = roots.iter().map(|&root| schedule.value(root)).collect();
    schedule.program.results = results;
    prune(schedule.program)
}

struct Schedule<'g> {
    graph: &'g Graph,
    program: Program,
    done: BTreeMap<Id, Place>,
    /// Angles that are computed from the sines and cosines of two others, with the sign of the second.
    differences: BTreeMap<Id, (Id, Id, bool)>,
    /// Angles whose sine and cosine are both needed.
    pairs: BTreeSet<Id>,
}

/// A product on its way into a sum.
#[derive(Clone, Debug)]
struct Term {
    coefficient: Rational,
    factors: Vec<(Id, Rational)>,
}

impl Schedule<'_> {
    /// Decides how each sine and cosine is computed.
    fn angles(&mut self, angles: &BTreeMap<Id, BTreeSet<Function>>) {
        for (&angle, functions) in angles {
            if functions.len() == 2 {
                self.pairs.insert(angle);
            }
            if let Node::Sum(terms) = self.graph.node(angle)
                && let [(a, Rational::ONE), (b, sign)] = terms[..]
                && sign.abs() == Rational::ONE
                && angles.contains_key(&a)
                && angles.contains_key(&b)
            {
                self.differences.insert(angle, (a, b, sign.is_negative()));
            }
        }
        for (a, b, _) in self.differences.values().copied().collect::<Vec<_>>() {
            self.pairs.extend([a, b]);
        }
    }

    fn value(&mut self, id: Id) -> Place {
        if let Some(&place) = self.done.get(&id) {
            return place;
        }
        let place = match self.graph.node(id).clone() {
            Node::Number(value) => self.number(value),
            Node::Opaque(literal) => self.program.push(Op::Literal(literal)),
            Node::Pi => self.program.push(Op::Pi),
            Node::Symbol(symbol) => self.program.push(Op::Load(symbol)),
            Node::Sum(terms) => {
                let terms = terms.iter().map(|&(term, coefficient)| self.term(term, coefficient)).collect();
                let (place, negative) = self.sum(terms);
                if negative { self.program.push(Op::Negative(place)) } else { place }
            }
            Node::Product(coefficient, factors) => {
                let (place, negative) = self.product(&Term { coefficient, factors });
                if negative { self.program.push(Op::Negative(place)) } else { place }
            }
            Node::Call(function @ (Function::Sin | Function::Cos), argument) => self.trigonometric(function, argument),
            Node::Call(function, argument) => {
                let argument = self.value(argument);
                self.program.push(Op::Call(function, argument))
            }
            Node::Atan2(y, x) => {
                let (y, x) = (self.value(y), self.value(x));
                self.program.push(Op::Atan2(y, x))
            }
            Node::Max(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.program.push(Op::Max(a, b))
            }
            Node::Atom(inner) => self.value(inner),
        };
        self.done.insert(id, place);
        place
    }

    fn number(&mut self, value: Rational) -> Place {
        if value.is_negative() {
            let positive = self.program.push(Op::Number(value.negative()));
            return self.program.push(Op::Negative(positive));
        }
        self.program.push(Op::Number(value))
    }

    fn term(&self, term: Id, coefficient: Rational) -> Term {
        let factors = if term == Graph::ONE { Vec::new() } else { self.graph.factors(term) };
        Term { coefficient, factors }
    }

    fn trigonometric(&mut self, function: Function, angle: Id) -> Place {
        if let Some(&(a, b, minus)) = self.differences.get(&angle) {
            let [sa, ca, sb, cb] = [(Function::Sin, a), (Function::Cos, a), (Function::Sin, b), (Function::Cos, b)]
                .map(|(function, angle)| self.trigonometric(function, angle));
            let (left, right, plus) = match function {
                Function::Sin => (self.program.push(mul(sa, cb)), self.program.push(mul(ca, sb)), !minus),
                _ => (self.program.push(mul(ca, cb)), self.program.push(mul(sa, sb)), minus),
            };
            return self.program.push(if plus { Op::Add(left, right) } else { Op::Sub(left, right) });
        }
        let argument = self.value(angle);
        if self.pairs.contains(&angle) {
            let both = self.program.push(Op::SinCos(argument));
            return self.program.push(Op::Part(function, both));
        }
        self.program.push(Op::Call(function, argument))
    }

    /// A sum of products, and whether its value is the negative of the place.
    fn sum(&mut self, mut terms: Vec<Term>) -> (Place, bool) {
        let mut parts: Vec<(Place, bool)> = Vec::new();
        while let Some((factor, shared)) = most_shared(&terms) {
            let mut inner = Vec::new();
            let mut rest = Vec::new();
            for (index, mut term) in terms.into_iter().enumerate() {
                if shared.contains(&index) {
                    take(&mut term.factors, factor);
                    inner.push(term);
                } else {
                    rest.push(term);
                }
            }
            let common = common_coefficient(&inner);
            for term in &mut inner {
                term.coefficient = term.coefficient.mul(common.reciprocal().unwrap_or(Rational::ONE)).unwrap_or(term.coefficient);
            }
            let (sum, negative) = self.sum(inner);
            let (outer, flipped) = self.product(&Term { coefficient: common, factors: vec![factor] });
            let place = self.program.push(mul(outer, sum));
            parts.push((place, negative != flipped));
            terms = rest;
        }
        for term in &terms {
            let part = self.product(term);
            parts.push(part);
        }
        // Begin with a positive part, so that no negation is needed.
        let first = parts.iter().position(|&(_, negative)| !negative);
        let (start, flipped) = match first {
            Some(index) => (parts.remove(index).0, false),
            None => (parts.remove(0).0, true),
        };
        let mut total = start;
        for (part, negative) in parts {
            total = self.program.push(if negative == flipped { add(total, part) } else { Op::Sub(total, part) });
        }
        (total, flipped)
    }

    /// A product without its sign, and whether that is minus.
    fn product(&mut self, term: &Term) -> (Place, bool) {
        let negative = term.coefficient.is_negative();
        let coefficient = term.coefficient.abs();
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &(base, exponent) in &term.factors {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            side.push((self.rank(base), base, exponent.abs()));
        }
        above.sort_unstable();
        below.sort_unstable();
        let mut top: Option<Place> = None;
        for (_, base, exponent) in above {
            let power = self.power(base, exponent);
            top = Some(match top {
                Some(product) => self.program.push(mul(product, power)),
                None => power,
            });
        }
        let mut bottom: Option<Place> = None;
        for (_, base, exponent) in below {
            let power = self.power(base, exponent);
            bottom = Some(match bottom {
                Some(product) => self.program.push(mul(product, power)),
                None => power,
            });
        }
        if coefficient != Rational::ONE || top.is_none() {
            let number = self.program.push(Op::Number(coefficient));
            top = Some(match top {
                Some(product) => self.program.push(mul(number, product)),
                None => number,
            });
        }
        let place = match (top, bottom) {
            (Some(top), Some(bottom)) => self.program.push(Op::Div(top, bottom)),
            (Some(top), None) => top,
            (None, _) => self.program.push(Op::Number(coefficient)),
        };
        (place, negative)
    }

    /// Parameters come first in a product: what does not move is computed once by whoever hoists it.
    fn rank(&self, base: Id) -> u8 {
        use crate::expr::Contents;
        let contents = self.graph.contents(base);
        if contents.any(Contents::VELOCITY.or(Contents::MOMENTUM)) {
            3
        } else if contents.any(Contents::COORDINATE) {
            2
        } else {
            u8::from(contents.any(Contents::TIME.or(Contents::INPUT)))
        }
    }

    /// A positive power: repeated squares, a square root for a half, `powf` for the rest.
    fn power(&mut self, base: Id, exponent: Rational) -> Place {
        let value = self.value(base);
        let whole = exponent.numerator() / exponent.denominator();
        let fraction = exponent.add(Rational::whole(i64::try_from(whole).unwrap_or(0)).negative());
        match (i64::try_from(whole), fraction) {
            (Ok(whole), Some(fraction)) if whole <= 64 && fraction.is_zero() => self.whole_power(value, whole),
            (Ok(whole), Some(fraction)) if whole <= 64 && fraction == Rational::HALF => {
                let root = self.program.push(Op::Sqrt(value));
                if whole == 0 {
                    return root;
                }
                let power = self.whole_power(value, whole);
                self.program.push(mul(power, root))
            }
            _ => {
                let exponent = self.program.push(Op::Number(exponent));
                self.program.push(Op::Powf(value, exponent))
            }
        }
    }

    fn whole_power(&mut self, value: Place, exponent: i64) -> Place {
        match exponent {
            0 => self.program.push(Op::Number(Rational::ONE)),
            1 => value,
            _ => {
                let half = self.whole_power(value, exponent / 2);
                let square = self.program.push(Op::Mul(half, half));
                if exponent % 2 == 0 { square } else { self.program.push(mul(square, value)) }
            }
        }
    }
}

/// Products and sums commute: one order, so that equal ones are found.
fn mul(a: Place, b: Place) -> Op {
    Op::Mul(a.min(b), a.max(b))
}

fn add(a: Place, b: Place) -> Op {
    Op::Add(a.min(b), a.max(b))
}

/// The factor that stands in most terms, if it stands in two, and the terms in which it does.
fn most_shared(terms: &[Term]) -> Option<((Id, Rational), BTreeSet<usize>)> {
    let mut shared: BTreeMap<(Id, bool), BTreeSet<usize>> = BTreeMap::new();
    for (index, term) in terms.iter().enumerate() {
        for &(base, exponent) in &term.factors {
            shared.entry((base, exponent.is_negative())).or_default().insert(index);
        }
    }
    let mut best: Option<((Id, bool), BTreeSet<usize>)> = None;
    for (key, places) in shared {
        if 2 <= places.len() && best.as_ref().is_none_or(|(_, other)| other.len() < places.len()) {
            best = Some((key, places));
        }
    }
    let ((base, negative), places) = best?;
    let exponents = places.iter().filter_map(|&index| {
        terms[index]
            .factors
            .iter()
            .find(|(other, exponent)| *other == base && exponent.is_negative() == negative)
            .map(|&(_, exponent)| exponent)
    });
    let exponent = exponents.reduce(|a, b| if b.abs().less(a.abs()) { b } else { a })?;
    Some(((base, exponent), places))
}

/// Divides a product by one of its factors.
fn take(factors: &mut Vec<(Id, Rational)>, (base, exponent): (Id, Rational)) {
    for factor in factors.iter_mut() {
        if factor.0 == base {
            factor.1 = factor.1.add(exponent.negative()).unwrap_or(factor.1);
        }
    }
    factors.retain(|(_, exponent)| !exponent.is_zero());
}

/// The coefficient that all terms share up to sign; one otherwise.
fn common_coefficient(terms: &[Term]) -> Rational {
    let first = terms[0].coefficient;
    if terms.iter().all(|term| term.coefficient.abs() == first.abs()) { first } else { Rational::ONE }
}

/// Leaves out what no result needs.
fn prune(program: Program) -> Program {
    let mut needed = vec![false; program.ops.len()];
    for result in &program.results {
        needed[result.0] = true;
    }
    for index in (0..program.ops.len()).rev() {
        if needed[index] {
            for operand in operands(&program.ops[index]) {
                needed[operand.0] = true;
            }
        }
    }
    let mut moved = vec![Place(0); program.ops.len()];
    let mut pruned = Program::default();
    for (index, op) in program.ops.into_iter().enumerate() {
        if needed[index] {
            moved[index] = pruned.push(renumber(op, &moved));
        }
    }
    pruned.results = program.results.iter().map(|result| moved[result.0]).collect();
    pruned
}

/// The places that an operation reads.
pub(crate) fn operands(op: &Op) -> Vec<Place> {
    match *op {
        Op::Number(_) | Op::Literal(_) | Op::Pi | Op::Load(_) => Vec::new(),
        Op::Negative(a) | Op::Sqrt(a) | Op::Call(_, a) | Op::SinCos(a) | Op::Part(_, a) => vec![a],
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Powf(a, b) | Op::Atan2(a, b) | Op::Max(a, b) => {
            vec![a, b]
        }
    }
}

fn renumber(op: Op, moved: &[Place]) -> Op {
    let at = |place: Place| moved[place.0];
    match op {
        Op::Number(_) | Op::Literal(_) | Op::Pi | Op::Load(_) => op,
        Op::Negative(a) => Op::Negative(at(a)),
        Op::Sqrt(a) => Op::Sqrt(at(a)),
        Op::Call(function, a) => Op::Call(function, at(a)),
        Op::SinCos(a) => Op::SinCos(at(a)),
        Op::Part(function, a) => Op::Part(function, at(a)),
        Op::Add(a, b) => Op::Add(at(a), at(b)),
        Op::Sub(a, b) => Op::Sub(at(a), at(b)),
        Op::Mul(a, b) => Op::Mul(at(a), at(b)),
        Op::Div(a, b) => Op::Div(at(a), at(b)),
        Op::Powf(a, b) => Op::Powf(at(a), at(b)),
        Op::Atan2(a, b) => Op::Atan2(at(a), at(b)),
        Op::Max(a, b) => Op::Max(at(a), at(b)),
    }
}
