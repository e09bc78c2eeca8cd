//! Messages of several layers.

use super::Text;
use std::fmt::Display;

/// Advice instead of a comparison.
pub(super) const TELL_CASES_APART: &str = "write `max`, `min`, `abs` or `sign` to tell cases apart";

/// Advice about a unit in a formula.
pub(super) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";

/// A second derivative in an energy or a force; `found` as written.
pub(crate) fn acceleration(found: impl Display) -> Text {
    text!(
        "{found} is an acceleration, and a Lagrangian has none; only driven inputs have a second \
         derivative"
    )
}

/// An acceleration in a constraint or a limit; `found` as written.
pub(crate) fn constrained_acceleration(found: impl Display) -> Text {
    text!("{found} is an acceleration; a constraint holds positions or velocities")
}

/// The derivative of a control input.
pub(crate) fn derivative_of_control(input: impl Display) -> Text {
    text!("`{input}` has no derivative; declare it `driven`")
}

/// A function without its arguments.
pub(crate) fn function_without_arguments(name: impl Display) -> Text {
    text!("`{name}` is a function; write `{name}(…)`")
}

/// Two operands side by side.
pub(crate) fn implicit_product(instead: impl Display) -> Text {
    text!("there is no implicit multiplication; write {instead}")
}

/// A third derivative of what has two; `found` as written.
pub(crate) fn jerk(found: impl Display) -> Text {
    text!("{found} is a third derivative; coordinates have two, in outputs")
}
