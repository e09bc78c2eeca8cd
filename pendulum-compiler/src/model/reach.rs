//! The definitions that an expression needs.

use super::{Meaning, Model};
use crate::syntax::ast::{Expr, ExprKind, ForceIndex};
use crate::syntax::name;
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// The definitions that outputs need, and neither an energy nor a force.
pub(super) fn of_outputs(model: &Model) -> BTreeSet<usize> {
    let mut equations = Reach { model, found: BTreeSet::new() };
    for (_, expr) in &model.energies {
        equations.expr(expr);
    }
    for force in &model.forces {
        if let Some(ForceIndex::One(index)) = force.index {
            equations.expr(index);
        }
        equations.expr(force.expr);
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
        match &expr.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name(name) => self.name(name),
            ExprKind::Sum(items) | ExprKind::Product(items) => {
                for (_, item) in items {
                    self.expr(item);
                }
            }
            ExprKind::Negative(a) | ExprKind::Magnitude(a) | ExprKind::Component(a, _) => {
                self.expr(a);
            }
            ExprKind::Power(a, b) | ExprKind::Index(a, b) => {
                self.expr(a);
                self.expr(b);
            }
            ExprKind::Call(name, items) => {
                self.name(name);
                for item in items {
                    self.expr(item);
                }
            }
            ExprKind::Vector(items) => {
                for item in items {
                    self.expr(item);
                }
            }
            ExprKind::SumOver(_, term) => self.expr(term),
            ExprKind::Integral { integrand, .. } => self.expr(integrand),
        }
    }
}
