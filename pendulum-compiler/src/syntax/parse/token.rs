//! Single tokens: names, signs, brackets, and tokens skipped after an error.

use crate::messages::{Range, Text, message};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::Token;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};

/// Parses an identifier that may be declared: not a keyword of Rust, without a reserved prefix or a
/// middle dot.
pub(super) fn identifier(input: ParseStream, expected: &str) -> Result<Ident> {
    let name = word(input, expected)?;
    // `gen` is a keyword since the 2024 edition, and is refused in all editions.
    if name == "gen" || syn::parse_str::<Ident>(&name.to_string()).is_err() {
        return Err(Range::from(name.span())
            .error(message!("`{name}` is a word of the Rust language; choose another name")));
    }
    Ok(name)
}

/// Parses the name of a constraint, limit or friction. It may be a keyword of Rust, because it is
/// not a name in the generated code.
pub(super) fn constraint_name(input: ParseStream, keyword: &str) -> Result<Ident> {
    word(input, &format!("the name of a {keyword}"))
}

fn word(input: ParseStream, expected: &str) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, expected));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    Ok(name)
}

pub(super) fn checked(name: &Ident) -> Result<()> {
    let text = name.to_string();
    if text.contains('\u{b7}') {
        let parts: Vec<&str> = text.split('\u{b7}').filter(|part| !part.is_empty()).collect();
        let instead = match parts.as_slice() {
            [a, b] => format!("`*`, as in `{a}*{b}`, or `inner({a}, {b})` for vectors"),
            [_, _, ..] => format!("`*`, as in `{}`, or `inner(u, v)` for vectors", parts.join("*")),
            _ => "`*`, or `inner(u, v)` for vectors".to_owned(),
        };
        return Err(Range::from(name.span())
            .error(message!("`·` is part of a name in Rust; write {instead}")));
    }
    if text.starts_with("__") {
        return Err(Range::from(name.span())
            .error(message!("names that begin with `__` are reserved; choose another name")));
    }
    Ok(())
}

/// Parses a word, if it comes next.
pub(super) fn accepts(input: ParseStream, word: &str) -> bool {
    let next = input.fork().call(Ident::parse_any).is_ok_and(|own| own == word);
    next && input.call(Ident::parse_any).is_ok()
}

pub(super) fn equals(input: ParseStream) -> Result<()> {
    let sign = input.parse::<Option<Token![=]>>()?;
    sign.map(|_| ()).ok_or_else(|| unexpected(input, "`=`"))
}

pub(super) fn comma(input: ParseStream) -> Result<()> {
    let sign = input.parse::<Option<Token![,]>>()?;
    sign.map(|_| ()).ok_or_else(|| unexpected(input, "`,`"))
}

/// Returns the tokens of a fragment such as `$e:expr`, which a macro has passed on as a unit, if
/// the fragment comes next.
///
/// A fragment is enclosed in invisible brackets, which syn skips. A fragment that is a single name
/// or number is treated as a plain token, because it may be called.
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

/// Checks that no tokens are left inside a pair of brackets.
pub(super) fn end(content: ParseStream) -> Result<()> {
    if content.is_empty() { Ok(()) } else { Err(unexpected(content, "the closing bracket")) }
}

/// Returns an error at the next token, or after the last token.
pub(super) fn unexpected(input: ParseStream, expected: &str) -> syn::Error {
    match input.fork().parse::<TokenTree>() {
        Ok(TokenTree::Group(group)) => {
            let open = match group.delimiter() {
                Delimiter::Parenthesis => "`(`",
                Delimiter::Brace => "`{`",
                Delimiter::Bracket => "`[`",
                Delimiter::None => "this",
            };
            Range::from(group.span_open()).error(not_expected(open, expected))
        }
        Ok(token) => Range::from(token.span()).error(not_expected(&format!("`{token}`"), expected)),
        Err(_) => Range::from(input.span())
            .error(message!("the input ends too early; expected {expected}")),
    }
}

/// The message about a token that is not valid at its position, or about several tokens that a
/// macro has passed on as a fragment.
pub(super) fn not_expected(found: &str, expected: &str) -> Text {
    message!("{found} is not expected here; expected {expected}")
}

/// Skips all tokens up to and including the next `mark` at this level.
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
