//! The definitions that an expression needs.

use super::resolved::{Meaning, Model};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name;
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// The definitions that outputs need, and neither an energy, a force, a constraint nor a limit.
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
    /// A name that is hidden by an index or an argument counts as well: the definition is then
    /// taken for one of the equations, where less may stand.
    fn name(&mut self, ident: &Ident) {
        let base = name::read(&ident.to_string()).base;
        if let Some(&Meaning::Let(index)) = self.model.names.get(&base)
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
