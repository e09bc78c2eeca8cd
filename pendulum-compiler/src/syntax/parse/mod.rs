//! Tokens to syntax: a parser with error recovery, whose operators have the precedence of
//! mathematics instead of Rust's.
//!
//! Precedence, low to high: `+ -`, `* /`, unary `-`, `^` (right-associative), call, index, `|…|`. A
//! statement that cannot be parsed is reported and skipped up to its `;`, so that several mistakes
//! are reported separately.

mod block;
mod expr;
mod foreign;
mod row;
pub(crate) mod statement;
mod table;
mod token;

use crate::messages::Errors;
use crate::syntax::ast::{Block, Recovery, Statement};
use crate::syntax::name;
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::parse::{ParseStream, Parser as Syn, Result};
use syn::{Token, braced};
use token::{drain, identifier};

/// Parses the path of the runtime and a block; `None` if not even the struct could be parsed.
pub(crate) fn all(input: TokenStream, errors: &mut Errors) -> Option<(TokenStream, Block)> {
    let mut parsed = None;
    let ascii = is_ascii(input.clone());
    let outcome = Syn::parse2(|input: ParseStream| Ok((runtime(input)?, input.parse()?)), input);
    let outcome = outcome.and_then(|(krate, tokens): (TokenStream, TokenStream)| {
        to_the_last(tokens, |input| {
            let mut parser = Parser {
                errors: &mut *errors,
                sources: 0,
                depth: 0,
                barred: false,
                recovery: Recovery::default(),
                begun: Vec::new(),
                declared: BTreeSet::new(),
                ascii,
            };
            match parser.block(input) {
                Ok(block) => parsed = Some((krate, block)),
                Err(error) => errors.push(error),
            }
            drain(input);
            Ok(())
        })
    });
    // Remaining tokens in brackets after recovery have been reported already.
    if let Err(error) = outcome
        && errors.is_empty()
    {
        errors.push(error);
        parsed = None;
    }
    parsed
}

/// Returns `true` if all names are ASCII. Comments and literals are not checked.
fn is_ascii(tokens: TokenStream) -> bool {
    tokens.into_iter().all(|tree| match tree {
        TokenTree::Ident(name) => name.to_string().is_ascii(),
        TokenTree::Group(group) => is_ascii(group.stream()),
        TokenTree::Punct(_) | TokenTree::Literal(_) => true,
    })
}

/// Parses the path of the runtime, up to the first `;`.
fn runtime(input: ParseStream) -> Result<TokenStream> {
    let mut path = TokenStream::new();
    while !input.is_empty() && !input.peek(Token![;]) {
        path.extend([input.parse::<TokenTree>()?]);
    }
    input.parse::<Token![;]>()?;
    Ok(path)
}

/// Parses tokens so that an error at their end is reported at the last token instead of the whole
/// macro.
fn to_the_last<R>(tokens: TokenStream, parse: impl FnOnce(ParseStream) -> Result<R>) -> Result<R> {
    let last = match tokens.clone().into_iter().last() {
        Some(TokenTree::Group(group)) => group.span_close(),
        Some(token) => token.span(),
        None => Span::call_site(),
    };
    let mut group = Group::new(Delimiter::Brace, tokens);
    group.set_span(last);
    let parse = |input: ParseStream| {
        let content;
        braced!(content in input);
        parse(&content)
    };
    Syn::parse2(parse, TokenTree::Group(group).into())
}

struct Parser<'a> {
    errors: &'a mut Errors,
    sources: usize,
    depth: usize,
    /// `true` if a `|` closes the current expression.
    barred: bool,
    recovery: Recovery,
    /// The coordinates of a statement that ends in a mistake, as far as they could be parsed.
    begun: Vec<Statement>,
    /// The names declared so far.
    declared: BTreeSet<String>,
    /// `true` if all names of the block are ASCII.
    ascii: bool,
}

impl Parser<'_> {
    /// Parses a name and records it as declared.
    fn declared(&mut self, input: ParseStream, expected: &str) -> Result<Ident> {
        let name = identifier(input, expected)?;
        self.declared.insert(name::plain(&name));
        Ok(name)
    }

    fn is_declared(&self, name: &str) -> bool {
        self.declared.contains(&name::read(name).base)
    }
}
