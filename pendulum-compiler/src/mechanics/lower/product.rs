//! Sums and products as they are written: terms of one kind, and factors of which matrices and
//! rotations act on the vector behind them.

use super::context::Lower;
use super::rotation::Rotation;
use super::value::Value;
use crate::algebra::expr::Graph;
use crate::messages::{Text, message};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::text::text;

impl Lower<'_, '_, '_, '_> {
    pub(super) fn sum(&mut self, items: &[(bool, Expr)]) -> Value {
        let mut total = None;
        for (index, (minus, item)) in items.iter().enumerate() {
            let mut value = self.expr(item);
            if *minus {
                value = self.map(value, Graph::negative);
            }
            total = Some(match total {
                None => value,
                Some(sum) => {
                    let product = match (&sum, &value) {
                        (Value::Plane { complex: false, .. }, Value::Scalar(scalar))
                        | (Value::Scalar(scalar), Value::Plane { complex: false, .. })
                            if *scalar != Graph::ZERO =>
                        {
                            items[..=index].iter().find_map(|(_, item)| self.vector_product(item))
                        }
                        _ => None,
                    };
                    product.unwrap_or_else(|| self.add(sum, value, item))
                }
            });
        }
        total.unwrap_or(Value::Bad)
    }

    pub(super) fn product(&mut self, items: &[(bool, Expr)]) -> Value {
        let mut total = Value::Scalar(Graph::ONE);
        let mut vector: Option<&Expr> = None;
        // The rotations that have not met a vector, and `true` if there are other factors.
        let mut rotation: Option<Rotation> = None;
        let mut scaled = false;
        for (index, (over, item)) in items.iter().enumerate() {
            let (minus, unsigned) = Self::unsigned(item);
            let mut value = self.expr(unsigned);
            let matrix = matches!(value, Value::Matrix(_));
            if let Value::Rotation(own) = &value {
                if *over || vector.is_some() {
                    let (found, all) = (text(unsigned), if *over { "divisor" } else { "factor" });
                    let message = message!(
                        "`{found}` is a rotation, which stands before the vector that it turns \
                         and is no {all} here; write `{found}*u`, or `transpose({found})*u` to \
                         turn back"
                    );
                    return self.wrong(item, message);
                }
                if minus {
                    total = self.map(total, Graph::negative);
                    scaled = true;
                }
                rotation = match rotation {
                    None => Some(own.clone()),
                    Some(rotation) => match self.compose(rotation, own, item) {
                        None => return Value::Bad,
                        product => product,
                    },
                };
                continue;
            }
            if let Value::Matrix(entries) = value {
                value = self.matrix_product(entries, unsigned, *over, &items[index + 1..]);
            }
            if minus {
                value = self.map(value, Graph::negative);
            }
            if let Some(before) = &rotation
                && !*over
                && !matches!(value, Value::Scalar(_))
            {
                value = self.image(before, value, item);
                rotation = None;
            } else {
                scaled = true;
            }
            if let Value::Space(_) | Value::Turned(_) = value {
                if let (Value::Space(_) | Value::Turned(_), Some(left), false) =
                    (&total, vector, *over)
                {
                    let (a, rest) = (text(left), if matrix { "*…" } else { "" });
                    let b = format!("{}{rest}", text(item));
                    let message = message!(
                        "the product of two space vectors is ambiguous; write `inner({a}, {b})` \
                         or `cross({a}, {b})`"
                    );
                    return self.wrong(item, message);
                }
                vector = Some(item);
            }
            total = if *over {
                self.divide(total, value, item)
            } else if index == 0 {
                value
            } else {
                self.multiply(total, value, item)
            };
            if matrix {
                break;
            }
        }
        match (rotation, &total) {
            (None, _) | (_, Value::Bad) => total,
            (Some(rotation), Value::Scalar(_)) if !scaled => Value::Rotation(rotation),
            (Some(_), _) => match items.last() {
                Some((_, last)) => self.wrong(last, multiple_of_rotation()),
                None => Value::Bad,
            },
        }
    }

    /// Reports an expression that is the product of two plane vectors but has to be a scalar.
    pub(super) fn vector_product(&mut self, expr: &Expr) -> Option<Value> {
        match &expr.kind {
            ExprKind::Negative(inner) => self.vector_product(inner),
            ExprKind::Product(items) => {
                let factors = items.iter().map(|(_, item)| item);
                let vectors: Vec<String> = factors
                    .filter(|item| matches!(self.expr(item), Value::Plane { complex: false, .. }))
                    .map(text)
                    .collect();
                let [a, b] = vectors.as_slice() else { return None };
                let message = message!(
                    "`{}` is the complex product of two plane vectors, but a scalar is needed \
                     here; write `inner({a}, {b})`",
                    text(expr)
                );
                Some(self.wrong(expr, message))
            }
            _ => None,
        }
    }
}

/// The message about a rotation with factors and without a vector.
pub(super) fn multiple_of_rotation() -> Text {
    message!(
        "a rotation has no multiples, and no vector follows it here; write the vector that it \
         turns behind it, as in `2*R*u`"
    )
}
