//! The sums of products of all recurrences. Odd and even terms are added separately, and the newest
//! terms last.

use crate::motion::series::{LENGTH, Series};
use crate::scalar::Real;

/// Two series that are computed together, coefficient by coefficient: sine and cosine.
pub type Pairs<T> = [[T; 2]; LENGTH];

/// Computes Σ a\[j\] b\[k−j\] over 0 < j < k, for k > 1.
#[inline(always)]
pub(super) fn inner<T: Real>(a: &Series<T>, b: &Series<T>, k: usize) -> T {
    let mut odd = a[1] * b[k - 1];
    if k == 2 {
        return odd;
    }
    let mut even = a[2] * b[k - 2];
    let mut j = 3;
    while j + 1 < k {
        odd += a[j] * b[k - j];
        even += a[j + 1] * b[k - j - 1];
        j += 2;
    }
    if j < k {
        odd += a[j] * b[k - j];
    }
    odd + even
}

/// Computes [`inner`] for k and k + 1, which have most loads in common, for k > 2.
#[inline(always)]
pub(super) fn inner_of_two<T: Real>(a: &Series<T>, b: &Series<T>, k: usize) -> [T; 2] {
    let mut odd = [a[1] * b[k - 1], a[1] * b[k]];
    let mut even = [a[2] * b[k - 2], a[2] * b[k - 1]];
    let mut j = 3;
    while j + 1 < k {
        odd = plus(odd, times(a[j], [b[k - j], b[k + 1 - j]]));
        even = plus(even, times(a[j + 1], [b[k - j - 1], b[k - j]]));
        j += 2;
    }
    if j < k {
        odd = plus(odd, times(a[j], [b[k - j], b[k + 1 - j]]));
        even[1] += a[j + 1] * b[k - j];
    } else {
        odd[1] += a[j] * b[1];
    }
    plus(odd, even)
}

/// Computes Σ a\[j\] b\[k−1−j\] over 0 ≤ j < k, for k > 0. `inner` is the value of [`inner`] for k
/// − 1, or `None` for k < 3.
#[inline(always)]
pub(super) fn before<T: Real>(a: &Series<T>, b: &Series<T>, k: usize, inner: Option<T>) -> T {
    let oldest = a[0] * b[k - 1];
    if k == 1 {
        return oldest;
    }
    let older = match inner {
        Some(inner) => inner + oldest,
        None => oldest,
    };
    older + a[k - 1] * b[0]
}

/// Computes Σ a\[j\] a\[k−j\] over 0 < j < k/2, for k > 2.
#[inline(always)]
pub(super) fn half<T: Real>(a: &Series<T>, k: usize) -> T {
    let mut odd = a[1] * a[k - 1];
    if k <= 4 {
        return odd;
    }
    let mut even = a[2] * a[k - 2];
    let mut j = 3;
    while 2 * (j + 1) < k {
        odd += a[j] * a[k - j];
        even += a[j + 1] * a[k - j - 1];
        j += 2;
    }
    if 2 * j < k {
        odd += a[j] * a[k - j];
    }
    odd + even
}

/// Computes [`half`] for k and k + 1, which have most loads in common, for even k > 2.
#[inline(always)]
pub(super) fn half_of_two<T: Real>(a: &Series<T>, k: usize) -> [T; 2] {
    let mut odd = [a[1] * a[k - 1], a[1] * a[k]];
    if k == 4 {
        return [odd[0], odd[1] + a[2] * a[3]];
    }
    let mut even = [a[2] * a[k - 2], a[2] * a[k - 1]];
    let mut j = 3;
    while 2 * (j + 1) < k {
        odd = plus(odd, times(a[j], [a[k - j], a[k + 1 - j]]));
        even = plus(even, times(a[j + 1], [a[k - j - 1], a[k - j]]));
        j += 2;
    }
    if 2 * j < k {
        odd = plus(odd, times(a[j], [a[k - j], a[k + 1 - j]]));
        even[1] += a[j + 1] * a[k - j];
    } else {
        odd[1] += a[j] * a[k + 1 - j];
    }
    plus(odd, even)
}

/// Computes ½ Σ a\[j\] a\[k−j\] over 0 ≤ j ≤ k with each product once, for k > 0. `half` is the
/// value of [`half`], or `None` for k < 3.
#[inline(always)]
pub(super) fn half_square<T: Real>(a: &Series<T>, k: usize, half: Option<T>) -> T {
    let newest = a[0] * a[k];
    if k == 1 {
        return newest;
    }
    let middle = T::from_f64(0.5) * (a[k / 2] * a[k / 2]);
    match half {
        Some(half) if k.is_multiple_of(2) => (half + middle) + newest,
        Some(half) => half + newest,
        None => middle + newest,
    }
}

/// Computes Σ a\[j−S\] p\[k−j\] over 1 ≤ j ≤ k for both series of the pair p, for k > 0.
#[inline(always)]
pub(super) fn both<T: Real, const S: usize>(a: &Series<T>, p: &Pairs<T>, k: usize) -> [T; 2] {
    let last = times(a[k - S], p[0]);
    if k == 1 {
        return last;
    }
    let newest = plus(times(a[1 - S], p[k - 1]), last);
    if k == 2 {
        return newest;
    }
    let mut odd = times(a[2 - S], p[k - 2]);
    if k == 3 {
        return plus(odd, newest);
    }
    let mut even = times(a[3 - S], p[k - 3]);
    let mut j = 4;
    while j + 1 < k {
        odd = plus(odd, times(a[j - S], p[k - j]));
        even = plus(even, times(a[j + 1 - S], p[k - j - 1]));
        j += 2;
    }
    if j < k {
        odd = plus(odd, times(a[j - S], p[k - j]));
    }
    plus(plus(odd, even), newest)
}

/// Computes Σ a\[j\]·b\[k−j\] over 0 ≤ j ≤ k. b\[k\] is passed as `newest`, because loading a
/// vector just after its parts were stored is slow.
#[inline(always)]
pub(super) fn dot<T: Real>(a: &Pairs<T>, b: &Pairs<T>, newest: [T; 2], k: usize) -> T {
    let newest = each(a[0], newest);
    if k == 0 {
        return newest[0] + newest[1];
    }
    let mut older = each(a[k], b[0]);
    if 1 < k {
        older = plus(inside(&a[1..k], &b[1..k], each), older);
    }
    (older[0] + older[1]) + (newest[0] + newest[1])
}

/// Computes Σ v\[j\] p\[k−j\] over 0 ≤ j < k, or v\[0\] p\[0\] for k = 0, for both series of the
/// pair p, where p\[k\] is `newest`.
#[inline(always)]
pub(super) fn turning<T: Real>(v: &Series<T>, p: &Pairs<T>, newest: [T; 2], k: usize) -> [T; 2] {
    let newest = times(v[0], newest);
    if k < 2 {
        return newest;
    }
    let older = inside(&v[1..k], &p[1..k], times);
    plus(older, newest)
}

/// Computes the sum of the products of the first element of `a` and the last of `b`, the second and
/// the last but one, and so on, with odd and even terms added separately. Slices instead of indices
/// avoid bounds checks.
#[inline(always)]
fn inside<T: Real, A: Copy>(a: &[A], b: &[[T; 2]], term: impl Fn(A, [T; 2]) -> [T; 2]) -> [T; 2] {
    let k = a.len();
    let mut odd = term(a[0], b[k - 1]);
    if k == 1 {
        return odd;
    }
    let mut even = term(a[1], b[k - 2]);
    let (twos, others) = (a[2..].chunks_exact(2), b[..k - 2].rchunks_exact(2));
    let (one, other) = (twos.remainder(), others.remainder());
    for (a, b) in twos.zip(others) {
        odd = plus(odd, term(a[0], b[1]));
        even = plus(even, term(a[1], b[0]));
    }
    if let ([a], [b]) = (one, other) {
        odd = plus(odd, term(*a, *b));
    }
    plus(odd, even)
}

#[inline(always)]
fn each<T: Real>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] * b[0], a[1] * b[1]]
}

#[inline(always)]
fn times<T: Real>(factor: T, pair: [T; 2]) -> [T; 2] {
    [factor * pair[0], factor * pair[1]]
}

#[inline(always)]
fn plus<T: Real>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] + b[0], a[1] + b[1]]
}
