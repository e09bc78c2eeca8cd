//! Widths and centres of functions of time.

use super::{derive, evaluate};
use crate::algebra::expr::Symbol;
use crate::mechanics::clock::features;
use std::fmt::Write;

/// Returns the reciprocal width of each function of time in a force, and the time since its centre
/// at t = 3, with a = 5, b = 0.5 and c = 2.
fn found(force: &str) -> Vec<(f64, f64)> {
    let block =
        format!("struct S {{ a, b, c }} coordinate q; kinetic = q_dot^2/2; force q = {force};");
    derive(&block, |_, graph, motion| {
        let (own, features) = features(graph, &motion.accelerations, &[]);
        let value = |id| {
            evaluate(&own, id, &|symbol| match symbol {
                Symbol::Parameter(index) => [5.0, 0.5, 2.0][index],
                Symbol::Time => 3.0,
                other => panic!("{force}: {other:?}"),
            })
        };
        let mut found: Vec<(f64, f64)> = features
            .into_iter()
            .map(|feature| (value(feature.rate), value(feature.since)))
            .collect();
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        found
    })
}

fn check(force: &str, expected: &[(f64, f64)]) {
    let found = found(force);
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
    assert!(
        found.len() == expected.len()
            && found.iter().zip(expected).all(|(a, b)| close(a.0, b.0) && close(a.1, b.1)),
        "{force}: {found:?}, not {expected:?}"
    );
}

const ROOT: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn bells() {
    check("c*exp(-((t - a)/b)^2)", &[(2.0, -2.0)]);
    check("exp(-(t - a)^2/b)*sin(q)", &[(1.0 / 0.5f64.sqrt(), -2.0)]);
    check("exp(-c*t^2 + a*t + sin(q))", &[(2f64.sqrt(), 3.0 - 1.25)]);
    check("exp(-(t/b)^4)", &[(2.0, 3.0)]);
    check("exp(-((t - 1)/b)^2) + exp(-((t - 4)/c)^2)", &[(0.5, -1.0), (2.0, 2.0)]);
    check("tanh((t - a)/b)", &[(2.0, -2.0)]);
    check("1/cosh(c*t)^2", &[(2.0, 3.0)]);
    check("atan(t/b)", &[(2.0, 3.0)]);
    check("exp(-t/b)", &[(2.0, 3.0)]);
    check("c^(t - 1)", &[(2f64.ln(), 2.0)]);
}

#[test]
fn reciprocals_and_roots() {
    check("1/(b^2 + (t - a)^2)", &[(2.0, -2.0)]);
    check("(b^2 + (t - a)^2)^(-3/2)", &[(2.0, -2.0)]);
    check("sqrt(b^2 + (t - a)^2)", &[(2.0, -2.0)]);
    check("1/(b^4 + t^4)", &[(2.0, 3.0)]);
    check("ln(b^2 + t^2)", &[(2.0, 3.0)]);
    check("atan2(t - a, b)", &[(2.0, -2.0)]);
    // The relative width is the same at every distance from the pole.
    for force in ["1/(a + t)", "sqrt(a + t)", "ln(t)", "1/t^2"] {
        check(force, &[]);
    }
}

#[test]
fn oscillations() {
    check("sin(c*t)", &[(2.0 * ROOT, 0.0)]);
    check("cos(c*t + b)^4", &[(2.0 * ROOT, 0.0)]);
    check("sin(q - 2*t)", &[(2.0 * ROOT, 0.0)]);
    check("sin(c*t^2)", &[(2f64.sqrt(), 0.0)]);
    check("sign(sin(10*t))", &[(10.0 * ROOT, 0.0)]);
    check("sin(7*t + sin(c*t))", &[(2.0 * ROOT, 0.0), (7.0 * ROOT, 0.0)]);
    // A kick at each zero of the sine, with steep sides.
    check("exp(-100*sin(3*t)^2)", &[(3.0 * ROOT, 0.0), (30.0, 0.0)]);
    check("tanh(a*sin(3*t))", &[(3.0 * ROOT, 0.0), (15.0, 0.0)]);
}

#[test]
fn corners() {
    check("abs(t - a)", &[]);
    check("max(0, t - a)", &[]);
    check("max(0, 1 - ((t - a)/b)^2)", &[(2.0, -2.0)]);
    check("sign(b^2 - (t - a)^2)", &[(2.0, -2.0)]);
    check("max(0, 1 - abs(t - a)/b)", &[(2.0, -2.0)]);
    check("exp(-abs(t - a)/b)", &[(2.0, -2.0)]);
    check("1/(b + abs(t - a))", &[(2.0, -2.0)]);
    // A pulse from a to a + b.
    check("sign(t - a) - sign(t - a - b)", &[(4.0, 3.0 - 5.25)]);
}

/// Nested magnitudes and sums of magnitudes: a centre at each corner, with the steepest slope.
#[test]
fn several_corners() {
    check("exp(-abs(abs(t - a) - b)/c)", &[(0.5, -2.5), (0.5, -2.0), (0.5, -1.5), (2.0, -2.0)]);
    check("exp(-abs(t - a)/b - abs(t - 1)/c)", &[(0.5, 0.0), (2.5, -2.0), (2.5, 2.0)]);
    check("tanh((abs(t - a) - abs(t - 1))/b)", &[(0.5, 0.0), (4.0, -2.0), (4.0, 2.0)]);
    // With too many corners, the width applies at all times.
    let many: Vec<String> = (0..10).map(|k| format!("abs(t - {k})")).collect();
    assert!(found(&format!("exp(-({})/b)", many.join(" + "))).contains(&(20.0, 0.0)));
}

/// If there are many corners at numeric times, neighbours are the ends of pulses.
#[test]
fn many_pulses() {
    let pulses: Vec<String> = (0..6).map(|k| format!("sign(t - {k}) - sign(t - {k}.5)")).collect();
    let expected: Vec<(f64, f64)> =
        (0..11).rev().map(|k| (4.0, 3.0 - 0.25 - 0.5 * f64::from(k))).collect();
    check(&pulses.join(" + "), &expected);
}

#[test]
fn what_has_no_width() {
    check("a*sin(q)", &[]);
    check("c*t + a*t^3", &[]);
    check("sin(q*t)", &[]);
    check("exp(-q^2*t)", &[]);
    check("sin(sin(q) + a)*t", &[]);
    check("q/(1 + q^2)*t", &[]);
}

/// Polynomials that are too long are skipped without being expanded.
#[test]
fn long_polynomials() {
    let product: Vec<String> = (0..40).map(|k| format!("(t - {k})")).collect();
    check(&format!("exp(-{})", product.join("*")), &[]);
    let mut lets = String::from("let u0 = t;");
    for k in 0..40 {
        write!(lets, "let u{} = u{k} + u{k}*(1 + u{k});", k + 1).unwrap();
    }
    let block =
        format!("struct S {{ a }} coordinate q; {lets} kinetic = q_dot^2/2; force q = sin(a*u40);");
    derive(&block, |_, graph, motion| {
        assert!(features(graph, &motion.accelerations, &[]).1.is_empty());
    });
}
