//! A traversal of all expressions that reports undeclared names and functions with the wrong number
//! of arguments.

use super::resolved::{Meaning, Model};
use crate::algebra::dimension::Dimension;
use crate::algebra::functions::Word;
use crate::messages::model::{self as messages, Holder, Local};
use crate::messages::shared;
use crate::messages::{Errors, Range, Text};
use crate::syntax::ast::{Binder, Expr, ExprKind};
use crate::syntax::elsewhere::{self, constant, function};
use crate::syntax::name::{self, Name, plain};
use proc_macro2::Ident;
use std::collections::BTreeSet;

/// A traversal of all expressions that reports undeclared names.
pub(super) struct Walk<'m, 'a, 'e> {
    pub(super) model: &'m Model<'a>,
    pub(super) errors: &'e mut Errors,
    pub(super) scope: Vec<String>,
    /// The declared names found so far.
    pub(super) mentioned: BTreeSet<Meaning>,
    /// `true` if accelerations of coordinates are allowed.
    pub(super) accelerations: bool,
    /// `true` in a constraint or a limit.
    pub(super) constraint: bool,
}

impl Walk<'_, '_, '_> {
    pub(super) fn block(&mut self) {
        let model = self.model;
        for quantity in &model.parameters {
            if let Some(default) =
                quantity.default.filter(|_| quantity.length.is_none() && !quantity.body)
            {
                self.constant(default);
            }
        }
        for (index, definition) in model.lets.iter().enumerate() {
            self.accelerations = model.of_outputs.contains(&index);
            let depth = self.scope.len();
            for argument in definition.arguments.iter().flatten() {
                self.local(argument, Local::Argument);
            }
            self.indexed(definition.index.as_ref(), [&definition.expr]);
            self.scope.truncate(depth);
        }
        self.accelerations = false;
        for contribution in model.contributions() {
            self.constraint = contribution.constraint;
            self.indexed(contribution.index, contribution.exprs);
        }
        self.constraint = false;
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
            _ => self.errors.at(expr.range, messages::open_default()),
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
        self.local(&binder.name, Local::Index);
    }

    /// Adds a local name of an expression. It may hide a parameter or a definition, but not a
    /// quantity that depends on time.
    fn local(&mut self, ident: &Ident, local: Local) {
        let Name { base, dots } = name::read(&ident.to_string());
        let holder = match base.as_str() {
            _ if 0 < dots => Some(Holder::Derivative),
            "t" => Some(Holder::Time),
            "pi" => Some(Holder::Pi),
            "i" if local != Local::Index => Some(Holder::ImaginaryUnit),
            _ => match self.model.names.get(&base) {
                Some(Meaning::Coordinate(_)) => Some(Holder::Coordinate),
                Some(&Meaning::Input(index)) if self.model.is_control(index) => {
                    Some(Holder::ControlInput)
                }
                Some(Meaning::Input(_)) => Some(Holder::DrivenInput),
                _ => None,
            },
        };
        if let Some(holder) = holder {
            self.errors.at(ident.span(), messages::hiding(ident, holder, local));
        }
        self.scope.push(base);
    }

    fn expr(&mut self, expr: &Expr) {
        let depth = self.scope.len();
        match &expr.kind {
            ExprKind::Name(name) => self.name(name),
            ExprKind::Call(name, items) => {
                self.mentioned.extend(self.model.names.get(&plain(name)));
                self.function(name, items, expr.range);
            }
            ExprKind::SumOver(binder, _) => self.bind(binder),
            ExprKind::Reaction(name, _) => self.reaction(name, expr.range),
            ExprKind::Integral { point, body, .. } => {
                let Name { base, dots } = name::read(&body.to_string());
                match self.model.names.get(&base) {
                    Some(&meaning @ Meaning::Parameter(index))
                        if dots == 0 && self.model.parameters[index].body =>
                    {
                        self.mentioned.insert(meaning);
                    }
                    Some(_) => {
                        self.errors.at(body.span(), messages::no_body(body));
                    }
                    None => self.name(body),
                }
                self.local(point, Local::Point);
            }
            _ => {}
        }
        for part in expr.parts() {
            self.expr(part);
        }
        self.scope.truncate(depth);
        if let ExprKind::Component(base, component) = &expr.kind {
            let known: &[&str] =
                if self.body(base) { &["mass", "center", "inertia"] } else { &["x", "y", "z"] };
            if !known.iter().any(|known| component == known) {
                let message = messages::unknown_component(component, known);
                self.errors.at(component.span(), message);
            }
        }
    }

    /// Checks a reaction, which has to name a constraint and is allowed only in outputs.
    fn reaction(&mut self, ident: &Ident, range: Range) {
        if !self.accelerations {
            self.errors.at(range, messages::reaction_outside_of_outputs(ident));
            return;
        }
        let base = plain(ident);
        let found = self.model.constraints.iter().find(|own| plain(&own.name) == base);
        let message = match found {
            Some(constraint) if constraint.redundant => messages::reaction_of_redundant(ident),
            Some(_) => return,
            None if self.model.block.recovery.declarations => return,
            None if self.model.limits.iter().any(|own| plain(&own.name) == base) => {
                messages::reaction_of_limit(ident)
            }
            None => {
                let known = self.model.constraints.iter().map(|own| own.name.to_string());
                let known: Vec<String> = known.collect();
                let near = name::nearest(&ident.to_string(), known.iter().map(String::as_str));
                messages::unknown_constraint(ident, near)
            }
        };
        self.errors.at(ident.span(), message);
    }

    /// Returns `true` if an expression is the name of a body.
    fn body(&self, expr: &Expr) -> bool {
        let ExprKind::Name(ident) = &expr.kind else { return false };
        let Name { base, dots } = name::read(&ident.to_string());
        let meaning =
            self.model.names.get(&base).filter(|_| dots == 0 && !self.scope.contains(&base));
        matches!(meaning, Some(&Meaning::Parameter(index)) if self.model.parameters[index].body)
    }

    fn name(&mut self, ident: &Ident) {
        let Name { base, dots } = name::read(&ident.to_string());
        if self.scope.contains(&base) {
            return;
        }
        self.mentioned.extend(self.model.names.get(&base));
        match (base.as_str(), self.model.names.get(&base)) {
            ("t" | "pi" | "i", _) if dots == 0 => {}
            ("t" | "pi" | "i", _) => {
                self.errors.at(ident.span(), messages::derivative_of_constant(ident));
            }
            (_, Some(Meaning::Parameter(_))) if 0 < dots => {
                self.errors.at(ident.span(), messages::derivative_of_parameter(ident, &base));
            }
            (_, Some(Meaning::Coordinate(_))) if 2 < dots && self.accelerations => {
                self.errors.at(ident.span(), shared::jerk(ident));
            }
            (_, Some(Meaning::Coordinate(_))) if 1 < dots && self.constraint => {
                let message = shared::acceleration_in_constraint(ident);
                self.errors.at(ident.span(), message);
            }
            (_, Some(Meaning::Coordinate(_))) if 1 < dots && !self.accelerations => {
                self.errors.at(ident.span(), shared::acceleration(ident));
            }
            (_, Some(&Meaning::Input(index))) if 0 < dots && self.model.is_control(index) => {
                self.errors.at(ident.span(), shared::derivative_of_control(&base));
            }
            (_, Some(Meaning::Input(_))) if 2 < dots => {
                self.errors.at(ident.span(), messages::jerk_of_input(ident));
            }
            (_, Some(_)) => {}
            (_, None) if self.model.block.recovery.declarations => {}
            (text, None) if Word::named(text).is_some() => {
                self.errors.at(ident.span(), shared::function_without_arguments(ident));
            }
            (_, None) => {
                let message = self.unknown(&ident.to_string());
                self.errors.at(ident.span(), message);
            }
        }
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
            return messages::accent(text, &name::dotted(&plain));
        }
        for suffix in ["ddot", "dot"] {
            if let Some(stem) = text.strip_suffix(suffix)
                && let Some(meaning) = moving(stem)
            {
                return match meaning {
                    Meaning::Coordinate(_) if suffix == "ddot" && !self.accelerations => {
                        shared::acceleration(text)
                    }
                    _ => messages::unknown_name(text, Some(&format!("{stem}_{suffix}"))),
                };
            }
        }
        let known = self.known();
        if !known.iter().any(|known| known.eq_ignore_ascii_case(text)) {
            if Dimension::of(text).is_some() {
                return messages::unit_in_formula(text);
            }
            // A single letter is more likely a quantity than a constant.
            if let Some(constant) =
                constant(text, self.model.block.ascii).filter(|_| 1 < text.len())
            {
                return messages::untranslated_name(text, &constant);
            }
            if let Some(stem) = elsewhere::moving(text).find(|stem| self.has_velocity(stem)) {
                return messages::unknown_name(text, Some(&format!("{stem}_dot")));
            }
            // Two letters are more likely a quantity than a unit, unless they are a unit of length.
            if let Some(unit) = elsewhere::unit(text)
                && (3 <= text.chars().count() || ["mm", "cm", "km"].contains(&text))
            {
                return match unit.factor {
                    Some(factor) => messages::scaled_unit_in_formula(text, unit.instead, factor),
                    None => messages::unit_in_formula(text),
                };
            }
        }
        let outputs = self.model.outputs.iter().map(|output| output.declared.name.to_string());
        let outputs: Vec<String> = outputs.collect();
        if outputs.iter().any(|output| output == text) {
            return messages::output_in_formula(text);
        }
        let known = known.iter().chain(&outputs).map(String::as_str);
        messages::unknown_name(text, name::nearest(text, known))
    }

    /// Returns `true` if a name has a velocity: a coordinate, a driven input or a definition.
    fn has_velocity(&self, text: &str) -> bool {
        let Name { base, dots } = name::read(text);
        dots == 0
            && match self.model.names.get(&base) {
                Some(Meaning::Coordinate(_)) => true,
                Some(&Meaning::Input(index)) => !self.model.is_control(index),
                Some(&Meaning::Let(index)) => self.model.lets[index].arguments.is_none(),
                Some(Meaning::Parameter(_)) | None => false,
            }
    }

    fn function(&mut self, ident: &Ident, items: &[Expr], range: Range) {
        let count = items.len();
        let Name { base, .. } = name::read(&ident.to_string());
        if let Some(Meaning::Let(index)) = self.model.names.get(&base)
            && let Some(arguments) = &self.model.lets[*index].arguments
        {
            if arguments.len() != count {
                let message = messages::wrong_number_of_arguments(ident, arguments.len(), count);
                self.errors.at(range, message);
            }
            return;
        }
        if let Some(expected) = Word::named(&ident.to_string()).map(Word::arity) {
            if let ("dot", Some(product)) =
                (ident.to_string().as_str(), function(&ident.to_string(), items))
            {
                self.errors.at(range, messages::dot_of_two(&product));
            } else if expected != count {
                let message = messages::wrong_number_of_arguments(ident, expected, count);
                self.errors.at(range, message);
            }
            return;
        }
        if ident == "sum" {
            self.errors.at(range, messages::sum_without_index());
        } else if self.model.names.contains_key(&base)
            || self.scope.contains(&base)
            || matches!(base.as_str(), "t" | "pi" | "i")
        {
            self.errors.at(ident.span(), messages::no_function(ident));
        } else if !self.model.block.recovery.declarations {
            let lets = self
                .model
                .lets
                .iter()
                .filter(|definition| definition.arguments.is_some())
                .map(|definition| definition.name.to_string());
            let known: Vec<String> =
                Word::all().map(|word| word.name.to_owned()).chain(lets).collect();
            let nearest = || name::nearest(&ident.to_string(), known.iter().map(String::as_str));
            let message = match (function(&ident.to_string(), items), nearest()) {
                (Some(call), _) => messages::untranslated_function(ident, &call),
                (None, nearest) => messages::unknown_function(ident, nearest),
            };
            self.errors.at(ident.span(), message);
        }
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
