//! The numbers of tables.

use super::resolved::Table;
use super::unit;
use crate::algebra::functions::GIVEN;
use crate::algebra::number::{Literal, Rational};
use crate::algebra::spline::Spline;
use crate::messages::{Errors, message};
use crate::syntax::ast::{self, Expr, ExprKind, Kind};
use crate::syntax::text::text;
use proc_macro2::Ident;
use std::collections::BTreeMap;

/// The largest number of points. Evaluations in lanes compare the argument with all of them.
const MOST_POINTS: usize = 256;

/// Declares the table of a statement, with its spline, which is empty after a mistake; or that of a
/// parameter, without a statement. Returns its index.
pub(super) fn table<'a>(
    tables: &mut BTreeMap<u8, Table<'a>>,
    name: &'a Ident,
    kinds: &'a [Kind; 2],
    statement: Option<&'a ast::Table>,
    errors: &mut Errors,
) -> u8 {
    let dimensions = kinds.each_ref().map(|kind| match kind {
        Kind::Scalar(Some(unit)) => unit::dimension(unit, errors),
        _ => None,
    });
    let written = statement.map(|own| (own, spline(own, errors).unwrap_or_default()));
    let places = if written.is_some() { 0..GIVEN } else { GIVEN..u8::MAX };
    let free = places.clone().find(|index| !tables.contains_key(index));
    if free.is_none() {
        let message = message!("more than {} tables; join some of them", places.len());
        errors.at(name.span(), message);
    }
    let index = free.unwrap_or(places.start);
    tables.insert(index, Table { name, dimensions, written });
    index
}

fn spline(statement: &ast::Table, errors: &mut Errors) -> Option<Spline> {
    let ast::Table { name, points, range, linear, .. } = statement;
    let count = points.len();
    if count < 2 {
        let message = message!("a table has two points at least; write `[(0, 0), (1, 2)]`");
        errors.at(*range, message);
        return None;
    }
    if MOST_POINTS < count {
        let message = message!(
            "a table has at most {MOST_POINTS} points, and {count} stand here; leave some out, or give a function of time as a `driven` input with a `Curve` for its motion"
        );
        errors.at(*range, message);
        return None;
    }
    let mut valid = true;
    let numbers = points.iter().map(|point| {
        point.each_ref().map(|expr| {
            number(expr).unwrap_or_else(|| {
                let message = message!(
                    "`{}` is no number; the points of a table are numbers in its units",
                    text(expr)
                );
                errors.at(expr.range, message);
                valid = false;
                0.0
            })
        })
    });
    let numbers: Vec<[f64; 2]> = numbers.collect();
    if !valid {
        return None;
    }
    if let Some(k) = (1..count).find(|&k| numbers[k][0] <= numbers[k - 1][0]) {
        let [before, own] = [k - 1, k].map(|k| &points[k][0]);
        let message = message!(
            "the points of a table stand in ascending order; `{}` is not greater than `{}` before \
             it",
            text(own),
            text(before)
        );
        errors.at(own.range, message);
        return None;
    }
    let spline = Spline::natural(&numbers, *linear);
    let pieces = &spline.rows[1..count];
    if !pieces.iter().flatten().all(|coefficient| coefficient.is_finite()) {
        let message =
            message!("the spline of `{name}` is beyond the range of `f64`; choose other units");
        errors.at(*range, message);
        return None;
    }
    Some(spline)
}

/// Returns the value of an expression of numbers, if it is finite.
fn number(expr: &Expr) -> Option<f64> {
    let nearest = |number: Rational| number.numerator() as f64 / number.denominator() as f64;
    let value = match &expr.kind {
        ExprKind::Number(Literal::Decimal(digits)) => digits.parse().ok(),
        ExprKind::Negative(inner) => number(inner).map(|value| -value),
        _ => unit::constant(expr).map(nearest),
    };
    value.filter(|value| value.is_finite())
}
