//! Sums and products with their rounding errors.

// These functions are compiled for several instruction sets, for steps and lanes.
#![allow(clippy::inline_always)]

use crate::scalar::real::Real;

/// Computes a + b and its rounding error, exactly for all magnitudes (Knuth 1969, two-sum).
#[inline(always)]
pub(crate) fn two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// Computes a sum and its rounding error if |high| ≥ |low| or `high` is zero (Dekker 1971).
#[inline(always)]
pub(crate) fn ordered_sum<T: Real>(high: T, low: T) -> (T, T) {
    let sum = high + low;
    (sum, low - (sum - high))
}

/// Computes a · b and its rounding error from the factors and their halves (Dekker 1971).
///
/// The caller splits the factors, because the split depends on the scalar and on the magnitudes.
#[inline(always)]
pub(crate) fn two_product<T: Real>(
    (a, [a_high, a_low]): (T, [T; 2]),
    (b, [b_high, b_low]): (T, [T; 2]),
) -> (T, T) {
    let product = a * b;
    (product, ((a_high * b_high - product) + (a_high * b_low + a_low * b_high)) + a_low * b_low)
}

#[cfg(test)]
mod tests {
    use super::{ordered_sum, two_product, two_sum};
    use crate::scalar::Octet;

    #[test]
    fn nothing_is_left_off() {
        let tiny = f64::EPSILON * f64::EPSILON;
        for (a, b) in [(1.0, tiny), (tiny, 1.0), (-1.0, tiny)] {
            assert_eq!(two_sum(a, b), if a == tiny { (b, a) } else { (a, b) });
        }
        assert_eq!(two_sum(1.0_f32, 1e-10), (1.0, 1e-10));
        assert_eq!(two_sum(Octet([1e20; 8]), Octet([3.0; 8])), (Octet([1e20; 8]), Octet([3.0; 8])));
        assert_eq!(
            ordered_sum(1.0, 0.75 * f64::EPSILON),
            (1.0 + f64::EPSILON, -0.25 * f64::EPSILON)
        );
        // (1 + ε)² = 1 + 2ε + ε².
        let a = (1.0 + f64::EPSILON, [1.0, f64::EPSILON]);
        assert_eq!(two_product(a, a), (1.0 + 2.0 * f64::EPSILON, tiny));
    }
}
