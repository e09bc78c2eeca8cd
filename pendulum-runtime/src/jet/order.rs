//! The order of a coefficient, as a constant or as a number at run time.

use super::{Jets, LENGTH, MAX_ORDER, Pairs, Path, Series, sum};
use crate::real::Real;

/// The index k of the coefficient that is computed, and the sums of products up to it.
pub trait Order: Copy {
    /// As a number below [`LENGTH`].
    fn index(self) -> usize;

    /// Σ a\[j\] b\[k−j\] over 0 < j < k, for k > 1.
    fn inner<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T;

    /// Σ a\[j−S\] p\[k−j\] over 1 ≤ j ≤ k, for both series of the pair p and k > 0.
    fn both<T: Real, const S: usize>(self, a: &Series<T>, pairs: &Pairs<T>) -> [T; 2];

    /// Σ a\[j\] b\[k−1−j\] over 0 ≤ j < k, for k > 0.
    fn before<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T;

    /// Σ a\[j\] a\[k−j\] over 0 < j < k/2, for k > 2.
    fn half<T: Real>(self, a: &Series<T>) -> T;

    /// ½ Σ a\[j\] a\[k−j\] over 0 ≤ j ≤ k, for k > 0.
    fn half_square<T: Real>(self, a: &Series<T>) -> T;
}

/// An order that the compiler knows: it unrolls every sum.
#[derive(Clone, Copy, Debug)]
pub struct Constant<const K: usize>;

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
    ($($(#[$inline:meta])? [$($parameter:tt)*] $order:ty, |$this:ident| $index:expr;)+) => {$(
        impl<$($parameter)*> Order for $order {
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
            fn before<T: Real>(self, a: &Series<T>, b: &Series<T>) -> T {
                sum::before(a, b, self.index())
            }

            $(#[$inline])?
            fn half<T: Real>(self, a: &Series<T>) -> T {
                sum::half(a, self.index())
            }

            $(#[$inline])?
            fn half_square<T: Real>(self, a: &Series<T>) -> T {
                sum::half_square(a, self.index())
            }
        }
    )+};
}

orders! {
    #[inline(always)] [const K: usize] Constant<K>, |_order| K;
    // The remainder has no effect, but the compiler then knows that no series is left.
    #[inline(always)] [] Running, |order| order.0 % LENGTH;
    #[inline(never)] [] Calling, |order| order.0 % LENGTH;
}

/// A way to go through the orders of a jet.
pub trait Orders {
    /// The tolerance below which [`Taylor`](crate::integrate::Taylor) is faster than [`Dop853`](crate::integrate::Dop853), as the
    /// benchmark `work_precision` measures it.
    const PAYS_BELOW: f64;

    /// The coefficients of q and q̇ up to `order`, at most [`MAX_ORDER`], from the leading ones.
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    );

    /// The same for a system over lanes, compiled into the code around it for the vectors that this may use.
    #[inline(always)]
    fn run_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        looped::<S, true, N>(system, order, path, drive, work);
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

impl Orders for Looped {
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
        looped::<S, false, N>(system, order, path, drive, work);
    }
}

impl Orders for Called {
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

impl Orders for Unrolled {
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
        unrolled::<S, false, N>(system, order, path, drive, work);
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
            looped::<S, true, N>(system, order, path, drive, work);
        } else {
            unrolled::<S, true, N>(system, order, path, drive, work);
        }
    }
}

/// The orders one after the other, each in the same code.
#[inline(always)]
fn looped<S: Jets<N>, const LANES: bool, const N: usize>(
    system: &S,
    order: usize,
    path: &mut Path<S::Scalar, N>,
    drive: &S::Drive,
    work: &mut S::Work,
) {
    for k in 0..order.min(MAX_ORDER) {
        system.coefficient(Running(k), path, drive, work);
        path.integrate(Running(k));
        if LANES {
            part(path, work);
        }
    }
}

/// The orders one after the other, each in code of its own.
#[inline(always)]
fn unrolled<S: Jets<N>, const LANES: bool, const N: usize>(
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
            if LANES {
                part(path, work);
            }
        )+};
    }
    each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29);
}

/// Keeps the orders apart: the compiler then forms vectors of lanes within one order, where they come out whole.
#[inline(always)]
fn part<P, W>(path: &mut P, work: &mut W) {
    core::hint::black_box((path, work));
}
