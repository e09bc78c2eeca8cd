//! Parsing of a block: its struct, the fields with their units, and the statements, each parsed
//! independently.

use super::Parser;
use super::statement::recovery;
use super::token::{comma, end, identifier, skip};
use crate::algebra::number::Literal;
use crate::messages::{Range, Text, message};
use crate::syntax::ast::{Block, Expr, ExprKind, Field, Kind};
use crate::syntax::text::text;
use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::spanned::Spanned;
use syn::{Attribute, Token, Visibility, braced, bracketed};

impl Parser<'_> {
    pub(super) fn block(&mut self, input: ParseStream) -> Result<Block> {
        let attributes = input.call(Attribute::parse_outer)?;
        let visibility: Visibility = input.parse()?;
        if !input.peek(Token![struct]) {
            return Err(Range::from(input.span()).error(message!(
                "a block begins with its struct; write `pub struct Name {{ … }}` with the \
                 parameters"
            )));
        }
        input.parse::<Token![struct]>()?;
        let name = identifier(input, "the name of the struct")?;
        if input.peek(Token![<]) {
            return Err(Range::from(input.span()).error(message!(
                "the struct gets the type of its numbers by itself; leave `<…>` out"
            )));
        }
        if !input.peek(syn::token::Brace) {
            return Err(Range::from(input.span()).error(message!(
                "the parameters are missing; write `{{ m: kg, L: m }}` after the name of the struct"
            )));
        }
        let content;
        braced!(content in input);
        let mut fields = Vec::new();
        while !content.is_empty() {
            match self.field(&content) {
                Ok(field) => fields.push(field),
                Err(error) => {
                    self.errors.push(error);
                    self.recovery.declarations = true;
                    skip(&content, ',');
                }
            }
        }
        let mut statements = Vec::new();
        while !input.is_empty() {
            let word = input
                .fork()
                .call(Ident::parse_any)
                .map(|word| word.to_string())
                .unwrap_or_default();
            match self.statement(input) {
                Ok(statement) => statements.push(statement),
                Err(error) => {
                    self.errors.push(error);
                    // The number of coordinates is part of the type. Without a coordinate, every
                    // use of the system would result in an error.
                    statements.append(&mut self.begun);
                    let recovery = recovery(&word);
                    self.recovery.declarations |= recovery.declarations;
                    self.recovery.energies |= recovery.energies;
                    skip(input, ';');
                }
            }
        }
        Ok(Block {
            attributes,
            visibility,
            name,
            fields,
            statements,
            recovery: self.recovery,
            ascii: self.ascii,
        })
    }

    fn field(&mut self, input: ParseStream) -> Result<Field> {
        let mut attributes = input.call(Attribute::parse_outer)?;
        let conditional = |attribute: &Attribute| attribute.path().is_ident("cfg");
        if let Some(attribute) = attributes.iter().find(|attribute| conditional(attribute)) {
            let range = Range { first: attribute.pound_token.spans[0], last: attribute.span() };
            let message = message!(
                "`cfg` has no place on a parameter, which the equations need in every build; \
                 write it above the struct"
            );
            self.errors.at(range, message);
        }
        attributes.retain(|attribute| !conditional(attribute));
        let _: Visibility = input.parse()?;
        let name = self.declared(input, "the name of a parameter")?;
        let kind = self.declared_kind(input, &name)?;
        if let Kind::Rotation(range) = kind {
            return Err(range.error(message!(
                "a parameter is no rotation; declare its axis and its angle, as `n: [1; 3]` and \
                 `φ: rad`, and write `rotation(n, φ)`"
            )));
        }
        let default = match input.parse::<Option<Token![=]>>()? {
            Some(_) => Some(self.expr(input)?),
            None => None,
        };
        if let (Some(default), true) = (&default, input.peek(Token![:])) {
            return Err(Range::from(input.span()).error(message!(
                "the unit stands before the default; write `{name}: kg = {}`",
                text(default)
            )));
        }
        if !input.is_empty() {
            comma(input)?;
        }
        Ok(Field { attributes, name, kind, default })
    }

    /// Parses the kind after the name of a parameter, an input or an output: a colon and a kind, or
    /// neither.
    pub(super) fn declared_kind(&mut self, input: ParseStream, name: &Ident) -> Result<Kind> {
        if input.peek(syn::token::Bracket) {
            let brackets = Range::from(input.span());
            let content;
            bracketed!(content in input);
            let length = content.parse::<TokenStream>()?.to_string();
            let unit = match input.parse::<Option<Token![:]>>()? {
                Some(_) => self.unit(input)?,
                None => None,
            };
            let unit = unit.as_ref().map_or_else(|| "_".to_owned(), text);
            return Err(brackets.error(message!(
                "the length stands with the unit; write `{name}: [{unit}; {length}]`"
            )));
        }
        self.optional_kind(input)
    }

    /// Parses a colon and a kind, or neither.
    pub(super) fn optional_kind(&mut self, input: ParseStream) -> Result<Kind> {
        match input.parse::<Option<Token![:]>>()? {
            Some(_) => self.kind(input),
            None => Ok(Kind::Scalar(None)),
        }
    }

    pub(super) fn kind(&mut self, input: ParseStream) -> Result<Kind> {
        if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            if content.peek(Token![;]) {
                let place = Range::from(content.parse::<Token![;]>()?.span());
                let length = content.parse::<TokenStream>()?.to_string();
                return Err(place.error(missing_unit(&length)));
            }
            let unit = self.unit(&content)?;
            if !content.peek(Token![;]) {
                return Err(no_length(&content, unit.as_ref()));
            }
            content.parse::<Token![;]>()?;
            let length = self.expr(&content)?;
            if content.parse::<Option<Token![,]>>()?.is_some() {
                let sizes = Box::new([length, self.expr(&content)?]);
                end(&content)?;
                return Ok(Kind::Matrix { unit, sizes });
            }
            end(&content)?;
            return Ok(Kind::Array { unit, length });
        }
        if input.peek2(syn::token::Paren)
            && input.fork().call(Ident::parse_any).is_ok_and(|word| word == "table")
        {
            return self.tabulated(input);
        }
        let unit = self.unit(input)?;
        let Some(Expr { kind: ExprKind::Name(name), range, .. }) = &unit else {
            return Ok(Kind::Scalar(unit));
        };
        Ok(match name.to_string().as_str() {
            "body" => Kind::Body(*range),
            "solid" => Kind::Solid(*range),
            "rotation" => Kind::Rotation(*range),
            _ => Kind::Scalar(unit),
        })
    }

    /// Parses a unit, or `_` for an unknown unit.
    fn unit(&mut self, input: ParseStream) -> Result<Option<Expr>> {
        if input.parse::<Option<Token![_]>>()?.is_some() {
            return Ok(None);
        }
        self.quantity(input).map(Some)
    }
}

/// The message about a length between brackets without a unit.
fn missing_unit(length: &str) -> Text {
    let length = if length.is_empty() { "2" } else { length };
    message!(
        "a unit is missing; write `[m; {length}]`, or `[_; {length}]` for a vector without a unit"
    )
}

/// Returns the error for brackets that contain a unit without a length, or a length without a unit.
fn no_length(content: ParseStream, unit: Option<&Expr>) -> syn::Error {
    match unit {
        Some(Expr { kind: ExprKind::Number(Literal::Exact(length)), range, .. })
            if content.is_empty() =>
        {
            range.error(missing_unit(&length.to_string()))
        }
        Some(unit) if content.peek(Token![,]) => {
            let place = Range::from(content.span());
            let rest = content.parse::<TokenStream>().unwrap_or_default().into_iter();
            // A comma at the end does not separate components.
            let commas = rest
                .map(|tree| matches!(tree, TokenTree::Punct(sign) if sign.as_char() == ','))
                .collect::<Vec<_>>();
            let length = commas.iter().filter(|comma| **comma).count()
                + usize::from(commas.last() == Some(&false));
            let (unit, length) = (text(unit), length.max(2));
            place.error(message!(
                "all components have one unit; write `[{unit}; {length}]` for a vector"
            ))
        }
        _ => Range::from(content.span()).error(message!(
            "a length is missing; write `[m; 2]` for a vector, `[kg; 5]` for a family"
        )),
    }
}
