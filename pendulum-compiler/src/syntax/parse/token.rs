//! Single tokens: names that may be declared, signs, brackets, and what is skipped after an error.

use crate::messages::{self, Range};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::Token;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};

/// An identifier that may be declared: no keyword of Rust, no reserved prefix, no middle dot.
pub(super) fn identifier(input: ParseStream, what: &str) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, what));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    // `gen` is a word of the language from the edition of 2024 on, wherever the block stands.
    if name == "gen" || syn::parse_str::<Ident>(&name.to_string()).is_err() {
        return Err(Range::from(name.span())
            .error(format!("`{name}` is a word of the Rust language; choose another name")));
    }
    Ok(name)
}

/// The name of a constraint or limit, which may be a word of Rust: it is no name of any code.
pub(super) fn constraint_name(input: ParseStream) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, "the name of a constraint"));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    Ok(name)
}

pub(super) fn checked(name: &Ident) -> Result<()> {
    let text = name.to_string();
    if text.contains('\u{b7}') {
        let parts: Vec<&str> = text.split('\u{b7}').filter(|part| !part.is_empty()).collect();
        let instead = match parts[..] {
            [a, b] => format!("`*`, as in `{a}*{b}`, or `inner({a}, {b})` for vectors"),
            [_, _, ..] => format!("`*`, as in `{}`, or `inner(u, v)` for vectors", parts.join("*")),
            _ => "`*`, or `inner(u, v)` for vectors".to_owned(),
        };
        return Err(Range::from(name.span())
            .error(format!("`·` is part of a name in Rust; write {instead}")));
    }
    if text.starts_with("__") {
        return Err(Range::from(name.span())
            .error("names that begin with `__` are reserved; choose another name"));
    }
    Ok(())
}

pub(super) fn equals(input: ParseStream) -> Result<()> {
    if input.peek(Token![=]) {
        input.parse::<Token![=]>()?;
        return Ok(());
    }
    Err(unexpected(input, "`=`"))
}

pub(super) fn comma(input: ParseStream) -> Result<()> {
    if input.peek(Token![,]) {
        input.parse::<Token![,]>()?;
        return Ok(());
    }
    Err(unexpected(input, "`,`"))
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
    if content.is_empty() { Ok(()) } else { Err(unexpected(content, "the closing bracket")) }
}

/// An error at the next token, or behind the last one.
pub(super) fn unexpected(input: ParseStream, expected: &str) -> syn::Error {
    match input.fork().parse::<TokenTree>() {
        Ok(TokenTree::Group(group)) => {
            let open = match group.delimiter() {
                Delimiter::Parenthesis => "`(`",
                Delimiter::Brace => "`{`",
                Delimiter::Bracket => "`[`",
                Delimiter::None => "this",
            };
            Range::from(group.span_open()).error(messages::unexpected(open, expected))
        }
        Ok(token) => {
            Range::from(token.span()).error(messages::unexpected(&format!("`{token}`"), expected))
        }
        Err(_) => Range::from(input.span())
            .error(format!("the input ends too early; expected {expected}")),
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
