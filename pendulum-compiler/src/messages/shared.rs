//! Messages of several checks, and the parts that messages have in common.

use super::{Text, message};
use std::fmt::Display;

pub(crate) const NO_ACCELERATION: &str = "is an acceleration, and a Lagrangian has none; only \
                                          driven inputs have a second derivative";

pub(crate) const NO_ACCELERATION_IN_CONSTRAINT: &str =
    "is an acceleration; a constraint holds positions or velocities";

pub(crate) const NO_JERK: &str = "is a third derivative; coordinates have two, in outputs";

/// Advice for two adjacent operands.
pub(crate) const NO_IMPLICIT_PRODUCT: &str = "there is no implicit multiplication";

/// Advice instead of a comparison.
pub(crate) const TELL_CASES_APART: &str = "write `max`, `min`, `abs` or `sign` to tell cases apart";

/// Advice about a unit in a formula.
pub(crate) const UNITS: &str = "units stand in declarations only, as in `g: m/s^2 = 9.81`";

/// The second derivative of a coordinate in an energy or a force.
pub(crate) fn acceleration(name: impl Display) -> Text {
    message!("`{name}` {NO_ACCELERATION}")
}

/// The derivative of a control input.
pub(crate) fn derivative_of_control(input: impl Display) -> Text {
    message!("`{input}` has no derivative; declare it `driven`")
}

/// A family without members.
pub(crate) fn empty_family(name: impl Display) -> Text {
    message!("`{name}` has no members; write a range such as `0..5`")
}

/// A function without its arguments.
pub(crate) fn function_without_arguments(name: impl Display) -> Text {
    message!("`{name}` is a function; write `{name}(…)`")
}

/// A name that is not available for declarations, with its present meaning.
pub(crate) fn held_name(name: impl Display, holder: &str) -> Text {
    message!("`{name}` is {holder}; choose another name")
}

/// An index out of range.
pub(crate) fn index_out_of_range(name: &str, index: i64, length: usize) -> Text {
    message!(
        "index {index} is out of range; `{name}` has {length} members, `{name}[0]` to `{name}[{}]`",
        length - 1
    )
}

/// A value that is not a number known at compile time.
pub(crate) fn open_number(place: &str) -> Text {
    message!("{place} is a whole number known while compiling; write numbers and indices only")
}

/// A number with a unit.
pub(crate) fn suffix_of_unit() -> Text {
    message!("a number in a formula has no unit; {UNITS}")
}

/// An undeclared name, with the nearest name or with advice.
pub(crate) fn unknown(kind: &str, name: impl Display, nearest: Option<&str>, advice: &str) -> Text {
    match nearest {
        Some(near) => message!("unknown {kind} `{name}`; did you mean `{near}`?"),
        None => message!("unknown {kind} `{name}`; {advice}"),
    }
}
