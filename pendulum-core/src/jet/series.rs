//! Recurrences for the next coefficient of a function of series.
//!
//! Here k is the order, x\[j\] a coefficient and `rate` the series of j x\[j\]. Products add their
//! newest terms last, so that the sum of the older terms is ready before the newest coefficients
//! are. Sources: Moore (1966), Interval Analysis; Jorba and Zou (2005), Exp. Math. 14, 99; Griewank
//! and Walther (2008), Evaluating Derivatives, table 13.2.

use crate::jet::order::Order;
use crate::jet::path::{Path, Reciprocals};
use crate::jet::sum::Pairs;
use crate::motion::series::Series;
use crate::scalar::Real;

/// Returns a coefficient of the series of a constant: `value` at order 0, and zero at all others.
#[inline(always)]
pub fn constant<T: Real, O: Order>(value: T, order: O) -> T {
    if order.index() == 0 { value } else { T::from_f64(0.0) }
}

/// Returns a coefficient of the series of the time.
#[inline(always)]
pub fn time<T: Real, O: Order>(t: T, order: O) -> T {
    match order.index() {
        0 => t,
        1 => T::from_f64(1.0),
        _ => T::from_f64(0.0),
    }
}

/// Computes k x\[k\].
#[inline(always)]
pub fn rate<T: Real, O: Order>(x: T, order: O) -> T {
    T::from_f64(order.index() as f64) * x
}

/// Computes a b: Σ a\[j\] b\[k−j\].
#[inline(always)]
pub fn product<T: Real, O: Order>(a: &Series<T>, b: &Series<T>, order: O) -> T {
    let k = order.index();
    if k == 0 {
        return a[0] * b[0];
    }
    let newest = a[0] * b[k] + a[k] * b[0];
    if k == 1 { newest } else { order.inner(a, b) + newest }
}

/// Computes a², with each product once.
#[inline(always)]
pub fn square<T: Real, O: Order>(a: &Series<T>, order: O) -> T {
    let k = order.index();
    if k == 0 {
        return a[0] * a[0];
    }
    let newest = a[0] * a[k];
    if k == 1 {
        return newest + newest;
    }
    doubled(a, order) + (newest + newest)
}

/// Computes Σ a\[j\] b\[k−j\] from j = 1 on, and zero at order 0: an integrand, or a product
/// without the term of the unknown b\[k\].
#[inline(always)]
pub fn behind<T: Real, O: Order>(a: &Series<T>, b: &Series<T>, order: O) -> T {
    match order.index() {
        0 => T::from_f64(0.0),
        1 => a[1] * b[0],
        k => order.inner(a, b) + a[k] * b[0],
    }
}

/// Computes a quotient of series. `a` is the coefficient of the numerator, `b` the denominator and
/// `own` the quotient so far.
#[inline(always)]
pub fn quotient<T: Real, O: Order>(
    a: T,
    b: &Series<T>,
    own: &Series<T>,
    leading: &mut T,
    order: O,
) -> T {
    if order.index() == 0 {
        *leading = T::from_f64(1.0) / b[0];
        return a / b[0];
    }
    (a - behind(b, own, order)) * *leading
}

/// Computes √a, where `a` is the coefficient of the radicand. At a root of zero, all coefficients
/// are zero: this is right where the radicand stays zero, as the square of a speed at rest. Where
/// it does not, the root is no series, and step control finds it far from the equations.
#[inline(always)]
pub fn sqrt<T: Real, O: Order>(a: T, own: &Series<T>, leading: &mut T, order: O) -> T {
    let k = order.index();
    if k == 0 {
        let root = a.sqrt();
        let zero = T::from_f64(0.0);
        *leading = root.where_positive(T::from_f64(0.5) / root, zero);
        return root;
    }
    if k == 1 { a * *leading } else { (a - doubled(own, order)) * *leading }
}

/// Computes a to a constant power: k a\[0\] p\[k\] = Σ (power (k−j) − j) a\[k−j\] p\[j\] over j <
/// k. At a base of zero, all other coefficients are zero, as for [`sqrt`].
#[inline(always)]
pub fn power<T: Real, O: Order>(
    a: &Series<T>,
    exponent: T,
    own: &Series<T>,
    leading: &mut T,
    reciprocals: &Reciprocals<T>,
    order: O,
) -> T {
    let k = order.index();
    if k == 0 {
        let zero = T::from_f64(0.0);
        *leading = a[0].abs().where_positive(T::from_f64(1.0) / a[0], zero);
        return a[0].powf(exponent);
    }
    let top = T::from_f64(k as f64) * exponent;
    let step = exponent + T::from_f64(1.0);
    let mut sum = T::from_f64(0.0);
    for j in 1..k {
        sum += (top - T::from_f64(j as f64) * step) * (a[k - j] * own[j]);
    }
    (sum + top * (a[k] * own[0])) * (*leading * reciprocals.of(k))
}

/// Computes y with ẏ = w ẋ: `start` at order 0, then (1/k) Σ j x\[j\] w\[k−j\].
#[inline(always)]
pub fn integral<T: Real, O: Order>(
    start: impl FnOnce() -> T,
    rate: &Series<T>,
    w: &Series<T>,
    reciprocals: &Reciprocals<T>,
    order: O,
) -> T {
    let k = order.index();
    if k == 0 { start() } else { reciprocals.over(behind(rate, w, order), k) }
}

/// Computes sin x and cos x.
#[inline(always)]
pub fn sin_cos<T: Real, O: Order>(
    x: T,
    rate: &Series<T>,
    own: &Pairs<T>,
    reciprocals: &Reciprocals<T>,
    order: O,
) -> [T; 2] {
    let k = order.index();
    if k == 0 {
        let (sin, cos) = x.sin_cos();
        return [sin, cos];
    }
    let [with_sin, with_cos] = order.both::<T, 0>(rate, own);
    [reciprocals.over(with_cos, k), -reciprocals.over(with_sin, k)]
}

/// Computes sin q and cos q of a coordinate from its velocity.
#[inline(always)]
pub fn sin_cos_of_coordinate<T: Real, O: Order, const N: usize>(
    path: &Path<T, N>,
    coordinate: usize,
    own: &Pairs<T>,
    order: O,
) -> [T; 2] {
    let k = order.index();
    if k == 0 {
        let (sin, cos) = path.q[coordinate][0].sin_cos();
        return [sin, cos];
    }
    let [with_sin, with_cos] = order.both::<T, 1>(&path.v[coordinate], own);
    [path.reciprocals.over(with_cos, k), -path.reciprocals.over(with_sin, k)]
}

/// Computes the rate of a series that is known to one order further: (k+1) x\[k+1\].
#[inline(always)]
pub fn rate_of<T: Real, O: Order>(x: &Series<T>, order: O) -> T {
    let k = order.index();
    T::from_f64((k + 1) as f64) * x[k + 1]
}

/// Computes the dot product of two pairs, Σ a\[j\]·b\[k−j\], where b\[k\] is `newest`.
#[inline(always)]
pub fn dot<T: Real, O: Order>(a: &Pairs<T>, b: &Pairs<T>, newest: [T; 2], order: O) -> T {
    order.dot(a, b, newest)
}

/// Computes q̇ sin q and q̇ cos q of a coordinate from the `pair` of its sine and cosine, whose
/// coefficients of order k are `newest`. For k > 0 the terms with the coefficient k of q̇ are left
/// out.
#[inline(always)]
pub fn turning<T: Real, O: Order, const N: usize>(
    path: &Path<T, N>,
    coordinate: usize,
    pair: &Pairs<T>,
    newest: [T; 2],
    order: O,
) -> [T; 2] {
    order.turning(&path.v[coordinate], pair, newest)
}

/// Computes sin q and cos q of a coordinate from [`turning`], the rates of −cos q and sin q.
#[inline(always)]
pub fn turned<T: Real, O: Order, const N: usize>(
    path: &Path<T, N>,
    coordinate: usize,
    turning: &Pairs<T>,
    order: O,
) -> [T; 2] {
    let k = order.index();
    if k == 0 {
        let (sin, cos) = path.q[coordinate][0].sin_cos();
        return [sin, cos];
    }
    let [with_sin, with_cos] = turning[k - 1];
    [path.reciprocals.over(with_cos, k), -path.reciprocals.over(with_sin, k)]
}

/// Computes a = q̈ = κ sin q + λ cos q and b = κ cos q − λ sin q for k > 0. The relations ȧ = b q̇
/// and ḃ = −a q̇ = −(q̇²/2)˙ need no sine or cosine.
#[inline(always)]
pub fn sine_oscillator<T: Real, O: Order, const N: usize>(
    path: &mut Path<T, N>,
    coordinate: usize,
    b: &mut Series<T>,
    order: O,
) {
    let k = order.index();
    let (v, a) = (&path.v[coordinate], &mut path.a[coordinate]);
    let [product, square] = order.oscillator_sums(v, a, b);
    (a[k], b[k]) = (path.reciprocals.over(product, k), -square);
}

/// Computes sinh x and cosh x.
#[inline(always)]
pub fn sinh_cosh<T: Real, O: Order>(
    x: T,
    rate: &Series<T>,
    own: &Pairs<T>,
    reciprocals: &Reciprocals<T>,
    order: O,
) -> [T; 2] {
    let k = order.index();
    if k == 0 {
        return [x.sinh(), x.cosh()];
    }
    let [with_sinh, with_cosh] = order.both::<T, 0>(rate, own);
    [reciprocals.over(with_cosh, k), reciprocals.over(with_sinh, k)]
}

/// Computes f(x) for a family of functions with fₙ′ = fₙ₊₁ and f = f₀. `member` returns fₙ(x\[0\])
/// for n, and `own` stores the series of the [`LENGTH`](crate::jet::LENGTH) first members.
///
/// k fₙ\[k\] = Σ j x\[j\] fₙ₊₁\[k−j\]: each order needs one more member at x\[0\] and one more
/// coefficient of each member before it. There is no division by the argument, so the series is as
/// accurate as the members, also at zeros of the argument. Order k takes k(k+1)/2 products.
#[inline(always)]
pub fn family<T: Real, O: Order>(
    member: impl FnOnce(usize) -> T,
    rate: &Series<T>,
    own: &mut [Series<T>],
    reciprocals: &Reciprocals<T>,
    order: O,
) -> T {
    let k = order.index();
    own[k][0] = member(k);
    for j in 1..=k {
        let coefficient = behind(rate, &own[k + 1 - j], order.at(j));
        own[k - j][j] = reciprocals.over(coefficient, j);
    }
    own[0][k]
}

/// Computes the rate z of y with r ẏ = ẋ, where `x` is k x\[k\]: r\[0\] z\[k\] = k x\[k\] − Σ
/// r\[j\] z\[k−j\] over 0 < j < k.
#[inline(always)]
pub fn slope<T: Real, O: Order>(
    x: T,
    r: &Series<T>,
    own: &Series<T>,
    leading: &mut T,
    order: O,
) -> T {
    match order.index() {
        0 => {
            *leading = T::from_f64(1.0) / r[0];
            T::from_f64(0.0)
        }
        1 => x * *leading,
        _ => (x - order.inner(r, own)) * *leading,
    }
}

/// Computes y from its rate, with `start` at order 0.
#[inline(always)]
pub fn from_rate<T: Real, O: Order>(
    start: impl FnOnce() -> T,
    rate: T,
    reciprocals: &Reciprocals<T>,
    order: O,
) -> T {
    let k = order.index();
    if k == 0 { start() } else { reciprocals.over(rate, k) }
}

/// Computes `start` at order 0 and returns its value at all orders.
#[inline(always)]
pub fn leading<T: Real, O: Order>(start: impl FnOnce() -> T, leading: &mut T, order: O) -> T {
    if order.index() == 0 {
        *leading = start();
    }
    *leading
}

/// Computes Σ a\[j\] a\[k−j\] over 0 < j < k with each product once, for k > 1.
#[inline(always)]
fn doubled<T: Real, O: Order>(a: &Series<T>, order: O) -> T {
    let k = order.index();
    if k == 2 {
        return a[1] * a[1];
    }
    let half = order.half(a);
    if k.is_multiple_of(2) { (half + half) + a[k / 2] * a[k / 2] } else { half + half }
}
