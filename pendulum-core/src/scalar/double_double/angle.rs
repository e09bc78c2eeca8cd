//! Sine, cosine and the angle of a point.

use super::number::{DoubleDouble, power_of_two, series};
use crate::scalar::real::Real;

/// The greatest magnitude of an angle without reduction.
const FIRST: f64 = core::f64::consts::FRAC_PI_4;

/// The first 1536 bits of 2/π after the point.
const TWO_OVER_PI: [u64; 24] = [
    0xA2F9836E4E441529,
    0xFC2757D1F534DDC0,
    0xDB6295993C439041,
    0xFE5163ABDEBBC561,
    0xB7246E3A424DD2E0,
    0x06492EEA09D1921C,
    0xFE1DEB1CB129A73E,
    0xE88235F52EBB4484,
    0xE99C7026B45F7E41,
    0x3991D639835339F4,
    0x9C845F8BBDF9283B,
    0x1FF897FFDE05980F,
    0xEF2F118B5A0A6D1F,
    0x6D367ECF27CB09B7,
    0x4F463F669E5FEA2D,
    0x7527BAC7EBE5F17B,
    0x3D0739F78A5292EA,
    0x6BFB5FB11F8D5D08,
    0x56033046FC7B6BAB,
    0xF0CFBC209AF4361D,
    0xA9E391615EE61B08,
    0x6599855F14A06840,
    0x8DFFD8804D732731,
    0x06061556CA73A8C9,
];

/// Both words of sin(k/16) and of cos(k/16).
const TABLE: [[f64; 4]; 14] = [
    [0.0, 0.0, 1.0, 0.0],
    [0.0624593178423802, -2.040259504585711e-18, 0.9980475107000991, 3.3232291674141346e-17],
    [0.12467473338522769, -2.925947496057858e-18, 0.992197667229329, 4.754870575189364e-17],
    [0.18640329676226988, 2.3493796901281573e-18, 0.9824733131012553, -3.919920375420088e-17],
    [0.24740395925452294, -7.53102495590706e-18, 0.9689124217106447, 5.071436662403936e-17],
    [0.30743851458038085, 1.1004366442765296e-19, 0.9515679480481722, -3.8614834675674123e-17],
    [0.36627252908604757, -9.938814562106524e-18, 0.9305076219123143, 4.488760003328074e-18],
    [0.42367625720393803, -2.331800700068871e-17, 0.9058136834259364, 4.2864666490805214e-17],
    [0.479425538604203, -5.103969860556013e-18, 0.8775825618903728, -4.2623149864279997e-17],
    [0.5333026735360201, 5.129318115032044e-17, 0.8459244992310679, 1.549506647350329e-17],
    [0.5850972729404622, -5.4883972461161805e-17, 0.8109631195052179, -3.091333486122179e-17],
    [0.6346070800152693, -3.4568582392624965e-17, 0.7728349461524715, 4.231014921891023e-17],
    [0.6816387600233341, 4.410467313197903e-17, 0.7316888688738209, -1.0475824306512768e-17],
    [0.7260086552607126, -1.573621815339587e-17, 0.6876855622205048, 3.5430696752823923e-17],
];

/// (sin x − x)/x³ in powers of x².
const SINE: [DoubleDouble; 3] = [
    DoubleDouble::words(-0.16666666666666666, -9.25185853854297e-18),
    DoubleDouble::words(0.008333333333333333, 1.1564823173178714e-19),
    DoubleDouble::words(-0.0001984126984126984, -1.7209558293420705e-22),
];
const SINE_TAIL: [f64; 4] = [
    2.7557319223985893e-06,
    -2.505210838544172e-08,
    1.6059043836821613e-10,
    -7.647163731819816e-13,
];
/// (cos x − 1)/x² in powers of x².
const COSINE: [DoubleDouble; 4] = [
    DoubleDouble::words(-0.5, 0.0),
    DoubleDouble::words(0.041666666666666664, 2.3129646346357427e-18),
    DoubleDouble::words(-0.001388888888888889, 5.300543954373577e-20),
    DoubleDouble::words(2.48015873015873e-05, 2.1511947866775882e-23),
];
const COSINE_TAIL: [f64; 4] =
    [-2.755731922398589e-07, 2.08767569878681e-09, -1.1470745597729725e-11, 4.779477332387385e-14];

/// Computes sine and cosine; NaN unless `x` is finite.
pub(super) fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    if !x.high.is_finite() {
        return (DoubleDouble::NAN, DoubleDouble::NAN);
    }
    if x.high.abs() <= FIRST {
        return near(x);
    }
    let (quadrant, r) = reduce(x);
    let (sin, cos) = near(r);
    match quadrant {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Computes sine and cosine for |x| up to about π/4, from those of k/16 in the table and of a small
/// remainder.
fn near(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let magnitude = x.abs();
    let k = (16.0 * magnitude.high).round_ties_even();
    let s = magnitude.plus(-k / 16.0);
    let z = s * s;
    let sin = s + s * z * series(z, &SINE, &SINE_TAIL);
    let cos_minus_one = z * series(z, &COSINE, &COSINE_TAIL);
    let (sin, cos) = if k == 0.0 {
        (sin, cos_minus_one.plus(1.0))
    } else {
        let [s, s_low, c, c_low] = TABLE[k as usize];
        let (sin_k, cos_k) = (DoubleDouble::words(s, s_low), DoubleDouble::words(c, c_low));
        (
            sin_k + (sin_k * cos_minus_one + cos_k * sin),
            cos_k + (cos_k * cos_minus_one - sin_k * sin),
        )
    };
    (if x.high.is_sign_negative() { -sin } else { sin }, cos)
}

/// Returns the integer nearest to x/(π/2), modulo four, and the remainder of x. The remainder has
/// full accuracy for all magnitudes of x.
///
/// Payne and Hanek (1983): x/(π/2) modulo four in 448 bits, 446 of them after the point. A two-word
/// number and a multiple of π/2 have at most some 250 leading bits in common, so that more than 150
/// remain.
fn reduce(x: DoubleDouble) -> (u64, DoubleDouble) {
    let mut turns = [0; WORDS];
    add_quarter_turns(&mut turns, x.high);
    add_quarter_turns(&mut turns, x.low);
    // Rounds to the nearest integer, in the top two bits.
    let quadrant = turns[0].wrapping_add(1 << 61) >> 62;
    turns[0] = turns[0].wrapping_sub(quadrant << 62);
    let negative = turns[0] >> 63 == 1;
    if negative {
        negate(&mut turns);
    }
    let fraction = value(&turns);
    let r = fraction * DoubleDouble::PI.scaled(0.5);
    (quadrant, if negative { -r } else { r })
}

/// The number of words of a fixed-point number modulo four, with the most significant word first.
const WORDS: usize = 7;

/// Adds x/(π/2) modulo four to `turns`.
fn add_quarter_turns(turns: &mut [u64; WORDS], x: f64) {
    let bits = x.abs().to_bits();
    if bits == 0 {
        return;
    }
    let (biased, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | (1 << 52), biased - 1075) };
    let mut product = [0; WORDS];
    let mut carry = 0_u128;
    for (i, word) in product.iter_mut().enumerate().rev() {
        // The bits of 2/π · 2^exponent from 2¹ on; higher bits are multiples of four.
        carry += u128::from(mantissa) * u128::from(bits_from(exponent - 2 + 64 * i as i32));
        *word = carry as u64;
        carry >>= 64;
    }
    if x.is_sign_negative() {
        negate(&mut product);
    }
    let mut carry = 0_u128;
    for (turn, word) in turns.iter_mut().zip(product).rev() {
        carry += u128::from(*turn) + u128::from(word);
        *turn = carry as u64;
        carry >>= 64;
    }
}

/// Returns 64 bits of 2/π from bit `offset` on; bits outside of the table are zero.
fn bits_from(offset: i32) -> u64 {
    let word = |index: i32| {
        usize::try_from(index).ok().and_then(|index| TWO_OVER_PI.get(index)).copied().unwrap_or(0)
    };
    let (index, shift) = (offset.div_euclid(64), offset.rem_euclid(64));
    if shift == 0 {
        word(index)
    } else {
        (word(index) << shift) | (word(index + 1) >> (64 - shift))
    }
}

/// Negates a number in two's complement.
fn negate(words: &mut [u64; WORDS]) {
    let mut carry = true;
    for word in words.iter_mut().rev() {
        (*word, carry) = (!*word).overflowing_add(u64::from(carry));
    }
}

/// Converts a fixed-point number, using its leading bits.
fn value(words: &[u64; WORDS]) -> DoubleDouble {
    let first = words.iter().position(|word| *word != 0).unwrap_or(WORDS);
    let mut sum = DoubleDouble::ZERO;
    for i in (first..WORDS.min(first + 4)).rev() {
        let unit = power_of_two(-62 - 64 * i as i32);
        sum = sum.plus((words[i] & 0xFFFF_FFFF) as f64 * unit);
        sum = sum.plus((words[i] >> 32) as f64 * (unit * 4294967296.0));
    }
    sum
}

/// Computes the angle of the point (`x`, `y`): the angle in one word, improved by one step of
/// Newton's method.
pub(super) fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let guess = libm::atan2(y.high, x.high);
    let (size_y, size_x) = (y.high.abs(), x.high.abs());
    let larger = if size_y < size_x { size_x } else { size_y };
    if guess.is_nan() || (guess == 0.0 && (y.high == 0.0 || size_x == f64::INFINITY)) {
        return guess.into();
    }
    if larger == 0.0 || larger == f64::INFINITY {
        // A multiple of π/4.
        return DoubleDouble::PI.scaled(0.25).times((guess / FIRST).round_ties_even());
    }
    // Both numbers are scaled to the middle of the range.
    let up = if larger < power_of_two(-400) {
        power_of_two(600)
    } else if power_of_two(400) < larger {
        power_of_two(-600)
    } else {
        1.0
    };
    let (y, x) = (y.scaled(up), x.scaled(up));
    let (sin, cos) = sin_cos(guess.into());
    let rest = (y * cos - x * sin) / (x * cos + y * sin);
    rest.plus(guess)
}
