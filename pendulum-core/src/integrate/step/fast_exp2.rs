//! Logarithms and powers for step control: fast, with six correct digits and the same bits on every
//! machine.

// Loops over lanes are inlined, to be compiled for the vectors of the lanes.
#![allow(clippy::inline_always)]

/// Returns the binary logarithm of x ≥ 0, with an error of about 1e-7; −∞ for zero.
#[inline]
pub(crate) fn log2(x: f64) -> f64 {
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    // Subnormal numbers are scaled up by 2⁵⁴ first.
    let (x, shift) = if x < f64::MIN_POSITIVE { (x * 18014398509481984.0, 54.0) } else { (x, 0.0) };
    let bits = x.to_bits();
    let exponent = ((bits >> 52) as i64 - 1023) as f64;
    let mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | (1023 << 52));
    // ln m = ln √2 + 2 artanh s with s = (m − √2)/(m + √2), |s| ≤ 0.172.
    let s = (mantissa - core::f64::consts::SQRT_2) / (mantissa + core::f64::consts::SQRT_2);
    let s2 = s * s;
    let artanh = s * (1.0 + s2 * (1.0 / 3.0 + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0))));
    exponent - shift + 0.5 + 2.0 * core::f64::consts::LOG2_E * artanh
}

/// Returns 2^y with a relative error of about 2e-7; y is clamped to ±1000.
#[inline]
pub(crate) fn exp2(y: f64) -> f64 {
    let y = y.clamp(-1000.0, 1000.0);
    let whole = (y + 1024.5) as i64 - 1024;
    let z = (y - whole as f64) * core::f64::consts::LN_2;
    // The exponential series; |z| ≤ ln 2 / 2, so that the next term is below 2e-7.
    let even = 1.0 + z * z * (1.0 / 2.0 + z * z * (1.0 / 24.0 + z * z * (1.0 / 720.0)));
    let odd = z * (1.0 + z * z * (1.0 / 6.0 + z * z * (1.0 / 120.0)));
    let fraction = even + odd;
    fraction * f64::from_bits(((whole + 1023) as u64) << 52)
}

/// 2⁵²: the last bit of a number from here to 2⁵³ counts ones.
const WHOLE: f64 = 4503599627370496.0;

/// Returns 2³² (log₂ x + 1023) of a positive number, too small by up to 0.09 · 2³²; zero for zero,
/// 2047 · 2³² for infinity.
#[inline(always)]
pub(crate) fn digits(x: f64) -> f64 {
    // Exponent and mantissa as one number: the mantissa approximates its logarithm.
    f64::from_bits((x.to_bits() >> 20) | WHOLE.to_bits()) - WHOLE
}

/// Returns 2^(y − 1023) with a relative error of up to 0.4 %; y is clamped to 23 … 2023.
#[inline(always)]
pub(crate) fn power(y: f64) -> f64 {
    let y = y.clamp(23.0, 2023.0);
    // The integer part of y, or one less for odd integers. This needs no conversion, which few
    // machines support for vectors.
    let shifted = y + (WHOLE - 0.5);
    let z = y - (shifted - WHOLE);
    // The polynomial is exact at z = 0 and z = 1.
    let fraction = 1.0 + z * (0.6565 + z * 0.3435);
    fraction * f64::from_bits(shifted.to_bits() << 52)
}

#[cfg(test)]
mod tests {
    use super::{digits, exp2, log2, power};

    #[test]
    fn coarse_functions_are_close_to_fine_ones() {
        for k in 1..4000_i32 {
            let x = f64::from(k) * 0.37;
            let error = log2(x) - (digits(x) / 4294967296.0 - 1023.0);
            assert!((-1e-6..0.0861).contains(&error), "log2({x}): {error}");
            let y = f64::from(k - 2000) * 0.137;
            let error = power(y + 1023.0) / exp2(y) - 1.0;
            assert!(error.abs() < 0.004, "2^{y}: {error}");
        }
        assert_eq!((digits(0.0), digits(1.0)), (0.0, 1023.0 * 4294967296.0));
        assert!(power(f64::NEG_INFINITY) < 1e-300 && 1e300 < power(f64::INFINITY));
    }

    #[test]
    fn roots_agree_with_square_roots() {
        for k in -1000..1000_i32 {
            let x = f64::from(k * k + 1) * f64::from_bits(((1023 + k / 2) as u64) << 52);
            let expected = 1.0 / x.sqrt().sqrt().sqrt();
            let measured = exp2(-0.125 * log2(x));
            assert!(
                (measured / expected - 1.0).abs() < 1e-6,
                "x = {x}: {measured}, not {expected}"
            );
        }
        assert!((exp2(0.5 * log2(5e-324)) / 2.2227587494850775e-162 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn limits() {
        assert_eq!(log2(0.0), f64::NEG_INFINITY);
        assert_eq!(exp2(0.0), 1.0);
        assert!(1e300 < exp2(-0.1 * log2(0.0)));
        assert!(exp2(-0.2 * log2(f64::MAX)) < 1e-60);
        assert!(exp2(f64::NEG_INFINITY) < 1e-300);
    }
}
