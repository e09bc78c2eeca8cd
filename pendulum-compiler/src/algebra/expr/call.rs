//! Functions of expressions: calls, powers with non-constant exponents, minima and maxima.

use super::{Graph, Id, Node};
use crate::algebra::expr::rule;
use crate::algebra::functions::Function;

impl Graph {
    /// Returns `a` to the power `b`. If `b` is not a number, the power is exp(b ln a).
    pub(crate) fn general_power(&mut self, a: Id, b: Id) -> Id {
        if let Node::Number(exponent) = *self.node(b) {
            return self.power(a, exponent);
        }
        let logarithm = self.call(Function::Ln, a);
        let exponent = self.mul(b, logarithm);
        self.call(Function::Exp, exponent)
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
        if let (Node::Number(x), Node::Number(y)) = (self.node(a), self.node(b))
            && let Some(less) = x.less(*y)
        {
            return if less { b } else { a };
        }
        self.intern(Node::Max(a.min(b), a.max(b)))
    }

    /// Returns the minimum, −max(−a, −b).
    pub(crate) fn min(&mut self, a: Id, b: Id) -> Id {
        let a = self.negative(a);
        let b = self.negative(b);
        let max = self.max(a, b);
        self.negative(max)
    }
}

#[cfg(test)]
mod tests {
    use super::{Graph, Node};
    use crate::algebra::number::Rational;

    #[test]
    fn numbers_too_long_to_compare_stay_in_their_maximum() {
        let mut g = Graph::new();
        let [a, b, c] = ["0.12345678901234567891", "0.92345678901234567891", "0.5"].map(|digits| {
            let value = Rational::decimal(digits).unwrap();
            g.number(value)
        });
        for (first, second) in [(a, b), (b, a)] {
            let max = g.max(first, second);
            assert!(matches!(*g.node(max), Node::Max(x, y) if [x, y] == [a.min(b), a.max(b)]));
        }
        assert_eq!((g.max(a, c), g.max(b, c)), (c, b));
    }
}
