//! The sparse form against the dense one: equal at random points of a prime field, and cheaper where it should be.

use super::derived;
use crate::articulated;
use crate::error::Errors;
use crate::expr::{Graph, Id};
use crate::modular::{Point, Residue};
use crate::schedule;

/// Compares every output of the two forms and gives the operations of both accelerations.
fn compare(source: &str) -> [schedule::Count; 2] {
    let mut errors = Errors::default();
    let counts = derived(source, &mut errors, |_, graph, motion, energies| {
        let extended = energies.extended.as_ref().unwrap();
        let sparse = articulated::sparse(graph, extended, motion.accelerations.len()).unwrap();
        let velocities = motion.velocities.clone().unwrap();
        let pairs: Vec<(&str, Id, Id)> = [
            ("q̈", &motion.accelerations, &sparse.accelerations),
            ("q̇", &velocities, &sparse.velocities),
            ("p", &motion.momenta, &sparse.momenta),
            ("ṗ", &motion.momentum_rates, &sparse.momentum_rates),
            ("E", &vec![motion.energy], &vec![sparse.energy]),
        ]
        .into_iter()
        .flat_map(|(name, dense, sparse)| {
            dense.iter().zip(sparse).map(|(&a, &b)| (name, a, b)).collect::<Vec<_>>()
        })
        .collect();
        for (name, dense, sparse) in pairs {
            let difference = graph.sub(dense, sparse);
            assert!(vanishes(graph, difference), "{name} of {source}");
        }
        [&motion.accelerations, &sparse.accelerations].map(|roots| schedule::program(graph, roots).count())
    });
    assert!(errors.is_empty(), "{:?}", errors.messages());
    counts.unwrap()
}

fn vanishes(graph: &Graph, id: Id) -> bool {
    let values = (0..64).filter_map(|seed| Point::new(graph, &[id], seed).values(graph, &[id]));
    let mut count = 0;
    values.take(3).inspect(|_| count += 1).all(|values| values[&id] == Residue::ZERO) && 0 < count
}

fn chain(n: usize) -> String {
    format!(
        "struct C {{ m: [kg; {n}], l: [m; {n}], g }} coordinate θ[{n}]; let y[k in 0..{n}] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
         kinetic = sum(k in 0..{n}, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..{n}, m[k]*g*height(y[k]));"
    )
}

#[test]
fn chains() {
    for n in [2, 3, 4, 5, 6, 8, 10] {
        let [dense, sparse] = compare(&chain(n));
        println!("{n} {dense:?}\n  {sparse:?}");
    }
}
