//! Coordinates that are rotations: the equations of motion in the rates of the body, and the change
//! to quaternions.
//!
//! The four velocities of a quaternion q are not independent. While the equations are derived, the
//! symbols of its velocities are therefore quasi-velocities: that of its first place is unused, and
//! the three others are the rates Ω about the axes of the body, with q̇ = ½ q Ω. The equations of
//! Poincaré (1901), also Boltzmann's and Hamel's, are those of Lagrange with two changes:
//!
//! d/dt ∂L/∂Ω + Ω × ∂L/∂Ω − X L = Q, where X L is the slope of L along the turns about the axes of
//! the body.
//!
//! They have no multiplier, and of a free body they are Euler's. Positions contain the entries of
//! the matrix R of the rotation, whose rates R [Ω]× and slopes are entries again; polynomials of a
//! quaternion would not be collected as shortly. At the end R and Ω = 2 q* q̇ are substituted:
//! vectors change as q̇ = ½ q Ω, and momenta and forces as p = 2 q π, so that p · q̇ = π · Ω. The
//! constraint |q|² = 1 is kept by the equations already. Its row has the multiplier zero and is
//! there for the projection, which takes off rounding errors. The mass matrix has the mean inertia
//! of the body in the direction of q, which makes it regular and is never moved.

use crate::algebra::diff::{derivative, substitute_in};
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::mechanics::constraint::{Constraint, Constraints, magnitude};
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::mechanics::quaternion::{self, Quaternion, conjugate, product};
use crate::model::{Element, Model};
use std::collections::BTreeMap;

const TWO: Rational = Rational::whole(2);

/// Returns the first scalar of each rotation, and its name.
pub(crate) fn rotations(model: &Model) -> Vec<(usize, String)> {
    let mut rotations = Vec::new();
    for coordinate in &model.coordinates {
        if coordinate.element == Element::Rotation {
            let firsts = coordinate.scalars().step_by(4);
            let members = coordinate.members;
            rotations.extend(firsts.enumerate().map(|(k, first)| match members {
                None => (first, coordinate.name.to_string()),
                Some(_) => (first, format!("{}[{k}]", coordinate.name)),
            }));
        }
    }
    rotations
}

/// Returns the name of the constraint that holds the quaternion of a rotation.
pub(crate) fn norm(name: &str) -> String {
    format!("|{name}|")
}

/// Returns the slope of a function of the positions along the rate of each scalar coordinate.
pub(crate) fn slopes(model: &Model, graph: &mut Graph, id: Id, count: usize) -> Vec<Id> {
    let mut slopes: Vec<Id> =
        (0..count).map(|i| derivative(graph, id, Symbol::Coordinate(i))).collect();
    for (first, _) in rotations(model) {
        slopes[first + 1..first + 4].copy_from_slice(&along_turns(graph, id, first));
    }
    slopes
}

/// Returns the slopes of a function along the turns of a rotation about the axes behind it.
pub(crate) fn along_turns(graph: &mut Graph, id: Id, first: usize) -> [Id; 3] {
    let mut own = [const { Vec::new() }; 3];
    for entry in 0..9 {
        let slope = derivative(graph, id, Symbol::Entry(first, entry));
        // Row u of R changes as u × eₐ along axis a.
        let (row, column) = (entry - entry % 3, entry % 3);
        for (a, other, sign) in [
            ((column + 2) % 3, (column + 1) % 3, Rational::ONE),
            ((column + 1) % 3, (column + 2) % 3, Rational::MINUS_ONE),
        ] {
            let part = graph.symbol(Symbol::Entry(first, row + other));
            own[a].push((graph.mul(slope, part), sign));
        }
    }
    own.map(|terms| graph.sum(&terms))
}

/// Gives each rotation an inertia in the unused direction: the mean of its moments of inertia.
pub(crate) fn add_radial(model: &Model, graph: &mut Graph, masses: &mut [Vec<Id>]) {
    let Some(third) = Rational::whole(3).reciprocal() else { return };
    for (first, _) in rotations(model) {
        let trace = [1, 2, 3].map(|k| (masses[first + k][first + k], third));
        let mean = graph.sum(&trace);
        masses[first][first] = if mean == Graph::ZERO { Graph::ONE } else { mean };
    }
}

/// Returns Ω × π for the rates of each rotation, and zero for other coordinates.
pub(crate) fn gyroscopic(model: &Model, graph: &mut Graph, momenta: &[Id]) -> Vec<Id> {
    let mut turning = vec![Graph::ZERO; momenta.len()];
    for (first, _) in rotations(model) {
        let own = [1, 2, 3].map(|k| momenta[first + k]);
        turning[first + 1..first + 4].copy_from_slice(&turned(graph, first, own));
    }
    turning
}

/// Returns Ω × π for the rates of a rotation.
pub(crate) fn turned(graph: &mut Graph, first: usize, momenta: [Id; 3]) -> [Id; 3] {
    [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(_, b, c)| {
        let rates = [b, c].map(|part| graph.symbol(Symbol::Velocity(first + 1 + part)));
        let left = graph.mul(rates[0], momenta[c]);
        let right = graph.mul(rates[1], momenta[b]);
        graph.sub(left, right)
    })
}

/// Changes a motion from the rates of bodies to quaternions.
pub(crate) fn widen(model: &Model, graph: &mut Graph, motion: &mut Motion, turning: &[Id]) {
    let rotations = rotations(model);
    if rotations.is_empty() {
        return;
    }
    motion.in_rates = Some(Box::new(Motion {
        accelerations: motion.accelerations.clone(),
        mass_matrix: motion.mass_matrix.clone(),
        forces: motion.forces.clone(),
        states: motion.states.clone(),
        energy: motion.energy,
        power: motion.power,
        constraints: Constraints {
            held: motion.constraints.held.clone(),
            redundant: motion.constraints.redundant.clone(),
            sides: motion.constraints.sides.clone(),
            power: motion.constraints.power,
            ..Constraints::default()
        },
        ..Motion::default()
    }));
    for (rate, &own) in motion.momentum_rates.iter_mut().zip(turning) {
        *rate = graph.sub(*rate, own);
    }
    to_quaternions(graph, motion.roots(), &rotations);
    for (first, name) in rotations {
        let q: Quaternion = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Coordinate(first + k)));
        let v: Quaternion = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Velocity(first + k)));
        let square = |graph: &mut Graph, parts: Quaternion| {
            let squares = parts.map(|part| (graph.power(part, TWO), Rational::ONE));
            graph.sum(&squares)
        };
        let speed = square(graph, v);
        // The radial part of M q̈, for which q · q̈ = −|q̇|².
        let radial = graph.mul(motion.mass_matrix[first][first], speed);
        let radial = graph.scale(TWO.negative(), radial);
        motion.forces[first] = radial;
        let momenta = taken(&motion.momenta, first);
        for list in [&mut motion.forces, &mut motion.momenta, &mut motion.momentum_rates] {
            covector(graph, q, list, first);
        }
        let moved = product(graph, TWO, v, momenta);
        for (rate, part) in motion.momentum_rates[first..].iter_mut().zip(moved) {
            *rate = graph.add(*rate, part);
        }
        for row in &mut motion.mass_matrix {
            covector(graph, q, row, first);
        }
        for column in 0..motion.mass_matrix.len() {
            let mut own: Vec<Id> = motion.mass_matrix.iter().map(|row| row[column]).collect();
            covector(graph, q, &mut own, first);
            for (row, entry) in motion.mass_matrix.iter_mut().zip(own) {
                row[column] = entry;
            }
        }
        vector(graph, q, &mut motion.accelerations, first);
        // Along the motion ½ q̇ Ω is −|q̇|² q.
        for (acceleration, part) in motion.accelerations[first..].iter_mut().zip(q) {
            let inward = graph.mul(speed, part);
            *acceleration = graph.sub(*acceleration, inward);
        }
        if let Some(velocities) = &mut motion.velocities {
            vector(graph, q, velocities, first);
        }
        let count = motion.forces.len();
        let constraints = &mut motion.constraints;
        let rows = constraints.held.iter_mut().chain(&mut constraints.redundant);
        for row in rows.chain(&mut constraints.limits).chain(&mut constraints.frictions) {
            covector(graph, q, &mut row.gradient, first);
        }
        if !constraints.sides.is_empty() {
            constraints.sides[first] = radial;
            covector(graph, q, &mut constraints.sides, first);
        }
        constraints.correction.resize(count, Graph::ZERO);
        vector(graph, q, &mut constraints.correction, first);
        let target = graph.symbol(Symbol::Target(constraints.held.len()));
        for (change, part) in constraints.correction[first..].iter_mut().zip(q) {
            let own = graph.mul(target, part);
            let own = graph.scale(Rational::HALF, own);
            *change = graph.add(*change, own);
        }
        let length = square(graph, q);
        let value = graph.sub(length, Graph::ONE);
        let products = [0, 1, 2, 3].map(|k| (graph.mul(q[k], v[k]), TWO));
        let rate = graph.sum(&products);
        let mut gradient = vec![Graph::ZERO; count];
        gradient[first..first + 4].copy_from_slice(&q.map(|part| graph.scale(TWO, part)));
        constraints.held.push(Constraint {
            holonomic: true,
            value,
            gradient,
            rate,
            drive: Graph::ZERO,
            drift: graph.scale(TWO, speed),
            // One for the position: a length is then off by at most 4e-16, its rounding error.
            scales: [Graph::ONE, magnitude(graph, rate)],
        });
        constraints.norms.push(name);
        constraints.multipliers.push(Graph::ZERO);
        constraints.independence.push(Graph::ONE);
    }
}

/// Changes the scalars of a block from the rates of bodies to quaternions.
pub(crate) fn widen_energies(model: &Model, graph: &mut Graph, energies: &mut Energies) {
    let rotations = rotations(model);
    if !rotations.is_empty() {
        to_quaternions(graph, energies.roots(), &rotations);
    }
}

/// Writes the rates of bodies in expressions as functions of quaternions and their rates.
fn to_quaternions(graph: &mut Graph, roots: Vec<&mut Id>, rotations: &[(usize, String)]) {
    let mut values = BTreeMap::new();
    for &(first, _) in rotations {
        let q: Quaternion = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Coordinate(first + k)));
        let back = conjugate(graph, q);
        for (entry, value) in quaternion::matrix(graph, q).into_iter().enumerate() {
            values.insert(Symbol::Entry(first, entry), graph.closed(value));
        }
        for kind in [Symbol::Velocity, Symbol::Acceleration, Symbol::Momentum] {
            let momentum = kind(0) == Symbol::Momentum(0);
            let factor = if momentum { Rational::HALF } else { TWO };
            let own = [0, 1, 2, 3].map(|k| graph.symbol(kind(first + k)));
            let turned = product(graph, factor, back, own);
            // The real part is zero along any motion.
            values.insert(kind(first), Graph::ZERO);
            for k in 1..4 {
                values.insert(kind(first + k), graph.closed(turned[k]));
            }
        }
    }
    substitute_in(graph, roots, |symbol| values.get(&symbol).copied());
}

/// Changes what multiplies rates to what multiplies the rates of the quaternion: 2 q π.
fn covector(graph: &mut Graph, q: Quaternion, list: &mut [Id], first: usize) {
    let own = taken(list, first);
    let own = product(graph, TWO, q, own);
    list[first..first + 4].copy_from_slice(&own);
}

/// Changes rates to those of the quaternion: ½ q Ω.
fn vector(graph: &mut Graph, q: Quaternion, list: &mut [Id], first: usize) {
    let [_, x, y, z] = taken(list, first);
    let own = product(graph, Rational::HALF, q, [Graph::ZERO, x, y, z]);
    list[first..first + 4].copy_from_slice(&own);
}

fn taken(list: &[Id], first: usize) -> Quaternion {
    [0, 1, 2, 3].map(|k| list[first + k])
}
