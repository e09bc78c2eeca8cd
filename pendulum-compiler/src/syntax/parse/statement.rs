//! Parsing of statements: coordinates, states, inputs, definitions, tables, energies, forces, rates,
//! outputs, constraints, limits, frictions.

use super::token::{accepts, end, equals, fragment, identifier, not_expected, unexpected};
use super::{Parser, foreign};
use crate::messages::{Range, message};
use crate::syntax::ast::{
    Binder, Expr, ExprKind, Force, Kind, Let, Output, Recovery, Role, Statement,
};
use crate::syntax::text::text;
use proc_macro2::{Ident, Spacing, Span, TokenStream, TokenTree};
use quote::quote;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::spanned::Spanned;
use syn::{Attribute, Token, bracketed, parenthesized};

/// The keywords of statements.
#[rustfmt::skip]
pub(crate) const STATEMENTS: [&str; 18] =
    ["coordinate", "state", "rate", "driven", "input", "let", "table", "kinetic", "potential", "lagrangian", "dissipation", "force", "torque", "output", "constraint", "redundant", "limit", "friction"];

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
        if !STATEMENTS.contains(&word.as_str()) {
            return Err(foreign::statement(input, &word));
        }
        let keyword = input.call(Ident::parse_any)?.span();
        let statement = match word.as_str() {
            "coordinate" => self.coordinate(input, false)?,
            "state" => self.coordinate(input, true)?,
            "rate" => self.rate(input)?,
            "driven" => self.input(input, false)?,
            "input" => self.input(input, true)?,
            "output" => self.output(input, quote!(#(#attributes)*))?,
            "constraint" => self.constraint(input, false)?,
            "redundant" if accepts(input, "constraint") => self.constraint(input, true)?,
            "redundant" => {
                return Err(unexpected(input, "`constraint`, as in `redundant constraint`"));
            }
            "limit" => self.limit(input)?,
            "friction" => self.friction(input)?,
            "let" => self.definition(input)?,
            "table" => self.table(input)?,
            "force" => self.force(input, false)?,
            "torque" => self.force(input, true)?,
            "kinetic" => self.energy(input, keyword, Role::Kinetic)?,
            "potential" => self.energy(input, keyword, Role::Potential)?,
            "lagrangian" => self.energy(input, keyword, Role::Lagrangian)?,
            _ => self.energy(input, keyword, Role::Dissipation)?,
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
                "coordinate" | "state" => self.coordinate(input, word == "state"),
                "driven" | "input" => self.input(input, word == "input"),
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

    fn coordinate(&mut self, input: ParseStream, state: bool) -> Result<Statement> {
        let expected = if state { "the name of a state" } else { "the name of a coordinate" };
        let name = self.declared(input, expected)?;
        let mut length = None;
        let mut closed = Ok(());
        if input.peek(syn::token::Bracket) {
            let content;
            bracketed!(content in input);
            length = Some(self.expr(&content)?);
            closed = end(&content);
        }
        match closed.and_then(|()| self.coordinate_kind(input, state)) {
            Ok(kind) => Ok(Statement::Coordinate { state, name, length, kind }),
            Err(error) => {
                let kind = Kind::Scalar(None);
                self.begun.push(Statement::Coordinate { state, name, length, kind });
                Err(error)
            }
        }
    }

    fn coordinate_kind(&mut self, input: ParseStream, state: bool) -> Result<Kind> {
        match self.optional_kind(input)? {
            Kind::Rotation(range) if state => Err(range.error(message!(
                "a state is a number or a vector; write `coordinate` for a rotation that turns \
                 with a body"
            ))),
            Kind::Body(range) | Kind::Solid(range) | Kind::Table(range, _) if state => {
                Err(range.error(message!("a state has a unit; write `m` or `[m; 3]`")))
            }
            Kind::Body(range) | Kind::Solid(range) | Kind::Table(range, _) => {
                Err(range.error(message!("a coordinate has a unit; write `rad` or `m`")))
            }
            Kind::Matrix { sizes, .. } => Err(no_parameter(&sizes)),
            kind => Ok(kind),
        }
    }

    fn input(&mut self, input: ParseStream, control: bool) -> Result<Statement> {
        let expected =
            if control { "the name of a control input" } else { "the name of a driven input" };
        let name = self.declared(input, expected)?;
        let kind = self.declared_kind(input, &name)?;
        if let Kind::Matrix { sizes, .. } = &kind {
            return Err(no_parameter(sizes));
        }
        if let Kind::Body(range) | Kind::Solid(range) | Kind::Table(range, _) = kind {
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
        Ok(Statement::Input { control, name, kind })
    }

    fn output(&mut self, input: ParseStream, documentation: TokenStream) -> Result<Statement> {
        // The names of outputs are separate: an output may have the name of a definition.
        let name = identifier(input, "the name of an output")?;
        let index = self.index(input)?;
        let kind = self.declared_kind(input, &name)?;
        if let Kind::Matrix { sizes, .. } = &kind {
            return Err(no_parameter(sizes));
        }
        if let Kind::Body(range) | Kind::Solid(range) | Kind::Table(range, _) = kind {
            return Err(range.error(message!("an output has a unit; write `m` or `[m; 2]`")));
        }
        equals(input)?;
        let expr = self.expr(input)?;
        let output = Output { documentation, name, index, kind, expr };
        Ok(Statement::Output(Box::new(output)))
    }

    /// Parses the index of a family and its range between brackets, if they come next.
    pub(super) fn index(&mut self, input: ParseStream) -> Result<Option<Binder>> {
        if !input.peek(syn::token::Bracket) {
            return Ok(None);
        }
        let content;
        bracketed!(content in input);
        let index = self.binder(&content)?;
        end(&content)?;
        Ok(Some(index))
    }

    fn definition(&mut self, input: ParseStream) -> Result<Statement> {
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

    fn energy(&mut self, input: ParseStream, keyword: Span, role: Role) -> Result<Statement> {
        equals(input)?;
        Ok(Statement::Energy { role, keyword: keyword.into(), expr: self.expr(input)? })
    }

    fn force(&mut self, input: ParseStream, torque: bool) -> Result<Statement> {
        if input.peek(Token![=]) {
            return Err(Range::from(input.span()).error(message!(
                "what it acts on is missing; write `force θ = …;` with a coordinate or a point, \
                 also for the torque about an angle θ"
            )));
        }
        let force = self.of_point(input, torque, "what it acts on")?;
        Ok(Statement::Force(Box::new(force)))
    }

    fn rate(&mut self, input: ParseStream) -> Result<Statement> {
        if input.peek(Token![=]) {
            return Err(Range::from(input.span()).error(message!(
                "the state is missing; write `rate z = …;` with the name of a state"
            )));
        }
        let rate = self.of_point(input, false, "the name of a state")?;
        Ok(Statement::Rate(Box::new(rate)))
    }

    /// Parses what a statement gives to a point, to each member of a family, or to a state.
    fn of_point(&mut self, input: ParseStream, torque: bool, expected: &str) -> Result<Force> {
        let (point, index) = if is_family(&input.fork()).unwrap_or(false) {
            let name = identifier(input, expected)?;
            let index = self.index(input)?;
            (self.member(name, index.as_ref()), index)
        } else {
            (self.expr(input)?, None)
        };
        equals(input)?;
        let expr = self.expr(input)?;
        Ok(Force { point, index, torque, expr })
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
        let inclusive = input.parse::<Option<Token![..=]>>()?.is_some();
        if !inclusive && input.parse::<Option<Token![..]>>()?.is_none() {
            return Err(unexpected(input, "`..` and the end of the range"));
        }
        let high = self.expr(input)?;
        Ok((low, high, inclusive))
    }
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
        Statement::Coordinate { state, name, length, kind } => {
            let keyword = if *state { "state" } else { "coordinate" };
            let length = length.as_ref().map_or_else(String::new, |own| format!("[{}]", text(own)));
            format!("{keyword} {name}{length}{};", kind_written(kind))
        }
        Statement::Input { control, name, kind } => {
            let keyword = if *control { "input" } else { "driven" };
            format!("{keyword} {name}{};", kind_written(kind))
        }
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
        Kind::Table(_, kinds) => {
            let [argument, value] = kinds.each_ref().map(kind_written);
            format!(": table({}){value}", argument.trim_start_matches(": "))
        }
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
