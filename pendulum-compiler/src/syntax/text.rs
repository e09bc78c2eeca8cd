//! Expressions as text, for messages and facts.

use crate::algebra::number::Literal;
use crate::syntax::ast::{Expr, ExprKind};

/// Returns the text of a small expression, for messages and facts.
pub(crate) fn text(expr: &Expr) -> String {
    let list = |items: &[Expr]| items.iter().map(text).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        // A literal is a decimal fraction, so that its nearest double is printed as it was written
        // unless it has more digits.
        ExprKind::Number(Literal::Exact(value)) if value.is_integer() => value.to_string(),
        ExprKind::Number(Literal::Exact(value)) => {
            (value.numerator() as f64 / value.denominator() as f64).to_string()
        }
        ExprKind::Number(Literal::Decimal(digits)) => digits.clone(),
        ExprKind::Name(name) => name.to_string(),
        ExprKind::Sum(terms) => joined(terms, " + ", " - ", term),
        ExprKind::Product(factors) => joined(factors, "*", "/", closed),
        ExprKind::Negative(inner) => format!("-{}", closed(inner)),
        ExprKind::Power(base, exponent) => format!("{}^{}", operand(base), closed(exponent)),
        ExprKind::Call(name, items) => format!("{name}({})", list(items)),
        ExprKind::Index(base, index) => format!("{}[{}]", operand(base), text(index)),
        ExprKind::Component(base, component) => format!("{}.{component}", operand(base)),
        ExprKind::Vector(items) => format!("[{}]", list(items)),
        ExprKind::Magnitude(inner) => format!("|{}|", text(inner)),
        ExprKind::SumOver(binder, term) => format!("sum({} in …, {})", binder.name, text(term)),
        ExprKind::ProductOver(binder, factor) => {
            format!("product({} in …, {})", binder.name, text(factor))
        }
        ExprKind::Integral { point, body, .. } => format!("integral({point} in {body}, …)"),
        ExprKind::Reaction(name, index, friction) => {
            let index = index.as_ref().map_or_else(String::new, |own| format!("[{}]", text(own)));
            format!("reaction({name}{index}{})", if *friction { ", friction" } else { "" })
        }
    }
}

fn joined(
    items: &[(bool, Expr)],
    plus: &str,
    minus: &str,
    part: impl Fn(&Expr) -> String,
) -> String {
    let mut result = String::new();
    for (index, (negative, item)) in items.iter().enumerate() {
        if 0 < index {
            result.push_str(if *negative { minus } else { plus });
        }
        let first = index == 0 && matches!(item.kind, ExprKind::Negative(_));
        result.push_str(&if first { text(item) } else { part(item) });
    }
    result
}

/// Returns the text of a term.
pub(crate) fn term(expr: &Expr) -> String {
    match expr.kind {
        ExprKind::Product(ref factors) if !matches!(factors[0].1.kind, ExprKind::Negative(_)) => {
            text(expr)
        }
        _ => closed(expr),
    }
}

/// Returns the text of an expression that is followed by a power, an index or a component.
pub(crate) fn operand(expr: &Expr) -> String {
    match expr.kind {
        ExprKind::Power(..) => format!("({})", text(expr)),
        _ => closed(expr),
    }
}

/// Returns the text of a factor or an exponent.
pub(super) fn closed(expr: &Expr) -> String {
    match expr.kind {
        ExprKind::Sum(_) | ExprKind::Product(_) | ExprKind::Negative(_) => {
            format!("({})", text(expr))
        }
        _ => text(expr),
    }
}
