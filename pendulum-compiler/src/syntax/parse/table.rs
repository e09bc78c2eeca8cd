//! Parsing of tables.

use super::Parser;
use super::token::{comma, end, equals, identifier, unexpected};
use crate::messages::{Range, message};
use crate::syntax::ast::{Expr, Kind, Statement, Table};
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::{Token, bracketed, parenthesized, token};

impl Parser<'_> {
    /// Parses `f(x: m): N = [(0, 0), (0.1, 3)], outside = linear`.
    pub(super) fn table(&mut self, input: ParseStream) -> Result<Statement> {
        let name = self.declared(input, "the name of a table")?;
        if !input.peek(token::Paren) {
            return Err(Range::from(name.span()).error(message!(
                "a table is a function; write `table {name}(x: m): N = [(0, 0), (1, 2)], outside = \
                 linear;`"
            )));
        }
        let content;
        parenthesized!(content in input);
        let argument = identifier(&content, "the name of an argument")?;
        let mut kinds = [self.optional_kind(&content)?, Kind::Scalar(None)];
        if content.peek(Token![,]) {
            return Err(Range::from(content.span())
                .error(message!("a table has one argument; leave the others out")));
        }
        end(&content)?;
        kinds[1] = self.optional_kind(input)?;
        scalars(&kinds, name.span().into())?;
        equals(input)?;
        if !input.peek(token::Bracket) {
            return Err(unexpected(input, "a list of points, as `[(0, 0), (1, 2)]`"));
        }
        let list;
        let brackets = bracketed!(list in input).span;
        let mut points = Vec::new();
        while !list.is_empty() {
            points.push(self.point(&list)?);
            if !list.is_empty() {
                comma(&list)?;
            }
        }
        let range = Range { first: brackets.open(), last: brackets.close() };
        let linear = outside(input, range, &name)?;
        Ok(Statement::Table(Box::new(Table { name, argument, kinds, points, range, linear })))
    }

    /// Parses `table(m): N`, the kind of a parameter.
    pub(super) fn tabulated(&mut self, input: ParseStream) -> Result<Kind> {
        let word = Range::from(input.call(Ident::parse_any)?.span());
        let content;
        let last = parenthesized!(content in input).span.close();
        let argument = if content.is_empty() { Kind::Scalar(None) } else { self.kind(&content)? };
        if content.peek(Token![:]) || content.peek(Token![,]) {
            return Err(Range::from(content.span()).error(message!(
                "the unit of the argument alone stands between the parentheses; write `table(m): N`"
            )));
        }
        end(&content)?;
        let kinds = [argument, self.optional_kind(input)?];
        scalars(&kinds, word)?;
        Ok(Kind::Table(Range { first: word.first, last }, Box::new(kinds)))
    }

    /// Parses `(x, y)`.
    fn point(&mut self, input: ParseStream) -> Result<[Expr; 2]> {
        if !input.peek(token::Paren) {
            return Err(unexpected(input, "a point of the table, as `(0, 0)`"));
        }
        let content;
        parenthesized!(content in input);
        let x = self.expr(&content)?;
        comma(&content)?;
        let y = self.expr(&content)?;
        end(&content)?;
        Ok([x, y])
    }
}

/// Returns an error unless argument and value are scalars.
fn scalars(kinds: &[Kind; 2], place: Range) -> Result<()> {
    if kinds.iter().all(|kind| matches!(kind, Kind::Scalar(_))) {
        return Ok(());
    }
    Err(place.error(message!(
        "argument and value of a table are scalars; write one table for each component"
    )))
}

/// Parses `, outside = linear` or `, outside = refused` behind the points.
fn outside(input: ParseStream, points: Range, name: &Ident) -> Result<bool> {
    let comma = input.parse::<Option<Token![,]>>()?;
    let place = Range::from(if comma.is_some() { input.span() } else { points.last });
    if comma.is_none() || !input.call(Ident::parse_any).is_ok_and(|word| word == "outside") {
        return Err(place.error(message!(
            "what `{name}` is beyond its points is missing; write `, outside = linear` for its \
             tangents there, or `, outside = refused`"
        )));
    }
    equals(input)?;
    let place = Range::from(input.span());
    match input.call(Ident::parse_any).map(|word| word.to_string()).as_deref() {
        Ok("linear") => Ok(true),
        Ok("refused") => Ok(false),
        _ => Err(place.error(message!(
            "a table goes on along its tangents or ends with its points; write `outside = linear` \
             or `outside = refused`"
        ))),
    }
}
