//! The words of the language.

/// The functions of the language, with their number of arguments; those before `dot` take scalars
/// to a scalar.
#[rustfmt::skip]
pub(crate) const FUNCTIONS: &[(&str, usize)] = &[
    ("sqrt", 1), ("exp", 1), ("ln", 1), ("sin", 1), ("cos", 1), ("tan", 1), ("asin", 1), ("acos", 1), ("atan", 1), ("atan2", 2),
    ("sinh", 1), ("cosh", 1), ("tanh", 1), ("abs", 1), ("sign", 1), ("min", 2), ("max", 2),
    ("dot", 1), ("inner", 2), ("cross", 2), ("perp", 1), ("height", 1), ("cis", 1),
];

/// What to do about a unit in a formula.
pub(crate) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";
