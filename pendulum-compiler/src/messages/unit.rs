//! Messages about units.

use super::Text;
use std::fmt::{self, Display};

/// The description of a valid unit.
const FORM: &str = "a unit is a product, quotient or power of `kg`, `m`, `s`, `rad`, `N`, `J`, \
                    `W`, `Hz`, `A`, `V`, `C`, `F`, `H`, `ohm`, `T`, `K` and `1`";

/// An expression whose parts must have the same unit.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Whole<'a> {
    Constraint,
    Function(&'a str),
    Limit,
    Sum,
    Vector,
}

impl Display for Whole<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constraint => f.write_str("a constraint"),
            Self::Function(name) => write!(f, "`{name}`"),
            Self::Limit => f.write_str("a limit"),
            Self::Sum => f.write_str("a sum"),
            Self::Vector => f.write_str("a vector"),
        }
    }
}

/// A place that requires a pure number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pure<'a> {
    Argument(&'a str),
    Base,
    Exponent,
    Restitution,
}

impl Display for Pure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument(function) => write!(f, "the argument of `{function}`"),
            Self::Base => f.write_str("the base of a power with a non-constant exponent"),
            Self::Exponent => f.write_str("an exponent"),
            Self::Restitution => f.write_str("a restitution"),
        }
    }
}

/// Describes a known dimension times the units of quantities whose units are unknown.
pub(crate) fn open_unit(known: impl Display, quantities: &[&str]) -> String {
    let unknown: Vec<String> =
        quantities.iter().map(|name| format!("the unit of `{name}`")).collect();
    format!("{known} times {}", unknown.join(" and "))
}

// Declarations.

/// An expression that is not a unit.
pub(crate) fn no_unit() -> Text {
    text!("this is no unit; {FORM}")
}

/// A number as a unit.
pub(crate) fn number_as_unit() -> Text {
    text!("a number is no unit; {FORM}")
}

/// An exponent of a unit that is not a number.
pub(crate) fn open_exponent() -> Text {
    text!("this exponent is no number; {FORM}")
}

/// A name that is not a unit.
pub(crate) fn unknown_unit(name: &str) -> Text {
    text!("unknown unit `{name}`; {FORM}")
}

/// A unit that is not part of the language, with a unit of the language and the factor if the sizes
/// differ.
pub(crate) fn untranslated_unit(name: &str, instead: &str, factor: Option<&str>) -> Text {
    match factor {
        Some(factor) => {
            text!("unknown unit `{name}`; write `{instead}`: 1 {name} is {factor} {instead}")
        }
        None => text!("unknown unit `{name}`; write `{instead}`"),
    }
}

// Formulas.

/// A unit where a pure number is required.
pub(crate) fn impure(found: &str, unit: &str, place: Pure) -> Text {
    let instead = match (unit, place) {
        ("s", Pure::Argument("sin" | "cos" | "tan" | "cis" | "sinc")) => {
            "multiply it by an angular frequency, such as a parameter `omega: rad/s`".to_owned()
        }
        ("s", _) => "divide it by a time, such as a parameter `tau: s`".to_owned(),
        ("m", _) => "divide it by a length, such as a parameter `a: m`".to_owned(),
        _ => format!("divide it by a quantity in {unit}"),
    };
    text!("`{found}` is {unit}, but {place} is a pure number; {instead}")
}

/// A dissipation whose unit times a second differs from that of the energies.
pub(crate) fn other_dissipation(found: &str, unit: &str, first: &str, expected: &str) -> Text {
    text!(
        "`{found}` times a second is {unit}, but `{first}` is {expected}; all energies of a block \
         have one unit"
    )
}

/// An energy whose unit differs from that of the first energy.
pub(crate) fn other_energy(found: &str, unit: &str, first: &str, expected: &str) -> Text {
    text!("`{found}` is {unit}, but `{first}` is {expected}; all energies of a block have one unit")
}

/// A force whose unit is not that of energy per coordinate.
pub(crate) fn other_force(
    found: &str,
    unit: &str,
    coordinate: impl Display,
    expected: &str,
) -> Text {
    text!(
        "`{found}` is {unit}, but a force on `{coordinate}` is {expected}, an energy per unit of \
         the coordinate"
    )
}

/// An output whose unit differs from the declared unit.
pub(crate) fn other_output(found: &str, unit: &str, output: impl Display, declared: &str) -> Text {
    text!("`{found}` is {unit}, but `{output}` is declared in {declared}")
}

/// A part whose unit differs from that of the first part.
pub(crate) fn other_part(
    found: &str,
    unit: &str,
    first: &str,
    expected: &str,
    whole: Whole,
) -> Text {
    text!("`{found}` is {unit}, but `{first}` is {expected}; {whole} needs one unit")
}
