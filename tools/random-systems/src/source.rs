//! A system as the text of a block, with only the brackets required by the precedence of the
//! language.

use super::tree::{Expr, INDICES, Index, Kind, Property, Shape, System};
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
            let _ = writeln!(
                text,
                "let {}{head} = {};",
                definition.name,
                self.text(&definition.expr, 0)
            );
        }
        if self.joined {
            let minus = |expr: &Expr| self.text(expr, PRODUCT);
            let kinetic: Vec<String> =
                self.kinetic.iter().map(|expr| self.text(expr, SUM)).collect();
            let potential: Vec<String> =
                self.potential.iter().map(|expr| format!(" - {}", minus(expr))).collect();
            let _ = writeln!(text, "lagrangian = {}{};", kinetic.join(" + "), potential.concat());
        } else {
            for expr in &self.kinetic {
                let _ = writeln!(text, "kinetic = {};", self.text(expr, 0));
            }
            for expr in &self.potential {
                let _ = writeln!(text, "potential = {};", self.text(expr, 0));
            }
        }
        for expr in &self.dissipation {
            let _ = writeln!(text, "dissipation = {};", self.text(expr, 0));
        }
        for force in &self.forces {
            let coordinate = &self.coordinates[force.coordinate];
            let index = match (coordinate.length, force.member) {
                (None, _) => String::new(),
                (Some(_), Some(member)) => format!("[{member}]"),
                (Some(length), None) => format!("[{} in 0..{length}]", INDICES[0]),
            };
            let _ =
                writeln!(text, "force {}{index} = {};", coordinate.name, self.text(&force.expr, 0));
        }
        text
    }

    /// Returns the text of an expression, in brackets if its precedence is below `least`.
    fn text(&self, expr: &Expr, least: u8) -> String {
        let (text, own) = self.bare(expr);
        if own < least { format!("({text})") } else { text }
    }

    /// Returns the text of an expression without outer brackets, and its precedence.
    fn bare(&self, expr: &Expr) -> (String, u8) {
        let call = |name: &str, items: &[&Expr]| {
            let items: Vec<String> = items.iter().map(|item| self.text(item, 0)).collect();
            (format!("{name}({})", items.join(", ")), ATOM)
        };
        match expr {
            Expr::Number(top, 1) if 0 <= *top => (top.to_string(), ATOM),
            Expr::Number(top, 1) => (top.to_string(), UNARY),
            Expr::Number(top, 4) if top % 2 == 1 && 0 < *top => {
                (format!("{}", *top as f64 / 4.0), ATOM)
            }
            Expr::Number(top, bottom) => (format!("{top}/{bottom}"), PRODUCT),
            Expr::Pi => ("π".to_owned(), ATOM),
            Expr::Imaginary => ("i".to_owned(), ATOM),
            Expr::Time => ("t".to_owned(), ATOM),
            Expr::Parameter(index) => (self.parameters[*index].name.clone(), ATOM),
            Expr::Member(index, member) => {
                (format!("{}{}", self.parameters[*index].name, bracket(*member)), ATOM)
            }
            Expr::Property(index, property) => {
                let property = match property {
                    Property::Mass => "mass",
                    Property::Center => "center",
                    Property::Inertia => "inertia",
                };
                (format!("{}.{property}", self.parameters[*index].name), ATOM)
            }
            Expr::Coordinate(index, member) => (
                format!(
                    "{}{}",
                    self.coordinates[*index].name,
                    member.map(bracket).unwrap_or_default()
                ),
                ATOM,
            ),
            Expr::Velocity(index, member, spelling) => {
                let (name, member) =
                    (&self.coordinates[*index].name, member.map(bracket).unwrap_or_default());
                let text = match spelling {
                    0 => format!("{name}\u{307}{member}"),
                    1 => format!("{name}_dot{member}"),
                    _ => format!("dot({name}{member})"),
                };
                (text, ATOM)
            }
            Expr::Input(index, order) => {
                let name = &self.inputs[*index].name;
                (format!("{name}{}", ["", "\u{307}", "\u{308}"][*order]), ATOM)
            }
            Expr::Sum(items) => {
                let mut text = String::new();
                for (position, (minus, item)) in items.iter().enumerate() {
                    text.push_str(match (position, minus) {
                        (0, false) => "",
                        (0, true) => "-",
                        (_, false) => " + ",
                        (_, true) => " - ",
                    });
                    // A sign has a higher precedence than a product: -a*b is (-a)*b, which is the
                    // same number.
                    text.push_str(&self.text(item, PRODUCT));
                }
                (text, SUM)
            }
            Expr::Product(items) => {
                let mut text = String::new();
                for (position, (over, item)) in items.iter().enumerate() {
                    text.push_str(match (position, over) {
                        (0, false) => "",
                        (0, true) => "1/",
                        (_, false) => "*",
                        (_, true) => "/",
                    });
                    // The first factor may be a product: a/b*c is (a/b)*c.
                    let least = if position == 0 && !over { PRODUCT } else { UNARY };
                    text.push_str(&self.text(item, least));
                }
                (text, PRODUCT)
            }
            Expr::Negative(inner) => (format!("-{}", self.text(inner, UNARY)), UNARY),
            Expr::Power(base, top, 1) if 0 <= *top => {
                (format!("{}^{top}", self.text(base, ATOM)), POWER)
            }
            Expr::Power(base, top, 1) => (format!("{}^{top}", self.text(base, ATOM)), POWER),
            Expr::Power(base, 1, 2) => call("sqrt", &[base]),
            Expr::Power(base, top, bottom) => {
                (format!("{}^({top}/{bottom})", self.text(base, ATOM)), POWER)
            }
            Expr::GeneralPower(base, exponent) => {
                (format!("{}^{}", self.text(base, ATOM), self.text(exponent, UNARY)), POWER)
            }
            Expr::Call(function, inner) => call(&function.name(), &[inner]),
            Expr::Atan2(y, x) => call("atan2", &[y, x]),
            Expr::Max(a, b) => call("max", &[a, b]),
            Expr::Min(a, b) => call("min", &[a, b]),
            Expr::Vector(items) => {
                let items: Vec<String> = items.iter().map(|item| self.text(item, 0)).collect();
                (format!("[{}]", items.join(", ")), ATOM)
            }
            Expr::Inner(a, b) => call("inner", &[a, b]),
            Expr::Cross(a, b) => call("cross", &[a, b]),
            Expr::Perp(a) => call("perp", &[a]),
            Expr::Height(a) => call("height", &[a]),
            // Nested bars require brackets around the inner ones.
            Expr::Magnitude(a) => {
                let text = self.text(a, 0);
                (if text.contains('|') { format!("|({text})|") } else { format!("|{text}|") }, ATOM)
            }
            Expr::Component(a, component) => {
                (format!("{}.{}", self.text(a, ATOM), ["x", "y", "z"][*component]), ATOM)
            }
            Expr::Cis(angle, false) => call("cis", &[angle]),
            Expr::Cis(angle, true) => (format!("exp(i*{})", self.text(angle, UNARY)), ATOM),
            Expr::Dot(inner) => call("dot", &[inner]),
            Expr::Let(index) => (self.lets[*index].name.clone(), ATOM),
            Expr::LetDot(index) => (format!("{}\u{307}", self.lets[*index].name), ATOM),
            Expr::LetMember(index, member) => {
                (format!("{}{}", self.lets[*index].name, bracket(*member)), ATOM)
            }
            Expr::Apply(index, arguments) => {
                call(&self.lets[*index].name, &arguments.iter().collect::<Vec<_>>())
            }
            Expr::Argument(index) => (argument(*index), ATOM),
            Expr::Bound(index) => (INDICES[*index].to_owned(), ATOM),
            Expr::Over(index, count, inclusive, term) => {
                let range =
                    if *inclusive { format!("0..={}", count - 1) } else { format!("0..{count}") };
                (format!("sum({} in {range}, {})", INDICES[*index], self.text(term, 0)), ATOM)
            }
            Expr::Integral(body, integrand) => (
                format!(
                    "integral(ξ in {}, {})",
                    self.parameters[*body].name,
                    self.text(integrand, 0)
                ),
                ATOM,
            ),
            Expr::Point => ("ξ".to_owned(), ATOM),
        }
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
