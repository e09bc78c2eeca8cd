//! The simplifier: a table of named rules, which are tried whenever a node is made.
//!
//! A row consists of the name of the rule, the pattern, the result and the function that matches
//! the pattern and returns the result. Tests parse the patterns, evaluate both sides at random
//! points and check that the left side is rewritten to the right side. Values at zero and parities
//! are columns of the table of functions.

mod sums;

use self::sums::{
    angle_sum, cosines, hyperbolic_pythagoras, one_and_cosines, one_minus_square, pythagoras,
};
use crate::algebra::expr::{Graph, Id, Node, Terms};
use crate::algebra::functions::{Function, Parity};
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// A rule for one kind of node.
#[cfg_attr(
    not(test),
    allow(dead_code, reason = "name and patterns are for the reader and the tests")
)]
pub(crate) struct Rule {
    pub(crate) name: &'static str,
    pub(crate) left: &'static str,
    pub(crate) right: &'static str,
    apply: Apply,
}

enum Apply {
    Call(Function, fn(&mut Graph, Id) -> Option<Id>),
    Sum(fn(&mut Graph, &Terms) -> Option<Edit>),
    Product(fn(&mut Graph, &Terms) -> Option<Edit>),
}

/// A replacement of terms of a sum or factors of a product.
pub(crate) struct Edit {
    pub(crate) removed: Vec<Id>,
    pub(crate) added: Vec<(Id, Rational)>,
}

#[rustfmt::skip]
pub(crate) const RULES: &[Rule] = &[
    call(Function::Sin,  "sin-quarter",   "sin(a + 3*π/2)",                        "-cos(a)",        |g, u| quarter_turns(g, u, 0)),
    call(Function::Cos,  "cos-quarter",   "cos(a + π/2)",                          "-sin(a)",        |g, u| quarter_turns(g, u, 1)),
    call(Function::Sin,  "sin-asin",      "sin(asin(a/9))",                        "a/9",            |g, u| inverse(g, Function::Asin, u)),
    call(Function::Cos,  "cos-acos",      "cos(acos(a/9))",                        "a/9",            |g, u| inverse(g, Function::Acos, u)),
    call(Function::Tan,  "tan-atan",      "tan(atan(a))",                          "a",              |g, u| inverse(g, Function::Atan, u)),
    call(Function::Exp,  "exp-ln",        "exp(ln(a))",                            "a",              |g, u| inverse(g, Function::Ln, u)),
    call(Function::Ln,   "ln-one",        "ln(1)",                                 "0",              |_, u| (u == Graph::ONE).then_some(Graph::ZERO)),
    call(Function::Ln,   "ln-exp",        "ln(exp(a))",                            "a",              |g, u| inverse(g, Function::Exp, u)),
    call(Function::Abs,  "abs-number",    "abs(-3/2)",                             "3/2",            abs_number),
    call(Function::Abs,  "abs-abs",       "abs(abs(a - 2))",                       "abs(a - 2)",     abs_range),
    call(Function::Abs,  "abs-square",    "abs(a^2)",                              "a^2",            abs_square),
    call(Function::Abs,  "abs-range",     "abs(cosh(a - 2))",                      "cosh(a - 2)",    abs_range),
    call(Function::Sign, "sign-number",   "sign(-3/2)",                            "-1",             sign_number),
    product("abs-even-power",             "abs(a - 2)^2",                          "(a - 2)^2",      abs_even_power),
    product("sign-abs",                   "sign(a - 2)*abs(a - 2)",                "a - 2",          sign_abs),
    product("cosh-divisor",               "b/cosh(a)^3",                           "b*sech(a)^3",    cosh_divisor),
    product("exp-divisor",                "c*exp(a)/(1 + b*exp(a))^2",             "c/((1 + b*exp(a))*(b + 1/exp(a)))", exp_divisor),
    sum("pythagoras",                     "b*sin(a)^2 + b*cos(a)^2",               "b",              pythagoras),
    sum("one-minus-square",               "b - b*cos(a)^2",                        "b*sin(a)^2",     one_minus_square),
    sum("hyperbolic-pythagoras",          "b*cosh(a)^2 - b*sinh(a)^2",             "b",              hyperbolic_pythagoras),
    sum("cos-difference",                 "c*cos(a)*cos(b) + c*sin(a)*sin(b)",     "c*cos(a - b)",   angle_sum),
    sum("cos-sum",                        "cos(a)*cos(b) - sin(a)*sin(b)",         "cos(a + b)",     angle_sum),
    sum("sin-difference",                 "sin(a)*cos(b) - cos(a)*sin(b)",         "sin(a - b)",     angle_sum),
    sum("sin-sum",                        "sin(a)*cos(b) + cos(a)*sin(b)",         "sin(a + b)",     angle_sum),
];

/// Rules that avoid cancellation. If the two terms on the left are nearly equal, their difference
/// loses digits; the product on the right keeps all digits. Such rules cost more operations than
/// they save, so that they are applied only to energies, whose values are output. Equations of
/// motion are derivatives, in which these terms do not cancel.
#[rustfmt::skip]
pub(crate) const CANCELLATIONS: &[Rule] = &[
    sum("one-minus-cos",                  "b - b*cos(a)",                          "2*b*sin(a/2)^2", one_and_cosines),
    sum("one-plus-cos",                   "b + b*cos(a)",                          "2*b*cos(a/2)^2", one_and_cosines),
    sum("cos-minus-cos",                  "c*cos(a) - c*cos(b)",                   "2*c*sin((a + b)/2)*sin((b - a)/2)", cosines),
];

/// Rewrites the differences in `root` that match a rule of `CANCELLATIONS`.
pub(crate) fn without_cancellation(graph: &mut Graph, root: Id) -> Id {
    let mut known: BTreeMap<Id, Id> = BTreeMap::new();
    for id in graph.reachable(&[root]) {
        let node = graph.node(id).clone();
        let mut value = graph.rebuilt(&node, |child| known[&child]);
        // Each rewrite reduces the number of cosines.
        while let Some(next) = rewrite_cancellation(graph, value) {
            value = next;
        }
        known.insert(id, value);
    }
    known[&root]
}

fn rewrite_cancellation(graph: &mut Graph, id: Id) -> Option<Id> {
    let Node::Sum(terms) = graph.node(id).clone() else { return None };
    let terms: Terms = terms.into_iter().collect();
    CANCELLATIONS.iter().find_map(|rule| {
        let Apply::Sum(apply) = rule.apply else { return None };
        let Edit { removed, mut added } = apply(graph, &terms)?;
        added.extend(
            terms
                .iter()
                .filter(|(term, _)| !removed.contains(term))
                .map(|(&term, &coefficient)| (term, coefficient)),
        );
        Some(graph.sum(&added))
    })
}

#[cfg(test)]
thread_local! {
    /// The functions that have simplified a node, for tests.
    static APPLIED: std::cell::RefCell<Vec<usize>> = const { std::cell::RefCell::new(Vec::new()) };
}

#[cfg(test)]
impl Rule {
    /// Returns `true` if `lower` simplifies a node by the function of the rule.
    pub(crate) fn applies(&self, lower: impl FnOnce()) -> bool {
        APPLIED.with_borrow_mut(Vec::clear);
        lower();
        APPLIED.with_borrow(|applied| applied.contains(&self.address()))
    }

    fn address(&self) -> usize {
        match self.apply {
            Apply::Call(_, apply) => apply as usize,
            Apply::Sum(apply) | Apply::Product(apply) => apply as usize,
        }
    }
}

/// Returns `result`, and notes for tests that the rule has one.
fn noted<R>(rule: &Rule, result: Option<R>) -> Option<R> {
    #[cfg(test)]
    if result.is_some() {
        APPLIED.with_borrow_mut(|applied| applied.push(rule.address()));
    }
    let _ = rule;
    result
}

/// Returns the simpler form of a function call, if a rule matches.
pub(crate) fn rewrite_call(graph: &mut Graph, function: Function, argument: Id) -> Option<Id> {
    let row = function.row();
    if let (Graph::ZERO, Some(value)) = (argument, row.at_zero) {
        return Some(graph.number(value));
    }
    if row.parity != Parity::Neither
        && let Some(positive) = opposite(graph, argument)
    {
        let value = graph.call(function, positive);
        return Some(if row.parity == Parity::Odd { graph.negative(value) } else { value });
    }
    RULES.iter().find_map(|rule| match rule.apply {
        Apply::Call(of, apply) if of == function => noted(rule, apply(graph, argument)),
        _ => None,
    })
}

/// Returns the first simplification of a sum by a rule.
pub(crate) fn rewrite_sum(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    if terms.len() < 2 || !terms.keys().any(|&term| graph.angular(term)) {
        return None;
    }
    let mut tried: Vec<fn(&mut Graph, &Terms) -> Option<Edit>> = Vec::new();
    for rule in RULES {
        if let Apply::Sum(apply) = rule.apply
            && !tried.iter().any(|&other| std::ptr::fn_addr_eq(other, apply))
        {
            tried.push(apply);
            if let Some(edit) = noted(rule, apply(graph, terms)) {
                return Some(edit);
            }
        }
    }
    None
}

/// Returns `true` if a product contains the square of a sine or cosine, or two of them: every rule
/// for sums has such a term. To search all terms takes a quarter of an expansion.
pub(crate) fn angular(graph: &Graph, factors: &[(Id, Rational)]) -> bool {
    let mut count = 0;
    for &(base, exponent) in factors {
        if let Node::Call(Function::Sin | Function::Cos | Function::Cosh, _) = graph.node(base)
            && !exponent.is_negative()
        {
            count += 1 + usize::from(exponent != Rational::ONE);
        }
    }
    1 < count
}

/// Returns the first simplification of a product by a rule.
pub(crate) fn rewrite_product(graph: &mut Graph, factors: &Terms) -> Option<Edit> {
    RULES.iter().find_map(|rule| match rule.apply {
        Apply::Product(apply) => noted(rule, apply(graph, factors)),
        _ => None,
    })
}

const fn call(
    function: Function,
    name: &'static str,
    left: &'static str,
    right: &'static str,
    apply: fn(&mut Graph, Id) -> Option<Id>,
) -> Rule {
    Rule { name, left, right, apply: Apply::Call(function, apply) }
}

const fn sum(
    name: &'static str,
    left: &'static str,
    right: &'static str,
    apply: fn(&mut Graph, &Terms) -> Option<Edit>,
) -> Rule {
    Rule { name, left, right, apply: Apply::Sum(apply) }
}

const fn product(
    name: &'static str,
    left: &'static str,
    right: &'static str,
    apply: fn(&mut Graph, &Terms) -> Option<Edit>,
) -> Rule {
    Rule { name, left, right, apply: Apply::Product(apply) }
}

/// Returns `-argument` if the coefficient of the argument is negative.
fn opposite(graph: &mut Graph, argument: Id) -> Option<Id> {
    let (coefficient, _) = graph.split(argument);
    coefficient.is_negative().then(|| graph.negative(argument))
}

/// Applies f(f⁻¹(u)) = u.
fn inverse(graph: &mut Graph, inverse: Function, argument: Id) -> Option<Id> {
    match *graph.node(argument) {
        Node::Call(function, inner) if function == inverse => Some(inner),
        _ => None,
    }
}

/// Rewrites sin(u + kπ/2). `shift` quarter turns are added first, because cos u is sin(u + π/2).
fn quarter_turns(graph: &mut Graph, argument: Id, shift: i64) -> Option<Id> {
    let pi = graph.pi();
    let (scale, bare) = graph.split(argument);
    let (turns, rest) = match graph.node(bare).clone() {
        Node::Pi => (scale, Graph::ZERO),
        Node::Sum(terms) => {
            let &(_, coefficient) = terms.iter().find(|&&(id, _)| id == pi)?;
            let total = coefficient.mul(scale)?;
            let removed = graph.sum(&[(argument, Rational::ONE), (pi, total.negative())]);
            (total, removed)
        }
        _ => return None,
    };
    // Four quarter turns are a full turn. The sum of two remainders cannot overflow.
    let quarters = (turns.mul(Rational::whole(2))?.integer()?.rem_euclid(4) + shift).rem_euclid(4);
    let sin_cos = if quarters % 2 == 0 { Function::Sin } else { Function::Cos };
    let value = graph.call(sin_cos, rest);
    Some(if quarters < 2 { value } else { graph.negative(value) })
}

fn abs_number(graph: &mut Graph, argument: Id) -> Option<Id> {
    match *graph.node(argument) {
        Node::Number(value) => Some(graph.number(value.abs())),
        _ => None,
    }
}

fn sign_number(graph: &mut Graph, argument: Id) -> Option<Id> {
    match *graph.node(argument) {
        Node::Number(value) if !value.is_zero() => {
            Some(graph.whole(if value.is_negative() { -1 } else { 1 }))
        }
        _ => None,
    }
}

/// Applies |f(u)| = f(u) for functions f without negative values.
fn abs_range(graph: &mut Graph, argument: Id) -> Option<Id> {
    match *graph.node(argument) {
        Node::Call(function, _) if 0.0 <= function.row().range[0] => Some(argument),
        _ => None,
    }
}

/// Applies |u²| = u² and |c u²| = |c| u².
fn abs_square(graph: &mut Graph, argument: Id) -> Option<Id> {
    match graph.node(argument) {
        Node::Product(coefficient, factors)
            if factors.iter().all(|(_, exponent)| exponent.is_even()) =>
        {
            let positive = !coefficient.is_negative();
            Some(if positive { argument } else { graph.negative(argument) })
        }
        _ => None,
    }
}

/// Applies |u|² = u².
fn abs_even_power(graph: &mut Graph, factors: &Terms) -> Option<Edit> {
    factors.iter().find_map(|(&id, &exponent)| match *graph.node(id) {
        Node::Call(Function::Abs, inner) if exponent.is_even() => {
            Some(Edit { removed: vec![id], added: vec![(inner, exponent)] })
        }
        _ => None,
    })
}

/// Applies sign(u)·|u| = u.
fn sign_abs(graph: &mut Graph, factors: &Terms) -> Option<Edit> {
    factors.iter().find_map(|(&id, &exponent)| {
        let Node::Call(Function::Sign, inner) = *graph.node(id) else { return None };
        let magnitude = graph.call(Function::Abs, inner);
        if exponent != Rational::ONE || factors.get(&magnitude) != Some(&Rational::ONE) {
            return None;
        }
        Some(Edit { removed: vec![id, magnitude], added: vec![(inner, Rational::ONE)] })
    })
}

/// Applies coshᵐ(u)·sechⁿ(u) = coshᵐ⁻ⁿ(u) or sechⁿ⁻ᵐ(u): a divisor that overflows has derivatives
/// ∞/∞, where those of the hyperbolic secant are zero.
fn cosh_divisor(graph: &mut Graph, factors: &Terms) -> Option<Edit> {
    factors.iter().find_map(|(&cosh, &exponent)| {
        let Node::Call(Function::Cosh, inner) = *graph.node(cosh) else { return None };
        let sech = graph.call(Function::Sech, inner);
        let other = factors.get(&sech).copied();
        if other.is_none() && !exponent.is_negative() {
            return None;
        }
        let left = exponent.add(other.unwrap_or(Rational::ZERO).negative())?;
        let added = if left.is_negative() { (sech, left.negative()) } else { (cosh, left) };
        Some(Edit { removed: vec![cosh, sech], added: vec![added] })
    })
}

/// Applies eᵘ/(1 + eᵘ)² = 1/((1 + eᵘ)(1 + e⁻ᵘ)), where 1 + e⁻ᵘ is the divisor over eᵘ: where the
/// divisor overflows, the derivatives of 1/(1 + eᵘ) are ∞/∞ on the left and zero on the right.
fn exp_divisor(graph: &mut Graph, factors: &Terms) -> Option<Edit> {
    for (&exp, &exponent) in factors {
        let one = if exponent.is_negative() { Rational::MINUS_ONE } else { Rational::ONE };
        if !exponent.is_integer() || !matches!(graph.node(exp), Node::Call(Function::Exp, _)) {
            continue;
        }
        let grows = |graph: &Graph, term: Id| {
            graph.factors(term).iter().any(|&(base, own)| {
                base == exp && own.is_integer() && own.is_negative() == one.is_negative()
            })
        };
        for (&divisor, &power) in factors {
            let Node::Sum(terms) = graph.node(divisor).clone() else { continue };
            let left = power.add(Rational::ONE)?;
            if !left.is_integer()
                || !left.is_negative()
                || !terms.iter().any(|&(term, _)| grows(graph, term))
            {
                continue;
            }
            let mut shares = Vec::new();
            for (term, own) in terms {
                let factors = [(term, Rational::ONE), (exp, one.negative())];
                shares.push((graph.product(Rational::ONE, &factors), own));
            }
            let share = (graph.sum(&shares), Rational::MINUS_ONE);
            let added = vec![(exp, exponent.add(one.negative())?), (divisor, left), share];
            return Some(Edit { removed: vec![exp, divisor], added });
        }
    }
    None
}
