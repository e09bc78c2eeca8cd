//! The scalars that generated code runs on.

mod double_double;
mod dual;
pub(crate) mod exact;
mod float;
mod lanes;
mod sinc;
mod trig;

pub use double_double::{DoubleDouble, ParseError};
pub use dual::Dual;
pub use lanes::{Lane, Lanes, Octet};

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number as generated code sees it: arithmetic and elementary functions, no comparison.
///
/// Implementations are `f32`, `f64` and whatever computes with several of them at once (lanes, dual
/// numbers, two-word numbers), which is why there is no ordering here. Every function gives the
/// same bits on every machine.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The nearest number to `value`.
    fn from_f64(value: f64) -> Self;

    /// The quotient of two integers that `f64` holds exactly, rounded once in this type.
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::from_f64(numerator) / Self::from_f64(denominator)
    }

    /// The number π.
    fn pi() -> Self;

    /// Sine and cosine of an angle in radians, together.
    fn sin_cos(self) -> (Self, Self);

    /// Sine of an angle in radians.
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine of an angle in radians.
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Tangent of an angle in radians.
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    /// The derivative of `order` of sin(x)/x, at zero as well: `order` 0 is sinc x itself.
    ///
    /// Errors are below 1.5 units in the last place for sinc itself, and below 1.5 ε/(n+1) for the
    /// derivative of order n, which is 1/(n+1) at most.
    fn sinc(self, order: usize) -> Self;

    /// Arc sine, in [−π/2, π/2].
    fn asin(self) -> Self;
    /// Arc cosine, in [0, π].
    fn acos(self) -> Self;
    /// Arc tangent, in [−π/2, π/2].
    fn atan(self) -> Self;
    /// The angle of the point (`x`, `self`), in [−π, π].
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;

    /// Hyperbolic secant.
    fn sech(self) -> Self {
        // Not 1/cosh, whose derivatives are ∞/∞ where cosh overflows.
        let power = self.where_positive(-self, self).exp();
        (power + power) / (Self::from_f64(1.0) + power * power)
    }

    /// The exponential function.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// `self` to a real power; not a number for a negative base.
    fn powf(self, exponent: Self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// −1, 0 or 1: the derivative of [`abs`](Self::abs), zero at zero.
    fn sign(self) -> Self;
    /// 0, ½ or 1: the derivative of max(0, x), one half at zero.
    fn step(self) -> Self;
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self;

    /// `then` where `self` is positive, `otherwise` where it is not or is no number.
    ///
    /// The default is correct for a single number; types of several numbers choose for each.
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        if self.sign() == Self::from_f64(1.0) { then } else { otherwise }
    }
}

/// A real number that can be compared: what step control needs beyond [`Real`].
pub trait Float: Real + PartialOrd {
    /// The distance from 1 to the next number.
    const EPSILON: Self;

    /// The nearest `f64`.
    fn to_f64(self) -> f64;

    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
}
