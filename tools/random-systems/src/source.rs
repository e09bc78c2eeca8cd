//! A system as the text of a block, with only the brackets required by the precedence of the
//! language.

use super::tree::{Expr, INDICES, Index, Kind, Operation, Shape, System};
use std::fmt::Write;

/// The precedence of operators.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const UNARY: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

impl System {
    /// Returns the block, without the name of the macro.
    pub fn source(&self, name: &str) -> String {
        let mut text = format!("pub struct {name} {{");
        for parameter in &self.parameters {
            let own = &parameter.name;
            let _ = match (parameter.kind, self.units) {
                (Kind::Scalar, true) => write!(text, " {own}: 1,"),
                (Kind::Rate, true) => write!(text, " {own}: Hz,"),
                (Kind::Mass, _) => write!(text, " {own}: kg,"),
                (Kind::Length, _) => write!(text, " {own}: m,"),
                (Kind::Scalar | Kind::Rate, false) => write!(text, " {own},"),
                (Kind::Vector(count) | Kind::Family(count), _) => {
                    write!(text, " {own}: [1; {count}],")
                }
                (Kind::Body, _) => write!(text, " {own}: body,"),
            };
        }
        text.push_str(" }\n");
        let unit = if self.units { ": rad" } else { "" };
        for coordinate in &self.coordinates {
            let length = coordinate.length.map(|length| format!("[{length}]")).unwrap_or_default();
            let _ = writeln!(text, "coordinate {}{length}{unit};", coordinate.name);
        }
        for input in &self.inputs {
            let kind = match (input.components, self.units) {
                (1, true) => ": 1".to_owned(),
                (1, false) => String::new(),
                (count, _) => format!(": [1; {count}]"),
            };
            let _ = writeln!(text, "driven {}{kind};", input.name);
        }
        for definition in &self.lets {
            let head = match &definition.shape {
                Shape::Plain => String::new(),
                Shape::Indexed(count) => format!("[{} in 0..{count}]", INDICES[0]),
                Shape::Function(types) => {
                    let names: Vec<String> = (0..types.len()).map(argument).collect();
                    format!("({})", names.join(", "))
                }
            };
            let (name, body) = (&definition.name, self.bare(&definition.expr));
            let _ = writeln!(text, "let {name}{head} = {body};");
        }
        let mut energies = vec![("dissipation", &self.dissipation)];
        if self.joined {
            let kinetic: Vec<_> = self.kinetic.iter().map(|expr| self.text(expr, SUM)).collect();
            let minus = |expr: &Expr| format!(" - {}", self.text(expr, PRODUCT));
            let potential: String = self.potential.iter().map(minus).collect();
            let _ = writeln!(text, "lagrangian = {}{potential};", kinetic.join(" + "));
        } else {
            energies.splice(0..0, [("kinetic", &self.kinetic), ("potential", &self.potential)]);
        }
        for (name, exprs) in energies {
            for expr in exprs {
                let _ = writeln!(text, "{name} = {};", self.bare(expr));
            }
        }
        for force in &self.forces {
            let coordinate = &self.coordinates[force.coordinate];
            let index = match (coordinate.length, force.member) {
                (None, _) => String::new(),
                (Some(_), Some(member)) => format!("[{member}]"),
                (Some(length), None) => format!("[{} in 0..{length}]", INDICES[0]),
            };
            let (name, body) = (&coordinate.name, self.bare(&force.expr));
            let _ = writeln!(text, "force {name}{index} = {body};");
        }
        text
    }

    /// Returns the text of an expression, in brackets if its precedence is below `least`.
    fn text(&self, expr: &Expr, least: u8) -> String {
        let text = self.bare(expr);
        if precedence(expr) < least { format!("({text})") } else { text }
    }

    /// Returns the texts of expressions with commas between them.
    fn list(&self, items: &[Expr]) -> String {
        items.iter().map(|item| self.bare(item)).collect::<Vec<_>>().join(", ")
    }

    /// Returns the texts of terms or factors, each behind its sign: two signs of the first one, and
    /// two of the others. `least` are the lowest precedences without brackets of a first one that
    /// is not marked, and of all others.
    fn joined(&self, items: &[(bool, Expr)], signs: [&str; 4], least: [u8; 2]) -> String {
        let text = |(position, (marked, item)): (usize, &(bool, Expr))| {
            let sign = signs[2 * usize::from(0 < position) + usize::from(*marked)];
            format!("{sign}{}", self.text(item, least[usize::from(0 < position || *marked)]))
        };
        items.iter().enumerate().map(text).collect()
    }

    /// Returns the text of an expression without outer brackets.
    fn bare(&self, expr: &Expr) -> String {
        match expr {
            Expr::Number(top, 1) => top.to_string(),
            Expr::Number(top, 4) if is_decimal(*top, 4) => (*top as f64 / 4.0).to_string(),
            Expr::Number(top, bottom) => format!("{top}/{bottom}"),
            Expr::Pi => "π".to_owned(),
            Expr::Imaginary => "i".to_owned(),
            Expr::Time => "t".to_owned(),
            Expr::Parameter(index) => self.parameters[*index].name.clone(),
            Expr::Member(index, member) => self.parameters[*index].name.clone() + &bracket(*member),
            Expr::Property(index, property) => {
                let property = format!("{property:?}").to_lowercase();
                format!("{}.{property}", self.parameters[*index].name)
            }
            Expr::Coordinate(index, member) => {
                self.coordinates[*index].name.clone() + &member.map(bracket).unwrap_or_default()
            }
            Expr::Velocity(index, member, spelling) => {
                let (name, member) =
                    (&self.coordinates[*index].name, member.map(bracket).unwrap_or_default());
                match spelling {
                    0 => format!("{name}\u{307}{member}"),
                    1 => format!("{name}_dot{member}"),
                    _ => format!("dot({name}{member})"),
                }
            }
            Expr::Input(index, order) => {
                self.inputs[*index].name.clone() + ["", "\u{307}", "\u{308}"][*order]
            }
            // A sign has a higher precedence than a product: -a*b is (-a)*b, which is the same
            // number.
            Expr::Sum(items) => self.joined(items, ["", "-", " + ", " - "], [PRODUCT; 2]),
            // The first factor may be a product: a/b*c is (a/b)*c.
            Expr::Product(items) => self.joined(items, ["", "1/", "*", "/"], [PRODUCT, UNARY]),
            Expr::Negative(inner) => format!("-{}", self.text(inner, UNARY)),
            Expr::Power(base, 1, 2) => format!("sqrt({})", self.bare(base)),
            Expr::Power(base, top, 1) => format!("{}^{top}", self.text(base, ATOM)),
            Expr::Power(base, top, bottom) => format!("{}^({top}/{bottom})", self.text(base, ATOM)),
            Expr::Vector(items) => format!("[{}]", self.list(items)),
            Expr::Call(function, inner) => format!("{}({})", function.name(), self.bare(inner)),
            Expr::Of(Operation::Power, items) => {
                format!("{}^{}", self.text(&items[0], ATOM), self.text(&items[1], UNARY))
            }
            // Nested bars require brackets around the inner ones.
            Expr::Of(Operation::Magnitude, items) => {
                let text = self.bare(&items[0]);
                if text.contains('|') { format!("|({text})|") } else { format!("|{text}|") }
            }
            Expr::Of(operation, items) => {
                let name = format!("{operation:?}").to_lowercase();
                format!("{name}({})", self.list(items))
            }
            Expr::Component(a, component) => {
                format!("{}.{}", self.text(a, ATOM), ["x", "y", "z"][*component])
            }
            Expr::Cis(angle, false) => format!("cis({})", self.bare(angle)),
            Expr::Cis(angle, true) => format!("exp(i*{})", self.text(angle, UNARY)),
            Expr::Let(index) => self.lets[*index].name.clone(),
            Expr::LetDot(index) => format!("{}\u{307}", self.lets[*index].name),
            Expr::LetMember(index, member) => self.lets[*index].name.clone() + &bracket(*member),
            Expr::Apply(index, arguments) => {
                format!("{}({})", self.lets[*index].name, self.list(arguments))
            }
            Expr::Argument(index) => argument(*index),
            Expr::Bound(index) => INDICES[*index].to_owned(),
            Expr::Over(index, count, inclusive, term) => {
                let range =
                    if *inclusive { format!("0..={}", count - 1) } else { format!("0..{count}") };
                format!("sum({} in {range}, {})", INDICES[*index], self.bare(term))
            }
            Expr::Integral(body, integrand) => {
                format!("integral(ξ in {}, {})", self.parameters[*body].name, self.bare(integrand))
            }
            Expr::Point => "ξ".to_owned(),
        }
    }
}

/// Returns `true` if a fraction is written as a decimal.
fn is_decimal(top: i64, bottom: i64) -> bool {
    bottom == 4 && top % 2 == 1 && 0 < top
}

/// Returns the precedence of the text of an expression.
fn precedence(expr: &Expr) -> u8 {
    match expr {
        Expr::Sum(_) => SUM,
        Expr::Product(_) => PRODUCT,
        Expr::Number(top, bottom) if *bottom != 1 && !is_decimal(*top, *bottom) => PRODUCT,
        Expr::Number(top, _) if *top < 0 => UNARY,
        Expr::Negative(_) => UNARY,
        Expr::Power(_, 1, 2) => ATOM,
        Expr::Power(..) | Expr::Of(Operation::Power, _) => POWER,
        _ => ATOM,
    }
}

fn argument(index: usize) -> String {
    format!("a{index}")
}

fn bracket(index: Index) -> String {
    match index {
        Index::Number(number) => format!("[{number}]"),
        Index::Bound(index) => format!("[{}]", INDICES[index]),
        Index::Reversed(index, count) => format!("[{} - {}]", count - 1, INDICES[index]),
    }
}
