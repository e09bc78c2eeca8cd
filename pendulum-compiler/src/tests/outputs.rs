//! Outputs: their shapes, their units, and accelerations in them.

use super::refusals;

fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, g: m/s^2, f: [m; 5] }} coordinate θ: rad; coordinate φ[3]: rad; driven x: [m; 2];
         let y = x + L*[sin(θ), -cos(θ)]; let z[k in 0..3] = y + L*[sin(φ[k]), -cos(φ[k])];
         kinetic = m/2*|ẏ|^2 + sum(k in 0..3, m/2*|ż[k]|^2); potential = m*g*height(y); {statements}"
    )
}

#[test]
fn all_shapes_are_taken() {
    for statements in [
        "output tip: [m; 2] = y;",
        "output y: [m; 2] = y;",
        "output tips[k in 0..3]: [m; 2] = z[k];",
        "output heights[k in 0..3]: m = height(z[k]);",
        "output turn: [1; 2] = cis(θ);",
        "output all: [m; 5] = f;",
        "output place: [m; 3] = [L, L, t*L*θ̇];",
        "output open = y;",
        "output load: N = m*(g + height(dot(dot(y))));",
        "let a = dot(ẏ); output pull: N = m*|a|;",
        "output direct: 1/s^2 = θ̈; output member: 1/s^2 = φ̈[1];",
        "output mixed: m/s^2 = height(ẍ);",
    ] {
        assert!(refusals(&block(statements)).is_empty(), "{:?}", refusals(&block(statements)));
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("output tip: m = y;",                       "`y` is a plane vector, but `tip` is declared as a scalar; write `[m; 2]`"),
    ("output tip: [m; 3] = y;",                  "`y` is a plane vector, but `tip` is declared with 3 components; write `[m; 2]`"),
    ("output tip: [m; 2] = height(y);",          "`height(y)` is a scalar, but `tip` is declared with 2 components; write `m`"),
    ("output tip = z;",                          "`z` is a family of vectors; write `output tip[k in 0..3]: [_; 2] = z[k];`"),
    ("output tip: [m; 2] = ẏ;",                  "`ẏ` is m/s, but `tip` is declared in m"),
    ("output tip: N = m*g*L;",                   "`m*g*L` is kg·m²/s², but `tip` is declared in N"),
    ("output tip: body = y;",                    "an output has a unit; write `m` or `[m; 2]`"),
    ("output tip: m = w;",                       "unknown name `w`; declare it as a parameter, a coordinate, an input or with `let`"),
    ("output θ: rad = θ;",                       "`θ` is declared already; choose another name for the output"),
    ("output tip: m = L; output tip: m = L;",    "two outputs are called `tip`; rename one of the two"),
    ("output energy: J = m*g*L;",                "`energy` is a method of every system; choose another name"),
    ("output controls: J = m*g*L;",              "`controls` is a method of every system; choose another name"),
    ("output FACTS: J = m*g*L;",                 "`FACTS` is a constant of every system; choose another name"),
    ("output ẏ: [m/s; 2] = ẏ;",                  "`ẏ` is a time derivative; give the output a name without dots, as `rate`"),
    ("output tip: m/s^3 = dot(dot(dot(height(y))));", "the derivative of an acceleration in `dot(dot(height(y)))` is a third derivative; coordinates have two, in outputs"),
    ("output tip: m/s^3 = height(dot(ẍ));",      "`ẍ` contains a third derivative of a driven input; they have two"),
    ("let a = dot(ẏ); potential = m*L*height(a);", "the derivative of a velocity in `ẏ` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("let a = dot(ẏ); potential = m*L*height(a); output tip = a;", "the derivative of a velocity in `ẏ` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("output tips[k in 1..3]: m = height(z[k]);", "the members of `tips` are counted from 0; begin the range there"),
    ("output tips[k in 0..0]: m = height(z[k]);", "`tips` has no members; write a range such as `0..5`"),
    ("output tips[k in 0..4]: m = height(z[k]);", "`z[3]` does not exist; `z` is defined for 0 to 2"),
];

#[test]
fn mistakes_are_told_at_the_output() {
    for (statements, expected) in REFUSED {
        assert_eq!(refusals(&block(statements)), [*expected], "{statements}");
    }
}

/// Outputs change neither the equations nor their cost.
#[test]
fn equations_stay_as_they_are() {
    let plain = crate::compile(&block("")).unwrap();
    let outputs = "output tip: [m; 2] = y; output load: N = m*(g + height(dot(dot(z[2])))); let w = L*sin(θ)*cos(φ[1]); output o: m = w;";
    let mut with = crate::compile(&block(outputs)).unwrap();
    assert_eq!(with.outputs.len(), 3);
    assert_eq!(with.outputs[0].expressions, ["x.x + L·sin θ", "x.y − L·cos θ"]);
    with.outputs.clear();
    assert_eq!(plain, with);
}

/// Refused outputs have no method, because rustc would report two methods of the same name as well.
#[test]
fn what_is_refused_is_no_method() {
    let count = |statements: &str, method: &str| {
        // The macro of the runtime inserts its path before a block.
        let source = format!("::pendulum_runtime; {}", block(statements));
        let text = crate::expand(source.parse().unwrap()).to_string();
        text.matches(&format!("fn {method} ")).count()
    };
    let once = count("output tip: m = L;", "tip");
    assert!(0 < once);
    assert_eq!(count("output tip: m = L; output tip: m = L;", "tip"), once);
    for method in ["new", "driven_by", "controls"] {
        let refused = format!("output {method}: m = L;");
        assert_eq!(count(&refused, method), count("", method), "{method}");
    }
}
