//! The editor's view: every name of a block in plain Rust, for hover, completion and go to
//! definition.
//!
//! The items are there for rust-analyzer alone; rustc never reads them. Names of parameters lead to
//! their fields, all others to their declarations in the block, and a block with mistakes gives
//! items of the same shape.

use crate::syntax::ast::{Binder, Block, Expr, ExprKind, ForceIndex, Statement};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// A hidden function that mentions every name of `block`.
pub(crate) fn function(block: &Block) -> TokenStream {
    let mut mirror = Mirror { block, declared: Vec::new(), uses: TokenStream::new() };
    mirror.statements();
    let (name, declared, uses) = (&block.name, &mirror.declared, &mirror.uses);
    let conditions = block.conditions();
    quote! {
        #(#conditions)*
        #[allow(unexpected_cfgs, deprecated)]
        const _: () = {
            #[cfg(rust_analyzer)]
            fn __names(parameters: &#name, #(#declared: ::core::primitive::f64),*) {
                #uses
            }
        };
    }
}

struct Mirror<'a> {
    block: &'a Block,
    declared: Vec<&'a Ident>,
    uses: TokenStream,
}

impl<'a> Mirror<'a> {
    fn statements(&mut self) {
        for statement in &self.block.statements {
            match statement {
                Statement::Coordinate { name, .. }
                | Statement::Driven { name, .. }
                | Statement::Input { name, .. } => self.declare(name),
                Statement::Let(definition) => self.declare(&definition.name),
                Statement::Energy { .. }
                | Statement::Force { .. }
                | Statement::Output(_)
                | Statement::Constraint(_)
                | Statement::Limit(_) => {}
            }
        }
        for statement in &self.block.statements {
            match statement {
                Statement::Coordinate { .. }
                | Statement::Driven { .. }
                | Statement::Input { .. } => {}
                Statement::Output(output) => {
                    if let Some(binder) = &output.index {
                        self.binder(binder);
                    }
                    self.expr(&output.expr);
                }
                Statement::Constraint(constraint) => {
                    if let Some(binder) = &constraint.index {
                        self.binder(binder);
                    }
                    self.expr(&constraint.difference);
                }
                Statement::Limit(limit) => {
                    if let Some(binder) = &limit.index {
                        self.binder(binder);
                    }
                    self.expr(&limit.difference);
                    self.expr(&limit.restitution);
                }
                Statement::Let(definition) => {
                    if let Some(binder) = &definition.index {
                        self.binder(binder);
                    }
                    self.expr(&definition.expr);
                }
                Statement::Energy { expr, .. } => self.expr(expr),
                Statement::Force { name, index, expr } => {
                    self.name(name);
                    match index {
                        Some(ForceIndex::One(index)) => self.expr(index),
                        Some(ForceIndex::Each(binder)) => self.binder(binder),
                        None => {}
                    }
                    self.expr(expr);
                }
            }
        }
    }

    fn declare(&mut self, name: &'a Ident) {
        if !self.declared.contains(&name) {
            self.declared.push(name);
        }
    }

    fn binder(&mut self, binder: &Binder) {
        self.expr(&binder.low);
        self.expr(&binder.high);
    }

    /// The name as an expression with its own span: a field, or an argument of the hidden function.
    fn name(&mut self, name: &Ident) {
        if self.block.fields.iter().any(|field| field.name == *name) {
            self.uses.extend(quote!(let _ = &parameters.#name;));
        } else if self.declared.contains(&name) {
            self.uses.extend(quote!(let _ = #name;));
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Name(name) | ExprKind::Call(name, _) => self.name(name),
            ExprKind::Integral { body, .. } => self.name(body),
            ExprKind::SumOver(binder, _) => self.binder(binder),
            _ => {}
        }
        for part in expr.parts() {
            self.expr(part);
        }
    }
}
