//! Messages about names and declarations.

use super::Text;
use super::shared::{NO_IMPLICIT_PRODUCT, UNITS};
use std::fmt::{self, Display};

/// The present meaning of a name, which a declaration cannot use.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Holder {
    ConstantOfSystems,
    ControlInput,
    Coordinate,
    Derivative,
    DrivenInput,
    ImaginaryUnit,
    MethodOfSystems,
    Pi,
    Time,
}

impl Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ConstantOfSystems => "a constant of every system",
            Self::ControlInput => "a control input",
            Self::Coordinate => "a coordinate",
            Self::Derivative => "a time derivative",
            Self::DrivenInput => "a driven input",
            Self::ImaginaryUnit => "the imaginary unit",
            Self::MethodOfSystems => "a method of every system",
            Self::Pi => "the number π",
            Self::Time => "the time",
        })
    }
}

/// A local name of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Local {
    Argument,
    Index,
    Point,
}

impl Display for Local {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Argument => "an argument",
            Self::Index => "an index",
            Self::Point => "a point",
        })
    }
}

// Declarations.

/// A name for a constraint or a limit that is a parameter, a coordinate or an input.
pub(crate) fn declared_already(name: impl Display) -> Text {
    text!("`{name}` is declared already; choose another name")
}

/// The second declaration of a name.
pub(crate) fn declared_twice(name: impl Display) -> Text {
    text!("`{name}` is declared twice; rename one of the two")
}

/// A default of a vector, a family or a body.
pub(crate) fn default_of_several() -> Text {
    text!("only a scalar has a default; leave it out and pass the value to `new`")
}

/// A derivative as the name of a parameter, a coordinate, an input or a definition.
pub(crate) fn derivative_as_name(name: impl Display, plain: &str) -> Text {
    text!("`{name}` is a time derivative; declare the name without dots, `{plain}`")
}

/// A derivative as the name of a constraint or a limit.
pub(crate) fn derivative_as_name_of_constraint(name: impl Display) -> Text {
    text!("`{name}` is a time derivative; write the name without dots")
}

/// A derivative as the name of an output.
pub(crate) fn derivative_as_name_of_output(name: impl Display) -> Text {
    text!("`{name}` is a time derivative; give the output a name without dots, as `rate`")
}

/// The first declaration of a name that is declared twice.
pub(crate) fn first_declaration(name: impl Display) -> Text {
    text!("`{name}` is declared here first")
}

/// A name that is not available for declarations.
pub(crate) fn held_name(name: impl Display, holder: Holder) -> Text {
    text!("`{name}` is {holder}; choose another name")
}

/// A length out of bounds.
pub(crate) fn huge_length(longest: i64) -> Text {
    text!("a length is between 1 and {longest}; write another number")
}

/// A block without coordinates.
pub(crate) fn no_coordinate() -> Text {
    text!("no coordinate; write `coordinate θ: rad;` below the struct")
}

/// A default that does not consist of numbers.
pub(crate) fn open_default() -> Text {
    text!("a default is a number; write its value, as in `g: m/s^2 = 9.81`")
}

/// A length that is not an integer.
pub(crate) fn open_length() -> Text {
    text!("a length is a whole number; write it out, as in `[kg; 5]`")
}

/// A name for an output that is a parameter, a coordinate or an input.
pub(crate) fn output_declared_already(name: impl Display) -> Text {
    text!("`{name}` is declared already; choose another name for the output")
}

/// An input with the length of a family.
pub(crate) fn shape_of_input(input: Holder) -> Text {
    text!("{input} is a scalar or a vector; write `[m; 2]` or `[m; 3]`")
}

/// A ninth input. `controlled` is set if there are control inputs.
pub(crate) fn too_many_inputs(controlled: bool) -> Text {
    let inputs = if controlled { "inputs" } else { "driven inputs" };
    text!("more than eight {inputs}; join some of them into vectors")
}

/// Two arguments with the same name.
pub(crate) fn twin_arguments(name: impl Display) -> Text {
    text!("the argument `{name}` stands twice; rename one of the two")
}

/// Two constraints or limits with the same name.
pub(crate) fn twin_constraints(name: impl Display) -> Text {
    text!("two constraints or limits are called `{name}`; rename one of the two")
}

/// Two outputs with the same name.
pub(crate) fn twin_outputs(name: impl Display) -> Text {
    text!("two outputs are called `{name}`; rename one of the two")
}

// Energies and forces.

/// A Lagrangian in addition to a kinetic or a potential energy.
pub(crate) fn both_forms() -> Text {
    text!("`lagrangian` is kinetic minus potential energy already; write either one or the other")
}

/// A force on a name that is not a coordinate.
pub(crate) fn force_on_other(name: impl Display) -> Text {
    text!("`{name}` is no coordinate; a force acts on a coordinate, as in `force θ = …;`")
}

/// A block without energies.
pub(crate) fn no_energy() -> Text {
    text!("no energy; write `kinetic = …;` and `potential = …;` below the struct")
}

/// Two Lagrangians.
pub(crate) fn twin_lagrangians() -> Text {
    text!("`lagrangian` stands twice; write one sum")
}

// Names in formulas.

/// An accent in place of a dot. `velocity` lists the spellings of the derivative.
pub(crate) fn accent(name: &str, velocity: &str) -> Text {
    text!("`{name}` has an accent, and a derivative has a dot; write {velocity}")
}

/// The derivative of time, π or the imaginary unit.
pub(crate) fn derivative_of_constant(name: impl Display) -> Text {
    text!("`{name}` does not move as a coordinate does; write a number")
}

/// The derivative of a parameter.
pub(crate) fn derivative_of_parameter(name: impl Display, plain: &str) -> Text {
    text!(
        "`{plain}` is a parameter, so nothing in `{name}` moves; declare it `driven` or as a \
         coordinate"
    )
}

/// A local name that hides a constant or a quantity that depends on time.
pub(crate) fn hiding(name: impl Display, holder: Holder, local: Local) -> Text {
    text!("`{name}` is {holder}, and {local} of this name would hide it; choose another name")
}

/// The third derivative of a driven input.
pub(crate) fn jerk_of_input(name: impl Display) -> Text {
    text!("`{name}` is a third derivative; driven inputs have two")
}

/// A name that is not a body where a body is required.
pub(crate) fn no_body(name: impl Display) -> Text {
    text!("`{name}` is no body; declare it as `{name}: body` in the struct")
}

/// An output in a formula.
pub(crate) fn output_in_formula(name: &str) -> Text {
    text!("`{name}` is an output, which no formula reads; name its value with `let`")
}

/// A unit of another size in a formula, with the corresponding unit of the language and the factor.
pub(crate) fn scaled_unit_in_formula(name: &str, instead: &str, factor: &str) -> Text {
    text!("unknown name `{name}`; write a number in `{instead}`: 1 {name} is {factor} {instead}")
}

/// A unit in a formula in which its name is not declared.
pub(crate) fn unit_in_formula(name: &str) -> Text {
    text!("unknown name `{name}`; declare it as a parameter; {UNITS}")
}

/// A component of neither a vector nor a body.
pub(crate) fn unknown_component(name: impl Display, known: &[&str]) -> Text {
    let list: Vec<String> = known.iter().map(|known| format!("`.{known}`")).collect();
    text!("unknown component `{name}`; there are {}", list.join(", "))
}

/// A force on an undeclared coordinate, with the nearest name.
pub(crate) fn unknown_coordinate(name: &str, nearest: Option<&str>) -> Text {
    match nearest {
        Some(near) => text!("unknown coordinate `{name}`; did you mean `{near}`?"),
        None => text!("unknown coordinate `{name}`; declare it, as in `coordinate {name}: m;`"),
    }
}

/// An undeclared name, with the nearest name.
pub(crate) fn unknown_name(name: &str, nearest: Option<&str>) -> Text {
    match nearest {
        Some(near) => text!("unknown name `{name}`; did you mean `{near}`?"),
        None => text!(
            "unknown name `{name}`; declare it as a parameter, a coordinate, an input or with `let`"
        ),
    }
}

/// A name of another language, with its translation.
pub(crate) fn untranslated_name(name: &str, translation: &str) -> Text {
    text!("unknown name `{name}`; write `{translation}`")
}

// Functions.

/// The product of two vectors written as a derivative.
pub(crate) fn dot_of_two(product: &str) -> Text {
    text!("`dot` is the derivative of one argument; write `{product}` for a scalar product")
}

/// A call of a name that is not a function.
pub(crate) fn no_function(name: impl Display) -> Text {
    text!("`{name}` is no function, and {NO_IMPLICIT_PRODUCT}; write `{name}*(…)`")
}

/// A sum without its index.
pub(crate) fn sum_without_index() -> Text {
    text!("`sum` runs over an index; write `sum(k in 0..5, …)`")
}

/// An undefined function, with the nearest name.
pub(crate) fn unknown_function(name: impl Display, nearest: Option<&str>) -> Text {
    match nearest {
        Some(near) => text!("unknown function `{name}`; did you mean `{near}`?"),
        None => text!("unknown function `{name}`; define it with `let {name}(p) = …;`"),
    }
}

/// A function of another language, with its translation.
pub(crate) fn untranslated_function(name: impl Display, translation: &str) -> Text {
    text!("unknown function `{name}`; write `{translation}`")
}

/// A call with the wrong number of arguments.
pub(crate) fn wrong_number_of_arguments(name: impl Display, expected: usize, found: usize) -> Text {
    let expected =
        if expected == 1 { "one argument".into() } else { format!("{expected} arguments") };
    text!("`{name}` takes {expected}; {found} stand here")
}

// Reactions.

/// The reaction of a limit.
pub(crate) fn reaction_of_limit(name: impl Display) -> Text {
    text!("`{name}` is a limit; `reaction` is that of a constraint")
}

/// The reaction of a redundant constraint.
pub(crate) fn reaction_of_redundant(name: impl Display) -> Text {
    text!("`{name}` is redundant, and its reaction is not unique; leave it out")
}

/// A reaction outside of outputs.
pub(crate) fn reaction_outside_of_outputs(name: impl Display) -> Text {
    text!("the reaction of `{name}` is known only after the forces; it stands in outputs")
}

/// The reaction of an undeclared constraint, with the nearest name.
pub(crate) fn unknown_constraint(name: impl Display, nearest: Option<&str>) -> Text {
    match nearest {
        Some(near) => text!("unknown constraint `{name}`; did you mean `{near}`?"),
        None => text!("unknown constraint `{name}`; declare it, as in `constraint {name}: a = b;`"),
    }
}
