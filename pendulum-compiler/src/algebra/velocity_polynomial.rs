//! A Lagrangian as a polynomial in the velocities.
//!
//! As it is written, the kinetic energy is a sum of squares of Cartesian velocities. After its
//! terms are collected by powers of the velocities, each coefficient is simplified separately
//! (sin² + cos², cos a cos b + sin a sin b, equal masses), and the equations of motion resemble
//! those derived by hand.

use crate::algebra::expr::{Dependencies, Graph, Id, Node};
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// Powers of the variables, sorted.
pub(crate) type Monomial = Vec<(Id, i64)>;

/// The terms of the coefficient of each monomial.
pub(crate) type Polynomial = BTreeMap<Monomial, Vec<(Id, Rational)>>;

/// The limit on the number of terms; larger expressions stay unchanged.
const LIMIT: usize = 100_000;

/// Velocities of coordinates, of positions and of driven inputs.
const MOVING: Dependencies = Dependencies::VELOCITY
    .or(Dependencies::AUXILIARY)
    .or(Dependencies::VELOCITY_INPUT)
    .or(Dependencies::ACCELERATION_INPUT);

/// Collects `id` by powers of its velocities (of coordinates and driven inputs); returns `None` if
/// it is not a polynomial in them.
pub(crate) fn by_velocities(graph: &mut Graph, id: Id) -> Option<Id> {
    let polynomial = polynomial(graph, id, MOVING)?;
    let mut terms = Vec::new();
    for (monomial, coefficient) in polynomial {
        let coefficient = simplest(graph, &coefficient);
        let mut factors: Vec<(Id, Rational)> =
            monomial.iter().map(|&(base, power)| (base, Rational::whole(power))).collect();
        factors.push((coefficient, Rational::ONE));
        terms.push((graph.product(Rational::ONE, &factors), Rational::ONE));
    }
    Some(graph.sum(&terms))
}

/// Returns the same, or the expression itself.
pub(crate) fn collected(graph: &mut Graph, id: Id) -> Id {
    by_velocities(graph, id).unwrap_or(id)
}

/// Returns an expression as a polynomial in all symbols of the kinds in `variables`. Polynomials
/// are computed from those of the children.
pub(crate) fn polynomial(
    graph: &mut Graph,
    root: Id,
    variables: Dependencies,
) -> Option<Polynomial> {
    let mut moving = graph.reachable(&[root]);
    moving.retain(|&id| graph.dependencies(id).any(variables));
    // A root of a long polynomial is found before the polynomial is multiplied out.
    if !moving.iter().all(|&id| keeps_polynomials(graph, id, variables)) {
        return None;
    }
    let mut known: BTreeMap<Id, Polynomial> = BTreeMap::new();
    for id in moving {
        let value = match graph.node(id).clone() {
            Node::Symbol(_) => {
                Polynomial::from([(vec![(id, 1)], vec![(Graph::ONE, Rational::ONE)])])
            }
            Node::Sum(terms) => {
                let mut sum = Polynomial::new();
                for (term, coefficient) in terms {
                    match known.get(&term) {
                        None => sum.entry(Vec::new()).or_default().push((term, coefficient)),
                        Some(part) => {
                            for (monomial, list) in part {
                                let entry = sum.entry(monomial.clone()).or_default();
                                for &(own, factor) in list {
                                    entry.push((own, factor.mul(coefficient)?));
                                }
                            }
                        }
                    }
                }
                sum
            }
            Node::Product(coefficient, factors) => {
                let mut product = Polynomial::from([(Vec::new(), vec![(Graph::ONE, coefficient)])]);
                let mut fixed = Vec::new();
                for (base, exponent) in factors {
                    match known.get(&base) {
                        None => fixed.push((base, exponent)),
                        Some(part) => {
                            for _ in 0..exponent.integer()? {
                                product = multiply(graph, &product, part)?;
                            }
                        }
                    }
                }
                let fixed = graph.product(Rational::ONE, &fixed);
                let constant = Polynomial::from([(Vec::new(), vec![(fixed, Rational::ONE)])]);
                multiply(graph, &product, &constant)?
            }
            Node::Atom(inner) => known.get(&inner)?.clone(),
            _ => return None,
        };
        if graph.spent() || LIMIT < value.values().map(Vec::len).sum() {
            return None;
        }
        known.insert(id, value);
    }
    match known.remove(&root) {
        Some(polynomial) => Some(polynomial),
        None => Some(Polynomial::from([(Vec::new(), vec![(root, Rational::ONE)])])),
    }
}

/// Returns the number of products of coefficients from which an expression is collected by
/// velocities; zero if it stays unchanged.
pub(crate) fn products(graph: &Graph, root: Id) -> usize {
    let mut known: BTreeMap<Id, usize> = BTreeMap::new();
    for id in graph.reachable(&[root]) {
        if !graph.dependencies(id).any(MOVING) {
            continue;
        }
        if !keeps_polynomials(graph, id, MOVING) {
            return 0;
        }
        let of = |id: &Id| known.get(id).copied().unwrap_or(1);
        let count = match graph.node(id) {
            Node::Sum(terms) => {
                terms.iter().fold(0, |sum: usize, (term, _)| sum.saturating_add(of(term)))
            }
            Node::Product(_, factors) => {
                let (mut count, mut degree) = (1_usize, 0);
                for (base, exponent) in factors {
                    let power = if known.contains_key(base) { exponent.integer() } else { None };
                    for _ in 0..power.unwrap_or(0) {
                        count = count.saturating_mul(of(base));
                        degree += 1;
                    }
                }
                if LIMIT < count && 1 < degree {
                    return 0;
                }
                count
            }
            Node::Atom(inner) => of(inner),
            _ => 1,
        };
        known.insert(id, count);
    }
    known.get(&root).copied().unwrap_or(0)
}

/// Returns `true` if an expression is a polynomial if all of its children are.
fn keeps_polynomials(graph: &Graph, id: Id, variables: Dependencies) -> bool {
    match graph.node(id) {
        Node::Symbol(_) | Node::Sum(_) | Node::Atom(_) => true,
        Node::Product(_, factors) => factors.iter().all(|&(base, exponent)| {
            !graph.dependencies(base).any(variables)
                || exponent.integer().is_some_and(|count| (1..=8).contains(&count))
        }),
        _ => false,
    }
}

fn multiply(graph: &mut Graph, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
    let size = |polynomial: &Polynomial| polynomial.values().map(Vec::len).sum::<usize>();
    if LIMIT < size(a).saturating_mul(size(b)) {
        return None;
    }
    let mut product = Polynomial::new();
    for (left, left_terms) in a {
        for (right, right_terms) in b {
            let mut powers: BTreeMap<Id, i64> = left.iter().copied().collect();
            for &(base, power) in right {
                *powers.entry(base).or_default() += power;
            }
            let entry = product.entry(powers.into_iter().collect()).or_default();
            for &(x, p) in left_terms {
                for &(y, q) in right_terms {
                    entry.push((graph.mul(x, y), p.mul(q)?));
                }
            }
        }
    }
    Some(product)
}

/// Returns a coefficient as given or multiplied out, whichever is cheaper.
pub(crate) fn simplest(graph: &mut Graph, terms: &[(Id, Rational)]) -> Id {
    let plain = graph.sum(terms);
    let mut flat = Vec::new();
    for &(term, coefficient) in terms {
        match expand(graph, term) {
            Some(parts) => {
                for (part, own) in parts {
                    match own.mul(coefficient) {
                        Some(own) => flat.push((part, own)),
                        None => return plain,
                    }
                }
            }
            None => return plain,
        }
    }
    if flat.len() == terms.len() {
        // No term contains a sum.
        return plain;
    }
    let flat = graph.sum(&flat);
    if cost(graph, flat) < cost(graph, plain) { flat } else { plain }
}

/// Returns an expression multiplied out, or the expression itself if the result would be too long.
pub(crate) fn expanded(graph: &mut Graph, id: Id) -> Id {
    match expand(graph, id) {
        Some(terms) => graph.sum(&terms),
        None => id,
    }
}

/// Multiplies out a product of sums until no sum remains as a factor. Returns `None` if the result
/// would be too long.
fn expand(graph: &mut Graph, term: Id) -> Option<Vec<(Id, Rational)>> {
    let mut open = vec![(term, Rational::ONE)];
    let mut done = Vec::new();
    while let Some((term, outer)) = open.pop() {
        let (own, bare) = graph.split(term);
        let outer = outer.mul(own)?;
        let sum =
            graph.factors(bare).into_iter().find_map(|(base, exponent)| match graph.node(base) {
                Node::Sum(terms) if exponent.is_integer() && !exponent.is_negative() => {
                    Some((base, terms.clone()))
                }
                _ => None,
            });
        let Some((base, terms)) = sum else {
            done.push((bare, outer));
            continue;
        };
        if 256 < open.len() + done.len() + terms.len() {
            return None;
        }
        for (part, coefficient) in terms {
            let factors =
                [(bare, Rational::ONE), (base, Rational::MINUS_ONE), (part, Rational::ONE)];
            open.push((graph.product(Rational::ONE, &factors), outer.mul(coefficient)?));
        }
    }
    Some(done)
}

/// Estimates the number of operations of an expression. Shared nodes are counted once.
pub(crate) fn cost(graph: &Graph, root: Id) -> usize {
    let price = |id: Id| match graph.node(id) {
        Node::Number(_) | Node::Opaque(_) | Node::Pi | Node::Symbol(_) | Node::Atom(_) => 0,
        Node::Sum(terms) => {
            terms.len() - 1
                + terms.iter().filter(|(_, coefficient)| coefficient.abs() != Rational::ONE).count()
        }
        Node::Product(coefficient, factors) => {
            let powers: usize = factors
                .iter()
                .map(|(_, exponent)| match exponent.integer() {
                    Some(1) => 1,
                    Some(power) if 0 < power => power.unsigned_abs().ilog2() as usize + 2,
                    Some(_) => 8,
                    None => 16,
                })
                .sum();
            powers - 1 + usize::from(coefficient.abs() != Rational::ONE)
        }
        Node::Call(..) | Node::Atan2(..) | Node::Max(..) => 20,
    };
    graph.reachable(&[root]).into_iter().map(price).sum()
}
