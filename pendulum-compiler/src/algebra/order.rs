//! Canonical order: expressions are rebuilt so that the result does not depend on how they were
//! written.
//!
//! Ids grow in order of creation, and sums and products are sorted by id. The graph is rebuilt from
//! its leaves upwards, and each level is sorted by its contents. Equal systems thereby get equal
//! graphs, with the same operations in the same order, whatever notation they were written in.

use crate::algebra::expr::{Dependencies, Graph, Id, Node};
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// Rebuilds `roots` in a new graph.
pub(crate) fn canonicalize(old: &Graph, roots: &mut [&mut Id]) -> Graph {
    let reachable = old.reachable(&roots.iter().map(|id| **id).collect::<Vec<Id>>());
    let mut heights: BTreeMap<Id, usize> = BTreeMap::new();
    let mut levels: Vec<Vec<Id>> = Vec::new();
    for id in reachable {
        let height = old.children(id).iter().map(|child| heights[child] + 1).max().unwrap_or(0);
        heights.insert(id, height);
        if levels.len() <= height {
            levels.resize(height + 1, Vec::new());
        }
        levels[height].push(id);
    }
    let mut graph = Graph::new();
    let mut known: BTreeMap<Id, Id> = BTreeMap::new();
    for level in levels {
        let mut keyed: Vec<(Key, Id)> =
            level.into_iter().map(|id| (key(old, id, &mut graph, &known), id)).collect();
        keyed.sort();
        for (_, id) in keyed {
            let new = graph.rebuilt(old.node(id), |child| known[&child]);
            known.insert(id, new);
        }
    }
    for root in roots {
        **root = known[&**root];
    }
    graph
}

/// The sort key of a node within its level: dependencies, then the kind of node, then its parts up
/// to sign.
type Key = (u8, Node, Vec<(Id, Rational)>);

fn key(old: &Graph, id: Id, graph: &mut Graph, known: &BTreeMap<Id, Id>) -> Key {
    let dependencies = old.dependencies(id);
    let rank =
        [Dependencies::VELOCITY, Dependencies::COORDINATE, Dependencies::INPUT, Dependencies::TIME];
    let rank = rank
        .into_iter()
        .position(|kind| dependencies.any(kind))
        .map_or(0, |place| 4 - u8::try_from(place).unwrap_or(0));
    let mut bare = |id: Id| graph.split(known[&id]);
    let (shape, mut parts) = match old.node(id) {
        Node::Sum(terms) => {
            let part = |&(term, coefficient): &(Id, Rational)| {
                let (own, term) = bare(term);
                (term, own.mul(coefficient).unwrap_or(coefficient))
            };
            (Node::Sum(Vec::new()), terms.iter().map(part).collect::<Vec<_>>())
        }
        Node::Product(coefficient, factors) => {
            let parts = factors.iter().map(|&(base, exponent)| (bare(base).1, exponent)).collect();
            (Node::Product(coefficient.abs(), Vec::new()), parts)
        }
        node => {
            let parts = node.children().map(|child| (bare(child).1, Rational::ONE)).collect();
            let shape = match node {
                Node::Call(function, _) => Node::Call(*function, Graph::ZERO),
                Node::Atan2(..) => Node::Atan2(Graph::ZERO, Graph::ZERO),
                Node::Max(..) => Node::Max(Graph::ZERO, Graph::ZERO),
                Node::Atom(_) => Node::Atom(Graph::ZERO),
                leaf => leaf.clone(),
            };
            (shape, parts)
        }
    };
    if matches!(shape, Node::Sum(_)) {
        parts.sort_unstable();
        if parts.first().is_some_and(|(_, coefficient)| coefficient.is_negative()) {
            for (_, coefficient) in &mut parts {
                *coefficient = coefficient.negative();
            }
        }
    }
    if matches!(shape, Node::Product(..)) {
        parts.sort_unstable();
    }
    (rank, shape, parts)
}
