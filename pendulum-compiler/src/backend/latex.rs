//! Equations in LaTeX: `\ddot{\theta} = -\frac{g \sin\theta}{L}`.

use crate::algebra::expr::{Graph, Id, Moment, Node, Symbol};
use crate::algebra::functions::{Function, Notation};
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::backend::unicode::{self, Names, Sides};
use crate::mechanics::motion::Motion;
use crate::syntax::name;

/// Returns the equations of motion in LaTeX, with a line for each coordinate. `unicode::equations`
/// returns the same equations in Unicode.
pub(crate) fn equations(
    graph: &mut Graph,
    names: &Names,
    motion: &Motion,
    sides: &Sides,
) -> Vec<String> {
    let mut lines = Vec::new();
    for row in 0..motion.accelerations.len() {
        let coupled: Vec<(usize, Id)> = motion.mass_matrix[row]
            .iter()
            .copied()
            .enumerate()
            .filter(|&(_, entry)| entry != Graph::ZERO)
            .collect();
        let writer = Writer { graph, names };
        if unicode::too_long(graph, motion, row) {
            lines.push(format!(
                "{} = \\ldots\\text{{ (too long to write out)}}",
                writer.coordinate(row, 2)
            ));
            continue;
        }
        let (own, id) = unicode::side(graph, motion, sides, row);
        let side = Writer { graph: own, names }.sum(id);
        if unicode::is_uncoupled(motion, row) {
            lines.push(format!("{} = {side}", writer.coordinate(row, 2)));
            continue;
        }
        let terms: Vec<String> = coupled
            .iter()
            .map(|&(column, entry)| {
                let symbol = writer.coordinate(column, 2);
                if entry == Graph::ONE {
                    symbol
                } else {
                    format!("{} {symbol}", writer.coefficient(entry))
                }
            })
            .collect();
        lines.push(format!("{} = {side}", terms.join(" + ")));
    }
    for value in motion.constraints.values(graph) {
        if unicode::long(graph, &[value]) {
            lines.push("\\ldots\\text{ (too long to write out)} = 0".into());
        } else {
            lines.push(format!("{} = 0", Writer { graph, names }.sum(value)));
        }
    }
    lines
}

struct Writer<'a> {
    graph: &'a Graph,
    names: &'a Names,
}

impl Writer<'_> {
    /// Writes an expression that is not followed by factors or exponents.
    fn sum(&self, id: Id) -> String {
        match self.graph.node(id) {
            Node::Sum(terms) => {
                let mut ordered: Vec<&(Id, Rational)> = terms.iter().collect();
                ordered.sort_by_key(|(_, coefficient)| coefficient.is_negative());
                let mut text = String::new();
                for (index, &&(term, coefficient)) in ordered.iter().enumerate() {
                    text.push_str(match (index, coefficient.is_negative()) {
                        (0, false) => "",
                        (0, true) => "-",
                        (_, false) => " + ",
                        (_, true) => " - ",
                    });
                    let factors =
                        if term == Graph::ONE { Vec::new() } else { self.graph.factors(term) };
                    text.push_str(&self.product(coefficient.abs(), &factors));
                }
                text
            }
            Node::Product(coefficient, factors) => {
                let sign = if coefficient.is_negative() { "-" } else { "" };
                format!("{sign}{}", self.product(coefficient.abs(), factors))
            }
            Node::Atom(inner) => self.sum(*inner),
            _ => self.factor(id),
        }
    }

    fn product(&self, coefficient: Rational, factors: &[(Id, Rational)]) -> String {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        if coefficient.numerator() != 1 || factors.is_empty() && coefficient.denominator() == 1 {
            above.push(coefficient.numerator().to_string());
        }
        if coefficient.denominator() != 1 {
            below.push(coefficient.denominator().to_string());
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
            let text = if alone { self.sum(base) } else { self.power(base, exponent.abs()) };
            if exponent.is_negative() { below.push(text) } else { above.push(text) }
        }
        if below.is_empty() {
            return if above.is_empty() { "1".into() } else { above.join(" ") };
        }
        let top = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        format!("\\frac{{{top}}}{{{}}}", below.join(" "))
    }

    fn power(&self, base: Id, exponent: Rational) -> String {
        if exponent == Rational::ONE {
            return self.factor(base);
        }
        if exponent == Rational::HALF {
            return format!("\\sqrt{{{}}}", self.sum(base));
        }
        if let Node::Call(function, argument) = self.graph.node(base)
            && let Some(command) = command(*function)
        {
            return format!("{command}^{{{exponent}}}{}", self.argument(*argument));
        }
        format!("{}^{{{exponent}}}", self.closed(base))
    }

    /// Writes an expression that is followed by an exponent.
    fn closed(&self, id: Id) -> String {
        let open = match self.graph.node(id) {
            Node::Number(value) | Node::Opaque(Literal::Exact(value)) => {
                value.is_negative() || !value.is_integer()
            }
            Node::Product(..) => true,
            Node::Atom(inner) => return self.closed(*inner),
            _ => false,
        };
        if open { format!("\\left({}\\right)", self.sum(id)) } else { self.factor(id) }
    }

    /// Writes an expression as a factor.
    fn factor(&self, id: Id) -> String {
        match self.graph.node(id) {
            Node::Number(value) => rational(*value),
            Node::Opaque(Literal::Exact(value)) => rational(*value),
            Node::Opaque(Literal::Decimal(digits)) => digits.clone(),
            Node::Pi => "\\pi".into(),
            Node::Symbol(symbol) => self.symbol(*symbol),
            Node::Sum(_) => format!("\\left({}\\right)", self.sum(id)),
            Node::Product(..) => {
                let text = self.sum(id);
                if text.starts_with('-') { format!("\\left({text}\\right)") } else { text }
            }
            Node::Call(function, argument) => match command(*function) {
                Some(command) => format!("{command}{}", self.argument(*argument)),
                None => format!("\\left|{}\\right|", self.sum(*argument)),
            },
            Node::Atan2(y, x) => {
                format!("\\operatorname{{atan2}}\\left({}, {}\\right)", self.sum(*y), self.sum(*x))
            }
            Node::Max(a, b) => format!("\\max\\left({}, {}\\right)", self.sum(*a), self.sum(*b)),
            Node::Atom(inner) => self.factor(*inner),
        }
    }

    /// Writes a factor that is followed by a symbol. Without brackets, the symbol would be read as
    /// part of the bare argument of a function.
    fn coefficient(&self, id: Id) -> String {
        let bare = |&(base, _): &(Id, Rational)| match self.graph.node(base) {
            Node::Call(_, argument) => matches!(self.graph.node(*argument), Node::Symbol(_)),
            _ => false,
        };
        let factor = self.factor(id);
        let open = self.graph.factors(id).iter().any(bare) && !factor.starts_with("\\left(");
        if open { format!("\\left({factor}\\right)") } else { factor }
    }

    fn argument(&self, id: Id) -> String {
        match self.graph.node(id) {
            Node::Symbol(_) | Node::Pi => format!(" {}", self.factor(id)),
            _ => format!("\\left({}\\right)", self.sum(id)),
        }
    }

    fn coordinate(&self, index: usize, dots: u8) -> String {
        dotted(&self.names.coordinates[index], dots)
    }

    fn input(&self, input: usize, component: usize, dots: u8) -> String {
        let (name, vector) = self.names.input(input);
        let component = if vector { [".x", ".y", ".z"][component.min(2)] } else { "" };
        dotted(&format!("{name}{component}"), dots)
    }

    fn symbol(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Parameter(index) => dotted(&self.names.parameters[index], 0),
            Symbol::Coordinate(index) => self.coordinate(index, 0),
            Symbol::Velocity(index) => self.coordinate(index, 1),
            Symbol::Auxiliary(index) => format!("u_{{{index}}}"),
            Symbol::Acceleration(index) => self.coordinate(index, 2),
            Symbol::Multiplier(index) => {
                format!(
                    "\\lambda_{{\\mathrm{{{}}}}}",
                    self.names.constraints[index].replace('_', "\\_")
                )
            }
            Symbol::Target(index) => format!("\\tau_{{{index}}}"),
            Symbol::Position(index) => format!("z_{{{index}}}"),
            Symbol::Momentum(index) => format!("p_{{{}}}", self.coordinate(index, 0)),
            Symbol::Input { input, component, order } => self.input(input, component, order),
            Symbol::Control { input, component } => self.input(input, component, 0),
            Symbol::Moment(first, moment) => {
                let body = self.names.parameters[first].trim_end_matches(".mass");
                let body = dotted(body, 0);
                match moment {
                    Moment::Inertia => format!("I_{{{body}}}"),
                    Moment::Difference => {
                        format!("\\left(S^{{{body}}}_{{xx}} - S^{{{body}}}_{{yy}}\\right)")
                    }
                    Moment::Product => format!("S^{{{body}}}_{{xy}}"),
                }
            }
            Symbol::Time => "t".into(),
            Symbol::Point(_, component) => ["p_x", "p_y"][component.min(1)].into(),
        }
    }
}

fn rational(value: Rational) -> String {
    if value.is_integer() {
        return value.to_string();
    }
    let sign = if value.is_negative() { "-" } else { "" };
    format!("{sign}\\frac{{{}}}{{{}}}", value.numerator().abs(), value.denominator())
}

/// Returns the command for a function; `None` if its argument is written between bars.
fn command(function: Function) -> Option<String> {
    let Notation::Prefix(command) = function.row().notation else { return None };
    Some(match function.order() {
        None | Some(0) => command.to_owned(),
        Some(order @ 1..=3) => format!("{{{command}{}}}", "'".repeat(order.into())),
        Some(order) => format!("{{{command}^{{({order})}}}}"),
    })
}

/// Writes a name such as `θ1`, `l[0]`, `B.center.x` or `theta_max` with dots. Its first word is the
/// letter, the rest the index.
fn dotted(name: &str, dots: u8) -> String {
    let spelled = name::read(name).base;
    let split = spelled.find(|letter: char| !letter.is_alphabetic()).unwrap_or(spelled.len());
    let (letter, rest) = spelled.split_at(split);
    let letter = if name::is_greek(letter) {
        format!("\\{letter}")
    } else if letter.chars().count() <= 1 {
        letter.to_owned()
    } else {
        format!("\\mathrm{{{letter}}}")
    };
    let letter = match dots {
        0 => letter,
        1 => format!("\\dot{{{letter}}}"),
        _ => format!("\\ddot{{{letter}}}"),
    };
    let index: Vec<&str> =
        rest.split(['[', ']', '.', '_']).filter(|part| !part.is_empty()).collect();
    if index.is_empty() { letter } else { format!("{letter}_{{{}}}", index.join(",")) }
}

#[cfg(test)]
mod tests {
    use super::dotted;

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
