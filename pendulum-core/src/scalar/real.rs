//! The traits of scalars.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number for generated code: arithmetic and elementary functions, but no comparison.
///
/// Implementations are `f32`, `f64`, two-word numbers, dual numbers and lanes of several numbers.
/// Lanes have no ordering, so this trait has none. Every function returns the same bits on every
/// machine.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no real number of a system",
    label = "write a number with a point, as `1.0`, or convert it, as by `f64::from(k)`"
)]
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
    /// Returns the number nearest to `value`.
    fn from_f64(value: f64) -> Self;

    /// Returns the quotient of two integers that are exact in `f64`, rounded once in this type.
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::from_f64(numerator) / Self::from_f64(denominator)
    }

    /// Returns π.
    fn pi() -> Self;

    /// Computes sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// Computes the sine of an angle in radians.
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Computes the cosine of an angle in radians.
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Computes the tangent of an angle in radians.
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    /// Computes the derivative of `order` of sin(x)/x, also at zero. Order 0 is sinc x itself.
    ///
    /// Errors are below 1.5 units in the last place for sinc itself, and below 1.5 ε/(n+1) for the
    /// derivative of order n, which is at most 1/(n+1).
    fn sinc(self, order: usize) -> Self;

    /// Computes the arc sine, in [−π/2, π/2].
    fn asin(self) -> Self;
    /// Computes the arc cosine, in [0, π].
    fn acos(self) -> Self;
    /// Computes the arc tangent, in [−π/2, π/2].
    fn atan(self) -> Self;
    /// Computes the angle of the point (`x`, `self`), in [−π, π].
    fn atan2(self, x: Self) -> Self;
    /// Computes the hyperbolic sine.
    fn sinh(self) -> Self;
    /// Computes the hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Computes the hyperbolic tangent.
    fn tanh(self) -> Self;

    /// Computes the hyperbolic secant.
    fn sech(self) -> Self {
        // Not 1/cosh, because its derivatives are ∞/∞ if cosh overflows.
        let power = self.where_positive(-self, self).exp();
        (power + power) / (Self::from_f64(1.0) + power * power)
    }

    /// Computes the exponential function.
    fn exp(self) -> Self;
    /// Computes the natural logarithm.
    fn ln(self) -> Self;
    /// Computes the square root, correctly rounded for `f32` and `f64`.
    fn sqrt(self) -> Self;
    /// Raises `self` to a real power; NaN for a negative base.
    fn powf(self, exponent: Self) -> Self;
    /// Returns the magnitude.
    fn abs(self) -> Self;
    /// Returns −1, 0 or 1: the derivative of [`abs`](Self::abs), zero at zero.
    fn sign(self) -> Self;
    /// Returns 0, ½ or 1: the derivative of max(0, x), one half at zero.
    fn step(self) -> Self;
    /// Returns the larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// Returns the smaller of two numbers.
    fn min(self, other: Self) -> Self;

    /// Returns `then` if `self` is positive, and `otherwise` if it is not positive or NaN.
    ///
    /// The default implementation is correct for single numbers. Types of several numbers select in
    /// each lane.
    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        if self.sign() == Self::from_f64(1.0) { then } else { otherwise }
    }

    /// Returns the product of a derivative and a slope; zero if the derivative is zero, even if the
    /// slope is infinite or NaN.
    ///
    /// The default implementation is correct for single numbers. Types of several numbers decide in
    /// each lane.
    #[inline]
    fn along(self, slope: Self) -> Self {
        let zero = Self::from_f64(0.0);
        if self == zero { zero } else { slope * self }
    }

    /// Returns the row in which `self` lies: the last one whose first number is less, or the first
    /// row. The first numbers are in ascending order.
    ///
    /// The default implementation compares all of them, and so do the lanes of several numbers,
    /// which lie in different rows. Single numbers search: among 256 rows, that takes a thirtieth of
    /// the instructions.
    #[doc(hidden)]
    fn row<const K: usize>(self, rows: &[[f64; K]]) -> [Self; K] {
        let [first, rest @ ..] = rows else { return [Self::from_f64(f64::NAN); K] };
        rest.iter().fold(first.map(Self::from_f64), |own, row| {
            let past = self - Self::from_f64(row[0]);
            core::array::from_fn(|k| past.where_positive(Self::from_f64(row[k]), own[k]))
        })
    }
}

/// A real number with comparisons, as required by step control and by lanes.
pub trait Float: Real + PartialOrd {
    /// The distance from 1 to the next greater number.
    const EPSILON: Self;

    /// Returns the nearest `f64`.
    fn to_f64(self) -> f64;

    /// Returns `true` if the number is neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// Computes sine and cosine of every lane; one after the other by default.
    fn sin_cos_lanes<const W: usize>(x: &[Self; W]) -> ([Self; W], [Self; W]) {
        let both = x.map(Real::sin_cos);
        (both.map(|both| both.0), both.map(|both| both.1))
    }
}
