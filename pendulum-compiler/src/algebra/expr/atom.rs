//! Atoms: expressions closed to rewriting, on which elimination works.

use super::{Dependencies, Graph, Id, Node};
use crate::algebra::number::Rational;

impl Graph {
    /// Closes the sums of an expression to rewriting: no other sum takes their terms in. Products
    /// stay open, so that their factors cancel, and so do sums of parameters, which cost nothing.
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

    /// Closes any expression that is not a leaf: it is computed once and used as it is.
    pub(crate) fn closed(&mut self, id: Id) -> Id {
        match self.node(id) {
            Node::Sum(_) | Node::Product(..) => self.intern(Node::Atom(id)),
            _ => id,
        }
    }
}
