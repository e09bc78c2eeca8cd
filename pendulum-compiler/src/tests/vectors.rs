//! Vector coordinates, and families of them.

use super::refusals;
use super::{derive, evaluate};
use crate::algebra::expr::Symbol;
use crate::compile::compile;

/// Returns the accelerations and the energy of a block at fixed values of all symbols.
pub(super) fn values(source: &str) -> Vec<f64> {
    derive(source, |_, graph, motion| {
        let value = |symbol: Symbol| match symbol {
            Symbol::Parameter(index) => 1.25 + index as f64 / 3.0,
            Symbol::Coordinate(index) => 0.4 + index as f64 / 7.0,
            Symbol::Velocity(index) => 0.3 - index as f64 / 5.0,
            Symbol::Time => 0.75,
            Symbol::Input { input, component, order } => {
                0.2 + (input + 2 * component) as f64 / 9.0 - f64::from(order) / 5.0
            }
            Symbol::Control { input, component } => 0.6 + (input + 2 * component) as f64 / 9.0,
            other => panic!("{other:?}"),
        };
        let roots = motion.accelerations.iter().chain([&motion.energy, &motion.power]);
        roots.map(|&root| evaluate(graph, root, &value)).collect()
    })
}

/// Returns the largest difference of two lists.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_vector_coordinate_moves_as_its_components() {
    let rest = "potential = k/2*|p|^2 + m*g*height(p); dissipation = k*inner(ṗ, [ṗ.y, 0, ṗ.z]);
                force p.x = k*cross(p, dot(p)).y; force p = [0, 2*k, 0];";
    let scalars = "let p = [a, b, c]; potential = k/2*|p|^2 + m*g*height(p);
                   dissipation = k*inner(ṗ, [ṗ.y, 0, ṗ.z]);
                   force a = k*cross(p, dot(p)).y; force b = 2*k;";
    let kinetic = "kinetic = m/2*|ṗ|^2;";
    let vector = values(&format!("struct P {{ m, k, g }} coordinate p: [_; 3]; {kinetic} {rest}"));
    let scalar = values(&format!(
        "struct P {{ m, k, g }} coordinate a; coordinate b; coordinate c; {kinetic} {scalars}"
    ));
    assert!(distance(&vector, &scalar) < 1e-14, "{vector:?} {scalar:?}");
}

#[test]
fn a_family_of_vectors_moves_as_its_components() {
    let vectors = values(
        "struct P { m, k, g } coordinate x[3]: [_; 2];
         kinetic = sum(k in 0..3, m/2*|ẋ[k]|^2);
         potential = sum(j in 1..3, k/2*(|x[j] - x[j - 1]| - 1/2)^2) + m*g*x[2].y;",
    );
    let scalars = values(
        "struct P { m, k, g } coordinate q[6];
         let x[j in 0..3] = [q[2*j], q[2*j + 1]];
         kinetic = sum(k in 0..3, m/2*|ẋ[k]|^2);
         potential = sum(j in 1..3, k/2*(|x[j] - x[j - 1]| - 1/2)^2) + m*g*q[5];",
    );
    assert!(distance(&vectors, &scalars) < 1e-14, "{vectors:?} {scalars:?}");
}

#[test]
fn every_component_has_a_name() {
    let compiled = compile(
        "struct P { m, k } coordinate θ; coordinate p: [_; 3]; coordinate tip[2]: [_; 2];
         kinetic = m/2*(θ̇^2 + |ṗ|^2 + sum(k in 0..2, |dot(tip)[k]|^2));
         potential = k*(p.z + θ + inner(tip[0], tip[1]));",
    );
    let compiled = compiled.unwrap_or_else(|messages| panic!("{messages:?}"));
    let left: Vec<&str> =
        compiled.equations.iter().filter_map(|own| own.split(' ').next()).collect();
    assert_eq!(
        left,
        [
            "θ\u{308}",
            "p\u{308}.x",
            "p\u{308}.y",
            "p\u{308}.z",
            "tip_ddot[0].x",
            "tip_ddot[0].y",
            "tip_ddot[1].x",
            "tip_ddot[1].y"
        ]
    );
    assert_eq!(compiled.momenta[1..3], ["m·ṗ.x", "m·ṗ.y"]);
    let declared = |index: usize| {
        let declared = &compiled.coordinates[index];
        (declared.length, declared.components)
    };
    assert_eq!([0, 1, 2].map(declared), [(None, None), (Some(3), None), (Some(2), Some(2))]);
}

#[test]
fn four_inputs_are_a_family() {
    let family = values(
        "struct P { m } coordinate x; input f: [_; 4]; kinetic = m/2*ẋ^2;
         force x = f[0] - 2*f[3] + sum(k in 1..3, f[k]);",
    );
    // f[k] is 0.6 + 2k/9, so that the force is −0.
    assert!((family[0] - (0.6 + 2.0 / 3.0 - 2.0 * (2.0 / 3.0)) / 1.25).abs() < 1e-14, "{family:?}");
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("potential = k*p;",                 "`k*p` is a space vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("potential = k*r[0].z;",            "`r[0]` is a plane vector, it has no `.z`; write a vector"),
    ("potential = k*r[2].x;",            "index 2 is out of range; `r` has 2 members, `r[0]` to `r[1]`"),
    ("potential = k*r.x;",               "`r` is a family, it has no `.x`; write a vector"),
    ("potential = k*|p + r[0]|;",        "`r[0]` is a plane vector, but the terms before it are space vectors; a sum needs terms of one kind"),
    ("coordinate s: [m; 7];",            "a coordinate is a number or a vector of two or three components; write `coordinate s[7]: m;` for several"),
    ("coordinate s: [m; 2]; kinetic = m/2*ṡ.x^2;", "`s.y` has no kinetic energy, so its acceleration is undetermined; add the square of its velocity to `kinetic`"),
];

#[test]
fn vectors_are_not_numbers() {
    for (statements, expected) in REFUSED {
        let source = format!(
            "struct P {{ m: kg, k: N }} coordinate p: [m; 3]; coordinate r[2]: [m; 2];
             kinetic = m/2*(|ṗ|^2 + |ṙ[0]|^2 + |ṙ[1]|^2); {statements}"
        );
        assert_eq!(refusals(&source), [*expected], "{statements}");
    }
}

#[test]
fn the_unit_of_a_vector_is_that_of_each_component() {
    let source = |unit: &str| {
        format!(
            "struct P {{ m: kg, k: {unit} }} coordinate p: [m; 3];
             kinetic = m/2*|ṗ|^2; potential = k/2*|p|^2;"
        )
    };
    assert!(refusals(&source("N/m")).is_empty());
    let expected = "`k/2*|p|^2` is kg·m³/s², but `m/2*|ṗ|^2` is kg·m²/s²; all energies of a block have one unit";
    assert_eq!(refusals(&source("N")), [expected]);
}
