//! Implementations of scalars for two-word numbers.

use super::number::{DoubleDouble, power_of_two};
use super::{angle, exponential};
use crate::scalar::real::{Float, Real};
use crate::scalar::sinc;

impl Real for DoubleDouble {
    #[inline]
    fn from_f64(value: f64) -> Self {
        value.into()
    }

    fn pi() -> Self {
        Self::PI
    }

    fn sin_cos(self) -> (Self, Self) {
        angle::sin_cos(self)
    }

    fn sinc(self, order: usize) -> Self {
        sinc::sinc(self, order)
    }

    fn asin(self) -> Self {
        Real::atan2(self, ((Self::ONE - self) * (Self::ONE + self)).sqrt())
    }

    fn acos(self) -> Self {
        Real::atan2(((Self::ONE - self) * (Self::ONE + self)).sqrt(), self)
    }

    fn atan(self) -> Self {
        Real::atan2(self, Self::ONE)
    }

    fn atan2(self, x: Self) -> Self {
        angle::atan2(self, x)
    }

    fn sinh(self) -> Self {
        exponential::sinh(self)
    }

    fn cosh(self) -> Self {
        exponential::cosh(self)
    }

    fn tanh(self) -> Self {
        exponential::tanh(self)
    }

    fn exp(self) -> Self {
        exponential::exp(self)
    }

    fn ln(self) -> Self {
        exponential::ln(self)
    }

    fn sqrt(self) -> Self {
        if self.high <= 0.0 || !self.high.is_finite() {
            return Self::words(self.high.sqrt(), 0.0);
        }
        if self.high < power_of_two(-400) {
            return self.scaled(power_of_two(600)).root().scaled(power_of_two(-300));
        }
        if power_of_two(900) < self.high {
            return self.scaled(power_of_two(-600)).root().scaled(power_of_two(300));
        }
        self.root()
    }

    fn powf(self, exponent: Self) -> Self {
        exponential::powf(self, exponent)
    }

    fn abs(self) -> Self {
        if self.high.is_sign_negative() { -self } else { self }
    }

    fn sign(self) -> Self {
        Real::sign(self.high).into()
    }

    fn step(self) -> Self {
        Real::step(self.high).into()
    }

    fn max(self, other: Self) -> Self {
        if other < self {
            self
        } else if self < other {
            other
        } else {
            // Equal (the positive of two zeros) or NaN.
            Self::finite(Real::max(self.high, other.high), self.low)
        }
    }

    fn min(self, other: Self) -> Self {
        -Real::max(-self, -other)
    }
}

impl Float for DoubleDouble {
    /// 2⁻¹⁰⁴, the accuracy of a few operations near 1. The distance to the next number is
    /// meaningless for two words.
    const EPSILON: Self = Self::words(power_of_two(-104), 0.0);

    #[inline]
    fn to_f64(self) -> f64 {
        self.high
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.high.is_finite()
    }
}
