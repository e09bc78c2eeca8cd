//! Terms that cancel in printed equations.
//!
//! Equations are derived without expansion, so that a term may occur with opposite signs in two
//! brackets. Computed expressions stay unexpanded. Printed expressions are expanded if this makes
//! them shorter.

use crate::algebra::expr::{Dependencies, Graph, Id, Node};
use crate::algebra::number::Rational;
use crate::algebra::order;
use std::collections::BTreeMap;

/// The largest number of terms of an expansion.
const MOST_TERMS: usize = 100;

/// The highest power of a sum that is expanded.
const MOST_FACTORS: i64 = 3;

/// Products of powers with their coefficients.
type Terms = BTreeMap<Vec<(Id, Rational)>, Rational>;

/// Returns the same value with fewer terms, in a separate graph; `None` if no expression becomes
/// shorter.
///
/// The graph of the system is not changed, and neither is the order in which its sums are computed.
pub(crate) fn shorter(
    graph: &Graph,
    root: Id,
    length: impl Fn(&Graph, Id) -> usize,
) -> Option<(Graph, Id)> {
    let whole = length(graph, root);
    let mut root = root;
    let mut own = order::canonicalize(graph, &mut [&mut root]);
    let nodes = own.reachable(&[root]);
    let mut expansions =
        [false, true].map(|parameters| Expansions { parameters, known: BTreeMap::new() });
    let mut promising = |&id: &Id| {
        let possible = id == root || matches!(own.node(id), Node::Sum(_));
        possible && expansions.iter_mut().any(|expansions| expansions.of(&own, id).is_some())
    };
    if !nodes.iter().any(&mut promising) {
        return None;
    }
    let mut short: BTreeMap<Id, Id> = BTreeMap::new();
    // Children precede their parents.
    for id in nodes {
        let node = own.node(id).clone();
        let same = own.children(id).iter().all(|child| short[child] == *child);
        let mut best = if same { id } else { own.rebuilt(&node, |child| short[&child]) };
        if id == root || matches!(own.node(best), Node::Sum(_)) {
            for expansions in &mut expansions {
                if let Some(terms) = expansions.of(&own, best) {
                    let products: Vec<(Id, Rational)> = terms
                        .iter()
                        .map(|(factors, &coefficient)| {
                            (own.product(Rational::ONE, factors), coefficient)
                        })
                        .collect();
                    let other = own.sum(&products);
                    if length(&own, other) < length(&own, best) {
                        best = other;
                    }
                }
            }
        }
        short.insert(id, best);
    }
    let found = short[&root];
    (length(&own, found) < whole).then_some((own, found))
}

/// The expansions of expressions of one graph computed so far.
struct Expansions {
    /// `true` if sums of parameters are expanded too.
    parameters: bool,
    known: BTreeMap<Id, Option<Expansion>>,
}

/// An expanded expression.
#[derive(Clone)]
struct Expansion {
    terms: Terms,
    /// `true` if two terms had the same factors.
    met: bool,
}

impl Expansions {
    /// Returns the expansion of an expression; `None` if it is too long or if no two terms have the
    /// same factors.
    fn of(&mut self, graph: &Graph, id: Id) -> Option<Terms> {
        self.expand(graph, id).filter(|expansion| expansion.met).map(|expansion| expansion.terms)
    }

    fn expand(&mut self, graph: &Graph, id: Id) -> Option<Expansion> {
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let expansion = self.expand_parts(graph, id);
        self.known.insert(id, expansion.clone());
        expansion
    }

    fn expand_parts(&mut self, graph: &Graph, id: Id) -> Option<Expansion> {
        match graph.node(id) {
            Node::Number(value) => Some(Expansion::one(Vec::new(), *value)),
            Node::Atom(inner) => self.expand(graph, *inner),
            Node::Sum(terms)
                if self.parameters || graph.dependencies(id).any(Dependencies::STATE) =>
            {
                let mut all = Expansion { terms: Terms::new(), met: false };
                for &(term, coefficient) in terms {
                    let part = self.expand(graph, term)?;
                    all.met |= part.met;
                    for (factors, own) in part.terms {
                        all.add(factors, coefficient.mul(own)?)?;
                    }
                }
                Some(all)
            }
            Node::Product(coefficient, factors) => {
                let mut all = Expansion::one(Vec::new(), *coefficient);
                for &(base, exponent) in factors {
                    match exponent.integer() {
                        Some(count @ 1..=MOST_FACTORS) => {
                            let one = self.expand(graph, base)?;
                            for _ in 0..count {
                                all = all.times(&one)?;
                            }
                        }
                        _ => {
                            all =
                                all.times(&Expansion::one(vec![(base, exponent)], Rational::ONE))?;
                        }
                    }
                }
                Some(all)
            }
            _ => Some(Expansion::one(vec![(id, Rational::ONE)], Rational::ONE)),
        }
    }
}

impl Expansion {
    fn one(factors: Vec<(Id, Rational)>, coefficient: Rational) -> Self {
        Self { terms: Terms::from([(factors, coefficient)]), met: false }
    }

    fn add(&mut self, factors: Vec<(Id, Rational)>, coefficient: Rational) -> Option<()> {
        let Some(before) = self.terms.remove(&factors) else {
            self.terms.insert(factors, coefficient);
            return (self.terms.len() <= MOST_TERMS).then_some(());
        };
        self.met = true;
        let sum = before.add(coefficient)?;
        if !sum.is_zero() {
            self.terms.insert(factors, sum);
        }
        Some(())
    }

    fn times(&self, other: &Self) -> Option<Self> {
        let mut all = Self { terms: Terms::new(), met: self.met || other.met };
        for (left, x) in &self.terms {
            for (right, y) in &other.terms {
                let mut powers: BTreeMap<Id, Rational> = left.iter().copied().collect();
                for &(base, exponent) in right {
                    let sum = powers.get(&base).copied().unwrap_or(Rational::ZERO).add(exponent)?;
                    powers.insert(base, sum);
                }
                powers.retain(|_, exponent| !exponent.is_zero());
                all.add(powers.into_iter().collect(), x.mul(*y)?)?;
            }
        }
        Some(all)
    }
}
