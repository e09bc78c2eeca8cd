//! Units and shapes: a mismatch is reported at the smallest expression that contains it.

use super::refusals;
use super::refusals::block;

/// Vectors, families and indices.
#[rustfmt::skip]
const SHAPES: &[(&str, &str)] = &[
    ("kinetic = m*L^2*θ̇^2; potential = x;",                    "`x` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("kinetic = m*L^2*θ̇^2; potential = inner(x, [1, 2, 3]);",  "`inner` takes two vectors of one length; these are a plane vector and a space vector"),
    ("kinetic = m*L^2*θ̇^2; potential = |x + [1, 2, 3]|;",      "`[1, 2, 3]` is a space vector, but the terms before it are plane vectors; a sum needs terms of one kind"),
    ("kinetic = m*L^2*θ̇^2; potential = f[5]*g;",               "index 5 is out of range; `f` has 5 members, `f[0]` to `f[4]`"),
    ("kinetic = m*L^2*θ̇^2; potential = sum(k in 0..7, f[k]);", "index 5 is out of range; `f` has 5 members, `f[0]` to `f[4]`"),
    ("kinetic = m*L^2*θ̇^2; potential = f*g;",                  "a family cannot be multiplied by a scalar; write a component or an index"),
    ("kinetic = m*L^2*θ̇^2; potential = x/x;",                  "`x` is a plane vector, and nothing can be divided by that; divide by its length `|u|`"),
    ("kinetic = m*L^2*θ̇^2; potential = x.w;",                  "unknown component `w`; there are `.x`, `.y`, `.z`"),
    ("kinetic = m*L^2*θ̇^2; potential = x.z;",                  "`x` is a plane vector, it has no `.z`; write a vector"),
    ("kinetic = m*L^2*θ̇^2; potential = sum(k in 0..100000000, k);", "this range has more than 65536 members; write a shorter one"),
    ("kinetic = m*L^2*θ̇^2; potential = x^2;",                  "`x` is a plane vector, and only scalars have powers; write `|x|^2`"),
    ("kinetic = m*L^2*θ̇^2; potential = max(x, x);",            "`x` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
];

#[test]
fn shapes_are_checked() {
    for (statements, expected) in SHAPES {
        assert_eq!(refusals(&block(statements)), [*expected], "{statements}");
    }
}

/// Quantities without a unit are not checked, including vectors and families.
#[test]
fn a_vector_may_have_no_unit() {
    let source = |unit: &str| {
        format!(
            "struct P {{ m: kg, l: m, f: [{unit}; 5] }} coordinate θ: _; driven x: [{unit}; 2];
             kinetic = m/2*|ẋ + dot(l*cis(θ))|^2; potential = m*f[0]*height(x);"
        )
    };
    assert!(refusals(&source("_")).is_empty());
    assert_eq!(
        refusals(&source("1")),
        ["`dot(l*cis(θ))` is m/s, but `ẋ` is 1/s; a sum needs one unit"]
    );
}

/// Each electrical unit in terms of other units.
#[test]
fn electrical_units_agree() {
    for (unit, other) in [
        ("C", "A*s"),
        ("V", "W/A"),
        ("F", "C/V"),
        ("H", "V*s/A"),
        ("ohm", "V/A"),
        ("T", "V*s/m^2"),
        ("J", "C*V"),
        ("N*m/A", "V*s/rad"),
        ("J/K", "W*s/K"),
    ] {
        let source = |other: &str| {
            format!(
                "struct P {{ a: {unit}, b: {other} }} coordinate q: 1; lagrangian = (a + b)*q̇^2/2;"
            )
        };
        assert!(refusals(&source(other)).is_empty(), "{unit} {other}");
        let wrong = format!("{other}*K");
        assert_eq!(refusals(&source(&wrong)).len(), 1, "{unit} {other}");
    }
}

/// A direct-current motor: its inductance is the mass of the charge, and its constant couples both
/// circuits.
#[test]
fn a_motor_is_checked() {
    let source = |constant: &str| {
        format!(
            "struct Motor {{ L: H, R: ohm, C: F, k: {constant}, J: kg*m^2 }}
             coordinate q: C; coordinate θ: rad;
             kinetic = L/2*q̇^2 + J/2*θ̇^2; potential = q^2/(2*C); dissipation = R/2*q̇^2;
             force q = -k*θ̇; force θ = k*q̇;"
        )
    };
    assert!(refusals(&source("V*s")).is_empty());
    assert!(refusals(&source("N*m/A")).is_empty());
    assert_eq!(
        refusals(&source("T*m^3"))[0],
        "`-k*θ̇` is kg·m³/(s³·A), but a force on `q` is kg·m²/(s³·A), an energy per unit of `q`"
    );
}

/// Units: each mistake is reported at the smallest expression that contains it.
#[rustfmt::skip]
const UNITS: &[(&str, &str)] = &[
    ("potential = m*9.81*L*cos(θ);",                        "`m*9.81*L*cos(θ)` is kg·m, but `m/2*L^2*θ̇^2` is kg·m²/s²; all energies of a block have one unit"),
    ("potential = m*g*(L + θ);",                            "`θ` is a pure number, but `L` is m; a sum needs one unit"),
    ("potential = m*g*L*cos(L);",                           "`L` is m, but the argument of `cos` is a pure number; divide it by a length, such as a parameter `a: m`"),
    ("potential = m*g*L*sin(t);",                           "`t` is s, but the argument of `sin` is a pure number; multiply it by an angular frequency, such as a parameter `omega: rad/s`"),
    ("potential = m*g*L*exp(t*θ̇ + t);",                     "`t` is s, but `t*θ̇` is a pure number; a sum needs one unit"),
    ("potential = m*g*height([L, θ]);",                     "`θ` is a pure number, but `L` is m; a vector needs one unit"),
    ("potential = m*g*height(x + ẋ);",                      "`ẋ` is m/s, but `x` is m; a sum needs one unit"),
    ("potential = m*g*max(0, L*θ - t);",                    "`t` is s, but `L*θ` is m; a sum needs one unit"),
    ("potential = m*g*max(L, θ);",                          "`θ` is a pure number, but `L` is m; `max` needs one unit"),
    ("potential = m*g*L*atan2(L, t);",                      "`t` is s, but `L` is m; `atan2` needs one unit"),
    ("potential = m*g*L*L^θ;",                              "`L` is m, but the base of a power with a non-constant exponent is a pure number; divide it by a length, such as a parameter `a: m`"),
    ("potential = m*g*L*2^t;",                              "`t` is s, but an exponent is a pure number; divide it by a time, such as a parameter `tau: s`"),
    ("dissipation = m*L^2*θ̇^2;",                            "`m*L^2*θ̇^2` times a second is kg·m²/s, but `m/2*L^2*θ̇^2` is kg·m²/s²; all energies of a block have one unit"),
    ("force θ = m*g;",                                      "`m*g` is kg·m/s², but a force on `θ` is kg·m²/s², an energy per unit of `θ`"),
    ("let r(p) = p + L; potential = m*g*r(t);",             "`L` is m, but `p` is s; a sum needs one unit"),
    ("let w = g*L; potential = m*w + m*L;",                 "`m*L` is kg·m, but `m*w` is kg·m²/s²; a sum needs one unit"),
    // Brackets are printed only where the language requires them.
    ("potential = m*g*(L - (x.x^2)^3*2 - -m*t);",            "`(x.x^2)^3*2` is m⁶, but `L` is m; a sum needs one unit"),
    ("potential = m*g*height(x + L*(θ*2 - (-θ)*2)*[t, t]);", "`L*(θ*2 - (-θ*2))*[t, t]` is m·s, but `x` is m; a sum needs one unit"),
    // The unit of a quantity without a unit is inferred from its first use and checked at the next.
    ("potential = k*θ^2 + k*L;",                            "`k*L` is m times the unit of `k`, but `k*θ^2` is a pure number times the unit of `k`; a sum needs one unit"),
];

#[test]
fn units_are_checked() {
    for (statements, expected) in UNITS {
        let source = format!(
            "struct P {{ m: kg, L: m, g: m/s^2, k }} coordinate θ: rad; driven x: [m; 2]; kinetic = m/2*L^2*θ̇^2; {statements}"
        );
        assert_eq!(refusals(&source), [*expected], "{statements}");
    }
}

#[test]
fn units_give_no_false_alarm() {
    let blocks = [
        // An energy may be divided by the mass.
        "struct P { L: m, g: m/s^2 } coordinate θ: rad; kinetic = L^2*θ̇^2/2; potential = -g*L*cos(θ);",
        // Quantities without units are not checked.
        "struct P { L, g } coordinate θ; kinetic = θ̇^2 + t*θ̇^2; potential = sin(t);",
        // Unknown units are inferred or stay unknown. A zero has every unit.
        "struct P { m: kg, L, g, c, k, s: N/m^(3/2) } coordinate θ: rad; coordinate z: m; driven x: [m; 2]; kinetic = m/2*|ẋ + dot(L*cis(θ))|^2 + m/2*ż^2;
         potential = m*g*(height(x) + height(L*cis(θ))) + k/2*max(0, z)^2 + s*|z|^(5/2)*sign(z); dissipation = c*θ̇^2; force θ = [c, 0].x*θ̇; force z = k*z;",
    ];
    for source in blocks {
        assert!(refusals(source).is_empty(), "{:?}", refusals(source));
    }
}

#[rustfmt::skip]
const BODIES: &[(&str, &str)] = &[
    ("potential = B;",                                  "`B` is a body; write `B.mass`, `B.center`, `B.inertia` or `integral(p in B, …)`"),
    ("potential = B.weight;",                           "unknown component `weight`; there are `.mass`, `.center`, `.inertia`"),
    ("potential = integral(p in g, height(p));",        "`g` is no body; declare it as `g: body` in the struct"),
    ("potential = integral(p in D, height(p));",        "unknown name `D`; declare it as a parameter, a coordinate, an input or with `let`"),
    ("potential = integral(p in B, |p|^3);",            "`|p|^3` is no polynomial in `p`, and a body knows its moments up to the second; write a polynomial of degree two or less"),
    ("potential = integral(p in B, p.x*|p|^2);",        "`p.x*|p|^2` is of higher degree than two in `p`, and a body knows its moments up to the second; write a polynomial of degree two or less"),
    ("potential = integral(p in B, sin(p.x));",         "`sin(p.x)` is no polynomial in `p`, and a body knows its moments up to the second; write a polynomial of degree two or less"),
    ("potential = integral(p in B, p);",                "`integral(p in B, …)` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("potential = B.mass*g*B.inertia;",                 "`B.mass*g*B.inertia` is kg²·m³/s², but `integral(p in B, …)` is kg·m²/s²; all energies of a block have one unit"),
    ("potential = integral(p in B, g*|p|^2);",          "`integral(p in B, …)` is kg·m³/s², but `integral(p in B, …)` is kg·m²/s²; all energies of a block have one unit"),
];

#[test]
fn bodies_are_integrated_to_the_second_degree() {
    for (statements, expected) in BODIES {
        let source = format!(
            "struct P {{ B: body, g: m/s^2 }} coordinate θ: rad; let r(p) = cis(θ)*p; kinetic = integral(p in B, |dot(r(p))|^2/2); {statements}"
        );
        assert_eq!(refusals(&source), [*expected], "{statements}");
    }
}
