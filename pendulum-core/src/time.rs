//! Time in two words, so that steps of 1/60 s are still resolved accurately after a year.

// Loops over lanes must be compiled with the vector instructions of their callers.
#![allow(clippy::inline_always)]

use crate::scalar::exact::{ordered_sum, two_sum};
use core::fmt;
use core::ops::{Add, AddAssign};

/// A time in seconds, `hi + lo` with |lo| at most half a unit in the last place of `hi`.
///
/// Integrators add their steps without losing low digits. Motions evaluate differences to the times
/// of their keys, which are accurate to the low digits.
// The derived order compares the high words first, and the low words only if the high words are
// equal.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Time {
    hi: f64,
    lo: f64,
}

impl Time {
    /// Creates a time from one word, exactly.
    pub const fn new(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// Creates a time from the words returned by [`to_f64`](Self::to_f64) and [`low`](Self::low).
    pub(crate) const fn from_words(hi: f64, lo: f64) -> Self {
        Self { hi, lo }
    }

    /// Returns the nearest `f64`, the high word.
    #[inline(always)]
    pub const fn to_f64(self) -> f64 {
        self.hi
    }

    /// Returns the low word, the remainder after `to_f64`.
    #[inline(always)]
    pub const fn low(self) -> f64 {
        self.lo
    }

    /// Returns `self - origin`, rounded once.
    #[inline(always)]
    pub fn since(self, origin: f64) -> f64 {
        // By Sterbenz's lemma the first difference is exact close to the origin.
        (self.hi - origin) + self.lo
    }
}

/// Formats the nearest `f64` with the given format.
impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.hi.fmt(f)
    }
}

impl From<f64> for Time {
    fn from(hi: f64) -> Self {
        Self::new(hi)
    }
}

impl Add<f64> for Time {
    type Output = Self;

    #[inline(always)]
    fn add(self, step: f64) -> Self {
        let (sum, error) = two_sum(self.hi, step);
        let (hi, lo) = ordered_sum(sum, self.lo + error);
        Self { hi, lo }
    }
}

impl AddAssign<f64> for Time {
    fn add_assign(&mut self, step: f64) {
        *self = *self + step;
    }
}

#[cfg(test)]
mod tests {
    use super::Time;

    #[test]
    fn sixtieths_add_up_after_thirty_years() {
        let mut time = Time::new(1e9);
        for _ in 0..600 {
            time += 1.0 / 60.0;
        }
        // 600 · fl(1/60) is 10 within 600 half-units in the last place of 1/60.
        assert!((time.since(1e9) - 10.0).abs() < 600.0 * 1.8e-18 + 2e-15);
    }

    #[test]
    fn times_are_ordered_by_both_words_and_shown_as_numbers() {
        let (now, later) = (Time::new(1e15), Time::new(1e15) + 1e-3);
        assert!(now < later && later < now + 1.0 && now.to_f64() == later.to_f64());
        assert_eq!(format!("{:.2}", Time::new(0.1) + 0.025), "0.12");
    }

    #[test]
    fn low_word_stays_below_half_a_unit() {
        let time = Time::new(1e15) + 0.3;
        assert_eq!(time.to_f64(), 1e15 + 0.3);
        assert!(time.low().abs() <= 0.0625);
        assert_eq!(time.since(1e15), 0.3);
    }
}
