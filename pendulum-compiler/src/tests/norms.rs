//! Norms at zero: derivatives that exist there, and directions, which do not.

use super::derive;
use super::random::interpret::Values;

/// Returns accelerations, ∂q̈/∂q and ∂q̈/∂q̇ of two coordinates in columns, one after another.
fn linearized(statements: &str, q: [f64; 2], v: [f64; 2]) -> [f64; 10] {
    let block = format!(
        "struct S {{ c }} coordinate x; coordinate y; let v = [ẋ, ẏ]; let r = [x, y]; {statements}"
    );
    derive(&block, |model, graph, motion| {
        let values = Values {
            parameters: vec![3.0],
            time: 0.0,
            q: q.to_vec(),
            v: v.to_vec(),
            p: Vec::new(),
            inputs: Vec::new(),
        };
        let jacobians = motion.jacobians.as_ref().unwrap();
        let lists =
            [&motion.accelerations].into_iter().chain(jacobians[0].iter()).chain(&jacobians[1]);
        let all = lists.flat_map(|list| values.of(model, graph, list));
        all.collect::<Vec<f64>>().try_into().unwrap()
    })
}

const FREE: &str = "kinetic = (ẋ^2 + ẏ^2)/2; potential = 0;";

/// Drag of every power above the first has the derivative zero at rest.
#[test]
fn drag_has_a_derivative_at_rest() {
    for drag in [
        "force x = -c*|v|*ẋ; force y = -c*|v|*ẏ;",
        "force x = -c*|v|*ẋ*(1 + |v|); force y = -c*|v|^(1/2)*ẏ;",
        "force x = -c*|[ẋ, 2*ẏ, ẋ + ẏ]|*ẋ; force y = -c*|v|*ẏ;",
        "dissipation = c/3*|v|^3;",
        "dissipation = c/3*inner(v, v)^(3/2);",
        "dissipation = c/3*sqrt(inner(v, v))^(5/2);",
        "dissipation = c/3*|v|^(9/4);",
        "dissipation = c/3*|v - [2*ẏ, ẋ]|^3;",
        "dissipation = c*|[ẋ*cos(y), ẏ*(2 + sin(x))]|^3;",
    ] {
        assert_eq!(
            linearized(&format!("{FREE} {drag}"), [0.5, 0.25], [0.0; 2]),
            [0.0; 10],
            "{drag}"
        );
    }
    // The masses are coupled, and the matrix is eliminated.
    let coupled = "kinetic = ẋ^2 + ẏ^2 + ẋ*ẏ*cos(x - y); potential = 0; dissipation = c*|v|^3;";
    assert_eq!(linearized(coupled, [0.5, 0.25], [0.0; 2]), [0.0; 10]);
}

/// Forces and Jacobians of potentials at the origin, and at a common place of two points.
#[test]
fn potentials_have_derivatives_at_their_centre() {
    for potential in
        ["c*|r|^3", "c*|r|^5", "c*sqrt(x^2 + y^2)^3", "c*|r|^(5/2)", "c*inner(r, r)^(3/2)"]
    {
        let block = format!("kinetic = (ẋ^2 + ẏ^2)/2; potential = {potential};");
        assert_eq!(linearized(&block, [0.0; 2], [0.0; 2]), [0.0; 10], "{potential}");
    }
    for potential in
        ["c*|[x - y, 2*x - 2*y]|^3", "c*|r - [1/2, 1/2]|^3", "c*|[x - 1/2, y - 1/2, 0]|^3"]
    {
        let block = format!("kinetic = (ẋ^2 + ẏ^2)/2; potential = {potential};");
        assert_eq!(linearized(&block, [0.5; 2], [0.0; 2]), [0.0; 10], "{potential}");
    }
}

/// |v|ẋ has the derivatives |v| + ẋ²/|v| and ẋẏ/|v|.
#[test]
fn derivatives_of_norms_are_exact_elsewhere() {
    let drag = format!("{FREE} force x = -c*|v|*ẋ; force y = -c*|v|*ẏ;");
    // At 1e-40 the norm is less than any number that could count, and its derivative vanishes.
    for size in [1.0_f64, -1e-3, 1e-20] {
        let v = [3.0 * size, 4.0 * size];
        let (norm, size): (f64, f64) = (5.0 * size.abs(), size.abs());
        let found = linearized(&drag, [0.5, 0.25], v);
        let expected = [-20.4, -7.2, -7.2, -24.6].map(|entry| entry * size);
        assert_eq!(found[2..6], [0.0; 4]);
        for (found, expected) in found[6..].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14 * norm, "{found}, not {expected}");
        }
    }
    let found = linearized(&drag, [0.5, 0.25], [0.0, 1e-40]);
    assert!(found.iter().all(|entry| entry.abs() < 1e-38), "{found:?}");
}

/// A spring of length zero has no direction, and a centre of attraction no force.
#[test]
fn what_has_no_limit_stays_without_a_value() {
    for potential in ["c*(|r| - 1)^2", "-c/|r|", "c*|r|"] {
        let block = format!("kinetic = (ẋ^2 + ẏ^2)/2; potential = {potential};");
        let found = linearized(&block, [0.0; 2], [0.0; 2]);
        assert!(found[..2].iter().any(|force| force.is_nan()), "{potential}: {found:?}");
    }
    // A numerator that does not vanish beside a norm that does.
    let found = linearized(&format!("{FREE} force x = ẋ^2/|[ẏ, 2*ẏ, ẏ*x]|;"), [0.5; 2], [1.0, 0.0]);
    assert!(!found[0].is_finite() || 1e20 < found[0], "{found:?}");
}
