//! Constants known at compile time. Constants that are not real numbers are refused where they are
//! written.

use super::context::Lower;
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::messages::message;
use crate::syntax::ast::Expr;
use crate::syntax::text::text;

impl Lower<'_, '_, '_, '_> {
    /// Returns a value, or refuses it if it is a constant that is not finite.
    pub(super) fn real(&mut self, value: Value, expr: &Expr) -> Value {
        let Value::Scalar(id) = value else { return value };
        if self.graph.dependencies(id) != Dependencies::default()
            || matches!(self.graph.node(id), Node::Number(_))
        {
            return value;
        }
        let number = self.constant(id);
        let vanishes = match self.graph.node(id) {
            Node::Product(_, factors) => {
                factors.iter().any(|(base, _)| self.constants[base] == 0.0)
            }
            Node::Call(Function::Exp | Function::Sech, _) => false,
            _ => true,
        };
        let message = if number == 0.0 && !vanishes {
            message!("`{}` is below the range of `f64`; write zero, or another operand", text(expr))
        } else if number.is_finite() {
            return value;
        } else if number.is_nan() {
            message!("`{}` is no real number; write an operand for which it is", text(expr))
        } else {
            let text = text(expr);
            message!("`{text}` is infinite or beyond the range of `f64`; write another operand")
        };
        self.wrong(expr, message)
    }

    /// Returns the value of a constant; NaN or infinity if it is no real number.
    pub(super) fn constant(&mut self, id: Id) -> f64 {
        if let Some(&known) = self.constants.get(&id) {
            return known;
        }
        for child in self.graph.children(id) {
            self.constant(child);
        }
        let exception = match *self.graph.node(id) {
            // The nearest double to a pole has a finite tangent.
            Node::Call(Function::Tan, angle) => {
                self.is_zero(Function::Cos, angle).then_some(f64::INFINITY)
            }
            Node::Call(function @ (Function::Sin | Function::Cos), angle) => {
                self.is_zero(function, angle).then_some(0.0)
            }
            Node::Call(Function::Table(index, _), argument) => {
                let written = self.model.tables[&index].written.as_ref();
                written.map(|(_, spline)| spline.value(self.constants[&argument]))
            }
            // The origin has no angle, where the function of `f64` returns zero.
            Node::Atan2(Graph::ZERO, Graph::ZERO) => Some(f64::NAN),
            _ => None,
        };
        let number = exception.unwrap_or_else(|| {
            evaluate(self.graph, id, |child| self.constants[&child], &|_| f64::NAN)
        });
        self.constants.insert(id, number);
        number
    }

    /// Returns `true` if the rounding of the angle alone may make the sine or cosine what it is:
    /// what is divided by it would have no digits.
    fn is_zero(&self, function: Function, angle: Id) -> bool {
        // Whole numbers far beyond any angle are exact, and so are their sines.
        const FAR: f64 = 1e6;
        let angle = self.constants[&angle];
        function.value(angle).abs() <= f64::EPSILON * angle.abs().min(FAR)
    }
}

/// Evaluates a node in floating point, given the values of its children and of the symbols.
pub(crate) fn evaluate(
    graph: &Graph,
    id: Id,
    known: impl Fn(Id) -> f64,
    symbol: &dyn Fn(Symbol) -> f64,
) -> f64 {
    match graph.node(id) {
        Node::Number(number) | Node::Opaque(Literal::Exact(number)) => ratio(*number),
        Node::Opaque(Literal::Decimal(digits)) => digits.parse().unwrap_or(f64::NAN),
        Node::Pi => std::f64::consts::PI,
        Node::Symbol(own) => symbol(*own),
        Node::Sum(terms) => {
            terms.iter().map(|&(term, coefficient)| ratio(coefficient) * known(term)).sum()
        }
        Node::Product(coefficient, factors) => {
            factors.iter().fold(ratio(*coefficient), |product, &(base, exponent)| {
                product * known(base).powf(ratio(exponent))
            })
        }
        Node::Call(function, argument) => function.value(known(*argument)),
        Node::Atan2(y, x) => known(*y).atan2(known(*x)),
        Node::Max(a, b) => known(*a).max(known(*b)),
        Node::Atom(inner) => known(*inner),
    }
}

fn ratio(number: Rational) -> f64 {
    number.numerator() as f64 / number.denominator() as f64
}
