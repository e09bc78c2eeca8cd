//! Equations as they are drawn on paper, with fractions and indices: the tree that `latex` and
//! `mathml` print. `unicode` has the same equations in one line, with fractions between brackets.

use crate::algebra::expr::{Graph, Id, Moment, Node, Symbol};
use crate::algebra::functions::{Function, Notation};
use crate::algebra::number::{Literal, Rational};
use crate::backend::names::Names;
use crate::backend::unicode::{self, Side};
use crate::mechanics::motion::Motion;
use crate::syntax::name;

/// A part of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Layout {
    /// Digits, and letters and signs within indices and exponents.
    Plain(String),
    /// A letter, or the English name of a Greek one.
    Letter(String),
    /// A word in upright letters.
    Word(String),
    /// A function, by its command in LaTeX.
    Command(&'static str),
    /// `+`, `-` or `=` between two parts.
    Sign(char),
    /// The sign of a negative part.
    Minus,
    Comma,
    /// The space between factors, and before the bare argument of a function.
    Space,
    /// Parts that stand together.
    Row(Vec<Layout>),
    Dots(Box<Layout>, u8),
    Below(Box<Layout>, Vec<Layout>),
    Above(Box<Layout>, Vec<Layout>),
    Fraction(Vec<Layout>, Vec<Layout>),
    Root(Vec<Layout>),
    /// Brackets as high as what they enclose.
    Fence([char; 2], Vec<Layout>),
    /// What stands for an expression that is too long.
    TooLong,
}

use Layout::{Above, Below, Comma, Fraction, Letter, Minus, Plain, Row, Sign, Space, TooLong};

/// Returns the equations of motion, each as its parts. `unicode::equations` returns the same
/// equations in Unicode.
pub(crate) fn equations(
    graph: &mut Graph,
    names: &Names,
    motion: &Motion,
    sides: &[Side],
) -> Vec<Vec<Layout>> {
    let mut lines = Vec::new();
    for row in (0..motion.accelerations.len()).filter(|&row| !names.skips(row)) {
        let writer = Writer { graph, names };
        let mut line = Vec::new();
        let Some((own, id)) = unicode::side(graph, motion, sides, row) else {
            line.extend([writer.rate(row, 2), Sign('='), TooLong]);
            lines.push(line);
            continue;
        };
        if unicode::is_uncoupled(motion, row) {
            line.push(writer.rate(row, 2));
        } else {
            for (column, &entry) in motion.mass_matrix[row].iter().enumerate() {
                if entry == Graph::ZERO {
                    continue;
                }
                line.extend((!line.is_empty()).then_some(Sign('+')));
                if entry != Graph::ONE {
                    line.extend(writer.coefficient(entry));
                    line.push(Space);
                }
                line.push(writer.rate(column, 2));
            }
        }
        line.push(Sign('='));
        line.extend(Writer { graph: own, names }.sum(id));
        lines.push(line);
    }
    for value in motion.constraints.values(graph) {
        let mut line = if unicode::long(graph, value) {
            vec![TooLong]
        } else {
            Writer { graph, names }.sum(value)
        };
        line.extend([Sign('='), Plain("0".into())]);
        lines.push(line);
    }
    lines
}

struct Writer<'a> {
    graph: &'a Graph,
    names: &'a Names,
}

impl Writer<'_> {
    /// Lays out an expression that is not followed by factors or exponents.
    fn sum(&self, id: Id) -> Vec<Layout> {
        match self.graph.node(id) {
            Node::Sum(terms) => {
                let mut ordered: Vec<&(Id, Rational)> = terms.iter().collect();
                ordered.sort_by_key(|(_, coefficient)| coefficient.is_negative());
                let mut parts = Vec::new();
                for &(term, coefficient) in ordered {
                    match (parts.is_empty(), coefficient.is_negative()) {
                        (true, false) => {}
                        (true, true) => parts.push(Minus),
                        (false, negative) => parts.push(Sign(if negative { '-' } else { '+' })),
                    }
                    let factors =
                        if term == Graph::ONE { Vec::new() } else { self.graph.factors(term) };
                    parts.extend(self.product(coefficient.abs(), &factors));
                }
                parts
            }
            Node::Product(coefficient, factors) => {
                signed(coefficient.is_negative(), self.product(coefficient.abs(), factors))
            }
            Node::Atom(inner) => self.sum(*inner),
            Node::Opaque(Literal::Exact(value)) => rational(*value),
            _ => self.factor(id),
        }
    }

    fn product(&self, coefficient: Rational, factors: &[(Id, Rational)]) -> Vec<Layout> {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        if coefficient.numerator() != 1 || factors.is_empty() && coefficient.denominator() == 1 {
            above.push(vec![Plain(coefficient.numerator().to_string())]);
        }
        if coefficient.denominator() != 1 {
            below.push(vec![Plain(coefficient.denominator().to_string())]);
        }
        let mut ordered: Vec<&(Id, Rational)> = factors.iter().collect();
        // The argument of a function extends to the end of the product, so that functions come
        // last.
        ordered.sort_by_key(|(base, _)| matches!(self.graph.node(*base), Node::Call(..)));
        // The only factor in a numerator or denominator needs no brackets.
        let tops =
            above.len() + ordered.iter().filter(|(_, exponent)| !exponent.is_negative()).count();
        let bottoms = below.len() + ordered.len() + above.len() - tops;
        for &&(base, exponent) in &ordered {
            let side = if exponent.is_negative() { bottoms } else { tops };
            let alone = side == 1 && 0 < bottoms && exponent.abs() == Rational::ONE;
            let parts = if alone { self.sum(base) } else { self.power(base, exponent.abs()) };
            if exponent.is_negative() { below.push(parts) } else { above.push(parts) }
        }
        if above.is_empty() {
            above.push(vec![Plain("1".into())]);
        }
        let [above, below] = [above, below].map(|factors| factors.join(&Space));
        if below.is_empty() { above } else { vec![Fraction(above, below)] }
    }

    fn power(&self, base: Id, exponent: Rational) -> Vec<Layout> {
        if exponent == Rational::ONE {
            return self.factor(base);
        }
        if exponent == Rational::HALF {
            return vec![Layout::Root(self.sum(base))];
        }
        let raised = |part| Above(Box::new(part), vec![Plain(exponent.to_string())]);
        if let Node::Call(function, argument) = self.graph.node(base)
            && let (None, Some(command)) = (self.names.table(*function), command(*function))
        {
            return [vec![raised(command)], self.argument(*argument)].concat();
        }
        let mut parts = self.closed(base);
        let last = parts.pop().map(raised);
        parts.extend(last);
        parts
    }

    /// Lays out an expression that is followed by an exponent.
    fn closed(&self, id: Id) -> Vec<Layout> {
        let open = match self.graph.node(id) {
            Node::Number(value) | Node::Opaque(Literal::Exact(value)) => {
                value.is_negative() || !value.is_integer()
            }
            Node::Product(..) => true,
            Node::Atom(inner) => return self.closed(*inner),
            _ => false,
        };
        if open { vec![brackets(self.sum(id))] } else { self.factor(id) }
    }

    /// Lays out an expression as a factor.
    fn factor(&self, id: Id) -> Vec<Layout> {
        match self.graph.node(id) {
            Node::Number(value) => rational(*value),
            Node::Opaque(Literal::Decimal(digits)) => vec![Plain(digits.clone())],
            Node::Pi => vec![Letter("pi".into())],
            Node::Symbol(symbol) => vec![self.symbol(*symbol)],
            Node::Sum(_) => vec![brackets(self.sum(id))],
            // The sign of a negative factor would be read as a difference.
            Node::Product(..) | Node::Opaque(Literal::Exact(_)) => {
                let parts = self.sum(id);
                if parts[0] == Minus { vec![brackets(parts)] } else { parts }
            }
            Node::Call(function, argument) => {
                match (self.names.table(*function), command(*function)) {
                    (Some((name, order)), _) => {
                        let name = dotted(name, 0);
                        let primes = Plain("'".repeat(order.into()));
                        let name = if order == 0 { name } else { Row(vec![name, primes]) };
                        vec![name, brackets(self.sum(*argument))]
                    }
                    (None, Some(command)) => [vec![command], self.argument(*argument)].concat(),
                    (None, None) => vec![Layout::Fence(['|', '|'], self.sum(*argument))],
                }
            }
            Node::Atan2(y, x) => self.pair("\\operatorname{atan2}", *y, *x),
            Node::Max(a, b) => self.pair("\\max", *a, *b),
            Node::Atom(inner) => self.factor(*inner),
        }
    }

    fn pair(&self, command: &'static str, a: Id, b: Id) -> Vec<Layout> {
        let both = [self.sum(a), vec![Comma], self.sum(b)].concat();
        vec![Layout::Command(command), brackets(both)]
    }

    /// Lays out a factor that is followed by a symbol. Without brackets, the symbol would be read
    /// as part of the bare argument of a function.
    fn coefficient(&self, id: Id) -> Vec<Layout> {
        let bare = |&(base, _): &(Id, Rational)| match self.graph.node(base) {
            Node::Call(_, argument) => matches!(self.graph.node(*argument), Node::Symbol(_)),
            _ => false,
        };
        let parts = self.factor(id);
        let first = if let Above(base, _) = &parts[0] { base } else { &parts[0] };
        let open = self.graph.factors(id).iter().any(bare)
            && !matches!(first, Layout::Fence(['(', ')'], _));
        if open { vec![brackets(parts)] } else { parts }
    }

    fn argument(&self, id: Id) -> Vec<Layout> {
        match self.graph.node(id) {
            Node::Symbol(_) | Node::Pi => [vec![Space], self.factor(id)].concat(),
            _ => vec![brackets(self.sum(id))],
        }
    }

    fn coordinate(&self, index: usize, dots: u8) -> Layout {
        dotted(&self.names.coordinates[index], dots)
    }

    fn rate(&self, index: usize, dots: u8) -> Layout {
        let (name, dots) = self.names.rate(index, dots);
        dotted(name, dots)
    }

    fn input(&self, input: usize, component: usize, dots: u8) -> Layout {
        dotted(self.names.input(input, component), dots)
    }

    fn symbol(&self, symbol: Symbol) -> Layout {
        let word = |base, index: &String| below(base, Layout::Word(index.clone()));
        match symbol {
            Symbol::Parameter(index) => dotted(&self.names.parameters[index], 0),
            Symbol::Coordinate(index) => self.coordinate(index, 0),
            Symbol::Entry(first, entry) => dotted(&self.names.entry(first, entry), 0),
            Symbol::Velocity(index) => self.rate(index, 1),
            Symbol::Acceleration(index) => self.rate(index, 2),
            Symbol::Multiplier(index) => word("lambda", &self.names.constraints[index]),
            Symbol::Auxiliary(index) => below("u", Plain(index.to_string())),
            Symbol::Target(index) => below("tau", Plain(index.to_string())),
            Symbol::Contact(index) => word("N", &self.names.limits[index]),
            Symbol::Friction(index) => word("F", &self.names.frictions[index]),
            Symbol::Position(index) => below("z", Plain(index.to_string())),
            Symbol::Momentum(index) => below("p", self.coordinate(index, 0)),
            Symbol::Point(_, component) => below("p", letter(["x", "y", "z"][component.min(2)])),
            Symbol::Input { input, component, order } => self.input(input, component, order),
            Symbol::Control { input, component } => self.input(input, component, 0),
            Symbol::Moment(first, moment) => {
                let body = self.names.parameters[first].trim_end_matches(".mass");
                let body = dotted(body, 0);
                let entry = |matrix: &str, index: &str| {
                    let of = Above(Box::new(letter(matrix)), vec![body.clone()]);
                    Below(Box::new(of), vec![Plain(index.into())])
                };
                let second = |index: &str| entry("S", index);
                match moment {
                    Moment::Inertia => below("I", body),
                    Moment::Difference => brackets(vec![second("xx"), Sign('-'), second("yy")]),
                    Moment::Product => second("xy"),
                    Moment::About(axis) => entry("I", ["xx", "yy", "zz"][usize::from(axis)]),
                    Moment::Mixed(pair) => second(["xy", "xz", "yz"][usize::from(pair)]),
                }
            }
            Symbol::Time => letter("t"),
        }
    }
}

fn letter(letter: &str) -> Layout {
    Letter(letter.into())
}

fn below(base: &str, index: Layout) -> Layout {
    Below(Box::new(letter(base)), vec![index])
}

fn brackets(parts: Vec<Layout>) -> Layout {
    Layout::Fence(['(', ')'], parts)
}

fn signed(negative: bool, mut parts: Vec<Layout>) -> Vec<Layout> {
    if negative {
        parts.insert(0, Minus);
    }
    parts
}

fn rational(value: Rational) -> Vec<Layout> {
    let [above, below] =
        [value.numerator().abs(), value.denominator()].map(|number| Plain(number.to_string()));
    let size = if value.is_integer() { above } else { Fraction(vec![above], vec![below]) };
    signed(value.is_negative(), vec![size])
}

/// Returns the sign of a function; `None` if its argument is written between bars.
fn command(function: Function) -> Option<Layout> {
    let Notation::Prefix(command) = function.row().notation else { return None };
    let command = Layout::Command(command);
    Some(match function.order() {
        None | Some(0) => command,
        Some(order @ 1..=3) => Row(vec![command, Plain("'".repeat(order.into()))]),
        Some(order) => Row(vec![Above(Box::new(command), vec![Plain(format!("({order})"))])]),
    })
}

/// Lays out a name such as `θ1`, `l[0]`, `B.center.x` or `theta_max` with dots. Its first word is
/// the letter, the rest the index.
fn dotted(name: &str, dots: u8) -> Layout {
    let spelled = name::read(name).base;
    let split = spelled.find(|letter: char| !letter.is_alphabetic()).unwrap_or(spelled.len());
    let (word, rest) = spelled.split_at(split);
    let short = name::is_greek(word) || word.chars().count() <= 1;
    let word = if short { letter(word) } else { Layout::Word(word.into()) };
    let word = if dots == 0 { word } else { Layout::Dots(Box::new(word), dots) };
    let index: Vec<&str> =
        rest.split(['[', ']', '.', '_']).filter(|part| !part.is_empty()).collect();
    if index.is_empty() { word } else { Below(Box::new(word), vec![Plain(index.join(","))]) }
}

#[cfg(test)]
mod tests {
    use crate::backend::latex;

    fn dotted(name: &str, dots: u8) -> String {
        latex::equation(&[super::dotted(name, dots)])
    }

    #[test]
    fn names_have_their_indices_below() {
        assert_eq!(dotted("θ", 2), "\\ddot{\\theta}");
        assert_eq!(dotted("θ[3]", 1), "\\dot{\\theta}_{3}");
        assert_eq!(dotted("m1", 0), "m_{1}");
        assert_eq!(dotted("theta_max", 0), "\\theta_{max}");
        assert_eq!(dotted("B.center.x", 0), "B_{center,x}");
        assert_eq!(dotted("mass", 0), "\\mathrm{mass}");
    }
}
