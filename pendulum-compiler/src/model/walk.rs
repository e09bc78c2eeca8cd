//! A traversal of all expressions that reports undeclared names and functions with the wrong number
//! of arguments.

mod notation;

use super::resolved::{Meaning, Model, Place};
use crate::algebra::dimension::Dimension;
use crate::algebra::functions::Word;
use crate::messages::shared::{self, NO_ACCELERATION_IN_CONSTRAINT, NO_IMPLICIT_PRODUCT, NO_JERK};
use crate::messages::{Errors, Range, Text, message};
use crate::syntax::ast::{Binder, Expr, ExprKind};
use crate::syntax::elsewhere::{self, ForeignUnit, constant, function};
use crate::syntax::name::{self, Name, plain};
use crate::syntax::text::text;
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// The index of a family or a sum, in a message.
const INDEX: &str = "an index";

/// A traversal of all expressions that reports undeclared names.
pub(super) struct Walk<'m, 'a, 'e> {
    pub(super) model: &'m Model<'a>,
    pub(super) errors: &'e mut Errors,
    pub(super) scope: Vec<String>,
    /// The declared names found so far.
    pub(super) mentioned: BTreeSet<Meaning>,
    /// `true` if accelerations of coordinates are allowed.
    pub(super) accelerations: bool,
    /// The kind of statement.
    pub(super) place: Place,
}

impl Walk<'_, '_, '_> {
    pub(super) fn block(&mut self) {
        let model = self.model;
        for quantity in &model.parameters {
            for item in quantity.default_items() {
                self.constant(item);
            }
        }
        for (index, definition) in model.lets.iter().enumerate() {
            self.accelerations = model.of_outputs.contains(&index);
            let depth = self.scope.len();
            for argument in definition.arguments.iter().flatten() {
                self.local(argument, "an argument");
            }
            self.indexed(definition.index.as_ref(), [&definition.expr]);
            self.scope.truncate(depth);
        }
        self.accelerations = false;
        for contribution in model.contributions() {
            self.place = contribution.place;
            self.indexed(contribution.index, contribution.exprs);
        }
        self.place = Place::Output;
        self.accelerations = true;
        for output in &model.outputs {
            self.indexed(output.statement.index.as_ref(), [&output.statement.expr]);
        }
    }

    /// Visits expressions with the index of a family in scope.
    fn indexed<'x>(&mut self, index: Option<&Binder>, exprs: impl IntoIterator<Item = &'x Expr>) {
        let depth = self.scope.len();
        if let Some(binder) = index {
            self.bind(binder);
        }
        for expr in exprs {
            self.expr(expr);
        }
        self.scope.truncate(depth);
    }

    /// Checks that a default consists of numbers.
    fn constant(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name(name)
                if name::read(&name.to_string()) == (Name { base: "pi".into(), dots: 0 }) => {}
            ExprKind::Sum(_)
            | ExprKind::Product(_)
            | ExprKind::Negative(_)
            | ExprKind::Power(..) => self.constants(expr),
            ExprKind::Call(name, items)
                if Word::named(&name.to_string())
                    .is_some_and(|word| word.is_scalar() && word.arity() == items.len()) =>
            {
                self.constants(expr);
            }
            _ => self.errors.at(
                expr.range,
                message!("a default is a number; write its value, as in `g: m/s^2 = 9.81`"),
            ),
        }
    }

    fn constants(&mut self, expr: &Expr) {
        for part in expr.parts() {
            self.constant(part);
        }
    }

    fn bind(&mut self, binder: &Binder) {
        self.expr(&binder.low);
        self.expr(&binder.high);
        self.local(&binder.name, INDEX);
    }

    /// Adds a local name of an expression. It may hide a parameter or a definition, but not a
    /// quantity that depends on time.
    fn local(&mut self, ident: &Ident, local: &str) {
        let Name { base, dots } = name::read(&ident.to_string());
        let holder = match base.as_str() {
            _ if 0 < dots => Some("a time derivative"),
            "t" => Some("the time"),
            "pi" => Some("the number π"),
            "i" if local != INDEX => Some("the imaginary unit"),
            _ => match self.model.names.get(&base) {
                Some(Meaning::Coordinate(_)) => Some("a coordinate"),
                Some(&Meaning::Input(index)) if self.model.is_control(index) => {
                    Some("a control input")
                }
                Some(Meaning::Input(_)) => Some("a driven input"),
                _ => None,
            },
        };
        if let Some(holder) = holder {
            let message = message!(
                "`{ident}` is {holder}, and {local} of this name would hide it; choose another name"
            );
            self.errors.at(ident.span(), message);
        }
        self.scope.push(base);
    }

    fn expr(&mut self, expr: &Expr) {
        if let Some((range, message)) = self.of_another_language(expr) {
            self.errors.at(range, message);
            return;
        }
        let depth = self.scope.len();
        match &expr.kind {
            ExprKind::Name(name) => self.name(name),
            ExprKind::Call(name, items) => {
                self.mentioned.extend(self.model.names.get(&plain(name)));
                self.function(name, items, expr.range);
            }
            ExprKind::SumOver(binder, _) | ExprKind::ProductOver(binder, _) => self.bind(binder),
            ExprKind::Reaction(name, _, friction) => self.reaction(name, *friction, expr.range),
            ExprKind::Integral { point, body, .. } => {
                let Name { base, dots } = name::read(&body.to_string());
                match self.model.names.get(&base) {
                    Some(&meaning @ Meaning::Parameter(index))
                        if dots == 0 && self.model.parameters[index].is_body() =>
                    {
                        self.mentioned.insert(meaning);
                    }
                    Some(_) => {
                        let message = message!(
                            "`{body}` is no body; declare it as `{body}: body` in the struct"
                        );
                        self.errors.at(body.span(), message);
                    }
                    None => self.name(body),
                }
                self.local(point, "a point");
            }
            _ => {}
        }
        for part in expr.parts() {
            self.expr(part);
        }
        self.scope.truncate(depth);
        if let ExprKind::Component(base, component) = &expr.kind {
            let known =
                if self.body(base) { ["mass", "center", "inertia"] } else { ["x", "y", "z"] };
            if !known.iter().any(|known| component == known) {
                let list = known.map(|known| format!("`.{known}`")).join(", ");
                let called = Word::named(&component.to_string()).filter(|word| word.arity() == 1);
                let called = called.map(|word| format!("{}({})", word.name, text(base)));
                let translated = || function(&component.to_string(), std::slice::from_ref(base));
                let message = match called.or_else(translated) {
                    Some(call) => {
                        message!("`{component}` is no component; write `{call}`")
                    }
                    None => message!("unknown component `{component}`; there are {list}"),
                };
                self.errors.at(component.span(), message);
            }
        }
    }

    /// Checks a reaction, which stands in outputs. That of a limit stands in magnitudes of frictions
    /// as well, and that of the `friction` of a limit has the name of the limit.
    fn reaction(&mut self, ident: &Ident, friction: bool, range: Range) {
        let (model, base) = (self.model, plain(ident));
        let constraint = model.constraints.iter().find(|own| plain(&own.name) == base);
        let limit = model.limits.iter().find(|own| plain(&own.name) == base);
        let of_limit = self.place == Place::Friction;
        if !of_limit && !self.accelerations {
            let and = if limit.is_some() { " and in frictions" } else { "" };
            let message = message!(
                "the reaction of `{ident}` is known only after the forces; it stands in outputs{and}"
            );
            self.errors.at(range, message);
            return;
        }
        let message = match (constraint, limit) {
            _ if of_limit && friction => {
                message!("the force of a friction depends on no other friction; leave it out")
            }
            (Some(constraint), _) if constraint.redundant => {
                message!("`{ident}` is redundant, and its reaction is not unique; leave it out")
            }
            (_, Some(limit)) if friction && limit.slip.is_none() => message!(
                "`{ident}` has no friction; write `friction = μ along dot(x)` behind the limit, or \
                 `reaction({ident})`"
            ),
            (_, Some(_)) => return,
            (Some(_), _) if friction => {
                message!("`{ident}` is a constraint, without friction; write `reaction({ident})`")
            }
            (Some(_), _) => return,
            _ if model.block.recovery.declarations => return,
            _ if !of_limit && model.frictions.iter().any(|own| plain(own.name) == base) => return,
            _ => {
                let (kind, declare) = if of_limit {
                    let holds = "a friction contains reactions of limits and constraints only";
                    ("limit or constraint", holds.to_owned())
                } else {
                    ("constraint", format!("declare it, as in `constraint {ident}: a = b;`"))
                };
                let constraints = model.constraints.iter().map(|own| &own.name);
                let frictions = model.frictions.iter().map(|own| own.name).filter(|_| !of_limit);
                let limits = model.limits.iter().map(|own| &own.name);
                let known = constraints.chain(limits).chain(frictions).map(Ident::to_string);
                let known: Vec<String> = known.collect();
                let near = name::nearest(&ident.to_string(), known.iter().map(String::as_str));
                shared::unknown(kind, ident, near, &declare)
            }
        };
        self.errors.at(ident.span(), message);
    }

    /// Returns `true` if an expression is the name of a body.
    fn body(&self, expr: &Expr) -> bool {
        self.model.body(expr, |name| self.scope.iter().any(|local| local == name)).is_some()
    }

    fn name(&mut self, ident: &Ident) {
        let Name { base, dots } = name::read(&ident.to_string());
        if self.scope.contains(&base) {
            return;
        }
        self.mentioned.extend(self.model.names.get(&base));
        let message = match (base.as_str(), self.model.names.get(&base)) {
            ("t" | "pi" | "i", _) if dots == 0 => return,
            ("t" | "pi" | "i", _) => {
                message!("`{ident}` does not move as a coordinate does; write a number")
            }
            (_, Some(Meaning::Parameter(_))) if 0 < dots => message!(
                "`{base}` is a parameter, so nothing in `{ident}` moves; declare it `driven` or \
                 as a coordinate"
            ),
            (_, Some(Meaning::Coordinate(_))) if 2 < dots && self.accelerations => {
                message!("`{ident}` {NO_JERK}")
            }
            (_, Some(Meaning::Coordinate(_))) if 1 < dots && self.place == Place::Row => {
                message!("`{ident}` {NO_ACCELERATION_IN_CONSTRAINT}")
            }
            (_, Some(Meaning::Coordinate(_))) if 1 < dots && !self.accelerations => {
                shared::acceleration(ident)
            }
            (_, Some(&Meaning::Input(index))) if 0 < dots && self.model.is_control(index) => {
                shared::derivative_of_control(&base)
            }
            (_, Some(Meaning::Input(_))) if 2 < dots => {
                message!("`{ident}` is a third derivative; driven inputs have two")
            }
            (_, Some(_)) => return,
            (_, None) if self.model.block.recovery.declarations => return,
            (text, None) if Word::named(text).is_some() => {
                shared::function_without_arguments(ident)
            }
            (_, None) => self.unknown(&ident.to_string()),
        };
        self.errors.at(ident.span(), message);
    }

    /// Returns the message for an undeclared name.
    fn unknown(&self, text: &str) -> Text {
        let moving = |stem: &str| {
            let Name { base, dots } = name::read(stem);
            self.model
                .names
                .get(&base)
                .filter(|meaning| dots == 0 && !matches!(meaning, Meaning::Parameter(_)))
        };
        if let Some(plain) = name::unaccented(text)
            && moving(&plain).is_some()
        {
            let velocity = name::dotted(&plain);
            return message!(
                "`{text}` has an accent, and a derivative has a dot; write {velocity}"
            );
        }
        for suffix in ["ddot", "dot"] {
            if let Some(stem) = text.strip_suffix(suffix)
                && let Some(meaning) = moving(stem)
            {
                return match meaning {
                    Meaning::Coordinate(_) if suffix == "ddot" && !self.accelerations => {
                        shared::acceleration(text)
                    }
                    _ => unknown_name(text, Some(&format!("{stem}_{suffix}"))),
                };
            }
        }
        let known = self.known();
        if !known.iter().any(|known| known.eq_ignore_ascii_case(text)) {
            if Dimension::of(text).is_some() {
                return unit_in_formula(text);
            }
            // A single letter is more likely a quantity than a constant.
            if let Some(constant) =
                constant(text, self.model.block.ascii).filter(|_| 1 < text.len())
            {
                return message!("unknown name `{text}`; write `{constant}`");
            }
            if let Some(stem) = elsewhere::moving(text).find(|stem| self.has_velocity(stem)) {
                return unknown_name(text, Some(&format!("{stem}_dot")));
            }
            // Two letters are more likely a quantity than a unit, unless they are a unit of length.
            if let Some(ForeignUnit { instead, factor }) = elsewhere::unit(text)
                && (3 <= text.chars().count() || ["mm", "cm", "km"].contains(&text))
            {
                return match factor {
                    Some(factor) => message!(
                        "unknown name `{text}`; write a number in `{instead}`: 1 {text} is \
                         {factor} {instead}"
                    ),
                    None => unit_in_formula(text),
                };
            }
        }
        let outputs = self.model.outputs.iter().map(|output| output.declared.name.to_string());
        let outputs: Vec<String> = outputs.collect();
        if outputs.iter().any(|output| output == text) {
            return message!(
                "`{text}` is an output, which no formula reads; name its value with `let`"
            );
        }
        let known = known.iter().chain(&outputs).map(String::as_str);
        unknown_name(text, name::nearest(text, known))
    }

    /// Returns `true` if a name has a velocity: a coordinate, a driven input or a definition.
    fn has_velocity(&self, text: &str) -> bool {
        let Name { base, dots } = name::read(text);
        dots == 0
            && match self.model.names.get(&base) {
                Some(Meaning::Coordinate(_)) => true,
                Some(&Meaning::Input(index)) => !self.model.is_control(index),
                Some(&Meaning::Let(index)) => self.model.lets[index].arguments.is_none(),
                Some(Meaning::Parameter(_) | Meaning::Table(_)) | None => false,
            }
    }

    fn function(&mut self, ident: &Ident, items: &[Expr], range: Range) {
        let (model, own) = (self.model, ident.to_string());
        let base = name::read(&own).base;
        let defined = match model.names.get(&base) {
            Some(&Meaning::Let(index)) => model.lets[index].arguments.as_ref().map(Vec::len),
            Some(Meaning::Table(_)) => Some(1),
            _ => None,
        };
        let call = || function(&own, items);
        let mut place = range;
        let message = if let Some(expected) = defined.or(Word::named(&own).map(Word::arity)) {
            match call() {
                Some(product) if defined.is_none() && own == "dot" => message!(
                    "`dot` is the derivative of one argument; write `{product}` for a scalar \
                     product"
                ),
                _ if expected == items.len() => return,
                _ => {
                    let (plural, found) = (if expected == 1 { "" } else { "s" }, items.len());
                    let expected =
                        if expected == 1 { "one".to_owned() } else { expected.to_string() };
                    let stand = if found == 1 { "stands" } else { "stand" };
                    message!("`{ident}` takes {expected} argument{plural}; {found} {stand} here")
                }
            }
        } else if own == "sum" {
            message!("`sum` runs over an index; write `sum(k in 0..5, …)`")
        } else if own == "product" {
            message!("`product` runs over an index; write `product(k in 0..5, A[k])`")
        } else {
            place = ident.span().into();
            let quantity = model.names.contains_key(&base)
                || self.scope.contains(&base)
                || matches!(base.as_str(), "t" | "pi" | "i");
            let of_time = matches!(items, [Expr { kind: ExprKind::Name(time), .. }] if time == "t");
            if quantity && of_time {
                place = range;
                message!(
                    "`{ident}` is no function; leave `(t)` out, because everything that moves \
                     depends on the time"
                )
            } else if quantity {
                message!("`{ident}` is no function, and {NO_IMPLICIT_PRODUCT}; write `{ident}*(…)`")
            } else if model.block.recovery.declarations {
                return;
            } else if let Some(call) = call() {
                message!("unknown function `{ident}`; write `{call}`")
            } else {
                let lets = model.lets.iter().filter(|definition| definition.arguments.is_some());
                let lets = lets.map(|definition| definition.name.to_string());
                let tables = model.tables.values().map(|own| own.name.to_string());
                let words = Word::all().map(|word| word.name.to_owned());
                let known: Vec<String> = words.chain(lets).chain(tables).collect();
                let nearest = name::nearest(&own, known.iter().map(String::as_str));
                let define = format!("define it with `let {ident}(p) = …;`");
                shared::unknown("function", ident, nearest, &define)
            }
        };
        self.errors.at(place, message);
    }

    /// Returns all declared names as written.
    fn known(&self) -> Vec<String> {
        let quantities =
            self.model.parameters.iter().chain(&self.model.coordinates).chain(&self.model.inputs);
        quantities
            .map(|quantity| quantity.name)
            .chain(self.model.lets.iter().map(|definition| &definition.name))
            .map(ToString::to_string)
            .collect()
    }
}

/// The message about an undeclared name, with the nearest name.
fn unknown_name(name: &str, nearest: Option<&str>) -> Text {
    let declare = "declare it as a parameter, a coordinate, an input or with `let`";
    shared::unknown("name", name, nearest, declare)
}

/// The message about a unit in a formula in which its name is not declared.
fn unit_in_formula(name: &str) -> Text {
    message!("unknown name `{name}`; declare it as a parameter; {}", shared::UNITS)
}
