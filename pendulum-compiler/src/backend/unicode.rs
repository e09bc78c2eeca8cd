//! Equations in Unicode, in mathematical notation: θ̈ = −g·sin θ/L.
//!
//! The equations of a block that is written in ASCII are in ASCII too, in the syntax of the
//! language: `theta_ddot = -g*sin(theta)/L`.

use crate::algebra::expr::{Graph, Id, Node, Symbol};
use crate::algebra::functions::{Function, Notation};
use crate::algebra::number::{Literal, Rational};
use crate::backend::cancel;
use crate::backend::names::Names;
use crate::mechanics::motion::Motion;
use crate::mechanics::symmetry::{Conserved, Displacement};
use std::collections::BTreeMap;

/// The lowest precedence that an expression may have without brackets.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
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
    if let Some(state) = row.checked_sub(motion.accelerations.len() - motion.states.len()) {
        return motion.states[state][0];
    }
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
            Node::Call(function, argument) if names.table(*function).is_some() => {
                return format!("{}({})", self.spelled(*function), self.whole(*argument));
            }
            Node::Call(Function::Knots(index, _), argument) => {
                let own = self.spelled(Function::Table(*index, 0));
                return format!("knots of {own}({})", self.whole(*argument));
            }
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
                let text = format!("{}{}", self.spelled(*function), self.operand(*argument));
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
            && self.names.table(*function).is_none()
            && !self.names.ascii
        {
            return format!("{}{raised}{}", self.spelled(*function), self.operand(*argument));
        }
        format!("{}{raised}", self.write(base, Level::Power))
    }

    /// Returns the name of a function with its primes.
    fn spelled(&self, function: Function) -> String {
        let name = self.names.table(function).map_or(function.row().name, |(name, _)| name);
        let primes = function.primes();
        let primes = if self.names.ascii { primes.replace('′', "'") } else { primes };
        format!("{name}{primes}")
    }
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
