//! Control inputs: expressions that may contain them, and derivatives that are refused.

use super::{derive, refusals};
use crate::algebra::expr::{Dependencies, Graph};

fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, g: m/s^2, k: N*m }} coordinate θ: rad; driven x: [m; 2]; input u: N*m; input f: [N; 2];
         let y = x + L*[sin(θ), -cos(θ)]; kinetic = m/2*|ẏ|^2; {statements}"
    )
}

#[test]
fn they_act_as_forces() {
    for statements in [
        "potential = m*g*height(y); force θ = u;",
        "potential = m*g*height(y) - u*θ;",
        "potential = m*g*height(y) - inner(f, y);",
        "potential = m*g*height(y); dissipation = u^2/k*θ̇^2*t;",
    ] {
        assert!(refusals(&block(statements)).is_empty(), "{:?}", refusals(&block(statements)));
        derive(&block(statements), |_, graph, motion| {
            let all = |ids: &[_]| {
                ids.iter().fold(Dependencies::default(), |all, &id| all.or(graph.dependencies(id)))
            };
            assert!(all(&motion.accelerations).any(Dependencies::CONTROL), "{statements}");
            assert!(!all(&motion.momenta).any(Dependencies::CONTROL), "{statements}");
            assert!(!all(&[motion.energy]).any(Dependencies::CONTROL), "{statements}");
            assert!(all(&[motion.power]).any(Dependencies::CONTROL), "{statements}");
            assert!(motion.nonconservative && !motion.velocity_free && !motion.autonomous);
        });
    }
}

#[test]
fn a_force_and_a_potential_are_one() {
    let equations = |statements: &str| {
        crate::compile(&block(statements)).unwrap_or_else(|messages| panic!("{messages:?}"))
    };
    let force = equations("potential = m*g*height(y); force θ = u;");
    let potential = equations("potential = m*g*height(y) - u*θ;");
    assert_eq!(force.equations, potential.equations);
    assert_eq!(force.energy, potential.energy);
    assert_eq!(force.power, potential.power);
    assert_eq!(force.inputs.len(), 1);
    let names: Vec<_> = force.controls.iter().map(|control| control.name.as_str()).collect();
    assert_eq!(names, ["u", "f"]);
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("potential = m*g*height(y); force θ = u̇;",           "`u` has no derivative; declare it `driven`"),
    ("potential = m*g*height(y); force θ = dot(u*θ);",    "`u` has no derivative; declare it `driven`"),
    ("let z = u*θ; potential = m*g*height(y); force θ = ż;", "`u` has no derivative; declare it `driven`"),
    ("potential = m*g*height(y) + u*θ̇*t;",                "the momenta contain the control input `u`, so the equations would contain its derivative; declare it `driven`, or write what it does as a `force`"),
    ("potential = m*g*height(y) + k^2/u*cos(θ);",         "the control input `u` stands in a divisor, a power or a function of an energy, which may be no number where the input is zero; write what it does as a `force`"),
    ("potential = m*g*height(y) + sqrt(u*k)*θ;",          "the control input `u` stands in a divisor, a power or a function of an energy, which may be no number where the input is zero; write what it does as a `force`"),
    ("potential = m*g*height(y) + k*ln(u/k)*θ;",          "the control input `u` stands in a divisor, a power or a function of an energy, which may be no number where the input is zero; write what it does as a `force`"),
    ("potential = m*g*height(y); force θ = f;",           "`f` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("potential = m*g*height(y); force θ = u/L;",         "`u/L` is kg·m/s², but a force on `θ` is kg·m²/s², an energy per unit of `θ`"),
    ("potential = m*g*height(y); driven v: [m; 4];",      "a driven input is a scalar or a vector; write `[m; 2]` or `[m; 3]`"),
    ("potential = m*g*height(y); input B: body;",         "a control input has a unit; write `N` or `[N; 2]`"),
    ("potential = m*g*height(y); input a: m, b: m;",      "a statement declares one name; write `input b: m;` as a statement of its own"),
    ("potential = m*g*height(y); input u: N;",            "`u` is declared twice; rename one of the two"),
    ("potential = m*g*height(y); let h(u) = L*u; force θ = k*h(1)/L;", "`u` is a control input, and an argument of this name would hide it; choose another name"),
];

#[test]
fn derivatives_of_controls_are_refused() {
    for (statements, expected) in REFUSED {
        assert_eq!(
            refusals(&block(statements)).first().map(String::as_str),
            Some(*expected),
            "{statements}"
        );
    }
}

#[test]
fn without_controls_nothing_changes() {
    let plain = "struct P { m: kg, L: m, g: m/s^2 } coordinate θ: rad; kinetic = m/2*L^2*θ̇^2; potential = m*g*L*cos(θ);";
    derive(plain, |_, graph, motion| {
        assert!(!graph.dependencies(motion.power).any(Dependencies::STATE));
        assert_eq!(motion.power, Graph::ZERO);
        assert!(motion.velocity_free && motion.autonomous);
    });
}
