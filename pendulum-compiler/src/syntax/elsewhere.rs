//! Constants, functions, velocities and units in other notations, with their translations.

use super::text::{closed, operand, text};
use crate::syntax::ast::Expr;

/// Translates a constant of Rust or a name of the time. The translation is ASCII if `ascii` is set.
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
        "time" | "TIME" | "Time" => "t",
        _ => return None,
    };
    Some(if ascii { value.replace('π', "pi") } else { value.to_owned() })
}

/// Translates a call of a function that has another name in the language or is an operator.
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
        ("clamp" | "clip" | "saturate" | "sat", [a, b, c]) => {
            format!("min(max({}, {}), {})", text(a), text(b), text(c))
        }
        ("square" | "sq", [a]) => format!("{}^2", operand(a)),
        ("cbrt", [a]) => format!("{}^(1/3)", operand(a)),
        ("sec", [a]) => format!("1/cos({})", text(a)),
        ("csc", [a]) => format!("1/sin({})", text(a)),
        ("cot", [a]) => format!("1/tan({})", text(a)),
        ("d" | "der" | "ddt" | "diff" | "derivative" | "Derivative" | "D", [a]) => {
            format!("dot({})", text(a))
        }
        ("diff" | "derivative" | "Derivative" | "D", [a, by]) if text(by) == "t" => {
            format!("dot({})", text(a))
        }
        ("Rational" | "Fraction", [a, b]) => format!("{}/{}", closed(a), operand(b)),
        ("heaviside" | "Heaviside", [a, ..]) => format!("(1 + sign({}))/2", text(a)),
        ("radians" | "deg2rad", [a]) => format!("{}*pi/180", closed(a)),
        ("degrees" | "rad2deg", [a]) => format!("{}*180/pi", closed(a)),
        ("sind" | "cosd" | "tand", [a]) => format!("{}({}*pi/180)", &name[..3], closed(a)),
        ("array" | "Matrix" | "matrix" | "vec2" | "vec3" | "Vector2" | "Vector3", [a]) => text(a),
        ("vec" | "vec2" | "vec3" | "vector" | "Vector2" | "Vector3", [_, _, ..]) => {
            format!("[{}]", arguments.iter().map(text).collect::<Vec<_>>().join(", "))
        }
        ("dot" | "scalar" | "dot_product", [a, b]) => format!("inner({}, {})", text(a), text(b)),
        _ => return None,
    })
}

/// Modules of mathematical functions in other languages.
pub(crate) const MODULES: &[&str] =
    &["np", "numpy", "jnp", "math", "Math", "sympy", "sp", "sm", "mpmath", "cmath", "torch"];

/// Returns the names whose velocity a name may denote: `x` for `vx`, `v_x`, `dx`, `dxdt`, `xd` and
/// `xDot`.
pub(crate) fn moving(name: &str) -> impl Iterator<Item = &str> {
    let differential = name.strip_prefix('d').and_then(|rest| rest.strip_suffix("dt"));
    let differential = differential.map(|stem| stem.strip_suffix('_').unwrap_or(stem));
    let before = ["v_", "v", "d_", "d"].into_iter();
    let behind = ["_prime", "prime", "_d", "d", "_Dot", "Dot", "DOT", "_vel", "Vel"].into_iter();
    let stems = differential.into_iter().chain(before.filter_map(|sign| name.strip_prefix(sign)));
    stems.chain(behind.filter_map(|sign| name.strip_suffix(sign)))
}

/// A unit that is not part of the language: the unit to declare instead, and the factor if the
/// sizes differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ForeignUnit {
    pub(crate) instead: &'static str,
    pub(crate) factor: Option<&'static str>,
}

/// Returns the translation of a unit that is not part of the language.
pub(crate) fn unit(name: &str) -> Option<ForeignUnit> {
    let rows = || SCALED.iter().map(|&(names, instead, factor)| (names, instead, Some(factor)));
    let rows = rows().chain(SPELLED.iter().map(|&(names, instead)| (names, instead, None)));
    let mut rows = rows.map(|(names, instead, factor)| (names, ForeignUnit { instead, factor }));
    if let Some((_, unit)) = rows.find(|(names, _)| names.contains(&name)) {
        return Some(unit);
    }
    PREFIXES.iter().find_map(|&(symbols, word, factor)| {
        let symbol = symbols.chars().find_map(|symbol| name.strip_prefix(symbol));
        let symbol = symbol.and_then(|rest| PREFIXED.iter().find(|unit| **unit == rest)).copied();
        let word = name.strip_prefix(word).and_then(|rest| {
            SPELLED.iter().find(|(names, _)| names.contains(&rest)).map(|&(_, unit)| unit)
        });
        symbol.or(word).map(|instead| ForeignUnit { instead, factor: Some(factor) })
    })
}

/// Types of numbers, which newcomers write in the place of a unit.
pub(crate) const TYPES: &[&str] = &[
    "f64", "f32", "i32", "u32", "usize", "int", "float", "double", "Float64", "real", "Real",
    "number",
];

/// Returns the unit of a quantity, or of a vector, that stands in the place of a unit.
pub(crate) fn quantity(name: &str) -> Option<&'static str> {
    QUANTITIES.iter().find(|(names, _)| names.contains(&name)).map(|&(_, unit)| unit)
}

/// Quantities and vectors, and the units to write instead.
#[rustfmt::skip]
const QUANTITIES: &[(&[&str], &str)] = &[
    (&["mass", "Mass"],                                                "kg"),
    (&["length", "Length", "distance", "position", "height", "radius"], "m"),
    (&["time", "Time", "duration"],                                    "s"),
    (&["angle", "Angle"],                                              "rad"),
    (&["force", "Force"],                                              "N"),
    (&["torque", "Torque", "moment"],                                  "N*m"),
    (&["energy", "Energy"],                                            "J"),
    (&["power", "Power"],                                              "W"),
    (&["frequency", "Frequency"],                                      "Hz"),
    (&["speed", "velocity", "Velocity"],                               "m/s"),
    (&["acceleration", "Acceleration"],                                "m/s^2"),
    (&["stiffness"],                                                   "N/m"),
    (&["inertia"],                                                     "kg*m^2"),
    (&["density"],                                                     "kg/m^3"),
    (&["pressure"],                                                    "N/m^2"),
    (&["vec2", "Vec2", "Vector2", "point", "Point"],                   "[m; 2]"),
    (&["vec3", "Vec3", "Vector3"],                                     "[m; 3]"),
];

/// Units of other sizes: their names, a unit of the language and the factor.
#[rustfmt::skip]
const SCALED: &[(&[&str], &str, &str)] = &[
    (&["g", "gram", "grams"],                             "kg",    "0.001"),
    (&["mg", "milligram", "milligrams"],                  "kg",    "1e-6"),
    (&["tonne", "tonnes", "ton", "tons"],                 "kg",    "1000"),
    (&["lb", "lbs", "pound", "pounds"],                   "kg",    "0.45359237"),
    (&["inch", "inches"],                                 "m",     "0.0254"),
    (&["ft", "foot", "feet"],                             "m",     "0.3048"),
    (&["mile", "miles"],                                  "m",     "1609.344"),
    (&["min", "mins", "minute", "minutes"],               "s",     "60"),
    (&["h", "hr", "hour", "hours"],                       "s",     "3600"),
    (&["day", "days"],                                    "s",     "86400"),
    (&["kmh", "kph"],                                     "m/s",   "5/18"),
    (&["deg", "degs", "degree", "degrees"],               "rad",   "pi/180"),
    (&["rev", "revs", "revolution", "turn", "turns"],     "rad",   "2*pi"),
    (&["rpm"],                                            "rad/s", "pi/30"),
    (&["lbf"],                                            "N",     "4.4482216152605"),
    (&["kPa"],                                            "N/m^2", "1000"),
    (&["bar"],                                            "N/m^2", "100000"),
    (&["cal"],                                            "J",     "4.184"),
    (&["eV"],                                             "J",     "1.602176634e-19"),
    (&["kWh"],                                            "J",     "3600000"),
];

/// Units of the language under other names.
#[rustfmt::skip]
const SPELLED: &[(&[&str], &str)] = &[
    (&["metre", "metres", "meter", "meters"],             "m"),
    (&["kilogram", "kilograms", "Kg", "KG"],              "kg"),
    (&["sec", "secs", "second", "seconds"],               "s"),
    (&["radian", "radians", "rads"],                      "rad"),
    (&["newton", "newtons", "Newton"],                    "N"),
    (&["Nm"],                                             "N*m"),
    (&["Pa", "pascal", "pascals", "Pascal"],              "N/m^2"),
    (&["joule", "joules", "Joule"],                       "J"),
    (&["watt", "watts", "Watt"],                          "W"),
    (&["hertz", "Hertz"],                                 "Hz"),
    (&["amp", "amps", "ampere", "amperes", "Ampere"],     "A"),
    (&["volt", "volts", "Volt"],                          "V"),
    (&["coulomb", "coulombs", "Coulomb"],                 "C"),
    (&["farad", "farads", "Farad"],                       "F"),
    (&["henry", "henries", "Henry"],                      "H"),
    (&["Ω", "\u{2126}", "ohms", "Ohm", "Ohms"],           "ohm"),
    (&["tesla", "Tesla"],                                 "T"),
    (&["kelvin", "kelvins", "Kelvin"],                    "K"),
];

/// Prefixes: symbols, the word and the factor.
const PREFIXES: &[(&str, &str, &str)] = &[
    ("n", "nano", "1e-9"),
    ("uµμ", "micro", "1e-6"),
    ("m", "milli", "0.001"),
    ("c", "centi", "0.01"),
    ("d", "deci", "0.1"),
    ("k", "kilo", "1000"),
    ("M", "mega", "1e6"),
    ("G", "giga", "1e9"),
];

/// The units that accept a prefix.
const PREFIXED: &[&str] =
    &["m", "s", "rad", "N", "J", "W", "Hz", "A", "V", "C", "F", "H", "ohm", "T", "K"];

#[cfg(test)]
mod tests {
    use super::{ForeignUnit, PREFIXED, SCALED, SPELLED, unit};
    use crate::algebra::dimension::Dimension;

    /// No translated unit is part of the language, and each translation is.
    #[test]
    fn translations_of_units_are_units() {
        let known = |unit: &str| {
            unit.split(['*', '/', '^']).all(|part| part == "2" || Dimension::of(part).is_some())
        };
        let scaled = SCALED.iter().map(|&(names, instead, _)| (names, instead));
        for (names, instead) in scaled.chain(SPELLED.iter().copied()) {
            assert!(known(instead), "{instead}");
            for name in names {
                assert!(Dimension::of(name).is_none(), "{name}");
                assert_eq!(unit(name).unwrap().instead, instead, "{name}");
            }
        }
        assert!(PREFIXED.iter().all(|name| known(name) && unit(name).is_none()));
        let unit_of = |instead, factor| Some(ForeignUnit { instead, factor });
        assert_eq!(unit("km"), unit_of("m", Some("1000")));
        assert_eq!(unit("µs"), unit_of("s", Some("1e-6")));
        assert_eq!(unit("millimetre"), unit_of("m", Some("0.001")));
        assert_eq!(unit("min"), unit_of("s", Some("60")));
        assert_eq!(unit("furlong"), None);
    }
}
