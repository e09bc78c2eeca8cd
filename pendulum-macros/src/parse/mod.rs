//! Tokens to syntax: a recovering parser whose operators bind as in mathematics, not as in Rust.
//!
//! Precedence, low to high: `+ -`, `* /`, unary `-`, `^` (to the right), call, index, `|…|`. A statement that does not parse is
//! reported and skipped to its `;`, so that two mistakes give two messages.

mod block;
mod expr;
mod foreign;
mod statement;
mod token;

use crate::ast::{Block, Lost, Statement};
use crate::error::Errors;
use proc_macro2::{TokenStream, TokenTree};
use syn::Token;
use syn::parse::{ParseStream, Parser as Syn, Result};
use token::drain;

/// Parses the path of the runtime and a block; `None` if not even the struct could be read.
pub(crate) fn all(input: TokenStream, errors: &mut Errors) -> Option<(TokenStream, Block)> {
    let mut parsed = None;
    let ascii = is_ascii(input.clone());
    let outcome = Syn::parse2(
        |input: ParseStream| {
            let krate = runtime(input)?;
            let mut parser =
                Parser { errors: &mut *errors, sources: 0, depth: 0, barred: false, lost: Lost::default(), begun: None, ascii };
            match parser.block(input) {
                Ok(block) => parsed = Some((krate, block)),
                Err(error) => errors.push(error),
            }
            drain(input);
            Ok(())
        },
        input,
    );
    // What recovery has left in some bracket has been reported already.
    if let Err(error) = outcome
        && errors.is_empty()
    {
        errors.push(error);
        parsed = None;
    }
    parsed
}

/// Whether no name has a letter beyond ASCII; comments and other literals may.
fn is_ascii(tokens: TokenStream) -> bool {
    tokens.into_iter().all(|tree| match tree {
        TokenTree::Ident(name) => name.to_string().is_ascii(),
        TokenTree::Group(group) => is_ascii(group.stream()),
        TokenTree::Punct(_) | TokenTree::Literal(_) => true,
    })
}

/// The path of the runtime, up to the first `;`.
fn runtime(input: ParseStream) -> Result<TokenStream> {
    let mut path = TokenStream::new();
    while !input.is_empty() && !input.peek(Token![;]) {
        path.extend([input.parse::<TokenTree>()?]);
    }
    input.parse::<Token![;]>()?;
    Ok(path)
}

struct Parser<'a> {
    errors: &'a mut Errors,
    sources: usize,
    depth: usize,
    /// Whether a `|` closes what stands here.
    barred: bool,
    lost: Lost,
    /// A coordinate whose statement ends in a mistake, as far as it could be read.
    begun: Option<Statement>,
    ascii: bool,
}
