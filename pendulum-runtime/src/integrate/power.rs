//! Powers for step control: good to six digits, quick, and the same bits everywhere.

/// x^p for x ≥ 0 and moderate p, with a relative error of about 1e-6.
///
/// Zero and infinity give what they should; a number that is not a number gives itself.
pub(crate) fn power(x: f64, p: f64) -> f64 {
    if 0.0 < x && x < f64::INFINITY {
        exp2(p * log2(x))
    } else if x == 0.0 {
        if p < 0.0 { f64::INFINITY } else { 0.0 }
    } else if x.is_nan() {
        x
    } else if p < 0.0 {
        0.0
    } else {
        f64::INFINITY
    }
}

/// The binary logarithm of a positive finite number.
fn log2(x: f64) -> f64 {
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

/// 2^y within the range of normal numbers, clamped to its ends.
fn exp2(y: f64) -> f64 {
    let y = y.clamp(-1000.0, 1000.0);
    let whole = (y + 1024.5) as i64 - 1024;
    let z = (y - whole as f64) * core::f64::consts::LN_2;
    // |z| ≤ ln 2 / 2: the next term is below 2.4e-6 / 7.
    let fraction = 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0)))));
    fraction * f64::from_bits(((whole + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::power;

    #[test]
    fn roots_agree_with_square_roots() {
        for k in -1000..1000_i32 {
            let x = f64::from(k * k + 1) * f64::from_bits(((1023 + k / 2) as u64) << 52);
            let expected = 1.0 / x.sqrt().sqrt().sqrt();
            let measured = power(x, -0.125);
            assert!((measured / expected - 1.0).abs() < 1e-6, "x = {x}: {measured}, not {expected}");
        }
        assert!((power(5e-324, 0.5) / 2.2227587494850775e-162 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn limits() {
        assert_eq!(power(0.0, -0.2), f64::INFINITY);
        assert_eq!(power(0.0, 0.2), 0.0);
        assert_eq!(power(f64::INFINITY, -0.2), 0.0);
        assert!(power(f64::NAN, -0.2).is_nan());
        assert_eq!(power(7.0, 0.0), 1.0);
    }
}
