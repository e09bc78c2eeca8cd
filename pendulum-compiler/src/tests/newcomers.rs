//! Notations of newcomers: the message suggests the corresponding notation of the language.

use super::refusals;

/// Blocks with the names and units of other notations, and their messages.
#[rustfmt::skip]
const NEWCOMERS: &[(&str, &str)] = &[
    // Velocities.
    ("dissipation = c*vx^2;",               "unknown name `vx`; did you mean `x_dot`?"),
    ("dissipation = c*v_x^2;",              "unknown name `v_x`; did you mean `x_dot`?"),
    ("dissipation = c*dx^2;",               "unknown name `dx`; did you mean `x_dot`?"),
    ("dissipation = c*dxdt^2;",             "unknown name `dxdt`; did you mean `x_dot`?"),
    ("dissipation = c*dx_dt^2;",            "unknown name `dx_dt`; did you mean `x_dot`?"),
    ("dissipation = c*xdot^2;",             "unknown name `xdot`; did you mean `x_dot`?"),
    ("dissipation = c*xd^2;",               "unknown name `xd`; did you mean `x_dot`?"),
    ("dissipation = c*xDot^2;",             "unknown name `xDot`; did you mean `x_dot`?"),
    ("dissipation = c*x_prime^2;",          "unknown name `x_prime`; did you mean `x_dot`?"),
    ("driven path: m; potential = m*g*L*(path + dpath)/L;", "unknown name `dpath`; did you mean `path_dot`?"),
    // A parameter and a control input have no velocity to suggest.
    ("dissipation = c*vm*x_dot;",           "unknown name `vm`; did you mean `m`?"),
    ("dissipation = c*du*x_dot;",           "unknown name `du`; did you mean `u`?"),
    // The time.
    ("force x = k*L*sin(time);",            "unknown name `time`; write `t`"),
    ("force x = k*L*sin(2*pi*t);",          "`2*pi*t` is s, but the argument of `sin` is a pure number; multiply it by an angular frequency, such as a parameter `omega: rad/s`"),
    ("force x = k*L*exp(-t);",              "`-t` is s, but the argument of `exp` is a pure number; divide it by a time, such as a parameter `tau: s`"),
    ("potential = m*g*L*cos(x);",           "`x` is m, but the argument of `cos` is a pure number; divide it by a length, such as a parameter `a: m`"),
    ("potential = m*g*L*cos(m*x);",         "`m*x` is kg·m, but the argument of `cos` is a pure number; divide it by a quantity in kg·m"),
    // Units.
    ("driven h: cm;",                       "unknown unit `cm`; write `m`: 1 cm is 0.01 m"),
    ("driven h: mm;",                       "unknown unit `mm`; write `m`: 1 mm is 0.001 m"),
    ("driven h: km/s;",                     "unknown unit `km`; write `m`: 1 km is 1000 m"),
    ("driven h: g;",                        "unknown unit `g`; write `kg`: 1 g is 0.001 kg"),
    ("driven h: metre;",                    "unknown unit `metre`; write `m`"),
    ("driven h: meter^2;",                  "unknown unit `meter`; write `m`"),
    ("driven h: m/second;",                 "unknown unit `second`; write `s`"),
    ("driven h: m/sec;",                    "unknown unit `sec`; write `s`"),
    ("driven h: degree;",                   "unknown unit `degree`; write `rad`: 1 degree is pi/180 rad"),
    ("driven h: deg/s;",                    "unknown unit `deg`; write `rad`: 1 deg is pi/180 rad"),
    ("driven h: hour;",                     "unknown unit `hour`; write `s`: 1 hour is 3600 s"),
    ("driven h: 1/min;",                    "unknown unit `min`; write `s`: 1 min is 60 s"),
    ("potential = m*g*L*cos(30*deg);",      "unknown name `deg`; write a number in `rad`: 1 deg is pi/180 rad"),
    ("potential = m*g*5*cm;",               "unknown name `cm`; write a number in `m`: 1 cm is 0.01 m"),
    ("potential = m*g*5 cm;",               "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = m*g*5cm;",                "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = m*g*5 metre;",            "a number in a formula has no unit; units stand in declarations only, as in `g: m/s^2 = 9.81`"),
    ("potential = m*g*L*2 min(1, 2);",      "there is no implicit multiplication; write `*` before `min`"),
    // Control inputs, coordinates and outputs.
    ("input torque: N; force x = torqe;",   "unknown name `torqe`; did you mean `torque`?"),
    ("input torque: N; output a = torqu;",  "unknown name `torqu`; did you mean `torque`?"),
    ("control torque: N;",                  "unknown statement `control`; did you mean `input`?"),
    ("coord angle: rad;",                   "unknown statement `coord`; did you mean `coordinate`?"),
    ("dof angle: rad;",                     "unknown statement `dof`; did you mean `coordinate`?"),
    ("pot = m*g*x;",                        "unknown statement `pot`; did you mean `potential`?"),
    ("damping = c/2*x_dot^2;",              "unknown statement `damping`; did you mean `dissipation`?"),
    // Vectors.
    ("let r = (x, -L);",                    "a vector stands in brackets; write `[x, …]`"),
    ("let r = L*(sin(x/L), -cos(x/L));",    "a vector stands in brackets; write `[sin(x/L), …]`"),
    ("let r = L [sin(x/L), -cos(x/L)];",    "there is no implicit multiplication, and an index is one number; write `L*[…]` for a vector"),
    ("coordinate angle; kinetic = m*angle_dot^2; force angel = 1;", "unknown coordinate `angel`; did you mean `angle`?"),
    ("force z = u;",                        "unknown coordinate `z`; declare it, as in `coordinate z: m;`"),
    ("output speed = x_dot; output twice = 2*speed;", "`speed` is an output, which no formula reads; name its value with `let`"),
    ("output speed = x_dot; output twice = 2*sped;", "unknown name `sped`; did you mean `speed`?"),
];

#[test]
fn newcomers_are_answered() {
    for (statements, expected) in NEWCOMERS {
        let source = format!(
            "struct P {{ m: kg, L: m, g: m/s^2, k: kg/s^2, c: kg/s }} coordinate x: m; input u: N; kinetic = m/2*x_dot^2; {statements}"
        );
        assert_eq!(refusals(&source), [*expected], "{statements}");
    }
}
