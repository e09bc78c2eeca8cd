//! From the graph to a straight program: binary operations in order, shared ones once.
//!
//! Sums are factored greedily by what most of their terms share, quotients share one division, sine and cosine of one angle come
//! together, and those of a difference of angles are products where both angles are there anyway.

use crate::ast::Literal;
use crate::expr::{Contents, Function, Graph, Id, Node, Symbol};
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

/// What has to be known before an operation can be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stage {
    Numbers,
    Parameters,
    /// The time and the driven inputs, without parameters: the same for all systems on a joint.
    Time,
    Position,
    Velocity,
}

impl Stage {
    /// The stage of an operation with operands of two stages.
    fn with(self, other: Self) -> Self {
        match self.max(other) {
            Stage::Time if self.min(other) == Stage::Parameters => Stage::Position,
            later => later,
        }
    }
}

impl Count {
    /// What the operations cost, in multiplications.
    pub(crate) fn cost(self) -> usize {
        self.mul + self.add + 4 * self.div + 20 * (self.sincos + self.functions)
    }
}

impl Program {
    /// The operations of one evaluation, after what parameters alone decide has been prepared.
    pub(crate) fn count(&self) -> Count {
        let mut count = Count::default();
        let still = self.still();
        for (op, _) in self.ops.iter().zip(still).filter(|(_, still)| !still) {
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

    /// Whether each operation is made of parameters and numbers alone.
    pub(crate) fn still(&self) -> Vec<bool> {
        self.stages().into_iter().map(|stage| stage <= Stage::Parameters).collect()
    }

    /// When each operation can be done first.
    fn stages(&self) -> Vec<Stage> {
        let mut stages: Vec<Stage> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let own = match op {
                Op::Load(symbol) => match symbol {
                    Symbol::Parameter(_) | Symbol::Moment(..) => Stage::Parameters,
                    Symbol::Time | Symbol::Input { .. } => Stage::Time,
                    Symbol::Coordinate(_) => Stage::Position,
                    Symbol::Velocity(_) | Symbol::Momentum(_) | Symbol::Auxiliary(_) | Symbol::Point(..) => Stage::Velocity,
                },
                _ => operands(op).iter().map(|place| stages[place.0]).fold(Stage::Numbers, Stage::with),
            };
            stages.push(own);
        }
        stages
    }

    /// What can be done up to a stage and is read after it: the places that are worth keeping.
    pub(crate) fn kept(&self, stage: Stage) -> Vec<Place> {
        let stages = self.stages();
        let before = |own: Stage| own == Stage::Numbers || own == stage;
        let mut read = vec![false; self.ops.len()];
        for (op, _) in self.ops.iter().zip(&stages).filter(|&(_, &own)| !before(own)) {
            for place in operands(op) {
                read[place.0] = true;
            }
        }
        for result in &self.results {
            read[result.0] = true;
        }
        let worth = |index: &usize| {
            let leaf = match self.ops[*index] {
                Op::Load(symbol) => !matches!(symbol, Symbol::Moment(..)),
                Op::Number(_) | Op::Literal(_) | Op::Pi => true,
                // A pair is kept by its parts.
                Op::SinCos(_) => true,
                _ => false,
            };
            let own = stages[*index];
            (own == stage || own == Stage::Numbers && stage == Stage::Parameters) && read[*index] && !leaf
        };
        (0..self.ops.len()).filter(worth).map(Place).collect()
    }

    /// The same values, with products by reciprocals for quotients by what parameters alone decide.
    fn with_reciprocals(self) -> Self {
        let still = self.still();
        let mut program = Self::default();
        let mut moved: Vec<Place> = Vec::with_capacity(self.ops.len());
        for (index, op) in self.ops.into_iter().enumerate() {
            let place = match op {
                Op::Div(a, b) if !still[index] && still[b.0] => {
                    let one = program.push(Op::Number(Rational::ONE));
                    let reciprocal = program.push(Op::Div(one, moved[b.0]));
                    program.push(mul(moved[a.0], reciprocal))
                }
                op => program.push(renumber(op, &moved)),
            };
            moved.push(place);
        }
        program.results = self.results.iter().map(|result| moved[result.0]).collect();
        program
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
    scheduled(graph, roots, true)
}

/// The program whose operations work on series: there sine and cosine cost as much as two products, and a reciprocal is found once.
pub(crate) fn of_series(graph: &Graph, roots: &[Id]) -> Program {
    scheduled(graph, roots, false).with_reciprocals()
}

/// The program; differences of angles may be taken apart.
fn scheduled(graph: &Graph, roots: &[Id], apart: bool) -> Program {
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
        scales: Vec::new(),
        scaled: BTreeMap::new(),
        uses: BTreeMap::new(),
    };
    schedule.count_uses(roots);
    schedule.angles(&angles, apart);
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

/// Polynomials are nested as Horner does down to this depth, and no deeper: the stack is finite.
const DEPTH: usize = 64;

struct Schedule<'g> {
    graph: &'g Graph,
    program: Program,
    done: BTreeMap<Id, Place>,
    /// Angles that are computed from the sines and cosines of two others, with the sign of the second.
    differences: BTreeMap<Id, (Id, Id, bool)>,
    /// Angles whose sine and cosine are both needed.
    pairs: BTreeSet<Id>,
    /// The constants that sums take in, and the sums with theirs that are done.
    scales: Vec<Term>,
    scaled: BTreeMap<(Id, usize), (Place, bool)>,
    /// In how many products and sums each sum stands.
    uses: BTreeMap<Id, usize>,
}

/// A product on its way into a sum.
#[derive(Clone, Debug, PartialEq)]
struct Term {
    coefficient: Rational,
    factors: Vec<(Factor, Rational)>,
}

/// A factor of a product; a sum may stand for itself times a constant that its own constants take in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Factor {
    id: Id,
    /// The constant, by its place in `Schedule::scales`.
    scale: Option<usize>,
}

impl Factor {
    fn plain(id: Id) -> Self {
        Self { id, scale: None }
    }
}

impl Schedule<'_> {
    /// Decides how each sine and cosine is computed.
    fn angles(&mut self, angles: &BTreeMap<Id, BTreeSet<Function>>, apart: bool) {
        for (&angle, functions) in angles {
            if functions.len() == 2 {
                self.pairs.insert(angle);
            }
            if apart
                && let Node::Sum(terms) = self.graph.node(angle)
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
                let factors = factors.into_iter().map(|(id, exponent)| (Factor::plain(id), exponent)).collect();
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
        Term { coefficient, factors: factors.into_iter().map(|(id, exponent)| (Factor::plain(id), exponent)).collect() }
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
    fn sum(&mut self, terms: Vec<Term>) -> (Place, bool) {
        self.nested_sum(terms, 0)
    }

    /// A sum that stands in `depth` others, each with a factor drawn before it.
    fn nested_sum(&mut self, mut terms: Vec<Term>, depth: usize) -> (Place, bool) {
        let mut parts: Vec<(Place, bool)> = Vec::new();
        while depth < DEPTH
            && let Some((factor, shared)) = self.most_shared(&terms)
        {
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
            let (sum, negative) = self.nested_sum(inner, depth + 1);
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
    ///
    /// What does not move stands together: it is computed once by whoever prepares it.
    fn product(&mut self, term: &Term) -> (Place, bool) {
        let (still, mut moving) = self.split(term);
        let mut negative = term.coefficient.is_negative();
        let mut still = Some(still).filter(|still| *still != unit());
        if let Some(constant) = &still
            && constant.coefficient.within(60).is_some()
            && let Some(index) =
                moving.iter().position(|&(factor, exponent)| exponent == Rational::ONE && self.takes_in(factor.id, 1))
            && moving[index].0.scale.is_none()
        {
            let scale = self.scale(constant.clone());
            moving[index].0.scale = Some(scale);
            still = None;
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (factor, exponent) in moving {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            side.push((self.rank(factor.id), factor, exponent.abs()));
        }
        let top = self.side(above, &mut negative);
        let bottom = self.side(below, &mut negative);
        let constant = still.map(|still| self.constant(&still));
        let top = match (constant, top) {
            (Some(constant), Some(top)) => Some(self.program.push(mul(constant, top))),
            (constant, top) => constant.or(top),
        };
        let place = match (top, bottom) {
            (Some(top), Some(bottom)) => self.program.push(Op::Div(top, bottom)),
            (Some(top), None) => top,
            (None, bottom) => {
                let one = self.program.push(Op::Number(Rational::ONE));
                match bottom {
                    Some(bottom) => self.program.push(Op::Div(one, bottom)),
                    None => one,
                }
            }
        };
        (place, negative)
    }

    /// The magnitude of what does not move in a product, and its other factors.
    fn split(&self, term: &Term) -> (Term, Vec<(Factor, Rational)>) {
        let (factors, moving) = term.factors.iter().partition(|(factor, _)| factor.scale.is_none() && self.still(factor.id));
        (Term { coefficient: term.coefficient.abs(), factors }, moving)
    }

    /// Whether an expression is made of parameters and numbers alone.
    fn still(&self, id: Id) -> bool {
        let contents = self.graph.contents(id);
        !contents.any(Contents::STATE)
    }

    /// A product of parameters and numbers.
    fn constant(&mut self, term: &Term) -> Place {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &(factor, exponent) in &term.factors {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            side.push((0, factor, exponent.abs()));
        }
        let mut sign = false;
        let top = self.side(above, &mut sign);
        let bottom = self.side(below, &mut sign);
        let top = match top {
            Some(top) if term.coefficient == Rational::ONE => top,
            Some(top) => {
                let number = self.program.push(Op::Number(term.coefficient));
                self.program.push(mul(number, top))
            }
            None => self.program.push(Op::Number(term.coefficient)),
        };
        match bottom {
            Some(bottom) => self.program.push(Op::Div(top, bottom)),
            None => top,
        }
    }

    /// The product of some positive powers.
    fn side(&mut self, mut factors: Vec<(u8, Factor, Rational)>, negative: &mut bool) -> Option<Place> {
        factors.sort_unstable();
        let mut product: Option<Place> = None;
        for (_, factor, exponent) in factors {
            let power = match factor.scale {
                None => self.power(factor.id, exponent),
                Some(scale) => {
                    let (place, flipped) = self.scaled_sum(factor.id, scale);
                    *negative ^= flipped;
                    place
                }
            };
            product = Some(match product {
                Some(product) => self.program.push(mul(product, power)),
                None => power,
            });
        }
        product
    }

    /// A sum each of whose terms has taken in a constant.
    fn scaled_sum(&mut self, sum: Id, scale: usize) -> (Place, bool) {
        if let Some(&done) = self.scaled.get(&(sum, scale)) {
            return done;
        }
        let Some(terms) = self.terms(sum) else { return (self.value(sum), false) };
        let constant = self.scales[scale].clone();
        let mut scaled = Vec::new();
        for (id, coefficient) in terms {
            let mut term = self.term(id, coefficient);
            let inner =
                term.factors.iter().position(|&(factor, exponent)| exponent == Rational::ONE && self.takes_in(factor.id, 2));
            if let Some(index) = inner {
                term.factors[index].0.scale = Some(scale);
            } else {
                term.coefficient = term.coefficient.mul(constant.coefficient).unwrap_or(term.coefficient);
                for &(factor, exponent) in &constant.factors {
                    multiply(&mut term.factors, factor, exponent);
                }
            }
            scaled.push(term);
        }
        let done = self.sum(scaled);
        self.scaled.insert((sum, scale), done);
        done
    }

    /// Whether a sum is the better for taking in a constant: every term has a constant of its own, or a sum that takes it in.
    ///
    /// A sum that stands in more than `most` places is left alone: it would be computed twice.
    fn takes_in(&self, id: Id, most: usize) -> bool {
        let Some(terms) = self.terms(id) else { return false };
        if self.still(id) || most < self.uses.get(&id).copied().unwrap_or(0) {
            return false;
        }
        let terms = &terms;
        terms.iter().all(|&(term, coefficient)| {
            if coefficient.within(60).is_none() {
                return false;
            }
            let factors = self.graph.factors(term);
            let constant =
                coefficient.abs() != Rational::ONE || term == Graph::ONE || factors.iter().any(|&(base, _)| self.still(base));
            constant
                || factors
                    .iter()
                    .any(|&(base, exponent)| exponent == Rational::ONE && self.takes_in(base, self.occurrences(base, terms)))
        })
    }

    /// The terms of a sum, closed or not.
    fn terms(&self, id: Id) -> Option<Vec<(Id, Rational)>> {
        match self.graph.node(id) {
            Node::Sum(terms) => Some(terms.clone()),
            Node::Atom(inner) if self.uses.get(inner).copied().unwrap_or(0) < 2 => self.terms(*inner),
            _ => None,
        }
    }

    /// The number of terms of a sum in which a factor stands.
    fn occurrences(&self, id: Id, terms: &[(Id, Rational)]) -> usize {
        terms.iter().filter(|&&(term, _)| self.graph.factors(term).iter().any(|&(base, _)| base == id)).count()
    }

    fn scale(&mut self, constant: Term) -> usize {
        if let Some(known) = self.scales.iter().position(|scale| *scale == constant) {
            return known;
        }
        self.scales.push(constant);
        self.scales.len() - 1
    }

    fn count_uses(&mut self, roots: &[Id]) {
        for id in self.graph.reachable(roots) {
            for child in self.graph.children(id) {
                *self.uses.entry(child).or_default() += 1;
            }
        }
        for &root in roots {
            *self.uses.entry(root).or_default() += 1;
        }
    }

    /// The factor that is best drawn before a sum, and the terms in which it stands.
    ///
    /// A factor that moves saves a multiplication in all terms but one; a constant only in those that have no other.
    fn most_shared(&self, terms: &[Term]) -> Option<((Factor, Rational), BTreeSet<usize>)> {
        let mut shared: BTreeMap<(Factor, bool), BTreeSet<usize>> = BTreeMap::new();
        for (index, term) in terms.iter().enumerate() {
            // Differences of these exponents are exact.
            for &(factor, exponent) in term.factors.iter().filter(|(_, exponent)| exponent.within(30).is_some()) {
                shared.entry((factor, exponent.is_negative())).or_default().insert(index);
            }
        }
        let mut best: Option<(usize, (Factor, bool), BTreeSet<usize>)> = None;
        for (key, places) in shared {
            let still = key.0.scale.is_none() && self.still(key.0.id);
            let saved = if still {
                let alone = |&&index: &&usize| {
                    let (constant, _) = self.split(&terms[index]);
                    constant.coefficient == Rational::ONE && constant.factors.len() == 1
                };
                places.iter().filter(alone).count()
            } else {
                places.len()
            };
            if 2 <= saved && best.as_ref().is_none_or(|(other, ..)| *other < saved) {
                best = Some((saved, key, places));
            }
        }
        let (_, (factor, negative), places) = best?;
        let exponents = places.iter().filter_map(|&index| {
            let found =
                terms[index].factors.iter().find(|(other, exponent)| *other == factor && exponent.is_negative() == negative);
            found.map(|&(_, exponent)| exponent)
        });
        let exponent = exponents.reduce(|a, b| if b.abs().less(a.abs()) { b } else { a })?;
        Some(((factor, exponent), places))
    }

    /// What changes least comes first in a product.
    fn rank(&self, base: Id) -> u8 {
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

/// Divides a product by one of its factors.
fn take(factors: &mut Vec<(Factor, Rational)>, (factor, exponent): (Factor, Rational)) {
    multiply(factors, factor, exponent.negative());
}

/// Multiplies a product by a power.
fn multiply(factors: &mut Vec<(Factor, Rational)>, factor: Factor, exponent: Rational) {
    let own = factors.iter_mut().find(|(other, _)| *other == factor);
    match own.and_then(|(_, own)| own.add(exponent).map(|total| (own, total))) {
        Some((own, total)) => *own = total,
        // An exponent that cannot be added stands beside the other.
        None => factors.push((factor, exponent)),
    }
    factors.retain(|(_, exponent)| !exponent.is_zero());
}

/// The empty product.
fn unit() -> Term {
    Term { coefficient: Rational::ONE, factors: Vec::new() }
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
