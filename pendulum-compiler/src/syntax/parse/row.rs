//! Parsing of constraints, limits and frictions.

use super::Parser;
use super::token::{constraint_name, equals, unexpected};
use crate::messages::{Range, message};
use crate::syntax::ast::{Binder, Constraint, Expr, Friction, Limit, Slip, Statement};
use crate::syntax::text::text;
use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::Token;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};

impl Parser<'_> {
    pub(super) fn constraint(&mut self, input: ParseStream, redundant: bool) -> Result<Statement> {
        let (name, index) = self.named_row(input, "constraint")?;
        let difference = self.difference(input, |_, input, _| {
            if input.peek(Token![<]) || input.peek(Token![>]) {
                let sign = input.fork().parse::<TokenTree>()?;
                return Err(Range::from(sign.span()).error(message!(
                    "a constraint holds with `=`; write `limit {name}: a >= b, restitution = 0;` \
                     for one side"
                )));
            }
            if input.peek(Token![==]) {
                let sign = input.fork().parse::<TokenTree>()?;
                return Err(Range::from(sign.span()).error(message!(
                    "the two sides of a constraint stand beside one `=`; write `a = b`"
                )));
            }
            equals(input)
        })?;
        let constraint = Constraint { redundant, name, index, difference };
        Ok(Statement::Constraint(Box::new(constraint)))
    }

    pub(super) fn limit(&mut self, input: ParseStream) -> Result<Statement> {
        let (name, index) = self.named_row(input, "limit")?;
        let difference = self.difference(input, |parser, input, left| {
            if input.parse::<Option<Token![>=]>>()?.is_some() {
                return Ok(());
            }
            if input.peek(Token![<]) || input.peek(Token![>]) || input.peek(Token![=]) {
                let sign = input.fork().parse::<TokenTree>()?;
                let own = row_text(&name, index.as_ref());
                let right = parser.right_limit(input, left);
                let (right, restitution) = right.unwrap_or(("a >= b".to_owned(), "0".to_owned()));
                let message = message!(
                    "a limit is a smallest value; write `limit {own}: {right}, restitution = \
                     {restitution};`"
                );
                return Err(Range::from(sign.span()).error(message));
            }
            Err(unexpected(input, "`>=`"))
        })?;
        let Some(restitution) = self.choice(input, "restitution")? else {
            let comma = input.parse::<Option<Token![,]>>()?.is_some();
            let place = if comma { input.span() } else { difference.range.last };
            return Err(Range::from(place).error(message!(
                "the restitution is missing; write `, restitution = 0` behind the limit `{name}`, \
                 or a number up to 1"
            )));
        };
        let slip = self.slip(input)?;
        let limit = Limit { name, index, difference, restitution, slip };
        Ok(Statement::Limit(Box::new(limit)))
    }

    /// Returns the sides of a limit with a wrong sign, which follows, as they should be written, and
    /// its restitution.
    fn right_limit(&mut self, input: ParseStream, left: &Expr) -> Result<(String, String)> {
        let ahead = input.fork();
        let less = ahead.peek(Token![<]);
        while ahead.peek(Token![<]) || ahead.peek(Token![>]) || ahead.peek(Token![=]) {
            ahead.parse::<TokenTree>()?;
        }
        let (left, right) = (text(left), text(&self.expr(&ahead)?));
        let sides = if less { format!("{right} >= {left}") } else { format!("{left} >= {right}") };
        let restitution = if ahead.peek(Token![,]) {
            ahead.parse::<Token![,]>()?;
            ahead.call(Ident::parse_any)?;
            equals(&ahead)?;
            text(&self.expr(&ahead)?)
        } else {
            "0".to_owned()
        };
        Ok((sides, restitution))
    }

    pub(super) fn friction(&mut self, input: ParseStream) -> Result<Statement> {
        let (name, index) = self.named_row(input, "friction")?;
        let rate = self.expr(input)?;
        let Some(force) = self.choice(input, "force")? else {
            let place = if input.peek(Token![,]) { input.span() } else { rate.range.last };
            return Err(Range::from(place).error(message!(
                "the force is missing; write `, force = F` behind the rate of the friction \
                 `{name}`"
            )));
        };
        let bound = self.choice(input, "static")?;
        if input.parse::<Option<Token![,]>>()?.is_some() {
            return Err(unexpected(input, "`static` behind `force`, or `;` before it"));
        }
        let slip = Slip { rate, force, bound };
        Ok(Statement::Friction(Box::new(Friction { name, index, slip })))
    }

    /// Parses `, friction = μ along rate, static = μs` behind a limit, if it comes next.
    fn slip(&mut self, input: ParseStream) -> Result<Option<Slip>> {
        if !is_choice(input, "friction") {
            return Ok(None);
        }
        input.parse::<Token![,]>()?;
        input.call(Ident::parse_any)?;
        equals(input)?;
        let place = input.span();
        let Some(tokens) = before_along(input)? else {
            return Err(Range::from(place).error(message!(
                "the rate is missing; write `friction = μ along dot(x)`, with what slides"
            )));
        };
        let force = self.inside(tokens, Self::expr)?;
        let rate = self.expr(input)?;
        let bound = self.choice(input, "static")?;
        Ok(Some(Slip { rate, force, bound }))
    }

    /// Parses `, word = value`, if it comes next.
    fn choice(&mut self, input: ParseStream, word: &str) -> Result<Option<Expr>> {
        if !is_choice(input, word) {
            return Ok(None);
        }
        input.parse::<Token![,]>()?;
        input.call(Ident::parse_any)?;
        equals(input)?;
        self.expr(input).map(Some)
    }

    /// Parses the name of a constraint, limit or friction, the index of a family, and the colon.
    fn named_row(&mut self, input: ParseStream, keyword: &str) -> Result<(Ident, Option<Binder>)> {
        let name = constraint_name(input, keyword)?;
        let index = self.index(input)?;
        if !input.peek(Token![:]) && keyword == "friction" {
            return Err(Range::from(name.span()).error(message!(
                "a dry friction has a name; write `friction {name}: rate, force = F;`, or \
                 `dissipation = …;` for a viscous one"
            )));
        }
        if !input.peek(Token![:]) {
            return Err(Range::from(name.span())
                .error(message!("a {keyword} has a name; write `{keyword} {name}: …`")));
        }
        input.parse::<Token![:]>()?;
        Ok((name, index))
    }
}

/// Returns `true` if `, word` comes next.
fn is_choice(input: ParseStream, word: &str) -> bool {
    let ahead = input.fork();
    ahead.parse::<Token![,]>().is_ok() && ahead.call(Ident::parse_any).is_ok_and(|own| own == word)
}

/// Returns the tokens before `along` and skips them and `along`; `None` without `along`.
///
/// `along` is also a name: it ends an expression only behind an operand.
fn before_along(input: ParseStream) -> Result<Option<TokenStream>> {
    let ahead = input.fork();
    let (mut count, mut operand) = (0, false);
    loop {
        match ahead.parse::<TokenTree>() {
            Ok(TokenTree::Ident(name)) if operand && name == "along" => break,
            Ok(TokenTree::Punct(sign)) if [',', ';'].contains(&sign.as_char()) => return Ok(None),
            Ok(token) => operand = !matches!(token, TokenTree::Punct(_)),
            Err(_) => return Ok(None),
        }
        count += 1;
    }
    let before = (0..count).map(|_| input.parse::<TokenTree>()).collect::<Result<_>>()?;
    input.call(Ident::parse_any)?;
    Ok(Some(before))
}

/// Returns the name of a limit, with its index.
fn row_text(name: &Ident, index: Option<&Binder>) -> String {
    let Some(Binder { name: index, low, high, inclusive }) = index else { return name.to_string() };
    let dots = if *inclusive { "..=" } else { ".." };
    format!("{name}[{index} in {}{dots}{}]", text(low), text(high))
}
