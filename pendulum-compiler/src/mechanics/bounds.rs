//! What a block may cost: longer derivations and longer equations are refused, because they would
//! take rustc many seconds.

use crate::algebra::expr::{Graph, Id};
use crate::algebra::velocity_polynomial;
use crate::mechanics::derivation::Derivation;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::mechanics::solve;
use crate::messages::{Errors, message};
use crate::model::Model;
use crate::schedule;

/// The limit on the operands that the derivation of a block goes through. More would take many
/// seconds, also to compile what they become.
pub(super) const MOST_WORK: usize = 2_000_000;

/// The corresponding limit for the powers of the velocities, which are collected first, and for
/// Jacobians.
pub(super) const MOST_PART: usize = MOST_WORK / 2;

/// The limit on the operations of the equations. Those of accelerations that are not coupled count
/// three times, because they stand also in their series and stages; where they are coupled, series
/// solve for them step by step. At the limit, rustc takes five seconds and half a gigabyte.
const LONGEST_EQUATIONS: usize = 14_000;

/// The limit on the products of coefficients from which the energies are collected. A chain of 34
/// links has more; its equations are just too long.
const MOST_PRODUCTS: usize = 26_000;

/// The least number of operations that come from a product of an elimination: they also stand in
/// the velocities and in the solution for each row.
pub(super) const BY_PRODUCT: usize = 3;

/// Refuses a block whose derivation goes through too many operands.
pub(super) fn long_derivation(model: &Model, errors: &mut Errors) {
    if let Some((_, energy)) = model.energies.first() {
        let message = message!(
            "the equations of this block unfold to millions of expressions; write shorter sums, \
             or nest fewer functions"
        );
        errors.at(energy.range, message);
    }
}

/// Returns those of `values`, one for each coordinate, whose coordinates are not coupled.
pub(super) fn uncoupled(motion: &Motion, values: &[Id]) -> Vec<Id> {
    let alone = solve::uncoupled(&motion.mass_matrix).into_iter().zip(values);
    alone.filter(|(alone, _)| *alone).map(|(_, &value)| value).collect()
}

/// Refuses a block whose equations are too long. `most` are those that are emitted most often, and
/// `further` are operations that will be added.
pub(super) fn long_equations(block: &mut Derivation, most: &[Id], roots: &[Id], further: usize) {
    let Derivation { model, graph, errors, .. } = block;
    let operands = |roots: &[Id]| operands(graph, roots);
    let operations = |roots: &[Id]| schedule::program(graph, roots).ops.len();
    // Long products share their factors, so that operands alone only say that equations are short.
    if LONGEST_EQUATIONS < operands(roots) + 2 * operands(most) + further
        && LONGEST_EQUATIONS < operations(roots) + 2 * operations(most) + further
    {
        refuse(model, errors);
    }
}

/// Refuses a block whose equations will be too long, before they are derived. The energies of
/// `chained` rotations need not be collected.
pub(super) fn long_input(
    model: &Model,
    graph: &Graph,
    energies: &Energies,
    chained: bool,
    errors: &mut Errors,
) {
    let collected = [energies.kinetic, energies.lagrangian, energies.dissipation];
    let collected = collected.into_iter().flatten().filter(|_| !chained);
    let products = collected.map(|id| velocity_polynomial::products(graph, id)).max();
    let outputs = energies.outputs.iter().flat_map(|output| &output.scalars);
    let given: Vec<Id> = energies.forces.iter().chain(outputs).copied().collect();
    // Simplification shortens some of what is given, but rarely by a third.
    if MOST_PRODUCTS < products.unwrap_or(0) || 3 * LONGEST_EQUATIONS / 2 < operands(graph, &given)
    {
        refuse(model, errors);
    }
}

/// Returns the number of operands of all expressions in `roots`.
fn operands(graph: &Graph, roots: &[Id]) -> usize {
    graph.reachable(roots).into_iter().map(|id| graph.children(id).len()).sum()
}

fn refuse(model: &Model, errors: &mut Errors) {
    if let Some((_, energy)) = model.energies.first() {
        let message = message!(
            "the equations of this block are too long to be compiled in a few seconds; write \
             shorter sums or smaller families, or nest fewer functions"
        );
        errors.at(energy.range, message);
    }
}
