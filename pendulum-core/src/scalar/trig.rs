//! Sine and cosine with only additions and multiplications, so that they have the same bits on
//! every machine, for single numbers and for lanes of vectors.
//!
//! Argument reduction after Cody and Waite (1980), here with an exact low word. Kernels and their
//! coefficients after FDLIBM (Sun Microsystems, 1993), evaluated after Estrin (1960). The error is
//! below one unit in the last place (at most 0.82 among six million arguments). For `f32`, whose
//! kernel has fewer terms, it is at most 0.501.

/// The greatest argument of [`kernel`]: 2²⁰ π/2, rounded down.
pub(crate) const LIMIT: f64 = 1647099.3291652855;

/// The greatest argument without reduction: π/4, rounded down.
const FIRST: f64 = 0.7853981633974482;

const TWO_OVER_PI: f64 = core::f64::consts::FRAC_2_PI;
/// π/2 in three parts of 33 bits, whose products with integers up to 2²⁰ are exact, and the
/// remainder.
const PI_2_A: f64 = f64::from_bits(0x3FF921FB54400000);
const PI_2_B: f64 = f64::from_bits(0x3DD0B4611A600000);
const PI_2_C: f64 = f64::from_bits(0x3BA3198A2E000000);
const PI_2_D: f64 = f64::from_bits(0x397B839A252049C1);
/// Adding 2⁵² rounds to an integer, which is then in the low bits.
const ROUND: f64 = 4503599627370496.0;
const SIGN: u64 = 1 << 63;

/// sin x ≈ x + x³ (S₁ + S₂ x² + …) on [−π/4, π/4], within 2⁻⁵⁸.
const S1: f64 = f64::from_bits(0xBFC5555555555549);
const S2: f64 = f64::from_bits(0x3F8111111110F8A6);
const S3: f64 = f64::from_bits(0xBF2A01A019C161D5);
const S4: f64 = f64::from_bits(0x3EC71DE357B1FE7D);
const S5: f64 = f64::from_bits(0xBE5AE5E68A2B9CEB);
const S6: f64 = f64::from_bits(0x3DE5D93A5ACFD57C);

/// cos x ≈ 1 − x²/2 + x⁴ (C₁ + C₂ x² + …) on [−π/4, π/4], within 2⁻⁵⁸.
const C1: f64 = f64::from_bits(0x3FA555555555554C);
const C2: f64 = f64::from_bits(0xBF56C16C16C15177);
const C3: f64 = f64::from_bits(0x3EFA01A019CB1590);
const C4: f64 = f64::from_bits(0xBE927E4F809C52AD);
const C5: f64 = f64::from_bits(0x3E21EE9EBDB4B1C4);
const C6: f64 = f64::from_bits(0xBDA8FAE9BE8838D4);

/// Coefficients of sine and cosine for single precision, within 2⁻³⁷ and 2⁻³⁴ (FreeBSD's msun,
/// Evans 2004).
const SINGLE_S: [f64; 4] =
    [-0.16666666641626524, 0.008333329385889463, -0.00019839334836096632, 2.718311493989822e-06];
const SINGLE_C: [f64; 4] =
    [-0.499999997251031, 0.04166662332373906, -0.001388676377460993, 2.439044879627741e-05];

/// Computes sine and cosine; NaN unless `x` is finite.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let magnitude = x.abs();
    if magnitude <= FIRST {
        // The same computation as in `kernel`, without the latency of finding k = 0.
        let (sin, cos) = polynomials(magnitude, 0.0);
        (sin.copysign(x), cos)
    } else if magnitude <= LIMIT {
        kernel(x)
    } else {
        far(x)
    }
}

/// Computes sine and cosine for |x| up to [`LIMIT`] without branches; beyond the limit the results
/// are meaningless.
///
/// The compiler vectorizes loops over lanes of an array, with the same bits.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn kernel(x: f64) -> (f64, f64) {
    let (quadrant, r, low) = reduce(x.abs());
    let (sin, cos) = polynomials(r, low);
    turned(x, quadrant, sin, cos)
}

/// Computes sine and cosine in single precision; NaN unless `x` is finite.
#[inline]
pub(crate) fn sin_cos_single(x: f32) -> (f32, f32) {
    let x = f64::from(x);
    let (sin, cos) = if x.abs() <= LIMIT { kernel_single(x) } else { far(x) };
    (sin as f32, cos as f32)
}

/// Computes [`kernel`] with the accuracy of single precision: within 2⁻³³ if `x` is an `f32`.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn kernel_single(x: f64) -> (f64, f64) {
    let magnitude = x.abs();
    let rounded = magnitude * TWO_OVER_PI + ROUND;
    let k = rounded - ROUND;
    // No `f32` up to the limit is closer to a multiple of π/2 than about 1e-8, so one word
    // suffices.
    let r = (magnitude - k * PI_2_A) - (k * PI_2_B + k * PI_2_C);
    let z = r * r;
    let (zz, rz) = (z * z, r * z);
    let sin =
        (r + rz * (SINGLE_S[0] + z * SINGLE_S[1])) + (rz * zz) * (SINGLE_S[2] + z * SINGLE_S[3]);
    let cos =
        ((1.0 + z * SINGLE_C[0]) + zz * SINGLE_C[1]) + (zz * z) * (SINGLE_C[2] + z * SINGLE_C[3]);
    turned(x, rounded.to_bits(), sin, cos)
}

/// Returns sine and cosine of `x` from those of |x| reduced by `quadrant` quarter turns.
#[inline(always)]
#[allow(clippy::inline_always)]
fn turned(x: f64, quadrant: u64, sin: f64, cos: f64) -> (f64, f64) {
    // Odd quadrants swap sine and cosine. The sine is negative in the upper two quadrants, the
    // cosine in the middle two.
    let swap = (quadrant & 1).wrapping_neg();
    let change = (sin.to_bits() ^ cos.to_bits()) & swap;
    let sin_sign = ((quadrant & 2) << 62) ^ (x.to_bits() & SIGN);
    let cos_sign = ((quadrant + 1) & 2) << 62;
    (
        f64::from_bits((sin.to_bits() ^ change) ^ sin_sign),
        f64::from_bits((cos.to_bits() ^ change) ^ cos_sign),
    )
}

/// Returns the integer k nearest to x/(π/2) in the low bits, and x − k π/2 in two words; `x` must
/// not be negative.
#[inline(always)]
#[allow(clippy::inline_always)]
fn reduce(x: f64) -> (u64, f64, f64) {
    let rounded = x * TWO_OVER_PI + ROUND;
    let k = rounded - ROUND;
    let b = k * PI_2_B;
    let c = k * PI_2_C;
    let bc = b + c;
    let near = x - k * PI_2_A;
    let r = near - bc;
    // Two-sums: every difference is exact, so the low word has full accuracy even if `r` is close
    // to zero.
    let part = r - near;
    let low = (near - (r - part)) - ((bc + part) + ((c - (bc - b)) + k * PI_2_D));
    (rounded.to_bits(), r, low)
}

/// Computes sin(r + low) and cos(r + low) for |r| up to π/4, to first order in `low`.
#[inline(always)]
#[allow(clippy::inline_always)]
fn polynomials(r: f64, low: f64) -> (f64, f64) {
    let z = r * r;
    let zz = z * z;
    let rz = r * z;
    let half = 0.5 * z;
    let main = 1.0 - half;
    let rest = ((1.0 - main) - half) - r * low;
    let sin = (rz * (S1 + z * S2) + low * main) + (rz * zz) * ((S3 + z * S4) + zz * (S5 + z * S6));
    let cos = (zz * (C1 + z * C2) + rest) + (zz * zz) * ((C3 + z * C4) + zz * (C5 + z * C6));
    (r + sin, main + cos)
}

/// Computes sine and cosine beyond [`LIMIT`].
#[cold]
#[inline(never)]
fn far(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

#[cfg(test)]
mod tests {
    use super::{FIRST, LIMIT, far, kernel, kernel_single, sin_cos, sin_cos_single};

    fn bits((sin, cos): (f64, f64)) -> (u64, u64) {
        (sin.to_bits(), cos.to_bits())
    }

    #[test]
    fn short_cut_has_the_bits_of_the_kernel() {
        for index in 0..100_000_u64 {
            // The last hundred thousand floats up to FIRST, and a sweep of its whole range.
            for x in [
                f64::from_bits(FIRST.to_bits() - index),
                FIRST * index as f64 * 1e-5,
                1e-300 * index as f64,
            ] {
                assert_eq!(bits(sin_cos(x)), bits(kernel(x)), "{x:e}");
                assert_eq!(bits(sin_cos(-x)), bits(kernel(-x)), "{x:e}");
            }
        }
    }

    #[test]
    fn both_sides_of_the_limits_agree() {
        for limit in [FIRST, LIMIT] {
            for x in [limit.next_down(), limit, limit.next_up()] {
                let (ours, theirs) = (sin_cos(x), far(x));
                assert!(
                    (ours.0 - theirs.0).abs() <= 1.2e-16 && (ours.1 - theirs.1).abs() <= 1.2e-16,
                    "{x:e}"
                );
            }
        }
        assert_eq!(bits(sin_cos(LIMIT)), bits(kernel(LIMIT)));
        assert_eq!(bits(sin_cos(LIMIT.next_up())), bits(far(LIMIT.next_up())));
    }

    #[test]
    fn single_precision_is_next_to_correctly_rounded() {
        let mut worst = 0.0_f64;
        let mut check = |x: f32| {
            let (exact, found) = (sin_cos(f64::from(x)), sin_cos_single(x));
            for (exact, found) in [(exact.0, found.0), (exact.1, found.1)] {
                let ulp = f64::from(found.abs().next_up() - found.abs());
                worst = worst.max((f64::from(found) - exact).abs() / ulp);
            }
        };
        // All magnitudes, and the neighbours of the multiples of π/2.
        let mut seed = 1_u64;
        for _ in 0..400_000 {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let exponent = (seed >> 40) % 42;
            let mantissa = f32::from_bits(0x3F80_0000 | ((seed >> 9) as u32 & 0x7F_FFFF));
            check(mantissa * 2f32.powi(exponent as i32 - 22));
        }
        for k in 0..1_048_576 {
            let x = (f64::from(k) * core::f64::consts::FRAC_PI_2) as f32;
            for x in [x.next_down(), x, x.next_up()] {
                check(x);
                check(-x);
            }
        }
        assert!(worst <= 0.501, "{worst}");
        assert_eq!(sin_cos_single(-0.0).0.to_bits(), (-0.0_f32).to_bits());
        assert!(kernel_single(1.0).0 - kernel(1.0).0 != 0.0);
    }

    #[test]
    fn lanes_have_the_bits_of_single_numbers() {
        let mut x = [0.0; 64];
        for (index, x) in x.iter_mut().enumerate() {
            *x = (index as f64 - 31.5) * 0.37;
        }
        let mut lanes = [(0.0, 0.0); 64];
        for index in 0..64 {
            lanes[index] = kernel(x[index]);
        }
        for index in 0..64 {
            assert_eq!(bits(lanes[index]), bits(sin_cos(core::hint::black_box(x[index]))));
        }
    }
}
