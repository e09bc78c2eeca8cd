//! The order of a coefficient, known at compile time or at run time.

use crate::jet::sum::{self, Pairs};
use crate::motion::series::{LENGTH, Series};
use crate::scalar::Real;

/// The index k of the coefficient to be computed, and the sums of products up to it.
pub trait Order: Copy {
    /// An order that is known at run time.
    type At: Order;

    /// Returns the order as a number below [`LENGTH`].
    fn index(self) -> usize;

    /// Returns the order `index`, below [`LENGTH`].
    fn at(self, index: usize) -> Self::At;

    /// Computes Σ a\[j\] b\[k−j\] over 0 < j < k, for k > 1.
    fn inner<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T;

    /// Computes Σ a\[j−S\] p\[k−j\] over 1 ≤ j ≤ k for both series of the pair p, for k > 0.
    fn both<T: Real, const S: usize>(self, a: &Series<T>, pairs: &Pairs<T>) -> [T; 2];

    /// Computes Σ a\[j\]·b\[k−j\] over 0 ≤ j ≤ k, where b\[k\] is `newest`.
    fn dot<T: Real>(self, a: &Pairs<T>, b: &Pairs<T>, newest: [T; 2]) -> T;

    /// Computes Σ v\[j\] p\[k−j\] over 0 ≤ j < k, or v\[0\] p\[0\] for k = 0, for both series of
    /// the pair p, where p\[k\] is `newest`.
    fn turning<T: Real>(self, v: &Series<T>, p: &Pairs<T>, newest: [T; 2]) -> [T; 2];

    /// Computes Σ a\[j\] a\[k−j\] over 0 < j < k/2, for k > 2.
    fn half<T: Real>(self, a: &Series<T>) -> T;

    /// Computes Σ b\[j\] v\[k−1−j\] over 0 ≤ j < k and ½ Σ v\[j\] v\[k−j\] over 0 ≤ j ≤ k, for k >
    /// 0, from which a\[k\] and b\[k\] follow. Until then, a\[k\] and b\[k\] may contain partial
    /// sums.
    fn oscillator_sums<T: Real>(
        self,
        v: &Series<T>,
        a: &mut Series<T>,
        b: &mut Series<T>,
    ) -> [T; 2];
}

/// An order that is known at compile time, for which every sum is unrolled.
#[derive(Clone, Copy, Debug)]
pub struct Constant<const K: usize>;

/// An even order above 2 that is known at compile time, for lanes. The products of this order and
/// the next one are added together, because loading takes most of the time.
#[derive(Clone, Copy, Debug)]
pub struct First<const K: usize>;

/// The order after [`First`].
#[derive(Clone, Copy, Debug)]
pub struct Second<const K: usize>;

/// An order that is known at run time, for which every sum is an inlined loop.
#[derive(Clone, Copy, Debug)]
pub struct Running(usize);

/// An order that is known at run time, for which every sum is a function call.
#[derive(Clone, Copy, Debug)]
pub struct Calling(usize);

impl Running {
    /// Creates the order `index`, below [`LENGTH`].
    pub const fn new(index: usize) -> Self {
        Self(index)
    }
}

impl Calling {
    /// Creates the order `index`, below [`LENGTH`].
    pub const fn new(index: usize) -> Self {
        Self(index)
    }
}

macro_rules! orders {
    ($($(#[$inline:meta])? [$($parameter:tt)*] $order:ty, |$this:ident| $index:expr, $at:ident, $oscillator_sums:ident;)+) => {$(
        impl<$($parameter)*> Order for $order {
            type At = $at;

            #[inline(always)]
            fn at(self, index: usize) -> $at {
                $at(index)
            }

            #[inline(always)]
            fn index(self) -> usize {
                let $this = self;
                $index
            }

            $(#[$inline])?
            fn inner<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T {
                sum::inner(a, b, self.index())
            }

            $(#[$inline])?
            fn both<T: Real, const S: usize>(self, a: &Series<T>, pairs: &Pairs<T>) -> [T; 2] {
                sum::both::<T, S>(a, pairs, self.index())
            }

            $(#[$inline])?
            fn dot<T: Real>(self, a: &Pairs<T>, b: &Pairs<T>, newest: [T; 2]) -> T {
                sum::dot(a, b, newest, self.index())
            }

            $(#[$inline])?
            fn turning<T: Real>(self, v: &Series<T>, p: &Pairs<T>, newest: [T; 2]) -> [T; 2] {
                sum::turning(v, p, newest, self.index())
            }

            $(#[$inline])?
            fn half<T: Real>(self, a: &Series<T>) -> T {
                sum::half(a, self.index())
            }

            $(#[$inline])?
            fn oscillator_sums<T: Real>(self, v: &Series<T>, a: &mut Series<T>, b: &mut Series<T>) -> [T; 2] {
                $oscillator_sums(self.index(), v, a, b)
            }
        }
    )+};
}

orders! {
    #[inline(always)] [const K: usize] Constant<K>, |_order| K, Running, oscillator_sums;
    #[inline(always)] [const K: usize] First<K>, |_order| K, Running, first_oscillator_sums;
    #[inline(always)] [const K: usize] Second<K>, |_order| K, Running, second_oscillator_sums;
    // The remainder does not change the index, but removes bounds checks.
    #[inline(always)] [] Running, |order| order.0 % LENGTH, Running, oscillator_sums;
    #[inline(never)] [] Calling, |order| order.0 % LENGTH, Calling, oscillator_sums;
}

/// Computes the sums of [`Order::oscillator_sums`].
#[inline(always)]
fn oscillator_sums<T: Real>(
    k: usize,
    v: &Series<T>,
    _: &mut Series<T>,
    b: &mut Series<T>,
) -> [T; 2] {
    let inner = if 2 < k { Some(sum::inner(b, v, k - 1)) } else { None };
    let half = if 2 < k { Some(sum::half(v, k)) } else { None };
    [sum::before(b, v, k, inner), sum::half_square(v, k, half)]
}

/// Computes the sums of [`Order::oscillator_sums`], and partial sums of the next order in a\[k+1\]
/// and b\[k+1\].
#[inline(always)]
fn first_oscillator_sums<T: Real>(
    k: usize,
    v: &Series<T>,
    a: &mut Series<T>,
    b: &mut Series<T>,
) -> [T; 2] {
    let [inner, next_inner] = sum::inner_of_two(b, v, k - 1);
    let [half, next_half] = sum::half_of_two(v, k);
    (a[k + 1], b[k + 1]) = (next_inner, next_half);
    [sum::before(b, v, k, Some(inner)), sum::half_square(v, k, Some(half))]
}

/// Computes the sums of [`Order::oscillator_sums`] from the partial sums of
/// [`first_oscillator_sums`].
#[inline(always)]
fn second_oscillator_sums<T: Real>(
    k: usize,
    v: &Series<T>,
    a: &mut Series<T>,
    b: &mut Series<T>,
) -> [T; 2] {
    [sum::before(b, v, k, Some(a[k])), sum::half_square(v, k, Some(b[k]))]
}
