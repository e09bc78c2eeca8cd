//! Scalar expressions: arbitrary, bounded, positive or wild.

use super::{Generator, Manner, May};
use crate::nilpotent::Function;
use crate::tree::{Expr, Kind, Operation, Type, call, number, power, product, quotient, sum};

impl Generator {
    pub(crate) fn scalar(&mut self, depth: usize, may: May) -> Expr {
        if depth == 0 {
            return self.leaf(may);
        }
        if self.manner == Manner::Wild && self.random.once_in(3) {
            return self.wild(depth, may);
        }
        let inner = depth - 1;
        match self.random.below(22) {
            0..=2 => {
                let items = (0..2 + self.random.below(2))
                    .map(|_| (self.random.once_in(3), self.scalar(inner, may)));
                Expr::Sum(items.collect())
            }
            3..=5 => product(self.scalar(inner, may), self.scalar(inner, may)),
            6 => {
                let divisor = self.positive(inner, may);
                let divided = quotient(self.scalar(inner, may), divisor);
                if self.random.once_in(3) { product(divided, self.scalar(0, may)) } else { divided }
            }
            7 => Expr::Negative(Box::new(self.scalar(inner, may))),
            8 => {
                let exponent = self.random.of(&[2, 2, 3]);
                power(self.scalar(inner, may), exponent)
            }
            9 => {
                let (top, bottom) =
                    self.random.of(&[(1, 2), (-1, 2), (3, 2), (2, 3), (-1, 1), (-2, 1), (5, 4)]);
                Expr::Power(Box::new(self.positive(inner, may)), top, bottom)
            }
            10 => Operation::Power.of([self.positive(inner, may), self.bounded(inner, may)]),
            11..=14 => self.bounded(depth, may),
            15 | 16 => self.of_vector(inner, may),
            17 => self.sum_over(inner, may),
            18 => {
                let items = [self.scalar(inner, may), self.scalar(inner, may)];
                self.random.of(&[Operation::Max, Operation::Min]).of(items)
            }
            19 => self.use_let(Type::Scalar, inner, may).unwrap_or_else(|| self.leaf(may)),
            20 => self.integral(may).unwrap_or_else(|| self.leaf(may)),
            _ => self.leaf(may),
        }
    }

    /// Returns an expression of at most moderate magnitude.
    pub(crate) fn bounded(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth.saturating_sub(1);
        let angle = |generator: &mut Self| generator.angle(inner, may);
        let ring = |generator: &mut Self, function| call(function, generator.angle(inner, may));
        match self.random.below(17) {
            0..=3 => ring(self, Function::Sin),
            4..=7 => ring(self, Function::Cos),
            8 => call(Function::Tanh, angle(self)),
            9 => call(Function::Atan, angle(self)),
            10 => {
                let half = quotient(ring(self, Function::Sin), number(2));
                let function = self.random.of(&[
                    Function::Asin,
                    Function::Acos,
                    Function::Tan,
                    Function::Sinh,
                    Function::Cosh,
                ]);
                call(function, half)
            }
            11 => call(Function::Exp, Expr::Negative(Box::new(power(angle(self), 2)))),
            12 => call(Function::Exp, ring(self, Function::Cos)),
            13 => Operation::Atan2.of([angle(self), self.positive(inner, may)]),
            14 => call(Function::Ln, self.positive(inner, may)),
            15 => {
                let function = self.random.of(&[Function::Abs, Function::Sign]);
                let argument = ring(self, Function::Sin);
                call(function, argument)
            }
            _ => {
                let x = angle(self);
                quotient(x.clone(), sum(number(1), power(x, 2)))
            }
        }
    }

    /// Returns a sum that a trigonometric function may expand.
    pub(crate) fn angle(&mut self, depth: usize, may: May) -> Expr {
        if 0 < depth && self.random.once_in(3) {
            return self.scalar(depth - 1, may);
        }
        let (a, b) = (self.leaf(may), self.leaf(may));
        match self.random.below(7) {
            0 => sum(a, b),
            1 => Expr::Sum(vec![(false, a), (true, b)]),
            2 => product(number(2), a),
            3 => quotient(a, number(2)),
            4 => Expr::Sum(vec![(false, a), (true, quotient(Expr::Pi, number(2)))]),
            _ => a,
        }
    }

    /// Returns an expression that is at least one half.
    pub(crate) fn positive(&mut self, depth: usize, may: May) -> Expr {
        match self.random.below(5) {
            0 => sum(number(1), power(self.scalar(depth, may), 2)),
            1 => sum(number(2), call(Function::Sin, self.angle(depth, may))),
            2 => self.positive_parameter(),
            3 => call(Function::Cosh, self.bounded(depth, may)),
            _ => {
                let vector = self.plane(depth.min(1), may);
                sum(number(1), power(Operation::Magnitude.of([vector]), 2))
            }
        }
    }

    /// Returns a function of an arbitrary expression.
    fn wild(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth - 1;
        let a = self.scalar(inner, may);
        let functions = [
            Function::Sqrt,
            Function::Exp,
            Function::Ln,
            Function::Tan,
            Function::Asin,
            Function::Acos,
            Function::Sinh,
            Function::Cosh,
            Function::Abs,
            Function::Sign,
        ];
        match self.random.below(8) {
            0..=2 => call(self.random.of(&functions), a),
            3 => quotient(a, self.scalar(inner, may)),
            4 => {
                let (top, bottom) =
                    self.random.of(&[(1, 3), (-3, 2), (7, 1), (-5, 1), (1, 4), (11, 7), (0, 1)]);
                Expr::Power(Box::new(a), top, bottom)
            }
            5 => Operation::Power.of([a, self.scalar(inner, may)]),
            6 => Operation::Atan2.of([a, Operation::Magnitude.of([self.plane(inner, may)])]),
            _ => Expr::Sum(vec![(false, a.clone()), (true, a)]),
        }
    }

    fn sum_over(&mut self, depth: usize, may: May) -> Expr {
        // Sums are not nested, because all of them bind index 0.
        if may.bound.is_some() {
            return self.leaf(may);
        }
        let count = 1 + self.random.below(4);
        let term = self.scalar(depth, May { bound: Some(count), ..may });
        Expr::Over(0, count, self.random.once_in(3), Box::new(term))
    }

    fn of_vector(&mut self, depth: usize, may: May) -> Expr {
        let (plane, space) = (
            |generator: &mut Self| generator.plane(depth, may),
            |generator: &mut Self| generator.space(depth, may),
        );
        match self.random.below(9) {
            0 => Operation::Inner.of([plane(self), plane(self)]),
            1 => Operation::Inner.of([space(self), space(self)]),
            2 => Operation::Cross.of([plane(self), plane(self)]),
            3 => Operation::Height.of([plane(self)]),
            4 => Operation::Height.of([space(self)]),
            5 => Expr::Component(Box::new(plane(self)), self.random.below(2)),
            6 => Expr::Component(Box::new(space(self)), self.random.below(3)),
            7 => power(Operation::Magnitude.of([space(self)]), 2),
            _ => {
                // The length of a vector that is never short.
                let parts = [self.positive(depth, may), self.scalar(depth, may)];
                Operation::Magnitude.of([Expr::Vector(parts.to_vec())])
            }
        }
    }

    /// Returns the integral of the square of a velocity, of a height, or of a function of the
    /// point.
    fn integral(&mut self, may: May) -> Option<Expr> {
        let body =
            self.system.parameters.iter().position(|parameter| parameter.kind == Kind::Body)?;
        let still = May { velocities: false, orders: 0, arguments: &[], ..may };
        let point = quotient(Expr::Point, self.measure(Kind::Length));
        let turned = product(Expr::Cis(Box::new(self.angle(1, still)), false), point.clone());
        let place = sum(self.plane(1, still), turned);
        let integrand = match self.random.below(3) {
            0 if may.velocities => {
                let moved = self.moved(place);
                let velocity = self.rate(Operation::Dot.of([moved]));
                quotient(power(Operation::Magnitude.of([velocity]), 2), number(2))
            }
            1 => product(Operation::Height.of([place]), Expr::Component(Box::new(point), 0)),
            _ => Operation::Height.of([place]),
        };
        Some(quotient(Expr::Integral(body, Box::new(integrand)), self.measure(Kind::Mass)))
    }
}
