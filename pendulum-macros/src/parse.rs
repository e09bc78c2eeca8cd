//! Tokens to syntax: a recovering parser whose operators bind as in mathematics, not as in Rust.
//!
//! Precedence, low to high: `+ -`, `* /`, unary `-`, `^` (to the right), call, index, `|…|`. A statement that does not parse is
//! reported and skipped to its `;`, so that two mistakes give two messages.

use crate::ast::{Binder, Block, Expr, ExprKind, Field, ForceIndex, Kind, Let, Literal, Lost, Role, Statement};
use crate::check::{FUNCTIONS, text};
use crate::error::{Errors, Range};
use crate::number::Rational;
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser as Syn, Result};
use syn::spanned::Spanned;
use syn::{Attribute, Lit, Token, Visibility, braced, bracketed, parenthesized};

/// Deeper expressions are refused: they would overflow the stack before they meant anything.
const DEPTH: usize = 128;

/// Parses the path of the runtime and a block; `None` if not even the struct could be read.
pub(crate) fn all(input: TokenStream, errors: &mut Errors) -> Option<(TokenStream, Block)> {
    let mut parsed = None;
    let outcome = Syn::parse2(
        |input: ParseStream| {
            let krate = runtime(input)?;
            let mut parser = Parser { errors: &mut *errors, sources: 0, depth: 0, barred: false, lost: Lost::default() };
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
}

impl Parser<'_> {
    fn block(&mut self, input: ParseStream) -> Result<Block> {
        let attributes = input.call(Attribute::parse_outer)?;
        let visibility: Visibility = input.parse()?;
        if !input.peek(Token![struct]) {
            return Err(Range::from(input.span())
                .error("a block begins with its struct; write `pub struct Name { … }` with the parameters"));
        }
        input.parse::<Token![struct]>()?;
        let name = identifier(input, "the name of the struct")?;
        if !input.peek(syn::token::Brace) {
            return Err(Range::from(input.span())
                .error("the parameters are missing; write `{ m: kg, L: m }` after the name of the struct"));
        }
        let content;
        braced!(content in input);
        let mut fields = Vec::new();
        while !content.is_empty() {
            match self.field(&content) {
                Ok(field) => fields.push(field),
                Err(error) => {
                    self.errors.push(error);
                    self.lost.declarations = true;
                    skip(&content, ',');
                }
            }
        }
        let mut statements = Vec::new();
        while !input.is_empty() {
            let word = input.fork().call(Ident::parse_any).map(|word| word.to_string()).unwrap_or_default();
            match self.statement(input) {
                Ok(statement) => statements.push(statement),
                Err(error) => {
                    self.errors.push(error);
                    match word.as_str() {
                        "kinetic" | "potential" | "lagrangian" | "dissipation" | "force" => self.lost.energies = true,
                        _ => self.lost = Lost { declarations: true, energies: true },
                    }
                    skip(input, ';');
                }
            }
        }
        Ok(Block { attributes, visibility, name, fields, statements, lost: self.lost })
    }

    fn field(&mut self, input: ParseStream) -> Result<Field> {
        let attributes = input.call(Attribute::parse_outer)?;
        let _: Visibility = input.parse()?;
        let name = identifier(input, "the name of a parameter")?;
        let kind = if input.peek(Token![:]) {
            input.parse::<Token![:]>()?;
            self.kind(input)?
        } else {
            Kind::Scalar(None)
        };
        let default = if input.peek(Token![=]) {
            input.parse::<Token![=]>()?;
            Some(self.expr(input)?)
        } else {
            None
        };
        if !input.is_empty() && !input.peek(Token![,]) {
            return Err(unexpected(input, "`,`"));
        }
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
        Ok(Field { attributes, name, kind, default })
    }

    fn kind(&mut self, input: ParseStream) -> Result<Kind> {
        if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            let unit = self.expr(&content)?;
            if !content.peek(Token![;]) {
                return Err(
                    Range::from(content.span()).error("a length is missing; write `[m; 2]` for a vector, `[kg; 5]` for a family")
                );
            }
            content.parse::<Token![;]>()?;
            let length = self.expr(&content)?;
            end(&content)?;
            return Ok(Kind::Array { unit, length });
        }
        let unit = self.expr(input)?;
        match &unit.kind {
            ExprKind::Name(name) if name == "body" => Ok(Kind::Body(unit.range)),
            _ => Ok(Kind::Scalar(Some(unit))),
        }
    }

    fn statement(&mut self, input: ParseStream) -> Result<Statement> {
        let attributes = input.call(Attribute::parse_outer)?;
        if let Some(attribute) = attributes.iter().find(|attribute| !attribute.path().is_ident("doc")) {
            return Err(Range { first: attribute.pound_token.spans[0], last: attribute.span() }
                .error("an attribute has no effect here; attributes belong on the struct and its fields"));
        }
        let statement = if input.peek(Token![let]) {
            input.parse::<Token![let]>()?;
            Statement::Let(self.definition(input)?)
        } else {
            let fork = input.fork();
            let word = match fork.call(Ident::parse_any) {
                Ok(word) => word.to_string(),
                Err(_) => String::new(),
            };
            match word.as_str() {
                "coordinate" => self.coordinate(input)?,
                "driven" => self.driven(input)?,
                "force" => self.force(input)?,
                "kinetic" => self.energy(input, Role::Kinetic)?,
                "potential" => self.energy(input, Role::Potential)?,
                "lagrangian" => self.energy(input, Role::Lagrangian)?,
                "dissipation" => self.energy(input, Role::Dissipation)?,
                _ => return Err(unknown_statement(input, &word)),
            }
        };
        if !input.peek(Token![;]) {
            return Err(unexpected(input, "`;`"));
        }
        input.parse::<Token![;]>()?;
        Ok(statement)
    }

    fn coordinate(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        let name = identifier(input, "the name of a coordinate")?;
        let length = if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            let length = self.expr(&content)?;
            end(&content)?;
            Some(length)
        } else {
            None
        };
        let unit = if input.peek(Token![:]) {
            input.parse::<Token![:]>()?;
            match self.kind(input)? {
                Kind::Scalar(unit) => unit,
                Kind::Array { unit, .. } => {
                    return Err(unit.range.error("a coordinate is one number; declare one coordinate for each component"));
                }
                Kind::Body(range) => return Err(range.error("a coordinate has a unit; write `rad` or `m`")),
            }
        } else {
            None
        };
        Ok(Statement::Coordinate { name, length, unit })
    }

    fn driven(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        let name = identifier(input, "the name of a driven input")?;
        let kind = if input.peek(Token![:]) {
            input.parse::<Token![:]>()?;
            self.kind(input)?
        } else {
            Kind::Scalar(None)
        };
        if let Kind::Body(range) = kind {
            return Err(range.error("a driven input has a unit; write `[m; 2]` for a motion in the plane"));
        }
        Ok(Statement::Driven { name, kind })
    }

    fn definition(&mut self, input: ParseStream) -> Result<Let> {
        let name = identifier(input, "the name of a definition")?;
        let mut index = None;
        let mut arguments = None;
        if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            index = Some(self.binder(&content)?);
            end(&content)?;
        } else if input.peek(syn::token::Paren) {
            let content;
            parenthesized!(content in input);
            let mut names = Vec::new();
            while !content.is_empty() {
                names.push(identifier(&content, "the name of an argument")?);
                if !content.is_empty() {
                    content.parse::<Token![,]>()?;
                }
            }
            arguments = Some(names);
        }
        equals(input)?;
        let expr = self.expr(input)?;
        Ok(Let { name, index, arguments, expr })
    }

    fn energy(&mut self, input: ParseStream, role: Role) -> Result<Statement> {
        let keyword = input.call(Ident::parse_any)?.span().into();
        equals(input)?;
        Ok(Statement::Energy { role, keyword, expr: self.expr(input)? })
    }

    fn force(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        let name = identifier(input, "the coordinate on which the force acts")?;
        let index = if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            let each = content.peek2(Token![in]);
            let index = if each { ForceIndex::Each(self.binder(&content)?) } else { ForceIndex::One(self.expr(&content)?) };
            end(&content)?;
            Some(index)
        } else {
            None
        };
        equals(input)?;
        Ok(Statement::Force { name, index, expr: self.expr(input)? })
    }

    /// `k in 0..5`.
    fn binder(&mut self, input: ParseStream) -> Result<Binder> {
        let name = identifier(input, "the name of an index")?;
        if !input.peek(Token![in]) {
            return Err(unexpected(input, "`in` and a range such as `0..5`"));
        }
        input.parse::<Token![in]>()?;
        let low = self.expr(input)?;
        let inclusive = input.peek(Token![..=]);
        if inclusive {
            input.parse::<Token![..=]>()?;
        } else if input.peek(Token![..]) {
            input.parse::<Token![..]>()?;
        } else {
            return Err(unexpected(input, "`..` and the end of the range"));
        }
        let high = self.expr(input)?;
        Ok(Binder { name, low, high, inclusive })
    }

    fn expr(&mut self, input: ParseStream) -> Result<Expr> {
        self.expr_in(input, false)
    }

    fn expr_in(&mut self, input: ParseStream, barred: bool) -> Result<Expr> {
        let outside = std::mem::replace(&mut self.barred, barred);
        self.depth += 1;
        let result = if DEPTH < self.depth {
            Err(Range::from(input.span()).error("this expression is nested too deeply; name a part of it with `let`"))
        } else {
            self.sum(input)
        };
        self.depth -= 1;
        self.barred = outside;
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
                return Err(Range::from(input.span()).error("`**` is not an operator; write `^`"));
            }
            factors.push((over, self.unary(input)?));
        }
        let range = factors[0].1.range.to(factors[factors.len() - 1].1.range);
        Ok(self.node(ExprKind::Product(factors), range))
    }

    fn unary(&mut self, input: ParseStream) -> Result<Expr> {
        if !input.peek(Token![-]) {
            return self.power(input);
        }
        let sign: Range = input.parse::<TokenTree>()?.span().into();
        self.depth += 1;
        let operand = if DEPTH < self.depth {
            Err(Range::from(input.span()).error("too many signs in a row; write one"))
        } else {
            self.unary(input)
        };
        self.depth -= 1;
        let operand = operand?;
        let range = sign.to(operand.range);
        Ok(self.node(ExprKind::Negative(Box::new(operand)), range))
    }

    fn power(&mut self, input: ParseStream) -> Result<Expr> {
        let base = self.postfix(input)?;
        if !input.peek(Token![^]) {
            return Ok(base);
        }
        input.parse::<Token![^]>()?;
        self.depth += 1;
        let exponent = if DEPTH < self.depth {
            Err(Range::from(input.span()).error("too many powers in a row; name a part with `let`"))
        } else {
            self.unary(input)
        };
        self.depth -= 1;
        let exponent = exponent?;
        let range = base.range.to(exponent.range);
        Ok(self.node(ExprKind::Power(Box::new(base), Box::new(exponent)), range))
    }

    fn postfix(&mut self, input: ParseStream) -> Result<Expr> {
        let mut expr = self.primary(input)?;
        loop {
            if input.peek(syn::token::Bracket) {
                let content;
                let brackets = bracketed!(content in input);
                let index = self.expr(&content)?;
                end(&content)?;
                let range = expr.range.to(brackets.span.close().into());
                expr = self.node(ExprKind::Index(Box::new(expr), Box::new(index)), range);
            } else if input.peek(Token![.]) && !input.peek(Token![..]) {
                input.parse::<Token![.]>()?;
                let component = identifier(input, "a component, `x`, `y` or `z`")?;
                if input.peek(syn::token::Paren) {
                    return Err(method(input, &expr, &component));
                }
                let range = expr.range.to(component.span().into());
                expr = self.node(ExprKind::Component(Box::new(expr), component), range);
            } else {
                break;
            }
        }
        no_operand(input, &expr, self.barred)?;
        Ok(expr)
    }

    fn primary(&mut self, input: ParseStream) -> Result<Expr> {
        if input.peek(Lit) {
            return self.number(input);
        }
        if input.peek(syn::token::Paren) {
            let content;
            parenthesized!(content in input);
            let inner = self.expr(&content)?;
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
            if !input.peek(Token![|]) {
                return Err(Range::from(open.span()).error("this `|` is not closed; write `|u|`"));
            }
            let close = input.parse::<Token![|]>()?;
            let range = Range { first: open.span(), last: close.span() };
            return Ok(self.node(ExprKind::Magnitude(Box::new(inner)), range));
        }
        if input.peek(Ident::peek_any) {
            return self.named(input);
        }
        if input.is_empty() {
            return Err(Range::from(input.span()).error("an expression is missing here"));
        }
        Err(unexpected(input, "a number, a name, `(`, `[` or `|`"))
    }

    fn named(&mut self, input: ParseStream) -> Result<Expr> {
        let name = input.call(Ident::parse_any)?;
        checked(&name)?;
        if let Some(row) = FOREIGN.iter().find(|row| name == row.0) {
            return Err(Range::from(name.span()).error(format!("`{name}` is Rust, which has no place in a formula; {}", row.1)));
        }
        let start = Range::from(name.span());
        if !input.peek(syn::token::Paren) {
            return Ok(self.node(ExprKind::Name(name), start));
        }
        let content;
        let parens = parenthesized!(content in input);
        let range = start.to(parens.span.close().into());
        let kind = if name == "sum" && content.peek2(Token![in]) {
            let binder = self.binder(&content)?;
            comma(&content)?;
            let term = self.expr(&content)?;
            end(&content)?;
            ExprKind::SumOver(Box::new(binder), Box::new(term))
        } else if name == "integral" {
            let point = identifier(&content, "the point of integration; write `integral(p in B, …)`")?;
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

    fn list(&mut self, content: ParseStream) -> Result<Vec<Expr>> {
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
            Lit::Float(literal) => (literal.base10_digits().to_owned(), literal.suffix().to_owned()),
            _ => {
                return Err(
                    Range::from(span).error("only numbers and names can stand in a formula; write a number such as `9.81`")
                );
            }
        };
        if !suffix.is_empty() {
            let message = if suffix == "f32" || suffix == "f64" {
                format!("numbers here are exact and have no suffix; write `{digits}`")
            } else {
                format!("there is no implicit multiplication; write `{digits}*{suffix}`")
            };
            return Err(Range::from(span).error(message));
        }
        let literal = match Rational::decimal(&digits) {
            Some(value) => Literal::Exact(value),
            None if digits.parse::<f64>().is_ok_and(f64::is_finite) => Literal::Decimal(digits),
            None => return Err(Range::from(span).error("this number is beyond the range of `f64`; write a smaller one")),
        };
        Ok(self.node(ExprKind::Number(literal), span.into()))
    }

    fn node(&mut self, kind: ExprKind, range: Range) -> Expr {
        self.sources += 1;
        Expr { kind, range, source: self.sources }
    }
}

/// Two operands side by side: there is no implicit multiplication.
fn no_operand(input: ParseStream, left: &Expr, barred: bool) -> Result<()> {
    if input.peek(Token![as]) {
        return Err(Range::from(input.span()).error("`as` is Rust, which has no place in a formula; leave the type out"));
    }
    if input.peek(Token![|]) && !barred
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
            (_, TokenTree::Group(group)) => match &left.kind {
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
fn method(input: ParseStream, base: &Expr, name: &Ident) -> syn::Error {
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

/// An identifier that may be declared: no keyword of Rust, no reserved prefix, no middle dot.
fn identifier(input: ParseStream, what: &str) -> Result<Ident> {
    if !input.peek(Ident::peek_any) {
        return Err(unexpected(input, what));
    }
    let name = input.call(Ident::parse_any)?;
    checked(&name)?;
    // `gen` is a word of the language from the edition of 2024 on, wherever the block stands.
    if name == "gen" || syn::parse_str::<Ident>(&name.to_string()).is_err() {
        return Err(Range::from(name.span()).error(format!("`{name}` is a word of the Rust language; choose another name")));
    }
    Ok(name)
}

fn checked(name: &Ident) -> Result<()> {
    let text = name.to_string();
    if text.contains('\u{b7}') {
        let parts = text.replace('\u{b7}', "*");
        return Err(Range::from(name.span()).error(format!("`·` is part of a name in Rust; write `*`, as in `{parts}`")));
    }
    if text.starts_with("__") {
        return Err(Range::from(name.span()).error("names that begin with `__` are reserved; choose another name"));
    }
    Ok(())
}

fn equals(input: ParseStream) -> Result<()> {
    if input.peek(Token![=]) {
        input.parse::<Token![=]>()?;
        return Ok(());
    }
    Err(unexpected(input, "`=`"))
}

fn comma(input: ParseStream) -> Result<()> {
    if input.peek(Token![,]) {
        input.parse::<Token![,]>()?;
        return Ok(());
    }
    Err(unexpected(input, "`,`"))
}

/// Nothing may be left inside a pair of brackets.
fn end(content: ParseStream) -> Result<()> {
    if content.is_empty() { Ok(()) } else { Err(unexpected(content, "the closing bracket")) }
}

/// An error at the next token, or behind the last one.
fn unexpected(input: ParseStream, expected: &str) -> syn::Error {
    match input.fork().parse::<TokenTree>() {
        Ok(TokenTree::Group(group)) => {
            let open = match group.delimiter() {
                Delimiter::Parenthesis => "`(`",
                Delimiter::Brace => "`{`",
                Delimiter::Bracket => "`[`",
                Delimiter::None => "this",
            };
            Range::from(group.span_open()).error(format!("{open} is not expected here; expected {expected}"))
        }
        Ok(token) => Range::from(token.span()).error(format!("`{token}` is not expected here; expected {expected}")),
        Err(_) => Range::from(input.span()).error(format!("the input ends too early; expected {expected}")),
    }
}

/// Words that begin Rust expressions, and what to write instead.
#[rustfmt::skip]
const FOREIGN: &[(&str, &str)] = &[
    ("if", "write `max`, `min`, `abs` or `sign` to tell cases apart"),
    ("match", "write `max`, `min`, `abs` or `sign` to tell cases apart"),
    ("for", "write `sum(k in 0..5, …)`"),
    ("while", "write `sum(k in 0..5, …)`"),
    ("loop", "write `sum(k in 0..5, …)`"),
    ("return", "leave it out"),
    ("unsafe", "leave it out"),
    ("move", "leave it out"),
];

/// The words with which statements begin.
const STATEMENTS: [&str; 8] = ["coordinate", "driven", "let", "kinetic", "potential", "lagrangian", "dissipation", "force"];

fn unknown_statement(input: ParseStream, word: &str) -> syn::Error {
    if word.is_empty() {
        return unexpected(input, "a statement such as `coordinate θ: rad;`");
    }
    let hint = match crate::name::nearest(word, STATEMENTS.into_iter()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "a statement begins with `coordinate`, `driven`, `let`, `kinetic`, `potential`, `lagrangian`, `dissipation` or `force`".into(),
    };
    Range::from(input.span()).error(format!("unknown statement `{word}`; {hint}"))
}

/// Skips to behind the next `mark` at this level.
fn skip(input: ParseStream, mark: char) {
    while let Ok(token) = input.parse::<TokenTree>() {
        if matches!(&token, TokenTree::Punct(punct) if punct.as_char() == mark) {
            break;
        }
    }
}

fn drain(input: ParseStream) {
    while input.parse::<TokenTree>().is_ok() {}
}
