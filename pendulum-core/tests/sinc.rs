//! sin(x)/x and its derivatives against numbers in two words, which `tests/double_double.rs` holds
//! against a table.

use pendulum_core::scalar::{DoubleDouble, Float, Real};
use systems::random::Random;

const ORDERS: usize = 40;

/// Uniform in [−width, width).
fn within(random: &mut Random, width: f64) -> f64 {
    random.uniform(-1.0, 1.0) * width
}

/// Arguments of all sizes, and next to those beyond which an order is found otherwise.
fn arguments() -> Vec<f64> {
    let mut random = Random::new(3);
    let widths = [1e-300, 1e-9, 1e-3, 0.1, 1.0, 1.0, 3.2, 10.0, 45.0, 1e4];
    let mut all: Vec<f64> =
        (0..3000).map(|index| within(&mut random, widths[index % widths.len()])).collect();
    for n in 0..=ORDERS {
        let n = n as f64;
        all.extend([n, n.next_up(), n.next_down(), -n, n * core::f64::consts::PI]);
    }
    all.extend([5e-324, -5e-324, 1e-310, f64::MIN_POSITIVE]);
    all
}

fn exact(x: f64, order: usize) -> DoubleDouble {
    DoubleDouble::from(x).sinc(order)
}

fn error(value: f64, exact: DoubleDouble) -> f64 {
    (DoubleDouble::from(value) - exact).to_f64().abs()
}

#[test]
fn sinc_has_all_its_digits() {
    let mut worst = 0.0_f64;
    for x in arguments() {
        let exact = exact(x, 0);
        let magnitude = exact.to_f64().abs();
        worst = worst.max(error(x.sinc(0), exact) / (magnitude.next_up() - magnitude));
    }
    assert!((0.5..1.5).contains(&worst), "{worst}");
}

/// In units of ε/(n+1): the derivative of order n is 1/(n+1) at most.
#[test]
fn derivatives_have_their_digits() {
    for order in 1..=ORDERS {
        let (mut worst, mut at) = (0.0_f64, 0.0);
        for x in arguments() {
            let error = error(x.sinc(order), exact(x, order)) * (order + 1) as f64 / f64::EPSILON;
            if worst < error {
                (worst, at) = (error, x);
            }
        }
        println!("order {order}: {worst:.2} at {at:e}");
        assert!((0.1..1.5).contains(&worst), "order {order}: {worst} at {at:e}");
    }
}

/// Where odd orders vanish, next to zero, they keep their digits as well.
#[test]
fn derivatives_keep_their_digits_next_to_zero() {
    for order in 1..=ORDERS {
        for x in arguments().into_iter().filter(|x| (1e-290..=1.0).contains(&x.abs())) {
            let (found, exact) = (x.sinc(order), exact(x, order));
            let relative = error(found, exact) / exact.to_f64().abs() / f64::EPSILON;
            assert!(relative < 4.0, "order {order} at {x:e}: {found:e}, {relative} ε");
        }
    }
}

#[test]
fn values_at_zero_are_fractions() {
    for order in 0..=ORDERS {
        let fraction = match order % 4 {
            0 => 1.0 / (order + 1) as f64,
            2 => -1.0 / (order + 1) as f64,
            _ => 0.0,
        };
        for zero in [0.0_f64, -0.0] {
            assert_eq!(zero.sinc(order), fraction, "order {order}");
            assert_eq!((zero as f32).sinc(order), fraction as f32, "order {order}");
        }
    }
}

#[test]
fn odd_orders_are_odd_and_even_ones_even_in_every_bit() {
    for x in arguments().into_iter().filter(|x| *x != 0.0) {
        for order in 0..=ORDERS {
            let (one, other) = (x.sinc(order), (-x).sinc(order));
            let other = if order % 2 == 0 { other } else { -other };
            assert_eq!(one.to_bits(), other.to_bits(), "order {order} at {x:e}");
        }
    }
}

#[test]
fn single_precision_is_next_to_correctly_rounded() {
    for x in arguments() {
        let x = x as f32;
        for order in 0..=ORDERS {
            let (found, exact) = (x.sinc(order), f64::from(x).sinc(order));
            let magnitude = found.abs();
            let ulp = f64::from(magnitude.next_up()) - f64::from(magnitude);
            assert!((f64::from(found) - exact).abs() <= 0.5001 * ulp, "order {order} at {x:e}");
        }
    }
}

#[test]
fn infinite_arguments_give_no_number() {
    for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        for order in [0, 1, 7] {
            assert!(x.sinc(order).is_nan() && (x as f32).sinc(order).is_nan());
            assert!(DoubleDouble::from(x).sinc(order).to_f64().is_nan());
        }
    }
}

#[test]
fn every_order_has_the_same_bits_on_every_machine() {
    // FNV-1a over the bits of the results; recorded on x86-64.
    let mut hash = 0xCBF29CE484222325_u64;
    for x in arguments() {
        for order in 0..=ORDERS {
            for byte in x.sinc(order).to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x100000001B3);
            }
        }
    }
    assert_eq!(hash, 0x8C70AAB8305492CF, "{hash:#X}");
}
