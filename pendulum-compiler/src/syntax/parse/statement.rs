//! Parsing of statements: coordinates, inputs, definitions, energies, forces, outputs, constraints,
//! limits, frictions.

use super::token::{constraint_name, end, equals, fragment, identifier, not_expected, unexpected};
use super::{Parser, foreign};
use crate::messages::{Range, message};
use crate::syntax::ast::{
    Binder, Constraint, Expr, ExprKind, Force, Friction, Kind, Let, Limit, Output, Recovery, Role,
    Slip, Statement,
};
use crate::syntax::text::text;
use proc_macro2::{Ident, Spacing, TokenStream, TokenTree};
use quote::quote;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::spanned::Spanned;
use syn::{Attribute, Token, bracketed, parenthesized};

/// The keywords of statements.
#[rustfmt::skip]
pub(crate) const STATEMENTS: [&str; 15] =
    ["coordinate", "driven", "input", "let", "kinetic", "potential", "lagrangian", "dissipation", "force", "torque", "output", "constraint", "redundant", "limit", "friction"];

/// Returns the kinds of statements that a block lacks if the statement with this keyword could not
/// be parsed.
pub(super) fn recovery(keyword: &str) -> Recovery {
    match keyword {
        "kinetic" | "potential" | "lagrangian" | "dissipation" | "force" | "torque" => {
            Recovery { declarations: false, energies: true }
        }
        "output" => Recovery::default(),
        _ => Recovery { declarations: true, energies: true },
    }
}

impl Parser<'_> {
    pub(super) fn statement(&mut self, input: ParseStream) -> Result<Statement> {
        let attributes = input.call(Attribute::parse_outer)?;
        if let Some(attribute) =
            attributes.iter().find(|attribute| !attribute.path().is_ident("doc"))
        {
            return Err(Range { first: attribute.pound_token.spans[0], last: attribute.span() }
                .error(message!(
                    "an attribute has no effect here; attributes belong on the struct and its \
                     fields"
                )));
        }
        let word = match input.fork().call(Ident::parse_any) {
            Ok(word) => word.to_string(),
            Err(_) => String::new(),
        };
        let statement = match word.as_str() {
            "coordinate" => self.coordinate(input)?,
            "driven" => self.driven(input)?,
            "input" => self.control(input)?,
            "output" => self.output(input, quote!(#(#attributes)*))?,
            "constraint" => self.constraint(input, false)?,
            "redundant" => {
                input.call(Ident::parse_any)?;
                if !input.fork().call(Ident::parse_any).is_ok_and(|word| word == "constraint") {
                    return Err(unexpected(input, "`constraint`, as in `redundant constraint`"));
                }
                self.constraint(input, true)?
            }
            "limit" => self.limit(input)?,
            "friction" => self.friction(input)?,
            "let" => self.definition(input)?,
            "force" => self.force(input, false)?,
            "torque" => self.force(input, true)?,
            "kinetic" => self.energy(input, Role::Kinetic)?,
            "potential" => self.energy(input, Role::Potential)?,
            "lagrangian" => self.energy(input, Role::Lagrangian)?,
            "dissipation" => self.energy(input, Role::Dissipation)?,
            _ => return Err(foreign::statement(input, &word)),
        };
        if input.is_empty() {
            // The statement is complete except for its end.
            let message = message!("`;` is missing after this; end the last statement with `;`");
            self.errors.at(input.span(), message);
            return Ok(statement);
        }
        if !input.peek(Token![;]) {
            self.begun.extend(
                Some(statement)
                    .filter(|statement| matches!(statement, Statement::Coordinate { .. })),
            );
            return Err(if input.peek(Token![,]) {
                self.several(input, &word)
            } else {
                foreign::behind_declaration(input, &word)
                    .unwrap_or_else(|| unexpected(input, "`;`"))
            });
        }
        input.parse::<Token![;]>()?;
        Ok(statement)
    }

    /// Reports several names in a statement that declares one.
    fn several(&mut self, input: ParseStream, word: &str) -> syn::Error {
        let comma = Range::from(input.span());
        let mut example = None;
        while input.parse::<Token![,]>().is_ok()
            && let Ok(name) = input.fork().call(Ident::parse_any)
        {
            let statement = match word {
                "coordinate" => self.named_coordinate(input),
                "driven" | "input" => self.named_input(input, word == "input"),
                "let" => {
                    example = Some(format!("let {name} = …;"));
                    break;
                }
                _ => break,
            };
            example.get_or_insert_with(|| {
                statement.as_ref().map_or_else(|_| format!("{word} {name};"), written)
            });
            match statement {
                Ok(coordinate @ Statement::Coordinate { .. }) => self.begun.push(coordinate),
                _ => break,
            }
        }
        comma.error(match example {
            Some(example) => message!(
                "a statement declares one name; write `{example}` as a statement of its own"
            ),
            None => not_expected("`,`", "`;`"),
        })
    }

    fn coordinate(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        self.named_coordinate(input)
    }

    fn named_coordinate(&mut self, input: ParseStream) -> Result<Statement> {
        let name = self.declared(input, "the name of a coordinate")?;
        let mut length = None;
        let mut closed = Ok(());
        if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            length = Some(self.expr(&content)?);
            closed = end(&content);
        }
        match closed.and_then(|()| self.coordinate_kind(input)) {
            Ok(kind) => Ok(Statement::Coordinate { name, length, kind }),
            Err(error) => {
                self.begun.push(Statement::Coordinate { name, length, kind: Kind::Scalar(None) });
                Err(error)
            }
        }
    }

    fn coordinate_kind(&mut self, input: ParseStream) -> Result<Kind> {
        if !input.peek(Token![:]) {
            return Ok(Kind::Scalar(None));
        }
        input.parse::<Token![:]>()?;
        match self.kind(input)? {
            Kind::Body(range) | Kind::Solid(range) => {
                Err(range.error(message!("a coordinate has a unit; write `rad` or `m`")))
            }
            Kind::Matrix { sizes, .. } => Err(no_parameter(&sizes)),
            kind => Ok(kind),
        }
    }

    fn driven(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        self.named_input(input, false)
    }

    fn control(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        self.named_input(input, true)
    }

    fn named_input(&mut self, input: ParseStream, control: bool) -> Result<Statement> {
        let expected =
            if control { "the name of a control input" } else { "the name of a driven input" };
        let name = self.declared(input, expected)?;
        let kind = self.declared_kind(input, &name)?;
        if let Kind::Matrix { sizes, .. } = &kind {
            return Err(no_parameter(sizes));
        }
        if let Kind::Body(range) | Kind::Solid(range) = kind {
            return Err(range.error(if control {
                message!("a control input has a unit; write `N` or `[N; 2]`")
            } else {
                message!("a driven input has a unit; write `[m; 2]` for a motion in the plane")
            }));
        }
        if let (Kind::Rotation(range), true) = (&kind, control) {
            return Err(range.error(message!(
                "a control input is no rotation; write `torque R = …` with numbers as inputs"
            )));
        }
        Ok(if control { Statement::Input { name, kind } } else { Statement::Driven { name, kind } })
    }

    fn output(&mut self, input: ParseStream, documentation: TokenStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        // The names of outputs are separate: an output may have the name of a definition.
        let name = identifier(input, "the name of an output")?;
        let index = self.index(input)?;
        let kind = self.declared_kind(input, &name)?;
        if let Kind::Matrix { sizes, .. } = &kind {
            return Err(no_parameter(sizes));
        }
        if let Kind::Body(range) | Kind::Solid(range) = kind {
            return Err(range.error(message!("an output has a unit; write `m` or `[m; 2]`")));
        }
        if let Kind::Rotation(range) = kind {
            return Err(range.error(message!(
                "an output is made of numbers; write directions that the rotation turns, as in \
                 `output axis: [1; 3] = R*[0, 0, 1];`"
            )));
        }
        equals(input)?;
        let expr = self.expr(input)?;
        let output = Output { documentation, name, index, kind, expr };
        Ok(Statement::Output(Box::new(output)))
    }

    fn constraint(&mut self, input: ParseStream, redundant: bool) -> Result<Statement> {
        input.call(Ident::parse_any)?;
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

    fn limit(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        let (name, index) = self.named_row(input, "limit")?;
        let difference = self.difference(input, |parser, input, left| {
            if input.peek(Token![>=]) {
                input.parse::<Token![>=]>()?;
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
        let missing = || {
            message!(
                "the restitution is missing; write `, restitution = 0` behind the limit `{name}`, \
                 or a number up to 1"
            )
        };
        if !input.peek(Token![,]) {
            return Err(Range::from(difference.range.last).error(missing()));
        }
        input.parse::<Token![,]>()?;
        if !input.fork().call(Ident::parse_any).is_ok_and(|word| word == "restitution") {
            return Err(Range::from(input.span()).error(missing()));
        }
        input.call(Ident::parse_any)?;
        equals(input)?;
        let restitution = self.expr(input)?;
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

    fn friction(&mut self, input: ParseStream) -> Result<Statement> {
        input.call(Ident::parse_any)?;
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
        if input.peek(Token![,]) {
            input.parse::<Token![,]>()?;
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

    /// Parses the index of a family and its range between brackets, if they come next.
    fn index(&mut self, input: ParseStream) -> Result<Option<Binder>> {
        if !input.peek(syn::token::Bracket) {
            return Ok(None);
        }
        let content;
        bracketed!(content in input);
        let index = self.binder(&content)?;
        end(&content)?;
        Ok(Some(index))
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

    fn definition(&mut self, input: ParseStream) -> Result<Statement> {
        input.parse::<Token![let]>()?;
        foreign::no_pattern(input)?;
        let name = self.declared(input, "the name of a definition")?;
        let index = self.index(input)?;
        let mut arguments = None;
        if index.is_none() && input.peek(syn::token::Paren) {
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
        if input.peek(Token![:]) {
            return Err(Range::from(input.span()).error(message!(
                "a definition has the unit of its value; write `let {name} = …;`"
            )));
        }
        equals(input)?;
        let expr = self.expr(input)?;
        Ok(Statement::Let(Let { name, index, arguments, expr }))
    }

    fn energy(&mut self, input: ParseStream, role: Role) -> Result<Statement> {
        let keyword = input.call(Ident::parse_any)?.span().into();
        equals(input)?;
        Ok(Statement::Energy { role, keyword, expr: self.expr(input)? })
    }

    fn force(&mut self, input: ParseStream, torque: bool) -> Result<Statement> {
        input.call(Ident::parse_any)?;
        if input.peek(Token![=]) {
            return Err(Range::from(input.span()).error(message!(
                "what it acts on is missing; write `force θ = …;` with a coordinate or a point, \
                 also for the torque about an angle θ"
            )));
        }
        let (point, index) = if is_family(&input.fork()).unwrap_or(false) {
            let name = identifier(input, "what it acts on")?;
            let index = self.index(input)?;
            (self.member(name, index.as_ref()), index)
        } else {
            (self.expr(input)?, None)
        };
        equals(input)?;
        let expr = self.expr(input)?;
        Ok(Statement::Force(Box::new(Force { point, index, torque, expr })))
    }

    /// Returns the member `y[k]` of a family, whose mistakes are those of the range of its index.
    fn member(&mut self, name: Ident, index: Option<&Binder>) -> Expr {
        let range = name.span().into();
        let base = self.node(ExprKind::Name(name), range);
        let Some(Binder { name, high, .. }) = index else { return base };
        let kind = ExprKind::Name(name.clone());
        let k = Expr { kind, range: high.range, source: high.source };
        self.node(ExprKind::Index(Box::new(base), Box::new(k)), range)
    }

    /// Parses `k in 0..5`.
    pub(super) fn binder(&mut self, input: ParseStream) -> Result<Binder> {
        let name = identifier(input, "the name of an index")?;
        if !input.peek(Token![in]) {
            return Err(unexpected(input, "`in` and a range such as `0..5`"));
        }
        input.parse::<Token![in]>()?;
        let (low, high, inclusive) = match fragment(input).filter(whole_range) {
            None => self.range(input)?,
            Some(tokens) => {
                input.parse::<TokenTree>()?;
                self.inside(tokens, Self::range)?
            }
        };
        Ok(Binder { name, low, high, inclusive })
    }

    /// Parses `0..5`.
    fn range(&mut self, input: ParseStream) -> Result<(Expr, Expr, bool)> {
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
        Ok((low, high, inclusive))
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

/// Returns `true` if a name with the index of a family comes next: `y[k in …]`.
fn is_family(input: ParseStream) -> Result<bool> {
    input.call(Ident::parse_any)?;
    let content;
    bracketed!(content in input);
    Ok(content.peek2(Token![in]))
}

/// Returns a declaration as it is written in a block.
fn written(statement: &Statement) -> String {
    match statement {
        Statement::Coordinate { name, length, kind } => {
            let length = length.as_ref().map_or_else(String::new, |own| format!("[{}]", text(own)));
            format!("coordinate {name}{length}{};", kind_written(kind))
        }
        Statement::Driven { name, kind } => format!("driven {name}{};", kind_written(kind)),
        Statement::Input { name, kind } => format!("input {name}{};", kind_written(kind)),
        _ => "…".to_owned(),
    }
}

/// Returns a unit after its colon, with the length of a vector.
fn kind_written(kind: &Kind) -> String {
    match kind {
        Kind::Scalar(unit) => {
            unit.as_ref().map_or_else(String::new, |unit| format!(": {}", text(unit)))
        }
        Kind::Array { unit, length } => {
            let unit = unit.as_ref().map_or_else(|| "_".to_owned(), text);
            format!(": [{unit}; {}]", text(length))
        }
        Kind::Matrix { unit, sizes } => {
            let unit = unit.as_ref().map_or_else(|| "_".to_owned(), text);
            let [rows, columns] = sizes.each_ref().map(text);
            format!(": [{unit}; {rows}, {columns}]")
        }
        Kind::Body(_) => ": body".to_owned(),
        Kind::Solid(_) => ": solid".to_owned(),
        Kind::Rotation(_) => ": rotation".to_owned(),
    }
}

/// Returns the error for a matrix that is no parameter.
fn no_parameter([rows, columns]: &[Expr; 2]) -> syn::Error {
    let message =
        message!("only a parameter is a matrix; write vectors, as in `[m; 3]`, for its columns");
    rows.range.to(columns.range).error(message)
}

/// Returns `true` if a fragment is a range and not only its lower end.
fn whole_range(tokens: &TokenStream) -> bool {
    let dots = |tree| matches!(tree, TokenTree::Punct(dot) if dot.as_char() == '.' && dot.spacing() == Spacing::Joint);
    tokens.clone().into_iter().any(dots)
}

/// Returns the name of a limit, with its index.
fn row_text(name: &Ident, index: Option<&Binder>) -> String {
    let Some(Binder { name: index, low, high, inclusive }) = index else { return name.to_string() };
    let dots = if *inclusive { "..=" } else { ".." };
    format!("{name}[{index} in {}{dots}{}]", text(low), text(high))
}
