//! States of first order: their rates, units, equations, refusals.

use super::{derive, refusals};
use crate::compile::compile;

/// Returns a block with a point in the plane, two joints, a driven and two control inputs, and two
/// states with their rates.
fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, k: N/m, T: s, g: m/s^2, e: 1 }}
         coordinate x: m; coordinate y: m; coordinate θ[2]: rad; state w: m; state f[2]: N;
         driven s: m; input u: N; input U: V; let r = [x, y];
         kinetic = m/2*|ṙ|^2 + sum(k in 0..2, m/2*L^2*θ̇[k]^2); potential = m*g*y;
         rate w = (x - w)/T; rate f[k in 0..2] = (u - f[k])/T; {statements}"
    )
}

#[test]
fn rates_contain_what_is_known() {
    for statements in [
        "state z: V; rate z = (U - z)/T;",
        "state z; rate z = ẋ/L + ẏ*θ[0]/L;",
        "state z: [m; 3]; rate z = [ẋ, ṡ, w/T];",
        "state z: [m; 2]; rate z = dot(r);",
        "state z[2]: [m; 2]; rate z[k in 0..2] = (r - z[k])/T;",
        "state z[2]: m; rate z[1] = z[0]/T; rate z[0] = t*L/T^2;",
        "state z: m; rate z = ẇ + w/T;",
        "state z: m; let follows = ż; rate z = ẇ; force x = k*follows*T;",
        "state z: m; rate z = sign(x)*L/T + abs(ẋ);",
        "state z: m^2; potential = k/2*z; kinetic = m*w^2/L^2*ẋ^2; rate z = x*L/T;",
        "kinetic = m/2*|dot(w*r/L)|^2;",
        "force x = f[0] + k*w + ẇ*k*T;",
        "force (x - w) = f[1];",
        "dissipation = k*T/2*(ẋ - ẇ)^2;",
        "constraint rod: |r - [w, 0]| = L;",
        "constraint skate: ẏ = ẋ*w/L;",
        "limit floor: y - w >= 0, restitution = e;",
        "friction belt: ẋ - ẇ, force = f[0];",
        "output rates: [N; 2] = [T*dot(f[0]), f[1]];",
        "output late: m/s^2 = dot(ẇ);",
        "let state = x; let rate = y; potential = k*state*rate;",
    ] {
        let found = refusals(&block(statements));
        assert!(found.is_empty(), "{statements}: {found:?}");
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("state z: m;",                              "the state `z` has no rate; write `rate z = …;`"),
    ("state z[2]: m;",                           "the state `z` has no rate; write `rate z[k in 0..2] = …;`"),
    ("state z[2]: m; rate z[0] = ẋ;",            "the state `z[1]` has no rate; write `rate z[1] = …;`"),
    ("rate w = x/T;",                            "the rate of `w` stands twice; write one"),
    ("rate f[1] = u/T;",                         "the rate of `f[1]` stands twice; write one"),
    ("rate x = ẏ;",                              "`x` is a coordinate, which forces move; declare it as `state x` to give its rate, or write a `constraint` of its velocity"),
    ("rate s = ẏ;",                              "`s` is no state; declare what has a rate as `state`"),
    ("rate v = ẏ;",                              "unknown state `v`; declare it, as in `state v: m;`"),
    ("rate ww = ẏ;",                             "unknown state `ww`; did you mean `w`?"),
    ("rate ẇ = ẏ;",                              "the rate of a state has its name without dots; write `w`"),
    ("rate x + y = ẏ;",                          "a rate is that of a state; write `rate z = …;` with its name"),
    ("rate = ẏ;",                                "the state is missing; write `rate z = …;` with the name of a state"),
    ("state z[2]: m; rate z = ẏ;",               "`z` is a family; write `rate z[k in 0..2] = …;` with `z[k]`"),
    ("state z: m; rate z[0] = ẏ;",               "`z` is no family; write `rate z = …;`"),
    ("state z[2]: m; rate z[k in 0..3] = ẏ;",    "index 2 is out of range; `z` has 2 members, `z[0]` to `z[1]`"),
    ("state z: m; rate z = x;",                  "`x` is m, but the rate of `z` is m/s"),
    ("state z: m; rate z = [ẋ, ẏ];",             "is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("state z: [m; 2]; rate z = ẋ;",             "`ẋ` is a scalar, but `z` is a plane vector; both have one shape"),
    ("state z: m; rate z = ẍ*T;",                "`ẍ` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("state z: m; rate z = dot(dot(s))*T;",      "the derivative of this rate contains the third one of `s`, and driven inputs have two; leave its second derivative out"),
    ("state z: m; rate z = u̇*T*L/k/T;",          "`u` has no derivative; declare it `driven`"),
    ("state z: m; rate z = ż/2;",                "the rate of `z` contains itself; break the circle"),
    ("state z: m; state o: m; rate z = ȯ; rate o = ż;", "the rate of `z` contains itself; break the circle"),
    ("force w = u;",                             "`w` is a state, which nothing pushes; write what changes it into its `rate`"),
    ("force (w*L) = u;",                         "no coordinate moves `w*L`, so a force does nothing there; write a coordinate or an expression of coordinates"),
    ("constraint rod: x = f[0]/k;",              "the state `f[0]` stands here and its rate contains the control input `u`, whose derivative would be needed; leave the state out, or declare the input `driven`"),
    ("constraint skate: ẏ = ẋ*f[0]/k/L;",        "the state `f[0]` stands here and its rate contains the control input `u`, whose derivative would be needed; leave the state out, or declare the input `driven`"),
    ("limit floor: y >= f[1]/k, restitution = e;", "the state `f[1]` stands here and its rate contains the control input `u`, whose derivative would be needed; leave the state out, or declare the input `driven`"),
    ("friction belt: ẋ - f[0]/k/T, force = f[0];", "the state `f[0]` stands here and its rate contains the control input `u`, whose derivative would be needed; leave the state out, or declare the input `driven`"),
    ("state z: m; rate z = ẋ; constraint rod: y = z;", "the state `z` stands here and its rate contains a velocity, so that the force that holds this would push the state; leave the state out"),
    ("state R: rotation; rate R = 1;",           "a state is a number or a vector; write `coordinate` for a rotation that turns with a body"),
    ("state z: [m; 5]; rate z = 1;",             "a state is a number or a vector of two or three components; write `state z[5]: m;` for several"),
    ("state w: m;",                              "`w` is declared twice; rename one of the two"),
    ("output w: m = x;",                         "`w` is declared already; choose another name for the output"),
];

#[test]
fn each_mistake_has_its_message() {
    for (statements, expected) in REFUSED {
        let found = refusals(&block(statements));
        assert!(found.iter().any(|message| message.contains(expected)), "{statements}: {found:?}");
    }
}

#[test]
fn states_alone_move_nothing() {
    let found = refusals("struct S { T: s } state z: m; kinetic = 0; rate z = -z/T;");
    assert!(found[0].starts_with("no coordinate;"), "{found:?}");
}

#[test]
fn equations_are_those_of_rates() {
    let compiled = compile(&block("force x = f[0] + k*ẇ*T;")).unwrap();
    assert_eq!(
        compiled.equations[4..],
        ["ẇ = (x − w)/T", "ḟ[0] = (u − f[0])/T", "ḟ[1] = (u − f[1])/T"]
    );
    assert!(!compiled.equations[0].contains('ẇ'), "{:?}", compiled.equations);
    assert_eq!(compiled.momenta.len(), 4);
    assert!(compiled.latex[4].starts_with("\\dot"), "{}", compiled.latex[4]);
    let names: Vec<_> = compiled.coordinates.iter().map(|own| own.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "θ", "w", "f"]);
}

#[test]
fn power_contains_the_rates_of_states_in_energies() {
    let source = "struct S { m: kg, k: N/m, T: s } coordinate x: m; state z;
                  kinetic = m/2*ẋ^2; potential = k*z/2*x^2; rate z = -z/T;";
    let compiled = compile(source).unwrap();
    assert_eq!(compiled.equations, ["ẍ = −k·x·z/m", "ż = −z/T"]);
    assert_eq!(compiled.power, "−k·x²·z/(2·T)");
    assert!(compiled.conserved.is_empty());
}

#[test]
fn states_have_no_symmetries() {
    // Nothing depends on z, which is not conserved for that.
    let source = "struct S { m: kg } coordinate x: m; state z: m; kinetic = m/2*ẋ^2; rate z = ẋ;";
    assert_eq!(compile(source).unwrap().conserved, ["p_x"]);
    derive(source, |_, _, motion| {
        assert_eq!((motion.cyclic.as_slice(), motion.accelerations.len()), (&[0][..], 2));
        assert!(!motion.velocity_free && !motion.separable);
    });
}

#[test]
fn forces_do_not_act_through_rates() {
    let source = "struct S { m: kg, J: kg*m^2, F: N } coordinate y: m; coordinate R: rotation; state z: m;
                  kinetic = m/2*ẏ^2 + J/2*|angular_velocity(R)|^2; rate z = ẏ; force R*[z, 0, 0] = [0, 0, F];";
    assert_eq!(compile(source).unwrap().equations[0], "ÿ = 0");
}
