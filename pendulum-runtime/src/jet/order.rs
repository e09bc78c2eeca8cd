//! The order of a coefficient, as a constant or as a number at run time.

use super::{Jets, LENGTH, MAX_ORDER, Pairs, Path, Series, sum};
use crate::scalar::Real;
use crate::sealed::Sealed;

/// The index k of the coefficient that is computed, and the sums of products up to it.
pub trait Order: Copy + Sealed {
    /// Another order, known at run time.
    type At: Order;

    /// The order as a number below [`LENGTH`].
    fn index(self) -> usize;

    /// The order `index`, below [`LENGTH`].
    fn at(self, index: usize) -> Self::At;

    /// Σ a\[j\] b\[k−j\] over 0 < j < k, for k > 1.
    fn inner<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T;

    /// Σ a\[j−S\] p\[k−j\] over 1 ≤ j ≤ k, for both series of the pair p and k > 0.
    fn both<T: Real, const S: usize>(self, a: &Series<T>, pairs: &Pairs<T>) -> [T; 2];

    /// Σ a\[j\]·b\[k−j\] over 0 ≤ j ≤ k, where b\[k\] is `newest`.
    fn dot<T: Real>(self, a: &Pairs<T>, b: &Pairs<T>, newest: [T; 2]) -> T;

    /// Σ v\[j\] p\[k−j\] over 0 ≤ j < k, or v\[0\] p\[0\] for k = 0, for both series of the pair p,
    /// where p\[k\] is `newest`.
    fn turning<T: Real>(self, v: &Series<T>, p: &Pairs<T>, newest: [T; 2]) -> [T; 2];

    /// Σ a\[j\] a\[k−j\] over 0 < j < k/2, for k > 2.
    fn half<T: Real>(self, a: &Series<T>) -> T;

    /// Σ b\[j\] v\[k−1−j\] over 0 ≤ j < k and ½ Σ v\[j\] v\[k−j\] over 0 ≤ j ≤ k, for k > 0. From
    /// them come a\[k\] and b\[k\], whose places may hold partial sums before.
    fn swing<T: Real>(self, v: &Series<T>, a: &mut Series<T>, b: &mut Series<T>) -> [T; 2];
}

/// An order that the compiler knows: it unrolls every sum.
#[derive(Clone, Copy, Debug)]
pub struct Constant<const K: usize>;

/// An even order above 2 that the compiler knows, in lanes: products of this order and the next one
/// are summed together, because there it is loading that takes time.
#[derive(Clone, Copy, Debug)]
pub struct First<const K: usize>;

/// The order after [`First`].
#[derive(Clone, Copy, Debug)]
pub struct Second<const K: usize>;

/// An order that is known at run time: every sum is a loop in its place.
#[derive(Clone, Copy, Debug)]
pub struct Running(usize);

/// An order that is known at run time: every sum is a call.
#[derive(Clone, Copy, Debug)]
pub struct Calling(usize);

impl Running {
    /// The order `index`, below [`LENGTH`].
    pub const fn new(index: usize) -> Self {
        Self(index)
    }
}

impl Calling {
    /// The order `index`, below [`LENGTH`].
    pub const fn new(index: usize) -> Self {
        Self(index)
    }
}

macro_rules! orders {
    ($($(#[$inline:meta])? [$($parameter:tt)*] $order:ty, |$this:ident| $index:expr, $at:ident, $swing:ident;)+) => {$(
        impl<$($parameter)*> Sealed for $order {}

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
            fn swing<T: Real>(self, v: &Series<T>, a: &mut Series<T>, b: &mut Series<T>) -> [T; 2] {
                $swing(self.index(), v, a, b)
            }
        }
    )+};
}

orders! {
    #[inline(always)] [const K: usize] Constant<K>, |_order| K, Running, swing;
    #[inline(always)] [const K: usize] First<K>, |_order| K, Running, first_swing;
    #[inline(always)] [const K: usize] Second<K>, |_order| K, Running, second_swing;
    // The remainder has no effect, but the compiler then knows that no series is left.
    #[inline(always)] [] Running, |order| order.0 % LENGTH, Running, swing;
    #[inline(never)] [] Calling, |order| order.0 % LENGTH, Calling, swing;
}

/// The sums of [`Order::swing`].
#[inline(always)]
fn swing<T: Real>(k: usize, v: &Series<T>, _: &mut Series<T>, b: &mut Series<T>) -> [T; 2] {
    let inner = if 2 < k { Some(sum::inner(b, v, k - 1)) } else { None };
    let half = if 2 < k { Some(sum::half(v, k)) } else { None };
    [sum::before(b, v, k, inner), sum::half_square(v, k, half)]
}

/// The same, and what is known of the next order's sums in the places of its coefficients.
#[inline(always)]
fn first_swing<T: Real>(k: usize, v: &Series<T>, a: &mut Series<T>, b: &mut Series<T>) -> [T; 2] {
    let [inner, next_inner] = sum::inner_of_two(b, v, k - 1);
    let [half, next_half] = sum::half_of_two(v, k);
    (a[k + 1], b[k + 1]) = (next_inner, next_half);
    [sum::before(b, v, k, Some(inner)), sum::half_square(v, k, Some(half))]
}

/// The same with what [`first_swing`] has left in the places of the coefficients.
#[inline(always)]
fn second_swing<T: Real>(k: usize, v: &Series<T>, a: &mut Series<T>, b: &mut Series<T>) -> [T; 2] {
    [sum::before(b, v, k, Some(a[k])), sum::half_square(v, k, Some(b[k]))]
}

/// A way to go through the orders of a jet.
pub trait Unrolling: Sealed {
    /// The tolerance below which [`Taylor`](crate::integrate::Taylor) is faster than
    /// [`Dop853`](crate::integrate::Dop853), as the benchmark `work_precision` measures it.
    const PAYS_BELOW: f64;

    /// The coefficients of q and q̇ up to `order`, at most [`MAX_ORDER`], from the leading ones.
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    );

    /// The accelerations at the start for a system over lanes, with which [`run_in_lanes`] goes on;
    /// compiled into the code around it for the vectors that this may use.
    ///
    /// [`run_in_lanes`]: Self::run_in_lanes
    #[inline(always)]
    fn begin_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        system.coefficient(Running(0), path, drive, work);
        part(path, work);
    }

    /// The same as [`run`](Self::run) for a system over lanes, from the accelerations at the start
    /// and from the work of [`begin_in_lanes`](Self::begin_in_lanes).
    #[inline(always)]
    fn run_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        path.integrate(Running(0));
        for k in 1..order.min(MAX_ORDER) {
            system.coefficient(Running(k), path, drive, work);
            path.integrate(Running(k));
            part(path, work);
        }
    }
}

/// One piece of code for each order: fastest for short equations.
#[derive(Clone, Copy, Debug)]
pub struct Unrolled;

/// One piece of code for all orders.
#[derive(Clone, Copy, Debug)]
pub struct Looped;

/// One piece of code for all orders and for all products: smallest, for long equations.
#[derive(Clone, Copy, Debug)]
pub struct Called;

impl Sealed for Unrolled {}

impl Sealed for Looped {}

impl Sealed for Called {}

impl Unrolling for Looped {
    const PAYS_BELOW: f64 = 2e-7;

    // Alone in its function, the loop keeps what it needs in registers.
    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        for k in 0..order.min(MAX_ORDER) {
            system.coefficient(Running(k), path, drive, work);
            path.integrate(Running(k));
        }
    }
}

impl Unrolling for Called {
    const PAYS_BELOW: f64 = 2e-14;

    // Alone in its function, the loop keeps what it needs in registers.
    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        for k in 0..order.min(MAX_ORDER) {
            system.coefficient(Calling(k), path, drive, work);
            path.integrate(Calling(k));
        }
    }
}

impl Unrolling for Unrolled {
    const PAYS_BELOW: f64 = 1.0;

    // Alone in its function, the loop keeps what it needs in registers.
    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        unrolled(system, order, path, drive, work);
    }

    #[inline(always)]
    fn begin_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        system.coefficient(Constant::<0>, path, drive, work);
        part(path, work);
    }

    #[inline(always)]
    fn run_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        // With the same bits; but one piece of code for each order takes the compiler long.
        if cfg!(debug_assertions) {
            Looped::run_in_lanes(system, order, path, drive, work);
        } else {
            paired(system, order, path, drive, work);
        }
    }
}

/// The orders in lanes, each in code of its own: four by four, so that what one order leaves to the
/// next stays in registers; the last ones of an order that is no multiple of four in a loop.
#[inline(always)]
fn paired<S: Jets<N>, const N: usize>(
    system: &S,
    order: usize,
    path: &mut Path<S::Scalar, N>,
    drive: &S::Drive,
    work: &mut S::Work,
) {
    path.integrate(Constant::<0>);
    let mut done = 1;
    macro_rules! each {
        ($([$($k:ident<$index:literal>)+] $next:literal)+) => {'groups: {$(
            if order < $next {
                break 'groups;
            }
            $(system.coefficient($k::<$index>, path, drive, work);
            path.integrate($k::<$index>);)+
            part(path, work);
            done = $next;
        )+}};
    }
    each! {
        [Constant<1> Constant<2> Constant<3>] 4
        [First<4> Second<5> First<6> Second<7>] 8
        [First<8> Second<9> First<10> Second<11>] 12
        [First<12> Second<13> First<14> Second<15>] 16
        [First<16> Second<17> First<18> Second<19>] 20
        [First<20> Second<21> First<22> Second<23>] 24
        [First<24> Second<25> First<26> Second<27>] 28
    }
    for k in done..order.min(MAX_ORDER) {
        system.coefficient(Running(k), path, drive, work);
        path.integrate(Running(k));
        part(path, work);
    }
}

/// The orders one after the other, each in code of its own.
#[inline(always)]
fn unrolled<S: Jets<N>, const N: usize>(
    system: &S,
    order: usize,
    path: &mut Path<S::Scalar, N>,
    drive: &S::Drive,
    work: &mut S::Work,
) {
    macro_rules! each {
        ($($k:literal)+) => {$(
            if order <= $k {
                return;
            }
            system.coefficient(Constant::<$k>, path, drive, work);
            path.integrate(Constant::<$k>);
        )+};
    }
    each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29);
}

/// Keeps the orders apart: the compiler then forms vectors of lanes within one order, where they
/// come out whole.
#[inline(always)]
fn part<P, W>(path: &mut P, work: &mut W) {
    core::hint::black_box((path, work));
}
