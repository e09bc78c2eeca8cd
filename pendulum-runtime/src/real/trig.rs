//! Sine and cosine of `f64` from nothing but additions and products, so that they have the same bits on every machine, alone
//! and in a lane of a vector.
//!
//! Argument reduction after Cody and Waite (1980), here with an exact low word; kernels after FDLIBM (Sun Microsystems, 1993),
//! whose coefficients these are, evaluated after Estrin (1960). The error is below one unit
//! in the last place (at most 0.82 among six million arguments).

/// Up to this magnitude, 2²⁰ π/2 rounded down, [`kernel`] is right.
pub(crate) const LIMIT: f64 = 1647099.3291652855;

/// Up to this magnitude, π/4 rounded down, nothing needs to be taken off.
const FIRST: f64 = 0.7853981633974482;

const TWO_OVER_PI: f64 = core::f64::consts::FRAC_2_PI;
/// π/2 in three parts of 33 bits, whose product with an integer up to 2²⁰ is exact, and the rest.
const PI_2_A: f64 = f64::from_bits(0x3FF921FB54400000);
const PI_2_B: f64 = f64::from_bits(0x3DD0B4611A600000);
const PI_2_C: f64 = f64::from_bits(0x3BA3198A2E000000);
const PI_2_D: f64 = f64::from_bits(0x397B839A252049C1);
/// Adding 2⁵² rounds to an integer, which then stands in the low bits.
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

/// Sine and cosine; NaN unless `x` is finite.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let magnitude = x.abs();
    if magnitude <= FIRST {
        // What the kernel does here, without waiting for k = 0.
        let (sin, cos) = polynomials(magnitude, 0.0);
        (sin.copysign(x), cos)
    } else if magnitude <= LIMIT {
        kernel(x)
    } else {
        far(x)
    }
}

/// Sine and cosine for |x| up to [`LIMIT`], without a branch; beyond it the result means nothing.
///
/// In a loop over the lanes of an array the compiler makes vector code of it, with the same bits.
#[inline(always)]
#[allow(clippy::inline_always)]
pub(crate) fn kernel(x: f64) -> (f64, f64) {
    let (quadrant, r, low) = reduce(x.abs());
    let (sin, cos) = polynomials(r, low);
    // In odd quadrants sine and cosine change places; the sine is negative in the upper two, the cosine in the middle two.
    let swap = (quadrant & 1).wrapping_neg();
    let change = (sin.to_bits() ^ cos.to_bits()) & swap;
    let sin_sign = ((quadrant & 2) << 62) ^ (x.to_bits() & SIGN);
    let cos_sign = ((quadrant + 1) & 2) << 62;
    (f64::from_bits((sin.to_bits() ^ change) ^ sin_sign), f64::from_bits((cos.to_bits() ^ change) ^ cos_sign))
}

/// The integer k nearest to x/(π/2) in the low bits, and x − k π/2 in two words; `x` is not negative.
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
    // Two-sums: every difference is exact, so that the low word is good to its last digit even where r nearly vanishes.
    let part = r - near;
    let low = (near - (r - part)) - ((bc + part) + ((c - (bc - b)) + k * PI_2_D));
    (rounded.to_bits(), r, low)
}

/// sin(r + low) and cos(r + low) for |r| up to π/4, where `low` counts to first order.
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

/// Beyond [`LIMIT`].
#[cold]
#[inline(never)]
fn far(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

#[cfg(test)]
mod tests {
    use super::{FIRST, LIMIT, far, kernel, sin_cos};

    fn bits((sin, cos): (f64, f64)) -> (u64, u64) {
        (sin.to_bits(), cos.to_bits())
    }

    #[test]
    fn short_cut_has_the_bits_of_the_kernel() {
        for index in 0..100_000_u64 {
            // The last hundred thousand floats before FIRST, and a sweep of its whole range.
            for x in [f64::from_bits(FIRST.to_bits() - index), FIRST * index as f64 * 1e-5, 1e-300 * index as f64] {
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
                assert!((ours.0 - theirs.0).abs() <= 1.2e-16 && (ours.1 - theirs.1).abs() <= 1.2e-16, "{x:e}");
            }
        }
        assert_eq!(bits(sin_cos(LIMIT)), bits(kernel(LIMIT)));
        assert_eq!(bits(sin_cos(LIMIT.next_up())), bits(far(LIMIT.next_up())));
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
