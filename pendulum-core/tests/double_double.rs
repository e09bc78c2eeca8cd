//! Arithmetic and functions in two words against values of higher precision,
//! `tests/data/double_double.py`.

use pendulum_core::scalar::{DoubleDouble, Float, Real};

const TABLE: &str = include_str!("data/double_double.txt");

struct Row {
    function: &'static str,
    arguments: Vec<DoubleDouble>,
    value: DoubleDouble,
}

fn table() -> impl Iterator<Item = Row> {
    TABLE.lines().map(|line| {
        let (function, rest) = line.split_once(' ').expect("a name");
        let words: Vec<f64> = rest
            .split(' ')
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).expect("hexadecimal bits")))
            .collect();
        let mut arguments: Vec<DoubleDouble> =
            words.chunks(2).map(|pair| DoubleDouble::sum(pair[0], pair[1])).collect();
        let value = arguments.pop().expect("a value");
        Row { function, arguments, value }
    })
}

/// The relative error in units of 2⁻¹⁰⁶.
fn units(value: DoubleDouble, expected: DoubleDouble) -> f64 {
    if value == expected {
        return 0.0;
    }
    ((value - expected) / expected).to_f64().abs() * 2.0_f64.powi(106)
}

#[test]
fn every_function_meets_the_table() {
    let mut worst = std::collections::BTreeMap::<&str, f64>::new();
    for Row { function, arguments, value } in table() {
        let x = arguments[0];
        let (found, bound) = match function {
            "sin" => (x.sin(), 8.0),
            "cos" => (x.cos(), 8.0),
            "tan" => (x.tan(), 8.0),
            "asin" => (x.asin(), 8.0),
            "acos" => (x.acos(), 8.0),
            "atan" => (x.atan(), 8.0),
            "sinh" => (x.sinh(), 8.0),
            "cosh" => (x.cosh(), 8.0),
            "tanh" => (x.tanh(), 8.0),
            "sech" => (x.sech(), 8.0),
            "exp" => (x.exp(), 8.0),
            "ln" => (x.ln(), 8.0),
            "sqrt" => (x.sqrt(), 4.0),
            "sinc0" => (x.sinc(0), 8.0),
            _ if let Some(order) = function.strip_prefix("sinc") => {
                // A derivative of order n has zeros and is 1/(n+1) at most.
                let order: usize = order.parse().expect("an order");
                (x.sinc(order), 8.0 / ((order + 1) as f64 * value.to_f64().abs()).min(1.0))
            }
            "add" => (x + arguments[1], 3.0),
            "mul" => (x * arguments[1], 5.0),
            "div" => (x / arguments[1], 15.0),
            "atan2" => (x.atan2(arguments[1]), 8.0),
            "powf" => (x.powf(arguments[1]), 8.0 * (1.0 + (arguments[1] * x.ln()).to_f64().abs())),
            _ => panic!("there is no test of {function}"),
        };
        let error = units(found, value);
        assert!(
            error <= bound,
            "{function}{arguments:?}: {found:e} instead of {value:e}, {error:.1} units"
        );
        let largest = worst.entry(function).or_default();
        *largest = largest.max(error);
    }
    assert_eq!(worst.len(), 23);
    // A table that measures nothing would be met exactly.
    assert!(worst.values().all(|error| 0.1 < *error), "{worst:?}");
}

fn number(text: &str) -> DoubleDouble {
    text.parse().expect("a number")
}

#[test]
fn digits_come_and_go() {
    for text in [
        "0",
        "1",
        "-1",
        "0.1",
        "9.80665",
        "123456789.000000001",
        "0.00001",
        "-3.1415926535897932384626433832795",
        "1e-20",
        "2.5e33",
    ] {
        assert_eq!(number(text).to_string(), text);
    }
    assert_eq!(format!("{:.31}", DoubleDouble::PI), "3.1415926535897932384626433832795");
    assert_eq!(format!("{:.3}", number("-0.9996")), "-1.000");
    assert_eq!(format!("{:.0}", number("0.7")), "1");
    assert_eq!(format!("{:.2}", number("0.001")), "0.00");
    assert_eq!(
        format!("{:+8.2}|{:<8.1}|{:08.1}", number("1.25"), number("1.75"), number("-2.5")),
        "   +1.25|1.8     |-00002.5"
    );
    assert_eq!(
        format!("{:e} {:.2e} {:e}", number("1500"), number("9.999"), number("0")),
        "1.5e3 1.00e1 0e0"
    );
    assert_eq!(
        format!("{} {}", DoubleDouble::from(f64::NAN), -DoubleDouble::from(f64::INFINITY)),
        "NaN -inf"
    );
    assert_eq!(DoubleDouble::from(0.1).to_string(), "0.10000000000000000555111512312578");
    assert_eq!(DoubleDouble::from(5e-324).to_string(), "4.9406564584124654417656879286822e-324");
    assert_eq!(number("+12.5E-1"), DoubleDouble::from(1.25));
    assert_eq!(number("1e400").to_f64(), f64::INFINITY);
    assert_eq!(number("1e-400").to_f64(), 0.0);
    assert_eq!(number("0.1"), DoubleDouble::ratio(1.0, 10.0));
    for (text, at) in [
        ("", 0),
        ("-", 1),
        (".", 1),
        ("1.2.3", 3),
        ("1e", 2),
        ("1e+", 3),
        ("1 ", 1),
        ("inf", 0),
        ("0x10", 1),
    ] {
        assert_eq!(text.parse::<DoubleDouble>().unwrap_err().at, at, "{text}");
    }
    assert!("1,5".parse::<DoubleDouble>().unwrap_err().to_string().contains("byte 1"));
}

#[test]
fn printed_values_are_read_back() {
    for Row { value, .. } in table() {
        assert!(units(number(&format!("{value:.34e}")), value) <= 1024.0, "{value:e}");
    }
    // Where the power of ten is exact, the error is that of one operation.
    for Row { value, .. } in table().filter(|row| (1e-9..1e9).contains(&row.value.to_f64().abs())) {
        assert!(units(number(&format!("{value:.34e}")), value) <= 15.0, "{value:e}");
    }
}

/// A function over both scalars.
type One = (&'static str, fn(DoubleDouble) -> DoubleDouble, fn(f64) -> f64);
type Two = (&'static str, fn(DoubleDouble, DoubleDouble) -> DoubleDouble, fn(f64, f64) -> f64);

#[test]
fn limits_are_those_of_one_word() {
    let (inf, nan, zero) = (f64::INFINITY, f64::NAN, 0.0);
    let one: [One; 12] = [
        ("sin", Real::sin, Real::sin),
        ("tan", Real::tan, Real::tan),
        ("asin", Real::asin, Real::asin),
        ("acos", Real::acos, Real::acos),
        ("atan", Real::atan, Real::atan),
        ("sinh", Real::sinh, Real::sinh),
        ("cosh", Real::cosh, Real::cosh),
        ("tanh", Real::tanh, Real::tanh),
        ("sech", Real::sech, Real::sech),
        ("exp", Real::exp, Real::exp),
        ("ln", Real::ln, Real::ln),
        ("sqrt", Real::sqrt, Real::sqrt),
    ];
    for (name, wide, narrow) in one {
        for x in [
            inf, -inf, nan, zero, -zero, 1.0, -1.0, 1.5, -1.5, 1e300, 5e-324, 800.0, -800.0,
            709.75, -740.0,
        ] {
            let (found, expected) = (wide(x.into()), narrow(x));
            let (high, low) = (found.high(), found.low());
            assert!(
                high.is_nan() && expected.is_nan()
                    || high == expected
                    || (high - expected).abs() <= 2e-16 * expected.abs(),
                "{name} {x}: {high:e} {expected:e}"
            );
            assert!(high.is_finite() || low == 0.0, "{name} {x}");
        }
    }
    let two: [Two; 8] = [
        ("+", |a, b| a + b, |a, b| a + b),
        ("-", |a, b| a - b, |a, b| a - b),
        ("*", |a, b| a * b, |a, b| a * b),
        ("/", |a, b| a / b, |a, b| a / b),
        ("atan2", Real::atan2, Real::atan2),
        ("powf", Real::powf, Real::powf),
        ("max", Real::max, Real::max),
        ("min", Real::min, Real::min),
    ];
    let values =
        [inf, -inf, nan, zero, -zero, 1.0, -1.0, 0.5, -2.0, 3.0, 1e300, 1e-300, 1.7e308, 5e-324];
    for (name, wide, narrow) in two {
        for (a, b) in values.iter().flat_map(|a| values.map(|b| (*a, b))) {
            let (found, expected) = (wide(a.into(), b.into()), narrow(a, b));
            let (high, low) = (found.high(), found.low());
            assert!(
                high.is_nan() && expected.is_nan()
                    || high == expected
                    || (high - expected).abs() <= 1e-15 * expected.abs()
                    || (high - expected).abs() < 1e-320,
                "{name} {a:e} {b:e}: {high:e} {expected:e}"
            );
            assert!(high.is_finite() || low == 0.0, "{name} {a:e} {b:e}");
        }
    }
}

#[test]
fn quotients_of_small_numbers_are_as_large_as_they_are() {
    for (a, b) in [
        ("1e-150", "1e-300"),
        ("1e-280", "1e-10"),
        ("1e300", "1e150"),
        ("1e150", "1e-150"),
        ("1e-200", "1e60"),
    ] {
        let (a, b) = (number(a), number(b));
        let quotient = a / b;
        assert!(
            quotient.is_finite() && units(quotient * b, a) < 1e5,
            "{a:?} / {b:?} = {quotient:?}"
        );
    }
}

#[test]
fn order_looks_at_both_words() {
    let (a, b) = (DoubleDouble::sum(1.0, -1e-20), DoubleDouble::sum(1.0, 1e-20));
    assert!(a < DoubleDouble::from(1.0) && DoubleDouble::from(1.0) < b && a != b);
    assert_eq!((a.max(b), a.min(b)), (b, a));
    assert_eq!(
        ((b - a).sign().to_f64(), (a - b).step().to_f64(), (a - a).step().to_f64()),
        (1.0, 0.0, 0.5)
    );
    assert_eq!((-a).abs(), a);
    assert!(DoubleDouble::from(f64::NAN).partial_cmp(&a).is_none());
}
