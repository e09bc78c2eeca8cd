//! The two-word number, and its sums, products and quotients.

use crate::scalar::exact::{ordered_sum, two_sum};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number in two words, high + low with |low| at most half a unit in the last place of high:
/// about 32 decimal digits.
///
/// Sums, products, quotients and roots have relative errors of at most 3, 5, 15 and 4 times 2⁻¹⁰⁶
/// (Joldes, Muller and Popescu 2017, Tight and rigorous error bounds for basic building blocks of
/// double-word arithmetic, ACM Trans. Math. Softw. 44, 15res), elementary functions of about 2⁻¹⁰³,
/// also for large angles, and a general power x^y of about (1 + |y ln x|)·2⁻¹⁰³. Error-free sums
/// are Knuth's (1969), products Dekker's (1971) with Veltkamp's splitting. They need no fused
/// multiply-add, so the bits are the same on every machine.
///
/// The range is that of `f64`. Below 1e-291 the low word underflows, and the accuracy decreases.
///
/// ```
/// use pendulum_runtime::scalar::{DoubleDouble, Real};
///
/// let third = DoubleDouble::ratio(1.0, 3.0);
/// assert_eq!(format!("{third:.30}"), "0.333333333333333333333333333333");
/// let g: DoubleDouble = "9.80665".parse()?;
/// assert_eq!(g.to_string(), "9.80665");
/// # Ok::<(), pendulum_runtime::scalar::ParseError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    pub(super) high: f64,
    pub(super) low: f64,
}

impl DoubleDouble {
    /// π.
    pub const PI: Self = Self::words(core::f64::consts::PI, 1.2246467991473532e-16);
    pub(super) const ZERO: Self = Self::words(0.0, 0.0);
    pub(super) const ONE: Self = Self::words(1.0, 0.0);
    pub(super) const NAN: Self = Self::words(f64::NAN, 0.0);

    /// Computes the sum of two numbers.
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self::finite(high, low)
    }

    /// Computes the product of two numbers.
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        Self::words(high, low)
    }

    /// Returns the word of greater magnitude, which is the nearest `f64`.
    pub const fn high(self) -> f64 {
        self.high
    }

    /// Returns the remainder after [`high`](Self::high).
    pub const fn low(self) -> f64 {
        self.low
    }

    /// Creates a number from two words, for constants; |low| must be at most half a unit in the
    /// last place of `high`.
    pub(super) const fn words(high: f64, low: f64) -> Self {
        Self { high, low }
    }

    /// Creates a number from two words, with `low` = 0 if `high` is not finite.
    #[inline]
    pub(super) fn finite(high: f64, low: f64) -> Self {
        Self { high, low: if high.is_finite() { low } else { 0.0 } }
    }

    /// Computes high + low for |high| ≥ |low|.
    #[inline]
    pub(super) fn ordered(high: f64, low: f64) -> Self {
        let (high, low) = ordered_sum(high, low);
        Self::finite(high, low)
    }

    /// Multiplies by a power of two.
    #[inline]
    pub(super) fn scaled(self, power: f64) -> Self {
        Self::ordered(self.high * power, self.low * power)
    }

    /// Multiplies by a number of one word.
    #[inline]
    pub(super) fn times(self, factor: f64) -> Self {
        let (high, low) = two_product(self.high, factor);
        if !high.is_finite() {
            return Self::words(high, 0.0);
        }
        Self::ordered(high, low + self.low * factor)
    }

    /// Adds a number of one word.
    #[inline]
    pub(super) fn plus(self, term: f64) -> Self {
        let (high, low) = two_sum(self.high, term);
        if !high.is_finite() {
            return Self::words(high, 0.0);
        }
        Self::ordered(high, low + self.low)
    }

    /// Computes the quotient if neither dividend nor quotient is close to the limits of the range.
    fn quotient(self, divisor: Self) -> Self {
        let high = self.high / divisor.high;
        let product = divisor.times(high);
        let rest = (self.high - product.high) + (self.low - product.low);
        Self::ordered(high, rest / divisor.high)
    }

    /// Computes the square root of a positive number that is not close to the limits of the range.
    pub(super) fn root(self) -> Self {
        let high = self.high.sqrt();
        let (square, error) = two_product(high, high);
        let rest = self.low + ((self.high - square) - error);
        Self::ordered(high, rest / (2.0 * high))
    }

    /// Computes an integer power by repeated squaring.
    pub(super) fn whole_power(self, mut exponent: u32) -> Self {
        let (mut base, mut power) = (self, Self::ONE);
        while exponent != 0 {
            if exponent & 1 == 1 {
                power *= base;
            }
            exponent >>= 1;
            if exponent != 0 {
                base *= base;
            }
        }
        power
    }
}

/// Computes a · b and its rounding error (Dekker 1971) in the whole range.
#[inline]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    if !product.is_finite() {
        return (product, 0.0);
    }
    // Splitting multiplies by 2²⁷. To avoid overflow, a part of the exponent of a large factor
    // moves to the other factor.
    let (a, b) = if LARGE < a.abs() {
        (a * TINY_POWER, b / TINY_POWER)
    } else if LARGE < b.abs() {
        (a / TINY_POWER, b * TINY_POWER)
    } else {
        (a, b)
    };
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2)
}

/// Splits a number into its upper 26 bits and the remainder (Veltkamp 1968).
#[inline]
fn split(a: f64) -> (f64, f64) {
    let c = 134217729.0 * a;
    let upper = c - (c - a);
    (upper, a - upper)
}

/// 2⁹⁹⁰; beyond it [`split`] may overflow.
const LARGE: f64 = power_of_two(990);
const TINY_POWER: f64 = power_of_two(-60);

/// Returns 2^exponent for exponents from −1022 to 1023.
pub(super) const fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Computes Σ coefficient · xᵏ.
#[inline]
fn polynomial(x: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// Computes Σ coefficient · xᵏ. The last coefficients, `tail`, are single words, because only the
/// leading digits of their terms are significant.
#[inline]
pub(super) fn series(x: DoubleDouble, coefficients: &[DoubleDouble], tail: &[f64]) -> DoubleDouble {
    let rest = DoubleDouble::words(polynomial(x.high, tail), 0.0);
    coefficients.iter().rev().fold(rest, |sum, coefficient| sum * x + *coefficient)
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self::words(value, 0.0)
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        if !high.is_finite() {
            return Self::words(high, 0.0);
        }
        let (low, rest) = two_sum(self.low, other.low);
        let (sum, error) = (high + (error + low), error + low);
        let carry = error - (sum - high);
        Self::ordered(sum, carry + rest)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        if !high.is_finite() {
            return Self::words(high, 0.0);
        }
        Self::ordered(
            high,
            low + (self.high * other.low + (self.low * other.high + self.low * other.low)),
        )
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let high = self.high / other.high;
        if !high.is_finite() || high == 0.0 || !other.high.is_finite() {
            return Self::words(high, 0.0);
        }
        let middle = |x: f64| (power_of_two(-400)..power_of_two(900)).contains(&x.abs());
        if middle(self.high) && middle(other.high) {
            return self.quotient(other);
        }
        // Close to the limits of the range, both numbers are scaled to its middle.
        let (up, down) = (balance(self.high), balance(other.high));
        let quotient = self.scaled(up).quotient(other.scaled(down));
        // Equal scale factors cancel, and must not overflow.
        if up == down { quotient } else { quotient.scaled(down).scaled(1.0 / up) }
    }
}

/// Returns the power of two that scales a number to the middle of the range.
fn balance(x: f64) -> f64 {
    if x.abs() < power_of_two(-400) {
        power_of_two(600)
    } else if power_of_two(400) < x.abs() {
        power_of_two(-600)
    } else {
        1.0
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for DoubleDouble {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for DoubleDouble {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl DivAssign for DoubleDouble {
    #[inline]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}
