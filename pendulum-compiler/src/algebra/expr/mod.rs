//! The hash-consed expression graph: equal expressions are one node, numbers are exact.
//!
//! Sums and products are flat and sorted. A sum is primitive: its numeric content and the factors
//! common to all its terms are factored out, so that `a*b + a*c` and `a*(b + c)` are one node.
//! Children are always older than their parents, so that ascending ids are a topological order.

mod atom;
mod call;
mod dependencies;
mod node;
mod product;
pub(crate) mod rule;
mod sum;
mod walk;

use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
pub(crate) use dependencies::Dependencies;
pub(crate) use node::{Id, Moment, Node, Symbol};
use std::collections::{BTreeMap, HashMap};
use std::hash::{BuildHasher, BuildHasherDefault, Hash, Hasher};
use std::rc::Rc;

/// The terms of a sum under construction.
pub(crate) type Terms = BTreeMap<Id, Rational>;

/// A hasher without random keys, which multiplies the words of a key. Maps with this hasher are used
/// for look-ups only and are never iterated, so that their order has no effect. That of `std` takes
/// a tenth of an expansion, because macros run without optimization.
#[derive(Clone, Debug, Default)]
struct WordHasher(u64);

impl Hasher for WordHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_u64(&mut self, word: u64) {
        // The odd number is 2⁶⁴ over the golden ratio. Its product mixes upwards, the shift downwards.
        let product = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = product ^ product >> 32;
    }

    fn write_i128(&mut self, word: i128) {
        self.write_u64(word as u64);
        self.write_u64((word >> 64) as u64);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }
}

type Words = BuildHasherDefault<WordHasher>;

/// Returns a number that is, in practice, unique to a symbol or a function, and the same in every
/// expansion.
pub(super) fn hash(value: &impl Hash) -> u64 {
    // Zeros alone leave the state of the hasher at zero: without the word before it, the second
    // parameter would have the number of the time.
    Words::default().hash_one((1u64, value))
}

/// All expressions of a block.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    nodes: Vec<Rc<Node>>,
    /// The number of operands in all sums and products.
    size: usize,
    /// The number of operands that sums and products have gone through, and the limit on it.
    work: usize,
    most_work: usize,
    dependencies: Vec<Dependencies>,
    /// For each node, a bit for the residue of each of its symbols.
    residues: Vec<u64>,
    /// For each node, `true` if it is a product with a factor that rules for sums search.
    angular: Vec<bool>,
    ids: HashMap<Rc<Node>, Id, Words>,
    /// The derivatives computed so far.
    derivatives: HashMap<(Symbol, Id), Id, Words>,
}

impl Graph {
    pub(crate) const ZERO: Id = Id(0);
    pub(crate) const ONE: Id = Id(1);

    pub(crate) fn new() -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            size: 0,
            work: 0,
            most_work: usize::MAX,
            dependencies: Vec::new(),
            residues: Vec::new(),
            angular: Vec::new(),
            ids: HashMap::default(),
            derivatives: HashMap::default(),
        };
        graph.intern(Node::Number(Rational::ZERO));
        graph.intern(Node::Number(Rational::ONE));
        graph
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    /// Returns the number of operands in all sums and products made so far.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// Limits the operands that sums and products may go through from now on. Beyond the limit all
    /// of them are zero, so that whoever sets it asks [`Graph::spent`] before using a result.
    pub(crate) fn limit_work(&mut self, operands: usize) {
        self.most_work = self.work.saturating_add(operands);
    }

    /// Returns `true` if the limit on operands has been exceeded.
    pub(crate) fn spent(&self) -> bool {
        self.most_work < self.work
    }

    pub(crate) fn dependencies(&self, id: Id) -> Dependencies {
        self.dependencies[id.index()]
    }

    /// Returns `true` for a product to which a rule for sums may apply.
    pub(crate) fn angular(&self, id: Id) -> bool {
        self.angular[id.index()]
    }

    pub(crate) fn number(&mut self, value: Rational) -> Id {
        self.intern(Node::Number(value))
    }

    pub(crate) fn whole(&mut self, value: i64) -> Id {
        self.number(Rational::whole(value))
    }

    pub(crate) fn literal(&mut self, literal: &Literal) -> Id {
        match literal {
            Literal::Exact(value) => self.number(*value),
            Literal::Decimal(_) => self.intern(Node::Opaque(literal.clone())),
        }
    }

    pub(crate) fn pi(&mut self) -> Id {
        self.intern(Node::Pi)
    }

    pub(crate) fn symbol(&mut self, symbol: Symbol) -> Id {
        self.intern(Node::Symbol(symbol))
    }

    /// Returns `a + b`.
    pub(crate) fn add(&mut self, a: Id, b: Id) -> Id {
        self.sum(&[(a, Rational::ONE), (b, Rational::ONE)])
    }

    /// Returns `a - b`.
    pub(crate) fn sub(&mut self, a: Id, b: Id) -> Id {
        self.sum(&[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    /// Returns the sum of some expressions.
    pub(crate) fn total(&mut self, terms: impl IntoIterator<Item = Id>) -> Id {
        let terms: Vec<_> = terms.into_iter().map(|term| (term, Rational::ONE)).collect();
        self.sum(&terms)
    }

    /// Returns Σ aₖ bₖ.
    pub(crate) fn inner(&mut self, a: &[Id], b: &[Id]) -> Id {
        let products: Vec<Id> = a.iter().zip(b).map(|(&a, &b)| self.mul(a, b)).collect();
        self.total(products)
    }

    pub(crate) fn negative(&mut self, a: Id) -> Id {
        self.scale(Rational::MINUS_ONE, a)
    }

    pub(crate) fn scale(&mut self, coefficient: Rational, a: Id) -> Id {
        if coefficient == Rational::ONE {
            return a;
        }
        self.product(coefficient, &[(a, Rational::ONE)])
    }

    /// Returns `a * b`.
    pub(crate) fn mul(&mut self, a: Id, b: Id) -> Id {
        // Products of polynomials contain many ones.
        match (a, b) {
            (Self::ONE, other) | (other, Self::ONE) => return other,
            (Self::ZERO, _) | (_, Self::ZERO) => return Self::ZERO,
            _ => {}
        }
        self.product(Rational::ONE, &[(a, Rational::ONE), (b, Rational::ONE)])
    }

    /// Returns `a / b`.
    pub(crate) fn div(&mut self, a: Id, b: Id) -> Id {
        self.product(Rational::ONE, &[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    pub(crate) fn power(&mut self, a: Id, exponent: Rational) -> Id {
        self.product(Rational::ONE, &[(a, exponent)])
    }

    pub(crate) fn sqrt(&mut self, a: Id) -> Id {
        self.power(a, Rational::HALF)
    }

    /// Returns the derivative of a node if it is in the cache or zero.
    pub(crate) fn cached_derivative(&self, symbol: Symbol, id: Id) -> Option<Id> {
        // An expression without symbols of this kind has the derivative zero, and so have most of
        // the others in a sum over a large family: without their residues, each would be visited
        // for each member.
        let may_contain = self.residues[id.index()] & residue(symbol) != 0;
        if may_contain && self.dependencies(id).any(Dependencies::of(symbol)) {
            self.derivatives.get(&(symbol, id)).copied()
        } else {
            Some(Self::ZERO)
        }
    }

    /// Stores a derivative in the cache.
    pub(crate) fn cache_derivative(&mut self, symbol: Symbol, id: Id, derivative: Id) {
        self.derivatives.insert((symbol, id), derivative);
    }

    fn intern(&mut self, node: Node) -> Id {
        if let Some(&id) = self.ids.get(&node) {
            return id;
        }
        let id = Id(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX));
        let (dependencies, residues) = match &node {
            Node::Symbol(symbol) => (Dependencies::of(*symbol), residue(*symbol)),
            Node::Call(function, argument) if function.is_given() => {
                let own = self.dependencies(*argument).or(Dependencies::PARAMETER);
                (own, self.residues[argument.index()])
            }
            _ => node.children().fold((Dependencies::default(), 0), |(all, residues), child| {
                let own = self.residues[child.index()];
                (all.or(self.dependencies(child)), residues | own)
            }),
        };
        if let Node::Sum(list) | Node::Product(_, list) = &node {
            self.size += list.len();
        }
        let angular = match &node {
            Node::Product(_, factors) => rule::angular(self, factors),
            _ => false,
        };
        let node = Rc::new(node);
        self.angular.push(angular);
        self.nodes.push(Rc::clone(&node));
        self.dependencies.push(dependencies);
        self.residues.push(residues);
        self.ids.insert(node, id);
        id
    }
}

/// Returns a bit for the index of a symbol modulo 64. Symbols that others contain have all bits.
fn residue(symbol: Symbol) -> u64 {
    match symbol {
        Symbol::Parameter(index)
        | Symbol::Coordinate(index)
        | Symbol::Velocity(index)
        | Symbol::Acceleration(index)
        | Symbol::Multiplier(index)
        | Symbol::Contact(index)
        | Symbol::Friction(index)
        | Symbol::Target(index)
        | Symbol::Momentum(index)
        | Symbol::Auxiliary(index)
        | Symbol::Position(index) => 1 << (index % 64),
        _ => u64::MAX,
    }
}

impl Default for Id {
    fn default() -> Self {
        Graph::ZERO
    }
}
