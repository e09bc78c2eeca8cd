//! Time derivatives of expressions.

use crate::algebra::diff;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// Returns Σ ∂x/∂s · rate(s) over the symbols of an expression, added to `terms`.
pub(crate) fn chain(
    graph: &mut Graph,
    id: Id,
    mut terms: Vec<(Id, Rational)>,
    rate: impl Fn(&mut Graph, Symbol) -> Option<Id>,
) -> Id {
    for symbol in graph.symbols(&[id]) {
        if let Some(rate) = rate(graph, symbol) {
            let partial = diff::derivative(graph, id, symbol);
            terms.push((graph.mul(partial, rate), Rational::ONE));
        }
    }
    graph.sum(&terms)
}

/// Returns dx/dt along any motion, by the chain rule through coordinates, driven inputs and time.
/// `rates` are those of the states, by their places among the coordinates.
pub(crate) fn total_derivative(graph: &mut Graph, id: Id, rates: &BTreeMap<usize, Id>) -> Id {
    chain(graph, id, Vec::new(), |graph, symbol| match symbol {
        Symbol::Coordinate(index) => {
            let rate = rates.get(&index).copied();
            Some(rate.unwrap_or_else(|| graph.symbol(Symbol::Velocity(index))))
        }
        Symbol::Entry(first, entry) => {
            // Row u of R changes as u × Ω.
            let (i, j) = ((entry + 1) % 3, (entry + 2) % 3);
            let row = entry - entry % 3;
            let [a, b] = [i, j].map(|k| graph.symbol(Symbol::Entry(first, row + k)));
            let [c, d] = [j, i].map(|k| graph.symbol(Symbol::Velocity(first + 1 + k)));
            let (left, right) = (graph.mul(a, c), graph.mul(b, d));
            Some(graph.sub(left, right))
        }
        other => explicit_rate(graph, other),
    })
}

/// Returns the rate of the time and of driven inputs, as far as it is known.
pub(crate) fn explicit_rate(graph: &mut Graph, symbol: Symbol) -> Option<Id> {
    match symbol {
        Symbol::Time => Some(Graph::ONE),
        Symbol::Input { input, component, order } if order < 2 => {
            Some(graph.symbol(Symbol::Input { input, component, order: order + 1 }))
        }
        _ => None,
    }
}

/// Returns dx/dt along the motion of the system, including the accelerations.
pub(crate) fn second_derivative(graph: &mut Graph, id: Id, rates: &BTreeMap<usize, Id>) -> Id {
    let first = vec![(total_derivative(graph, id, rates), Rational::ONE)];
    chain(graph, id, first, |graph, symbol| match symbol {
        Symbol::Velocity(index) => Some(graph.symbol(Symbol::Acceleration(index))),
        _ => None,
    })
}

/// Returns an expression with all velocities of coordinates set to zero.
pub(crate) fn at_rest(graph: &mut Graph, id: Id) -> Id {
    let rest = |symbol| matches!(symbol, Symbol::Velocity(_)).then_some(Graph::ZERO);
    diff::substitute(graph, id, rest)
}

/// Returns an expression with all control inputs set to zero.
pub(crate) fn at_rest_controls(graph: &mut Graph, id: Id) -> Id {
    if !graph.dependencies(id).any(Dependencies::CONTROL) {
        return id;
    }
    let rest = |symbol| matches!(symbol, Symbol::Control { .. }).then_some(Graph::ZERO);
    diff::substitute(graph, id, rest)
}
