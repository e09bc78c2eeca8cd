//! Every row of the derivative table against fourth-order central differences.

use super::{Random, evaluate, lowered};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Symbol};

#[rustfmt::skip]
const EXPRESSIONS: &[&str] = &[
    "sin(a)", "cos(a)", "tan(a/3)", "asin(a/4)", "acos(a/4)", "atan(a)", "atan2(a, b)", "atan2(b, a)", "sinh(a)", "cosh(a)", "tanh(a)",
    "exp(a)", "ln(a)", "sqrt(a)", "abs(a - 5)", "abs(a + 5)", "a^3", "a^-2", "a^(3/2)", "a^b", "b^a", "max(a, 5)", "max(a, b - 7)", "min(a, 5)", "min(a, b - 7)",
    "sign(a)*a^2", "1/(a + b)", "(a + b)^2/(a*b - 9)", "sqrt(a^2 + b^2)", "sin(a*b)*cos(a + b)^2", "exp(-a*sin(b*a))", "ln(cosh(a)*c)", "|[a, b, a*c]|^3",
    "max(0, a - 1/100)^2",
];

#[test]
fn derivatives_match_differences() {
    let mut random = Random(11);
    for expression in EXPRESSIONS {
        let mut graph = Graph::new();
        let id = lowered(&mut graph, expression);
        let slope = derivative(&mut graph, id, Symbol::Parameter(0));
        for _ in 0..50 {
            let point = [0, 1, 2].map(|_| random.uniform(0.2, 2.5));
            let at = |a: f64, id| {
                evaluate(&graph, id, &|symbol| match symbol {
                    Symbol::Parameter(0) => a,
                    Symbol::Parameter(index) => point[index],
                    other => panic!("{other:?}"),
                })
            };
            let (a, h) = (point[0], 1e-3);
            let difference = (8.0 * (at(a + h, id) - at(a - h, id))
                - (at(a + 2.0 * h, id) - at(a - 2.0 * h, id)))
                / (12.0 * h);
            let exact = at(a, slope);
            assert!(
                (difference - exact).abs() < 1e-7 * (1.0 + exact.abs()),
                "d/da {expression} at {point:?}: {exact}, differences {difference}"
            );
        }
    }
}

#[test]
fn the_step_is_the_derivative_of_the_ramp() {
    let mut graph = Graph::new();
    let id = lowered(&mut graph, "max(0, a)");
    let slope = derivative(&mut graph, id, Symbol::Parameter(0));
    for (a, expected) in [(-1.0, 0.0), (0.0, 0.5), (2.0, 1.0)] {
        assert_eq!(evaluate(&graph, slope, &|_| a), expected);
    }
}

/// At zeros of the base, a power of a product has the slope zero.
#[test]
fn a_power_has_its_slope_at_zero_too() {
    for (expression, inside) in
        [("(c*a)^(5/2)", 5.0 * 2f64.powf(2.5) / 2.0), ("(max(0, a)/c)^(5/2)", 5.0 / 2f64.powf(3.5))]
    {
        let mut graph = Graph::new();
        let id = lowered(&mut graph, expression);
        let slope = derivative(&mut graph, id, Symbol::Parameter(0));
        for (a, expected) in [(0.0, 0.0), (1.0, inside)] {
            let found = evaluate(&graph, slope, &|symbol| {
                if symbol == Symbol::Parameter(0) { a } else { 2.0 }
            });
            assert!(
                (found - expected).abs() < 1e-14,
                "d/da {expression} at {a}: {found}, not {expected}"
            );
        }
    }
}

/// Where a divisor overflows, a quotient and its derivatives are zero, not ∞/∞.
#[test]
fn derivatives_of_quotients_are_finite_where_divisors_overflow() {
    for expression in [
        "1/(1 + exp(a))",
        "1/(1 + exp(-a))",
        "1/(2 + b*exp(a/2))^3",
        "1/(1 + c*a*exp(a))",
        "sin(b)/(1 + exp((a - c)/b))",
        "1/(1 + exp(a) + exp(b))^2",
        "1/cosh(a)^3",
        "tanh(a)",
    ] {
        let mut graph = Graph::new();
        let mut id = lowered(&mut graph, expression);
        for order in 1..=2 {
            id = derivative(&mut graph, id, Symbol::Parameter(0));
            for a in [-1500.0, -800.0, 800.0, 1500.0] {
                let value = evaluate(&graph, id, &|symbol| match symbol {
                    Symbol::Parameter(index) => [a, 1.5, 0.7][index],
                    other => panic!("{other:?}"),
                });
                assert!(value.abs() < 1e-100, "{value}: derivative {order} of {expression} at {a}");
            }
        }
    }
}
