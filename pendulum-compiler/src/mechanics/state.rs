//! States of first order in equations of second order.
//!
//! The place of a state z in the accelerations is the derivative of its rate along the motion, so
//! that all methods, series, Jacobians and lanes integrate it as a coordinate without a coupling.
//! Its place in the velocities is *set* to the rate wherever a step may begin: at the start, at the
//! end of each step, and behind kinks, impacts, samples and actions. A step thus moves z along the
//! exact solution through its start, and no error of ż survives it. Within a step, ż is the one
//! that the method integrates: with z̈ = −ż/T a filter has the rates 0 and −1/T, while its rate in
//! place of ż would give z̈ = z/T², and with it a rate +1/T. All other equations contain the rate
//! in place of ż, so that a force never depends on the place of ż.
//!
//! The price is a derivative of the rate. Driven inputs have it, a sample that is held is
//! constant, and a feedback law in continuous time has none: such dynamics are refused. Methods
//! that would integrate the rate itself need no derivative, but each of them would know of states.

use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::mechanics::derivation::named_input;
use crate::mechanics::lower::{Energies, second_derivative};
use crate::mechanics::motion::Motion;
use crate::messages::{Text, message};
use crate::model::{Model, Quantity};
use std::collections::BTreeMap;

/// Adds the states behind the coordinates of a motion, with a unit mass that nothing else moves.
pub(crate) fn widen(graph: &mut Graph, motion: &mut Motion, rates: &BTreeMap<usize, Id>) {
    if rates.is_empty() {
        return;
    }
    let accelerations: Vec<Id> = motion.accelerations.iter().map(|&id| graph.closed(id)).collect();
    for (&place, &rate) in rates {
        let slope = second_derivative(graph, rate, &BTreeMap::new());
        let acceleration = substitute(graph, slope, |symbol| match symbol {
            Symbol::Acceleration(index) => accelerations.get(index).copied(),
            _ => None,
        });
        motion.states.push([rate, slope]);
        motion.momenta.push(graph.symbol(Symbol::Velocity(place)));
        motion.accelerations.push(acceleration);
        motion.forces.push(acceleration);
        motion.momentum_rates.push(acceleration);
        if let Some(velocities) = &mut motion.velocities {
            velocities.push(graph.symbol(Symbol::Momentum(place)));
        }
    }
    let count = motion.accelerations.len();
    for row in &mut motion.mass_matrix {
        row.resize(count, Graph::ZERO);
    }
    for place in motion.mass_matrix.len()..count {
        let mut row = vec![Graph::ZERO; count];
        row[place] = Graph::ONE;
        motion.mass_matrix.push(row);
    }
    let constraints = &mut motion.constraints;
    let rows = constraints.held.iter_mut().chain(&mut constraints.redundant);
    for row in rows.chain(&mut constraints.limits).chain(&mut constraints.frictions) {
        row.gradient.resize(count, Graph::ZERO);
    }
    if !constraints.held.is_empty() {
        constraints.correction.resize(count, Graph::ZERO);
        let own = &motion.accelerations[constraints.sides.len()..];
        constraints.sides.extend(own);
    }
}

/// Returns why the row of a constraint, a limit or a friction is refused for the rate of a state
/// in its value. A row on positions is derived twice, and a force along it has no part along ż.
pub(crate) fn refused(
    graph: &mut Graph,
    model: &Model,
    energies: &Energies,
    value: Id,
    holonomic: bool,
) -> Option<Text> {
    for symbol in graph.symbols(&[value]) {
        let Symbol::Coordinate(place) = symbol else { continue };
        let Some(&rate) = energies.rates.get(&place) else { continue };
        if derivative(graph, value, symbol) == Graph::ZERO {
            continue;
        }
        let names = model.coordinates.iter().flat_map(Quantity::names);
        let state = names.into_iter().nth(place).unwrap_or_default();
        let dependencies = graph.dependencies(rate);
        if dependencies.any(Dependencies::CONTROL) {
            let input = named_input(model, graph, &[rate], None);
            let input = input.map_or_else(String::new, ToString::to_string);
            return Some(message!(
                "the state `{state}` stands here and its rate contains the control input \
                 `{input}`, whose derivative would be needed; leave the state out, or declare \
                 the input `driven`"
            ));
        }
        if holonomic && dependencies.any(Dependencies::VELOCITY) {
            return Some(message!(
                "the state `{state}` stands here and its rate contains a velocity, so that the \
                 force that holds this would push the state; leave the state out"
            ));
        }
    }
    None
}
