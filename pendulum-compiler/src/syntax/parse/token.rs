//! Single tokens: names that may be declared, signs, brackets, and what is skipped after an error.

use crate::messages::expected::{self, Expected};
use crate::messages::{Range, syntax as messages};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::Token;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};

/// An identifier that may be declared: no keyword of Rust, no reserved prefix, no middle dot.
pub(super) fn identifier(input: ParseStream, expected: Expected) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, expected));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    // `gen` is a word of the language from the edition of 2024 on, wherever the block stands.
    if name == "gen" || syn::parse_str::<Ident>(&name.to_string()).is_err() {
        return Err(Range::from(name.span()).error(messages::rust_keyword(&name)));
    }
    Ok(name)
}

/// The name of a constraint or limit, which may be a word of Rust: it is no name of any code.
pub(super) fn constraint_name(input: ParseStream) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, expected::CONSTRAINT));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    Ok(name)
}

pub(super) fn checked(name: &Ident) -> Result<()> {
    let text = name.to_string();
    if text.contains('\u{b7}') {
        let parts: Vec<&str> = text.split('\u{b7}').filter(|part| !part.is_empty()).collect();
        return Err(Range::from(name.span()).error(messages::middle_dot(&parts)));
    }
    if text.starts_with("__") {
        return Err(Range::from(name.span()).error(messages::reserved_name()));
    }
    Ok(())
}

pub(super) fn equals(input: ParseStream) -> Result<()> {
    if input.peek(Token![=]) {
        input.parse::<Token![=]>()?;
        return Ok(());
    }
    Err(unexpected(input, expected::EQUALS))
}

pub(super) fn comma(input: ParseStream) -> Result<()> {
    if input.peek(Token![,]) {
        input.parse::<Token![,]>()?;
        return Ok(());
    }
    Err(unexpected(input, expected::COMMA))
}

/// The tokens that a macro of the user's has handed over as one, as `$e:expr`, if they come next.
///
/// They stand between brackets that nobody sees and that syn looks through. A single name or number
/// needs none: it may be called.
pub(super) fn fragment(input: ParseStream) -> Option<TokenStream> {
    let mut cursor = input.cursor();
    loop {
        let (content, ..) = cursor.group(Delimiter::None)?;
        match content.token_tree() {
            Some((TokenTree::Ident(_) | TokenTree::Literal(_), rest)) if rest.eof() => return None,
            Some((TokenTree::Group(_), rest)) if rest.eof() => cursor = content,
            _ => return Some(content.token_stream()),
        }
    }
}

/// Nothing may be left inside a pair of brackets.
pub(super) fn end(content: ParseStream) -> Result<()> {
    if content.is_empty() { Ok(()) } else { Err(unexpected(content, expected::CLOSING_BRACKET)) }
}

/// An error at the next token, or behind the last one.
pub(super) fn unexpected(input: ParseStream, expected: Expected) -> syn::Error {
    match input.fork().parse::<TokenTree>() {
        Ok(TokenTree::Group(group)) => {
            let open = match group.delimiter() {
                Delimiter::Parenthesis => Some("("),
                Delimiter::Brace => Some("{"),
                Delimiter::Bracket => Some("["),
                Delimiter::None => None,
            };
            Range::from(group.span_open()).error(messages::unexpected(open, expected))
        }
        Ok(token) => Range::from(token.span())
            .error(messages::unexpected(Some(&token.to_string()), expected)),
        Err(_) => Range::from(input.span()).error(messages::early_end(expected)),
    }
}

/// Skips to behind the next `mark` at this level.
pub(super) fn skip(input: ParseStream, mark: char) {
    while let Ok(token) = input.parse::<TokenTree>() {
        if matches!(&token, TokenTree::Punct(punct) if punct.as_char() == mark) {
            break;
        }
    }
}

pub(super) fn drain(input: ParseStream) {
    while input.parse::<TokenTree>().is_ok() {}
}
