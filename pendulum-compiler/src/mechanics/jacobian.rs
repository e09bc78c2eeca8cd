//! Jacobians of the accelerations: ∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂parameters.
//!
//! M q̈ = f gives M ∂q̈/∂z = ∂f/∂z − ∂M/∂z q̈: each column is a further right side for the existing
//! factors of the matrix; with multipliers, for the factors of the whole matrix. The acceleration
//! of a coordinate that is not coupled to others is differentiated directly.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::motion::Motion;
use crate::mechanics::solve;

/// Returns the column ∂q̈/∂z for each symbol z.
pub(crate) fn columns(graph: &mut Graph, motion: &Motion, symbols: &[Symbol]) -> Vec<Vec<Id>> {
    let count = motion.accelerations.len();
    let constraints = &motion.constraints;
    let matrix = constraints.matrix(graph, &motion.mass_matrix);
    let sides = constraints.right(&motion.forces);
    let unknowns = motion.accelerations.iter().chain(&constraints.multipliers);
    let closed: Vec<Id> = unknowns.map(|&id| graph.closed(id)).collect();
    let uncoupled = solve::uncoupled(&matrix);
    symbols
        .iter()
        .map(|&symbol| {
            let mut right = Vec::with_capacity(closed.len());
            for (row, &side) in sides.iter().enumerate() {
                if uncoupled[row] && row < count {
                    right.push(Graph::ZERO);
                    continue;
                }
                let mut terms = vec![(derivative(graph, side, symbol), Rational::ONE)];
                for (column, &entry) in matrix[row].iter().enumerate() {
                    let slope = derivative(graph, entry, symbol);
                    terms.push((graph.mul(slope, closed[column]), Rational::MINUS_ONE));
                }
                right.push(graph.sum(&terms));
            }
            let mut column = if constraints.held.is_empty() {
                solve::solve(graph, &matrix, &right)
            } else {
                let augmented = solve::augmented(graph, &matrix, count, &[right]);
                augmented.solutions.into_iter().next().unwrap_or_default()
            };
            column.truncate(count);
            for (row, value) in column.iter_mut().enumerate() {
                if uncoupled[row] {
                    *value = derivative(graph, motion.accelerations[row], symbol);
                }
            }
            column
        })
        .collect()
}
