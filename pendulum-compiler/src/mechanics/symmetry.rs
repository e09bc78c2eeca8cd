//! Conserved quantities: every symmetry q → q + ε(a + Bq) of the Lagrangian.
//!
//! The Lagrangian is unchanged if Σ ∂L/∂q_i ξ_i + ∂L/∂q̇_i ξ̇_i vanishes for ξ = a + Bq (Noether
//! 1918). The sum is linear in a and B, and their values are its null space at random points of a
//! prime field. If too few points have all square roots, the field is extended by a root of −1, and
//! both the real and the imaginary part of the sum have to vanish. Σ p_i ξ_i is conserved if the
//! forces do no work along ξ either.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Point, Residue, null_space};

/// The largest number of coordinates for which matrices B are searched. With more coordinates, only
/// displacements q → q + εa are.
const MOST_LINEAR: usize = 8;

/// The number of points of the prime field in a first sample. The prime field is used if all roots
/// exist at more than an eighth of them.
const SAMPLE: usize = 32;

/// A conserved quantity.
#[derive(Clone, Debug)]
pub(crate) struct Conserved {
    /// The terms, written with the names of the momenta: `p_φ`, `x·p_y − y·p_x`.
    pub(crate) terms: Vec<(Rational, Option<usize>, usize)>,
    pub(crate) value: Id,
}

/// Returns the momenta of all symmetries of `lagrangian` along which neither the `external` forces
/// nor the constraint forces, which are along the `gradients`, do work.
pub(crate) fn conserved(
    graph: &mut Graph,
    lagrangian: Id,
    momenta: &[Id],
    external: &[Id],
    gradients: &[Vec<Id>],
) -> Vec<Conserved> {
    let count = momenta.len();
    let coordinates: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Coordinate(i))).collect();
    let velocities: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Velocity(i))).collect();
    let slopes: Vec<Id> =
        (0..count).map(|i| derivative(graph, lagrangian, Symbol::Coordinate(i))).collect();
    // Displacements of coordinate i, by a constant or by coordinate j.
    let mut unknowns: Vec<(usize, Option<usize>)> = (0..count).map(|i| (i, None)).collect();
    if count <= MOST_LINEAR {
        unknowns.extend((0..count).flat_map(|i| (0..count).map(move |j| (i, Some(j)))));
    }
    let mut roots: Vec<Id> = [&slopes[..], momenta, external, &coordinates, &velocities].concat();
    roots.extend(gradients.iter().flatten());
    // Each point raises the rank until the rank is full, except with a probability of D/2⁶¹, where
    // D is the degree of the norm of a minor. The norm is the product over the signs of all k roots
    // and has at most 2^k times the degree of one factor. There are nine more points than unknowns.
    // All nine have to fail if a displacement that is not a symmetry is accepted, which for D < 2³⁰
    // has a probability below 2⁻²⁰⁰.
    let wanted = unknowns.len() + 9;
    let nodes = graph.reachable(&roots);
    // The equations of a point for the unknowns. The values at the point are not kept.
    let demands = |point: &Point, seed: u64| {
        let values = point.again(seed).values_of(graph, &nodes)?;
        let at = |id: Id| values[&id];
        let change = unknowns.iter().map(|&(i, j)| match j {
            None => at(slopes[i]),
            Some(j) => {
                at(slopes[i]).mul(at(coordinates[j])).add(at(momenta[i]).mul(at(velocities[j])))
            }
        });
        let work = |forces: &[Id]| {
            let work = unknowns.iter().map(|&(i, j)| match j {
                None => at(forces[i]),
                Some(j) => at(forces[i]).mul(at(coordinates[j])),
            });
            work.collect::<Vec<Residue>>()
        };
        let mut demands = vec![change.collect(), work(external)];
        demands.extend(gradients.iter().map(|gradient| work(gradient)));
        Some(demands)
    };
    let prime = Point::new(graph, &roots, 0);
    let mut tried = 0..8 * unknowns.len() as u64 + 64;
    let mut points: Vec<Vec<Vec<Residue>>> =
        tried.by_ref().take(SAMPLE).filter_map(|seed| demands(&prime, seed)).collect();
    if SAMPLE < 8 * points.len() {
        let missing = wanted.saturating_sub(points.len());
        points.extend(tried.by_ref().filter_map(|seed| demands(&prime, seed)).take(missing));
    }
    // In the extension, only roots of roots may be missing, each at half of the points.
    let extended = Point::extended(graph, &roots, 0);
    let more = (tried.end..2 * tried.end).filter_map(|seed| demands(&extended, seed));
    points.extend(more.take(wanted.saturating_sub(points.len())));
    if points.len() < wanted {
        return Vec::new();
    }
    let part = |row: &[Residue], index: usize| {
        row.iter().map(|value| value.parts()[index]).collect::<Vec<Residue>>()
    };
    let mut rows: Vec<Vec<Residue>> =
        points.iter().flatten().flat_map(|row| [part(row, 0), part(row, 1)]).collect();
    // A row of zeros imposes no condition.
    rows.retain(|row| row.iter().any(|&value| value != Residue::ZERO));
    let mut found = Vec::new();
    for vector in null_space(rows, unknowns.len()) {
        let exact: Option<Vec<Rational>> =
            vector.iter().map(|residue| residue.rational()).collect();
        let Some(exact) = exact else { continue };
        let terms: Vec<(Rational, Option<usize>, usize)> = exact
            .into_iter()
            .zip(&unknowns)
            .filter(|(factor, _)| !factor.is_zero())
            .map(|(factor, &(i, j))| (factor, j, i))
            .collect();
        let mut sum = Vec::new();
        for &(factor, j, i) in &terms {
            let part = match j {
                None => momenta[i],
                Some(j) => graph.mul(coordinates[j], momenta[i]),
            };
            sum.push((part, factor));
        }
        let value = graph.sum(&sum);
        // A momentum that is a constant is not reported. It may result from gauge terms.
        if graph.dependencies(value).any(crate::algebra::expr::Dependencies::VELOCITY) {
            found.push(Conserved { terms, value });
        }
    }
    found
}
