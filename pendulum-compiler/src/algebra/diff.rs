//! Derivatives: functions by their table rows, sums and products by the usual rules. Each shared
//! node is differentiated once.

use crate::algebra::expr::{Graph, Id, Moment, Node, Symbol};
use crate::algebra::functions::{Derivative, Divisor, Function, Sign};
use crate::algebra::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

/// Returns ∂`id`/∂`symbol`.
pub(crate) fn derivative(graph: &mut Graph, id: Id, symbol: Symbol) -> Id {
    let mut unknown = BTreeSet::new();
    let mut pending = vec![id];
    while let Some(node) = pending.pop() {
        if graph.cached_derivative(symbol, node).is_none() && unknown.insert(node) {
            pending.extend(graph.children(node));
        }
    }
    // Children have smaller ids than their parents.
    for node in unknown {
        let slope = rule(graph, node, symbol);
        graph.cache_derivative(symbol, node, slope);
    }
    graph.cached_derivative(symbol, id).unwrap_or_default()
}

/// Computes the derivative of a node from the derivatives of its children.
fn rule(graph: &mut Graph, id: Id, symbol: Symbol) -> Id {
    let known = |graph: &Graph, id: Id| graph.cached_derivative(symbol, id).unwrap_or_default();
    match graph.node(id).clone() {
        Node::Number(_) | Node::Opaque(_) | Node::Pi => Graph::ZERO,
        Node::Symbol(own) if own == symbol => Graph::ONE,
        Node::Symbol(Symbol::Moment(first, moment)) => {
            moment_derivative(graph, first, moment, symbol)
        }
        Node::Symbol(_) => Graph::ZERO,
        Node::Sum(terms) => {
            let terms: Vec<(Id, Rational)> = terms
                .iter()
                .map(|&(term, coefficient)| (known(graph, term), coefficient))
                .collect();
            graph.sum(&terms)
        }
        Node::Product(coefficient, factors) => {
            let mut terms = Vec::new();
            for (place, &(base, exponent)) in factors.iter().enumerate() {
                let inner = known(graph, base);
                if inner != Graph::ZERO {
                    let power = graph.number(exponent);
                    // The exponent is lowered instead of dividing the product by the base: with a
                    // fractional power of a product the quotient would not cancel and would be NaN
                    // at zero.
                    let mut parts = factors.clone();
                    match exponent.add(Rational::MINUS_ONE) {
                        Some(lowered) => parts[place].1 = lowered,
                        None => parts.push((base, Rational::MINUS_ONE)),
                    }
                    parts.push((power, Rational::ONE));
                    for (term, own) in slopes(graph, inner, exponent) {
                        let mut parts = parts.clone();
                        parts.push((term, Rational::ONE));
                        terms.push((graph.product(coefficient, &parts), own));
                    }
                }
            }
            graph.sum(&terms)
        }
        Node::Call(function, argument) => {
            let inner = known(graph, argument);
            if inner == Graph::ZERO {
                return Graph::ZERO;
            }
            let outer = of_function(graph, function, argument, id);
            graph.mul(outer, inner)
        }
        Node::Atan2(y, x) => {
            let (dy, dx) = (known(graph, y), known(graph, x));
            let left = graph.mul(x, dy);
            let right = graph.mul(y, dx);
            let top = graph.sub(left, right);
            let bottom = graph.inner(&[x, y], &[x, y]);
            graph.div(top, bottom)
        }
        Node::Max(a, b) => {
            let difference = graph.sub(a, b);
            let opposite = graph.sub(b, a);
            let first = graph.call(Function::Step, difference);
            let second = graph.call(Function::Step, opposite);
            let left = graph.mul(first, known(graph, a));
            let right = graph.mul(second, known(graph, b));
            graph.add(left, right)
        }
        Node::Atom(inner) => {
            let value = known(graph, inner);
            graph.atom(value)
        }
    }
}

/// Returns the terms that are summed in the derivative of a power, from the derivative of its base.
///
/// The terms of a divisor with exponentials stay apart, so that each is divided by itself: the
/// quotient of sums that overflow is ∞/∞.
fn slopes(graph: &Graph, inner: Id, exponent: Rational) -> Vec<(Id, Rational)> {
    let grows = |&(term, _): &(Id, Rational)| {
        graph.factors(term).iter().any(|&(base, _)| {
            matches!(
                graph.node(base),
                Node::Call(Function::Exp | Function::Cosh | Function::Sinh, _)
            )
        })
    };
    match graph.node(inner) {
        Node::Sum(terms) if exponent.is_negative() && terms.iter().any(grows) => terms.clone(),
        _ => vec![(inner, Rational::ONE)],
    }
}

/// Returns f′(u), where `y` is f(u).
fn of_function(graph: &mut Graph, function: Function, u: Id, y: Id) -> Id {
    let (slope, sign) = match function.row().derivative {
        Derivative::Call(sign, other, _) => (graph.call(other, u), sign),
        Derivative::Itself => (y, Sign::Plus),
        Derivative::OneAndSquare(sign) => (one_and_square(graph, y, sign), Sign::Plus),
        Derivative::Times(sign, other) => {
            let factor = graph.call(other, u);
            (graph.mul(y, factor), sign)
        }
        Derivative::Reciprocal(divisor, sign) => (reciprocal(graph, divisor, u), sign),
        Derivative::Zero => (Graph::ZERO, Sign::Plus),
    };
    if sign == Sign::Plus { slope } else { graph.negative(slope) }
}

/// Returns 1/u, 1/(1 + u²) or 1/√(1 − u²).
fn reciprocal(graph: &mut Graph, divisor: Divisor, u: Id) -> Id {
    let (base, exponent) = match divisor {
        Divisor::Argument => (u, Rational::MINUS_ONE),
        Divisor::OnePlusSquare => (one_and_square(graph, u, Sign::Plus), Rational::MINUS_ONE),
        Divisor::RootOfOneMinusSquare => {
            (one_and_square(graph, u, Sign::Minus), Rational::HALF.negative())
        }
    };
    graph.power(base, exponent)
}

/// Returns 1 ± x².
fn one_and_square(graph: &mut Graph, x: Id, sign: Sign) -> Id {
    let square = graph.power(x, Rational::whole(2));
    let sign = if sign == Sign::Plus { Rational::ONE } else { Rational::MINUS_ONE };
    graph.sum(&[(Graph::ONE, Rational::ONE), (square, sign)])
}

/// The entries of the second moments of a body and of a solid, in the order of their parameters.
const PLANE: [[usize; 2]; 3] = [[0, 0], [0, 1], [1, 1]];
const SPACE: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Returns the derivative of a combination of second moments about the pivot, S = C + m c cᵀ, with
/// respect to mass, centre or a central moment.
fn moment_derivative(graph: &mut Graph, first: usize, moment: Moment, symbol: Symbol) -> Id {
    let Symbol::Parameter(parameter) = symbol else { return Graph::ZERO };
    let offset = parameter.wrapping_sub(first);
    let (one, minus_one) = (Rational::ONE, Rational::MINUS_ONE);
    let (dimensions, entries, combination): (_, &[_], _) = match moment {
        Moment::Inertia => (2, &PLANE, vec![(0, one), (2, one)]),
        Moment::Difference => (2, &PLANE, vec![(0, one), (2, minus_one)]),
        Moment::Product => (2, &PLANE, vec![(1, one)]),
        Moment::About(axis) => {
            let others = (0..3).filter(|&other| other != usize::from(axis));
            (3, &SPACE, others.map(|other| (other, one)).collect())
        }
        Moment::Mixed(pair) => (3, &SPACE, vec![(3 + usize::from(pair), one)]),
    };
    let mut terms = Vec::new();
    for (entry, factor) in combination {
        let [i, k]: [usize; 2] = entries[entry];
        let [m, x, y] = [0, 1 + i, 1 + k].map(|part| graph.symbol(Symbol::Parameter(first + part)));
        let slopes = [(0, x, y), (1 + i, m, y), (1 + k, m, x)];
        for (_, a, b) in slopes.into_iter().filter(|&(part, ..)| part == offset) {
            terms.push((graph.mul(a, b), factor));
        }
        if offset == 1 + dimensions + entry {
            terms.push((Graph::ONE, factor));
        }
    }
    graph.sum(&terms)
}

/// Returns `id` with some of its symbols replaced.
pub(crate) fn substitute(graph: &mut Graph, id: Id, value: impl Fn(Symbol) -> Option<Id>) -> Id {
    let mut root = id;
    substitute_in(graph, vec![&mut root], value);
    root
}

/// Replaces some of the symbols in `roots`. What several roots share is rebuilt once.
pub(crate) fn substitute_in(
    graph: &mut Graph,
    roots: Vec<&mut Id>,
    value: impl Fn(Symbol) -> Option<Id>,
) {
    let ids: Vec<Id> = roots.iter().map(|root| **root).collect();
    let mut known: BTreeMap<Id, Id> = BTreeMap::new();
    for node in graph.reachable(&ids) {
        let result = if let Node::Symbol(symbol) = *graph.node(node) {
            value(symbol).unwrap_or(node)
        } else {
            let old = graph.node(node).clone();
            graph.rebuilt(&old, |child| known[&child])
        };
        known.insert(node, result);
    }
    for root in roots {
        *root = known[root];
    }
}
