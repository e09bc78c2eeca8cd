//! Tables: statements, units, equations, switches, refusals.

use super::{derive, refusals};
use crate::compile::{compile, expand};
use crate::mechanics::arguments::arguments;
use crate::model::Table;

/// Returns a block with a mass on a spring whose force is a table, and further statements.
fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, k: N/m }} coordinate x: m; coordinate θ: rad; input u: N;
         kinetic = m/2*ẋ^2 + m/2*L^2*θ̇^2; {statements}"
    )
}

const F: &str = "table f(x: m): N = [(-1, -2), (0, 0), (0.5, 3), (1e0, 3.5)], outside = linear;";

#[test]
fn tables_stand_wherever_functions_of_one_argument_do() {
    for statements in [
        "force x = -f(x);",
        "potential = f(x)*L;",
        "kinetic = m*f(x)/k/L*ẋ^2;",
        "dissipation = f(x)*abs(ẋ);",
        "force x = -f(L*sin(θ) + 2*x);",
        "let g(y) = f(y)/2; force x = -g(x);",
        "let f2 = f(x); force x = -f2; output rate: N/s = dot(f2); output jerk: N/s = dot(f(x));",
        "output push: N = f(x);",
        "force x = f(L*t/(1*t));",
        "force x = f(0);",
        "force θ = f(x)*L; constraint rod: f(x) = k*x;",
        "limit stop: f(x) + k*L >= 0, restitution = 0;",
        "friction shoe: ẋ, force = f(x);",
        "table linear(y): 1 = [(0, 0), (2/3, -1/3)], outside = refused; force x = k*x*linear(θ);",
        "let table = L; potential = f(table + x)*table; table outside(a: 1): 1 = [(0, 0), (1, 1)], outside = linear; force x = k*L*outside(θ);",
    ] {
        let found = refusals(&block(&format!("{F} {statements}")));
        assert!(found.is_empty(), "{statements}: {found:?}");
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("table f(x: m): N = [(0, 0)], outside = linear;",                  "a table has two points at least; write `[(0, 0), (1, 2)]`"),
    ("table f(x: m): N = [], outside = linear;",                        "a table has two points at least; write `[(0, 0), (1, 2)]`"),
    ("table f(x: m): N = [(0, 0), (1, 1), (1, 2)], outside = linear;",  "the points of a table stand in ascending order; `1` is not greater than `1` before it"),
    ("table f(x: m): N = [(0.5, 0), (0.25, 1)], outside = linear;",     "the points of a table stand in ascending order; `0.25` is not greater than `0.5` before it"),
    ("table f(x: m): N = [(0, 0), (L, 1)], outside = linear;",          "`L` is no number; the points of a table are numbers in its units"),
    ("table f(x: m): N = [(0, 0), (1, 1/0)], outside = linear;",        "`1/0` is no number; the points of a table are numbers in its units"),
    ("table f(x: m): N = [(0, 0), (1e-300, 1e300)], outside = linear;", "the spline of `f` is beyond the range of `f64`; choose other units"),
    ("table f(x: m): N = [0, 1], outside = linear;",                    "`0` is not expected here; expected a point of the table, as `(0, 0)`"),
    ("table f(x: m): N = [(0, 0, 1)], outside = linear;",               "`,` is not expected here; expected the closing bracket"),
    ("table f(x: m): N = [(0), (1)], outside = linear;",                "the input ends too early; expected `,`"),
    ("table f(x: m): N = (0, 0), outside = linear;",                    "`(` is not expected here; expected a list of points, as `[(0, 0), (1, 2)]`"),
    ("table f(x: m): N = [(0, 0), (1, 1)];",                            "what `f` is beyond its points is missing; write `, outside = linear` for its tangents there, or `, outside = refused`"),
    ("table f(x: m): N = [(0, 0), (1, 1)], linear;",                    "what `f` is beyond its points is missing; write `, outside = linear` for its tangents there, or `, outside = refused`"),
    ("table f(x: m): N = [(0, 0), (1, 1)], outside = flat;",            "a table goes on along its tangents or ends with its points; write `outside = linear` or `outside = refused`"),
    ("table f(x: m): N = [(0, 0), (1, 1)], outside = 0;",               "a table goes on along its tangents or ends with its points; write `outside = linear` or `outside = refused`"),
    ("table f: N = [(0, 0), (1, 1)], outside = linear;",                "a table is a function; write `table f(x: m): N = [(0, 0), (1, 2)], outside = linear;`"),
    ("table f(x: m, y: m): N = [(0, 0), (1, 1)], outside = linear;",    "a table has one argument; leave the others out"),
    ("table f(x: m): [N; 2] = [(0, 0), (1, 1)], outside = linear;",     "argument and value of a table are scalars; write one table for each component"),
    ("table f(x: metre): N = [(0, 0), (1, 1)], outside = linear;",      "unknown unit `metre`; write `m`"),
    ("table L(x: m): N = [(0, 0), (1, 1)], outside = linear;",          "`L` is declared twice; rename one of the two"),
    ("table i(x: m): N = [(0, 0), (1, 1)], outside = linear;",          "`i` is the imaginary unit"),
];

#[test]
fn refused_statements() {
    for (statements, expected) in REFUSED {
        let found = refusals(&block(statements));
        assert!(found.iter().any(|own| own.contains(expected)), "{statements}: {found:?}");
    }
}

#[rustfmt::skip]
const MISUSED: &[(&str, &str)] = &[
    ("force x = -f(θ);",        "`θ` is a pure number, but the argument of `f` is m; divide or multiply it"),
    ("force x = k*f(x);",       "`k*f(x)` is kg²·m/s⁴, but a force on `x` is kg·m/s², an energy per unit of `x`"),
    ("force x = -f;",           "`f` is a function; write `f(…)`"),
    ("force x = -f*x;",         "`f` is a function; write `f(…)`"),
    ("force x = -f(x, x);",     "`f` takes one argument; 2 stand here"),
    ("force x = -f([x, x]);",   "`[x, x]` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("force x = -ff(x);",       "unknown function `ff`; did you mean `f`?"),
    ("coordinate f: m;",        "`f` is declared twice; rename one of the two"),
    ("table g(a: 1): N = [(0, 0), (1, 1)], outside = refused; force x = g(2);", "`g(2)` is no real number; write an operand for which it is"),
];

#[test]
fn misused_tables() {
    for (statements, expected) in MISUSED {
        let found = refusals(&block(&format!("{F} {statements}")));
        assert!(found.iter().any(|own| own == expected), "{statements}: {found:?}");
    }
}

#[test]
fn equations_name_the_table() {
    let statements = "potential = f(x)*L; force θ = -k*L^2*f(θ*L)^2*f(x)/(k*L)^3;";
    let compiled = compile(&block(&format!("{F} {statements}"))).unwrap();
    let equations = ["ẍ = −L·f′(x)/m", "θ̈ = −f(x)·f(L·θ)²/(m·L³·k²)"];
    assert_eq!(compiled.equations, equations);
    assert_eq!(compiled.latex[0], r"\ddot{x} = -\frac{L {f'}\left(x\right)}{m}");
    let ascii = "struct P { m: kg } coordinate x: m; kinetic = m/2*dot(x)^2; potential = f(x);
                 table f(x: m): J = [(0, 0), (1, 1)], outside = linear;";
    assert_eq!(compile(ascii).unwrap().equations, ["x_ddot = -f'(x)/m"]);
}

/// Eleven knots have twelve intervals, which four digits tell apart.
#[test]
fn an_argument_has_a_switch_for_each_digit_of_its_intervals() {
    let points: Vec<String> = (0..11).map(|k| format!("({k}, {})", k * k % 7)).collect();
    let table = format!("table f(x: m): N = [{}], outside = linear;", points.join(", "));
    let of = |statements: &str| {
        derive(&block(&format!("{table} {statements}")), |model, graph, motion| {
            let digit = |own: &Table| own.written.as_ref().map_or(9, |(_, own)| own.digits());
            let digits = model.tables.iter().map(|(&index, own)| (index, digit(own))).collect();
            arguments(graph, &motion.accelerations, &digits).switches.len()
        })
    };
    assert_eq!(of("force x = -f(x);"), 4);
    assert_eq!(of("potential = f(x)*L;"), 4);
    assert_eq!(of("force x = -f(x)*f(2*x)/f(3*L);"), 8);
    assert_eq!(of("force x = -f(t*L/t);"), 0);
    assert_eq!(of("force x = -f(t*sqrt(k/m)*L);"), 4);
}

/// Returns a block with a table among its parameters, and further statements.
fn given(statements: &str) -> String {
    block(statements).replacen("k: N/m }", "k: N/m, f: table(m): N, g: table(s): 1 }", 1)
}

#[test]
fn a_table_is_a_parameter_too() {
    for statements in [
        "force x = -f(x)*g(t);",
        "potential = f(x)*L; output rate: N/s = dot(f(x));",
        "dissipation = f(L)*abs(ẋ); table h(x: m): N = [(0, 0), (1, 1)], outside = linear; force x = h(x);",
        "force x = f(0);",
        "friction shoe: ẋ, force = f(x);",
        "limit stop: f(x) + k*L >= 0, restitution = 0; constraint rod: f(L*θ) = k*x;",
    ] {
        let found = refusals(&given(statements));
        assert!(found.is_empty(), "{statements}: {found:?}");
    }
    let compiled = compile(&given("potential = f(x)*L; force θ = k*L^2*g(t);")).unwrap();
    assert_eq!(compiled.equations, ["ẍ = −L·f′(x)/m", "θ̈ = k·g(t)/m"]);
}

#[rustfmt::skip]
const NOT_GIVEN: &[(&str, &str)] = &[
    ("f: table(m): N = 3",         "a parameter has no points in the block; leave them out and pass a `Table` to `new`, or write `table f(x: m): N = [(0, 0), (1, 2)], outside = linear;`"),
    ("f: table(m): [N; 2]",        "argument and value of a table are scalars; write one table for each component"),
    ("f: table([m; 2]): N",        "argument and value of a table are scalars; write one table for each component"),
    ("f: table(x: m): N",          "the unit of the argument alone stands between the parentheses; write `table(m): N`"),
    ("f: table(m, m): N",          "the unit of the argument alone stands between the parentheses; write `table(m): N`"),
    ("f: table(metre): N",         "unknown unit `metre`; write `m`"),
    ("m: table(m): N",             "`m` is declared twice; rename one of the two"),
];

#[test]
fn parameters_that_are_no_tables() {
    for (field, expected) in NOT_GIVEN {
        let found = refusals(&block("").replacen("k: N/m }", &format!("k: N/m, {field} }}"), 1));
        assert!(found.iter().any(|own| own == expected), "{field}: {found:?}");
    }
    for (statement, expected) in [
        ("coordinate y: table(m): N;", "a coordinate has a unit; write `rad` or `m`"),
        (
            "driven y: table(m): N;",
            "a driven input has a unit; write `[m; 2]` for a motion in the plane",
        ),
        ("output y: table(m): N = x;", "an output has a unit; write `m` or `[m; 2]`"),
        ("force x = -f;", "`f` is a function; write `f(…)`"),
        (
            "force x = -f(θ);",
            "`θ` is a pure number, but the argument of `f` is m; divide or multiply it",
        ),
    ] {
        let found = refusals(&given(statement));
        assert!(found.iter().any(|own| own == expected), "{statement}: {found:?}");
    }
}

#[test]
fn a_mistake_leaves_the_items() {
    let source = block("table f(x: m): N = [(0, 0)], outside = linear; force x = f(x);");
    let items = expand(format!("::p; {source}").parse().unwrap()).to_string();
    assert!(items.contains("compile_error") && items.contains("impl"));
}
