//! Jets: the Taylor coefficients of a motion, computed order by order.
//!
//! `lagrangian!` emits one recurrence for each operation of its equations (Jorba and Zou 2005); the
//! mass matrix is factored once for all orders. All series are in powers of the time since their
//! start: x(t₀ + h) = Σ x\[k\] hᵏ.

// Sums must be inlined to use an order that is known at compile time.
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

use crate::scalar::Real;
use crate::system::System;
use core::fmt::Debug;

/// The number of coefficients of a [`Series`].
pub const LENGTH: usize = 32;

/// The highest order of a jet: the acceleration of a driven input needs two further coefficients of
/// its position.
pub const MAX_ORDER: usize = LENGTH - 2;

/// The coefficients of a quantity, starting with the constant one.
pub type Series<T> = [T; LENGTH];

/// Two series that are computed together, coefficient by coefficient: sine and cosine.
pub type Pairs<T> = [[T; 2]; LENGTH];

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

/// The series of a motion.
#[derive(Clone, Debug)]
pub struct Path<T, const N: usize> {
    /// The time at the start.
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
    /// Computes the reciprocals, correctly rounded.
    pub fn new() -> Self {
        Self(core::array::from_fn(|k| T::ratio(1.0, if k == 0 { 1.0 } else { k as f64 })))
    }

    /// Returns 1/k for 0 < k < [`LENGTH`].
    #[inline(always)]
    pub fn of(&self, k: usize) -> T {
        self.0[k]
    }

    /// Computes x/k for 0 < k < [`LENGTH`]. Small k are divided by, because the rounding error of ⅓
    /// would be the same in every step and accumulate.
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
    /// Creates series that are zero.
    pub fn new() -> Self {
        let zero = [zero(); N];
        Self { t: T::from_f64(0.0), q: zero, v: zero, a: zero, reciprocals: Reciprocals::new() }
    }

    /// Computes the coefficients k + 1 of q and q̇ from the accelerations of order k: ẋ = y is
    /// (k+1) x\[k+1\] = y\[k\].
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

/// The series of one component of a driven input.
#[derive(Clone, Copy, Debug)]
pub struct InputSeries<T> {
    /// x.
    pub position: Series<T>,
    /// ẋ.
    pub velocity: Series<T>,
    /// ẍ.
    pub acceleration: Series<T>,
}

impl<T: Real> InputSeries<T> {
    /// Creates series that are zero.
    pub fn zero() -> Self {
        Self { position: zero(), velocity: zero(), acceleration: zero() }
    }

    /// Computes velocity and acceleration from the position: the coefficients below `count`, and
    /// one more of the velocity.
    pub fn differentiate(&mut self, count: usize) {
        let count = count.min(MAX_ORDER);
        self.velocity[count] = self.position[count + 1] * T::from_f64((count + 1) as f64);
        for k in 0..count {
            self.velocity[k] = self.position[k + 1] * T::from_f64((k + 1) as f64);
            self.acceleration[k] = self.position[k + 2] * T::from_f64(((k + 1) * (k + 2)) as f64);
        }
    }
}

/// Returns the zero series.
pub fn zero<T: Real>() -> Series<T> {
    [T::from_f64(0.0); LENGTH]
}

/// The workspace of generated code: `W` series, `Q` pairs of series, `P` values that depend only on
/// parameters, `L` values that are computed once per step, and the factors of the blocks of the
/// mass matrix.
#[derive(Clone, Debug)]
pub struct Work<T, F, const W: usize, const Q: usize, const P: usize, const L: usize> {
    /// The series of operands of products and functions.
    pub series: [Series<T>; W],
    /// Sines and cosines.
    pub pairs: [Pairs<T>; Q],
    /// Values that depend only on parameters.
    pub still: [T; P],
    /// Values that depend only on leading coefficients: reciprocals and signs.
    pub leading: [T; L],
    /// The factors of the mass matrix at the start of the step.
    pub factors: F,
}

impl<T: Real, F, const W: usize, const Q: usize, const P: usize, const L: usize>
    Work<T, F, W, Q, P, L>
{
    /// Creates a workspace with the values `still`, and zero series.
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
