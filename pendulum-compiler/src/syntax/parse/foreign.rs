//! Notations that are not valid in formulas, with their translations.

use super::Parser;
use super::statement::STATEMENTS;
use super::token::{fragment, unexpected};
use crate::algebra::dimension::Dimension;
use crate::algebra::functions::Word;
use crate::messages::shared::{self, NO_IMPLICIT_PRODUCT, TELL_CASES_APART};
use crate::messages::{Range, Text, message};
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::elsewhere::{self, constant, function};
use crate::syntax::name;
use crate::syntax::text::text;
use proc_macro2::{Delimiter, Ident, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Result};
use syn::{Lifetime, Lit, Token, parenthesized};

impl Parser<'_> {
    /// Reports two adjacent operands, because there is no implicit multiplication.
    pub(super) fn no_operand(&self, input: ParseStream, left: &Expr) -> Result<()> {
        if input.peek(Token![as]) {
            return Err(Range::from(input.span()).error(rust("as", "leave the type out")));
        }
        if let (ExprKind::Name(name), true) = (&left.kind, input.peek(Lifetime)) {
            let velocity = name::dotted(&name.to_string());
            return Err(
                Range::from(input.span()).error(message!("`'` is no derivative; write {velocity}"))
            );
        }
        if fragment(input).is_some()
            || input.peek(Token![|]) && !self.barred
            || input.peek(Ident::peek_any) && !input.peek(Token![in])
            || input.peek(Lit) && !input.peek(Token![-])
            || input.peek(syn::token::Paren)
        {
            let token = input.fork().parse::<TokenTree>()?;
            let right = Range::from(token.span());
            if STATEMENTS.iter().any(|word| token.to_string() == *word) {
                return Err(right.error(message!(
                    "`;` is missing before `{token}`; end the statement above with `;`"
                )));
            }
            return Err(match (&left.kind, &token) {
                (_, TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
                    Range::from(group.span_open()).error(match &left.kind {
                        ExprKind::Name(_) | ExprKind::Number(_) => implicit_product("("),
                        _ => message!("an operator is missing before `(`; write `*` to multiply"),
                    })
                }
                (ExprKind::Name(name), _) if self.is_function(name) => {
                    let count = Word::named(&name.to_string()).map_or(1, Word::arity);
                    let (plural, verb) = if count == 1 { ("", "stands") } else { ("s", "stand") };
                    let arguments = match token {
                        TokenTree::Ident(_) | TokenTree::Literal(_) if count == 1 => {
                            token.to_string()
                        }
                        _ => vec!["…"; count].join(", "),
                    };
                    right.error(message!(
                        "the argument{plural} of `{name}` {verb} in parentheses; write \
                         `{name}({arguments})`"
                    ))
                }
                (ExprKind::Number(_), _) if self.is_unit(None, input) => {
                    right.error(shared::suffix_of_unit())
                }
                _ => right.error(implicit_product(&token.to_string())),
            });
        }
        Ok(())
    }

    /// Reports the power of a function before its argument, as in `cos^2(θ)`.
    pub(super) fn no_powered_function(&mut self, input: ParseStream, base: &Expr) -> Result<()> {
        let ExprKind::Name(name) = &base.kind else { return Ok(()) };
        if !self.is_function(name) {
            return Ok(());
        }
        let ahead = input.fork();
        ahead.parse::<Token![^]>()?;
        let minus = if ahead.peek(Token![-]) {
            ahead.parse::<TokenTree>()?.to_string()
        } else {
            String::new()
        };
        let Ok(power) = ahead.parse::<TokenTree>().map(|power| minus + &power.to_string()) else {
            return Ok(());
        };
        let (argument, last) = if ahead.peek(syn::token::Paren) {
            let content;
            let parens = parenthesized!(content in ahead);
            (
                self.expr(&content).map_or_else(|_| "…".to_owned(), |argument| text(&argument)),
                parens.span.close(),
            )
        } else if ahead.peek(syn::Ident) {
            let argument: Ident = ahead.parse()?;
            (argument.to_string(), argument.span())
        } else {
            return Ok(());
        };
        let inverse = format!("a{name}");
        let instead = if power == "-1" && takes(&inverse, 1) {
            format!("`{inverse}({argument})`, or `1/{name}({argument})`")
        } else {
            format!("`{name}({argument})^{power}`")
        };
        let message =
            message!("a function is raised to a power after its argument; write {instead}");
        Err(base.range.to(last.into()).error(message))
    }

    /// Returns `true` if a unit follows a number, as its `suffix` or in the next tokens. At least
    /// one name of the unit must not be declared.
    pub(super) fn is_unit(&self, suffix: Option<&str>, input: ParseStream) -> bool {
        let ahead = input.fork();
        let mut name = suffix.map(str::to_owned);
        loop {
            let next = match name.take() {
                Some(name) => name,
                None => match ahead.parse::<TokenTree>() {
                    Ok(TokenTree::Ident(ident)) => ident.to_string(),
                    Ok(TokenTree::Punct(sign)) if matches!(sign.as_char(), '*' | '/' | '^') => {
                        continue;
                    }
                    Ok(TokenTree::Literal(_)) => continue,
                    _ => return false,
                },
            };
            match (Dimension::of(&next), self.is_declared(&next)) {
                (None, declared) => {
                    let unit = 1 < next.chars().count() && elsewhere::unit(&next).is_some();
                    return unit && !declared && Word::named(&next).is_none();
                }
                (Some(_), false) => return true,
                (Some(_), true) => {}
            }
        }
    }

    /// Returns the error for a method call, with its translation.
    pub(super) fn method(&mut self, input: ParseStream, base: Expr, name: &Ident) -> syn::Error {
        let method = name.to_string();
        let range = base.range.to(name.span().into());
        let module = self.module(&base);
        let mut operands = if module.is_some() { Vec::new() } else { vec![base] };
        let translation = match self.arguments(input) {
            Ok(arguments) => {
                operands.extend(arguments);
                let list = || operands.iter().map(text).collect::<Vec<_>>().join(", ");
                let own = takes(&method, operands.len()).then(|| format!("{method}({})", list()));
                own.or_else(|| function(&method, &operands))
            }
            Err(_) => None,
        };
        let instead = match translation {
            Some(call) => format!("write `{call}`"),
            None => "write a function of the language, as in `sin(θ)`".to_owned(),
        };
        if let Some(module) = module {
            return range.error(message!("a function stands without `{module}`; {instead}"));
        }
        Range::from(name.span()).error(rust(&format!(".{method}()"), &instead))
    }

    /// Returns the name of a module of mathematical functions in another language.
    fn module(&self, base: &Expr) -> Option<String> {
        let ExprKind::Name(name) = &base.kind else { return None };
        let name = name.to_string();
        (elsewhere::MODULES.contains(&name.as_str()) && !self.is_declared(&name)).then_some(name)
    }

    /// Parses the expressions between a pair of parentheses.
    fn arguments(&mut self, input: ParseStream) -> Result<Vec<Expr>> {
        let content;
        parenthesized!(content in input);
        self.list(&content)
    }

    fn is_function(&self, name: &Ident) -> bool {
        Word::named(&name.to_string()).is_some() && !self.is_declared(&name.to_string())
    }
}

/// Returns `true` if a function takes this number of arguments.
fn takes(name: &str, count: usize) -> bool {
    Word::named(name).is_some_and(|word| word.arity() == count)
}

/// The message about two adjacent operands. `right` is the first token of the second operand.
fn implicit_product(right: &str) -> Text {
    message!("{NO_IMPLICIT_PRODUCT}; write `*` before `{right}`")
}

/// The message about a notation of Rust.
pub(super) fn rust(found: &str, instead: &str) -> Text {
    message!("`{found}` is Rust, which has no place in a formula; {instead}")
}

/// Reports a comparison, which Rust has but formulas do not.
pub(super) fn no_condition(input: ParseStream) -> Result<()> {
    let equal = input.peek(Token![==]) || input.peek(Token![!=]);
    if equal
        || input.peek(Token![<])
        || input.peek(Token![>])
        || input.peek(Token![&&])
        || input.peek(Token![?])
    {
        let sign = input.fork().parse::<TokenTree>()?;
        return Err(Range::from(sign.span()).error(message!(
            "a formula has no conditions; {TELL_CASES_APART}, as in `max(0, θ)`"
        )));
    }
    Ok(())
}

/// Returns the error for a statement that does not exist, with the nearest one or its translation.
pub(super) fn statement(input: ParseStream, word: &str) -> syn::Error {
    if word.is_empty() {
        return unexpected(input, "a statement such as `coordinate θ: rad;`");
    }
    let ahead = input.fork();
    let _ = ahead.call(Ident::parse_any);
    let refuse = |message: Text| Range::from(input.span()).error(message);
    let nearest = match word {
        "param" | "params" | "parameter" | "parameters" | "const" | "constant" | "constants" => {
            return refuse(message!(
                "`{word}` is no statement; declare parameters between the braces of the struct, as \
                 in `{{ m: kg, g: m/s^2 = 9.81 }}`"
            ));
        }
        "control" | "actuator" => Some("input"),
        "dof" | "variable" | "var" | "state" | "states" => Some("coordinate"),
        "damping" | "drag" | "rayleigh" | "Rayleigh" => Some("dissipation"),
        "T" | "K" | "KE" | "Ek" | "Ekin" => Some("kinetic"),
        "V" | "U" | "PE" | "Ep" | "Epot" => Some("potential"),
        "L" | "Lagrangian" => Some("lagrangian"),
        "fn" | "def" | "function" => Some("let"),
        _ => STATEMENTS
            .into_iter()
            .find(|statement| 3 <= word.len() && statement.starts_with(word))
            .or_else(|| name::nearest(word, STATEMENTS.into_iter())),
    };
    if nearest.is_none() && ahead.peek(Token![:]) && !ahead.peek(Token![::]) {
        return refuse(message!(
            "`{word}` is no statement; declare it, as in `coordinate {word}: rad;`"
        ));
    }
    if nearest.is_none() && ahead.peek(Token![=]) {
        return refuse(message!(
            "`{word}` is no statement; name a value by `let {word} = …;`, an energy by `kinetic = \
             …;` or `potential = …;`"
        ));
    }
    let begin = "a statement begins with `coordinate`, `driven`, `input`, `let`, `kinetic`, \
                 `potential`, `lagrangian`, `dissipation`, `force`, `torque`, `output`, \
                 `constraint`, `limit` or `friction`";
    refuse(shared::unknown("statement", word, nearest, begin))
}

/// Returns the error for a value or an argument behind a declaration.
pub(super) fn behind_declaration(input: ParseStream, word: &str) -> Option<syn::Error> {
    if !["coordinate", "driven", "input"].contains(&word) {
        return None;
    }
    let argument = input.fork().parse::<TokenTree>().is_ok_and(|token| token.to_string() == "(t)");
    let message = if argument {
        message!("everything that moves depends on the time; leave `(t)` out")
    } else if input.peek(Token![=]) {
        match word {
            "coordinate" => message!("a block has no start; pass it to `solve`, with the interval"),
            "driven" => message!(
                "a block does not say how a driven input moves; pass its motion to `driven_by`, or \
                 write `let` for a formula"
            ),
            _ => message!(
                "a block does not say the value of a control input; pass a controller to \
                 `controlled_by`, or write `let` for a formula"
            ),
        }
    } else {
        return None;
    };
    Some(Range::from(input.span()).error(message))
}

/// Reports what stands between `let` and a name in Rust.
pub(super) fn no_pattern(input: ParseStream) -> Result<()> {
    if input.peek(Token![mut]) {
        let message = message!("a definition never changes; leave `mut` out");
        return Err(Range::from(input.span()).error(message));
    }
    if input.peek(syn::token::Paren) || input.peek(syn::token::Bracket) {
        let message = message!(
            "a definition has one name; write `let r = [x, y];` for a vector, whose components are \
             `r.x` and `r.y`"
        );
        return match input.fork().parse::<TokenTree>()? {
            TokenTree::Group(group) => Err(Range::from(group.span_open()).error(message)),
            token => Err(Range::from(token.span()).error(message)),
        };
    }
    Ok(())
}

/// Returns the error for a path, with its translation.
pub(super) fn path(input: ParseStream, first: Option<&Ident>, ascii: bool) -> syn::Error {
    let start = first.map_or_else(|| input.span(), Ident::span);
    let (mut text, mut last) =
        (first.map(Ident::to_string).unwrap_or_default(), (String::new(), start));
    while input.parse::<Token![::]>().is_ok()
        && let Ok(name) = input.call(Ident::parse_any)
    {
        text = format!("{text}::{name}");
        last = (name.to_string(), name.span());
    }
    let call = || Word::named(&last.0).map(|word| format!("{}(…)", word.name));
    let translation = constant(&last.0, ascii).or_else(call);
    let instead = match translation {
        Some(expression) => format!("write `{expression}`"),
        None => "write a number, or declare a parameter".to_owned(),
    };
    Range { first: start, last: last.1 }.error(rust(&text, &instead))
}
