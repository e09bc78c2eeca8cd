//! The functions of the rules for sums: squares, addition theorems and differences of cosines.

use super::Edit;
use crate::algebra::expr::{Graph, Id, Node, Terms};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
use std::collections::BTreeSet;

/// The limit on the factors of a term in which squares and angles are searched. Each pair of them
/// makes a product of the others: in derivatives of a hundred nested sines that would be gigabytes.
const MOST_FACTORS: usize = 24;

/// Applies c·r·sin²u + c·r·cos²u = c·r.
pub(super) fn pythagoras(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    sum_of_squares(graph, terms, [Function::Sin, Function::Cos], |own| own)
}

/// Applies c·r·cosh²u - c·r·sinh²u = c·r.
pub(super) fn hyperbolic_pythagoras(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    sum_of_squares(graph, terms, [Function::Cosh, Function::Sinh], Rational::negative)
}

/// Applies c·r·f²u ± c·r·g²u = c·r.
fn sum_of_squares(
    graph: &mut Graph,
    terms: &Terms,
    [f, g]: [Function; 2],
    sign: fn(Rational) -> Rational,
) -> Option<Edit> {
    terms.iter().find_map(|(&term, &coefficient)| {
        squares(graph, term, f).into_iter().find_map(|(argument, rest)| {
            let partner = with_square(graph, rest, g, argument);
            (terms.get(&partner) == Some(&sign(coefficient)))
                .then(|| Edit { removed: vec![term, partner], added: vec![(rest, coefficient)] })
        })
    })
}

/// Returns r·f²u.
fn with_square(graph: &mut Graph, rest: Id, function: Function, argument: Id) -> Id {
    let value = graph.call(function, argument);
    graph.product(Rational::ONE, &[(rest, Rational::ONE), (value, Rational::whole(2))])
}

/// Applies c·r - c·r·cos²u = c·r·sin²u, and the same with sine and cosine exchanged.
pub(super) fn one_minus_square(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    terms.iter().find_map(|(&term, &coefficient)| {
        [(Function::Cos, Function::Sin), (Function::Sin, Function::Cos)].into_iter().find_map(
            |(from, to)| {
                squares(graph, term, from).into_iter().find_map(|(argument, rest)| {
                    if terms.get(&rest) != Some(&coefficient.negative()) {
                        return None;
                    }
                    let square = with_square(graph, rest, to, argument);
                    Some(Edit {
                        removed: vec![term, rest],
                        added: vec![(square, coefficient.negative())],
                    })
                })
            },
        )
    })
}

/// Returns the arguments of `function` squared in `term`, each with the term divided by that
/// square.
fn squares(graph: &mut Graph, term: Id, function: Function) -> Vec<(Id, Id)> {
    let mut found = Vec::new();
    let factors = graph.factors(term);
    if MOST_FACTORS < factors.len() {
        return found;
    }
    for (base, exponent) in factors {
        if let Node::Call(of, argument) = *graph.node(base)
            && of == function
            && exponent.integer().is_some_and(|exponent| 2 <= exponent)
        {
            found.push((
                argument,
                graph.product(Rational::ONE, &[(term, Rational::ONE), (base, Rational::whole(-2))]),
            ));
        }
    }
    found
}

/// Applies the four addition theorems from right to left.
pub(super) fn angle_sum(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    let mut signatures: Option<BTreeSet<u64>> = None;
    terms.iter().find_map(|(&term, &coefficient)| {
        let trig: Vec<(Id, Function, Id)> = graph
            .factors(term)
            .into_iter()
            .filter(|(_, exponent)| exponent.is_integer() && !exponent.is_negative())
            .filter_map(|(base, _)| match *graph.node(base) {
                Node::Call(function @ (Function::Sin | Function::Cos), argument) => {
                    Some((base, function, argument))
                }
                _ => None,
            })
            .collect();
        if trig.len() < 2 || MOST_FACTORS < trig.len() {
            return None;
        }
        let partners: Vec<Id> =
            trig.iter().map(|&(_, function, a)| graph.call(other(function), a)).collect();
        let signatures = signatures.get_or_insert_with(|| {
            terms.keys().map(|&term| signature(&graph.factors(term))).collect()
        });
        let own = signature(&graph.factors(term));
        // The change of the signature if a factor is exchanged.
        let change = |index: usize| {
            let pair = [(partners[index], Rational::ONE), (trig[index].0, Rational::MINUS_ONE)];
            signature(&pair)
        };
        let changes: Vec<u64> = (0..trig.len()).map(change).collect();
        let called: Vec<bool> =
            partners.iter().map(|&id| matches!(graph.node(id), Node::Call(..))).collect();
        for (index, &(left, f, a)) in trig.iter().enumerate() {
            for (next, &(right, g, b)) in trig.iter().enumerate().skip(index + 1) {
                // Most partners are no terms. To make the products of all pairs takes seconds.
                let partner = own.wrapping_add(changes[index]).wrapping_add(changes[next]);
                let excluded = called[index] && called[next] && !signatures.contains(&partner);
                if a == b || excluded {
                    continue;
                }
                let over = [
                    (term, Rational::ONE),
                    (left, Rational::MINUS_ONE),
                    (right, Rational::MINUS_ONE),
                ];
                let rest = graph.product(Rational::ONE, &over);
                let partner = [rest, partners[index], partners[next]].map(|id| (id, Rational::ONE));
                let partner = graph.product(Rational::ONE, &partner);
                let Some(&second) = terms.get(&partner) else { continue };
                let same = second == coefficient;
                if !same && second != coefficient.negative() {
                    continue;
                }
                // sin a cos b ± cos a sin b and cos a cos b ± sin a sin b: the coefficient is that
                // of the first product.
                let (function, angle, sign) = match (f, g) {
                    (Function::Cos, Function::Cos) if same => {
                        (Function::Cos, graph.sub(a, b), coefficient)
                    }
                    (Function::Cos, Function::Cos) => (Function::Cos, graph.add(a, b), coefficient),
                    (Function::Sin, Function::Sin) if same => {
                        (Function::Cos, graph.sub(a, b), coefficient)
                    }
                    (Function::Sin, Function::Sin) => (Function::Cos, graph.add(a, b), second),
                    (_, _) if same => (Function::Sin, graph.add(a, b), coefficient),
                    (Function::Sin, _) => (Function::Sin, graph.sub(a, b), coefficient),
                    (_, _) => (Function::Sin, graph.sub(b, a), coefficient),
                };
                let value = graph.call(function, angle);
                let value = graph.mul(rest, value);
                return Some(Edit { removed: vec![term, partner], added: vec![(value, sign)] });
            }
        }
        None
    })
}

/// Returns a sum over factors, each mixed and times its exponent: a change of a factor changes it by
/// the difference. Equal products have equal signatures, and others almost never.
fn signature(factors: &[(Id, Rational)]) -> u64 {
    factors.iter().fold(0, |sum: u64, &(base, exponent)| {
        let mixed = (base.index() as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let times = exponent.numerator() as u64;
        sum.wrapping_add((mixed ^ mixed >> 32).wrapping_mul(times))
    })
}

/// Returns the terms r·cos u of a sum: r, the term, its coefficient and u.
fn cosine_terms(graph: &mut Graph, terms: &Terms) -> Vec<(Id, Id, Rational, Id)> {
    let mut found = Vec::new();
    for (&term, &coefficient) in terms {
        let cosine =
            graph.factors(term).into_iter().find_map(|(base, exponent)| match *graph.node(base) {
                Node::Call(Function::Cos, argument) if exponent == Rational::ONE => {
                    Some((base, argument))
                }
                _ => None,
            });
        if let Some((base, argument)) = cosine {
            let rest =
                graph.product(Rational::ONE, &[(term, Rational::ONE), (base, Rational::MINUS_ONE)]);
            found.push((rest, term, coefficient, argument));
        }
    }
    found
}

/// Applies r - r·cos u = 2r·sin²(u/2) and r + r·cos u = 2r·cos²(u/2). The magnitudes of the
/// coefficients of all cosines of r must add up to that of r.
pub(super) fn one_and_cosines(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    let cosines = cosine_terms(graph, terms);
    let half = Rational::new(1, 2)?;
    terms.iter().find_map(|(&rest, &whole)| {
        let own: Vec<&(Id, Id, Rational, Id)> =
            cosines.iter().filter(|(other, ..)| *other == rest).collect();
        let used = own
            .iter()
            .try_fold(Rational::ZERO, |sum, (_, _, coefficient, _)| sum.add(coefficient.abs()))?;
        if own.is_empty() || used != whole.abs() {
            return None;
        }
        let (mut removed, mut added) = (vec![rest], Vec::new());
        for &&(_, term, coefficient, argument) in &own {
            let same = coefficient.is_negative() == whole.is_negative();
            let angle = graph.scale(half, argument);
            let function = if same { Function::Cos } else { Function::Sin };
            let square = with_square(graph, rest, function, angle);
            let twice =
                coefficient.abs().mul(Rational::whole(if whole.is_negative() { -2 } else { 2 }))?;
            removed.push(term);
            added.push((square, twice));
        }
        Some(Edit { removed, added })
    })
}

/// Applies r·cos a - r·cos b = 2r·sin((a + b)/2)·sin((b - a)/2).
pub(super) fn cosines(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    let cosines = cosine_terms(graph, terms);
    let half = Rational::new(1, 2)?;
    for (index, &(rest, first, coefficient, a)) in cosines.iter().enumerate() {
        for &(other, second, opposite, b) in &cosines[index + 1..] {
            if other != rest || opposite != coefficient.negative() {
                continue;
            }
            let (sum, difference) = (graph.add(a, b), graph.sub(b, a));
            let factors = [sum, difference].map(|angle| {
                let angle = graph.scale(half, angle);
                (graph.call(Function::Sin, angle), Rational::ONE)
            });
            let value =
                graph.product(Rational::ONE, &[(rest, Rational::ONE), factors[0], factors[1]]);
            return Some(Edit {
                removed: vec![first, second],
                added: vec![(value, coefficient.mul(Rational::whole(2))?)],
            });
        }
    }
    None
}

fn other(function: Function) -> Function {
    if function == Function::Sin { Function::Cos } else { Function::Sin }
}
