//! Definitions and their uses.

use super::{Generator, May};
use crate::nilpotent::Function;
use crate::tree::{Expr, Let, Operation, Shape, Type};

const LETS: [&str; 6] = ["P", "ζ", "G", "H", "W", "Z"];
const FUNCTIONS: [&[Type]; 4] =
    [&[Type::Scalar], &[Type::Plane], &[Type::Scalar, Type::Plane], &[Type::Scalar, Type::Scalar]];

impl Generator {
    pub(crate) fn define(&mut self) {
        for index in 0..self.random.below(4) {
            let kind = self.random.of(&[
                Type::Scalar,
                Type::Plane,
                Type::Plane,
                Type::Complex,
                Type::Space,
            ]);
            let mut may =
                May { velocities: false, orders: 0, lets: index, bound: None, arguments: &[] };
            let shape = match self.random.below(5) {
                0 | 1 => Shape::Plain,
                2 | 3 => {
                    let count = 1 + self.random.below(4);
                    may.bound = Some(count);
                    Shape::Indexed(count)
                }
                _ => {
                    may.arguments = FUNCTIONS[self.random.below(FUNCTIONS.len())];
                    Shape::Function(may.arguments.to_vec())
                }
            };
            let expr = self.typed(kind, 3, may);
            self.system.lets.push(Let { name: LETS[index].to_owned(), shape, kind, expr });
        }
    }

    pub(crate) fn use_let(&mut self, kind: Type, depth: usize, may: May) -> Option<Expr> {
        if may.lets == 0 {
            return None;
        }
        let index = self.random.below(may.lets);
        let definition = self.system.lets[index].clone();
        if definition.kind != kind && !(kind == Type::Plane && definition.kind == Type::Complex) {
            return None;
        }
        let derived = may.velocities && self.random.once_in(2);
        let value = match definition.shape {
            Shape::Plain if derived && self.random.once_in(2) && moves(&definition.expr) => {
                return Some(self.rate(Expr::LetDot(index)));
            }
            Shape::Plain => Expr::Let(index),
            Shape::Indexed(count) => Expr::LetMember(index, self.index(count, may)),
            Shape::Function(types) => {
                let still = May { velocities: false, orders: 0, ..may };
                let arguments =
                    types.iter().map(|&kind| self.typed(kind, depth.min(1), still)).collect();
                Expr::Apply(index, arguments)
            }
        };
        if derived && kind == Type::Plane {
            let value = self.moved(value);
            return Some(self.rate(Operation::Dot.of([value])));
        }
        Some(value)
    }
}

/// Returns `true` if an expression contains a coordinate that no simplification can remove.
fn moves(expr: &Expr) -> bool {
    match expr {
        Expr::Coordinate(..) => true,
        Expr::Vector(items) => items.iter().any(moves),
        Expr::Call(Function::Sin | Function::Cos | Function::Exp, inner) => moves(inner),
        Expr::Cis(inner, _) => moves(inner),
        _ => false,
    }
}
