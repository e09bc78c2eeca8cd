//! Value numbering: replaces expressions of equal value but different form by a single expression.
//!
//! Hashing finds expressions of equal form. Expressions of equal value but different form, such as
//! (a + b)(a − b) and a² − b², have the same residues at random points of a prime field (Gulwani
//! and Necula 2003). The cheapest form replaces all others, up to sign. Roots are treated as
//! unknown functions here, because a root in the field has no sign.

use crate::algebra::expr::{Graph, Id, Node};
use crate::algebra::number::Rational;
use crate::algebra::prime_field::{Point, Residue};
use crate::algebra::velocity_polynomial;
use std::collections::BTreeMap;

/// The number of points at which values are compared.
const POINTS: usize = 2;

/// The largest number of nodes in a program that is numbered.
const LIMIT: usize = 20_000;

/// The cheapest form of each value up to sign, and whether this form is the negative.
type Best = BTreeMap<Vec<Residue>, (Id, bool)>;

/// Returns `roots` with each set of equal expressions replaced by its cheapest form.
pub(crate) fn numbered(graph: &mut Graph, roots: &[Id]) -> Vec<Id> {
    let nodes = graph.reachable(roots);
    if LIMIT < nodes.len() {
        return roots.to_vec();
    }
    let points = (0..64).filter_map(|seed| Point::formal(graph, roots, seed).values(graph, roots));
    let points: Vec<_> = points.take(POINTS).collect();
    if points.len() < POINTS {
        return roots.to_vec();
    }
    let mut constants: BTreeMap<Id, Rational> = BTreeMap::new();
    let mut forms: BTreeMap<Vec<Residue>, Vec<(Id, bool)>> = BTreeMap::new();
    let mut keys: BTreeMap<Id, (Vec<Residue>, bool)> = BTreeMap::new();
    for &id in &nodes {
        // A closed expression has the same value as its child.
        if matches!(graph.node(id), Node::Atom(_)) {
            continue;
        }
        let values: Vec<Residue> = points.iter().map(|values| values[&id]).collect();
        if let Some(constant) = constant(&values) {
            constants.insert(id, constant);
            continue;
        }
        let opposite: Vec<Residue> = values.iter().map(|value| value.negative()).collect();
        let flipped = opposite < values;
        let key = if flipped { opposite } else { values };
        forms.entry(key.clone()).or_default().push((id, flipped));
        keys.insert(id, (key, flipped));
    }
    let unique = forms.len() == keys.len();
    // A form never contains itself, because its parts are older and do not cost more.
    let cheapest = |forms: Vec<(Id, bool)>| {
        let costs = |&(id, _): &(Id, bool)| (velocity_polynomial::cost(graph, id), id);
        if let [only] = forms[..] { Some(only) } else { forms.into_iter().min_by_key(costs) }
    };
    let best: Best =
        forms.into_iter().filter_map(|(key, forms)| Some((key, cheapest(forms)?))).collect();
    let plain = constants.keys().all(|&id| matches!(graph.node(id), Node::Number(_)));
    if unique && plain {
        return roots.to_vec();
    }
    let mut known: BTreeMap<Id, Id> =
        constants.into_iter().map(|(id, value)| (id, graph.number(value))).collect();
    roots.iter().map(|&root| rebuilt(graph, root, &best, &keys, &mut known)).collect()
}

/// Returns the value of an expression that is the same small rational at all points.
fn constant(values: &[Residue]) -> Option<Rational> {
    let (first, others) = values.split_first()?;
    if others.iter().all(|other| other == first) { first.rational() } else { None }
}

/// Rebuilds an expression from the cheapest forms of its parts.
fn rebuilt(
    graph: &mut Graph,
    root: Id,
    best: &Best,
    keys: &BTreeMap<Id, (Vec<Residue>, bool)>,
    known: &mut BTreeMap<Id, Id>,
) -> Id {
    let form = |id: Id| match keys.get(&id) {
        Some((key, flipped)) => (best[key].0, best[key].1 != *flipped),
        None => (id, false),
    };
    let mut pending = vec![root];
    while let Some(&id) = pending.last() {
        let (chosen, flipped) = form(id);
        let missing: Vec<Id> =
            graph.children(chosen).into_iter().filter(|child| !known.contains_key(child)).collect();
        if !known.contains_key(&id) && missing.is_empty() {
            let node = graph.node(chosen).clone();
            let value = graph.rebuilt(&node, |child| known[&child]);
            let value = if flipped { graph.scale(Rational::MINUS_ONE, value) } else { value };
            known.insert(id, value);
        }
        if known.contains_key(&id) {
            pending.pop();
        }
        pending.extend(missing);
    }
    known[&root]
}

#[cfg(test)]
mod tests {
    use super::numbered;
    use crate::algebra::expr::{Graph, Id, Node};
    use crate::tests::lowered;

    /// Numbers an expression; returns the graph, the new root and the number of calls in it.
    fn calls(expression: &str) -> (Graph, Id, usize) {
        let mut graph = Graph::new();
        let root = lowered(&mut graph, expression);
        let root = numbered(&mut graph, &[root])[0];
        let count = graph
            .reachable(&[root])
            .into_iter()
            .filter(|&id| matches!(graph.node(id), Node::Call(..)))
            .count();
        (graph, root, count)
    }

    #[test]
    fn equal_values_become_one_expression() {
        assert_eq!(calls("exp(a^2 - b^2)*a + b*exp((a - b)*(a + b))").2, 1);
        assert_eq!(calls("tan(a/(a*b + b) + c) - tan(c + 1/(b + b/a))").1, Graph::ZERO);
        assert_eq!(calls("atan(sin(a + b)) + c*atan(sin(a)*cos(b) + cos(a)*sin(b))").2, 2);
    }

    #[test]
    fn opposite_values_become_one_expression() {
        assert_eq!(calls("exp((a + b)*(a - b)) + exp(c)*exp(-b^2 + a^2)").2, 2);
        let (graph, root, _) = calls("atan(c)*((a - b)*(a + b)*c + b^2*c - a^2*c + exp(b))");
        assert!(!graph.symbols(&[root]).contains(&crate::algebra::expr::Symbol::Parameter(0)));
    }

    #[test]
    fn constants_in_disguise_are_numbers() {
        let (graph, root, _) = calls("(a + b)^2/(a^2 + 2*a*b + b^2)");
        assert!(matches!(graph.node(root), Node::Number(_)));
    }

    #[test]
    fn roots_keep_their_sign() {
        let (_, root, _) = calls("sqrt(a^2 - 2*a + 1) - (a - 1)");
        assert_ne!(root, Graph::ZERO);
        let (_, root, _) = calls("sqrt(a)*sqrt(b) - sqrt(a*b)");
        assert_ne!(root, Graph::ZERO);
    }
}
