//! Atoms: expressions that are excluded from rewriting. Elimination works on them.

use super::{Dependencies, Graph, Id, Node};
use crate::algebra::number::Rational;

impl Graph {
    /// Makes atoms of the sums in an expression, so that no other sum absorbs their terms. Products
    /// stay open so that their factors cancel. Sums of parameters stay open too, because they are
    /// computed only once.
    pub(crate) fn atom(&mut self, id: Id) -> Id {
        let (coefficient, bare) = self.split(id);
        match self.node(bare).clone() {
            Node::Sum(_) if self.dependencies(bare).any(Dependencies::STATE) => {
                let atom = self.intern(Node::Atom(bare));
                self.scale(coefficient, atom)
            }
            Node::Product(_, factors) => {
                let close = |graph: &mut Self, id: Id| {
                    let moving = graph.dependencies(id).any(Dependencies::STATE);
                    if moving && matches!(graph.node(id), Node::Sum(_)) {
                        graph.intern(Node::Atom(id))
                    } else {
                        id
                    }
                };
                let closed: Vec<(Id, Rational)> = factors
                    .into_iter()
                    .map(|(base, exponent)| (close(self, base), exponent))
                    .collect();
                self.product(coefficient, &closed)
            }
            _ => id,
        }
    }

    /// Returns an atom of a sum.
    pub(crate) fn atom_of(&mut self, terms: &[(Id, Rational)]) -> Id {
        let sum = self.sum(terms);
        self.atom(sum)
    }

    /// Makes an atom of a sum or a product; returns any other expression unchanged.
    pub(crate) fn closed(&mut self, id: Id) -> Id {
        match self.node(id) {
            Node::Sum(_) | Node::Product(..) => self.intern(Node::Atom(id)),
            _ => id,
        }
    }
}
