//! Expressions as text, for messages and facts.

use crate::ast::{Expr, ExprKind, Literal};

/// The text of a small expression, for messages and facts.
pub(crate) fn text(expr: &Expr) -> String {
    let list = |items: &[Expr]| items.iter().map(text).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        // A literal is a decimal fraction, so that its nearest double prints as it was written.
        ExprKind::Number(Literal::Exact(value)) => (value.numerator() as f64 / value.denominator() as f64).to_string(),
        ExprKind::Number(Literal::Decimal(digits)) => digits.clone(),
        ExprKind::Name(name) => name.to_string(),
        ExprKind::Sum(terms) => joined(terms, " + ", " - "),
        ExprKind::Product(factors) => joined(factors, "*", "/"),
        ExprKind::Negative(inner) => format!("-{}", closed(inner)),
        ExprKind::Power(base, exponent) => format!("{}^{}", closed(base), closed(exponent)),
        ExprKind::Call(name, items) => format!("{name}({})", list(items)),
        ExprKind::Index(base, index) => format!("{}[{}]", text(base), text(index)),
        ExprKind::Component(base, component) => format!("{}.{component}", text(base)),
        ExprKind::Vector(items) => format!("[{}]", list(items)),
        ExprKind::Magnitude(inner) => format!("|{}|", text(inner)),
        ExprKind::SumOver(binder, term) => format!("sum({} in …, {})", binder.name, text(term)),
        ExprKind::Integral { point, body, .. } => format!("integral({point} in {body}, …)"),
    }
}

fn joined(items: &[(bool, Expr)], plus: &str, minus: &str) -> String {
    let mut result = String::new();
    for (index, (negative, item)) in items.iter().enumerate() {
        if 0 < index {
            result.push_str(if *negative { minus } else { plus });
        }
        let first = index == 0 && matches!(item.kind, ExprKind::Negative(_));
        result.push_str(&if first { text(item) } else { closed(item) });
    }
    result
}

fn closed(expr: &Expr) -> String {
    match expr.kind {
        ExprKind::Sum(_) | ExprKind::Product(_) | ExprKind::Negative(_) => format!("({})", text(expr)),
        _ => text(expr),
    }
}
