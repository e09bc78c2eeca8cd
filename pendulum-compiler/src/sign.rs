//! Expressions whose sign does not depend on the state: a kinetic energy that is negative shows in its mass matrix.

use crate::ast::{Expr, ExprKind, Role};
use crate::check::{Model, Quantity, text};
use crate::error::Errors;
use crate::expr::{Contents, Function, Graph, Id, Moment, Node, Symbol};
use crate::lower::Energies;
use crate::name;
use crate::number::Rational;
use crate::unit::Dimension;
use std::collections::BTreeMap;

/// Reports the coordinates whose entries on the diagonal of the mass matrix are negative at every state.
///
/// A Lagrangian that is not split may have any sign, and so may a parameter that is no mass.
pub(crate) fn positive(model: &Model, graph: &Graph, energies: &Energies, matrix: &[Vec<Id>], errors: &mut Errors) -> bool {
    let potential = energies.potential.unwrap_or_default();
    if energies.lagrangian.is_some() || graph.contents(potential).any(Contents::VELOCITY) {
        return true;
    }
    let diagonal: Vec<Id> = matrix.iter().enumerate().map(|(index, row)| row[index]).collect();
    let signs = signs(model, graph, &diagonal);
    let negative = |coordinate: &&Quantity| {
        let rows = coordinate.first..coordinate.first + coordinate.count();
        diagonal[rows].iter().any(|entry| signs[entry] == Some(Sign::Negative))
    };
    let before = errors.len();
    for coordinate in model.coordinates.iter().filter(negative) {
        let Some((minus, term)) = guilty(model, &coordinate.name.to_string()) else { continue };
        let (sign, name) = (if minus { "-" } else { "" }, coordinate.name);
        let message =
            format!("the kinetic energy of `{name}` is negative in `{sign}{}`; write it with a positive sign", text(term));
        // A term that is negative for two coordinates is wrong once.
        errors.once(term.source, term.range, message);
    }
    before == errors.len()
}

/// The negative term of the kinetic energy that is guilty of a coordinate, and whether a minus stands before it.
fn guilty<'a>(model: &Model<'a>, coordinate: &str) -> Option<(bool, &'a Expr)> {
    let kinetic = model.energies.iter().filter(|(role, _)| *role == Role::Kinetic);
    let terms = kinetic.clone().flat_map(|&(_, expr)| match &expr.kind {
        ExprKind::Sum(terms) => terms.iter().map(|(minus, term)| (*minus, term)).collect(),
        _ => vec![(false, expr)],
    });
    let negative: Vec<(bool, &Expr)> = terms.filter(|(minus, term)| *minus != begins_negative(term)).collect();
    let base = name::read(coordinate).base;
    let own = negative.iter().find(|(_, term)| mentions(term, &base));
    own.or(negative.first()).copied().or_else(|| kinetic.map(|&(_, expr)| (false, expr)).next())
}

/// Whether an odd number of signs stands before the factors of an expression.
fn begins_negative(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Negative(inner) => !begins_negative(inner),
        ExprKind::Product(factors) => factors.iter().fold(false, |negative, (_, factor)| negative != begins_negative(factor)),
        _ => false,
    }
}

/// Whether a name stands in an expression, with or without dots.
fn mentions(expr: &Expr, base: &str) -> bool {
    let mentions = |expr: &Expr| mentions(expr, base);
    match &expr.kind {
        ExprKind::Number(_) => false,
        ExprKind::Name(ident) => name::read(&ident.to_string()).base == base,
        ExprKind::Sum(items) | ExprKind::Product(items) => items.iter().any(|(_, item)| mentions(item)),
        ExprKind::Negative(a) | ExprKind::Magnitude(a) | ExprKind::Component(a, _) => mentions(a),
        ExprKind::Power(a, b) | ExprKind::Index(a, b) => mentions(a) || mentions(b),
        ExprKind::Call(_, items) | ExprKind::Vector(items) => items.iter().any(mentions),
        ExprKind::SumOver(_, term) => mentions(term),
        ExprKind::Integral { integrand, .. } => mentions(integrand),
    }
}

/// A sign that no state changes; what has one may be zero at some states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Positive,
    Negative,
}

impl Sign {
    fn of(value: Rational) -> Self {
        if value.is_negative() { Self::Negative } else { Self::Positive }
    }

    fn times(self, other: Self) -> Self {
        if self == other { Self::Positive } else { Self::Negative }
    }
}

/// The signs of all expressions that stand in `roots`; `None` for those that may have either.
fn signs(model: &Model, graph: &Graph, roots: &[Id]) -> BTreeMap<Id, Option<Sign>> {
    let mut signs: BTreeMap<Id, Option<Sign>> = BTreeMap::new();
    for id in graph.reachable(roots) {
        let sign = match graph.node(id) {
            Node::Number(value) => Some(Sign::of(*value)),
            // A number is written without a sign.
            Node::Opaque(_) | Node::Pi | Node::Symbol(Symbol::Moment(_, Moment::Inertia)) => Some(Sign::Positive),
            Node::Symbol(Symbol::Parameter(scalar)) => is_mass(model, *scalar).then_some(Sign::Positive),
            Node::Symbol(_) | Node::Atan2(..) => None,
            Node::Sum(terms) => {
                let mut each = terms.iter().map(|(term, coefficient)| Some(signs[term]?.times(Sign::of(*coefficient))));
                let first = each.next().flatten();
                first.filter(|_| each.all(|sign| sign == first))
            }
            Node::Product(coefficient, factors) => {
                factors.iter().try_fold(Sign::of(*coefficient), |sign, (base, exponent)| {
                    // An even power, and a root where it is real.
                    let square = exponent.numerator() % 2 == 0 || exponent.denominator() % 2 == 0;
                    Some(if square { sign } else { sign.times(signs[base]?) })
                })
            }
            Node::Call(Function::Exp | Function::Cosh | Function::Abs | Function::Step, _) => Some(Sign::Positive),
            Node::Call(..) => None,
            Node::Max(a, b) => [signs[a], signs[b]].contains(&Some(Sign::Positive)).then_some(Sign::Positive),
            Node::Atom(inner) => signs[inner],
        };
        signs.insert(id, sign);
    }
    signs
}

/// Whether a scalar is a mass, a moment of inertia or a density; a first moment may have any sign.
fn is_mass(model: &Model, scalar: usize) -> bool {
    let own = |quantity: &&Quantity| (quantity.first..quantity.first + quantity.count()).contains(&scalar);
    let one = Rational::ONE;
    let massive = |Dimension([mass, length, time])| mass == one && time.is_zero() && length != one;
    match model.parameters.iter().find(own) {
        Some(quantity) if quantity.body => scalar == quantity.first,
        Some(quantity) => quantity.dimension.is_some_and(massive),
        None => false,
    }
}
