//! Vectors in the plane and in space, and complex numbers.

use super::{Generator, May};
use crate::nilpotent::Function;
use crate::tree::{
    Expr, Kind, Operation, Property, Type, call, number, power, product, quotient, sum,
};

impl Generator {
    pub(crate) fn plane(&mut self, depth: usize, may: May) -> Expr {
        let whole = self.whole(2, may);
        if depth == 0 {
            return whole.unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)]));
        }
        let inner = depth - 1;
        match self.random.below(12) {
            0 => whole.unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)])),
            1 | 2 => sum(self.plane(inner, may), self.plane(inner, may)),
            3 => product(self.scalar(inner, may), self.plane(inner, may)),
            4 => Operation::Perp.of([self.plane(inner, may)]),
            5 | 6 => {
                product(Expr::Cis(Box::new(self.angle(inner, may)), false), self.plane(inner, may))
            }
            7 => self.complex(depth, may),
            8 | 9 => self
                .use_let(Type::Plane, inner, may)
                .unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)])),
            10 => {
                let angle = self.angle(0, may);
                let cos = Expr::Negative(Box::new(call(Function::Cos, angle.clone())));
                product(self.leaf(may), Expr::Vector(vec![call(Function::Sin, angle), cos]))
            }
            _ => Expr::Vector(vec![self.scalar(inner, may), self.scalar(inner, may)]),
        }
    }

    /// Returns a quantity that is declared as a vector.
    fn whole(&mut self, components: usize, may: May) -> Option<Expr> {
        let argument = may.arguments.iter().position(|&kind| kind == Type::Plane);
        if let Some(index) = argument
            && components == 2
            && self.random.once_in(2)
        {
            return Some(Expr::Argument(index));
        }
        let mut found = Vec::new();
        for (index, parameter) in self.system.parameters.iter().enumerate() {
            match parameter.kind {
                Kind::Vector(count) if count == components => found.push(Expr::Parameter(index)),
                Kind::Body if components == 2 => found.push(self.property(index, Property::Center)),
                _ => {}
            }
        }
        for (index, input) in self.system.inputs.iter().enumerate() {
            if input.components == components {
                found.push(Expr::Input(index, 0));
            }
        }
        if found.is_empty() {
            None
        } else {
            Some(found.swap_remove(self.random.below(found.len())))
        }
    }

    /// Returns an expression written as a complex number.
    pub(crate) fn complex(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth.saturating_sub(1);
        let cis = |generator: &mut Self| {
            let angle = Box::new(generator.angle(inner, may));
            Expr::Cis(angle, generator.random.once_in(2))
        };
        match self.random.below(9) {
            0 if 0 < depth => product(self.complex(inner, may), self.complex(inner, may)),
            1 if 0 < depth => sum(self.complex(inner, may), self.scalar(inner, may)),
            2 if 0 < depth => power(self.complex(inner, may), 2 + (depth % 2) as i64),
            3 => quotient(cis(self), cis(self)),
            4 => product(self.leaf(may), cis(self)),
            5 => sum(self.leaf(may), product(Expr::Imaginary, self.leaf(may))),
            6 if 0 < depth => self.use_let(Type::Complex, inner, may).unwrap_or_else(|| cis(self)),
            7 => quotient(cis(self), self.positive_parameter()),
            _ => cis(self),
        }
    }

    pub(crate) fn space(&mut self, depth: usize, may: May) -> Expr {
        let plain = |generator: &mut Self, depth| {
            Expr::Vector((0..3).map(|_| generator.scalar(depth, may)).collect())
        };
        if depth == 0 {
            return self.whole(3, may).unwrap_or_else(|| plain(self, 0));
        }
        let inner = depth - 1;
        match self.random.below(6) {
            0 => self.whole(3, may).unwrap_or_else(|| plain(self, 0)),
            1 => sum(self.space(inner, may), self.space(inner, may)),
            2 => product(self.scalar(inner, may), self.space(inner, may)),
            3 => Operation::Cross.of([self.space(inner, may), self.space(inner, may)]),
            4 => self.use_let(Type::Space, inner, may).unwrap_or_else(|| plain(self, 0)),
            _ => plain(self, inner.min(1)),
        }
    }

    /// Returns a vector that depends on the coordinates, so that it may be differentiated.
    pub(crate) fn moved(&mut self, vector: Expr) -> Expr {
        let may = May { velocities: false, orders: 0, lets: 0, bound: None, arguments: &[] };
        let shift =
            Expr::Vector(vec![self.coordinate(may), product(number(2), self.coordinate(may))]);
        sum(vector, shift)
    }
}
