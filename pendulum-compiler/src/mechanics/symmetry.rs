//! Conserved quantities: every symmetry q → q + ε(a + Bq) of the Lagrangian, also with turns of
//! rotations R by ε about an axis of space or of the body.
//!
//! The Lagrangian is unchanged if Σ ∂L/∂q_i ξ_i + ∂L/∂q̇_i ξ̇_i vanishes for ξ = a + Bq (Noether
//! 1918). A turn about an axis n of space changes R by n × R and none of the rates Ω of the body;
//! one about an axis e of the body changes R by R [e]× and Ω by Ω × e. The sum is linear in a, B, n
//! and e, and their values are its null space at random points of a prime field, at which R is
//! orthogonal. If too few points have all square roots, the field is extended by a root of −1, and
//! both the real and the imaginary part of the sum have to vanish. Σ p_i ξ_i is conserved if the
//! forces do no work along ξ either.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Equations, Point, Residue, Row, Values};
use std::collections::{BTreeMap, BTreeSet};

/// The largest number of coordinates for which matrices B are searched. With more coordinates, only
/// displacements q → q + εa are.
const MOST_LINEAR: usize = 8;

/// The number of points of the prime field in a sample. The prime field is used if all roots
/// exist at more than an eighth of them.
const SAMPLE: u64 = 32;

/// The number of points that have to add no condition.
const IDLE: usize = 9;

/// A displacement of coordinates, whose momentum may be conserved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Displacement {
    /// Of a coordinate by a constant.
    Constant(usize),
    /// Of the first coordinate by the second.
    Linear(usize, usize),
    /// A turn of a rotation, given by its first scalar, about an axis of space.
    InSpace(usize, usize),
    /// The same about an axis of the body.
    InBody(usize, usize),
}

use Displacement::{Constant, InBody, InSpace, Linear};

/// A conserved quantity.
#[derive(Clone, Debug)]
pub(crate) struct Conserved {
    /// The terms, written with the names of the momenta: `p_φ`, `x·p_y − y·p_x`.
    pub(crate) terms: Vec<(Rational, Displacement)>,
    pub(crate) value: Id,
}

/// The entries of a rotation, and the slopes of the Lagrangian along them.
struct Entries {
    entries: [Id; 9],
    slopes: [Id; 9],
}

/// Returns the momenta of all symmetries of `lagrangian` along which none of the `forces` does
/// work. The slopes along the rates of the `rotations`, which are given by their first scalars, are
/// those along turns about the axes of the body.
pub(crate) fn conserved(
    graph: &mut Graph,
    lagrangian: Id,
    slopes: &[Id],
    momenta: &[Id],
    forces: &[Vec<Id>],
    rotations: &[usize],
) -> Vec<Conserved> {
    let count = momenta.len();
    let coordinates: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Coordinate(i))).collect();
    let velocities: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Velocity(i))).collect();
    let turned: BTreeMap<usize, Entries> = rotations
        .iter()
        .map(|&first| {
            let symbols: [Symbol; 9] = core::array::from_fn(|entry| Symbol::Entry(first, entry));
            let entries = symbols.map(|symbol| graph.symbol(symbol));
            let slopes = symbols.map(|symbol| derivative(graph, lagrangian, symbol));
            (first, Entries { entries, slopes })
        })
        .collect();
    let free = |&i: &usize| !rotations.iter().any(|&first| (first..first + 4).contains(&i));
    let free: Vec<usize> = (0..count).filter(free).collect();
    let mut unknowns: Vec<Displacement> = free.iter().map(|&i| Constant(i)).collect();
    if count <= MOST_LINEAR {
        unknowns.extend(free.iter().flat_map(|&i| free.iter().map(move |&j| Linear(i, j))));
    }
    for turn in [InSpace, InBody] {
        unknowns.extend(rotations.iter().flat_map(|&first| [0, 1, 2].map(|a| turn(first, a))));
    }
    let mut roots: Vec<Id> = [slopes, momenta, &coordinates, &velocities].concat();
    roots.extend(turned.values().flat_map(|own| own.entries.into_iter().chain(own.slopes)));
    roots.extend(forces.iter().flatten());
    let nodes = graph.reachable(&roots);
    // The places of a node in the equations for displacements by constants: row and unknown.
    let mut places: BTreeMap<Id, Vec<(usize, usize)>> = BTreeMap::new();
    let forces = [slopes].into_iter().chain(forces.iter().map(Vec::as_slice));
    for (row, list) in forces.clone().enumerate() {
        list.iter().enumerate().for_each(|(i, &id)| places.entry(id).or_default().push((row, i)));
    }
    let mut parents: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
    for &id in &nodes {
        graph.children(id).iter().for_each(|&child| parents.entry(child).or_default().push(id));
    }
    // The equations of a point.
    let equations_at = |values: &Values| {
        let at = |id: Id| values[&id];
        let times = |a: Id, b: Id| at(a).mul(at(b));
        let minus = |a: Residue, b: Residue| a.add(b.negative());
        let entry = |row: usize, forces: &[Id], displacement: Displacement| match displacement {
            Constant(i) => at(forces[i]),
            Linear(i, j) if row == 0 => {
                times(forces[i], coordinates[j]).add(times(momenta[i], velocities[j]))
            }
            Linear(i, j) => times(forces[i], coordinates[j]),
            InSpace(first, a) => {
                let Entries { entries, slopes } = &turned[&first];
                let [b, c] = [(a + 1) % 3, (a + 2) % 3];
                (0..3).fold(Residue::ZERO, |sum, k| {
                    sum.add(if row == 0 {
                        // n × column k
                        let up = times(slopes[3 * c + k], entries[3 * b + k]);
                        minus(up, times(slopes[3 * b + k], entries[3 * c + k]))
                    } else {
                        times(forces[first + 1 + k], entries[3 * a + k])
                    })
                })
            }
            InBody(first, a) if row == 0 => {
                let [b, c] = [first + 1 + (a + 1) % 3, first + 1 + (a + 2) % 3];
                let turn =
                    minus(times(momenta[b], velocities[c]), times(momenta[c], velocities[b]));
                at(forces[first + 1 + a]).add(turn)
            }
            InBody(first, a) => at(forces[first + 1 + a]),
        };
        let row = |(row, forces): (usize, &[Id])| {
            unknowns.iter().enumerate().map(|(k, &own)| (k, entry(row, forces, own))).collect()
        };
        forces.clone().enumerate().map(row).collect::<Vec<Row>>()
    };
    // The differences of the equations at a point with another value of one symbol. They contain
    // only coordinates that are coupled with it. Turns are not among them.
    let differences = |point: &Point, symbol: Id, values: &mut Values| {
        let (mut above, mut pending) = (BTreeSet::new(), vec![symbol]);
        while let Some(id) = pending.pop() {
            if values.contains_key(&id) && above.insert(id) {
                pending.extend(parents.get(&id).into_iter().flatten());
            }
        }
        let above: Vec<Id> = above.into_iter().collect();
        let old: Vec<(Id, Residue)> = above.iter().map(|&id| (id, values[&id])).collect();
        let mut rows: BTreeMap<usize, Row> = BTreeMap::new();
        if point.moved(symbol).evaluate(graph, &above, values).is_some() {
            for &(id, old) in &old {
                let change = values[&id].add(old.negative());
                for &(row, i) in places.get(&id).into_iter().flatten() {
                    rows.entry(row).or_default().insert(i, change);
                }
            }
        }
        values.extend(old);
        rows.into_values().collect::<Vec<Row>>()
    };
    let prime = Point::new(graph, &roots, 0).orthogonal();
    let exists = |&seed: &u64| {
        let point = prime.again(seed);
        point.evaluate(graph, &nodes, &mut Values::new()).is_some()
    };
    let tried = 16 * unknowns.len() as u64 + 256;
    let (point, seeds) = if (0..SAMPLE).filter(exists).nth(SAMPLE as usize / 8).is_some() {
        (prime, 0..tried)
    } else {
        // In the extension, only roots of roots may be missing, each at half of the points.
        (Point::extended(graph, &roots, 0).orthogonal(), tried..2 * tried)
    };
    // Each point raises the rank until the rank is full, except with a probability of D/2⁶¹, where
    // D is the degree of the norm of a minor. The norm is the product over the signs of all k roots
    // and has at most 2^k times the degree of one factor. All of the last points have to fail if a
    // displacement that is not a symmetry is accepted, which for D < 2³⁰ has a probability below
    // 2⁻²⁰⁰.
    let (mut equations, mut idle) = (Equations::default(), 0);
    for seed in seeds {
        let (point, mut values) = (point.again(seed), Values::new());
        if point.evaluate(graph, &nodes, &mut values).is_none() {
            continue;
        }
        let rank = equations.rank();
        let mut insert = |rows: Vec<Row>| {
            for row in rows {
                for part in [0, 1] {
                    let entries = row.iter().map(|(&k, value)| (k, value.parts()[part]));
                    let entries = entries.filter(|&(_, value)| value != Residue::ZERO);
                    equations.insert(&entries.collect());
                }
            }
            equations.rank() == unknowns.len()
        };
        let full = insert(equations_at(&values))
            || MOST_LINEAR < count
                && rotations.is_empty()
                && idle == 0
                && coordinates
                    .iter()
                    .chain(&velocities)
                    .any(|&symbol| insert(differences(&point, symbol, &mut values)));
        if full {
            return Vec::new();
        }
        idle = if rank < equations.rank() { 0 } else { idle + 1 };
        if idle == IDLE {
            break;
        }
    }
    if idle < IDLE {
        // There are too few points.
        return Vec::new();
    }
    let mut found = Vec::new();
    for vector in equations.null_space(unknowns.len()) {
        let term = |(k, residue): (usize, Residue)| Some((residue.rational()?, unknowns[k]));
        let terms: Option<Vec<(Rational, Displacement)>> = vector.into_iter().map(term).collect();
        let Some(terms) = terms else { continue };
        let mut sum = Vec::new();
        for &(factor, displacement) in &terms {
            match displacement {
                Constant(i) => sum.push((momenta[i], factor)),
                Linear(i, j) => sum.push((graph.mul(coordinates[j], momenta[i]), factor)),
                InSpace(first, a) => sum.extend([0, 1, 2].map(|k| {
                    let entry = turned[&first].entries[3 * a + k];
                    (graph.mul(entry, momenta[first + 1 + k]), factor)
                })),
                InBody(first, a) => sum.push((momenta[first + 1 + a], factor)),
            }
        }
        let value = graph.sum(&sum);
        // A momentum that is a constant is not reported. It may result from gauge terms.
        if graph.dependencies(value).any(crate::algebra::expr::Dependencies::VELOCITY) {
            found.push(Conserved { terms, value });
        }
    }
    found
}
