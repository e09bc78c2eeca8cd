//! Products: flat, sorted, with a coefficient and an exponent for each base.

use super::{Dependencies, Graph, Id, Node, Terms};
use crate::algebra::expr::rule;
use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;

impl Graph {
    /// Returns coefficient · Π base^exponent.
    pub(crate) fn product(&mut self, coefficient: Rational, factors: &[(Id, Rational)]) -> Id {
        self.work += factors.len();
        if self.spent() {
            return Self::ZERO;
        }
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
            // A base whose exponent has become an integer is split into its factors if it is a
            // number or a product. The rules then apply to the result.
            if let Some(edit) = rule::rewrite_product(self, &bases) {
                for id in edit.removed {
                    bases.remove(&id);
                }
                pending.extend(edit.added);
                continue;
            }
            let opened: Vec<Id> = bases
                .iter()
                .filter(|(id, exponent)| {
                    exponent.is_integer()
                        && matches!(self.node(**id), Node::Number(_) | Node::Product(..))
                })
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
        self.work += bases.len();
        let factors: Vec<(Id, Rational)> = bases.into_iter().collect();
        match factors.as_slice() {
            [] => self.number(coefficient),
            [(base, exponent)] if *exponent == Rational::ONE && coefficient == Rational::ONE => {
                *base
            }
            _ => self.intern(Node::Product(coefficient, factors)),
        }
    }

    /// Returns the factors of a term, without its coefficient.
    pub(crate) fn factors(&self, id: Id) -> Vec<(Id, Rational)> {
        match self.node(id) {
            Node::Product(_, factors) => factors.clone(),
            _ => vec![(id, Rational::ONE)],
        }
    }

    /// Splits an expression into its coefficient and the remaining factors.
    pub(crate) fn split(&mut self, id: Id) -> (Rational, Id) {
        match self.node(id).clone() {
            Node::Number(value) => (value, Self::ONE),
            Node::Product(coefficient, factors) if coefficient != Rational::ONE => {
                (coefficient, self.bare_product(factors))
            }
            _ => (Rational::ONE, id),
        }
    }

    /// Returns `true` if a factor with a negative exponent depends on more than parameters.
    pub(crate) fn moving_quotient(&self, id: Id) -> bool {
        let factors = self.factors(id);
        factors.iter().any(|&(base, exponent)| {
            exponent.is_negative() && self.dependencies(base).any(Dependencies::STATE)
        })
    }

    fn add_factor(
        &mut self,
        coefficient: &mut Rational,
        bases: &mut Terms,
        base: Id,
        exponent: Rational,
    ) {
        if exponent.is_zero() {
            return;
        }
        match self.node(base).clone() {
            Node::Number(value) => {
                if let Some(power) =
                    number_power(value, exponent).and_then(|power| power.mul(*coefficient))
                {
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
                    let powers =
                        inner.iter().map(|&(id, power)| Some((id, exact(power.mul(exponent))?)));
                    let powers = powers.collect::<Option<Vec<_>>>();
                    let Some(powers) = powers else {
                        // The exponents exceed exact arithmetic. The base is closed, because it
                        // would be split again and again otherwise.
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

    /// Adds a fractional power of a product. Even powers are extracted as magnitudes and positive
    /// numbers as factors; the remaining factors stay together.
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

    pub(super) fn bare_product(&mut self, factors: Vec<(Id, Rational)>) -> Id {
        match factors.as_slice() {
            [(base, exponent)] if *exponent == Rational::ONE => *base,
            _ => self.intern(Node::Product(Rational::ONE, factors)),
        }
    }
}

/// Returns the exponent if it is small enough for exact sums and differences of exponents.
pub(super) fn exact(exponent: Option<Rational>) -> Option<Rational> {
    exponent?.within(60)
}

/// Returns the exact power of a number, if it is rational and small enough.
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
    use crate::algebra::expr::{Graph, Node, Symbol};
    use crate::algebra::functions::Function;
    use crate::algebra::number::Rational;

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
        assert!(
            matches!(factors.as_slice(), [(base, exponent)] if matches!(g.node(*base), Node::Atom(_)) && *exponent == large)
        );
        assert_eq!(g.div(tower, tower), Graph::ONE);
    }
}
