//! The functions of the language: a table with a row for each function and all its properties.
//!
//! An ordinary function of one argument is a row of `functions!` and a method of the runtime's
//! `Real`. A row with a missing column does not compile. Functions with a special structure are
//! rows of [`STRUCTURES`]: powers and functions of two arguments are other kinds of nodes;
//! functions of vectors and derivatives are eliminated when energies are lowered. Three relations
//! between functions are not in the table but where they are used: the rules of `rule.rs`, sine and
//! cosine as a point of a circle (in `schedule`, in `prime_field.rs` and in the jets), and roots of
//! squares, which become magnitudes.

use crate::algebra::number::{Rational, superscript};
use std::f64::consts::{FRAC_PI_2, PI};

use Derivative::{Call, Itself, OneAndSquare, Reciprocal, Times, Zero};
use Kinks::{Corner, Jump, Smooth};
use Notation::{Bars, Prefix};
use Parity::{Even, Neither, Odd};
use Scale::{Bell, Bump, Oscillation};
use Series::{Circular, Family, Hyperbolic, Linear};

/// The properties of a function f of one argument.
pub(crate) struct Row {
    /// The name in the language and of the method of `Real`.
    pub(crate) name: &'static str,
    /// A description for editors.
    pub(crate) meaning: &'static str,
    /// `true` if the function can be written in the language. Other functions occur only in
    /// derivatives.
    pub(crate) word: bool,
    /// The units of argument and value.
    pub(crate) units: UnitRule,
    /// An interval on which f is defined, and smooth except for its kinks.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests take their arguments from it"))]
    pub(crate) domain: [f64; 2],
    /// Bounds of the values.
    pub(crate) range: [f64; 2],
    /// The value f(0), if the simplifier may use it.
    pub(crate) at_zero: Option<Rational>,
    /// The symmetry: f(−u) in terms of f(u).
    pub(crate) parity: Parity,
    /// The kink at zero, of f or of one of its derivatives.
    pub(crate) kinks: Kinks,
    /// The rule for the width of f(u(t)).
    pub(crate) scale: Scale,
    /// The notation in equations.
    pub(crate) notation: Notation,
    /// Writes f(u) in ASCII, from the order in a family and the text of u, if it is not written as
    /// a call.
    pub(crate) ascii: Option<fn(u8, &str) -> String>,
    /// Computes f(x) in the compiler, from the order in a family and x.
    pub(crate) value: fn(u8, f64) -> f64,
    /// The derivative f′(u).
    pub(crate) derivative: Derivative,
}

/// The relation between the units of arguments and value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UnitRule {
    /// A pure number, from pure numbers.
    Pure,
    /// The unit of the argument.
    Same,
    /// The square root of the unit of the argument.
    Root,
    /// The unit of the argument per second.
    Rate,
    /// The product of the units of two arguments.
    Product,
    /// A pure number, from an argument of any unit.
    Any,
    /// The common unit of all arguments.
    Common,
    /// A pure number, from arguments of a common unit.
    Ratio,
    /// A pure number, from an axis of any unit and an angle.
    Turn,
}

/// The symmetry of a function: f(−u) in terms of f(u).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    /// −f(u).
    Odd,
    /// f(u).
    Even,
    /// Neither.
    Neither,
}

/// The kinds of kinks at zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kinks {
    /// No kink: all derivatives exist.
    Smooth,
    /// The derivative jumps.
    Corner,
    /// The value jumps.
    Jump,
}

/// The rule for the width of f(u(t)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    /// The width of a crest of a sine.
    Oscillation,
    /// f changes when |u| is of the order of one.
    Bell,
    /// f has no width. The width is that of u where u is not zero.
    Bump,
    /// A kink at u = 0.
    Kink,
}

/// The form of f(u) in equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Notation {
    /// The name before u; in LaTeX this command.
    Prefix(&'static str),
    /// |u|.
    Bars,
}

/// f′(u) in terms of u and y = f(u). The Taylor series of f(u(t)) follows from ẏ = f′(u) u̇.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Derivative {
    /// ± another function of u.
    Call(Sign, Function, Series),
    /// y.
    Itself,
    /// 1 ± y².
    OneAndSquare(Sign),
    /// ± y g(u) with another function g.
    Times(Sign, Function),
    /// ± 1/d with a divisor d.
    Reciprocal(Divisor, Sign),
    /// 0.
    Zero,
}

/// The Taylor series of a function whose derivative is another function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Series {
    /// Together with that function: sine and cosine.
    Circular,
    /// Together with that function: sinh and cosh. The number is the index in the pair.
    Hyperbolic(usize),
    /// y = a u, where a is the value of that function at the start of the series.
    Linear,
    /// That function is the next member of a family. The methods of a family take the order.
    Family,
}

/// The divisor of the derivative of the argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Divisor {
    /// u.
    Argument,
    /// 1 + u².
    OnePlusSquare,
    /// √(1 − u²).
    RootOfOneMinusSquare,
}

/// The sign of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    Plus,
    Minus,
}

/// The index of the first table that is a parameter; those of the block come before.
pub(crate) const GIVEN: u8 = 128;

/// All numbers.
pub(crate) const REAL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];
const UNIT: [f64; 2] = [-1.0, 1.0];
const ZERO: Option<Rational> = Some(Rational::ZERO);
const ONE: Option<Rational> = Some(Rational::ONE);

/// Defines functions. A function is `Case = name { columns }`; a family of derivatives is
/// `Case(order: u8) = name { columns }`, and its methods take the order.
macro_rules! functions {
    ($($case:ident $(($order:ident: $kind:ty))? = $name:ident { $($column:tt)* })+) => {
        /// A function of one argument. The canonical order is the order of the rows.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(crate) enum Function {
            $($case $(($kind))?,)+
            /// The spline of a table of the block or a derivative of it, by the index of the table
            /// and the order.
            Table(u8, u8),
            /// A function that changes its sign at knots of a table, by the index of the table and
            /// the digit that tells the intervals on both sides apart.
            Knots(u8, u8),
        }

        impl Function {
            /// All functions, except those of tables; a family is represented by its member of
            /// order 0.
            pub(crate) const ALL: &[Self] = &[$(Self::$case $((<$kind>::MIN))?,)+];

            /// Returns the row in the table of functions.
            pub(crate) fn row(self) -> Row {
                match self {
                    $(Self::$case $(($order))? => Row { name: stringify!($name), $($column)* },)+
                    Self::Table(index, order @ 0..3) => Row {
                        derivative: Call(Sign::Plus, Self::Table(index, order + 1), Family),
                        kinks: if order == 2 { Corner } else { Smooth },
                        ..TABLE
                    },
                    Self::Table(..) | Self::Knots(..) => TABLE,
                }
            }

            /// Returns the order of the derivative, for a member of a family.
            pub(crate) fn order(self) -> Option<u8> {
                match self {
                    $(Self::$case $(($order))? => None$(.or(Some($order)))?,)+
                    Self::Table(_, order) => Some(order),
                    Self::Knots(..) => None,
                }
            }

            /// Returns `true` for a function of a table that is a parameter.
            pub(crate) fn is_given(self) -> bool {
                matches!(self, Self::Table(GIVEN.., _) | Self::Knots(GIVEN.., _))
            }

            /// Returns the value over any scalar of the runtime.
            #[cfg(test)]
            pub(crate) fn of<T: pendulum_runtime::scalar::Real>(self, x: T) -> T {
                match self {
                    $(Self::$case $(($order))? => x.$name($($order.into())?),)+
                    Self::Table(..) | Self::Knots(..) => T::from_f64(f64::NAN),
                }
            }
        }
    };
}

functions! {
    Sin = sin {
        meaning: "The sine.",
        word: true, units: UnitRule::Pure, domain: REAL, range: UNIT, at_zero: ZERO, parity: Odd,
        kinks: Smooth, scale: Oscillation, notation: Prefix("\\sin"), ascii: None,
        value: |_, x| x.sin(), derivative: Call(Sign::Plus, Function::Cos, Circular),
    }
    Cos = cos {
        meaning: "The cosine.",
        word: true, units: UnitRule::Pure, domain: REAL, range: UNIT, at_zero: ONE, parity: Even,
        kinks: Smooth, scale: Oscillation, notation: Prefix("\\cos"), ascii: None,
        value: |_, x| x.cos(), derivative: Call(Sign::Minus, Function::Sin, Circular),
    }
    Tan = tan {
        meaning: "The tangent.",
        word: true, units: UnitRule::Pure, domain: [-FRAC_PI_2, FRAC_PI_2], range: REAL,
        at_zero: ZERO, parity: Odd, kinks: Smooth, scale: Oscillation, notation: Prefix("\\tan"),
        ascii: None, value: |_, x| x.tan(), derivative: OneAndSquare(Sign::Plus),
    }
    Asin = asin {
        meaning: "The arcsine.",
        word: true, units: UnitRule::Pure, domain: UNIT, range: [-FRAC_PI_2, FRAC_PI_2],
        at_zero: ZERO, parity: Odd, kinks: Smooth, scale: Bell, notation: Prefix("\\arcsin"),
        ascii: None, value: |_, x| x.asin(),
        derivative: Reciprocal(Divisor::RootOfOneMinusSquare, Sign::Plus),
    }
    Acos = acos {
        meaning: "The arccosine.",
        word: true, units: UnitRule::Pure, domain: UNIT, range: [0.0, PI], at_zero: None,
        parity: Neither, kinks: Smooth, scale: Bell, notation: Prefix("\\arccos"), ascii: None,
        value: |_, x| x.acos(), derivative: Reciprocal(Divisor::RootOfOneMinusSquare, Sign::Minus),
    }
    Atan = atan {
        meaning: "The arctangent.",
        word: true, units: UnitRule::Pure, domain: REAL, range: [-FRAC_PI_2, FRAC_PI_2],
        at_zero: ZERO, parity: Odd, kinks: Smooth, scale: Bell, notation: Prefix("\\arctan"),
        ascii: None, value: |_, x| x.atan(),
        derivative: Reciprocal(Divisor::OnePlusSquare, Sign::Plus),
    }
    Sinh = sinh {
        meaning: "The hyperbolic sine.",
        word: true, units: UnitRule::Pure, domain: REAL, range: REAL, at_zero: ZERO, parity: Odd,
        kinks: Smooth, scale: Bell, notation: Prefix("\\sinh"), ascii: None, value: |_, x| x.sinh(),
        derivative: Call(Sign::Plus, Function::Cosh, Hyperbolic(0)),
    }
    Cosh = cosh {
        meaning: "The hyperbolic cosine.",
        word: true, units: UnitRule::Pure, domain: REAL, range: [1.0, f64::INFINITY], at_zero: ONE,
        parity: Even, kinks: Smooth, scale: Bell, notation: Prefix("\\cosh"), ascii: None,
        value: |_, x| x.cosh(), derivative: Call(Sign::Plus, Function::Sinh, Hyperbolic(1)),
    }
    Tanh = tanh {
        meaning: "The hyperbolic tangent.",
        word: true, units: UnitRule::Pure, domain: REAL, range: UNIT, at_zero: ZERO, parity: Odd,
        kinks: Smooth, scale: Bell, notation: Prefix("\\tanh"), ascii: None, value: |_, x| x.tanh(),
        derivative: OneAndSquare(Sign::Minus),
    }
    Sech = sech {
        meaning: "The hyperbolic secant.",
        word: true, units: UnitRule::Pure, domain: REAL, range: [0.0, 1.0], at_zero: ONE,
        parity: Even, kinks: Smooth, scale: Bell, notation: Prefix("\\operatorname{sech}"),
        ascii: None, value: |_, x| x.cosh().recip(),
        derivative: Times(Sign::Minus, Function::Tanh),
    }
    Exp = exp {
        meaning: "The exponential function.",
        word: true, units: UnitRule::Pure, domain: REAL, range: POSITIVE, at_zero: ONE,
        parity: Neither, kinks: Smooth, scale: Bell, notation: Prefix("\\exp"), ascii: None,
        value: |_, x| x.exp(), derivative: Itself,
    }
    Ln = ln {
        meaning: "The natural logarithm.",
        word: true, units: UnitRule::Pure, domain: POSITIVE, range: REAL, at_zero: None,
        parity: Neither, kinks: Smooth, scale: Bump, notation: Prefix("\\ln"), ascii: None,
        value: |_, x| x.ln(), derivative: Reciprocal(Divisor::Argument, Sign::Plus),
    }
    Abs = abs {
        meaning: "The absolute value.",
        word: true, units: UnitRule::Same, domain: REAL, range: POSITIVE, at_zero: ZERO,
        parity: Even, kinks: Corner, scale: Scale::Kink, notation: Bars, ascii: None,
        value: |_, x| x.abs(), derivative: Call(Sign::Plus, Function::Sign, Linear),
    }
    Sign = sign {
        meaning: "The sign: −1, 0 or 1.",
        word: true, units: UnitRule::Any, domain: REAL, range: UNIT, at_zero: None, parity: Odd,
        kinks: Jump, scale: Scale::Kink, notation: Prefix("\\operatorname{sign}"), ascii: None,
        value: |_, x| if x == 0.0 { 0.0 } else { x.signum() }, derivative: Zero,
    }
    // The derivative of max(0, u): ½ at zero.
    Step = step {
        meaning: "The unit step: 0, ½ or 1.",
        word: false, units: UnitRule::Any, domain: REAL, range: [0.0, 1.0], at_zero: None,
        parity: Neither, kinks: Jump, scale: Scale::Kink, notation: Prefix("\\operatorname{step}"),
        ascii: Some(|_, x| format!("((1 + sign({x}))/2)")),
        value: |_, x| if x == 0.0 { 0.5 } else { f64::from(0.0 < x) }, derivative: Zero,
    }
    // The derivatives of sin(x)/x, by order.
    Sinc(order: u8) = sinc {
        meaning: "The function sin(x)/x, which is 1 at 0.",
        word: true, units: UnitRule::Pure, domain: REAL, range: UNIT,
        at_zero: match order % 4 {
            0 => Rational::new(1, i128::from(order) + 1),
            2 => Rational::new(-1, i128::from(order) + 1),
            _ => ZERO,
        },
        parity: if order % 2 == 0 { Even } else { Odd }, kinks: Smooth, scale: Oscillation,
        notation: Prefix("\\operatorname{sinc}"), ascii: Some(sinc_in_ascii), value: sinc,
        derivative: Call(Sign::Plus, Function::Sinc(order.saturating_add(1)), Family),
    }
}

/// The row of the third derivative of a table, which jumps at the knots. Name, units and values are
/// those of the block.
const TABLE: Row = Row {
    name: "table",
    meaning: "",
    word: false,
    units: UnitRule::Any,
    domain: REAL,
    range: REAL,
    at_zero: None,
    parity: Neither,
    kinks: Jump,
    scale: Scale::Kink,
    notation: Prefix(""),
    ascii: None,
    value: |_, _| f64::NAN,
    derivative: Zero,
};

/// Computes a derivative of sin(x)/x from x sₙ + n sₙ₋₁ = sin⁽ⁿ⁾ x: upwards if |x| > n, otherwise
/// downwards from a high order.
fn sinc(order: u8, x: f64) -> f64 {
    let sine = |n: u8| [x.sin(), x.cos(), -x.sin(), -x.cos()][usize::from(n % 4)];
    if f64::from(order) < x.abs() {
        return (1..=order).fold(x.sin() / x, |value, n| (sine(n) - f64::from(n) * value) / x);
    }
    let orders = order + 1..=order.saturating_add(60);
    orders.rev().fold(0.0, |value, n| (sine(n) - x * value) / f64::from(n))
}

/// Writes the same relation in the syntax of the language.
fn sinc_in_ascii(order: u8, x: &str) -> String {
    if order == 0 {
        return format!("sinc({x})");
    }
    let sine = ["sin", "cos", "-sin", "-cos"][usize::from(order % 4)];
    let (times, before) = (order, sinc_in_ascii(order - 1, x));
    format!("(({sine}({x}) - {times}*{before})/({x}))")
}

impl Function {
    /// Returns f(x).
    pub(crate) fn value(self, x: f64) -> f64 {
        (self.row().value)(self.order().unwrap_or(0), x)
    }

    /// Returns the primes after the name of a derivative: ′, ″ and so on.
    pub(crate) fn primes(self) -> String {
        match self.order() {
            None | Some(0) => String::new(),
            Some(order @ 1..=3) => "′".repeat(order.into()),
            Some(order) => format!("⁽{}⁾", superscript(order.into())),
        }
    }
}

/// A function of the language.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word {
    pub(crate) name: &'static str,
    /// A description for editors.
    pub(crate) meaning: &'static str,
    pub(crate) units: UnitRule,
    pub(crate) lowering: Lowering,
}

/// The lowering of a function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lowering {
    /// An ordinary function of the table.
    Function(Function),
    /// A square root, lowered to a power.
    Sqrt,
    Dot,
    Perp,
    Height,
    Cis,
    Transpose,
    AngularVelocity,
    Atan2,
    Min,
    Max,
    Inner,
    Cross,
    Rotation,
}

/// The functions with a special structure.
#[rustfmt::skip]
const STRUCTURES: [Word; 13] = [
    Word { name: "sqrt",   meaning: "The square root.",                              units: UnitRule::Root,    lowering: Lowering::Sqrt },
    Word { name: "atan2",  meaning: "The angle of the point (x, y), as atan2(y, x).", units: UnitRule::Ratio,   lowering: Lowering::Atan2 },
    Word { name: "min",    meaning: "The lesser of two values.",                     units: UnitRule::Common,  lowering: Lowering::Min },
    Word { name: "max",    meaning: "The greater of two values.",                    units: UnitRule::Common,  lowering: Lowering::Max },
    Word { name: "dot",    meaning: "The total derivative by time.",                 units: UnitRule::Rate,    lowering: Lowering::Dot },
    Word { name: "inner",  meaning: "The inner product of two vectors.",             units: UnitRule::Product, lowering: Lowering::Inner },
    Word { name: "cross",  meaning: "The cross product of two vectors.",             units: UnitRule::Product, lowering: Lowering::Cross },
    Word { name: "perp",   meaning: "A plane vector, turned by a quarter counter-clockwise.", units: UnitRule::Same, lowering: Lowering::Perp },
    Word { name: "height", meaning: "The last component of a vector, which points up.", units: UnitRule::Same, lowering: Lowering::Height },
    Word { name: "cis",    meaning: "The complex number cos φ + i sin φ.",           units: UnitRule::Pure,    lowering: Lowering::Cis },
    Word { name: "rotation", meaning: "The rotation about an axis in space, right-handed.", units: UnitRule::Turn, lowering: Lowering::Rotation },
    Word { name: "transpose", meaning: "The rotation that turns back.",              units: UnitRule::Same,    lowering: Lowering::Transpose },
    Word { name: "angular_velocity", meaning: "The angular velocity of a rotation, in the components of space.", units: UnitRule::Rate, lowering: Lowering::AngularVelocity },
];

impl Word {
    /// Returns all functions of the language.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let functions = Function::ALL.iter().filter_map(|&function| {
            let Row { name, meaning, word, units, .. } = function.row();
            word.then_some(Self { name, meaning, units, lowering: Lowering::Function(function) })
        });
        functions.chain(STRUCTURES)
    }

    /// Returns the function with this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::all().find(|word| word.name == name)
    }

    /// Returns the number of arguments.
    pub(crate) fn arity(self) -> usize {
        use Lowering::{Atan2, Cross, Inner, Max, Min, Rotation};
        if matches!(self.lowering, Atan2 | Min | Max | Inner | Cross | Rotation) { 2 } else { 1 }
    }

    /// Returns `true` if arguments and value are scalars.
    pub(crate) fn is_scalar(self) -> bool {
        use Lowering::{Atan2, Max, Min, Sqrt};
        matches!(self.lowering, Lowering::Function(_) | Sqrt | Atan2 | Min | Max)
    }
}
