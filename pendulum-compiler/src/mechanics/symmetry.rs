//! Conserved quantities: every symmetry q → q + ε(a + Bq) of the Lagrangian, and the energy where
//! nothing depends on time.
//!
//! The Lagrangian is unchanged if Σ ∂L/∂q_i ξ_i + ∂L/∂q̇_i ξ̇_i vanishes for ξ = a + Bq (Noether
//! 1918), which is linear in a and B: their values are the null space of that sum at random points
//! of a prime field. Where too few points have all square roots, the field gets a root of −1 and
//! the sum's real and imaginary part both vanish. Then Σ p_i ξ_i is conserved, if the forces do no
//! work along ξ either.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Point, Residue, null_space};

/// With more coordinates than this only displacements q → q + εa are looked for.
const MOST_LINEAR: usize = 8;

/// The number of points of the prime field that show if there are enough: more than an eighth has
/// to have all roots.
const SAMPLE: usize = 32;

/// A conserved quantity.
#[derive(Clone, Debug)]
pub(crate) struct Conserved {
    /// Its terms in the names of the momenta: `p_φ`, `x·p_y − y·p_x`.
    pub(crate) terms: Vec<(Rational, Option<usize>, usize)>,
    pub(crate) value: Id,
}

/// The momenta of all symmetries of `lagrangian` along which neither `external` forces nor those of
/// constraints, along their `gradients`, do anything.
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
    // Each point adds to the rank until it is full, but for a chance of D/2⁶¹, D the degree of a
    // minor's norm: the product over the signs of all k roots has at most 2^k times the degree of
    // one factor. Nine points more than there are unknowns must all fail for a displacement that is
    // no symmetry to pass: for D < 2³⁰ with a chance below 2⁻²⁰⁰.
    let wanted = unknowns.len() + 9;
    let nodes = graph.reachable(&roots);
    // The equations of a point for the unknowns; its values are dropped at once.
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
    // Only roots of roots are missing there, each at every other point.
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
    // A row of zeros demands nothing.
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
        // A momentum that is a constant is no news: gauge terms make such.
        if graph.dependencies(value).any(crate::algebra::expr::Dependencies::VELOCITY) {
            found.push(Conserved { terms, value });
        }
    }
    found
}
