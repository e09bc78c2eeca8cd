//! The sparse form and the dense form: equal at random points of a prime field, and the sparse form
//! is cheaper for long chains.

use super::derived;
use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Point, Residue};
use crate::mechanics::articulated;
use crate::mechanics::euler_lagrange;
use crate::mechanics::lower::{at_rest_controls, total_derivative};
use crate::mechanics::solve;
use crate::messages::Errors;
use crate::schedule;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Compares every output of the two forms and returns the programs of both accelerations.
fn compare(source: &str) -> [schedule::Program; 2] {
    let mut errors = Errors::default();
    let programs = derived(source, &mut errors, |_, graph, motion, energies| {
        let extended = energies.extended.as_ref().unwrap();
        let sparse =
            articulated::sparse(graph, extended, motion.accelerations.len(), false).unwrap();
        let lagrangian = match (energies.lagrangian, energies.kinetic, energies.potential) {
            (Some(lagrangian), ..) => lagrangian,
            (None, kinetic, potential) => {
                graph.sub(kinetic.unwrap_or_default(), potential.unwrap_or_default())
            }
        };
        let count = motion.accelerations.len();
        let slopes = |graph: &mut Graph, id: Id, symbol: fn(usize) -> Symbol| -> Vec<Id> {
            (0..count).map(|i| derivative(graph, id, symbol(i))).collect()
        };
        let momenta = slopes(graph, lagrangian, Symbol::Velocity);
        let pulls = slopes(graph, lagrangian, Symbol::Coordinate);
        let frictions = slopes(graph, energies.dissipation.unwrap_or_default(), Symbol::Velocity);
        let rates: Vec<Id> = (0..count)
            .map(|i| {
                let terms = [(pulls[i], 1), (energies.forces[i], 1), (frictions[i], -1)];
                graph.sum(&terms.map(|(id, sign)| (id, Rational::whole(sign))))
            })
            .collect();
        let own = at_rest_controls(graph, lagrangian);
        let mut energy = vec![(own, Rational::MINUS_ONE)];
        for (i, &momentum) in momenta.iter().enumerate() {
            let velocity = graph.symbol(Symbol::Velocity(i));
            energy.push((graph.mul(velocity, momentum), Rational::ONE));
        }
        let energy = graph.sum(&energy);
        let accelerations = solve::solve(graph, &motion.mass_matrix, &motion.forces);
        let velocities = euler_lagrange::invert(graph, &motion.mass_matrix, &momenta).unwrap();
        let pairs: Vec<(&str, Id, Id)> = [
            ("q̈", &accelerations, &sparse.accelerations),
            ("q̇", &velocities, &sparse.velocities),
            ("p", &momenta, &sparse.momenta),
            ("ṗ", &rates, &sparse.momentum_rates),
            ("E", &vec![energy], &vec![sparse.energy]),
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
        [&accelerations, &sparse.accelerations].map(|roots| schedule::program(graph, roots))
    });
    assert!(errors.is_empty(), "{:?}", errors.messages());
    programs.unwrap()
}

/// Compares all quantities of a chain that is derived in sparse form only with the derivatives of
/// its Lagrangian, and returns the cost of the accelerations.
fn check_alone(source: &str) -> usize {
    let mut errors = Errors::default();
    let cost = derived(source, &mut errors, |_, graph, motion, energies| {
        let cost = schedule::cost(graph, &motion.accelerations);
        // The limit of the derivation has no say in what it is compared with.
        graph.limit_work(usize::MAX);
        let count = motion.accelerations.len();
        let lagrangian = graph.sub(energies.kinetic.unwrap(), energies.potential.unwrap());
        let velocities: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Velocity(i))).collect();
        let momenta: Vec<Id> =
            (0..count).map(|i| derivative(graph, lagrangian, Symbol::Velocity(i))).collect();
        let mut pairs = Vec::new();
        let held = &motion.constraints.held;
        for i in 0..count {
            let mut terms = vec![(motion.forces[i], Rational::MINUS_ONE)];
            for j in 0..count {
                let mass = derivative(graph, momenta[i], Symbol::Velocity(j));
                pairs.push((mass, motion.mass_matrix[i][j]));
                terms.push((graph.mul(mass, motion.accelerations[j]), Rational::ONE));
            }
            for (row, &multiplier) in held.iter().zip(&motion.constraints.multipliers) {
                terms.push((graph.mul(row.gradient[i], multiplier), Rational::MINUS_ONE));
            }
            pairs.push((graph.sum(&terms), Graph::ZERO));
            let slope = derivative(graph, lagrangian, Symbol::Coordinate(i));
            let drift = total_derivative(graph, momenta[i], &BTreeMap::new());
            pairs.push((graph.sub(slope, drift), motion.forces[i]));
            if held.is_empty() {
                pairs.push((slope, motion.momentum_rates[i]));
            }
        }
        for row in held {
            let rate = graph.inner(&row.gradient, &motion.accelerations);
            pairs.push((rate, graph.negative(row.drift)));
        }
        let known = |symbol| match symbol {
            Symbol::Momentum(i) => Some(momenta[i]),
            _ => None,
        };
        for (&own, &velocity) in motion.velocities.iter().flatten().zip(&velocities) {
            pairs.push((substitute(graph, own, known), velocity));
        }
        pairs.extend(momenta.iter().copied().zip(motion.momenta.iter().copied()));
        let action = graph.inner(&velocities, &momenta);
        pairs.push((graph.sub(action, lagrangian), motion.energy));
        for (place, (a, b)) in pairs.into_iter().enumerate() {
            let difference = graph.sub(a, b);
            assert!(vanishes(graph, difference), "{place} of {source}");
        }
        cost
    });
    assert!(errors.is_empty(), "{:?}", errors.messages());
    cost.unwrap()
}

/// Returns a chain of solids on hinges whose axes are those of coordinates in turn.
fn hinges(n: usize) -> String {
    let axes = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"];
    let (mut lets, mut kinetic, mut potential) = (String::new(), String::new(), String::new());
    for k in 0..n {
        let (before, joint) = match k {
            0 => (String::new(), "[0, 0, 0]".into()),
            _ => (format!("R{}*", k - 1), format!("y{0} + R{0}*l", k - 1)),
        };
        write!(
            lets,
            "let R{k} = {before}rotation({}, θ[{k}]); let y{k} = {joint}; let c{k} = y{k} + R{k}*c;
             let W{k} = transpose(R{k})*angular_velocity(R{k}); ",
            axes[(k + 1) % 3]
        )
        .unwrap();
        write!(kinetic, " + m/2*|dot(c{k})|^2 + inner(W{k}, J*W{k})/2").unwrap();
        write!(potential, " + m*g*height(c{k})").unwrap();
    }
    format!(
        "struct C {{ m, g, l: [_; 3], c: [_; 3], J: [_; 3, 3] }} coordinate θ[{n}]; {lets}
         kinetic = 0{kinetic}; potential = 0{potential};"
    )
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

/// Blocks of various shapes, for which the two forms are the same functions.
#[rustfmt::skip]
const BLOCKS: &[(&str, &str)] = &[
    ("a driven chain",
     "struct S { m: [kg; 3], l: [m; 3], g } coordinate θ[3]; driven x: [m; 2];
      let y[k in 0..3] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
      kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..3, m[k]*g*height(y[k]));"),
    ("a tree: two arms on a trunk, one of them in two parts",
     "struct S { m, l, g } coordinate a; coordinate b; coordinate c; coordinate d; driven x: [m; 2];
      let trunk = x + l*[sin(a), -cos(a)]; let left = trunk + l*[sin(b), -cos(b)]; let right = trunk + 2*l*[sin(c), -cos(c)];
      let tip = right + l*[sin(d), -cos(d)];
      kinetic = m/2*(|dot(trunk)|^2 + 2*|dot(left)|^2 + 3*|dot(right)|^2 + |dot(tip)|^2); potential = m*g*height(trunk + left + right + tip);"),
    ("compound bodies: joints without mass, centres of mass beside them, inertia of their own",
     "struct S { m: [kg; 3], J: [kg*m^2; 3], l, h, g } coordinate θ[3]; let joint[k in 0..3] = sum(j in 0..k, l*cis(θ[j]));
      let center[k in 0..3] = joint[k] + h*cis(θ[k]);
      kinetic = sum(k in 0..3, m[k]/2*|dot(center[k])|^2 + J[k]/2*θ̇[k]^2); potential = sum(k in 0..3, m[k]*g*height(center[k]));"),
    ("a body's velocity and its turn coupled: a compound chain written with the velocity of its joints",
     "struct S { m, I, c: [m; 2], l, g } coordinate θ[2]; let y[k in 0..2] = sum(j in 0..k, l*cis(θ[j])) + [0, 0]*θ[k];
      let joint = l*cis(θ[0]);
      kinetic = I/2*θ̇[0]^2 + m/2*|dot(joint)|^2 + m*θ̇[1]*inner(dot(joint), perp(cis(θ[1])*c)) + I/2*θ̇[1]^2;
      potential = m*g*(height(cis(θ[0])*c) + height(joint + cis(θ[1])*c));"),
    ("springs in the links: two coordinates a joint",
     "struct S { m, k, g } coordinate r[3]; coordinate θ[3]; let y[i in 0..3] = sum(j in 0..=i, r[j]*[sin(θ[j]), -cos(θ[j])]);
      kinetic = sum(i in 0..3, m/2*|ẏ[i]|^2); potential = sum(i in 0..3, m*g*height(y[i]) + k/2*(r[i] - 1)^2);"),
    ("air drag on every bob, friction in the joints and a motor",
     "struct S { m, l, c, b, u, w } coordinate θ[3]; driven x: [m; 2]; let y[k in 0..3] = x + sum(j in 0..=k, l*cis(θ[j]));
      kinetic = sum(k in 0..3, m/2*|ẏ[k]|^2); dissipation = sum(k in 0..3, c/2*|ẏ[k]|^2 + b/2*θ̇[k]^2); force θ[1] = u*sin(w*t);"),
    ("a cart",
     "struct S { M, m, l, g } coordinate s; coordinate θ[2]; let cart = [s, 0]; let y[k in 0..2] = cart + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
      kinetic = M/2*|dot(cart)|^2 + sum(k in 0..2, m/2*|ẏ[k]|^2); potential = sum(k in 0..2, m*g*height(y[k]));"),
    ("coordinates that no position needs, and masses that change",
     "struct S { m, l, J, w } coordinate θ[2]; coordinate φ; let y[k in 0..2] = sum(j in 0..=k, l*cis(θ[j]));
      kinetic = exp(w*t)*sum(k in 0..2, m/2*|ẏ[k]|^2) + J/2*(φ̇ + θ̇[0])^2; potential = m*cos(φ);"),
    ("links in space",
     "struct S { m, l, g } coordinate θ[2]; coordinate φ[2]; driven x: [m; 3];
      let y[k in 0..2] = x + sum(j in 0..=k, l*[sin(θ[j])*cos(φ[j]), sin(θ[j])*sin(φ[j]), -cos(θ[j])]);
      kinetic = sum(k in 0..2, m/2*|ẏ[k]|^2); potential = sum(k in 0..2, m*g*height(y[k]));"),
    ("hinges on a base that moves and turns, pushed at a point, turned by a motor and rubbed",
     "struct S { m, c: [_; 3], J: [_; 3, 3], n: [_; 3], b, F: [_; 3], k } coordinate θ[3]; driven x: [m; 3]; driven P: rotation;
      let R[k in 0..3] = P*product(j in 0..=k, rotation([1 - j, j, 0], θ[j])); let y[k in 0..3] = x + sum(j in 0..=k, R[j]*c);
      kinetic = sum(k in 0..3, m/2*|dot(y[k])|^2 + inner(transpose(R[k])*angular_velocity(R[k]), J*transpose(R[k])*angular_velocity(R[k]))/2);
      potential = k*inner(R[2]*n, P*n); dissipation = b/2*|angular_velocity(R[1])|^2 + b*θ̇[2]^2; force y[1] = F; torque R[2] = c.x*(R[1]*F);"),
    ("a force that the program gives, as a potential",
     "struct S { m, l, g } coordinate θ[3]; input u: N; let y[k in 0..3] = sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
      kinetic = sum(k in 0..3, m/2*|ẏ[k]|^2); potential = sum(k in 0..3, m*g*height(y[k])) - u*y[2].x;"),
    ("a tree of hinges: two arms on a trunk, an axis that moves, and a rotation between two others",
     "struct S { m, c: [_; 3], J, g } coordinate a; coordinate b; coordinate d;
      let R = rotation([0, 0, 1], a); let A = R*rotation(c, b); let B = R*rotation([0, 1, 0], d)*rotation([1, sin(a), 0], b); let D = transpose(A)*B;
      let y = R*c; let u = y + A*c; let w = y + B*c;
      kinetic = m/2*(|dot(y)|^2 + |dot(u)|^2 + |dot(w)|^2) + J/2*(|angular_velocity(B)|^2 + |angular_velocity(D)|^2) + J/2*(ȧ^2 + ḃ^2); potential = m*g*height(y + u + w);"),
    ("a charge in a magnetic field, with a velocity-linear term",
     "struct S { m, l, B } coordinate θ[2]; let y[k in 0..2] = sum(j in 0..=k, l*cis(θ[j]));
      lagrangian = sum(k in 0..2, m/2*|ẏ[k]|^2 + B/2*cross(y[k], ẏ[k]));"),
];

#[test]
fn both_forms_are_the_same_functions() {
    for (name, source) in BLOCKS {
        println!("{name}");
        let [dense, sparse] = compare(source).map(|program| program.count());
        println!("    dense {dense:?}\n    sparse {sparse:?}");
    }
}

#[test]
fn chains_and_trees_grow_linearly() {
    let costs: Vec<usize> = [4, 8, 12].map(|n| compare(&chain(n))[1].cost()).to_vec();
    assert_eq!(costs[2] - costs[1], costs[1] - costs[0]);
    let costs: Vec<usize> = [4, 8, 12].map(|n| compare(&comb(n))[1].cost()).to_vec();
    assert_eq!(costs[2] - costs[1], costs[1] - costs[0]);
}

/// Returns a chain with a branch at every joint.
fn comb(n: usize) -> String {
    format!(
        "struct C {{ m: [kg; {n}], l: [m; {n}], g }} coordinate θ[{n}]; coordinate φ[{n}];
         let y[k in 0..{n}] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]); let z[k in 0..{n}] = y[k] + l[k]*[sin(φ[k]), -cos(φ[k])];
         kinetic = sum(k in 0..{n}, m[k]/2*(|ẏ[k]|^2 + |ż[k]|^2)); potential = sum(k in 0..{n}, m[k]*g*height(y[k] + z[k]));"
    )
}

#[test]
fn jets_of_longer_chains_come_from_equations_that_are_not_solved() {
    for (links, turned) in [(2, false), (3, true), (8, true)] {
        let source = format!("::p; {}", chain(links));
        let tokens = crate::compile::expand(source.parse().unwrap()).to_string();
        assert_eq!(tokens.contains("series :: turned"), turned, "{links} links");
    }
}

/// A further hinge costs the same. Six are too long to be written out in their velocities.
#[test]
#[ignore = "takes ten seconds: `.ci/run` runs it"]
fn chains_of_hinges_grow_linearly() {
    let [six, seven, eight] = [6, 7, 8].map(|n| check_alone(&hinges(n)));
    assert!(eight - seven <= seven - six + 20 && eight < 4200, "{six} {seven} {eight}");
    let tip = format!("{} constraint end: inner([2, 1, 0], c5) = l.x/3;", hinges(6));
    check_alone(&tip);
}
