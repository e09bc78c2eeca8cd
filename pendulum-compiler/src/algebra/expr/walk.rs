//! Traversal of the graph: children, reachable nodes, nodes rebuilt with other children, and
//! properties of whole expressions.

use super::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::Kinks;
use crate::algebra::number::Rational;
use std::collections::BTreeSet;

impl Graph {
    /// Returns a node of the same kind whose children are replaced by `child`.
    pub(crate) fn rebuilt(&mut self, node: &Node, child: impl Fn(Id) -> Id) -> Id {
        let list = |items: &[(Id, Rational)]| {
            items.iter().map(|&(id, number)| (child(id), number)).collect::<Vec<_>>()
        };
        match node {
            Node::Number(_) | Node::Opaque(_) | Node::Pi | Node::Symbol(_) => {
                self.intern(node.clone())
            }
            Node::Sum(terms) => self.sum(&list(terms)),
            Node::Product(coefficient, factors) => self.product(*coefficient, &list(factors)),
            Node::Call(function, argument) => self.call(*function, child(*argument)),
            Node::Atan2(y, x) => self.atan2(child(*y), child(*x)),
            Node::Max(a, b) => self.max(child(*a), child(*b)),
            Node::Atom(inner) => {
                let inner = child(*inner);
                let (_, bare) = self.split(inner);
                if matches!(self.node(bare), Node::Sum(_)) {
                    self.atom(inner)
                } else {
                    self.closed(inner)
                }
            }
        }
    }

    /// Returns the direct operands of a node.
    pub(crate) fn children(&self, id: Id) -> Vec<Id> {
        self.node(id).children().collect()
    }

    /// Returns all nodes that `roots` contain, children before parents.
    pub(crate) fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        let last = roots.iter().map(|id| id.index()).max().unwrap_or(0);
        // A bit for each node: few nodes of a large graph are found without a visit to the others.
        let mut found = vec![0u64; last / 64 + 1];
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            let (word, bit) = (id.index() / 64, 1 << (id.index() % 64));
            if found[word] & bit == 0 {
                found[word] |= bit;
                pending.extend(self.node(id).children());
            }
        }
        let mut all = Vec::new();
        for (word, mut bits) in (0..).zip(found) {
            while bits != 0 {
                all.push(Id(64 * word + bits.trailing_zeros()));
                bits &= bits - 1;
            }
        }
        all
    }

    /// Returns `true` if no function with a corner or a jump has an argument that depends on more
    /// than parameters.
    pub(crate) fn smooth(&self, roots: &[Id]) -> bool {
        let cornered = |&id: &Id| match self.node(id) {
            Node::Max(..) => true,
            Node::Call(function, _) => function.row().kinks != Kinks::Smooth,
            _ => false,
        };
        !self
            .reachable(roots)
            .iter()
            .filter(|id| cornered(id))
            .any(|&id| self.dependencies(id).any(Dependencies::STATE))
    }

    /// Returns `true` if an expression contains a function that jumps and whose argument depends on
    /// one of these kinds of symbols. The derivative of such a function is zero and hides this
    /// dependence.
    pub(crate) fn jumps(&self, id: Id, kinds: Dependencies) -> bool {
        let jumps = |&id: &Id| match self.node(id) {
            Node::Call(function, _) => {
                function.row().kinks == Kinks::Jump && self.dependencies(id).any(kinds)
            }
            _ => false,
        };
        self.dependencies(id).any(kinds) && self.reachable(&[id]).iter().any(jumps)
    }

    /// Returns `true` if every root is a linear combination of coordinates and velocities, with
    /// coefficients that depend only on parameters, plus terms that contain neither.
    pub(crate) fn linear(&self, roots: &[Id]) -> bool {
        let moving = Dependencies::COORDINATE
            .or(Dependencies::VELOCITY)
            .or(Dependencies::MOMENTUM)
            .or(Dependencies::AUXILIARY);
        let mut linear = vec![false; roots.iter().map(|id| id.index() + 1).max().unwrap_or(0)];
        for id in self.reachable(roots) {
            linear[id.index()] = !self.dependencies(id).any(moving)
                || match self.node(id) {
                    Node::Symbol(_) => true,
                    Node::Sum(terms) => terms.iter().all(|(term, _)| linear[term.index()]),
                    Node::Product(_, factors) => {
                        let mut changing = factors.iter().filter(|(factor, _)| {
                            self.dependencies(*factor).any(Dependencies::STATE)
                        });
                        let only = changing.next().is_some_and(|(factor, power)| {
                            *power == Rational::ONE && linear[factor.index()]
                        });
                        only && changing.next().is_none()
                    }
                    Node::Atom(inner) => linear[inner.index()],
                    _ => false,
                };
        }
        roots.iter().all(|root| linear[root.index()])
    }

    /// Returns the symbols in `roots`.
    pub(crate) fn symbols(&self, roots: &[Id]) -> BTreeSet<Symbol> {
        let symbol = |id: Id| match self.node(id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        };
        self.reachable(roots).into_iter().filter_map(symbol).collect()
    }
}
