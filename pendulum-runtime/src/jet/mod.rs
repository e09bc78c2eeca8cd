//! Jets: the Taylor coefficients of a motion, one order after the other.
//!
//! `lagrangian!` emits one recurrence for each operation of its equations (Jorba and Zou 2005); the
//! mass matrix is factored once for all orders. All series are in powers of the time since their
//! start: x(t₀ + h) = Σ x\[k\] hᵏ.

// An order that the compiler knows has to reach every sum.
#![allow(clippy::inline_always)]

mod dynamics;
mod factors;
mod order;
pub mod series;
mod sum;
#[cfg(test)]
mod tests;

pub(crate) use dynamics::Known;
pub use dynamics::{JetDynamics, MaybeJets};
pub use factors::Factors;
pub use order::{
    Called, Calling, Constant, First, Looped, Order, Running, Second, Unrolled, Unrolling,
};

pub use crate::motion::series::{InputSeries, LENGTH, MAX_ORDER, Series, zero};
use crate::scalar::Real;
use crate::system::System;
use core::fmt::Debug;

/// Two series that are found together, coefficient by coefficient: sine and cosine.
pub type Pairs<T> = [[T; 2]; LENGTH];

/// A system whose equations come as Taylor recurrences; `lagrangian!` implements it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor recurrences",
    label = "`Taylor` needs the jets that `lagrangian!` emits",
    note = "systems written by hand can use `Dop853`, those under a controller `Picard` too"
)]
pub trait Jets<const N: usize>: System<N> {
    /// The series of the values between the state and the accelerations.
    type Work: Clone + Debug;
    /// The series of the driven inputs, component by component.
    type Drive: Clone + Debug + AsMut<[InputSeries<Self::Scalar>]>;
    /// The way through the orders: [`Unrolled`] for short equations, [`Looped`] for others,
    /// [`Called`] for long ones.
    type Unrolling: Unrolling;

    /// c in the order p = ⌈1 − c ln rtol⌉ with which [`Taylor`](crate::integrate::Taylor) takes
    /// least time, measured: the less an order costs beside the rest of a step, the more orders
    /// pay.
    const PER_DIGIT: f64;

    /// Room for the work, with what parameters alone decide.
    fn work(&self) -> Self::Work;

    /// Room for the series of the driven inputs.
    fn drive() -> Self::Drive;

    /// The coefficients q̈\[k\] of the accelerations into `path.a`, from those of q and q̇ up to
    /// the same order k.
    ///
    /// The orders before have to be done.
    fn coefficient<O: Order>(
        &self,
        order: O,
        path: &mut Path<Self::Scalar, N>,
        drive: &Self::Drive,
        work: &mut Self::Work,
    );
}

/// The series of a motion.
#[derive(Clone, Debug)]
pub struct Path<T, const N: usize> {
    /// The time at which it starts.
    pub t: T,
    /// The coordinates.
    pub q: [Series<T>; N],
    /// The velocities.
    pub v: [Series<T>; N],
    /// The accelerations.
    pub a: [Series<T>; N],
    /// The reciprocals of the numbers 1, 2, ….
    pub reciprocals: Reciprocals<T>,
}

/// The reciprocals of the numbers 1, 2, ….
#[derive(Clone, Debug)]
pub struct Reciprocals<T>(Series<T>);

impl<T: Real> Reciprocals<T> {
    /// The nearest numbers.
    pub fn new() -> Self {
        Self(core::array::from_fn(|k| T::ratio(1.0, if k == 0 { 1.0 } else { k as f64 })))
    }

    /// 1/k for 0 < k < [`LENGTH`].
    #[inline(always)]
    pub fn of(&self, k: usize) -> T {
        self.0[k]
    }

    /// x/k for 0 < k < [`LENGTH`]. The first orders are divided: the same rounding error of ⅓ in
    /// every step would add up.
    #[inline(always)]
    pub fn over(&self, x: T, k: usize) -> T {
        if matches!(k, 3 | 5 | 6) { x / T::from_f64(k as f64) } else { x * self.0[k] }
    }
}

impl<T: Real> Default for Reciprocals<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> Path<T, N> {
    /// All zero.
    pub fn new() -> Self {
        let zero = [zero(); N];
        Self { t: T::from_f64(0.0), q: zero, v: zero, a: zero, reciprocals: Reciprocals::new() }
    }

    /// The coefficients of q and q̇ after the order k from the accelerations of that order: ẋ = y
    /// is (k+1) x\[k+1\] = y\[k\].
    #[inline(always)]
    pub fn integrate<O: Order>(&mut self, order: O) {
        let k = order.index();
        for i in 0..N {
            self.q[i][k + 1] = self.reciprocals.over(self.v[i][k], k + 1);
            self.v[i][k + 1] = self.reciprocals.over(self.a[i][k], k + 1);
        }
    }
}

impl<T: Real, const N: usize> Default for Path<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// The workspace of generated code: `W` series, `Q` pairs of series, `P` numbers that parameters
/// alone decide, `L` numbers that each step finds once, and the factors of the blocks of the mass
/// matrix.
#[derive(Clone, Debug)]
pub struct Work<T, F, const W: usize, const Q: usize, const P: usize, const L: usize> {
    /// The series of values that products and functions read.
    pub series: [Series<T>; W],
    /// Sines and cosines.
    pub pairs: [Pairs<T>; Q],
    /// Values that parameters alone decide.
    pub still: [T; P],
    /// Values that the leading coefficients decide: reciprocals and signs.
    pub leading: [T; L],
    /// The mass matrix at the start of the step.
    pub factors: F,
}

impl<T: Real, F, const W: usize, const Q: usize, const P: usize, const L: usize>
    Work<T, F, W, Q, P, L>
{
    /// Nothing computed but `still`.
    pub fn new(still: [T; P], factors: F) -> Self {
        let zero_number = T::from_f64(0.0);
        Self {
            series: [zero(); W],
            pairs: [[[zero_number; 2]; LENGTH]; Q],
            still,
            leading: [zero_number; L],
            factors,
        }
    }
}
