//! Conversions between two-word numbers and decimal digits.

use super::number::DoubleDouble;
use crate::scalar::real::{Float, Real};
use core::fmt;
use core::str::FromStr;

/// The reason for which a text is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// The index of the first byte that does not belong to a number, or the length of the text if
    /// digits are missing at its end.
    pub at: usize,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no number from byte {} on; write digits with a point and an exponent, as in `-1.25e-3`",
            self.at
        )
    }
}

impl core::error::Error for ParseError {}

/// More digits than two words can represent.
const MOST_DIGITS: usize = 36;

impl FromStr for DoubleDouble {
    type Err = ParseError;

    /// Parses digits with an optional sign, point and exponent. The relative error is about 2⁻¹⁰²
    /// (2⁻⁹⁶ beyond 1e±45). Numbers of up to 15 digits without a negative exponent are exact.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let (negative, mut rest) = sign(text);
        let (mut mantissa, mut kept, mut exponent, mut any, mut after_point) =
            (0_u128, 0, 0_i64, false, false);
        while let Some(&byte) = rest.as_bytes().first() {
            match byte {
                b'0'..=b'9' => {
                    any = true;
                    if kept < MOST_DIGITS {
                        mantissa = 10 * mantissa + u128::from(byte - b'0');
                        kept += usize::from(mantissa != 0);
                        exponent -= i64::from(after_point);
                    } else {
                        exponent += i64::from(!after_point);
                    }
                }
                b'.' if !after_point => after_point = true,
                _ => break,
            }
            rest = &rest[1..];
        }
        let error = |rest: &str| ParseError { at: text.len() - rest.len() };
        if !any {
            return Err(error(rest));
        }
        if let Some(power) = rest.strip_prefix(['e', 'E']) {
            let (down, mut digits) = sign(power);
            if !digits.starts_with(|c: char| c.is_ascii_digit()) {
                return Err(error(digits));
            }
            let mut power = 0_i64;
            while let Some(&byte @ b'0'..=b'9') = digits.as_bytes().first() {
                // Greater exponents also result in zero or infinity.
                power = (10 * power + i64::from(byte - b'0')).min(1_000_000);
                digits = &digits[1..];
            }
            exponent += if down { -power } else { power };
            rest = digits;
        }
        if !rest.is_empty() {
            return Err(error(rest));
        }
        let high = mantissa as f64;
        let whole = Self::sum(high, (mantissa as i128 - high as i128) as f64);
        let value = if mantissa == 0 {
            Self::ZERO
        } else {
            times_power_of_ten(whole, exponent.clamp(-2000, 2000) as i32)
        };
        Ok(if negative { -value } else { value })
    }
}

fn sign(text: &str) -> (bool, &str) {
    match text.as_bytes().first() {
        Some(b'-') => (true, &text[1..]),
        Some(b'+') => (false, &text[1..]),
        _ => (false, text),
    }
}

/// Computes `value` · 10^`exponent`.
fn times_power_of_ten(value: DoubleDouble, exponent: i32) -> DoubleDouble {
    let power = |exponent: u32| DoubleDouble::from(10.0).whole_power(exponent);
    let mut left = exponent.unsigned_abs();
    let mut value = value;
    // In portions whose powers are in range.
    while left != 0 {
        let portion = left.min(200);
        value = if 0 < exponent { value * power(portion) } else { value / power(portion) };
        left -= portion;
    }
    value
}

impl fmt::Display for DoubleDouble {
    /// Formats the number with the requested digits after the point, as in `{:.30}`, or with up to
    /// 32 digits without trailing zeros.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.is_finite() {
            return fmt::Display::fmt(&self.to_f64(), f);
        }
        let mut decimal = Decimal::new(self.abs());
        let text = if let Some(precision) = f.precision() {
            decimal.round(decimal.point + precision as i32);
            decimal.fixed(precision)
        } else {
            decimal.round(DIGITS);
            decimal.trim();
            if !(-5..=DIGITS).contains(&decimal.point) {
                return f.pad_integral(!self.negative(), "", &decimal.scientific());
            }
            decimal.fixed((decimal.digits.len() as i32 - decimal.point).max(0) as usize)
        };
        f.pad_integral(!self.negative(), "", &text)
    }
}

impl fmt::LowerExp for DoubleDouble {
    /// Formats the number with the requested digits after the point, as in `{:.30e}`, or with up to
    /// 32 digits without trailing zeros.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.is_finite() {
            return fmt::Display::fmt(&self.to_f64(), f);
        }
        let mut decimal = Decimal::new(self.abs());
        if let Some(precision) = f.precision() {
            decimal.round(precision as i32 + 1);
            decimal.digits.resize(precision + 1, 0);
        } else {
            decimal.round(DIGITS);
            decimal.trim();
        }
        f.pad_integral(!self.negative(), "", &decimal.scientific())
    }
}

/// The number of digits that two words can represent.
const DIGITS: i32 = 32;

impl DoubleDouble {
    fn negative(self) -> bool {
        self.high.is_sign_negative()
    }
}

/// A number 0.d₁d₂d₃… · 10^point.
struct Decimal {
    digits: Vec<u8>,
    point: i32,
}

/// The numbers of 32-bit words before and after the point that suffice for all finite numbers.
const BEFORE: usize = 33;
const AFTER: usize = 34;
const BILLION: u64 = 1_000_000_000;

impl Decimal {
    /// Converts a finite number that is not negative to all of its digits.
    fn new(value: DoubleDouble) -> Self {
        // A fixed-point number with the least significant word first.
        let mut words = [0_u32; AFTER + BEFORE];
        add(&mut words, value.high);
        add(&mut words, value.low);
        let mut groups = Vec::new();
        while words[AFTER..].iter().any(|word| *word != 0) {
            let rest = words[AFTER..].iter_mut().rev().fold(0_u64, |rest, word| {
                let dividend = (rest << 32) | u64::from(*word);
                *word = (dividend / BILLION) as u32;
                dividend % BILLION
            });
            groups.push(rest);
        }
        groups.reverse();
        let whole = groups.len();
        while words[..AFTER].iter().any(|word| *word != 0) {
            let carry = words[..AFTER].iter_mut().fold(0_u64, |carry, word| {
                let product = u64::from(*word) * BILLION + carry;
                *word = product as u32;
                product >> 32
            });
            groups.push(carry);
        }
        let mut digits: Vec<u8> = groups
            .iter()
            .flat_map(|group| (0..9).rev().map(move |i| (group / 10_u64.pow(i) % 10) as u8))
            .collect();
        let zeros = digits.iter().take_while(|digit| **digit == 0).count();
        let point = if zeros == digits.len() { 0 } else { 9 * whole as i32 - zeros as i32 };
        digits.drain(..zeros);
        Self { digits, point }
    }

    /// Rounds to the leading `count` digits.
    fn round(&mut self, count: i32) {
        let Ok(count) = usize::try_from(count) else {
            self.digits.clear();
            return;
        };
        let up = self.digits.get(count).is_some_and(|digit| 5 <= *digit);
        self.digits.truncate(count);
        if up {
            if let Some(last) = self.digits.iter().rposition(|digit| *digit != 9) {
                self.digits[last] += 1;
                self.digits[last + 1..].fill(0);
            } else {
                self.digits.fill(0);
                self.digits.insert(0, 1);
                self.point += 1;
            }
        }
    }

    fn trim(&mut self) {
        while self.digits.last() == Some(&0) {
            self.digits.pop();
        }
    }

    fn digit(&self, index: i32) -> char {
        let digit = usize::try_from(index)
            .ok()
            .and_then(|index| self.digits.get(index))
            .copied()
            .unwrap_or(0);
        char::from(b'0' + digit)
    }

    /// Formats the number with `precision` digits after the point.
    fn fixed(&self, precision: usize) -> String {
        // A number below one has a single zero before the point.
        let zero = (self.point <= 0).then_some('0');
        let before = (0..self.point).map(|i| self.digit(i));
        let after = (0..precision as i32).map(|i| self.digit(self.point + i));
        let point = (precision != 0).then_some('.');
        zero.into_iter().chain(before).chain(point).chain(after).collect()
    }

    fn scientific(&self) -> String {
        let after: String = (1..self.digits.len().max(1) as i32).map(|i| self.digit(i)).collect();
        let point = if after.is_empty() { "" } else { "." };
        let exponent = if self.digits.is_empty() { 0 } else { self.point - 1 };
        format!("{}{point}{after}e{exponent}", self.digit(0))
    }
}

/// Adds `x` to a fixed-point number.
fn add(words: &mut [u32; AFTER + BEFORE], x: f64) {
    let bits = x.abs().to_bits();
    let (biased, fraction) = ((bits >> 52) as usize, bits & ((1 << 52) - 1));
    // The lowest bit of the mantissa is `shift` bits above 2⁻¹⁰⁸⁸, the unit of the least
    // significant word.
    let (mantissa, shift) =
        if biased == 0 { (fraction, 14) } else { (fraction | (1 << 52), biased + 13) };
    let mut wide = u128::from(mantissa) << (shift % 32);
    let mut carry = 0_i64;
    for word in &mut words[shift / 32..] {
        let part = i64::from(wide as u32);
        carry += i64::from(*word) + if x < 0.0 { -part } else { part };
        *word = carry as u32;
        carry >>= 32;
        wide >>= 32;
    }
}
