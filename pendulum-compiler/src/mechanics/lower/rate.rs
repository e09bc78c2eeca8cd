//! Time derivatives of expressions.

use crate::algebra::diff;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;

/// Returns dx/dt along any motion, by the chain rule through coordinates, driven inputs and time.
pub(crate) fn total_derivative(graph: &mut Graph, id: Id) -> Id {
    let mut terms = Vec::new();
    for symbol in graph.symbols(&[id]) {
        let rate = match symbol {
            Symbol::Time => Graph::ONE,
            Symbol::Coordinate(index) => graph.symbol(Symbol::Velocity(index)),
            Symbol::Entry(first, entry) => {
                // Row u of R changes as u × Ω.
                let (i, j) = ((entry + 1) % 3, (entry + 2) % 3);
                let row = entry - entry % 3;
                let [a, b] = [i, j].map(|k| graph.symbol(Symbol::Entry(first, row + k)));
                let [c, d] = [j, i].map(|k| graph.symbol(Symbol::Velocity(first + 1 + k)));
                let (left, right) = (graph.mul(a, c), graph.mul(b, d));
                graph.sub(left, right)
            }
            Symbol::Input { input, component, order } if order < 2 => {
                graph.symbol(Symbol::Input { input, component, order: order + 1 })
            }
            _ => continue,
        };
        let partial = diff::derivative(graph, id, symbol);
        terms.push((graph.mul(partial, rate), Rational::ONE));
    }
    graph.sum(&terms)
}

/// Returns dx/dt along the motion of the system, including the accelerations.
pub(super) fn second_derivative(graph: &mut Graph, id: Id) -> Id {
    let mut terms = vec![(total_derivative(graph, id), Rational::ONE)];
    for symbol in graph.symbols(&[id]) {
        if let Symbol::Velocity(index) = symbol {
            let partial = diff::derivative(graph, id, symbol);
            let acceleration = graph.symbol(Symbol::Acceleration(index));
            terms.push((graph.mul(partial, acceleration), Rational::ONE));
        }
    }
    graph.sum(&terms)
}
