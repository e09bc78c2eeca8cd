//! Equations in Unicode, in mathematical notation: θ̈ = −g·sin θ/L.
//!
//! The equations of a block that is written in ASCII are in ASCII too, in the syntax of the
//! language: `theta_ddot = -g*sin(theta)/L`.

use crate::algebra::expr::{Graph, Id, Moment, Node, Symbol};
use crate::algebra::functions::{Function, Notation};
use crate::algebra::number::{Literal, Rational, superscript};
use crate::backend::cancel;
use crate::mechanics::attitude;
use crate::mechanics::lower::{Energies, Row};
use crate::mechanics::motion::Motion;
use crate::mechanics::symmetry::{Conserved, Displacement};
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
    /// The names of the components of each input.
    inputs: Vec<Vec<String>>,
    /// The names of scalar constraints: `loop.x`, `rod[2]`.
    pub(crate) constraints: Vec<String>,
    /// The names of scalar limits, and of scalar rates with friction.
    pub(crate) limits: Vec<String>,
    pub(crate) frictions: Vec<String>,
    /// `true` for the signs and spellings of the language in ASCII.
    ascii: bool,
}

impl Names {
    /// Creates the names of a block. `energies` contains its constraints, and the parameters of two
    /// or three components that are not vectors.
    pub(crate) fn new(model: &Model, energies: &Energies) -> Self {
        let families = &energies.families;
        let parameters = model.parameters.iter().enumerate();
        Self {
            parameters: parameters
                .flat_map(|(index, quantity)| parameter_names(quantity, families.contains(&index)))
                .collect(),
            coordinates: model.coordinates.iter().flat_map(Quantity::names).collect(),
            rates: BTreeMap::new(),
            inputs: model.inputs.iter().map(Quantity::names).collect(),
            constraints: constraints(model, energies),
            limits: energies.limits.iter().map(|row| row.name.clone()).collect(),
            frictions: energies.frictions.iter().map(|row| row.name.clone()).collect(),
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
    /// the number of dots that it has then.
    pub(crate) fn rate(&self, index: usize, dots: u8) -> (&str, u8) {
        match self.rates.get(&index) {
            Some(Some(rate)) => (rate, dots - 1),
            _ => (&self.coordinates[index], dots),
        }
    }

    /// Returns the name of an entry of a rotation: `R.xz`.
    pub(crate) fn entry(&self, first: usize, entry: usize) -> String {
        let rotation = self.coordinates[first].trim_end_matches(".w");
        let axis = |index: usize| ["x", "y", "z"][index % 3];
        format!("{rotation}.{}{}", axis(entry / 3), axis(entry))
    }

    /// Returns the sign of a negative number or term.
    fn minus(&self) -> &'static str {
        if self.ascii { "-" } else { "−" }
    }

    /// Returns the sign between factors.
    fn times(&self) -> &'static str {
        if self.ascii { "*" } else { "·" }
    }

    /// Returns a name with dots.
    fn dotted(&self, name: &str, dots: u8) -> String {
        dotted(name, dots, self.ascii)
    }

    /// Returns an exponent, with its operator in ASCII.
    fn exponent(&self, exponent: Rational) -> String {
        match exponent.integer() {
            Some(count) if !self.ascii => superscript(count),
            Some(count) if !exponent.is_negative() => format!("^{count}"),
            _ => format!("^({exponent})"),
        }
    }

    /// Returns the sign before a term.
    fn sign(&self, first: bool, negative: bool) -> String {
        match (first, negative) {
            (true, true) => self.minus().into(),
            (true, false) => String::new(),
            (false, true) => format!(" {} ", self.minus()),
            (false, false) => " + ".into(),
        }
    }

    fn number(&self, value: Rational, level: Level) -> String {
        let text = value.to_string().replace('-', self.minus());
        let closed = Level::Sum < level && (value.is_negative() || !value.is_integer());
        if closed { format!("({text})") } else { text }
    }

    /// Returns what stands for an expression that is too long.
    fn too_long(&self) -> String {
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
    fn of_input(&self, input: usize, component: usize, order: u8) -> String {
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

/// The lowest precedence that an expression may have without brackets.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
}

/// Returns an expression as text.
pub(crate) fn expression(graph: &Graph, names: &Names, id: Id) -> String {
    Writer { graph, names }.whole(id)
}

/// The right side of an equation as it is written.
pub(crate) enum Side {
    /// The one of the motion.
    Own,
    /// The same without terms that cancel, in a separate graph.
    Shorter(Graph, Id),
    /// The equation is too long to be written out.
    TooLong,
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

/// Returns the right sides of the equations, without terms that cancel.
pub(crate) fn sides(graph: &Graph, names: &Names, motion: &Motion) -> Vec<Side> {
    let mut total = 0;
    let short = |row: usize| {
        // An equation is solved if its coordinate is not coupled to others.
        let mut roots = vec![right(motion, row)];
        if !is_uncoupled(motion, row) {
            roots.extend(motion.mass_matrix[row].iter().filter(|&&entry| entry != Graph::ZERO));
        }
        let length = length(graph, &roots);
        if LONGEST < length || LONGEST_TOGETHER < total + length {
            return Side::TooLong;
        }
        total += length;
        let shorter = cancel::shorter(graph, right(motion, row), |graph, id| {
            expression(graph, names, id).chars().count()
        });
        shorter.map_or(Side::Own, |(own, id)| Side::Shorter(own, id))
    };
    (0..motion.accelerations.len()).map(short).collect()
}

/// Returns the right side of the equation in a row: the acceleration if its coordinate is not
/// coupled to others, otherwise the force.
fn right(motion: &Motion, row: usize) -> Id {
    match motion.constraints.sides.get(row) {
        Some(&side) if motion.constraints.bound(row) => side,
        _ if is_uncoupled(motion, row) => motion.accelerations[row],
        _ => motion.forces[row],
    }
}

/// Returns `true` if a row of the mass matrix has a single entry and no constraint acts on its
/// coordinate.
pub(crate) fn is_uncoupled(motion: &Motion, row: usize) -> bool {
    let entries = motion.mass_matrix[row].iter().filter(|&&entry| entry != Graph::ZERO);
    entries.count() == 1 && !motion.constraints.bound(row)
}

/// Returns the right side of the equation in a row, with its graph; `None` if it is too long.
pub(crate) fn side<'g>(
    graph: &'g Graph,
    motion: &Motion,
    sides: &'g [Side],
    row: usize,
) -> Option<(&'g Graph, Id)> {
    match &sides[row] {
        Side::Own => Some((graph, right(motion, row))),
        Side::Shorter(own, id) => Some((own, *id)),
        Side::TooLong => None,
    }
}

/// Writes the expressions of a graph.
struct Writer<'a> {
    graph: &'a Graph,
    names: &'a Names,
}

impl Writer<'_> {
    fn write(&self, id: Id, level: Level) -> String {
        let names = self.names;
        let (text, own) = match self.graph.node(id) {
            Node::Number(value) | Node::Opaque(Literal::Exact(value)) => {
                return names.number(*value, level);
            }
            Node::Opaque(Literal::Decimal(digits)) => return digits.clone(),
            Node::Pi => return if names.ascii { "pi" } else { "π" }.into(),
            Node::Symbol(symbol) => return names.symbol(*symbol),
            Node::Sum(terms) => (self.sum(terms), Level::Sum),
            Node::Product(coefficient, factors) => self.product(*coefficient, factors),
            Node::Call(function, argument) => {
                let row = function.row();
                match row.ascii {
                    _ if row.notation == Notation::Bars => {
                        return format!("|{}|", self.whole(*argument));
                    }
                    Some(ascii) if names.ascii => {
                        return ascii(function.order().unwrap_or(0), &self.whole(*argument));
                    }
                    _ => {}
                }
                let text = format!("{}{}", spelled(*function), self.operand(*argument));
                if names.ascii {
                    return text;
                }
                (text, Level::Product)
            }
            Node::Atan2(y, x) => return format!("atan2({}, {})", self.whole(*y), self.whole(*x)),
            Node::Max(a, b) => return format!("max({}, {})", self.whole(*a), self.whole(*b)),
            Node::Atom(inner) => return self.write(*inner, level),
        };
        let call = matches!(self.graph.node(id), Node::Call(..));
        if own < level && !(call && level == Level::Product) { format!("({text})") } else { text }
    }

    /// Writes an expression that stands alone or between brackets.
    fn whole(&self, id: Id) -> String {
        self.write(id, Level::Sum)
    }

    /// Writes the argument of a function, with the space or bracket before it.
    fn operand(&self, argument: Id) -> String {
        if self.names.ascii {
            return format!("({})", self.whole(argument));
        }
        let inner = self.write(argument, Level::Power);
        if inner.starts_with('(') { inner } else { format!(" {inner}") }
    }

    fn sum(&self, terms: &[(Id, Rational)]) -> String {
        let mut ordered: Vec<&(Id, Rational)> = terms.iter().collect();
        ordered.sort_by_key(|(_, coefficient)| coefficient.is_negative());
        let mut text = String::new();
        for (index, &&(term, coefficient)) in ordered.iter().enumerate() {
            text.push_str(&self.names.sign(index == 0, coefficient.is_negative()));
            let factors = if term == Graph::ONE { Vec::new() } else { self.graph.factors(term) };
            text.push_str(&self.product(coefficient.abs(), &factors).0);
        }
        text
    }

    fn product(&self, coefficient: Rational, factors: &[(Id, Rational)]) -> (String, Level) {
        let times = self.names.times();
        let sign = if coefficient.is_negative() { self.names.minus() } else { "" };
        let coefficient = coefficient.abs();
        let mut ordered: Vec<&(Id, Rational)> = factors.iter().collect();
        ordered.sort_by_key(|(base, _)| rank(self.graph, *base));
        let (mut above, mut below) = (Vec::new(), Vec::new());
        if coefficient.numerator() != 1 {
            above.push(coefficient.numerator().to_string());
        }
        if coefficient.denominator() != 1 {
            below.push(coefficient.denominator().to_string());
        }
        for &(base, exponent) in ordered {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            side.push(self.power(base, exponent.abs()));
        }
        // A factor after a function would be read as part of its argument. Functions therefore
        // come last, in brackets if there are several.
        let top = if above.is_empty() { "1".to_owned() } else { above.join(times) };
        let alone = above.len() == 1 && below.is_empty() && !above[0].contains(' ');
        let level = match (sign, alone) {
            ("", true) => Level::Power,
            ("", false) => Level::Product,
            _ => Level::Sum,
        };
        let text = match &below[..] {
            [] => format!("{sign}{top}"),
            [bottom] => format!("{sign}{top}/{bottom}"),
            _ => format!("{sign}{top}/({})", below.join(times)),
        };
        (text, level)
    }

    fn power(&self, base: Id, exponent: Rational) -> String {
        if exponent == Rational::ONE {
            return self.write(base, Level::Product);
        }
        if exponent == Rational::HALF {
            let root = if self.names.ascii { "sqrt" } else { "√" };
            return format!("{root}({})", self.whole(base));
        }
        let raised = self.names.exponent(exponent);
        if let Node::Call(function, argument) = self.graph.node(base)
            && function.row().notation != Notation::Bars
            && !self.names.ascii
        {
            return format!("{}{raised}{}", spelled(*function), self.operand(*argument));
        }
        format!("{}{raised}", self.write(base, Level::Power))
    }
}

/// Returns the name of a function with its primes.
fn spelled(function: Function) -> String {
    format!("{}{}", function.row().name, function.primes())
}

/// Returns `true` if a text contains a space outside of brackets. The text is then a function whose
/// argument would absorb further factors.
fn open(text: &str) -> bool {
    let mut depth = 0;
    text.chars().any(|letter| {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        depth == 0 && letter == ' '
    })
}

/// Returns the rank of a factor in a product, in the usual order: numbers, parameters, other
/// symbols, sums, functions.
fn rank(graph: &Graph, base: Id) -> u8 {
    match graph.node(base) {
        Node::Number(_) | Node::Opaque(_) | Node::Pi => 0,
        Node::Symbol(Symbol::Parameter(_)) => 1,
        Node::Symbol(_) => 2,
        Node::Sum(_) | Node::Atom(_) | Node::Product(..) => 3,
        Node::Atan2(..) | Node::Max(..) => 4,
        Node::Call(..) => 5,
    }
}

/// Returns the name of a conserved quantity in terms of the momenta: `p_φ`, `x·p_y − y·p_x`.
pub(crate) fn conserved(names: &Names, conserved: &Conserved) -> String {
    let mut terms = conserved.terms.clone();
    // Start with a positive term.
    if let Some(first) = terms.iter().position(|(factor, ..)| !factor.is_negative()) {
        let first = terms.remove(first);
        terms.insert(0, first);
    }
    let mut text = String::new();
    for (index, &(factor, displacement)) in terms.iter().enumerate() {
        text.push_str(&names.sign(index == 0, factor.is_negative()));
        let mut parts = Vec::new();
        if factor.abs() != Rational::ONE {
            parts.push(names.number(factor.abs(), Level::Product));
        }
        let turn = |letter: &str, first: usize, axis: usize| {
            let rotation = names.coordinates[first].trim_end_matches(".w");
            format!("{letter}_{rotation}.{}", ["x", "y", "z"][axis])
        };
        match displacement {
            Displacement::Constant(i) => parts.push(names.symbol(Symbol::Momentum(i))),
            Displacement::Linear(i, j) => {
                parts.push(names.coordinates[j].clone());
                parts.push(names.symbol(Symbol::Momentum(i)));
            }
            Displacement::InSpace(first, axis) => parts.push(turn("L", first, axis)),
            Displacement::InBody(first, axis) => {
                parts.push(turn(if names.ascii { "Pi" } else { "Π" }, first, axis));
            }
        }
        text.push_str(&parts.join(names.times()));
    }
    text
}

/// The limit on the symbols of a line. An expression that is shared in the graph is repeated in the
/// text for every use.
const LONGEST: usize = 1000;

/// The same limit for all equations together. Beyond it, the text of a large family would be longer
/// than its code.
const LONGEST_TOGETHER: usize = 20 * LONGEST;

/// Writes an expression, or says that it is too long.
pub(crate) fn short(graph: &Graph, names: &Names, id: Id) -> String {
    if long(graph, id) {
        return names.too_long();
    }
    expression(graph, names, id)
}

/// Returns `true` if an expression is too long to be written out.
pub(crate) fn long(graph: &Graph, id: Id) -> bool {
    LONGEST < length(graph, &[id])
}

/// Returns the number of symbols in the text of expressions.
fn length(graph: &Graph, roots: &[Id]) -> usize {
    let mut lengths: BTreeMap<Id, usize> = BTreeMap::new();
    for id in graph.reachable(roots) {
        let length = graph
            .children(id)
            .iter()
            .fold(1, |sum: usize, child| sum.saturating_add(lengths[child]));
        lengths.insert(id, length);
    }
    roots.iter().fold(0, |sum: usize, root| sum.saturating_add(lengths[root]))
}

/// Returns the equations of motion, with a line for each coordinate and for each constraint. The
/// equation of a coordinate is solved if the coordinate is not coupled to others; otherwise, it is
/// a row of M q̈ = f + Cᵀλ.
pub(crate) fn equations(
    graph: &mut Graph,
    names: &Names,
    motion: &Motion,
    sides: &[Side],
) -> Vec<String> {
    let mut lines = Vec::new();
    for row in (0..motion.accelerations.len()).filter(|&row| !names.skips(row)) {
        let Some((own, id)) = side(graph, motion, sides, row) else {
            lines.push(format!("{} = {}", names.acceleration(row), names.too_long()));
            continue;
        };
        let side = expression(own, names, id);
        if is_uncoupled(motion, row) {
            lines.push(format!("{} = {side}", names.acceleration(row)));
            continue;
        }
        let mut left = String::new();
        for (column, &entry) in motion.mass_matrix[row].iter().enumerate() {
            if entry == Graph::ZERO {
                continue;
            }
            let negative = graph.split(entry).0.is_negative();
            let magnitude = if negative { graph.negative(entry) } else { entry };
            left.push_str(&names.sign(left.is_empty(), negative));
            if magnitude != Graph::ONE {
                let text = Writer { graph, names }.write(magnitude, Level::Product);
                let text = if open(&text) { format!("({text})") } else { text };
                left.push_str(&text);
                left.push_str(names.times());
            }
            left.push_str(&names.acceleration(column));
        }
        lines.push(format!("{left} = {side}"));
    }
    let length = |graph: &Graph, id| expression(graph, names, id).chars().count();
    for (row, value) in motion.constraints.values(graph).into_iter().enumerate() {
        let shorter = if long(graph, value) { None } else { cancel::shorter(graph, value, length) };
        let left = match shorter {
            Some((own, id)) => expression(&own, names, id),
            None => short(graph, names, value),
        };
        lines.push(format!("{left} = 0 ({})", names.constraints[row]));
    }
    lines
}
