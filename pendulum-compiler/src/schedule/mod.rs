//! From the graph to a straight-line program: binary operations in order, with shared ones computed
//! once.
//!
//! Sums are factored greedily by the factors that most of their terms share. Quotients share a
//! single division. Sine and cosine of an angle are computed together. Sine and cosine of a
//! difference of angles are computed as products if those of both angles are needed anyway.

mod cost;
mod product;
mod program;
mod rest;
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
use rest::Small;
pub(crate) use stage::Stage;
use std::collections::{BTreeMap, BTreeSet};
use term::{Factor, Term};

/// Returns the program that computes `roots`.
pub(crate) fn program(graph: &Graph, roots: &[Id]) -> Program {
    scheduled(graph, roots, true, false)
}

/// Returns the cost of one evaluation of `roots`, as [`Program::cost`].
pub(crate) fn cost(graph: &Graph, roots: &[Id]) -> usize {
    program(graph, roots).cost()
}

/// Returns the program that computes derivatives of accelerations. Norms of positions are kept off
/// zero as those of velocities are, which accelerations themselves need not.
pub(crate) fn of_derivatives(graph: &Graph, roots: &[Id]) -> Program {
    scheduled(graph, roots, true, true)
}

/// Returns the program for series. For series, sine and cosine cost as much as two products, and
/// reciprocals of parameters are computed once.
pub(crate) fn of_series(graph: &Graph, roots: &[Id]) -> Program {
    scheduled(graph, roots, false, false).with_reciprocals()
}

/// Returns the program. If `apart` is set, sines and cosines of sums and differences of angles may
/// be computed from those of the angles. If `positions` is set, norms of positions are kept off zero.
fn scheduled(graph: &Graph, roots: &[Id], apart: bool, positions: bool) -> Program {
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
        degrees: BTreeMap::new(),
        positions,
    };
    schedule.count_uses(roots);
    schedule.angles(&angles, apart);
    // Children have smaller ids, so that the ascending order keeps the recursion shallow.
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
    /// Angles whose sine and cosine are computed from those of two other angles; `true` if the
    /// second angle is subtracted.
    differences: BTreeMap<Id, (Id, Id, bool)>,
    /// Angles whose sine and cosine are both needed.
    pairs: BTreeSet<Id>,
    /// The constants distributed into sums; `scaled` contains the finished sums with their
    /// constants.
    scales: Vec<Term>,
    scaled: BTreeMap<(Id, usize), (Place, bool)>,
    /// For each node, the number of its uses as an operand or as a root.
    uses: BTreeMap<Id, usize>,
    /// The degrees of nodes found so far.
    degrees: BTreeMap<(Small, Id), f64>,
    /// `true` if norms of positions are kept off zero, too.
    positions: bool,
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

    /// Returns `true` if an expression depends only on parameters and numbers.
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
