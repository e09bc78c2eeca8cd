//! Messages used by several layers.

use super::Text;
use std::fmt::Display;

const NO_ACCELERATION: &str = "is an acceleration, and a Lagrangian has none; only driven inputs \
                               have a second derivative";

const NO_ACCELERATION_IN_CONSTRAINT: &str =
    "is an acceleration; a constraint holds positions or velocities";

const NO_JERK: &str = "is a third derivative; coordinates have two, in outputs";

/// Advice for two adjacent operands.
pub(super) const NO_IMPLICIT_PRODUCT: &str = "there is no implicit multiplication";

/// Advice instead of a comparison.
pub(super) const TELL_CASES_APART: &str = "write `max`, `min`, `abs` or `sign` to tell cases apart";

/// Advice about a unit in a formula.
pub(super) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";

/// The second derivative of a coordinate in an energy or a force.
pub(crate) fn acceleration(name: impl Display) -> Text {
    text!("`{name}` {NO_ACCELERATION}")
}

/// The second derivative of a coordinate in a constraint or a limit.
pub(crate) fn acceleration_in_constraint(name: impl Display) -> Text {
    text!("`{name}` {NO_ACCELERATION_IN_CONSTRAINT}")
}

/// The derivative of an acceleration in an output.
pub(crate) fn derivative_of_acceleration(found: impl Display) -> Text {
    text!("the derivative of an acceleration in `{found}` {NO_JERK}")
}

/// The derivative of a control input.
pub(crate) fn derivative_of_control(input: impl Display) -> Text {
    text!("`{input}` has no derivative; declare it `driven`")
}

/// The derivative of a velocity in an energy or a force.
pub(crate) fn derivative_of_velocity(found: impl Display) -> Text {
    text!("the derivative of a velocity in `{found}` {NO_ACCELERATION}")
}

/// The derivative of a velocity in a constraint or a limit.
pub(crate) fn derivative_of_velocity_in_constraint(found: impl Display) -> Text {
    text!("the derivative of a velocity in `{found}` {NO_ACCELERATION_IN_CONSTRAINT}")
}

/// A function without its arguments.
pub(crate) fn function_without_arguments(name: impl Display) -> Text {
    text!("`{name}` is a function; write `{name}(…)`")
}

/// The third derivative of a coordinate in an output.
pub(crate) fn jerk(name: impl Display) -> Text {
    text!("`{name}` {NO_JERK}")
}
