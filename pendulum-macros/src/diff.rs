//! Derivatives: one row per function, sums and products by their rules, each shared node once.

use crate::expr::{Function, Graph, Id, Node, Symbol};
use crate::number::Rational;
use std::collections::BTreeMap;

/// ∂`id`/∂`symbol`.
pub(crate) fn derivative(graph: &mut Graph, id: Id, symbol: Symbol) -> Id {
    let mut known: BTreeMap<Id, Id> = BTreeMap::new();
    for node in graph.reachable(&[id]) {
        let value = rule(graph, node, symbol, &known);
        known.insert(node, value);
    }
    known[&id]
}

/// The derivative of one node from those of its children.
fn rule(graph: &mut Graph, id: Id, symbol: Symbol, known: &BTreeMap<Id, Id>) -> Id {
    match graph.node(id).clone() {
        Node::Number(_) | Node::Opaque(_) | Node::Pi => Graph::ZERO,
        Node::Symbol(own) => {
            if own == symbol {
                Graph::ONE
            } else {
                Graph::ZERO
            }
        }
        Node::Sum(terms) => {
            let terms: Vec<(Id, Rational)> = terms.iter().map(|&(term, coefficient)| (known[&term], coefficient)).collect();
            graph.sum(&terms)
        }
        Node::Product(coefficient, factors) => {
            let mut terms = Vec::new();
            for &(base, exponent) in &factors {
                let inner = known[&base];
                if inner != Graph::ZERO {
                    let power = graph.number(exponent);
                    let parts =
                        [(id, Rational::ONE), (base, Rational::MINUS_ONE), (inner, Rational::ONE), (power, Rational::ONE)];
                    terms.push((graph.product(Rational::ONE, &parts), Rational::ONE));
                }
            }
            // The coefficient is part of `id`.
            let _ = coefficient;
            graph.sum(&terms)
        }
        Node::Call(function, argument) => {
            let inner = known[&argument];
            if inner == Graph::ZERO {
                return Graph::ZERO;
            }
            let outer = function_derivative(graph, function, argument, id);
            graph.mul(outer, inner)
        }
        Node::Atan2(y, x) => {
            let (dy, dx) = (known[&y], known[&x]);
            let left = graph.mul(x, dy);
            let right = graph.mul(y, dx);
            let top = graph.sub(left, right);
            let squares = [graph.power(x, Rational::whole(2)), graph.power(y, Rational::whole(2))];
            let bottom = graph.add(squares[0], squares[1]);
            graph.div(top, bottom)
        }
        Node::Max(a, b) => {
            let difference = graph.sub(a, b);
            let opposite = graph.sub(b, a);
            let first = graph.call(Function::Step, difference);
            let second = graph.call(Function::Step, opposite);
            let left = graph.mul(first, known[&a]);
            let right = graph.mul(second, known[&b]);
            graph.add(left, right)
        }
        Node::Atom(inner) => {
            let value = known[&inner];
            graph.atom(value)
        }
    }
}

/// f′(u), where `value` is f(u).
#[rustfmt::skip]
fn function_derivative(g: &mut Graph, function: Function, u: Id, value: Id) -> Id {
    match function {
        Function::Sin  => g.call(Function::Cos, u),                                 // cos u
        Function::Cos  => { let s = g.call(Function::Sin, u); g.negative(s) }       // -sin u
        Function::Tan  => one_plus_square(g, value, Rational::ONE),                 // 1 + tan²u
        Function::Asin => { let s = one_plus_square(g, u, Rational::MINUS_ONE); g.power(s, minus_half()) }
        Function::Acos => { let s = one_plus_square(g, u, Rational::MINUS_ONE); let r = g.power(s, minus_half()); g.negative(r) }
        Function::Atan => { let s = one_plus_square(g, u, Rational::ONE); g.power(s, Rational::MINUS_ONE) }
        Function::Sinh => g.call(Function::Cosh, u),                                // cosh u
        Function::Cosh => g.call(Function::Sinh, u),                                // sinh u
        Function::Tanh => one_plus_square(g, value, Rational::MINUS_ONE),           // 1 - tanh²u
        Function::Exp  => value,                                                    // exp u
        Function::Ln   => g.power(u, Rational::MINUS_ONE),                          // 1/u
        Function::Abs  => g.call(Function::Sign, u),                                // sign u
        Function::Sign | Function::Step => Graph::ZERO,                             // 0 where they are smooth
    }
}

fn one_plus_square(graph: &mut Graph, u: Id, sign: Rational) -> Id {
    let square = graph.power(u, Rational::whole(2));
    graph.sum(&[(Graph::ONE, Rational::ONE), (square, sign)])
}

fn minus_half() -> Rational {
    Rational::HALF.negative()
}

/// `id` with some of its symbols replaced.
pub(crate) fn substitute(graph: &mut Graph, id: Id, value: impl Fn(Symbol) -> Option<Id>) -> Id {
    let mut known: BTreeMap<Id, Id> = BTreeMap::new();
    for node in graph.reachable(&[id]) {
        let result = if let Node::Symbol(symbol) = *graph.node(node) {
            value(symbol).unwrap_or(node)
        } else {
            let old = graph.node(node).clone();
            graph.rebuilt(&old, |child| known[&child])
        };
        known.insert(node, result);
    }
    known[&id]
}
