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
    // Derivatives.
    ("dissipation = c*der(x)^2;",           "unknown function `der`; write `dot(x)`"),
    ("dissipation = c*diff(x, t)^2;",       "unknown function `diff`; write `dot(x)`"),
    ("dissipation = c*Derivative(x, t)^2;", "unknown function `Derivative`; write `dot(x)`"),
    ("dissipation = c*x.diff(t)^2;",        "`.diff()` is Rust, which has no place in a formula; write `dot(x)`"),
    ("dissipation = c*(dx/dt)^2;",          "`dt` is no quantity; write `ẋ` or `x_dot`"),
    ("dissipation = c*(d(x)/dt)^2;",        "`dt` is no quantity; write `dot(x)`"),
    ("force x = -k*x(t);",                  "`x` is no function; leave `(t)` out, because everything that moves depends on the time"),
    // Functions and constants of modules.
    ("force x = k*L*np.sin(x/L);",          "a function stands without `np`; write `sin(x/L)`"),
    ("force x = k*L*Math.atan2(x, L);",     "a function stands without `Math`; write `atan2(x, L)`"),
    ("force x = k*L*math.pi;",              "a constant stands without `math`; write `pi`"),
    ("force x = k*L*Rational(1, 2);",       "unknown function `Rational`; write `1/2`"),
    ("force x = k*L*cosd(30);",             "unknown function `cosd`; write `cos(30*pi/180)`"),
    ("force x = k*L*Heaviside(x);",         "unknown function `Heaviside`; write `(1 + sign(x))/2`"),
    // Statements.
    ("T = m/2*x_dot^2;",                    "unknown statement `T`; did you mean `kinetic`?"),
    ("V = m*g*x;",                          "unknown statement `V`; did you mean `potential`?"),
    ("drag = c/2*x_dot^2;",                 "unknown statement `drag`; did you mean `dissipation`?"),
    ("param q: kg;",                        "`param` is no statement; declare parameters between the braces of the struct, as in `{ m: kg, g: m/s^2 = 9.81 }`"),
    ("const b = 2;",                        "`const` is no statement; declare parameters between the braces of the struct, as in `{ m: kg, g: m/s^2 = 9.81 }`"),
    ("phi: rad;",                           "`phi` is no statement; declare it, as in `coordinate phi: rad;`"),
    ("bob = x*L;",                          "`bob` is no statement; name a value by `let bob = …;`, an energy by `kinetic = …;` or `potential = …;`"),
    ("force = -c*x_dot;",                   "what it acts on is missing; write `force θ = …;` with a coordinate or a point, also for the torque about an angle θ"),
    ("torque = -c*x_dot;",                  "what it acts on is missing; write `force θ = …;` with a coordinate or a point, also for the torque about an angle θ"),
    ("torque x = -c*x_dot;",                "`x` is a scalar, and a torque acts on a rotation; write `force` for what acts on a point or an angle"),
    ("friction x = c*x_dot;",               "a dry friction has a name; write `friction x: rate, force = F;`, or `dissipation = …;` for a viscous one"),
    // Declarations.
    ("let h: m = x;",                       "a definition has the unit of its value; write `let h = …;`"),
    ("let mut h = x;",                      "a definition never changes; leave `mut` out"),
    ("let (h, w) = (x, L);",                "a definition has one name; write `let r = [x, y];` for a vector, whose components are `r.x` and `r.y`"),
    ("let r = vec![x, L];",                 "`vec!` is Rust, which has no place in a formula; write `[a, b]` for a vector"),
    ("let r = array([x, L]);",              "unknown function `array`; write `[x, L]`"),
    ("coordinate z(t): m;",                 "everything that moves depends on the time; leave `(t)` out"),
    ("coordinate z: m = 0;",                "a block has no start; pass it to `solve`, with the interval"),
    ("driven z: m = L*sin(t);",             "a block does not say how a driven input moves; pass its motion to `driven_by`, or write `let` for a formula"),
    ("input w: N = -k*x;",                  "a block does not say the value of a control input; pass a controller to `controlled_by`, or write `let` for a formula"),
    ("coordinate z: f64;",                  "`f64` is a type, and a unit stands here; write `kg`, `m` and so on, or `1` for a pure number"),
    ("coordinate z: length;",               "unknown unit `length`; write `m`"),
    ("driven z: Vec2;",                     "unknown unit `Vec2`; write `[m; 2]`"),
    ("driven z: \"m\";",                    "a text has no place here; write it without quotes"),
    // Vectors and norms.
    ("let r = [x, L]; potential = m*g*r.height;", "`height` is no component; write `height(r)`"),
    ("let r = [x, L]; potential = k/2*r.norm^2;", "`norm` is no component; write `|r|`"),
    ("let r = [x, L]; kinetic = m/2*inner(dot(r));", "`inner` takes 2 arguments; 1 stands here"),
    // A forgotten square is marked, wherever it stands.
    ("let r = [x, L]; kinetic = m/2*|dot(r)|;", "`m/2*|dot(r)|` is kg·m/s, but `m/2*x_dot^2` is kg·m²/s²; all energies of a block have one unit: write `|dot(r)|^2`"),
    ("let r = [x, L]; kinetic = m/2*|dot(r)| + m/2*|dot(r)|^2;", "`m/2*|dot(r)|` is kg·m/s, but `m/2*|dot(r)|^2` is kg·m²/s²; a sum needs one unit: write `|dot(r)|^2`"),
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

/// Blocks with slips in the struct or in the first energy, and their messages.
#[rustfmt::skip]
const BEGINNINGS: &[(&str, &str)] = &[
    ("struct P<T> { m: kg } coordinate x: m; kinetic = m/2*x_dot^2;", "the struct gets the type of its numbers by itself; leave `<…>` out"),
    ("struct P { m = 1: kg } coordinate x: m; kinetic = m/2*x_dot^2;", "the unit stands before the default; write `m: kg = 1`"),
    ("struct P { m: kg, k: N/m } coordinate x: m; kinetic = m/2*x_dot; potential = k/2*x^2;", "`m/2*x_dot` is kg·m/s, but `k/2*x^2` is kg·m²/s²; all energies of a block have one unit: write `x_dot^2`"),
    ("struct P { m: kg, k: N/m } coordinate x: m; kinetic = m*x_dot^3; potential = k/2*x^2;", "`m*x_dot^3` is kg·m³/s³, but `k/2*x^2` is kg·m²/s²; all energies of a block have one unit"),
    ("struct P { m: kg, k: N/m } coordinate x: m; kinetic = m/2*x_dot^2 + k/2*x;", "`k/2*x` is kg·m/s², but `m/2*x_dot^2` is kg·m²/s²; a sum needs one unit: write `x^2`"),
    ("struct P { m: kg, c: kg/s } coordinate x: m; dissipation = c*x_dot; kinetic = m/2*x_dot^2;", "`c*x_dot` times a second is kg·m/s, but `m/2*x_dot^2` is kg·m²/s²; all energies of a block have one unit: write `x_dot^2`"),
];

#[test]
fn a_slip_at_the_beginning_is_marked_there() {
    for (source, expected) in BEGINNINGS {
        assert_eq!(refusals(source), [*expected], "{source}");
    }
}
