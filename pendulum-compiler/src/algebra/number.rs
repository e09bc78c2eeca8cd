//! Exact rational numbers, used for all numbers until code or text is written.

use std::fmt;

/// A fraction in lowest terms with a positive denominator.
///
/// Its `Ord` compares numerator and denominator as a pair and serves only for sorting. Arithmetic
/// returns `None` if it exceeds 128 bits, and the graph then leaves the operation unevaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Rational {
    numerator: i128,
    denominator: i128,
}

impl Rational {
    pub(crate) const ZERO: Self = Self::whole(0);
    pub(crate) const ONE: Self = Self::whole(1);
    pub(crate) const MINUS_ONE: Self = Self::whole(-1);
    pub(crate) const HALF: Self = Self { numerator: 1, denominator: 2 };

    pub(crate) const fn whole(value: i64) -> Self {
        Self { numerator: value as i128, denominator: 1 }
    }

    pub(crate) fn new(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 || numerator == i128::MIN || denominator == i128::MIN {
            return None;
        }
        if denominator == 1 {
            return Some(Self { numerator, denominator });
        }
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()).cast_signed();
        let sign = denominator.signum();
        Some(Self {
            numerator: sign * numerator / divisor,
            denominator: sign * denominator / divisor,
        })
    }

    pub(crate) fn numerator(self) -> i128 {
        self.numerator
    }

    pub(crate) fn denominator(self) -> i128 {
        self.denominator
    }

    pub(crate) fn is_zero(self) -> bool {
        self.numerator == 0
    }

    pub(crate) fn is_negative(self) -> bool {
        self.numerator < 0
    }

    pub(crate) fn is_integer(self) -> bool {
        self.denominator == 1
    }

    /// Returns `true` for an even integer.
    pub(crate) fn is_even(self) -> bool {
        self.is_integer() && self.numerator % 2 == 0
    }

    /// Returns the value if it is an integer that fits.
    pub(crate) fn integer(self) -> Option<i64> {
        if self.is_integer() { i64::try_from(self.numerator).ok() } else { None }
    }

    /// Returns the number itself if numerator and denominator are below 2^`bits`.
    pub(crate) fn within(self, bits: u32) -> Option<Self> {
        let small = |value: i128| value.unsigned_abs() >> bits == 0;
        (small(self.numerator) && small(self.denominator)).then_some(self)
    }

    pub(crate) fn abs(self) -> Self {
        Self { numerator: self.numerator.abs(), ..self }
    }

    pub(crate) fn negative(self) -> Self {
        Self { numerator: -self.numerator, ..self }
    }

    pub(crate) fn add(self, other: Self) -> Option<Self> {
        if self.is_integer() && other.is_integer() {
            return Self::new(self.numerator.checked_add(other.numerator)?, 1);
        }
        let left = self.numerator.checked_mul(other.denominator)?;
        let right = other.numerator.checked_mul(self.denominator)?;
        Self::new(left.checked_add(right)?, self.denominator.checked_mul(other.denominator)?)
    }

    pub(crate) fn mul(self, other: Self) -> Option<Self> {
        if self.is_integer() && other.is_integer() {
            return Self::new(self.numerator.checked_mul(other.numerator)?, 1);
        }
        // Cancelling crosswise first keeps the products as small as the result.
        let a = Self::new(self.numerator, other.denominator)?;
        let b = Self::new(other.numerator, self.denominator)?;
        Self::new(a.numerator.checked_mul(b.numerator)?, a.denominator.checked_mul(b.denominator)?)
    }

    pub(crate) fn reciprocal(self) -> Option<Self> {
        Self::new(self.denominator, self.numerator)
    }

    /// Returns the power with an integer exponent.
    pub(crate) fn power(self, exponent: i64) -> Option<Self> {
        let base = if exponent < 0 { self.reciprocal()? } else { self };
        let exponent = u32::try_from(exponent.unsigned_abs()).ok()?;
        Some(Self {
            numerator: base.numerator.checked_pow(exponent)?,
            denominator: base.denominator.checked_pow(exponent)?,
        })
    }

    /// Returns the exact `degree`-th root, if it is rational.
    pub(crate) fn root(self, degree: u32) -> Option<Self> {
        Some(Self {
            numerator: whole_root(self.numerator, degree)?,
            denominator: whole_root(self.denominator, degree)?,
        })
    }

    /// Returns the content of two coefficients: the largest fraction of which both are integer
    /// multiples.
    pub(crate) fn content(self, other: Self) -> Option<Self> {
        let numerator =
            gcd(self.numerator.unsigned_abs(), other.numerator.unsigned_abs()).cast_signed();
        let shared =
            gcd(self.denominator.unsigned_abs(), other.denominator.unsigned_abs()).cast_signed();
        Self::new(numerator, (self.denominator / shared).checked_mul(other.denominator)?)
    }

    /// Returns `true` if `self` is less than `other`, or `None` if the comparison exceeds 128 bits.
    pub(crate) fn less(self, other: Self) -> Option<bool> {
        let left = self.numerator.checked_mul(other.denominator)?;
        let right = other.numerator.checked_mul(self.denominator)?;
        Some(left < right)
    }

    /// Reads a decimal literal such as `9.81`, `1e-3` or `12`.
    pub(crate) fn decimal(digits: &str) -> Option<Self> {
        let (mantissa, exponent) = match digits.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (digits, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let numerator: i128 = format!("{whole}{fraction}").parse().ok()?;
        let shift = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let scale = 10i128.checked_pow(shift.unsigned_abs())?;
        if shift < 0 {
            Self::new(numerator, scale)
        } else {
            Self::new(numerator.checked_mul(scale)?, 1)
        }
    }

    /// Returns `true` if numerator and denominator are exact in `f64`.
    pub(crate) fn fits_double(self) -> bool {
        let exact = |value: i128| value.unsigned_abs() >> value.trailing_zeros().min(127) < 1 << 53;
        self.numerator == 0 || exact(self.numerator) && exact(self.denominator)
    }

    /// Returns the double nearest to a positive number, and the double nearest to the remaining
    /// error.
    pub(crate) fn words(self) -> (f64, f64) {
        let bottom = self.denominator.unsigned_abs();
        let (mut quotient, mut rest) =
            (self.numerator.unsigned_abs() / bottom, self.numerator.unsigned_abs() % bottom);
        let mut unit = 1.0;
        // Long division in binary, to 120 digits.
        while quotient < 1 << 119 {
            rest *= 2;
            let digit = u128::from(bottom <= rest);
            quotient = 2 * quotient + digit;
            rest -= digit * bottom;
            unit /= 2.0;
        }
        let high = quotient as f64;
        let low = quotient.cast_signed() - (high as u128).cast_signed();
        (unit * high, unit * low as f64)
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_integer() {
            write!(f, "{}", self.numerator)
        } else {
            write!(f, "{}/{}", self.numerator, self.denominator)
        }
    }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

fn whole_root(value: i128, degree: u32) -> Option<i128> {
    if value < 0 || degree == 0 {
        return None;
    }
    let (mut low, mut high) = (0i128, 1i128 << (127 / degree).min(126));
    while low < high {
        let middle = low + (high - low) / 2;
        if middle.checked_pow(degree).is_none_or(|power| value <= power) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    (low.checked_pow(degree) == Some(value)).then_some(low)
}

/// A number as written in the source: exact if it fits, otherwise its digits.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Literal {
    Exact(Rational),
    Decimal(String),
}

/// Formats an integer as an exponent: ⁻¹, ², ³.
pub(crate) fn superscript(value: i64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    value
        .to_string()
        .chars()
        .map(|digit| digit.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::Rational;

    fn ratio(a: i128, b: i128) -> Rational {
        Rational::new(a, b).unwrap()
    }

    #[test]
    fn decimals_are_exact() {
        assert_eq!(Rational::decimal("9.81"), Some(ratio(981, 100)));
        assert_eq!(Rational::decimal("1e-3"), Some(ratio(1, 1000)));
        assert_eq!(Rational::decimal("2.50e2"), Some(ratio(250, 1)));
        assert_eq!(Rational::decimal("6.674e-11"), Some(ratio(6674, 100_000_000_000_000)));
        assert_eq!(Rational::decimal("1e300"), None);
    }

    #[test]
    fn arithmetic_cancels() {
        assert_eq!(ratio(1, 6).add(ratio(1, 3)), Some(Rational::HALF));
        assert_eq!(ratio(-4, 6), ratio(2, -3));
        assert_eq!(ratio(2, 3).power(-2), Some(ratio(9, 4)));
        assert_eq!(ratio(9, 4).root(2), Some(ratio(3, 2)));
        assert_eq!(ratio(2, 1).root(2), None);
        assert_eq!(ratio(i128::MAX, 1).mul(ratio(2, 1)), None);
        assert_eq!(ratio(i128::MAX, 2).mul(ratio(2, 1)), Some(ratio(i128::MAX, 1)));
    }

    #[test]
    fn content_divides_both() {
        assert_eq!(ratio(1, 2).content(ratio(1, 3)), Some(ratio(1, 6)));
        assert_eq!(ratio(4, 1).content(ratio(-6, 1)), Some(ratio(2, 1)));
    }
}
