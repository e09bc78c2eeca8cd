//! Sine and cosine against correctly rounded values, `tests/data/trig.py`, and against their
//! identities.

use pendulum_core::scalar::Real;
use systems::random::Random;

const TABLE: &str = include_str!("data/trig.txt");

/// A number in two words.
struct Words {
    hi: f64,
    lo: f64,
}

impl Words {
    /// The distance of `value` from here in units in the last place of the correctly rounded
    /// result.
    fn ulps(&self, value: f64) -> f64 {
        let magnitude = self.hi.abs();
        let ulp = f64::from_bits(magnitude.to_bits() + 1) - magnitude;
        (((value - self.hi) - self.lo) / ulp).abs()
    }
}

struct Row {
    x: f64,
    sin: Words,
    cos: Words,
}

fn table() -> impl Iterator<Item = Row> {
    TABLE.lines().map(|line| {
        let mut numbers = line
            .split(' ')
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).expect("hexadecimal bits")));
        let mut next = || numbers.next().expect("five words a line");
        Row {
            x: next(),
            sin: Words { hi: next(), lo: next() },
            cos: Words { hi: next(), lo: next() },
        }
    })
}

/// Uniform in [−width, width).
fn within(random: &mut Random, width: f64) -> f64 {
    random.uniform(-1.0, 1.0) * width
}

/// Arguments of all sizes up to 2²⁰ π/2, most of them ordinary angles.
fn arguments(count: usize) -> impl Iterator<Item = f64> {
    let mut random = Random::new(1);
    let widths = [0.8, 3.2, 3.2, 10.0, 100.0, 1e4, 1647099.0];
    (0..count).map(move |index| within(&mut random, widths[index % widths.len()]))
}

#[test]
fn the_table_is_met_below_one_unit_in_the_last_place() {
    let mut rows = 0;
    let (mut worst_sin, mut worst_cos) = (0.0_f64, 0.0_f64);
    for row in table() {
        let (sin, cos) = Real::sin_cos(row.x);
        let errors = (row.sin.ulps(sin), row.cos.ulps(cos));
        assert!(
            errors.0 < 0.85 && errors.1 < 0.85,
            "sine and cosine of {:e} are off by {errors:?}",
            row.x
        );
        worst_sin = worst_sin.max(errors.0);
        worst_cos = worst_cos.max(errors.1);
        rows += 1;
    }
    assert!(1000 < rows);
    // A table that measures nothing would be met exactly.
    assert!(0.5 < worst_sin && 0.5 < worst_cos, "{worst_sin} {worst_cos}");
}

#[test]
fn single_precision_is_correctly_rounded_where_doubles_decide() {
    for row in table() {
        let x = row.x as f32;
        if f64::from(x) == row.x {
            assert_eq!(Real::sin(x), row.sin.hi as f32);
            assert_eq!(Real::cos(x), row.cos.hi as f32);
        }
    }
}

#[test]
fn each_alone_has_the_bits_of_the_pair() {
    for x in arguments(100_000).chain(table().map(|row| row.x)) {
        let (sin, cos) = Real::sin_cos(x);
        assert_eq!(
            (Real::sin(x).to_bits(), Real::cos(x).to_bits()),
            (sin.to_bits(), cos.to_bits()),
            "{x:e}"
        );
    }
}

#[test]
fn sine_is_odd_and_cosine_even_in_every_bit() {
    for x in arguments(100_000).chain(table().map(|row| row.x)) {
        let (sin, cos) = Real::sin_cos(x);
        let (odd, even) = Real::sin_cos(-x);
        assert_eq!(((-odd).to_bits(), even.to_bits()), (sin.to_bits(), cos.to_bits()), "{x:e}");
    }
}

#[test]
fn zeros_keep_their_sign() {
    assert_eq!(Real::sin(0.0_f64).to_bits(), 0);
    assert_eq!(Real::sin(-0.0_f64).to_bits(), 1 << 63);
    assert_eq!(Real::sin(-0.0_f32).to_bits(), 1 << 31);
    assert_eq!((Real::cos(0.0_f64), Real::cos(-0.0_f64)), (1.0, 1.0));
}

#[test]
fn infinite_arguments_give_no_number() {
    for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let (sin, cos) = Real::sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan());
        let (sin, cos) = Real::sin_cos(x as f32);
        assert!(sin.is_nan() && cos.is_nan());
    }
}

#[test]
fn squares_add_up_to_one() {
    for x in arguments(100_000) {
        let (sin, cos) = Real::sin_cos(x);
        assert!((sin * sin + cos * cos - 1.0).abs() <= 3.0 * f64::EPSILON, "{x:e}");
    }
}

#[test]
fn a_million_arguments_agree_with_another_library() {
    for x in arguments(1_000_000) {
        let (sin, cos) = Real::sin_cos(x);
        let other = libm::sincos(x);
        for (ours, theirs) in [(sin, other.0), (cos, other.1)] {
            let apart = ours.to_bits().abs_diff(theirs.to_bits());
            assert!(apart <= 1, "{ours:e} and {theirs:e} at {x:e}");
        }
    }
}

#[test]
fn single_precision_holds_for_every_exponent() {
    let mut random = Random::new(2);
    for exponent in 0..255_u32 {
        for _ in 0..400 {
            let x = f32::from_bits((exponent << 23) | (random.bits() as u32 & 0x807FFFFF));
            let (sin, cos) = Real::sin_cos(x);
            let exact = libm::sincos(f64::from(x));
            for (ours, exact) in [(sin, exact.0), (cos, exact.1)] {
                let magnitude = (exact as f32).abs();
                let ulp = f64::from(f32::from_bits(magnitude.to_bits() + 1)) - f64::from(magnitude);
                assert!(
                    (f64::from(ours) - exact).abs() <= 0.501 * ulp,
                    "{ours:e} is not {exact:e} at {x:e}"
                );
            }
        }
    }
}

#[test]
fn every_function_has_the_same_bits_on_every_machine() {
    // FNV-1a over the bits of the results; recorded on x86-64.
    let mut hash = 0xCBF29CE484222325_u64;
    let mut take = |value: f64| {
        for byte in value.to_bits().to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100000001B3);
        }
    };
    for x in arguments(20_000) {
        let (sin, cos) = Real::sin_cos(x);
        let small = x % 1.0;
        for value in [
            sin,
            cos,
            Real::tan(x),
            Real::asin(small),
            Real::acos(small),
            Real::atan(x),
            Real::atan2(x, small),
        ] {
            take(value);
        }
        let middle = x % 16.0;
        for value in [Real::sinh(middle), Real::cosh(middle), Real::tanh(middle), Real::exp(middle)]
        {
            take(value);
        }
        take(Real::ln(Real::abs(x)));
        take(Real::powf(Real::abs(x), small));
    }
    assert_eq!(hash, 12754388991074856979);
}
