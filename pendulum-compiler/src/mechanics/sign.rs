//! Expressions whose sign does not depend on the state. They reveal negative kinetic energies in
//! the mass matrix, and dissipations that would drive the motion.

use crate::algebra::diff::derivative;
use crate::algebra::dimension::Dimension;
use crate::algebra::expr::{Dependencies, Graph, Id, Moment, Node, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::{Literal, Rational};
use crate::mechanics::derivation::Derivation;
use crate::messages::message;
use crate::model::{Element, Meaning, Model, Quantity};
use crate::syntax::ast::{Expr, ExprKind, Role};
use crate::syntax::name;
use crate::syntax::text::text;
use proc_macro2::Ident;
use std::collections::{BTreeMap, BTreeSet};

/// Reports the coordinates whose diagonal entries in the mass matrix are negative at every state.
///
/// A Lagrangian that is not split into energies may have any sign, and so may a parameter that is
/// not a mass.
pub(crate) fn positive(block: &mut Derivation, matrix: &[Vec<Id>]) -> bool {
    let potential = block.energies.potential.unwrap_or_default();
    if block.energies.lagrangian.is_some()
        || block.graph.dependencies(potential).any(Dependencies::VELOCITY)
    {
        return true;
    }
    let diagonal: Vec<Id> = matrix.iter().enumerate().map(|(index, row)| row[index]).collect();
    positive_energy(block, Role::Kinetic, &diagonal)
}

/// Reports the coordinates of which a dissipation is a concave function at every state: it would
/// drive them.
pub(crate) fn dissipates(block: &mut Derivation, dissipation: Id) -> bool {
    let graph = &mut *block.graph;
    let model = block.model;
    let count = model.coordinates[..model.mechanical].iter().map(Quantity::count).sum();
    let curvature = |index| {
        let velocity = Symbol::Velocity(index);
        let slope = derivative(graph, dissipation, velocity);
        derivative(graph, slope, velocity)
    };
    let diagonal: Vec<Id> = (0..count).map(curvature).collect();
    positive_energy(block, Role::Dissipation, &diagonal)
}

/// Reports the coordinates whose second derivatives of an energy by their velocities, `diagonal`,
/// are negative at every state.
fn positive_energy(block: &mut Derivation, role: Role, diagonal: &[Id]) -> bool {
    let Derivation { model, graph, errors, .. } = block;
    let signs = signs(model, graph, diagonal);
    let negative = |coordinate: &&Quantity| {
        diagonal[coordinate.scalars()]
            .iter()
            .any(|&entry| entry != Graph::ZERO && signs[&entry] == Some(Sign::Negative))
    };
    let (energy, otherwise) = if role == Role::Kinetic {
        (
            "kinetic energy",
            "write `lagrangian = …;`, which may have any, instead of `kinetic` and `potential`",
        )
    } else {
        ("dissipation", "write `force`, which may drive a motion")
    };
    let before = errors.len();
    for coordinate in model.coordinates[..model.mechanical].iter().filter(negative) {
        let Some((minus, term)) = negative_term(model, role, &coordinate.name.to_string()) else {
            continue;
        };
        let (name, sign) = (coordinate.name, if minus { "-" } else { "" });
        let message = message!(
            "the {energy} of `{name}` is negative in `{sign}{}`; write it with a positive sign, \
             or {otherwise}",
            text(term)
        );
        // A term that is negative for two coordinates is reported once.
        errors.once(term.source, term.range, message);
    }
    before == errors.len()
}

/// Returns the negative term of an energy that makes the entry of a coordinate negative, and
/// whether it follows a minus sign.
fn negative_term<'a>(model: &Model<'a>, role: Role, coordinate: &str) -> Option<(bool, &'a Expr)> {
    let mut source = Source { model, negative: BTreeMap::new(), followed: BTreeSet::new() };
    let written: Vec<&'a Expr> =
        model.energies.iter().filter(|(own, _)| *own == role).map(|&(_, expr)| expr).collect();
    let mut negative = Vec::new();
    for expr in &written {
        source.negative_terms(false, expr, &mut negative);
    }
    let base = name::read(coordinate).base;
    let whole = written.iter().map(|expr| (false, *expr));
    let all: Vec<(bool, &Expr)> = if negative.is_empty() { whole.collect() } else { negative };
    all.iter().find(|(_, term)| source.mention(term, &base)).or(all.first()).copied()
}

/// The written expressions with the definitions they use; each definition is followed once.
struct Source<'m, 'a> {
    model: &'m Model<'a>,
    /// For each definition, `true` if it begins with a minus sign.
    negative: BTreeMap<usize, bool>,
    /// The definitions visited by the current search.
    followed: BTreeSet<usize>,
}

impl<'a> Source<'_, 'a> {
    /// Returns the definition that an expression refers to.
    fn definition(&self, expr: &Expr) -> Option<usize> {
        match &expr.kind {
            ExprKind::Name(name) | ExprKind::Call(name, _)
                if name::read(&name.to_string()).dots == 0 =>
            {
                self.named(name)
            }
            ExprKind::Index(base, _) => self.definition(base),
            _ => None,
        }
    }

    /// Returns the definition of a name with or without dots.
    fn named(&self, name: &Ident) -> Option<usize> {
        match self.model.names.get(&name::plain(name)) {
            Some(&Meaning::Let(index)) => Some(index),
            _ => None,
        }
    }

    /// Finds the negative terms of an expression where they are written, and whether each of them
    /// follows a minus sign.
    fn negative_terms<'e>(&mut self, minus: bool, expr: &'e Expr, found: &mut Vec<(bool, &'e Expr)>)
    where
        'a: 'e,
    {
        match (&expr.kind, self.definition(expr)) {
            (ExprKind::Sum(terms), _) => {
                for (own, term) in terms {
                    self.negative_terms(minus != *own, term, found);
                }
            }
            (ExprKind::SumOver(_, term), _) if !minus => self.negative_terms(false, term, found),
            // If a definition follows a minus sign, that minus sign is reported and not the
            // definition.
            (_, Some(index)) if !minus => {
                if !self.followed.insert(index) {
                    return;
                }
                self.negative_terms(false, &self.model.lets[index].expr, found);
            }
            _ if minus != self.begins_negative(expr) => found.push((minus, expr)),
            _ => {}
        }
    }

    /// Returns `true` if the factors of an expression have an odd number of minus signs.
    fn begins_negative(&mut self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Negative(inner) => !self.begins_negative(inner),
            ExprKind::Product(factors) => factors
                .iter()
                .fold(false, |negative, (_, factor)| negative != self.begins_negative(factor)),
            ExprKind::SumOver(_, term) => self.begins_negative(term),
            _ => {
                let Some(index) = self.definition(expr) else { return false };
                if let Some(&known) = self.negative.get(&index) {
                    return known;
                }
                self.negative.insert(index, false);
                let negative = self.begins_negative(&self.model.lets[index].expr);
                self.negative.insert(index, negative);
                negative
            }
        }
    }

    /// Returns `true` if an expression, or a definition it uses, contains a name with or without
    /// dots.
    fn mention(&mut self, expr: &Expr, base: &str) -> bool {
        self.followed.clear();
        self.mentions(expr, base)
    }

    fn mentions(&mut self, expr: &Expr, base: &str) -> bool {
        let own = match &expr.kind {
            ExprKind::Name(ident) => name::plain(ident) == base || self.defined_with(ident, base),
            ExprKind::Call(ident, _) => self.defined_with(ident, base),
            _ => false,
        };
        own || expr.parts().into_iter().any(|part| self.mentions(part, base))
    }

    /// Returns `true` if a name refers to a definition that contains the name `base`.
    fn defined_with(&mut self, name: &Ident, base: &str) -> bool {
        match self.named(name).filter(|&index| self.followed.insert(index)) {
            Some(index) => self.mentions(&self.model.lets[index].expr, base),
            None => false,
        }
    }
}

/// A sign that is the same at all states. The value may be zero at some states.
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

/// Returns the signs of all expressions in `roots`; `None` for expressions whose sign may vary.
fn signs(model: &Model, graph: &Graph, roots: &[Id]) -> BTreeMap<Id, Option<Sign>> {
    let mut signs: BTreeMap<Id, Option<Sign>> = BTreeMap::new();
    for id in graph.reachable(roots) {
        let sign = match graph.node(id) {
            Node::Number(value) => Some(Sign::of(*value)),
            Node::Opaque(Literal::Exact(value)) => Some(Sign::of(*value)),
            // A number with too many digits is written without a sign.
            Node::Opaque(Literal::Decimal(_))
            | Node::Pi
            | Node::Symbol(Symbol::Moment(_, Moment::Inertia | Moment::About(_))) => {
                Some(Sign::Positive)
            }
            Node::Symbol(Symbol::Parameter(scalar)) => {
                is_positive(model, *scalar).then_some(Sign::Positive)
            }
            Node::Symbol(_) | Node::Atan2(..) => None,
            Node::Sum(terms) => {
                let mut each = terms
                    .iter()
                    .map(|(term, coefficient)| Some(signs[term]?.times(Sign::of(*coefficient))));
                let first = each.next().flatten();
                first.filter(|_| each.all(|sign| sign == first))
            }
            Node::Product(coefficient, factors) => {
                let odd = |exponent: &Rational| {
                    exponent.numerator() % 2 != 0 && exponent.denominator() % 2 != 0
                };
                // u·sign u is not negative.
                let of_sign = |base: Id| match graph.node(base) {
                    Node::Call(Function::Sign, inner) => Some(*inner),
                    _ => None,
                };
                let has =
                    |wanted: Id| factors.iter().any(|(base, own)| *base == wanted && odd(own));
                let paired = |base: Id| {
                    of_sign(base).is_some_and(has)
                        || factors
                            .iter()
                            .any(|(other, own)| odd(own) && of_sign(*other) == Some(base))
                };
                factors.iter().try_fold(Sign::of(*coefficient), |sign, (base, exponent)| {
                    // Even powers are not negative, and neither are even roots if they are real.
                    let square = !odd(exponent) || paired(*base);
                    Some(if square { sign } else { sign.times(signs[base]?) })
                })
            }
            Node::Call(function, _) => (0.0 <= function.row().range[0]).then_some(Sign::Positive),
            Node::Max(a, b) => {
                [signs[a], signs[b]].contains(&Some(Sign::Positive)).then_some(Sign::Positive)
            }
            Node::Atom(inner) => signs[inner],
        };
        signs.insert(id, sign);
    }
    signs
}

/// Returns `true` if a scalar is a mass, a moment of inertia, a density or an inductance, or the
/// coefficient of a damper or a resistance. A first moment may have any sign.
fn is_positive(model: &Model, scalar: usize) -> bool {
    let own = |quantity: &&Quantity| quantity.scalars().contains(&scalar);
    let one = Rational::ONE;
    let massive = |Dimension([mass, length, others @ ..])| {
        mass == one && length != one && others.iter().all(|exponent| exponent.is_zero())
    };
    let named = |own| {
        massive(own)
            || ["H", "ohm"].into_iter().any(|unit| Dimension::of(unit) == Some(own))
            || [0, 2].into_iter().any(|length| Dimension::whole([1, length, -1, 0, 0]) == own)
    };
    match model.parameters.iter().find(own) {
        Some(quantity) if quantity.is_body() => scalar == quantity.first,
        // The diagonal entries of an inertia come first. The others may have any sign.
        Some(quantity) if quantity.element == Element::Matrix && quantity.first + 3 <= scalar => {
            false
        }
        Some(quantity) => quantity.dimension.is_some_and(named),
        None => false,
    }
}
