//! Values of expressions in a prime field, used to test expressions for being identically zero.
//!
//! An expression that vanishes at random points modulo a large prime vanishes identically with high
//! probability (Schwartz 1980, Zippel 1979). Arithmetic in the field has no rounding errors. Angles
//! are points of the unit circle of the field and square roots are roots in the field. Every other
//! function has a random value that depends only on the value of its argument. Points at which a
//! root does not exist are discarded; on average each root discards half of the points. In the
//! extension by i, the root of −1, every element of the prime field has a root, so that expressions
//! with many roots have enough points too.

use crate::algebra::expr::{Graph, Id, Node, Symbol, hash};
use crate::algebra::functions::Function;
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// 2⁶¹ − 1, which is 3 modulo 4: square roots are powers, and −1 is not a square.
const PRIME: u64 = (1 << 61) - 1;

/// An element a + b·i of the prime field extended by i² = −1. b is zero unless it results from a
/// root in the extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Residue(u64, u64);

fn sum(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if PRIME <= sum { sum - PRIME } else { sum }
}

fn negated(a: u64) -> u64 {
    if a == 0 { 0 } else { PRIME - a }
}

fn product(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    // 2⁶¹ ≡ 1: the upper bits are added to the lower bits.
    sum(product as u64 & PRIME, (product >> 61) as u64)
}

impl Residue {
    pub(crate) const ZERO: Self = Self(0, 0);
    pub(crate) const ONE: Self = Self(1, 0);

    pub(crate) fn add(self, other: Self) -> Self {
        Self(sum(self.0, other.0), sum(self.1, other.1))
    }

    pub(crate) fn negative(self) -> Self {
        Self(negated(self.0), negated(self.1))
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        if self.1 == 0 && other.1 == 0 {
            return Self(product(self.0, other.0), 0);
        }
        Self(
            sum(product(self.0, other.0), negated(product(self.1, other.1))),
            sum(product(self.0, other.1), product(self.1, other.0)),
        )
    }

    fn power(self, mut exponent: u64) -> Self {
        let (mut base, mut result) = (self, Self::ONE);
        while 0 < exponent {
            if exponent % 2 == 1 {
                result = result.mul(base);
            }
            base = base.mul(base);
            exponent /= 2;
        }
        result
    }

    /// Returns the reciprocal, or `None` for zero.
    pub(crate) fn reciprocal(self) -> Option<Self> {
        if self.1 == 0 {
            return (self.0 != 0).then(|| self.power(PRIME - 2));
        }
        // 1/(a + b·i) = (a − b·i)/(a² + b²). a² + b² is not zero because −1 is not a square.
        Some(Self(self.0, negated(self.1)).mul(self.norm().reciprocal()?))
    }

    /// Returns a² + b².
    fn norm(self) -> Self {
        Self(sum(product(self.0, self.0), product(self.1, self.1)), 0)
    }

    /// Returns the real and the imaginary part.
    pub(crate) fn parts(self) -> [Self; 2] {
        [Self(self.0, 0), Self(self.1, 0)]
    }

    /// Returns the root of an element of the prime field, if it lies in the prime field.
    fn root(self) -> Option<Self> {
        let root = self.power(PRIME.div_ceil(4));
        (root.mul(root) == self).then_some(root)
    }

    /// Returns the root in the extension by i. It exists for all elements of the prime field and
    /// for half of the other elements.
    fn extended_root(self) -> Option<Self> {
        if self.1 == 0 {
            // Either a or −a is a square, because −1 is not.
            return self.root().or_else(|| Some(Self(0, self.negative().root()?.0)));
        }
        // (x + y·i)² = a + b·i: x² is (a ± √(a² + b²))/2. Exactly one of the two is a square,
        // because their product is −(b/2)².
        let length = self.norm().root()?;
        let half = Self(PRIME.div_ceil(2), 0);
        let square = |length: Self| half.mul(Self(self.0, 0).add(length)).root();
        let x = square(length).or_else(|| square(length.negative()))?;
        let y = half.mul(Self(self.1, 0)).mul(x.reciprocal()?);
        Some(Self(x.0, y.0))
    }

    /// Returns a key of this element, from which random values of functions are computed.
    fn key(self) -> u64 {
        self.0 ^ self.1.wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    fn of(value: Rational) -> Option<Self> {
        let reduce = |number: i128| {
            let magnitude = u64::try_from(number.unsigned_abs() % u128::from(PRIME)).unwrap_or(0);
            if number < 0 { Self(magnitude, 0).negative() } else { Self(magnitude, 0) }
        };
        let numerator = reduce(value.numerator());
        // Most denominators are 1, and a reciprocal costs a hundred products.
        if value.denominator() == 1 {
            Some(numerator)
        } else {
            Some(numerator.mul(reduce(value.denominator()).reciprocal()?))
        }
    }

    /// Returns the fraction of small integers equal to this residue, if there is one (Wang 1981).
    pub(crate) fn rational(self) -> Option<Rational> {
        if self.1 != 0 {
            return None;
        }
        let (mut a, mut b) = (i128::from(PRIME), i128::from(self.0));
        let (mut s, mut t) = (0i128, 1i128);
        while 1 << 20 < b {
            let quotient = a / b;
            (a, b) = (b, a - quotient * b);
            (s, t) = (t, s - quotient * t);
        }
        if t.abs() < 1 << 20 { Rational::new(b, t) } else { None }
    }
}

/// A random point of the field: a value for every symbol, computed on demand.
#[derive(Debug)]
pub(crate) struct Point {
    seed: u64,
    /// The common denominator of all angles.
    denominator: i64,
    roots: Roots,
    /// `true` if the entries of a rotation are those of an orthogonal matrix.
    orthogonal: bool,
    /// A symbol with another value than its own at this point.
    moved: Option<Id>,
}

/// The interpretation of square roots in the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Roots {
    /// Roots in the prime field, if they exist there.
    Prime,
    /// Roots in the prime field extended by i.
    Extended,
    /// Unknown functions.
    Formal,
}

/// The values of nodes.
pub(crate) type Values = BTreeMap<Id, Residue>;

impl Point {
    /// Creates a point for the expressions in `roots`.
    pub(crate) fn new(graph: &Graph, roots: &[Id], seed: u64) -> Self {
        let mut denominator = 1i64;
        for id in graph.reachable(roots) {
            if let Node::Call(Function::Sin | Function::Cos, argument) = *graph.node(id) {
                for (_, coefficient) in linear(graph, argument).unwrap_or_default() {
                    let own = i64::try_from(coefficient.denominator()).unwrap_or(1);
                    if denominator % own != 0
                        && denominator.checked_mul(own).is_some_and(|product| product < 1 << 20)
                    {
                        denominator *= own;
                    }
                }
            }
        }
        Self { seed, denominator, roots: Roots::Prime, orthogonal: false, moved: None }
    }

    /// Creates a point at which roots are unknown functions: expressions of equal value are equal
    /// wherever both are real.
    pub(crate) fn formal(graph: &Graph, roots: &[Id], seed: u64) -> Self {
        Self { roots: Roots::Formal, ..Self::new(graph, roots, seed) }
    }

    /// Creates a point at which every element of the prime field has a root.
    ///
    /// The root of a product equals the product of the roots of its factors only up to a sign,
    /// which differs from point to point. An expression that vanishes at many such points vanishes
    /// identically, but the converse does not hold.
    pub(crate) fn extended(graph: &Graph, roots: &[Id], seed: u64) -> Self {
        Self { roots: Roots::Extended, ..Self::new(graph, roots, seed) }
    }

    /// Makes the entries of each rotation those of an orthogonal matrix.
    pub(crate) fn orthogonal(self) -> Self {
        Self { orthogonal: true, ..self }
    }

    /// Creates another point for the same expressions.
    pub(crate) fn again(&self, seed: u64) -> Self {
        Self { seed, ..*self }
    }

    /// Creates a point that differs in the value of one symbol.
    pub(crate) fn moved(&self, symbol: Id) -> Self {
        Self { moved: Some(symbol), ..*self }
    }

    /// Returns the values of all nodes in `roots`, or `None` if a root or a reciprocal does not
    /// exist.
    pub(crate) fn values(&self, graph: &Graph, roots: &[Id]) -> Option<Values> {
        let mut values = Values::new();
        self.evaluate(graph, &graph.reachable(roots), &mut values)?;
        Some(values)
    }

    /// Puts the values of `nodes` into `known`, which contains those of all other operands. The
    /// nodes are sorted with operands first.
    pub(crate) fn evaluate(&self, graph: &Graph, nodes: &[Id], known: &mut Values) -> Option<()> {
        for &id in nodes {
            let value = match graph.node(id) {
                Node::Number(value) => Residue::of(*value)?,
                Node::Opaque(_) | Node::Pi => self.random(&[u64::from(id.index() as u32), 1]),
                Node::Symbol(Symbol::Entry(first, entry)) if self.orthogonal => {
                    self.entry(*first, *entry)?
                }
                Node::Symbol(symbol) => self.random(&[hash(symbol), self.salt(id, 2)]),
                Node::Sum(terms) => {
                    let mut sum = Residue::ZERO;
                    for (term, coefficient) in terms {
                        sum = sum.add(known[term].mul(Residue::of(*coefficient)?));
                    }
                    sum
                }
                Node::Product(coefficient, factors) => {
                    let mut product = Residue::of(*coefficient)?;
                    for (base, exponent) in factors {
                        product = product.mul(self.power(known[base], *exponent)?);
                    }
                    product
                }
                Node::Call(function @ (Function::Sin | Function::Cos), argument) => {
                    let (cos, sin) = self.circle(graph, *argument, known[argument])?;
                    if *function == Function::Sin { sin } else { cos }
                }
                Node::Call(function, argument) => {
                    self.random(&[hash(function), known[argument].key(), 3])
                }
                Node::Atan2(a, b) => self.random(&[known[a].key(), known[b].key(), 4]),
                Node::Max(a, b) => self.random(&[known[a].key(), known[b].key(), 5]),
                Node::Atom(inner) => known[inner],
            };
            known.insert(id, value);
        }
        Some(())
    }

    /// Returns `salt`, or another number for the symbol that is moved.
    fn salt(&self, symbol: Id, salt: u64) -> u64 {
        if self.moved == Some(symbol) { salt + 16 } else { salt }
    }

    /// Returns an entry of the matrix of a random quaternion.
    fn entry(&self, first: usize, entry: usize) -> Option<Residue> {
        let q = [0, 1, 2, 3].map(|part| self.random(&[first as u64, part, 8]));
        let twice = |a: Residue| a.add(a);
        let square = q.iter().fold(Residue::ZERO, |sum, part| sum.add(part.mul(*part)));
        let (row, column) = (entry / 3, entry % 3);
        let mut value = twice(q[1 + row].mul(q[1 + column]));
        if row == column {
            // 2 w² − |q|² + 2 x²
            value = value.add(twice(q[0].mul(q[0]))).add(square.negative());
        } else {
            let turn = twice(q[0].mul(q[4 - row - column]));
            let backwards = (row + 1) % 3 == column;
            value = value.add(if backwards { turn.negative() } else { turn });
        }
        Some(value.mul(square.reciprocal()?))
    }

    fn power(&self, base: Residue, exponent: Rational) -> Option<Residue> {
        let root = match exponent.denominator() {
            1 => base,
            2 if self.roots == Roots::Prime => base.root()?,
            2 if self.roots == Roots::Extended => base.extended_root()?,
            other => self.random(&[base.key(), u64::try_from(other).ok()?, 6]),
        };
        let root = if exponent.is_negative() { root.reciprocal()? } else { root };
        Some(root.power(u64::try_from(exponent.numerator().unsigned_abs()).ok()?))
    }

    /// Returns cosine and sine of an angle: a product of rotations for a linear angle, otherwise a
    /// random rotation.
    fn circle(&self, graph: &Graph, argument: Id, value: Residue) -> Option<(Residue, Residue)> {
        let Some(terms) = linear(graph, argument) else { return self.rotation(&[value.key(), 7]) };
        let mut total = (Residue::ONE, Residue::ZERO);
        for (base, coefficient) in terms {
            let steps = coefficient.mul(Rational::whole(self.denominator))?.integer()?;
            let (cos, sin) = self.rotation(&[base.index() as u64, self.salt(base, 8)])?;
            let sin = if steps < 0 { sin.negative() } else { sin };
            for _ in 0..steps.unsigned_abs().min(1 << 12) {
                total = (
                    total.0.mul(cos).add(total.1.mul(sin).negative()),
                    total.0.mul(sin).add(total.1.mul(cos)),
                );
            }
        }
        Some(total)
    }

    /// Returns a random point of the unit circle: ((1 − t²)/(1 + t²), 2t/(1 + t²)).
    fn rotation(&self, key: &[u64]) -> Option<(Residue, Residue)> {
        let t = self.random(key);
        let square = t.mul(t);
        let scale = square.add(Residue::ONE).reciprocal()?;
        Some((Residue::ONE.add(square.negative()).mul(scale), t.add(t).mul(scale)))
    }

    /// Returns a residue that depends only on the seed and the key.
    fn random(&self, key: &[u64]) -> Residue {
        let mut state = self.seed;
        for part in key {
            // SplitMix64 (Steele, Lea and Flood 2014).
            state = state.wrapping_add(*part).wrapping_add(0x9e37_79b9_7f4a_7c15);
            state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            state ^= state >> 31;
        }
        Residue(state % PRIME, 0)
    }
}

/// Returns an angle as a linear combination of symbols with rational coefficients.
fn linear(graph: &Graph, argument: Id) -> Option<Vec<(Id, Rational)>> {
    let symbol = |id: Id| matches!(graph.node(id), Node::Symbol(_) | Node::Pi);
    match graph.node(argument) {
        Node::Symbol(_) | Node::Pi => Some(vec![(argument, Rational::ONE)]),
        Node::Product(coefficient, factors) => match factors.as_slice() {
            [(base, Rational::ONE)] if symbol(*base) => Some(vec![(*base, *coefficient)]),
            [(base, Rational::ONE)] => {
                let terms = linear(graph, *base)?;
                terms.into_iter().map(|(id, own)| Some((id, own.mul(*coefficient)?))).collect()
            }
            _ => None,
        },
        Node::Sum(terms) => terms.iter().all(|(id, _)| symbol(*id)).then(|| terms.clone()),
        _ => None,
    }
}

/// The entries of a vector that are not zero.
pub(crate) type Row = BTreeMap<usize, Residue>;

/// Linear equations in echelon form. Rows of large families have few entries, so that only these
/// are kept, in order.
#[derive(Debug, Default)]
pub(crate) struct Equations(BTreeMap<usize, Vec<(usize, Residue)>>);

impl Equations {
    pub(crate) fn rank(&self) -> usize {
        self.0.len()
    }

    /// Adds an equation, unless it follows from the others.
    pub(crate) fn insert(&mut self, row: &Row) {
        let last = row.keys().chain(self.0.values().filter_map(|row| Some(&row.last()?.0)));
        let mut dense = vec![Residue::ZERO; last.max().map_or(0, |last| last + 1)];
        for (&column, &value) in row {
            dense[column] = value;
        }
        for column in 0..dense.len() {
            let value = dense[column];
            if value == Residue::ZERO {
                continue;
            }
            if let Some(pivot) = self.0.get(&column) {
                for &(other, entry) in pivot {
                    dense[other] = dense[other].add(entry.mul(value).negative());
                }
                continue;
            }
            // Entries are not zero.
            let inverse = value.reciprocal().unwrap_or(Residue::ONE);
            let entries = dense.into_iter().enumerate();
            let entries = entries.filter(|&(_, entry)| entry != Residue::ZERO);
            let row = entries.map(|(other, entry)| (other, entry.mul(inverse))).collect();
            self.0.insert(column, row);
            return;
        }
    }

    /// Returns a basis of the solutions, in reduced echelon form.
    pub(crate) fn null_space(mut self, width: usize) -> Vec<Row> {
        let pivots: Vec<usize> = self.0.keys().copied().collect();
        for &column in pivots.iter().rev() {
            let later = self.0.remove(&column).unwrap_or_default();
            let mut row: Row = later.iter().copied().collect();
            for (other, value) in later {
                if let Some(pivot) = self.0.get(&other) {
                    eliminate(&mut row, value, pivot);
                }
            }
            self.0.insert(column, row.into_iter().collect());
        }
        let mut basis: BTreeMap<usize, Row> = (0..width)
            .filter(|column| !self.0.contains_key(column))
            .map(|free| (free, Row::from([(free, Residue::ONE)])))
            .collect();
        for (pivot, row) in self.0 {
            for (column, value) in row {
                if let Some(vector) = basis.get_mut(&column) {
                    vector.insert(pivot, value.negative());
                }
            }
        }
        basis.into_values().collect()
    }
}

/// Subtracts `factor` times a row.
fn eliminate(row: &mut Row, factor: Residue, other: &[(usize, Residue)]) {
    for &(column, value) in other {
        let old = row.get(&column).copied().unwrap_or(Residue::ZERO);
        let new = old.add(value.mul(factor).negative());
        if new == Residue::ZERO {
            row.remove(&column);
        } else {
            row.insert(column, new);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Equations, Point, Residue};
    use crate::algebra::expr::{Graph, Moment, Symbol, hash};
    use crate::algebra::functions::Function;
    use crate::algebra::number::Rational;
    use crate::tests::lowered;
    use std::collections::BTreeSet;

    #[test]
    fn symbols_and_functions_have_numbers_of_their_own() {
        let symbols = (0..500).flat_map(|k| {
            let (input, component) = (k / 32, k % 32);
            let inputs = [0, 1, 2].map(|order| Symbol::Input { input, component, order });
            let others = [
                Symbol::Parameter(k),
                Symbol::Coordinate(k),
                Symbol::Velocity(k),
                Symbol::Entry(k / 9, k % 9),
                Symbol::Control { input, component },
                Symbol::Acceleration(k),
                Symbol::Multiplier(k),
                Symbol::Target(k),
                Symbol::Momentum(k),
                Symbol::Moment(k, Moment::Inertia),
                Symbol::Moment(k, Moment::Mixed(1)),
                Symbol::Auxiliary(k),
                Symbol::Position(k),
                Symbol::Point(k / 3, k % 3),
                Symbol::Contact(k),
                Symbol::Friction(k),
            ];
            inputs.into_iter().chain(others)
        });
        let symbols: BTreeSet<Symbol> = symbols.chain([Symbol::Time]).collect();
        let numbers: BTreeSet<u64> = symbols.iter().map(hash).collect();
        assert_eq!(numbers.len(), symbols.len());
        let numbers: BTreeSet<u64> = Function::ALL.iter().map(hash).collect();
        assert_eq!(numbers.len(), Function::ALL.len());
    }

    fn vanishes(expression: &str) -> bool {
        let mut graph = Graph::new();
        let id = lowered(&mut graph, expression);
        let values =
            (0..64).filter_map(|seed| Point::new(&graph, &[id], seed).values(&graph, &[id]));
        let mut count = 0;
        let all = values.inspect(|_| count += 1).all(|values| values[&id] == Residue::ZERO);
        assert!(0 < count);
        all
    }

    #[test]
    fn what_vanishes_is_found_and_what_does_not_is_not() {
        assert!(vanishes("(a + b)^2 - a^2 - 2*a*b - b^2"));
        assert!(vanishes("sin(a + b)*sin(a - b) - sin(a)^2 + sin(b)^2"));
        assert!(vanishes("sin(a/2)*cos(a/2) - sin(a)/2"));
        assert!(vanishes("sqrt(a^2 + b^2)*(a - b) - (a^2 - b^2)*sqrt(a^2 + b^2)/(a + b)"));
        assert!(vanishes("exp(a*(b + 1)) - exp(a*b + a)"));
        assert!(!vanishes("sin(a + b) - sin(a) - sin(b)"));
        assert!(!vanishes("(a + b)^3 - a^3 - b^3"));
    }

    #[test]
    fn every_number_has_a_root_beside_the_root_of_minus_one() {
        let number = |value: i64| Residue::of(Rational::whole(value)).unwrap();
        let i = number(-1).extended_root().unwrap();
        assert_eq!(number(-1).root(), None);
        for value in -40..40 {
            let root = number(value).extended_root().unwrap();
            assert_eq!(root.mul(root), number(value));
            let mixed = number(value).add(i.mul(number(3 * value + 7)));
            let reciprocal = mixed.reciprocal().unwrap();
            assert_eq!(mixed.mul(reciprocal), Residue::ONE);
            // The root of a square is the original element up to sign.
            let again = mixed.mul(mixed).extended_root().unwrap();
            assert!(again == mixed || again == mixed.negative(), "{mixed:?} and {again:?}");
        }
        let exist =
            (0..400).filter(|&value| number(value).add(i).extended_root().is_some()).count();
        assert!((150..250).contains(&exist), "{exist} roots of 400");
    }

    #[test]
    fn fractions_come_back() {
        for (top, bottom) in [(1, 2), (-3, 7), (12, 1), (0, 1)] {
            let value = Rational::new(top, bottom).unwrap();
            assert_eq!(Residue::of(value).unwrap().rational(), Some(value));
        }
    }

    #[test]
    fn the_null_space_is_orthogonal_to_every_row() {
        let row = |values: [i64; 4]| {
            let values = values.map(|value| Residue::of(Rational::whole(value)).unwrap());
            let entries = values.into_iter().enumerate();
            entries.filter(|&(_, value)| value != Residue::ZERO).collect::<super::Row>()
        };
        let rows = [row([1, 2, 3, 4]), row([2, 4, 6, 8]), row([0, 1, -1, 5])];
        let mut equations = Equations::default();
        for row in &rows {
            equations.insert(row);
        }
        assert_eq!(equations.rank(), 2);
        let basis = equations.null_space(4);
        assert_eq!(basis.len(), 2);
        for vector in basis {
            for row in &rows {
                let common = row.iter().filter_map(|(column, a)| Some(a.mul(*vector.get(column)?)));
                let product = common.fold(Residue::ZERO, Residue::add);
                assert_eq!(product, Residue::ZERO);
            }
        }
    }
}
