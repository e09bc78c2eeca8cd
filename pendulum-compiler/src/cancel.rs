//! Terms that cancel in what is printed.
//!
//! Equations are derived without expanding anything, so that a term may stand in one bracket with a plus and in another with a
//! minus. What is computed stays so; what is printed is expanded where that makes it shorter.

use crate::expr::{Contents, Graph, Id, Node};
use crate::number::Rational;
use std::collections::BTreeMap;

/// An expansion of more terms is given up.
const MOST_TERMS: usize = 100;

/// A power of a sum beyond this one is not expanded.
const MOST_FACTORS: i64 = 3;

/// Products of powers with their coefficients.
type Terms = BTreeMap<Vec<(Id, Rational)>, Rational>;

/// The same value with fewer terms, in a graph of its own; `None` if nothing gets shorter.
///
/// The graph of the system stays as it is, and with it the order in which sums are computed.
pub(crate) fn shorter(graph: &Graph, root: Id, length: impl Fn(&Graph, Id) -> usize) -> Option<(Graph, Id)> {
    let sums: Vec<Id> = graph.reachable(&[root]).into_iter().filter(|&id| matches!(graph.node(id), Node::Sum(_))).collect();
    let promising = |&id: &Id| [false, true].into_iter().any(|parameters| Expansion::of(graph, id, parameters).is_some());
    if !sums.iter().any(promising) && Expansion::of(graph, root, false).is_none() {
        return None;
    }
    let mut own = graph.clone();
    let mut short: BTreeMap<Id, Id> = BTreeMap::new();
    // Children come first.
    for id in graph.reachable(&[root]) {
        let node = graph.node(id).clone();
        let same = graph.children(id).iter().all(|child| short[child] == *child);
        let mut best = if same { id } else { own.rebuilt(&node, |child| short[&child]) };
        if id == root || matches!(own.node(best), Node::Sum(_)) {
            for parameters in [false, true] {
                if let Some(terms) = Expansion::of(&own, best, parameters) {
                    let products: Vec<(Id, Rational)> =
                        terms.iter().map(|(factors, &coefficient)| (own.product(Rational::ONE, factors), coefficient)).collect();
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
    (length(&own, found) < length(graph, root)).then_some((own, found))
}

/// An expansion under construction.
struct Expansion<'a> {
    graph: &'a Graph,
    /// Whether sums of parameters alone are expanded too.
    parameters: bool,
    /// Whether two terms have met.
    met: bool,
}

impl<'a> Expansion<'a> {
    /// The expansion of an expression; `None` if it is too long or no two of its terms meet.
    fn of(graph: &'a Graph, id: Id, parameters: bool) -> Option<Terms> {
        let mut expansion = Self { graph, parameters, met: false };
        let terms = expansion.expand(id)?;
        expansion.met.then_some(terms)
    }

    fn expand(&mut self, id: Id) -> Option<Terms> {
        match self.graph.node(id) {
            Node::Number(value) => Some(Terms::from([(Vec::new(), *value)])),
            Node::Atom(inner) => self.expand(*inner),
            Node::Sum(terms) if self.parameters || self.graph.contents(id).any(Contents::STATE) => {
                let mut all = Terms::new();
                for &(term, coefficient) in terms {
                    for (factors, own) in self.expand(term)? {
                        self.add(&mut all, factors, coefficient.mul(own)?)?;
                    }
                }
                Some(all)
            }
            Node::Product(coefficient, factors) => {
                let mut all = Terms::from([(Vec::new(), *coefficient)]);
                for &(base, exponent) in factors {
                    match exponent.integer() {
                        Some(count @ 1..=MOST_FACTORS) => {
                            let one = self.expand(base)?;
                            for _ in 0..count {
                                all = self.multiplied(&all, &one)?;
                            }
                        }
                        _ => all = self.multiplied(&all, &Terms::from([(vec![(base, exponent)], Rational::ONE)]))?,
                    }
                }
                Some(all)
            }
            _ => Some(Terms::from([(vec![(id, Rational::ONE)], Rational::ONE)])),
        }
    }

    fn add(&mut self, all: &mut Terms, factors: Vec<(Id, Rational)>, coefficient: Rational) -> Option<()> {
        let Some(before) = all.remove(&factors) else {
            all.insert(factors, coefficient);
            return (all.len() <= MOST_TERMS).then_some(());
        };
        self.met = true;
        let sum = before.add(coefficient)?;
        if !sum.is_zero() {
            all.insert(factors, sum);
        }
        Some(())
    }

    fn multiplied(&mut self, a: &Terms, b: &Terms) -> Option<Terms> {
        let mut all = Terms::new();
        for (left, x) in a {
            for (right, y) in b {
                let mut powers: BTreeMap<Id, Rational> = left.iter().copied().collect();
                for &(base, exponent) in right {
                    let sum = powers.get(&base).copied().unwrap_or(Rational::ZERO).add(exponent)?;
                    powers.insert(base, sum);
                }
                powers.retain(|_, exponent| !exponent.is_zero());
                self.add(&mut all, powers.into_iter().collect(), x.mul(*y)?)?;
            }
        }
        Some(all)
    }
}
