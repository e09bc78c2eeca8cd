//! Compensated summation of the state.

use crate::real::Float;

/// `N` numbers to which small increments are added without losing their low digits.
///
/// Each is kept as `high + low`, where |low| is at most about half a unit in the last place of `high`: the sum of Kahan (1965), with the
/// two-sum of Knuth (1969) in it, which is exact whatever the magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum<T, const N: usize> {
    /// The numbers as everybody else sees them.
    pub high: [T; N],
    /// What rounding has left off.
    pub low: [T; N],
}

impl<T: Float, const N: usize> Sum<T, N> {
    /// The numbers `high`, exactly.
    pub fn new(high: [T; N]) -> Self {
        Self { high, low: [T::from_f64(0.0); N] }
    }

    /// Adds `factor · increment`.
    #[inline]
    pub fn add(&mut self, factor: T, increment: &[T; N]) {
        for i in 0..N {
            let y = self.high[i];
            let d = factor * increment[i] + self.low[i];
            let sum = y + d;
            let part = sum - y;
            self.high[i] = sum;
            self.low[i] = (y - (sum - part)) + (d - part);
        }
    }

    /// `self - earlier`, with the low words: exact where the two are close.
    #[inline]
    pub fn since(&self, earlier: &Self) -> [T; N] {
        core::array::from_fn(|i| (self.high[i] - earlier.high[i]) + (self.low[i] - earlier.low[i]))
    }

    /// Whether all numbers are finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.high.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn ten_million_tenths_of_a_single() {
        let mut sum = Sum::new([0.0_f32]);
        for _ in 0..10_000_000 {
            sum.add(0.5, &[0.2]);
        }
        // fl32(0.1) · 10⁷ to the last digit; the plain sum is off by 9 %.
        assert_eq!(sum.high[0], (f64::from(0.1_f32) * 1e7) as f32);
    }

    #[test]
    fn an_increment_larger_than_the_sum_loses_nothing() {
        let mut sum = Sum::new([1e-20_f64]);
        sum.add(1.0, &[1.0]);
        assert_eq!((sum.high, sum.low), ([1.0], [1e-20]));
    }

    #[test]
    fn differences_see_the_low_words() {
        let start = Sum::new([1.0_f64]);
        let mut end = start;
        end.add(1.0, &[1e-17]);
        assert_eq!(end.high, start.high);
        assert_eq!(end.since(&start), [1e-17]);
    }
}
