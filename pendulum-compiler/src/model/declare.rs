//! Declarations: each name is declared once, with its unit and length.

use super::integer::integer;
use super::resolved::{Meaning, Quantity};
use crate::messages::Errors;
use crate::messages::model::{self as messages, Holder};
use crate::model::unit;
use crate::syntax::ast::{Expr, Kind, Let};
use crate::syntax::name::{self, Name, plain};
use crate::syntax::text::text;
use proc_macro2::Ident;
use std::collections::BTreeMap;

/// The largest length of a family. The equations of longer families would take days to compile.
const LONGEST: i64 = 1024;

/// The declaration of each name.
#[derive(Default)]
pub(super) struct Declared<'a> {
    places: BTreeMap<String, &'a Ident>,
}

impl<'a> Declared<'a> {
    pub(super) fn declare(
        &mut self,
        names: &mut BTreeMap<String, Meaning>,
        ident: &'a Ident,
        meaning: Meaning,
        errors: &mut Errors,
    ) {
        let Name { base, dots } = name::read(&ident.to_string());
        let refusal = match base.as_str() {
            _ if 0 < dots => Some(messages::derivative_as_name(ident, &base)),
            "t" => Some(messages::held_name(ident, Holder::Time)),
            "pi" => Some(messages::held_name(ident, Holder::Pi)),
            "i" => Some(messages::held_name(ident, Holder::ImaginaryUnit)),
            _ => None,
        };
        if let Some(message) = refusal {
            errors.at(ident.span(), message);
            // Uses of the name refer to this declaration, so that the mistake is reported once.
            names.entry(base).or_insert(meaning);
            return;
        }
        if let Some(first) = self.places.get(&base) {
            errors.at(ident.span(), messages::declared_twice(ident));
            errors.at(first.span(), messages::first_declaration(first));
            return;
        }
        self.places.insert(base.clone(), ident);
        names.insert(base, meaning);
    }
}

#[derive(Clone, Copy)]
pub(super) enum Shape<'a> {
    Kind(&'a Kind),
    Family(Option<&'a Expr>, Option<&'a Expr>),
}

pub(super) fn quantity<'a>(
    name: &'a Ident,
    shape: Shape<'a>,
    first: usize,
    default: Option<&'a Expr>,
    errors: &mut Errors,
) -> Quantity<'a> {
    let (unit, length) = match shape {
        Shape::Kind(Kind::Scalar(unit)) => (unit.as_ref(), None),
        Shape::Kind(Kind::Array { unit, length }) => (unit.as_ref(), Some(length)),
        Shape::Kind(Kind::Body(_)) => (None, None),
        Shape::Family(length, unit) => (unit, length),
    };
    let length = length.map(|expr| family_length(expr, errors));
    let body = matches!(shape, Shape::Kind(Kind::Body(_)));
    if let (true, Some(default)) = (body || length.is_some(), default) {
        errors.at(default.range, messages::default_of_several());
    }
    let dimension = unit.and_then(|unit| unit::dimension(unit, errors));
    Quantity {
        name,
        length,
        first,
        dimension,
        unit: unit.map(text).unwrap_or_default(),
        default,
        body,
    }
}

fn family_length(expr: &Expr, errors: &mut Errors) -> usize {
    match integer(expr, &|_| None) {
        Ok(length) if (1..=LONGEST).contains(&length) => usize::try_from(length).unwrap_or(1),
        Ok(_) => {
            errors.at(expr.range, messages::huge_length(LONGEST));
            1
        }
        Err(range) => {
            errors.at(range, messages::open_length());
            1
        }
    }
}

/// Reports arguments with the same name.
pub(super) fn twice(definition: &Let, errors: &mut Errors) {
    let arguments = definition.arguments.as_deref().unwrap_or_default();
    for (index, argument) in arguments.iter().enumerate() {
        if arguments[..index].iter().any(|other| plain(other) == plain(argument)) {
            errors.at(argument.span(), messages::twin_arguments(argument));
        }
    }
}
