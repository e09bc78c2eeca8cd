//! From the graph to a straight program: binary operations in order, shared ones once.
//!
//! Sums are factored greedily by what most of their terms share, quotients share one division, sine
//! and cosine of one angle come together, and those of a difference of angles are products where
//! both angles are there anyway.

mod cost;
mod product;
mod program;
mod scale;
mod stage;
mod sum;
mod term;

use crate::algebra::expr::{Dependencies, Graph, Id, Node};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
pub use cost::Operations;
pub(crate) use program::{Op, Place, Program, operands};
use program::{mul, prune};
pub(crate) use stage::Stage;
use std::collections::{BTreeMap, BTreeSet};
use term::{Factor, Term};

/// The program that computes `roots`.
pub(crate) fn program(graph: &Graph, roots: &[Id]) -> Program {
    scheduled(graph, roots, true)
}

/// The program whose operations work on series: there sine and cosine cost as much as two products,
/// and a reciprocal is found once.
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

struct Schedule<'g> {
    graph: &'g Graph,
    program: Program,
    done: BTreeMap<Id, Place>,
    /// Angles that are computed from the sines and cosines of two others, with the sign of the
    /// second.
    differences: BTreeMap<Id, (Id, Id, bool)>,
    /// Angles whose sine and cosine are both needed.
    pairs: BTreeSet<Id>,
    /// The constants that sums take in, and the sums with theirs that are done.
    scales: Vec<Term>,
    scaled: BTreeMap<(Id, usize), (Place, bool)>,
    /// In how many products and sums each sum stands.
    uses: BTreeMap<Id, usize>,
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
                let terms =
                    terms.iter().map(|&(term, coefficient)| self.term(term, coefficient)).collect();
                let (place, negative) = self.sum(terms);
                if negative { self.program.push(Op::Negative(place)) } else { place }
            }
            Node::Product(coefficient, factors) => {
                let factors = factors
                    .into_iter()
                    .map(|(id, exponent)| (Factor::plain(id), exponent))
                    .collect();
                let (place, negative) = self.product(&Term { coefficient, factors });
                if negative { self.program.push(Op::Negative(place)) } else { place }
            }
            Node::Call(function @ (Function::Sin | Function::Cos), argument) => {
                self.trigonometric(function, argument)
            }
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
        Term {
            coefficient,
            factors: factors
                .into_iter()
                .map(|(id, exponent)| (Factor::plain(id), exponent))
                .collect(),
        }
    }

    fn trigonometric(&mut self, function: Function, angle: Id) -> Place {
        if let Some(&(a, b, minus)) = self.differences.get(&angle) {
            let [sa, ca, sb, cb] =
                [(Function::Sin, a), (Function::Cos, a), (Function::Sin, b), (Function::Cos, b)]
                    .map(|(function, angle)| self.trigonometric(function, angle));
            let (left, right, plus) = match function {
                Function::Sin => {
                    (self.program.push(mul(sa, cb)), self.program.push(mul(ca, sb)), !minus)
                }
                _ => (self.program.push(mul(ca, cb)), self.program.push(mul(sa, sb)), minus),
            };
            return self.program.push(if plus {
                Op::Add(left, right)
            } else {
                Op::Sub(left, right)
            });
        }
        let argument = self.value(angle);
        if self.pairs.contains(&angle) {
            let both = self.program.push(Op::SinCos(argument));
            return self.program.push(Op::Part(function, both));
        }
        self.program.push(Op::Call(function, argument))
    }

    /// Returns true if an expression is made of parameters and numbers alone.
    fn parameter_only(&self, id: Id) -> bool {
        let dependencies = self.graph.dependencies(id);
        !dependencies.any(Dependencies::STATE)
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
}
