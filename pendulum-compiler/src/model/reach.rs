//! The definitions that an expression uses.

use super::resolved::{Meaning, Model};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name::plain;
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// Returns the definitions used by outputs but not by any energy, force, constraint or limit.
pub(super) fn of_outputs(model: &Model) -> BTreeSet<usize> {
    let mut equations = Reach { model, found: BTreeSet::new() };
    for contribution in model.contributions() {
        contribution.exprs.into_iter().for_each(|expr| equations.expr(expr));
    }
    let mut outputs = Reach { model, found: BTreeSet::new() };
    for output in &model.outputs {
        outputs.expr(&output.statement.expr);
    }
    outputs.found.difference(&equations.found).copied().collect()
}

struct Reach<'m, 'a> {
    model: &'m Model<'a>,
    found: BTreeSet<usize>,
}

impl Reach<'_, '_> {
    /// Visits a name. A name hidden by an index or an argument counts as well. Its definition is
    /// then treated as part of the equations, where fewer expressions are allowed.
    fn name(&mut self, ident: &Ident) {
        if let Some(&Meaning::Let(index)) = self.model.names.get(&plain(ident))
            && self.found.insert(index)
        {
            self.expr(&self.model.lets[index].expr);
        }
    }

    fn expr(&mut self, expr: &Expr) {
        if let ExprKind::Name(name) | ExprKind::Call(name, _) = &expr.kind {
            self.name(name);
        }
        for part in expr.parts() {
            self.expr(part);
        }
    }
}
