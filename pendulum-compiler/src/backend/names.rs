//! The names of symbols in printed equations.

use crate::algebra::expr::{Moment, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::{Rational, superscript};
use crate::backend::unicode::Level;
use crate::mechanics::attitude;
use crate::mechanics::lower::{Energies, Row};
use crate::mechanics::motion::Motion;
use crate::model::{Element, Model, Quantity};
use crate::syntax::name;
use std::collections::BTreeMap;

/// The names of all symbols of a block, as the user writes them.
pub(crate) struct Names {
    pub(crate) parameters: Vec<String>,
    pub(crate) coordinates: Vec<String>,
    /// The names of the rates in the places of a rotation, of which the first is unused; none if
    /// equations are not printed.
    rates: BTreeMap<usize, Option<String>>,
    /// The number of coordinates; the states come after them.
    freedoms: usize,
    /// The names of the components of each input.
    inputs: Vec<Vec<String>>,
    /// The names of scalar constraints: `loop.x`, `rod[2]`.
    pub(crate) constraints: Vec<String>,
    /// The names of scalar limits, and of scalar rates with friction.
    pub(crate) limits: Vec<String>,
    pub(crate) frictions: Vec<String>,
    /// The names of tables.
    tables: BTreeMap<u8, String>,
    /// `true` for the signs and spellings of the language in ASCII.
    pub(super) ascii: bool,
}

impl Names {
    /// Creates the names of a block. `energies` contains its constraints, and the parameters of two
    /// or three components that are not vectors.
    pub(crate) fn new(model: &Model, energies: &Energies) -> Self {
        let families = &energies.families;
        let parameters = model.parameters.iter().enumerate();
        let tables = model.tables.iter().map(|(&index, own)| (index, own.name.to_string()));
        Self {
            parameters: parameters
                .flat_map(|(index, quantity)| parameter_names(quantity, families.contains(&index)))
                .collect(),
            coordinates: model.coordinates.iter().flat_map(Quantity::names).collect(),
            rates: BTreeMap::new(),
            freedoms: model.freedoms(),
            inputs: model.inputs.iter().map(Quantity::names).collect(),
            constraints: constraints(model, energies),
            limits: energies.limits.iter().map(|row| row.name.clone()).collect(),
            frictions: energies.frictions.iter().map(|row| row.name.clone()).collect(),
            tables: tables.collect(),
            ascii: model.block.ascii,
        }
    }

    /// Returns the names and the motion for printed equations: in the rates Ω of bodies and the
    /// entries of rotations if there are rotations, because four equations of quaternions say less.
    pub(crate) fn printed<'m>(mut self, model: &Model, motion: &'m Motion) -> (Self, &'m Motion) {
        let Some(motion_in_rates) = &motion.in_rates else { return (self, motion) };
        let letter = if self.ascii { "Omega" } else { "Ω" };
        for (first, name) in attitude::rotations(model) {
            self.rates.insert(first, None);
            for (place, axis) in (first + 1..).zip(["x", "y", "z"]) {
                self.rates.insert(place, Some(format!("{letter}_{name}.{axis}")));
            }
            // They have no constraint of their lengths.
            self.constraints.retain(|own| *own != attitude::norm(&name));
        }
        (self, motion_in_rates)
    }

    /// Returns `true` if a row has no equation: that of the first scalar of a rotation.
    pub(crate) fn skips(&self, row: usize) -> bool {
        self.rates.get(&row).is_some_and(Option::is_none)
    }

    /// Returns the name of a velocity or an acceleration of one or two dots without its dots, and
    /// the number of dots that it has then. The equation of a state is one of its rate.
    pub(crate) fn rate(&self, index: usize, dots: u8) -> (&str, u8) {
        match self.rates.get(&index) {
            Some(Some(rate)) => (rate, dots - 1),
            _ if self.freedoms <= index => (&self.coordinates[index], 1),
            _ => (&self.coordinates[index], dots),
        }
    }

    /// Returns the name of an entry of a rotation: `R.xz`.
    pub(crate) fn entry(&self, first: usize, entry: usize) -> String {
        let rotation = self.coordinates[first].trim_end_matches(".w");
        let axis = |index: usize| ["x", "y", "z"][index % 3];
        format!("{rotation}.{}{}", axis(entry / 3), axis(entry))
    }

    /// Returns the name of a table and the number of derivatives, if the function is that of a
    /// table.
    pub(super) fn table(&self, function: Function) -> Option<(&str, u8)> {
        let Function::Table(index, order) = function else { return None };
        Some((&self.tables[&index], order))
    }

    /// Returns the sign of a negative number or term.
    pub(super) fn minus(&self) -> &'static str {
        if self.ascii { "-" } else { "−" }
    }

    /// Returns the sign between factors.
    pub(super) fn times(&self) -> &'static str {
        if self.ascii { "*" } else { "·" }
    }

    /// Returns a name with dots.
    pub(super) fn dotted(&self, name: &str, dots: u8) -> String {
        dotted(name, dots, self.ascii)
    }

    /// Returns an exponent, with its operator in ASCII.
    pub(super) fn exponent(&self, exponent: Rational) -> String {
        match exponent.integer() {
            Some(count) if !self.ascii => superscript(count),
            Some(count) if !exponent.is_negative() => format!("^{count}"),
            _ => format!("^({exponent})"),
        }
    }

    /// Returns the sign before a term.
    pub(super) fn sign(&self, first: bool, negative: bool) -> String {
        match (first, negative) {
            (true, true) => self.minus().into(),
            (true, false) => String::new(),
            (false, true) => format!(" {} ", self.minus()),
            (false, false) => " + ".into(),
        }
    }

    pub(super) fn number(&self, value: Rational, level: Level) -> String {
        let text = value.to_string().replace('-', self.minus());
        let closed = Level::Sum < level && (value.is_negative() || !value.is_integer());
        if closed { format!("({text})") } else { text }
    }

    /// Returns what stands for an expression that is too long.
    pub(super) fn too_long(&self) -> String {
        format!("{} (too long to write out)", if self.ascii { "..." } else { "…" })
    }

    /// Returns the name of a symbol with its dots.
    pub(crate) fn symbol(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Parameter(index) => self.parameters[index].clone(),
            Symbol::Time => "t".into(),
            Symbol::Coordinate(index) => self.coordinates[index].clone(),
            Symbol::Entry(first, entry) => self.entry(first, entry),
            Symbol::Velocity(index) => {
                let (name, dots) = self.rate(index, 1);
                self.dotted(name, dots)
            }
            Symbol::Acceleration(index) => self.acceleration(index),
            Symbol::Momentum(index) => format!("p_{}", self.coordinates[index]),
            Symbol::Multiplier(index) => {
                let letter = if self.ascii { "lambda" } else { "λ" };
                format!("{letter}_{}", self.constraints[index])
            }
            Symbol::Target(index) => format!("target[{index}]"),
            Symbol::Contact(index) => format!("reaction({})", self.limits[index]),
            Symbol::Friction(index) => format!("reaction({})", self.frictions[index]),
            Symbol::Auxiliary(index) => format!("u[{index}]"),
            Symbol::Position(index) => format!("z[{index}]"),
            Symbol::Point(_, component) => ["p.x", "p.y", "p.z"][component.min(2)].into(),
            Symbol::Moment(body, moment) => {
                let body = self.parameters[body].trim_end_matches(".mass");
                match moment {
                    Moment::Inertia => format!("{body}.inertia"),
                    Moment::Difference => format!("({body}.xx {} {body}.yy)", self.minus()),
                    Moment::Product => format!("{body}.xy"),
                    Moment::About(axis) => {
                        let axis = ["xx", "yy", "zz"][usize::from(axis)];
                        format!("{body}.inertia.{axis}")
                    }
                    Moment::Mixed(pair) => {
                        format!("{body}.{}", ["xy", "xz", "yz"][usize::from(pair)])
                    }
                }
            }
            Symbol::Input { input, component, order } => self.of_input(input, component, order),
            Symbol::Control { input, component } => self.of_input(input, component, 0),
        }
    }

    /// Returns the name of a component of an input with its dots.
    pub(super) fn of_input(&self, input: usize, component: usize, order: u8) -> String {
        self.dotted(self.input(input, component), order)
    }

    /// Returns the name of a component of an input.
    pub(crate) fn input(&self, input: usize, component: usize) -> &str {
        &self.inputs[input][component]
    }

    /// Returns a coordinate with two dots.
    pub(crate) fn acceleration(&self, index: usize) -> String {
        let (name, dots) = self.rate(index, 2);
        self.dotted(name, dots)
    }
}

/// Returns the names of the scalars of a parameter. One of two or three components is a `family` if
/// it is used only with indices.
fn parameter_names(quantity: &Quantity, family: bool) -> Vec<String> {
    match quantity.element {
        Element::Vector(length) if family => {
            (0..length).map(|k| format!("{}[{k}]", quantity.name)).collect()
        }
        _ => quantity.names(),
    }
}

/// Returns a name with dots over its first letter. The result has the ASCII suffix if the name is a
/// word in ASCII or if the block is in ASCII.
fn dotted(name: &str, dots: u8, ascii: bool) -> String {
    if dots == 0 {
        return name.into();
    }
    let (stem, index) = name.split_at(name.find(['[', '.']).unwrap_or(name.len()));
    if ascii || stem.is_ascii() && 1 < stem.len() {
        return format!("{stem}{}{index}", if dots == 1 { "_dot" } else { "_ddot" });
    }
    format!("{}{index}", name::with_dots(stem, dots))
}

/// Returns the names of the constraints in the order in which they are solved and checked.
fn constraints(model: &Model, energies: &Energies) -> Vec<String> {
    let rows = energies.constraints.iter();
    let (solved, checked): (Vec<_>, Vec<_>) =
        rows.partition(|row| !model.constraints[row.statement].redundant);
    let name = |row: &Row| row.name.clone();
    let norms = attitude::rotations(model).into_iter().map(|(_, name)| attitude::norm(&name));
    let solved = solved.into_iter().map(name).chain(norms);
    solved.chain(checked.into_iter().map(name)).collect()
}
