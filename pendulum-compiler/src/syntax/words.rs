//! The words of the language.

/// What to do about a unit in a formula.
pub(crate) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";
