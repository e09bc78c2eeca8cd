//! Each mistake results in one message, which states the correction.

use super::refusals;
use crate::algebra::expr::Graph;

/// Returns a block with the given statements.
pub(super) fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, c: [m; 2], f: [kg; 5], g }} coordinate θ: rad; driven x: [m; 2]; {statements}"
    )
}

const ENERGY: &str = "kinetic = m/2*L^2*θ̇^2; potential = -m*g*L*cos(θ);";

#[rustfmt::skip]
const CASES: &[(&str, &str)] = &[
    ("kinetic = m*L^2*θ̇^2; potential = M*g;",                  "unknown name `M`; did you mean `m`?"),
    ("kinetic = m*L^2*θ̇^2; potential = velocity;",             "unknown name `velocity`; declare it as a parameter, a coordinate, an input or with `let`"),
    ("kinetic = m*L^2*θ̇^2; potential = sinn(θ);",              "unknown function `sinn`; did you mean `sin`?"),
    ("kinetic = m*L^2*θ̇^2; potential = θ̈;",                    "`θ̈` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("kinetic = m*L^2*θ̇^2; potential = dot(θ̇);",               "the derivative of a velocity in `θ̇` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("kinetic = m*L^2*θ̇^2; potential = dot(m*L);",             "nothing in `m*L` moves, so its time derivative is zero; leave it out"),
    ("kinetic = m*L^2*θ̇^2; potential = m_dot;",                "`m` is a parameter, so nothing in `m_dot` moves; declare it `driven` or as a coordinate"),
    ("kinetic = m*L^2*θ̇^2; potential = g*sum(k in 0..2, f[k]*k_dot*θ);", "nothing in `k_dot` moves, so its time derivative is zero; leave it out"),
    ("kinetic = m*L^2*θ̇^2; potential = 2g;",                   "there is no implicit multiplication; write `2*g`"),
    ("kinetic = m*L^2*θ̇^2; potential = m g;",                  "there is no implicit multiplication; write `*` before `g`"),
    ("kinetic = m*L^2*θ̇^2; potential = m(g);",                 "`m` is no function, and there is no implicit multiplication; write `m*(…)`"),
    ("kinetic = m*L^2*θ̇^2; potential = m*t(g);",               "`t` is no function, and there is no implicit multiplication; write `t*(…)`"),
    ("kinetic = m*L^2*θ̇^2; potential = m*π(2);",               "`π` is no function, and there is no implicit multiplication; write `π*(…)`"),
    ("kinetic = m*L^2*θ̇^2; potential = |m*i(2)|;",             "`i` is no function, and there is no implicit multiplication; write `i*(…)`"),
    ("kinetic = m*L^2*θ̇^2; potential = 1.5f64*g;",             "numbers here are exact and have no suffix; write `1.5`"),
    ("kinetic = m*L^2*θ̇^2; potential = m·g;",                  "`·` is part of a name in Rust; write `*`, as in `m*g`, or `inner(m, g)` for vectors"),
    ("kinetic = m*L^2*θ̇^2; potential = __m;",                  "names that begin with `__` are reserved; choose another name"),
    ("kinetic = m*L^2*θ̇^2; potential = m**2;",                 "`**` is not an operator; write `^`"),
    ("kinetic = m*L^2*θ̇^2; potential = |θ;",                   "this `|` is not closed; write `|u|`"),
    ("kinetic = m*L^2*θ̇^2; potential = m*g",                   "`;` is missing after this; end the last statement with `;`"),
    ("kinetic = m*L^2*θ̇^2 potential = m*g;",                   "`;` is missing before `potential`; end the statement above with `;`"),
    ("kinetic = m*L^2*θ̇^2; potental = m*g;",                   "unknown statement `potental`; did you mean `potential`?"),
    ("kinetic = m*L^2*θ̇^2; lagrangian = m*g;",                 "`lagrangian` is kinetic minus potential energy already; write either one or the other"),
    ("kinetic = m*L^2*θ̇^2; let a = b; let b = a;",             "`a` is defined by itself; break the circle"),
    ("kinetic = m*L^2*θ̇^2; let r(p) = r(p); potential = r(θ);", "`r` is defined by itself; break the circle"),
    ("kinetic = m*L^2*θ̇^2; let r(p) = p; potential = r(θ, θ);", "`r` takes one argument; 2 stand here"),
    ("kinetic = m*L^2*θ̇^2; potential = sin(θ, θ);",            "`sin` takes one argument; 2 stand here"),
    ("kinetic = m*L^2*θ̇^2; potential = sin;",                  "`sin` is a function; write `sin(…)`"),
    ("kinetic = m*L^2*θ̇^2; potential = m/0;",                  "division by zero; write another divisor"),
    ("kinetic = m*L^2*θ̇^2; potential = θ^10000000000000000000000;", "this exponent is too long for exact arithmetic; write one of at most eighteen digits"),
    ("kinetic = m*L^2*θ̇^2; force m = 1;",                      "`m` is no coordinate; a force acts on a coordinate, as in `force θ = …;`"),
    ("kinetic = m*L^2*θ̇^2; potential = sum(k in 0..θ, k);",    "the end of a range is a whole number known while compiling; write numbers and indices only"),
    ("kinetic = m*L^2*θ̇^2; potential = dot(dot(dot(x))).x;",   "`dot(dot(x))` contains a third derivative of a driven input; they have two"),
    ("kinetic = m*L^2*θ̇^2 + m*L*t*θ̇*ẍ.x;",                 "the momenta contain the acceleration of `x`, so the equations would contain its third derivative; leave its second derivative out of the kinetic energy"),
    ("kinetic = m*L^2*θ̇^2; potential = m*L*θ*ẍ.x;",           "the energy contains the acceleration of `x`, so its power would contain a third derivative; write what it does to a coordinate as a `force`"),
    ("kinetic = m*L^2*θ̇^2; coordinate φ; potential = m*φ^2;",   "`φ` has no kinetic energy, so its acceleration is undetermined; add the square of its velocity to `kinetic`"),
    ("coordinate φ; kinetic = m*L^2*(θ̇ + φ̇)^2;",               "the mass matrix is singular in the direction of `θ`: its kinetic energy is that of other coordinates; leave the redundant coordinate out"),
    ("coordinate φ[3]; kinetic = m*L^2*(θ̇^2 + (φ̇[0] + φ̇[2])^2 + (φ̇[1] - 2*φ̇[2])^2);", "the mass matrix is singular in the direction of `φ[0]`: its kinetic energy is that of other coordinates; leave the redundant coordinate out"),
    ("coordinate φ; kinetic = m*L^2*|dot([cos(θ + φ), sin(θ + φ)])|^2;", "the mass matrix is singular in the direction of `θ`: its kinetic energy is that of other coordinates; leave the redundant coordinate out"),
    ("coordinate φ; kinetic = m*L^2*θ̇*φ̇;", "the kinetic energy is not positive: in the direction of `φ` it is zero at every state; take coordinates whose squared velocities stand in it"),
    // More roots than can exist at a common point of the field.
    ("let z = sum(k in 1..20, sqrt(k + θ^2)*sin(k*θ)); coordinate φ; kinetic = m*L^2*(z*θ̇ + z^2*φ̇)^2;", "the mass matrix is singular in the direction of `θ`: its kinetic energy is that of other coordinates; leave the redundant coordinate out"),
    ("potential = m*g*θ;",                                     "`θ` has no kinetic energy, so its acceleration is undetermined; add the square of its velocity to `kinetic`"),
    ("",                                                       "no energy; write `kinetic = …;` and `potential = …;` below the struct"),
    ("kinetic = m*L^2*θ̇^2; coordinate φ: furlong;",            "unknown unit `furlong`; a unit is a product, quotient or power of `kg`, `m`, `s`, `rad`, `N`, `J`, `W`, `Hz`, `A`, `V`, `C`, `F`, `H`, `ohm`, `T`, `K` and `1`"),
    ("kinetic = m*L^2*θ̇^2; coordinate t;",                     "`t` is the time; choose another name"),
    ("kinetic = m*L^2*θ̇^2; driven ẏ: [m; 2];",                 "`ẏ` is a time derivative; declare the name without dots, `y`"),
    ("kinetic = m*L^2*θ̇^2; driven r: [m; 5];",                 "a driven input is a scalar or a vector; write `[m; 2]` or `[m; 3]`"),
    ("kinetic = m*L^2*θ̇^2; let loop = 2;",                     "`loop` is a word of the Rust language; choose another name"),
    ("kinetic = m*L^2*θ̇^2; let gen = 2;",                      "`gen` is a word of the Rust language; choose another name"),
    ("kinetic = m*L^2*θ̇^2; let i = 3; potential = i*L;",       "`i` is the imaginary unit; choose another name"),
    ("kinetic = m*L^2*θ̇^2; driven ẏ; potential = y*ẏ;",        "`ẏ` is a time derivative; declare the name without dots, `y`"),
    ("kinetic = m*L^2*θ̇^2; let y(p, p) = p; potential = y(θ, θ);", "the argument `p` stands twice; rename one of the two"),
    ("kinetic = m*L^2*θ̇^2; let y(α, alpha) = α; potential = y(θ, θ);", "the argument `alpha` stands twice; rename one of the two"),
    ("kinetic = m*L^2*θ̇^2; potential = sum(θ in 0..2, g*θ);",  "`θ` is a coordinate, and an index of this name would hide it; choose another name"),
    ("kinetic = m*L^2*θ̇^2; let y(θ) = θ^2; potential = y(L);", "`θ` is a coordinate, and an argument of this name would hide it; choose another name"),
    ("kinetic = m*L^2*θ̇^2; let y(t) = t^2; potential = y(L);", "`t` is the time, and an argument of this name would hide it; choose another name"),
    ("kinetic = m*L^2*θ̇^2; potential = g |x|;",                "there is no implicit multiplication; write `*` before `|`"),
    ("kinetic = m*L^2*θ̇^2; potential = |x||x|;",               "there is no implicit multiplication; write `*` before `|`"),
    ("kinetic = m*L^2*θ̇^2; potential = |(g |x|)|;",            "there is no implicit multiplication; write `*` before `|`"),
    ("kinetic = m*L^2*θ̇^2; potential = θ.powi(2);",            "`.powi()` is Rust, which has no place in a formula; write `θ^2`"),
    ("kinetic = m*L^2*θ̇^2; potential = (m*θ).sin();",          "`.sin()` is Rust, which has no place in a formula; write `sin(m*θ)`"),
    ("kinetic = m*L^2*θ̇^2; potential = m*clamp(θ, 0, 1);",     "unknown function `clamp`; write `min(max(θ, 0), 1)`"),
    ("kinetic = m*L^2*θ̇^2; potential = θ.clamp(0, 1);",        "`.clamp()` is Rust, which has no place in a formula; write `min(max(θ, 0), 1)`"),
    ("kinetic = m*L^2*θ̇^2; potential = θ as f64;",             "`as` is Rust, which has no place in a formula; leave the type out"),
    ("kinetic = m*L^2*θ̇^2; potential = if θ { 1 };",           "`if` is Rust, which has no place in a formula; write `max`, `min`, `abs` or `sign` to tell cases apart"),
    ("kinetic = m*L^2*θ̇^2; potential = m*sqrt(-1);",           "`sqrt(-1)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*ln(-2);",             "`ln(-2)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*asin(2);",            "`asin(2)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*acos(1 + 1);",        "`acos(1 + 1)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*(-8)^(1/3);",         "`(-8)^(1/3)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*ln(0);",              "`ln(0)` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*3^999999999999999999;", "`3^999999999999999999` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*3^12345678901234567;", "`3^12345678901234567` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*tan(π/2);",           "`tan(π/2)` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m/tan(-7*π/2);",        "`tan(-7*π/2)` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*tan(π/2 + 10^-30);",  "`tan(π/2 + 10^(-30))` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*tan(1.5707963267948966);", "`tan(1.5707963267948966)` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m/cos(1.5707963267948966);", "division by zero; write another divisor"),
    ("let h(a) = tan(a); kinetic = m*L^2*θ̇^2; potential = m*h(3*π/2);", "`tan(a)` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*1e-999999999;",       "this number is below the range of `f64`; write zero, or a larger one"),
    ("kinetic = m*L^2*θ̇^2; potential = 1 + 0.00012e-330*m;",   "this number is below the range of `f64`; write zero, or a larger one"),
    ("kinetic = m*L^2*θ̇^2; potential = m*(1e-200*1e-200);",    "`1e-200*1e-200` is below the range of `f64`; write zero, or another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*3^-99999;",           "`3^(-99999)` is below the range of `f64`; write zero, or another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*exp(-10000);",        "`exp(-10000)` is below the range of `f64`; write zero, or another operand"),
    ("let h(a) = exp(-a); kinetic = m*L^2*θ̇^2; potential = m/(1 + h(π*500));", "`exp(-a)` is below the range of `f64`; write zero, or another operand"),
    ("coordinate z; kinetic = m*L^2*θ̇^2; force z = -m*L^2*ż;",
        "`z` has no kinetic energy, so its acceleration is undetermined; add the square of its velocity to `kinetic`, or, if its rate is given, as that of a filter, declare it with `state` in place of `coordinate` and write `rate z = …;`"),
    ("coordinate z[2]; kinetic = m*L^2*(θ̇^2 + ż[0]^2); dissipation = g*ż[1]^2;",
        "`z[1]` has no kinetic energy, so its acceleration is undetermined; add the square of its velocity to `kinetic`, or, if its rate is given, as that of a filter, declare it with `state` in place of `coordinate` and write `rate z[1] = …;`"),
    ("coordinate a; coordinate b; kinetic = m*L^2*(θ̇^2 + (a*ḃ - b*ȧ)^2); constraint unit: a^2 + b^2 = 1;",
        "the mass matrix is singular in the direction of `a`: its kinetic energy is that of other coordinates; leave the redundant coordinate out, or, if `unit` holds this direction, as it holds the length of a quaternion, give it an inertia, which nothing then moves: add the square of the rate of `unit` to `kinetic`"),
    ("kinetic = m*L^2*θ̇^2; potential = m*sech(1000);",         "`sech(1000)` is below the range of `f64`; write zero, or another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*atan2(0, 0);",        "`atan2(0, 0)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*atan2(sin(π), cos(π/2));", "`atan2(sin(π), cos(π/2))` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = m*0^-1;",               "zero has no negative power; write another base"),
    ("kinetic = m*L^2*θ̇^2; potential = m*0^θ;",                "`0` has powers with fixed exponents only, and `θ` changes; write a positive base"),
    ("kinetic = m*L^2*θ̇^2; potential = m*(1 - π)^(θ/2);",      "`1 - π` has powers with fixed exponents only, and `θ/2` changes; write a positive base"),
    ("let h(a) = (-1)^a; kinetic = m*L^2*θ̇^2; potential = m*h(θ);", "`-1` has powers with fixed exponents only, and `a` changes; write a positive base"),
    ("kinetic = m*L^2*θ̇^2; potential = m*10^10^10;",           "`10^10^10` is infinite or beyond the range of `f64`; write another operand"),
    ("kinetic = m*L^2*θ̇^2; potential = m*sqrt(1 - π);",        "`sqrt(1 - π)` is no real number; write an operand for which it is"),
    ("kinetic = m*L^2*θ̇^2; potential = integral(p in c, 1);",  "`c` is no body; declare it as `c: body` in the struct"),
];

#[test]
fn one_mistake_gives_one_message() {
    for (statements, expected) in CASES {
        assert_eq!(refusals(&block(statements)), [*expected], "{statements}");
    }
}

/// A power series has a constant term where its variable is zero.
#[test]
fn zero_to_the_power_zero_is_one() {
    let mut graph = Graph::new();
    assert_eq!(super::lowered(&mut graph, "0^0"), Graph::ONE);
}

/// Kinetic energies that are negative at every state.
#[rustfmt::skip]
const NEGATIVE: &[(&str, &str)] = &[
    ("kinetic = -m/2*L^2*θ̇^2;",                          "the kinetic energy of `θ` is negative in `-m/2*L^2*θ̇^2`"),
    ("kinetic = -(m/2*L^2*θ̇^2);",                        "the kinetic energy of `θ` is negative in `-(m/2*L^2*θ̇^2)`"),
    ("kinetic = m*-sum(k in 0..2, (L*θ̇)^2);",            "the kinetic energy of `θ` is negative in `m*(-sum(k in …, (L*θ̇)^2))`"),
    ("coordinate z: m; kinetic = m*ż^2 - m/2*(L*θ̇)^2;",  "the kinetic energy of `θ` is negative in `-m/2*(L*θ̇)^2`"),
    ("coordinate z: m; kinetic = m*ż^2; kinetic = m*L^2*θ̇^2; kinetic = -2*m*L^2*(θ̇*sin(θ) - ż/L)^2;",
                                                           "the kinetic energy of `z` is negative in `-2*m*L^2*(θ̇*sin(θ) - ż/L)^2`"),
    ("coordinate z: m; kinetic = -m/2*|dot([z, L*θ])|^2;", "the kinetic energy of `θ` is negative in `-m/2*|dot([z, L*θ])|^2`"),
    ("let K = -J/2*θ̇^2; kinetic = K;",                   "the kinetic energy of `θ` is negative in `-J/2*θ̇^2`"),
    ("let K = J/2*θ̇^2; kinetic = -K;",                   "the kinetic energy of `θ` is negative in `-K`"),
    ("let K = -J/2*θ̇^2; let E = 2*K; kinetic = E;",      "the kinetic energy of `θ` is negative in `2*K`"),
    ("let n = -1; kinetic = n*J*θ̇^2;",                   "the kinetic energy of `θ` is negative in `n*J*θ̇^2`"),
    ("coordinate z: m; let y = m/2*ż^2; let K = -J/2*θ̇^2; kinetic = y + K;",
                                                           "the kinetic energy of `θ` is negative in `-J/2*θ̇^2`"),
    ("coordinate z: m; let y = [0, z]; let w = L*cis(θ); kinetic = m/2*|ẏ|^2 - m/4*|ẇ|^2 - (-m)*ż^2;",
                                                           "the kinetic energy of `θ` is negative in `-m/4*|ẇ|^2`"),
    ("let K(p) = -p*L^2*θ̇^2; kinetic = K(m);",           "the kinetic energy of `θ` is negative in `-p*L^2*θ̇^2`"),
    ("let K[k in 0..2] = -m*L^2*θ̇^2; kinetic = sum(k in 0..2, K[k]);",
                                                           "the kinetic energy of `θ` is negative in `-m*L^2*θ̇^2`"),
    ("kinetic = J*θ̇^2*(-3)^101;",                        "the kinetic energy of `θ` is negative in `J*θ̇^2*(-3)^101`"),
    ("kinetic = -B.inertia/2*θ̇^2;",                      "the kinetic energy of `θ` is negative in `-B.inertia/2*θ̇^2`"),
];

#[test]
fn a_negative_kinetic_energy_is_refused() {
    let block = |statements: &str| {
        format!(
            "struct P {{ m: kg, M: kg, L: m, S: kg*m, J: kg*m^2, c, B: body }} coordinate θ: rad; {statements}"
        )
    };
    let way_out = "write it with a positive sign, or write `lagrangian = …;`, which may have any, instead of `kinetic` and `potential`";
    for (statements, expected) in NEGATIVE {
        let found = refusals(&block(statements));
        assert_eq!(found, [format!("{expected}; {way_out}")], "{statements}");
    }
    // Definitions that double each time are followed once.
    let doubled =
        (0..60).map(|k| format!("let u{} = u{k} + u{k};", k + 1)).collect::<Vec<_>>().concat();
    let expected = format!("the kinetic energy of `θ` is negative in `-J*θ̇^2`; {way_out}");
    assert_eq!(refusals(&block(&format!("let u0 = -J*θ̇^2; {doubled} kinetic = u60;"))), [expected]);
    // The sign may be intended, or the energy is positive for some values.
    for statements in [
        "lagrangian = -m/2*L^2*θ̇^2;",
        "kinetic = -c/2*θ̇^2;",
        "kinetic = -S/2*L*θ̇^2;",
        "kinetic = (m - M)/2*L^2*θ̇^2;",
        "kinetic = m/2*L^2*θ̇^2 - M/2*L^2*θ̇^2*cos(θ)^2;",
        "kinetic = -m/2*L^2*cos(θ)*θ̇^2;",
        "coordinate z: m; kinetic = m/2*(L*θ̇ - ż)^2 - M*L*θ̇*ż;",
    ] {
        assert_eq!(refusals(&block(statements)), [""; 0], "{statements}");
    }
    // Without units, a number has a sign, but a parameter may have any sign.
    let source = "struct P { m } coordinate q; kinetic = -q_dot^2/2; potential = m*q^2;";
    assert_eq!(
        refusals(source),
        [format!("the kinetic energy of `q` is negative in `-q_dot^2/2`; {way_out}")]
    );
    assert!(refusals(&source.replace("-q_dot^2/2", "-m*q_dot^2")).is_empty());
}

#[test]
fn a_dissipation_that_drives_is_refused() {
    let block = |statements: &str| {
        format!(
            "struct P {{ m: kg, b: kg/s, C: N*m*s, R: kg/m, k: 1, J: kg*m^2, L: m }} coordinate x: m; \
             coordinate θ: rad; kinetic = m/2*ẋ^2 + J*θ̇^2; {statements}"
        )
    };
    for (statements, name, term) in [
        ("dissipation = -b/2*ẋ^2;", "x", "-b/2*ẋ^2"),
        ("dissipation = b/2*ẋ^2 - C/2*θ̇^2;", "θ", "-C/2*θ̇^2"),
        ("let D = -C/2*θ̇^2; dissipation = D;", "θ", "-C/2*θ̇^2"),
        ("dissipation = -R/3*abs(ẋ)^3;", "x", "-R/3*abs(ẋ)^3"),
    ] {
        let way_out = "write it with a positive sign, or write `force`, which may drive a motion";
        let expected = format!("the dissipation of `{name}` is negative in `{term}`; {way_out}");
        assert_eq!(refusals(&block(statements)), [expected], "{statements}");
    }
    for statements in [
        "dissipation = b/2*(ẋ - L*θ̇)^2;",
        // It dissipates far from the middle, and drives there.
        "dissipation = -C/2*(1 - θ^2)*θ̇^2;",
        "dissipation = -k*b/2*ẋ^2;",
        "force x = b*ẋ;",
    ] {
        assert_eq!(refusals(&block(statements)), [""; 0], "{statements}");
    }
}

#[test]
fn two_mistakes_give_two_messages() {
    let found = refusals(&block("kinetic = 2m*L^2*θ̇^2; potential = m g;"));
    assert_eq!(found.len(), 2, "{found:?}");
    let found = refusals(&block("kinetic = m*L^2*θ̇^2; potential = M*g + l;"));
    assert_eq!(
        found,
        ["unknown name `M`; did you mean `m`?", "unknown name `l`; did you mean `L`?"]
    );
    let found = refusals(&block("kinetic = m*L^2*θ̇^2 + 2θ̇; potential = x + M;"));
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn a_name_declared_twice_is_shown_in_both_places() {
    let found = refusals(&block(&format!("{ENERGY} coordinate theta;")));
    assert_eq!(
        found,
        ["`theta` is declared twice; rename one of the two", "`θ` is declared here first"]
    );
}

#[test]
fn a_lost_declaration_gives_no_second_message() {
    assert_eq!(
        refusals("struct P { m g, L } coordinate θ; kinetic = m*L^2*θ̇^2; potential = m*g*θ;").len(),
        1
    );
    assert_eq!(refusals(&block("let r = ; kinetic = m*L^2*θ̇^2 + r;")).len(), 1);
}

#[test]
fn no_coordinate() {
    assert_eq!(
        refusals("struct P { m } kinetic = m;"),
        ["no coordinate; write `coordinate θ: rad;` below the struct"]
    );
}

#[test]
fn a_default_that_is_no_number_is_one_mistake() {
    let list = |count: usize| {
        format!(
            "the default of `c` is a list of {count} numbers; write them between brackets, as in \
             `[1, 2, 3]`"
        )
    };
    let number = "a default is a number; write its value, as in `g: m/s^2 = 9.81`".to_owned();
    let body = "a body has no default; leave it out and pass the value to `new`".to_owned();
    let root = "`sqrt(-1)` is no real number; write an operand for which it is".to_owned();
    for (field, expected) in [
        ("c: [m; 2] = [1, 2, 3]", list(2)),
        ("c: [m; 3] = 0", list(3)),
        ("c: [m; 5] = [1]", list(5)),
        ("c: [m; 2] = [m, 1]", number.clone()),
        ("c: [m; 2] = [[1, 2], 1]", number.clone()),
        ("c: m = [1]", number),
        ("c: body = [1, 2]", body),
        ("c: m = sqrt(-1)", root.clone()),
        ("c: [m; 2] = [1, sqrt(-1)]", root),
    ] {
        let source = format!("struct N {{ m, {field} }} coordinate θ; kinetic = m*θ̇^2;");
        assert_eq!(refusals(&source), [expected], "{field}");
    }
}

#[test]
fn a_right_block_is_not_refused() {
    // Every function of scalars in a default, including the last of the table.
    assert!(
        refusals("struct N { c = min(1, 2), d = max(1, 2), e = atan2(1, sqrt(2)), n: [1; 3] = [0, -1/2, 1], f: [kg; 5] = [1, 2, 3, 4, 5] } coordinate θ; kinetic = c*d*e*θ̇^2;")
            .is_empty()
    );
    // Nested bars, and an index with the name of the imaginary unit.
    assert!(
        refusals(&block(
            "kinetic = m*L^2*θ̇^2; potential = m*g*|x + |x|*x/L|*sum(i in 0..3, i)*exp(-1)*8^(1/3);"
        ))
        .is_empty()
    );
    assert!(refusals(&block(ENERGY)).is_empty());
}

/// A coordinate whose declaration is readable is counted, because the number of coordinates is part
/// of the type.
#[test]
fn a_broken_coordinate_is_counted() {
    for (statements, count, messages) in [
        ("coordinate x kinetic = m*x_dot^2;", 1, 1),
        ("coordinate q[3]: [m]; kinetic = m*sum(k in 0..3, q_dot[k]^2);", 3, 1),
        ("coordinate q[3, 4]; coordinate z; kinetic = m*(z_dot^2 + q_dot[2]^2);", 4, 1),
        ("coordinate q: body; kinetic = m*q_dot^2;", 1, 1),
        ("coordinate x: m, y[2]: m; kinetic = m*(x_dot^2 + y_dot[0]^2 + y_dot[1]^2);", 3, 1),
    ] {
        let block = format!("::p; struct S {{ m }} {statements}");
        let found = crate::compile::expand(block.parse().unwrap()).to_string();
        assert_eq!(found.matches("compile_error").count(), messages, "{statements}");
        assert!(found.contains(&format!("System < {count}usize > for S")), "{statements}: {found}");
    }
}

#[test]
fn a_parameter_is_in_every_build() {
    let source = "struct P { #[cfg(test)] m: kg, L } coordinate θ: rad; kinetic = m*L^2*θ̇^2;";
    assert_eq!(
        refusals(source),
        [
            "`cfg` has no place on a parameter, which the equations need in every build; write it above the struct"
        ]
    );
}

/// The parameters that no statement mentions, for which rustc issues a warning.
#[test]
fn unmentioned_parameters_are_found() {
    let unmentioned = |source: &str| {
        super::derive(source, |model, _, _| {
            model
                .unmentioned
                .iter()
                .map(|&index| model.parameters[index].name.to_string())
                .collect::<Vec<_>>()
        })
    };
    let source = "struct P { m: J*s^2, L: m, c, _d, B: body, C: body, h = 2, n: [kg; 2] } coordinate θ: rad;";
    // A mass that cancels is mentioned, and so are names in an unused definition.
    let statements =
        "let unused = L; kinetic = m*θ̇^2/2 + integral(p in B, 0*|p|^2); potential = 0*n[1]*θ;";
    assert_eq!(unmentioned(&format!("{source} {statements}")), ["c", "_d", "C", "h"]);
    // Unused inputs and definitions are found in addition.
    let unused = |source: &str| {
        super::derive(source, |model, _, _| {
            model.unused.iter().map(ToString::to_string).collect::<Vec<_>>()
        })
    };
    let statements = "driven x: m; driven y: m; input u: N; input w: N; let a = 2*x; let b = a; \
                      let f(p) = p^2; let g(p) = f(p); kinetic = m*θ̇^2/2; force θ = L*w;";
    assert_eq!(unused(&format!("{source} {statements}")), ["y", "u", "b", "g"]);
    // An argument of the same name hides a parameter.
    assert_eq!(
        unmentioned("struct P { m, c } coordinate q; let r(c) = m*c; kinetic = r(q_dot)^2;"),
        ["c"]
    );
    assert_eq!(
        unmentioned(
            "struct P { m, c, d } coordinate q; kinetic = m*q_dot^2; dissipation = c*q_dot^2; force q = d;"
        ),
        [""; 0]
    );
}
