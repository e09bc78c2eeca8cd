//! Every rule of the table at random points: both sides have the same value, and the left side is
//! rewritten to the right side.

use super::{Random, evaluate, lowered};
use crate::algebra::expr::rule::{CANCELLATIONS, RULES, without_cancellation};
use crate::algebra::expr::{Graph, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::messages::Errors;
use crate::model;
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::parse;

#[test]
fn the_left_side_becomes_the_right() {
    for rule in RULES {
        let mut graph = Graph::new();
        let left = lowered(&mut graph, rule.left);
        let right = lowered(&mut graph, rule.right);
        assert_eq!(left, right, "{}: {} is not {}", rule.name, rule.left, rule.right);
    }
}

#[test]
fn every_rule_applies_to_its_pattern() {
    for rule in RULES {
        let lower = || {
            lowered(&mut Graph::new(), rule.left);
        };
        assert!(
            rule.applies(lower),
            "{}: {} is simplified by another rule, or not at all",
            rule.name,
            rule.left
        );
    }
}

#[test]
fn the_left_side_keeps_its_digits() {
    for rule in CANCELLATIONS {
        let mut graph = Graph::new();
        let left = lowered(&mut graph, rule.left);
        let right = lowered(&mut graph, rule.right);
        assert_ne!(left, right, "{}: the graph itself leaves {} as it is", rule.name, rule.left);
        assert_eq!(
            without_cancellation(&mut graph, left),
            right,
            "{}: {} is not {}",
            rule.name,
            rule.left,
            rule.right
        );
    }
}

#[test]
fn differences_are_found_among_other_terms() {
    for (whole, parts) in [
        ("a*b*(1 - cos(c)) + a", "2*a*b*sin(c/2)^2 + a"),
        ("3 - cos(a) - 2*cos(b) + c", "2*sin(a/2)^2 + 4*sin(b/2)^2 + c"),
        ("c^2*(2 - cos(a) + cos(b))", "c^2*(2*sin(a/2)^2 + 2*cos(b/2)^2)"),
        ("sqrt(1 - cos(a - b))", "sqrt(2*sin((a - b)/2)^2)"),
    ] {
        let mut graph = Graph::new();
        let (whole, parts) = (lowered(&mut graph, whole), lowered(&mut graph, parts));
        assert_eq!(without_cancellation(&mut graph, whole), parts);
    }
    // Terms that do not match a rule are not changed.
    for still in ["2 - cos(a)", "1 - cos(a)^2/2", "b - c*cos(a)", "cos(a) + cos(b)", "1 - cosh(a)"]
    {
        let mut graph = Graph::new();
        let root = lowered(&mut graph, still);
        assert_eq!(without_cancellation(&mut graph, root), root, "{still}");
    }
}

#[test]
fn the_largest_shift_is_reduced() {
    for (shifted, plain) in [
        ("cos(a + 9223372036854775807*π/2)", "sin(a)"),
        ("cos(a - 9223372036854775807*π/2)", "-sin(a)"),
        ("sin(a + 9223372036854775807*π/2)", "-cos(a)"),
        ("cos(a + 9223372036854775806*π/2)", "-cos(a)"),
    ] {
        let mut graph = Graph::new();
        assert_eq!(lowered(&mut graph, shifted), lowered(&mut graph, plain), "{shifted}");
    }
}

/// The left side is evaluated from its syntax tree, without the graph.
#[test]
fn both_sides_have_one_value() {
    let mut random = Random(7);
    for rule in RULES.iter().chain(CANCELLATIONS) {
        for _ in 0..100 {
            let point = [0, 1, 2].map(|_| random.uniform(0.1, 3.0));
            let left = value(rule.left, point);
            let mut graph = Graph::new();
            let right = lowered(&mut graph, rule.right);
            let right = evaluate(&graph, right, &|symbol| match symbol {
                Symbol::Parameter(index) => point[index],
                other => panic!("{other:?}"),
            });
            assert!(
                (left - right).abs() <= 1e-12 * (1.0 + left.abs()),
                "{} at {point:?}: {left} and {right}",
                rule.name
            );
        }
    }
}

#[test]
fn names_are_unique() {
    let mut names: Vec<&str> = RULES.iter().chain(CANCELLATIONS).map(|rule| rule.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

fn value(source: &str, point: [f64; 3]) -> f64 {
    let source = format!("::p; struct S {{ a, b, c }} coordinate q; potential = {source};");
    let mut errors = Errors::default();
    let (_, block) = parse::all(source.parse().unwrap(), &mut errors).unwrap();
    let model = model::resolve(&block, &mut errors);
    assert!(errors.is_empty(), "{:?}", errors.messages());
    tree(model.energies[0].1, point)
}

fn tree(expr: &Expr, point: [f64; 3]) -> f64 {
    match &expr.kind {
        ExprKind::Number(Literal::Exact(value)) => {
            value.numerator() as f64 / value.denominator() as f64
        }
        ExprKind::Name(name) => match name.to_string().as_str() {
            "a" => point[0],
            "b" => point[1],
            "c" => point[2],
            "π" => std::f64::consts::PI,
            other => panic!("{other}"),
        },
        ExprKind::Sum(items) => items
            .iter()
            .map(|(minus, item)| if *minus { -tree(item, point) } else { tree(item, point) })
            .sum(),
        ExprKind::Product(items) => items.iter().fold(1.0, |product, (over, item)| {
            if *over { product / tree(item, point) } else { product * tree(item, point) }
        }),
        ExprKind::Negative(inner) => -tree(inner, point),
        ExprKind::Power(base, exponent) => tree(base, point).powf(tree(exponent, point)),
        ExprKind::Call(name, items) => {
            let x = tree(&items[0], point);
            let name = name.to_string();
            if name == "sqrt" {
                return x.sqrt();
            }
            let function = Function::ALL.iter().find(|function| function.row().name == name);
            function.unwrap_or_else(|| panic!("{name}")).value(x)
        }
        other => panic!("{other:?}"),
    }
}
