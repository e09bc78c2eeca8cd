//! Parsing of expressions: operators by precedence, then names, calls and numbers.

use super::foreign::{no_condition, path, rust};
use super::token::{
    accepts, checked, comma, constraint_name, end, fragment, identifier, unexpected,
};
use super::{Parser, to_the_last};
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::messages::shared::{self, NO_IMPLICIT_PRODUCT, TELL_CASES_APART};
use crate::messages::{Range, Text, message};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::text::text;
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::spanned::Spanned;
use syn::{Lit, Token, bracketed, parenthesized};

/// The limit on the depth of expressions, which protects the stack.
const DEPTH: usize = 128;

impl Parser<'_> {
    pub(super) fn expr(&mut self, input: ParseStream) -> Result<Expr> {
        let expr = self.expr_in(input, false)?;
        no_condition(input)?;
        Ok(expr)
    }

    /// Parses a unit, which has the syntax of an expression.
    pub(super) fn quantity(&mut self, input: ParseStream) -> Result<Expr> {
        self.expr_in(input, false)
    }

    fn expr_in(&mut self, input: ParseStream, barred: bool) -> Result<Expr> {
        let outside = std::mem::replace(&mut self.barred, barred);
        let deep =
            || message!("this expression is nested too deeply; name a part of it with `let`");
        let result = self.nested(input, deep, Self::sum);
        self.barred = outside;
        result
    }

    /// Parses a part of an expression, unless it is nested too deeply.
    fn nested(
        &mut self,
        input: ParseStream,
        deep: impl FnOnce() -> Text,
        parse: impl FnOnce(&mut Self, ParseStream) -> Result<Expr>,
    ) -> Result<Expr> {
        if DEPTH <= self.depth {
            return Err(Range::from(input.span()).error(deep()));
        }
        self.depth += 1;
        let result = parse(self, input);
        self.depth -= 1;
        result
    }

    fn sum(&mut self, input: ParseStream) -> Result<Expr> {
        let first = self.product(input)?;
        if !input.peek(Token![+]) && !input.peek(Token![-]) {
            return Ok(first);
        }
        let mut terms = vec![(false, first)];
        while input.peek(Token![+]) || input.peek(Token![-]) {
            let minus = input.peek(Token![-]);
            input.parse::<TokenTree>()?;
            terms.push((minus, self.product(input)?));
        }
        let range = terms[0].1.range.to(terms[terms.len() - 1].1.range);
        Ok(self.node(ExprKind::Sum(terms), range))
    }

    fn product(&mut self, input: ParseStream) -> Result<Expr> {
        let first = self.unary(input)?;
        if !input.peek(Token![*]) && !input.peek(Token![/]) {
            return Ok(first);
        }
        let mut factors = vec![(false, first)];
        while input.peek(Token![*]) || input.peek(Token![/]) {
            let over = input.peek(Token![/]);
            input.parse::<TokenTree>()?;
            if input.peek(Token![*]) {
                return Err(
                    Range::from(input.span()).error(message!("`**` is not an operator; write `^`"))
                );
            }
            factors.push((over, self.unary(input)?));
        }
        let range = factors[0].1.range.to(factors[factors.len() - 1].1.range);
        Ok(self.node(ExprKind::Product(factors), range))
    }

    fn unary(&mut self, input: ParseStream) -> Result<Expr> {
        // A sign inside a fragment belongs to the operand of the fragment.
        if fragment(input).is_some() || !input.peek(Token![-]) {
            return self.power(input);
        }
        let sign: Range = input.parse::<TokenTree>()?.span().into();
        let operand =
            self.nested(input, || message!("too many signs in a row; write one"), Self::unary)?;
        let range = sign.to(operand.range);
        Ok(self.node(ExprKind::Negative(Box::new(operand)), range))
    }

    fn power(&mut self, input: ParseStream) -> Result<Expr> {
        let base = self.postfix(input)?;
        if !input.peek(Token![^]) {
            return Ok(base);
        }
        self.no_powered_function(input, &base)?;
        input.parse::<Token![^]>()?;
        let deep = || message!("too many powers in a row; name a part with `let`");
        let exponent = self.nested(input, deep, Self::unary)?;
        let range = base.range.to(exponent.range);
        Ok(self.node(ExprKind::Power(Box::new(base), Box::new(exponent)), range))
    }

    fn postfix(&mut self, input: ParseStream) -> Result<Expr> {
        let mut expr = self.primary(input)?;
        while fragment(input).is_none() {
            if input.peek(syn::token::Bracket) {
                let content;
                let brackets = bracketed!(content in input);
                let index = self.expr(&content)?;
                if content.peek(Token![,]) {
                    return Err(brackets_without_operator(&expr, brackets.span.open().into()));
                }
                end(&content)?;
                let range = expr.range.to(brackets.span.close().into());
                expr = self.node(ExprKind::Index(Box::new(expr), Box::new(index)), range);
            } else if input.peek(Token![.]) && !input.peek(Token![..]) {
                input.parse::<Token![.]>()?;
                let component = identifier(input, "a component, `x`, `y` or `z`")?;
                if input.peek(syn::token::Paren) {
                    return Err(self.method(input, expr, &component));
                }
                let range = expr.range.to(component.span().into());
                expr = self.node(ExprKind::Component(Box::new(expr), component), range);
            } else {
                break;
            }
        }
        self.no_operand(input, &expr)?;
        Ok(expr)
    }

    fn primary(&mut self, input: ParseStream) -> Result<Expr> {
        if let Some(tokens) = fragment(input) {
            input.parse::<TokenTree>()?;
            return self.inside(tokens, Self::expr);
        }
        if input.peek(Lit) {
            return self.number(input);
        }
        if input.peek(syn::token::Paren) {
            let content;
            let parens = parenthesized!(content in input);
            let inner = self.expr(&content)?;
            if content.peek(Token![,]) {
                let range = Range { first: parens.span.open(), last: parens.span.close() };
                return Err(range.error(message!(
                    "a vector stands in brackets; write `[{}, …]`",
                    text(&inner)
                )));
            }
            end(&content)?;
            return Ok(inner);
        }
        if input.peek(syn::token::Bracket) {
            let content;
            let brackets = bracketed!(content in input);
            let items = self.list(&content)?;
            let range = Range { first: brackets.span.open(), last: brackets.span.close() };
            return Ok(self.node(ExprKind::Vector(items), range));
        }
        if input.peek(Token![|]) {
            let open = input.parse::<Token![|]>()?;
            let inner = self.expr_in(input, true)?;
            no_condition(input)?;
            if !input.peek(Token![|]) {
                return Err(
                    Range::from(open.span()).error(message!("this `|` is not closed; write `|u|`"))
                );
            }
            let close = input.parse::<Token![|]>()?;
            let range = Range { first: open.span(), last: close.span() };
            return Ok(self.node(ExprKind::Magnitude(Box::new(inner)), range));
        }
        if input.peek(Ident::peek_any) {
            return self.named(input);
        }
        if input.peek(Token![::]) {
            return Err(path(input, None, self.ascii));
        }
        if input.peek(Token![.]) && input.peek2(Lit) {
            let dot = Range::from(input.parse::<Token![.]>()?.span());
            let digits: Lit = input.parse()?;
            let (range, digits) = (dot.to(digits.span().into()), digits.to_token_stream());
            return Err(range.error(message!("a number begins with a digit; write `0.{digits}`")));
        }
        if input.is_empty() {
            return Err(Range::from(input.span()).error(message!("an expression is missing here")));
        }
        Err(unexpected(input, "a number, a name, `(`, `[` or `|`"))
    }

    /// Parses the contents of a fragment up to its end.
    pub(super) fn inside<R>(
        &mut self,
        tokens: TokenStream,
        parse: impl FnOnce(&mut Self, ParseStream) -> Result<R>,
    ) -> Result<R> {
        let content = |content: ParseStream| {
            let result = parse(self, content)?;
            end(content)?;
            Ok(result)
        };
        to_the_last(tokens, content)
    }

    fn named(&mut self, input: ParseStream) -> Result<Expr> {
        let name = input.call(Ident::parse_any)?;
        checked(&name)?;
        if name == "reaction" && input.peek(syn::token::Paren) {
            return self.reaction(input, name.span().into());
        }
        let instead = match name.to_string().as_str() {
            "if" | "match" => Some(TELL_CASES_APART),
            "for" | "while" | "loop" => Some("write `sum(k in 0..5, …)`"),
            "return" | "unsafe" | "move" => Some("leave it out"),
            _ => None,
        };
        if let Some(instead) = instead {
            return Err(Range::from(name.span()).error(rust(&name.to_string(), instead)));
        }
        if input.peek(Token![::]) {
            return Err(path(input, Some(&name), self.ascii));
        }
        let start = Range::from(name.span());
        if name == "vec" && input.peek(Token![!]) && !input.peek(Token![!=]) {
            return Err(start.error(rust("vec!", "write `[a, b]` for a vector")));
        }
        if !input.peek(syn::token::Paren) {
            return Ok(self.node(ExprKind::Name(name), start));
        }
        let content;
        let parens = parenthesized!(content in input);
        let range = start.to(parens.span.close().into());
        let kind = if (name == "sum" || name == "product") && content.peek2(Token![in]) {
            let binder = Box::new(self.binder(&content)?);
            comma(&content)?;
            let term = Box::new(self.expr(&content)?);
            end(&content)?;
            if name == "sum" {
                ExprKind::SumOver(binder, term)
            } else {
                ExprKind::ProductOver(binder, term)
            }
        } else if name == "integral" {
            let point =
                identifier(&content, "the point of integration; write `integral(p in B, …)`")?;
            if !content.peek(Token![in]) {
                return Err(unexpected(&content, "`in` and the name of a body"));
            }
            content.parse::<Token![in]>()?;
            let body = identifier(&content, "the name of a body")?;
            comma(&content)?;
            let integrand = Box::new(self.expr(&content)?);
            end(&content)?;
            ExprKind::Integral { point, body, integrand }
        } else {
            ExprKind::Call(name, self.list(&content)?)
        };
        Ok(self.node(kind, range))
    }

    /// Parses `(loop)`, `(loop.x)`, `(rod[2])` or `(floor, friction)` after `reaction`. Keywords such as `loop` are
    /// valid names of constraints.
    fn reaction(&mut self, input: ParseStream, start: Range) -> Result<Expr> {
        let content;
        let parens = parenthesized!(content in input);
        let name = constraint_name(&content, "constraint")?;
        let mut index = None;
        if content.peek(syn::token::Bracket) {
            let brackets;
            bracketed!(brackets in content);
            index = Some(Box::new(self.expr(&brackets)?));
            end(&brackets)?;
        }
        let range = start.to(parens.span.close().into());
        let friction = content.parse::<Option<Token![,]>>()?.is_some();
        if friction && !accepts(&content, "friction") {
            return Err(unexpected(&content, "`friction`, as in `reaction(floor, friction)`"));
        }
        let mut expr = self.node(ExprKind::Reaction(name, index, friction), range);
        if content.parse::<Option<Token![.]>>()?.is_some() {
            let component = identifier(&content, "a component, `x`, `y` or `z`")?;
            expr = self.node(ExprKind::Component(Box::new(expr), component), range);
        }
        end(&content)?;
        Ok(expr)
    }

    /// Parses two sides separated by `sign`, as the left side minus the right side.
    pub(super) fn difference(
        &mut self,
        input: ParseStream,
        sign: impl FnOnce(&mut Self, ParseStream, &Expr) -> Result<()>,
    ) -> Result<Expr> {
        let left = self.expr_in(input, false)?;
        sign(self, input, &left)?;
        let right = self.expr(input)?;
        let range = left.range.to(right.range);
        Ok(self.node(ExprKind::Sum(vec![(false, left), (true, right)]), range))
    }

    pub(super) fn list(&mut self, content: ParseStream) -> Result<Vec<Expr>> {
        let mut items = Vec::new();
        while !content.is_empty() {
            items.push(self.expr(content)?);
            if !content.is_empty() {
                comma(content)?;
            }
        }
        Ok(items)
    }

    fn number(&mut self, input: ParseStream) -> Result<Expr> {
        let literal: Lit = input.parse()?;
        let span = literal.span();
        let (digits, suffix) = match &literal {
            Lit::Int(literal) => (literal.base10_digits().to_owned(), literal.suffix().to_owned()),
            Lit::Float(literal) => {
                (literal.base10_digits().to_owned(), literal.suffix().to_owned())
            }
            Lit::Str(_) => {
                return Err(Range::from(span)
                    .error(message!("a text has no place here; write it without quotes")));
            }
            _ => {
                return Err(Range::from(span).error(message!(
                    "only numbers and names can stand in a formula; write a number such as `9.81`"
                )));
            }
        };
        if !suffix.is_empty() {
            let message = if suffix == "f32" || suffix == "f64" {
                message!("numbers here are exact and have no suffix; write `{digits}`")
            } else if self.is_unit(Some(&suffix), input) {
                shared::suffix_of_unit()
            } else {
                message!("{NO_IMPLICIT_PRODUCT}; write `{digits}*{suffix}`")
            };
            return Err(Range::from(span).error(message));
        }
        let literal = match Rational::decimal(&digits) {
            Some(value) => Literal::Exact(value),
            None if digits.parse() == Ok(0.0) && nonzero(&digits) => {
                return Err(Range::from(span).error(message!(
                    "this number is below the range of `f64`; write zero, or a larger one"
                )));
            }
            None if digits.parse::<f64>().is_ok_and(f64::is_finite) => Literal::Decimal(digits),
            None => {
                return Err(Range::from(span).error(message!(
                    "this number is beyond the range of `f64`; write a smaller one"
                )));
            }
        };
        Ok(self.node(ExprKind::Number(literal), span.into()))
    }

    pub(super) fn node(&mut self, kind: ExprKind, range: Range) -> Expr {
        self.sources += 1;
        Expr { kind, range, source: self.sources }
    }
}

/// Returns the error for a factor directly before a vector, which reads as an index.
fn brackets_without_operator(left: &Expr, open: Range) -> syn::Error {
    open.error(message!(
        "{NO_IMPLICIT_PRODUCT}, and an index is one number; write `{}*[…]` for a vector",
        text(left)
    ))
}

/// Returns `true` if a digit before the exponent is not zero.
fn nonzero(digits: &str) -> bool {
    let mantissa = digits.split(['e', 'E']).next().unwrap_or_default();
    mantissa.contains(|digit: char| digit.is_ascii_digit() && digit != '0')
}
