//! Constraints between positions: multipliers among the unknowns of the tree.
//!
//! A holonomic constraint g(z, q, t) of positions z and coordinates has the gradients ∂g/∂z and
//! ∂g/∂q with respect to the accelerations u̇ and q̈. Its multiplier stays in the system while
//! leaves are substituted into their parents, and is eliminated after the coordinates of its row.
//! The cost per link of a chain closed into a loop is therefore the same as that of an open chain.

use super::Held;
use super::quadratic::{Entries, Places};
use super::tree::Tree;
use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::lower::{Extended, chain, total_derivative};
use std::collections::{BTreeMap, BTreeSet};

impl Tree<'_> {
    /// Returns the accelerations under the constraints, the multipliers and the correction of
    /// constraint violations.
    pub(super) fn held(
        &mut self,
        extended: &Extended,
        masses: &Entries,
        forces: &Places,
        drifts: &[Vec<Id>],
    ) -> Option<Held> {
        let values = extended.constraints.as_ref()?;
        if values.is_empty() {
            return None;
        }
        let first = self.wide + extended.scalars.len();
        let (mut masses, mut forces) = (masses.clone(), forces.clone());
        let mut targets = Places::new();
        let mut multipliers = Vec::new();
        for (k, &value) in values.iter().enumerate() {
            let place = first + k;
            let rate = rate_of(self.graph, value);
            // The derivative at constant velocities.
            let drift = rate_of(self.graph, rate);
            let mut row = BTreeSet::new();
            for symbol in self.graph.symbols(&[rate]) {
                let Some(other) = self.place(symbol) else { continue };
                let slope = derivative(self.graph, rate, symbol);
                let slope = self.positioned(slope, extended);
                let entry = self.graph.negative(slope);
                let entry = self.scaled(entry, &[other]);
                if entry != Graph::ZERO {
                    masses.insert((other, place), entry);
                }
            }
            let whole = self.positioned(value, extended);
            row.extend(self.coordinates(&[whole]));
            let drift = self.positioned(drift, extended);
            forces.insert(place, drift);
            let target = self.graph.symbol(Symbol::Target(k));
            targets.insert(place, self.graph.negative(target));
            multipliers.push((place, row));
        }
        let solution = self.solve_with(&masses, forces, drifts, &multipliers)?;
        let still: Vec<Vec<Id>> =
            drifts.iter().map(|drift| vec![Graph::ZERO; drift.len()]).collect();
        let correction = self.solve_with(&masses, targets, &still, &multipliers)?;
        Some(Held {
            accelerations: solution.unknowns,
            multipliers: solution.multipliers,
            correction: correction.unknowns,
            independence: solution.independence,
        })
    }

    /// Substitutes the values of positions, of rotations and of their velocities in an expression.
    fn positioned(&mut self, id: Id, extended: &Extended) -> Id {
        let id = substitute(self.graph, id, |symbol| match symbol {
            Symbol::Position(scalar) => extended.scalars.get(scalar).copied(),
            _ => None,
        });
        self.at(id)
    }
}

/// Returns d/dt of an expression in positions, rotations and coordinates. `Auxiliary` is the
/// velocity of a position.
fn rate_of(graph: &mut Graph, id: Id) -> Id {
    let explicit = vec![(total_derivative(graph, id, &BTreeMap::new()), Rational::ONE)];
    chain(graph, id, explicit, |graph, symbol| match symbol {
        Symbol::Position(scalar) => Some(graph.symbol(Symbol::Auxiliary(scalar))),
        _ => None,
    })
}
