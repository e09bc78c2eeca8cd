//! Messages of the parser.

use super::Text;
use super::expected::Expected;
use super::shared::{NO_IMPLICIT_PRODUCT, TELL_CASES_APART, UNITS};
use std::fmt::Display;

// Tokens and names.

/// Text that cannot be split into tokens.
pub(crate) fn broken_tokens() -> Text {
    text!(
        "this cannot be read: a bracket, a quote or a comment is not closed, or a character does \
         not belong to the language"
    )
}

/// An early end of the input.
pub(crate) fn early_end(expected: Expected) -> Text {
    text!("the input ends too early; expected {expected}")
}

/// A middle dot in a name. `parts` are the parts between the dots.
pub(crate) fn middle_dot(parts: &[&str]) -> Text {
    let instead = match parts {
        [a, b] => format!("`*`, as in `{a}*{b}`, or `inner({a}, {b})` for vectors"),
        [_, _, ..] => format!("`*`, as in `{}`, or `inner(u, v)` for vectors", parts.join("*")),
        _ => "`*`, or `inner(u, v)` for vectors".to_owned(),
    };
    text!("`·` is part of a name in Rust; write {instead}")
}

/// A name with the prefix of generated names.
pub(crate) fn reserved_name() -> Text {
    text!("names that begin with `__` are reserved; choose another name")
}

/// A keyword of Rust as a name.
pub(crate) fn rust_keyword(name: impl Display) -> Text {
    text!("`{name}` is a word of the Rust language; choose another name")
}

/// A token that is not valid at its position, or several tokens passed on by a macro as a fragment.
pub(crate) fn unexpected(found: Option<&str>, expected: Expected) -> Text {
    let found = found.map_or_else(|| "this".to_owned(), |found| format!("`{found}`"));
    text!("{found} is not expected here; expected {expected}")
}

// The struct and its fields.

/// A `cfg` on a parameter.
pub(crate) fn conditional_parameter() -> Text {
    text!(
        "`cfg` has no place on a parameter, which the equations need in every build; write it \
         above the struct"
    )
}

/// A length after the name instead of the unit.
pub(crate) fn misplaced_length(name: impl Display, unit: &str, length: &str) -> Text {
    text!("the length stands with the unit; write `{name}: [{unit}; {length}]`")
}

/// A unit between brackets without a length.
pub(crate) fn missing_length() -> Text {
    text!("a length is missing; write `[m; 2]` for a vector, `[kg; 5]` for a family")
}

/// A struct without braces.
pub(crate) fn missing_parameters() -> Text {
    text!("the parameters are missing; write `{{ m: kg, L: m }}` after the name of the struct")
}

/// A block that does not begin with its struct.
pub(crate) fn missing_struct() -> Text {
    text!("a block begins with its struct; write `pub struct Name {{ … }}` with the parameters")
}

/// A length between brackets without a unit.
pub(crate) fn missing_unit(length: &str) -> Text {
    let length = if length.is_empty() { "2" } else { length };
    text!(
        "a unit is missing; write `[m; {length}]`, or `[_; {length}]` for a vector without a unit"
    )
}

/// A trait, in a `derive`, that floating-point numbers do not implement; `None` for all other
/// traits.
pub(crate) fn underivable_trait(name: &str) -> Option<Text> {
    let instead = match name {
        "Eq" => "leave it out, `PartialEq` compares them",
        "Hash" => "leave it out and hash the bits of the fields",
        "Ord" => "leave it out, `PartialOrd` compares them",
        _ => return None,
    };
    Some(text!(
        "`{name}` cannot be derived: the parameters are floating-point numbers, which do not have \
         it; {instead}"
    ))
}

/// A unit for each component of a vector.
pub(crate) fn units_of_components(unit: &str, length: usize) -> Text {
    text!("all components have one unit; write `[{unit}; {length}]` for a vector")
}

// Statements.

/// An attribute on a statement.
pub(crate) fn attribute_of_statement() -> Text {
    text!("an attribute has no effect here; attributes belong on the struct and its fields")
}

/// A control input declared as a body.
pub(crate) fn body_as_control_input() -> Text {
    text!("a control input has a unit; write `N` or `[N; 2]`")
}

/// A coordinate declared as a body.
pub(crate) fn body_as_coordinate() -> Text {
    text!("a coordinate has a unit; write `rad` or `m`")
}

/// A driven input declared as a body.
pub(crate) fn body_as_driven_input() -> Text {
    text!("a driven input has a unit; write `[m; 2]` for a motion in the plane")
}

/// An output declared as a body.
pub(crate) fn body_as_output() -> Text {
    text!("an output has a unit; write `m` or `[m; 2]`")
}

/// A constraint with `==`.
pub(crate) fn comparison_as_constraint() -> Text {
    text!("the two sides of a constraint stand beside one `=`; write `a = b`")
}

/// A coordinate with the unit of a vector.
pub(crate) fn coordinate_of_components(family: &str) -> Text {
    text!("a coordinate is one number; write `{family}` for several")
}

/// A constraint with `<` or `>`.
pub(crate) fn inequality_as_constraint(name: impl Display) -> Text {
    text!(
        "a constraint holds with `=`; write `limit {name}: a >= b, restitution = 0;` for one side"
    )
}

/// The last statement without its semicolon.
pub(crate) fn missing_end() -> Text {
    text!("`;` is missing after this; end the last statement with `;`")
}

/// A statement without its semicolon before the next one.
pub(crate) fn missing_end_before(next: impl Display) -> Text {
    text!("`;` is missing before `{next}`; end the statement above with `;`")
}

/// A limit without its restitution.
pub(crate) fn missing_restitution(name: impl Display) -> Text {
    text!(
        "the restitution is missing; write `, restitution = 0` behind the limit `{name}`, or a \
         number up to 1"
    )
}

/// Several names in one statement.
pub(crate) fn several_names(example: &str) -> Text {
    text!("a statement declares one name; write `{example}` as a statement of its own")
}

/// A word that is not a statement, with the nearest keyword.
pub(crate) fn unknown_statement(word: &str, nearest: Option<&str>) -> Text {
    match nearest {
        Some(near) => text!("unknown statement `{word}`; did you mean `{near}`?"),
        None => text!(
            "unknown statement `{word}`; a statement begins with `coordinate`, `driven`, `input`, \
             `let`, `kinetic`, `potential`, `lagrangian`, `dissipation`, `force`, `output`, \
             `constraint` or `limit`"
        ),
    }
}

/// A constraint or a limit without a name.
pub(crate) fn unnamed_row(keyword: &str, found: impl Display) -> Text {
    text!("a {keyword} has a name; write `{keyword} {found}: …`")
}

/// A limit with a sign other than `>=`, and its sides and restitution as they should be.
pub(crate) fn wrong_sign_of_limit(name: impl Display, sides: &str, restitution: &str) -> Text {
    text!(
        "a limit is a smallest value; write `limit {name}: {sides}, restitution = {restitution};`"
    )
}

// Expressions.

/// An expression that is nested too deeply.
pub(crate) fn deep_expression() -> Text {
    text!("this expression is nested too deeply; name a part of it with `let`")
}

/// Two asterisks for a power.
pub(crate) fn double_star() -> Text {
    text!("`**` is not an operator; write `^`")
}

/// A number beyond the largest double.
pub(crate) fn huge_number() -> Text {
    text!("this number is beyond the range of `f64`; write a smaller one")
}

/// A number that would be rounded to zero.
pub(crate) fn tiny_number() -> Text {
    text!("this number is below the range of `f64`; write zero, or a larger one")
}

/// Two adjacent operands. `right` is the first token of the second operand.
pub(crate) fn implicit_product(right: impl Display) -> Text {
    text!("{NO_IMPLICIT_PRODUCT}; write `*` before `{right}`")
}

/// A number that begins with a decimal point.
pub(crate) fn leading_point(digits: impl Display) -> Text {
    text!("a number begins with a digit; write `0.{digits}`")
}

/// A string or a character in a formula.
pub(crate) fn literal() -> Text {
    text!("only numbers and names can stand in a formula; write a number such as `9.81`")
}

/// Chained powers without parentheses.
pub(crate) fn many_powers() -> Text {
    text!("too many powers in a row; name a part with `let`")
}

/// Consecutive minus signs.
pub(crate) fn many_signs() -> Text {
    text!("too many signs in a row; write one")
}

/// A missing operand between two signs.
pub(crate) fn missing_expression() -> Text {
    text!("an expression is missing here")
}

/// Two adjacent factors in parentheses.
pub(crate) fn missing_operator() -> Text {
    text!("an operator is missing before `(`; write `*` to multiply")
}

/// A number followed by a name.
pub(crate) fn suffix_of_name(digits: &str, name: &str) -> Text {
    text!("{NO_IMPLICIT_PRODUCT}; write `{digits}*{name}`")
}

/// A number with a type suffix.
pub(crate) fn suffix_of_type(digits: &str) -> Text {
    text!("numbers here are exact and have no suffix; write `{digits}`")
}

/// A number with a unit.
pub(crate) fn suffix_of_unit() -> Text {
    text!("a number in a formula has no unit; {UNITS}")
}

/// A magnitude that is not closed.
pub(crate) fn unclosed_bar() -> Text {
    text!("this `|` is not closed; write `|u|`")
}

// Foreign notations.

/// A comparison in a formula.
pub(crate) fn comparison() -> Text {
    text!("a formula has no conditions; {TELL_CASES_APART}, as in `max(0, θ)`")
}

/// A power between a function and its argument. `inverse` is the inverse function, if it may be
/// meant.
pub(crate) fn powered_function(
    name: impl Display,
    argument: &str,
    power: &str,
    inverse: Option<&str>,
) -> Text {
    let instead = match inverse {
        Some(inverse) => format!("`{inverse}({argument})`, or `1/{name}({argument})`"),
        None => format!("`{name}({argument})^{power}`"),
    };
    text!("a function is raised to a power after its argument; write {instead}")
}

/// A prime for a derivative. `velocity` lists the spellings of the derivative.
pub(crate) fn prime(velocity: &str) -> Text {
    text!("`'` is no derivative; write {velocity}")
}

/// A type conversion in Rust's syntax.
pub(crate) fn rust_conversion() -> Text {
    rust("as", "leave the type out")
}

/// A method of Rust, with its translation.
pub(crate) fn rust_method(name: &str, translation: Option<&str>) -> Text {
    let instead = match translation {
        Some(call) => format!("write `{call}`"),
        None => "write a function of the language, as in `sin(θ)`".to_owned(),
    };
    rust(format!(".{name}()"), instead)
}

/// A path of Rust, with its translation.
pub(crate) fn rust_path(path: &str, translation: Option<&str>) -> Text {
    let instead = match translation {
        Some(expression) => format!("write `{expression}`"),
        None => "write a number, or declare a parameter".to_owned(),
    };
    rust(path, instead)
}

/// A keyword that begins a Rust expression; `None` for all other names.
pub(crate) fn rust_word(name: &str) -> Option<Text> {
    let instead = match name {
        "if" | "match" => TELL_CASES_APART,
        "for" | "while" | "loop" => "write `sum(k in 0..5, …)`",
        "return" | "unsafe" | "move" => "leave it out",
        _ => return None,
    };
    Some(rust(name, instead))
}

fn rust(found: impl Display, instead: impl Display) -> Text {
    text!("`{found}` is Rust, which has no place in a formula; {instead}")
}

/// A function whose arguments are not in parentheses. `arguments` are the arguments to be put in
/// parentheses.
pub(crate) fn unbracketed_arguments(name: impl Display, arguments: &[String]) -> Text {
    let (plural, verb) = if arguments.len() == 1 { ("", "stands") } else { ("s", "stand") };
    text!(
        "the argument{plural} of `{name}` {verb} in parentheses; write `{name}({})`",
        arguments.join(", ")
    )
}
