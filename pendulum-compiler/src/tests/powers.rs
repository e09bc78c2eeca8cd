//! Large whole powers, at negative bases too, and their derivatives.

use super::derive;
use super::random::interpret::Values;
use pendulum_runtime::scalar::{Dual, Real};

/// Returns the acceleration of a coordinate with this force, and its derivative with respect to the
/// coordinate, where the parameter `w` has the value given.
fn force<T: Real>(force: &str, x: T, w: T) -> [T; 2] {
    let block = format!(
        "struct S {{ w }} coordinate x; kinetic = ẋ^2/2; potential = 0; force x = {force};"
    );
    derive(&block, |model, graph, motion| {
        let values = Values {
            parameters: vec![w],
            time: T::from_f64(0.0),
            q: vec![x],
            v: vec![T::from_f64(0.0)],
            p: Vec::new(),
            inputs: Vec::new(),
        };
        let slope = motion.jacobians.as_ref().unwrap()[0][0][0];
        values.of(model, graph, &[motion.accelerations[0], slope]).try_into().ok().unwrap()
    })
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-13 * expected.abs(), "{found}, not {expected}");
}

/// The expected values are exact powers of two and their products with whole numbers.
#[test]
fn large_whole_powers_of_negative_numbers_are_real() {
    let cases: [(&str, f64, f64); 8] = [
        ("x^65", -(0.5f64.powi(65)), 65.0 * 0.5f64.powi(64)),
        ("x^66", 0.5f64.powi(66), -66.0 * 0.5f64.powi(65)),
        ("x^999", -(0.5f64.powi(999)), 999.0 * 0.5f64.powi(998)),
        ("x^-101", -(2f64.powi(101)), -101.0 * 2f64.powi(102)),
        ("x^-100", 2f64.powi(100), 100.0 * 2f64.powi(101)),
        ("(2*x)^1000001", -1.0, 2000002.0),
        ("(2*x)^999999999999999", -1.0, 1999999999999998.0),
        ("1/(1 + x^70/w^70)", 0.5, 35.0),
    ];
    for (expression, value, slope) in cases {
        let [found, derivative] = force(expression, -0.5, 0.5);
        close(found, value);
        close(derivative, slope);
        // Jacobians of large systems are computed with dual numbers.
        close(force(expression, Dual::variable(-0.5), Dual::constant(0.5))[0].derivative, slope);
        let [found, derivative] = force(expression, -0.5f32, 0.5);
        if value.abs() < 1e30 && 1e-30 < value.abs() && slope.abs() < 1e6 {
            assert!((f64::from(found) - value).abs() < 1e-3 * value.abs(), "{expression}: {found}");
            assert!((f64::from(derivative) - slope).abs() < 1e-3 * slope.abs(), "{derivative}");
        }
    }
}

/// (x/w)^100 where w^100 is zero in `f64`, or in `f32`.
#[test]
fn large_powers_of_quotients_have_the_range_of_the_quotient() {
    let expression = "1/(1 + (x/w)^100)";
    for (x, value, slope) in
        [(0.0, 1.0, 0.0), (-1e-4, 0.5, 250_000.0), (-0.5e-4, 1.0, 1e6 * 2.0 * 0.5f64.powi(100))]
    {
        let [found, derivative] = force(expression, x, 1e-4);
        close(found, value);
        close(derivative, slope);
    }
    let [found, derivative] = force(expression, -0.01f32, 0.01);
    assert!((found - 0.5).abs() < 1e-4 && (derivative - 2500.0).abs() < 1.0, "{derivative}");
    let [found, derivative] = force("(x/w)^99", -1e-5, 1e-5);
    close(found, -1.0);
    close(derivative, 99e5);
    // At zero, the power and its slope are zero.
    for expression in ["x^100", "x^65", "(x/w)^101", "x^200*w^-150"] {
        assert_eq!(force(expression, 0.0, 1e-4), [0.0; 2]);
    }
}
