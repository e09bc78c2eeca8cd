//! Notations of other languages that are told from names only after all declarations.

use super::Walk;
use crate::messages::{Range, Text, message};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::elsewhere::{MODULES, constant};
use crate::syntax::name::{self, plain};
use crate::syntax::text::text;
use proc_macro2::Ident;

impl Walk<'_, '_, '_> {
    /// Returns the message for a constant of a module, as `np.pi`, or a quotient of differentials,
    /// as `dx/dt` and `d(x)/dt`, with its place.
    pub(super) fn of_another_language(&self, expr: &Expr) -> Option<(Range, Text)> {
        match &expr.kind {
            ExprKind::Component(base, component) => {
                let ExprKind::Name(module) = &base.kind else { return None };
                if !MODULES.iter().any(|known| module == known) || !self.undeclared(module) {
                    return None;
                }
                let component = component.to_string();
                let value = constant(&component, self.model.block.ascii).unwrap_or(component);
                let message = message!("a constant stands without `{module}`; write `{value}`");
                Some((expr.range, message))
            }
            ExprKind::Product(factors) => factors.windows(2).find_map(|pair| {
                let [(_, above), (true, below)] = pair else { return None };
                let velocity = self.quotient(above, below)?;
                let message = message!("`dt` is no quantity; write {velocity}");
                Some((above.range.to(below.range), message))
            }),
            _ => None,
        }
    }

    /// Returns the velocity that a quotient of differentials denotes.
    fn quotient(&self, above: &Expr, below: &Expr) -> Option<String> {
        let ExprKind::Name(dt) = &below.kind else { return None };
        if dt != "dt" || !self.undeclared(dt) {
            return None;
        }
        match &above.kind {
            ExprKind::Name(name) if self.undeclared(name) => {
                let name = name.to_string();
                let moving = name.strip_prefix('d')?;
                self.has_velocity(moving).then(|| name::dotted(moving))
            }
            ExprKind::Call(d, items) if d == "d" && self.undeclared(d) => {
                let [moving] = items.as_slice() else { return None };
                Some(format!("`dot({})`", text(moving)))
            }
            _ => None,
        }
    }

    /// Returns `true` if a name is not declared and no declaration has been lost by a mistake.
    fn undeclared(&self, ident: &Ident) -> bool {
        let base = plain(ident);
        !self.model.names.contains_key(&base)
            && !self.scope.contains(&base)
            && !self.model.block.recovery.declarations
    }
}
