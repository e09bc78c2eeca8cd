//! Names to symbols: what every name of a block means, and every name that means nothing.

use crate::ast::{Binder, Block, Expr, ExprKind, ForceIndex, Kind, Let, Role, Statement};
use crate::error::{Errors, Range};
use crate::name::{self, Name};
use crate::number::Rational;
use crate::unit::{self, Dimension};
use proc_macro2::Ident;
use std::collections::BTreeMap;

/// A family longer than this is refused: its equations would not compile within a day.
const LONGEST: i64 = 1024;

/// A block with its names resolved.
pub(crate) struct Model<'a> {
    pub(crate) block: &'a Block,
    pub(crate) parameters: Vec<Quantity<'a>>,
    pub(crate) coordinates: Vec<Quantity<'a>>,
    pub(crate) inputs: Vec<Quantity<'a>>,
    pub(crate) lets: Vec<&'a Let>,
    pub(crate) energies: Vec<(Role, &'a Expr)>,
    pub(crate) forces: Vec<Force<'a>>,
    pub(crate) names: BTreeMap<String, Meaning>,
}

/// A declared parameter, coordinate or driven input.
pub(crate) struct Quantity<'a> {
    pub(crate) name: &'a Ident,
    /// `None` for a scalar, the length of a vector or family otherwise.
    pub(crate) length: Option<usize>,
    /// The number of scalars declared before it.
    pub(crate) first: usize,
    pub(crate) dimension: Option<Dimension>,
    pub(crate) unit: String,
    pub(crate) default: Option<&'a Expr>,
    /// A rigid body: mass, centre and central moments.
    pub(crate) body: bool,
}

impl Quantity<'_> {
    /// The number of its scalars.
    pub(crate) fn count(&self) -> usize {
        if self.body { 6 } else { self.length.unwrap_or(1) }
    }
}

/// A `force` statement.
pub(crate) struct Force<'a> {
    pub(crate) coordinate: usize,
    pub(crate) name: &'a Ident,
    pub(crate) index: Option<&'a ForceIndex>,
    pub(crate) expr: &'a Expr,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Parameter(usize),
    Coordinate(usize),
    Input(usize),
    Let(usize),
}

/// The functions of the language, with their number of arguments.
#[rustfmt::skip]
pub(crate) const FUNCTIONS: &[(&str, usize)] = &[
    ("sqrt", 1), ("exp", 1), ("ln", 1), ("sin", 1), ("cos", 1), ("tan", 1), ("asin", 1), ("acos", 1), ("atan", 1), ("atan2", 2),
    ("sinh", 1), ("cosh", 1), ("tanh", 1), ("abs", 1), ("sign", 1), ("min", 2), ("max", 2),
    ("dot", 1), ("inner", 2), ("cross", 2), ("perp", 1), ("height", 1), ("cis", 1),
];

/// Resolves every name, reports those that cannot be.
pub(crate) fn resolve<'a>(block: &'a Block, errors: &mut Errors) -> Model<'a> {
    let mut model = Model {
        block,
        parameters: Vec::new(),
        coordinates: Vec::new(),
        inputs: Vec::new(),
        lets: Vec::new(),
        energies: Vec::new(),
        forces: Vec::new(),
        names: BTreeMap::new(),
    };
    let mut declared = Declared::default();
    let (mut parameters, mut coordinates, mut inputs) = (0, 0, 0);
    for field in &block.fields {
        let meaning = Meaning::Parameter(model.parameters.len());
        declared.declare(&mut model.names, &field.name, meaning, errors);
        let quantity = quantity(&field.name, Shape::Kind(&field.kind), parameters, field.default.as_ref(), errors);
        parameters += quantity.count();
        model.parameters.push(quantity);
    }
    for statement in &block.statements {
        match statement {
            Statement::Coordinate { name, length, unit } => {
                declared.declare(&mut model.names, name, Meaning::Coordinate(model.coordinates.len()), errors);
                let quantity = quantity(name, Shape::Family(length.as_ref(), unit.as_ref()), coordinates, None, errors);
                coordinates += quantity.count();
                model.coordinates.push(quantity);
            }
            Statement::Driven { name, kind } => {
                declared.declare(&mut model.names, name, Meaning::Input(model.inputs.len()), errors);
                let quantity = quantity(name, Shape::Kind(kind), inputs, None, errors);
                if quantity.length.is_some_and(|length| !(2..=3).contains(&length)) {
                    errors.at(name.span(), "a driven input is a scalar or a vector; write `[m; 2]` or `[m; 3]`");
                }
                inputs += quantity.count();
                model.inputs.push(quantity);
            }
            Statement::Let(definition) => {
                declared.declare(&mut model.names, &definition.name, Meaning::Let(model.lets.len()), errors);
                twice(definition, errors);
                model.lets.push(definition);
            }
            Statement::Energy { role, expr, .. } => model.energies.push((*role, expr)),
            Statement::Force { .. } => {}
        }
    }
    if model.inputs.len() > 8 {
        errors.at(model.inputs[8].name.span(), "more than eight driven inputs; join some of them into vectors");
    }
    for statement in &block.statements {
        if let Statement::Force { name, index, expr, .. } = statement {
            force(&mut model, name, index.as_ref(), expr, errors);
        }
    }
    roles(block, errors);
    if model.coordinates.is_empty() && !block.lost.declarations {
        errors.at(block.name.span(), "no coordinate; write `coordinate θ: rad;` below the struct");
    }
    let mut walk = Walk { model: &model, errors, scope: Vec::new() };
    walk.block();
    model
}

/// Arguments of one name.
fn twice(definition: &Let, errors: &mut Errors) {
    let arguments = definition.arguments.as_deref().unwrap_or_default();
    for (index, argument) in arguments.iter().enumerate() {
        if arguments[..index].iter().any(|other| plain(other) == plain(argument)) {
            errors.at(argument.span(), format!("the argument `{argument}` stands twice; rename one of the two"));
        }
    }
}

/// Where each name was first declared.
#[derive(Default)]
struct Declared<'a> {
    places: BTreeMap<String, &'a Ident>,
}

impl<'a> Declared<'a> {
    fn declare(&mut self, names: &mut BTreeMap<String, Meaning>, ident: &'a Ident, meaning: Meaning, errors: &mut Errors) {
        let Name { base, dots } = name::read(&ident.to_string());
        let refusal = match base.as_str() {
            _ if 0 < dots => Some(format!("`{ident}` is a time derivative; declare the name without dots, `{}`", plain(ident))),
            "t" => Some("`t` is the time; choose another name".to_owned()),
            "pi" => Some(format!("`{ident}` is the number π; choose another name")),
            "i" => Some("`i` is the imaginary unit; choose another name".to_owned()),
            _ => None,
        };
        if let Some(message) = refusal {
            errors.at(ident.span(), message);
            // Whoever uses the name means this declaration: one mistake gives one message.
            names.entry(base).or_insert(meaning);
            return;
        }
        if let Some(first) = self.places.get(&base) {
            errors.at(ident.span(), format!("`{ident}` is declared twice; rename one of the two"));
            errors.at(first.span(), format!("`{first}` is declared here first"));
            return;
        }
        self.places.insert(base.clone(), ident);
        names.insert(base, meaning);
    }
}

/// A dotted name without its dots, as the user would write it.
fn plain(ident: &Ident) -> String {
    name::read(&ident.to_string()).base
}

#[derive(Clone, Copy)]
enum Shape<'a> {
    Kind(&'a Kind),
    Family(Option<&'a Expr>, Option<&'a Expr>),
}

fn quantity<'a>(name: &'a Ident, shape: Shape<'a>, first: usize, default: Option<&'a Expr>, errors: &mut Errors) -> Quantity<'a> {
    let (unit, length) = match shape {
        Shape::Kind(Kind::Scalar(unit)) => (unit.as_ref(), None),
        Shape::Kind(Kind::Array { unit, length }) => (Some(unit), Some(length)),
        Shape::Kind(Kind::Body(_)) => (None, None),
        Shape::Family(length, unit) => (unit, length),
    };
    let length = length.map(|expr| family_length(expr, errors));
    let body = matches!(shape, Shape::Kind(Kind::Body(_)));
    if let (true, Some(default)) = (body || length.is_some(), default) {
        errors.at(default.range, "only a scalar has a default; leave it out and pass the value to `new`");
    }
    let dimension = unit.and_then(|unit| unit::dimension(unit, errors));
    Quantity { name, length, first, dimension, unit: unit.map(text).unwrap_or_default(), default, body }
}

fn family_length(expr: &Expr, errors: &mut Errors) -> usize {
    match integer(expr, &[]) {
        Ok(length) if (1..=LONGEST).contains(&length) => usize::try_from(length).unwrap_or(1),
        Ok(_) => {
            errors.at(expr.range, format!("a length is between 1 and {LONGEST}; write another number"));
            1
        }
        Err(range) => {
            errors.at(range, "a length is a whole number; write it out, as in `[kg; 5]`");
            1
        }
    }
}

fn force<'a>(model: &mut Model<'a>, name: &'a Ident, index: Option<&'a ForceIndex>, expr: &'a Expr, errors: &mut Errors) {
    let Name { base, dots } = name::read(&name.to_string());
    match model.names.get(&base) {
        Some(&Meaning::Coordinate(coordinate)) if dots == 0 => model.forces.push(Force { coordinate, name, index, expr }),
        Some(_) => {
            errors.at(name.span(), format!("`{name}` is no coordinate; a force acts on a coordinate, as in `force θ = …;`"));
        }
        None if model.block.lost.declarations => {}
        None => {
            let known = model.coordinates.iter().map(|coordinate| coordinate.name.to_string()).collect::<Vec<_>>();
            errors.at(name.span(), unknown(&name.to_string(), known.iter().map(String::as_str)));
        }
    }
}

/// Either `lagrangian`, once, or `kinetic` and `potential`.
fn roles(block: &Block, errors: &mut Errors) {
    let mut lagrangian = None;
    let mut split = None;
    for statement in &block.statements {
        if let Statement::Energy { role, keyword, .. } = statement {
            match role {
                Role::Lagrangian if lagrangian.is_some() => {
                    errors.at(*keyword, "`lagrangian` stands twice; write one sum");
                }
                Role::Lagrangian => lagrangian = Some(*keyword),
                Role::Kinetic | Role::Potential => split = split.or(Some(*keyword)),
                Role::Dissipation => {}
            }
        }
    }
    if let (Some(_), Some(split)) = (lagrangian, split) {
        errors.at(split, "`lagrangian` is kinetic minus potential energy already; write either one or the other");
    }
    if lagrangian.is_none() && split.is_none() && !block.lost.energies {
        errors.at(block.name.span(), "no energy; write `kinetic = …;` and `potential = …;` below the struct");
    }
}

/// A whole number, with the values of the indices in scope; the range that is none otherwise.
pub(crate) fn integer(expr: &Expr, scope: &[(String, i64)]) -> Result<i64, Range> {
    let value = rational(expr, scope).ok_or(expr.range)?;
    value.integer().ok_or(expr.range)
}

fn rational(expr: &Expr, scope: &[(String, i64)]) -> Option<Rational> {
    match &expr.kind {
        ExprKind::Name(ident) => {
            let name = name::read(&ident.to_string());
            let &(_, value) = scope.iter().rev().find(|(known, _)| *known == name.base && name.dots == 0)?;
            Some(Rational::whole(value))
        }
        ExprKind::Negative(inner) => Some(rational(inner, scope)?.negative()),
        ExprKind::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (minus, term)| {
            let term = rational(term, scope)?;
            sum.add(if *minus { term.negative() } else { term })
        }),
        ExprKind::Product(factors) => factors.iter().try_fold(Rational::ONE, |product, (over, factor)| {
            let factor = rational(factor, scope)?;
            product.mul(if *over { factor.reciprocal()? } else { factor })
        }),
        _ => unit::constant(expr),
    }
}

/// The text of a small expression, for messages and facts.
pub(crate) fn text(expr: &Expr) -> String {
    use crate::ast::Literal;
    let list = |items: &[Expr]| items.iter().map(text).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        // A literal is a decimal fraction, so that its nearest double prints as it was written.
        ExprKind::Number(Literal::Exact(value)) => (value.numerator() as f64 / value.denominator() as f64).to_string(),
        ExprKind::Number(Literal::Decimal(digits)) => digits.clone(),
        ExprKind::Name(name) => name.to_string(),
        ExprKind::Sum(terms) => joined(terms, " + ", " - "),
        ExprKind::Product(factors) => joined(factors, "*", "/"),
        ExprKind::Negative(inner) => format!("-{}", closed(inner)),
        ExprKind::Power(base, exponent) => format!("{}^{}", closed(base), closed(exponent)),
        ExprKind::Call(name, items) => format!("{name}({})", list(items)),
        ExprKind::Index(base, index) => format!("{}[{}]", text(base), text(index)),
        ExprKind::Component(base, component) => format!("{}.{component}", text(base)),
        ExprKind::Vector(items) => format!("[{}]", list(items)),
        ExprKind::Magnitude(inner) => format!("|{}|", text(inner)),
        ExprKind::SumOver(binder, term) => format!("sum({} in …, {})", binder.name, text(term)),
        ExprKind::Integral { point, body, .. } => format!("integral({point} in {body}, …)"),
    }
}

fn joined(items: &[(bool, Expr)], plus: &str, minus: &str) -> String {
    let mut result = String::new();
    for (index, (negative, item)) in items.iter().enumerate() {
        if 0 < index {
            result.push_str(if *negative { minus } else { plus });
        }
        let first = index == 0 && matches!(item.kind, ExprKind::Negative(_));
        result.push_str(&if first { text(item) } else { closed(item) });
    }
    result
}

fn closed(expr: &Expr) -> String {
    match expr.kind {
        ExprKind::Sum(_) | ExprKind::Product(_) | ExprKind::Negative(_) => format!("({})", text(expr)),
        _ => text(expr),
    }
}

/// "unknown name, with the nearest known one".
fn unknown<'b>(name: &str, known: impl Iterator<Item = &'b str>) -> String {
    match name::nearest(name, known) {
        Some(near) => format!("unknown name `{name}`; did you mean `{near}`?"),
        None => format!("unknown name `{name}`; declare it as a parameter, a coordinate, a driven input or with `let`"),
    }
}

/// A walk over all expressions that reports what no one declared.
struct Walk<'m, 'a, 'e> {
    model: &'m Model<'a>,
    errors: &'e mut Errors,
    scope: Vec<String>,
}

impl Walk<'_, '_, '_> {
    fn block(&mut self) {
        let model = self.model;
        for quantity in &model.parameters {
            if let Some(default) = quantity.default.filter(|_| quantity.length.is_none() && !quantity.body) {
                self.constant(default);
            }
        }
        for definition in &model.lets {
            let depth = self.scope.len();
            if let Some(binder) = &definition.index {
                self.bind(binder);
            }
            for argument in definition.arguments.iter().flatten() {
                self.local(argument, "an argument");
            }
            self.expr(&definition.expr);
            self.scope.truncate(depth);
        }
        for (_, expr) in &model.energies {
            self.expr(expr);
        }
        for force in &model.forces {
            let depth = self.scope.len();
            match force.index {
                Some(ForceIndex::Each(binder)) => self.bind(binder),
                Some(ForceIndex::One(index)) => self.expr(index),
                None => {}
            }
            self.expr(force.expr);
            self.scope.truncate(depth);
        }
    }

    /// A default is made of numbers.
    fn constant(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name(name) if name::read(&name.to_string()) == (Name { base: "pi".into(), dots: 0 }) => {}
            ExprKind::Sum(items) | ExprKind::Product(items) => items.iter().for_each(|(_, item)| self.constant(item)),
            ExprKind::Negative(inner) => self.constant(inner),
            ExprKind::Power(base, exponent) => {
                self.constant(base);
                self.constant(exponent);
            }
            ExprKind::Call(name, items)
                if FUNCTIONS.iter().take(16).any(|(function, count)| name == function && *count == items.len()) =>
            {
                for item in items {
                    self.constant(item);
                }
            }
            _ => self.errors.at(expr.range, "a default is a number; write its value, as in `g: m/s^2 = 9.81`"),
        }
    }

    fn bind(&mut self, binder: &Binder) {
        self.expr(&binder.low);
        self.expr(&binder.high);
        self.local(&binder.name, "an index");
    }

    /// A name that holds in one expression; it may hide a parameter or a definition, but nothing that moves.
    fn local(&mut self, ident: &Ident, what: &str) {
        let Name { base, dots } = name::read(&ident.to_string());
        let hidden = match base.as_str() {
            _ if 0 < dots => Some(format!("`{ident}` is a time derivative")),
            "t" => Some(format!("`{ident}` is the time")),
            "pi" => Some(format!("`{ident}` is the number π")),
            "i" if what != "an index" => Some(format!("`{ident}` is the imaginary unit")),
            _ => match self.model.names.get(&base) {
                Some(Meaning::Coordinate(_)) => Some(format!("`{ident}` is a coordinate")),
                Some(Meaning::Input(_)) => Some(format!("`{ident}` is a driven input")),
                _ => None,
            },
        };
        if let Some(hidden) = hidden {
            self.errors.at(ident.span(), format!("{hidden}, and {what} of this name would hide it; choose another name"));
        }
        self.scope.push(base);
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name(name) => self.name(name),
            ExprKind::Sum(items) | ExprKind::Product(items) => items.iter().for_each(|(_, item)| self.expr(item)),
            ExprKind::Negative(inner) | ExprKind::Magnitude(inner) => self.expr(inner),
            ExprKind::Power(base, exponent) => {
                self.expr(base);
                self.expr(exponent);
            }
            ExprKind::Call(name, items) => {
                self.function(name, items.len(), expr.range);
                for item in items {
                    self.expr(item);
                }
            }
            ExprKind::Index(base, index) => {
                self.expr(base);
                self.expr(index);
            }
            ExprKind::Component(base, component) => {
                self.expr(base);
                let known: &[&str] = if self.body(base) { &["mass", "center", "inertia"] } else { &["x", "y", "z"] };
                if !known.iter().any(|known| component == known) {
                    let list = known.iter().map(|name| format!("`.{name}`")).collect::<Vec<_>>().join(", ");
                    self.errors.at(component.span(), format!("unknown component `{component}`; there are {list}"));
                }
            }
            ExprKind::Vector(items) => {
                for item in items {
                    self.expr(item);
                }
            }
            ExprKind::SumOver(binder, term) => {
                let depth = self.scope.len();
                self.bind(binder);
                self.expr(term);
                self.scope.truncate(depth);
            }
            ExprKind::Integral { point, body, integrand } => {
                let Name { base, dots } = name::read(&body.to_string());
                match self.model.names.get(&base) {
                    Some(&Meaning::Parameter(index)) if dots == 0 && self.model.parameters[index].body => {}
                    Some(_) => {
                        self.errors.at(body.span(), format!("`{body}` is no body; declare it as `{body}: body` in the struct"));
                    }
                    None => self.name(body),
                }
                self.local(point, "a point");
                self.expr(integrand);
                self.scope.pop();
            }
        }
    }

    /// Whether an expression is the name of a body.
    fn body(&self, expr: &Expr) -> bool {
        let ExprKind::Name(ident) = &expr.kind else { return false };
        let Name { base, dots } = name::read(&ident.to_string());
        let meaning = self.model.names.get(&base).filter(|_| dots == 0 && !self.scope.contains(&base));
        matches!(meaning, Some(&Meaning::Parameter(index)) if self.model.parameters[index].body)
    }

    fn name(&mut self, ident: &Ident) {
        let Name { base, dots } = name::read(&ident.to_string());
        if self.scope.contains(&base) {
            return;
        }
        match (base.as_str(), self.model.names.get(&base)) {
            ("t" | "pi" | "i", _) if dots == 0 => {}
            ("t" | "pi" | "i", _) => {
                self.errors.at(ident.span(), format!("`{ident}` does not move as a coordinate does; write a number"));
            }
            (_, Some(Meaning::Parameter(_))) if 0 < dots => self.errors.at(
                ident.span(),
                format!(
                    "`{}` is a parameter, so nothing in `{ident}` moves; declare it `driven` or as a coordinate",
                    plain(ident)
                ),
            ),
            (_, Some(Meaning::Coordinate(_))) if 1 < dots => self.errors.at(
                ident.span(),
                format!("`{ident}` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
            ),
            (_, Some(Meaning::Input(_))) if 2 < dots => {
                self.errors.at(ident.span(), format!("`{ident}` is a third derivative; driven inputs have two"));
            }
            (_, Some(_)) => {}
            (_, None) if self.model.block.lost.declarations => {}
            (text, None) if FUNCTIONS.iter().any(|(function, _)| *function == text) => {
                self.errors.at(ident.span(), format!("`{ident}` is a function; write `{ident}(…)`"));
            }
            (_, None) => {
                let known = self.known();
                self.errors.at(ident.span(), unknown(&ident.to_string(), known.iter().map(String::as_str)));
            }
        }
    }

    fn function(&mut self, ident: &Ident, count: usize, range: Range) {
        let Name { base, .. } = name::read(&ident.to_string());
        if let Some(Meaning::Let(index)) = self.model.names.get(&base)
            && let Some(arguments) = &self.model.lets[*index].arguments
        {
            if arguments.len() != count {
                self.errors.at(range, format!("`{ident}` takes {}; {count} stand here", plural(arguments.len())));
            }
            return;
        }
        if let Some(&(_, expected)) = FUNCTIONS.iter().find(|(function, _)| ident == function) {
            if expected != count {
                self.errors.at(range, format!("`{ident}` takes {}; {count} stand here", plural(expected)));
            }
            return;
        }
        if ident == "sum" {
            self.errors.at(range, "`sum` runs over an index; write `sum(k in 0..5, …)`");
        } else if self.model.names.contains_key(&base) || self.scope.contains(&base) {
            self.errors.at(
                ident.span(),
                format!("`{ident}` is no function, and there is no implicit multiplication; write `{ident}*(…)`"),
            );
        } else if !self.model.block.lost.declarations {
            let lets = self
                .model
                .lets
                .iter()
                .filter(|definition| definition.arguments.is_some())
                .map(|definition| definition.name.to_string());
            let known: Vec<String> = FUNCTIONS.iter().map(|(function, _)| (*function).to_owned()).chain(lets).collect();
            let message = match name::nearest(&ident.to_string(), known.iter().map(String::as_str)) {
                Some(near) => format!("unknown function `{ident}`; did you mean `{near}`?"),
                None => format!("unknown function `{ident}`; define it with `let {ident}(p) = …;`"),
            };
            self.errors.at(ident.span(), message);
        }
    }

    /// Every declared name as written.
    fn known(&self) -> Vec<String> {
        let quantities = self.model.parameters.iter().chain(&self.model.coordinates).chain(&self.model.inputs);
        quantities
            .map(|quantity| quantity.name)
            .chain(self.model.lets.iter().map(|definition| &definition.name))
            .map(ToString::to_string)
            .collect()
    }
}

fn plural(count: usize) -> String {
    if count == 1 { "one argument".into() } else { format!("{count} arguments") }
}
