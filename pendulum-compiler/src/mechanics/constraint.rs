//! Constraints and limits: gradients, rates, multipliers; likewise the rates of frictions, which are
//! constraints while they are zero.
//!
//! A row is either holonomic, g(q, t) = 0, or a constraint of velocities, A(q, t) q̇ + b(q, t) = 0.
//! Let c be the time derivative of ġ or of A q̇ + b, C = ∂c/∂q̈, and γ = −c at q̈ = 0. The motion
//! satisfies M q̈ = f + Cᵀλ and C q̈ = γ. A single elimination yields accelerations and
//! multipliers: each multiplier is eliminated after the coordinates of its row, so that the signs
//! of all pivots are known.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
use crate::algebra::prime_field::Residue;
use crate::mechanics::attitude;
use crate::mechanics::derivation::{Derivation, named_input};
use crate::mechanics::lower::{Energies, Row, at_rest, total_derivative};
use crate::mechanics::solve::{self, Augmented};
use crate::mechanics::state;
use crate::messages::shared::derivative_of_control;
use crate::messages::{Text, message};
use crate::syntax::ast::Expr;
use crate::syntax::text::text;
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// The largest number of scalar limits, which is the capacity of the runtime.
pub(crate) const MOST_LIMITS: usize = 16;

/// The largest number of scalar rates with dry friction, which is the capacity of the runtime.
pub(crate) const MOST_FRICTIONS: usize = 16;

/// The constraints, limits and frictions of a motion.
#[derive(Debug, Default)]
pub(crate) struct Constraints {
    /// The constraints that are solved.
    pub(crate) held: Vec<Constraint>,
    pub(crate) redundant: Vec<Constraint>,
    pub(crate) limits: Vec<Constraint>,
    /// The rates with dry friction.
    pub(crate) frictions: Vec<Constraint>,
    /// λ in the order of `held`.
    pub(crate) multipliers: Vec<Id>,
    /// For each pivot, the fraction that remains after the preceding constraints, from 0 to 1.
    pub(crate) independence: Vec<Id>,
    /// M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹ applied to the symbols `Target`.
    pub(crate) correction: Vec<Id>,
    /// f + Cᵀλ with λ as symbols, for printed equations; empty without constraints.
    pub(crate) sides: Vec<Id>,
    /// The power with λ as symbols, for printed equations; `None` without constraints.
    pub(crate) power: Option<Id>,
    /// The names of the rotations whose quaternions are held at length one, by the last rows of
    /// `held`.
    pub(crate) norms: Vec<String>,
}

/// A scalar constraint, a limit, or the rate of a friction.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub(crate) holonomic: bool,
    /// g or A q̇ + b.
    pub(crate) value: Id,
    /// A row of C.
    pub(crate) gradient: Vec<Id>,
    /// ġ or A q̇ + b.
    pub(crate) rate: Id,
    /// The rate at q̇ = 0.
    pub(crate) drive: Id,
    /// The time derivative of the rate at q̈ = 0, −γ.
    pub(crate) drift: Id,
    /// The sums of the magnitudes of the terms of `value` and of `rate`.
    pub(crate) scales: [Id; 2],
}

impl Constraints {
    /// Returns all expressions of the constraints, limits and frictions.
    pub(crate) fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let rows = self.held.iter_mut().chain(&mut self.redundant).chain(&mut self.limits);
        let rows = rows.chain(&mut self.frictions).flat_map(|row| {
            let single = [&mut row.value, &mut row.rate, &mut row.drive, &mut row.drift];
            single.into_iter().chain(&mut row.gradient).chain(&mut row.scales)
        });
        let lists =
            [&mut self.multipliers, &mut self.independence, &mut self.correction, &mut self.sides];
        rows.chain(lists.into_iter().flatten()).chain(&mut self.power)
    }

    /// Returns `true` if a constraint that is solved acts on a coordinate.
    pub(crate) fn bound(&self, coordinate: usize) -> bool {
        self.held.iter().any(|row| row.gradient[coordinate] != Graph::ZERO)
    }

    /// Returns the left sides of all constraints, g or A q̇ + b, with their signs chosen so that
    /// the coefficient is positive.
    pub(crate) fn values(&self, graph: &mut Graph) -> Vec<Id> {
        let rows = self.held.iter().chain(&self.redundant);
        rows.map(|row| {
            let negative = graph.split(row.value).0.is_negative();
            if negative { graph.negative(row.value) } else { row.value }
        })
        .collect()
    }

    /// Returns the constraints that are solved, followed by the redundant ones, each with its row,
    /// or with the name of the rotation whose quaternion it holds.
    pub(crate) fn rows<'c>(
        &'c self,
        energies: &'c Energies,
    ) -> impl Iterator<Item = (&'c Constraint, Result<&'c Row, &'c String>)> {
        let (solved, checked) = energies.constraints.split_at(self.held.len() - self.norms.len());
        let rows = solved.iter().map(Ok).chain(self.norms.iter().map(Err));
        self.held.iter().chain(&self.redundant).zip(rows.chain(checked.iter().map(Ok)))
    }

    /// Returns the rows of C.
    pub(crate) fn gradients(&self) -> Vec<Vec<Id>> {
        self.held.iter().map(|row| row.gradient.clone()).collect()
    }

    /// Returns the directions of all forces that may do work: those of constraints and frictions.
    pub(crate) fn directions(&self) -> Vec<Vec<Id>> {
        let rows = self.held.iter().chain(&self.frictions);
        rows.map(|row| row.gradient.clone()).collect()
    }

    /// Returns the matrix of M q̈ − Cᵀλ = f and −C q̈ = −γ.
    pub(crate) fn matrix(&self, graph: &mut Graph, masses: &[Vec<Id>]) -> Vec<Vec<Id>> {
        let count = masses.len();
        let size = count + self.held.len();
        let mut matrix = vec![vec![Graph::ZERO; size]; size];
        for (row, masses) in matrix.iter_mut().zip(masses) {
            row[..count].copy_from_slice(masses);
        }
        for (k, row) in self.held.iter().enumerate() {
            for (j, &entry) in row.gradient.iter().enumerate() {
                let entry = graph.negative(entry);
                matrix[count + k][j] = entry;
                matrix[j][count + k] = entry;
            }
        }
        matrix
    }

    /// Returns the right side of these equations.
    pub(crate) fn right(&self, forces: &[Id]) -> Vec<Id> {
        forces.iter().copied().chain(self.held.iter().map(|row| row.drift)).collect()
    }

    /// Returns the accelerations in dense form, and sets multipliers, independence and correction.
    pub(crate) fn solve(
        &mut self,
        graph: &mut Graph,
        masses: &[Vec<Id>],
        forces: &[Id],
    ) -> Vec<Id> {
        let count = forces.len();
        let matrix = self.matrix(graph, masses);
        let right = self.right(forces);
        let mut targets = vec![Graph::ZERO; count];
        for k in 0..self.held.len() {
            let target = graph.symbol(Symbol::Target(k));
            targets.push(graph.negative(target));
        }
        let Augmented { solutions, independence } =
            solve::augmented(graph, &matrix, count, &[right, targets]);
        self.independence = independence;
        let [mut accelerations, mut correction] = <[Vec<Id>; 2]>::try_from(solutions)
            .unwrap_or_else(|_| [vec![Graph::ZERO; matrix.len()], vec![Graph::ZERO; matrix.len()]]);
        self.multipliers = accelerations.split_off(count);
        correction.truncate(count);
        self.correction = correction;
        accelerations
    }

    /// Returns the multipliers as symbols.
    pub(crate) fn symbols(&self, graph: &mut Graph) -> Vec<Id> {
        (0..self.held.len()).map(|k| graph.symbol(Symbol::Multiplier(k))).collect()
    }

    /// Returns the terms −λ b of the power.
    pub(crate) fn power_terms(&self, graph: &mut Graph, multipliers: &[Id]) -> Vec<(Id, Rational)> {
        let rows = self.held.iter().zip(multipliers);
        rows.map(|(row, &multiplier)| (graph.mul(row.drive, multiplier), Rational::MINUS_ONE))
            .collect()
    }

    /// Returns Σ C_kj λ_k for each coordinate j, with the given multipliers λ.
    pub(crate) fn forces(&self, graph: &mut Graph, multipliers: &[Id]) -> Vec<Id> {
        let count = self.held.first().map_or(0, |row| row.gradient.len());
        let column = |j: usize| self.held.iter().map(|row| row.gradient[j]).collect::<Vec<Id>>();
        (0..count).map(|j| graph.inner(&column(j), multipliers)).collect()
    }
}

/// Derives the constraints, limits and frictions of a block, and reports mistakes in them.
pub(crate) fn derive(block: &mut Derivation) -> Constraints {
    let (model, energies) = (block.model, block.energies);
    let count = energies.forces.len();
    let mut constraints = Constraints::default();
    let before = block.errors.len();
    for row in &energies.constraints {
        let own = model.constraints[row.statement];
        let Some(constraint) = constraint(block, row, &own.difference) else {
            continue;
        };
        let list = if own.redundant { &mut constraints.redundant } else { &mut constraints.held };
        list.push(constraint);
    }
    for row in &energies.limits {
        let own = model.limits[row.statement];
        let limit = constraint(block, row, &own.difference);
        match limit {
            Some(limit) if !limit.holonomic => {
                let expr = &own.difference;
                let message = message!("a limit holds positions; leave the velocities out");
                block.errors.once(expr.source, expr.range, message);
            }
            limit => constraints.limits.extend(limit),
        }
    }
    for friction in &energies.frictions {
        let (graph, rate) = (&mut *block.graph, friction.rate);
        if let Some(message) = state::refused(graph, model, energies, rate, false) {
            let expr = &model.frictions[friction.statement].slip.rate;
            block.errors.once(expr.source, expr.range, message);
            continue;
        }
        let gradient = gradient(graph, rate, count);
        let drift = total_derivative(graph, rate, &energies.rates);
        constraints.frictions.push(row(graph, false, rate, [rate, drift], gradient));
    }
    if block.errors.len() == before {
        independent(block, &constraints);
    }
    if block.errors.len() == before {
        check_counts(block, &constraints);
    }
    constraints
}

/// Derives a row, or reports why it is refused.
fn constraint(block: &mut Derivation, row: &Row, difference: &Expr) -> Option<Constraint> {
    let Derivation { model, graph, energies, errors } = block;
    let input = |graph: &Graph, order| {
        named_input(model, graph, &[row.value], order).map_or_else(String::new, Ident::to_string)
    };
    let mut refuse = |message: Text| {
        errors.once(difference.source, difference.range, message);
        None
    };
    let dependencies = graph.dependencies(row.value);
    if dependencies.any(Dependencies::CONTROL) {
        return refuse(derivative_of_control(input(graph, None)));
    }
    let holonomic = !dependencies.any(Dependencies::VELOCITY);
    if dependencies.any(Dependencies::ACCELERATION_INPUT)
        || holonomic && dependencies.any(Dependencies::VELOCITY_INPUT)
    {
        let second = dependencies.any(Dependencies::ACCELERATION_INPUT);
        let input = input(graph, Some(if second { 2 } else { 1 }));
        return refuse(message!(
            "the second derivative of this constraint contains the third one of `{input}`, and \
             driven inputs have two; leave its derivative out"
        ));
    }
    let rate =
        if holonomic { total_derivative(graph, row.value, &energies.rates) } else { row.value };
    if let Some(message) = state::refused(graph, model, energies, row.value, holonomic) {
        return refuse(message);
    }
    if !graph.smooth(&[row.value, rate]) {
        return refuse(message!(
            "a constraint and a limit need two derivatives, and `abs`, `sign`, `min` and `max` of \
             what moves have a corner; write both sides without them, and two limits for a bound \
             on both sides"
        ));
    }
    let gradient = gradient(graph, rate, energies.forces.len());
    if gradient.iter().any(|&entry| graph.dependencies(entry).any(Dependencies::VELOCITY)) {
        return refuse(message!(
            "velocities enter a constraint to the first power only; solve it for a velocity, or \
             write a `force`"
        ));
    }
    if gradient.iter().all(|&entry| entry == Graph::ZERO) {
        let [left, right] = difference.sides();
        let [left, right] = [left, right].map(text);
        return refuse(message!(
            "no coordinate stands in `{left} = {right}`: nothing here can move to fulfil it; \
             leave it out"
        ));
    }
    let drift = total_derivative(graph, rate, &energies.rates);
    Some(self::row(graph, holonomic, row.value, [rate, drift], gradient))
}

/// Returns the gradient of a rate with respect to the velocities.
fn gradient(graph: &mut Graph, rate: Id, count: usize) -> Vec<Id> {
    (0..count).map(|j| derivative(graph, rate, Symbol::Velocity(j))).collect()
}

/// Returns a row with what follows from its rate and the derivative of the rate at q̈ = 0.
fn row(
    graph: &mut Graph,
    holonomic: bool,
    value: Id,
    [rate, drift]: [Id; 2],
    gradient: Vec<Id>,
) -> Constraint {
    let drive = at_rest(graph, rate);
    let scales = [value, rate].map(|id| magnitude(graph, id));
    Constraint { holonomic, value, gradient, rate, drive, drift, scales }
}

/// Returns the sum of the magnitudes of the terms of an expression.
pub(super) fn magnitude(graph: &mut Graph, id: Id) -> Id {
    match graph.node(id).clone() {
        Node::Atom(inner) => magnitude(graph, inner),
        Node::Sum(terms) => {
            let mut all = Vec::new();
            for (term, coefficient) in terms {
                all.push((magnitude(graph, term), coefficient.abs()));
            }
            graph.sum(&all)
        }
        Node::Product(coefficient, factors)
            if factors.iter().any(|&(base, exponent)| {
                exponent == Rational::ONE && matches!(graph.node(base), Node::Sum(_))
            }) =>
        {
            let mut all = Vec::new();
            for (base, exponent) in factors {
                let open = exponent == Rational::ONE;
                let size =
                    if open { magnitude(graph, base) } else { graph.call(Function::Abs, base) };
                all.push((size, exponent));
            }
            graph.product(coefficient.abs(), &all)
        }
        _ => graph.call(Function::Abs, id),
    }
}

/// Reports constraints that are as many as the coordinates, redundant constraints that are more
/// than the coordinates, and more limits or frictions than there is room for.
fn check_counts(block: &mut Derivation, constraints: &Constraints) {
    let Derivation { model, energies, errors, .. } = block;
    let count = energies.forces.len();
    let held = constraints.held.len();
    // A rotation has three freedoms in four places.
    let freedoms = count - attitude::rotations(model).len();
    if freedoms <= held {
        let last = model.constraints[energies.constraints[freedoms - 1].statement];
        let (held, coordinates) =
            (several(held, "scalar constraint"), several(freedoms, "coordinate"));
        let message =
            message!("{held} for {coordinates}: nothing is left to move; leave a constraint out");
        errors.at(last.name.span(), message);
    }
    let redundant = constraints.redundant.len();
    if let Some(row) = energies.constraints.last().filter(|_| count < redundant) {
        let redundant = several(redundant, "scalar redundant constraint");
        let coordinates = several(count, "coordinate");
        let message =
            message!("{redundant} for {coordinates}; leave out those that follow from others");
        errors.at(model.constraints[row.statement].name.span(), message);
    }
    let limits = constraints.limits.len();
    if let Some(row) = energies.limits.last().filter(|_| MOST_LIMITS < limits) {
        let message = message!(
            "there are {limits} scalar limits, and at most {MOST_LIMITS} are kept; leave some \
             out, or join two of one coordinate, as in `w^2 - x^2 >= 0`"
        );
        errors.at(model.limits[row.statement].name.span(), message);
    }
    let frictions = constraints.frictions.len();
    if let Some(row) = energies.frictions.last().filter(|_| MOST_FRICTIONS < frictions) {
        let message = message!(
            "there are {frictions} scalar rates with friction, and at most {MOST_FRICTIONS} are \
             kept; leave some out, or write a `force` with `tanh` for them"
        );
        errors.at(model.frictions[row.statement].name.span(), message);
    }
}

/// Reports constraints whose gradients depend linearly on the gradients of preceding constraints at
/// a random state.
fn independent(block: &mut Derivation, constraints: &Constraints) {
    let Derivation { model, graph, energies, errors } = block;
    let Some(values) = solve::at_random(graph, &constraints.gradients()) else { return };
    // Reduced rows, each with the indices of the rows combined in it.
    let mut reduced: Vec<(Vec<Residue>, BTreeSet<usize>)> = Vec::new();
    let mut reported = BTreeSet::new();
    for (k, row) in values.into_iter().enumerate() {
        let (mut row, mut parts) = (row, BTreeSet::new());
        for (other, theirs) in &reduced {
            let pivot = other.iter().position(|&entry| entry != Residue::ZERO);
            let Some(pivot) = pivot.filter(|&pivot| row[pivot] != Residue::ZERO) else { continue };
            let Some(inverse) = other[pivot].reciprocal() else { continue };
            let factor = row[pivot].mul(inverse).negative();
            for (entry, &other) in row.iter_mut().zip(other) {
                *entry = entry.add(other.mul(factor));
            }
            parts.extend(theirs.iter().copied());
        }
        if row.iter().any(|&entry| entry != Residue::ZERO) {
            parts.insert(k);
            reduced.push((row, parts));
            continue;
        }
        let own = &energies.constraints[k];
        if !reported.insert(own.statement) {
            continue;
        }
        let quoted: Vec<String> =
            parts.iter().map(|&part| format!("`{}`", energies.constraints[part].name)).collect();
        let Some((last, others)) = quoted.split_last() else { continue };
        let from = if others.is_empty() {
            last.clone()
        } else {
            format!("{} and {last}", others.join(", "))
        };
        let message = message!(
            "`{}` follows from {from}: leave it out, or write `redundant constraint` to have it \
             checked",
            own.name
        );
        errors.at(model.constraints[own.statement].name.span(), message);
    }
}

/// Returns a number with a noun in the singular or plural.
fn several(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}
