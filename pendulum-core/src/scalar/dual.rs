//! Dual numbers: values with their derivatives.

use crate::scalar::real::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number a + a′ε with ε² = 0 (Clifford 1873). Functions of a dual number compute their
/// derivative with respect to one variable.
///
/// The derivative of a constant is zero even if the slope of a function is infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual<T = f64> {
    /// The value a.
    pub value: T,
    /// The derivative a′.
    pub derivative: T,
}

impl<T: Real> Dual<T> {
    /// Creates a number that does not depend on the variable.
    pub fn constant(value: T) -> Self {
        Self { value, derivative: number(0.0) }
    }

    /// Creates the variable itself.
    pub fn variable(value: T) -> Self {
        Self { value, derivative: number(1.0) }
    }

    /// Applies the chain rule to a function with this value and slope at `self`.
    #[inline]
    fn chain(self, value: T, slope: T) -> Self {
        Self { value, derivative: self.derivative.along(slope) }
    }
}

fn number<T: Real>(value: f64) -> T {
    T::from_f64(value)
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, derivative: self.derivative + other.derivative }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, derivative: self.derivative - other.derivative }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let derivative = self.derivative.along(other.value) + other.derivative.along(self.value);
        Self { value: self.value * other.value, derivative }
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let derivative = self.derivative.along(number::<T>(1.0) / other.value)
            - other.derivative.along(value / other.value);
        Self { value, derivative }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: -self.derivative }
    }
}

impl<T: Real> AddAssign for Dual<T> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Dual<T> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real> MulAssign for Dual<T> {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<T: Real> DivAssign for Dual<T> {
    #[inline]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<T: Real> Real for Dual<T> {
    fn from_f64(value: f64) -> Self {
        Self::constant(number(value))
    }

    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::constant(T::ratio(numerator, denominator))
    }

    fn pi() -> Self {
        Self::constant(T::pi())
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.value);
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    fn tan(self) -> Self {
        let tan = Real::tan(self.value);
        self.chain(tan, number::<T>(1.0) + tan * tan)
    }

    fn sinc(self, order: usize) -> Self {
        self.chain(self.value.sinc(order), self.value.sinc(order + 1))
    }

    fn asin(self) -> Self {
        self.chain(Real::asin(self.value), number::<T>(1.0) / circle(self.value))
    }

    fn acos(self) -> Self {
        self.chain(Real::acos(self.value), number::<T>(-1.0) / circle(self.value))
    }

    fn atan(self) -> Self {
        self.chain(
            Real::atan(self.value),
            number::<T>(1.0) / (number::<T>(1.0) + self.value * self.value),
        )
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let derivative =
            self.derivative.along(x.value / square) - x.derivative.along(self.value / square);
        Self { value: Real::atan2(self.value, x.value), derivative }
    }

    fn sinh(self) -> Self {
        self.chain(Real::sinh(self.value), Real::cosh(self.value))
    }

    fn cosh(self) -> Self {
        self.chain(Real::cosh(self.value), Real::sinh(self.value))
    }

    fn tanh(self) -> Self {
        let cosh = Real::cosh(self.value);
        self.chain(Real::tanh(self.value), number::<T>(1.0) / (cosh * cosh))
    }

    fn sech(self) -> Self {
        let sech = Real::sech(self.value);
        self.chain(sech, -(sech * Real::tanh(self.value)))
    }

    fn exp(self) -> Self {
        let exp = Real::exp(self.value);
        self.chain(exp, exp)
    }

    fn ln(self) -> Self {
        self.chain(Real::ln(self.value), number::<T>(1.0) / self.value)
    }

    fn sqrt(self) -> Self {
        let sqrt = self.value.sqrt();
        self.chain(sqrt, number::<T>(0.5) / sqrt)
    }

    fn powf(self, exponent: Self) -> Self {
        let value = Real::powf(self.value, exponent.value);
        let slope = exponent.value * Real::powf(self.value, exponent.value - number(1.0));
        let derivative =
            self.derivative.along(slope) + exponent.derivative.along(value * Real::ln(self.value));
        Self { value, derivative }
    }

    fn abs(self) -> Self {
        self.chain(self.value.abs(), Real::sign(self.value))
    }

    fn sign(self) -> Self {
        Self::constant(Real::sign(self.value))
    }

    fn step(self) -> Self {
        Self::constant(Real::step(self.value))
    }

    fn max(self, other: Self) -> Self {
        let step = Real::step(self.value - other.value);
        let derivative =
            self.derivative.along(step) + other.derivative.along(number::<T>(1.0) - step);
        Self { value: Real::max(self.value, other.value), derivative }
    }

    fn min(self, other: Self) -> Self {
        -Real::max(-self, -other)
    }

    fn where_positive(self, then: Self, otherwise: Self) -> Self {
        let value = self.value.where_positive(then.value, otherwise.value);
        Self { value, derivative: self.value.where_positive(then.derivative, otherwise.derivative) }
    }

    fn row<const K: usize>(self, rows: &[[f64; K]]) -> [Self; K] {
        self.value.row(rows).map(Self::constant)
    }
}

/// Computes √(1 − x²) without cancellation near ±1.
fn circle<T: Real>(x: T) -> T {
    ((number::<T>(1.0) - x) * (number::<T>(1.0) + x)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{Dual, Real};
    use crate::scalar::Octet;

    /// Returns the derivative of `function` at `x`, and checks its value against plain `f64`.
    fn slope(function: fn(Dual) -> Dual, plain: fn(f64) -> f64, x: f64) -> f64 {
        let result = function(Dual::variable(x));
        assert_eq!(result.value.to_bits(), plain(x).to_bits());
        assert_eq!(function(Dual::constant(x)).derivative, 0.0);
        result.derivative
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a} is not {b}");
    }

    macro_rules! slope {
        ($function:ident, $x:expr) => {
            slope(<Dual as Real>::$function, <f64 as Real>::$function, $x)
        };
    }

    #[test]
    fn functions_have_their_derivatives() {
        // The expected digits are from `tests/data/functions.py`.
        close(slope!(sin, 0.75), 0.7316888688738209);
        close(slope!(cos, 0.75), -0.6816387600233341);
        close(slope!(tan, 0.75), 1.8678719641803279);
        for (order, expected) in [(0, -0.23621708154305512), (1, -0.27893946258296526)] {
            assert_eq!(Dual::constant(0.75).sinc(order).derivative, 0.0);
            close(Dual::variable(0.75).sinc(order).derivative, expected);
        }
        close(slope!(asin, 0.75), 1.511857892036909);
        close(slope!(acos, 0.75), -1.511857892036909);
        close(slope!(atan, 0.75), 0.64);
        close(slope!(sinh, 0.75), 1.2946832846768448);
        close(slope!(cosh, 0.75), 0.82231673193583);
        close(slope!(tanh, 0.75), 0.5965858082813315);
        close(slope!(sech, 0.75), -0.49058249218520006);
        // cosh overflows here.
        assert_eq!(slope!(sech, 800.0), 0.0);
        close(slope!(exp, 0.75), 2.117000016612675);
        close(slope!(ln, 0.75), 4.0 / 3.0);
        close(slope!(sqrt, 0.5625), 2.0 / 3.0);
        assert_eq!((slope!(abs, 0.75), slope!(abs, -0.75), slope!(abs, 0.0)), (1.0, -1.0, 0.0));
        assert_eq!((slope!(sign, 0.75), slope!(step, 0.75)), (0.0, 0.0));
    }

    #[test]
    fn constant_lanes_have_no_derivative_beside_others() {
        let x = Dual {
            value: Octet::splat(0.0),
            derivative: Octet([0.0, 1.0, -1.0, f64::NAN, 0.0, -0.0, 2.0, 0.0]),
        };
        let sqrt = x.sqrt().derivative.0;
        assert_eq!(sqrt.map(f64::is_nan), [false, false, false, true, false, false, false, false]);
        let inf = f64::INFINITY;
        assert_eq!((sqrt[0], sqrt[1], sqrt[2], sqrt[5], sqrt[6]), (0.0, inf, -inf, 0.0, inf));
        assert!(sqrt[5].is_sign_positive());
    }

    #[test]
    fn products_and_quotients_follow_their_rules() {
        let x = Dual::variable(3.0);
        let two = Dual::constant(2.0);
        assert_eq!(x * x, Dual { value: 9.0, derivative: 6.0 });
        assert_eq!(two / x, Dual { value: 2.0 / 3.0, derivative: -2.0 / 9.0 });
        assert_eq!(x / two, Dual { value: 1.5, derivative: 0.5 });
        let mut y = x;
        y += two;
        y *= x;
        y -= two;
        y /= x;
        // x + 2 − 2/x.
        assert_eq!(y.value, 13.0 / 3.0);
        close(y.derivative, 11.0 / 9.0);
        assert_eq!(-x, Dual { value: -3.0, derivative: -1.0 });
    }

    #[test]
    fn powers_differentiate_in_base_and_exponent() {
        let x = Dual::variable(4.0);
        assert_eq!(x.powf(Dual::constant(1.5)), Dual { value: 8.0, derivative: 3.0 });
        close(Dual::constant(4.0).powf(Dual::variable(1.5)).derivative, 8.0 * 1.3862943611198906);
        // xˣ (1 + ln x).
        close(x.powf(x).derivative, 256.0 * 2.386294361119891);
        assert_eq!(
            Dual::variable(0.0).powf(Dual::constant(2.0)),
            Dual { value: 0.0, derivative: 0.0 }
        );
    }

    #[test]
    fn angles_differentiate_in_both_components() {
        let (y, x) = (Dual::variable(1.0), Dual::constant(-2.0));
        close(y.atan2(x).derivative, -0.4);
        close(Dual::constant(1.0).atan2(Dual::variable(-2.0)).derivative, -0.2);
    }

    #[test]
    fn ties_share_the_derivative() {
        let (a, b) = (Dual::variable(1.0), Dual::constant(1.0));
        assert_eq!((a.max(b).derivative, a.min(b).derivative), (0.5, 0.5));
        let c = Dual::constant(2.0);
        assert_eq!((a.max(c), a.min(c)), (c, a));
        assert!(a.max(Dual::constant(f64::NAN)).value.is_nan());
    }
}
