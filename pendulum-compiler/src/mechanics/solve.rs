//! M x = f on the graph: `LDLᵀ` without square roots. Structural zeros are skipped and independent
//! blocks are solved separately.

use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Point, Residue};
use crate::algebra::velocity_polynomial;
use crate::mechanics::derivation::Derivation;
use crate::messages::message;
use crate::model::{Element, Quantity};
use std::collections::{BTreeMap, BTreeSet};

/// Returns `true` if every direction has kinetic energy at a random state, and reports the
/// coordinates without kinetic energy.
pub(crate) fn regular(block: &mut Derivation, matrix: &[Vec<Id>]) -> bool {
    let Derivation { model, graph, energies, errors } = block;
    let before = errors.len();
    for coordinate in &model.coordinates[..model.mechanical] {
        let mut rows = coordinate.scalars();
        if let Some(row) = rows.find(|&row| matrix[row].iter().all(|&entry| entry == Graph::ZERO)) {
            if coordinate.element == Element::Rotation {
                let name = coordinate.name;
                let message = message!(
                    "`{name}` has no kinetic energy, so its acceleration is undetermined; add \
                     that of its body, as `J/2*|angular_velocity({name})|^2`"
                );
                errors.at(name.span(), message);
                continue;
            }
            let name = named(coordinate, row);
            let pushed: Vec<Id> =
                energies.dissipation.iter().chain(&energies.forces).copied().collect();
            let message = if graph.symbols(&pushed).contains(&Symbol::Velocity(row)) {
                message!(
                    "`{name}` has no kinetic energy, so its acceleration is undetermined; add the \
                     square of its velocity to `kinetic`, or, if its rate is given, as that of a \
                     filter, declare it with `state` in place of `coordinate` and write \
                     `rate {name} = …;`"
                )
            } else {
                message!(
                    "`{name}` has no kinetic energy, so its acceleration is undetermined; add the \
                     square of its velocity to `kinetic`"
                )
            };
            errors.at(coordinate.name.span(), message);
        }
    }
    if before < errors.len() {
        return false;
    }
    let Some(values) = at_random(graph, matrix) else { return true };
    for rows in blocks(matrix) {
        let Some((row, deficient)) = zero_pivot(&values, &rows) else { continue };
        let found = model.coordinates.iter().find(|coordinate| coordinate.scalars().contains(&row));
        let Some(coordinate) = found else { continue };
        let name = named(coordinate, row);
        let holding = energies.constraints.iter().find(|constraint| {
            graph.symbols(&[constraint.value]).contains(&Symbol::Coordinate(row))
        });
        let message = if deficient && let Some(constraint) = holding {
            let holding = model.constraints[constraint.statement].name.to_string();
            message!(
                "the mass matrix is singular in the direction of `{name}`: its kinetic energy is \
                 that of other coordinates; leave the redundant coordinate out, or, if \
                 `{holding}` holds this direction, as it holds the length of a quaternion, give \
                 it an inertia, which nothing then moves: add the square of the rate of \
                 `{holding}` to `kinetic`"
            )
        } else if deficient {
            message!(
                "the mass matrix is singular in the direction of `{name}`: its kinetic energy is \
                 that of other coordinates; leave the redundant coordinate out"
            )
        } else {
            message!(
                "the kinetic energy is not positive: in the direction of `{name}` it is zero at \
                 every state; take coordinates whose squared velocities stand in it"
            )
        };
        errors.at(coordinate.name.span(), message);
    }
    errors.len() == before
}

/// Returns the name of the scalar coordinate of a row, as written in a block.
fn named(coordinate: &Quantity, row: usize) -> String {
    coordinate.names().swap_remove(row - coordinate.first)
}

/// Returns the entries of a matrix at a random point of a prime field.
///
/// Half of all elements of the field have a root. If there are too many roots to find a point at
/// which all of them exist, roots are treated as unknown functions. Entries that vanish then vanish
/// with roots too.
pub(crate) fn at_random(graph: &Graph, matrix: &[Vec<Id>]) -> Option<Vec<Vec<Residue>>> {
    let roots: Vec<Id> = matrix.iter().flatten().copied().collect();
    let exact = (0..64).find_map(|seed| Point::new(graph, &roots, seed).values(graph, &roots));
    let formal =
        || (0..64).find_map(|seed| Point::formal(graph, &roots, seed).values(graph, &roots));
    let values = exact.or_else(formal)?;
    Some(matrix.iter().map(|row| row.iter().map(|entry| values[entry]).collect()).collect())
}

/// Returns the row at which elimination finds a zero pivot, and whether the rows are linearly
/// dependent.
fn zero_pivot(values: &[Vec<Residue>], block: &[usize]) -> Option<(usize, bool)> {
    let mut rows: Vec<Vec<Residue>> =
        block.iter().map(|&i| block.iter().map(|&j| values[i][j]).collect()).collect();
    for pivot in 0..block.len() {
        let Some(inverse) = rows[pivot][pivot].reciprocal() else {
            let deficient = rows[pivot].iter().skip(pivot).all(|&entry| entry == Residue::ZERO);
            return Some((block[pivot], deficient));
        };
        let (done, rest) = rows.split_at_mut(pivot + 1);
        for row in rest {
            let factor = row[pivot].mul(inverse).negative();
            for (entry, &own) in row.iter_mut().zip(&done[pivot]) {
                *entry = entry.add(own.mul(factor));
            }
        }
    }
    None
}

/// Solves M x = f for a symmetric matrix that has passed `regular`.
pub(crate) fn solve(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Vec<Id> {
    let mut solution = vec![Graph::ZERO; right.len()];
    for block in blocks(matrix) {
        solve_block(graph, matrix, &block, right.len(), right, &mut solution);
    }
    solution
}

/// The solutions of equations with multipliers.
pub(crate) struct Augmented {
    /// The solution for each right side.
    pub(crate) solutions: Vec<Vec<Id>>,
    /// For each multiplier, its pivot divided by the pivot without the reduction by other
    /// multipliers.
    pub(crate) independence: Vec<Id>,
}

/// Solves equations for each of several right sides. The first `count` unknowns are coordinates,
/// the remaining unknowns are multipliers.
pub(crate) fn augmented(
    graph: &mut Graph,
    matrix: &[Vec<Id>],
    count: usize,
    rights: &[Vec<Id>],
) -> Augmented {
    let mut solutions = vec![vec![Graph::ZERO; matrix.len()]; rights.len()];
    let mut independence = vec![Graph::ONE; matrix.len() - count];
    for block in blocks(matrix) {
        let order = elimination(matrix, &block, count).into_iter().map(|(row, _)| row);
        let order: Vec<usize> = order.collect();
        for (right, solution) in rights.iter().zip(&mut solutions) {
            let ratios = solve_block(graph, matrix, &order, count, right, solution);
            for (&row, ratio) in order.iter().zip(ratios) {
                if count <= row {
                    independence[row - count] = ratio;
                }
            }
        }
    }
    Augmented { solutions, independence }
}

/// Counts the products of an elimination with multipliers, from the nonzero entries.
pub(crate) fn products(matrix: &[Vec<Id>], count: usize) -> usize {
    let block = |block: Vec<usize>| {
        let degrees = elimination(matrix, &block, count).into_iter().map(|(_, degree)| degree);
        degrees.map(|degree| degree * (degree + 3) / 2).sum::<usize>()
    };
    blocks(matrix).into_iter().map(block).sum()
}

/// Returns the rows of a block in an order with little fill-in, each with the number of rows
/// coupled to it when it is eliminated: rows with the fewest neighbours first, the last of several
/// equal ones first. A multiplier follows all coordinates of its row, because its pivot has a known
/// sign then.
fn elimination(matrix: &[Vec<Id>], block: &[usize], count: usize) -> Vec<(usize, usize)> {
    let neighbours = |row: usize| {
        let entries = matrix[row].iter().enumerate();
        let others = entries.filter(move |&(other, &entry)| other != row && entry != Graph::ZERO);
        others.map(|(other, _)| other).collect::<BTreeSet<usize>>()
    };
    let mut open: BTreeMap<usize, BTreeSet<usize>> =
        block.iter().map(|&row| (row, neighbours(row))).collect();
    let mut order = Vec::with_capacity(block.len());
    while !open.is_empty() {
        let ready = |row: usize| {
            row < count
                || neighbours(row).iter().all(|other| count <= *other || !open.contains_key(other))
        };
        let next = open
            .iter()
            .filter(|&(&row, _)| ready(row))
            .min_by_key(|&(&row, others)| (others.len(), std::cmp::Reverse(row)))
            .map(|(&row, _)| row);
        let Some(next) = next else { break };
        let others = open.remove(&next).unwrap_or_default();
        for &other in &others {
            if let Some(own) = open.get_mut(&other) {
                own.extend(others.iter().copied().filter(|&third| third != other));
                own.remove(&next);
            }
        }
        order.push((next, others.len()));
    }
    order
}

/// Stores the solution of a block of rows, eliminated in the given order, in `solution`. Returns
/// for each row the ratio of its pivot to the pivot without the reduction by multipliers, which are
/// the rows from `count` on.
fn solve_block(
    graph: &mut Graph,
    matrix: &[Vec<Id>],
    block: &[usize],
    count: usize,
    right: &[Id],
    solution: &mut [Id],
) -> Vec<Id> {
    if let [row] = *block {
        solution[row] = graph.div(right[row], matrix[row][row]);
        return vec![Graph::ONE];
    }
    let mut scales = scales(graph, matrix, block);
    let pivot = graph.product(
        Rational::ONE,
        &[(matrix[block[0]][block[0]], Rational::ONE), (scales[0], Rational::whole(-2))],
    );
    // The first pivot is scaled to one if it depends only on parameters.
    let unit = if graph.dependencies(pivot).any(Dependencies::STATE) { Graph::ONE } else { pivot };
    for (scale, _) in scales.iter_mut().zip(block).filter(|&(_, &row)| count <= row) {
        // The gradients of constraints stay unscaled.
        *scale = graph.power(unit, Rational::MINUS_ONE);
    }
    let scaled: Vec<Vec<Id>> = (0..block.len())
        .map(|i| {
            let entry = |j: usize| {
                let entry =
                    divided(graph, matrix[block[i]][block[j]], &[scales[i], scales[j], unit]);
                // Multiplying out reveals terms of a constant that cancel against squares: 1 − cos²
                // is sin².
                if graph.dependencies(entry).any(Dependencies::STATE) {
                    entry
                } else {
                    velocity_polynomial::expanded(graph, entry)
                }
            };
            (0..block.len()).map(entry).collect()
        })
        .collect();
    let multiplier: Vec<bool> = block.iter().map(|&row| count <= row).collect();
    let Some(factors) = factor(graph, &scaled, &multiplier) else { return Vec::new() };
    let right: Vec<Id> = block
        .iter()
        .zip(&scales)
        .map(|(&row, &scale)| divided(graph, right[row], &[scale, unit]))
        .collect();
    for ((value, &row), &scale) in
        substitute(graph, &factors, right).into_iter().zip(block).zip(&scales)
    {
        solution[row] = divided(graph, value, &[scale]);
    }
    factors.independence
}

/// Returns `true` for each coordinate that is not coupled to any other.
pub(crate) fn uncoupled(matrix: &[Vec<Id>]) -> Vec<bool> {
    matrix
        .iter()
        .map(|row| row.iter().filter(|&&entry| entry != Graph::ZERO).count() == 1)
        .collect()
}

/// Returns for each row a product of parameters that divides all its entries, and the diagonal
/// twice. In chains, these are the lengths. The unknowns are measured in these units, which reduces
/// the number of products that depend on the state.
fn scales(graph: &mut Graph, matrix: &[Vec<Id>], block: &[usize]) -> Vec<Id> {
    let mut scales = Vec::new();
    for &row in block {
        if matrix[row][row] == Graph::ZERO {
            scales.push(Graph::ONE);
            continue;
        }
        let diagonal = graph.factors(matrix[row][row]);
        let common: Vec<(Id, Rational)> = diagonal
            .into_iter()
            .filter(|&(base, exponent)| {
                let parameters_alone = !graph.dependencies(base).any(Dependencies::STATE)
                    && exponent == Rational::whole(2);
                let stands = |&column: &usize| {
                    let entry = matrix[row][column];
                    entry == Graph::ZERO
                        || graph
                            .factors(entry)
                            .iter()
                            .any(|&(other, power)| other == base && !power.is_negative())
                };
                parameters_alone && block.iter().all(stands)
            })
            .map(|(base, _)| (base, Rational::ONE))
            .collect();
        scales.push(graph.product(Rational::ONE, &common));
    }
    scales
}

/// Divides `id` by `divisors`.
fn divided(graph: &mut Graph, id: Id, divisors: &[Id]) -> Id {
    let mut factors = vec![(id, Rational::ONE)];
    factors.extend(divisors.iter().map(|&divisor| (divisor, Rational::MINUS_ONE)));
    graph.product(Rational::ONE, &factors)
}

/// A unit lower triangle and the reciprocals of the pivots.
struct Factors {
    lower: Vec<Vec<Id>>,
    reciprocal: Vec<Id>,
    /// For each multiplier, its pivot divided by the pivot without the reduction by other
    /// multipliers.
    independence: Vec<Id>,
}

/// Returns the independent blocks of rows, in descending order: chains are eliminated from the leaf
/// to the root.
pub(crate) fn blocks(matrix: &[Vec<Id>]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; matrix.len()];
    let mut blocks = Vec::new();
    for start in 0..matrix.len() {
        if seen[start] {
            continue;
        }
        let mut block = Vec::new();
        let mut pending = vec![start];
        seen[start] = true;
        while let Some(row) = pending.pop() {
            block.push(row);
            for (column, &entry) in matrix[row].iter().enumerate() {
                if entry != Graph::ZERO && !seen[column] {
                    seen[column] = true;
                    pending.push(column);
                }
            }
        }
        block.sort_unstable_by(|a, b| b.cmp(a));
        blocks.push(block);
    }
    blocks
}

/// Factors M = L D Lᵀ on atoms; `None` if a pivot is structurally zero.
fn factor(graph: &mut Graph, matrix: &[Vec<Id>], multiplier: &[bool]) -> Option<Factors> {
    let size = matrix.len();
    let mut lower = vec![vec![Graph::ZERO; size]; size];
    // The entries to the left of the pivot, before the division by the pivot.
    let mut scaled = vec![vec![Graph::ZERO; size]; size];
    let mut reciprocal: Vec<Id> = Vec::with_capacity(size);
    let mut independence: Vec<Id> = Vec::with_capacity(size);
    for j in 0..size {
        for i in j..size {
            let entry = graph.atom(matrix[i][j]);
            let mut terms = vec![(entry, Rational::ONE)];
            for k in 0..j {
                if scaled[i][k] != Graph::ZERO && lower[j][k] != Graph::ZERO {
                    terms.push((graph.mul(scaled[i][k], lower[j][k]), Rational::MINUS_ONE));
                }
            }
            scaled[i][j] = graph.atom_of(&terms);
        }
        let pivot = scaled[j][j];
        if pivot == Graph::ZERO {
            return None;
        }
        let inverse = graph.power(pivot, Rational::MINUS_ONE);
        let inverse = graph.atom(inverse);
        for i in j + 1..size {
            if scaled[i][j] != Graph::ZERO {
                let entry = graph.mul(scaled[i][j], inverse);
                // A division that depends on the state is computed once. A quotient by parameters
                // stays open so that it can cancel.
                lower[i][j] = if graph.moving_quotient(entry) {
                    graph.closed(entry)
                } else {
                    graph.atom(entry)
                };
            }
        }
        reciprocal.push(inverse);
        let reduced = |k: usize| multiplier[k] && scaled[j][k] != Graph::ZERO;
        independence.push(if multiplier[j] && (0..j).any(reduced) {
            let mut terms = Vec::new();
            for k in (0..j).filter(|&k| !multiplier[k] && scaled[j][k] != Graph::ZERO) {
                terms.push((graph.mul(scaled[j][k], lower[j][k]), Rational::MINUS_ONE));
            }
            let whole = graph.atom_of(&terms);
            graph.div(pivot, whole)
        } else {
            Graph::ONE
        });
    }
    Some(Factors { lower, reciprocal, independence })
}

fn substitute(graph: &mut Graph, factors: &Factors, mut right: Vec<Id>) -> Vec<Id> {
    let size = right.len();
    for i in 0..size {
        let start = graph.atom(right[i]);
        let mut terms = vec![(start, Rational::ONE)];
        for k in 0..i {
            terms.push((graph.mul(factors.lower[i][k], right[k]), Rational::MINUS_ONE));
        }
        right[i] = graph.atom_of(&terms);
    }
    for i in (0..size).rev() {
        let mut terms = vec![(graph.mul(right[i], factors.reciprocal[i]), Rational::ONE)];
        for k in i + 1..size {
            terms.push((graph.mul(factors.lower[k][i], right[k]), Rational::MINUS_ONE));
        }
        right[i] = graph.atom_of(&terms);
    }
    right
}
