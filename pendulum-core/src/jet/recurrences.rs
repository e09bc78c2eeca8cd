//! Systems with Taylor recurrences, and the loops over the orders of a jet.

use crate::jet::order::{Calling, Constant, First, Order, Running, Second};
use crate::jet::path::Path;
use crate::motion::series::{InputSeries, MAX_ORDER};
use crate::simd::{Work, widest};
use crate::system::System;
use core::fmt::Debug;

/// A system with Taylor recurrences; implemented by `lagrangian!`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor recurrences",
    label = "`Taylor` needs the jets that `lagrangian!` emits",
    note = "systems written by hand can use `Dop853`, those under a controller `Picard` too"
)]
pub trait Jets<const N: usize>: System<N> {
    /// The series of the intermediate values between the state and the accelerations.
    type Work: Clone + Debug;
    /// The series of the driven inputs, one per component.
    type Drive: Clone + Debug + AsMut<[InputSeries<Self::Scalar>]>;
    /// The loop over the orders: [`Unrolled`] for short equations, [`Called`] for long ones,
    /// otherwise [`Looped`].
    type Unrolling: Unrolling;

    /// The factor c in the fastest order p = ⌈1 − c ln rtol⌉ of
    /// [`Taylor`](crate::integrate::Taylor), as measured. The cheaper an order is in comparison
    /// with the rest of a step, the higher is the fastest order.
    const PER_DIGIT: f64;

    /// Creates the workspace and computes the values that depend only on parameters.
    fn work(&self) -> Self::Work;

    /// Creates the series of the driven inputs.
    fn drive() -> Self::Drive;

    /// Computes the coefficients q̈\[k\] of the accelerations in `path.a` from those of q and q̇ up
    /// to the same order k.
    ///
    /// The orders below k must have been computed before.
    fn coefficient<O: Order>(
        &self,
        order: O,
        path: &mut Path<Self::Scalar, N>,
        drive: &Self::Drive,
        work: &mut Self::Work,
    );
}

/// A way to compute the orders of a jet one after the other.
pub trait Unrolling {
    /// The tolerance below which [`Taylor`](crate::integrate::Taylor) is faster than
    /// [`Dop853`](crate::integrate::Dop853), as measured by the benchmark `work_precision`.
    const PAYS_BELOW: f64;

    /// Computes the coefficients of q and q̇ up to `order`, at most [`MAX_ORDER`], from the leading
    /// ones.
    // A separate function keeps more values of the loop in registers.
    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        for k in 0..order.min(MAX_ORDER) {
            system.coefficient(Running::new(k), path, drive, work);
            path.integrate(Running::new(k));
        }
    }

    /// Computes the accelerations at the start for a system over lanes, before [`run_in_lanes`].
    /// The code is inlined, to use the vector instructions of its caller.
    ///
    /// [`run_in_lanes`]: Self::run_in_lanes
    #[inline(always)]
    fn begin_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        system.coefficient(Running::new(0), path, drive, work);
        part(path, work);
    }

    /// Computes the same as [`run`](Self::run) for a system over lanes, from the accelerations at
    /// the start and the work of [`begin_in_lanes`](Self::begin_in_lanes).
    #[inline(always)]
    fn run_in_lanes<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        path.integrate(Running::new(0));
        for k in 1..order.min(MAX_ORDER) {
            system.coefficient(Running::new(k), path, drive, work);
            path.integrate(Running::new(k));
            part(path, work);
        }
    }
}

/// Separate code for each order: fastest for short equations.
#[derive(Clone, Copy, Debug)]
pub struct Unrolled;

/// Common code for all orders.
#[derive(Clone, Copy, Debug)]
pub struct Looped;

/// Common code for all orders and all products: smallest, for long equations.
#[derive(Clone, Copy, Debug)]
pub struct Called;

impl Unrolling for Looped {
    const PAYS_BELOW: f64 = 2e-7;
}

impl Unrolling for Called {
    const PAYS_BELOW: f64 = 2e-14;

    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
        system: &S,
        order: usize,
        path: &mut Path<S::Scalar, N>,
        drive: &S::Drive,
        work: &mut S::Work,
    ) {
        for k in 0..order.min(MAX_ORDER) {
            system.coefficient(Calling::new(k), path, drive, work);
            path.integrate(Calling::new(k));
        }
    }
}

impl Unrolling for Unrolled {
    const PAYS_BELOW: f64 = 1.0;

    /// Computes the orders one after the other, with separate code for each.
    #[inline(never)]
    fn run<S: Jets<N>, const N: usize>(
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
        // The loop has the same bits, and compiles faster than separate code for each order.
        if cfg!(debug_assertions) {
            Looped::run_in_lanes(system, order, path, drive, work);
        } else {
            paired(system, order, path, drive, work);
        }
    }
}

/// The orders from `FROM` on in lanes, with separate code for each, so that values stay in registers
/// from one order to the next.
///
/// Each group is [`Work`] of its own: a function with the orders of all groups takes the compiler
/// minutes.
struct Group<'a, S: Jets<N>, const N: usize, const FROM: usize> {
    system: &'a S,
    path: &'a mut Path<S::Scalar, N>,
    drive: &'a S::Drive,
    work: &'a mut S::Work,
}

/// Computes the orders in lanes in groups. The remaining orders of an incomplete group are computed
/// in a loop.
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
        ($($run:ident $from:literal..$next:literal)+) => {'groups: {$(
            if order < $next {
                break 'groups;
            }
            let (path, work) = (&mut *path, &mut *work);
            $run(Group::<S, N, $from> { system, path, drive, work });
            done = $next;
        )+}};
    }
    // A call takes a tenth of the time of the first orders.
    each! {
        here 1..4 here 4..8
        widest 8..12 widest 12..16 widest 16..20 widest 20..24 widest 24..28
    }
    for k in done..order.min(MAX_ORDER) {
        system.coefficient(Running::new(k), path, drive, work);
        path.integrate(Running::new(k));
        part(path, work);
    }
}

macro_rules! groups {
    ($($from:literal: $($k:ident<$index:literal>)+;)+) => {$(
        impl<S: Jets<N>, const N: usize> Work for Group<'_, S, N, $from> {
            #[inline(always)]
            fn run(self) {
                let Self { system, path, drive, work } = self;
                $(system.coefficient($k::<$index>, path, drive, work);
                path.integrate($k::<$index>);)+
                part(path, work);
            }
        }
    )+};
}

groups! {
    1: Constant<1> Constant<2> Constant<3>;
    4: First<4> Second<5> First<6> Second<7>;
    8: First<8> Second<9> First<10> Second<11>;
    12: First<12> Second<13> First<14> Second<15>;
    16: First<16> Second<17> First<18> Second<19>;
    20: First<20> Second<21> First<22> Second<23>;
    24: First<24> Second<25> First<26> Second<27>;
}

#[inline(always)]
fn here(work: impl Work) {
    work.run();
}

/// Prevents the compiler from combining orders, so that it vectorizes each order over complete
/// lanes.
#[inline(always)]
fn part<P, W>(path: &mut P, work: &mut W) {
    core::hint::black_box((path, work));
}
