//! Messages about energies, momenta and constraints that require the graph.

use super::Text;
use std::fmt::Display;

// Energies and momenta.

/// A control input whose derivative the equations would contain.
pub(crate) fn control_in_momenta(input: impl Display) -> Text {
    text!(
        "the momenta contain the control input `{input}`, so the equations would contain its \
         derivative; declare it `driven`, or write what it does as a `force`"
    )
}

/// A coordinate without inertia whose velocity stands in a dissipation or a force.
pub(crate) fn first_order(coordinate: &str) -> Text {
    text!(
        "`{coordinate}` has no kinetic energy, so its acceleration is undetermined; add the square \
         of its velocity to `kinetic`, and if its rate is given, as that of a filter, a constraint \
         of the velocity, `constraint rate: dot({coordinate}) = …;`"
    )
}

/// A kinetic energy without a definite sign.
pub(crate) fn indefinite_energy(coordinate: &str) -> Text {
    text!(
        "the kinetic energy is not positive: in the direction of `{coordinate}` it is zero at \
         every state; take coordinates whose squared velocities stand in it"
    )
}

/// The acceleration of a driven input in an energy.
pub(crate) fn jerk_in_energy(input: impl Display) -> Text {
    text!(
        "the energy contains the acceleration of `{input}`, so its power would contain a third \
         derivative; write what it does to a coordinate as a `force`"
    )
}

/// The acceleration of a driven input in the momenta.
pub(crate) fn jerk_in_momenta(input: impl Display) -> Text {
    text!(
        "the momenta contain the acceleration of `{input}`, so the equations would contain its \
         third derivative; leave its second derivative out of the kinetic energy"
    )
}

/// A kinetic energy that is negative at every state. `minus` is set if the term follows a minus
/// sign.
pub(crate) fn negative_energy(coordinate: impl Display, minus: bool, term: &str) -> Text {
    let sign = if minus { "-" } else { "" };
    text!(
        "the kinetic energy of `{coordinate}` is negative in `{sign}{term}`; write it with a \
         positive sign, or write `lagrangian = …;`, which may have any, instead of `kinetic` and \
         `potential`"
    )
}

/// Energies whose equations are too long.
pub(crate) fn long_equations() -> Text {
    text!(
        "the equations of this block unfold to millions of expressions; write shorter sums, or \
         nest fewer functions"
    )
}

/// A coordinate whose velocity does not occur in any energy.
pub(crate) fn no_kinetic_energy(coordinate: &str) -> Text {
    text!(
        "`{coordinate}` has no kinetic energy, so its acceleration is undetermined; add the square \
         of its velocity to `kinetic`"
    )
}

/// Coordinates that move the same masses in the same way.
pub(crate) fn redundant_coordinate(coordinate: &str) -> Text {
    text!(
        "the mass matrix is singular in the direction of `{coordinate}`: its kinetic energy is \
         that of other coordinates; leave the redundant coordinate out"
    )
}

/// Coordinates that move the same masses in the same way, beside constraints.
pub(crate) fn redundant_coordinate_with_constraint(coordinate: &str, constraint: &str) -> Text {
    text!(
        "the mass matrix is singular in the direction of `{coordinate}`: its kinetic energy is \
         that of other coordinates; leave the redundant coordinate out, or, if `{constraint}` holds \
         this direction, as it holds the length of a quaternion, give it an inertia, which nothing \
         then moves: add the square of the rate of `{constraint}` to `kinetic`"
    )
}

// Constraints and limits.

/// A constraint without second derivatives.
pub(crate) fn constraint_with_corner() -> Text {
    text!(
        "a constraint and a limit need two derivatives, and `abs`, `sign`, `min` and `max` of what moves have \
         a corner; write both sides without them, and two limits for a bound on both sides"
    )
}

/// A constraint that follows from other constraints.
pub(crate) fn dependent_constraint(name: &str, others: &[&str]) -> Text {
    let quoted: Vec<String> = others.iter().map(|other| format!("`{other}`")).collect();
    let from = match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => quoted.concat(),
    };
    text!(
        "`{name}` follows from {from}: leave it out, or write `redundant constraint` to have it \
         checked"
    )
}

/// Constraints that determine all coordinates.
pub(crate) fn fixed_coordinates(constraints: usize, coordinates: usize) -> Text {
    text!(
        "{} for {}: nothing is left to move; leave a constraint out",
        several_of(constraints, "scalar constraint"),
        several_of(coordinates, "coordinate")
    )
}

/// A constraint whose second derivative contains the third derivative of a driven input.
pub(crate) fn jerk_in_constraint(input: &str) -> Text {
    text!(
        "the second derivative of this constraint contains the third one of `{input}`, and driven \
         inputs have two; leave its derivative out"
    )
}

/// A limit of a velocity.
pub(crate) fn limit_of_velocity() -> Text {
    text!("a limit holds positions; leave the velocities out")
}

/// A constraint that is not linear in the velocities.
pub(crate) fn nonlinear_constraint() -> Text {
    text!(
        "velocities enter a constraint to the first power only; solve it for a velocity, or write \
         a `force`"
    )
}

/// More limits than a step supports.
pub(crate) fn too_many_limits(limits: usize, most: usize) -> Text {
    text!(
        "there are {limits} scalar limits, and at most {most} are kept; leave some out, or join \
         two of one coordinate, as in `w^2 - x^2 >= 0`"
    )
}

/// More redundant constraints than coordinates.
pub(crate) fn too_many_redundant(constraints: usize, coordinates: usize) -> Text {
    text!(
        "{} for {}; leave out those that follow from others",
        several_of(constraints, "scalar redundant constraint"),
        several_of(coordinates, "coordinate")
    )
}

/// A constraint without coordinates.
pub(crate) fn unmoved_constraint(left: &str, right: &str) -> Text {
    text!(
        "no coordinate stands in `{left} = {right}`: nothing here can move to fulfil it; leave it \
         out"
    )
}

/// Returns a number with a noun in the singular or plural.
fn several_of(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}
