//! Messages about the shapes, values and sizes of expressions.

use super::Text;
use std::fmt::Display;

// Shapes.

/// An exponential of a vector or a family.
pub(crate) fn exponential_of_vector(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, but the exponent is a number; write `exp(i*φ)` for a turn")
}

/// Terms of different kinds.
pub(crate) fn mixed_sum(found: &str, kind: &str, others: &str) -> Text {
    text!(
        "`{found}` is {kind}, but the terms before it are {others}; a sum needs terms of one kind"
    )
}

/// A component of a value without components.
pub(crate) fn no_component(found: &str, kind: &str, component: &str) -> Text {
    text!("`{found}` is {kind}, it has no `.{component}`; write a vector")
}

/// A divisor that is not a number.
pub(crate) fn no_divisor(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, and nothing can be divided by that; divide by its length `|u|`")
}

/// The height of a value that is not a vector.
pub(crate) fn no_height(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, and a height is that of a vector; write the scalar itself")
}

/// The magnitude of a family.
pub(crate) fn no_magnitude(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}; write one of its members")
}

/// A power of a value that is not a number.
pub(crate) fn no_power(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, and only scalars have powers; write `|{found}|^2`")
}

/// Factors without a product.
pub(crate) fn no_product(left: &str, right: &str) -> Text {
    text!("{left} cannot be multiplied by {right}; write a component or an index")
}

/// A quarter turn of a value that is not a plane vector.
pub(crate) fn no_quarter_turn(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, and a quarter turn needs a plane vector; write `perp([x, y])`")
}

/// A value that is not a scalar where a scalar is required.
pub(crate) fn no_scalar(found: &str, kind: &str) -> Text {
    other_than_scalar(found, kind, "`inner(u, v)`, `|u|` or a component")
}

/// A vector with too few or too many components.
pub(crate) fn no_vector(count: usize) -> Text {
    text!("a vector has two or three components; {count} stand here")
}

/// A function of two vectors with other arguments.
pub(crate) fn no_vectors(function: &str, left: &str, right: &str) -> Text {
    text!("`{function}` takes two vectors of one length; these are {left} and {right}")
}

/// The complex product of two plane vectors where a scalar is required.
pub(crate) fn product_of_plane_vectors(found: &str, left: &str, right: &str) -> Text {
    let kind = "the complex product of two plane vectors";
    other_than_scalar(found, kind, &format!("`inner({left}, {right})`"))
}

/// The product of two space vectors.
pub(crate) fn product_of_space_vectors(left: &str, right: &str) -> Text {
    text!(
        "the product of two space vectors is ambiguous; write `inner({left}, {right})` or \
         `cross({left}, {right})`"
    )
}

/// A body where a number is required.
pub(crate) fn whole_body(name: &str) -> Text {
    text!(
        "`{name}` is a body; write `{name}.mass`, `{name}.center`, `{name}.inertia` or \
         `integral(p in {name}, …)`"
    )
}

fn other_than_scalar(found: &str, kind: &str, instead: &str) -> Text {
    text!("`{found}` is {kind}, but a scalar is needed here; write {instead}")
}

// Indices, ranges and families.

/// A family without members.
pub(crate) fn empty_family(name: impl Display) -> Text {
    text!("`{name}` has no members; write a range such as `0..5`")
}

/// A force on a family without an index.
pub(crate) fn force_on_family(name: impl Display, count: usize) -> Text {
    text!("`{name}` is a family; write `{name}[k]`, or `{name}[k in 0..{count}]` for all")
}

/// An index of a definition outside of its range.
pub(crate) fn index_of_definition(name: &str, index: i64, range: &std::ops::Range<i64>) -> Text {
    text!(
        "`{name}[{index}]` does not exist; `{name}` is defined for {} to {}",
        range.start,
        range.end - 1
    )
}

/// An index of a force on a single coordinate.
pub(crate) fn index_of_force(name: impl Display) -> Text {
    text!("`{name}` is no family; write it without an index")
}

/// An index of a single constraint.
pub(crate) fn index_of_reaction(name: impl Display) -> Text {
    text!("`{name}` is no family; write `reaction({name})`")
}

/// An index of a scalar.
pub(crate) fn index_of_scalar(found: &str) -> Text {
    text!("`{found}` is a scalar, it has no members; leave out the index")
}

/// An index out of range.
pub(crate) fn index_out_of_range(name: &str, index: i64, length: usize) -> Text {
    text!(
        "index {index} is out of range; `{name}` has {length} members, `{name}[0]` to `{name}[{}]`",
        length - 1
    )
}

/// A range of too many members.
pub(crate) fn long_range() -> Text {
    text!("this range has more than 65536 members; write a shorter one")
}

/// An end of a range that is not a number.
pub(crate) fn open_end_of_range() -> Text {
    open_number("the end of a range")
}

/// An index that is not a number.
pub(crate) fn open_index() -> Text {
    open_number("an index")
}

/// A value that is not a number known at compile time.
fn open_number(place: &str) -> Text {
    text!("{place} is a whole number known while compiling; write numbers and indices only")
}

// Values.

/// A power of a complex number that cannot be expanded.
pub(crate) fn complex_power() -> Text {
    text!("a complex number has whole powers from 0 to 64 here; write `exp(i*φ)` for others")
}

/// A divisor that is zero.
pub(crate) fn division_by_zero() -> Text {
    text!("division by zero; write another divisor")
}

/// A constant that is not finite.
pub(crate) fn infinite_constant(found: &str) -> Text {
    text!("`{found}` is infinite or beyond the range of `f64`; write another operand")
}

/// A constant that is not zero but would be rounded to zero.
pub(crate) fn tiny_constant(found: &str) -> Text {
    text!("`{found}` is below the range of `f64`; write zero, or another operand")
}

/// An exponent with too many digits.
pub(crate) fn long_exponent() -> Text {
    text!("this exponent is too long for exact arithmetic; write one of at most eighteen digits")
}

/// A negative power of zero.
pub(crate) fn negative_power_of_zero() -> Text {
    text!("zero has no negative power; write another base")
}

/// An integrand that is not a polynomial in the point.
pub(crate) fn no_polynomial(integrand: &str, point: &str) -> Text {
    no_moment(integrand, "no polynomial", point)
}

/// An integrand of higher degree than two in the point.
pub(crate) fn polynomial_of_high_degree(integrand: &str, point: &str) -> Text {
    no_moment(integrand, "of higher degree than two", point)
}

/// A constant that is not a real number.
pub(crate) fn unreal_constant(found: &str) -> Text {
    text!("`{found}` is no real number; write an operand for which it is")
}

fn no_moment(integrand: &str, found: &str, point: &str) -> Text {
    text!(
        "`{integrand}` is {found} in `{point}`, and a body knows its moments up to the second; \
         write a polynomial of degree two or less"
    )
}

// Definitions.

/// A definition that depends on its own value.
pub(crate) fn circular_definition(name: impl Display) -> Text {
    text!("`{name}` is defined by itself; break the circle")
}

/// Definitions that are nested too deeply.
pub(crate) fn deep_definitions() -> Text {
    text!(
        "definitions within definitions are nested too deeply here; write each `let` above its \
         uses, and call fewer functions by functions"
    )
}

/// Functions and operations that are nested too deeply.
pub(crate) fn deep_value(deepest: usize) -> Text {
    text!(
        "this unfolds to more than {deepest} functions and operations within one another; write a \
         shorter chain"
    )
}

/// An energy or a force with too many nodes.
pub(crate) fn large_value(largest: usize) -> Text {
    text!("this unfolds to more than {largest} different expressions; write a shorter sum")
}

/// A block with too many evaluations.
pub(crate) fn long_block() -> Text {
    text!("this block unfolds to more than two million expressions; write shorter sums")
}

// Derivatives and control inputs.

/// A control input at which the potential energy may be undefined at zero.
pub(crate) fn control_in_divisor(input: impl Display) -> Text {
    text!(
        "the control input `{input}` stands in a divisor, a power or a function of an energy, \
         which may be no number where the input is zero; write what it does as a `force`"
    )
}

/// The derivative of a reaction.
pub(crate) fn derivative_of_reaction(found: &str) -> Text {
    text!("the derivative of a reaction in `{found}` is not known; leave the reaction out of it")
}

/// The third derivative of a driven input.
pub(crate) fn jerk_of_input(found: &str) -> Text {
    text!("`{found}` contains a third derivative of a driven input; they have two")
}

/// The derivative of a value that does not depend on time.
pub(crate) fn nothing_moves(found: &str) -> Text {
    text!("nothing in `{found}` moves, so its time derivative is zero; leave it out")
}

// Constraints, limits and outputs.

/// A restitution below zero or above one.
pub(crate) fn excessive_restitution(found: &str) -> Text {
    text!("`{found}` is no restitution; write a number from 0, no rebound, to 1, no loss")
}

/// A family on one side of a constraint or a limit.
pub(crate) fn family_in_constraint(found: &str, count: usize, name: &str) -> Text {
    text!(
        "`{found}` is a family; write it for one member, as `{name}[k in 0..{count}]: …` with \
         `{found}[k]`"
    )
}

/// An output of several vectors that is declared as one value.
pub(crate) fn family_of_vectors(found: &str, name: impl Display, count: usize, unit: &str) -> Text {
    text!(
        "`{found}` is a family of vectors; write `output {name}[k in 0..{count}]: [{}; 2] = \
         {found}[k];`",
        between_brackets(unit)
    )
}

/// An output whose first member has an index other than 0.
pub(crate) fn late_first_member(name: impl Display) -> Text {
    text!("the members of `{name}` are counted from 0; begin the range there")
}

/// A restitution that depends on the state.
pub(crate) fn moving_restitution(found: &str) -> Text {
    text!("`{found}` moves, and a restitution is made of parameters and numbers")
}

/// An output whose shape differs from the declared shape. Lengths are `None` for scalars.
pub(crate) fn shape_of_output(
    found: &str,
    [kind, name]: [&str; 2],
    declared: Option<usize>,
    own: Option<usize>,
    unit: &str,
) -> Text {
    let declared = match declared {
        None => "as a scalar".to_owned(),
        Some(length) => format!("with {length} components"),
    };
    let unit = between_brackets(unit);
    let instead = match own {
        None => unit.to_owned(),
        Some(length) => format!("[{unit}; {length}]"),
    };
    text!("`{found}` is {kind}, but `{name}` is declared {declared}; write `{instead}`")
}

/// Sides of a constraint or a limit with different shapes. Each side is given with its kind.
pub(crate) fn unequal_sides(left: [&str; 2], right: [&str; 2]) -> Text {
    let ([left, left_kind], [right, right_kind]) = (left, right);
    text!("`{left}` is {left_kind}, but `{right}` is {right_kind}; both sides have one shape")
}

/// A limit of a vector.
pub(crate) fn vector_limit(found: &str, kind: &str) -> Text {
    text!("`{found}` is {kind}, and a limit is one number; write a component")
}

/// Returns a unit in the form required inside the brackets of a vector.
fn between_brackets(unit: &str) -> &str {
    if unit.is_empty() { "_" } else { unit }
}
