//! The hash-consed expression graph: equal expressions are one node, numbers are exact.
//!
//! Sums and products are flat and sorted. A sum is primitive: its numeric content and the factors common to all its terms stand
//! before it, so that `a*b + a*c` and `a*(b + c)` are one node. Children are always older than their parents: ascending ids are a
//! topological order.

use crate::ast::Literal;
use crate::number::Rational;
use crate::rule;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{BuildHasherDefault, DefaultHasher};

/// A node of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Id(u32);

impl Id {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a node is made of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Node {
    Number(Rational),
    /// A number that takes no part in folding: too large for exact arithmetic.
    Opaque(Literal),
    Pi,
    Symbol(Symbol),
    /// Two or more terms with their coefficients; `1` is the term of the constant.
    Sum(Vec<(Id, Rational)>),
    /// A coefficient and factors with their exponents.
    Product(Rational, Vec<(Id, Rational)>),
    Call(Function, Id),
    /// The angle of the point (second, first).
    Atan2(Id, Id),
    Max(Id, Id),
    /// The same value as its child, closed to all rewriting: what elimination works on.
    Atom(Id),
}

/// A leaf that has its value at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Symbol {
    Parameter(usize),
    Time,
    Coordinate(usize),
    Velocity(usize),
    Input {
        input: usize,
        component: usize,
        order: u8,
    },
    /// A generalized momentum, in the function that inverts them.
    Momentum(usize),
    /// A second moment about its pivot of the body whose scalars begin with this parameter.
    Moment(usize, Moment),
    /// The velocity of a scalar of a `let` position, as an unknown of its own.
    Auxiliary(usize),
    /// A component of the point of integration; the first number tells nested integrals apart.
    Point(usize, usize),
}

/// The second moments of a body in which rotations are short: S_xx + S_yy, S_xx − S_yy and S_xy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Moment {
    /// S_xx + S_yy, the moment of inertia.
    Inertia,
    /// S_xx − S_yy.
    Difference,
    /// S_xy.
    Product,
}

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Abs,
    Sign,
    Step,
}

/// What stands in an expression, anywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Contents(u16);

impl Contents {
    pub(crate) const PARAMETER: Self = Self(1);
    pub(crate) const TIME: Self = Self(2);
    pub(crate) const COORDINATE: Self = Self(4);
    pub(crate) const VELOCITY: Self = Self(8);
    pub(crate) const POSITION_INPUT: Self = Self(16);
    pub(crate) const VELOCITY_INPUT: Self = Self(32);
    pub(crate) const ACCELERATION_INPUT: Self = Self(64);
    pub(crate) const MOMENTUM: Self = Self(128);
    pub(crate) const POINT: Self = Self(256);
    pub(crate) const AUXILIARY: Self = Self(512);
    pub(crate) const INPUT: Self = Self(16 | 32 | 64);
    /// Everything but parameters.
    pub(crate) const STATE: Self = Self(!1);

    pub(crate) const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether anything of `other` is in `self`.
    pub(crate) const fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    fn of(symbol: Symbol) -> Self {
        match symbol {
            Symbol::Parameter(_) | Symbol::Moment(..) => Self::PARAMETER,
            Symbol::Point(..) => Self::POINT,
            Symbol::Time => Self::TIME,
            Symbol::Coordinate(_) => Self::COORDINATE,
            Symbol::Velocity(_) => Self::VELOCITY,
            Symbol::Input { order: 0, .. } => Self::POSITION_INPUT,
            Symbol::Input { order: 1, .. } => Self::VELOCITY_INPUT,
            Symbol::Input { .. } => Self::ACCELERATION_INPUT,
            Symbol::Momentum(_) => Self::MOMENTUM,
            Symbol::Auxiliary(_) => Self::AUXILIARY,
        }
    }
}

/// The terms of a sum under construction.
pub(crate) type Terms = BTreeMap<Id, Rational>;

/// The same in every run; the maps that use it are asked, never listed, so that no order of theirs can be seen.
type Hasher = BuildHasherDefault<DefaultHasher>;

/// All expressions of a block.
#[derive(Debug)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    /// The number of operands in all sums and products.
    size: usize,
    contents: Vec<Contents>,
    ids: HashMap<Node, Id, Hasher>,
    /// The derivatives that are known.
    slopes: HashMap<(Symbol, Id), Id, Hasher>,
}

impl Graph {
    pub(crate) const ZERO: Id = Id(0);
    pub(crate) const ONE: Id = Id(1);

    pub(crate) fn new() -> Self {
        let mut graph =
            Self { nodes: Vec::new(), size: 0, contents: Vec::new(), ids: HashMap::default(), slopes: HashMap::default() };
        graph.intern(Node::Number(Rational::ZERO));
        graph.intern(Node::Number(Rational::ONE));
        graph
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    /// The number of operands in all sums and products made so far.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    pub(crate) fn contents(&self, id: Id) -> Contents {
        self.contents[id.index()]
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

    /// `a + b`.
    pub(crate) fn add(&mut self, a: Id, b: Id) -> Id {
        self.sum(&[(a, Rational::ONE), (b, Rational::ONE)])
    }

    /// `a - b`.
    pub(crate) fn sub(&mut self, a: Id, b: Id) -> Id {
        self.sum(&[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    pub(crate) fn negative(&mut self, a: Id) -> Id {
        self.scale(Rational::MINUS_ONE, a)
    }

    pub(crate) fn scale(&mut self, coefficient: Rational, a: Id) -> Id {
        self.product(coefficient, &[(a, Rational::ONE)])
    }

    /// `a * b`.
    pub(crate) fn mul(&mut self, a: Id, b: Id) -> Id {
        self.product(Rational::ONE, &[(a, Rational::ONE), (b, Rational::ONE)])
    }

    /// `a / b`.
    pub(crate) fn div(&mut self, a: Id, b: Id) -> Id {
        self.product(Rational::ONE, &[(a, Rational::ONE), (b, Rational::MINUS_ONE)])
    }

    pub(crate) fn power(&mut self, a: Id, exponent: Rational) -> Id {
        self.product(Rational::ONE, &[(a, exponent)])
    }

    pub(crate) fn sqrt(&mut self, a: Id) -> Id {
        self.power(a, Rational::HALF)
    }

    /// `a` to a power that is no number: exp(b ln a).
    pub(crate) fn general_power(&mut self, a: Id, b: Id) -> Id {
        if let Node::Number(exponent) = *self.node(b) {
            return self.power(a, exponent);
        }
        let logarithm = self.call(Function::Ln, a);
        let exponent = self.mul(b, logarithm);
        self.call(Function::Exp, exponent)
    }

    /// Σ coefficient · term.
    pub(crate) fn sum(&mut self, terms: &[(Id, Rational)]) -> Id {
        let mut collected = Terms::new();
        for &(term, coefficient) in terms {
            self.add_term(&mut collected, term, coefficient);
        }
        self.finish_sum(collected)
    }

    /// Adds `coefficient · term`, flat.
    pub(crate) fn add_term(&mut self, terms: &mut Terms, term: Id, coefficient: Rational) {
        if coefficient.is_zero() {
            return;
        }
        match self.node(term).clone() {
            Node::Number(value) => self.add_monomial(terms, Self::ONE, value, coefficient),
            Node::Sum(inner) => {
                for (id, own) in inner {
                    self.add_monomial(terms, id, own, coefficient);
                }
            }
            Node::Product(own, factors) if own != Rational::ONE => {
                let bare = self.bare_product(factors);
                match self.node(bare).clone() {
                    Node::Sum(inner) => match own.mul(coefficient) {
                        Some(outer) => {
                            for (id, coefficient) in inner {
                                self.add_monomial(terms, id, coefficient, outer);
                            }
                        }
                        None => self.add_monomial(terms, bare, own, coefficient),
                    },
                    _ => self.add_monomial(terms, bare, own, coefficient),
                }
            }
            _ => self.add_monomial(terms, term, Rational::ONE, coefficient),
        }
    }

    /// Adds `a · b · term` for a term without a coefficient of its own; what overflows is left unevaluated.
    fn add_monomial(&mut self, terms: &mut Terms, term: Id, a: Rational, b: Rational) {
        let old = terms.get(&term).copied().unwrap_or(Rational::ZERO);
        if let Some(total) = a.mul(b).and_then(|product| product.add(old)) {
            if total.is_zero() {
                terms.remove(&term);
            } else {
                terms.insert(term, total);
            }
            return;
        }
        let a = self.intern(Node::Opaque(Literal::Exact(a)));
        let b = self.intern(Node::Opaque(Literal::Exact(b)));
        let product = self.product(Rational::ONE, &[(a, Rational::ONE), (b, Rational::ONE), (term, Rational::ONE)]);
        let count = terms.get(&product).copied().unwrap_or(Rational::ZERO);
        terms.insert(product, count.add(Rational::ONE).unwrap_or(Rational::ONE));
    }

    fn finish_sum(&mut self, mut terms: Terms) -> Id {
        while let Some(edit) = rule::rewrite_sum(self, &terms) {
            for id in edit.removed {
                terms.remove(&id);
            }
            for (id, coefficient) in edit.added {
                self.add_term(&mut terms, id, coefficient);
            }
        }
        if terms.len() < 2 {
            return match terms.pop_first() {
                None => Self::ZERO,
                Some((id, coefficient)) => self.scale(coefficient, id),
            };
        }
        let common = self.common_factors(&terms);
        if !common.is_empty() {
            let inverse: Vec<(Id, Rational)> = common.iter().map(|&(base, exponent)| (base, exponent.negative())).collect();
            let mut rest = Terms::new();
            for (id, coefficient) in terms {
                let mut factors = vec![(id, Rational::ONE)];
                factors.extend(&inverse);
                let quotient = self.product(Rational::ONE, &factors);
                self.add_term(&mut rest, quotient, coefficient);
            }
            let rest = self.finish_sum(rest);
            let mut factors = common;
            factors.push((rest, Rational::ONE));
            return self.product(Rational::ONE, &factors);
        }
        let mut content =
            terms.values().copied().reduce(|a, b| a.content(b).unwrap_or(Rational::ONE)).unwrap_or(Rational::ONE).abs();
        if terms.values().next().is_some_and(|first| first.is_negative()) {
            content = content.negative();
        }
        let divided: Option<Vec<(Id, Rational)>> = content
            .reciprocal()
            .and_then(|inverse| terms.iter().map(|(&id, &coefficient)| coefficient.mul(inverse).map(|own| (id, own))).collect());
        match divided {
            Some(divided) if content != Rational::ONE => {
                let primitive = self.intern(Node::Sum(divided));
                self.intern(Node::Product(content, vec![(primitive, Rational::ONE)]))
            }
            _ => self.intern(Node::Sum(terms.into_iter().collect())),
        }
    }

    /// The factors that stand in every term, with the exponents nearest to zero.
    fn common_factors(&self, terms: &Terms) -> Vec<(Id, Rational)> {
        let mut ids = terms.keys();
        let mut common = match ids.next() {
            Some(&id) if id != Self::ONE => self.factors(id),
            _ => return Vec::new(),
        };
        for &id in ids {
            if id == Self::ONE || common.is_empty() {
                return Vec::new();
            }
            let factors = self.factors(id);
            common.retain_mut(|(base, exponent)| match factors.iter().find(|(other, _)| other == base) {
                Some(&(_, other)) if other.is_negative() == exponent.is_negative() => {
                    if other.abs().less(exponent.abs()) {
                        *exponent = other;
                    }
                    true
                }
                _ => false,
            });
        }
        // What a division by the factor cannot take out of every term would be found again for ever.
        common.retain(|&(base, least)| {
            let divides = |&(other, exponent): &(Id, Rational)| {
                let rest = exact(exponent.add(least.negative()));
                other != base || rest.is_some_and(|rest| rest.is_zero() || rest.is_negative() == least.is_negative())
            };
            terms.keys().all(|&id| self.factors(id).iter().all(divides))
        });
        common
    }

    /// The factors of a term, without its coefficient.
    pub(crate) fn factors(&self, id: Id) -> Vec<(Id, Rational)> {
        match self.node(id) {
            Node::Product(_, factors) => factors.clone(),
            _ => vec![(id, Rational::ONE)],
        }
    }

    /// The coefficient of an expression and the rest.
    pub(crate) fn split(&mut self, id: Id) -> (Rational, Id) {
        match self.node(id).clone() {
            Node::Number(value) => (value, Self::ONE),
            Node::Product(coefficient, factors) if coefficient != Rational::ONE => (coefficient, self.bare_product(factors)),
            _ => (Rational::ONE, id),
        }
    }

    /// coefficient · Π base^exponent.
    pub(crate) fn product(&mut self, coefficient: Rational, factors: &[(Id, Rational)]) -> Id {
        let mut coefficient = coefficient;
        let mut bases = Terms::new();
        let mut pending: Vec<(Id, Rational)> = factors.to_vec();
        loop {
            for (base, exponent) in std::mem::take(&mut pending) {
                self.add_factor(&mut coefficient, &mut bases, base, exponent);
            }
            if coefficient.is_zero() {
                return Self::ZERO;
            }
            // A base whose exponents have added up to a whole number may open again; rules may fire on the rest.
            if let Some(edit) = rule::rewrite_product(self, &bases) {
                for id in edit.removed {
                    bases.remove(&id);
                }
                pending.extend(edit.added);
                continue;
            }
            let opened: Vec<Id> = bases
                .iter()
                .filter(|(id, exponent)| exponent.is_integer() && matches!(self.node(**id), Node::Number(_) | Node::Product(..)))
                .map(|(&id, _)| id)
                .collect();
            if opened.is_empty() {
                break;
            }
            for id in opened {
                if let Some(exponent) = bases.remove(&id) {
                    pending.push((id, exponent));
                }
            }
        }
        let factors: Vec<(Id, Rational)> = bases.into_iter().collect();
        match factors.as_slice() {
            [] => self.number(coefficient),
            [(base, exponent)] if *exponent == Rational::ONE && coefficient == Rational::ONE => *base,
            _ => self.intern(Node::Product(coefficient, factors)),
        }
    }

    fn add_factor(&mut self, coefficient: &mut Rational, bases: &mut Terms, base: Id, exponent: Rational) {
        if exponent.is_zero() {
            return;
        }
        match self.node(base).clone() {
            Node::Number(value) => {
                if let Some(power) = number_power(value, exponent).and_then(|power| power.mul(*coefficient)) {
                    *coefficient = power;
                    return;
                }
                if exponent.is_integer() {
                    let opaque = self.intern(Node::Opaque(Literal::Exact(value)));
                    return self.add_exponent(bases, opaque, exponent);
                }
                self.add_exponent(bases, base, exponent);
            }
            Node::Product(own, inner) => {
                if exponent.is_integer() {
                    let powers = inner.iter().map(|&(id, power)| Some((id, exact(power.mul(exponent))?)));
                    let powers = powers.collect::<Option<Vec<_>>>();
                    let Some(powers) = powers else {
                        // Exponents beyond exact arithmetic: the power stays closed, or it would be opened for ever.
                        let closed = self.intern(Node::Atom(base));
                        return self.add_exponent(bases, closed, exponent);
                    };
                    let own = self.number(own);
                    self.add_factor(coefficient, bases, own, exponent);
                    for (id, power) in powers {
                        self.add_factor(coefficient, bases, id, power);
                    }
                    return;
                }
                self.add_root(coefficient, bases, (own, inner), exponent);
            }
            _ => self.add_exponent(bases, base, exponent),
        }
    }

    /// A broken power of a product: even powers come out as magnitudes, positive numbers come out, the rest stays together.
    fn add_root(
        &mut self,
        coefficient: &mut Rational,
        bases: &mut Terms,
        product: (Rational, Vec<(Id, Rational)>),
        exponent: Rational,
    ) {
        let (own, inner) = product;
        let mut rest = Vec::new();
        for (id, power) in inner {
            match exact(power.mul(exponent)) {
                Some(total) if power.is_even() => {
                    let magnitude = if total.is_even() { id } else { self.call(Function::Abs, id) };
                    self.add_factor(coefficient, bases, magnitude, total);
                }
                _ => rest.push((id, power)),
            }
        }
        let sign = if own.is_negative() { Rational::MINUS_ONE } else { Rational::ONE };
        let magnitude = self.number(own.abs());
        self.add_factor(coefficient, bases, magnitude, exponent);
        match rest.as_slice() {
            [] if sign == Rational::ONE => {}
            [(id, power)] if sign == Rational::ONE => {
                if let Some(total) = exact(power.mul(exponent)) {
                    self.add_exponent(bases, *id, total);
                } else {
                    let whole = self.intern(Node::Product(sign, rest));
                    self.add_exponent(bases, whole, exponent);
                }
            }
            [] => {
                let minus = self.whole(-1);
                self.add_exponent(bases, minus, exponent);
            }
            _ => {
                let whole = self.intern(Node::Product(sign, rest));
                self.add_exponent(bases, whole, exponent);
            }
        }
    }

    fn add_exponent(&mut self, bases: &mut Terms, base: Id, exponent: Rational) {
        match exact(bases.get(&base).copied().unwrap_or(Rational::ZERO).add(exponent)) {
            Some(total) if total.is_zero() => {
                bases.remove(&base);
            }
            Some(total) => {
                bases.insert(base, total);
            }
            None => {
                let power = self.intern(Node::Product(Rational::ONE, vec![(base, exponent)]));
                let power = self.intern(Node::Atom(power));
                bases.insert(power, Rational::ONE);
            }
        }
    }

    fn bare_product(&mut self, factors: Vec<(Id, Rational)>) -> Id {
        match factors.as_slice() {
            [(base, exponent)] if *exponent == Rational::ONE => *base,
            _ => self.intern(Node::Product(Rational::ONE, factors)),
        }
    }

    pub(crate) fn call(&mut self, function: Function, argument: Id) -> Id {
        match rule::rewrite_call(self, function, argument) {
            Some(id) => id,
            None => self.intern(Node::Call(function, argument)),
        }
    }

    pub(crate) fn atan2(&mut self, y: Id, x: Id) -> Id {
        self.intern(Node::Atan2(y, x))
    }

    pub(crate) fn max(&mut self, a: Id, b: Id) -> Id {
        if a == b {
            return a;
        }
        if let (Node::Number(x), Node::Number(y)) = (self.node(a), self.node(b)) {
            return if x.less(*y) { b } else { a };
        }
        self.intern(Node::Max(a.min(b), a.max(b)))
    }

    /// -max(-a, -b).
    pub(crate) fn min(&mut self, a: Id, b: Id) -> Id {
        let a = self.negative(a);
        let b = self.negative(b);
        let max = self.max(a, b);
        self.negative(max)
    }

    /// Closes the sums of an expression to rewriting: no other sum takes their terms in. Products stay open, so that their factors
    /// cancel, and so do sums of parameters, which cost nothing.
    pub(crate) fn atom(&mut self, id: Id) -> Id {
        let (coefficient, bare) = self.split(id);
        match self.node(bare).clone() {
            Node::Sum(_) if self.contents(bare).any(Contents::STATE) => {
                let atom = self.intern(Node::Atom(bare));
                self.scale(coefficient, atom)
            }
            Node::Product(_, factors) => {
                let close = |graph: &mut Self, id: Id| {
                    let moving = graph.contents(id).any(Contents::STATE);
                    if moving && matches!(graph.node(id), Node::Sum(_)) { graph.intern(Node::Atom(id)) } else { id }
                };
                let closed: Vec<(Id, Rational)> =
                    factors.into_iter().map(|(base, exponent)| (close(self, base), exponent)).collect();
                self.product(coefficient, &closed)
            }
            _ => id,
        }
    }

    /// Whether an expression is a quotient by something that moves.
    pub(crate) fn moving_quotient(&self, id: Id) -> bool {
        let factors = self.factors(id);
        factors.iter().any(|&(base, exponent)| exponent.is_negative() && self.contents(base).any(Contents::STATE))
    }

    /// Closes any expression that is not a leaf: it is computed once and used as it is.
    pub(crate) fn closed(&mut self, id: Id) -> Id {
        match self.node(id) {
            Node::Sum(_) | Node::Product(..) => self.intern(Node::Atom(id)),
            _ => id,
        }
    }

    /// A node with other children.
    pub(crate) fn rebuilt(&mut self, node: &Node, child: impl Fn(Id) -> Id) -> Id {
        let list = |items: &[(Id, Rational)]| items.iter().map(|&(id, number)| (child(id), number)).collect::<Vec<_>>();
        match node {
            Node::Number(_) | Node::Opaque(_) | Node::Pi | Node::Symbol(_) => self.intern(node.clone()),
            Node::Sum(terms) => self.sum(&list(terms)),
            Node::Product(coefficient, factors) => self.product(*coefficient, &list(factors)),
            Node::Call(function, argument) => self.call(*function, child(*argument)),
            Node::Atan2(y, x) => self.atan2(child(*y), child(*x)),
            Node::Max(a, b) => self.max(child(*a), child(*b)),
            Node::Atom(inner) => {
                let inner = child(*inner);
                let (_, bare) = self.split(inner);
                if matches!(self.node(bare), Node::Sum(_)) { self.atom(inner) } else { self.closed(inner) }
            }
        }
    }

    /// The nodes from which an expression is made directly.
    pub(crate) fn children(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Number(_) | Node::Opaque(_) | Node::Pi | Node::Symbol(_) => Vec::new(),
            Node::Sum(list) | Node::Product(_, list) => list.iter().map(|&(id, _)| id).collect(),
            Node::Call(_, a) | Node::Atom(a) => vec![*a],
            Node::Atan2(a, b) | Node::Max(a, b) => vec![*a, *b],
        }
    }

    /// Everything from which `roots` are made, children first.
    pub(crate) fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        let mut found = vec![false; roots.iter().map(|id| id.index() + 1).max().unwrap_or(0)];
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if !std::mem::replace(&mut found[id.index()], true) {
                pending.extend(self.children(id));
            }
        }
        (0..).zip(found).filter(|&(_, found)| found).map(|(index, _)| Id(index)).collect()
    }

    /// Whether nothing that moves goes through a function that has a corner or jumps.
    pub(crate) fn smooth(&self, roots: &[Id]) -> bool {
        let cornered =
            |&id: &Id| matches!(self.node(id), Node::Max(..) | Node::Call(Function::Abs | Function::Sign | Function::Step, _));
        !self.reachable(roots).iter().filter(|id| cornered(id)).any(|&id| self.contents(id).any(Contents::STATE))
    }

    /// The derivative of a node, if it is known.
    pub(crate) fn slope(&self, symbol: Symbol, id: Id) -> Option<Id> {
        // What contains nothing of the symbol's kind does not depend on it.
        if self.contents(id).any(Contents::of(symbol)) { self.slopes.get(&(symbol, id)).copied() } else { Some(Self::ZERO) }
    }

    /// Remembers a derivative.
    pub(crate) fn set_slope(&mut self, symbol: Symbol, id: Id, slope: Id) {
        self.slopes.insert((symbol, id), slope);
    }

    /// The symbols in `roots`.
    pub(crate) fn symbols(&self, roots: &[Id]) -> BTreeSet<Symbol> {
        let symbol = |id: Id| match self.node(id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        };
        self.reachable(roots).into_iter().filter_map(symbol).collect()
    }

    fn intern(&mut self, node: Node) -> Id {
        if let Some(&id) = self.ids.get(&node) {
            return id;
        }
        let id = Id(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX));
        let contents = match &node {
            Node::Symbol(symbol) => Contents::of(*symbol),
            Node::Sum(list) | Node::Product(_, list) => {
                list.iter().fold(Contents::default(), |all, &(id, _)| all.or(self.contents(id)))
            }
            Node::Call(_, a) | Node::Atom(a) => self.contents(*a),
            Node::Atan2(a, b) | Node::Max(a, b) => self.contents(*a).or(self.contents(*b)),
            Node::Number(_) | Node::Opaque(_) | Node::Pi => Contents::default(),
        };
        if let Node::Sum(list) | Node::Product(_, list) = &node {
            self.size += list.len();
        }
        self.nodes.push(node.clone());
        self.contents.push(contents);
        self.ids.insert(node, id);
        id
    }
}

/// An exponent as long as it is small enough for sums and differences of exponents to be exact.
fn exact(exponent: Option<Rational>) -> Option<Rational> {
    exponent?.within(60)
}

/// The exact power of a number, where there is one.
fn number_power(value: Rational, exponent: Rational) -> Option<Rational> {
    if value == Rational::ONE {
        return Some(value);
    }
    let degree = u32::try_from(exponent.denominator()).ok()?;
    let power = i64::try_from(exponent.numerator()).ok()?;
    if 4096 < power.abs() {
        return None;
    }
    if value.is_zero() && power < 0 {
        return None;
    }
    let root = if degree == 1 { value } else { value.root(degree)? };
    root.power(power)
}

#[cfg(test)]
mod tests {
    use super::{Function, Graph, Node, Symbol};
    use crate::number::Rational;

    #[test]
    fn like_terms_and_common_factors_collect() {
        let mut g = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|k| g.symbol(Symbol::Parameter(k)));
        let ab = g.mul(a, b);
        let ac = g.mul(a, c);
        let left = g.add(ab, ac);
        let inner = g.add(c, b);
        assert_eq!(left, g.mul(inner, a));
        assert_eq!(g.sub(left, left), Graph::ZERO);
        let double = g.add(left, left);
        assert_eq!(double, g.scale(Rational::whole(2), left));
        let quotient = g.div(double, left);
        assert_eq!(quotient, g.whole(2));
    }

    #[test]
    fn roots_of_squares_are_magnitudes() {
        let mut g = Graph::new();
        let x = g.symbol(Symbol::Coordinate(0));
        let square = g.power(x, Rational::whole(2));
        let root = g.sqrt(square);
        assert_eq!(root, g.call(Function::Abs, x));
        assert_eq!(g.power(root, Rational::whole(2)), square);
        let four = g.whole(4);
        assert_eq!(g.sqrt(four), g.whole(2));
    }

    #[test]
    fn overflow_is_left_unevaluated() {
        let mut g = Graph::new();
        let large = g.number(Rational::decimal("1e30").unwrap());
        let product = g.mul(large, large);
        assert!(!matches!(g.node(product), Node::Number(_)));
        let x = g.symbol(Symbol::Time);
        let scaled = g.mul(product, x);
        assert_eq!(g.sub(scaled, scaled), Graph::ZERO);
    }

    #[test]
    fn exponents_that_overflow_stay_closed() {
        let mut g = Graph::new();
        let [x, y] = [0, 1].map(|k| g.symbol(Symbol::Coordinate(k)));
        let large = Rational::decimal("1e17").unwrap();
        let product = g.mul(x, y);
        let power = g.power(product, large);
        let tower = g.power(power, large);
        let factors = g.factors(tower);
        assert!(matches!(factors.as_slice(), [(base, exponent)] if matches!(g.node(*base), Node::Atom(_)) && *exponent == large));
        assert_eq!(g.div(tower, tower), Graph::ONE);
    }
}
