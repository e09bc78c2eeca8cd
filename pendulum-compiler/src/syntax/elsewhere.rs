//! Names of constants and functions in other languages, with their translations.

use super::text::{closed, operand, text};
use crate::syntax::ast::Expr;

/// The value of a constant of Rust, as it is written here; in `ascii`, if the block is.
pub(crate) fn constant(name: &str, ascii: bool) -> Option<String> {
    let value = match name {
        "PI" | "Pi" => "π",
        "TAU" => "2*π",
        "E" => "exp(1)",
        "SQRT_2" => "sqrt(2)",
        "LN_2" => "ln(2)",
        "LN_10" => "ln(10)",
        "FRAC_PI_2" => "π/2",
        "FRAC_PI_3" => "π/3",
        "FRAC_PI_4" => "π/4",
        "FRAC_PI_6" => "π/6",
        "FRAC_PI_8" => "π/8",
        "FRAC_1_PI" => "1/π",
        "FRAC_1_SQRT_2" => "1/sqrt(2)",
        _ => return None,
    };
    Some(if ascii { value.replace('π', "pi") } else { value.to_owned() })
}

/// The call of a function that has another name here, or is an operator.
pub(crate) fn function(name: &str, arguments: &[Expr]) -> Option<String> {
    Some(match (name, arguments) {
        ("log", [a]) => format!("ln({})", text(a)),
        ("log2", [a]) => format!("ln({})/ln(2)", text(a)),
        ("log10", [a]) => format!("ln({})/ln(10)", text(a)),
        ("norm" | "length" | "len" | "magnitude" | "mag", [a]) => format!("|{}|", text(a)),
        ("hypot", [a, b]) => format!("|[{}, {}]|", text(a), text(b)),
        ("arcsin" | "arccos" | "arctan", [a]) => format!("a{}({})", &name[3..], text(a)),
        ("arctan2", [a, b]) => format!("atan2({}, {})", text(a), text(b)),
        ("sgn" | "signum", [a]) => format!("sign({})", text(a)),
        ("pow" | "powi" | "powf", [a, b]) => format!("{}^{}", operand(a), closed(b)),
        ("square" | "sq", [a]) => format!("{}^2", operand(a)),
        ("cbrt", [a]) => format!("{}^(1/3)", operand(a)),
        ("sec", [a]) => format!("1/cos({})", text(a)),
        ("csc", [a]) => format!("1/sin({})", text(a)),
        ("cot", [a]) => format!("1/tan({})", text(a)),
        ("diff" | "ddt" | "derivative", [a]) => format!("dot({})", text(a)),
        ("dot" | "scalar" | "dot_product", [a, b]) => format!("inner({}, {})", text(a), text(b)),
        _ => return None,
    })
}
