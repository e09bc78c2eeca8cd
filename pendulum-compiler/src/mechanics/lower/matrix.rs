//! Products of symmetric matrices and vectors.

use super::context::Lower;
use super::value::Value;
use crate::algebra::expr::Id;
use crate::messages::message;
use crate::syntax::ast::Expr;
use crate::syntax::text::text;

impl Lower<'_, '_, '_, '_> {
    /// Returns the product of a symmetric matrix and of the factors behind it, whose product is a
    /// vector.
    pub(super) fn matrix_product(
        &mut self,
        entries: [Id; 6],
        item: &Expr,
        over: bool,
        rest: &[(bool, Expr)],
    ) -> Value {
        let vector = if over || rest.is_empty() {
            None
        } else {
            let product = self.product(rest);
            Some(self.components(product))
        };
        match vector {
            Some(Value::Bad) => Value::Bad,
            Some(Value::Space(vector)) => {
                let [xx, yy, zz, xy, xz, yz] = entries;
                let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                Value::Space(rows.map(|row| self.graph.inner(&row, &vector)))
            }
            _ => {
                let found = text(item);
                let message = message!(
                    "`{found}` is a matrix, which multiplies the space vector behind it; write \
                     `{found}*u`"
                );
                self.wrong(item, message)
            }
        }
    }
}
