//! Switches and layers in equations.

use super::{derive, evaluate};
use crate::algebra::expr::Symbol;
use crate::mechanics::arguments::arguments;
use std::collections::BTreeMap;

/// Returns the switches and the layers in a force, at a = 5, b = 0.5, c = 2, t = 3, q = 0.25 and
/// q̇ = −4.
fn found(force: &str) -> [Vec<f64>; 2] {
    let block =
        format!("struct S {{ a, b, c }} coordinate q; kinetic = q_dot^2/2; force q = {force};");
    derive(&block, |_, graph, motion| {
        let found = arguments(graph, &motion.accelerations, &BTreeMap::new());
        [&found.switches, &found.layers].map(|ids| {
            let value = |id: &_| {
                evaluate(&found.graph, *id, &|symbol| match symbol {
                    Symbol::Parameter(index) => [5.0, 0.5, 2.0][index],
                    Symbol::Time => 3.0,
                    Symbol::Coordinate(_) => 0.25,
                    Symbol::Velocity(_) => -4.0,
                    other => panic!("{force}: {other:?}"),
                })
            };
            let mut values: Vec<f64> = ids.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            values
        })
    })
}

/// Checks the sizes of the arguments; their signs depend on the order of terms.
fn check(force: &str, switches: &[f64], layers: &[f64]) {
    let close = |found: &[f64], expected: &[f64]| {
        let near = |(a, b): (&f64, &f64)| (a.abs() - b).abs() <= 1e-12 * (1.0 + b.abs());
        found.len() == expected.len() && found.iter().zip(expected).all(near)
    };
    let [own, other] = found(force);
    assert!(close(&own, switches) && close(&other, layers), "{force}: {own:?} {other:?}");
}

#[test]
fn switches() {
    check("-c*sign(q_dot)", &[4.0], &[]);
    check("a*abs(q - c)", &[1.75], &[]);
    check("-q_dot*abs(q_dot)", &[4.0], &[]);
    check("max(q, b)", &[0.25], &[]);
    check("min(a*q, c*t)", &[4.75], &[]);
    check("sign(c - a)*q", &[], &[]);
}

#[test]
fn layers() {
    check("tanh(q_dot/b)", &[], &[8.0]);
    check("atan(c*q)", &[], &[0.5]);
    check("exp(-((q - a)/b)^2)", &[], &[9.5]);
    check("exp(-((t^2 - c^2)/b)^2)", &[], &[10.0]);
    check("1/cosh((t^3 - a)/b)", &[], &[44.0]);
    check("1/(1 + (q/b)^2)", &[], &[0.5]);
    check("atan2(q, b)", &[], &[0.5]);
    check("1/(1 + exp(-q_dot/b))", &[], &[8.0]);
    check("c/(a + exp(q_dot/b))^2", &[], &[8.0 + 5f64.ln()]);
    check("exp(q/b)/(a*exp(q/b) + 5)", &[], &[0.5]);
    check("exp(-(abs(t - c)/b)^(3/2))", &[1.0], &[2.0]);
    check("exp(-a*exp(q_dot/b))", &[], &[8.0 - 5f64.ln()]);
    check("atan(exp(q/b))", &[], &[0.5]);
    check("tanh(a*exp(-q_dot/b))", &[], &[8.0 + 5f64.ln()]);
    check("atan2(b, q)", &[], &[0.5]);
    // A width, a height or a place that varies too.
    check("exp(-((q - a)/b)^2/(c + t^2))", &[], &[9.5 / 11f64.sqrt()]);
    check("exp(-((t - a)/b)^2*(c + q_dot))", &[], &[32f64.sqrt()]);
    check("exp(-((q - a)/b)^2 - c*q_dot)", &[], &[82.25]);
    check("exp(-(q - a)*(q - c)/b)", &[], &[16.625]);
    check("1/(1 + (q/b)^2*(a + q_dot))", &[], &[0.5]);
    check("1/(1 + (q/b)^2*(c + sin(t)))", &[], &[0.5 * (2.0 + 3f64.sin()).sqrt()]);
    // Peaks of sines.
    check("exp(a*(cos(q) - 1))", &[], &[5.0 * (1.0 - 0.25f64.cos())]);
    check("cos(q)^200", &[], &[(-200.0 * 0.25f64.cos().ln()).sqrt()]);
}

#[test]
fn what_varies_evenly_has_none() {
    for force in [
        "sin(a*q)",
        "-c*q_dot",
        "q^3/(a + c)",
        "1/(c + cos(q))",
        "exp(-((t - a)/b)^2)",
        "tanh((t - a)/b)",
        "1/q^2",
        "exp(c*q)",
        "ln(1 + exp(-q/b))",
        "exp(-q/b)*ln(1 + exp(-q/b))/(1 + exp(-q/b))",
        "1/(1 + exp((t - c)/b))",
        "exp(a*cos(t))",
        "sin(c*t)^100",
        "sin(q)^3 + q^12",
    ] {
        check(force, &[], &[]);
    }
}
