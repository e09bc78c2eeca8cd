//! Implementations of scalars for `f64` and `f32`.

use super::{sinc, trig};
use crate::scalar::real::{Float, Real};

/// Implements `Real` and `Float` for a type. Both types use the functions of `f64`. `f32` rounds
/// their results once more, which is close to correct rounding. Only sine and cosine of `f32` have
/// a shorter kernel.
macro_rules! float {
    ($float:ident $sin_cos:ident $kernel:ident) => {
        impl Real for $float {
            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            #[inline]
            fn ratio(numerator: f64, denominator: f64) -> Self {
                (numerator / denominator) as $float
            }

            #[inline]
            fn pi() -> Self {
                core::$float::consts::PI
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                trig::$sin_cos(self)
            }

            #[inline]
            fn tan(self) -> Self {
                libm::tan(f64::from(self)) as $float
            }

            #[inline]
            fn sinc(self, order: usize) -> Self {
                sinc::sinc(f64::from(self), order) as $float
            }

            #[inline]
            fn asin(self) -> Self {
                libm::asin(f64::from(self)) as $float
            }

            #[inline]
            fn acos(self) -> Self {
                libm::acos(f64::from(self)) as $float
            }

            #[inline]
            fn atan(self) -> Self {
                libm::atan(f64::from(self)) as $float
            }

            #[inline]
            fn atan2(self, x: Self) -> Self {
                libm::atan2(f64::from(self), f64::from(x)) as $float
            }

            #[inline]
            fn sinh(self) -> Self {
                libm::sinh(f64::from(self)) as $float
            }

            #[inline]
            fn cosh(self) -> Self {
                libm::cosh(f64::from(self)) as $float
            }

            #[inline]
            fn tanh(self) -> Self {
                libm::tanh(f64::from(self)) as $float
            }

            #[inline]
            fn sech(self) -> Self {
                let power = libm::exp(-f64::abs(f64::from(self)));
                ((power + power) / (1.0 + power * power)) as $float
            }

            #[inline]
            fn exp(self) -> Self {
                libm::exp(f64::from(self)) as $float
            }

            #[inline]
            fn ln(self) -> Self {
                libm::log(f64::from(self)) as $float
            }

            #[inline]
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }

            #[inline]
            fn powf(self, exponent: Self) -> Self {
                if self < 0.0 {
                    return $float::NAN;
                }
                libm::pow(f64::from($float::abs(self)), f64::from(exponent)) as $float
            }

            #[inline]
            fn abs(self) -> Self {
                $float::abs(self)
            }

            #[inline]
            fn sign(self) -> Self {
                if 0.0 < self {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    self - self
                }
            }

            #[inline]
            fn where_positive(self, then: Self, otherwise: Self) -> Self {
                if 0.0 < self { then } else { otherwise }
            }

            fn row<const K: usize>(self, rows: &[[f64; K]]) -> [Self; K] {
                let less = rows.partition_point(|row| Self::from_f64(row[0]) < self);
                let own = rows.get(less.saturating_sub(1));
                own.map_or([$float::NAN; K], |row| row.map(Self::from_f64))
            }

            #[inline]
            fn step(self) -> Self {
                0.5 + 0.5 * Real::sign(self)
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                if other < self {
                    self
                } else if self < other {
                    other
                } else if self == other {
                    // Of two zeros, the positive one.
                    $float::from_bits(self.to_bits() & other.to_bits())
                } else {
                    self + other
                }
            }

            #[inline]
            fn min(self, other: Self) -> Self {
                if self < other {
                    self
                } else if other < self {
                    other
                } else if self == other {
                    $float::from_bits(self.to_bits() | other.to_bits())
                } else {
                    self + other
                }
            }
        }

        impl Float for $float {
            const EPSILON: Self = $float::EPSILON;

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }

            // Inlined, so that loops over lanes use the vector instructions of the code around them.
            #[inline(always)]
            #[allow(clippy::inline_always)]
            fn sin_cos_lanes<const W: usize>(x: &[Self; W]) -> ([Self; W], [Self; W]) {
                let mut near = true;
                for &x in x {
                    near &= f64::from(x).abs() <= trig::LIMIT;
                }
                let (mut sin, mut cos) = ([0.0; W], [0.0; W]);
                if near {
                    for k in 0..W {
                        let both = trig::$kernel(f64::from(x[k]));
                        (sin[k], cos[k]) = (both.0 as $float, both.1 as $float);
                    }
                } else {
                    for k in 0..W {
                        (sin[k], cos[k]) = Real::sin_cos(x[k]);
                    }
                }
                (sin, cos)
            }
        }
    };
}

float!(f32 sin_cos_single kernel_single);
float!(f64 sin_cos kernel);

#[cfg(test)]
mod tests {
    use super::{Float, Real};

    /// Checks values of a function over both types against the digits of `tests/data/functions.py`.
    fn near(f64_value: f64, f32_value: f32, expected: f64) {
        assert!(
            (f64_value - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(),
            "{f64_value} is not {expected}"
        );
        assert!(
            (f64::from(f32_value) - expected).abs()
                <= 0.5001 * f64::from(f32::EPSILON) * expected.abs(),
            "{f32_value} is not {expected}"
        );
    }

    macro_rules! at {
        ($function:ident($x:expr $(, $y:expr)?), $expected:expr) => {
            near(<f64 as Real>::$function($x $(, $y)?), <f32 as Real>::$function($x $(, $y)?), $expected)
        };
    }

    /// Checks that single precision rounds the result of `f64`, and not each operation.
    #[test]
    fn the_secant_is_rounded_once() {
        for k in -4000_i16..4000 {
            let x = f32::from(k) / 128.0;
            assert_eq!(Real::sech(x), Real::sech(f64::from(x)) as f32, "{x}");
        }
    }

    #[test]
    fn functions_have_their_values() {
        at!(tan(1.25), 3.0095696738628313);
        at!(sinc(1.25, 0), 0.759187695484469);
        at!(sinc(1.25, 1), -0.3550922664713602);
        at!(sinc(1.25, 2), -0.1910400691302926);
        at!(asin(0.625), 0.6751315329370317);
        at!(acos(0.625), 0.895664793857865);
        at!(atan(1.25), 0.8960553845713439);
        at!(atan2(1.0, -2.0), 2.677945044588987);
        at!(atan2(-1.0, -2.0), -2.677945044588987);
        at!(sinh(1.25), 1.6019190803008256);
        at!(cosh(1.25), 1.8884238771610158);
        at!(tanh(1.25), 0.8482836399575129);
        at!(sech(1.25), 0.52954212880604);
        at!(exp(-1.25), 0.2865047968601901);
        at!(ln(1.25), 0.22314355131420976);
        at!(sqrt(1.25), 1.118033988749895);
        at!(powf(1.25, -2.5), 0.5724334022399462);
    }

    #[test]
    fn powers_of_negative_numbers_are_not_numbers() {
        assert!(Real::powf(-2.0_f64, 3.0).is_nan());
        assert!(Real::powf(-2.0_f32, 2.0).is_nan());
        assert!(Real::powf(f64::NAN, 2.0).is_nan());
        assert_eq!(Real::powf(-0.0_f64, 3.0).to_bits(), 0);
        assert_eq!(Real::powf(0.0_f64, 0.0), 1.0);
    }

    #[test]
    fn sign_and_step_are_one_half_sided_at_zero() {
        for zero in [0.0_f64, -0.0] {
            assert_eq!(Real::sign(zero).to_bits(), 0);
            assert_eq!(Real::step(zero), 0.5);
        }
        assert_eq!((Real::sign(5e-324_f64), Real::step(5e-324_f64)), (1.0, 1.0));
        assert_eq!((Real::sign(-5e-324_f64), Real::step(-5e-324_f64)), (-1.0, 0.0));
        assert_eq!((Real::sign(f64::INFINITY), Real::step(f64::NEG_INFINITY)), (1.0, 0.0));
        assert!(Real::sign(f64::NAN).is_nan() && Real::step(f32::NAN).is_nan());
    }

    #[test]
    fn larger_and_smaller_keep_nan_and_the_sign_of_zero() {
        assert_eq!((Real::max(1.0_f64, 2.0), Real::min(1.0_f64, 2.0)), (2.0, 1.0));
        assert_eq!((Real::max(-1.0_f32, -2.0), Real::min(-1.0_f32, -2.0)), (-1.0, -2.0));
        for (a, b) in [(0.0_f64, -0.0), (-0.0, 0.0)] {
            assert_eq!(Real::max(a, b).to_bits(), 0);
            assert_eq!(Real::min(a, b).to_bits(), 1 << 63);
        }
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::INFINITY)] {
            assert!(Real::max(a, b).is_nan() && Real::min(a, b).is_nan());
        }
    }

    #[test]
    fn ratios_of_single_numbers_are_rounded_once() {
        assert_eq!(<f32 as Real>::ratio(1.0, 3.0), 1.0 / 3.0);
        // In single precision 2²⁴ + 1 rounds to 2²⁴.
        assert_eq!(<f32 as Real>::ratio(16777217.0, 2.0), 8388608.0);
        assert_eq!(<f32 as Real>::ratio(50331651.0, 16777217.0), 3.0);
        assert_eq!(<f64 as Real>::ratio(1.0, 3.0), 1.0 / 3.0);
    }

    #[test]
    fn floats_know_their_kind() {
        assert_eq!(
            (<f32 as Real>::from_f64(0.1), Float::to_f64(0.1_f32)),
            (0.1, 0.10000000149011612)
        );
        assert!(Float::is_finite(f32::MAX) && !Float::is_finite(<f32 as Real>::from_f64(1e39)));
        assert!(!Float::is_finite(f64::NAN));
        assert_eq!(
            (<f32 as Float>::EPSILON, <f64 as Float>::EPSILON),
            (f32::EPSILON, f64::EPSILON)
        );
        assert_eq!(
            (<f32 as Real>::pi(), <f64 as Real>::pi()),
            (core::f32::consts::PI, core::f64::consts::PI)
        );
    }
}
