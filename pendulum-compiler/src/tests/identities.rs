//! Identities that hold without reference values, at random states of various systems.

use super::{Random, derive, evaluate};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Symbol};
use std::collections::BTreeMap;

const SYSTEMS: &[&str] = &[
    "struct S { m, L, g } coordinate θ; driven x: [1; 2]; let y = L*[sin(θ), -cos(θ)]; kinetic = m/2*|ẋ + ẏ|^2; potential = m*g*(height(x) + height(y));",
    "struct S { m: [1; 4], l: [1; 4], g } coordinate θ[4]; driven x: [1; 2];
     let y[k in 0..4] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
     kinetic = sum(k in 0..4, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..4, m[k]*g*height(y[k]));",
    "struct S { m, k, l, g, c, w: Hz } coordinate r; coordinate θ; driven x: [1; 2]; let y = x + (l + r)*[sin(θ), -cos(θ)];
     kinetic = m/2*|ẏ|^2; potential = m*g*height(y) + k/2*r^2; dissipation = c/2*(ṙ^2 + r^2*θ̇^2); force θ = m*l*g*sin(3*w*t)*θ̇/w;",
    "struct S { m, R, w } coordinate θ; coordinate φ; let r = R*[sin(θ)*cos(φ + w*t), sin(θ)*sin(φ + w*t), -cos(θ)]; kinetic = m/2*|ṙ|^2; potential = m*height(r);",
    "struct S { c } coordinate x; coordinate y; lagrangian = exp(c*t)*(ẋ^2 + ẏ^2 + ẋ*ẏ*x)/2 + (x*ẏ - y*ẋ)*t - 1/|[x, y]|;",
    "struct S { m, L, k } coordinate x; coordinate θ; driven h; input u; input f: [_; 2]; let y = [x, h] + L*[sin(θ), -cos(θ)];
     kinetic = m/2*(ẋ^2 + |ẏ|^2); potential = k/2*(θ - u)^2 - inner(f, y) + m*height(y); dissipation = k*u^2*ẋ^2; force x = u*θ̇;",
    "struct S { c } coordinate x; coordinate y; lagrangian = -c^2*sqrt(1 - (ẋ^2 + ẏ^2)/(100*c^2)) - (x^2 + y^4)/2;",
];

struct Point {
    random: Random,
    values: BTreeMap<Symbol, f64>,
}

impl Point {
    fn value(&mut self, graph: &Graph, id: Id) -> f64 {
        for symbol in graph.symbols(&[id]) {
            let random = &mut self.random;
            self.values.entry(symbol).or_insert_with(|| random.uniform(0.3, 1.4));
        }
        evaluate(graph, id, &|symbol| self.values[&symbol])
    }
}

#[test]
fn accelerations_solve_the_mass_matrix() {
    for source in SYSTEMS {
        derive(source, |_, graph, motion| {
            for seed in 0..20 {
                let mut point = Point { random: Random(seed), values: BTreeMap::new() };
                let solution: Vec<f64> =
                    motion.accelerations.iter().map(|&id| point.value(graph, id)).collect();
                for (row, &force) in motion.mass_matrix.iter().zip(&motion.forces) {
                    let (mut sum, mut scale) = (-point.value(graph, force), 1.0);
                    for (&entry, acceleration) in row.iter().zip(&solution) {
                        let part = point.value(graph, entry) * acceleration;
                        sum += part;
                        scale += part.abs();
                    }
                    assert!(sum.abs() < 1e-12 * scale, "{source}: residual {sum} of {scale}");
                }
            }
        });
    }
}

/// dE/dt along the motion, computed by the chain rule on the graph, equals the power.
#[test]
fn energy_changes_by_the_power() {
    for source in SYSTEMS {
        derive(source, |_, graph, motion| {
            let mut rates = Vec::new();
            for symbol in graph.symbols(&[motion.energy]) {
                let rate = match symbol {
                    Symbol::Time => Graph::ONE,
                    Symbol::Coordinate(index) => graph.symbol(Symbol::Velocity(index)),
                    Symbol::Velocity(index) => motion.accelerations[index],
                    Symbol::Input { input, component, order } => {
                        graph.symbol(Symbol::Input { input, component, order: order + 1 })
                    }
                    Symbol::Parameter(_)
                    | Symbol::Control { .. }
                    | Symbol::Acceleration(_)
                    | Symbol::Multiplier(_)
                    | Symbol::Contact(_)
                    | Symbol::Friction(_)
                    | Symbol::Target(_)
                    | Symbol::Momentum(_)
                    | Symbol::Auxiliary(_)
                    | Symbol::Position(_)
                    | Symbol::Entry(..)
                    | Symbol::Moment(..)
                    | Symbol::Point(..) => continue,
                };
                rates.push((derivative(graph, motion.energy, symbol), rate));
            }
            for seed in 0..20 {
                let mut point = Point { random: Random(seed), values: BTreeMap::new() };
                let power = point.value(graph, motion.power);
                let (mut sum, mut scale) = (-power, 1.0);
                for &(slope, rate) in &rates {
                    let part = point.value(graph, slope) * point.value(graph, rate);
                    sum += part;
                    scale += part.abs();
                }
                assert!(sum.abs() < 1e-11 * scale, "{source}: {sum} of {scale}, power {power}");
            }
        });
    }
}

#[test]
fn velocities_invert_the_momenta() {
    for source in SYSTEMS {
        derive(source, |_, graph, motion| {
            let Some(velocities) = &motion.velocities else { return };
            for seed in 0..20 {
                let mut point = Point { random: Random(seed), values: BTreeMap::new() };
                for (index, &momentum) in motion.momenta.iter().enumerate() {
                    let value = point.value(graph, momentum);
                    point.values.insert(Symbol::Momentum(index), value);
                }
                for (index, &velocity) in velocities.iter().enumerate() {
                    let symbol = graph.symbol(Symbol::Velocity(index));
                    let (found, expected) =
                        (point.value(graph, velocity), point.value(graph, symbol));
                    assert!((found - expected).abs() < 1e-11, "{source}: {found} and {expected}");
                }
            }
        });
    }
}

/// Adding the total derivative of any function of coordinates and time to L does not change the
/// accelerations.
#[test]
fn gauge_terms_vanish() {
    let plain = "struct S { m, k } coordinate x; coordinate y; kinetic = m/2*(ẋ^2 + ẏ^2); potential = k*(x^4 + x*y);";
    let gauged = "struct S { m, k } coordinate x; coordinate y; kinetic = m/2*(ẋ^2 + ẏ^2); potential = k*(x^4 + x*y) + dot(x^2*sin(y)*t + exp(x));";
    let accelerations = |source| {
        derive(source, |_, graph, motion| {
            let mut point = Point { random: Random(3), values: BTreeMap::new() };
            // The same point for both systems, with the symbols in the same order.
            let symbols = [
                Symbol::Parameter(0),
                Symbol::Parameter(1),
                Symbol::Time,
                Symbol::Coordinate(0),
                Symbol::Coordinate(1),
                Symbol::Velocity(0),
                Symbol::Velocity(1),
            ];
            for (index, symbol) in symbols.into_iter().enumerate() {
                point.values.insert(symbol, 0.3 + 0.17 * index as f64);
            }
            motion.accelerations.iter().map(|&id| point.value(graph, id)).collect::<Vec<f64>>()
        })
    };
    for (a, b) in accelerations(plain).into_iter().zip(accelerations(gauged)) {
        assert!((a - b).abs() < 1e-14 * a.abs(), "{a} and {b}");
    }
}

#[test]
fn polar_and_cartesian_kepler_agree() {
    let cartesian = "struct S { } coordinate x; coordinate y; kinetic = (ẋ^2 + ẏ^2)/2; potential = -1/|[x, y]|;";
    let polar = "struct S { } coordinate r; coordinate φ; let p = r*cis(φ); kinetic = |ṗ|^2/2; potential = -1/r;";
    let (r, phi, dr, dphi) = (1.3f64, 0.7f64, 0.2, -0.4);
    let at = |source, values: [f64; 4]| {
        derive(source, |_, graph, motion| {
            let value = |symbol| match symbol {
                Symbol::Coordinate(index) => values[index],
                Symbol::Velocity(index) => values[2 + index],
                other => panic!("{other:?}"),
            };
            [0, 1].map(|index| evaluate(graph, motion.accelerations[index], &value))
        })
    };
    let (s, c) = phi.sin_cos();
    let [ddr, ddphi] = at(polar, [r, phi, dr, dphi]);
    let [ddx, ddy] = at(cartesian, [r * c, r * s, dr * c - r * dphi * s, dr * s + r * dphi * c]);
    let radial = ddr - r * dphi * dphi;
    let across = r * ddphi + 2.0 * dr * dphi;
    assert!((ddx - (radial * c - across * s)).abs() < 1e-14);
    assert!((ddy - (radial * s + across * c)).abs() < 1e-14);
}

/// The point of an integral hides an index of the same name.
#[test]
fn the_inner_name_holds() {
    let energy = |potential: &str| {
        let source = format!(
            "struct S {{ B: body, g: m/s^2 }} coordinate θ: rad; kinetic = integral(p in B, |dot(cis(θ)*p)|^2/2); {potential}"
        );
        derive(&source, |_, graph, motion| {
            let mut point = Point { random: Random(3), values: BTreeMap::new() };
            point.value(graph, motion.energy)
        })
    };
    let hidden = energy(
        "potential = sum(p in 0..2, p*g*B.mass*height(B.center) + integral(p in B, g*height(cis(θ)*p)));",
    );
    assert_eq!(
        hidden,
        energy(
            "potential = sum(k in 0..2, k*g*B.mass*height(B.center) + integral(p in B, g*height(cis(θ)*p)));"
        )
    );
}
