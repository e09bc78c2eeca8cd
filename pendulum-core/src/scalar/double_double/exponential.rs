//! The exponential function, the logarithm, and functions based on them.

use super::number::{DoubleDouble, power_of_two, series};
use crate::scalar::real::{Float, Real};

/// ln 2 in two parts of 32 bits, whose products with small integers are exact, and the remainder.
const LN_2_A: f64 = f64::from_bits(0x3FE62E42FEE00000);
const LN_2_B: f64 = f64::from_bits(0x3DEA39EF35600000);
const LN_2_C: DoubleDouble = DoubleDouble::words(4.275175589747649e-20, -9.89608398339473e-37);

/// 1/2!, 1/3!, ….
const FACTORIALS: [DoubleDouble; 6] = [
    DoubleDouble::words(0.5, 0.0),
    DoubleDouble::words(0.16666666666666666, 9.25185853854297e-18),
    DoubleDouble::words(0.041666666666666664, 2.3129646346357427e-18),
    DoubleDouble::words(0.008333333333333333, 1.1564823173178714e-19),
    DoubleDouble::words(0.001388888888888889, -5.300543954373577e-20),
    DoubleDouble::words(0.0001984126984126984, 1.7209558293420705e-22),
];
/// The coefficients after `FACTORIALS`.
const TAIL: [f64; 8] = [
    2.48015873015873e-05,
    2.7557319223985893e-06,
    2.755731922398589e-07,
    2.505210838544172e-08,
    2.08767569878681e-09,
    1.6059043836821613e-10,
    1.1470745597729725e-11,
    7.647163731819816e-13,
];

/// Computes eˣ.
pub(super) fn exp(x: DoubleDouble) -> DoubleDouble {
    if let Some(limit) = limit(x) {
        return limit;
    }
    let (k, part) = reduced(x);
    scaled(DoubleDouble::ONE + part, k)
}

/// Computes eˣ − 1 without cancellation near zero.
pub(super) fn exp_minus_one(x: DoubleDouble) -> DoubleDouble {
    if let Some(limit) = limit(x) {
        return limit - DoubleDouble::ONE;
    }
    if x.high.abs() < power_of_two(-200) {
        // x²/2 is negligible, and `x` scaled down could underflow.
        return x;
    }
    let (k, part) = reduced(x);
    if k == 0 { part } else { scaled(DoubleDouble::ONE + part, k) - DoubleDouble::ONE }
}

/// Returns the exponential function if it is infinite, zero or NaN.
fn limit(x: DoubleDouble) -> Option<DoubleDouble> {
    if x.high.is_nan() {
        Some(DoubleDouble::NAN)
    } else if 710.0 < x.high {
        Some(f64::INFINITY.into())
    } else if x.high < -746.0 {
        Some(DoubleDouble::ZERO)
    } else {
        None
    }
}

/// Returns an integer k and eʳ − 1 with x = k ln 2 + r and |r| ≤ ln 2 / 2.
fn reduced(x: DoubleDouble) -> (i32, DoubleDouble) {
    let k = (x.high * core::f64::consts::LOG2_E).round_ties_even();
    let r = x.plus(-k * LN_2_A).plus(-k * LN_2_B) - LN_2_C.times(k);
    // The series at r/32, followed by five times e²ʳ − 1 = (eʳ − 1)(eʳ + 1).
    let s = r.scaled(1.0 / 32.0);
    let mut part = s + s * s * series(s, &FACTORIALS, &TAIL);
    for _ in 0..5 {
        part = part.scaled(2.0) + part * part;
    }
    (k as i32, part)
}

/// Computes `x` · 2ᵏ; 2ᵏ itself may be out of range.
fn scaled(x: DoubleDouble, k: i32) -> DoubleDouble {
    let half = k / 2;
    x.scaled(power_of_two(half)).scaled(power_of_two(k - half))
}

/// Computes the natural logarithm: k ln 2 + ln m, with ln m in one word improved to two words by
/// one step of Halley's method.
pub(super) fn ln(x: DoubleDouble) -> DoubleDouble {
    if !(0.0 < x.high && x.high < f64::INFINITY) {
        return libm::log(x.high).into();
    }
    let (x, shift) =
        if x.high < f64::MIN_POSITIVE { (x.scaled(power_of_two(100)), -100) } else { (x, 0) };
    let exponent = (x.high.to_bits() >> 52) as i32 - 1023;
    // m is in [√½, √2], so that the sum has no cancellation.
    let k = if core::f64::consts::SQRT_2 < f64::from_bits((x.high.to_bits() & MANTISSA) | ONE) {
        exponent + 1
    } else {
        exponent
    };
    let fraction = scaled(x, -k) - DoubleDouble::ONE;
    let guess = libm::log(fraction.plus(1.0).high);
    let power = exp_minus_one(guess.into());
    let correction = (fraction - power).scaled(2.0) / (power + fraction).plus(2.0);
    let k = f64::from(k + shift);
    LN_2_C.times(k) + correction.plus(guess).plus(k * LN_2_B).plus(k * LN_2_A)
}

const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 1023 << 52;

/// Computes the hyperbolic sine.
pub(super) fn sinh(x: DoubleDouble) -> DoubleDouble {
    if 40.0 < x.high.abs() {
        let half = exp(x.abs().scaled(0.5));
        return half * half.scaled(0.5) * x.sign();
    }
    let part = exp_minus_one(x.abs());
    (part + part / part.plus(1.0)).scaled(0.5) * x.sign()
}

/// Computes the hyperbolic cosine.
pub(super) fn cosh(x: DoubleDouble) -> DoubleDouble {
    if 40.0 < x.high.abs() {
        let half = exp(x.abs().scaled(0.5));
        return half * half.scaled(0.5);
    }
    let power = exp(x);
    (power + DoubleDouble::ONE / power).scaled(0.5)
}

/// Computes the hyperbolic tangent.
pub(super) fn tanh(x: DoubleDouble) -> DoubleDouble {
    if 40.0 < x.high.abs() {
        return x.sign();
    }
    let part = exp_minus_one(x.scaled(2.0));
    part / part.plus(2.0)
}

/// Raises `base` to a real power: by multiplications and a root if twice the exponent is a small
/// integer, otherwise as e^(y ln x).
pub(super) fn powf(base: DoubleDouble, exponent: DoubleDouble) -> DoubleDouble {
    if base.high < 0.0 {
        return DoubleDouble::NAN;
    }
    if exponent.high == 0.0 || base == DoubleDouble::ONE {
        return DoubleDouble::ONE;
    }
    if base.high.is_nan() || exponent.high.is_nan() {
        return DoubleDouble::NAN;
    }
    let twice = exponent.scaled(2.0);
    if twice.low == 0.0
        && twice.high.abs() <= 32.0
        && twice.high == twice.high.round_ties_even()
        && base.high < f64::INFINITY
    {
        let count = twice.high.abs() as u32;
        let root = if count % 2 == 1 { base.abs().sqrt() } else { DoubleDouble::ONE };
        let power = base.abs().whole_power(count / 2) * root;
        // If the power is out of range, its inverse may still be in range.
        if 0.0 <= twice.high {
            return power;
        }
        if power.high < f64::INFINITY && power_of_two(-900) < power.high {
            return DoubleDouble::ONE / power;
        }
    }
    if base.high == 0.0 || !base.is_finite() || !exponent.is_finite() {
        return libm::pow(base.high.abs(), exponent.high).into();
    }
    exp(exponent * ln(base))
}
