//! Notations and declarations of other programs are translated in the messages.

use super::refusals;
use super::refusals::block;

/// Texts in other notations, and their messages.
#[rustfmt::skip]
const NOTATIONS: &[(&str, &str)] = &[
    ("potential = -cos^2(θ);",                 "a function is raised to a power after its argument; write `cos(θ)^2`"),
    ("potential = m*sin^2(θ + 1);",            "a function is raised to a power after its argument; write `sin(θ + 1)^2`"),
    ("potential = m*sin^-1(θ);",               "a function is raised to a power after its argument; write `asin(θ)`, or `1/sin(θ)`"),
    ("potential = m*exp^-1(θ);",               "a function is raised to a power after its argument; write `exp(θ)^-1`"),
    ("potential = m*cos^2 θ;",                 "a function is raised to a power after its argument; write `cos(θ)^2`"),
    ("potential = m*cos^2;",                   "`cos` is a function; write `cos(…)`"),
    ("potential = cos θ;",                     "the argument of `cos` stands in parentheses; write `cos(θ)`"),
    ("potential = inner u u;",                 "the arguments of `inner` stand in parentheses; write `inner(…, …)`"),
    ("let a = x; potential = ȧ·ȧ;",            "`·` is part of a name in Rust; write `*`, as in `ȧ*ȧ`, or `inner(ȧ, ȧ)` for vectors"),
    ("potential = m·L·g;",                     "`·` is part of a name in Rust; write `*`, as in `m*L*g`, or `inner(u, v)` for vectors"),
    ("potential = m·(L);",                     "`·` is part of a name in Rust; write `*`, or `inner(u, v)` for vectors"),
    ("let a = x; potential = -m/2*ȧ*ȧ;",       "`-m/2*ȧ*ȧ` is the complex product of two plane vectors, but a scalar is needed here; write `inner(ȧ, ȧ)`"),
    ("potential = m*g*L - m/2*ẋ*ẋ;",           "`m/2*ẋ*ẋ` is the complex product of two plane vectors, but a scalar is needed here; write `inner(ẋ, ẋ)`"),
    ("let a = [1, 2, θ]; potential = a*m*a;",  "the product of two space vectors is ambiguous; write `inner(a, a)` or `cross(a, a)`"),
    ("potential = dot(x, ẋ);",                 "`dot` is the derivative of one argument; write `inner(x, ẋ)` for a scalar product"),
    ("potential = m*9.81 m/s^2*L;",            "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = m*9.81m/s^2*L;",             "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = 2 kg;",                      "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = m*9.81*m/s^2;",              "unknown name `s`; declare it as a parameter; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = N*θ;",                    "unknown name `N`; declare it as a parameter; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = E*θ;",                    "unknown name `E`; declare it as a parameter, a coordinate, an input or with `let`"),
    ("potential = 2 m;",                       "there is no implicit multiplication; write `*` before `m`"),
    ("potential = 2m/L;",                      "there is no implicit multiplication; write `2*m`"),
    ("potential = log(θ + 2);",                "unknown function `log`; write `ln(θ + 2)`"),
    ("potential = norm(x);",                   "unknown function `norm`; write `|x|`"),
    ("potential = arctan(θ);",                 "unknown function `arctan`; write `atan(θ)`"),
    ("potential = pow(θ + 1, 2);",             "unknown function `pow`; write `(θ + 1)^2`"),
    ("potential = pow(θ^2, -3);",              "unknown function `pow`; write `(θ^2)^(-3)`"),
    ("potential = (m + L).powi(2);",           "`.powi()` is Rust, which has no place in a formula; write `(m + L)^2`"),
    ("potential = (θ^2).powf((g + 1)*2);",     "`.powf()` is Rust, which has no place in a formula; write `(θ^2)^((g + 1)*2)`"),
    ("potential = (m*L).hypot(-θ);",           "`.hypot()` is Rust, which has no place in a formula; write `|[m*L, -θ]|`"),
    ("potential = (m*L).atan2(g - 1);",        "`.atan2()` is Rust, which has no place in a formula; write `atan2(m*L, g - 1)`"),
    ("potential = x.dot(ẋ);",                  "`.dot()` is Rust, which has no place in a formula; write `inner(x, ẋ)`"),
    ("potential = m*L.powi(θ +);",             "`.powi()` is Rust, which has no place in a formula; write a function of the language, as in `sin(θ)`"),
    ("potential = |xdot|;",                    "unknown name `xdot`; did you mean `x_dot`?"),
    ("potential = |xddot|;",                   "unknown name `xddot`; did you mean `x_ddot`?"),
    ("potential = θdot;",                      "unknown name `θdot`; did you mean `θ_dot`?"),
    ("potential = thetaddot;",                 "`thetaddot` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("potential = std::f64::consts::PI;",      "`std::f64::consts::PI` is Rust, which has no place in a formula; write `π`"),
    ("potential = 2*::core::f64::consts::E;",  "`::core::f64::consts::E` is Rust, which has no place in a formula; write `exp(1)`"),
    ("potential = f64::sin(θ);",               "`f64::sin` is Rust, which has no place in a formula; write `sin(…)`"),
    ("potential = crate::GRAVITY;",            "`crate::GRAVITY` is Rust, which has no place in a formula; write a number, or declare a parameter"),
    ("potential = θ*TAU;",                     "unknown name `TAU`; write `2*π`"),
    ("potential = θ*PI;",                   "unknown name `PI`; write `π`"),
    ("potential = θ*Pi;",                   "unknown name `Pi`; write `π`"),
    ("potential = .5*m;",                      "a number begins with a digit; write `0.5`"),
    ("potential = m*θ > 0;",                   "a formula has no conditions; write `max`, `min`, `abs` or `sign` to tell cases apart, as in `max(0, θ)`"),
    ("potential = m*(θ <= 0);",                "a formula has no conditions; write `max`, `min`, `abs` or `sign` to tell cases apart, as in `max(0, θ)`"),
    ("potential = |θ != 0|;",                  "a formula has no conditions; write `max`, `min`, `abs` or `sign` to tell cases apart, as in `max(0, θ)`"),
    ("potential = θ\u{301};",                  "`θ\u{301}` has an accent, and a derivative has a dot; write `θ̇` or `theta_dot`"),
    ("potential = θ\u{300};",                  "`θ\u{300}` has an accent, and a derivative has a dot; write `θ̇` or `theta_dot`"),
    ("potential = |x\u{301}|;",                "`x\u{301}` has an accent, and a derivative has a dot; write `ẋ` or `x_dot`"),
    ("let ω = θ; potential = ώ;",              "`ώ` has an accent, and a derivative has a dot; write `ω̇` or `omega_dot`"),
    ("let ab = θ; potential = áb;",            "`áb` has an accent, and a derivative has a dot; write `ab_dot`"),
    ("potential = m\u{301};",                  "unknown name `m\u{301}`; did you mean `m`?"),
    ("potential = θ'a;",                       "`'` is no derivative; write `θ̇` or `theta_dot`"),
];

#[test]
fn other_notations_are_translated() {
    for (statements, expected) in NOTATIONS {
        assert_eq!(
            refusals(&block(&format!("kinetic = m*L^2*θ̇^2; {statements}"))),
            [*expected],
            "{statements}"
        );
    }
}

/// The message for a block in ASCII is in ASCII.
#[test]
fn constants_are_translated_into_the_letters_of_the_block() {
    for (constant, expected) in [
        ("PI", "unknown name `PI`; write `pi`"),
        ("FRAC_PI_2", "unknown name `FRAC_PI_2`; write `pi/2`"),
        (
            "f64::consts::PI",
            "`f64::consts::PI` is Rust, which has no place in a formula; write `pi`",
        ),
    ] {
        let source = format!(
            "struct P {{ m }} coordinate q; kinetic = m*q_dot^2; potential = m*{constant};"
        );
        assert_eq!(refusals(&source), [expected]);
    }
}

/// Declarations in other forms, and statements that are not supported.
#[rustfmt::skip]
const DECLARATIONS: &[(&str, &str)] = &[
    ("coordinate a, b: m;",                    "a statement declares one name; write `coordinate b: m;` as a statement of its own"),
    ("driven a: m, b: m;",                     "a statement declares one name; write `driven b: m;` as a statement of its own"),
    ("coordinate a, b[3]: m/s, d;",            "a statement declares one name; write `coordinate b[3]: m/s;` as a statement of its own"),
    ("coordinate a, b: [m];",                  "a statement declares one name; write `coordinate b;` as a statement of its own"),
    ("driven a, b: [m; 2];",                   "a statement declares one name; write `driven b: [m; 2];` as a statement of its own"),
    ("let a = 1, b = 2;",                      "a statement declares one name; write `let b = …;` as a statement of its own"),
    ("potential = θ, b;",                      "`,` is not expected here; expected `;`"),
    ("driven a: [2];",                         "a unit is missing; write `[m; 2]`, or `[_; 2]` for a vector without a unit"),
    ("driven a: [; 3];",                       "a unit is missing; write `[m; 3]`, or `[_; 3]` for a vector without a unit"),
    ("driven a: [;];",                         "a unit is missing; write `[m; 2]`, or `[_; 2]` for a vector without a unit"),
    ("driven a[2];",                           "the length stands with the unit; write `a: [_; 2]`"),
    ("driven a[2]: m/s;",                      "the length stands with the unit; write `a: [m/s; 2]`"),
    ("driven a: [m, m];",                      "all components have one unit; write `[m; 2]` for a vector"),
    ("driven a: [m, m, m,];",                  "all components have one unit; write `[m; 3]` for a vector"),
    ("driven a: [m];",                         "a length is missing; write `[m; 2]` for a vector, `[kg; 5]` for a family"),
    ("coordinate a: [_; 4];",                  "a coordinate is a number or a vector of two or three components; write `coordinate a[4];` for several"),
    ("coordinate a: [m/s; 5];",                "a coordinate is a number or a vector of two or three components; write `coordinate a[5]: m/s;` for several"),
];

#[test]
fn other_declarations_are_translated() {
    for (statements, expected) in DECLARATIONS {
        assert_eq!(
            refusals(&block(&format!("kinetic = m*L^2*θ̇^2; {statements}"))),
            [*expected],
            "{statements}"
        );
    }
    assert_eq!(
        refusals("struct P { m[3]: kg } coordinate θ; kinetic = m[0]*θ̇^2;"),
        ["the length stands with the unit; write `m: [kg; 3]`"]
    );
}
