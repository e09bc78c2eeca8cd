//! Compensated summation of the state.

#![allow(clippy::inline_always)]

use crate::scalar::exact::{two_product, two_sum};
use crate::scalar::{Float, Real};

/// `N` numbers that add small increments without losing their low digits.
///
/// Each number is stored as `high + low`, where |low| is at most about half a unit in the last
/// place of `high`. The sum is that of Kahan (1965) with the two-sum of Knuth (1969), which is
/// exact for any magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Compensated<T, const N: usize> {
    /// The numbers, rounded to one word.
    pub high: [T; N],
    /// The rounding errors of `high`.
    pub low: [T; N],
}

impl<T: Real, const N: usize> Compensated<T, N> {
    /// Creates the numbers `high`, with low words of zero.
    #[inline]
    pub fn new(high: [T; N]) -> Self {
        Self { high, low: [T::from_f64(0.0); N] }
    }

    /// Adds `factor · increment`.
    #[inline(always)]
    pub fn add(&mut self, factor: T, increment: &[T; N]) {
        for i in 0..N {
            (self.high[i], self.low[i]) =
                two_sum(self.high[i], factor * increment[i] + self.low[i]);
        }
    }

    /// Adds `increment` to the number with this index.
    #[inline(always)]
    pub(crate) fn add_one(&mut self, index: usize, increment: T) {
        (self.high[index], self.low[index]) =
            two_sum(self.high[index], increment + self.low[index]);
    }

    /// Adds `a · b + rest` to the number with this index, using both words of the product (Veltkamp
    /// 1968, Dekker 1971). The [`splitter`] of the scalar splits the factors.
    #[inline(always)]
    pub(crate) fn add_split_product(&mut self, index: usize, a: T, b: T, rest: T, splitter: T) {
        let (product, error) = two_product((a, halves(a, splitter)), (b, halves(b, splitter)));
        let (sum, left) = two_sum(self.high[index], product);
        let (sum, rounded) = two_sum(sum, rest + ((left + error) + self.low[index]));
        (self.high[index], self.low[index]) = (sum, rounded);
    }

    /// Returns `self - earlier`, including the low words; exact if the two are close.
    #[inline]
    pub fn since(&self, earlier: &Self) -> [T; N] {
        core::array::from_fn(|i| (self.high[i] - earlier.high[i]) + (self.low[i] - earlier.low[i]))
    }
}

impl<T: Float, const N: usize> Compensated<T, N> {
    /// Moves the numbers to `high`. Those that are there already keep their low words.
    pub(crate) fn jump(&mut self, high: &[T; N]) {
        for i in 0..N {
            if high[i] != self.high[i] {
                (self.high[i], self.low[i]) = (high[i], T::from_f64(0.0));
            }
        }
    }

    /// Adds `a · b + rest` to the number with this index, using both words of the product.
    #[inline(always)]
    pub fn add_product(&mut self, index: usize, a: T, b: T, rest: T) {
        self.add_split_product(index, a, b, rest, splitter::<T>());
    }

    /// Adds `factor · (high + low)`, using both words of the products of the high words.
    #[inline]
    pub fn add_both(&mut self, factor: T, high: &[T; N], low: &[T; N]) {
        for i in 0..N {
            self.add_product(i, factor, high[i], factor * low[i]);
        }
    }

    /// Returns `true` if all numbers are finite.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.high.iter().all(|x| x.is_finite())
    }
}

/// Returns 2^⌈d/2⌉ + 1 for a scalar with d binary digits.
#[inline(always)]
pub(crate) fn splitter<T: Float>() -> T {
    // The exponent of the machine epsilon gives the number of digits.
    let digits = 1024 - (T::EPSILON.to_f64().to_bits() >> 52);
    T::from_f64(f64::from_bits((1023 + digits.div_ceil(2)) << 52) + 1.0)
}

/// Splits a number into two numbers with half the digits each.
#[inline(always)]
fn halves<T: Real>(x: T, splitter: T) -> [T; 2] {
    let scaled = splitter * x;
    let high = scaled - (scaled - x);
    [high, x - high]
}

#[cfg(test)]
mod tests {
    use super::Compensated;

    #[test]
    fn ten_million_tenths_of_a_single() {
        let mut sum = Compensated::new([0.0_f32]);
        for _ in 0..10_000_000 {
            sum.add(0.5, &[0.2]);
        }
        // fl32(0.1) · 10⁷ to the last digit; the plain sum is off by 9 %.
        assert_eq!(sum.high[0], (f64::from(0.1_f32) * 1e7) as f32);
    }

    #[test]
    fn an_increment_larger_than_the_sum_loses_nothing() {
        let mut sum = Compensated::new([1e-20_f64]);
        sum.add(1.0, &[1.0]);
        assert_eq!((sum.high, sum.low), ([1.0], [1e-20]));
    }

    #[test]
    fn products_keep_their_low_word() {
        // (1 + ε)² = 1 + 2ε + ε².
        let a = 1.0 + f64::EPSILON;
        let mut sum = Compensated::new([2.0]);
        sum.add_product(0, a, a, 0.0);
        assert_eq!(
            (sum.high, sum.low),
            ([3.0 + 2.0 * f64::EPSILON], [f64::EPSILON * f64::EPSILON])
        );
        let a = 1.0 + f32::EPSILON;
        let mut sum = Compensated::new([2.0_f32]);
        sum.add_product(0, a, a, 0.0);
        assert_eq!(
            (sum.high, sum.low),
            ([3.0 + 2.0 * f32::EPSILON], [f32::EPSILON * f32::EPSILON])
        );
    }

    #[test]
    fn differences_see_the_low_words() {
        let start = Compensated::new([1.0_f64]);
        let mut end = start;
        end.add(1.0, &[1e-17]);
        assert_eq!(end.high, start.high);
        assert_eq!(end.since(&start), [1e-17]);
    }
}
