//! Declarations: each name is declared once, with its unit and length.

use super::integer::integer;
use super::resolved::{Element, Meaning, Quantity};
use crate::algebra::dimension::Dimension;
use crate::messages::{Errors, message, shared};
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
            _ if 0 < dots => Some(message!(
                "`{ident}` is a time derivative; declare the name without dots, `{base}`"
            )),
            "t" => Some(shared::held_name(ident, "the time")),
            "pi" => Some(shared::held_name(ident, "the number π")),
            "i" => Some(shared::held_name(ident, "the imaginary unit")),
            _ => None,
        };
        if let Some(message) = refusal {
            errors.at(ident.span(), message);
            // Uses of the name refer to this declaration, so that the mistake is reported once.
            names.entry(base).or_insert(meaning);
            return;
        }
        if let Some(first) = self.places.get(&base) {
            errors.at(ident.span(), message!("`{ident}` is declared twice; rename one of the two"));
            errors.at(first.span(), message!("`{first}` is declared here first"));
            return;
        }
        self.places.insert(base.clone(), ident);
        names.insert(base, meaning);
    }
}

/// Returns the quantity that a statement or a field declares.
///
/// An array of two or three components is a vector, any other a family.
pub(super) fn quantity<'a>(
    name: &'a Ident,
    kind: &'a Kind,
    first: usize,
    default: Option<&'a Expr>,
    errors: &mut Errors,
) -> Quantity<'a> {
    let (unit, members, element) = match kind {
        Kind::Scalar(unit) => (unit.as_ref(), None, Element::Scalar),
        Kind::Array { unit, length } => match family_length(length, errors) {
            length @ (2 | 3) => (unit.as_ref(), None, Element::Vector(length)),
            length => (unit.as_ref(), Some(length), Element::Scalar),
        },
        Kind::Matrix { unit, sizes } => {
            if !sizes.iter().all(|size| matches!(integer(size, &|_| None), Ok(3))) {
                let message = message!(
                    "a matrix is symmetric and has three rows and columns; write `[…; 3, 3]`"
                );
                errors.at(sizes[0].range.to(sizes[1].range), message);
            }
            (unit.as_ref(), None, Element::Matrix)
        }
        Kind::Body(_) => (None, None, Element::Body),
        Kind::Solid(_) => (None, None, Element::Solid),
        Kind::Rotation(_) => (None, None, Element::Rotation),
        Kind::Table(..) => (None, None, Element::Table),
    };
    let dimension = match element {
        Element::Rotation => Some(Dimension::PURE),
        _ => unit.and_then(|unit| unit::dimension(unit, errors)),
    };
    let quantity = Quantity {
        name,
        members,
        element,
        first,
        dimension,
        unit: unit.map(text).unwrap_or_default(),
        default,
    };
    if let Some(default) = default
        && quantity.default_items().next().is_none()
    {
        let message = match quantity.length() {
            Some(count) => message!(
                "the default of `{name}` is a list of {count} numbers; write them between \
                 brackets, as in `[1, 2, 3]`"
            ),
            None if quantity.element == Element::Table => message!(
                "a parameter has no points in the block; leave them out and pass a `Table` to \
                 `new`, or write `table {name}(x: m): N = [(0, 0), (1, 2)], outside = linear;`"
            ),
            None => message!("a body has no default; leave it out and pass the value to `new`"),
        };
        errors.at(default.range, message);
    }
    quantity
}

/// Returns a coordinate or a family of `length` coordinates, each a number or a vector; states if
/// `state` is set.
pub(super) fn coordinate<'a>(
    state: bool,
    name: &'a Ident,
    length: Option<&'a Expr>,
    kind: &'a Kind,
    errors: &mut Errors,
) -> Quantity<'a> {
    let mut coordinate = quantity(name, kind, 0, None, errors);
    if let (Some(members), Kind::Array { unit, length }) = (coordinate.members, kind) {
        let unit = unit.as_ref().map_or_else(String::new, |unit| format!(": {}", text(unit)));
        let word = if state { "state" } else { "coordinate" };
        let message = message!(
            "a {word} is a number or a vector of two or three components; write `{word} \
             {name}[{members}]{unit};` for several"
        );
        errors.at(length.range, message);
    }
    coordinate.members = length.map(|expr| family_length(expr, errors)).or(coordinate.members);
    coordinate
}

fn family_length(expr: &Expr, errors: &mut Errors) -> usize {
    match integer(expr, &|_| None) {
        Ok(length) if (1..=LONGEST).contains(&length) => usize::try_from(length).unwrap_or(1),
        Ok(_) => {
            let message = message!("a length is between 1 and {LONGEST}; write another number");
            errors.at(expr.range, message);
            1
        }
        Err(range) => {
            errors.at(range, message!("a length is a whole number; write it out, as in `[kg; 5]`"));
            1
        }
    }
}

/// Reports arguments with the same name.
pub(super) fn twice(definition: &Let, errors: &mut Errors) {
    let arguments = definition.arguments.as_deref().unwrap_or_default();
    for (index, argument) in arguments.iter().enumerate() {
        if arguments[..index].iter().any(|other| plain(other) == plain(argument)) {
            let message = message!("the argument `{argument}` stands twice; rename one of the two");
            errors.at(argument.span(), message);
        }
    }
}
