//! Tests of all recurrences against compositions of power series in exact rationals.

use super::{First, Order, Reciprocals, Running, Second, Series, series};
use crate::motion::series::zero;
use crate::scalar::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// An exact fraction. Functions are defined only at arguments with rational values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fraction(i128, i128);

fn fraction(numerator: i128, denominator: i128) -> Fraction {
    let (mut a, mut b) = (numerator.unsigned_abs(), denominator.unsigned_abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let divisor = i128::try_from(a.max(1)).unwrap() * denominator.signum();
    Fraction(numerator / divisor, denominator / divisor)
}

impl Add for Fraction {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        fraction(self.0 * other.1 + other.0 * self.1, self.1 * other.1)
    }
}

impl Neg for Fraction {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, self.1)
    }
}

impl Sub for Fraction {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Fraction {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        fraction(self.0 * other.0, self.1 * other.1)
    }
}

impl Div for Fraction {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        assert!(other.0 != 0, "division by zero");
        fraction(self.0 * other.1, self.1 * other.0)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operation:tt),+) => {$(
        impl $trait for Fraction {
            fn $method(&mut self, other: Self) {
                *self = *self $operation other;
            }
        }
    )+};
}

assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

/// Defines functions that are known only at one point.
macro_rules! known {
    ($($name:ident $at:literal $value:literal),+) => {$(
        fn $name(self) -> Self {
            assert_eq!(self, fraction($at, 1));
            fraction($value, 1)
        }
    )+};
}

impl Real for Fraction {
    fn from_f64(value: f64) -> Self {
        let scaled = value * 1024.0;
        assert_eq!(scaled.fract(), 0.0);
        fraction(scaled as i128, 1024)
    }

    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::from_f64(numerator) / Self::from_f64(denominator)
    }

    fn sin_cos(self) -> (Self, Self) {
        assert_eq!(self.0, 0);
        (fraction(0, 1), fraction(1, 1))
    }

    known!(tan 0 0, asin 0 0, atan 0 0, sinh 0 0, cosh 0 1, tanh 0 0, exp 0 1, ln 1 0, sqrt 1 1);

    fn sinc(self, order: usize) -> Self {
        assert_eq!(self.0, 0);
        let order = order as i128;
        circular(order, false, true) * fraction(factorial(order), order + 1)
    }

    fn atan2(self, x: Self) -> Self {
        assert!(self.0 == 0 && 0 < x.0);
        self
    }

    fn powf(self, _: Self) -> Self {
        assert_eq!(self, fraction(1, 1));
        self
    }

    fn abs(self) -> Self {
        Self(self.0.abs(), self.1)
    }

    fn sign(self) -> Self {
        fraction(self.0.signum(), 1)
    }

    fn step(self) -> Self {
        fraction(self.0.signum() + 1, 2)
    }

    fn max(self, other: Self) -> Self {
        if 0 < (other - self).0 { other } else { self }
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    fn acos(self) -> Self {
        unreachable!("irrational")
    }

    fn pi() -> Self {
        unreachable!("irrational")
    }
}

/// The number of coefficients for which 128 bits suffice.
const COUNT: usize = 9;

type Coefficients = [Fraction; COUNT];

fn whole(value: i128) -> Fraction {
    fraction(value, 1)
}

/// x0 + t/2 − t²/3 + t³ + t⁴/4 + …
fn argument(x0: i128) -> Coefficients {
    let rest = [(1, 2), (-1, 3), (1, 1), (1, 4), (-2, 1), (0, 1), (1, 2), (3, 1)];
    core::array::from_fn(
        |k| if k == 0 { whole(x0) } else { fraction(rest[k - 1].0, rest[k - 1].1) },
    )
}

fn multiplied(a: &Coefficients, b: &Coefficients) -> Coefficients {
    core::array::from_fn(|k| (0..=k).fold(whole(0), |sum, j| sum + a[j] * b[k - j]))
}

/// Σ outer\[n\] (x − x0)ⁿ.
fn composed(outer: impl Fn(i128) -> Fraction, x: &Coefficients) -> Coefficients {
    let mut inner = *x;
    inner[0] = whole(0);
    let mut sum = [whole(0); COUNT];
    for n in (0..COUNT).rev() {
        sum = multiplied(&sum, &inner);
        sum[0] += outer(n as i128);
    }
    sum
}

fn factorial(n: i128) -> i128 {
    (1..=n).product()
}

/// The coefficient of xⁿ in the Maclaurin series of sine and cosine, or of sinh and cosh.
fn circular(n: i128, odd: bool, alternating: bool) -> Fraction {
    let sign = if alternating && n % 4 >= 2 { -1 } else { 1 };
    if (n % 2 == 1) == odd { fraction(sign, factorial(n)) } else { whole(0) }
}

/// Returns c/n for odd n, and zero for even n: the coefficients of inverse functions such as the
/// arc tangent.
fn odd(n: i128, coefficient: impl Fn(i128) -> Fraction) -> Fraction {
    if n % 2 == 1 { coefficient(n / 2) / whole(n) } else { whole(0) }
}

/// Returns a generalized binomial coefficient.
fn binomial(exponent: Fraction, n: i128) -> Fraction {
    (0..n).fold(whole(1), |product, j| product * (exponent - whole(j)) / whole(j + 1))
}

/// Computes a quotient by long division.
fn divided(a: &Coefficients, b: &Coefficients) -> Coefficients {
    let mut quotient = [whole(0); COUNT];
    for k in 0..COUNT {
        let sum = (1..=k).fold(a[k], |sum, j| sum - b[j] * quotient[k - j]);
        quotient[k] = sum / b[0];
    }
    quotient
}

/// Runs a recurrence through all orders and compares its results with `expected`.
fn check(
    name: &str,
    expected: &Coefficients,
    mut next: impl FnMut(Running, usize, &Series<Fraction>) -> Fraction,
) {
    let mut own = zero();
    for k in 0..COUNT {
        own[k] = next(Running::new(k), k, &own);
        assert_eq!(own[k], expected[k], "{name}, order {k}");
    }
}

fn padded(x: &Coefficients) -> Series<Fraction> {
    core::array::from_fn(|k| if k < COUNT { x[k] } else { whole(0) })
}

fn rates(x: &Coefficients) -> Series<Fraction> {
    core::array::from_fn(|k| if k < COUNT { x[k] * whole(k as i128) } else { whole(0) })
}

fn reciprocals() -> Reciprocals<Fraction> {
    Reciprocals::new()
}

#[test]
fn products_quotients_and_powers() {
    let (a, b) = (argument(1), argument(-3));
    let (x, y) = (padded(&a), padded(&b));
    let mut lead = whole(0);
    check("product", &multiplied(&a, &b), |order, _, _| series::product(&x, &y, order));
    check("square", &multiplied(&a, &a), |order, _, _| series::square(&x, order));
    check("quotient", &divided(&a, &b), |order, k, own| {
        series::quotient(x[k], &y, own, &mut lead, order)
    });
    let root = composed(|n| binomial(fraction(1, 2), n), &a);
    check("square root", &root, |order, k, own| series::sqrt(x[k], own, &mut lead, order));
    for exponent in [fraction(-3, 2), fraction(5, 2), fraction(1, 4), whole(7), whole(-2)] {
        let expected = composed(|n| binomial(exponent, n), &a);
        check("power", &expected, |order, _, own| {
            series::power(&x, exponent, own, &mut lead, &reciprocals(), order)
        });
    }
}

#[test]
fn circular_and_hyperbolic_functions() {
    let a = argument(0);
    let (x, rate) = (padded(&a), rates(&a));
    let mut path = super::Path::<Fraction, 1>::new();
    path.q[0] = x;
    path.v[0] = core::array::from_fn(|k| if k + 1 < COUNT { rate[k + 1] } else { whole(0) });
    for (part, name) in ["sine", "cosine"].into_iter().enumerate() {
        let mut pairs = [[whole(0); 2]; super::LENGTH];
        let expected = composed(|n| circular(n, part == 0, true), &a);
        check(name, &expected, |order, k, _| {
            pairs[k] = series::sin_cos(x[k], &rate, &pairs, &reciprocals(), order);
            pairs[k][part]
        });
        let mut pairs = [[whole(0); 2]; super::LENGTH];
        check(name, &expected, |order, k, _| {
            pairs[k] = series::sin_cos_of_coordinate(&path, 0, &pairs, order);
            pairs[k][part]
        });
        let mut pairs = [[whole(0); 2]; super::LENGTH];
        check(name, &composed(|n| circular(n, part == 0, false), &a), |order, k, _| {
            pairs[k] = series::sinh_cosh(x[k], &rate, &pairs, &reciprocals(), order);
            pairs[k][part]
        });
    }
    let parts =
        |alternating| [true, false].map(|odd| composed(|n| circular(n, odd, alternating), &a));
    for (alternating, sign) in [(true, whole(1)), (false, whole(-1))] {
        let [sine, cosine] = parts(alternating);
        // tan′ = 1 + tan², tanh′ = 1 − tanh².
        let mut slopes = zero();
        check("tangent", &divided(&sine, &cosine), |order, k, own| {
            let value = series::integral(|| x[0].tan(), &rate, &slopes, &reciprocals(), order);
            let mut own = *own;
            own[k] = value;
            slopes[k] = series::constant(whole(1), order) + sign * series::square(&own, order);
            value
        });
    }
    let exponential = composed(|n| fraction(1, factorial(n)), &a);
    check("exponential", &exponential, |order, _, own| {
        series::integral(|| x[0].exp(), &rate, own, &reciprocals(), order)
    });
}

/// The name of a function and its derivatives at zero.
type Family = (&'static str, fn(i128) -> Fraction);

#[test]
fn families_of_derivatives() {
    let a = argument(0);
    let rate = rates(&a);
    // The derivatives at zero of sinc, e²ˣ, sine, cosine and a polynomial.
    let families: [Family; 5] = [
        ("sinc", |n| whole(0).sinc(n as usize)),
        ("exponential", |n| whole(1 << n)),
        ("sine", |n| circular(n, true, true) * whole(factorial(n))),
        ("cosine", |n| circular(n, false, true) * whole(factorial(n))),
        ("polynomial", |n| if n < 4 { whole(n + 2) } else { whole(0) }),
    ];
    for (name, member) in families {
        let mut members = vec![zero(); super::LENGTH];
        let expected = composed(|n| member(n) / whole(factorial(n)), &a);
        check(name, &expected, |order, _, _| {
            let member = |n: usize| member(n as i128);
            series::family(member, &rate, &mut members, &reciprocals(), order)
        });
    }
}

#[test]
fn oscillators_have_the_sines_and_cosines_of_their_own_angle() {
    let (sine, cosine) = (fraction(-3, 2), whole(2));
    let mut path = super::Path::<Fraction, 1>::new();
    path.v[0][0] = fraction(1, 2);
    let (mut pairs, mut own) = ([[whole(0); 2]; super::LENGTH], zero());
    for k in 0..12 {
        let order = Running::new(k);
        pairs[k] = series::sin_cos_of_coordinate(&path, 0, &pairs, order);
        let [s, c] = pairs[k];
        let expected = [sine * s + cosine * c, sine * c - cosine * s];
        if k == 0 {
            [path.a[0][0], own[0]] = expected;
        } else {
            series::sine_oscillator(&mut path, 0, &mut own, order);
        }
        assert_eq!([path.a[0][k], own[k]], expected, "order {k}");
        path.integrate(order);
    }
}

/// Computes one further order of a swing.
fn oscillator_on<O: Order>(path: &mut super::Path<f64, 1>, own: &mut Series<f64>, order: O) {
    series::sine_oscillator(path, 0, own, order);
    path.integrate(order);
}

#[test]
fn two_orders_of_an_oscillator_at_once_have_the_same_bits() {
    let mut one_by_one = super::Path::<f64, 1>::new();
    (one_by_one.v[0][0], one_by_one.a[0][0]) = (0.7, -1.3);
    one_by_one.integrate(Running::new(0));
    let mut own = zero();
    own[0] = -9.1;
    for k in 1..4 {
        oscillator_on(&mut one_by_one, &mut own, Running::new(k));
    }
    let (mut in_pairs, mut own_in_pairs) = (one_by_one.clone(), own);
    macro_rules! pairs {
        ($($first:literal $second:literal)+) => {$(
            for k in [$first, $second] {
                oscillator_on(&mut one_by_one, &mut own, Running::new(k));
            }
            oscillator_on(&mut in_pairs, &mut own_in_pairs, First::<$first>);
            oscillator_on(&mut in_pairs, &mut own_in_pairs, Second::<$second>);
            let bits = |path: &super::Path<f64, 1>, own: &Series<f64>| [path.q[0], path.v[0], path.a[0], *own].map(|x| x.map(f64::to_bits));
            assert_eq!(bits(&in_pairs, &own_in_pairs), bits(&one_by_one, &own), "order {}", $first);
        )+};
    }
    pairs!(4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29);
}

#[test]
fn inverse_functions() {
    let inverse = |name: &str,
                   start: fn(Fraction) -> Fraction,
                   a: &Coefficients,
                   divisor: &Coefficients,
                   expected: &Coefficients| {
        let (x, rate, divisor) = (padded(a), rates(a), padded(divisor));
        let (mut slopes, mut lead) = (zero(), whole(0));
        check(name, expected, |order, k, _| {
            slopes[k] = series::slope(rate[k], &divisor, &slopes, &mut lead, order);
            series::from_rate(|| start(x[0]), slopes[k], &reciprocals(), order)
        });
    };
    let a = argument(1);
    let logarithm =
        |n| if n == 0 { whole(0) } else { fraction(if n % 2 == 1 { 1 } else { -1 }, n) };
    inverse("logarithm", Real::ln, &a, &a, &composed(logarithm, &a));
    let a = argument(0);
    let plus = |sign: Fraction| {
        let mut sum = multiplied(&a, &a).map(|square| sign * square);
        sum[0] += whole(1);
        sum
    };
    let arc_tangent = composed(|n| odd(n, |m| whole(if m % 2 == 0 { 1 } else { -1 })), &a);
    inverse("arc tangent", Real::atan, &a, &plus(whole(1)), &arc_tangent);
    let mut below = plus(whole(-1));
    below[0] = whole(1);
    let root = composed(|n| binomial(fraction(1, 2), n), &below);
    let arc_sine = composed(
        |n| odd(n, |m| binomial(fraction(-1, 2), m) * whole(if m % 2 == 0 { 1 } else { -1 })),
        &a,
    );
    inverse("arc sine", Real::asin, &a, &root, &arc_sine);
}

#[test]
fn orders_are_all_the_same() {
    let (x, y): (Series<f64>, Series<f64>) = (
        core::array::from_fn(|k| 1.0 / (k + 1) as f64),
        core::array::from_fn(|k| 0.7 - 0.1 * k as f64),
    );
    let all = |order| {
        (series::product(&x, &y, order), series::square(&x, order), series::behind(&x, &y, order))
    };
    assert_eq!(all(Running::new(0)), {
        let order = super::Constant::<0>;
        (series::product(&x, &y, order), series::square(&x, order), series::behind(&x, &y, order))
    });
    macro_rules! same {
        ($($k:literal)+) => {$(
            let order = super::Constant::<$k>;
            assert_eq!(order.index(), $k);
            let unrolled = (series::product(&x, &y, order), series::square(&x, order), series::behind(&x, &y, order));
            assert_eq!(all(Running::new($k)), unrolled);
            let order = super::Calling::new($k);
            assert_eq!(all(Running::new($k)), (series::product(&x, &y, order), series::square(&x, order), series::behind(&x, &y, order)));
        )+};
    }
    same!(1 2 3 4 5 6 7 8 9 10 17 24 31);
}
