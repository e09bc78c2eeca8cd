//! What has no place in a formula, and what to write instead.

use super::statement::STATEMENTS;
use super::token::fragment;
use crate::ast::{Expr, ExprKind};
use crate::check::{FUNCTIONS, text};
use crate::error::Range;
use proc_macro2::{Delimiter, Ident, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::{Lit, Token};

/// Words that begin Rust expressions, and what to write instead.
#[rustfmt::skip]
pub(super) const FOREIGN: &[(&str, &str)] = &[
    ("if", "write `max`, `min`, `abs` or `sign` to tell cases apart"),
    ("match", "write `max`, `min`, `abs` or `sign` to tell cases apart"),
    ("for", "write `sum(k in 0..5, …)`"),
    ("while", "write `sum(k in 0..5, …)`"),
    ("loop", "write `sum(k in 0..5, …)`"),
    ("return", "leave it out"),
    ("unsafe", "leave it out"),
    ("move", "leave it out"),
];

/// Two operands side by side: there is no implicit multiplication.
pub(super) fn no_operand(input: ParseStream, left: &Expr, barred: bool) -> Result<()> {
    if input.peek(Token![as]) {
        return Err(Range::from(input.span()).error("`as` is Rust, which has no place in a formula; leave the type out"));
    }
    if fragment(input).is_some()
        || input.peek(Token![|]) && !barred
        || input.peek(Ident::peek_any) && !input.peek(Token![in])
        || input.peek(Lit) && !input.peek(Token![-])
        || input.peek(syn::token::Paren)
    {
        let token = input.fork().parse::<TokenTree>()?;
        let right = Range::from(token.span());
        if STATEMENTS.iter().any(|word| token.to_string() == *word) {
            return Err(right.error(format!("`;` is missing before `{token}`; end the statement above with `;`")));
        }
        return Err(match (&left.kind, &token) {
            (_, TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => match &left.kind {
                ExprKind::Name(_) | ExprKind::Number(_) => {
                    Range::from(group.span_open()).error("there is no implicit multiplication; write `*` before `(`")
                }
                _ => Range::from(group.span_open()).error("an operator is missing before `(`; write `*` to multiply"),
            },
            _ => right.error(format!("there is no implicit multiplication; write `*` before `{token}`")),
        });
    }
    Ok(())
}

/// A method call, and what to write instead.
pub(super) fn method(input: ParseStream, base: &Expr, name: &Ident) -> syn::Error {
    let function = name.to_string();
    let base = text(base);
    let arguments = input.fork().parse::<TokenTree>().map(|group| group.to_string()).unwrap_or_default();
    let instead = match function.as_str() {
        "powi" | "powf" => format!("`{base}^{}`", arguments.trim_start_matches('(').trim_end_matches(')')),
        _ if FUNCTIONS.contains(&(&function, 1)) => format!("`{function}({base})`"),
        _ => "a function of the language, as in `sin(θ)`".to_owned(),
    };
    Range::from(name.span()).error(format!("`.{function}()` is Rust, which has no place in a formula; write {instead}"))
}
