//! The declared names of a block as documented items.

use super::{Copy, is_keyword};
use crate::algebra::dimension::Dimension;
use crate::algebra::number::Rational;
use crate::backend::{Analysis, unlocated};
use crate::model::{Element, Meaning, Quantity, Table};
use crate::syntax::ast::{Expr, Let};
use crate::syntax::name;
use crate::syntax::text::text;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use syn::Attribute;

/// A declared name.
struct Declared<'d> {
    name: &'d Ident,
    /// The kind, as a noun with its article.
    kind: &'static str,
    shape: Shape,
    /// The user's documentation.
    documentation: Vec<&'d Attribute>,
    /// The value as text.
    definition: Option<String>,
    /// The default as text.
    default: Option<String>,
    /// `true` if its velocity is offered.
    moves: bool,
}

impl Copy<'_, '_, '_> {
    /// Returns the items of constraints and of all other names.
    pub(super) fn declarations(&self) -> [TokenStream; 2] {
        let mut items = [(); 2].map(|()| TokenStream::new());
        let Some(analysis) = self.analysis else { return items };
        let [constraints, others] = &mut items;
        let (model, mut spelled) = (analysis.model, self.spelled());
        for (base, &meaning) in &model.names {
            if let Meaning::Let(index) = meaning
                && let Some(arguments) = &model.lets[index].arguments
            {
                let Let { name, expr, .. } = model.lets[index];
                let value = text(expr);
                others.extend(Self::function("A definition", name, arguments, &value));
                continue;
            }
            if let Meaning::Table(index) = meaning {
                let Table { name, written, .. } = &model.tables[&index];
                let (argument, value) = match written {
                    Some((own, _)) => {
                        let point = |[x, y]: &[Expr; 2]| format!("({}, {})", text(x), text(y));
                        let points = own.points.iter().map(point).collect::<Vec<String>>();
                        (own.argument.clone(), format!("[{}]", points.join(", ")))
                    }
                    None => (format_ident!("x"), "its `Table`".to_owned()),
                };
                others.extend(Self::function("A table", name, &[argument], &value));
                continue;
            }
            let Some(declared) = Self::declared(analysis, meaning) else { continue };
            let mut names = spelled.remove(base).unwrap_or_default();
            names.extend(declared.offered(model.block.ascii));
            others.extend(names.iter().filter_map(|spelling| declared.item(spelling)));
        }
        let row = |kind: &str, name, difference: &Expr, sign| {
            let [left, right] = difference.sides().map(text);
            (name, format!("A {kind}.\n\n```text\n{name}: {left} {sign} {right}\n```"))
        };
        let held = model.constraints.iter();
        let held = held.map(|own| row("constraint", &own.name, &own.difference, "="));
        let limits = model.limits.iter();
        let limits = limits.map(|own| row("limit", &own.name, &own.difference, ">="));
        let frictions = model.frictions.iter().filter(|own| own.limit.is_none()).map(|own| {
            let [rate, force] = [&own.slip.rate, &own.slip.force].map(text);
            let name = own.name;
            (name, format!("A friction.\n\n```text\n{name}: {rate}, force = {force}\n```"))
        });
        let named = held.chain(limits).chain(frictions);
        for (name, text) in named.filter(|(name, _)| !is_keyword(name)) {
            constraints.extend(quote! {
                #[doc = #text]
                pub static #name: Constraint;
            });
        }
        items
    }

    /// Returns the spellings of each name and of its derivatives in the block.
    fn spelled(&self) -> BTreeMap<String, BTreeSet<String>> {
        let names = self.scan.names.iter().filter_map(|(name, _)| Some(name.as_ref()?.to_string()));
        let mut spelled: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for spelling in names.collect::<BTreeSet<String>>() {
            spelled.entry(name::read(&spelling).base).or_default().insert(spelling);
        }
        spelled
    }

    /// Returns what is declared by a name other than that of a table.
    fn declared<'d>(analysis: &'d Analysis, meaning: Meaning) -> Option<Declared<'d>> {
        let model = analysis.model;
        let quantity = |quantity: &'d Quantity, kind: &'static str| Declared {
            name: quantity.name,
            kind,
            shape: Shape {
                unit: quantity.unit.clone(),
                dimension: quantity.dimension,
                lengths: quantity.lengths(),
                body: match quantity.element {
                    Element::Body => Some("Body"),
                    Element::Solid => Some("Solid"),
                    _ => None,
                },
            },
            documentation: Vec::new(),
            definition: None,
            default: quantity.default.map(text),
            moves: false,
        };
        Some(match meaning {
            Meaning::Table(_) => return None,
            Meaning::Parameter(index) => {
                let attributes = &model.block.fields[index].attributes;
                let documentation = attributes
                    .iter()
                    .filter(|attribute| attribute.path().is_ident("doc"))
                    .collect();
                Declared { documentation, ..quantity(&model.parameters[index], "A parameter") }
            }
            Meaning::Coordinate(index) => {
                let kind = if index < model.mechanical { "A coordinate" } else { "A state" };
                Declared { moves: true, ..quantity(&model.coordinates[index], kind) }
            }
            Meaning::Input(index) if model.is_control(index) => {
                quantity(&model.inputs[index], "A control input")
            }
            Meaning::Input(index) => {
                Declared { moves: true, ..quantity(&model.inputs[index], "A driven input") }
            }
            Meaning::Let(index) => {
                let definition = model.lets[index];
                let dimension = analysis.units.definitions.get(index).copied().flatten();
                Declared {
                    name: &definition.name,
                    kind: "A definition",
                    shape: Shape {
                        unit: dimension.map(|dimension| dimension.to_string()).unwrap_or_default(),
                        dimension,
                        lengths: analysis.energies.lengths.get(index).cloned().unwrap_or_default(),
                        body: None,
                    },
                    documentation: Vec::new(),
                    definition: Some(text(&definition.expr)),
                    default: None,
                    moves: false,
                }
            }
        })
    }

    /// Returns the item of a definition with arguments or of a table.
    fn function(kind: &str, name: &Ident, arguments: &[Ident], value: &str) -> TokenStream {
        if arguments.iter().chain([name]).any(is_keyword) {
            return TokenStream::new();
        }
        let list = arguments.iter().map(Ident::to_string).collect::<Vec<_>>().join(", ");
        let text = format!("{kind}.\n\n```text\n{name}({list}) = {value}\n```");
        let arguments = arguments.iter().map(unlocated);
        quote! {
            #[doc = #text]
            pub fn #name(#(#arguments: impl Quantity),*) -> impl Quantity;
        }
    }
}

impl Declared<'_> {
    /// Returns the spellings that an editor offers: the name and those of its velocity.
    fn offered(&self, ascii: bool) -> impl Iterator<Item = String> {
        let own = self.name.to_string();
        let suffixed = self.moves.then(|| format!("{own}_dot"));
        let dotted = name::velocity(&own).filter(|_| self.moves && !ascii);
        suffixed.into_iter().chain(dotted).chain([own])
    }

    /// Returns the item of the name or of one of its derivatives, in one of its spellings.
    fn item(&self, spelling: &str) -> Option<TokenStream> {
        let mut item = syn::parse_str::<Ident>(spelling).ok()?;
        item.set_span(self.name.span());
        let (name, kind, documentation) = (self.name, self.shape.kind(), &self.documentation);
        let mut text = match name::read(spelling).dots {
            0 => format!("{}{}.", self.kind, self.shape.shown(0)),
            1 => format!("The velocity of `{name}`{}.", self.shape.shown(1)),
            2 => format!("The acceleration of `{name}`{}.", self.shape.shown(2)),
            order => format!("The derivative of `{name}` of order {order}."),
        };
        if let Some(default) = &self.default {
            let _ = write!(text, " The default is {default}.");
        }
        if let Some(definition) = &self.definition {
            let _ = write!(text, "\n\n```text\n{name} = {definition}\n```");
        }
        if !documentation.is_empty() {
            text.insert(0, '\n');
        }
        Some(quote!(#(#documentation)* #[doc = #text] pub static #item: #kind;))
    }
}

/// The unit and the lengths of a value, as far as they are known.
struct Shape {
    /// The unit as written or inferred.
    unit: String,
    dimension: Option<Dimension>,
    /// The lengths, outermost first.
    lengths: Vec<usize>,
    /// The type of a body in Rust.
    body: Option<&'static str>,
}

impl Shape {
    /// Returns the unit of a time derivative and the lengths, in the notation of declarations.
    fn shown(&self, order: u8) -> String {
        if self.body.is_some() {
            return String::new();
        }
        let unit = self.unit_of(order);
        if unit.is_none() && self.lengths.is_empty() {
            return String::new();
        }
        let unit = unit.unwrap_or_else(|| "_".to_owned());
        let text = self.lengths.iter().rev().fold(unit, |inner, n| format!("[{inner}; {n}]"));
        format!(" in `{text}`")
    }

    fn unit_of(&self, order: u8) -> Option<String> {
        let dimension = self.dimension?;
        match (order, self.unit.as_str()) {
            (0, _) if dimension == Dimension::PURE && self.unit != "rad" => Some("1".to_owned()),
            (0, unit) => Some(unit.to_owned()),
            (1, "rad") => Some("rad/s".to_owned()),
            (_, "rad") => Some(format!("rad/s^{order}")),
            _ => {
                let second = Dimension::whole([0, 0, 1, 0, 0]);
                let rate = dimension.times(second, Rational::whole(-i64::from(order)))?;
                Some(rate.to_string())
            }
        }
    }

    /// Returns the type of the value in Rust. Editors do not show the lengths of arrays.
    fn kind(&self) -> TokenStream {
        if let Some(body) = self.body {
            let body = format_ident!("{body}");
            return quote!(#body);
        }
        self.lengths.iter().fold(quote!(f64), |inner, _| quote!([#inner]))
    }
}
