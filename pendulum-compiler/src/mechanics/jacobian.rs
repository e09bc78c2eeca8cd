//! Jacobians of the accelerations: ∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂parameters.
//!
//! M q̈ = f gives M ∂q̈/∂z = ∂f/∂z − ∂M/∂z q̈: each column is one more right-hand side for factors
//! that exist already. A coordinate that stands alone in its row is differentiated directly.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::motion::Motion;
use crate::mechanics::solve;

/// ∂q̈/∂z for each symbol z, a column after the other.
pub(crate) fn columns(graph: &mut Graph, motion: &Motion, symbols: &[Symbol]) -> Vec<Vec<Id>> {
    let closed: Vec<Id> = motion.accelerations.iter().map(|&id| graph.closed(id)).collect();
    let alone = solve::alone(&motion.mass_matrix);
    symbols
        .iter()
        .map(|&symbol| {
            let mut right = Vec::with_capacity(closed.len());
            for (row, &force) in motion.forces.iter().enumerate() {
                if alone[row] {
                    right.push(Graph::ZERO);
                    continue;
                }
                let mut terms = vec![(derivative(graph, force, symbol), Rational::ONE)];
                for (column, &entry) in motion.mass_matrix[row].iter().enumerate() {
                    let slope = derivative(graph, entry, symbol);
                    terms.push((graph.mul(slope, closed[column]), Rational::MINUS_ONE));
                }
                right.push(graph.sum(&terms));
            }
            let mut column = solve::solve(graph, &motion.mass_matrix, &right);
            for (row, value) in column.iter_mut().enumerate() {
                if alone[row] {
                    *value = derivative(graph, motion.accelerations[row], symbol);
                }
            }
            column
        })
        .collect()
}
