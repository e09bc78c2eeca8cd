//! The simplifier: a table of named rules, which are tried whenever a node is made.
//!
//! A row consists of the name of the rule, the pattern, the result and the function that matches
//! the pattern and returns the result. Tests parse the patterns, evaluate both sides at random
//! points and check that the left side is rewritten to the right side. Values at zero and parities
//! are columns of the table of functions.

use crate::algebra::expr::{Graph, Id, Node, Terms};
use crate::algebra::functions::{Function, Parity};
use crate::algebra::number::Rational;
use std::collections::{BTreeMap, BTreeSet};

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

/// The limit on the factors of a term in which squares and angles are searched. Each pair of them
/// makes a product of the others: in derivatives of a hundred nested sines that would be gigabytes.
const MOST_FACTORS: usize = 24;

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

/// Applies c·r·sin²u + c·r·cos²u = c·r.
fn pythagoras(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
    sum_of_squares(graph, terms, [Function::Sin, Function::Cos], |own| own)
}

/// Applies c·r·cosh²u - c·r·sinh²u = c·r.
fn hyperbolic_pythagoras(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
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
fn one_minus_square(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
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
fn angle_sum(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
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
fn one_and_cosines(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
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
fn cosines(graph: &mut Graph, terms: &Terms) -> Option<Edit> {
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
